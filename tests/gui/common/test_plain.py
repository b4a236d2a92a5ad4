"""Text that looks like HTML is shown as it is written, wherever Qt would guess, and opens no file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtGui import QAccessible, QAction, QHelpEvent, QKeySequence
from PySide6.QtWidgets import (
    QApplication,
    QInputDialog,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QToolButton,
    QWidget,
)
from pytestqt.qtbot import QtBot

from tests.support.canary import WATCHES, Canary, canary
from widgets.common.plain import Label, MessageBox, verbatim, verbatim_title

pytestmark = pytest.mark.skipif(not WATCHES, reason="only Linux reports which files are opened")


@pytest.fixture
def watched(qt_app: QApplication, tmp_path: Path) -> Iterator[Canary]:
    """Files that nothing may open, in the themed application."""
    with canary(tmp_path / "c") as result:
        yield result


def tip_at(widget: QWidget, place: QPoint) -> QLabel:
    """The tip that comes up where the mouse rests."""
    QApplication.sendEvent(widget, QHelpEvent(QEvent.Type.ToolTip, place, widget.mapToGlobal(place)))
    QApplication.processEvents()
    (tip,) = (one for one in QApplication.allWidgets() if one.metaObject().className() == "QTipLabel")
    assert isinstance(tip, QLabel)
    return tip


@pytest.mark.parametrize("text", ["html", "eager"])
def test_the_watch_sees_what_rich_text_opens(watched: Canary, qtbot: QtBot, text: str) -> None:
    label = QLabel(getattr(watched, text))
    qtbot.addWidget(label)
    label.heightForWidth(100)
    assert watched.opened()


@pytest.mark.parametrize("text", ["html", "eager"])
def test_a_label_is_plain_before_any_style_reaches_it(watched: Canary, qtbot: QtBot, text: str) -> None:
    written: str = getattr(watched, text)
    first, later = Label(written), Label()
    later.setText(written)
    for label in (first, later):
        qtbot.addWidget(label)
        label.setWordWrap(True)
        label.heightForWidth(100)
        reader = QAccessible.queryAccessibleInterface(label)
        assert reader is not None
        assert reader.text(QAccessible.Text.Name) == written
    assert watched.opened() == []


def test_tips_are_plain(watched: Canary, qtbot: QtBot) -> None:
    plain, by_action, items = QWidget(), QToolButton(), QListWidget()
    plain.setToolTip(watched.html)
    # A widget with a style of its own gives it to its tip.
    plain.setStyleSheet("color: red;")
    by_action.setDefaultAction(QAction(watched.html, by_action))
    item = QListWidgetItem("item")
    item.setToolTip(watched.html)
    items.addItem(item)
    for widget in (plain, by_action, items):
        qtbot.addWidget(widget)
        widget.resize(100, 60)
        widget.show()
        qtbot.waitExposed(widget)
        asked = items.viewport() if widget is items else widget
        tip = tip_at(asked, QPoint(10, 10))
        assert tip.isVisible()
        assert tip.text().startswith("<img")
        assert tip.textFormat() == Qt.TextFormat.PlainText
    assert watched.opened() == []


def test_boxes_are_plain(watched: Canary, qtbot: QtBot) -> None:
    box = MessageBox()
    qtbot.addWidget(box)
    box.setText(watched.html)
    box.setInformativeText(watched.eager)
    shown = [label for label in box.findChildren(QLabel) if label.text()]
    assert {label.textFormat() for label in shown} == {Qt.TextFormat.PlainText}
    box.show()
    qtbot.waitExposed(box)
    assert watched.opened() == []


def test_labels_that_qt_makes_are_plain(watched: Canary, qtbot: QtBot) -> None:
    """No label of ours: those of Qt's own dialogs."""
    asking = QInputDialog()
    qtbot.addWidget(asking)
    asking.setLabelText(watched.html)
    asking.show()
    qtbot.waitExposed(asking)
    assert watched.opened() == []


def test_a_name_gives_a_button_no_key(qtbot: QtBot) -> None:
    for name in ("R&B", "a\tb", "&&", "plain"):
        button = QPushButton(verbatim(name))
        qtbot.addWidget(button)
        assert button.shortcut() == QKeySequence()
        assert "\t" not in button.text()
    assert verbatim("R&B") == "R&&B"


def test_a_name_does_not_mark_a_window_as_changed(qt_app: QApplication, qtbot: QtBot) -> None:
    window = QWidget()
    qtbot.addWidget(window)
    window.setWindowTitle(f"{verbatim_title('a[*]b')}[*]")
    window.show()
    qtbot.waitExposed(window)
    assert window.windowHandle().title().startswith("a[*]b")
    window.setWindowModified(True)
    assert window.windowHandle().title().startswith("a[*]b*")
