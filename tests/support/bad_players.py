"""Players who cannot play for various reasons, in temporary folders of characters and instruments."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec
import pytest

import app.rig.characters.character_library as character_library
import instrument_maps.library as instrument_library
from app.formats.cache import CACHE_VARIABLE
from app.project.model import Project
from app.rig.characters.character_library import bundled_characters

WHISTLE = Path(__file__).parents[2] / "docs" / "tin-whistle"


@dataclass(frozen=True)
class OwnFolders:
    """Folders of a user's own characters and instruments.

    Attributes
    ----------
    characters, instruments : Path
        Existing folders.
    """

    characters: Path
    instruments: Path

    def add_character(self, content: bytes | None, entry: str = 'file = "mori.glb"\n') -> str:
        """Add the character ``mori`` with a file of these bytes; None for a missing file."""
        (self.characters / "mori.toml").write_text(entry)
        if content is not None:
            (self.characters / "mori.glb").write_bytes(content)
        return "mori"

    def add_instrument(self, change: Callable[[str], str] = str, model: Callable[[bytes], bytes] = bytes) -> str:
        """Add the guide's whistle with a changed map or model."""
        map_text = (WHISTLE / "tin_whistle_D.toml").read_text(encoding="utf-8")
        (self.instruments / "tin_whistle_D.toml").write_text(change(map_text), encoding="utf-8")
        content = model((WHISTLE / "tin_whistle_D.glb").read_bytes())
        if content:
            (self.instruments / "tin_whistle_D.glb").write_bytes(content)
        return "tin_whistle_D"


def own_folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> OwnFolders:
    """Use empty folders of a user's own files from now on."""
    folders = OwnFolders(tmp_path / "own_characters", tmp_path / "own_instruments")
    for folder, variable in (
        (folders.characters, character_library.FOLDER_VARIABLE),
        (folders.instruments, instrument_library.FOLDER_VARIABLE),
    ):
        folder.mkdir()
        monkeypatch.setenv(variable, str(folder))
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    monkeypatch.setattr(character_library.LIBRARY, "last", None)
    monkeypatch.setattr(character_library, "_good", {})
    monkeypatch.setattr(instrument_library.LIBRARY, "last", None)
    return folders


def _truncated(content: bytes) -> bytes:
    return content[: len(content) // 2]


def _figure() -> bytes:
    return bundled_characters()["woman_adult"].read_bytes()


BAD_CHARACTERS: dict[str, tuple[Callable[[OwnFolders], str], str]] = {
    "not installed": (lambda own: "unknown", "the character 'unknown' of trumpet is not installed"),
    "file gone": (lambda own: own.add_character(None), "mori.glb, referenced in "),
    "description damaged": (lambda own: own.add_character(_figure(), "file = "), "mori.toml"),
    "file damaged": (lambda own: own.add_character(_truncated(_figure())), "mori.glb is damaged"),
    "no body": (
        lambda own: own.add_character((WHISTLE / "tin_whistle_D.glb").read_bytes()),
        "mori.glb cannot play because its meshes are not bound to the bones of a skeleton",
    ),
}
"""Changes that make a character unusable, each returning the character's id, with the expected message."""

BAD_INSTRUMENTS: dict[str, tuple[Callable[[OwnFolders], str], str]] = {
    "not installed": (lambda own: "ophicleide", "the instrument 'ophicleide' of trumpet is not installed"),
    "map damaged": (lambda own: own.add_instrument(_half), "tin_whistle_D.toml"),
    "control missing": (
        lambda own: own.add_instrument(lambda text: text.replace('control = "hole_L1"', 'control = "hole_X9"')),
        "there is no control named 'hole_X9'",
    ),
    "model damaged": (lambda own: own.add_instrument(model=_truncated), "'tin_whistle_D.glb' cannot be read"),
    "model gone": (lambda own: own.add_instrument(model=lambda content: b""), "there is no file 'tin_whistle_D.glb'"),
}
"""Same for instruments."""


def _half(text: str) -> str:
    return text[: len(text) // 2]


def with_character(project: Project, index: int, character_id: str) -> Project:
    """Give the player at an index another character."""
    return _with(project, index, character_id=character_id)


def with_instrument(project: Project, index: int, instrument_id: str) -> Project:
    """Give the player at an index another instrument."""
    return _with(project, index, instrument_id=instrument_id)


def _with(project: Project, index: int, **fields: str) -> Project:
    players = list(project.players)
    players[index] = msgspec.structs.replace(players[index], **fields)
    return replace(project, players=tuple(players))
