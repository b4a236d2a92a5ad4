"""How many frames a report looks at: as many in all usual pieces, few in hours with little in them, and what it says
of that."""

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

from app.performance import judged
from app.performance.cast import performer_of
from app.performance.ensemble import Performance
from app.performance.judged import all_problems
from app.performance.motion import playing_of
from app.performance.span import whole_span
from app.plan.model import TimeFrame
from app.project.model import Project
from app.score.model import Note
from tests.fuzz.harness.costly_projects import base
from tests.support.doubled import flutist


def piece(quarters: int, players: int = 1) -> Project:
    """Trumpets with a few notes, and a last one after so many quarters of a second each."""
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
    """Frame rate and number of the frames that are made."""
    found: list[tuple[Fraction, int]] = []
    playing_of = judged.playing_of

    class Counted:
        def __init__(self, *arguments: object) -> None:
            self._made = playing_of(*arguments)  # type: ignore[arg-type]

        def __getattr__(self, name: str) -> object:
            return getattr(self._made, name)

        def motion(self, fps: Fraction, first: int, frames: int, every: int) -> object:
            made = self._made.motion(fps, first, frames, every)
            found.append((fps, made.frames))
            return made

    monkeypatch.setattr(judged, "playing_of", Counted)
    return found


def test_of_a_usual_piece_every_fourth_frame_is_looked_at(rates: list[tuple[Fraction, int]]) -> None:
    performance = Performance(piece(40))
    assert all_problems(performance, performance.project.players).notice is None
    count = whole_span(performance.time_frame, Fraction(60)).count
    assert rates == [(Fraction(60), math.ceil(count / 4))]


@pytest.mark.parametrize("project", [piece(8), flutist(2)], ids=["alone", "by turns"])
def test_frames_that_are_looked_at_are_those_of_the_whole_motion(project: Project) -> None:
    performance = Performance(project)
    playing = playing_of(performance, performer_of(performance, project.players[0]))
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
    monkeypatch.setattr(judged, "WHOLE_FRAMES", 2000)
    monkeypatch.setattr(judged, "SPARSE_FRAMES", 2000)
    monkeypatch.setattr(judged, "SPARSE_PER_NOTE", 0)
    performance = Performance(piece(400))
    notice = all_problems(performance, performance.project.players).notice
    assert notice is not None
    assert notice.id == "judged.sparsely"
    assert sum(frames for _, frames in rates) <= 2000
    assert {fps for fps, _ in rates} == {Fraction(60, 8)}
    assert notice.arguments["rate"] == 7.5


@given(
    players=st.integers(1, 128),
    notes=st.integers(1, 40_000),
    seconds=st.floats(1.0, 43_200.0),
    fps=st.sampled_from([Fraction(24), Fraction(30000, 1001), Fraction(60)]),
)
@example(players=128, notes=12_800, seconds=10.0, fps=Fraction(60))
@example(players=1, notes=40_000, seconds=3000.0, fps=Fraction(60))
def test_the_work_on_a_piece_is_bounded(players: int, notes: int, seconds: float, fps: Fraction) -> None:
    frame = TimeFrame(0.0, seconds)
    piece_of_so_many = SimpleNamespace(project=SimpleNamespace(fps=fps), time_frame=frame)
    looked, notice = judged._looked(cast(Performance, piece_of_so_many), players, notes)
    if looked is None:
        assert notice is not None
        assert notice.id == "judged.not"
        return
    rate = float(looked.fps) / looked.every
    beside = judged.PLAYER_WORK * players + judged.NOTE_WORK * notes
    assert rate * seconds * players + beside <= judged.MOST_WORK + players
    assert (notice is None) == (rate > 10.0)
    assert rate >= judged.LEAST_PER_S


def test_hours_of_many_players_are_not_looked_at(rates: list[tuple[Fraction, int]]) -> None:
    performance = Performance(piece(80_000, 9))
    problems, notice = all_problems(performance, performance.project.players)
    assert not rates
    assert notice is not None
    assert notice.id == "judged.not"
    assert notice.arguments == {"players": 9, "minutes": 667}
    assert problems.keys() == {player.id for player in performance.project.players}
