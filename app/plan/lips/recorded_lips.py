"""Lips and cheeks within the notes, from controllers: air and strain follow the breath, tension follows bite and pitch
bend, so that a vibrato is visible at its own rate. Hairpins and sforzandi of a score are treated alike.

A note whose embouchure was set by hand keeps the set values throughout.
"""

from __future__ import annotations

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.plan.by_hand.corrections import Correction, SetEmbouchure
from app.plan.lips.embouchure import strain_of, tension_of
from app.plan.music.breath_controller import BreathEnvelope, step_means
from app.plan.music.piece import ControllerInput, ControllerSteps, LineTimes
from app.plan.sampled_lip_curves import SampledCurves
from app.score.model import Note
from app.score.tempo import TempoMap
from instrument_maps.model import InstrumentMap

STEP_S = 0.01
"""Step in seconds of the sampled traces: a seventh of a second, one cycle of vibrato, has fourteen."""
AROUND_S = 1.0
"""Seconds by which the traces extend beyond the line."""
AIR_S, EFFORT_S, SHIFT_S, LIPS_S = 0.08, 0.4, 0.12, 0.04
"""Averaging times in seconds: of the cheeks after the air, of effort, of the change between notes, and of vibrato."""
BITE_TENSION = 0.5
"""Additional tension from relaxed teeth to a full bite."""
BEND_TENSION, MOST_BEND_TENSION = 1.4, 0.3
"""Tension per whole tone of a small pitch bend (0.15 for a vibrato of 30 cents), and greatest additional tension."""


def plan_traces(
    *,
    notes: tuple[Note, ...],
    times: LineTimes,
    clock: TempoMap,
    instrument: InstrumentMap,
    embouchure_tension: float,
    controller: ControllerInput | None,
    envelope: BreathEnvelope | None,
    corrections: tuple[Correction, ...],
    recorded: bool = True,
) -> SampledCurves | None:
    """Return the curves of lips and air within the notes; None without notes or without data within them.

    Parameters
    ----------
    envelope : BreathEnvelope or None
        ``controller.breath`` in time, or the dynamics in the score.
    recorded : bool
        Whether a controller recorded any of the part.
    """
    if not notes or (controller is None and envelope is None):
        return None
    first = int(np.floor((times.onset_s[0] - AROUND_S) / STEP_S))
    count = int(np.ceil((times.played_end_s[-1] + AROUND_S) / STEP_S)) - first
    at_s: FloatArray = (first + np.arange(count, dtype=np.float64)) * STEP_S
    here = np.maximum(np.searchsorted(times.onset_s, at_s, side="right") - 1, 0)
    sounds = (at_s >= times.onset_s[here]) & (at_s < times.played_end_s[here])
    by_hand = [item for item in corrections if isinstance(item, SetEmbouchure)]
    set_spans = _spans(by_hand, notes, times, at_s)

    air = effort = None
    loudness = times.loudness[here]
    register = tension_of(times.pitch.astype(np.float64), instrument)
    if envelope is not None:
        curve = _clipped(envelope.mean(at_s - STEP_S / 2.0, at_s + STEP_S / 2.0))
        loudness = np.where(sounds & ~envelope.plays(times)[here], loudness, curve)
        air = np.where(sounds | envelope.has_breath_gaps(times), loudness, 0.0)
        effort = np.where(sounds, strain_of(register[here], loudness, times.duration_s[here])[1], 0.0)
        for item, span in set_spans:
            air[span] = air[span] if item.air is None else item.air
            effort[span] = effort[span] if item.effort is None else item.effort
        air, effort = _smooth(air, AIR_S), _smooth(effort, EFFORT_S)

    coming = np.maximum(np.searchsorted(times.onset_s, at_s + SHIFT_S / 2.0, side="right") - 1, 0)
    tension, _ = strain_of(register[coming], loudness, times.duration_s[coming])
    tension = _clipped(tension * embouchure_tension)
    lips = np.zeros(len(at_s))
    if controller is not None:
        lips = np.where(sounds, _pressed(controller, clock, at_s, sounds), 0.0)
    for item, span in set_spans:
        if item.tension is not None:
            tension[span], lips[span] = item.tension, 0.0
    tension = _clipped(_smooth(tension, SHIFT_S) + _smooth(lips, LIPS_S))
    return SampledCurves(first * STEP_S, STEP_S, tension, air, effort, recorded)


def _spans(
    by_hand: list[SetEmbouchure], notes: tuple[Note, ...], times: LineTimes, at_s: FloatArray
) -> list[tuple[SetEmbouchure, slice]]:
    """Return each embouchure set by hand with the range of samples ``at_s`` during its note."""
    if not by_hand:
        return []
    index_of = {note.id: index for index, note in enumerate(notes)}
    spans = []
    for item in by_hand:
        index = index_of.get(item.note_id)
        if index is not None:
            start, end = np.searchsorted(at_s, (times.onset_s[index], times.played_end_s[index])).tolist()
            spans.append((item, slice(start, end)))
    return spans


def _pressed(controller: ControllerInput, clock: TempoMap, at_s: FloatArray, sounds: BoolArray) -> FloatArray:
    """Return the lip tension (N,) added by a wind controller's bite and pitch bend at the times ``at_s``; the bite
    counts from its usual value."""
    bite = bend = np.zeros(len(at_s))
    if controller.bite is not None:
        bite = _sampled(controller.bite, clock, at_s)
        bite = bite - (np.median(bite[sounds]) if sounds.any() else 0.0)
    if controller.bend is not None:
        bend = _sampled(controller.bend, clock, at_s)
    return pressed_by(bite, bend)


def pressed_by(bite: FloatArray, bend: FloatArray) -> FloatArray:
    """Tension added by a bite above the usual one (0..1) and a pitch bend in whole tones."""
    pressed: FloatArray = BITE_TENSION * bite + MOST_BEND_TENSION * np.tanh(BEND_TENSION / MOST_BEND_TENSION * bend)
    return pressed


def _sampled(steps: ControllerSteps, clock: TempoMap, at_s: FloatArray) -> FloatArray:
    return step_means(clock.seconds(steps.ticks), steps.values, at_s - STEP_S / 2.0, at_s + STEP_S / 2.0)


def _smooth(values: FloatArray, width_s: float) -> FloatArray:
    """Smooth values by a bell-shaped window of this width; the end values extend outwards."""
    reach = max(round(width_s / STEP_S / 2.0), 1)
    window = np.hanning(2 * reach + 3)[1:-1]
    padded = np.pad(values, reach, mode="edge")
    return np.asarray(np.convolve(padded, window / window.sum(), mode="valid"), dtype=np.float64)


def _clipped(values: FloatArray) -> FloatArray:
    return np.clip(values, 0.0, 1.0)
