"""Written loudness changes within notes: hairpins, and the decay after a sforzando."""

from __future__ import annotations

from typing import Final

import numpy as np

from app.plan.music.breath_controller import BreathEnvelope
from app.plan.music.piece import LineTimes
from app.plan.music.written_dynamics import (
    LOUDER_ROWS,
    loudness_of_rows,
    rows_of_loudness,
    struck_notes,
    written_dynamics,
)
from app.score.marks import Mark, Source
from app.score.tempo import TempoMap

STEP_S: Final = 0.05
"""Step in seconds of a loudness that changes within a note."""
ATTACK_S, FALL_S = 0.15, 0.25
"""Seconds for which a sforzando stays at its loudest, and in which it decreases to the current dynamic."""


def dynamics_within(
    times: LineTimes, marks: tuple[Mark, ...], source: Source, clock: TempoMap
) -> BreathEnvelope | None:
    """Compute the loudness of a part over time, also within notes, from written dynamics and hairpins.

    Returns
    -------
    BreathEnvelope or None
        The curve, without gaps; None if no note changes its loudness.
    """
    written = written_dynamics(marks, source, clock.ticks_per_quarter)
    if not len(times.onset_tick) or not (len(written.ticks) > 1 or written.swells or written.struck):
        return None
    counts = np.maximum(np.ceil(times.duration_s / STEP_S), 1.0).astype(np.int64)
    firsts = np.cumsum(counts) - counts
    note = np.repeat(np.arange(len(counts)), counts)
    step_s = times.duration_s[note] / counts[note]
    since_s = (np.arange(len(note)) - firsts[note]) * step_s
    ticks = np.asarray(clock.ticks(times.onset_s[note] + since_s + step_s / 2.0), np.float64)
    begins = rows_of_loudness(times.loudness)
    struck = np.zeros(len(counts), dtype=bool)
    struck[struck_notes(times.onset_tick, written, clock.ticks_per_quarter)] = True
    heard = begins - LOUDER_ROWS * struck - written.swell_at(times.onset_tick.astype(np.float64))
    rows = written.rows_at(ticks)
    rows = np.where(np.isnan(rows), heard[note] + written.swell_at(ticks), rows)
    # The effect of an accent fades to zero.
    left = np.clip((ATTACK_S + FALL_S - since_s) / FALL_S, 0.0, 1.0) * struck[note]
    rows += left * (begins[note] - rows)
    moving = np.maximum.reduceat(rows, firsts) - np.minimum.reduceat(rows, firsts) > 1e-6
    if not moving.any():
        return None
    loudness = np.where(moving[note], loudness_of_rows(rows), times.loudness[note])
    return BreathEnvelope(times.onset_s[note] + since_s, loudness, np.empty((0, 2)))
