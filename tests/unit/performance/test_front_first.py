"""Selected players are planned and moved before all others, and the plans are independent of the order."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from app.errors import Cancelled
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.plan.model import PlayerPlan, Problem
from app.plan.player import PLAYER
from app.project.edit.piece import new_piece
from app.project.model import Project, project_from_score
from app.score.model import Note, Part, Score
from app.score.tempo import TempoMap
from instrument_maps.load import bundled_maps
from tests.property.performance.edits import piece
from tests.support.doubled import flutist

QUARTER = 480


@cache
def unison() -> Project:
    """Five clarinets with fast notes and hardly a rest, which stagger their breaths."""
    rows = [(QUARTER * 4 + QUARTER // 2 * index, 60 + (index * 5) % 12) for index in range(160)]
    parts = tuple(
        Part(
            f"{number}.1.1",
            f"Clarinet {number}",
            number - 1,
            0,
            0,
            None,
            None,
            "clarinet_Bb",
            tuple(Note(f"{number}:{index}", tick, QUARTER // 2, pitch, 80) for index, (tick, pitch) in enumerate(rows)),
        )
        for number in range(1, 6)
    )
    return project_from_score(Score("unison", QUARTER, TempoMap(QUARTER), parts=parts), bundled_maps())


def made(performance: Performance) -> dict[str, tuple[PlayerPlan, tuple[Problem, ...]]]:
    return {player_id: (plan, performance.problems(player_id)) for player_id, plan in performance.plans.items()}


@pytest.mark.parametrize("project", [unison, piece, flutist])
@pytest.mark.parametrize("seed", [1, 2])
def test_plans_are_the_same_in_any_order(project: Callable[[], Project], seed: int) -> None:
    in_order = Performance(project())
    ids = [player.id for player in in_order.project.players]
    mixed = Performance(project())
    order = [ids[number] for number in np.random.default_rng(seed).permutation(len(ids))]
    mixed.prepare(first=lambda: ["no one's", *order])
    assert made(mixed) == made(in_order)
    assert list(mixed.plans) == ids


def test_a_unison_has_breaths_that_depend_on_who_is_before() -> None:
    """Players in unison breathe at different times, so that comparing their plans is a valid test."""
    breaths = {tuple(event.start_s for event in plan.breaths) for plan in Performance(unison()).plans.values()}
    assert len(breaths) > 1


def test_of_others_no_more_than_their_breaths_is_computed_before_the_player_in_front(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fingered, breathed, counts = list[str](), list[str](), list[tuple[int, int, tuple[str, ...]]]()

    def counted(name: str, into: list[str]) -> None:
        function = PLAYER.functions[name]

        def counting(**inputs: object) -> object:
            into.append(name)
            return function(**inputs)

        monkeypatch.setitem(PLAYER.functions, name, counting)

    counted("planned_fingerings", fingered)
    counted("planned_breaths", breathed)
    performance = Performance(unison())
    ids = [player.id for player in performance.project.players]

    def planned(player_ids: tuple[str, ...]) -> None:
        counts.append((len(fingered), len(breathed), player_ids))

    performance.prepare(first=lambda: (ids[3],), planned=planned)
    assert counts[0] == (1, 4, (ids[3],))
    assert [player_ids for _, _, player_ids in counts[1:]] == [(ids[0],), (ids[1],), (ids[2],), (ids[4],)]
    assert (len(fingered), len(breathed)) == (5, 5), "nothing is computed twice"


def test_another_player_brought_to_the_front_is_next() -> None:
    performance, order = Performance(unison()), list[str]()
    ids = [player.id for player in performance.project.players]
    front = [ids[2]]

    def planned(player_ids: tuple[str, ...]) -> None:
        order.extend(player_ids)
        front[:] = [ids[4]]

    performance.prepare(first=lambda: tuple(front), planned=planned)
    assert order == [ids[2], ids[4], ids[0], ids[1], ids[3]]


def test_instruments_of_one_musician_are_planned_together() -> None:
    performance, order = Performance(flutist()), list[tuple[str, ...]]()
    doubled = next(player for player in performance.project.players if player.doubles)
    performance.prepare(first=lambda: (doubled.id,), planned=order.append)
    assert order[0] == (doubled.doubles, doubled.id)


def test_stopped_in_the_middle_it_begins_again() -> None:
    performance, reported = Performance(unison()), list[str]()
    with pytest.raises(Cancelled):
        performance.prepare(lambda: len(reported) == 2, planned=reported.extend)
    assert not performance.planned
    assert made(performance) == made(Performance(unison()))


def test_the_player_in_front_moves_while_others_are_planned_and_is_left_as_it_is_by_their_plans() -> None:
    live = LiveMotion(Performance(new_piece()))
    performance, seen = Performance(piece()), list[object]()
    ids = [player.id for player in performance.project.players]

    def planned(player_ids: tuple[str, ...]) -> None:
        if player_ids != (ids[1],):
            return
        live.request(8.0, 1.0, player_ids)
        live.show_first(performance, player_ids)
        while live.work():
            pass
        seen.append(live.pose(ids[1], 8.0))
        assert [live.pose(one, 8.0) is None for one in ids] == [True, False, True]
        assert not live.is_seen, "the others are missing yet"
        assert live.ready_share < 0.2
        assert not live.judge(), "what no one waits for is done after the plans"

    performance.prepare(first=lambda: (ids[1],), planned=planned)
    count = live.made
    live.show(performance)
    assert np.array_equal(live.pose(ids[1], 8.0).rotations, seen[0].rotations)  # type: ignore[attr-defined]
    while not live.is_seen:
        live.work()
    assert live.made - count == 2, "of the others"
    fresh = LiveMotion(Performance(piece()))
    for player_id in ids:
        anew, shown = fresh.pose_now(player_id, 8.1), live.pose(player_id, 8.1)
        assert anew is not None
        assert shown is not None
        assert np.array_equal(anew.rotations, shown.rotations)
