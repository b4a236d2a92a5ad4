"""List of changes before a re-import: the user's changes that are kept, and those that the file replaces."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import mido
import msgspec
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialogButtonBox, QLabel, QListWidget, QTreeWidget
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.project.model import Project
from app.project.part_changes import changes_by_part
from app.project.reimport import Reimport, reimport, reimported
from app.score.model import Note, Score
from app.shell.language import Language
from instrument_maps.load import bundled_maps
from tests.gui.conftest import quartet_project
from tests.support.windows import child
from tests.unit.project.test_reimport import by_hand, file_with
from tests.unit.project.test_rereading import quintet, tracks, written
from widgets.common.combo import Combo
from widgets.common.text import note_text
from widgets.dialogs.reimport_midi import ReimportDialog


def shown_dialog(session: Session, outcome: Reimport, file: str = "q.mid") -> ReimportDialog:
    """Dialog about a re-import."""
    changes = changes_by_part(session.project.score, outcome.project.score)
    return ReimportDialog(session, outcome, file, lambda correction, player: "", changes)


@pytest.mark.parametrize("language", ["en", "ja"])
def test_conflicts_are_rows_and_what_stays_is_counted(session: Session, qtbot: QtBot, language: str) -> None:
    project = quartet_project()
    first = project.score.parts[0].notes
    edited = by_hand(project, 0, {3: {"pitch": first[3].pitch + 1}, 7: None, 11: {"velocity": 9}})
    new = file_with(project, 0, {3: {"pitch": first[3].pitch - 2}, 7: {"velocity": 9}})
    session.document.open(edited)
    outcome = reimport(edited, new, bundled_maps())
    spoken = Language()
    spoken.set(language)
    try:
        dialog = shown_dialog(session, outcome, "quartet.mid")
        qtbot.addWidget(dialog)
        dialog.show()
        rows = child(dialog, QListWidget, "reimport_conflicts")
        assert rows.isVisible()
        texts = [rows.item(row).text() for row in range(rows.count())]
        assert len(texts) == 2
        part = project.score.parts[0]
        here, there = (
            note_text(session, note, session.project.players[0])
            for note in (edited.score.parts[0].notes[3], outcome.project.score.parts[0].notes[3])
        )
        assert texts[0] == f"{part.name}: {here} → {there}"
        assert texts[1].startswith(f"{part.name}: {'deleted' if language == 'en' else '削除'}")
        table = child(dialog, QTreeWidget, "reimport_parts")
        assert [table.topLevelItem(row).text(5) for row in range(table.topLevelItemCount())] == ["1", "0", "0", "0"]
        # Conflicts of a player whose notes are kept are not counted.
        table.setCurrentItem(table.topLevelItem(0))
        QTest.keyClick(table, Qt.Key.Key_Space)
        assert not rows.isVisible()
        QTest.keyClick(table, Qt.Key.Key_Space)
        assert [rows.isRowHidden(row) for row in range(rows.count())] == [False, False]
        assert rows.isVisible()
        ok = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok)
        with qtbot.waitSignal(dialog.accepted):
            qtbot.mouseClick(ok, Qt.MouseButton.LeftButton)
    finally:
        spoken.set("en")


def changed_quintet(tmp_path: Path) -> tuple[Project, Path, Path]:
    """A quintet, its file, and a newer file without the fourth part and with a flute."""
    path = written(tmp_path / "quintet.mid", tracks())
    flute = mido.MidiTrack([mido.MetaMessage("track_name", name="Flute")])
    for place in range(12):
        flute.append(mido.Message("note_on", note=72 + 5 * place % 12, velocity=80))
        flute.append(mido.Message("note_off", note=72 + 5 * place % 12, time=240))
    newer = written(tmp_path / "newer.mid", [*tracks()[:3], tracks()[4], flute])
    return quintet(path), path, newer


def dialog_of(session: Session, qtbot: QtBot, before: Project, path: Path) -> ReimportDialog:
    session.document.open(before)
    outcome = reimported(before, path, bundled_maps())
    dialog = shown_dialog(session, outcome, path.name)
    qtbot.addWidget(dialog)
    dialog.show()
    return dialog


@pytest.mark.parametrize("by", ["mouse", "keys"])
def test_a_player_whose_part_is_gone_is_removed_only_if_checked(
    session: Session, qtbot: QtBot, tmp_path: Path, by: str
) -> None:
    project, _, newer = changed_quintet(tmp_path)
    dialog = dialog_of(session, qtbot, project, newer)
    gone = child(dialog, QListWidget, "reimport_gone")
    assert gone.isVisible()
    assert [gone.item(row).text() for row in range(gone.count())] == [project.players[3].name]
    assert dialog.removed == ()
    if by == "keys":
        gone.setFocus()
        gone.setCurrentRow(0)
        QTest.keyClick(gone, Qt.Key.Key_Space)
    else:
        box = gone.visualItemRect(gone.item(0))
        QTest.mouseClick(gone.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(box.left() + 10, box.center().y()))
    assert dialog.removed == (project.players[3].id,)


def changed_quartet() -> tuple[Project, Score]:
    """A quartet and its changed file: two notes of the first player differ and one is missing, the second player's are
    a bar later from the sixth on.
    """
    project = quartet_project()
    first, second = (part.notes for part in project.score.parts[:2])
    late = {place: {"onset_tick": note.onset_tick + 2880} for place, note in enumerate(second) if place > 4}
    edited = by_hand(project, 0, {3: {"pitch": first[3].pitch + 2}, 7: None, 9: {"velocity": 9}})
    return project, file_with(edited, 1, late)


@pytest.mark.parametrize("language", ["en", "ja"])
def test_changes_are_stepped_through_and_shown_behind_the_dialog(session: Session, qtbot: QtBot, language: str) -> None:
    project, score = changed_quartet()
    session.document.open(project)
    spoken = Language()
    spoken.set(language)
    try:
        dialog = shown_dialog(session, reimport(project, score, bundled_maps()))
        qtbot.addWidget(dialog)
        dialog.show()
        dialog.activateWindow()
        qtbot.waitUntil(dialog.isActiveWindow)
        tree = child(dialog, QTreeWidget, "reimport_parts")
        assert [tree.topLevelItem(row).text(0) for row in range(4)] == [player.name for player in project.players]
        steps = []
        for key in [Qt.Key.Key_F8] * 5:
            QTest.keyClick(tree, key)
            item = tree.currentItem()
            steps.append((item.parent().text(0), item.text(1)))
            assert session.players[0] == next(one.id for one in project.players if one.name == item.parent().text(0))
            (note_id,) = session.selection.notes
            note = next(note for part in project.score.parts for note in part.notes if note.id == note_id)
            assert session.playhead_s == pytest.approx(project.score.tempo_map.seconds(note.onset_tick))
        one, two = (player.name for player in project.players[:2])
        assert [name for name, _ in steps] == [one, one, one, two, two]
        assert steps[3] == steps[4]
        assert all(text.isascii() for _, text in steps if "→" not in text) == (language == "en")
        assert "→" in steps[0][1]
        assert ("+1 bar" if language == "en" else "+1 小節") in steps[3][1]
        QTest.keyClick(tree, Qt.Key.Key_F8, Qt.KeyboardModifier.ShiftModifier)
        assert tree.currentItem().parent().text(0) == one
    finally:
        spoken.set("en")


def test_a_filter_leaves_the_changes_of_one_kind(session: Session, qtbot: QtBot) -> None:
    project, score = changed_quartet()
    session.document.open(project)
    dialog = shown_dialog(session, reimport(project, score, bundled_maps()))
    qtbot.addWidget(dialog)
    dialog.show()
    tree, kinds = child(dialog, QTreeWidget, "reimport_parts"), child(dialog, Combo, "reimport_filter")
    kinds.setFocus()
    QTest.keyClicks(kinds, "Rem")
    assert kinds.currentText() == "Removed"
    shown = [tree.topLevelItem(row) for row in range(4) if not tree.topLevelItem(row).isHidden()]
    assert [item.text(0) for item in shown] == [project.players[0].name]
    assert [shown[0].child(row).text(1)[-7:] for row in range(shown[0].childCount())] == ["removed"]


@pytest.mark.parametrize("by", ["mouse", "keys"])
def test_a_player_that_is_unchecked_keeps_its_notes(session: Session, qtbot: QtBot, by: str) -> None:
    project, score = changed_quartet()
    session.document.open(project)
    outcome = reimport(project, score, bundled_maps())
    dialog = shown_dialog(session, outcome, "q.mid")
    qtbot.addWidget(dialog)
    dialog.show()
    tree = child(dialog, QTreeWidget, "reimport_parts")
    ok = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok)
    for row in (0, 1):
        assert ok.isEnabled()
        item = tree.topLevelItem(row)
        if by == "keys":
            tree.setCurrentItem(item)
            QTest.keyClick(tree, Qt.Key.Key_Space)
        else:
            box = tree.visualItemRect(item)
            QTest.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(box.left() + 10, box.center().y()))
        if row == 0:
            kept, taken = dialog.taken.project.score.parts[:2]
            assert kept == project.score.parts[0]
            assert taken == outcome.project.score.parts[1]
    assert dialog.taken.project is project
    assert not ok.isEnabled()


def test_ten_thousand_changes_are_shown_at_once(session: Session, qtbot: QtBot) -> None:
    project = quartet_project()
    notes = tuple(Note(f"1:{place}", 240 * place, 200, 60 + place % 12, 80) for place in range(1, 10_001))
    parts = (msgspec.structs.replace(project.score.parts[0], notes=notes), *project.score.parts[1:])
    project = replace(project, score=msgspec.structs.replace(project.score, parts=parts))
    score = file_with(project, 0, {place: {"velocity": 50} for place in range(10_000)})
    session.document.open(project)
    outcome = reimport(project, score, bundled_maps())
    begun = time.perf_counter()
    dialog = shown_dialog(session, outcome, "q.mid")
    qtbot.addWidget(dialog)
    dialog.show()
    dialog.activateWindow()
    qtbot.waitUntil(dialog.isActiveWindow)
    tree = child(dialog, QTreeWidget, "reimport_parts")
    for _ in range(10):
        QTest.keyClick(tree, Qt.Key.Key_F8)
    assert time.perf_counter() - begun < 5
    assert tree.topLevelItem(0).indexOfChild(tree.currentItem()) == 9
    assert tree.topLevelItem(0).childCount() == 10_000


def test_a_file_that_says_nothing_new_cannot_be_taken_in(session: Session, qtbot: QtBot, tmp_path: Path) -> None:
    project, path, _ = changed_quintet(tmp_path)
    dialog = dialog_of(session, qtbot, project, path)
    assert any(label.text() == "quintet.mid contains no changes." for label in dialog.findChildren(QLabel))
    assert not dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok).isEnabled()
    assert not dialog.findChild(QListWidget, "reimport_gone").isVisible()


def test_the_same_notes_elsewhere_only_change_which_file_is_used(
    session: Session, qtbot: QtBot, tmp_path: Path
) -> None:
    project, path, _ = changed_quintet(tmp_path)
    other = tmp_path / "final.mid"
    other.write_bytes(path.read_bytes())
    dialog = dialog_of(session, qtbot, project, other)
    assert any("from now on" in label.text() for label in dialog.findChildren(QLabel))
    assert dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok).isEnabled()


@pytest.mark.parametrize("language", ["en", "ja"])
def test_names_are_whole_and_many_changes_leave_the_other_players_in_sight(
    session: Session, qtbot: QtBot, language: str
) -> None:
    project = quartet_project()
    changes: dict[int, dict[str, int] | None] = {
        place: {"velocity": 9} for place in range(len(project.score.parts[0].notes))
    }
    session.document.open(project)
    spoken = Language()
    spoken.set(language)
    try:
        dialog = shown_dialog(session, reimport(project, file_with(project, 0, changes), bundled_maps()))
        qtbot.addWidget(dialog)
        dialog.show()
        tree = child(dialog, QTreeWidget, "reimport_parts")
        rows = [tree.topLevelItem(row) for row in range(tree.topLevelItemCount())]
        room = tree.viewport().rect()
        assert [room.contains(tree.visualItemRect(row)) for row in rows] == [True] * 4
        needed = [tree.sizeHintForIndex(tree.indexFromItem(row)).width() + tree.indentation() for row in rows]
        assert max(needed) <= tree.columnWidth(0)
        # Opened by a key, it shows whole places too.
        tree.setCurrentItem(rows[0])
        QTest.keyClick(tree, Qt.Key.Key_Right)
        assert rows[0].childCount() > 50
        last = tree.indexFromItem(rows[0].child(rows[0].childCount() - 1))
        assert tree.sizeHintForIndex(last).width() + 2 * tree.indentation() <= tree.columnWidth(0)
    finally:
        spoken.set("en")
