"""Scoops and falls: pitch bends into the start of a note or away at its end.

They count as articulations: pitch, fingering and player of the note do not change.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from app.plan.music.piece import ControllerSteps
from app.score.marks import Mark
from app.score.model import Note
from app.score.tempo import TempoMap

WRITTEN_BENDS: Final = {"scoop": -1.0, "plop": 1.0, "fall": -1.5, "doit": 1.5}
"""Size of written bends in whole tones: into the start of a note, and away at its end."""
_INTO: Final = ("scoop", "plop")
_INTO_S, _AWAY_S = 0.15, 0.35
"""Seconds of bends into and away from a note, at most half of the note."""
_STEPS: Final = 8
LEAST_BEND: Final = 0.3
"""Least difference in whole tones between a note's end and middle for a bend: 60 cents, twice a wide vibrato."""


def bends(notes: Sequence[Note], bend: ControllerSteps | None) -> list[tuple[str, ...]]:
    """Recognise the bends of each note: ``scoop`` (into its start from below), ``plop`` (from above), ``fall`` (down at
    its end) or ``doit`` (up at its end).

    Parameters
    ----------
    notes : sequence of Note
        The notes by onset.
    bend : ControllerSteps or None
        Pitch bend in whole tones.
    """
    if bend is None:
        return [()] * len(notes)
    onsets = [note.onset_tick for note in notes]
    return [
        _of_note(bend, note.onset_tick, min(note.onset_tick + note.duration_tick, following))
        for note, following in zip(notes, [*onsets[1:], np.inf], strict=True)
    ]


def _of_note(bend: ControllerSteps, onset_tick: float, end_tick: float) -> tuple[str, ...]:
    first = int(np.searchsorted(bend.ticks, onset_tick, side="right"))
    stop = int(np.searchsorted(bend.ticks, end_tick, side="left"))
    if stop <= first:
        return ()
    values = np.append(bend.values[first - 1] if first else 0.0, bend.values[first:stop])
    lengths = np.diff(np.concatenate(([onset_tick], bend.ticks[first:stop], [end_tick])))
    order = np.argsort(values, kind="stable")
    middle = values[order][np.searchsorted(np.cumsum(lengths[order]), 0.5 * lengths.sum())]
    start, end = float(values[0] - middle), float(values[-1] - middle)
    before = ("scoop",) if start <= -LEAST_BEND else ("plop",) if start >= LEAST_BEND else ()
    after = ("fall",) if end <= -LEAST_BEND else ("doit",) if end >= LEAST_BEND else ()
    # A slide through a whole note either leaves its pitch or arrives at it, not both.
    if before and after and start * end < 0.0:
        if abs(float(values[0])) < LEAST_BEND <= abs(float(values[-1])):
            return after
        if abs(float(values[-1])) < LEAST_BEND <= abs(float(values[0])):
            return before
    return before + after


def written_bends(notes: Sequence[Note], marks: Sequence[Mark], clock: TempoMap) -> ControllerSteps | None:
    """Convert the marks for bends in a score to a curve of pitch bend in whole tones; None if there are no
    such marks.
    """
    kinds: dict[str, set[str]] = {}
    for mark in marks:
        if mark.kind in WRITTEN_BENDS:
            kinds.setdefault(mark.note_id, set()).add(mark.kind)
    if not kinds or not notes:
        return None
    onsets = [note.onset_tick for note in notes]
    steps = {0.0: 0.0}
    for note, following in zip(notes, [*onsets[1:], np.inf], strict=True):
        start_s, end_s = (clock.seconds(float(at)) for at in (
            note.onset_tick, min(note.onset_tick + note.duration_tick, following)))  # fmt: skip
        steps[float(note.onset_tick)] = 0.0
        for kind in sorted(kinds.get(note.id, ())):
            into = kind in _INTO
            length_s = min(_INTO_S if into else _AWAY_S, (end_s - start_s) / 2.0)
            begins_s = start_s if into else end_s - length_s
            for step in range(_STEPS):
                share = 1.0 - step / _STEPS if into else (step + 1) / _STEPS
                steps[float(clock.ticks(begins_s + length_s * step / _STEPS))] = WRITTEN_BENDS[kind] * share
            if into:
                steps[float(clock.ticks(begins_s + length_s))] = 0.0
    ticks = np.array(sorted(steps), np.float64)
    return ControllerSteps(ticks, np.array([steps[tick] for tick in ticks.tolist()]))
