"""Many rectangles and lines drawn together are all at the right places."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen
from PySide6.QtWidgets import QApplication

from widgets.timeline.plot.drawing import draw_groups, draw_lines, draw_rects

Pixels = npt.NDArray[np.uint32]
WHITE, BLUE = 0xFFFFFFFF, 0xFF0000FF


@pytest.fixture
def image(qapp: QApplication) -> QImage:
    image = QImage(1600, 8, QImage.Format.Format_ARGB32)
    image.fill(Qt.GlobalColor.white)
    return image


def pixels(image: QImage) -> Pixels:
    return np.frombuffer(image.constBits(), np.uint32).reshape(image.height(), image.width()).copy()


@pytest.mark.parametrize("count", [1, 16, 100, 400])
def test_every_rectangle_is_drawn(image: QImage, count: int) -> None:
    """Including the first, whose memory was formerly freed before Qt had read it."""
    left = 4.0 * np.arange(count)
    painter = QPainter(image)
    draw_rects(painter, left, np.full(count, 2.0), np.full(count, 3.0), np.full(count, 4.0), QColor("blue"))
    painter.end()
    expected = np.full((8, 1600), WHITE, np.uint32)
    for x in left.astype(int):
        expected[2:6, x : x + 3] = BLUE
    np.testing.assert_array_equal(pixels(image), expected)


@pytest.mark.parametrize("count", [1, 16, 100, 400])
def test_every_line_is_drawn(image: QImage, count: int) -> None:
    x = 4.0 * np.arange(count) + 0.5
    painter = QPainter(image)
    draw_lines(painter, x, np.full(count, 0.0), x, np.full(count, 8.0), QPen(QColor("blue"), 1.0))
    painter.end()
    expected = np.full((8, 1600), WHITE, np.uint32)
    expected[:, (4 * np.arange(count))] = BLUE
    np.testing.assert_array_equal(pixels(image), expected)


def test_groups_have_their_colours(image: QImage) -> None:
    left, ones = 4.0 * np.arange(5), np.ones(5)
    group = np.array([0, 0, 2, 2, 3])
    colours = [QColor(name) for name in ("red", "lime", "blue", "black")]
    painter = QPainter(image)
    draw_groups(painter, (left, 2.0 * ones, 2.0 * ones, ones), group, colours)
    painter.end()
    expected = np.full((8, 1600), WHITE, np.uint32)
    for x, number in zip(left.astype(int), group, strict=True):
        expected[2, x : x + 2] = colours[number].rgba()
    np.testing.assert_array_equal(pixels(image), expected)


def test_nothing_is_drawn_of_nothing(image: QImage) -> None:
    none = np.empty(0)
    painter = QPainter(image)
    draw_rects(painter, none, none, none, none, QColor("blue"))
    draw_lines(painter, none, none, none, none, QPen(QColor("blue")))
    draw_groups(painter, (none, none, none, none), np.empty(0, np.int64), [])
    painter.end()
    assert (pixels(image) == WHITE).all()
