"""Dialogs that work beside the window, show how far they are, and cancel before they close."""

from __future__ import annotations

import threading
from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QProgressBar, QPushButton, QWidget

from widgets.common.clicks import on_click
from widgets.common.controls import Button, Retranslated, named

_PARTS = 1000


class WorkingDialog(Retranslated, QDialog):
    """Begins work with one button; with another it cancels while it works, and closes while it does not.

    Parameters
    ----------
    name, prefix : str
        Object name, and what the names of its buttons begin with.

    Attributes
    ----------
    fields : tuple of QWidget
        What is chosen: disabled while it works.
    """

    def __init__(self, name: str, prefix: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.fields: tuple[QWidget, ...] = ()
        self._prefix = prefix
        self._running = False
        # Each work gets its own: the thread knows nothing of the dialog.
        self._stop = threading.Event()
        self._progress = named(QProgressBar(), f"{prefix}_progress")
        self._progress.setRange(0, _PARTS)
        self._progress.hide()
        self._close = named(QPushButton(), f"{prefix}_close")
        on_click(self._close, self.reject)

    def _box(self, start_id: str, start: Callable[[], object], show_folder: Callable[[], object]) -> QDialogButtonBox:
        """Buttons to start, to look at what was written, and to cancel or close."""
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
        return box

    def _set_running(self, running: bool) -> None:
        if running:
            self._stop = threading.Event()
            self._show_share(0.0)
        self._running = running
        self._progress.setVisible(running)
        for field in self.fields:
            field.setEnabled(not running)
        self.retranslate()

    def _show_share(self, share: float) -> None:
        self._progress.setValue(round(_PARTS * share))

    def retranslate(self) -> None:
        self._close.setText(self.tr("working_dialog.cancel") if self._running else self.tr("working_dialog.close"))

    def reject(self) -> None:
        """Escape and the window's own button too."""
        if self._running:
            self._stop.set()
        else:
            super().reject()
