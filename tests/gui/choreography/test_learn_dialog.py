"""The dialog Learn Choreography by mouse and keys, compared with the resulting file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import mido
import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QCheckBox, QDoubleSpinBox, QLabel, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from app.choreography.learn import learn
from app.choreography.model_file import encode_model, read_model
from app.choreography.read_pair import read_pair
from app.editor.session import Session
from tests.gui.japanese import speaking
from tests.support.dances import stepping
from tests.support.windows import child, show_in_front
from tests.unit.choreography.test_command import write_clip, write_drums, write_silence
from tests.unit.choreography.test_cuts import arm_swings
from widgets.common.paths import PathEdit, url_of
from widgets.dialogs.choreography import learn as learn_dialog
from widgets.dialogs.choreography import learn_pair, learn_work
from widgets.dialogs.choreography.learn import LearnDialog
from widgets.dialogs.choreography.learn_draft import PairDraft, with_files


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_clip(tmp_path / "swings.bvh", arm_swings(60))
    write_clip(tmp_path / "steps.bvh", stepping(12))
    write_drums(tmp_path / "drums.mid")
    write_drums(tmp_path / "steps.mid")
    write_silence(tmp_path / "silent.mid")
    (tmp_path / "steps.txt").write_text("Danced for this test", encoding="utf-8")
    return tmp_path


@pytest.fixture
def dialog(session: Session, qtbot: QtBot, folder: Path) -> LearnDialog:
    return shown(session, qtbot, folder)


def shown(session: Session, qtbot: QtBot, folder: Path) -> LearnDialog:
    made = LearnDialog(session, folder)
    made.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, on=False)
    qtbot.addWidget(made)
    show_in_front(made)
    return made


def press(dialog: LearnDialog, name: str) -> None:
    button = child(dialog, QPushButton, name)
    assert button.isEnabled()
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def drop(dialog: LearnDialog, *paths: Path, on: QWidget | None = None) -> None:
    """Drag files over the dialog, or over one of its widgets, and drop them."""
    mime = QMimeData()
    mime.setUrls([url_of(path) for path in paths])
    # File managers say it as text too, which fields take.
    mime.setText("\n".join(map(str, paths)))
    over = dialog.list.viewport() if on is None else on
    how = Qt.DropAction.CopyAction, mime, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    QApplication.sendEvent(over, QDragEnterEvent(QPoint(5, 5), *how))
    QApplication.sendEvent(over, QDropEvent(QPointF(5.0, 5.0), *how))


def type_number(dialog: LearnDialog, name: str, text: str) -> None:
    check = child(dialog, QCheckBox, f"{name}_automatic")
    if check.isChecked():
        QTest.mouseClick(check, Qt.MouseButton.LeftButton, pos=check.rect().center() * 0.2)
    number = child(dialog, QDoubleSpinBox, name)
    number.setFocus()
    number.selectAll()
    QTest.keyClicks(number, text)
    QTest.keyClick(number, Qt.Key.Key_Return)


def type_path(dialog: LearnDialog, name: str, path: Path) -> None:
    edit = child(dialog, PathEdit, name)
    edit.setFocus()
    edit.selectAll()
    QTest.keyClicks(edit, str(path))
    QTest.keyClick(edit, Qt.Key.Key_Return)


def select(dialog: LearnDialog, row: int) -> None:
    item = dialog.list.topLevelItem(row)
    assert item is not None
    QTest.mouseClick(dialog.list.viewport(), Qt.MouseButton.LeftButton, pos=dialog.list.visualItemRect(item).center())


def row_texts(dialog: LearnDialog, row: int) -> list[str]:
    item = dialog.list.topLevelItem(row)
    return [item.text(column) for column in range(dialog.list.columnCount())]


def state(dialog: LearnDialog) -> str:
    label = child(dialog, QLabel, "learn_state")
    assert isinstance(label, QLabel)
    return label.text()


def test_files_find_their_pair() -> None:
    a, b, drums, notes = (Path(name) for name in ("a.bvh", "b.FBX", "b.mid", "b.txt"))
    drafts, unknown = with_files((), (Path("other.mid"), notes, drums, Path("x.doc"), b, a))
    assert drafts == (PairDraft(b, drums, notes), PairDraft(a, Path("other.mid")))
    assert unknown == (Path("x.doc"),)
    more, _ = with_files(drafts, (Path("c.mid"),))
    assert more == (*drafts, PairDraft(music=Path("c.mid")))
    assert with_files(more, (Path("d.glb"),))[0] == (*drafts, PairDraft(Path("d.glb"), Path("c.mid")))
    assert with_files((), (notes,)) == ((), (notes,))


def test_pairs_that_are_added_typed_and_dropped_are_learned(
    dialog: LearnDialog, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert not child(dialog, QPushButton, "learn_start").isEnabled()
    monkeypatch.setattr(learn_dialog, "ask_for_files", lambda *_: [folder / "swings.bvh", folder / "drums.mid"])
    press(dialog, "learn_add")
    drop(dialog, folder / "steps.mid", folder / "steps.bvh")
    assert [(draft.motion, draft.music) for draft in dialog.drafts] == [
        (folder / "swings.bvh", folder / "drums.mid"),
        (folder / "steps.bvh", folder / "steps.mid"),
    ]
    select(dialog, 0)
    type_number(dialog, "learn_offset", "1")
    assert row_texts(dialog, 0) == ["swings.bvh", "drums.mid", "8.5", "10", "–", "1.00", "–"]
    type_number(dialog, "learn_states", "5")
    type_path(dialog, "learn_file", folder / "ours")
    press(dialog, "learn_start")
    model = read_model(folder / "ours.choreography")
    pairs = [
        read_pair(folder / "swings.bvh", folder / "drums.mid", offset_s=1.0).pair,
        read_pair(folder / "steps.bvh", folder / "steps.mid").pair,
    ]
    assert encode_model(model) == encode_model(learn(pairs, states=5, seed=0, name="ours"))
    assert model.sources[0].offset_confidence is None
    assert model.sources[1].credits == "Danced for this test"
    assert "5 basic motions" in state(dialog)
    used = [len({one.state for one in model.segments if one.clip == clip}) for clip in (0, 1)]
    assert [row_texts(dialog, row)[4] for row in (0, 1)] == [str(count) for count in used]
    assert row_texts(dialog, 1)[5:] == [
        f"{model.sources[1].offset_s:.2f}",
        f"{model.sources[1].offset_confidence:.2f} (unsure)",
    ]
    # The pair of which the user typed the offset is not named.
    assert state(dialog).splitlines()[1].startswith("Unsure offsets: pairs 2.")
    select(dialog, 1)
    notes = child(dialog, QLabel, "learn_pair_notes")
    assert isinstance(notes, QLabel)
    assert "unsure where the music begins" in notes.text().lower()


def test_files_are_dropped_anywhere(dialog: LearnDialog, folder: Path) -> None:
    drop(dialog, folder / "swings.bvh", on=child(dialog, PathEdit, "learn_file"))
    drop(dialog, folder / "drums.mid", on=dialog.cuts.plot.plot.viewport())
    drop(dialog, folder / "steps.txt", on=child(dialog, PathEdit, "learn_credits"))
    assert dialog.drafts == (PairDraft(folder / "swings.bvh", folder / "drums.mid", folder / "steps.txt"),)


def line_px(label: QLabel) -> int:
    """Height in pixels of a line in a label with two lines, in the fonts required by its text."""
    return (label.heightForWidth(10**6) - 2 * label.margin()) // (label.text().count("\n") + 1)


def test_notes_are_not_cut_in_japanese(dialog: LearnDialog, folder: Path) -> None:
    drop(dialog, folder / "swings.bvh", folder / "drums.mid")
    with speaking():
        QApplication.processEvents()
        notes = child(dialog, QLabel, "learn_pair_notes")
        assert isinstance(notes, QLabel)
        assert "オフセット" in notes.text()
        lines, cut_px = divmod(notes.parentWidget().height(), line_px(notes))
        assert (cut_px, lines >= 3) == (0, True)


def test_a_frame_rate_is_corrected_and_shown(dialog: LearnDialog, folder: Path) -> None:
    drop(dialog, folder / "swings.bvh", folder / "drums.mid")
    type_number(dialog, "learn_fps", "29.97")
    assert str(dialog.drafts[0].fps) == "30000/1001"
    assert row_texts(dialog, 0)[2] == "17.0"
    notes = child(dialog, QLabel, "learn_pair_notes")
    assert isinstance(notes, QLabel)
    assert "30000/1001 frames/s (the file states 60)" in notes.text()
    # No line of them is cut, whatever room there is.
    room = notes.parentWidget()
    for height_px in range(dialog.height(), dialog.height() + 40, 7):
        dialog.resize(dialog.width(), height_px)
        QApplication.processEvents()
        lines, cut_px = divmod(room.height(), line_px(notes))
        assert (cut_px, lines >= 3) == (0, True), height_px


def test_a_bad_pair_is_named_and_the_others_stay(
    dialog: LearnDialog, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drop(dialog, folder / "swings.bvh", folder / "drums.mid")
    type_number(dialog, "learn_offset", "1")
    drop(dialog, folder / "steps.bvh", folder / "silent.mid")
    assert "Pair 2 is left out: " in state(dialog)
    assert "silent.mid has no notes" in state(dialog)
    # The other one is learned without it.
    assert child(dialog, QPushButton, "learn_start").isEnabled()
    press(dialog, "learn_start")
    assert [one.motion_name for one in read_model(folder / "choreography.choreography").sources] == ["swings.bvh"]
    assert "Pair 2 is left out: " in state(dialog)
    assert [row_texts(dialog, row)[4] for row in (0, 1)] == ["2", "–"]
    (folder / "choreography.choreography").unlink()
    select(dialog, 1)
    assert dialog.drafts[0].offset_s == 1.0
    # The remedy: its music.
    monkeypatch.setattr(learn_pair, "ask_for_file", lambda *_: folder / "steps.mid")
    press(dialog, "learn_music_choose")
    assert child(dialog, QPushButton, "learn_start").isEnabled()
    assert dialog.drafts[0].offset_s == 1.0
    # Problems found only while learning are reported too, and nothing is lost.
    select(dialog, 0)
    type_number(dialog, "learn_states", "900")
    press(dialog, "learn_start")
    assert "900" in state(dialog)
    assert not (folder / "choreography.choreography").exists()
    assert len(dialog.drafts) == 2
    select(dialog, 1)
    press(dialog, "learn_remove")
    assert [draft.motion for draft in dialog.drafts] == [folder / "swings.bvh"]


def test_learning_waits_for_a_pair_that_fits(dialog: LearnDialog, folder: Path) -> None:
    """The reason is displayed before anything is pressed: a body without motion, and music that ends before the motion
    begins.
    """
    still = arm_swings(60)
    write_clip(folder / "still.bvh", replace(still, rotations=np.repeat(still.rotations[:1], len(still), axis=0)))
    learn_button = child(dialog, QPushButton, "learn_start")
    drop(dialog, folder / "still.bvh", folder / "drums.mid")
    assert "Pair 1: no motion to learn from was found in still.bvh" in state(dialog)
    assert not learn_button.isEnabled()
    QTest.mouseClick(learn_button, Qt.MouseButton.LeftButton)
    assert not (folder / "choreography.choreography").exists()
    drop(dialog, folder / "swings.bvh", folder / "steps.mid")
    assert "Pair 1 is left out: no motion" in state(dialog)
    press(dialog, "learn_start")
    assert [one.motion_name for one in read_model(folder / "choreography.choreography").sources] == ["swings.bvh"]
    select(dialog, 0)
    press(dialog, "learn_remove")
    least_s = float(-mido.MidiFile(folder / "steps.mid").length)
    type_number(dialog, "learn_offset", f"{least_s + 0.2:.3f}")
    assert not learn_button.isEnabled()
    assert "nothing of steps.mid sounds during swings.bvh" in state(dialog)


def test_a_file_that_cannot_be_written_is_named(dialog: LearnDialog, folder: Path) -> None:
    drop(dialog, folder / "swings.bvh", folder / "drums.mid")
    type_path(dialog, "learn_file", folder / "missing" / "ours.choreography")
    press(dialog, "learn_start")
    assert "ours.choreography" in state(dialog)
    assert not child(dialog, QPushButton, "learn_use").isVisible()


def test_cancelled_it_leaves_the_file_as_it_was(
    threaded: Session, qtbot: QtBot, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    dialog = shown(threaded, qtbot, folder)
    drop(dialog, folder / "swings.bvh", folder / "drums.mid")
    start = child(dialog, QPushButton, "learn_start")
    qtbot.waitUntil(start.isEnabled)
    (folder / "choreography.choreography").write_text("before", encoding="utf-8")
    before = sorted(folder.iterdir())

    def slow(*args: object, **options: object) -> object:
        """Wait for the cancellation, then learn."""
        dialog._stop.wait(60.0)
        return learn(*args, **options)

    monkeypatch.setattr(learn_work, "learn", slow)
    press(dialog, "learn_start")
    assert not start.isEnabled()
    assert not dialog.form.isEnabled()
    # Closing the window asks before it loses what is being learned.
    assert [work.id for work in threaded.tasks.writing] == ["work.learn"]
    press(dialog, "learn_close")
    qtbot.waitUntil(start.isEnabled)
    assert (folder / "choreography.choreography").read_text(encoding="utf-8") == "before"
    assert sorted(folder.iterdir()) == before
    assert "Cancelled" in state(dialog)
    assert dialog.isVisible()
    assert len(dialog.drafts) == 1


def test_a_finished_choreography_can_be_used(session: Session, dialog: LearnDialog, folder: Path, qtbot: QtBot) -> None:
    drop(dialog, folder / "swings.bvh", folder / "drums.mid")
    with qtbot.waitSignal(session.choreographies_changed):
        press(dialog, "learn_start")
    with qtbot.waitSignal(dialog.used) as signal:
        press(dialog, "learn_use")
    assert signal.args == [folder / "choreography.choreography"]
    # A different seed gives a different choreography.
    type_number(dialog, "learn_states", "3")
    assert not child(dialog, QPushButton, "learn_use").isVisible()
