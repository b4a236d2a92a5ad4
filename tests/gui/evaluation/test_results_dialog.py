"""Window of an evaluation's results: files as input; texts, picture and tables as output."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QLabel, QListWidget, QPlainTextEdit, QPushButton, QTabWidget

from app.evaluation.key import write_key
from app.evaluation.measures import write_measures
from app.evaluation.viewer_files import gather
from tests.support.viewers import key_of, viewers, write_viewers
from tests.unit.evaluation.test_report import MEASURES
from widgets.dialogs.evaluation.results import EvaluationResultsDialog


def test_files_become_words_a_picture_and_tables(
    qt_app: object, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[Path] = []
    monkeypatch.setattr("widgets.dialogs.evaluation.results.show_folder", opened.append)
    answers = tmp_path / "answers"
    answers.mkdir()
    files = write_viewers(viewers(key_of(), 8), answers)
    dialog = EvaluationResultsDialog(gather, tmp_path)
    dialog.show()
    tabs, words = dialog.findChild(QTabWidget), dialog.findChild(QPlainTextEdit)
    state, listed = dialog.findChild(QLabel, "results_state"), dialog.findChild(QListWidget)
    save = dialog.findChild(QPushButton, "results_save")
    assert tabs is not None
    assert "Add the files" in words.toPlainText()
    dialog.add_files(files)
    assert "'Choose Key...'" in state.text()
    assert not save.isEnabled()
    write_key(key_of(), tmp_path / "key.json")
    write_measures(MEASURES, tmp_path / "measures.json")
    dialog.add_files(files[:1])
    assert (state.text(), listed.count(), tabs.count()) == ("", 8, 6)
    assert "results." not in words.toPlainText()
    assert "With 8 viewers only large differences show" in words.toPlainText()
    clipboard = QGuiApplication.clipboard()
    dialog.copy()
    assert clipboard.text() == words.toPlainText()
    tabs.setCurrentIndex(1)
    dialog.copy()
    picture = clipboard.image()
    assert picture.width() > 600
    assert len({picture.pixel(x, y) for x in range(0, picture.width(), 9) for y in range(0, picture.height(), 9)}) > 3
    tabs.setCurrentIndex(2)
    dialog.copy()
    assert len(clipboard.text().splitlines()[0].split("\t")) > 8
    dialog.save(tmp_path / "results")
    assert {path.suffix for path in (tmp_path / "results").iterdir()} == {".md", ".svg", ".csv", ".json"}
    assert opened == [tmp_path / "results"]
    listed.item(0).setSelected(True)
    dialog.findChild(QPushButton, "results_remove").click()
    assert (listed.count(), tabs.currentIndex()) == (7, 2)
    dialog.close()
