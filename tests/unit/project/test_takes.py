"""Takes become parts, span by span, without loss of the user's corrections."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.errors import AppError
from app.project.edit.notes import add_note, move, resize
from app.project.edit.placed_takes import BEFORE, take_curves, take_notes
from app.project.edit.players import duplicate_players, remove_players
from app.project.edit.takes import (
    add_takes,
    beats_of,
    comp,
    comp_whole,
    follow_beats,
    remove_take,
    rename_take,
    set_cleaning,
)
from app.project.model import CompSpan, Project
from app.project.storage import load, save
from app.score.take import Cleaning
from tests.support.takes import PlayedNote, take_of
from tests.unit.project.pieces import small_project

TRUMPET = "1.1.1"
EXACT = Cleaning(ghost_s=0.0, double_s=0.0, overlap_s=0.0)


def recorded(*takes: list[PlayedNote], cleaning: Cleaning = EXACT) -> Project:
    made = [take_of(notes, cleaning=cleaning, end_s=2.0) for notes in takes]
    return add_takes(small_project(), TRUMPET, made)[0]


def line(project: Project) -> list[tuple[int, int, int]]:
    return [(note.onset_tick, note.duration_tick, note.pitch) for note in notes(project)]


def notes(project: Project):  # type: ignore[no-untyped-def]
    return project.part(project.player(TRUMPET)).notes


ONE = [(0.1, 0.5, 70, 0.5), (0.5, 1.0, 71, 0.5), (1.0, 1.5, 72, 0.5), (1.5, 2.0, 73, 0.5)]
TWO = [(0.05, 0.5, 80, 0.8), (0.55, 1.0, 81, 0.8), (1.05, 1.5, 82, 0.8), (1.5, 2.0, 83, 0.8)]


def test_recording_changes_nothing_until_something_is_taken() -> None:
    project = recorded(ONE, TWO)
    assert project.score == small_project().score
    assert [take.id for take in project.takes[TRUMPET].takes] == ["take:1", "take:2"]


def test_a_whole_take_becomes_the_part() -> None:
    project = comp_whole(recorded(ONE), TRUMPET, "take:1")
    assert line(project) == [(96, 384, 70), (480, 480, 71), (960, 480, 72), (1440, 480, 73)]
    assert [note.id for note in notes(project)] == ["t:1000001", "t:1000002", "t:1000003", "t:1000004"]
    breath = next(curve for curve in project.part(project.player(TRUMPET)).curves if curve.kind == "breath")
    assert breath.values[breath.ticks.index(96)] == pytest.approx(64 / 127)


def test_the_part_has_of_each_take_what_was_swiped() -> None:
    project = comp_whole(recorded(ONE, TWO), TRUMPET, "take:1")
    project = comp(project, TRUMPET, "take:2", 480, 1440)
    assert [pitch for _, _, pitch in line(project)] == [70, 81, 82, 73]
    spans = project.takes[TRUMPET].comp
    assert [(span.start_tick, span.take_id) for span in spans] == [(0, "take:1"), (480, "take:2"), (1440, "take:1")]
    project = comp(project, TRUMPET, BEFORE, 960, 1440)
    assert [pitch for _, _, pitch in line(project)] == [70, 81, 62, 73]
    # Reverting to the first take gives an identical part.
    again = comp_whole(project, TRUMPET, "take:1")
    assert line(again) == line(comp_whole(recorded(ONE, TWO), TRUMPET, "take:1"))
    assert again.takes[TRUMPET].comp == (CompSpan(0, 1920, "take:1"),)


def test_going_back_to_what_was_before_gives_the_score() -> None:
    before = small_project()
    project = comp_whole(recorded(ONE), TRUMPET, "take:1")
    project = comp_whole(project, TRUMPET, BEFORE)
    assert project.score == before.score
    assert project.takes[TRUMPET].comp == ()


def test_what_was_changed_by_hand_outside_a_swipe_stays() -> None:
    project = comp_whole(recorded(ONE, TWO), TRUMPET, "take:1")
    project = move(project, ["t:1000004"], 0, 5)
    project = comp(project, TRUMPET, "take:2", 0, 480)
    assert notes(project)[-1].pitch == 78


def test_a_note_moved_out_of_a_span_by_hand_does_not_come_twice() -> None:
    project = comp_whole(recorded(ONE), TRUMPET, "take:1")
    project = move(project, ["t:1000002"], 1440, 0)
    project = comp(project, TRUMPET, "take:1", 0, 960)
    ids = [note.id for note in notes(project)]
    assert len(ids) == len(set(ids))
    assert ids.count("t:1000002") == 1


def test_notes_are_cut_where_another_take_goes_on() -> None:
    long = [(0.1, 1.4, 70, 0.5)]
    project = comp(recorded(long, TWO), TRUMPET, "take:1", 0, 1440)
    project = comp(project, TRUMPET, "take:2", 480, 1440)
    assert line(project)[0] == (96, 528 - 96, 70)


def test_cleaning_follows_in_the_part_but_for_what_was_changed_by_hand() -> None:
    played = [(0.1, 0.5, 70, 0.5), (0.52, 0.54, 90, 0.05), (0.6, 1.0, 71, 0.5), (1.1, 1.5, 72, 0.5)]
    project = comp_whole(recorded(played), TRUMPET, "take:1")
    assert 90 in [note.pitch for note in notes(project)]
    project = move(project, ["t:1000004"], 0, 3)
    project = set_cleaning(project, TRUMPET, "take:1", Cleaning(quantise=1.0, grid_quarters=0.5))
    assert [(note.onset_tick, note.pitch) for note in notes(project)][:2] == [(0, 70), (480, 71)]
    by_hand = notes(project)[-1 if notes(project)[-1].id == "t:1000004" else 2]
    assert (by_hand.id, by_hand.pitch, by_hand.onset_tick) == ("t:1000004", 75, 1056)


def test_a_take_of_a_known_part_lands_on_its_notes() -> None:
    rng = np.random.default_rng(1)
    base = small_project()
    drawn = [(480 * index, 440, 60 + [0, 2, 4, 5, 7, 5, 4, 2][index % 8]) for index in range(32)]
    for onset, length, pitch in drawn:
        base, _ = add_note(base, TRUMPET, 1920 + onset, length, pitch, 80)
    score_notes = base.part(base.player(TRUMPET)).notes
    tempo = base.score.tempo_map
    played: list[PlayedNote] = []
    for note in score_notes:
        at = tempo.seconds(note.onset_tick) + float(rng.normal(0.03, 0.02))
        played.append((max(at, 0.0), tempo.seconds(note.end_tick) - 0.02, note.pitch, 0.6))
    del played[7]
    played[12] = (*played[12][:2], played[12][2] + 1, 0.6)
    base, _ = add_takes(base, TRUMPET, [take_of(played, cleaning=Cleaning(align=1.0))])
    found = {note.id: note for note in take_notes(base, TRUMPET, "take:1")}
    requested = {note.id: note for note in score_notes}
    assert len(found.keys() & requested.keys()) == len(score_notes) - 1
    assert all(
        (found[id].onset_tick, found[id].pitch) == (note.onset_tick, note.pitch)
        for id, note in requested.items()
        if id in found
    )

    # Half of the alignment goes half of the way, from where the notes were played.
    base = set_cleaning(base, TRUMPET, "take:1", Cleaning(align=0.0))
    loose = sorted(note.onset_tick for note in take_notes(base, TRUMPET, "take:1"))
    base = set_cleaning(base, TRUMPET, "take:1", Cleaning(align=0.5))
    half = sorted(note.onset_tick for note in take_notes(base, TRUMPET, "take:1"))
    aligned = sorted(note.onset_tick for note in found.values())
    assert half == pytest.approx((np.array(loose) + np.array(aligned)) / 2.0, abs=1.0)


def test_the_breath_goes_where_the_notes_go() -> None:
    played = [(0.07, 0.4, 70, 0.5), (0.6, 0.95, 71, 0.9)]
    project = add_takes(small_project(), TRUMPET, [take_of(played, cleaning=Cleaning(quantise=1.0, grid_quarters=1.0))])
    take_id = project[1][0]
    found = take_notes(project[0], TRUMPET, take_id)
    assert [note.onset_tick for note in found] == [0, 480]
    breath = next(curve for curve in take_curves(project[0], TRUMPET, take_id) if curve.kind == "breath")
    assert breath.ticks[0] == 0
    assert breath.values[breath.ticks.index(480)] == pytest.approx(round(0.9 * 127) / 127)
    assert list(breath.ticks) == sorted(breath.ticks)
    # Also in the part, when the take is cleaned later.
    loose = add_takes(small_project(), TRUMPET, [take_of(played, end_s=2.0)])[0]
    loose = set_cleaning(
        comp_whole(loose, TRUMPET, take_id), TRUMPET, take_id, Cleaning(quantise=1.0, grid_quarters=1.0)
    )
    part = loose.part(loose.player(TRUMPET))
    curve = next(curve for curve in part.curves if curve.kind == "breath")
    assert {note.onset_tick for note in part.notes} <= set(curve.ticks) | {0}


def test_a_free_take_gives_the_piece_its_beats() -> None:
    beats = np.cumsum(np.concatenate([[1.0], np.full(15, 0.6), np.full(15, 0.55)]))
    played = [(float(at), float(at) + 0.5, 60 + index % 5, 0.6) for index, at in enumerate(beats)]
    project = add_takes(_empty(), TRUMPET, [take_of(played)])[0]
    project = follow_beats(project, TRUMPET, "take:1", beats_of(project, TRUMPET, "take:1"))
    ticks = np.array([note.onset_tick for note in notes(project)])
    assert np.abs(ticks - 480 * np.rint(ticks / 480)).max() <= 30
    assert len(ticks) == len(played)
    # Played notes keep their times.
    seconds = project.score.tempo_map.seconds(ticks)
    assert np.abs(np.diff(seconds) - np.diff(beats)).max() < 0.02


def test_beats_are_not_found_where_others_play() -> None:
    with pytest.raises(AppError) as caught:
        beats_of(recorded(ONE), TRUMPET, "take:1")
    assert caught.value.message.id == "take.not_free"


def _empty() -> Project:
    project = small_project()
    parts = tuple(msgspec.structs.replace(part, notes=()) for part in project.score.parts)
    return replace(project, score=msgspec.structs.replace(project.score, parts=parts))


def test_a_take_thrown_away_leaves_its_notes_and_its_number_is_not_used_again() -> None:
    project = comp_whole(recorded(ONE), TRUMPET, "take:1")
    before = line(project)
    project = remove_take(project, TRUMPET, "take:1")
    assert (line(project), project.takes[TRUMPET].takes) == (before, ())
    project, ids = add_takes(project, TRUMPET, [take_of(TWO)])
    assert ids == ("take:2",)


def test_drawing_after_a_take_never_meets_a_note_of_before() -> None:
    project, drawn = add_note(small_project(), TRUMPET, 3000, 100, 60, 80)
    project = add_takes(project, TRUMPET, [take_of(ONE, end_s=9.0)])[0]
    project = comp_whole(project, TRUMPET, "take:1")
    assert drawn not in {note.id for note in notes(project)}
    project, other = add_note(project, TRUMPET, 20000, 100, 60, 80)
    assert other != drawn


def test_players_take_their_takes_with_them() -> None:
    project = recorded(ONE)
    assert remove_players(project, [TRUMPET]).takes == {}
    doubled, _ = duplicate_players(comp_whole(project, TRUMPET, "take:1"), [TRUMPET])
    assert set(doubled.takes) == {TRUMPET}


def test_a_project_with_takes_is_read_back_the_same(tmp_path: Path) -> None:
    project = comp(comp_whole(recorded(ONE, TWO), TRUMPET, "take:1"), TRUMPET, "take:2", 480, 960)
    project = rename_take(project, TRUMPET, "take:2", "二番目")
    save(project, tmp_path / "work.suisou")
    assert load(tmp_path / "work.suisou") == project


swipes = st.lists(
    st.tuples(st.sampled_from(["take:1", "take:2", BEFORE]), st.integers(0, 2000), st.integers(1, 900)), max_size=8
)


@given(swipes)
@settings(max_examples=60, deadline=None)
def test_the_part_is_always_what_the_comp_says(made: list[tuple[str, int, int]]) -> None:
    project = recorded(ONE, TWO)
    owner = dict.fromkeys(range(3000), BEFORE)
    for take_id, start, length in made:
        project = comp(project, TRUMPET, take_id, start, start + length)
        owner |= dict.fromkeys(range(start, start + length), take_id)
    sources = {
        id: {note.onset_tick: note.pitch for note in take_notes(project, TRUMPET, id)} for id in ("take:1", "take:2")
    }
    sources[BEFORE] = {note.onset_tick: note.pitch for note in small_project().score.parts[0].notes}
    expected = [(tick, sources[take_id][tick]) for tick, take_id in owner.items() if tick in sources[take_id]]
    assert [(note.onset_tick, note.pitch) for note in notes(project)] == expected
    spans = {
        tick: span.take_id
        for span in project.takes.get(TRUMPET, _none()).comp
        for tick in range(span.start_tick, min(span.end_tick, 3000))
    }
    assert spans == {tick: take_id for tick, take_id in owner.items() if take_id != BEFORE}


def _none():  # type: ignore[no-untyped-def]
    from app.project.model import PlayerTakes

    return PlayerTakes(())


def test_lengths_changed_by_hand_stay_when_a_take_is_cleaned() -> None:
    project = comp_whole(recorded(ONE), TRUMPET, "take:1")
    project = resize(project, ["t:1000001"], 40)
    project = set_cleaning(project, TRUMPET, "take:1", Cleaning())
    assert notes(project)[0].duration_tick == 424


@given(swipes, st.integers(0, 3))
@settings(max_examples=40, deadline=None)
def test_what_is_blown_is_always_the_take_s_that_the_comp_says(made: list[tuple[str, int, int]], seed: int) -> None:
    rng = np.random.default_rng(seed)
    times = np.sort(rng.integers(-200, 2000, 40)) / 1000.0
    sent = [(float(at), f"b002{value:02x}") for at, value in zip(times, rng.integers(0, 128, 40), strict=True)]
    blown = [take_of(ONE, cleaning=EXACT, breathes=False, more=sent[part::2], start_s=-1.0) for part in (0, 1)]
    project = add_takes(small_project(), TRUMPET, blown)[0]
    owner = dict.fromkeys(range(3000), BEFORE)
    for take_id, start, length in made:
        project = comp(project, TRUMPET, take_id, start, start + length)
        owner |= dict.fromkeys(range(start, start + length), take_id)
    breath = next((c for c in project.part(project.player(TRUMPET)).curves if c.kind == "breath"), None)
    for tick in range(0, 3000, 7):
        expected = 0.0
        if owner[tick] != BEFORE:
            # Times are whole ticks: 960 a second.
            part = 0 if owner[tick] == "take:1" else 1
            said = [int(raw[4:], 16) / 127 for at, raw in sent[part::2] if round(at * 960) <= tick]
            expected = said[-1] if said else 0.0
        index = -1 if breath is None else int(np.searchsorted(breath.ticks, tick, side="right")) - 1
        assert (breath.values[index] if breath is not None and index >= 0 else 0.0) == expected


def test_what_a_take_says_does_not_hold_for_what_was_played_before_it() -> None:
    project = comp(recorded(ONE), TRUMPET, "take:1", 480, 1200)
    for curve in project.part(project.player(TRUMPET)).curves:
        assert (curve.ticks[0], curve.values[0]) == (0, 0.0), curve.kind
    breath = next(curve for curve in project.part(project.player(TRUMPET)).curves if curve.kind == "breath")
    assert breath.values[list(breath.ticks).index(480)] > 0.0
    # Taken from the beginning on there is nothing before.
    whole = comp(recorded([(0.0, 0.5, 70, 0.5)]), TRUMPET, "take:1", 0, 480)
    assert whole.part(whole.player(TRUMPET)).curves[0].values[0] > 0.0
