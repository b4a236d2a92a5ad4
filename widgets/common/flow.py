"""A layout that arranges widgets in lines like words in a paragraph."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRect, QSize, Qt
from PySide6.QtWidgets import QLayout, QLayoutItem, QWidget


class FlowLayout(QLayout):
    """Widgets from left to right, then in the next line.

    Parameters
    ----------
    gap_px : int
        Space between neighbours and between lines.
    """

    def __init__(self, parent: QWidget | None = None, gap_px: int = 4) -> None:
        super().__init__(parent)
        self._items: list[QLayoutItem] = []
        self._heights_px: dict[int, int] = {}
        """By width, until something in it has another size: layouts around ask many times over."""
        self.setSpacing(gap_px)
        self.setContentsMargins(0, 0, 0, 0)

    def clear(self) -> None:
        """Remove and delete all widgets."""
        while (item := self.takeAt(0)) is not None:
            widget = item.widget()
            if widget is not None:
                widget.hide()
                widget.deleteLater()

    def _arrange(self, room: QRect, place: bool) -> int:
        """Return the total height of the lines for a width; with ``place``, also move the widgets there."""
        margins = self.contentsMargins()
        area = room.marginsRemoved(margins)
        y = area.y()
        for line in self._lines(area.width()):
            x, line_px = area.x(), max(size.height() for _, size in line)
            for item, size in line:
                if place:
                    width_px, below_px = min(size.width(), area.width()), (line_px - size.height()) // 2
                    item.setGeometry(QRect(QPoint(x, y + below_px), QSize(width_px, size.height())))
                x += size.width() + self.spacing()
            y += line_px + self.spacing()
        return max(y - self.spacing(), area.y()) - room.y() + margins.bottom()

    def _lines(self, width_px: int) -> list[list[tuple[QLayoutItem, QSize]]]:
        """Divide the visible items into lines of at most ``width_px``; return each item with its size."""
        lines: list[list[tuple[QLayoutItem, QSize]]] = []
        used_px = 0
        for item in self._items:
            if item.isEmpty():
                continue
            size = item.sizeHint()
            if not lines or used_px + size.width() > width_px:
                lines.append([])
                used_px = 0
            lines[-1].append((item, size))
            used_px += size.width() + self.spacing()
        return lines

    # Qt overrides

    def addItem(self, item: QLayoutItem) -> None:
        self._items.append(item)
        self.invalidate()

    def count(self) -> int:
        return len(self._items)

    def itemAt(self, index: int) -> QLayoutItem | None:
        return self._items[index] if 0 <= index < len(self._items) else None

    def takeAt(self, index: int) -> QLayoutItem | None:
        if not 0 <= index < len(self._items):
            return None
        item = self._items.pop(index)
        self.invalidate()
        return item

    def expandingDirections(self) -> Qt.Orientation:
        return Qt.Orientation(0)

    def hasHeightForWidth(self) -> bool:
        return True

    def invalidate(self) -> None:
        self._heights_px.clear()
        super().invalidate()

    def heightForWidth(self, width: int) -> int:
        height_px = self._heights_px.get(width)
        if height_px is None:
            height_px = self._heights_px[width] = self._arrange(QRect(0, 0, width, 0), place=False)
        return height_px

    def setGeometry(self, room: QRect) -> None:
        super().setGeometry(room)
        self._arrange(room, place=True)

    def sizeHint(self) -> QSize:
        return self.minimumSize()

    def minimumSize(self) -> QSize:
        size = QSize()
        for item in self._items:
            size = size.expandedTo(item.minimumSize())
        margins = self.contentsMargins()
        return size + QSize(margins.left() + margins.right(), margins.top() + margins.bottom())
