"""Instruments and their fingerings edited by mouse and keys, and the written files."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, QRectF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel, QLineEdit, QListWidget, QPushButton, QTableWidget
from pytestqt.qtbot import QtBot
from shiboken6 import isValid

import instrument_maps.library as library
from app.editor.library_watch import watch_instruments
from app.editor.session import Session
from instrument_maps.key_chart import key_chart
from instrument_maps.load import bundled_maps
from tests.gui.conftest import delete_now
from tests.support.pipe import add
from tests.support.windows import child, show_in_front
from widgets.common.fingering_diagram import FingeringDiagram
from widgets.dialogs.instrument_map import CENTS, LABEL, TAGS, InstrumentsDialog

D5, HIGH = 74, 84
TRUMPET = bundled_maps()["trumpet_Bb"]


class Page:
    """The dialog with the user's actions."""

    def __init__(self, session: Session, qtbot: QtBot) -> None:
        self.dialog = InstrumentsDialog(session)
        self.qtbot = qtbot
        show_in_front(self.dialog)
        self.table = self.dialog.findChild(QTableWidget, "instruments_fingerings")
        self.list = self.dialog.findChild(QListWidget, "instruments_list")
        self.diagram = self.dialog.findChild(FingeringDiagram, "instruments_diagram")
        self.problem = self.dialog.findChild(QLabel, "instruments_problem")

    def button(self, name: str) -> QPushButton:
        return child(self.dialog, QPushButton, f"instruments_{name}")

    def click(self, name: str) -> None:
        assert self.button(name).isEnabled(), name
        QTest.mouseClick(self.button(name), Qt.MouseButton.LeftButton)

    def choose(self, written: int, rank: int = 1) -> None:
        draft = self.dialog.draft
        row = [(one.written_pitch, one.rank) for one in draft.table].index((written, rank))
        self.table.scrollToItem(self.table.item(row, LABEL))
        box = self.table.visualItemRect(self.table.item(row, LABEL))
        QTest.mouseClick(self.table.viewport(), Qt.MouseButton.LeftButton, pos=box.center())

    def type(self, column: int, text: str) -> None:
        """Type into the selected row."""
        self.table.setCurrentCell(self.table.currentRow(), column)
        QTest.keyClick(self.table, Qt.Key.Key_F2)
        line = self.line()
        line.selectAll()
        QTest.keyClicks(line, text)
        QTest.keyClick(line, Qt.Key.Key_Return)
        delete_now()

    def line(self) -> QLineEdit:
        """Line edit that is open in the table."""
        (line,) = self.table.viewport().findChildren(QLineEdit)
        return line

    def labels(self, written: int) -> list[str]:
        draft = self.dialog.draft
        assert draft is not None
        return [one.label for one in draft.table if one.written_pitch == written]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    own = tmp_path / "own"
    own.mkdir()
    monkeypatch.setenv(library.FOLDER_VARIABLE, str(own))
    monkeypatch.setattr(library.LIBRARY, "last", None)
    return own


@pytest.fixture
def page(session: Session, qtbot: QtBot, folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Page]:
    monkeypatch.setattr(InstrumentsDialog, "ask", lambda dialog, count: "discard")
    add(folder)
    watch_instruments(session)
    made = Page(session, qtbot)
    yield made
    if isValid(made.dialog):
        made.dialog.ask = lambda count: "discard"
        made.dialog.close()


def test_it_opens_on_the_instrument_of_the_player_in_front_and_lists_all(page: Page) -> None:
    assert page.dialog.draft.instrument is TRUMPET
    assert page.list.count() == len(bundled_maps()) + 1
    assert page.table.rowCount() == len(TRUMPET.fingerings)
    page.choose(D5, 2)
    assert {name for name, value in page.diagram.values.items() if value} == set(TRUMPET.fingerings_for(72)[1].controls)


def test_the_signs_of_a_fingering_have_names_under_the_mouse_and_beside_the_chart(page: Page) -> None:
    page.dialog.choose("bassoon")
    row = next(row for row in range(page.table.rowCount()) if page.table.item(row, LABEL).text() == "L1 L2 Lt_w")
    assert page.table.item(row, LABEL).toolTip() == "whisper key + L1·2"
    page.table.setCurrentCell(row, LABEL)
    assert page.diagram.names == ["whisper key", "L1·2"]


def test_a_change_is_saved_as_ones_own_played_and_taken_back(page: Page, session: Session, folder: Path) -> None:
    before = page.labels(D5)
    page.choose(D5, 2)
    page.click("up")
    assert page.labels(D5) == [before[1], before[0], *before[2:]]
    page.type(CENTS, "-12,5")
    page.type(TAGS, "fast, forte")
    page.click("save")
    said = tomllib.loads((folder / "trumpet_Bb.toml").read_text("utf-8"))
    assert said["extends"] == said["id"] == "trumpet_Bb"
    assert said["fingerings"][0] == {
        "written_pitch": D5, "rank": 1, "label": before[1], "cents": -12.5, "tags": ["fast", "forte"],
        "correction": dict(TRUMPET.fingerings_for(72)[1].correction),
    }  # fmt: skip
    now = library.find_map("trumpet_Bb")
    assert now.fingerings_for(72)[0].label == before[1]
    assert not page.button("save").isEnabled()
    # Undo goes on after saving; and reverting leaves no file behind.
    page.click("undo")
    assert page.button("save").isEnabled()
    page.click("revert_all")
    page.click("save")
    assert not (folder / "trumpet_Bb.toml").exists()
    assert library.find_map("trumpet_Bb") is TRUMPET


def test_what_cannot_be_is_reported_beside_it_and_changes_nothing(page: Page) -> None:
    page.choose(D5)
    before = page.labels(D5)
    page.type(LABEL, "14")
    assert "'14'" in page.problem.text()
    page.type(LABEL, before[1])
    assert "already" in page.problem.text()
    page.type(CENTS, "flat")
    assert "flat" in page.problem.text()
    assert page.labels(D5) == before
    assert not page.button("undo").isEnabled()
    # A valid label that is not a harmonic of the tube stays for correction and is not saved.
    page.type(LABEL, "2 3")
    assert "harmonic" in page.problem.text()
    assert not page.button("save").isEnabled()
    QTest.keySequence(page.dialog, "Ctrl+Z")
    assert page.labels(D5) == before
    assert page.problem.text() == ""


def test_alternates_come_and_go_and_every_step_is_undone(page: Page) -> None:
    page.choose(D5)
    page.click("add")
    assert "already in the table" in page.problem.text()  # no other harmonic exists there
    page.choose(HIGH)
    before = page.labels(HIGH)
    page.click("add")
    added = page.labels(HIGH)
    assert added[: len(before)] == before
    assert len(added) == len(before) + 1
    QTest.keyClick(page.line(), Qt.Key.Key_Escape)
    page.click("remove")
    assert page.labels(HIGH) == before
    page.click("undo")
    assert page.labels(HIGH) == added
    page.click("redo")
    assert page.labels(HIGH) == before


def key_boxes(page: Page) -> dict[str, QRectF]:
    """Boxes of the drawn keys by their signs."""
    place, draft = page.diagram.chart_place, page.dialog.draft
    return {key.control.label: place.box(key) for key in key_chart(draft.instrument).keys}


def test_keys_are_clicked_in_the_drawing_half_holes_too(page: Page) -> None:
    page.dialog.choose("pipe")
    page.choose(72)
    start = page.labels(72)[0].split()

    def click(label: str) -> None:
        at = key_boxes(page)[label].center().toPoint()
        QTest.mouseClick(page.diagram, Qt.MouseButton.LeftButton, pos=QPoint(at.x(), at.y()))

    click("G")
    assert page.labels(72)[0].split() == sorted({*start, "G"} if "G" not in start else {*start} - {"G"})
    click("G")
    assert page.labels(72)[0].split() == start
    assert "L1" in start
    click("L1")
    assert "L1h" in page.labels(72)[0].split()
    click("L1")
    assert not {"L1", "L1h"} & set(page.labels(72)[0].split())


def test_the_chart_has_the_left_hand_above_the_right_and_nothing_under_another(page: Page) -> None:
    page.dialog.choose("pipe")
    boxes = key_boxes(page)
    assert set(boxes) == {"L1", "L2", "L3", "R1", "R2", "R3", "E", "F", "G", "C", "D", "T", "Reg"}
    column = [boxes[label] for label in ("L1", "L2", "L3", "R1", "R2", "R3")]
    assert all(above.bottom() < below.top() for above, below in pairwise(column))
    assert len({box.center().x() for box in column}) == 1
    assert boxes["T"].right() < boxes["L1"].left()
    assert boxes["C"].left() > boxes["L1"].right()
    reported = list(boxes.values())
    assert not any(one.intersects(other) for place, one in enumerate(reported) for other in reported[:place])
    for width in (120, 200, 700):
        page.diagram.resize(width, page.diagram.height())
        assert all(box.left() >= 0 and box.right() <= width for box in key_boxes(page).values())


def test_closing_asks_for_what_is_not_saved(page: Page, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page.choose(D5, 2)
    page.click("up")
    monkeypatch.setattr(page.dialog, "ask", lambda count: "cancel")
    page.click("close")
    assert page.dialog.isVisible()
    monkeypatch.setattr(page.dialog, "ask", lambda count: "save")
    QTest.keyClick(page.dialog, Qt.Key.Key_Escape)
    assert not page.dialog.isVisible()
    assert (folder / "trumpet_Bb.toml").exists()
