"""Removal of the poses held at the ends of a capture, for finding its body.

The turns of bones in the T-pose are found as means over the motion, which a T-pose or zero pose held for seconds before
or after it would move.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.choreography.body_speeds import angle
from app.formats.bvh.clip import BvhClip

STILL_RAD: Final = 0.01
"""Greatest angle in radians of all joints from the first or last pose while it is held: people sway more."""
STILL_S: Final = 0.25
"""Least time in seconds for which a pose is held."""
MOVES_S: Final = 1.0
"""Least length in seconds of the motion between the held poses; otherwise nothing is left out."""


def moving_frames(bvh: BvhClip) -> slice:
    """Return the frames of a clip with only one of a pose held at its start and at its end; all if none is held."""
    turns, fps = np.asarray(bvh.rotations_xyzw, np.float64), float(bvh.fps)
    before, after = _held(turns, fps), _held(turns[::-1], fps)
    kept = slice(max(0, before - 1), len(turns) - max(0, after - 1))
    return kept if (kept.stop - kept.start) / fps >= MOVES_S else slice(0, len(turns))


def without_still_ends(bvh: BvhClip) -> BvhClip:
    """Return the clip with its `moving_frames` only; the same clip if these are all."""
    kept = moving_frames(bvh)
    if kept == slice(0, len(bvh.rotations_xyzw)):
        return bvh
    return replace(
        bvh,
        rotations_xyzw=bvh.rotations_xyzw[kept],
        root_translation_cm=bvh.root_translation_cm[kept],
        translations_cm={joint: ways[kept] for joint, ways in bvh.translations_cm.items()},
    )


def _held(turns: FloatArray, fps: float) -> int:
    """Return the number of frames for which the first pose of rotations (F, J, 4) is held; 0 for a short time."""
    left = np.any(angle(turns, turns[:1]) > STILL_RAD, axis=1)
    held = int(left.argmax()) if left.any() else 0
    return held if held >= STILL_S * fps else 0
