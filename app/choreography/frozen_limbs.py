"""Detection of frozen segments while the body moves, caused by lost markers or repeated frames.

A captured joint is never motionless, and its rests begin and end smoothly; so a rest that begins or ends abruptly is
damage as a whole. A stretched elbow or knee at the rig's limit may stop abruptly.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.choreography.body import PARENT_OF, SEGMENTS
from app.choreography.body_speeds import PARTS, PLACE, angle, runs
from app.choreography.clip import MotionClip
from app.rig import quaternion

EXACT: Final = 1e-6
"""Speed (rad/s, m/s) below which a part is motionless, since rounding differs in every frame."""
FROZEN: Final = 2
"""Number of motionless steps that indicate lost frames, if the body moves by more than `STARTS_RAD_S` before or
after.
"""
STARTS_RAD_S: Final = 1.5
MOST_FROZEN: Final = 0.25
"""Share of a clip's time above which its rests are considered intended."""
NEARLY_RAD_S: Final = 2e-3
"""Speed in radians per second of a constant joint in a file with few decimals."""
NEARLY_S: Final = 0.1
"""Least time in seconds for which it is constant."""
LONG_S: Final = 0.25
"""Time in seconds from which a ball joint, or two neighbouring joints, that rest abruptly are frozen."""
LEAST_RAD_S: Final = 0.1
"""Least speed in radians per second of a joint that stops abruptly."""
SMOOTH: Final = 0.55
"""Largest ratio of the first step to the second if a joint starts smoothly; usually it is a third."""
STRETCHED_RAD: Final = 0.02
"""Angle in radians above the least bend within which an elbow or knee counts as stretched."""
LEAP: Final = 2.5
"""Ratio of the first step to the second above which, with `STARTS_RAD_S` in addition, a joint leaps out of its rest
pose; 1.7 at the limit of a knee in CMU's captures.
"""
_HINGES: Final = tuple(at for at, name in enumerate(SEGMENTS) if "Lower" in name)
_BALLS: Final = tuple(
    at for at, name in enumerate(SEGMENTS) if "Lower" not in name and at and name[-4:] not in ("Hand", "Foot")
)


def frozen(clip: MotionClip, speeds: FloatArray) -> Iterator[tuple[int, int, int]]:
    """Yield spans (start, stop, part) between sound frames in which the body or a part is frozen.

    Parameters
    ----------
    speeds : (F - 1, 17) float64
        See `app.choreography.body_speeds.part_speeds`.
    """
    yield from ((start, stop, part) for start, stop in _bodies(speeds) for part in range(len(PARTS)))
    rests = {part: _rests(clip, speeds, part) for part in range(PLACE)}
    for part, spans in rests.items():
        for start, stop in spans:
            if max(speeds[start - 1, part], speeds[stop, part]) > STARTS_RAD_S or (
                (stop - start) / float(clip.fps) >= LONG_S
                and _is_abrupt(speeds[:, part], start, stop)
                and (part in _BALLS or _has_resting_neighbour(rests, part, start, stop))
            ):
                yield start - 1, stop + 1, part


def with_held(speeds: FloatArray, found: set[tuple[int, int, int]]) -> set[tuple[int, int, int]]:
    """Extend the spans of frozen parts by the adjacent frames in which the part does not move either."""
    still = speeds <= EXACT
    long = [
        [run for run in runs(still[:, part]) if run[1] - run[0] >= FROZEN] if _is_seldom(still[:, part]) else []
        for part in range(len(PARTS))
    ]
    begins, ends = [dict(some) for some in long], [{stop: start for start, stop in some} for some in long]
    return {(ends[part].get(start, start), begins[part].get(stop, stop), part) for start, stop, part in found}


def _bodies(speeds: FloatArray) -> Iterator[tuple[int, int]]:
    """Yield the spans in which a moving body is frozen as a whole."""
    still = np.asarray((speeds <= EXACT).all(axis=1))
    if not _is_seldom(still):
        return
    fast = speeds[:, :PLACE].max(axis=1)
    for start, stop in runs(still):
        beside = max(fast[start - 1] if start else 0.0, fast[stop] if stop < len(fast) else 0.0)
        if stop - start >= FROZEN and start and stop < len(fast) and beside > STARTS_RAD_S:
            yield start, stop + 1


def _rests(clip: MotionClip, speeds: FloatArray, part: int) -> list[tuple[int, int]]:
    """Return the spans (first, stop) of frame steps in which a body part of a clip does not move at all, as after lost
    tracking; ``speeds`` (F - 1, parts) is radians per second."""
    found = []
    for most, least in ((EXACT, FROZEN), (NEARLY_RAD_S, max(FROZEN, round(NEARLY_S * float(clip.fps))))):
        still = np.asarray(speeds[:, part] <= most)
        if still.any() and _is_seldom(still):
            found += [run for run in runs(still) if run[1] - run[0] >= least and run[0] and run[1] < len(speeds)]
    if part in _HINGES and found:
        bent = angle(clip.rotations[:, part], quaternion.IDENTITY)
        least_bent = float(bent.min()) + STRETCHED_RAD
        # The limb leaps into exactly its rest pose because its marker was lost; the limit of a rig may be there too.
        found = [
            run
            for run in found
            if bent[run[0]] > least_bent or (bent[run[0]] < EXACT and _leaps(speeds[:, part], *run))
        ]
    return sorted(set(found))


def _leaps(speeds: FloatArray, start: int, stop: int) -> bool:
    """Return whether the steps into or out of a rest are much faster than the motion before or after them."""
    sides = ((speeds[start - 1], speeds[max(start - 2, 0)]), (speeds[stop], speeds[min(stop + 1, len(speeds) - 1)]))
    return any(first > LEAP * second + STARTS_RAD_S for first, second in sides)


def _is_abrupt(speeds: FloatArray, start: int, stop: int) -> bool:
    """Return whether a body part stops or starts moving within a single frame at the start or stop of a rest."""
    sides = ((speeds[start - 1], speeds[max(start - 2, 0)]), (speeds[stop], speeds[min(stop + 1, len(speeds) - 1)]))
    return any(first > max(LEAST_RAD_S, SMOOTH * second) for first, second in sides)


def _has_resting_neighbour(rests: dict[int, list[tuple[int, int]]], part: int, start: int, stop: int) -> bool:
    above = PARENT_OF[SEGMENTS[part]]
    beside = [at for at, name in enumerate(SEGMENTS) if PARENT_OF[name] == SEGMENTS[part] or name == above]
    return any(
        min(stop, other[1]) - max(start, other[0]) > 0.5 * (stop - start) for at in beside for other in rests[at]
    )


def _is_seldom(still: BoolArray) -> bool:
    return bool(still.mean() <= MOST_FROZEN)
