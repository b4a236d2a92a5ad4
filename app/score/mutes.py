"""Where a part is played with a mute: by its program, its name, or what the track says on the way.

A muted note is played by the same player; the mute is a technique, kept in spans of ticks.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Collection, Sequence
from typing import Final

from app.score.limits import MOST_NAME
from app.score.tracks import TrackEvents

MUTED_TRUMPET: Final = 59
"""The one muted sound of General MIDI's wind programs."""

_MUTE: Final = r"(?:sord(?:\.|in[oai]?|ine)?|mutes?|muted|dämpfern?|d[äa]mpfer|sourdines?|surdinas?|ミュート|弱音器)"
_ON: Final = re.compile(
    rf"(?:.*\b)?(?:con|with|mit|avec|com|add|put on)\s+(?:(?:a|the|la|il)\s+)?(?:\w+\s+)?{_MUTE}\b.*"
    rf"|(?:(?:cup|straight|harmon|wah[- ]?wah|plunger|bucket|practice)\s+)?{_MUTE}(?:\s+on|\s*(?:付き|つき|装着|あり))?"
    r"|(?:c\.|m\.)\s*(?:sord|d)\.?|gestopft|gest\.?|stopped|bouch[ée]|chiuso|ゲシュトップ|ストップ奏法",
    re.IGNORECASE,
)
_OFF: Final = re.compile(
    r"(?:.*\b)?(?:senza|without|no|ohne|sans|sem|sin|remove|take off|via|ôtez|enlevez)\s+"
    rf"(?:(?:the|la|le|les|il)\s+)?{_MUTE}.*"
    rf"|{_MUTE}\s*(?:off|ab|weg|なし|を?(?:外|はず)す|取る)"
    r"|s\.\s*sord\.?|o\.\s*d\.?|open|unmuted|offen|aperto|ouvert|naturale?|nat\.|オープン",
    re.IGNORECASE,
)
_IN_NAME: Final = re.compile(
    rf"\b(?:(?:con|with|mit|avec|com)\s+{_MUTE}|muted|c\.\s*sord)|ミュート|弱音器", re.IGNORECASE
)

Span = tuple[int, int]


def muted_spans(
    events: TrackEvents, channels: Collection[int], name: str, texts: Sequence[tuple[int, str]]
) -> tuple[Span, ...]:
    """Spans (first onset, last end) of ticks in which the notes of some channels are played with a mute, in order.

    Parameters
    ----------
    name : str
        Of the track.
    texts : sequence of (tick, text)
        What the track says to the player of these channels.
    """
    always = _IN_NAME.search(name) is not None
    said = [(tick, on) for tick, text in sorted(texts) if (on := _says(text)) is not None]
    sounds = {program for channel in channels for _, program in events.programs.get(channel, [])}
    if not (always or said or MUTED_TRUMPET in sounds):
        return ()
    at = [tick for tick, _ in said]
    rows: list[tuple[int, int, bool]] = []
    for channel in channels:
        notes = events.channels[channel]
        programs = sorted(events.programs.get(channel, []))
        ticks = [tick for tick, _ in programs]
        for onset, end in zip(notes.onset_ticks, notes.end_ticks, strict=True):
            program, word = bisect_right(ticks, onset), bisect_right(at, onset)
            by_program = bool(program) and programs[program - 1][1] == MUTED_TRUMPET
            rows.append((onset, end, by_program or (said[word - 1][1] if word else always)))
    spans: list[Span] = []
    before = False
    for onset, end, muted in sorted(rows):
        if muted and before:
            spans[-1] = spans[-1][0], max(spans[-1][1], end)
        elif muted:
            spans.append((onset, end))
        before = muted
    return tuple(spans)


def is_muted(spans: Sequence[Span], tick: int) -> bool:
    """Whether a note that begins at a tick is played with a mute."""
    place = bisect_right(spans, tick, key=lambda span: span[0])
    return bool(place) and tick < spans[place - 1][1]


def _says(text: str) -> bool | None:
    """Whether a text puts a mute in (True) or takes it out (False); None: it speaks of something else."""
    words = " ".join(text[:MOST_NAME].split()).strip("()[]")
    if _OFF.fullmatch(words):
        return False
    return True if _ON.fullmatch(words) else None
