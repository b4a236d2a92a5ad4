"""Synthetic takes of wind controllers, made note by note."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from app.score.take import Cleaning, ControllerMapping, Take
from app.score.tempo import TempoMap

PlayedNote = tuple[float, float, int, float]
"""Onset and end in seconds, pitch, and strength of the breath 0..1."""


def take_of(
    notes: Iterable[PlayedNote],
    *,
    id: str = "take:1",
    tempo_map: TempoMap | None = None,
    start_s: float = 0.0,
    end_s: float | None = None,
    cleaning: Cleaning | None = None,
    mapping: ControllerMapping | None = None,
    breathes: bool = True,
    more: Sequence[tuple[float, str]] = (),
    velocity: int = 90,
) -> Take:
    """Make a take in which each note has its own breath; the breath continues where notes touch or overlap."""
    notes = sorted(notes)
    events: list[tuple[float, int, str]] = [(time_s, 1, raw) for time_s, raw in more]
    for index, (onset_s, note_end_s, pitch, breath) in enumerate(notes):
        events.append((onset_s, 2, f"90{pitch:02x}{velocity:02x}"))
        events.append((note_end_s, 1, f"80{pitch:02x}00"))
        if breathes:
            events.append((onset_s, 0, f"b002{round(127 * breath):02x}"))
            if not any(other[0] <= note_end_s < other[1] for other in notes[index + 1 :]):
                events.append((note_end_s, 3, "b00200"))
    events.sort()
    last_s = max((event[0] for event in events), default=start_s)
    return Take(
        id=id,
        name="Take 1",
        colour="",
        device="EWI5000",
        recorded="2026-11-21T12:00:00+00:00",
        mapping=mapping or ControllerMapping(),
        cleaning=cleaning or Cleaning(),
        tempo_map=tempo_map or TempoMap(480),
        start_us=round(start_s * 1e6),
        end_us=round((last_s if end_s is None else end_s) * 1e6),
        times_us=tuple(round(event[0] * 1e6) for event in events),
        messages=tuple(event[2] for event in events),
    )
