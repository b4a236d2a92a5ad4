"""Field for typing a tempo or metre in the ruler."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QLineEdit, QWidget

FIELD_PX = 80


class MarkEditor(QLineEdit):
    """Field for a tempo or metre in the ruler.

    Signals
    -------
    typed(str, int, str)
        The user accepted a text: kind (tempo or metre), tick and text.
    """

    typed = Signal(str, int, str)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._ruler = parent
        self.setObjectName("mark_editor")
        self._mark: tuple[str, int] | None = None
        self.hide()
        self.editingFinished.connect(self._editing_finished)

    def open(self, kind: str, tick: int, text: str, left_px: float, height_px: int) -> None:
        """Show the editor at ``left_px`` with the text of the tempo or metre mark at a tick, ready for typing."""
        self._mark = (kind, tick)
        self.setText(text)
        self.setToolTip(
            self.tr("mark_editor.tempo_in_quarters_per_minute")
            if kind == "tempo"
            else self.tr("mark_editor.metre_e_g_6_8")
        )
        self.setGeometry(int(min(left_px, self._ruler.width() - FIELD_PX - 4)), 0, FIELD_PX, height_px)
        self.show()
        self.raise_()
        self.selectAll()
        self.setFocus(Qt.FocusReason.OtherFocusReason)

    def leave(self, meant: bool) -> None:
        """Close the field; its text is applied if ``meant``, else discarded."""
        if self._mark is None:
            return
        (kind, tick), self._mark = self._mark, None
        self.hide()
        self._ruler.setFocus(Qt.FocusReason.OtherFocusReason)
        if meant:
            self.typed.emit(kind, tick, self.text().strip())

    def _editing_finished(self) -> None:
        """Accept the typed text when the focus is lost."""
        if self.isVisible() and not self.hasFocus():
            self.leave(True)

    # Qt overrides

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.leave(True)
        elif event.key() == Qt.Key.Key_Escape:
            self.leave(False)
        else:
            super().keyPressEvent(event)
