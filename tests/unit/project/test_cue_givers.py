"""Choosing another player for a cue: an edit that can be undone, and the arrows that show it."""

from __future__ import annotations

import pytest

from app.errors import AppError
from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import RemoveEvent, SetCue
from app.project.edit.cue_givers import hand_over, set_giver, set_takers
from app.project.model import Project
from tests.unit.project.pieces import small_project
from widgets.timeline.model.roll.entries import entry_arrows

TRUMPET, TROMBONE = "1.1.1", "2.1.1"


def given(project: Project) -> dict[str, tuple[str, tuple[str, ...]]]:
    """Id and receivers of each player's cue."""
    plans = Performance(project).plans
    return {player: (cue.id, cue.takers) for player, plan in plans.items() for cue in plan.cues}


def test_another_player_gives_the_entry_and_the_first_again() -> None:
    project = small_project()
    assert given(project) == {TRUMPET: ("cue:1:1", (TROMBONE,))}
    edited = set_giver(project, Performance(project).plans[TRUMPET], "cue:1:1", TROMBONE)
    assert edited.event_ids == ("cue:2:1",)
    assert given(edited.project) == {TROMBONE: ("cue:2:1", (TRUMPET,))}
    assert edited.project.corrections == {
        TRUMPET: (RemoveEvent("cue:1:1", "1:1"),),
        TROMBONE: (SetCue("2:1", 1.0, added=True),),
    }
    back = set_giver(edited.project, Performance(edited.project).plans[TROMBONE], "cue:2:1", TRUMPET)
    assert back.event_ids == ("cue:1:1",)
    assert back.project.corrections == {}
    assert given(back.project) == given(project)


def test_a_giver_who_does_not_play_there_gives_it_at_its_place() -> None:
    project = small_project()
    plan = Performance(project).plans[TRUMPET]
    same = set_giver(project, plan, "cue:1:1", TRUMPET)
    assert same.project is project
    gone = set_giver(project, plan, "cue:1:9", TROMBONE)
    assert gone.project is project


def test_arrows_go_from_who_gives_an_entry_to_who_takes_it() -> None:
    project = small_project()
    plans = Performance(project).plans
    (arrow,) = entry_arrows(project, plans, TRUMPET)
    assert (arrow.giver_id, arrow.taker_id) == (TRUMPET, TROMBONE)
    assert (arrow.from_pitch, arrow.to_pitch) == (60, 48)
    assert arrow.from_s == plans[TRUMPET].cues[0].peak_s
    assert arrow.to_s == 0.0
    assert entry_arrows(project, plans, TROMBONE) == (arrow,)
    assert entry_arrows(project, plans, "nobody") == ()


def test_a_cue_brings_in_whom_the_user_chose() -> None:
    project = small_project()
    plan = Performance(project).plans[TRUMPET]
    alone = set_takers(project, plan, "cue:1:1", ())
    assert alone.corrections == {TRUMPET: (SetCue("1:1", 1.0, takers=()),)}
    assert given(alone) == {TRUMPET: ("cue:1:1", ())}
    again = set_takers(alone, Performance(alone).plans[TRUMPET], "cue:1:1", (TROMBONE, TRUMPET, "nobody"))
    assert given(again) == {TRUMPET: ("cue:1:1", (TROMBONE,))}
    assert set_takers(project, plan, "cue:1:9", ()) is project


def test_an_entry_is_handed_over_to_another_note() -> None:
    project = small_project()
    plan = Performance(project).plans[TRUMPET]
    later = next(note for note in project.score.parts[1].notes if note.onset_tick > 0)
    edited = hand_over(project, plan, "cue:1:1", TROMBONE, TROMBONE, later.onset_tick)
    (cue,) = Performance(edited.project).plans[TRUMPET].cues
    assert cue.end_tick == later.onset_tick
    assert edited.event_ids == (cue.id,)
    with pytest.raises(AppError, match=r"edit\.no_note_to_take"):
        hand_over(project, plan, "cue:1:1", TROMBONE, TROMBONE, 10**6)


def test_a_chosen_taker_who_becomes_the_giver_changes_places_with_the_giver() -> None:
    project = small_project()
    chosen = set_takers(project, Performance(project).plans[TRUMPET], "cue:1:1", (TROMBONE,))
    edited = set_giver(chosen, Performance(chosen).plans[TRUMPET], "cue:1:1", TROMBONE)
    assert given(edited.project) == {TROMBONE: ("cue:2:1", (TRUMPET,))}


def test_the_preparatory_beat_begins_where_it_is_put() -> None:
    project = small_project()
    plan = Performance(project).plans[TRUMPET]
    edited = set_giver(project, plan, "cue:1:1", TRUMPET, peak_tick=-960.0)
    (cue,) = Performance(edited.project).plans[TRUMPET].cues
    assert round(project.score.tempo_map.ticks(cue.peak_s)) == -960
    assert edited.project.corrections == {TRUMPET: (SetCue("1:1", 2.0),)}
