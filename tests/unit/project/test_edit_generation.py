"""Another performance changes random choices within its range, and no correction."""

from __future__ import annotations

from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import ChangeGesture
from app.project.edit import generation
from app.project.edit.corrections import with_corrections
from app.project.model import Project
from tests.gui.conftest import quartet_project as quartet


def sways(project: Project, index: int) -> list[tuple[int, float]]:
    plan = Performance(project).plan(project.players[index])
    return [(event.start_tick, event.amount) for event in plan.gestures if event.kind == "sway"]


def test_everyone_performs_anew() -> None:
    project = quartet()
    varied = generation.vary_everyone(project)
    assert all(sways(project, index) != sways(varied, index) for index in range(4))
    assert generation.vary_everyone(varied).seed not in (project.seed, varied.seed)


def test_the_chosen_players_perform_anew_and_the_others_as_before() -> None:
    project = quartet()
    varied = generation.vary_players(project, [project.players[1].id])
    assert [sways(project, index) == sways(varied, index) for index in range(4)] == [True, False, True, True]


def test_only_the_chosen_bars_are_performed_anew() -> None:
    project = quartet()
    player = project.players[0]
    start, end = project.score.metre_map.tick_of_bar(5), project.score.metre_map.tick_of_bar(9)
    varied = generation.vary_span(project, [player.id], start, end)
    before, after = dict(sways(project, 0)), dict(sways(varied, 0))
    assert before.keys() == after.keys()
    changed = {tick for tick in before if before[tick] != after[tick]}
    assert changed
    assert all(start <= tick < end for tick in changed)
    again = generation.vary_span(varied, [player.id], start, end)
    assert sways(again, 0) != sways(varied, 0)
    assert len(generation.variations(again, player.id)) == 1
    assert generation.unvary_span(again, [player.id], start, start + 1).corrections == project.corrections


def test_what_was_corrected_by_hand_stays_as_it_is() -> None:
    project = quartet()
    player = project.players[0]
    plan = Performance(project).plan(player)
    sway = next(event for event in plan.gestures if event.kind == "sway" and event.start_tick > 2000)
    corrected = with_corrections(project, player.id, [ChangeGesture(sway.id, amount=0.123)])
    for varied in (
        generation.vary_everyone(corrected),
        generation.vary_players(corrected, [player.id]),
        generation.vary_span(corrected, [player.id], 0, project.score.end_tick),
    ):
        amounts = {event.id: event.amount for event in Performance(varied).plan(player).gestures}
        assert amounts.get(sway.id, 0.123) == 0.123
        assert generation.by_hand(varied, [player.id]) == generation.by_hand(corrected, [player.id])
