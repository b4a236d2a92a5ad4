"""Files whose names are not UTF-8 are dropped, saved, exported and opened in the editor, and displayed readably."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import soundfile
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QComboBox,
    QDoubleSpinBox,
    QFileDialog,
    QLabel,
    QLineEdit,
    QPushButton,
    QSpinBox,
)
from pytestqt.qtbot import QtBot

from app.editor.settings import Settings
from app.errors import Message
from app.project.edit.piece import set_title
from app.project.names import file_stem
from app.project.recovery import Recoverable
from app.project.storage import load
from app.shell.app import Program
from app.shell.questions import DialogQuestions
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Answers, Start, trigger
from tests.support.odd_names import NAME, odd, on_bytes
from tests.support.windows import child
from tests.unit.cli.test_main import named_piece
from widgets.common.paths import PathEdit, ask_for_file, ask_for_folder, url_of
from widgets.dialogs.export_files import ExportDialog
from widgets.dialogs.playblast import PlayblastDialog
from widgets.dialogs.reimport_midi import ReimportDialog

pytestmark = on_bytes


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Folder with such a name that contains such a piece and a recording."""
    result = odd(tmp_path)
    result.mkdir()
    named_piece(odd(result, ".mid"), "trumpet")
    soundfile.write(str(tmp_path / "x.wav"), np.zeros((4410, 2), np.float32), 44_100)
    (tmp_path / "x.wav").rename(odd(result, ".wav"))
    return result


def drop(program: Program, path: Path) -> None:
    mime = QMimeData()
    mime.setUrls([url_of(path)])
    action, left, none = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    QApplication.sendEvent(program.window, QDragEnterEvent(QPoint(50, 50), action, mime, left, none))
    QApplication.sendEvent(program.window, QDropEvent(QPointF(50, 50), action, mime, left, none))


def test_a_piece_is_dropped_played_saved_and_opened_again(
    empty: Program, start: Start, folder: Path, answers: Answers
) -> None:
    drop(empty, odd(folder, ".mid"))
    session, files = empty.session, empty.editor.files
    assert session.project.source == str(odd(folder, ".mid"))
    assert empty.window.windowTitle().startswith(NAME)
    drop(empty, odd(folder, ".wav"))
    assert session.project.audio.path == str(odd(folder, ".wav"))
    answers.path = document = odd(folder, ".suisou")
    trigger(empty, "file.save")
    assert files.path == document
    assert load(document) == session.project
    assert f"{NAME}.suisou" in empty.window.windowTitle()
    empty.window._fill_recent()
    recent = [action.text() for action in empty.window.menus.menu("file/open_recent").actions()]
    assert f"{NAME}.suisou    {folder.parent}/{NAME}" in recent
    answers.path = odd(folder, ".mid")
    trigger(empty, "file.reimport_other")
    (dialog,) = empty.window.findChildren(ReimportDialog)
    assert NAME in dialog.windowTitle() + "".join(label.text() for label in dialog.findChildren(QLabel))
    dialog.reject()
    answers.path = odd(folder, ".2.mid")
    trigger(empty, "file.export_midi")
    assert odd(folder, ".2.mid").is_file()
    # Unsaved work of an editor that dies.
    session.attempt(Message("edit.set_tempo"), lambda project: set_title(project, "Another"))
    files.write_now()
    edited = session.project
    presence = files.autosave.presence if files.autosave is not None else None
    presence._stream.close()
    files.autosave = None
    again = start()
    page = again.window.start_page
    texts = [label.text() for label in page.findChildren(QLabel)]
    assert any(text.startswith(f"Unsaved changes found: {NAME}.suisou") for text in texts)
    rows = [button for button in page.findChildren(QPushButton, "recent_file") if f"{NAME}.suisou" in button.text()]
    assert rows[0].isEnabled()
    assert rows[0].toolTip() == f"{folder.parent}/{NAME}/{NAME}.suisou"
    offers: list[Recoverable] = []
    again.editor.files.found.connect(offers.append)
    QTest.mouseClick(rows[0], Qt.MouseButton.LeftButton)
    assert again.editor.files.path == document
    assert again.session.project == load(document)
    (offer,) = offers
    again.editor.files.recover(offer)
    assert again.session.project == edited


def test_players_are_exported(empty: Program, folder: Path, qtbot: QtBot) -> None:
    program = empty
    program.editor.files.open(odd(folder, ".mid"), ask=False)
    program.editor.settings.export_folder = str(odd(folder, ".out"))
    trigger(program, "export.files")
    (dialog,) = program.window.findChildren(ExportDialog)
    line, reported = dialog.findChild(QLineEdit, "export_folder"), dialog.findChild(QLabel, "export_outcome")
    assert reported is not None
    assert line.text().startswith("bytes:///")
    keys = child(dialog, QComboBox, "export_keys")
    keys.setCurrentIndex(keys.findData("reduced"))
    child(dialog, QComboBox, "export_range").setCurrentIndex(1)
    child(dialog, QSpinBox, "export_first_bar").setValue(1)
    child(dialog, QSpinBox, "export_last_bar").setValue(1)
    child(dialog, QDoubleSpinBox, "export_lead_in").setValue(1.0)
    dialog.start()
    qtbot.waitUntil(lambda: f"{NAME}/{NAME}.out" in reported.text())
    assert (odd(folder, ".out") / "report.json").is_file()
    dialog.close()
    assert program.editor.settings.export_folder == str(odd(folder, ".out"))
    trigger(program, "export.files")
    again = program.window.findChildren(ExportDialog)[-1]
    assert again.keys == "reduced", "as it was chosen"
    assert again.chosen_bars == ((1, 1), 1.0), "of this piece"
    again.close()
    program.editor.files.open(QUARTET, ask=False)
    trigger(program, "export.files")
    another = program.window.findChildren(ExportDialog)[-1]
    assert another.chosen_bars == (None, 0.0)
    another.close()


def test_a_path_that_is_typed(qt_app: QApplication, folder: Path) -> None:
    edit = PathEdit(odd(folder, ".mp4"))
    assert edit.path == odd(folder, ".mp4")
    assert edit.toolTip() == f"{folder.parent}/{NAME}/{NAME}.mp4"
    edit.setText(edit.text().replace(".mp4", ".2.mp4"))
    assert edit.path == odd(folder, ".2.mp4")
    edit.setText(f" {folder.parent} ")
    assert edit.path == folder.parent
    assert edit.toolTip() == ""
    for name in ("-x ", "a\nb", "\x1b[2J'\"", "bytes:"):
        edit.set_path(folder.parent / name)
        assert edit.path == folder.parent / name
    edit.set_path(None)
    assert edit.path is None


def test_dialogs_give_the_bytes_and_begin_where_qt_can_be(
    qt_app: QApplication, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The desktop's own dialogs support such names; Qt's does not list them."""
    begun: list[str] = []

    def chosen(parent: object, title: str, start: object, *more: object, **options: object) -> object:
        begun.append(start.toLocalFile())  # type: ignore[attr-defined]
        return url_of(odd(folder, ".suisou")), ""

    for name in ("getOpenFileUrl", "getSaveFileUrl"):
        monkeypatch.setattr(QFileDialog, name, chosen)
    monkeypatch.setattr(QFileDialog, "getExistingDirectoryUrl", lambda *given, **more: chosen(*given, **more)[0])
    assert DialogQuestions().open_file("Open", str(folder), "*") == odd(folder, ".suisou")
    assert DialogQuestions().save_file("Save", str(odd(folder, ".suisou")), "*", (".suisou",)) == odd(folder, ".suisou")
    assert ask_for_folder(None, "Folder", folder) == odd(folder, ".suisou")
    assert ask_for_file(None, "Open", None, "*") == odd(folder, ".suisou")
    assert begun == [str(folder.parent), f"{folder.parent}/{NAME}.suisou", str(folder.parent), str(Path.home())]


@pytest.mark.drawn
def test_names_that_no_file_can_have(start: Start, settings: Settings, answers: Answers, qtbot: QtBot) -> None:
    """Names that exceed the system's limit, from a settings file, a project and a field, are refused and named."""
    name = "長" * 2_000
    folder = Path("/tmp") / name
    settings.folder = settings.export_folder = str(folder)
    settings.add_recent(folder / f"{name}.mid")
    program = start()
    reported: list[Message] = []
    program.session.noticed.connect(lambda message, severity: reported.append(message))
    (row,) = program.window.start_page.findChildren(QPushButton, "recent_file")
    assert not row.isEnabled()
    program.window._fill_recent()
    program.editor.files.open(folder / f"{name}.mid")
    program.editor.files.open(QUARTET, ask=False)
    program.session.document.apply(
        Message("edit.set_tempo"), replace(program.session.project, source=str(folder / f"{name}.mid"))
    )
    answers.path = folder / f"{name}.suisou"
    for action_id in ("file.export_midi", "file.reimport"):
        trigger(program, action_id)
    assert [message.id for message in reported] == ["file.cannot_read", "file.cannot_write", "file.cannot_read"]
    assert all(name in str(message.arguments.get("file", "")) for message in reported)
    reported.clear()
    trigger(program, "export.files")
    (export,) = program.window.findChildren(ExportDialog)
    export.start()
    outcome = child(export, QLabel, "export_outcome")
    qtbot.waitUntil(lambda: name in outcome.text())
    export.close()
    trigger(program, "export.playblast")
    (film,) = program.window.findChildren(PlayblastDialog)
    film.close()


@pytest.mark.drawn
def test_a_name_is_proposed_that_a_file_can_have(empty: Program, answers: Answers) -> None:
    """Tested for pieces with any name."""
    proposals: list[str] = []

    def save_file(title: str, proposal: str, filters: str, suffixes: Sequence[str]) -> None:
        proposals.append(proposal)

    answers.save_file = save_file
    empty.editor.files.open(QUARTET, ask=False)
    empty.session.document.apply(Message("edit.set_tempo"), replace(empty.session.project, source=""))
    empty.session.attempt(Message("edit.set_tempo"), lambda project: set_title(project, "a/../\\:*" + "長" * 300))
    for action_id in ("file.save_as", "file.export_midi"):
        trigger(empty, action_id)
    trigger(empty, "export.playblast")
    (film,) = empty.window.findChildren(PlayblastDialog)
    proposals.append(str(child(film, PathEdit).path))
    film.close()
    assert len(proposals) == 3
    for proposal in proposals:
        assert Path(proposal).parent == Path(empty.editor.files.folder)
        assert Path(proposal).stem == file_stem(empty.session.project.score.title)
