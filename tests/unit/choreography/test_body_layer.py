"""The part of a dance that a player adopts: relative to the place and the dancer's facing, and within the player's
bounds.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.choreography.body import SEGMENTS
from app.choreography.body_layer import MOST, body_layer
from app.choreography.clip import MotionClip
from app.choreography.retarget import retarget
from app.motion.gestures.dance_layer import CHANNELS, BodyLayer
from app.rig.characters.character_library import character_named
from tests.support.dances import still

FPS = 30
SECONDS = 12
TIMES_S = np.arange(SECONDS * FPS) / FPS
CHARACTER = character_named("man_adult")


def clip(hips_m: np.ndarray | None = None, **turned: np.ndarray) -> MotionClip:
    """Standing body with segments rotated by rotation vectors (F, 3) and hips moved by (F, 3)."""
    standing = still(len(TIMES_S), FPS)
    rotations = standing.rotations.copy()
    for name, vectors in turned.items():
        rotations[:, SEGMENTS.index(name)] = Rotation.from_rotvec(vectors).as_quat()
    return replace(standing, rotations=rotations, hips_m=standing.hips_m + (0.0 if hips_m is None else hips_m))


def layer(motion: MotionClip) -> BodyLayer:
    return body_layer(retarget(motion, CHARACTER), CHARACTER)


def column(of: BodyLayer, name: str) -> np.ndarray:
    return of.values[:, CHANNELS.index(name)]


def about(axis: int, values: np.ndarray) -> np.ndarray:
    vectors = np.zeros((len(values), 3))
    vectors[:, axis] = values
    return vectors


def moved(motion: MotionClip, turn_rad: float, to_m: tuple[float, float]) -> MotionClip:
    """The same dance at another place on the stage, facing another way."""
    turn = Rotation.from_rotvec([0.0, turn_rad, 0.0])
    rotations = motion.rotations.copy()
    rotations[:, 0] = (turn * Rotation.from_quat(rotations[:, 0])).as_quat()
    return replace(motion, rotations=rotations, hips_m=turn.apply(motion.hips_m) + np.array([to_m[0], 0.0, to_m[1]]))


def groove() -> MotionClip:
    """Sideways motion of hips, chest and head once a second."""
    wave = np.sin(2.0 * np.pi * TIMES_S)
    hips_m = np.zeros((len(wave), 3))
    hips_m[:, 0], hips_m[:, 2] = 0.05 * wave, 0.02 * np.cos(2.0 * np.pi * TIMES_S)
    return clip(
        hips_m,
        hips=about(2, -0.08 * wave),
        spine=about(1, 0.1 * wave),
        chest=about(0, 0.06 * wave),
        head=about(1, 0.1 * wave),
    )


def test_a_body_that_stands_adds_nothing() -> None:
    assert np.abs(layer(clip()).values).max() < 1e-6


def test_each_part_goes_into_its_channel_with_its_sign() -> None:
    made = layer(groove())
    wave = np.sin(2.0 * np.pi * TIMES_S)
    middle = slice(FPS, -FPS)
    for name, size in (("side_m", 0.05), ("hips_left_rad", 0.08), ("trunk_turn_rad", 0.1), ("trunk_forward_rad", 0.06)):
        along = np.polyfit(wave[middle], column(made, name)[middle], 1)[0]
        # Smoothed a little, and a little smaller where it comes near its bound.
        assert 0.6 * size < along < 1.05 * size, name
    assert np.corrcoef(wave[middle], column(made, "head_turn_rad")[middle])[0, 1] > 0.98


@pytest.mark.parametrize("turn_rad", [0.7, -2.5, np.pi])
def test_where_the_dancer_stands_and_faces_is_left_out(turn_rad: float) -> None:
    here, there = layer(groove()), layer(moved(groove(), turn_rad, (1.5, -2.0)))
    np.testing.assert_allclose(there.values, here.values, atol=2e-3)


def test_a_way_over_the_stage_and_a_slow_turn_are_left_out() -> None:
    walk = np.stack([0.15 * TIMES_S, 0.0 * TIMES_S, 0.1 * TIMES_S], axis=1)
    middle = slice(5 * FPS, -5 * FPS)
    for motion in (clip(walk), clip(hips=about(1, 0.25 * TIMES_S))):
        assert np.abs(layer(motion).values[middle]).max() < 0.005


def test_spins_leaps_and_jerks_stay_within_the_bounds() -> None:
    spin = 2.0 * np.pi * np.clip((TIMES_S - 3.0) / 0.7, 0.0, 1.0) - 4.0 * np.pi * np.clip(
        (TIMES_S - 7.0) / 0.5, 0.0, 1.0
    )
    leap = np.zeros((len(TIMES_S), 3))
    leap[:, 0] = 1.2 * np.sign(np.sin(2.0 * np.pi * 0.4 * TIMES_S))
    leap[:, 1] = 0.3 * np.abs(np.sin(2.0 * np.pi * TIMES_S))
    jerks = about(0, 0.8 * np.sign(np.sin(2.0 * np.pi * 0.7 * TIMES_S)))
    made = layer(clip(leap, hips=about(1, spin), chest=jerks, head=-jerks))
    most = np.array([MOST[name] for name in CHANNELS])
    assert np.all(np.abs(made.values) <= most)
    speeds = np.abs(np.diff(made.values, axis=0)).max(axis=0) * FPS
    assert speeds[:3].max() < 0.9
    assert np.rad2deg(speeds[3:].max()) < 150.0


def test_a_large_motion_leaves_a_later_small_one_as_large_as_it_was() -> None:
    wave = np.sin(np.pi * TIMES_S)
    sways, small = np.zeros((len(wave), 3)), np.zeros((len(wave), 3))
    small[:, 0] = 0.04 * wave
    sways[:, 0] = np.where(TIMES_S < 4.0, 0.25, 0.04) * wave
    later = slice(9 * FPS, 11 * FPS)
    swayed = column(layer(clip(sways)), "side_m")
    assert np.ptp(swayed[later]) > 0.95 * np.ptp(column(layer(clip(small)), "side_m")[later])
    assert np.ptp(swayed[: 4 * FPS]) > 1.2 * MOST["side_m"]


def test_one_frame_is_a_layer_too() -> None:
    one = retarget(clip().span(0, 1), CHARACTER)
    assert np.abs(body_layer(one, CHARACTER).sample(np.array([-1.0, 0.0, 1.0]))).max() < 1e-9
