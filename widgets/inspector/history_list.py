"""List of undo steps; a click moves to a step."""

from __future__ import annotations

from PySide6.QtCore import QEvent
from PySide6.QtWidgets import QWidget

from app.editor.session import Session
from widgets.common.controls import named
from widgets.common.layouts import in_column
from widgets.common.text import message_text
from widgets.inspector.rows import LineList, ListRow


class HistoryList(QWidget):
    """All steps to undo or redo; the last one done is marked."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self.list = named(LineList(session, has_details=False), "history_list")
        self.list.setSelectionMode(LineList.SelectionMode.SingleSelection)
        in_column(self.list, of=self, margins=0)
        self.list.opened.connect(self._go_to)
        session.changed.connect(self.show_steps)

    def show_steps(self, *_: object) -> None:
        """Update the list of steps that can be undone and redone, if it is visible."""
        if not self.isVisible():
            return
        document = self._session.document
        done, undone = document.done, document.undone[::-1]
        texts = [self.tr("history_list.as_opened"), *(_sentence(message_text(step.name)) for step in (*done, *undone))]
        lines = []
        for number, text in enumerate(texts):
            tone = "current" if number == len(done) else "faint" if number > len(done) else ""
            lines.append(ListRow(number, text, str(number) if number else "", tone=tone))
        self.list.lines.show_lines(lines)
        current = self.list.lines.index(len(done))
        self.list.setCurrentIndex(current)
        self.list.scrollTo(current)

    def _go_to(self, key: object) -> None:
        assert isinstance(key, int)
        document = self._session.document
        while len(document.done) > key:
            document.undo()
        while len(document.done) < key and document.undone:
            document.redo()

    # Qt overrides

    def showEvent(self, event: QEvent) -> None:
        self.show_steps()

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.show_steps()
        super().changeEvent(event)


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]
