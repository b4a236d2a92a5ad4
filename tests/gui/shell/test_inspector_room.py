"""Division of the inspector: a short list of problems leaves space to the selected note, until the user drags the
divider.
"""

from __future__ import annotations

from dataclasses import replace

import msgspec
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QListView, QPushButton, QTabWidget, QWidget

from app.editor.selection import Selection
from app.errors import Message
from app.project.edit.notes import move
from app.shell.app import Program
from tests.support.windows import child, wait_until
from widgets.inspector.panel import InspectorPanel


def _saxophone_alone(program: Program) -> None:
    """Replace all players by a saxophone that can play the first part."""
    session = program.session
    first = msgspec.structs.replace(session.project.players[0], instrument_id="sax_alto_Eb")
    session.apply(Message("edit.remove_players", {"of": "Trumpet 1"}), replace(session.project, players=(first,)))
    assert not session.problems(first.id)


def _in_sight(chart: QWidget) -> bool:
    return wait_until(lambda: chart.visibleRegion().boundingRect().height() >= chart.height() - 4 > 100)


def test_the_chart_of_a_note_is_in_sight_until_the_divider_is_dragged(program: Program) -> None:
    program.window.resize(1600, 1000)
    program.window.reset_workspace()
    session = program.session
    _saxophone_alone(program)
    notes = session.project.part(session.project.players[0]).notes
    session.select(Selection(frozenset({notes[3].id})))
    chart, fix = child(program.window, QWidget, "fingering_diagram"), child(program.window, QPushButton, "fix_problems")
    assert _in_sight(chart)
    assert not fix.isVisible()

    inspector = child(program.window, InspectorPanel)
    splitter = inspector._splitter
    alone = splitter.sizes()[1]
    ids = [note.id for note in notes[4:12]]
    session.apply(Message("edit.move_notes", {"count": 8, "of": ""}), move(session.project, ids, 0, -24))
    assert splitter.sizes()[1] > alone
    assert fix.isVisible()
    assert _in_sight(chart)
    rows = child(program.window, QListView, "problem_list")
    assert rows.viewport().height() >= rows.visualRect(rows.model().index(0, 0)).height()

    # Other lists have the same place: the tabs stay under the mouse.
    tabs, sizes = child(inspector, QTabWidget, "inspector_tabs"), splitter.sizes()
    for tab in (1, 2, 0):
        tabs.setCurrentIndex(tab)
        assert splitter.sizes() == sizes

    handle = splitter.handle(1)
    place = handle.rect().center()
    QTest.mousePress(handle, Qt.MouseButton.LeftButton, pos=place)
    target = QPointF(place + QPoint(0, -60))
    spot = handle.mapToGlobal(target)
    left = Qt.MouseButton.LeftButton
    none = Qt.KeyboardModifier.NoModifier
    QApplication.sendEvent(handle, QMouseEvent(QEvent.Type.MouseMove, target, spot, left, left, none))
    QTest.mouseRelease(handle, left, pos=place)
    dragged = splitter.sizes()
    session.document.undo()
    assert splitter.sizes() == dragged
    state = inspector.save_state()
    program.window.reset_workspace()
    assert splitter.sizes()[1] == alone
    inspector.restore_state(state)
    assert abs(splitter.sizes()[1] - dragged[1]) <= 2
