"""Base of dialogs that work in the background, show progress, and cancel before they close."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QLayout, QProgressBar, QPushButton, QWidget

from app.errors import Message, StopRequested
from widgets.common.clicks import on_click
from widgets.common.controls import Button, Retranslated, named
from widgets.common.help import with_help
from widgets.common.plain import Label
from widgets.common.text import sentence

_PARTS = 1000
_LEAST_SHARE, _LEAST_S = 0.02, 0.5
"""Completed share and elapsed seconds below which no remaining time is estimated."""


def stopping(stop: threading.Event, stop_requested: StopRequested) -> StopRequested:
    """Return a function that the working thread calls to find out whether work was cancelled, in the dialog or in the
    status line.
    """

    def asked() -> bool:
        if stop_requested():
            stop.set()
        return stop.is_set()

    return asked


class WorkingDialog(Retranslated, QDialog):
    """Dialog in which one button starts work, and the other cancels it, or closes the dialog if no work is running.

    Parameters
    ----------
    name, prefix : str
        Object name, and prefix of the buttons' names.

    Attributes
    ----------
    fields : tuple of QWidget
        Fields, which are disabled during work.
    """

    def __init__(self, name: str, prefix: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.fields: tuple[QWidget, ...] = ()
        self._prefix = prefix
        self._running = False
        # A new event for each run, because the thread has no reference to the dialog.
        self._stop = threading.Event()
        self._progress = named(QProgressBar(), f"{prefix}_progress")
        self._progress.setRange(0, _PARTS)
        self._progress.hide()
        # Current item, number of items and remaining time; afterwards the news that it was cancelled.
        self._under_way = named(Label(), f"{prefix}_under_way")
        self._under_way.hide()
        self._began_s = 0.0
        self._close = named(QPushButton(), f"{prefix}_close")
        on_click(self._close, self.reject)

    def _box(self, start_id: str, start: Callable[[], object], show_folder: Callable[[], object]) -> QLayout:
        """Return a row of buttons that start the work, open the output folder, and cancel or close."""
        box = QDialogButtonBox()
        self._start = Button(start_id, start, f"{self._prefix}_start")
        self._start.setDefault(True)
        self._show = Button("working_dialog.show_in_folder", show_folder, f"{self._prefix}_show_folder")
        for button in (self._start, self._show):
            button.setAutoDefault(True)
            box.addButton(button, QDialogButtonBox.ButtonRole.ActionRole)
        self._show.hide()
        self.fields += (self._start,)
        box.addButton(self._close, QDialogButtonBox.ButtonRole.RejectRole)
        return with_help(box)

    def _set_running(self, running: bool) -> None:
        if running:
            self._stop = threading.Event()
            self._began_s = time.monotonic()
            self._show_share(0.0)
        self._running = running
        self._progress.setVisible(running)
        self._under_way.setVisible(running or self._stop.is_set())
        for field in self.fields:
            field.setEnabled(not running)
            # Choices cannot be changed during the work but stay legible.
            field.setProperty("working", running)
            for widget in (field, *field.findChildren(QWidget)):
                widget.style().polish(widget)
        self.retranslate()

    def _show_share(self, share: float, doing: str = "") -> None:
        """Show the completed share, a text about the current work, and the remaining time once it can be estimated."""
        self._progress.setValue(round(_PARTS * share))
        elapsed_s = time.monotonic() - self._began_s
        left = self.tr("working_dialog.finishing" if share >= 1.0 else "working_dialog.estimating")
        if _LEAST_SHARE <= share < 1.0 and elapsed_s >= _LEAST_S:
            left_s = math.ceil(elapsed_s * (1.0 - share) / share)
            left = self.tr("working_dialog.left").format(minutes=left_s // 60, seconds=left_s % 60)
        self._under_way.setText(" · ".join(part for part in (doing, left) if part))

    def retranslate(self) -> None:
        self._close.setText(self.tr("working_dialog.cancel") if self._running else self.tr("working_dialog.close"))
        if self._stop.is_set() and not self._running:
            self._under_way.setText(sentence(Message("work.stopped")))

    def reject(self) -> None:
        """Cancel running work, or close; also on Escape and the window's close button."""
        if self._running:
            self._stop.set()
        else:
            super().reject()
