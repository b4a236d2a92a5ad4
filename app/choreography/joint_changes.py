"""Limits sudden changes of the rotation speeds of joints in a dance to those of captures.

Joints between a moving body and a foot that lands earlier or later than captured may start and stop rotating within a
frame, most of all the knee of an almost straight leg. Where a joint's angular velocity changes by more from one frame
to the next than usual in the captures, its rotations are bent minimally in the adjacent frames. Standing feet stay in
place.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from scipy.ndimage import maximum_filter1d

from app.arrays import BoolArray, FloatArray
from app.choreography.bent_paths import bent
from app.choreography.body import FEET, PARENT_OF, SEGMENTS
from app.choreography.body_speeds import changes_rad, runs, sudden, turns_rad
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.feet_on_floor import legs_to
from app.rig import quaternion

ROOM: Final = 0.85
"""Share of the limit that is used, since placing the feet again changes the legs slightly."""
AROUND_S: Final = 0.1
"""Time in seconds before and after a sudden change within which rotations are bent."""
EDGE: Final = 2
"""Number of unchanged frames at either end of such a span, between which its first and last speed are kept."""
HANDS: Final = 1.25
"""Greatest change of a hand's angular velocity in the world relative to the limit for a joint."""
TRIES: Final = 2
"""Greatest number of passes, since rotations about different axes add up only approximately."""
SHARES: Final = (0.75, 0.5, 0.25, 0.0, 0.0)
"""Shares of its bends by which a foot is turned, one after another, while its leg cannot follow."""
MORE: Final = 1.25
"""Greatest change of the speed of a standing foot's ankle for that, relative to the limit, unless it is greater
already."""
ROUNDS: Final = 60
LANDS_S: Final = 0.05
"""Time in seconds before a landing in which a leg is unchanged, so that its foot descends steeply and does not skid."""
EXACT_M: Final = 1e-4
"""Distance in metres within which the tip of a standing foot stays."""
_HANDS: Final = ("leftHand", "rightHand")


def within_changes(
    clip: MotionClip, planted: BoolArray, most_rad_s: float, lands_s: float = LANDS_S, *, legs_only: bool = False
) -> MotionClip:
    """Return the motion with the angular velocity of each joint except the hips changing by at most ``most_rad_s`` from
    frame to frame, as far as standing feet allow; the same object if no change is greater.

    Parameters
    ----------
    planted : (F, 2) bool
        Frames in which the left and the right foot stand; their legs stay as they are.
    lands_s : float
        Time in seconds before they land in which they stay too.
    legs_only : bool
        Change legs only.
    """
    rotations, held = clip.rotations, _held(planted, float(clip.fps), lands_s)
    if legs_only:
        held[:, [not name.endswith(("Leg", "Foot")) for name in SEGMENTS]] = True
    for _ in range(TRIES):
        calmer = _calm(rotations, held, most_rad_s, float(clip.fps))
        if calmer is rotations:
            break
        rotations = calmer
    return clip if rotations is clip.rotations else replace(clip, rotations=quaternion.continuous(rotations))


def hips_within_changes(clip: MotionClip, most_rad_s: float) -> MotionClip:
    """Return the motion with the angular velocity of the hips changing by at most ``most_rad_s`` from frame to frame;
    the same object if no change is greater. It moves the feet, so that these are planted afterwards.
    """
    hips = clip.rotations[:, :1]
    calm = _calm(hips, np.zeros((len(clip), 1), bool), most_rad_s, float(clip.fps))
    if calm is hips:
        return clip
    rotations = np.concatenate([calm, clip.rotations[:, 1:]], axis=1)
    return replace(clip, rotations=quaternion.continuous(rotations))


def feet_within_changes(clip: MotionClip, planted: BoolArray, most_rad_s: float) -> MotionClip:
    """Return the motion with the angular velocity of each foot in the world changing by at most ``most_rad_s`` from
    frame to frame, unless that of a standing foot's ankle would change by more; its tip stays, also while the foot
    stands and rolls about it. The same object is returned if no change is greater.

    Parameters
    ----------
    planted : (F, 2) bool
        Frames in which the left and the right foot stand.
    """
    world, at = clip.world(), [1 + SEGMENTS.index(name) for name in FEET]
    turns, tips = world.rotations[:, at], tips_m(clip, world)
    calm = _calm(turns, np.zeros(planted.shape, bool), most_rad_s, float(clip.fps))
    if calm is turns:
        return clip
    bends = quaternion.to_rotation_vector(quaternion.multiply(calm, quaternion.conjugate(turns)))
    bent_frames: BoolArray = (calm != turns).any(axis=-1)
    spans = [(foot, slice(*run)) for foot in range(2) for run in runs(bent_frames[:, foot])]
    parts = [SEGMENTS.index(name) for name in FEET]
    most = np.maximum(changes_rad(turns_rad(clip.rotations[:, parts])), ROOM * most_rad_s / float(clip.fps))
    shares = np.ones(planted.shape)
    for share in SHARES:
        rotations = world.rotations.copy(order="K")
        rotations[:, at] = quaternion.multiply(quaternion.from_rotation_vector(shares[..., None] * bends), turns)
        found = legs_to(clip, replace(world, rotations=rotations), tips, planted, turned_back=False)
        # A foot is turned less if its leg does not reach as far, or if its ankle turns the other way.
        off = np.linalg.norm(tips_m(found) - tips, axis=-1) > EXACT_M
        off |= changes_rad(turns_rad(found.rotations[:, parts])) > MORE * most
        off &= planted
        if not off.any():
            break
        for foot, here in spans:
            if off[here, foot].any():
                shares[here, foot] = share
    return found


def hands_within_changes(clip: MotionClip, most_rad_s: float) -> MotionClip:
    """Return the motion with the angular velocity of each hand in the world changing by at most `HANDS` times
    ``most_rad_s`` from frame to frame, by bending wrists, since the changes of shoulder, elbow and wrist add up; less
    where a wrist would change by more than that instead. The same object is returned if no change is greater.
    """
    parts, most_rad = [SEGMENTS.index(name) for name in _HANDS], HANDS * most_rad_s / float(clip.fps)
    world = clip.world().rotations[:, 1:]
    turns = world[:, parts]
    calm = _calm(turns, np.zeros((len(clip), 2), bool), HANDS * most_rad_s, float(clip.fps))
    if calm is turns:
        return clip
    arms = world[:, [SEGMENTS.index(PARENT_OF[name]) for name in _HANDS]]
    most = np.maximum(changes_rad(turns_rad(clip.rotations[:, parts])), most_rad)
    moved: BoolArray = (calm != turns).any(axis=-1)
    bends, shares = None, np.ones(moved.shape)
    for share in SHARES:
        wrists = quaternion.multiply(quaternion.conjugate(arms), calm)
        off = changes_rad(turns_rad(wrists)) > most
        if not off.any():
            break
        for hand in np.flatnonzero(off.any(axis=0)).tolist():
            for here in (slice(*run) for run in runs(maximum_filter1d(moved[:, hand], 3))):
                if off[here, hand].any():
                    shares[here, hand] = share
        if bends is None:
            bends = quaternion.to_rotation_vector(quaternion.multiply(calm, quaternion.conjugate(turns)))
        calm = quaternion.multiply(quaternion.from_rotation_vector(shares[..., None] * bends), turns)
    rotations = clip.rotations.copy(order="K")
    rotations[:, parts] = quaternion.multiply(quaternion.conjugate(arms), calm)
    return replace(clip, rotations=quaternion.continuous(rotations))


def _calm(rotations: FloatArray, held: BoolArray, most_rad_s: float, fps: float) -> FloatArray:
    """Bend rotations (F, P, 4) of P parts where the angular velocity changes by more than ``most_rad_s`` from frame to
    frame; those marked in ``held`` (F, P) stay. The same object is returned if no change is greater.
    """
    most_rad = ROOM * most_rad_s / fps
    if len(rotations) < 3:
        return rotations
    snaps = sudden(rotations, most_rad)
    # A change amid frames that all stay cannot be avoided.
    snaps[1:-1] &= ~(held[:-2] & held[1:-1] & held[2:])
    if not snaps.any():
        return rotations
    around = 2 * (round(AROUND_S * fps) + EDGE) + 1
    spans = [
        (slice(start, stop), part)
        for part in range(held.shape[1])
        for start, stop in runs(maximum_filter1d(snaps[:, part], around))
    ]
    # All spans are bent as one path: the frames at which they meet stay.
    paths, stay = [], []
    for here, part in spans:
        turned = np.cumsum(turns_rad(rotations[here, part]), axis=0)
        paths.append(np.concatenate([np.zeros((1, 3)), turned]))
        own = held[here, part].copy()
        own[:EDGE] = own[-EDGE:] = True
        stay.append(own)
    path = np.concatenate(paths)
    change = quaternion.from_rotation_vector(bent(path, most_rad, np.concatenate(stay), ROUNDS) - path)
    result, first = rotations.copy(order="K"), 0
    for here, part in spans:
        stop = first + here.stop - here.start
        result[here, part] = quaternion.multiply(change[first:stop], result[here, part])
        first = stop
    return result


def _held(planted: BoolArray, fps: float, lands_s: float) -> BoolArray:
    """Mark the joints (F, 16) that stay: the hips always, and the legs of feet that stand or are about to land."""
    lands = planted.copy()
    for ahead in range(1, min(round(lands_s * fps), len(planted) - 1) + 1):
        lands[:-ahead] |= planted[ahead:]
    held = np.zeros((len(planted), len(SEGMENTS)), bool)
    for part, name in enumerate(SEGMENTS):
        if not part:
            held[:, part] = True
        elif name.endswith(("Leg", "Foot")):
            held[:, part] = lands[:, int(name.startswith("right"))]
    return held
