"""Text that looks like HTML is displayed literally wherever Qt would guess, and opens no file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtGui import QAccessible, QAction, QHelpEvent, QKeySequence
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QGroupBox,
    QInputDialog,
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QSpinBox,
    QTabBar,
    QToolButton,
    QWidget,
)
from pytestqt.qtbot import QtBot

from app.editor.design_tokens import DARK
from tests.gui.conftest import delete_now
from tests.support.canary import WATCHES, Canary, canary
from tests.support.windows import show
from widgets.common.plain import ComboBox, Label, MessageBox, verbatim, verbatim_title

pytestmark = pytest.mark.skipif(not WATCHES, reason="only Linux reports which files are opened")


@pytest.fixture
def watched(qt_app: QApplication, tmp_path: Path) -> Iterator[Canary]:
    """Files that must not be opened, and the application with its theme."""
    with canary(tmp_path / "c") as result:
        yield result


def tip_at(widget: QWidget, place: QPoint) -> QLabel:
    """Tool tip that appears at a position of the mouse."""
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
        assert reader.text(QAccessible.Text.Name) == written
    assert watched.opened() == []


@pytest.mark.parametrize(
    "kind", [QWidget, QToolButton, ComboBox, QSpinBox, QLineEdit, QListWidget, QTabBar, QGroupBox, QLabel, QPushButton]
)
@pytest.mark.parametrize("sheet", ["", "color: red;"])
def test_tips_are_plain(watched: Canary, qtbot: QtBot, kind: type[QWidget], sheet: str) -> None:
    """Each tip is new, since Qt reuses a visible one."""
    widget = kind()
    qtbot.addWidget(widget)
    # A widget with a style sheet of its own gives it to its tip.
    widget.setStyleSheet(sheet)
    widget.setToolTip(watched.html)
    widget.show()
    tip = tip_at(widget, QPoint(3, 3))
    assert (tip.isVisible(), tip.text(), tip.textFormat()) == (True, watched.html, Qt.TextFormat.PlainText)
    assert watched.opened() == []


def test_tips_of_actions_and_items_are_plain(watched: Canary, qtbot: QtBot) -> None:
    button, items, box = QToolButton(), QListWidget(), ComboBox()
    button.setDefaultAction(QAction(watched.html, button))
    item = QListWidgetItem("item")
    item.setToolTip(watched.html)
    items.addItem(item)
    box.addItem("item")
    box.setItemData(0, watched.html, Qt.ItemDataRole.ToolTipRole)
    for widget, asked in ((button, button), (items, items.viewport()), (box, box.view().viewport())):
        qtbot.addWidget(widget)
        widget.show()
        if widget is box:
            box.showPopup()
        tip = tip_at(asked, QPoint(10, 10))
        assert (tip.text(), tip.textFormat()) == (watched.html, Qt.TextFormat.PlainText)
        tip.close()
        delete_now()
    assert watched.opened() == []


def test_boxes_are_plain(watched: Canary, qtbot: QtBot) -> None:
    box = MessageBox()
    qtbot.addWidget(box)
    box.setText(watched.html)
    box.setInformativeText(watched.eager)
    shown = [label for label in box.findChildren(QLabel) if label.text()]
    assert {label.textFormat() for label in shown} == {Qt.TextFormat.PlainText}
    show(box)
    assert watched.opened() == []


def test_labels_that_qt_makes_are_plain(watched: Canary, qtbot: QtBot) -> None:
    """The labels in Qt's own dialogs."""
    asking = QInputDialog()
    qtbot.addWidget(asking)
    asking.setLabelText(watched.html)
    show(asking)
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
    show(window)
    assert window.windowHandle().title().startswith("a[*]b")
    window.setWindowModified(True)
    assert window.windowHandle().title().startswith("a[*]b*")


def test_what_a_message_box_says_can_be_copied(qt_app: QApplication, qtbot: QtBot) -> None:
    box = MessageBox()
    qtbot.addWidget(box)
    box.setText("film.mp4")
    box.setInformativeText("/home/films/film.mp4")
    box.show()
    texts = {label.text(): label for label in box.findChildren(QLabel) if label.text()}
    assert texts.keys() >= {"film.mp4", "/home/films/film.mp4"}
    for label in texts.values():
        assert label.textInteractionFlags() & Qt.TextInteractionFlag.TextSelectableByMouse
    box.hide()


def test_what_is_marked_in_an_open_list_has_the_accent(qt_app: QApplication, qtbot: QtBot) -> None:
    box = ComboBox()
    box.addItems(["1/4", "1/8", "1/16"])
    qtbot.addWidget(box)
    show(box)
    box.showPopup()
    QApplication.processEvents()
    view = box.view()
    QTest.keyClick(view, Qt.Key.Key_Down)
    row = view.visualRect(view.model().index(1, 0))
    picture = view.viewport().grab().toImage()
    assert picture.pixelColor(row.right() - 6, row.center().y()).name() == DARK.accent
    box.hidePopup()
