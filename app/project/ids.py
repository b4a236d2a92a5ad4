"""Ids of what is made here: notes, parts and players that no file brought.

Ids from a MIDI file are ``"track:number"`` (notes) and ``"track.channel.voice"`` (parts, and the players cast for
them), all digits. Other ids begin with a word, so that they can never be taken for something of a file: notes drawn
here are ``"n:1"`` and so on, their parts ``"part:1"``; what a file brought when it was read again ``"f:1"`` and
``"file:1"``. Each follows every number that the project knows, also from corrections that have lost their note, so
that such a correction can never come to mean another note.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

from app.plan.corrections import Correction
from app.project.model import Project

DRAWN_NOTE: Final = "n:"
READ_NOTE: Final = "f:"
MADE_PART: Final = "part:"
READ_PART: Final = "file:"

_NUMBERED = re.compile(r"(?:^|:)([nf]:)(\d+)$", re.ASCII)


def fresh_note_ids(project: Project, count: int, prefix: str = DRAWN_NOTE) -> tuple[str, ...]:
    """Ids for new notes, ``"n:1"``, ``"n:2"`` and so on; the same project gives the same ids."""
    last = max(
        (
            *(_number(note.id, prefix) for part in project.score.parts for note in part.notes),
            *(_number(id, prefix) for notes in project.read_notes.values() for id in notes),
            *(_named(correction, prefix) for corrections in project.corrections.values() for correction in corrections),
        ),
        default=0,
    )
    return tuple(f"{prefix}{last + index}" for index in range(1, count + 1))


def fresh_part_ids(project: Project, count: int = 1, prefix: str = MADE_PART) -> tuple[str, ...]:
    """Ids for new parts, ``"part:1"`` and so on."""
    return _following(prefix, (part.id for part in project.score.parts), count)


def fresh_player_ids(project: Project, count: int = 1) -> tuple[str, ...]:
    """Ids for new players, ``"player:1"`` and so on."""
    return _following("player:", (player.id for player in project.players), count)


def _following(prefix: str, ids: Iterable[str], count: int) -> tuple[str, ...]:
    last = max((_number(id, prefix) for id in ids), default=0)
    return tuple(f"{prefix}{last + index}" for index in range(1, count + 1))


def _number(id: str, prefix: str) -> int:
    digits = id[len(prefix) :]
    return int(digits) if id.startswith(prefix) and digits.isascii() and digits.isdigit() else 0


def _named(correction: Correction, prefix: str) -> int:
    """The highest number of a note made here that a correction names, in whatever field."""
    found = (
        _NUMBERED.search(value)
        for value in (getattr(correction, field) for field in correction.__struct_fields__)
        if isinstance(value, str)
    )
    return max((int(match.group(2)) for match in found if match and match.group(1) == prefix), default=0)
