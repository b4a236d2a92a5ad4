"""Dances of playing musicians, chosen by mouse and keys in the Players panel and compared with the project."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit, QToolButton
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.project.performers import Player
from tests.support.windows import child, show_in_front
from widgets.common.combo import Combo
from widgets.common.number_slider import NumberSlider
from widgets.players import body_dance
from widgets.players.parameters import ParameterSections


@pytest.fixture
def sections(session: Session, qtbot: QtBot, choreography: Path, monkeypatch: pytest.MonkeyPatch) -> ParameterSections:
    monkeypatch.setattr(body_dance, "ask_for_file", lambda *_: choreography)
    made = ParameterSections(session)
    qtbot.addWidget(made)
    made.resize(320, 900)
    session.players_changed.connect(made.show_players)
    session.changed.connect(lambda _: made.show_players())
    made.show_players()
    show_in_front(made)
    return made


def front(session: Session) -> Player:
    return session.project.player(session.players[0])


def combo(sections: ParameterSections) -> Combo:
    return child(sections, Combo, "parameter_choreography")


def slider(sections: ParameterSections, name: str) -> NumberSlider:
    return child(sections, NumberSlider, name)


def press(sections: ParameterSections, key: Qt.Key, times: int = 1) -> None:
    chosen = combo(sections)
    chosen.setFocus()
    for _ in range(times):
        QTest.keyClick(chosen, key)


def test_the_bundled_choreography_is_chosen_by_keys_and_undone(sections: ParameterSections, session: Session) -> None:
    assert combo(sections).shown == ""
    assert not slider(sections, "parameter_dance_amount").isVisible()
    press(sections, Qt.Key.Key_Down)
    assert front(session).parameters.choreography == "salsa"
    assert slider(sections, "parameter_dance_amount").isVisible()
    session.document.undo()
    assert front(session).parameters.choreography == ""
    assert combo(sections).shown == ""
    assert not slider(sections, "parameter_dance_amount").isVisible()
    session.document.redo()
    press(sections, Qt.Key.Key_Up)
    assert front(session).parameters.choreography == ""
    assert len(session.document.done) == 2


def test_a_file_is_chosen_and_stays_among_the_options(
    sections: ParameterSections, session: Session, choreography: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    press(sections, Qt.Key.Key_End)
    assert front(session).parameters.choreography == str(choreography)
    assert combo(sections).currentText() == "steps & more"
    assert str(choreography) in combo(sections).toolTip()
    # Closing the question without an answer changes nothing.
    monkeypatch.setattr(body_dance, "ask_for_file", lambda *_: None)
    before = session.project
    press(sections, Qt.Key.Key_End)
    assert session.project is before
    assert combo(sections).shown == str(choreography)


def test_a_file_that_is_no_choreography_is_refused(
    sections: ParameterSections, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(body_dance, "ask_for_file", lambda *_: Path("/music/tango.bvh"))
    refused: list[str] = []
    session.noticed.connect(lambda message, _: refused.append(message.id))
    before = session.project
    press(sections, Qt.Key.Key_End)
    assert session.project is before
    assert refused == ["dancer.no_choreography"]
    assert combo(sections).shown == ""


def test_amount_and_variation_of_several_players(sections: ParameterSections, session: Session) -> None:
    chosen = tuple(player.id for player in session.project.players[:2])
    session.set_players(chosen)
    press(sections, Qt.Key.Key_Down)
    amount = slider(sections, "parameter_dance_amount")
    amount.setFocus()
    QTest.keyClick(amount, Qt.Key.Key_Return)
    field = child(amount, QLineEdit)
    field.selectAll()
    QTest.keyClicks(field, "0.8")
    QTest.keyClick(field, Qt.Key.Key_Return)
    QTest.mouseClick(child(sections, QToolButton, "dance_dice"), Qt.MouseButton.LeftButton)
    one, two, other, *_ = (player.parameters for player in session.project.players)
    assert (one.choreography, one.dance_amount, two.dance_amount) == ("salsa", 0.8, 0.8)
    assert one.dance_variation > 0
    assert two.dance_variation > 0
    assert one.dance_variation != two.dance_variation
    assert slider(sections, "parameter_dance_variation").mixed
    assert (other.choreography, other.dance_amount, other.dance_variation) == ("", 0.5, 0)
    QTest.mouseDClick(amount, Qt.MouseButton.LeftButton, pos=QPoint(30, 10))
    assert front(session).parameters.dance_amount == 0.5
    # For players with different values neither is shown.
    session.set_players((chosen[0], session.project.players[2].id))
    assert combo(sections).shown is None
