"""Ignored problems stay with their player and the music, and are excluded from reports."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import msgspec
import pytest

from app.cli import main
from app.errors import Message
from app.performance.ensemble import Performance
from app.performance.span import whole_span
from app.plan.model import Problem
from app.project.edit.corrections import ignore, unignore
from app.project.edit.dancers import add_dancer, remove_dancers
from app.project.edit.notes import move
from app.project.edit.players import remove_players, rename
from app.project.ignored_problems import split_by_ignored
from app.project.model import Project
from app.project.reimport import reimport
from app.project.storage import save
from app.project.undoable_document import Document
from instrument_maps.load import bundled_maps
from tests.support.bodies import playing
from tests.support.live import performance_of

NOTES = [(480 * index, 480, 60 + index % 5) for index in range(8)]
MAPS = bundled_maps()


def _project() -> Project:
    """Clarinet whose third and sixth notes are far too high."""
    project = performance_of("clarinet_Bb", NOTES).project
    notes = project.score.parts[0].notes
    return move(project, {notes[2].id, notes[5].id}, 0, 48)


def _problems(project: Project) -> tuple[Problem, ...]:
    return Performance(project).problems(project.players[0].id)


def _counted(project: Project, problems: tuple[Problem, ...]) -> tuple[Problem, ...]:
    known = project.ignored_problems.get(project.players[0].id, ())
    return split_by_ignored(problems, known, project.score.tempo_map)[0]


def test_they_go_with_the_player_or_dancer_and_come_back_with_undo() -> None:
    project, dancer_id = add_dancer(_project(), "salsa", "Dana")
    player_id = project.players[0].id
    dance = Problem(Message("dance.state_not_held", {"number": 3}), None, 2.0, 2.5)
    project = ignore(ignore(project, player_id, _problems(project)), dancer_id, [dance])
    document = Document(project)
    document.apply(Message("edit.remove_players", {"of": "Trumpet 1"}), remove_players(project, {player_id}))
    assert document.project.ignored_problems.keys() == {dancer_id}
    document.apply(Message("edit.remove_dancers", {"count": 1}), remove_dancers(document.project, {dancer_id}))
    assert not document.project.ignored_problems
    document.undo()
    document.undo()
    assert document.project == project


def test_another_name_keeps_them() -> None:
    project = _project()
    player_id = project.players[0].id
    project = rename(ignore(project, player_id, _problems(project)), player_id, "Benny")
    assert _problems(project)
    assert not _counted(project, _problems(project))


@pytest.mark.parametrize("resolution", [1, 2])
def test_a_file_read_again_keeps_them_where_the_music_is(resolution: int) -> None:
    """Four bars are inserted at the beginning, with another resolution."""
    project = _project()
    player_id, before = project.players[0].id, project.score
    beat = before.ticks_per_quarter
    at_s = before.tempo_map.seconds(float(before.parts[0].notes[4].onset_tick))
    shaky = Problem(Message("contact.hand_off", {"side": "left", "gap_mm": 4}), None, at_s, at_s + 0.2)
    project = ignore(project, player_id, (*_problems(project), shaky))

    def later(score_tick: int) -> int:
        return resolution * (score_tick + 16 * beat)

    notes = tuple(
        msgspec.structs.replace(
            note, id=f"9:{index}", onset_tick=later(note.onset_tick), duration_tick=resolution * note.duration_tick
        )
        for index, note in enumerate(before.parts[0].notes)
    )
    clock = msgspec.structs.replace(before.tempo_map, ticks_per_quarter=resolution * beat)
    part = msgspec.structs.replace(before.parts[0], notes=notes)
    file = msgspec.structs.replace(before, ticks_per_quarter=clock.ticks_per_quarter, tempo_map=clock, parts=(part,))
    after = reimport(project, file, MAPS).project
    clock = after.score.tempo_map
    now_s = clock.seconds(float(later(before.parts[0].notes[4].onset_tick)))
    assert now_s > at_s + 1.0
    moved = msgspec.structs.replace(shaky, start_s=now_s)
    assert _problems(after)
    assert not _counted(after, (*_problems(after), moved))
    assert _counted(after, (shaky,)) == (shaky,)


def test_inspect_export_and_stream_count_them_and_list_them_on_request(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    project = _project()
    player = project.players[0]
    every = _problems(project)
    high = tuple(problem for problem in every if problem.message.id == "fingering.out_of_range")
    assert len(high) == 2
    file, out = str(tmp_path / "clarinet.suisou"), tmp_path / "out"
    last_s = str(whole_span(Performance(project).time_frame, Fraction(60)).end_s - 0.1)

    def listed(*options: str) -> tuple[list[tuple[bool, int]], str]:
        """For each report: are notes out of range listed, and the number of ignored problems; all printed text."""
        with playing():
            assert main(["inspect", file, "--json", "--no-contacts", *options]) == 0
            inspected = json.loads(capsys.readouterr().out)
            assert main(["inspect", file, "--no-contacts", *options]) == 0
            assert main(["export", file, "--to", str(out), "--format", "bvh", *options]) == 0
            assert main(["stream", file, "--from", last_s, *options]) == 0
        exported = json.loads((out / "report.json").read_bytes())
        reports = [
            ("outside this instrument's range" in " ".join(one["warnings"]), one["ignored_problems"])
            for one in (inspected, exported)
        ]
        printed = capsys.readouterr()
        return reports, printed.out + printed.err

    save(ignore(project, player.id, high), file)
    reports, printed = listed()
    assert reports == [(False, 2)] * 2
    assert printed.count("2 problems ignored (--ignored)") == 3
    assert "outside" not in printed
    reports, printed = listed("--ignored")
    assert reports == [(True, 0)] * 2
    assert "problems ignored" not in printed
    assert printed.count("outside this instrument's range") == 3
    assert unignore(ignore(project, player.id, high), player.id, high) == project
