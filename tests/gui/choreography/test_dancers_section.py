"""The dancers' section by mouse and keys, judged by the project."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QCheckBox, QLineEdit, QMenu, QToolButton, QWidget
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.errors import Message
from tests.support.windows import child, show_in_front
from widgets.common.combo import Combo
from widgets.common.number_slider import NumberSlider
from widgets.players.choreography import dancers
from widgets.players.choreography.dancers import DancersSection
from widgets.players.stage_section import StageSection


@pytest.fixture
def section(session: Session, qtbot: QtBot, choreography: Path, monkeypatch: pytest.MonkeyPatch) -> DancersSection:
    monkeypatch.setattr(dancers, "ask_for_file", lambda *_: choreography)
    made = DancersSection(session)
    qtbot.addWidget(made)
    made.resize(320, 600)
    show_in_front(made)
    return made


def click(section: DancersSection, name: str) -> None:
    QTest.mouseClick(child(section, QToolButton, name), Qt.MouseButton.LeftButton)


def add(section: DancersSection) -> None:
    click(section, "dancers_add_button")
    menu = QApplication.activePopupWidget()
    assert isinstance(menu, QMenu)
    menu.actions()[-1].trigger()
    menu.close()


def slide(section: DancersSection, name: str, text: str) -> None:
    slider = child(section, NumberSlider, name)
    slider.setFocus()
    QTest.keyClick(slider, Qt.Key.Key_Return)
    editor = child(slider, QLineEdit)
    editor.setText(text)
    QTest.keyClick(editor, Qt.Key.Key_Return)


def test_a_dancer_comes_is_changed_and_goes_and_all_is_undone(
    session: Session, section: DancersSection, choreography: Path
) -> None:
    before = session.project
    reported: list[Message] = []
    session.noticed.connect(lambda message, _: reported.append(message))
    add(section)
    (dancer,) = session.project.dancers
    assert [message.id for message in reported] == ["dance.no_percussion"]
    assert dancer.choreography == str(choreography)
    assert section.dancer is dancer
    slide(section, "dancer_size", "1.25")
    slide(section, "dancer_weight", "-0.5")
    slide(section, "dancer_delay_beats", "4")
    slide(section, "dancer_x_m", "1.5")
    mirrored = child(section, QCheckBox, "dancer_mirrored")
    QTest.mouseClick(mirrored, Qt.MouseButton.LeftButton, pos=mirrored.rect().center() * 0.2)
    click(section, "dancer_dice")
    source = child(section, Combo, "dancer_source")
    assert [source.itemText(row) for row in range(source.count())] == ["None", "one", "other"]
    source.setCurrentIndex(2)
    source.activated.emit(2)
    outfit = child(section, Combo, "dancer_outfit")
    assert outfit.shown == ""
    outfit.setFocus()
    QTest.keyClick(outfit, Qt.Key.Key_Down)
    assert session.project.dancers[0].outfit.id == outfit.shown != ""
    (changed,) = session.project.dancers
    assert (changed.size, changed.weight, changed.delay_beats) == (1.25, -0.5, 4.0)
    assert (changed.mirrored, changed.source) == (True, 1)
    assert changed.stage.x_m == 1.5
    assert changed.seed != dancer.seed
    click(section, "dancers_duplicate_button")
    assert len(session.project.dancers) == 2
    assert section.dancer is session.project.dancers[1]
    click(section, "dancers_remove_button")
    click(section, "dancers_remove_button")
    assert session.project.dancers == ()
    assert section.dancer is None
    while session.document.done:
        session.document.undo()
    assert session.project == before


def test_a_name_is_typed_in_the_list(session: Session, section: DancersSection) -> None:
    add(section)
    section.list.setFocus()
    QTest.keyClick(section.list, Qt.Key.Key_F2)
    editor = child(section.list, QLineEdit)
    editor.setText("Ｙｕｋｉ 1/2")
    QTest.keyClick(editor, Qt.Key.Key_Return)
    QApplication.processEvents()
    assert session.project.dancers[0].name == "Ｙｕｋｉ 1/2"
    QApplication.processEvents()
    session.document.undo()
    assert names(section) == [session.project.dancers[0].name] != ["Ｙｕｋｉ 1/2"]


def names(section: DancersSection) -> list[str]:
    return [section.list.rows.item(row).text() for row in range(section.list.rows.rowCount())]


def row_point(section: DancersSection, row: int) -> QPoint:
    return section.list.visualRect(section.list.rows.index(row, 0)).center()


def test_a_name_that_cannot_be_is_refused_and_the_old_one_shown(
    session: Session, section: DancersSection, qtbot: QtBot
) -> None:
    add(section)
    reported: list[Message] = []
    session.noticed.connect(lambda message, _: reported.append(message))
    before = names(section)
    QTest.mouseDClick(section.list.viewport(), Qt.MouseButton.LeftButton, pos=row_point(section, 0))
    editor = child(section.list, QLineEdit)
    editor.setText("  ")
    QTest.keyClick(editor, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: bool(reported))
    qtbot.waitUntil(lambda: names(section) == before)
    assert [message.id for message in reported] == ["player.no_name"]
    assert [dancer.name for dancer in session.project.dancers] == before
    assert len(session.document.done) == 1


def test_a_click_selects_and_a_drag_or_alt_with_the_arrows_reorders(session: Session, section: DancersSection) -> None:
    for _ in range(3):
        add(section)
    first, second, third = (dancer.id for dancer in session.project.dancers)
    places = {dancer.id: dancer.stage for dancer in session.project.dancers}
    steps = len(session.document.done)
    view = section.list.viewport()

    def order() -> list[str]:
        return [dancer.id for dancer in session.project.dancers]

    QTest.mouseClick(view, Qt.MouseButton.LeftButton, pos=row_point(section, 0))
    assert section.dancer is session.project.dancers[0]
    drag_to(view, row_point(section, 0), row_point(section, 1) + QPoint(0, 8))
    assert order() == [second, first, third]
    assert section.dancer is session.project.dancer(first)
    assert section.list.currentIndex().row() == 1
    QTest.keyClick(section.list, Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)
    assert order() == [second, third, first]
    QTest.keyClick(section.list, Qt.Key.Key_Down, Qt.KeyboardModifier.AltModifier)
    assert order() == [second, third, first]
    QTest.keyClick(section.list, Qt.Key.Key_Up)
    assert section.dancer is session.project.dancer(third)
    drag_to(view, row_point(section, 1), row_point(section, 1) + QPoint(0, 8))
    assert {dancer.id: dancer.stage for dancer in session.project.dancers} == places
    assert [step.name.id for step in session.document.done[steps:]] == ["edit.move_dancers"] * 2
    session.document.undo()
    session.document.undo()
    assert order() == [first, second, third]
    assert names(section) == [session.project.dancer(id).name for id in order()]


def test_the_dancer_after_the_one_who_goes_is_selected(session: Session, section: DancersSection) -> None:
    for _ in range(3):
        add(section)
    first, second, third = session.project.dancers
    for selected, left in ((second, third), (third, first)):
        session.set_dancer(selected.id)
        click(section, "dancers_remove_button")
        assert section.dancer == left
    assert session.project.dancers == (first,)


def test_a_choreography_that_is_gone_leaves_the_section_usable(
    session: Session, section: DancersSection, tmp_path: Path
) -> None:
    section.add(str(tmp_path / "gone.choreography"))
    assert section.dancer is not None
    source = child(section, Combo, "dancer_source")
    assert source.count() == 1
    click(section, "dancers_remove_button")
    assert not session.project.dancers


def test_a_dancer_is_dragged_and_turned_on_the_stage_and_the_players_stay(
    session: Session, section: DancersSection, qtbot: QtBot
) -> None:
    add(section)
    add(section)
    stage = StageSection(session)
    qtbot.addWidget(stage)
    stage.resize(320, 320)
    show_in_front(stage)
    first, second = session.project.dancers
    players = session.project.players
    view = stage.view
    start = view.point(first.stage.x_m, first.stage.z_m).toPoint()
    drag_to(view, start, start + QPoint(-40, 0))
    assert session.dancer.id == first.id
    assert section.list.currentIndex().data() == first.name
    moved = session.project.dancer(first.id)
    assert moved.stage.x_m < first.stage.x_m - 0.2
    assert moved.stage.z_m == pytest.approx(first.stage.z_m, abs=0.02)
    nose = view.nose_point(moved).toPoint()
    drag_to(view, nose, nose + QPoint(30, -40))
    assert session.project.dancer(first.id).stage.turn_rad > 1.0
    assert session.project.dancer(second.id) == second
    assert session.project.players is players
    view.setFocus()
    QTest.keyClick(view, Qt.Key.Key_Up)
    assert session.project.dancer(first.id).stage.z_m == pytest.approx(moved.stage.z_m - 0.05, abs=1e-3)
    assert [step.name.id for step in session.document.done][-3:] == ["edit.dancer_place"] * 3
    for _ in range(3):
        session.document.undo()
    assert session.project.dancer(first.id) == first


def drag_to(view: QWidget, start: QPoint, end: QPoint) -> None:
    left = Qt.MouseButton.LeftButton
    QTest.mousePress(view, left, Qt.KeyboardModifier.NoModifier, start)
    for step in (1, 2, 3, 4):
        place = start + (end - start) * (step / 4)
        event = QMouseEvent(
            QEvent.Type.MouseMove, QPointF(place), QPointF(view.mapToGlobal(place)), Qt.MouseButton.NoButton, left,
            Qt.KeyboardModifier.NoModifier,
        )  # fmt: skip
        QApplication.sendEvent(view, event)
    QTest.mouseRelease(view, left, Qt.KeyboardModifier.NoModifier, end)
