"""Choice of the file to write: nothing is replaced without a question."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeVar

import pytest
from PySide6.QtCore import Qt, QTimer, QUrl
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog, QFileDialog, QMessageBox, QPushButton, QTreeView

from app.errors import Message
from app.shell.language import Language
from app.shell.questions import DialogQuestions
from tests.gui.japanese import texts_of
from tests.support.windows import child, wait_until
from widgets.common.paths import ask_for_file, ask_for_files, ask_for_folder, ask_where_to_save

SUFFIXES = (".mid", ".midi")
D = TypeVar("D", bound=QDialog)


def when_shown(kind: type[D], act: Callable[[D], None]) -> None:
    """Call a function with the next dialog of a kind when it is shown; close the dialog if that fails."""

    def look() -> None:
        dialog = QApplication.activeModalWidget()
        if not isinstance(dialog, kind) or not dialog.isVisible():
            QTimer.singleShot(20, look)
            return
        try:
            act(dialog)
        finally:
            # Otherwise the test would wait for the dialog forever.
            dialog.close()

    QTimer.singleShot(20, look)


class Typed:
    """Names typed one after another, and answers to questions about a file."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, folder: Path, *names: str) -> None:
        self.left = [str(folder / name) if name else "" for name in names]
        self.proposals: list[str] = []
        self.asked: list[str] = []
        monkeypatch.setattr(QFileDialog, "getSaveFileUrl", self._type)

    def _type(self, parent: object, title: str, proposal: QUrl, filters: str, **more: object) -> tuple[QUrl, str]:
        self.proposals.append(proposal.toLocalFile())
        typed = self.left.pop(0)
        return QUrl.fromLocalFile(typed) if typed else QUrl(), filters

    def answer(self, button: str) -> None:
        def click(box: QMessageBox) -> None:
            self.asked.append(box.text())
            requested = next(one for one in box.buttons() if one.text() == button)
            QTest.mouseClick(requested, Qt.MouseButton.LeftButton)

        when_shown(QMessageBox, click)


def save(folder: Path) -> Path | None:
    return DialogQuestions().save_file("Export MIDI", str(folder / "x.mid"), "MIDI (*.mid)", SUFFIXES)


@pytest.mark.parametrize("typed", ["piece", "piece.v2", "piece.MID", "piece.midi"])
def test_a_name_gets_its_suffix(
    qt_app: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, typed: str
) -> None:
    Typed(monkeypatch, tmp_path, typed)
    kept = typed.lower().endswith(SUFFIXES)
    assert save(tmp_path) == tmp_path / (typed if kept else f"{typed}.mid")


def test_a_file_of_the_completed_name_is_asked_about(
    qt_app: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "piece.mid").write_bytes(b"mine")
    typed = Typed(monkeypatch, tmp_path, "piece")
    typed.answer("Replace")
    assert save(tmp_path) == tmp_path / "piece.mid"
    assert typed.asked == ["Replace piece.mid?"]


def test_who_does_not_replace_it_types_another_name(
    qt_app: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "piece.mid").write_bytes(b"mine")
    typed = Typed(monkeypatch, tmp_path, "piece", "other")
    typed.answer("Cancel")
    assert save(tmp_path) == tmp_path / "other.mid"
    assert typed.proposals == [str(tmp_path / "x.mid"), str(tmp_path / "piece.mid")]
    typed = Typed(monkeypatch, tmp_path, "piece", "")
    typed.answer("Cancel")
    assert save(tmp_path) is None


def test_what_the_systems_dialog_asked_about_is_not_asked_again(
    qt_app: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "piece.mid").write_bytes(b"mine")
    Typed(monkeypatch, tmp_path, "piece.mid")
    assert save(tmp_path) == tmp_path / "piece.mid"


JAPANESE = re.compile("[\u3040-\u30ff\u4e00-\u9fff]")
ASKED: Mapping[str, Callable[[Path], object]] = {
    "open": lambda folder: ask_for_file(None, "title", folder, "MIDI (*.mid)"),
    "open_many": lambda folder: ask_for_files(None, "title", folder, "MIDI (*.mid)"),
    "save": lambda folder: ask_where_to_save(None, "title", folder / "x.mid", "MIDI (*.mid)"),
    "folder": lambda folder: ask_for_folder(None, "title", folder),
}


def rows_of(dialog: QFileDialog) -> list[list[str]]:
    """Rows of the list of files once it is read: name, size, type and date."""
    view = child(dialog, QTreeView, "treeView")

    def rows() -> list[list[str]]:
        model, at = view.model(), view.rootIndex()
        return [[str(model.index(row, n, at).data() or "") for n in range(4)] for row in range(model.rowCount(at))]

    assert wait_until(lambda: "a folder" in [name for name, *_ in rows()])
    return rows()


@pytest.mark.parametrize("name", ASKED)
def test_file_dialogs_speak_the_language_of_the_editor(
    qt_app: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    """Qt's own dialog is used if the system has another language, and all of its texts are translated."""
    monkeypatch.setattr("app.editor.translated.system_language", lambda: "en")
    seen: list[set[str]] = []
    (tmp_path / "a folder").mkdir()
    (tmp_path / "a piece.mid").write_bytes(b"MThd")

    def look(dialog: QFileDialog) -> None:
        found = texts_of(dialog) | {row[2] for row in rows_of(dialog)}
        seen.append({text for text in found if re.search("[A-Za-z]{3}", text)} - {str(tmp_path)})
        cancel = next(one for one in dialog.findChildren(QPushButton) if one.text() in ("キャンセル", "Cancel"))
        seen.append({cancel.text()})
        QTest.mouseClick(cancel, Qt.MouseButton.LeftButton)

    language = Language()
    try:
        language.set("ja")
        when_shown(QFileDialog, look)
        assert not ASKED[name](tmp_path)
        left, cancelled = seen
        assert {text for text in left if not JAPANESE.search(text)} - {"title", "MIDI (*.mid)", "x.mid"} == set()
        assert cancelled == {"キャンセル"}
    finally:
        language.set("en")


@pytest.mark.parametrize(("system", "editor", "native"), [("ja", "ja", True), ("en", "ja", False), ("ja", "en", False)])
def test_the_systems_dialog_is_used_where_it_speaks_the_same(
    qt_app: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, system: str, editor: str, native: bool
) -> None:
    monkeypatch.setattr("app.editor.translated.system_language", lambda: system)
    chosen: list[QFileDialog.Option] = []

    def note(*given: object, options: QFileDialog.Option, **more: object) -> tuple[QUrl, str]:
        chosen.append(options)
        return QUrl(), ""

    monkeypatch.setattr(QFileDialog, "getOpenFileUrl", note)
    language = Language()
    try:
        language.set(editor)
        ask_for_file(None, "title", tmp_path, "*")
        assert bool(chosen[0] & QFileDialog.Option.DontUseNativeDialog) is not native
    finally:
        language.set("en")


@pytest.mark.parametrize(
    ("language", "button", "stops", "question"),
    [
        ("en", "Stop and Close", True, "Files are still being written. Stop and close?"),
        ("en", "Keep Window Open", False, "Creating video…"),
        ("ja", "ウインドウを閉じない", False, "まだファイルを書き込んでいます。中止して閉じますか？"),
    ],
)
def test_whether_running_work_is_stopped(
    language: str, button: str, stops: bool, question: str, qt_app: QApplication
) -> None:
    seen: list[str] = []

    def click(box: QMessageBox) -> None:
        seen.append(f"{box.text()}\n{box.informativeText()}")
        requested = next(one for one in box.buttons() if one.text() == button)
        QTest.mouseClick(requested, Qt.MouseButton.LeftButton)

    spoken = Language()
    try:
        spoken.set(language)
        when_shown(QMessageBox, click)
        assert DialogQuestions().stop_writing((Message("work.playblast"),)) is stops
        assert question in seen[0]
    finally:
        spoken.set("en")
