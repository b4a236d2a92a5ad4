"""The evaluation dialog requests the chosen options, and the evaluation is made in the background."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QCheckBox, QComboBox, QLabel, QPushButton, QSpinBox
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.errors import AppError, Cancelled, Message
from app.evaluation.process import EvaluationFinished, made_by_process
from app.evaluation.request import EvaluationRequest
from app.messages import WORDINGS
from app.performance.ensemble import Performance
from app.project.model import Project
from app.shell.language import TEXTS
from tests.gui.conftest import quartet_project
from tests.support.windows import child
from tests.unit.evaluation.test_keyframes import export_bvh
from widgets.common.paths import PathEdit
from widgets.dialogs.evaluation.make import EvaluationDialog, Make


def dialog_of(session: Session, make: Make, folder: Path) -> EvaluationDialog:
    dialog = EvaluationDialog(session, make, folder, "Quartet")
    dialog.show()
    return dialog


def press(dialog: EvaluationDialog, name: str) -> None:
    QTest.mouseClick(dialog.findChild(QPushButton, name), Qt.MouseButton.LeftButton)


def choose(dialog: EvaluationDialog, name: str, data: str) -> None:
    box = child(dialog, QComboBox, name)
    box.setCurrentIndex(box.findData(data))


def said(dialog: EvaluationDialog) -> str:
    return child(dialog, QLabel, "evaluation_state").text()


def enabled(dialog: EvaluationDialog) -> bool:
    return child(dialog, QPushButton, "evaluation_start").isEnabled()


def test_what_is_chosen_is_asked_for(threaded: Session, qtbot: QtBot, tmp_path: Path) -> None:
    asked: list[EvaluationRequest] = []

    def make(
        project: Project, request: EvaluationRequest, report: Callable[[float, Message], None], stop: Callable[[], bool]
    ) -> EvaluationFinished:
        assert project is threaded.project
        asked.append(request)
        report(0.5, Message("evaluate.step_sound"))
        return EvaluationFinished(12, 3, (("Horn", Message("picture.loading")),), -3.25, 0.875)

    dialog = dialog_of(threaded, make, tmp_path / "made")
    film = child(dialog, PathEdit, "evaluation_film")
    place = child(dialog, QComboBox, "evaluation_place")
    view = child(dialog, QComboBox, "evaluation_view")
    assert not place.isEnabled()
    film.set_path(tmp_path / "film.mp4")
    place.setCurrentIndex(place.findData("follow"))
    view.setCurrentIndex(view.findData("hands"))
    press(dialog, "evaluation_start")
    qtbot.waitUntil(lambda: "evaluation.html" in said(dialog))
    (request,) = asked
    assert request.folder == str(tmp_path / "made")
    assert request.variants == ("film", "generated", "still", "shifted")
    assert (request.film, request.follow_film, request.film_offset_s) == (str(tmp_path / "film.mp4"), True, None)
    assert (request.view, request.player_ids) == ("hands", (threaded.project.bodies[0].id,))
    assert (request.title, request.bars, request.excerpts, request.size) == ("Quartet", None, 3, (640, 360))
    for part in ("-3.25 s", "88 %", "Horn", "made"):
        assert part in said(dialog)
    dialog.close()


def test_it_is_not_begun_without_two_variants_or_onto_another(threaded: Session, tmp_path: Path) -> None:
    (tmp_path / "key.json").write_text("{}")

    def make(*asked: object) -> EvaluationFinished:
        raise AssertionError("nothing is to be made")

    dialog = dialog_of(threaded, make, tmp_path / "made")
    assert enabled(dialog)
    for name in ("evaluation_still", "evaluation_shifted"):
        box = child(dialog, QCheckBox, name)
        box.setChecked(False)
    assert not enabled(dialog)
    assert "at least two" in said(dialog)
    box.setChecked(True)
    assert enabled(dialog)
    folder = child(dialog, PathEdit, "evaluation_folder")
    folder.set_path(tmp_path)
    assert not enabled(dialog)
    assert "choose another folder" in said(dialog)
    dialog.close()


def test_a_trouble_is_said_and_cancelling_ends_it(threaded: Session, qtbot: QtBot, tmp_path: Path) -> None:
    begun: list[bool] = []

    def make(
        project: Project, request: EvaluationRequest, report: Callable[[float, Message], None], stop: Callable[[], bool]
    ) -> EvaluationFinished:
        if not begun:
            begun.append(True)
            raise AppError("evaluate.silent_video", file="film.mp4")
        while not stop():
            report(0.25, Message("evaluate.step_pairs"))
        raise Cancelled("work.stopped")

    dialog = dialog_of(threaded, make, tmp_path / "made")
    press(dialog, "evaluation_start")
    qtbot.waitUntil(lambda: "film.mp4 has no sound" in said(dialog))
    assert "'At a given time'" in said(dialog)
    assert "--" not in said(dialog)
    press(dialog, "evaluation_start")
    qtbot.waitUntil(lambda: said(dialog) == "clips side by side")
    press(dialog, "evaluation_close")
    qtbot.waitUntil(lambda: enabled(dialog))
    dialog.close()


def test_bars_and_motion_from_elsewhere_are_asked_for(threaded: Session, tmp_path: Path) -> None:
    def make(*asked: object) -> EvaluationFinished:
        raise AssertionError("nothing is to be made")

    dialog = dialog_of(threaded, make, tmp_path / "made")
    keyframes = child(dialog, PathEdit, "evaluation_keyframes")
    keyframes.set_path(tmp_path)
    choose(dialog, "evaluation_keyframes_place", "hand")
    choose(dialog, "evaluation_range", "bars")
    spins = {name: dialog.findChild(QSpinBox, f"evaluation_{name}") for name in ("first_bar", "last_bar", "excerpts")}
    assert not spins["excerpts"].isEnabled()
    spins["first_bar"].setValue(5)
    spins["last_bar"].setValue(3)
    assert not enabled(dialog)
    spins["last_bar"].setValue(7)
    assert enabled(dialog)
    request = dialog.request()
    assert request.bars == (5, 7)
    assert (request.keyframes, request.keyframes_offset_s) == (str(tmp_path), 0.0)
    assert request.variants == ("generated", "still", "shifted", "keyframes")
    dialog.close()


def test_errors_name_controls_that_there_are() -> None:
    """In both languages and for the results too, errors mention existing controls and no command options."""
    labels = {place: {text[place] for text in TEXTS.values()} for place in (0, 1)}
    for id, wordings in WORDINGS.items():
        if not id.startswith(("evaluate.", "results.")) or not id.endswith("_here"):
            continue
        for place, quoted in ((0, r"'([^']+)'"), (1, r"「([^」]+)」")):
            named = re.findall(quoted, wordings[place])
            assert named or id == "evaluate.keyframes_lacking_here"
            assert set(named) <= labels[place], id
            assert "--" not in wordings[place]


@pytest.mark.drawn
@pytest.mark.skipif(not os.environ.get("DISPLAY"), reason="no display")
def test_another_process_makes_it_stops_and_refuses(tmp_path: Path) -> None:
    project = quartet_project()
    request = EvaluationRequest(
        str(tmp_path / "made"), "Quartet", variants=("generated", "keyframes"), excerpts=1, excerpt_s=1.0,
        view="front", player_ids=(project.bodies[0].id,), size=(64, 64), fps=(2, 1), presentation="pair",
        keyframes=str(tmp_path / "motion"),
    )  # fmt: skip
    (tmp_path / "motion").mkdir()
    export_bvh(Performance(project), project.bodies[0].name, tmp_path / "motion")
    shares: list[float] = []
    module = "app.cli.evaluation.worker"
    made = made_by_process(module, project, request, lambda share, said: shares.append(share), lambda: False)
    assert (made.clips, made.pairs, made.left_out) == (2, 1, ())
    assert shares == sorted(shares)
    names = sorted(path.name for path in (tmp_path / "made").iterdir())
    assert names == ["clips", "evaluation.html", "key.json", "measures.json"]
    with pytest.raises(AppError, match="there_already"):
        made_by_process(module, project, request, lambda share, said: None, lambda: False)
    with pytest.raises(Cancelled):
        made_by_process(
            module,
            project,
            EvaluationRequest(str(tmp_path / "other"), "Quartet", excerpts=3, size=(64, 64)),
            lambda share, said: shares.append(share + 1.0),
            lambda: shares[-1] > 1.2,
        )
    assert not (tmp_path / "other").exists()
