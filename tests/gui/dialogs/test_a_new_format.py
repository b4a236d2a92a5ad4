"""An export format added by one row and one function works in dialog, command line and export."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable
from pathlib import Path
from typing import cast

import pytest
from PySide6.QtWidgets import QCheckBox, QComboBox
from pytestqt.qtbot import QtBot

from app.cli import main, parser
from app.cli.export import file_formats
from app.editor.session import Session
from app.export.formats import FILE_FORMATS, FileFormat, WriteOptions
from app.formats.scene import Scene
from app.project.storage import save
from tests.support.doubled import flutist
from widgets.dialogs.export_files import ExportDialog


def write_names(path: Path, scenes: Iterable[Scene], beside: WriteOptions) -> None:
    """Write the names of all scenes, and of the renamed bones."""
    path.write_text(json.dumps([[scene.name for scene in scenes], len(beside.bone_names)]))


ROW = FileFormat("nam", "Names", ".nam", ("character", "instrument"), 1.0, write_names, bones_by_name=True)


@pytest.fixture(autouse=True)
def added(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(cast(dict[str, FileFormat], FILE_FORMATS), ROW.id, ROW)


def test_the_dialog_offers_it_with_its_options(session: Session, qtbot: QtBot, tmp_path: Path) -> None:
    dialog = ExportDialog(session, tmp_path / "out", "quartet.mid", "Suisou test")
    dialog.show()
    for name in ("fbx", "bvh"):
        dialog.findChild(QCheckBox, f"export_{name}").setChecked(False)
    box, bone_names = dialog.findChild(QCheckBox, "export_nam"), dialog.findChild(QComboBox, "export_bvh_names")
    assert box.text() == "Names (characters and instruments)"
    assert not bone_names.isVisible()
    box.setChecked(True)
    assert bone_names.isVisible()
    assert dialog._request().formats == {"nam"}


def test_the_command_line_takes_and_names_it() -> None:
    assert file_formats("NAM,fbx") == ["fbx", "nam"]
    with pytest.raises(argparse.ArgumentTypeError, match="vrma, nam"):
        file_formats("x")
    typed = parser().parse_args(["export", "x", "--to", "y", "--format", "nam"]).formats
    assert typed == ["nam"]


def test_an_export_writes_it(tmp_path: Path) -> None:
    save(flutist(), tmp_path / "piece.suisou")
    out = tmp_path / "out"
    given = ["--format", "nam", "--stage", "--bvh-names", "mixamo", "--fps", "24", "--to-bar", "1"]
    assert main(["export", str(tmp_path / "piece.suisou"), "--to", str(out), *given]) == 0
    report = json.loads((out / "report.json").read_bytes())
    flute, oboe = report["players"]
    assert flute["files"] == {"character_nam": "Flute.nam", "instrument_nam": "Flute_flute.nam"}
    assert flute["doubles"][0]["files"] == {"instrument_nam": "Flute_piccolo.nam"}
    assert report["stage"]["files"] == {"nam": "piece_stage.nam"}
    for one in (flute, *flute["doubles"], oboe):
        for name in one["files"].values():
            names, renamed = json.loads((out / name).read_text())
            assert names == [Path(name).stem]
            assert renamed > 0
    figures = [["Flute", "Flute_flute", "Flute_piccolo", "Oboe", "Oboe_oboe"], 0]
    assert json.loads((out / "piece_stage.nam").read_text()) == figures
