"""A button for choosing a colour: one of the theme's, which are distinguishable for colour-blind users, or any
other.
"""

from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QIcon, QPainter, QPaintEvent, QPen, QPixmap
from PySide6.QtWidgets import QColorDialog, QMenu, QPushButton, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.session import Session
from app.editor.translated import speaks_as_system
from widgets.common.clicks import on_click
from widgets.common.controls import named


class ColourSwatch(QPushButton):
    """Shows a colour, and a menu of others on a click.

    Parameters
    ----------
    title : str
        Id of the title of the dialog for any colour.

    Signals
    -------
    chosen(str)
        The user chose ``#rrggbb``; empty for the automatic colour.
    """

    chosen = Signal(str)

    def __init__(
        self, session: Session, parent: QWidget | None = None, *, title: str = "colour_swatch.colour_of_player"
    ) -> None:
        super().__init__(parent)
        self._session, self._title = session, title
        self._colours: tuple[str, ...] = ()
        self.setFixedSize(44, LEAST_TARGET_PX + 1)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        on_click(self, self.offer)
        session.theme_changed.connect(self.update)

    def show_colours(self, colours: tuple[str, ...]) -> None:
        """Set the colours shown side by side on the button."""
        if colours != self._colours:
            self._colours = colours
            self.update()

    def offer(self) -> None:
        """Open the menu of colours."""
        menu = named(QMenu(self), "colour_menu")
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        on_click(menu.addAction(self.tr("colour_swatch.automatic")), self.chosen.emit, "")
        menu.addSeparator()
        names = (
            self.tr("colour_swatch.sky_blue"),
            self.tr("colour_swatch.orange"),
            self.tr("colour_swatch.green"),
            self.tr("colour_swatch.pink"),
            self.tr("colour_swatch.yellow"),
            self.tr("colour_swatch.blue"),
            self.tr("colour_swatch.vermilion"),
            self.tr("colour_swatch.grey"),
        )
        for name, colour in zip(names, self._session.tokens.players, strict=False):
            action = menu.addAction(_spot(colour), name)
            on_click(action, self.chosen.emit, colour)
        menu.addSeparator()
        on_click(menu.addAction(self.tr("colour_swatch.other_colour")), self._ask)
        menu.popup(self.mapToGlobal(self.rect().bottomLeft()))

    def _ask(self) -> None:
        before = QColor(self._colours[0]) if self._colours else QColor(self._session.tokens.accent)
        options = QColorDialog.ColorDialogOption(0)
        if not speaks_as_system():
            options = QColorDialog.ColorDialogOption.DontUseNativeDialog
        colour = QColorDialog.getColor(before, self, self.tr(self._title), options)
        if colour.isValid():
            self.chosen.emit(colour.name())

    # Qt overrides

    def sizeHint(self) -> QSize:
        return QSize(44, LEAST_TARGET_PX + 1)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = self._session.tokens, QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        box = QRectF(self.rect()).adjusted(1, 1, -1, -1)
        shown = self._colours[:6]
        for index, colour in enumerate(shown):
            width = box.width() / len(shown)
            painter.fillRect(QRectF(box.left() + index * width, box.top(), width, box.height()), QColor(colour))
        focused = self.hasFocus()
        painter.setPen(QPen(QColor(tokens.accent if focused else tokens.line_strong), 2.0 if focused else 1.0))
        painter.drawRoundedRect(box, 3, 3)


def _spot(colour: str) -> QIcon:
    pixmap = QPixmap(32, 32)
    pixmap.fill(Qt.GlobalColor.transparent)
    painter = QPainter(pixmap)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setBrush(QColor(colour))
    painter.setPen(Qt.PenStyle.NoPen)
    painter.drawEllipse(3, 3, 26, 26)
    painter.end()
    return QIcon(pixmap)
