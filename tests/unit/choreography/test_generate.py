"""Generated dances as an animator would judge them: on the beat, without visible seams, with standing feet, and in
place.
"""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.arrays import FloatArray
from app.choreography.clip import MotionClip
from app.choreography.contacts import foot_contacts, tips_m
from app.choreography.dance import Dance, Manner
from app.choreography.generate import Choreographer
from app.choreography.joins import FADE_S, MOST_CARRIED_RAD, fading_difference, fading_turn
from app.choreography.rhythm import SYMBOLS, Rhythm
from app.choreography.sequence import Constraints
from app.choreography.stage import STAGE_M
from tests.support.dance_measures import alignments, kinematic_beats_s
from tests.support.dances import beaten, model, stepping

FPS = Fraction(60)


@cache
def choreographer() -> Choreographer:
    return Choreographer(model())


@cache
def dance(seed: int = 0, beats: int = 64, beat_s: float = 0.55) -> Dance:
    return choreographer().dance(beaten(beats, beat_s), Manner(seed=seed), FPS)


def spins(clip: MotionClip) -> FloatArray:
    """Angular velocities (F - 1, 16, 3) in rad/s, calculated with scipy."""
    turns = Rotation.from_quat(clip.rotations.reshape(-1, 4))
    frames, joints = clip.rotations.shape[:2]
    steps = turns[: (frames - 1) * joints].inv() * turns[joints:]
    return steps.as_rotvec().reshape(frames - 1, joints, 3) * float(clip.fps)


def test_the_body_arrives_on_the_beats() -> None:
    found, beats = dance(), beaten(64, 0.55)
    assert len(found.steps) > 25
    for one, other in pairwise(found.steps):
        assert one.start_s < one.end_s == other.start_s
        assert one.start_s <= one.accent_s <= one.end_s
        assert abs(one.accent_s - 0.275 * one.place) < 0.65
    assert found.clip.length_s > beats.beats_s[-2]
    for aligned in alignments(found.first_s + kinematic_beats_s(found.clip), 0.275 * np.arange(127)):
        # Shifts by whole beats do nearly as well.
        assert aligned.found > 0.97 * aligned.chance_95
        assert aligned.found > aligned.chance + 0.3


def test_no_seam_shows() -> None:
    found = dance()
    assert len(found.seams) > 5
    jumps = np.linalg.norm(np.diff(spins(found.clip), axis=0), axis=-1).max(axis=1)
    source = [np.linalg.norm(np.diff(spins(clip), axis=0), axis=-1).max(axis=1) for clip in model().clips]
    at_seams = max(jumps[max(0, seam - 3) : seam + 3].max() for seam in found.seams)
    assert at_seams <= 1.25 * np.percentile(np.concatenate(source), 99.9)
    hips = np.diff(found.clip.hips_m, 3, axis=0) * 60.0**2
    assert np.abs(hips).max() < 0.6


def test_no_seam_shows_in_the_first_frame() -> None:
    whole = dance()
    for seam in whole.seams[2:7]:
        first_s = whole.first_s + (seam - 1) / float(FPS)
        begun = choreographer().dance(beaten(64, 0.55), Manner(), FPS, first_s=first_s, end_s=first_s + 4.0)
        speed = np.linalg.norm(spins(begun.clip), axis=-1).max(axis=1)
        assert speed[0] < speed[1:60].max()


def test_standing_feet_stand() -> None:
    found = dance()
    assert len(found.standing) > 20
    tips = tips_m(found.clip)
    for stand in found.standing:
        off = np.linalg.norm(tips[stand.start : stand.stop, stand.foot] - stand.place_m, axis=-1)
        assert off.max() < 1e-3
    # Detected again from the result alone.
    seen = foot_contacts(found.clip)
    slides = np.linalg.norm(np.diff(tips, axis=0), axis=-1) * 60.0
    slow = slides[seen[1:] & seen[:-1]]
    assert np.mean(slow) < 0.05


def test_bones_keep_their_length_and_rotations_their_unit() -> None:
    clip = dance().clip
    assert np.abs(np.linalg.norm(clip.rotations, axis=-1) - 1.0).max() < 1e-9
    assert np.einsum("fji,fji->fj", clip.rotations[1:], clip.rotations[:-1]).min() > 0.0


def test_a_dancer_keeps_to_the_place_and_faces_the_audience() -> None:
    clip = dance().clip
    assert np.linalg.norm(clip.hips_m[:, [0, 2]], axis=1).max() < 1.1 * STAGE_M
    ahead = Rotation.from_quat(clip.rotations[:, 0]).apply((0.0, 0.0, 1.0))
    assert ahead[:, 2].mean() > 0.5


def test_it_begins_and_ends_at_rest_whenever_it_is_seen() -> None:
    found = choreographer().dance(beaten(16), Manner(), FPS, first_s=-3.0, end_s=14.0)
    speed = np.linalg.norm(spins(found.clip), axis=-1).max(axis=1)
    assert speed[:30].max() < 0.1
    assert speed[-30:].max() < 0.1
    assert len(found.clip) == 17 * 60


def test_a_cut_of_it_is_the_same_dance() -> None:
    whole = dance()
    again = choreographer().dance(beaten(64, 0.55), Manner(), Fraction(30))
    assert again.steps == whole.steps


def test_to_the_bit() -> None:
    again = Choreographer(model()).dance(beaten(64, 0.55), Manner(), FPS)
    assert np.array_equal(again.clip.rotations, dance().clip.rotations)
    assert np.array_equal(again.clip.hips_m, dance().clip.hips_m)


def test_a_mirror_shows_left_as_right_and_twice_the_same() -> None:
    clip = stepping(4)
    seen = clip.mirrored()
    there, back = clip.world().positions_m, seen.world().positions_m
    left, right = 1 + 4, 1 + 7
    assert np.allclose(back[:, left], there[:, right] * (-1.0, 1.0, 1.0), atol=1e-9)
    assert np.allclose(seen.mirrored().rotations, clip.rotations)
    danced = choreographer().dance(beaten(16), Manner(mirrored=True), FPS)
    plain = choreographer().dance(beaten(16), Manner(), FPS)
    assert np.allclose(danced.clip.hips_m * (-1.0, 1.0, 1.0), plain.clip.hips_m, atol=1e-9)


def test_size_makes_arms_swing_farther_and_leaves_steps() -> None:
    small, plain, large = (choreographer().dance(beaten(32), Manner(size=size), FPS).clip for size in (0.5, 1.0, 1.4))
    swings = [np.linalg.norm(spins(clip)[:, 4], axis=-1).mean() for clip in (small, plain, large)]
    assert swings[0] < 0.7 * swings[1] < 0.7 * swings[2]
    assert np.allclose(small.hips_m, large.hips_m)


def test_a_source_can_be_preferred() -> None:
    of = [one.clip for one in model().segments]
    shares = [
        np.mean([of[step.segment] for step in choreographer().steps(beaten(64), Manner(source=source))])
        for source in (0, 1)
    ]
    assert shares[0] + 0.3 < shares[1]


def test_a_preferred_source_dances_to_the_drums_of_another() -> None:
    """Two dancers learned with different drums: the preferred one dances to the drums of either."""
    plain = model()
    segments = tuple(replace(one, sounds=(1 + 20 * one.clip,) * 4) for one in plain.segments)
    emission = np.full((plain.states, len(SYMBOLS)), 1e-3)
    emission[:, [1, 21]] = 0.5
    told = Choreographer(replace(plain, segments=segments, emission=emission))
    of = np.array([one.clip for one in segments])
    for symbol, own in ((1, 0), (21, 1)):
        struck = beaten(64)
        struck = replace(struck, symbols=np.full(len(struck.symbols), symbol))

        def share(source: int | None, clip: int, struck: Rhythm = struck) -> float:
            return float(np.mean(of[[step.segment for step in told.steps(struck, Manner(source=source))]] == clip))

        assert share(None, own) > 0.8
        assert [share(source, source) for source in (0, 1)] == pytest.approx([1.0, 1.0], abs=0.1)


def test_pins_hold() -> None:
    found = choreographer().steps(beaten(32), Manner(), constraints=Constraints(pinned={20: 2}))
    assert next(step for step in found if step.place == 20).state == 2


def test_no_segment_comes_more_than_three_times_in_a_row() -> None:
    runs, last = 1, -1
    for step in dance().steps:
        runs = runs + 1 if step.segment == last else 1
        last = step.segment
        assert runs <= 3


def test_nothing_is_danced_to_nothing() -> None:
    empty = beaten(2)
    silent = type(empty)(np.zeros(0), np.zeros(0, int), np.zeros(0), np.zeros(0, int), np.zeros(0), False)
    found = choreographer().dance(silent, Manner(), FPS, first_s=-1.0, end_s=1.0)
    assert len(found.clip) == 120
    assert found.steps == ()
    assert np.ptp(found.clip.rotations, axis=0).max() == 0.0


def test_what_fades_begins_as_it_was_and_ends_at_rest() -> None:
    times = np.linspace(0.0, 0.6, 601)
    curve = fading_difference(np.array([1.0]), np.array([-2.0]), times, 0.5)[:, 0]
    slope = np.gradient(curve, times)
    assert curve[0] == 1.0
    assert slope[1] == pytest.approx(-2.0, abs=0.05)
    assert np.abs(curve[times >= 0.5]).max() == 0.0
    assert np.abs(slope[-80:]).max() < 1e-9
    assert math.isfinite(np.abs(np.gradient(slope, times)).max())


def test_a_fast_difference_of_speeds_turns_no_joint_far_before_it_has_faded_out() -> None:
    """The speed of a kicking knee would otherwise carry it a quarter of a turn beyond the next motion."""
    times = np.linspace(0.0, FADE_S, 451)
    spins = np.array([[12.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    turns = fading_turn(np.zeros((2, 3)), spins, times)[..., 0]
    assert turns.max(axis=0)[0] == pytest.approx(MOST_CARRIED_RAD, rel=0.01)
    assert np.gradient(turns[:, 0], times)[0] == pytest.approx(12.0, rel=0.02)
    slow = fading_difference(np.zeros(3), spins[1], times)[:, 0]
    assert turns[:, 1] == pytest.approx(slow)


def test_what_idles_in_the_capture_is_hardly_danced(monkeypatch: pytest.MonkeyPatch) -> None:
    """Six motions of the first source are motionless."""
    own = model()
    held = [at for at, one in enumerate(own.segments) if one.clip == 0][6:12]
    rotations = own.clips[0].rotations.copy()
    rotations[own.segments[held[0]].start : own.segments[held[-1]].end] = rotations[own.segments[held[0]].start]
    still = replace(own, clips=(replace(own.clips[0], rotations=rotations), *own.clips[1:]))

    def idles() -> int:
        made = Choreographer(still)
        return sum(
            step.segment in held[1:-1] for seed in range(3) for step in made.steps(beaten(48), Manner(seed=seed))
        )

    cost = idles()
    for name in ("IDLE", "THIN"):
        monkeypatch.setattr(f"app.choreography.idling.{name}", 0.0)
    assert cost < 0.3 * idles()


def test_a_dancer_who_was_captured_in_turning_faces_the_audience() -> None:
    """The capture rotates once in 12 s; each of its motions is danced facing the front."""
    own = model()
    turned = []
    for clip in own.clips:
        turn = Rotation.from_rotvec(np.outer(2.0 * np.pi * np.arange(len(clip)) / 720.0, (0.0, 1.0, 0.0)))
        rotations = clip.rotations.copy()
        rotations[:, 0] = (turn * Rotation.from_quat(rotations[:, 0])).as_quat()
        turned.append(replace(clip, rotations=rotations, hips_m=turn.apply(clip.hips_m)))
    found = Choreographer(replace(own, clips=tuple(turned))).dance(beaten(48), Manner(), FPS)
    ahead = Rotation.from_quat(found.clip.rotations[:, 0]).apply((0.0, 0.0, 1.0))
    assert np.mean(ahead[:, 2] > 0.5) > 0.9
