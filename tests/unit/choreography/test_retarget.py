"""Motion of the 16 segments on bundled characters, compared with a calculation joint by joint with scipy."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import BodyShape, MotionClip
from app.choreography.retarget import retarget
from app.choreography.skin_around import skin_around
from app.choreography.soles_on_floor import over_the_floor
from app.motion.model import Motion
from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.model import Character
from app.rig.skeleton import rest_positions
from app.rig.sole import roll_point_m
from tests.support.dances import stepping

FRAMES = 240
HIPS_M, ANKLE_M = 0.95, 0.08
ARM, LEG = [(0.18, 0.22, 0), (0.3, 0, 0), (0.26, 0, 0)], [(0.1, -0.04, 0), (0, -0.43, 0), (0, -0.40, 0)]
MIRRORED = np.array((-1, 1, 1))
SHAPE = BodyShape.of(
    np.array([(0, HIPS_M, 0), (0, 0.1, 0), (0, 0.2, 0), (0, 0.3, 0), *ARM, *(ARM * MIRRORED), *LEG, *(LEG * MIRRORED)]),
    np.array([(0, 0.25, 0), (0.18, 0, 0), (-0.18, 0, 0), (0, -ANKLE_M, 0.2), (0, -ANKLE_M, 0.2)], np.float64),
)


def still(frames: int = FRAMES) -> MotionClip:
    rotations = np.zeros((frames, len(SEGMENTS), 4))
    rotations[..., 3] = 1.0
    return MotionClip(SHAPE, Fraction(60), np.tile((0.0, HIPS_M, 0.0), (frames, 1)), rotations)


def moving(seed: int = 3) -> MotionClip:
    """Smooth rotations of all segments up to about 60 degrees on a path, with knees bent so that no leg is fully
    extended.
    """
    random = np.random.default_rng(seed)
    keys = np.linspace(0, FRAMES - 1, 9)
    clip = still()
    rotations = clip.rotations.copy()
    for at in range(len(SEGMENTS)):
        turns = Rotation.from_rotvec(random.normal(0.0, 0.35, (len(keys), 3)))
        rotations[:, at] = Slerp(keys, turns)(np.arange(FRAMES)).as_quat()
    for side in ("left", "right"):
        for name, angle in (("UpperLeg", -0.6), ("LowerLeg", 1.1)):
            at = SEGMENTS.index(side + name)
            less = Rotation.from_rotvec(0.2 * Rotation.from_quat(rotations[:, at]).as_rotvec())
            rotations[:, at] = (Rotation.from_rotvec((angle, 0, 0)) * less).as_quat()
    hips = clip.hips_m + np.stack([np.linspace(0, 1, FRAMES), np.full(FRAMES, 0.1), np.linspace(0, -0.5, FRAMES)], 1)
    return replace(clip, rotations=rotations, hips_m=hips)


def joints(character: Character, motion: Motion, frame: int) -> dict[str, tuple[FloatArray, Rotation]]:
    """Position and rotation of every joint, calculated in a loop."""
    skeleton, found = character.skeleton, dict[str, tuple[FloatArray, Rotation]]()
    for at, (name, parent) in enumerate(zip(skeleton.names, skeleton.parents, strict=True)):
        turn = Rotation.from_quat(motion.rotations[frame, at].astype(np.float64))
        offset = motion.hips_m[frame].astype(np.float64) if name == "hips" else skeleton.offsets_m[at]
        if parent < 0:
            found[name] = offset, turn
        else:
            place, above = found[skeleton.names[parent]]
            found[name] = place + above.apply(offset), above * turn
    return found


@pytest.mark.parametrize("character", [character_named(name) for name in bundled_characters()], ids=lambda one: one.id)
def test_a_standing_body_stands(character: Character) -> None:
    found = joints(character, retarget(still(), character), 7)
    rest = rest_positions(character.skeleton)
    for name, (place, turn) in found.items():
        if "Proximal" in name or "Intermediate" in name or "Distal" in name or "Thumb" in name:
            continue
        # The collar bones of arms held out begin to rise; a straight leg keeps a little bend in its knee.
        loose = 0.05 if "Shoulder" in name else 0.25 if "Leg" in name else 5e-3
        assert turn.magnitude() < loose, name
        near_m = 0.08 if "LowerLeg" in name else 0.025
        assert np.linalg.norm(place - rest[character.skeleton.index(name)]) < near_m, name


def test_segments_and_joints_turn_alike() -> None:
    character, clip = character_named("woman_adult"), moving()
    motion, world = retarget(clip, character), clip.world()
    for frame in (0, 60, 133, FRAMES - 1):
        found = joints(character, motion, frame)
        for at, name in enumerate(SEGMENTS):
            wide = "UpperLeg" in name or "LowerLeg" in name
            joint = {"chest": "upperChest"}.get(name, name)
            off = found[joint][1].inv() * Rotation.from_quat(world.rotations[frame, 1 + at])
            # Legs go where the ankles have to be.
            assert off.magnitude() < (0.35 if wide else 2e-3), (name, frame)


@pytest.mark.parametrize("end_m", [0.15, 0.2])
def test_balls_of_feet_go_the_scaled_path_of_captured_feet_and_stay_where_they_stand(end_m: float) -> None:
    ends = SHAPE.ends_m.copy()
    ends[3:, 2] = end_m
    character, clip = character_named("man_adult"), stepping(4)
    # The dancer turns and walks on.
    hips_m = clip.hips_m + np.linspace(0.0, 0.3, len(clip))[:, None] * (1.0, 0.0, 0.5)
    rotations = clip.rotations.copy()
    rotations[:, 0] = Rotation.from_rotvec(np.linspace(0.0, 1.0, len(clip))[:, None] * (0.0, 1.0, 0.0)).as_quat()
    clip = replace(clip, shape=BodyShape.of(SHAPE.offsets_m, ends), rotations=rotations, hips_m=hips_m)
    motion, world = retarget(clip, character), clip.world()
    rest = rest_positions(character.skeleton)
    scale = rest[character.skeleton.index("leftUpperLeg"), 1] / (HIPS_M - 0.04)
    for side in ("left", "right"):
        foot = 1 + SEGMENTS.index(side + "Foot")
        turns = Rotation.from_quat(world.rotations[:, foot])
        source = scale * (world.positions_m[:, foot] + turns.apply(ends[3]))
        ankle, toes = (rest[character.skeleton.index(side + name)] for name in ("Foot", "Toes"))
        if end_m == 0.2:
            # The captured foot's end is its tip, farther ahead than the ball.
            behind_m = scale * end_m - np.hypot(*(toes - ankle)[[0, 2]])
            ahead = turns.apply((0.0, 0.0, 1.0)) * (1.0, 0.0, 1.0)
            source -= behind_m * ahead / np.linalg.norm(ahead, axis=1, keepdims=True)
        balls = np.array([joints(character, motion, frame)[side + "Toes"][0] for frame in range(0, len(clip), 15)])
        assert np.abs(np.diff(balls, axis=0) - np.diff(source[::15], axis=0))[:, [0, 2]].max() < 2e-3


def test_no_sole_is_below_the_floor() -> None:
    character, clip = character_named("woman_adult"), moving()
    sunk = replace(clip, hips_m=clip.hips_m - (0.0, 0.25, 0.0))
    motion = retarget(sunk, character)
    rest = rest_positions(character.skeleton)
    for frame in range(0, FRAMES, 20):
        found = joints(character, motion, frame)
        for side in ("left", "right"):
            place, turn = found[side + "Foot"]
            ankle, toes = (rest[character.skeleton.index(side + name)] for name in ("Foot", "Toes"))
            for part in (-0.3, 1.0):
                way = part * (toes - ankle)
                assert (place + turn.apply((way[0], -ankle[1], way[2])))[1] > -1e-3
            place, turn = found[side + "Toes"]
            tip = 0.4 * (toes - ankle)
            assert (place + turn.apply((tip[0], -toes[1], tip[2])))[1] > -6e-3


@pytest.mark.parametrize("apart_deg", [20, 40, 88])
def test_straight_legs_apart_stand_on_the_floor_and_splits_go_no_deeper_than_the_dancers(apart_deg: float) -> None:
    character, clip = character_named("woman_adult"), still(60)
    rotations = clip.rotations.copy()
    for side, sign in (("left", 1.0), ("right", -1.0)):
        turn = Rotation.from_euler("z", sign * apart_deg, degrees=True)
        rotations[:, SEGMENTS.index(side + "UpperLeg")] = turn.as_quat()
        rotations[:, SEGMENTS.index(side + "Foot")] = turn.inv().as_quat()
    found = joints(character, retarget(replace(clip, rotations=rotations), character), 30)
    rest = rest_positions(character.skeleton)
    scale = rest[character.skeleton.index("leftUpperLeg"), 1] / (HIPS_M - 0.04)
    dancers_m = scale * (ANKLE_M - (LEG[1][1] + LEG[2][1]) * np.cos(np.radians(apart_deg)))
    names = ("UpperLeg", "LowerLeg", "Foot")
    hip, knee, ankle = (rest[character.skeleton.index("left" + name)] for name in names)
    length_m = np.linalg.norm(knee - hip) + np.linalg.norm(ankle - knee)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        (socket_m, _), (foot_m, _) = found[side + "UpperLeg"], found[side + "Foot"]
        assert foot_m[1] == pytest.approx(ankle[1], abs=3e-3)
        # As far apart as the dancer's feet, or as far as the leg reaches from the height of the dancer's hip joints.
        dancers_foot_m = scale * (LEG[0][0] - (LEG[1][1] + LEG[2][1]) * np.sin(np.radians(apart_deg)))
        farthest_m = hip[0] + np.sqrt(length_m**2 - (socket_m[1] - foot_m[1]) ** 2)
        assert sign * foot_m[0] == pytest.approx(min(dancers_foot_m, farthest_m), abs=0.012)
        # Shorter legs, and hip joints nearer together, reach it from lower down: no lower than they must, and never
        # quite stretched.
        across_m = np.hypot(*(socket_m - foot_m)[[0, 2]])
        least_m = foot_m[1] + np.sqrt(max((0.99 * length_m) ** 2 - across_m**2, 0.0))
        assert min(least_m, dancers_m) - 0.001 < socket_m[1] < dancers_m + 0.001


def test_collars_rise_with_lifted_arms_only() -> None:
    character, clip = character_named("woman_adult"), still(3)
    rotations = clip.rotations.copy()
    at = SEGMENTS.index("leftUpperArm")
    for frame, rise_deg in enumerate((-75, 0, 75)):
        rotations[frame, at] = Rotation.from_euler("z", rise_deg, degrees=True).as_quat()
    motion = retarget(replace(clip, rotations=rotations), character)
    heights = [joints(character, motion, frame)["leftUpperArm"][0][1] for frame in range(3)]
    assert heights[0] <= heights[1] < heights[1] + 0.02 < heights[2]
    wrists = [joints(character, motion, frame)["leftHand"][0][1] for frame in range(3)]
    assert wrists == sorted(wrists)


def test_one_frame_is_a_motion() -> None:
    motion = retarget(still(1), character_named("woman_adult"), first_frame_s=-2.0)
    assert motion.frames == 1
    assert motion.first_frame_s == -2.0


def skin_heights_m(character: Character, motion: Motion, frame: int, part: str) -> FloatArray:
    """Heights of all vertices that the joints of a part of the body have most weight for, calculated one by one."""
    found, heights = joints(character, motion, frame), []
    for mesh in character.meshes:
        most = mesh.joints[np.arange(len(mesh.joints)), mesh.weights.argmax(axis=1)]
        for row in np.flatnonzero([part in character.skeleton.names[joint] for joint in most])[::7]:
            height = 0.0
            for joint, weight in zip(mesh.joints[row], mesh.weights[row], strict=True):
                bind = character.joint_from_mesh[joint]
                place, turn = found[character.skeleton.names[joint]]
                height += weight * (place + turn.apply(bind[:3, :3] @ mesh.positions_m[row] + bind[:3, 3]))[1]
            heights.append(height)
    return np.array(heights)


@pytest.mark.parametrize("roll_deg", [-35.0, 0.0, 35.0])
def test_no_edge_of_a_standing_foot_is_below_the_floor_and_one_in_the_air_stays_rolled(roll_deg: float) -> None:
    character, clip = character_named("woman_adult"), still()
    rotations = clip.rotations.copy()
    rotations[:, SEGMENTS.index("leftFoot")] = Rotation.from_euler("z", roll_deg, degrees=True).as_quat()
    # The same foot is in the air from the middle on.
    for name, bend in (("UpperLeg", -70.0), ("LowerLeg", 70.0)):
        turn = Rotation.from_euler("x", bend, degrees=True)
        rotations[FRAMES // 2 :, SEGMENTS.index(f"left{name}")] = turn.as_quat()
    motion = retarget(replace(clip, rotations=rotations), character)
    standing, raised = FRAMES // 4, FRAMES - 1
    assert -1e-3 < skin_heights_m(character, motion, standing, "leftFoot").min() < 8e-3
    turned = {frame: joints(character, motion, frame)["leftFoot"][1] for frame in (standing, raised)}
    # Its middle is a little over the floor, as that of a foot that was captured on its edge.
    assert turned[standing].magnitude() < np.radians(0.4 * abs(roll_deg) + 1.0)
    assert np.degrees(turned[raised].as_rotvec()[2]) == pytest.approx(roll_deg, abs=2.0)


def test_a_kneeling_knee_is_on_the_floor_and_a_standing_body_is_not_lifted() -> None:
    character, clip = character_named("man_adult"), still()
    rotations, hips_m = clip.rotations.copy(), clip.hips_m.copy()
    kneeling = slice(FRAMES // 2, None)
    for side in ("left", "right"):
        for name, bend in (("LowerLeg", 90.0), ("Foot", 70.0)):
            turn = Rotation.from_euler("x", bend, degrees=True)
            rotations[kneeling, SEGMENTS.index(side + name)] = turn.as_quat()
    # The captured knees, joints without flesh, are on the floor.
    hips_m[kneeling, 1] = 0.04 + 0.43
    motion = retarget(replace(clip, rotations=rotations, hips_m=hips_m), character)
    lowest = [skin_heights_m(character, motion, FRAMES - 1, part).min() for part in ("LowerLeg", "UpperLeg")]
    assert -0.01 < min(lowest) < 0.03
    lifted = retarget(still(), character).hips_m[FRAMES // 4, 1]
    assert motion.hips_m[FRAMES // 4, 1] == pytest.approx(lifted, abs=5e-3)


def test_a_foot_rolls_over_its_ball_with_its_toes_flat_on_the_floor() -> None:
    character, fps = character_named("woman_adult"), 60.0
    ball = roll_point_m(character.skeleton, "left")
    rest_m = float(rest_positions(character.skeleton)[character.skeleton.index("leftToes"), 1])
    bend_deg = np.concatenate([np.zeros(20), np.linspace(0.0, 35.0, 20), np.full(60, 35.0)])
    foot = Rotation.from_euler("x", bend_deg[:, None], degrees=True).as_quat()
    # It stands on its ball for forty frames, and then leaves, high enough for toes that are straight.
    rises_m = np.minimum(np.maximum(np.arange(100) - 39, 0), 30)
    ball_m = np.outer(rises_m, (0.0, 0.01, 0.005)) + np.array((0.0, rest_m, 0.0))
    placed = over_the_floor(character, "left", foot, ball_m - Rotation.from_quat(foot).apply(ball), fps)
    after_m = placed.ankle_m + Rotation.from_quat(placed.rotations).apply(ball)
    assert np.ptp(after_m[:40], axis=0).max() < 5e-3
    # Toes are level under the raised heel, and straight in the air.
    level_deg = np.degrees((Rotation.from_quat(foot) * Rotation.from_quat(placed.toes)).as_rotvec()[:, 0])
    assert np.abs(level_deg[25:39]).max() < 3.0
    assert np.degrees(Rotation.from_quat(placed.toes[80:]).magnitude()).max() < 2.0
    hull_m = skin_around(character, [character.skeleton.index("leftFoot")])[0].rest_m
    hull_m = hull_m - rest_positions(character.skeleton)[character.skeleton.index("leftFoot")]
    lowest_m = [
        (place + Rotation.from_quat(turn).apply(hull_m))[:, 1].min()
        for place, turn in zip(placed.ankle_m, placed.rotations, strict=True)
    ]
    assert min(lowest_m) > -0.0055
