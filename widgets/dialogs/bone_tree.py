"""Tree of a file's bones with a search field, for choosing a bone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QKeySequence
from PySide6.QtWidgets import QHeaderView, QLineEdit, QTreeWidget, QTreeWidgetItem, QWidget

from app.editor.session import Session
from app.rig.figure import Figure
from widgets.common.controls import named
from widgets.common.layouts import in_column

_INDENTATION_PX, _MOST_INDENTED_PX = 10, 40
"""Indentation of a bone from its parent in pixels, and the greatest total indentation, since fingers have ten parents
or more.
"""


class BoneTree(QWidget):
    """Tree of bones; Enter or a double click chooses one.

    Signals
    -------
    chosen(str)
        The user chose the bone of this name.
    """

    chosen = Signal(str)

    def __init__(self, session: Session, figure: Figure, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self.search = named(QLineEdit(), "bone_search")
        self.search.setClearButtonEnabled(True)
        self.search.textChanged.connect(self._filter)
        self.search.installEventFilter(self)
        self.tree = named(_Tree(), "bone_tree")
        self.tree.setColumnCount(2)
        self.tree.setUniformRowHeights(True)
        self.tree.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        self.tree.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.tree.itemActivated.connect(self._activated)
        self._items = list[QTreeWidgetItem]()
        for bone, name in enumerate(figure.bone_names):
            item = QTreeWidgetItem([name, ""])
            item.setToolTip(0, name)
            parent_bone = figure.parents[bone]
            if parent_bone < 0:
                self.tree.addTopLevelItem(item)
            else:
                self._items[parent_bone].addChild(item)
            self._items.append(item)
        self.tree.setIndentation(min(_INDENTATION_PX, _MOST_INDENTED_PX // max(1, _depth(figure))))
        self.tree.expandAll()
        in_column(self.search, (self.tree, 1), of=self, margins=0, spacing=4)

    def show_used(self, used: Mapping[int, str]) -> None:
        """Show next to each used bone the joint that uses it, by index of the bone."""
        dim = QColor(self._session.tokens.text_dim)
        for bone, item in enumerate(self._items):
            text = used.get(bone, "")
            if item.text(1) != text:
                item.setText(1, text)
            item.setForeground(1, dim)

    def reveal(self, bone: int | None) -> None:
        """Select a bone and scroll to it."""
        if bone is None:
            self.tree.clearSelection()
            return
        self.tree.setCurrentItem(self._items[bone])
        self.tree.scrollToItem(self._items[bone])

    def set_headers(self, headers: Sequence[str]) -> None:
        """Set the column headings of the tree of bones."""
        self.tree.setHeaderLabels(list(headers))
        header = self.tree.header()
        header.setStretchLastSection(False)
        # Both columns are visible: the joint, and as much of the bone's name as fits.
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)

    def _filter(self, text: str) -> None:
        """Show only the bones whose name contains a text, and their parents; select an exact match, else the first."""
        requested = text.strip().casefold()
        first: QTreeWidgetItem | None = None
        exact: QTreeWidgetItem | None = None
        # Children follow their parents in this list.
        for item in reversed(self._items):
            hit = requested in item.text(0).casefold()
            children = [item.child(number) for number in range(item.childCount())]
            below = any(child is not None and not child.isHidden() for child in children)
            item.setHidden(bool(requested) and not hit and not below)
            if hit and requested:
                first = item
            if item.text(0).casefold() == requested:
                exact = item
        first = exact or first
        if first is not None:
            self.tree.setCurrentItem(first)
            self.tree.scrollToItem(first)

    def _activated(self, item: QTreeWidgetItem, column: int = 0) -> None:
        self.chosen.emit(item.text(0))

    def eventFilter(self, watched: object, event: QEvent) -> bool:
        """Move from the search field to the bones with the arrow keys, and choose the selected one with Enter; a choice
        is undone from the field too, once it has no text of its own to undo.
        """
        if watched is self.search and event.type() is QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            if event.matches(QKeySequence.StandardKey.Undo):
                return not self.search.isUndoAvailable()
            return event.matches(QKeySequence.StandardKey.Redo) and not self.search.isRedoAvailable()
        if watched is self.search and event.type() is QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            key = Qt.Key(event.key())
            if key in (Qt.Key.Key_Down, Qt.Key.Key_Up):
                self.tree.setFocus(Qt.FocusReason.OtherFocusReason)
                self.tree.keyPressEvent(event)
                return True
            if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
                item = self.tree.currentItem()
                if item is not None and not item.isHidden():
                    # Text that was set, unlike text that was cleared, cannot be undone.
                    self.search.setText("")
                    self._activated(item)
                return True
        return False


def _depth(figure: Figure) -> int:
    """Return the greatest number of ancestors that a bone of the figure has."""
    depths = list[int]()
    for parent in figure.parents:
        depths.append(0 if parent < 0 else depths[parent] + 1)
    return max(depths, default=0)


class _Tree(QTreeWidget):
    """Tree that emits ``itemActivated`` on Enter regardless of the desktop's style."""

    def keyPressEvent(self, event: QKeyEvent) -> None:
        item = self.currentItem()
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and item is not None:
            self.itemActivated.emit(item, 0)
            return
        super().keyPressEvent(event)
