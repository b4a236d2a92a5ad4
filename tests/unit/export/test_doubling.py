"""Files of a musician with two instruments, read back."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.export.file_names import figure_stems
from app.export.report import Report, failures
from app.export.request import ExportRequest
from app.export.run import export
from app.formats.fbx.read import read_scene
from app.messages import text
from app.performance.ensemble import Performance, changes_of
from app.performance.span import whole_span
from app.project.edit import players as edit
from app.project.model import Project
from tests.support.doubled import flutist

FPS = Fraction(30)


def exported(project: Project, folder: Path, asked: int, formats: frozenset[str] = frozenset(("fbx", "glb"))) -> Report:
    performance = Performance(project)
    request = ExportRequest(
        performance=performance,
        players=(project.players[asked],),
        folder=folder,
        formats=formats,
        span=whole_span(performance.time_frame, FPS),
        bars=None,
        source="changes.mid",
        creator="Suisou test",
        stage=True,
    )
    return export(request, text)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Report]:
    folder = tmp_path_factory.mktemp("changes") / "out"
    return folder, exported(flutist(beside=False), folder, 1)


def test_two_instruments_of_one_kind_have_files_named_after_their_players() -> None:
    project = flutist(beside=False)
    flute, piccolo = project.players
    both = replace(project, players=(flute, msgspec.structs.replace(piccolo, instrument_id="flute")))
    assert [names["instrument"] for names in figure_stems(Performance(both)).values()] == [
        "Flute_flute",
        "Flute_flute_Piccolo",
    ]


def test_for_either_player_one_character_and_both_instruments_are_written(written: tuple[Path, Report]) -> None:
    folder, report = written
    assert {path.name for path in folder.iterdir() if path.is_file()} == {
        *(f"{stem}.{suffix}" for stem in ("Flute", "Flute_flute", "Flute_piccolo") for suffix in ("fbx", "glb")),
        *("changes_stage.fbx", "changes_stage.glb", "report.json"),
    }
    assert [figure.node for figure in report.stage.figures] == ["Flute", "Flute_flute", "Flute_piccolo"]
    assert len({(figure.place.x_m, figure.place.z_m) for figure in report.stage.figures}) == 1
    (player,) = report.players
    (double,) = player.doubles
    assert (player.name, player.instrument, player.notes) == ("Flute", "flute", 8)
    assert (double.name, double.instrument, double.notes) == ("Piccolo", "piccolo", 4)
    reported = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    assert reported["players"][0]["doubles"][0]["files"]["instrument_fbx"] == "Flute_piccolo.fbx"


def test_both_are_judged_with_that_character_and_keep_every_bound(written: tuple[Path, Report]) -> None:
    (player,) = written[1].players
    for one in (player, *player.doubles):
        assert one.measures is not None  # type: ignore[attr-defined]
        assert one.measures.sounding_frames > 40  # type: ignore[attr-defined]
        assert one.measures.breaths.shown == one.measures.breaths.planned > 0  # type: ignore[attr-defined]
        assert failures(one) == ()
    # There is one body, so measures of the body alone are equal for both instruments.
    (double,) = player.doubles
    assert double.measures.feet == player.measures.feet
    assert double.measures.acceleration == player.measures.acceleration


def test_what_is_not_played_lies_still_in_the_files(written: tuple[Path, Report]) -> None:
    folder, _ = written
    performance = Performance(flutist(beside=False))
    _, (there, back) = changes_of(performance, performance.project.players[:2])
    first_s = performance.time_frame.first_frame_s
    for stem, start_s, end_s in (
        ("Flute_flute", there.put_s, back.taken_s),
        ("Flute_piccolo", first_s, there.taken_s),
    ):
        scene = read_scene(folder / f"{stem}.fbx")
        times_s = first_s + np.arange(scene.clip.frames) / float(FPS)
        lies = (times_s >= start_s) & (times_s <= end_s)
        place_cm, turns = scene.clip.translations_cm[0], scene.clip.rotations_xyzw[:, 0]
        assert np.ptp(place_cm[lies], axis=0).max() < 1e-3
        assert np.ptp(np.abs(turns[lies]), axis=0).max() < 1e-5
        assert np.ptp(place_cm, axis=0).max() > 20.0


def test_an_instrument_that_is_not_there_is_left_out_and_the_musician_plays_on(tmp_path: Path) -> None:
    project = flutist(beside=False)
    project = edit.change(project, (project.players[1].id,), instrument_id="no_such_thing")
    report = exported(project, tmp_path / "out", 0, frozenset(("glb",)))
    assert [one.player for one in report.left_out] == ["Piccolo"]
    assert [player.name for player in report.players] == ["Flute"]
    assert report.players[0].doubles == ()
