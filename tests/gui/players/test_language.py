"""The open players' panel changes its language."""

from __future__ import annotations

from PySide6.QtWidgets import QApplication

from app.editor.session import Session
from tests.gui.japanese import english_in, speaking, texts_of
from tests.gui.players.conftest import ShowPlayers


def test_everything_is_japanese_at_once_and_english_again(session: Session, show_players: ShowPlayers) -> None:
    panel = show_players(session)
    english = texts_of(panel)
    with speaking():
        shown = texts_of(panel)
        assert not english_in(shown)
        assert "動きの大きさ" in shown
        assert panel.list.rows.rows[0].instrument == "トランペット（B♭管）"
    QApplication.processEvents()
    assert texts_of(panel) == english
