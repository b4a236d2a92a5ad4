"""Regions of a style: motion inside, at the edges and outside, and edits that they survive."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.motion.model import frame_count
from app.motion.perform import PerformanceCurves
from app.performance.ensemble import Performance
from app.plan.acting import LAYERS, acting_of
from app.plan.by_hand.corrections import PlayStyle
from app.plan.styles import amount_at, shown_in_style, styles_at
from app.project.edit.corrections import with_corrections
from app.project.edit.events import add_style, move, remove, resize, set_fades, set_style
from app.project.edit.generation import vary_everyone
from app.project.edit.players import set_parameters
from app.project.model import Project
from app.project.piece_metadata import load_metadata, metadata_of, save_metadata, with_metadata
from metadata.acting import AMOUNTS
from tests.property.performance.edits import piece
from tests.support.performed import performance_curves

FPS = Fraction(10)


def curves_of(project: Project) -> PerformanceCurves:
    return performance_curves(Performance(project), project.players[0])


def rotations(curves: PerformanceCurves) -> np.ndarray:
    return curves.motion(FPS, 0, frame_count(curves.plan.time_frame, FPS)).rotations


@pytest.fixture(scope="module")
def plain() -> Project:
    project = piece()
    return set_parameters(project, (project.players[0].id,), style="reserved")


@pytest.fixture(scope="module")
def span(plain: Project) -> tuple[int, int]:
    """Third and fourth bar of the first player's notes."""
    metres, notes = plain.metre_map, plain.part(plain.players[0]).notes
    bars = metres.bars(notes[0].onset_tick, notes[-1].end_tick)
    return int(bars[2]), int(bars[4])


@pytest.fixture(scope="module")
def styled(plain: Project, span: tuple[int, int]) -> Project:
    return add_style(plain, plain.players[0].id, "soloist", *span).project


def test_inside_it_is_the_other_style_outside_the_own_and_between_both_are_blended(
    plain: Project, styled: Project
) -> None:
    player = plain.players[0]
    (event,) = Performance(styled).plan(player).styles
    whole = Performance(set_parameters(plain, (player.id,), style="soloist"))
    assert event.usual == acting_of(Performance(plain).parameters(player))
    assert event.acting == acting_of(whole.parameters(whole.project.player(player.id)))
    middle_s = 0.5 * (event.start_s + event.end_s)
    times_s = np.array([event.start_s - 1.0, event.start_s + 0.5 * event.fade_in_s, middle_s, event.end_s + 1.0])
    for name in AMOUNTS:
        layer = LAYERS.get(name, name)
        usual, other = getattr(event.usual, layer), getattr(event.acting, layer)
        shown = amount_at((event,), layer, usual, times_s)
        assert np.allclose(shown, [usual, 0.5 * (usual + other), other, usual])
    assert styles_at((event,), "reserved", times_s) == ["reserved", "soloist", "soloist", "reserved"]


def test_the_body_moves_more_in_it_and_as_before_outside(plain: Project, styled: Project) -> None:
    before, after = curves_of(plain), curves_of(styled)
    (event,) = after.plan.styles
    times_s = after.start_s + np.arange(frame_count(after.plan.time_frame, FPS)) / float(FPS)
    apart = np.abs(rotations(after) - rotations(before)).max(axis=(1, 2))
    # Steps and swings that touch the region reach a little beyond it.
    inside = (times_s > event.start_s) & (times_s < event.end_s)
    outside = (times_s < event.start_s - 4.0) | (times_s > event.end_s + 4.0)
    assert apart[inside].max() > 0.02
    assert apart[outside].max() < 1e-9
    moved = [np.abs(np.diff(rotations(one)[inside], axis=0)).sum() for one in (before, after)]
    assert moved[1] > 1.15 * moved[0]


def test_nothing_jumps_at_the_edges(styled: Project) -> None:
    curves = curves_of(styled)
    fine = Fraction(120)
    (event,) = curves.plan.styles
    for at_s in (event.start_s, event.end_s):
        first = round((at_s - curves.start_s) * 120) - 60
        steps = np.abs(np.diff(curves.motion(fine, first, 120).rotations, axis=0)).max(axis=(1, 2))
        assert steps.max() < 0.06


def test_only_the_region_is_made_anew(plain: Project, styled: Project) -> None:
    performance = Performance(styled)
    player = plain.players[0]
    region = Performance(styled).plan(player).styles[0]
    shorter = set_fades(styled, performance.plan(player), (region.id,), fade_in_s=0.0)
    changed_s = curves_of(shorter).changed_s(curves_of(styled))
    assert np.isfinite(changed_s).all()
    same = curves_of(styled).changed_s(curves_of(styled))
    assert len(same) == 0


def test_rules_of_a_style_hold_in_its_region(plain: Project) -> None:
    player = plain.players[0]
    notes = plain.part(player).notes
    students = add_style(plain, player.id, "jazz", 0, notes[-1].end_tick + 1).project
    ends = [event for event in Performance(students).plan(player).gestures if event.name == "bell_flourish"]
    alone = add_style(plain, player.id, "jazz", 0, notes[-1].onset_tick).project
    none = [event for event in Performance(alone).plan(player).gestures if event.name == "bell_flourish"]
    whole = Performance(set_parameters(plain, (player.id,), style="jazz")).plan(player).gestures
    assert [event.id for event in ends] == [event.id for event in whole if event.name == "bell_flourish"]
    assert none == []


def test_a_style_that_is_not_there_is_reported_and_changes_nothing(plain: Project, span: tuple[int, int]) -> None:
    player = plain.players[0]
    project = add_style(plain, player.id, "gone", *span).project
    performance = Performance(project)
    plan = performance.plan(player)
    (said,) = [problem for problem in plan.problems if problem.message.id == "project.style_missing"]
    assert said.message.arguments["name"] == "gone"
    assert said.message.arguments["player"] == player.name
    assert shown_in_style(plan).gestures == plan.gestures


def test_it_is_moved_resized_changed_and_removed(styled: Project, span: tuple[int, int]) -> None:
    player, start, end = styled.players[0], *span
    plan = Performance(styled).plan(styled.players[0])
    ids = (plan.styles[0].id,)

    def made(project: Project) -> PlayStyle:
        (item,) = project.corrections[player.id]
        assert isinstance(item, PlayStyle)
        return item

    assert (made(move(styled, plan, ids, 480).project).start_tick, made(styled).start_tick) == (start + 480, start)
    assert made(resize(styled, plan, ids, end_ticks=960)).end_tick == end + 960
    assert made(set_style(styled, plan, ids, "jazz")).style == "jazz"
    assert not remove(styled, plan, ids).corrections


def test_it_outlives_regenerating_and_goes_with_the_metadata(plain: Project, styled: Project, tmp_path: Path) -> None:
    player = styled.players[0]
    assert Performance(vary_everyone(styled)).plan(player).styles[0].style == "soloist"
    save_metadata(metadata_of(styled), tmp_path / "piece.toml")
    loaded = with_metadata(plain, load_metadata(tmp_path / "piece.toml")).project
    assert loaded.corrections == styled.corrections


def test_of_two_that_overlap_the_later_goes_over_the_other(styled: Project, span: tuple[int, int]) -> None:
    player = styled.players[0]
    start, end = span
    over = PlayStyle("own-9", "jazz", start + (end - start) // 2, end + 960)
    events = Performance(with_corrections(styled, player.id, (over,))).plan(player).styles
    assert [event.style for event in events] == ["soloist", "jazz"]
    at_s = np.array([events[1].start_s + 0.5])
    assert np.allclose(amount_at(events, "sway", events[0].usual.sway, at_s), events[1].acting.sway)


def test_a_style_of_the_section_intensity_is_in_it(styled: Project) -> None:
    player = styled.players[0]
    event = Performance(replace(styled, section_intensity=0.5)).plan(player).styles[0]
    whole = Performance(styled).plan(player).styles[0]
    assert event.acting.sway == pytest.approx(0.5 * whole.acting.sway)
    assert msgspec.structs.asdict(event)["style"] == "soloist"
