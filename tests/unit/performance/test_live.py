"""Visible motion is computed first, memory stays within its bound, and urgent poses are available immediately."""

from __future__ import annotations

import threading
from dataclasses import replace
from fractions import Fraction
from typing import Any

import msgspec
import numpy as np
import pytest

from app.motion.model import Motion
from app.motion.perform import PerformanceCurves
from app.performance.bodies import character_of
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion, PlayerFault
from app.performance.span import whole_span
from app.plan.by_hand.corrections import AddExpression
from app.plan.model import PlayerPlan
from app.project.edit.corrections import with_corrections
from app.project.edit.outfits import colour_outfit, give_outfit
from app.project.edit.piece import piece_settings, set_piece_settings
from app.rig.characters.character_library import character_named
from tests.property.performance.edits import piece
from tests.support.live import ready_spans
from tests.support.performed import player_motion

EVENTS = set(PlayerPlan.__struct_fields__) - {"time_frame"}


@pytest.fixture(scope="module")
def performance() -> Performance:
    return Performance(piece())


def all_made(live: LiveMotion) -> int:
    count = 0
    while live.work():
        count += 1
    return count


def test_what_is_looked_at_is_made_first(performance: Performance) -> None:
    live = LiveMotion(performance)
    first, second, third = (player.id for player in performance.project.players)
    assert live.pose(first, 8.0) is None
    live.request(8.0, 1.0, (second,))
    assert live.work()
    assert live.pose(second, 8.5) is not None
    assert live.pose(first, 8.5) is None
    for _ in range(4):
        live.work()
    assert live.pose(first, 8.5) is not None
    assert live.pose(third, 8.5) is not None
    assert live.pose(second, 0.0) is None
    assert 0.0 < live.ready_share < 1.0


@pytest.mark.parametrize(
    ("settings", "replanned", "moves_anew"),
    [
        ({"title": "Another"}, set(), False),
        ({"fps": Fraction(24)}, set(), True),
        ({"seed": 5}, {"gestures", "glances", "problems", "tongues"}, True),
        ({"preroll_beats": 9.0}, {"breaths", "gestures", "glances", "expressions", "problems"}, True),
    ],
)
def test_a_setting_of_the_piece_costs_what_it_changes(
    performance: Performance, settings: dict[str, Any], replanned: set[str], moves_anew: bool
) -> None:
    live = LiveMotion(performance)
    made = all_made(live)
    assert made
    requested = msgspec.structs.replace(piece_settings(performance.project), **settings)
    changed = Performance(set_piece_settings(performance.project, requested), performance)
    for player in changed.project.players:
        before, after = performance.plan(player), changed.plan(player)
        others = {field for field in EVENTS if getattr(before, field) is not getattr(after, field)}
        assert others <= replanned
    live.show(changed)
    again = all_made(live)
    assert bool(again) == moves_anew
    fresh = LiveMotion(changed)
    all_made(fresh)
    for player in changed.project.players:
        one, other = live.pose(player.id, 8.1), fresh.pose(player.id, 8.1)
        assert np.array_equal(one.rotations, other.rotations)


def test_all_players_are_made_at_the_playhead_first(performance: Performance) -> None:
    live = LiveMotion(performance)
    players = [player.id for player in performance.project.players]
    live.request(8.0, 4.0, (players[2],))
    here = []
    for _ in players:
        before, seen = {player for player in players if live.pose(player, 8.0) is not None}, live.seen
        assert not live.is_seen
        live.work()
        here += [player for player in players if player not in before and live.pose(player, 8.0) is not None]
        assert live.seen != seen, "the renderer is notified at once"
    assert here == [players[2], *players[:2]], "who is in front first"
    seen, count = live.seen, 0
    while not live.is_seen:
        assert live.work()
        count += 1
    assert count == len(players), "what is seen next, of everybody"
    while live.work():
        assert live.is_seen
    assert live.seen == seen, "nothing at the playhead changed"


def test_an_edit_is_awaited_only_until_what_is_looked_at_is_right(performance: Performance) -> None:
    player = performance.project.players[0]
    live = LiveMotion(performance)
    live.request(6.0, 2.0)
    all_made(live)
    project = with_corrections(performance.project, player.id, [AddExpression("x", "strained", 6 * 960, 40 * 960)])
    live.show(Performance(project, performance))
    assert not live.is_seen
    assert live.work()
    first, right = live.pose(player.id, 6.5), live.pose_now(player.id, 6.5)
    assert first.morphs == right.morphs, "the first piece of work is what is looked at"
    while not live.is_seen:
        assert live.work()
    assert all_made(live) > 3, "what is not shown is not made"


def test_ready_spans_grow_together(performance: Performance) -> None:
    live = LiveMotion(performance)
    player = performance.project.players[0]
    assert ready_spans(live, player.id) == ()
    all_made(live)
    frame = performance.time_frame
    ((start_s, end_s),) = ready_spans(live, player.id)
    assert start_s == frame.first_frame_s
    assert end_s == pytest.approx(frame.end_s, abs=1.0 / 60.0)
    assert live.ready_share == 1.0
    assert ready_spans(live, "unknown") == ()


def test_a_pose_made_at_once_is_the_one_that_is_made_in_time(performance: Performance) -> None:
    live = LiveMotion(performance)
    for player in performance.project.players:
        whole = player_motion(performance, player, whole_span(performance.time_frame, Fraction(60)))
        for index in range(0, whole.frames, 41):
            pose = live.pose_now(player.id, whole.first_frame_s + index / 60.0)
            assert np.array_equal(pose.rotations, whole.rotations[index])
            assert pose.morphs == {name: float(values[index]) for name, values in whole.morphs.items()}


def test_after_an_edit_a_player_who_was_seen_is_made_at_once(performance: Performance) -> None:
    live = LiveMotion(performance)
    player = performance.project.players[0]
    live.make_now(player.id, 8.0)
    assert live.pose(player.id, 8.0) is None, "figures are not loaded here"
    live.request(8.0, 1.0, (player.id,))
    live.work()
    shown = AddExpression("x", "strained", 6 * 960, 40 * 960)
    after = Performance(with_corrections(performance.project, player.id, [shown]), performance)
    live.show(after)
    live.make_now(player.id, 8.0)
    fresh = LiveMotion(after)
    made, anew = live.pose(player.id, 8.0), fresh.pose_now(player.id, 8.0)
    assert made is not None
    assert anew is not None
    assert any(start_s <= 8.0 < end_s for start_s, end_s in ready_spans(live, player.id))
    np.testing.assert_array_equal(made.rotations, anew.rotations)
    assert made.morphs == {**dict.fromkeys(made.morphs, 0.0), **anew.morphs}
    assert all_made(live) > 0
    assert live.ready_share == 1.0


def test_edits_that_follow_each_other_show_the_newest_pose_there_is(performance: Performance) -> None:
    live = LiveMotion(performance)
    player = performance.project.players[0]
    live.request(8.0, 1.0, (player.id,))
    all_made(live)
    before = live.pose(player.id, 8.0)
    strained = with_corrections(performance.project, player.id, [AddExpression("x", "strained", 6 * 960, 40 * 960)])
    live.show(Performance(strained, performance))
    live.make_now(player.id, 8.0)
    made = live.pose(player.id, 8.0)
    # Another edit comes before the worker has compared anything.
    smiling = with_corrections(strained, player.id, [AddExpression("y", "smile", 6 * 960, 40 * 960)])
    after = Performance(smiling, live.performance)
    live.show(after)
    shown = live.pose(player.id, 8.0)
    assert shown.morphs == made.morphs != before.morphs
    all_made(live)
    last, anew = live.pose(player.id, 8.0), LiveMotion(after).pose_now(player.id, 8.0)
    assert last.morphs == {**dict.fromkeys(last.morphs, 0.0), **anew.morphs}
    assert last.morphs != made.morphs


def test_after_an_edit_the_player_in_front_does_not_wait_for_another_that_is_being_made(
    performance: Performance, monkeypatch: pytest.MonkeyPatch
) -> None:
    live = LiveMotion(performance)
    first, second = performance.project.players[:2]
    live.request(8.0, 1.0, (first.id, second.id))
    live.work()
    begun, go_on, motion = threading.Event(), threading.Event(), PerformanceCurves.motion

    def slow(playing: PerformanceCurves, *arguments: Any) -> Motion:
        if playing.player_id == second.id:
            begun.set()
            assert go_on.wait(10.0)
        return motion(playing, *arguments)

    monkeypatch.setattr(PerformanceCurves, "motion", slow)
    worker = threading.Thread(target=live.work)
    worker.start()
    try:
        assert begun.wait(10.0)
        shown = AddExpression("x", "strained", 6 * 960, 40 * 960)
        after = Performance(with_corrections(performance.project, first.id, [shown]), performance)
        live.show(after)
        live.make_now(first.id, 8.0)
        made = live.pose(first.id, 8.0)
    finally:
        go_on.set()
        worker.join()
    anew = LiveMotion(after).pose_now(first.id, 8.0)
    assert made.morphs == {**dict.fromkeys(made.morphs, 0.0), **anew.morphs}
    assert live.pose(second.id, 8.0) is not None
    all_made(live)
    assert live.ready_share == 1.0


def test_between_two_frames_a_pose_is_between_them(performance: Performance) -> None:
    live = LiveMotion(performance)
    all_made(live)
    player = performance.project.players[2].id
    start_s = performance.time_frame.first_frame_s
    before, middle, after = (live.pose(player, start_s + (900 + share) / 60.0) for share in (0.0, 0.5, 1.0))
    np.testing.assert_allclose(middle.hips_m, (before.hips_m + after.hips_m) / 2.0, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(middle.rotations, axis=1), 1.0, atol=1e-6)
    sign = np.sign(np.einsum("ji,ji->j", before.rotations, after.rotations))[:, None]
    half = before.rotations + sign * after.rotations
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    np.testing.assert_allclose(middle.rotations, half, atol=1e-5)


@pytest.mark.parametrize("off_s", [0.0, 0.006])
def test_poses_of_several_are_those_of_each(performance: Performance, off_s: float) -> None:
    live = LiveMotion(performance)
    all_made(live)
    ids = [*(player.id for player in performance.project.players), "unknown"]
    random = np.random.default_rng(3)
    for frame in random.integers(0, 60 * 20, 40):
        time_s = performance.time_frame.first_frame_s + float(frame) / 60.0 + off_s
        together = live.poses(ids, time_s)
        assert len(together) == len(ids)
        assert together[-1] is None
        for player_id, pose in zip(ids[:-1], together, strict=False):
            alone = live.pose(player_id, time_s)
            assert pose is not None
            assert alone is not None
            for own, other in zip(vars(pose).values(), vars(alone).values(), strict=True):
                assert own == other if isinstance(own, dict) else np.array_equal(own, other)


def test_times_outside_the_performance_are_its_first_and_last_frame(performance: Performance) -> None:
    live = LiveMotion(performance)
    player, frame = performance.project.players[0].id, performance.time_frame
    for asked_s, there_s in ((-99.0, frame.first_frame_s), (9e9, frame.end_s - 0.5 / 60.0)):
        outside, inside = live.pose_now(player, asked_s), live.pose_now(player, there_s)
        np.testing.assert_allclose(outside.rotations, inside.rotations, atol=1e-3)


def test_memory_is_bounded_and_what_is_far_goes_first(performance: Performance) -> None:
    whole = LiveMotion(performance)
    all_made(whole)
    budget = whole.bytes // 3
    live = LiveMotion(performance, budget)
    live.request(0.0, 2.0)
    all_made(live)
    player = performance.project.players[0].id
    end_s = performance.time_frame.end_s - 1.0
    assert live.bytes <= budget
    assert live.ready_share > 0.8
    assert live.pose(player, 0.5) is not None
    assert live.pose(player, end_s) is None
    live.request(end_s, 2.0)
    all_made(live)
    assert live.bytes <= budget
    assert live.pose(player, end_s) is not None
    assert live.pose(player, performance.time_frame.first_frame_s) is None


def test_an_edit_leaves_what_it_did_not_touch_and_shows_the_old_until_the_new_is_there(
    performance: Performance,
) -> None:
    live = LiveMotion(performance)
    whole = all_made(live)
    player = performance.project.players[0]
    old = live.pose(player.id, 6.0)
    project = with_corrections(performance.project, player.id, [AddExpression("x", "strained", 6 * 960, 7 * 960)])
    live.show(Performance(project, performance))
    shown = live.pose(player.id, 6.5)
    assert shown is not None
    now = live.pose_now(player.id, 6.5)
    assert now.morphs != shown.morphs
    assert all_made(live) <= 3 < whole
    made = live.pose(player.id, 6.5)
    assert made.morphs == now.morphs
    assert old is not None
    assert live.ready_share == 1.0


def test_undone_edits_and_other_frame_rates(performance: Performance) -> None:
    live = LiveMotion(performance)
    all_made(live)
    slower = replace(performance.project, fps=Fraction(24))
    other = Performance(slower, performance)
    live.show(other)
    player = performance.project.players[0]
    assert live.pose(player.id, 6.0) is None
    all_made(live)
    whole = player_motion(other, player, whole_span(other.time_frame, Fraction(24)))
    pose = live.pose(player.id, whole.first_frame_s + 100 / 24.0)
    assert np.array_equal(pose.rotations, whole.rotations[100])


def test_a_player_who_came_or_went(performance: Performance) -> None:
    live = LiveMotion(performance)
    all_made(live)
    first, *others = performance.project.players
    fewer = Performance(replace(performance.project, players=tuple(others)), performance)
    live.show(fewer)
    assert live.pose(first.id, 6.0) is None
    assert live.error(first.id) is None
    twin = msgspec.structs.replace(first, id="twin", name="Twin")
    live.show(Performance(replace(performance.project, players=(first, *others, twin)), fewer))
    all_made(live)
    assert live.pose("twin", 6.0) is not None
    assert live.pose(first.id, 6.0) is not None


def test_clothes_change_motion_and_their_colours_do_not(performance: Performance) -> None:
    """Elbows leave room for what is worn."""
    live = LiveMotion(performance)
    all_made(live)
    first = performance.project.players[0].id
    dressed = Performance(give_outfit(performance.project, (first,), "marching"), performance)
    live.show(dressed)
    assert live.ready_share < 1.0
    all_made(live)
    live.show(Performance(colour_outfit(dressed.project, (first,), "main", "#203040"), dressed))
    assert live.ready_share == 1.0


def test_it_is_asked_while_it_works(performance: Performance) -> None:
    live = LiveMotion(performance)
    stop, faults = threading.Event(), list[BaseException]()

    def work() -> None:
        try:
            while not stop.is_set():
                live.work(stop.is_set)
        except BaseException as fault:  # noqa: BLE001 - reported below
            faults.append(fault)

    thread = threading.Thread(target=work)
    thread.start()
    player, before = performance.project.players[0], performance
    for tick in range(0, 9600, 960):
        project = with_corrections(before.project, player.id, [AddExpression("x", "smile", tick, tick + 480)])
        before = Performance(project, before)
        live.show(before)
        live.request(tick / 960.0)
        for time_s in np.linspace(-2.0, 12.0, 50):
            live.pose(player.id, float(time_s))
    stop.set()
    thread.join()
    assert not faults
    all_made(live)
    fresh = LiveMotion(Performance(before.project))
    all_made(fresh)
    for time_s in np.linspace(-2.0, 20.0, 70):
        one, other = live.pose(player.id, float(time_s)), fresh.pose(player.id, float(time_s))
        assert np.array_equal(one.rotations, other.rotations)
        # Shapes removed by an edit stay in the list with weight 0.
        names = one.morphs.keys() | other.morphs.keys()
        assert all(one.morphs.get(name, 0.0) == other.morphs.get(name, 0.0) for name in names)


def test_who_is_another_character_under_the_same_name_is_made_anew(
    performance: Performance, monkeypatch: pytest.MonkeyPatch
) -> None:
    live = LiveMotion(performance)
    all_made(live)
    again = Performance(performance.project, performance)
    again.prepare()
    live.show(again)
    assert live.ready_share == 1.0, "nothing is another one"
    first = performance.project.players[0]
    others = sum(player.character_id != first.character_id for player in performance.project.players)
    changed = replace(character_of(first))
    monkeypatch.setattr(
        "app.performance.bodies.character_named",
        lambda id: changed if id == first.character_id else character_named(id),
    )
    later = Performance(performance.project, performance)
    revisions = {**later.characters.revisions, first.character_id: 1}
    later.characters = replace(later.characters, revisions=revisions)
    later.prepare()
    live.show(later)
    assert live.pose(first.id, 2.0) is not None, "the old one is shown until the new one is there"
    assert live.ready_share == pytest.approx(others / len(performance.project.players))
    assert all_made(live) > 0
    assert live.ready_share == 1.0


def test_a_fault_in_one_players_motion_is_reported_once_and_the_others_are_made(
    performance: Performance, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, *others = performance.project.players
    motion = PerformanceCurves.motion

    def failing(playing: PerformanceCurves, *arguments: Any) -> Motion:
        if playing.player_id == first.id:
            raise ValueError("a bug")
        return motion(playing, *arguments)

    monkeypatch.setattr(PerformanceCurves, "motion", failing)
    live = LiveMotion(performance)
    live.request(8.0, 1.0, (first.id,))
    with pytest.raises(PlayerFault, match="ValueError: a bug") as caught:
        live.work()
    assert isinstance(caught.value.__cause__, ValueError)
    all_made(live)
    assert all(live.pose(player.id, 8.0) is not None for player in others)
    assert live.pose(first.id, 8.0) is None
    assert live.pose_now(first.id, 8.0) is None
    live.make_now(first.id, 8.0)
    error = live.error(first.id)
    assert error.id == "player.fault"
    assert [problem.message for problem in live.broken[first.id]] == [error]
    assert live.is_seen
    while live.judge():
        pass
    monkeypatch.undo()
    # An edited player is tried again.
    project = with_corrections(performance.project, first.id, [AddExpression("x", "smile", 0, 480)])
    live.show(Performance(project, performance))
    all_made(live)
    assert live.pose(first.id, 8.0) is not None
    assert first.id not in live.broken
