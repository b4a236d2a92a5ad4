"""A running task in the status line: name, progress, and a button that cancels it."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QSize
from PySide6.QtWidgets import QProgressBar, QWidget

from app.editor.session import Session
from app.editor.tasks import Task
from widgets.common.controls import IconButton, Retranslated, small
from widgets.common.layouts import in_row
from widgets.common.plain import Label
from widgets.common.text import message_text

NAME_PX = 48
"""Least width of the task's name in pixels."""
BAR_PX = 64
"""Width of a progress bar in pixels."""


def show_value(bar: QProgressBar, value: int) -> None:
    """Set a progress bar's value without painting it immediately, which would redraw all of a window with OpenGL."""
    if value != bar.value():
        bar.setUpdatesEnabled(False)
        bar.setValue(value)
        bar.setUpdatesEnabled(True)


class TaskRow(Retranslated, QWidget):
    """A row of the status line for one running task: name, progress, and a button that cancels the task."""

    def __init__(self, session: Session, task: Task, stop: Callable[[], object]) -> None:
        super().__init__()
        self._task, self._name, self._bar = task, Label(), QProgressBar()
        # The column at the right leaves room for the names of work.
        self._name.setMinimumWidth(NAME_PX)
        self._bar.setTextVisible(False)
        self._bar.setFixedWidth(BAR_PX)
        self._bar.setRange(0, 0)
        close = close_button(session, "task_row.stop", stop, "stop_task")
        in_row(self._name, self._bar, close, of=self, margins=0, spacing=6)
        self.retranslate()

    def retranslate(self) -> None:
        """Set the name of the task."""
        name = message_text(self._task.name)
        self._name.setText(name[:1].upper() + name[1:])
        self._name.setToolTip(self._name.text())

    def set_share(self, share: float) -> None:
        """Show the completed share of the task, 0..1; 0 shows a bar without a value."""
        most = 1000 if share > 0.0 else 0
        if self._bar.maximum() != most:
            self._bar.setRange(0, most)
        show_value(self._bar, round(1000 * share))


def close_button(session: Session, tip_id: str, run: Callable[[], object], name: str) -> IconButton:
    button = small(IconButton(session, "close", tip_id, run, name))
    button.setIconSize(QSize(14, 14))
    return button
