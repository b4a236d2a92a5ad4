"""Outfits in the panel of players, by mouse and keys: for one player, for several, and for everyone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu, QPushButton

from app.editor.session import Session
from app.errors import Message
from app.project.edit.players import change
from app.rig.people.wardrobe import OutfitChoice
from app.shell.commands.players import ACTIONS
from tests.gui.players.conftest import ShowPlayers
from tests.support.wardrobe import wardrobe_in, write_outfit
from tests.support.windows import child
from widgets.common.combo import Combo
from widgets.players.panel import PlayersPanel


@pytest.fixture(autouse=True)
def suits(tmp_path: Path) -> Iterator[None]:
    write_outfit(tmp_path / "test_suit.glb")
    with wardrobe_in(tmp_path):
        yield


@pytest.fixture
def panel(session: Session, show_players: ShowPlayers, suits: None) -> PlayersPanel:
    return show_players(session)


def outfits(session: Session) -> list[OutfitChoice]:
    return [player.outfit for player in session.project.players]


def choose(panel: PlayersPanel, row: int) -> None:
    combo = child(panel, Combo, "player_outfit")
    combo.setFocus()
    QTest.keyClick(combo, Qt.Key.Key_Home if row == 0 else Qt.Key.Key_End)


def test_one_player_then_several_are_dressed_and_undressed(session: Session, panel: PlayersPanel) -> None:
    combo = child(panel, Combo, "player_outfit")
    assert [combo.itemText(row) for row in range(combo.count())] == ["Own clothes", "Test suit"]
    session.set_players((session.project.players[0].id,))
    choose(panel, 1)
    assert outfits(session)[0] == OutfitChoice("test_suit")
    session.set_players(tuple(player.id for player in session.project.players))
    assert combo.shown is None, "they differ"
    choose(panel, 1)
    assert set(outfits(session)) == {OutfitChoice("test_suit")}
    choose(panel, 0)
    assert set(outfits(session)) == {OutfitChoice()}
    for _ in range(3):
        session.document.undo()
    assert set(outfits(session)) == {OutfitChoice()}
    assert not session.document.done


def test_a_colour_of_the_outfit_is_chosen_with_the_mouse_and_taken_back(session: Session, panel: PlayersPanel) -> None:
    swatch = child(panel, QPushButton, "player_outfit_main")
    session.set_players(tuple(player.id for player in session.project.players[:2]))
    assert not swatch.isVisible(), "clothes of their own have the person's colours"
    choose(panel, 1)
    assert swatch.isVisible()
    assert not child(panel, QPushButton, "player_outfit_accent").isVisible(), "this outfit has no third colour"
    QTest.mouseClick(swatch, Qt.MouseButton.LeftButton)
    menu = QApplication.activePopupWidget()
    assert isinstance(menu, QMenu)
    green = menu.actions()[4]
    QTest.mouseClick(menu, Qt.MouseButton.LeftButton, pos=menu.actionGeometry(green).center())
    colour = session.tokens.players[2]
    assert outfits(session)[:3] == [OutfitChoice("test_suit", main=colour)] * 2 + [OutfitChoice()]
    choose(panel, 0)
    choose(panel, 1)
    assert outfits(session)[0] == OutfitChoice("test_suit"), "another outfit comes in its own colours"


def test_everyone_is_dressed_like_the_active_player(session: Session, panel: PlayersPanel) -> None:
    session.set_players((session.project.players[1].id,))
    choose(panel, 1)
    row = next(action for action in ACTIONS if action.id == "players.dress_everyone")
    row.run(session)
    assert set(outfits(session)) == {OutfitChoice("test_suit")}
    session.document.undo()
    assert set(outfits(session)) == {OutfitChoice("test_suit"), OutfitChoice()}


def test_a_figure_of_the_user_s_own_has_no_choice_and_the_reason_is_said(session: Session, panel: PlayersPanel) -> None:
    first = session.project.players[0].id
    session.set_players((first,))
    combo = child(panel, Combo, "player_outfit")
    assert combo.isEnabled()
    name = Message("edit.player_character", {"of": "x"})
    session.attempt(name, lambda project: change(project, [first], character_id="of_my_own"))
    assert not combo.isEnabled()
    assert "own" in combo.toolTip()
