"""Legs that would pass through each other go around each other, and feet that stand stay in place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.arrays import FloatArray
from app.choreography.body import SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.feet_on_floor import AHEAD
from app.choreography.foot_plants import FootPlant
from app.choreography.footfalls import Footfalls
from app.choreography.legs_apart import depths_m, knees_apart, with_legs_apart, with_swings_apart
from app.choreography.limbs import bend
from app.choreography.standing_feet import planted
from app.rig import quaternion
from app.rig.sole import SIDES
from tests.support.dance_measures import angular_jumps
from tests.support.dances import stepping, still

FRAMES = 120


def with_ankles(away_m: FloatArray) -> MotionClip:
    """A body that stands in a slight squat, with ankles moved from below the hip joints by ``away_m`` (F, 2, 3)."""
    clip = still(len(away_m))
    clip = replace(clip, hips_m=clip.hips_m - (0.0, 0.06, 0.0))
    world, rotations = clip.world(), clip.rotations.copy()
    for foot, side in enumerate(SIDES):
        limb = ("hips", *(f"{side}{part}" for part in ("UpperLeg", "LowerLeg", "Foot")))
        ankle = world.positions_m[:, 1 + SEGMENTS.index(limb[-1])] + (0.0, 0.06, 0.0)
        bend(clip, world, limb, ankle + away_m[:, foot], AHEAD, rotations)
    return replace(clip, rotations=quaternion.continuous(rotations))


def bump() -> FloatArray:
    """Rise from 0 to 1 and back (F,)."""
    return np.asarray(0.5 - 0.5 * np.cos(np.arange(FRAMES) / (FRAMES - 1.0) * 2.0 * np.pi))


def apart(clip: MotionClip, standing: tuple[FootPlant, ...]) -> tuple[MotionClip, MotionClip, tuple[FootPlant, ...]]:
    """The motion with planted feet, before and after its legs were kept apart, and the new stands."""
    falls = Footfalls(standing, np.tile(np.arange(float(len(clip)))[:, None], (1, 2)))
    shown = planted(clip, standing, 0.0, falls.shown)
    return shown, *with_legs_apart(clip, shown, falls, 0.0)


def place(clip: MotionClip, foot: int, frame: int = 0) -> tuple[float, float, float]:
    x, y, z = tips_m(clip)[frame, foot]
    return float(x), float(y), float(z)


def test_a_swinging_leg_passes_a_standing_one() -> None:
    away = np.zeros((FRAMES, 2, 3))
    away[:, 0, 0], away[:, 0, 1] = -0.27 * bump(), 0.05 * bump()
    clip = with_ankles(away)
    stand = FootPlant(1, 0, FRAMES, place(clip, 1))
    shown, found, standing = apart(clip, (stand,))
    assert depths_m(shown).max() > 0.06
    assert depths_m(found).max() < 0.005
    # The standing foot stays, and nothing snaps.
    assert standing == (stand,)
    assert np.abs(tips_m(found)[:, 1] - stand.place_m).max() < 1e-4
    assert angular_jumps(found).max() < 1.5


def test_a_foot_swings_around_the_other_while_hips_and_the_standing_foot_stay() -> None:
    away = np.zeros((FRAMES, 2, 3))
    away[:, 0, 0], away[:, 0, 1] = -0.27 * bump(), 0.05 * bump()
    clip = with_ankles(away)
    stands = (FootPlant(1, 0, FRAMES, place(clip, 1)), FootPlant(0, 0, 15, place(clip, 0)))
    found = with_swings_apart(clip, stands)
    assert depths_m(clip).max() > 0.06
    assert depths_m(found).max() < 0.005
    assert np.array_equal(found.hips_m, clip.hips_m)
    assert np.abs(tips_m(found) - tips_m(clip))[:, 1].max() < 1e-4
    assert np.abs(tips_m(found) - tips_m(clip))[:15, 0].max() < 1e-4
    assert angular_jumps(found).max() < 1.5


def test_a_foot_that_would_land_in_the_other_one_lands_beside_it_and_stands_still() -> None:
    away = np.zeros((FRAMES, 2, 3))
    share = np.clip((np.arange(FRAMES) - 20.0) / 30.0, 0.0, 1.0)
    away[:, 0, 0], away[:, 0, 1] = -0.17 * share**2 * (3.0 - 2.0 * share), 0.05 * np.sin(np.pi * share) ** 2
    clip = with_ankles(away)
    stands = (
        FootPlant(0, 0, 20, place(clip, 0)),
        FootPlant(1, 0, FRAMES, place(clip, 1)),
        FootPlant(0, 50, FRAMES, place(clip, 0, -1)),
    )
    shown, found, standing = apart(clip, stands)
    assert depths_m(shown)[50:].min() > 0.03
    assert depths_m(found).max() < 0.005
    assert [(stand.foot, stand.start, stand.stop) for stand in standing] == [
        (stand.foot, stand.start, stand.stop) for stand in stands
    ]
    for stand in standing:
        here = tips_m(found)[stand.start : stand.stop, stand.foot]
        assert np.abs(here - stand.place_m).max() < 1e-4
    assert standing[1] == stands[1]
    assert 0.02 < np.linalg.norm(np.subtract(standing[2].place_m, stands[2].place_m)) < 0.12


def test_knees_in_each_other_are_turned_outwards_and_feet_stay() -> None:
    clip = with_ankles(np.tile((0.0, 0.25, 0.05), (FRAMES, 2, 1)))
    world, rotations = clip.world(), clip.rotations.copy()
    for side, sign in (("left", 1.0), ("right", -1.0)):
        thigh, shank, foot = (1 + SEGMENTS.index(f"{side}{part}") for part in ("UpperLeg", "LowerLeg", "Foot"))
        along = world.positions_m[0, foot] - world.positions_m[0, thigh]
        inwards = quaternion.from_rotation_vector(0.35 * sign * bump()[:, None] * along / np.linalg.norm(along))
        rotations[:, thigh - 1] = quaternion.multiply(inwards, rotations[:, thigh - 1])
        turned = quaternion.conjugate(quaternion.multiply(inwards, world.rotations[:, shank]))
        rotations[:, foot - 1] = quaternion.multiply(turned, world.rotations[:, foot])
    clip = replace(clip, rotations=rotations)
    assert depths_m(clip).max() > 0.03
    found = knees_apart(clip)
    assert depths_m(found).max() < 0.005
    assert np.abs(tips_m(found) - tips_m(clip)).max() < 1e-9
    assert angular_jumps(found).max() < 1.0


def test_legs_beside_each_other_stay_as_they_are() -> None:
    clip = stepping(8)
    assert depths_m(clip).max() == 0.0
    shown, found, _ = apart(clip, ())
    assert found is shown
    assert with_swings_apart(clip, ()) is clip
    assert knees_apart(clip) is clip
