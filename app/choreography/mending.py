"""Repair of a damaged capture: short damage is replaced, jumps are removed, the rest is excluded.

Excluded spans are not learned from (`app.choreography.learn`). Their frames are bridged, so that filters and splines
over many frames are not influenced by the damage.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.body_speeds import PARTS, angle
from app.choreography.clip import MotionClip
from app.choreography.cubic_distance import between
from app.choreography.damage import Damage, damage
from app.rig import quaternion

LONGEST_S: Final = 0.125
"""Longest damage in seconds that is replaced; the motion during a longer time cannot be inferred."""
ROUNDS: Final = 2
"""Number of rounds after which remaining damage is excluded."""
JUMP_RAD: Final = 0.5
"""Angle in radians from its extrapolated motion beyond which a segment has jumped."""
HIPS_JUMP_RAD: Final = 0.1
JUMP_M: Final = 0.03
RETURNS: Final = 0.5
"""Share of the greatest error within a damaged span below which the hips behind it have returned by themselves."""
MOST_LEAN_RAD: Final = 0.5
"""Greatest tilt of the hips in radians in a jump that can be removed."""
APART_S: Final = 0.75
"""Time in seconds between two jumps of a segment within which its motion is wrong."""
LONG_APART_S: Final = 10.0
BACK: Final = 0.4
"""Remaining share of a jump below which the second jump undoes the first."""
MARGIN_S: Final = 0.05
FADE_S: Final = 0.4
"""Time in seconds within which the remaining lean and height after a jump fade out."""
_FLAT: Final = np.array((1.0, 0.0, 1.0))
_UP: Final = (0.0, 1.0, 0.0)


@dataclass(frozen=True, eq=False)
class Mended:
    """A clip without damage.

    Attributes
    ----------
    clip : MotionClip
        Clip of equal length; sound frames are bitwise unchanged, except for those after a removed jump, which are
        rotated about the vertical and moved.
    mended : tuple of Damage
        Replaced spans.
    left_out : tuple of Damage
        Excluded spans, ascending and without overlap.
    """

    clip: MotionClip
    mended: tuple[Damage, ...] = ()
    left_out: tuple[Damage, ...] = ()


def mended(clip: MotionClip) -> Mended:
    """Repair the damage of a clip; the same clip is part of the result if there is none."""
    replaced: list[Damage] = []
    left_out: tuple[Damage, ...] = ()
    for last in (*(False,) * ROUNDS, True):
        found = [one for one in damage(clip) if not _within(one, left_out)]
        if not found:
            break
        body = _Body(clip)
        jumps = {one: parts for one in found if _short(one, clip) and (parts := body.jumped(one))}
        going_on = {one for one, parts in jumps.items() if not last and body.goes_on(one, parts)}
        lost = [one for one in found if last or (one not in going_on and (one in jumps or not _short(one, clip)))]
        pairs = _pairs(clip, [replace(one, parts=jumps.get(one, one.parts)) for one in lost])
        left_out = _united([*left_out, *lost, *pairs], clip)
        short = [one for one in found if not _within(one, left_out)]
        for one in sorted([*short, *left_out]):
            body.bridge(one, one in going_on)
        replaced += short
        clip = body.clip()
    return Mended(clip, tuple(sorted(one for one in replaced if not _within(one, left_out))), left_out)


def _short(one: Damage, clip: MotionClip) -> bool:
    return (one.stop - one.start) / float(clip.fps) <= LONGEST_S or one.stop - one.start <= 2


def _pairs(clip: MotionClip, jumps: Sequence[Damage]) -> list[Damage]:
    """Find pairs of jumps of one body part, of which the second undoes the first, and return the spans in between as
    damage.
    """
    found = []
    for at, part in enumerate(PARTS):
        back = -1
        for one, other in pairwise(sorted(jump for jump in jumps if part in jump.parts)):
            apart_s = (other.start - one.stop) / float(clip.fps)
            # A jump that undoes the previous one does not begin another damaged span; a held body does not jump.
            jumped = part != "place" and one.stop != back and _short(one, clip) and _short(other, clip)
            undone = jumped and (_swapped(part, one, other) or _undone(clip, at, one, other))
            if apart_s <= APART_S or (apart_s <= LONG_APART_S and undone):
                found.append(Damage(one.start, other.stop, (part,)))
                back = other.stop
    return found


def _swapped(part: str, one: Damage, other: Damage) -> bool:
    """Return whether in both jumps the same part of the other side jumps too, as when left and right markers are
    swapped.
    """
    if not part.startswith(("left", "right")):
        return False
    opposite = part.replace("left", "right") if part.startswith("left") else part.replace("right", "left")
    return opposite in one.parts and opposite in other.parts


def _undone(clip: MotionClip, at: int, one: Damage, other: Damage) -> bool:
    """Return whether the second of two jumps turns the segment ``at`` back by about the rotation of the first."""
    turns = clip.rotations[:, at]
    steps = [quaternion.multiply(quaternion.conjugate(turns[jump.start]), turns[jump.stop]) for jump in (one, other)]
    left = float(angle(quaternion.multiply(steps[0], steps[1]), quaternion.IDENTITY))
    return left < BACK * min(float(angle(step, quaternion.IDENTITY)) for step in steps)


def _united(lost: Sequence[Damage], clip: MotionClip) -> tuple[Damage, ...]:
    """Widen damaged spans by `MARGIN_S` at both ends, and merge overlapping ones with all their body parts."""
    margin = round(MARGIN_S * float(clip.fps))
    found: list[Damage] = []
    for one in sorted(lost):
        if found and one.start - margin <= found[-1].stop:
            parts = tuple(part for part in PARTS if part in found[-1].parts or part in one.parts)
            found[-1] = Damage(found[-1].start, max(found[-1].stop, min(one.stop + margin, len(clip) - 1)), parts)
        else:
            found.append(Damage(max(0, one.start - margin), min(one.stop + margin, len(clip) - 1), one.parts))
    return tuple(found)


def _within(one: Damage, spans: Sequence[Damage]) -> bool:
    return any(span.start < one.stop and one.start < span.stop for span in spans)


class _Body:
    """A clip during its repair. A jump of the hips rotates and moves all later frames, which is postponed until other
    repairs or the end, so that the cost is independent of the number of jumps.
    """

    def __init__(self, clip: MotionClip) -> None:
        self._clip = clip
        self._hips, self._turns = clip.hips_m.copy(), clip.rotations.copy()
        self._done = 0
        self._moves, self._turn, self._way = False, quaternion.IDENTITY, np.zeros(3)
        self._fade = round(FADE_S * float(clip.fps))

    def jumped(self, one: Damage) -> tuple[str, ...]:
        """Return the body parts that after a damaged span are not where the motion before and after it would lead."""
        found = []
        for part in one.parts:
            if part == "place":
                off, most = float(np.linalg.norm(self._hips[one.stop] - self._led(one)[0])), JUMP_M
            else:
                turns = self._turns[:, SEGMENTS.index(part)]
                off, most = float(angle(_led(turns, one), turns[one.stop])), JUMP_RAD
                if part == "hips":
                    most = HIPS_JUMP_RAD
            if off > most and not (part in ("hips", "place") and off < RETURNS * self._error(one, part)):
                found.append(part)
        return tuple(found)

    def _error(self, one: Damage, part: str) -> float:
        """Return the greatest distance in metres or angle in radians of the damaged frames of the hips from those that
        would replace them; 0 if only the change between two frames is damaged."""
        values = self._hips if part == "place" else self._turns[:, 0]
        around = slice(max(0, one.start - 1), one.stop + 2)
        here = slice(one.start - around.start + 1, one.stop - around.start)
        bridged = values[around].copy()
        _bridge(bridged, Damage(one.start - around.start, one.stop - around.start, one.parts), self._clip)
        was, now = values[around][here], bridged[here]
        apart = np.linalg.norm(was - now, axis=1) if part == "place" else angle(was, now)
        return float(apart.max(initial=0.0))

    def goes_on(self, one: Damage, jumped: Sequence[str]) -> bool:
        """Return whether only the hips jump, with little tilt, so that the motion can continue from the new place."""
        if not set(jumped) <= {"hips", "place"}:
            return False
        missing = quaternion.multiply(_led(self._turns[:, 0], one), quaternion.conjugate(self._turns[one.stop, 0]))
        return float(angle(quaternion.swing_twist(missing, _UP)[0], quaternion.IDENTITY)) < MOST_LEAN_RAD

    def bridge(self, one: Damage, goes_on: bool) -> None:
        """Replace the damaged frames: of the whole body if its hips are damaged or a postponed change is pending, else
        of the damaged parts.

        Parameters
        ----------
        goes_on : bool
            Whether the hips jumped, so that later frames are rotated and moved to the expected place.
        """
        self._move(min(one.stop + 2 + self._fade, len(self._hips)))
        if goes_on:
            self._go_on(one)
        whole = {"hips", "place"} & set(one.parts)
        for at, part in enumerate(SEGMENTS):
            if whole or part in one.parts:
                _bridge(self._turns[:, at], one, self._clip)
        if whole:
            _bridge(self._hips, one, self._clip)

    def clip(self) -> MotionClip:
        """Return the clip with the damage repaired so far."""
        self._move(len(self._hips))
        return replace(self._clip, hips_m=self._hips.copy(), rotations=self._turns.copy())

    def _move(self, stop: int) -> None:
        """Apply postponed rotations and moves to the frames before ``stop``."""
        some = slice(self._done, max(stop, self._done))
        if self._moves:
            self._hips[some] = quaternion.rotate(self._turn, self._hips[some]) + self._way
            self._turns[some, 0] = quaternion.multiply(self._turn, self._turns[some, 0])
        self._done = some.stop

    def _led(self, one: Damage) -> tuple[FloatArray, FloatArray]:
        """Return the hips' position (3,) and rotation (4,) expected at the first frame behind a damaged span, if they
        had moved on as before."""
        hips, turns = self._hips, self._turns[:, 0]
        turn = _led(turns, one)
        missing = quaternion.multiply(turn, quaternion.conjugate(turns[one.stop]))
        _, yaw = quaternion.swing_twist(missing, _UP)
        first, last = _steps(one, len(hips))
        after = quaternion.rotate(yaw, hips[last[1]] - hips[last[0]])
        return hips[one.start] + 0.5 * (one.stop - one.start) * (hips[first[1]] - hips[first[0]] + after), turn

    def _go_on(self, one: Damage) -> None:
        place, turn = self._led(one)
        hips, turns = self._hips, self._turns[:, 0]
        missing = quaternion.multiply(turn, quaternion.conjugate(turns[one.stop]))
        lean, yaw = quaternion.swing_twist(missing, _UP)
        faded = slice(one.stop, self._done)
        times = np.minimum(np.arange(faded.stop - faded.start) / (FADE_S * float(self._clip.fps)), 1.0)
        left = (1.0 - times) ** 2 * (1.0 + 2.0 * times)
        rise_m = place[1] - hips[one.stop, 1]
        way = place * _FLAT - quaternion.rotate(yaw, hips[one.stop] * _FLAT)
        hips[faded] = quaternion.rotate(yaw, hips[faded]) + way + (left * rise_m)[:, None] * _UP
        leaning = quaternion.from_rotation_vector(left[:, None] * quaternion.to_rotation_vector(lean))
        turned = quaternion.multiply(leaning, quaternion.multiply(yaw, turns[faded]))
        side = np.sign(float(turned[0] @ turns[one.start])) or 1.0
        turns[faded] = side * turned
        self._moves, self._turn = True, side * quaternion.multiply(yaw, self._turn)
        self._way = quaternion.rotate(yaw, self._way) + way


def _steps(one: Damage, count: int) -> tuple[tuple[int, int], tuple[int, int]]:
    """Frames of the last step before damage and of the first step after it, limited to a clip of ``count`` frames."""
    return (max(0, one.start - 1), one.start), (one.stop, min(one.stop + 1, count - 1))


def _led(turns: FloatArray, one: Damage) -> FloatArray:
    """Rotation (4,) expected at the first sound frame after damage, from the mean rotation speed before and
    after it.
    """
    vectors = [
        quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(turns[start]), turns[stop]))
        for start, stop in _steps(one, len(turns))
    ]
    step = quaternion.from_rotation_vector(0.5 * (one.stop - one.start) * (vectors[0] + vectors[1]))
    return quaternion.multiply(turns[one.start], step)


def _bridge(values: FloatArray, one: Damage, clip: MotionClip) -> None:
    """Fill in the values (F, ...) of the damaged frames in place by a cubic between the sound ones, which continues the
    speeds at both ends if the span is short."""
    count = one.stop - one.start
    (first, start), (stop, last) = _steps(one, len(values))
    short = count / float(clip.fps) <= LONGEST_S or count <= 2
    rotates = values.shape[1] == 4
    if rotates and float(values[start] @ values[stop]) < 0.0:
        # All later quaternions change sign, which does not change their rotations.
        values[stop:] *= -1.0
    slopes = count * (values[start] - values[first]), count * (values[last] - values[stop])
    slopes = slopes if short else (np.zeros_like(slopes[0]), np.zeros_like(slopes[1]))
    shares = (np.arange(1, count) / count)[:, None]
    found = between(values[start], values[stop], slopes, shares)
    values[start + 1 : stop] = quaternion.normalize(found) if rotates else found
