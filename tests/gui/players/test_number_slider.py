"""The number control, by mouse and keys."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QGuiApplication, QKeyEvent, QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QVBoxLayout, QWidget
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from tests.support.windows import child, show_in_front
from widgets.common.number_slider import NumberSlider


class Reported:
    """Signals sent by the control."""

    def __init__(self, slider: NumberSlider) -> None:
        self.values: list[float] = []
        self.tokens: list[object] = []
        self.releases = 0
        slider.changed.connect(self.take)
        slider.released.connect(self.release)

    def take(self, value: float, token: object) -> None:
        self.values.append(value)
        self.tokens.append(token)

    def release(self) -> None:
        self.releases += 1


@pytest.fixture
def window(session: Session, qtbot: QtBot) -> QWidget:
    made = QWidget()
    layout = QVBoxLayout(made)
    layout.addWidget(NumberSlider(session, 0.0, 1.0, default=0.5, step=0.05, parent=made))
    layout.addWidget(QLineEdit())
    made.resize(240, 120)
    qtbot.addWidget(made)
    show_in_front(made)
    return made


@pytest.fixture
def slider(window: QWidget) -> NumberSlider:
    control = child(window, NumberSlider)
    control.set_texts("Amplitude", "beats")
    control.setFocus()
    return control


def drag(slider: NumberSlider, pixels: int, release: bool = True) -> None:
    start = QPoint(40, slider.height() // 2)
    QTest.mousePress(slider, Qt.MouseButton.LeftButton, pos=start)
    for moved in (4, pixels // 2, pixels):
        QTest.mouseMove(slider, start + QPoint(moved, 0))
        QApplication.processEvents()
    if release:
        QTest.mouseRelease(slider, Qt.MouseButton.LeftButton, pos=start + QPoint(pixels, 0))


def test_it_is_large_enough_for_a_pen(slider: NumberSlider) -> None:
    assert slider.height() >= 24


def test_a_drag_is_one_gesture(slider: NumberSlider) -> None:
    reported = Reported(slider)
    drag(slider, 60)
    assert slider.value == pytest.approx(0.5 + 56 / slider.width(), abs=0.011)
    assert len(set(reported.tokens)) == 1
    assert reported.tokens[0] is not None
    assert reported.releases == 1
    drag(slider, -30)
    assert len(set(reported.tokens)) == 2


@pytest.mark.parametrize("first", [1, 12, -12])
def test_a_drag_that_comes_back_leaves_the_value(slider: NumberSlider, first: int) -> None:
    reported = Reported(slider)
    start = QPoint(80, slider.height() // 2)
    QTest.mousePress(slider, Qt.MouseButton.LeftButton, pos=start)
    for moved in (first, 4 * first, 40, 2 * first, first, 0):
        QTest.mouseMove(slider, start + QPoint(moved, 0))
        QApplication.processEvents()
    QTest.mouseRelease(slider, Qt.MouseButton.LeftButton, pos=start)
    assert reported.values[-1] == slider.value == 0.5
    assert max(reported.values) > 0.6


def test_escape_takes_a_drag_back(slider: NumberSlider) -> None:
    reported = Reported(slider)
    drag(slider, 60, release=False)
    assert slider.value > 0.6
    QTest.keyClick(slider, Qt.Key.Key_Escape)
    assert slider.value == 0.5
    assert reported.values[-1] == 0.5
    assert reported.releases == 1
    QTest.mouseRelease(slider, Qt.MouseButton.LeftButton)
    assert reported.releases == 1


def test_a_drag_stays_in_range_and_turns_at_once(slider: NumberSlider) -> None:
    start = QPoint(40, 10)
    QTest.mousePress(slider, Qt.MouseButton.LeftButton, pos=start)
    for x in (44, 900, 890):
        QTest.mouseMove(slider, QPoint(x, 10))
    QTest.mouseRelease(slider, Qt.MouseButton.LeftButton, pos=QPoint(890, 10))
    assert slider.value == pytest.approx(1.0 - 10 / slider.width(), abs=0.011)


def test_shift_is_fine(slider: NumberSlider) -> None:
    start = QPoint(40, 10)
    QTest.mousePress(slider, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.ShiftModifier, start)
    for x in (44, 104):
        position = QPointF(x, 10)
        event = QMouseEvent(
            QMouseEvent.Type.MouseMove,
            position,
            slider.mapToGlobal(position),
            Qt.MouseButton.NoButton,
            Qt.MouseButton.LeftButton,
            Qt.KeyboardModifier.ShiftModifier,
        )
        QApplication.sendEvent(slider, event)
    QTest.mouseRelease(slider, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.ShiftModifier, QPoint(104, 10))
    assert slider.value == pytest.approx(0.5 + 6 / slider.width(), abs=0.011)


def field(slider: NumberSlider) -> QLineEdit:
    found = child(slider, QLineEdit, "number_field")
    assert found.isVisible()
    return found


def test_a_click_opens_the_field_and_return_takes_what_was_typed(slider: NumberSlider) -> None:
    reported = Reported(slider)
    QTest.mouseClick(slider, Qt.MouseButton.LeftButton, pos=QPoint(100, 10))
    QTest.keyClicks(field(slider), "1/4")
    QTest.keyClick(field(slider), Qt.Key.Key_Return)
    assert reported.values == [0.25]
    assert reported.tokens == [None]
    assert slider.window().focusWidget() is slider


@pytest.mark.parametrize(("typed", "kept"), [("7", 1.0), ("-3", 0.0)])
def test_what_is_typed_beyond_the_range_is_its_end(slider: NumberSlider, typed: str, kept: float) -> None:
    reported = Reported(slider)
    QTest.keyClick(slider, Qt.Key.Key_F2)
    QTest.keyClicks(field(slider), typed)
    QTest.keyClick(field(slider), Qt.Key.Key_Return)
    assert (slider.value, reported.values) == (kept, [kept])


def test_typing_begins_with_the_first_digit(slider: NumberSlider) -> None:
    QTest.keyClick(slider, Qt.Key.Key_0)
    QTest.keyClicks(field(slider), ".75")
    QTest.keyClick(field(slider), Qt.Key.Key_Tab)
    assert slider.value == 0.75


def test_escape_and_nonsense_change_nothing(slider: NumberSlider) -> None:
    reported = Reported(slider)
    QTest.keyClick(slider, Qt.Key.Key_F2)
    QTest.keyClicks(field(slider), "0.9")
    QTest.keyClick(field(slider), Qt.Key.Key_Escape)
    QTest.keyClick(slider, Qt.Key.Key_Return)
    QTest.keyClicks(slider.findChildren(QLineEdit, "number_field")[-1], "loud")
    QTest.keyClick(slider.findChildren(QLineEdit, "number_field")[-1], Qt.Key.Key_Return)
    assert reported.values == []
    assert slider.value == 0.5


def test_arrows_step_and_a_held_key_is_one_gesture(slider: NumberSlider) -> None:
    reported = Reported(slider)
    for _ in range(3):
        QTest.keyPress(slider, Qt.Key.Key_Up)
    QTest.keyRelease(slider, Qt.Key.Key_Up)
    assert reported.values == [0.55, 0.6, 0.65]
    assert len(set(reported.tokens)) == 1
    assert reported.releases == 1
    QTest.keyClick(slider, Qt.Key.Key_Down, Qt.KeyboardModifier.ShiftModifier)
    assert slider.value == 0.64
    assert len(set(reported.tokens)) == 2
    QTest.keyClick(slider, Qt.Key.Key_End)
    assert slider.value == 1.0


def wheel(slider: NumberSlider) -> QWheelEvent:
    position = QPointF(20, 10)
    event = QWheelEvent(
        position,
        slider.mapToGlobal(position),
        QPoint(),
        QPoint(0, 120),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(slider, event)
    return event


def test_the_wheel_works_only_with_focus(slider: NumberSlider, qtbot: QtBot) -> None:
    reported = Reported(slider)
    wheel(slider)
    wheel(slider)
    assert reported.values == [0.55, 0.6]
    assert reported.tokens[0] is reported.tokens[1]
    qtbot.waitUntil(lambda: reported.releases == 1)
    slider.clearFocus()
    assert not wheel(slider).isAccepted()
    assert slider.value == 0.6


def test_a_double_click_returns_to_the_default(slider: NumberSlider) -> None:
    reported = Reported(slider)
    slider.show_value(0.9)
    assert slider.by_hand
    QTest.mouseDClick(slider, Qt.MouseButton.LeftButton, pos=QPoint(60, 10))
    assert reported.values == [0.5]
    assert not slider.by_hand
    slider.show_value(0.2)
    QTest.mouseClick(slider, Qt.MouseButton.LeftButton, pos=QPoint(60, 10))
    QTest.mouseDClick(field(slider), Qt.MouseButton.LeftButton, pos=QPoint(60, 10))
    assert slider.value == 0.5


def test_who_listens_to_reset_decides(slider: NumberSlider) -> None:
    reported, requested = Reported(slider), []
    slider.reset.connect(requested.append)
    slider.show_value(0.9, default=0.3)
    QTest.keyClick(slider, Qt.Key.Key_Backspace)
    assert requested == [0.3]
    assert reported.values == []


def test_without_a_default_a_double_click_types(session: Session, window: QWidget) -> None:
    control = NumberSlider(session, 0, 127, decimals=0, resets=False, parent=window)
    control.resize(120, 26)
    control.show()
    reported = Reported(control)
    control.show_value(64)
    assert not control.by_hand
    QTest.mouseDClick(control, Qt.MouseButton.LeftButton, pos=QPoint(30, 10))
    QTest.keyClicks(field(control), "70")
    QTest.keyClick(field(control), Qt.Key.Key_Return)
    assert reported.values == [70.0]


def test_copy_and_paste(slider: NumberSlider) -> None:
    slider.show_value(0.35)
    QTest.keyClick(slider, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    assert QGuiApplication.clipboard().text() == "0.35"
    QGuiApplication.clipboard().setText(" 0.8 beats")
    QTest.keyClick(slider, Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)
    assert slider.value == 0.8


def test_several_values_are_a_dash_until_one_is_chosen(slider: NumberSlider) -> None:
    reported = Reported(slider)
    slider.show_value(0.5, mixed=True)
    assert slider.value_text() == "—"
    assert slider.by_hand
    QTest.keyClick(slider, Qt.Key.Key_F2)
    assert field(slider).text() == ""
    QTest.keyClicks(field(slider), "0.5")
    QTest.keyClick(field(slider), Qt.Key.Key_Return)
    assert reported.values == [0.5]
    assert slider.value_text() == "0.50"


def test_it_takes_its_keys_before_the_window_does(slider: NumberSlider) -> None:
    def taken(key: Qt.Key, modifier: Qt.KeyboardModifier, text: str = "") -> bool:
        event = QKeyEvent(QEvent.Type.ShortcutOverride, key, modifier, text)
        event.ignore()
        QApplication.sendEvent(slider, event)
        return event.isAccepted()

    assert taken(Qt.Key.Key_1, Qt.KeyboardModifier.NoModifier, "1")
    assert taken(Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    assert taken(Qt.Key.Key_Backspace, Qt.KeyboardModifier.NoModifier)
    assert not taken(Qt.Key.Key_Space, Qt.KeyboardModifier.NoModifier, " ")
    assert not taken(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)


def test_a_value_finer_than_shown_is_left_alone_where_nobody_changed_it(window: QWidget, slider: NumberSlider) -> None:
    slider.show_value(0.5312)
    reported = Reported(slider)
    for end in (Qt.Key.Key_Return, Qt.Key.Key_Tab):
        slider.type_value()
        field = slider.findChild(QLineEdit)
        assert field is not None
        assert field.text() == "0.53"
        QTest.keyClick(field, end)
    slider.type_value()
    window.findChildren(QLineEdit)[-1].setFocus()
    assert reported.values == []


def test_a_drag_back_to_where_it_began_gives_the_exact_value_back(slider: NumberSlider) -> None:
    slider.show_value(0.5312)
    reported = Reported(slider)
    start = QPoint(40, slider.height() // 2)
    QTest.mousePress(slider, Qt.MouseButton.LeftButton, pos=start)
    for moved in (4, 30, 0):
        QTest.mouseMove(slider, start + QPoint(moved, 0))
    QTest.mouseRelease(slider, Qt.MouseButton.LeftButton, pos=start)
    assert reported.values[0] != 0.5312
    assert reported.values[-1] == 0.5312
