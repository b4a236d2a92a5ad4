"""A live player: fingers in place soon after every onset, contacts kept, no jumps, for hours."""

from __future__ import annotations

import gc
import tracemalloc
from dataclasses import replace
from fractions import Fraction
from functools import cache

import msgspec
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.contacts.breaks import Break, joined
from app.contacts.judge import ContactJudge
from app.motion.faces.face_curves import Drivers
from app.motion.faces.gaze import BLINK_SHUT_S
from app.motion.model import Motion
from app.performance.bodies import character_of, model_of
from app.performance.chunks import Pose
from app.performance.live_breath import LiveBreath, LiveLook
from app.performance.play_along import PlayAlong
from app.project.performers import Player
from app.rig import quaternion
from app.score.take import ControllerMapping
from instrument_maps.load import bundled_maps
from metadata.load import load_skeleton
from tests.support.live import FPS, LATE_S, QUARTER, Played, line, performance_of, played, playing_alone

KINDS = ("trumpet_Bb", "trombone_tenor_F_attachment", "flute", "clarinet_Bb")
NOTES = 10
SLACK = 2.0
"""Factor for the bounds of live motion, relative to those of a performance of the same notes, since it starts more
abruptly.
"""


@cache
def run(instrument_id: str) -> Played:
    notes = line(instrument_id, NOTES)
    return played(playing_alone(instrument_id, notes), notes)


@cache
def offline_motion(instrument_id: str) -> Motion:
    """Motion of the same notes as a performance."""
    seen = run(instrument_id)
    return seen.playing.motion(Fraction(FPS), 0, seen.motion.frames)


def along(instrument_id: str = "trumpet_Bb") -> PlayAlong:
    return PlayAlong(playing_alone(instrument_id, [(4 * QUARTER, QUARTER, bundled_maps()[instrument_id].range.low)]))


def breathing() -> LiveBreath:
    return LiveBreath(replace(playing_alone("trumpet_Bb", line("trumpet_Bb", 16)), expressions={}))


def faces(breath: LiveBreath, now_s: float) -> Drivers:
    return breath.at(now_s).face


def looked(player: PlayAlong, start_s: float, length_s: float) -> list[Pose]:
    return [player.pose(start_s + frame / FPS) for frame in range(1, int(length_s * FPS) + 1)]


def test_faces_are_those_of_the_performance_also_where_they_are_the_users_own() -> None:
    playing = playing_alone("trumpet_Bb", line("trumpet_Bb", 16))
    neutral = msgspec.structs.replace(playing.expressions["neutral"], weights={"noseSneerLeft": 0.7})
    own = PlayAlong(replace(playing, expressions={**playing.expressions, "neutral": neutral}))
    shown, usual = (player.pose(3.0).morphs.get("noseSneerLeft", 0.0) for player in (own, PlayAlong(playing)))
    assert usual < 0.1 < 0.5 < shown


@pytest.mark.parametrize("instrument_id", KINDS)
def test_soon_after_every_onset_the_controls_are_those_of_the_performance(instrument_id: str) -> None:
    seen = run(instrument_id)
    offline = offline_motion(instrument_id)
    held = {control.name for control in seen.playing.instrument_map.controls if control.role == "intonation"}
    slides = {hand.motion.control for hand in seen.playing.player.grip.hands if hand.motion is not None}
    compared = 0
    for event, own in zip(seen.playing.plan.fingerings, seen.plan.fingerings, strict=True):
        if event.label != own.label:
            continue
        frame = int(np.ceil((event.start_s + LATE_S - seen.motion.first_frame_s) * FPS))
        for name, values in seen.motion.controls.items():
            if name not in held | slides:
                assert values[frame] == pytest.approx(offline.controls[name][frame], abs=0.02), (event.label, name)
                compared += 1
        for name in slides:
            # An arm is not there before the body is.
            end = int((event.end_s - seen.motion.first_frame_s) * FPS) - 1
            late = min(frame + FPS // 4, end)
            if event.end_s - event.start_s > 0.4:
                # If the arm ends before the place, the slide stops where it stops in the performance.
                there = min(event.controls.get(name, 0.0), float(offline.controls[name][frame]))
                assert seen.motion.controls[name][late] == pytest.approx(there, abs=0.01)
    assert compared > 25 * (instrument_id != "trombone_tenor_F_attachment")


@pytest.mark.parametrize("instrument_id", KINDS)
def test_lips_fingers_and_feet_stay_where_they_belong(instrument_id: str) -> None:
    seen = run(instrument_id)
    performance = performance_of(instrument_id, line(instrument_id, NOTES))
    player = performance.project.players[0]
    offline = offline_motion(instrument_id)
    known = {item.contact for item in breaks(seen.playing, player, offline)}
    assert [item for item in breaks(seen, player, seen.motion) if item.contact not in known] == []


def breaks(of: object, player: Player, motion: object) -> list[Break]:
    judge = ContactJudge(of, character_of(player), model_of(of.instrument_map))  # type: ignore[attr-defined]
    return joined(judge.breaks(motion))


@pytest.mark.parametrize("instrument_id", KINDS)
def test_no_joint_jumps(instrument_id: str) -> None:
    seen, profile = run(instrument_id), load_skeleton()
    skeleton, body = seen.playing.player.skeleton, seen.playing.body
    offline = offline_motion(instrument_id)
    for joint, name in enumerate(skeleton.names):
        if name == "root":
            continue
        bound = body.limits[profile.joint(name).kind].acceleration_rad_s2
        own, usual = (acceleration(motion.rotations[:, joint]) for motion in (seen.motion, offline))
        assert own < SLACK * max(bound, usual), name


def acceleration(rotations: np.ndarray) -> float:
    turns = quaternion.multiply(quaternion.conjugate(rotations[:-1]), rotations[1:].astype(float))
    velocity = quaternion.to_rotation_vector(turns) * FPS
    return float(np.linalg.norm(np.diff(velocity, axis=0), axis=1).max()) * FPS


def test_of_notes_that_are_held_the_last_one_sounds_and_then_the_one_before() -> None:
    player = along()
    labels = []
    for time_s, on, pitch in ((1.0, True, 58), (2.0, True, 60), (3.0, True, 63), (4.0, False, 60), (5.0, False, 63)):
        (player.note_on if on else player.note_off)(time_s, pitch)
        fingering = player.fingering
        labels.append("" if fingering is None else fingering.label)
    first, second, third = (bundled_maps()["trumpet_Bb"].fingerings_for(pitch)[0].label for pitch in (58, 60, 63))
    assert labels == [first, second, third, third, first]
    player.note_off(6.0, 58)
    looked(player, 6.0, 0.1)
    assert player.fingering is not None
    pose = looked(player, 6.1, 1.0)[-1]
    assert player.fingering is None
    assert set(pose.controls.values()) == {0.0}


def test_a_pitch_out_of_range_keeps_the_fingering_and_moves_the_lips() -> None:
    player, limits = along(), bundled_maps()["trumpet_Bb"].range
    player.note_on(1.0, 61)
    before = looked(player, 1.0, 0.5)[-1]
    player.note_on(1.5, limits.high + 9)
    after = looked(player, 1.5, 0.5)[-1]
    assert after.controls == pytest.approx(before.controls)
    assert after.morphs["mouthPressLeft"] > before.morphs["mouthPressLeft"] + 0.1


def test_the_face_follows_breath_bite_and_bend() -> None:
    player = along()
    player.note_on(1.0, 66)
    player.breath(1.0, 0.2)
    soft = looked(player, 1.0, 0.5)[-1].morphs
    player.breath(1.5, 1.0)
    loud = looked(player, 1.5, 0.5)[-1].morphs
    assert loud["cheekPuff"] > soft["cheekPuff"] + 0.03
    player.bite(2.0, 1.0)
    bitten = looked(player, 2.0, 0.5)[-1].morphs
    assert bitten["mouthPressLeft"] > loud["mouthPressLeft"] + 0.05
    player.bite(2.5, 0.0)
    player.bend(2.5, -1.0)
    bent = looked(player, 2.5, 0.5)[-1].morphs
    assert bent["mouthPressLeft"] < loud["mouthPressLeft"] - 0.02


def test_lips_and_fingers_have_begun_to_move_a_frame_after_the_onset() -> None:
    player = along()
    still = looked(player, 0.0, 0.5)[-1]
    player.note_on(0.5, 61)
    moved = looked(player, 0.5, 2.0 / FPS)[-1]
    assert max(abs(moved.controls[name] - still.controls[name]) for name in moved.controls) > 0.1
    assert max(abs(moved.morphs[name] - still.morphs.get(name, 0.0)) for name in moved.morphs) > 0.03


def test_where_the_breath_pauses_long_enough_one_breathes_in_and_shuts_the_mouth_for_the_next_note() -> None:
    player = along()
    player.breath(1.0, 0.7)
    player.note_on(1.0, 61)
    playing = looked(player, 1.0, 6.0)[-1]
    player.note_off(7.0, 61)
    player.note_on(7.03, 63)
    legato = looked(player, 7.0, 0.4)
    assert max(pose.morphs["jawOpen"] for pose in legato) < playing.morphs["jawOpen"] + 0.1
    player.note_off(7.5, 63)
    player.breath(7.5, 0.0)
    paused = looked(player, 7.5, 0.5)
    jaws = [pose.morphs["jawOpen"] for pose in paused]
    assert max(jaws) > playing.morphs["jawOpen"] + 0.2
    player.breath(8.0, 0.7)
    player.note_on(8.0, 61)
    again = looked(player, 8.0, 0.12)
    assert again[-1].morphs["jawOpen"] < playing.morphs["jawOpen"] + 0.05
    assert max(np.abs(np.diff([pose.morphs["jawOpen"] for pose in (*paused, *again)]))) < 0.3


def strokes(step_s: float, velocities: list[int]) -> list[tuple[float, float, float]]:
    """Heights of the tongue's tip and back and the push of the breath in each of some attacked notes."""
    breath, found = breathing(), list[tuple[float, float, float]]()
    for place, velocity in enumerate(velocities):
        onset_s = 1.0 + place * step_s
        breath.play(onset_s, 60, velocity, attacked=True)
        times_s = np.linspace(onset_s, onset_s + 0.9 * step_s, 40)
        shown = [(face.tongue[0], face.tongue_back[0], face.push[0]) for face in (faces(breath, at) for at in times_s)]
        # The remainder of the previous stroke decreases; a new stroke rises.
        tip, back, push = np.maximum(np.array(shown) - np.array(shown[0]), 0.0).max(axis=0).tolist()
        found.append((tip, back, push))
    return found


def test_the_back_of_the_tongue_takes_turns_with_its_tip_in_quick_strokes_only() -> None:
    quick = strokes(0.08, [80] * 8)
    assert ["ka" if back > 0.3 else "ta" for _, back, _ in quick] == ["ta", "ta"] + ["ka", "ta"] * 3
    assert all(tip > 0.8 for tip, back, _ in quick if back <= 0.3)
    assert all(back == 0.0 and tip > 0.9 for tip, back, _ in strokes(0.3, [80] * 4))


def test_the_breath_pushes_who_is_struck_harder_than_before() -> None:
    assert [push > 0.5 for *_, push in strokes(0.4, [80, 78, 83, 112, 80, 70])] == [False] * 3 + [True] + [False] * 2


def test_in_a_long_pause_the_mouth_shuts_after_the_breath_and_at_last_the_lips_let_go() -> None:
    breath = breathing()
    breath.play(1.0, 61, 90, True)
    breath.rest(7.0)
    opened = [faces(breath, time_s).mouth_open[0] for time_s in np.arange(7.0, 8.6, 1 / FPS)]
    assert max(opened) > 0.8
    assert opened[-1] == pytest.approx(0.0, abs=1e-3)
    assert faces(breath, 9.0).at_lips[0] == 1.0
    for time_s in np.arange(9.0, 11.0, 1 / FPS):
        last = faces(breath, time_s)
    assert last.at_lips[0] == pytest.approx(0.0, abs=1e-3)


def test_a_breath_that_is_cut_short_brings_little_air() -> None:
    """The player inhales in the next short pause after an interrupted breath, but not after a complete one."""
    opened = []
    for length_s in (0.15, 1.0):
        breath = breathing()
        breath.play(1.0, 61, 127, True)
        breath.rest(31.0)
        faces(breath, 31.13)
        breath.play(31.13 + length_s, 61, 40, True)
        breath.rest(32.5)
        opened.append(max(faces(breath, time_s).mouth_open[0] for time_s in np.arange(32.5, 32.8, 1 / FPS)))
    assert opened[0] > 0.5
    assert opened[1] == pytest.approx(0.0, abs=1e-3)


def test_who_plays_breathes_out_and_the_bell_rises_with_the_loudness() -> None:
    breath = breathing()
    breath.blow(1.0, 1.0)
    breath.play(1.0, 61, 90, True)
    loud = [breath.at(time_s).levels.height[0] for time_s in np.arange(1.0, 7.0, 0.1)]
    breath.blow(7.0, 0.0)
    breath.rest(7.0)
    inhaled = [breath.at(time_s).levels.full[0] for time_s in np.arange(7.0, 8.0, 0.1)]
    breath.blow(8.0, 0.2)
    breath.play(8.0, 61, 90, True)
    soft = [breath.at(time_s).levels for time_s in np.arange(8.0, 14.0, 0.1)]
    assert loud[-1] > 0.4
    assert soft[-1].height[0] < -0.2
    assert inhaled[-1] > 0.8
    assert soft[-1].full[0] == pytest.approx(0.0, abs=0.01)


def test_a_bite_counts_by_how_far_it_is_from_the_usual_one() -> None:
    tensions = []
    for bite in (0.0, 0.6):
        breath = breathing()
        breath.play(1.0, 61, 90, True)
        breath.at(2.0)
        breath.bite(bite)
        tensions.append([faces(breath, time_s).tension[0] for time_s in np.arange(2.0, 42.0, 0.5)])
    free, bitten = (np.array(values) for values in tensions)
    assert (bitten - free)[1] > 0.1
    assert (bitten - free)[-1] == pytest.approx(0.0, abs=0.01)


def test_the_lids_close_now_and_then_and_open_again_at_once() -> None:
    look = LiveLook(playing_alone("trumpet_Bb", line("trumpet_Bb", 16)))
    lids = np.array([look.at(time_s).left_lid[0] for time_s in np.arange(0.0, 120.0, 1 / FPS)])
    shut = lids > 0.5
    begins = np.flatnonzero(np.diff(shut.astype(int)) == 1)
    assert 10 < len(begins) < 60
    assert BLINK_SHUT_S * len(begins) < shut.sum() / FPS < 0.3 * len(begins)
    assert all(lids[begin : begin + FPS // 4].max() > 0.95 for begin in begins)


def test_midi_messages_say_the_same() -> None:
    by_calls, by_messages = along(), along()
    mapping = ControllerMapping(channel=1, breath="cc2", bite="cc1")
    by_calls.breath(1.0, 100 / 127)
    by_calls.note_on(1.0, 61, 90)
    by_calls.bite(1.1, 40 / 127)
    by_calls.bend(1.1, 0.25)
    by_calls.note_on(1.2, 63, 90)
    by_calls.note_off(1.2, 61)
    messages = [
        (1.0, "b00264"), (1.0, "903d5a"), (1.1, "b00128"), (1.1, "e00050"), (1.2, "903f5a"), (1.2, "903d00"),
        # A message of another channel, a clock, an incomplete message, and a meaningless one.
        (1.2, "914050"), (1.2, "f8"), (1.2, "90"), (1.2, "b04000"),
    ]  # fmt: skip
    for time_s, raw in messages:
        by_messages.receive(time_s, raw, mapping)
    one, other = by_calls.pose(1.3), by_messages.pose(1.3)
    np.testing.assert_array_equal(one.rotations, other.rotations)
    assert one.morphs == other.morphs
    assert one.controls == other.controls
    by_messages.receive(2.0, "b07b00", mapping)
    looked(by_messages, 2.0, 1.2)
    assert by_messages.fingering is None


def test_time_does_not_run_backwards() -> None:
    player = along()
    player.note_on(5.0, 61)
    pose = looked(player, 5.0, 0.2)[-1]
    late = player.pose(1.0)
    np.testing.assert_array_equal(late.rotations, pose.rotations)
    player.note_off(1.0, 61)
    player.all_off(0.0)
    assert player.fingering is not None


EVENTS = st.lists(
    st.tuples(
        st.sampled_from(("note_on", "note_off", "breath", "bite", "bend", "all_off", "pose")),
        st.floats(-0.1, 2.0),
        st.integers(0, 127),
        st.floats(-2.0, 2.0),
    ),
    max_size=40,
)


@pytest.mark.parametrize("instrument_id", KINDS)
@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(events=EVENTS)
def test_nothing_that_is_played_raises(instrument_id: str, events: list[tuple[str, float, int, float]]) -> None:
    player, now_s = along(instrument_id), -3.0
    for kind, wait_s, pitch, value in events:
        now_s += wait_s
        if kind == "note_on":
            player.note_on(now_s, pitch, round(64 * value))
        elif kind == "note_off":
            player.note_off(now_s, pitch)
        elif kind in ("all_off", "pose"):
            getattr(player, kind)(now_s)
        else:
            getattr(player, kind)(now_s, value)
    pose = player.pose(now_s + 0.01)
    np.testing.assert_allclose(np.linalg.norm(pose.rotations, axis=1), 1.0, atol=1e-5)
    assert np.isfinite(pose.hips_m).all()
    assert np.isfinite(pose.instrument_position_m).all()
    for weights in (pose.morphs, pose.controls):
        assert all(0.0 <= value <= 1.0 for value in weights.values())


def test_memory_does_not_grow() -> None:
    player = along("flute")
    limits = bundled_maps()["flute"].range
    pitches = np.random.default_rng(3).integers(limits.low - 2, limits.high + 3, 100_000).tolist()
    now_s, number = 0.0, 0

    def play(seconds: int) -> None:
        nonlocal now_s, number
        for _ in range(seconds):
            for step in range(8):
                player.breath(now_s + step / 8, (number % 10) / 9)
                player.note_on(now_s + step / 8, pitches[number])
                player.note_off(now_s + step / 8 + 0.1, pitches[number])
                number += 1
            player.pose(now_s + 0.99)
            now_s += 1.0

    play(30)
    tracemalloc.start()
    try:
        play(4)
        gc.collect()
        before = tracemalloc.take_snapshot()
        play(15)
        gc.collect()
        after = tracemalloc.take_snapshot()
    finally:
        tracemalloc.stop()
    ours = [item for item in after.compare_to(before, "filename") if "/app/" in item.traceback[0].filename]
    assert sum(item.size_diff for item in ours) < 20_000


def test_a_pose_leaves_nothing_for_the_garbage_collector() -> None:
    player = along("flute")

    def play(first: int) -> None:
        for second in range(first, first + 3):
            player.note_on(float(second), 72)
            player.pose(second + 0.5)

    play(0)
    gc.collect()
    gc.disable()
    try:
        play(3)
        # A collection in the middle of playing would be a late frame.
        assert gc.collect() == 0
    finally:
        gc.enable()
