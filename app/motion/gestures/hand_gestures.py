"""Hands that leave the lowered instrument, and the instrument that comes up for it: the keys of gestures as curves.

A hand's way is a mixture of places, each with a share 0..1 (what is left is the grip), an offset, and a mixture of
shapes of the fingers (what is left is how they hold). Where the places are the solvers know
(`app.motion.contacts.hand_destinations`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple, TypeAlias, get_args

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import rows_changed_s
from app.motion.gestures.named_gestures import Gestured, keyed
from app.plan.model import GestureEvent
from app.rig.grip.grip_pose import Side
from metadata.gestures import Gesture, HandPlace, HandShape
from metadata.model import AmplitudeScale, at_amplitude

PLACES: Final[tuple[HandPlace, ...]] = tuple(place for place in get_args(HandPlace) if place != "grip")
SHAPES: Final[tuple[HandShape, ...]] = tuple(shape for shape in get_args(HandShape) if shape != "held")
RAISED: Final = "raised"
LEAST_SIZE: Final = 0.05
"""A gesture that is asked for as small as this is not done by a hand."""


class Reached(NamedTuple):
    """How hands are on their way at some frames, of what grows alike with the amplitude; empty: they are not.

    Attributes
    ----------
    shares : dict of str to (F,) float64
        ``RAISED``, and by side and place or shape, e.g. ``"left.page"``.
    offsets_m : dict of side to (F, 3) float64
        To the left, up and ahead.
    """

    shares: dict[str, FloatArray]
    offsets_m: dict[Side, FloatArray]


Reaches: TypeAlias = dict[AmplitudeScale, Reached]


@dataclass(frozen=True, eq=False)
class Reaching:
    """All gestures of a player in which a hand leaves the instrument, or it comes up.

    Attributes
    ----------
    rows : (N, 4) float64
        When each begins and ends, how large it is, and which it is.
    gestures : tuple of Gesture
        What is done, by that number; each once.
    """

    rows: FloatArray
    gestures: tuple[Gesture, ...]

    @classmethod
    def of(cls, events: Sequence[GestureEvent]) -> Reaching:
        """From a plan's gestures."""
        found = Gestured.of([one for one in events if one.gesture is not None and one.gesture.needs_lowered])
        return cls(found.rows, found.gestures)

    def sample(self, times_s: FloatArray) -> Reaches:
        """Where hands are on their way at ascending times."""
        found: Reaches = {}
        first = np.searchsorted(times_s, self.rows[:, 0])
        last = np.searchsorted(times_s, self.rows[:, 1])
        for index in np.flatnonzero(last > first).tolist():
            here = slice(first[index], last[index])
            start_s, end_s, amount, number = self.rows[index].tolist()
            gesture = self.gestures[int(number)]
            if amount < LEAST_SIZE:
                continue
            reached = found.setdefault(gesture.amplitude, Reached({}, {}))
            _add(reached, gesture, (times_s[here] - start_s) / (end_s - start_s), here, len(times_s))
        return found

    def changed_s(self, other: Reaching) -> FloatArray:
        """Spans (K, 2) outside of which both have the very same values."""
        if self.gestures != other.gestures:
            return np.concatenate((self.rows[:, :2], other.rows[:, :2]))
        return rows_changed_s(self.rows, other.rows, self.rows[:, :2], other.rows[:, :2])


def _add(reached: Reached, gesture: Gesture, phase: FloatArray, here: slice, frames: int) -> None:
    def share(name: str, at: FloatArray, values: Sequence[float]) -> None:
        if any(values):
            total = reached.shares.setdefault(name, np.zeros(frames))
            total[here] += np.clip(keyed(at, np.array(values), phase), 0.0, 1.0)

    if gesture.raised:
        share(RAISED, np.array([key.at for key in gesture.raised]), [key.share for key in gesture.raised])
    track = gesture.hand
    if track is None or track.which == "free":
        return
    at = np.array([key.at for key in track.keys])
    for place in PLACES:
        share(f"{track.which}.{place}", at, [float(key.place == place) for key in track.keys])
    for shape in SHAPES:
        share(f"{track.which}.{shape}", at, [float(key.shape == shape) for key in track.keys])
    offset_m = reached.offsets_m.setdefault(track.which, np.zeros((frames, 3)))
    for axis in range(3):
        offset_m[here, axis] += keyed(at, np.array([key.m[axis] for key in track.keys]), phase)


def reached(reaches: Reaches, amplitude: float, amount: float) -> tuple[dict[str, FloatArray], FloatArray | None]:
    """What hands do of it at a player's amplitude and amount, and how far (F,) the instrument comes up (None: not).

    A hand goes all the way, or does not leave the instrument. Keys are as of `Reached`; offsets are there as
    ``"left.m"`` and ``"right.m"``, (F, 3).
    """
    hands: dict[str, FloatArray] = {}
    raised: FloatArray | None = None
    for scale, part in sorted(reaches.items(), key=lambda item: item[0]):
        if amount * at_amplitude(scale, amplitude) < LEAST_SIZE:
            continue
        offsets_m: Mapping[str, FloatArray] = {f"{side}.m": values for side, values in part.offsets_m.items()}
        for name, values in {**part.shares, **offsets_m}.items():
            if name == RAISED:
                raised = values if raised is None else np.minimum(raised + values, 1.0)
            else:
                hands[name] = values if name not in hands else hands[name] + values
    return hands, raised
