"""List of the status line's recent messages in full, to read and copy, with links to their folders."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QFrame, QWidget

from app.editor.design_tokens import Tokens
from app.editor.session import Session, Severity
from app.errors import Message
from app.formats.other_computers import may_touch
from widgets.common.controls import Button, IconButton, selectable, small, wrapped
from widgets.common.icons import pixmap
from widgets.common.layouts import in_column, in_row, panel
from widgets.common.paths import show_folder
from widgets.common.plain import Label
from widgets.common.text import sentence

SHOWN = 12
"""Number of messages that are listed."""
WIDTH_PX = 520


class NoticeList(QFrame):
    """List of the recent messages of the status line in full, the newest on top."""

    def __init__(self, session: Session, parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setObjectName("notices")
        self.setFrameShape(QFrame.Shape.StyledPanel)
        self._session = session
        self._rows = in_column(spacing=8)
        copy = Button("details.copy", self._copy_all, "copy_notices")
        in_column(self._rows, (copy, 0, Qt.AlignmentFlag.AlignRight), of=self, margins=10, spacing=8)
        self._text = ""

    def open_over(self, anchor: QWidget, log: tuple[tuple[Message, Severity], ...]) -> None:
        """Show the newest messages of the log in a popup above a widget."""
        while (item := self._rows.takeAt(0)) is not None:
            widget = item.widget()
            if widget is not None:
                widget.hide()
                widget.deleteLater()
        newest = tuple(reversed(log))[:SHOWN]
        self._text = "\n".join(sentence(message, self._session) for message, _ in newest)
        for message, severity in newest:
            self._rows.addWidget(self._row(message, severity))
        self.adjustSize()
        corner = anchor.mapToGlobal(anchor.rect().topLeft())
        self.move(corner.x(), corner.y() - self.height() - 4)
        self.show()

    def _row(self, message: Message, severity: Severity) -> QWidget:
        mark, text = Label(), selectable(wrapped(Label(sentence(message, self._session))))
        colour = severity_colour(severity, self._session.tokens)
        mark.setPixmap(pixmap(severity.value, 16, colour, self.devicePixelRatioF()))
        text.setFixedWidth(WIDTH_PX)
        folder = folder_of(message)
        show = small(
            IconButton(self._session, "folder", "working_dialog.show_in_folder", partial(self._show, folder), "folder")
        )
        # Texts of all rows are aligned.
        policy = show.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        show.setSizePolicy(policy)
        if folder is None:
            show.hide()
        return panel(in_row((mark, 0, Qt.AlignmentFlag.AlignTop), (text, 1), show, margins=0))

    def _show(self, folder: Path | None) -> None:
        if folder is not None:
            show_folder(folder)
            self.hide()

    def _copy_all(self) -> None:
        QApplication.clipboard().setText(self._text)
        self.hide()


def folder_of(message: Message) -> Path | None:
    """Return the folder named by a message or the folder of its file; None if there is none."""
    for value in message.arguments.values():
        path = Path(value) if isinstance(value, str) else Path()
        if path.is_absolute() and may_touch(path):
            # Unlike `Path.is_dir`, this returns False for names that no file can have.
            folder = path if os.path.isdir(path) else path.parent
            if os.path.isdir(folder):
                return folder
    return None


def severity_colour(severity: Severity, tokens: Tokens) -> str:
    """Return the colour of the mark for messages of a severity (information, warning, error)."""
    return {
        Severity.INFORMATION: tokens.accent,
        Severity.WARNING: tokens.warning,
        Severity.ERROR: tokens.error,
    }[severity]
