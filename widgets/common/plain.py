"""Widgets that show text literally.

Qt interprets text that looks like HTML as HTML, and opens files named in it. Texts in the program come from files and
must never be shown as HTML. The program's labels and message boxes are plain by default; Qt's own widgets (tips, file
dialogs) are made plain by the theme's style sheet. A test ensures that no other classes and methods show HTML.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QHelpEvent, QShowEvent
from PySide6.QtWidgets import QComboBox, QLabel, QMessageBox, QStyledItemDelegate, QToolTip, QWidget

Role: TypeAlias = QMessageBox.ButtonRole


class Label(QLabel):
    """A label with plain text even before a style applies, since Qt measures and reads out hidden texts."""

    def __init__(self, text: str = "", parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setText(text)


class MessageBox(QMessageBox):
    """A message box with plain and selectable texts."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTextFormat(Qt.TextFormat.PlainText)

    def showEvent(self, event: QShowEvent) -> None:
        """Make the texts selectable; Qt creates the label for the longer text only when the box is shown."""
        for label in self.findChildren(QLabel):
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        super().showEvent(event)


def ask(
    parent: QWidget | None,
    name: str,
    title: str,
    text: str,
    explanation: str,
    answers: Mapping[str, Role],
    usual: Role = Role.RejectRole,
) -> Role:
    """Ask in a message box and return the answer.

    Parameters
    ----------
    name : str
        Object name.
    answers : mapping of str to Role
        Roles by the buttons' texts; Escape presses the rejecting one.
    usual : Role
        Role of the button that Return presses.
    """
    box = MessageBox(parent)
    box.setObjectName(name)
    box.setIcon(MessageBox.Icon.NoIcon)
    box.setWindowTitle(title)
    box.setText(text)
    box.setInformativeText(explanation)
    buttons = {role: box.addButton(answer, role) for answer, role in answers.items()}
    box.setDefaultButton(buttons[usual])
    box.setEscapeButton(buttons[Role.RejectRole])
    box.exec()
    role = box.buttonRole(box.clickedButton())
    box.deleteLater()
    return role


class ComboBox(QComboBox):
    """A combo box with a plain-text tool tip, whose open list receives all keys.

    Qt does not apply style sheets to frames within a combo box, such as tips. While the list is open, Qt still runs the
    panel's shortcuts: arrow keys would move notes. The current item has the accent colour, since the style would give
    it only a thin dark frame.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setItemDelegate(QStyledItemDelegate(self))

    def showPopup(self) -> None:
        """Open the list of options, whose keys are kept from shortcuts while it is open."""
        super().showPopup()
        self.view().installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keep keys in the open list from shortcuts."""
        if event.type() == QEvent.Type.ShortcutOverride:
            event.accept()
        return super().eventFilter(watched, event)

    def event(self, event: QEvent) -> bool:
        """Show the tool tip as if it were the parent's, so that it has plain text."""
        if not isinstance(event, QHelpEvent) or event.type() != QEvent.Type.ToolTip:
            return super().event(event)
        QToolTip.showText(event.globalPos(), self.toolTip(), self.parentWidget())
        return True


def verbatim(text: str) -> str:
    """Return a text for buttons, menus and tabs with ``&`` and tabs escaped."""
    return text.replace("&", "&&").replace("\t", " ")


def verbatim_title(text: str) -> str:
    """Return a text for window titles with ``[*]`` escaped."""
    return text.replace("[*]", "[*][*]")
