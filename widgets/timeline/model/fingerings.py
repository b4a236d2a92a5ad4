"""A plan's fingerings for drawing: pressed controls and slide positions, as arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.plan.model import FingeringEvent, PlayerPlan
from instrument_maps.model import Control, InstrumentMap
from widgets.timeline.model.geometry import TimeSpans


@dataclass(frozen=True)
class Fingerings:
    """A plan's fingerings as arrays (N,): pressed controls and slide positions.

    ``pressed`` has a row for every pressable control, ``slides`` for every slide, with values 0..1.
    """

    events: tuple[FingeringEvent, ...]
    start_s: FloatArray
    end_s: FloatArray
    pressed: FloatArray
    slides: FloatArray
    spans: TimeSpans


def fingerings(plan: PlayerPlan, pressable: tuple[Control, ...], slides: tuple[Control, ...]) -> Fingerings:
    """Return a plan's fingerings as arrays for drawing: start, end and control values of each."""
    events = plan.grips
    start_s = np.array([event.start_s for event in events], np.float64)
    end_s = np.array([event.end_s for event in events], np.float64)

    def values(controls: tuple[Control, ...]) -> FloatArray:
        rows = [[event.controls.get(control.name, control.rest_value) for event in events] for control in controls]
        return np.array(rows, np.float64).reshape(len(controls), len(events))

    return Fingerings(events, start_s, end_s, values(pressable), values(slides), TimeSpans(start_s, end_s))


def slide_places(instrument: InstrumentMap, slide: Control) -> tuple[tuple[float, str], ...]:
    """Return each named position of a slide as (value 0..1, name). The value is the mean over all fingerings that use
    nothing but the slide.
    """
    found: dict[str, list[float]] = {}
    for fingering in instrument.fingerings:
        if set(fingering.controls) <= {slide.name}:
            found.setdefault(fingering.label, []).append(fingering.controls.get(slide.name, slide.rest_value))
    return tuple(sorted((sum(values) / len(values), label) for label, values in found.items()))
