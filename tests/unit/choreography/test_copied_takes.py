"""Copies of a take are found and prove nothing, however they are trimmed, damaged or cut."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.choreography.clip import MotionClip
from app.choreography.copied_takes import takes_of
from app.choreography.dancers_told_apart import reports, share_told_apart
from app.choreography.held_out import evidence_of
from app.choreography.model import ChoreographyModel, MotionSegment
from app.choreography.music_motion_dependence import pairing_of
from app.messages import text
from tests.support.dances import model, moving

LENGTH = 36
"""Frames of a motion before its cuts are moved."""


def damaged(clip: MotionClip, seed: int) -> MotionClip:
    """The motion with a tremor of 2 mm, and another pose during a tenth of it."""
    random = np.random.default_rng(seed)
    rotations = clip.rotations.copy()
    start = int(random.integers(len(clip) * 9 // 10))
    rotations[start : start + len(clip) // 10] = rotations[start]
    return replace(clip, hips_m=clip.hips_m + random.normal(0.0, 0.002, (len(clip), 3)), rotations=rotations)


def cut(takes: tuple[tuple[int, MotionClip, int], ...], tells: float) -> ChoreographyModel:
    """Model of clips, each with the number of its take and its first frame in it, whose cuts lie elsewhere in each.
    States and sounds depend on the time in the take; ``tells`` is the probability that a sound is the state's.
    """
    states, segments = 4, []
    for number, (take, clip, first) in enumerate(takes):
        of_take, own = np.random.default_rng(take), np.random.default_rng(1000 + number)
        danced = of_take.integers(states, size=200)
        struck = np.where(of_take.uniform(size=200) < tells, danced, of_take.integers(states, size=200))
        count = len(clip) // LENGTH
        bounds = LENGTH * np.arange(count) + own.integers(0, LENGTH // 2, count)
        for start, end in zip(bounds.tolist(), bounds[1:].tolist(), strict=False):
            place = round((first + (start + end) / 2) / LENGTH)
            segments.append(
                MotionSegment(number, start, (start + end) // 2, end, int(danced[place]), (int(struck[place]), 40))
            )
    made, clips = model(states=states), tuple(clip for _, clip, _ in takes)
    return replace(made, clips=clips, segments=tuple(segments), sources=made.sources[:1] * len(clips))


def copied(take: int, clip: MotionClip, count: int) -> tuple[tuple[int, MotionClip, int], ...]:
    """Damaged copies of a take, each without some of its first and last frames."""
    random = np.random.default_rng(take)
    starts, ends = random.integers(0, len(clip) // 3, (2, count)).tolist()
    return tuple(
        (take, damaged(clip, number).span(start, len(clip) - end), start)
        for number, (start, end) in enumerate(zip(starts, ends, strict=True))
    )


def test_a_trimmed_and_damaged_copy_is_the_same_take() -> None:
    take, other = moving(1200, seed=1), moving(1200, seed=2)
    found = takes_of((other, take, damaged(take, 3).span(240, 1140)))
    assert found.takes.tolist() == [0, 1, 1]
    assert found.shifts_s[2] - found.shifts_s[1] == pytest.approx(4.0, abs=0.05)
    assert found.copies == 1


def test_different_takes_and_a_body_that_stands_are_no_copies() -> None:
    standing = [moving(60, seed=5).span(0, 1)] * 2
    held = tuple(
        replace(one, hips_m=np.repeat(one.hips_m, 600, 0), rotations=np.repeat(one.rotations, 600, 0))
        for one in standing
    )
    assert takes_of((*(moving(1200, seed) for seed in (1, 2, 3)), *held)).copies == 0


@pytest.mark.parametrize("seed", [7, 10, 11])
def test_ten_damaged_copies_of_a_take_prove_nothing(seed: int) -> None:
    """Motions that are cut elsewhere in each copy are not learned from in one and asked for in another."""
    take = moving(1500, seed)
    made = cut(copied(seed, take, 10), tells=0.0)
    found = pairing_of(made)
    assert found is None or not found.tells
    counted = evidence_of(made)
    assert counted.counted.sum() < 1.25 * len(take) / LENGTH
    assert share_told_apart(made) is None
    said = reports(made)[-1]
    assert said.id == "learn.copies_count_once"
    assert said.arguments["count"] == 10
    assert all("10" in text(said, language) for language in ("en", "ja"))


def test_independent_takes_give_the_number_as_before() -> None:
    """Takes of sounds that tell give the bits that they gave; copies of one of them hardly change these."""
    takes = tuple((seed, moving(1500, seed), 0) for seed in (1, 2, 3))
    alone = pairing_of(cut(takes, tells=1.0))
    again = pairing_of(cut((*takes, *copied(1, takes[0][1], 2)), tells=1.0))
    assert alone is not None
    assert again is not None
    assert alone.tells
    assert again.tells
    assert alone.bits > 1.0
    assert again.bits == pytest.approx(alone.bits, abs=0.3)
