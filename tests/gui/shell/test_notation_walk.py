"""Update of a piece from MIDI with the MusicXML of the same piece, as a user does it in the window."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialogButtonBox, QMenu

from app.editor.selection import Selection
from app.errors import Message
from app.plan.by_hand.corrections import PinFingering, SetBreath
from app.project.edit.corrections import with_corrections
from app.project.edit.marks import player_marks
from app.shell.app import Program
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Answers, trigger
from tests.gui.shell.test_window import drop
from tests.support import mouse
from tests.support.windows import child
from widgets.common.actions import actions
from widgets.dialogs.reimport_midi import ReimportDialog

NOTATION = QUARTET.with_suffix(".musicxml")


def click(program: Program, action_id: str) -> None:
    """Click an entry of Edit > Marks."""
    path = [child(program.window, QMenu, name) for name in ("menu_edit", "menu_edit_marks")]
    menu = mouse.open_in_bar(program.window.menuBar(), path)
    mouse.choose(menu, actions(program.session)[action_id])


@pytest.mark.parametrize("language", ["en", "ja"])
def test_corrections_of_a_midi_piece_stay_and_the_marks_of_its_score_come_in(
    empty: Program, answers: Answers, language: str
) -> None:
    program = empty
    program.window.resize(1600, 1000)
    program.editor.language.set(language)
    assert drop(program, QUARTET)
    session = program.session
    player = session.project.players[0]
    notes = session.project.part(player).notes
    pinned = session.performance.plan(player).fingerings[4]
    by_hand = [PinFingering(notes[4].id, pinned.label), SetBreath(notes[7].id, -60, -10)]
    session.attempt(Message("edit.set_tempo"), lambda project: with_corrections(project, player.id, by_hand))
    session.select(Selection(notes=frozenset({notes[10].id, notes[11].id, notes[12].id})))
    click(program, "marks.slur")
    before = session.project
    written = {mark for mark, origin in player_marks(before, player.id).items() if mark.kind == "slur"}
    assert len(written) == 1
    answers.path = NOTATION
    trigger(program, "file.reimport_other")
    dialog = program.window.findChildren(ReimportDialog)[-1]
    ok = dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok)
    assert ok.isEnabled()
    QTest.mouseClick(ok, Qt.MouseButton.LeftButton)
    after = session.project
    assert [one.name for one in after.players] == [one.name for one in before.players]
    assert after.corrections[player.id] == before.corrections[player.id]
    marks = player_marks(after, player.id)
    assert written < marks.keys()
    assert {"slur", "dynamic", "staccato"} <= {mark.kind for mark in marks.keys() - written}
    session.document.undo()
    assert session.project is before
