"""How many frames a report makes: all in usual pieces, few in hours with little in them, and what it says of that."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import msgspec
import pytest

from app.performance import judged
from app.performance.ensemble import Performance
from app.performance.judged import all_problems
from app.project.model import Project
from app.score.model import Note
from tests.fuzz.harness.costly_projects import base


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

        def motion(self, fps: Fraction, first: int, frames: int) -> object:
            found.append((fps, frames))
            return self._made.motion(fps, first, frames)

    monkeypatch.setattr(judged, "playing_of", Counted)
    return found


def test_a_usual_piece_is_made_whole(rates: list[tuple[Fraction, int]]) -> None:
    performance = Performance(piece(40))
    assert all_problems(performance, performance.project.players).notice is None
    assert {fps for fps, _ in rates} == {60}


def test_hours_with_few_notes_are_looked_at_sparsely(
    rates: list[tuple[Fraction, int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(judged, "FREE_FRAMES", 2000)
    monkeypatch.setattr(judged, "FRAMES_PER_NOTE", 0)
    performance = Performance(piece(400))
    notice = all_problems(performance, performance.project.players).notice
    assert notice is not None
    assert notice.id == "judged.sparsely"
    assert sum(frames for _, frames in rates) <= 2000
    assert {fps for fps, _ in rates} == {Fraction(60, 8)}
    assert notice.arguments["rate"] == 7.5


def test_hours_of_many_players_are_not_looked_at(rates: list[tuple[Fraction, int]]) -> None:
    performance = Performance(piece(80_000, 9))
    problems, notice = all_problems(performance, performance.project.players)
    assert not rates
    assert notice is not None
    assert notice.id == "judged.not"
    assert notice.arguments == {"players": 9, "hours": 11.1}
    assert problems.keys() == {player.id for player in performance.project.players}
