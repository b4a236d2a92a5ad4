"""Spans played with a mute or with the hand in the bell, from the part's program, its name, or texts of the track.

A muted note stays with the same player; muting is a technique, stored as spans of ticks.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Collection, Sequence
from typing import Final, Literal, NamedTuple, TypeAlias, get_args

from app.score.limits import MOST_NAME
from app.score.tracks import TrackEvents
from instrument_maps.instrument_names import vocabulary
from instrument_maps.instruments import Instrument

MUTED_TRUMPET: Final = 59
"""General MIDI's only program of a muted wind instrument."""

_MUTE: Final = r"(?:sord(?:\.|in[oai]?|ine)?|mutes?|muted|dämpfern?|d[äa]mpfer|sourdines?|surdinas?|ミュート|弱音器)"
_ON: Final = re.compile(
    rf"(?:.*\b)?(?:con|with|mit|avec|com|add|put on)\s+(?:(?:a|the|la|il)\s+)?(?:\w+\s+)?{_MUTE}\b.*"
    r"|(?:(?:cup|straight|harmon|wah[- ]?wah|plunger|bucket|practice|stop|solotone|pixie|hat|カップ|ストレート"
    rf"|ハー[マモ]ン|プランジャー|バケット|ハット)[\s・]*)?{_MUTE}"
    r"(?:\s+(?:on|in)|\s*(?:付き|つき|装着|あり))?"
    r"|harmon(?:\s*,?\s*stem\s+(?:in|out|half))?|plunger|(?:straight|cup|bucket)|in\s+(?:cup|straight|harmon|bucket|plunger|hat)"
    r"|(?:c\.|m\.)\s*(?:sord|d)\.?",
    re.IGNORECASE,
)
_HAND: Final = re.compile(
    r"gestopft|gest\.?|stopped|hand[- ]?stopped|bouch[ée]|chiuso|chius[ae]|ゲシュトップ|ストップ奏法", re.IGNORECASE
)
STOPPED_SIGN: Final = "+"
"""Sign of a stopped note, which applies to the notes that begin at it."""
OPEN_SIGN: Final = "o"
"""Sign that ends stopping in some scores."""
_OFF: Final = re.compile(
    r"(?:.*\b)?(?:senza|without|no|ohne|sans|sem|sin|remove|take off|via|ôtez|enlevez)\s+"
    rf"(?:(?:the|la|le|les|il)\s+)?{_MUTE}.*"
    rf"|{_MUTE}\s*(?:off|ab|weg|なし|を?(?:外|はず)す|取る)"
    r"|s\.\s*sord\.?|o\.\s*d\.?|open|unmuted|offen|aperto|ouvert|naturale?|nat\.|オープン",
    re.IGNORECASE,
)
_IN_NAME: Final = re.compile(
    rf"\b(?:(?:con|with|mit|avec|com)\s+(?:\w+\s+)?{_MUTE}|muted|c\.\s*sord)|ミュート|弱音器", re.IGNORECASE
)

Span = tuple[int, int]
Change = tuple[int, str]
"""Tick, and kind of the mute used from there on, as in `NAMED`; ``mute`` for an unknown kind."""
MuteName: TypeAlias = Literal["straight", "cup", "harmon", "plunger", "bucket", "hat", "practice", "solotone"]
NAMED: Final[tuple[MuteName, ...]] = get_args(MuteName)
"""Kinds of mutes that scores name."""
How: TypeAlias = Literal["open", "mute", "hand"] | MuteName
_NAMES: Final[dict[str, MuteName]] = {
    **{name: name for name in NAMED},
    "wah": "harmon",
    "wah-wah": "harmon",
    "wahwah": "harmon",
    "カップ": "cup",
    "ストレート": "straight",
    "ハーマン": "harmon",
    "ハーモン": "harmon",
    "プランジャー": "plunger",
    "バケット": "bucket",
    "ハット": "hat",
}
_NAME: Final = re.compile("|".join(sorted(_NAMES, key=len, reverse=True)), re.IGNORECASE)


def takes_mutes(instrument: Instrument | None) -> bool:
    """Return whether an instrument is a brass instrument, for which mutes and hand stopping are read."""
    return instrument is not None and instrument.family in _muted_families()


def _muted_families() -> set[str]:
    return {family for one in vocabulary().instruments.values() if one.any_pitch for family in _sections(one)}


def sounds_of(programs: Sequence[tuple[int, int]], named: Instrument | None = None) -> list[tuple[int, int]]:
    """Drop General MIDI's muted trumpet from a player's program changes (tick, program) if other changes or the name
    give another brass instrument, since notation programs use that sound for muted horns and trombones too.
    """
    known = vocabulary()
    brass = _muted_families()
    others = [known.by_program(program) for _, program in programs if program != MUTED_TRUMPET]
    if any(one is not None and one.family in brass for one in (named, *others)):
        return [row for row in programs if row[1] != MUTED_TRUMPET]
    return list(programs)


def _sections(section: Instrument) -> tuple[str, ...]:
    """Families of a section that includes the muted trumpet (brass); empty for other sections."""
    muted = vocabulary().by_program(MUTED_TRUMPET)
    return section.families if muted is not None and muted.family in section.families else ()


class Mutes(NamedTuple):
    """Muted passages of a player: spans of ticks (first onset, last end) played with a mute, the hand-stopped ones
    among them, and the changes (tick, kind) of the kind of mute.
    """

    muted: tuple[Span, ...] = ()
    stopped: tuple[Span, ...] = ()
    mute_kinds: tuple[Change, ...] = ()


def mutes_of(events: TrackEvents, channels: Collection[int], name: str, texts: Sequence[tuple[int, str]]) -> Mutes:
    """Spans of ticks in which the notes of some channels are played with a mute, or stopped.

    Parameters
    ----------
    name : str
        Name of the track.
    texts : sequence of (tick, text)
        Texts of the track for the player of these channels.
    """
    always: How = named_mute(name) if _IN_NAME.search(name) is not None else "open"
    said = [(tick, how) for tick, text in sorted(texts) if (how := said_of_mute(text)) is not None]
    signed = {tick for tick, text in texts if text.strip() == STOPPED_SIGN}
    sounds = {program for channel in channels for _, program in events.programs.get(channel, [])}
    if not (always != "open" or said or signed or MUTED_TRUMPET in sounds):
        return Mutes()
    at = [tick for tick, _ in said]
    rows: list[tuple[int, int, How]] = []
    for channel in channels:
        notes = events.channels[channel]
        programs = sorted(events.programs.get(channel, []))
        ticks = [tick for tick, _ in programs]
        for onset, end in zip(notes.onset_ticks, notes.end_ticks, strict=True):
            program, word = bisect_right(ticks, onset), bisect_right(at, onset)
            how = said[word - 1][1] if word else always
            if onset in signed:
                how = "hand"
            elif program and programs[program - 1][1] == MUTED_TRUMPET:
                how = how if how in NAMED else "mute"
            rows.append((onset, end, how))
    rows.sort()
    return mutes_in(rows)


def mutes_in(rows: Sequence[tuple[int, int, How]]) -> Mutes:
    """Collect the muted passages from notes (onset, end, way of playing), ordered by onset."""
    changes: list[Change] = []
    for onset, _, how in rows:
        if how not in ("open", "hand") and how != (changes[-1][1] if changes else "mute"):
            changes.append((onset, how))
    return Mutes(joined_spans(rows, ("mute", "hand", *NAMED)), joined_spans(rows, ("hand",)), tuple(changes))


def named_mute(text: str) -> How:
    """Return the kind of mute that a text names; ``mute`` if it names none."""
    found = _NAME.search(text)
    return "mute" if found is None else _NAMES[found[0].lower().replace(" ", "-")]


def mute_at(changes: Sequence[Change], tick: int) -> str:
    """Return the kind of mute in use at a tick, from the changes (tick, kind) in order."""
    place = bisect_right(changes, tick, key=lambda change: change[0])
    return changes[place - 1][1] if place else "mute"


def joined_spans(rows: Sequence[tuple[int, int, How]], ways: Collection[str]) -> tuple[Span, ...]:
    """Join consecutive notes that are played in one of the given ``ways`` to spans of ticks."""
    spans: list[Span] = []
    before = False
    for onset, end, how in rows:
        within = how in ways
        if within and before:
            spans[-1] = spans[-1][0], max(spans[-1][1], end)
        elif within:
            spans.append((onset, end))
        before = within
    return tuple(spans)


def is_muted(spans: Sequence[Span], tick: int) -> bool:
    """Return whether a note that begins at a tick is played with a mute."""
    place = bisect_right(spans, tick, key=lambda span: span[0])
    return bool(place) and tick < spans[place - 1][1]


def said_of_mute(text: str) -> How | None:
    """Interpret a text about mutes: the kind of mute to insert, hand stopping, or the end of either; None for other
    texts.
    """
    words = " ".join(text[:MOST_NAME].split()).strip("()[]")
    if _OFF.fullmatch(words):
        return "open"
    if _HAND.fullmatch(words):
        return "hand"
    return named_mute(words) if _ON.fullmatch(words) else None
