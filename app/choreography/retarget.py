"""Transfer of a motion of the 16 segments to the skeleton of a character.

Each segment's world rotation becomes that of the character's joint. Other joints follow: vertebrae and neck rotate
between their neighbours, the collar bones rise with arms above the shoulders, fingers are loosely bent. The path is
scaled by the length of the legs; the balls of the feet reach their scaled places by inverse kinematics, so that planted
feet stay planted, no sole is below the floor, and toes are bent where a foot rolls over its ball.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from app.arrays import FloatArray
from app.choreography.arms_apart import arms_apart
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.body_on_floor import needed_lifts
from app.choreography.clip import BodyShape, MotionClip
from app.choreography.limbs import smooth_share
from app.choreography.soles_on_floor import HEEL_PART, over_the_floor
from app.choreography.standing_feet import SINK_S
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.ik import Side, leg, solve_limb
from app.rig.model import Character, Skeleton
from app.rig.skeleton import rest_positions
from app.rig.sole import SIDES, TIP_PART, roll_point_m, sole_way_m, without_stiff_toes

TRUNK: Final[tuple[str, ...]] = ("spine", "chest", "upperChest")
LEG: Final = ("UpperLeg", "LowerLeg")
COLLAR_SHARE: Final = 0.25
"""Share of an arm's rise above the horizontal that the collar bone takes (about a third of an arm's rise is due to the
shoulder girdle: V. Inman and others, J. Bone Joint Surg. 26, 1944; the collar bone's joint is farther in, so less is
visible).
"""
COLLAR_SOFT_RAD: Final = 0.15
"""Angle in radians about the horizontal over which this begins."""
FINGER_BEND_RAD: Final = {"Proximal": 0.30, "Intermediate": 0.40, "Distal": 0.20}
"""Bend in radians of each bone of loosely bent fingers; the little finger's is larger than the index finger's by
`FINGER_GROWS`.
"""
FINGER_GROWS: Final = {"Index": 0.8, "Middle": 1.0, "Ring": 1.15, "Little": 1.3}
THUMB_BEND_RAD: Final = {"ThumbMetacarpal": 0.10, "ThumbProximal": 0.15, "ThumbDistal": 0.20}
LIFTS: Final = 3
"""Greatest number of lifts of a body from the floor; a knee rises less than the hips."""
REACH_SHARE: Final = 0.992
"""Largest reach of a foot on the floor, as a share of the leg's length."""
LOW_M: Final = 0.08
"""Height in metres of an ankle above its standing height up to which its foot is on the floor."""
STANDING_M_S: Final = 0.2
"""Speed in metres per second below which a foot stands."""
LEAST_AHEAD: Final = 0.35
"""Horizontal part of a foot's direction below which it is no longer lengthened to 1, since a foot that points down has
no direction ahead."""
BALL_M: Final = (0.02, 0.04)
"""Differences in metres of the distances from the ankle of a captured foot's end and of the character's ball up to
which that end is the ball, and from which it is not."""
RAISED_M: Final = (0.15, 0.45)
"""Heights in metres of an ankle above its standing height between which a foot's place changes from one relative to the
floor to one relative to the hip joint."""
KNEE_AHEAD: Final = 0.02
"""Distance by which the knee of a straight leg points forward, relative to the leg's length."""


def retarget(clip: MotionClip, character: Character, first_frame_s: float = 0.0) -> Motion:
    """Transfer a motion to a character.

    Parameters
    ----------
    first_frame_s : float
        Time of the clip's first frame in the performance.

    Returns
    -------
    Motion
        Motion of the character's body, without morphs, controls and instrument.
    """
    character = without_stiff_toes(character)
    skeleton, frames = character.skeleton, len(clip)
    source = clip.world()
    segments = {name: source.rotations[:, 1 + at] for at, name in enumerate(SEGMENTS)}
    places_m = {name: source.positions_m[:, 1 + at] for at, name in enumerate(SEGMENTS)}
    scale = _socket_height_m(skeleton) / _clip_socket_height_m(clip.shape)
    hips_m = _hips_path(skeleton, clip, segments["hips"], places_m, scale)
    # Legs reach the floor later; until then their rotations are the captured ones.
    legs = {skeleton.index(name): segments[name] for name in (f"{side}{part}" for side in SIDES for part in LEG)}
    turned = _world_rotations(skeleton, segments, frames) | legs
    world = arms_apart(character, turned, hips_m, float(clip.fps))
    ankles_m = {side: _ankle_path(skeleton, side, clip.shape, segments, places_m, scale) for side in SIDES}
    floor_m = _floor_m(skeleton, segments, ankles_m, float(clip.fps))
    hips_m -= floor_m
    sockets_m = _socket_paths(skeleton, world, hips_m)
    feet = {}
    for side in SIDES:
        ankle_m = _raised(skeleton, side, places_m, sockets_m[side], ankles_m[side] - floor_m)
        feet[side] = over_the_floor(character, side, segments[f"{side}Foot"], ankle_m, float(clip.fps))
    ankles_m = {side: foot.ankle_m for side, foot in feet.items()}
    hips_m[:, 1] -= _sink_m(skeleton, clip, world, hips_m, ankles_m)
    targets = {side: (ankles_m[side], foot.rotations) for side, foot in feet.items()}
    local = _local(skeleton, segments, places_m, world, hips_m, targets)
    for _ in range(LIFTS):
        lifts = needed_lifts(character, local, hips_m, float(clip.fps))
        if lifts is None:
            break
        hips_m[:, 1] += lifts.hips_m
        for side in SIDES:
            targets[side][0][:, 1] += lifts.ankles_m[side]
        local = _local(skeleton, segments, places_m, world, hips_m, targets)
    for side in SIDES:
        if f"{side}Toes" in skeleton.names:
            local[:, skeleton.index(f"{side}Toes")] = feet[side].toes
    _bend_fingers(skeleton, local)
    return Motion(
        fps=clip.fps,
        first_frame_s=first_frame_s,
        rotations=quaternion.continuous(quaternion.normalize(local)).astype(np.float32),
        hips_m=hips_m.astype(np.float32),
        morphs={},
        controls={},
        instrument_position_m=np.zeros((frames, 3), np.float32),
        instrument_rotation=np.tile(quaternion.IDENTITY, (frames, 1)).astype(np.float32),
    )


def _local(
    skeleton: Skeleton,
    segments: dict[str, FloatArray],
    places_m: dict[str, FloatArray],
    world: dict[int, FloatArray],
    hips_m: FloatArray,
    targets: dict[Side, tuple[FloatArray, FloatArray]],
) -> FloatArray:
    """Return the local rotations (F, J, 4) of all joints, with fingers at rest: those above the legs have their world
    rotations ``world`` (F, 4) by joint index, and the feet are at their targets, see `_leg`.
    """
    sockets_m = _socket_paths(skeleton, world, hips_m)
    legs = {side: _leg(skeleton, side, segments, places_m, world, sockets_m[side], targets[side]) for side in SIDES}
    local = np.tile(quaternion.IDENTITY, (len(hips_m), len(skeleton.names), 1))
    for joint, parent in enumerate(skeleton.parents):
        if joint in world:
            above = world.get(parent)
            local[:, joint] = (
                world[joint] if above is None else quaternion.multiply(quaternion.conjugate(above), world[joint])
            )
    for side in SIDES:
        for joint, turned in legs[side].items():
            local[:, joint] = turned
    return local


def _socket_height_m(skeleton: Skeleton) -> float:
    """Height in metres of the hip joints above the floor in the T-pose."""
    rest = rest_positions(skeleton)
    return float(np.mean([rest[skeleton.index(f"{side}UpperLeg"), 1] for side in SIDES]))


def _clip_socket_height_m(shape: BodyShape) -> float:
    offsets = shape.offsets_m
    return float(offsets[0, 1] + np.mean([offsets[SEGMENTS.index(f"{side}UpperLeg"), 1] for side in SIDES]))


def _hips_path(
    skeleton: Skeleton, clip: MotionClip, turned: FloatArray, places_m: dict[str, FloatArray], scale: float
) -> FloatArray:
    """Path (F, 3) of the character's hips for which the midpoint of its hip joints follows that of the clip, scaled by
    ``scale``.
    """
    middle = 0.5 * (places_m["leftUpperLeg"] + places_m["rightUpperLeg"])
    offset = np.mean([skeleton.offsets_m[skeleton.index(f"{side}UpperLeg")] for side in SIDES], axis=0)
    return scale * middle - quaternion.rotate(turned, offset)


def _world_rotations(skeleton: Skeleton, segments: dict[str, FloatArray], frames: int) -> dict[int, FloatArray]:
    """World rotations (F, 4), by joint index, of the root and of all joints above the legs."""
    there = set(skeleton.names)
    world = {0: np.tile(quaternion.IDENTITY, (frames, 1)), skeleton.index("hips"): segments["hips"]}
    trunk = [name for name in TRUNK if name in there]
    for at, name in enumerate(trunk):
        share = 1.0 if len(trunk) == 1 else at / (len(trunk) - 1)
        world[skeleton.index(name)] = quaternion.slerp(segments["spine"], segments["chest"], np.full(frames, share))
    if "neck" in there:
        world[skeleton.index("neck")] = quaternion.slerp(segments["chest"], segments["head"], np.full(frames, 0.5))
    world[skeleton.index("head")] = segments["head"]
    for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
        upper = segments[f"{side}UpperArm"]
        if f"{side}Shoulder" in there:
            world[skeleton.index(f"{side}Shoulder")] = quaternion.multiply(
                segments["chest"], _collar(segments["chest"], upper, sign)
            )
        for name in ("UpperArm", "LowerArm", "Hand"):
            world[skeleton.index(f"{side}{name}")] = segments[f"{side}{name}"]
    return world


def _collar(chest: FloatArray, upper: FloatArray, sign: float) -> FloatArray:
    """Rotation (F, 4) of a collar bone in the chest's frame, which rises with an upper arm above the shoulder."""
    along = quaternion.rotate(quaternion.multiply(quaternion.conjugate(chest), upper), np.array([sign, 0.0, 0.0]))
    rise = np.arcsin(np.clip(along[:, 1], -1.0, 1.0))
    lifted = COLLAR_SHARE * COLLAR_SOFT_RAD * np.logaddexp(0.0, rise / COLLAR_SOFT_RAD)
    # With a hanging arm the collar bone keeps its exact captured rotation.
    lifted = np.where(rise < -6.0 * COLLAR_SOFT_RAD, 0.0, lifted)
    return quaternion.from_axis_angle(np.array([0.0, 0.0, sign]), lifted)


def _socket_paths(skeleton: Skeleton, world: dict[int, FloatArray], hips_m: FloatArray) -> dict[Side, FloatArray]:
    """World positions (F, 3) of the hip joints by side, from world rotations (F, 4) by joint and hip
    positions (F, 3).
    """
    hips = skeleton.index("hips")
    return {
        side: hips_m + quaternion.rotate(world[hips], skeleton.offsets_m[skeleton.index(f"{side}UpperLeg")])
        for side in SIDES
    }


def _ankle_path(
    skeleton: Skeleton,
    side: Side,
    shape: BodyShape,
    segments: dict[str, FloatArray],
    places_m: dict[str, FloatArray],
    scale: float,
) -> FloatArray:
    """Path (F, 3) of a character's ankle for which the point about which its foot rolls follows the scaled path of the
    end of the clip's foot.

    So the ball of a standing foot stays in place while the heel rises, for feet of any length: the end of a captured
    foot is its ball in most files. Where it is farther ahead than the character's, the ball is behind it.
    """
    foot = f"{side}Foot"
    end, roll = shape.ends_m[ENDS.index(foot)], roll_point_m(skeleton, side)
    flat_m = _clip_ankle_height_m(shape, side) + float(end[1])
    path = scale * (places_m[foot] + quaternion.rotate(segments[foot], end) - (0.0, flat_m, 0.0))
    reach_m, own_m = scale * float(np.hypot(end[0], end[2])), float(np.hypot(roll[0], roll[2]))
    ahead = quaternion.rotate(segments[foot], end * (1.0, 0.0, 1.0) / max(reach_m / scale, 1e-9)) * (1.0, 0.0, 1.0)
    ahead /= np.maximum(np.linalg.norm(ahead, axis=1, keepdims=True), LEAST_AHEAD)
    farther_m = max(reach_m - own_m, 0.0)
    path -= farther_m * smooth_share(np.array(farther_m), BALL_M) * ahead
    path[:, 1] += sole_way_m(skeleton, side)[1] + roll[1]
    return np.asarray(path - quaternion.rotate(segments[foot], roll))


def _raised(
    skeleton: Skeleton, side: Side, places_m: dict[str, FloatArray], socket_m: FloatArray, ankle_m: FloatArray
) -> FloatArray:
    """Return the path (F, 3) of an ankle with a foot high over the floor as far from the hip joint, relative to the
    leg's length, as in the clip: so a kick stretches legs of other proportions no more than those of the dancer.
    """
    hip, knee, ankle = (places_m[f"{side}{name}"] for name in ("UpperLeg", "LowerLeg", "Foot"))
    length_m = float(np.linalg.norm(knee[0] - hip[0]) + np.linalg.norm(ankle[0] - knee[0]))
    as_far_m = socket_m + (ankle - hip) * (leg(skeleton, side).length_m / length_m)
    height_m = ankle_m[:, 1] - rest_positions(skeleton)[skeleton.index(f"{side}Foot"), 1]
    return np.asarray(ankle_m + smooth_share(height_m, RAISED_M)[:, None] * (as_far_m - ankle_m))


def _floor_m(
    skeleton: Skeleton, segments: dict[str, FloatArray], ankles_m: dict[Side, FloatArray], fps: float
) -> FloatArray:
    """Position (3,) of the floor relative to the origin: the height of the soles while feet stand, since captured feet
    are seldom exactly at 0.
    """
    heights = []
    for side in SIDES:
        if len(ankles_m[side]) < 2:
            continue
        slow = np.linalg.norm(np.gradient(ankles_m[side], axis=0), axis=-1) * fps < STANDING_M_S
        heights.append(_sole_m(skeleton, side, segments[f"{side}Foot"], ankles_m[side])[slow])
    standing = np.concatenate(heights) if heights else np.zeros(0)
    # Feet in the lowest half of heights stood on the floor; a foot held still in the air is higher.
    return np.array([0.0, float(np.percentile(standing, 30.0)) if len(standing) else 0.0, 0.0])


def _sink_m(
    skeleton: Skeleton,
    clip: MotionClip,
    world: dict[int, FloatArray],
    hips_m: FloatArray,
    ankles_m: dict[Side, FloatArray],
) -> FloatArray:
    """Distance (F,) in metres by which the hips must be lowered so that the character's legs reach the floor."""
    sink, sockets_m, fps = np.zeros(len(clip)), _socket_paths(skeleton, world, hips_m), float(clip.fps)
    height_m = {side: rest_positions(skeleton)[skeleton.index(f"{side}Foot"), 1] for side in SIDES}
    for side in SIDES:
        length_m = leg(skeleton, side).length_m
        way = sockets_m[side] - ankles_m[side]
        allowed = np.sqrt(
            np.maximum((REACH_SHARE * length_m) ** 2 - np.square(way[:, [0, 2]]).sum(axis=1), 0.25 * length_m**2)
        )
        low = ankles_m[side][:, 1] < height_m[side] + LOW_M
        sink = np.maximum(sink, np.where(low, way[:, 1] - allowed, 0.0))
    if not sink.any():
        return sink
    wide = 2 * round(2.5 * SINK_S * fps) + 1
    return np.asarray(gaussian_filter1d(maximum_filter1d(sink, wide, mode="nearest"), SINK_S * fps, mode="nearest"))


def _leg(
    skeleton: Skeleton,
    side: Side,
    segments: dict[str, FloatArray],
    places_m: dict[str, FloatArray],
    world: dict[int, FloatArray],
    socket_m: FloatArray,
    target: tuple[FloatArray, FloatArray],
) -> dict[int, FloatArray]:
    """Return rotations (F, 4) of a leg's joints, by joint index, that bring the ankle to ``target``: positions (F, 3)
    and world rotations (F, 4) of the foot. ``segments`` and ``places_m`` are the captured rotations and positions by
    bone name.
    """
    limb = leg(skeleton, side)
    hip, knee, ankle = (places_m[f"{side}{name}"] for name in ("UpperLeg", "LowerLeg", "Foot"))
    length_m = float(np.linalg.norm(knee[0] - hip[0]) + np.linalg.norm(ankle[0] - knee[0]))
    # The direction of a straight leg's knee follows from its thigh.
    ahead = quaternion.rotate(segments[f"{side}UpperLeg"], np.array([0.0, 0.0, 1.0]))
    pole = knee - 0.5 * (hip + ankle) + KNEE_AHEAD * length_m * ahead
    pose = solve_limb(limb, socket_m, world[skeleton.index("hips")], *target, pole)
    return {limb.upper: pose.upper, limb.lower: pose.lower, limb.end: pose.end}


def _clip_ankle_height_m(shape: BodyShape, side: Side) -> float:
    """Height in metres of the captured body's ankle above its sole in the T-pose."""
    height = sum(shape.offsets_m[SEGMENTS.index(name), 1] for name in ("hips", f"{side}UpperLeg", f"{side}LowerLeg"))
    return float(height + shape.offsets_m[SEGMENTS.index(f"{side}Foot"), 1])


def _sole_m(skeleton: Skeleton, side: Side, foot: FloatArray, ankle_m: FloatArray) -> FloatArray:
    """Height (F,) in metres of the lowest point of a sole: heel or ball, or tip without a joint of the toes."""
    way, height_m = sole_way_m(skeleton, side)
    parts = (-HEEL_PART, 1.0) if f"{side}Toes" in skeleton.names else (-HEEL_PART, 1.0, 1.0 + TIP_PART)
    sole = [np.array([part * way[0], -height_m, part * way[2]]) for part in parts]
    lowest: FloatArray = np.min([ankle_m[:, 1] + quaternion.rotate(foot, point)[:, 1] for point in sole], axis=0)
    return lowest


def _bend_fingers(skeleton: Skeleton, local: FloatArray) -> None:
    """Bend the fingers loosely towards the palm, in place in ``local``."""
    for joint, name in enumerate(skeleton.names):
        for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
            if not name.startswith(side):
                continue
            for finger, grows in FINGER_GROWS.items():
                for part, bend in FINGER_BEND_RAD.items():
                    if name == f"{side}{finger}{part}":
                        local[:, joint] = quaternion.from_axis_angle(np.array([0.0, 0.0, -sign]), bend * grows)
            for part, bend in THUMB_BEND_RAD.items():
                if name == f"{side}{part}":
                    local[:, joint] = quaternion.from_axis_angle(np.array([0.0, sign, 0.0]), -bend)
