"""Text that is shown as it is written.

Qt shows text that looks like HTML as HTML, and opens the files that such text names. Nothing here is HTML: what is
shown comes from files. Labels and message boxes of the program's own are plain from the start; those that Qt makes
(tips, file dialogs) by the theme's style sheet. A test keeps classes and methods that show HTML out of the program.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QHelpEvent, QShowEvent
from PySide6.QtWidgets import QComboBox, QLabel, QMessageBox, QStyledItemDelegate, QToolTip, QWidget

Role: TypeAlias = QMessageBox.ButtonRole


class Label(QLabel):
    """Plain text before any style reaches it: Qt measures and reads out texts that are not shown yet."""

    def __init__(self, text: str = "", parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setText(text)


class MessageBox(QMessageBox):
    """A message box whose texts are plain, and can be copied."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTextFormat(Qt.TextFormat.PlainText)

    def showEvent(self, event: QShowEvent) -> None:
        """Qt makes the label of the explanation when there is one."""
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
    """Ask in a message box, and wait for the answer.

    Parameters
    ----------
    name : str
        Object name.
    answers : mapping of str to Role
        Roles by the buttons' texts; the one that rejects is what Escape presses.
    usual : Role
        What Return presses.
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
    """A combo box whose tip is plain, and whose open list has the keyboard alone.

    Qt keeps style sheets from frames within a combo box, and a tip is one. While the list is open, Qt lets shortcuts of
    the panel work: the arrows would move notes instead of the choice. What is marked in it has the accent: as an entry
    of a menu, which the style makes of it, it would have a thin dark frame alone.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setItemDelegate(QStyledItemDelegate(self))

    def showPopup(self) -> None:
        """Open the list."""
        super().showPopup()
        self.view().installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keep keys in the open list from shortcuts."""
        if event.type() == QEvent.Type.ShortcutOverride:
            event.accept()
        return super().eventFilter(watched, event)

    def event(self, event: QEvent) -> bool:
        """Show the tip as one of what the box is in."""
        if not isinstance(event, QHelpEvent) or event.type() != QEvent.Type.ToolTip:
            return super().event(event)
        QToolTip.showText(event.globalPos(), self.toolTip(), self.parentWidget())
        return True


def verbatim(text: str) -> str:
    """A text for buttons, menus and tabs, where ``&`` would name a key and a tab begin a column."""
    return text.replace("&", "&&").replace("\t", " ")


def verbatim_title(text: str) -> str:
    """A text for a window's title, where ``[*]`` would mark changes."""
    return text.replace("[*]", "[*][*]")
