"""Curves of hands that leave the lowered instrument, and of the instrument raised for a gesture, from gesture keys.

A hand's motion is a mixture of places with shares 0..1 (the rest is the grip), an offset, and a mixture of finger
shapes (the rest is the grip's). `app.motion.contacts.hand_destinations` defines the places.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple, TypeAlias, get_args

import numpy as np

from app.arrays import FloatArray
from app.motion.gestures.named_gestures import KeyedGestures, keyed
from app.rig.grip.grip_pose import Side
from metadata.gestures import Gesture, HandPlace, HandShape
from metadata.model import AmplitudeScale, at_amplitude

PLACES: Final[tuple[HandPlace, ...]] = tuple(place for place in get_args(HandPlace) if place != "grip")
SHAPES: Final[tuple[HandShape, ...]] = tuple(shape for shape in get_args(HandShape) if shape != "held")
RAISED: Final = "raised"
LEAST_SIZE: Final = 0.05
"""Size below which a gesture of a hand is omitted."""


class ReachingHands(NamedTuple):
    """Motion of hands that leave the instrument, over F frames; empty where no hand leaves.

    Attributes
    ----------
    shares : dict of str to (F,) float64
        ``RAISED``, and by side and place or shape, such as ``"left.page"``.
    offsets_m : dict of side to (F, 3) float64
        Offset to the left, up and ahead.
    """

    shares: dict[str, FloatArray]
    offsets_m: dict[Side, FloatArray]


Reaches: TypeAlias = dict[AmplitudeScale, ReachingHands]


class Reaching(KeyedGestures):
    """All gestures of a player in which a hand leaves the instrument, or the instrument is raised."""

    @staticmethod
    def takes(gesture: Gesture) -> bool:
        """Return whether a gesture takes a hand off the instrument or raises it, so that this class handles it."""
        return gesture.needs_lowered

    def sample(self, times_s: FloatArray) -> Reaches:
        """Sample the hands' motion at ascending times, grouped by the amplitude scale of the gestures."""
        found: Reaches = {}
        for gesture, amount, phase, here in self.done(times_s):
            if amount >= LEAST_SIZE:
                _add(found.setdefault(gesture.amplitude, ReachingHands({}, {})), gesture, phase, here, len(times_s))
        return found


def _add(reached: ReachingHands, gesture: Gesture, phase: FloatArray, here: slice, frames: int) -> None:
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


def limited_hand_gestures(
    reaches: Reaches, amplitude: float, amount: float
) -> tuple[dict[str, FloatArray], FloatArray | None]:
    """Scale hand gestures to a player's amplitude and amount; also return the share (F,) by which the instrument is
    raised (None: never).

    A hand either goes all the way or stays. Keys are as in `ReachingHands`; offsets are ``"left.m"`` and ``"right.m"``,
    (F, 3).
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
