"""Curves of controls, finger positions and heights of waiting fingers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

from app.motion.by_hand.additive_curves import Additive
from app.motion.curves.curve import Curve, moves
from app.motion.fingering.changed_stretch import changed_stretch, spliced
from app.motion.fingering.control_curves import control_curves
from app.motion.fingering.finger_curves import raised_curve, station_curves
from app.plan.model import FingeringEvent
from app.score.metre_map import FeltBeats
from app.steps import StepTable, reading
from instrument_maps.model import InstrumentMap


class Fingers(NamedTuple):
    """Motion of the fingers.

    Attributes
    ----------
    grips : tuple of FingeringEvent
        Successive fingerings from which the curves were made.
    made_for : tuple
        The other inputs of the curves, compared to decide whether they can be reused.
    controls, stations, raised
        As in `PerformanceCurves`.
    """

    grips: tuple[FingeringEvent, ...]
    made_for: tuple[object, ...]
    controls: dict[str, Curve]
    stations: dict[str, Curve]
    raised: Curve


def fingers_of(
    grips: tuple[FingeringEvent, ...],
    instrument: InstrumentMap,
    felt_beats: FeltBeats,
    farthest: Mapping[str, float],
    before: Fingers | None,
) -> Fingers:
    """Compute the curves of controls, finger positions and waiting heights; with an earlier result ``before``, only
    around the edit.
    """
    made_for = (instrument, felt_beats, farthest)
    stretch = controls = stations = None
    if before is not None and before.made_for == made_for:
        stretch = changed_stretch(before.grips, grips, felt_beats)
    if before is not None and stretch is not None:
        own = stretch.notes(grips)
        controls = spliced(before.controls, control_curves(own, instrument.controls, felt_beats, farthest), stretch)
        if controls is not None:
            stations = spliced(before.stations, station_curves(own, instrument, controls), stretch)
    if controls is None:
        controls = control_curves(grips, instrument.controls, felt_beats, farthest)
    if stations is None:
        stations = station_curves(grips, instrument, controls)
    hovers = any(control.hover_m for control in instrument.controls)
    return Fingers(grips, made_for, controls, stations, raised_curve(grips) if hovers else moves(()))


FINGERS: Final = StepTable(
    grips="plan.grips",
    fingers=fingers_of,
    curves="plan.additive",
    additive=reading(Additive.of, events="curves"),
)
"""Steps that compute the fingers and the user's own curves."""
