"""After an edit of an event the new plan has exactly this change, and undoing it restores the generated plan."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.errors import AppError
from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import AddGesture, PoseCorrection, RemoveEvent, SetBreath, SetCue
from app.plan.model import (
    BreathEvent,
    CueEvent,
    Event,
    ExpressionEvent,
    FingeringEvent,
    GestureEvent,
    PlayerPlan,
)
from app.project.edit import breaths_and_cues
from app.project.edit import events as edit
from app.project.edit.corrections import Edited, with_corrections
from app.project.model import Project, map_choices, project_from_score
from app.score.model import Note
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.support.blown import TEMPO, Blow, breath_curve, take, ticks

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
BARS = 12
"""Length of the piece in bars, enough for every kind of event and quickly planned."""


@cache
def piece() -> Project:
    """The first bars of the bundled quartet."""
    maps = bundled_maps()
    project = project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)
    end = project.score.metre_map.tick_of_bar(BARS)
    parts = tuple(
        msgspec.structs.replace(part, notes=tuple(note for note in part.notes if note.end_tick <= end))
        for part in project.score.parts
    )
    return replace(project, score=msgspec.structs.replace(project.score, parts=parts))


@cache
def generated() -> Performance:
    """Piece as generated."""
    performance = Performance(piece())
    performance.prepare()
    return performance


def made() -> PlayerPlan:
    """First player's generated plan."""
    return generated().plan(piece().players[0])


def plan_of(project: Project) -> PlayerPlan:
    """First player's plan after an edit, updated like in the editor."""
    return Performance(project, generated()).plan(project.players[0])


def player_id() -> str:
    return piece().players[0].id


def notes() -> tuple[Note, ...]:
    return piece().part(piece().players[0]).notes


def event(plan: PlayerPlan, event_id: str) -> Event:
    return edit.events_of(plan)[event_id]


def same_but(one: PlayerPlan, other: PlayerPlan, *event_ids: str) -> bool:
    """Return whether two plans have the same events except for some."""
    first, second = edit.events_of(one), edit.events_of(other)
    return {key: value for key, value in first.items() if key not in event_ids} == {
        key: value for key, value in second.items() if key not in event_ids
    }


def placed(kind: type[BreathEvent] | type[CueEvent] | type[GestureEvent] | type[ExpressionEvent]) -> list[Event]:
    return [item for item in edit.events_of(made()).values() if isinstance(item, kind)]


gestures = st.sampled_from([item.id for item in placed(GestureEvent)])
expressions = st.sampled_from([item.id for item in placed(ExpressionEvent)])
breaths = st.sampled_from([item.id for item in placed(BreathEvent)])
breath_ids = {item.id for item in placed(BreathEvent)}
fast = settings(max_examples=25, deadline=None)


@fast
@given(event_id=st.one_of(gestures, expressions), ticks=st.integers(-2000, 2000))
def test_a_moved_gesture_or_expression_is_where_it_was_put(event_id: str, ticks: int) -> None:
    before = event(made(), event_id)
    project, ids = edit.move(piece(), made(), (event_id,), ticks)
    assert ids == (event_id,)
    if ticks == 0:
        assert project is piece()
        return
    after = event(plan_of(project), event_id)
    assert (after.start_tick, after.end_tick) == (before.start_tick + ticks, before.end_tick + ticks)
    assert after.corrected
    back = edit.give_back(project, player_id(), ids)
    assert back.corrections == {}
    assert event(plan_of(back), event_id) == before


@fast
@given(event_id=st.one_of(gestures, expressions), start=st.integers(-4000, 4000), end=st.integers(-4000, 4000))
def test_a_resized_event_has_the_ends_it_was_given_and_never_turns_round(event_id: str, start: int, end: int) -> None:
    before = event(made(), event_id)
    after = event(plan_of(edit.resize(piece(), made(), (event_id,), start, end)), event_id)
    requested = (before.start_tick + start, before.end_tick + end)
    assert after.start_tick < after.end_tick
    if requested[0] < requested[1]:
        assert (after.start_tick, after.end_tick) == requested


@fast
@given(event_id=breaths, ticks=st.integers(-6000, 6000))
def test_a_moved_breath_keeps_its_length_serves_a_note_and_can_go_home(event_id: str, ticks: int) -> None:
    before = event(made(), event_id)
    assert isinstance(before, BreathEvent)
    project, (new_id,) = edit.move(piece(), made(), (event_id,), ticks)
    plan = plan_of(project)
    after = event(plan, new_id)
    assert isinstance(after, BreathEvent)
    note = next(note for note in notes() if f"{after.kind}:{note.id}" == new_id)
    assert after.end_tick - after.start_tick == before.end_tick - before.start_tick
    assert after.end_tick <= note.onset_tick
    if ticks:
        assert after.corrected
        assert after.depth == before.depth
        if new_id != event_id:
            left = edit.events_of(plan).get(event_id)
            # Whoever goes leaves nothing behind but a catch breath that the lungs ask for elsewhere.
            assert left is None
    back = edit.give_back(project, player_id(), (new_id,))
    assert back.corrections == {}
    assert plan_of(back) == made()


@fast
@given(event_id=breaths, there=st.integers(-6000, 6000))
def test_a_breath_dragged_there_and_back_is_where_it_was(event_id: str, there: int) -> None:
    project, (new_id,) = edit.move(piece(), made(), (event_id,), there)
    plan = plan_of(project)
    moved = event(plan, new_id)
    home = event(made(), event_id)
    back, (last_id,) = edit.move(project, plan, (new_id,), home.end_tick - moved.end_tick)
    after = event(plan_of(back), last_id)
    assert last_id == event_id
    assert (after.start_tick, after.end_tick) == (home.start_tick, home.end_tick)
    assert all(item.moved_from is None for item in back.corrections.get(player_id(), ()) if isinstance(item, SetBreath))


@fast
@given(event_id=st.one_of(gestures, expressions, breaths), amount=st.floats(-2.0, 2.0))
def test_an_amount_is_what_was_set_within_what_there_is(event_id: str, amount: float) -> None:
    project = edit.set_amounts(piece(), made(), {event_id: amount})
    after = event(plan_of(project), event_id)
    least = -1.0 if isinstance(after, GestureEvent) else 0.0
    value = {
        BreathEvent: lambda: after.depth,
        GestureEvent: lambda: after.amount,
        ExpressionEvent: lambda: after.strength,
    }[type(after)]()
    assert value == pytest.approx(min(max(amount, least), 1.0), abs=1e-4)
    assert after.corrected is (project is not piece())
    assert plan_of(edit.give_back(project, player_id(), (event_id,))) == made()


def test_several_changes_of_one_event_are_one_correction() -> None:
    event_id = next(item.id for item in made().gestures if item.kind == "weight_shift")
    project = edit.move(piece(), made(), (event_id,), 100).project
    project = edit.set_amounts(project, plan_of(project), {event_id: -0.25})
    project = edit.resize(project, plan_of(project), (event_id,), 0, 50)
    (correction,) = project.corrections[player_id()]
    before, after = event(made(), event_id), event(plan_of(project), event_id)
    assert correction.about == event_id
    assert (after.start_tick, after.end_tick) == (before.start_tick + 100, before.end_tick + 150)
    assert after.amount == -0.25


def test_several_events_move_together() -> None:
    ids = [item.id for item in made().gestures if item.kind == "sway"][2:5]
    project, new_ids = edit.move(piece(), made(), ids, 33)
    plan = plan_of(project)
    assert new_ids == tuple(ids)
    for event_id in ids:
        assert event(plan, event_id).start_tick == event(made(), event_id).start_tick + 33
    assert same_but(plan, made(), *ids)


def test_fades_and_face_of_an_expression() -> None:
    added = edit.add_expression(piece(), player_id(), "smile", 480, 2400)
    project = edit.set_fades(added.project, plan_of(added.project), added.event_ids, 0.05)
    project = edit.set_fades(project, plan_of(project), added.event_ids, fade_out_s=0.7)
    project = edit.set_expression(project, plan_of(project), added.event_ids, "strained")
    after = event(plan_of(project), added.event_ids[0])
    assert isinstance(after, ExpressionEvent)
    assert (after.expression, after.fade_in_s, after.fade_out_s) == ("strained", 0.05, 0.7)
    generated = next(item.id for item in made().expressions if item.id != "expression:neutral")
    project = edit.set_fades(piece(), made(), (generated,), 0.11, 0.22)
    faded = event(plan_of(project), generated)
    assert isinstance(faded, ExpressionEvent)
    assert (faded.fade_in_s, faded.fade_out_s) == (0.11, 0.22)


def test_embouchures_keep_what_else_was_set() -> None:
    note = notes()[3].id
    project = edit.set_embouchure(piece(), player_id(), (note,), tension=0.9)
    project = edit.set_embouchure(project, player_id(), (note,), air=1.5)
    lips = event(plan_of(project), f"embouchure:{note}")
    assert (lips.tension, lips.air) == (0.9, 1.0)
    assert lips.effort == event(made(), f"embouchure:{note}").effort
    assert plan_of(edit.give_back(project, player_id(), note_ids=(note,))) == made()


def test_a_pinned_fingering_is_played_and_given_back() -> None:
    player = piece().players[0]
    instrument = Performance(piece()).instrument(player)
    note = next(note for note in notes() if len(instrument.fingerings_for(note.pitch)) > 1)
    label = instrument.fingerings_for(note.pitch)[1].label
    project = edit.pin_fingerings(piece(), player.id, {note.id: label})
    pinned = event(plan_of(project), f"fingering:{note.id}")
    assert isinstance(pinned, FingeringEvent)
    assert (pinned.label, pinned.corrected) == (label, True)
    assert plan_of(edit.give_back(project, player.id, note_ids=(note.id,))) == made()


@fast
@given(event_id=st.one_of(gestures, expressions, breaths))
def test_what_is_deleted_is_gone_and_comes_back(event_id: str) -> None:
    project = edit.remove(piece(), made(), (event_id,))
    assert event_id not in edit.events_of(plan_of(project))
    assert plan_of(edit.give_back(project, player_id(), (event_id,))) == made()


def test_what_was_added_is_forgotten_when_deleted() -> None:
    plan = made()
    free = next(note for note in notes()[1:] if f"breath:{note.id}" not in edit.events_of(plan))
    breath = breaths_and_cues.add_breath(piece(), plan, free.onset_tick)
    assert breath.event_ids == (f"breath:{free.id}",)
    gesture = edit.add_gesture(breath.project, player_id(), "bell_height", 100, 500, 0.4)
    smile = edit.add_expression(gesture.project, player_id(), "smile", 100, 500)
    cue = breaths_and_cues.add_cue(smile.project, plan, free.onset_tick)
    ids = (*breath.event_ids, *gesture.event_ids, *smile.event_ids, *cue.event_ids)
    full = plan_of(cue.project)
    assert set(ids) <= set(edit.events_of(full))
    assert all(event(full, event_id).corrected for event_id in ids)
    assert edit.remove(cue.project, full, ids).corrections == {}


def test_a_changed_breath_that_is_deleted_does_not_return() -> None:
    first = made().breaths[-1]
    project = edit.set_amounts(piece(), made(), {first.id: 0.4})
    project = edit.remove(project, plan_of(project), (first.id,))
    assert [type(item) for item in project.corrections[player_id()]] == [RemoveEvent]
    assert first.id not in edit.events_of(plan_of(project))


def test_adding_where_something_was_deleted_brings_it_under_ones_hand() -> None:
    breath = made().breaths[-1]
    project = edit.remove(piece(), made(), (breath.id,))
    added = breaths_and_cues.add_breath(project, plan_of(project), breath.end_tick)
    assert added.event_ids == (breath.id,)
    (correction,) = added.project.corrections[player_id()]
    assert isinstance(correction, SetBreath)
    assert not correction.added


def test_adding_twice_selects_what_is_there() -> None:
    breath = next(item for item in made().breaths if item.kind == "breath")
    assert breaths_and_cues.add_breath(piece(), made(), breath.end_tick) == Edited(piece(), (breath.id,))
    cue = made().cues[0]
    assert breaths_and_cues.add_cue(piece(), made(), cue.end_tick) == Edited(piece(), (cue.id,))


def test_there_is_nothing_to_breathe_for_after_the_last_note() -> None:
    after = notes()[-1].onset_tick + 1
    with pytest.raises(AppError, match=r"edit\.no_note_to_breathe_for"):
        breaths_and_cues.add_breath(piece(), made(), after)
    with pytest.raises(AppError, match=r"edit\.no_note_to_cue"):
        breaths_and_cues.add_cue(piece(), made(), after)


def test_preparations_go_and_come() -> None:
    prepared = next(item for item in made().breaths if item.kind == "preparation")
    note = prepared.id.split(":", 1)[1]
    without = edit.toggle_preparation(piece(), made(), note).project
    assert prepared.id not in edit.events_of(plan_of(without))
    assert edit.toggle_preparation(without, plan_of(without), note).project.corrections == {}
    bare = next(
        item.id.split(":", 1)[1]
        for item in made().breaths
        if item.kind == "breath" and item.id.replace("breath", "preparation") not in edit.events_of(made())
    )
    added = edit.toggle_preparation(piece(), made(), bare)
    preparation = event(plan_of(added.project), f"preparation:{bare}")
    assert preparation.end_tick == event(made(), f"breath:{bare}").start_tick
    assert edit.toggle_preparation(added.project, plan_of(added.project), bare).project.corrections == {}


def test_a_cue_moves_to_another_entry_or_to_a_bare_tick() -> None:
    cue = made().cues[0]
    target = notes()[5]
    ticks = target.onset_tick - cue.end_tick
    project, ids = edit.move(piece(), made(), (cue.id,), ticks)
    assert ids == (f"cue:{target.id}",)
    moved = event(plan_of(project), ids[0])
    assert (moved.end_tick, moved.corrected) == (target.onset_tick, True)
    assert cue.id not in edit.events_of(plan_of(project))
    project, ids = edit.move(project, plan_of(project), ids, 7)
    assert ids == (f"cue:@{target.onset_tick + 7}",)
    assert event(plan_of(project), ids[0]).end_tick == target.onset_tick + 7
    assert not plan_of(project).problems
    assert plan_of(edit.give_back(project, player_id(), ids)) == made()


def test_the_preparatory_beat_of_a_cue_is_drawn_out() -> None:
    cue = made().cues[0]
    project = edit.resize(piece(), made(), (cue.id,), -(cue.end_tick - cue.start_tick))
    longer = event(plan_of(project), cue.id)
    assert longer.end_tick == cue.end_tick
    assert longer.end_tick - longer.start_tick == pytest.approx(2 * (cue.end_tick - cue.start_tick), abs=2)
    (correction,) = project.corrections[player_id()]
    assert isinstance(correction, SetCue)
    assert correction.beats == pytest.approx(2.0, abs=0.01)


def test_names_of_added_events_are_the_first_free_ones() -> None:
    project = with_corrections(piece(), player_id(), (AddGesture("own-2", "sway", 0, 10, 0.5),))
    ids = []
    for _ in range(3):
        project, (event_id,) = edit.add_gesture(project, player_id(), "sway", 0, 100)
        ids.append(event_id)
    assert ids == ["sway:own-1", "sway:own-3", "sway:own-4"]
    assert edit.add_expression(project, player_id(), "smile", 0, 100).event_ids == ("expression:own-5",)


def test_a_changed_added_event_is_replaced_under_its_name() -> None:
    project, ids = edit.add_gesture(piece(), player_id(), "sway", 0, 480, 0.5)
    project = edit.move(project, plan_of(project), ids, 240).project
    project = edit.set_amounts(project, plan_of(project), {ids[0]: -1.0})
    assert project.corrections[player_id()] == (AddGesture("own-1", "sway", 240, 720, -1.0),)


def test_a_pose_moves_and_fades() -> None:
    project = with_corrections(piece(), player_id(), (PoseCorrection("lift", "bell", 480, 960, up_deg=5.0),))
    plan = plan_of(project)
    if not plan.poses:
        pytest.skip("poses are not planned yet")
    (pose,) = plan.poses
    moved, ids = edit.move(project, plan, (pose.id,), 240)
    assert ids == (pose.id,)
    (after,) = plan_of(moved).poses
    assert (after.start_tick, after.end_tick, after.up_deg) == (720, 1200, 5.0)
    faded = edit.set_fades(project, plan, (pose.id,), 0.5)
    assert plan_of(faded).poses[0].fade_in_s == pytest.approx(0.5, abs=0.01)
    assert edit.remove(project, plan, (pose.id,)).corrections == {}


def test_all_of_a_player_goes_back() -> None:
    project = edit.set_amounts(piece(), made(), {made().breaths[0].id: 0.5})
    project = edit.remove(project, made(), (made().gestures[3].id,))
    assert edit.give_back_player(project, player_id()).corrections == {}


def test_a_breath_within_a_note_stays_in_it() -> None:
    blown = take([(0.5, 4.5, 65), (5.0, 6.0, 67)], breath_curve([Blow(0.5, 2.0), Blow(2.5, 4.5), Blow(5.0, 6.0)]))
    score = msgspec.structs.replace(piece().score, parts=(blown,), tempo_map=TEMPO)
    project = project_from_score(score, bundled_maps())
    plan = plan_of(project)
    breath = edit.events_of(plan)["within:1:1"]
    assert isinstance(breath, BreathEvent)
    moved = edit.move(project, plan, ("within:1:1",), 480)
    assert moved.event_ids == ("within:1:1",)
    after = edit.events_of(plan_of(moved.project))["within:1:1"]
    assert isinstance(after, BreathEvent)
    assert (after.start_tick, after.end_tick) == (breath.start_tick + 480, breath.end_tick + 480)
    far = edit.events_of(plan_of(edit.move(project, plan, ("within:1:1",), 9600).project))["within:1:1"]
    assert isinstance(far, BreathEvent)
    assert (far.end_tick, far.end_tick - far.start_tick) == (ticks(4.5), breath.end_tick - breath.start_tick)
    assert "within:1:1" not in edit.events_of(plan_of(edit.remove(project, plan, ("within:1:1",))))


prepared_breaths = st.sampled_from(
    [
        item.id
        for item in placed(BreathEvent)
        if item.draws_air and item.id.replace("breath", "preparation") in breath_ids
    ]
)


def _led_to(plan: PlayerPlan, breath_id: str) -> tuple[BreathEvent, BreathEvent]:
    """A breath and its preparation."""
    breath, before = event(plan, breath_id), event(plan, breath_id.replace("breath", "preparation"))
    assert isinstance(breath, BreathEvent)
    assert isinstance(before, BreathEvent)
    return breath, before


@fast
@given(event_id=prepared_breaths, ticks=st.integers(-6000, 6000), both=st.booleans())
def test_a_moved_breath_takes_its_preparation_along_and_back(event_id: str, ticks: int, both: bool) -> None:
    breath, before = _led_to(made(), event_id)
    chosen = (event_id, before.id) if both else (event_id,)
    project, new_ids = edit.move(piece(), made(), chosen, ticks)
    moved, after = _led_to(plan_of(project), new_ids[0])
    by = moved.start_tick - breath.start_tick
    assert (after.start_tick, after.end_tick) == (before.start_tick + by, before.end_tick + by)
    assert new_ids[1:] == ((after.id,) if both else ())
    assert plan_of(edit.give_back(project, player_id(), new_ids[:1])) == made()


@fast
@given(event_id=prepared_breaths, ticks=st.integers(-2000, 400))
def test_a_breath_drawn_out_at_its_start_keeps_its_preparation_before_it(event_id: str, ticks: int) -> None:
    breath, before = _led_to(made(), event_id)
    plan = plan_of(edit.resize(piece(), made(), (event_id,), start_ticks=ticks))
    longer, after = _led_to(plan, event_id)
    by = longer.start_tick - breath.start_tick
    assert (after.start_tick, after.end_tick) == (before.start_tick + by, before.end_tick + by)


def test_an_instrument_lowered_by_hand_is_raised_as_much_sooner_as_its_breath() -> None:
    """A generated lowering ends before the breath wherever it is moved; one added by the user does not."""
    for lowered in placed(GestureEvent):
        breath_id = lowered.id.replace("lower_instrument", "breath")
        if not lowered.id.startswith("lower_instrument:") or breath_id not in breath_ids:
            continue
        project = edit.resize(piece(), made(), (lowered.id,), end_ticks=-100)
        moved = edit.move(project, plan_of(project), (breath_id,), -960).project
        assert event(plan_of(moved), lowered.id).end_tick == lowered.end_tick - 1060
        break
    else:
        pytest.fail("no rest of the piece has both")


@fast
@given(event_id=st.one_of(gestures, expressions, breaths))
def test_an_amount_that_is_there_already_is_no_correction(event_id: str) -> None:
    now = event(made(), event_id)
    amount = getattr(now, edit.AMOUNTS[type(now)][0])
    assert edit.set_amounts(piece(), made(), {event_id: amount}) is piece()


def test_faces_and_fades_that_are_there_already_are_no_correction() -> None:
    face = next(item for item in placed(ExpressionEvent))
    assert isinstance(face, ExpressionEvent)
    assert edit.set_expression(piece(), made(), (face.id,), face.expression) is piece()
    assert edit.set_fades(piece(), made(), (face.id,), face.fade_in_s, face.fade_out_s) is piece()
