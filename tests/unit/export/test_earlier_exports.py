"""Files of earlier exports that stay in a folder are named, and keep their own bars in the report."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from app.export.earlier_exports import MOST_NAMED, files_that_stay, remark_on_files_that_stay
from app.export.report import (
    DoubleReport,
    EarlierFiles,
    PlaceReport,
    PlayerReport,
    Report,
    StageReport,
    encode_report,
)
from app.messages import text


def _report(bars: tuple[int, int] | None, first_frame_s: float, *names: str, **more: object) -> Report:
    place = PlaceReport(0.0, 0.0, 0.0)
    files = {f"character_{Path(name).suffix[1:]}": name for name in names}
    players = (PlayerReport("Solo", "p", "i", "c", "standing", files, place, 1, None, None, None),)
    made = Report("v", "s.mid", first_frame_s, 30.0, "30", 10, 1.0, bars, 0, players, (), ())
    return msgspec.structs.replace(made, **more)


def _put(folder: Path, report: Report) -> None:
    for name in report.names:
        (folder / name).write_bytes(b"")
    (folder / "report.json").write_bytes(encode_report(report))


def test_what_another_export_leaves_keeps_its_bars(tmp_path: Path) -> None:
    _put(tmp_path, _report((9, 11), 9.2, "Solo.fbx", "Solo.bvh", "Solo.glb", sound="s.wav"))
    stays = files_that_stay(tmp_path, ["solo.FBX"])
    assert stays == (EarlierFiles((9, 11), 9.2, ("Solo.bvh", "Solo.glb", "s.wav")),)
    assert files_that_stay(tmp_path, ["Solo.fbx", "Solo.bvh", "Solo.glb", "s.wav"]) == ()


def test_bars_survive_several_exports_and_deleted_files_are_forgotten(tmp_path: Path) -> None:
    _put(tmp_path, _report((9, 11), 9.2, "Solo.fbx", "Solo.bvh", "Solo.glb"))
    _put(tmp_path, _report((5, 6), 4.6, "Solo.fbx", earlier=files_that_stay(tmp_path, ["Solo.fbx"])))
    (tmp_path / "Solo.glb").unlink()
    found = files_that_stay(tmp_path, ["Solo.usdc"])
    assert found == (EarlierFiles((5, 6), 4.6, ("Solo.fbx",)), EarlierFiles((9, 11), 9.2, ("Solo.bvh",)))


def test_files_of_doubles_and_of_the_stage_stay_too(tmp_path: Path) -> None:
    double = DoubleReport("Solo 2", "p", "i", 1.0, {}, {"instrument_glb": "Flute.glb"}, 1, None)
    made = _report(None, 0.0, "Solo.glb", stage=StageReport({"glb": "stage.glb"}, ()))
    players = tuple(msgspec.structs.replace(player, doubles=(double,)) for player in made.players)
    _put(tmp_path, msgspec.structs.replace(made, players=players))
    assert files_that_stay(tmp_path, []) == (EarlierFiles(None, 0.0, ("Solo.glb", "Flute.glb", "stage.glb")),)


def test_the_remark_names_some_of_the_files(tmp_path: Path) -> None:
    assert remark_on_files_that_stay(tmp_path, []) is None
    _put(tmp_path, _report((1, 2), 0.0, *(f"Solo.f{number}" for number in range(MOST_NAMED + 1))))
    remark = remark_on_files_that_stay(tmp_path, [])
    assert remark is not None
    assert "6 (Solo.f0, Solo.f1, Solo.f2, Solo.f3, Solo.f4, …)" in text(remark)


@pytest.mark.parametrize("content", ["", "[]", '{"bars": null, "players": [{"files": {"a": "../b.glb"}}]}'])
def test_a_report_of_another_program_or_beyond_the_folder_names_nothing(tmp_path: Path, content: str) -> None:
    folder = tmp_path / "inside"
    folder.mkdir()
    (tmp_path / "b.glb").write_bytes(b"")
    (folder / "report.json").write_text(content)
    assert files_that_stay(folder, []) == ()
