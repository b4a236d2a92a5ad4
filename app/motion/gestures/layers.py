"""Layers of one player's body as curves of time, each made from one kind of event."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import partial
from typing import Any, Final

import numpy as np

from app.arrays import FloatArray
from app.motion.breath.air_in_trunk import air, lungs, quiet_breaths
from app.motion.by_hand.pose_corrections import PoseAngles, PoseCorrectionTable
from app.motion.curves.curve import Curve, Envelopes, moves
from app.motion.curves.following_gestures import follow, path
from app.motion.curves.path import Path
from app.motion.gestures.accents import Accents
from app.motion.gestures.body_lag import Leads, Overlapped
from app.motion.gestures.feet import Feet
from app.motion.gestures.hand_gestures import Reaches, Reaching
from app.motion.gestures.held_still import held_still, holds_of
from app.motion.gestures.idle_gestures import NOTHING_BESIDE, Concert, ConcertSamples
from app.motion.gestures.named_gestures import Gestured, Sums
from app.motion.gestures.nods import Nods
from app.plan.events_by_hand import PoseTarget
from app.plan.kinds import GESTURE_KINDS, Part
from app.plan.model import GestureEvent
from app.plan.styles import shown_in_style
from app.steps import StepTable, reading

BELL_S: Final = 0.5
"""Seconds in which the bell moves to another height."""


@dataclass(frozen=True)
class LayerSamples:
    """Values of all layers of a player's motion at F frames, before they are scaled to the player; fields as in
    `Layers`, each (F,).

    ``dip`` and ``lift``: nods; ``giving``: 1 half way between two weight positions; ``held``: the animator's poses;
    ``gestured``: keyed gestures; ``feet``: as in `Feet.sample`; ``concert``: gestures while not playing; ``reached``:
    hands that leave the instrument; ``further``: additional fullness of the lungs that makes breaths visible
    (`app.motion.breath.breaths_that_show`); ``push``: breath pushes at attacks (`app.motion.faces.tongue_strokes`).
    """

    full: FloatArray
    leaning: FloatArray
    air: FloatArray
    dip: FloatArray
    lift: FloatArray
    sway: Overlapped
    lean: Overlapped
    accent: Overlapped
    weight: Overlapped
    giving: FloatArray
    height: FloatArray
    lowered: FloatArray
    feet: dict[str, FloatArray]
    held: dict[PoseTarget, PoseAngles]
    gestured: Sums | None = None
    concert: ConcertSamples = NOTHING_BESIDE
    reached: Reaches | None = None
    quiet: FloatArray | float = 0.0
    further: FloatArray | float = 0.0
    push: FloatArray | float = 0.0


@dataclass(frozen=True)
class Layers:
    """Layers of one player's body as curves of time, to be scaled by the player's sizes.

    Attributes
    ----------
    full, leaning : Curve
        Visible fullness of the lungs, and lean of the breath's preparation.
    air : Curve
        Amount of air in the lungs.
    sway, lean : Path
        Sideways and forward position of the trunk, -1..1.
    weight, height : Curve
        Position of the weight and height of the bell, -1..1.
    leads : Leads
        Delays between the parts of the body.
    """

    full: Curve
    leaning: Curve
    air: Curve
    nods: Nods
    sway: Path
    lean: Path
    accent: Accents
    weight: Curve
    height: Curve
    lowered: Curve
    quiet: Curve
    feet: Feet
    held: PoseCorrectionTable
    gestured: Gestured
    reached: Reaching
    concert: Concert
    still: Envelopes
    leads: Leads

    def sample(self, times_s: FloatArray) -> LayerSamples:
        """Return the values of all layers at ascending times; in spans in which the plan holds the body still, they
        keep their earlier values.
        """
        return held_still(self._moving(times_s), self.still, times_s, self._moving)

    def _moving(self, times_s: FloatArray) -> LayerSamples:
        """Sample all layers of motion at ascending times as if the body were never held still."""
        dip, lift = self.nods.sample(times_s)
        before, after, share = self.weight.between(self.leads.at(times_s).hips)
        values: dict[str, Any] = {name: getattr(self, name).sample(times_s) for name in ALIKE}
        values |= {name: self.leads.sample(getattr(self, name), times_s) for name in OVERLAPPED}
        return LayerSamples(dip=dip, lift=lift, giving=2.0 * share * (1.0 - share) * np.abs(after - before), **values)

    def changed_s(self, other: Layers) -> list[FloatArray]:
        """Return for each layer the K spans (K, 2) in seconds outside of which both have equal values."""
        names = [member.name for member in fields(self) if member.name != "leads"]
        return [self.leads.widened(getattr(self, name).changed_s(getattr(other, name))) for name in names]


OVERLAPPED: Final = ("sway", "lean", "accent", "weight")
"""Layers that the parts of the body perform one after another."""
ALIKE: Final = tuple(
    member.name for member in fields(LayerSamples) if member.name in Layers.__dataclass_fields__.keys() - {*OVERLAPPED}
)
"""Layers that all parts of the body perform simultaneously."""


def lowering_curve(gestures: Sequence[GestureEvent], lower_s: float, raise_s: float) -> Curve:
    """Return the curve of lowering the instrument: 0 at the lips, 1 lowered; at the end of each gesture it is back at
    the lips.

    Overlapping gestures are merged: the instrument stays down from the first to the last, at the lowest of them.
    """
    spans: list[tuple[float, float, float]] = []
    lowerings = (event for event in gestures if event.end_s > event.start_s)
    for event in sorted(lowerings, key=lambda event: event.start_s):
        if spans and event.start_s < spans[-1][1]:
            start_s, end_s, amount = spans[-1]
            spans[-1] = (start_s, max(end_s, event.end_s), max(amount, event.amount))
        else:
            spans.append((event.start_s, event.end_s, event.amount))
    segments: list[tuple[float, float, float]] = []
    for start_s, end_s, amount in spans:
        share = min(1.0, (end_s - start_s) / (lower_s + raise_s))
        segments.append((start_s, start_s + share * lower_s, amount))
        segments.append((end_s - share * raise_s, end_s, 0.0))
    return moves(segments)


def _of_parts(gestures: tuple[GestureEvent, ...], parts: tuple[Part, ...]) -> tuple[GestureEvent, ...]:
    """Return the gestures performed by some parts of the motion."""
    kinds = {kind for kind, row in GESTURE_KINDS.items() if row.part in parts}
    return tuple([event for event in gestures if event.kind in kinds])


LAYERS: Final = StepTable(
    styled=shown_in_style,
    breaths="styled.breaths",
    gestures="styled.gestures",
    lung_curves=lungs,
    full="lung_curves.full",
    leaning="lung_curves.leaning",
    air=air,
    cues="styled.cues",
    nodding=partial(_of_parts, parts=("nod",)),
    nods=reading(Nods.of, answers="nodding"),
    swaying=partial(_of_parts, parts=("sway",)),
    sway=reading(path, events="swaying"),
    leant=partial(_of_parts, parts=("lean",)),
    lean=reading(path, events="leant"),
    accented=partial(_of_parts, parts=("accent",)),
    accent=reading(Accents.of, events="accented"),
    shifting=partial(_of_parts, parts=("weight",)),
    shift_s="body.weight_shift.transition_s",
    weight=reading(follow, events="shifting", transition_s="shift_s"),
    carrying=partial(_of_parts, parts=("bell",)),
    height=reading(partial(follow, transition_s=BELL_S), events="carrying"),
    putting_down=partial(_of_parts, parts=("lowering",)),
    lower_s="body.bell.lower_s",
    raise_s="body.bell.raise_s",
    lowered=reading(lowering_curve, gestures="putting_down"),
    quiet=reading(quiet_breaths, gestures="putting_down"),
    stepping=partial(_of_parts, parts=("feet",)),
    step_s="body.footwork.step_s",
    feet=reading(Feet.of, events="stepping", generated_feet="generated_feet"),
    posed="styled.poses",
    held=reading(PoseCorrectionTable.of, events="posed"),
    gestured=reading(Gestured.of, events="gestures"),
    reached=reading(Reaching.of, events="gestures"),
    beside=partial(_of_parts, parts=("bow", "audience", "settle", "count")),
    concert=reading(Concert.of, gestures="beside"),
    holding=partial(_of_parts, parts=("still",)),
    still=reading(holds_of, gestures="holding"),
    overlap="body.overlap",
    leads=reading(Leads.of, overlap="overlap"),
    layers=Layers,
)
"""Steps that compute a body's layers from the plan, the body, the felt beats and the size of generated footwork."""
