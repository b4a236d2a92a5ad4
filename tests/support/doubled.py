"""A small piece in which one musician changes to a second instrument and back."""

from __future__ import annotations

from app.project.model import Project, project_from_score
from app.score.model import MOST_VOICES, Note, Part, Score
from app.score.tempo import TempoMap
from instrument_maps.load import bundled_maps

QUARTER = 480
BAR_S = 2.0
"""Length in seconds of a bar of four quarters at the default tempo."""


def notes(track: int, first: int, bars: tuple[int, ...], pitches: tuple[int, ...]) -> tuple[Note, ...]:
    """Four quarters in each of some bars, numbered from ``first``."""
    ticks = [(4 * bar + beat) * QUARTER for bar in bars for beat in range(4)]
    return tuple(
        Note(f"{track}:{first + index}", tick, QUARTER - 40, pitches[index % len(pitches)], 80)
        for index, tick in enumerate(ticks)
    )


def part(map_id: str, name: str, change: int, played: tuple[Note, ...], track: int = 1) -> Part:
    """Part of a track for its first instrument, or for the instrument after change number ``change``."""
    voice = change * MOST_VOICES
    return Part(f"{track + 1}.1.{voice + 1}", name, track, voice, 0, None, map_id, map_id, played)


def flutist(rest_bars: int = 2, beside: bool = True) -> Project:
    """Flute, piccolo and flute again for a bar each, separated by rests, and an oboe that plays continuously."""
    back = 2 + 2 * rest_bars
    flute = (*notes(1, 1, (0,), (72, 76, 79, 74)), *notes(1, 5, (back,), (77, 72)))
    piccolo = notes(1, 9, (1 + rest_bars,), (86, 88, 91, 93))
    parts = [part("flute", "Flute", 0, flute), part("piccolo", "Piccolo", 1, piccolo)]
    if beside:
        parts.append(part("oboe", "Oboe", 0, notes(2, 1, tuple(range(back + 1)), (67, 69, 71)), track=2))
    score = Score("Changes", QUARTER, TempoMap(QUARTER), parts=tuple(parts))
    return project_from_score(score, bundled_maps())
