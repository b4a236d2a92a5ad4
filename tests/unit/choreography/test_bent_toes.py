"""Toes of characters, measured on the skin of a foot that rises onto its ball."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.arrays import FloatArray
from app.choreography.bent_toes import MOST_RAD, toe_bend_rad
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.feet_on_floor import legs_to
from app.choreography.retarget import retarget
from app.rig import quaternion
from app.rig.characters.character_library import character_named
from app.rig.characters.load_character import load_character
from app.rig.model import Character
from app.rig.skeleton import forward
from app.rig.sole import foot_tip_m
from tests.support.dances import still

AHEAD = np.array([0.0, 0.0, 1.0])


def on_toes(raised_deg: FloatArray, swivelled_deg: float = 0.0, reach_m: float = 0.14) -> MotionClip:
    """Both feet pitch and swivel about their ends, which stand, while the hips stay a little lower than at rest."""
    clip = still(len(raised_deg))
    ends = clip.shape.ends_m.copy()
    ends[3:] = (0.0, -0.05, reach_m)
    clip = replace(clip, shape=replace(clip.shape, ends_m=ends), hips_m=clip.hips_m - (0.0, 0.05, 0.0))
    world = still(len(raised_deg)).world()
    stood = tips_m(replace(clip, hips_m=still(len(raised_deg)).hips_m))
    rotations = world.rotations.copy()
    swivel = quaternion.from_axis_angle((0.0, 1.0, 0.0), np.radians(np.linspace(0.0, swivelled_deg, len(clip))))
    pitch = quaternion.from_axis_angle((1.0, 0.0, 0.0), np.radians(raised_deg))
    for side in ("left", "right"):
        rotations[:, 1 + SEGMENTS.index(f"{side}Foot")] = quaternion.multiply(swivel, pitch)
    moved = replace(clip.world(), rotations=rotations)
    return legs_to(clip, moved, stood, np.ones((len(clip), 2), bool))


def shown(character: Character, clip: MotionClip) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Positions (F, 3) of the left toes' joint, and rotations (F, 4) of the foot and of the toes in the world."""
    motion, names = retarget(clip, character), character.skeleton.names
    world = forward(character.skeleton, motion.rotations.astype(np.float64), motion.hips_m.astype(np.float64))
    foot, toes = (names.index(f"left{part}") for part in ("Foot", "Toes"))
    return world.positions_m[:, toes], world.rotations[:, foot], world.rotations[:, toes]


@pytest.mark.parametrize("name", ["woman_adult", "man_adult"])
def test_a_foot_rises_onto_its_ball_and_its_toes_stay_flat(name: str) -> None:
    raised_deg = 40.0 * np.sin(np.linspace(0.0, np.pi, 90)) ** 2
    ball_m, foot, toes = shown(character_named(name), on_toes(raised_deg))
    pitch_deg = np.degrees(-np.arcsin(quaternion.rotate(foot, AHEAD)[:, 1]))
    assert pitch_deg.max() == pytest.approx(40.0, abs=2.0)
    assert np.ptp(ball_m[:, 1]) < 0.006
    assert np.ptp(ball_m[:, [0, 2]], axis=0).max() < 0.002
    assert np.degrees(np.arcsin(quaternion.rotate(toes, AHEAD)[:, 1])) == pytest.approx(0.0, abs=2.5)


def test_toes_of_feet_in_the_air_and_of_soles_that_face_back_are_straight() -> None:
    heights_m = np.array([0.05, 0.05, 0.5])
    foot = quaternion.from_axis_angle((1.0, 0.0, 0.0), np.radians([30.0, 120.0, 30.0]))
    bends = [toe_bend_rad(foot[[at]], AHEAD, heights_m[[at]], 0.05, 0.08, 60.0)[0] for at in range(3)]
    assert np.degrees(bends) == pytest.approx([30.0, 0.0, 0.0], abs=1.0)


def test_toes_bend_no_farther_than_those_of_people_and_not_suddenly() -> None:
    steep = quaternion.from_axis_angle((1.0, 0.0, 0.0), np.radians(np.minimum(80.0, 8.0 * np.arange(60))))
    leaves_m = 0.05 + 0.02 * np.maximum(np.arange(60) - 30, 0)
    bend = toe_bend_rad(steep, AHEAD, leaves_m, 0.05, 0.08, 60.0)
    assert 0.7 * MOST_RAD < bend.max() < MOST_RAD
    speeds = np.abs(np.diff(bend)) * 60.0
    assert speeds.max() < 7.0
    # Toes slow down towards their greatest bend, instead of bending at one speed.
    assert (speeds > 0.9 * speeds.max()).sum() <= 8
    assert bend[-1] < 0.02


@pytest.mark.parametrize(("swivelled_deg", "reach_m"), [(0.0, 0.14), (25.0, 0.09)])
def test_feet_of_figures_whose_toes_move_no_skin_roll_over_their_tips(swivelled_deg: float, reach_m: float) -> None:
    character = load_character(Path(__file__).parents[2] / "data" / "characters" / "elder_vrm0.vrm")
    raised_deg, skeleton = 40.0 * np.sin(np.linspace(0.0, np.pi, 90)) ** 2, character.skeleton
    motion = retarget(on_toes(raised_deg, swivelled_deg, reach_m), character)
    world = forward(skeleton, motion.rotations.astype(np.float64), motion.hips_m.astype(np.float64))
    foot = skeleton.index("leftFoot")
    tip_m = world.positions_m[:, foot] + quaternion.rotate(world.rotations[:, foot], foot_tip_m(skeleton, "left"))
    assert np.ptp(tip_m[:, [0, 2]], axis=0).max() < 0.005
    assert np.ptp(tip_m[:, 1]) < 0.02
