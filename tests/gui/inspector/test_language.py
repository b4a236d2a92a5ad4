"""The inspector changes its language while it is open."""

from __future__ import annotations

from PySide6.QtWidgets import QApplication

from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.errors import Message
from app.project.edit import events as edit
from tests.gui.inspector.hands import show_tab
from tests.gui.japanese import english_in, speaking, texts_of
from tests.support.windows import child
from widgets.common.section import Section
from widgets.inspector.panel import InspectorPanel
from widgets.inspector.rows import LineList


def test_everything_is_japanese_at_once_and_english_again(panel: InspectorPanel, planned: Session) -> None:
    player = planned.project.players[0]
    note = planned.project.part(player).notes[0]
    gesture = planned.performance.plan(player).gestures[2]
    planned.attempt(
        Message("edit.give_back", {"of": ""}), lambda p: edit.pin_fingerings(p, player.id, {note.id: "123"})
    )
    planned.select(Selection(frozenset((note.id,)), frozenset((EventKey(player.id, gesture.id),))))
    child(panel, Section, "inspector_expressions").set_open(True)
    show_tab(panel, 1)
    english = texts_of(panel)
    with speaking():
        shown = texts_of(panel)
        assert not english_in(shown)
        assert "運指図" in shown
        assert "右人差し指" in panel._notes._diagram.spoken()
        handwork = child(panel, LineList, "correction_list")
        assert [line.title for line in handwork.lines.lines] == ["運指 123"]
    QApplication.processEvents()
    assert texts_of(panel) == english
