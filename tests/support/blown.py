"""Takes of a synthetic wind player with known breaths, dynamics and vibrato.

No recording of the user: a breath sensor is modelled as a rise of some milliseconds to the dynamics asked for, noise of
a step or two, and a fall to zero, sent at a controller's rate as steps of 1/127.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.score.model import ControllerCurve, CurveKind, Note, Part
from app.score.tempo import TempoChange, TempoMap

TICKS_PER_S = 960.0
"""Ticks per second at 120 quarters per minute and 480 ticks per quarter."""
TEMPO = TempoMap(480, (TempoChange(0, 500_000.0),))

Dynamics = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class Blow:
    """Air from one time to another; ``dynamics`` is a function of the seconds since its start."""

    start_s: float
    end_s: float
    dynamics: Dynamics = lambda s: np.full(len(s), 0.6)


def ticks(seconds: float) -> int:
    """Whole ticks."""
    return round(seconds * TICKS_PER_S)


def breath_curve(
    blows: Sequence[Blow], rate_hz: float = 200.0, rise_s: float = 0.02, noise: int = 1, seed: int = 1
) -> ControllerCurve:
    """Curve of a breath sensor: 0 between blows, otherwise with noise of ``noise`` steps of 127."""
    chance = np.random.default_rng(seed)
    at = np.arange(0.0, max(blow.end_s for blow in blows) + 0.5, 1.0 / rate_hz)
    value = np.zeros(len(at))
    for blow in blows:
        here = (at >= blow.start_s) & (at < blow.end_s)
        since, left = at[here] - blow.start_s, blow.end_s - at[here]
        value[here] = blow.dynamics(since) * np.minimum(1.0, np.minimum(since + 1e-3, left) / rise_s)
    steps = np.round(127 * value) + chance.integers(-noise, noise + 1, len(at))
    return _curve("breath", at, np.clip(steps, 0, 127) / 127)


def vibrato_curve(
    start_s: float, end_s: float, depth: float, rate_hz: float, kind: CurveKind = "pitch_bend", middle: float = 0.0
) -> ControllerCurve:
    """Vibrato on pitch bend or bite from one time to another."""
    at = np.arange(0.0, end_s + 0.5, 0.005)
    inside = (at >= start_s) & (at < end_s)
    return _curve(kind, at, np.where(inside, middle + depth * np.sin(2 * np.pi * rate_hz * (at - start_s)), middle))


def _curve(kind: CurveKind, at: FloatArray, values: FloatArray) -> ControllerCurve:
    changed = np.flatnonzero(np.diff(values, prepend=np.nan) != 0.0)
    places = np.round(at[changed] * TICKS_PER_S).astype(int).tolist()
    return ControllerCurve(kind, tuple(places), tuple(values[changed].tolist()))


def take(
    notes: Sequence[tuple[float, float, int]], *curves: ControllerCurve, map_id: str = "trumpet_Bb", velocity: int = 80
) -> Part:
    """Make a part from notes (onset, end, pitch) in seconds, all with the same velocity as a wind controller sends."""
    made = tuple(
        Note(f"1:{number}", ticks(onset), ticks(end) - ticks(onset), pitch, velocity)
        for number, (onset, end, pitch) in enumerate(notes, 1)
    )
    return Part("1.1.1", "Trumpet", 0, 0, 0, 56, "trumpet", map_id, made, curves)
