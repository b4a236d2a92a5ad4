"""Learning a choreography from constructed pairs, with counts verified by hand."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest

from app.choreography.cuts import segment
from app.choreography.hidden_markov import count
from app.choreography.hit_log_odds import hearing
from app.choreography.learn import FPS, SMOOTHING, Pair, learn
from app.choreography.model_file import encode_model
from app.choreography.resample import resampled
from app.choreography.rhythm import SYMBOLS, Rhythm
from app.errors import UsageError
from app.rig import quaternion
from tests.unit.choreography.test_cuts import arm_swings
from tests.unit.choreography.test_features import random_clip
from tests.unit.choreography.test_music_offset import danced


def hits(times_s: list[float], symbols: list[int]) -> Rhythm:
    beats_s = np.arange(0.0, 10.0, 0.5)
    return Rhythm(
        beats_s,
        np.arange(20) % 4,
        np.array(times_s),
        np.array(symbols, np.int64),
        np.ones(len(times_s)),
        derived=False,
    )


SWINGS = Pair(
    arm_swings(60),
    "swings.bvh",
    # A hit of its own for setting off (1) and arriving (2) of the swings, and one far behind the motion.
    hits([0.1, 0.4, 1.6, 1.9, 3.1, 3.4, 4.6, 4.9, 6.1, 6.4, 30.0], [1, 2] * 5 + [5]),
    "swings.mid",
    offset_s=1.0,
    credits="made for this test",
)


def test_states_follow_each_other_and_sound_as_in_the_pair() -> None:
    model = learn([SWINGS], states=4, seed=0, name="swings")
    # Setting off and arriving, up and down: four motions in turn.
    states = [one.state for one in model.segments]
    assert states == [0, 1, 2, 3, 0, 1, 2, 3, 0, 1]
    assert [(one.start, one.accent, one.end) for one in model.segments] == [
        (cut.start, cut.accent, cut.end) for cut in segment(SWINGS.motion).cuts
    ]
    expected = count([np.array(states)], [[np.array([1 + at % 2]) for at in range(10)]], 4, smoothing=SMOOTHING)
    for found, known in zip((model.transition, model.emission, model.initial), expected, strict=True):
        assert found == pytest.approx(known)
    assert [one.sounds for one in model.segments] == [(1 + at % 2,) for at in range(10)]
    (source,) = model.sources
    assert (source.offset_s, source.offset_confidence) == (1.0, None)
    assert (source.motion_name, source.music_name, source.credits) == (
        "swings.bvh",
        "swings.mid",
        "made for this test",
    )


def test_an_offset_shifts_what_sounds() -> None:
    # The same music that begins half a second later in the motion: its hits meet other motions or rests.
    early = learn([SWINGS], states=4, seed=0, name="")
    late = learn([replace(SWINGS, offset_s=1.25)], states=4, seed=0, name="")
    assert late.transition.tolist() == early.transition.tolist()
    assert late.emission[0, 1] < early.emission[0, 1]


def test_a_dancer_hears_the_sounds_of_the_own_drums_most() -> None:
    """Two dancers with similar motions and different sounds share basic motions and are distinguished by the sounds."""
    other = replace(SWINGS.rhythm, symbols=SWINGS.rhythm.symbols + 10)
    model = learn([SWINGS, replace(SWINGS, rhythm=other)], states=4, seed=0, name="")
    clips = np.array([one.clip for one in model.segments])
    heard = hearing(model).percussion
    log_odds = heard.of_dancers + heard.of_motions
    assert {one.state for one in model.segments if one.clip == 0} == {one.state for one in model.segments if one.clip}
    for symbol, own in ((1, 0), (2, 0), (11, 1), (12, 1)):
        best = np.sort(log_odds[clips == own, symbol])[-5:]
        assert best.min() > 0.5 + log_odds[clips != own, symbol].max()
    # Sounds that no one heard tell nothing between two motions.
    assert np.ptp(log_odds[:, 30]) < 1e-6
    # With a chosen dancer, sounds indicate motions only: on average no dancer is likelier, and start and arrival are
    # distinguished as before.
    chosen = heard.of_motions
    for clip in (0, 1):
        assert chosen[clips == clip].mean(axis=0) == pytest.approx(np.zeros(len(SYMBOLS)), abs=1e-12)
        between = log_odds - chosen
        assert np.ptp(between[clips == clip], axis=0) == pytest.approx(np.zeros(len(SYMBOLS)), abs=1e-12)
    untrusted = hearing(model, 0.0).percussion
    assert untrusted.of_motions.tolist() == np.zeros(log_odds.shape).tolist()
    assert np.ptp(untrusted.of_dancers[:, 1]) > 0.5


def test_two_melodies_over_the_same_drums_tell_two_dancers_apart() -> None:
    rhythms = [
        replace(SWINGS.rhythm, melody=replace(SWINGS.rhythm, symbols=SWINGS.rhythm.symbols + by)) for by in (5, 9)
    ]
    model = learn([replace(SWINGS, rhythm=one) for one in rhythms], states=4, seed=0, name="")
    alone = learn([SWINGS, SWINGS], states=4, seed=0, name="")
    # The percussion is counted without the melody.
    assert model.emission.tolist() == alone.emission.tolist()
    assert [one.melody for one in model.segments] == [(one.sounds[0] + (5, 9)[one.clip],) for one in model.segments]
    clips, heard = np.array([one.clip for one in model.segments]), hearing(model)
    summed = [heard.hits(rhythms[0], amount).summed[-1] for amount in (0.0, 0.5, 1.0)]
    # The usual amount weighs half of what percussion does; the greatest four times as much as the usual one.
    assert summed[2] - summed[0] == pytest.approx(4.0 * (summed[1] - summed[0]))
    assert summed[0][clips == 0] == pytest.approx(summed[0][clips == 1])
    own, other = (np.array([one[clips == clip].mean() for one in summed]) for clip in (0, 1))
    assert (np.diff(own - other) > 1.0).all()
    # A model without melodies hears them as the drums they stand for.
    without = hearing(alone)
    assert without.melody is without.percussion


def test_offsets_are_found_where_none_is_given() -> None:
    clip = random_clip(1, 1801)
    model = learn([SWINGS, Pair(clip, "a.bvh", danced(clip, 2.5, 1), "a.mid")], states=None, seed=0, name="two")
    assert model.sources[1].offset_s == pytest.approx(2.5, abs=0.03)
    assert (model.sources[1].offset_confidence or 0.0) > 0.3
    # By clip, then in time; no transition leads from one clip to the next.
    order = [(one.clip, one.start) for one in model.segments]
    assert order == sorted(order)
    assert {one.clip for one in model.segments} == {0, 1}
    firsts = [next(one.state for one in model.segments if one.clip == clip) for clip in (0, 1)]
    assert sorted(np.flatnonzero(model.initial > 1.0 / model.states)) == sorted(set(firsts))


def test_the_same_pairs_give_the_same_model_to_the_bit() -> None:
    clip = random_clip(1, 1801)
    pairs = [SWINGS, Pair(clip, "a.bvh", danced(clip, 2.5, 1), "a.mid")]
    first, again = (encode_model(learn(pairs, states=None, seed=3, name="x")) for _ in range(2))
    assert first == again


def test_progress_rises_to_the_end() -> None:
    seen: list[float] = []
    learn([SWINGS, SWINGS], states=None, seed=0, name="", progress=lambda share, label: seen.append(share))
    assert seen[0] == 0.0
    assert seen[-1] == 1.0
    assert all(one <= other for one, other in pairwise(seen))


def test_what_cannot_be_learned_is_said() -> None:
    with pytest.raises(UsageError) as caught:
        learn([SWINGS], states=11, seed=0, name="")
    assert caught.value.message.arguments == {"states": 11, "segments": 10}
    still = replace(SWINGS, motion=SWINGS.motion.span(0, 40))
    with pytest.raises(UsageError) as caught:
        learn([still], states=None, seed=0, name="")
    assert caught.value.message.id == "learn.no_motion"
    noisy = replace(still, unfit=((5, 35),))
    with pytest.raises(UsageError) as caught:
        learn([noisy], states=None, seed=0, name="")
    assert caught.value.message.id == "learn.no_sound_motion"
    assert caught.value.message.arguments["percent"] == 75
    with pytest.raises(UsageError) as caught:
        learn([replace(SWINGS, offset_s=100.0)], states=None, seed=0, name="")
    assert caught.value.message.arguments == {"motion": "swings.bvh", "music": "swings.mid"}


@pytest.mark.parametrize("fps", [Fraction(24), Fraction(30000, 1001), Fraction(120)])
def test_a_clip_of_another_rate_is_the_same_motion(fps: Fraction) -> None:
    at_60 = random_clip(3, 601)
    other = resampled(at_60, fps)
    assert other.fps == fps
    assert other.length_s == pytest.approx(10.0, abs=1.0 / float(fps))
    # To the other rate and back: the spline passes through the frames that it is made of.
    back = resampled(other, FPS)
    middle = slice(30, len(back) - 30)
    apart = quaternion.multiply(quaternion.conjugate(back.rotations[middle]), at_60.rotations[: len(back)][middle])
    assert np.abs(2.0 * np.arcsin(np.linalg.norm(apart[..., :3], axis=-1))).max() < 1e-3
    assert np.abs(back.hips_m[middle] - at_60.hips_m[: len(back)][middle]).max() < 1e-3
    assert resampled(at_60, FPS).rotations is at_60.rotations
