"""Icons: line drawings in the colours of the theme.

Each is a file ``resources/icons/<name>.svg`` with a view box of 24 and lines of ``currentColor``. It is rendered for
each size, so that it is sharp at every scale of the screen.
"""

from __future__ import annotations

from functools import lru_cache
from importlib.resources import files

from PySide6.QtCore import QByteArray, QPointF, QRect, QRectF, QSizeF, Qt
from PySide6.QtGui import QIcon, QPainter, QPixmap
from PySide6.QtSvg import QSvgRenderer

from app.editor.design_tokens import Tokens

SIZES_PX = (16, 20, 24, 32, 48)
"""Rendered sizes in screen pixels; other sizes are scaled from the next larger one."""
DISABLED_OPACITY = 0.4


def icon(name: str, tokens: Tokens, colour: str | None = None) -> QIcon:
    """Return an icon in the theme's text colour, and in the accent colour for checked buttons.

    Parameters
    ----------
    name : str
        File name in ``resources/icons`` without suffix.
    colour : str, optional
        Colour ``#rrggbb`` instead of the theme's.

    Raises
    ------
    FileNotFoundError
        There is no icon of that name.
    """
    return _icon(name, colour or tokens.text, colour or tokens.accent)


def pixmap(name: str, size_px: int, colour: str, ratio: float = 1.0) -> QPixmap:
    """Return the icon of a name as an image of ``size_px`` device-independent pixels; ``ratio`` is the number of screen
    pixels per pixel.
    """
    result = _draw(source(name, colour), round(size_px * ratio), 1.0)
    result.setDevicePixelRatio(ratio)
    return result


@lru_cache(maxsize=512)
def _icon(name: str, colour: str, checked: str) -> QIcon:
    result = QIcon()
    off, on = source(name, colour), source(name, checked)
    for size_px in SIZES_PX:
        result.addPixmap(_draw(off, size_px, 1.0), QIcon.Mode.Normal, QIcon.State.Off)
        result.addPixmap(_draw(off, size_px, DISABLED_OPACITY), QIcon.Mode.Disabled, QIcon.State.Off)
        if checked != colour:
            result.addPixmap(_draw(on, size_px, 1.0), QIcon.Mode.Normal, QIcon.State.On)
    return result


@lru_cache(maxsize=512)
def _text(name: str) -> str:
    return (files("resources") / "icons" / f"{name}.svg").read_text(encoding="utf-8")


def source(name: str, colour: str) -> bytes:
    """Return the SVG text of the icon ``name`` in a colour."""
    return _text(name).replace("currentColor", colour).encode()


def draw_grip(painter: QPainter, box: QRect, colour: str) -> None:
    """Draw the grip in the middle of a horizontal splitter."""
    renderer = QSvgRenderer(QByteArray(source("grip_level", colour)))
    place = QRectF(QPointF(), QSizeF(renderer.defaultSize()))
    place.moveCenter(QRectF(box).center())
    renderer.render(painter, place)


def _draw(source: bytes, size_px: int, opacity: float) -> QPixmap:
    result = QPixmap(size_px, size_px)
    result.fill(Qt.GlobalColor.transparent)
    painter = QPainter(result)
    painter.setOpacity(opacity)
    QSvgRenderer(QByteArray(source)).render(painter, QRectF(0.0, 0.0, size_px, size_px))
    painter.end()
    return result
