"""Requests for help: a dialog's button and F1 show the section of the guide about a widget."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QApplication, QDialogButtonBox, QHBoxLayout, QWidget

from widgets.common.controls import Button
from widgets.common.layouts import in_row


@runtime_checkable
class ShowsHelp(Protocol):
    """A window that can show the guide's section about one of its widgets."""

    def show_help(self, about: QWidget) -> None:
        """Show the guide's section about a widget."""


def ask_for_help(about: QWidget) -> None:
    """Show the guide's section about a widget, by the window that contains it."""
    owner: QWidget | None = about
    while owner is not None and not isinstance(owner, ShowsHelp):
        owner = owner.parentWidget()
    if owner is None:
        # A dialog opened while the program was in the background has no parent.
        owner = next((top for top in QApplication.topLevelWidgets() if isinstance(top, ShowsHelp)), None)
    if isinstance(owner, ShowsHelp):
        owner.show_help(about)


class HelpButton(Button):
    """A button that opens the guide about its dialog; F1 opens the section about the focused field."""

    def __init__(self) -> None:
        super().__init__("help_button.help", self._ask, "help_button", "help_button.open_guide")
        # The field being edited keeps the focus.
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        QShortcut(QKeySequence(Qt.Key.Key_F1), self, self._ask_about_field)

    def _ask(self) -> None:
        ask_for_help(self.window())

    def _ask_about_field(self) -> None:
        field = QApplication.focusWidget()
        ask_for_help(field if field is not None and field.window() is self.window() else self.window())


def with_help(buttons: QDialogButtonBox) -> QHBoxLayout:
    """Return a dialog's buttons in a row with the help button at the left."""
    return in_row(HelpButton(), (buttons, 1))
