"""A body whose feet both leave the floor comes down, except in a jump."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.arrays import FloatArray
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.feet_on_floor import soles_m
from app.choreography.foot_plants import FootPlant
from app.choreography.standing_feet import planted
from tests.support.dances import still

FRAMES, FIRST, LAST = 120, 40, 80
TIMES_S: FloatArray = np.clip((np.arange(FRAMES) - FIRST) / 60.0, 0.0, (LAST - FIRST) / 60.0)


def raised(heights_m: FloatArray) -> tuple[MotionClip, tuple[FootPlant, ...]]:
    """A body that stands on both feet before and after it is raised."""
    clip = still(FRAMES)
    places = tips_m(clip)[0].tolist()
    standing = tuple(
        FootPlant(foot, start, stop, tuple(places[foot]))
        for foot in range(2)
        for start, stop in ((0, FIRST), (LAST, FRAMES))
    )
    return replace(clip, hips_m=clip.hips_m + heights_m[:, None] * (0.0, 1.0, 0.0)), standing


def test_a_body_that_hovers_comes_down() -> None:
    clip, standing = raised(0.04 * np.sin(np.pi * TIMES_S / TIMES_S[-1]) ** 2)
    assert soles_m(clip, clip.world()).min(axis=(1, 2)).max() > 0.03
    done = planted(clip, standing)
    soles = soles_m(done, done.world())
    assert soles.min(axis=(1, 2)).max() < 0.015
    assert soles[[FIRST - 1, LAST]] == pytest.approx(0.0, abs=1e-6)
    # Feet and hips move as slowly as the body did.
    assert np.abs(np.diff(soles.min(axis=2), 2, axis=0)).max() < 0.002


def test_a_jump_stays_as_high_as_it_is() -> None:
    clip, standing = raised(0.5 * 9.81 * TIMES_S * (TIMES_S[-1] - TIMES_S))
    assert tips_m(planted(clip, standing))[..., 1] == pytest.approx(tips_m(clip)[..., 1], abs=0.001)


def test_a_body_that_hovers_after_a_jump_comes_down() -> None:
    half_s = 0.5 * TIMES_S[-1]
    jump_m = np.maximum(0.5 * 9.81 * TIMES_S * (half_s - TIMES_S), 0.0)
    hover_m = 0.045 * np.sin(np.pi * np.clip(TIMES_S / half_s - 1.0, 0.0, 1.0)) ** 2
    # Between both, the feet do not quite touch the floor.
    clip, standing = raised(jump_m + hover_m + 0.008 * np.sin(np.pi * TIMES_S / TIMES_S[-1]))
    lowest = soles_m(done := planted(clip, standing), done.world()).min(axis=(1, 2))
    middle = (FIRST + LAST) // 2
    assert lowest[:middle].max() == pytest.approx(jump_m.max(), abs=0.02)
    assert lowest[middle:].max() < 0.015


def test_a_jump_that_a_dance_shows_slowly_is_none_the_less_a_jump() -> None:
    clip, standing = raised(0.2 * np.sin(np.pi * TIMES_S / TIMES_S[-1]) ** 2)
    assert tips_m(planted(clip, standing))[..., 1] == pytest.approx(tips_m(clip)[..., 1], abs=0.001)
