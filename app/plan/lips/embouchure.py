"""Embouchure of each note (T5 of the thesis: tense lips for high notes, relaxed ones for low notes). The tongue is in
`app.plan.lips.tonguing`.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from app.arrays import FloatArray
from app.errors import Message
from app.plan.model import EmbouchureEvent
from app.plan.music.piece import MEZZOFORTE, LineTimes
from app.score.model import Note
from instrument_maps.model import InstrumentMap

EASY_TENSION = (0.3, 0.6)
"""Tension at the two ends of the easy range; at the ends of the full range it is 0 and 1."""
LOUD_TENSION = 0.15
"""Rise of the tension from mezzoforte to the loudest."""
LONG_S = 6.0
"""Length in seconds of a note with the greatest effort."""


def tension_of(pitch: FloatArray, instrument: InstrumentMap) -> FloatArray:
    """Lip tension (N,) 0..1 by pitch alone: piecewise linear over the instrument's usual range."""
    limits = instrument.range
    low, high = limits.usual
    knots = np.array([low, limits.easy_low, limits.easy_high, high], dtype=np.float64)
    # A map whose easy range equals its range has equal knots, at which np.interp would jump; a semitone keeps them
    # apart.
    knots = np.maximum.accumulate(knots + np.array([-0.03, -0.02, 0.02, 0.03]))
    return np.interp(pitch, knots, [0.0, EASY_TENSION[0], EASY_TENSION[1], 1.0])


def strain_of(register: FloatArray, loudness: FloatArray, length_s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return lip tension (before the player's factor) and effort, 0..1 each, of notes. ``register`` is the tension by
    pitch from `tension_of`; ``loudness`` is 0..1.
    """
    loud = np.clip((loudness - MEZZOFORTE) / (1.0 - MEZZOFORTE), 0.0, 1.0)
    high = np.clip((register - EASY_TENSION[1]) / (1.0 - EASY_TENSION[1]), 0.0, 1.0)
    long = np.clip(length_s / LONG_S, 0.0, 1.0)
    # Independent strains combine as shares of what the others leave.
    effort = 1.0 - (1.0 - 0.75 * high) * (1.0 - 0.5 * loud) * (1.0 - 0.35 * long)
    return register + LOUD_TENSION * loud, np.clip(effort + 0.05 * register, 0.0, 1.0)


def plan_embouchures(
    notes: tuple[Note, ...],
    times: LineTimes,
    instrument: InstrumentMap,
    embouchure_tension: float,
    early_end_s: dict[int, float],
    from_breath: bool,
) -> tuple[EmbouchureEvent, ...]:
    """Plan an embouchure for every note.

    ``tension`` follows pitch and a little loudness, scaled by ``embouchure_tension``; ``air`` is the loudness;
    ``effort`` combines height above the easy range, loudness above mezzoforte, and length.

    Parameters
    ----------
    early_end_s : dict of int to float
        Time at which the lips leave a note early for a catch breath, by note index.
    from_breath : bool
        Whether the loudness is the mean of a recorded curve, which the lips follow within the note
        (`app.plan.lips.recorded_lips`).
    """
    if not notes:
        return ()
    register = tension_of(times.pitch.astype(np.float64), instrument)
    tension, effort = strain_of(register, times.loudness, times.duration_s)
    tension = np.clip(tension * embouchure_tension, 0.0, 1.0)
    low, top = instrument.range.low, instrument.range.high
    reported = "embouchure.controller" if from_breath else "embouchure.register"
    known: dict[float, float] = {}
    """Equal values are kept once."""
    once = known.setdefault
    events = []
    rows = zip(
        notes, times.onset_s.tolist(), times.played_end_s.tolist(), times.pitch.tolist(),
        np.round(times.loudness, 2).tolist(), np.round(tension, 4).tolist(), np.round(effort, 4).tolist(),
        np.round(times.loudness, 4).tolist(), strict=True,
    )  # fmt: skip
    for index, (note, start_s, end_s, midi, loudness, tight, strain, air) in enumerate(rows):
        reason = _reason(reported, midi, low, top, loudness)
        end_s = early_end_s.get(index, end_s)
        tight, strain, air = once(tight, tight), once(strain, strain), once(air, air)
        events.append(EmbouchureEvent(note.id, start_s, end_s, tight, strain, air, reason))
    return tuple(events)


@lru_cache(maxsize=8192)
def _reason(reported: str, pitch: int, low: int, high: int, loudness: float) -> Message:
    """Return the message that explains an embouchure, cached so that equal ones are one object."""
    return Message(reported, {"pitch": pitch, "low": low, "high": high, "loudness": loudness})


def efforts_of(embouchures: tuple[EmbouchureEvent, ...]) -> FloatArray:
    """Return the effort (N,) of each note, 0..1."""
    return np.array([event.effort for event in embouchures], np.float64)
