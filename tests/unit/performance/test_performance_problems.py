"""Number of frames examined for a report: equal for all usual pieces, lower for hours with few notes, and the report
about it.
"""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace
from typing import cast

import msgspec
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from app.contacts.breaks import JUDGED_PER_S
from app.performance import performance_problems
from app.performance.cast import performer_of
from app.performance.ensemble import Performance
from app.performance.motion import performance_curves
from app.performance.performance_problems import all_problems
from app.performance.span import whole_span
from app.plan.model import TimeFrame
from app.project.model import Project
from app.score.model import Note
from tests.fuzz.harness.costly_projects import base
from tests.support.doubled import flutist


def piece(quarters: int, players: int = 1) -> Project:
    """Trumpets with a few notes, and a last one after a number of quarter seconds each."""
    project = base(players)
    parts = [
        msgspec.structs.replace(part, notes=(*part.notes, Note(f"9{at}:1", quarters * 480, 480, 64, 80)))
        for at, part in enumerate(project.score.parts)
    ]
    tempo = msgspec.structs.replace(project.score.tempo_map, changes=project.score.tempo_map.changes[:1])
    score = msgspec.structs.replace(project.score, parts=tuple(parts), tempo_map=tempo)
    return replace(project, score=score, fps=Fraction(60))


@pytest.fixture
def rates(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Fraction, int]]:
    """Frame rate and number of the computed frames."""
    found: list[tuple[Fraction, int]] = []

    class Counted:
        def __init__(self, *arguments: object) -> None:
            self._made = performance_curves(*arguments)

        def __getattr__(self, name: str) -> object:
            return getattr(self._made, name)

        def motion(self, fps: Fraction, first: int, frames: int, every: int) -> object:
            made = self._made.motion(fps, first, frames, every)
            found.append((fps, made.frames))
            return made

    monkeypatch.setattr(performance_problems, "performance_curves", Counted)
    return found


def test_of_a_usual_piece_every_fourth_frame_is_looked_at(rates: list[tuple[Fraction, int]]) -> None:
    performance = Performance(piece(40))
    assert all_problems(performance, performance.project.players).notice is None
    count = whole_span(performance.time_frame, Fraction(60)).count
    assert rates == [(Fraction(60), math.ceil(count / 4))]


@pytest.mark.parametrize("project", [piece(8), flutist(2)], ids=["alone", "by turns"])
def test_frames_that_are_looked_at_are_those_of_the_whole_motion(project: Project) -> None:
    performance = Performance(project)
    playing = performance_curves(performance, performer_of(performance, project.players[0]))
    whole, some = playing.motion(Fraction(60), 9, 203), playing.motion(Fraction(60), 9, 203, 4)
    assert (some.fps, some.frames, some.first_frame_s) == (15, 51, whole.first_frame_s)
    for name in ("rotations", "hips_m", "instrument_position_m", "instrument_rotation"):
        np.testing.assert_array_equal(getattr(some, name), getattr(whole, name)[::4])
    for name in ("controls", "morphs"):
        mine, all_of = getattr(some, name), getattr(whole, name)
        assert mine.keys() == all_of.keys()
        assert all(np.array_equal(mine[one], all_of[one][::4]) for one in mine)


def test_hours_with_few_notes_are_looked_at_sparsely(
    rates: list[tuple[Fraction, int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(performance_problems, "WHOLE_FRAMES", 2000)
    monkeypatch.setattr(performance_problems, "SPARSE_FRAMES", 2000)
    monkeypatch.setattr(performance_problems, "SPARSE_PER_NOTE", 0)
    monkeypatch.setattr(performance_problems, "PLAYER_WORK", 0)
    performance = Performance(piece(400))
    notice = all_problems(performance, performance.project.players).notice
    assert notice.id == "judged.sparsely"
    assert sum(frames for _, frames in rates) <= 2000
    assert {fps for fps, _ in rates} == {Fraction(60, 8)}
    assert notice.arguments["rate"] == 7.5


@given(
    players=st.lists(st.integers(1, 3), min_size=1, max_size=128),
    notes=st.integers(1, 40_000),
    seconds=st.floats(1.0, 43_200.0),
    fps=st.sampled_from([Fraction(24), Fraction(30000, 1001), Fraction(60)]),
)
@example(players=[1] * 128, notes=12_800, seconds=10.0, fps=Fraction(60))
@example(players=[1] * 16, notes=8_600, seconds=357.0, fps=Fraction(60))
@example(players=[1], notes=40_000, seconds=3000.0, fps=Fraction(60))
def test_the_work_on_a_piece_is_bounded(players: list[int], notes: int, seconds: float, fps: Fraction) -> None:
    performance, each = of_length(seconds, fps), [notes // len(players)] * len(players)
    looked, count = performance_problems._looked(performance, players, each, performance_problems.MOST_WORK)
    assert (looked is None) == (count == 0)

    def work(rate: float, some: int) -> float:
        curves = performance_problems.PLAYER_WORK * sum(players[:some]) + performance_problems.CURVE_WORK * sum(
            each[:some]
        )
        return rate * seconds * sum(players[:some]) + curves + performance_problems.NOTE_WORK * sum(each)

    if looked is not None:
        rate = float(looked.fps) / looked.every
        assert rate >= performance_problems.LEAST_PER_S
        assert work(rate, count) <= performance_problems.MOST_WORK + sum(players)
    if count < len(players):
        # One musician more could not be looked at even as sparsely as anyone is, at every so many-th usual frame.
        few = performance_problems.SPARSE_FRAMES + performance_problems.SPARSE_PER_NOTE * sum(each)
        usual = float(fps) / max(1, round(float(fps) / JUDGED_PER_S))
        assert work(usual / (usual // performance_problems.LEAST_PER_S), count + 1) > min(
            performance_problems.MOST_WORK, few
        )


@pytest.mark.parametrize(
    ("players", "notes", "seconds", "rate"),
    [(4, 530, 107.0, 15.0), (3, 3424, 482.0, 15.0), (27, 7188, 113.0, 2.5), (12, 4197, 501.0, 5.0)],
    ids=["quartet", "Brandenburg concerto", "concert band", "overture"],
)
def test_everyone_is_looked_at_in_known_pieces(players: int, notes: int, seconds: float, rate: float) -> None:
    each = [notes // players] * players
    looked, count = performance_problems._looked(
        of_length(seconds, Fraction(60)), [1] * players, each, performance_problems.MOST_WORK
    )
    assert count == players
    assert float(looked.fps) / looked.every >= rate


def of_length(seconds: float, fps: Fraction) -> Performance:
    """Replacement for a performance with a frame rate and a length."""
    return cast(Performance, SimpleNamespace(project=SimpleNamespace(fps=fps), time_frame=TimeFrame(0.0, seconds)))


def test_the_first_players_are_looked_at_where_all_are_too_many(
    rates: list[tuple[Fraction, int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    project = piece(40, 4)
    seconds = whole_span(Performance(project).time_frame, Fraction(60)).count / 60.0
    monkeypatch.setattr(performance_problems, "NOTE_WORK", 0.0)
    monkeypatch.setattr(performance_problems, "CURVE_WORK", 0.0)
    monkeypatch.setattr(performance_problems, "MOST_WORK", 2 * (performance_problems.PLAYER_WORK + 2.5 * seconds))
    performance = Performance(project)
    problems, notice = all_problems(performance, project.players)
    assert len(rates) == 2
    assert notice.id == "judged.some"
    assert (notice.arguments["judged"], notice.arguments["last"]) == (2, project.players[1].name)
    assert problems.keys() == {player.id for player in project.players}


@pytest.mark.parametrize("limited", [True, False])
def test_everyone_is_looked_at_on_request(
    rates: list[tuple[Fraction, int]], monkeypatch: pytest.MonkeyPatch, limited: bool
) -> None:
    monkeypatch.setattr(performance_problems, "MOST_WORK", 1.0)
    performance = Performance(piece(40, 4))
    _, notice = all_problems(performance, performance.project.players, without_limit=not limited)
    assert (notice is None) == (not limited)
    assert len(rates) == (0 if limited else 4)


def test_hours_of_many_players_are_not_looked_at(rates: list[tuple[Fraction, int]]) -> None:
    performance = Performance(piece(80_000, 9))
    problems, notice = all_problems(performance, performance.project.players)
    assert not rates
    assert notice.id == "judged.not"
    assert notice.arguments == {"players": 9, "minutes": 667}
    assert problems.keys() == {player.id for player in performance.project.players}
