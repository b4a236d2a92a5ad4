"""Ids of notes, parts, players, dancers and takes that do not come from a file.

Ids from a MIDI file are ``"track:number"`` (notes) and ``"track.channel.voice"`` (parts and their players), all digits.
Other ids begin with a word, so that they never coincide with ids from a file: notes added in the editor are ``"n:1"``
and so on, their parts ``"part:1"``; additions of a re-read file are ``"f:1"`` and ``"file:1"``. Each new number is
above all numbers in the project, including corrections without a note, so that such a correction can never apply to
another note. Notes of a take are ``"t:1000001"`` and so on, made of the numbers of the take and of the played note
(`take_note_id`); they stay the same when the take is cut or cleaned again.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import count, islice
from typing import Final

from app.plan.by_hand.corrections import Correction
from app.project.model import Project

DRAWN_NOTE: Final = "n:"
READ_NOTE: Final = "f:"
TAKE_NOTE: Final = "t:"
TAKE: Final = "take:"
MADE_PART: Final = "part:"
READ_PART: Final = "file:"

MOST_TAKE_NOTES: Final = 1_000_000
"""Greatest number of notes in a take; further notes are omitted."""

_NUMBERED = re.compile(r"(?:^|:)([nft]:)(\d+)$", re.ASCII)


def fresh_note_ids(project: Project, number: int, prefix: str = DRAWN_NOTE) -> tuple[str, ...]:
    """Return unused ids for ``number`` new notes, such as ``"n:1"``; equal projects give equal ids."""
    return tuple(islice(new_note_ids(project, prefix), number))


def new_note_ids(project: Project, prefix: str = DRAWN_NOTE) -> Iterator[str]:
    """Yield ids for new notes without end; no note has them and no correction refers to them."""
    last = max(
        (
            *(_number(note.id, prefix) for part in project.score.parts for note in part.notes),
            *(_number(id, prefix) for notes in project.read_notes.values() for id in notes),
            *(_named(correction, prefix) for corrections in project.corrections.values() for correction in corrections),
            *(_number(note.id, prefix) for recorded in project.takes.values() for note in recorded.before_notes),
        ),
        default=0,
    )
    return (f"{prefix}{number}" for number in count(last + 1))


def fresh_part_ids(project: Project, count: int = 1, prefix: str = MADE_PART) -> tuple[str, ...]:
    """Return ``count`` unused ids for new parts, such as ``"part:1"``."""
    return _following(prefix, (part.id for part in project.score.parts), count)


def fresh_player_ids(project: Project, count: int = 1) -> tuple[str, ...]:
    """Return ``count`` unused ids for new players, such as ``"player:1"``."""
    return _following("player:", _performers(project), count)


def fresh_dancer_ids(project: Project, count: int = 1) -> tuple[str, ...]:
    """Return ``count`` unused ids for new dancers, such as ``"dancer:1"``."""
    return _following("dancer:", _performers(project), count)


def _performers(project: Project) -> Iterator[str]:
    """Yield the ids of players and dancers, unique among both."""
    yield from (player.id for player in project.players)
    yield from (dancer.id for dancer in project.dancers)


def fresh_take_ids(project: Project, count: int = 1) -> tuple[str, ...]:
    """Return unused ids for new takes; a number is not reused while anything refers to a note of its take."""
    takes = (take.number for recorded in project.takes.values() for take in recorded.takes)
    (following,) = fresh_note_ids(project, 1, TAKE_NOTE)
    last = max((*takes, _number(following, TAKE_NOTE) // MOST_TAKE_NOTES), default=0)
    return tuple(f"{TAKE}{last + index}" for index in range(1, count + 1))


def take_note_id(take_number: int, index: int) -> str:
    """Return the id of a take's note, by its index among the played notes."""
    return f"{TAKE_NOTE}{take_number * MOST_TAKE_NOTES + index + 1}"


def is_made_here(note_id: str) -> bool:
    """Return whether a note was added or recorded in the editor instead of read from a file."""
    return note_id.startswith((DRAWN_NOTE, TAKE_NOTE))


def _following(prefix: str, ids: Iterable[str], count: int) -> tuple[str, ...]:
    last = max((_number(id, prefix) for id in ids), default=0)
    return tuple(f"{prefix}{last + index}" for index in range(1, count + 1))


def _number(id: str, prefix: str) -> int:
    digits = id[len(prefix) :]
    return int(digits) if id.startswith(prefix) and digits.isascii() and digits.isdigit() else 0


def _named(correction: Correction, prefix: str) -> int:
    """Return the highest number of a note id with a prefix that occurs in any field of a correction."""
    found = (
        _NUMBERED.search(value)
        for value in (getattr(correction, field) for field in correction.__struct_fields__)
        if isinstance(value, str)
    )
    return max((int(match.group(2)) for match in found if match and match.group(1) == prefix), default=0)
