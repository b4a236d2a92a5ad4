"""Words over a staff of several players that give the music to one of them: "1. Solo", "2.", "a2", "tutti".

After such a number one player plays until the next word or until notes overlap again; the others rest.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

import msgspec

from app.score.limits import MOST_NAME
from app.score.model import Note

_NUMBER: Final = r"(?:(?P<number>[1-4]|IV|I{1,3})(?:\s*(?:st|nd|rd|th|er|e|[.°oº])))"
_ONE: Final = r"(?:solo|only|alone|allein|seul|player|ソロ)"
_SOLO: Final = re.compile(
    rf"{_NUMBER}(?:\s*{_ONE})?|{_ONE}(?:\s*(?P<after>[1-4]|IV|I{{1,3}})\.?)?|(?P<plain>[1-4]|IV|I{{1,3}})\s*{_ONE}",
    re.IGNORECASE,
)
_ALL: Final = re.compile(
    r"(?:a|à|zu)\s?[2-4]\.?|unis\.?|unison[oi]?|tutti|tous|alle|both|div\.?|divisi|soli|gli altri|全員|両方|"
    r"[1-4]\.\s?[,+&]?\s?[2-4]\.?",
    re.IGNORECASE,
)
_NUMERALS: Final = ("I", "II", "III", "IV")
_LEGATO_SHARE: Final = 0.5
"""Greatest overlap of two notes of a line, as a share of the shorter one."""

Word = tuple[int, int]
"""Tick, and number (from 1) of the player who plays alone from there on; 0 for all."""


def words_of_players(texts: Sequence[tuple[int, str]]) -> tuple[Word, ...]:
    """Find the texts of a track that say which players play ("1. Solo", "a2", "tutti"), in order of ticks."""
    return tuple(sorted((tick, who) for tick, text in texts if (who := _says(text)) is not None))


def _says(text: str) -> int | None:
    """Return the number of the player that a text names, 0 if it names all players, None if it is about
    something else.
    """
    words = " ".join(text[:MOST_NAME].split()).strip("()[]")
    if _ALL.fullmatch(words):
        return 0
    found = _SOLO.fullmatch(words)
    if not found:
        return None
    number = next(filter(None, found.groups()), "1").upper()
    return _NUMERALS.index(number) + 1 if number in _NUMERALS else int(number)


def solo_notes(notes: Sequence[Note], words: Sequence[Word]) -> dict[str, int]:
    """Find the notes that only one player plays, and that player's number from 1, by note id.

    Parameters
    ----------
    notes : sequence of Note
        Notes of all players of a staff, by onset, without duplicates.
    """
    alone: dict[str, int] = {}
    ends = [*(tick for tick, _ in words[1:]), None]
    for (start, who), end in zip(words, ends, strict=True):
        own = [note for note in notes if start <= note.onset_tick and (end is None or note.onset_tick < end)]
        for place, note in enumerate(own if who else ()):
            following = own[place + 1] if place + 1 < len(own) else None
            if following is not None and _together(note, following):
                break
            alone[note.id] = who
    return alone


def _together(one: Note, other: Note) -> bool:
    least = min(one.duration_tick, other.duration_tick)
    return one.end_tick - other.onset_tick > _LEGATO_SHARE * least


def with_solos(
    voices: Sequence[tuple[Note, ...]], alone: dict[str, int], original: dict[str, str]
) -> list[tuple[Note, ...]]:
    """Move the notes that one player has alone to that player's voice, and remove them from the other voices.

    Parameters
    ----------
    alone : dict of note id to player
        Player of each solo note, from 1; numbers beyond the voices are ignored.
    original : dict of note id to note id
        Id in the file of each note played in unison.
    """
    there = {id: who for id, who in alone.items() if who <= len(voices)}
    own: list[list[Note]] = [
        [note for note in voice if original.get(note.id, note.id) not in there] for voice in voices
    ]
    given = set()
    for voice in voices:
        for note in voice:
            id = original.get(note.id, note.id)
            if id in there and id not in given:
                given.add(id)
                own[there[id] - 1].append(msgspec.structs.replace(note, id=id))
    return [tuple(sorted(notes, key=lambda note: (note.onset_tick, note.pitch))) for notes in own if notes]
