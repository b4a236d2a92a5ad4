"""Marks added by the user: in the project, in the plan, and stored."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import pytest

from app.errors import AppError, UsageError
from app.messages import text
from app.performance.ensemble import Performance
from app.performance.fact_sources import breath_source
from app.plan.by_hand.mark_corrections import RemoveMark, SetMark
from app.plan.music.velocity_ladders import LEVELS
from app.project.check import require_sound
from app.project.edit.corrections import with_corrections
from app.project.edit.events import give_back, is_there, remove
from app.project.edit.marks import player_marks, remove_marks, replace_mark, set_marks, toggle_marks
from app.project.edit.notes import erase, join, split
from app.project.edit.players import duplicate_players
from app.project.model import Project, project_from_score
from app.project.orphans import orphaned, reattached
from app.score.marks import Mark, Source
from app.score.model import Note, Part, Score
from app.score.tempo import TempoMap
from instrument_maps.load import bundled_maps

QUARTER = 480


def _piece(marks: tuple[Mark, ...] = (), source: Source = "sound", count: int = 16, gate: float = 0.9) -> Project:
    """Trumpet that plays a scale of quarters without rests."""
    notes = tuple(
        Note(f"0:{index}", index * QUARTER, round(gate * QUARTER), 60 + index % 8, 80) for index in range(count)
    )
    part = Part("0.0.0", "Trumpet", 0, 0, 0, 56, None, "trumpet_Bb", notes, marks=marks, source=source)
    return project_from_score(Score("scale", QUARTER, TempoMap(QUARTER), parts=(part,)), bundled_maps())


def _player(project: Project) -> str:
    return project.players[0].id


def _notes(project: Project, first: int, last: int) -> dict[str, list[Note]]:
    return {_player(project): list(project.score.parts[0].notes[first : last + 1])}


def _tongued(project: Project) -> list[bool]:
    plan = Performance(project).plan(project.players[0])
    struck = {event.note_id for event in plan.tongues}
    return [note.id in struck for note in project.score.parts[0].notes]


def _air(project: Project) -> list[float]:
    """Loudness of each note."""
    return [event.air for event in Performance(project).plan(project.players[0]).embouchures]


def test_a_slur_over_midi_notes_is_played_in_one_stroke_and_undone_by_a_second_press() -> None:
    project = _piece()
    slurred = toggle_marks(project, _notes(project, 2, 6), "slur")
    assert (slurred.added, slurred.number) == (True, 1)
    assert _tongued(project) == [True] * 16
    assert _tongued(slurred.project) == [not 2 < index <= 6 for index in range(16)]
    again = toggle_marks(slurred.project, _notes(project, 2, 6), "slur")
    assert (again.added, again.project) == (False, project)


def test_the_notes_where_a_slur_begins_and_after_it_are_tongued_in_a_legato_sound() -> None:
    project = _piece(gate=1.05)
    assert not any(_tongued(project)[1:])
    slurred = toggle_marks(project, _notes(project, 2, 6), "slur").project
    assert [index for index, stroke in enumerate(_tongued(slurred)) if stroke] == [0, 2, 7]
    apart = toggle_marks(project, _notes(project, 2, 6), "non_legato").project
    assert [index for index, stroke in enumerate(_tongued(apart)) if stroke] == [0, 3, 4, 5, 6]


def test_a_breath_mark_breathes_after_the_last_chosen_note() -> None:
    project = _piece()
    plan = Performance(toggle_marks(project, _notes(project, 1, 4), "breath").project).plan(project.players[0])
    assert any(event.id == "breath:0:5" and event.reason.id == "breath.by_hand" for event in plan.breaths)


@pytest.mark.parametrize("source", ["sound", "score"])
def test_a_dynamic_over_several_notes_of_a_sound_holds_for_these(source: Source) -> None:
    project = _piece(source=source)
    before, after = _air(project), _air(toggle_marks(project, _notes(project, 4, 7), "dynamic", "pp").project)
    held = 8 if source == "sound" else 16
    assert {index for index in range(16) if after[index] != before[index]} == set(range(4, held))
    assert after[4:held] == pytest.approx([LEVELS[1]] * (held - 4), abs=1e-3)


def test_a_crescendo_over_a_sound_begins_where_it_is_and_ends_a_dynamic_louder() -> None:
    project = _piece()
    swollen = toggle_marks(project, _notes(project, 4, 11), "crescendo").project
    air, before = _air(swollen), _air(project)
    assert air[:5] == before[:5]
    assert air[12:] == before[12:]
    assert air[4:12] == sorted({*air[4:12]})


def test_reasons_tell_marks_by_hand_from_those_of_the_score() -> None:
    project = _piece((Mark("staccato", "0:2"), Mark("breath", "0:4")), "score")
    project = set_marks(project, _player(project), [Mark("staccato", "0:3"), Mark("breath", "0:10")])
    plan = Performance(project).plan(project.players[0])
    reasons = {event.note_id: text(event.reason) for event in plan.tongues}
    assert (reasons["0:2"], reasons["0:3"]) == ("staccato in the score", "Staccato by hand")
    assert [breath_source(event) for event in plan.breaths if event.id in ("breath:0:5", "breath:0:11")] == [
        "score", "hand"
    ]  # fmt: skip
    breaths = {event.id: event.reason.id for event in plan.breaths}
    assert (breaths["breath:0:5"], breaths["breath:0:11"]) == ("breath.written", "breath.by_hand")


def test_a_mark_of_the_score_is_taken_away_moved_and_given_back() -> None:
    slur, piano = Mark("slur", "0:1", "0:4"), Mark("dynamic", tick=0, text="p")
    project = _piece((slur, piano), "score")
    player = _player(project)
    assert player_marks(project, player) == {slur: "score", piano: "score"}
    without = remove_marks(project, player, [slur])
    assert without.corrections[player] == (RemoveMark("slur", "0:1", "0:4"),)
    assert player_marks(without, player) == {piano: "score"}
    assert _tongued(without) == [True] * 16
    assert set_marks(without, player, [slur]) == project
    longer = Mark("slur", "0:1", "0:6")
    moved = replace_mark(project, player, slur, longer)
    assert player_marks(moved, player) == {piano: "score", longer: "hand"}
    forte = Mark("dynamic", tick=0, text="f")
    assert player_marks(replace_mark(project, player, piano, forte), player) == {slur: "score", forte: "hand"}


def test_marks_that_exclude_one_another_take_each_others_place() -> None:
    project = _piece((Mark("staccato", "0:2"),), "score")
    accented = toggle_marks(project, _notes(project, 2, 2), "accent").project
    marked = toggle_marks(accented, _notes(project, 2, 2), "tenuto").project
    assert {mark.kind for mark in player_marks(marked, _player(project))} == {"accent", "tenuto"}


@pytest.mark.parametrize(("last", "id"), [(2, "mark.one_note"), (1, "mark.no_notes")])
def test_what_a_mark_needs_is_said(last: int, id: str) -> None:
    project = _piece()
    with pytest.raises(UsageError) as caught:
        toggle_marks(project, _notes(project, 2, last), "slur")
    assert caught.value.message.id == id


def test_a_slur_that_lost_an_end_is_reported_and_gets_another_end() -> None:
    project = _piece()
    player = _player(project)
    slurred = set_marks(project, player, [Mark("slur", "0:2", "0:9")])
    part = slurred.score.parts[0]
    shorter = msgspec.structs.replace(part, notes=part.notes[:8])
    slurred = replace(slurred, score=msgspec.structs.replace(slurred.score, parts=(shorter,)))
    [orphan] = orphaned(slurred)
    assert any(
        problem.message.id == "correction.orphaned"
        for problem in Performance(slurred).plan(slurred.players[0]).problems
    )
    assert _tongued(slurred) == [True] * 8
    attached = reattached(slurred, player, orphan.correction, "0:7")
    assert attached.corrections[player] == (SetMark("slur", "0:2", "0:7"),)
    assert not orphaned(attached)


HOSTILE = [
    SetMark("slur", "0:1"),
    SetMark("slur"),
    SetMark("staccato", start_tick=5),
    SetMark("dynamic", start_tick=0, text="louder"),
    SetMark("dynamic", "0:1", text="p"),
    SetMark("dynamic", start_tick=-1, text="p"),
    SetMark("crescendo", start_tick=0),
    SetMark("crescendo", start_tick=0, end_tick=10**12),
    SetMark("staccato", "0:1", end_tick=5),
    SetMark("fingering", "0:1", text="1" * 10_000),
    SetMark("staccato", "0" * 10_000),
    RemoveMark("slur", "0:1", start_tick=3),
]


@pytest.mark.parametrize("correction", HOSTILE, ids=lambda item: str(item)[:60])
def test_a_mark_that_no_score_can_have_is_refused(correction: SetMark | RemoveMark) -> None:
    project = _piece()
    hostile = with_corrections(project, _player(project), [correction])
    with pytest.raises(AppError) as caught:
        require_sound(hostile)
    assert correction.kind in str(caught.value.message.arguments)


def test_a_selected_mark_is_deleted_and_given_back_as_an_event() -> None:
    slur = Mark("slur", "0:1", "0:4")
    project = _piece((slur,), "score")
    player = _player(project)
    project = set_marks(project, player, [Mark("staccato", "0:7"), Mark("dynamic", tick=0, text="f")])
    for mark in player_marks(project, player):
        assert is_there(project, player, mark.id)
        deleted = remove(project, Performance(project).plan(project.players[0]), [mark.id])
        assert not is_there(deleted, player, mark.id)
        assert set(player_marks(project, player)) - set(player_marks(deleted, player)) == {mark}
    without = remove_marks(project, player, [slur])
    assert give_back(without, player, [slur.id]) == project
    assert give_back(without, player, note_ids=["0:1"]) == project
    assert set(player_marks(give_back(without, player, note_ids=["0:0", "0:7"]), player)) == set()


def test_marks_of_erased_notes_go_and_copies_of_a_player_have_their_own() -> None:
    project = _piece()
    player = _player(project)
    marked = set_marks(project, player, [Mark("slur", "0:2", "0:9"), Mark("staccato", "0:5")])
    assert player_marks(erase(marked, ["0:5", "0:9"]), player) == {Mark("slur", "0:2", "0:8"): "hand"}
    assert not erase(marked, [f"0:{index}" for index in range(3, 10)]).corrections
    copied, [copy] = duplicate_players(marked, [player])
    notes = {note.id for note in copied.part(copied.player(copy)).notes}
    assert {mark.kind for mark in player_marks(copied, copy)} == {"slur", "staccato"}
    assert all({mark.note_id, mark.last_note_id or mark.note_id} <= notes for mark in player_marks(copied, copy))


@pytest.mark.parametrize("by_hand", [True, False])
def test_slurs_and_breath_marks_keep_their_notes_when_these_are_cut_and_joined(by_hand: bool) -> None:
    slur, breath = Mark("slur", "0:2", "0:5"), Mark("breath", "0:5")
    project = _piece(() if by_hand else (slur, breath), "score")
    player = _player(project)
    project = set_marks(project, player, [slur, breath])
    notes = project.score.parts[0].notes
    cut, [second] = split(project, ["0:5"], notes[5].onset_tick + 240)
    assert set(player_marks(cut, player)) == {Mark("slur", "0:2", second), Mark("breath", second)}
    assert set(player_marks(join(cut, ["0:5", second]), player)) == {slur, breath}
    assert Mark("slur", "0:3", "0:5") in player_marks(erase(project, ["0:2"]), player)
    without = erase(remove_marks(project, player, [slur]), ["0:5"])
    assert not {mark for mark in player_marks(without, player) if mark.kind == "slur"}


def test_marks_are_planned_after_one_another_as_at_once() -> None:
    project, before = _piece(), None
    for kind in ("slur", "dynamic", "crescendo", "staccato", "breath"):
        level = "mf" if kind == "dynamic" else ""
        project = toggle_marks(project, _notes(project, 2, 6), kind, level).project
        performance = Performance(project, before)
        assert performance.plan(project.players[0]) == Performance(project).plan(project.players[0])
        before = performance


@pytest.mark.parametrize(("deleted", "left"), [("p", "sfz"), ("sfz", "p")])
def test_a_sforzando_stands_beside_the_dynamic_that_holds(deleted: str, left: str) -> None:
    marks = {text: Mark("dynamic", tick=480, text=text) for text in ("p", "sfz")}
    project = _piece(tuple(marks.values()), "score")
    player = _player(project)
    plan = Performance(project).plan(project.players[0])
    changed = remove(project, plan, [marks[deleted].id])
    assert player_marks(changed, player) == {marks[left]: "score"}
    assert give_back(changed, player, [marks[deleted].id]) == project
    # Same result for a mark added by the user.
    project = _piece((marks["p"],), "score")
    struck = toggle_marks(project, _notes(project, 1, 1), "dynamic", "sfz").project
    assert player_marks(struck, player) == {marks["p"]: "score", marks["sfz"]: "hand"}
    assert player_marks(remove_marks(struck, player, [marks["p"]]), player) == {marks["sfz"]: "hand"}
