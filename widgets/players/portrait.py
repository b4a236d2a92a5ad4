"""A small picture of a character's head, for lists to choose from."""

from __future__ import annotations

from functools import lru_cache

from PySide6.QtGui import QImage

from app.rig.characters.character_library import character_named
from app.rig.model import Character
from widgets.common.character_picture import picture, seen


def portrait_of(character_id: str, size_px: int) -> QImage:
    """The portrait of a character; drawn once. May be drawn in any thread."""
    return _portrait(character_named(character_id), size_px)


@lru_cache(maxsize=32)
def _portrait(character: Character, size_px: int) -> QImage:
    return picture(seen(character), size_px, size_px, "head")
