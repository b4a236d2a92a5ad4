"""Folded sections stay folded, also after a restart of the editor."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.editor.session import Session
from app.editor.settings import Settings
from tests.gui.players.conftest import ShowPlayers
from tests.support.windows import child
from widgets.common.section import Section
from widgets.players.panel import PlayersPanel


def section(panel: PlayersPanel, name: str) -> Section:
    return child(panel, Section, name)


def test_a_folded_part_is_remembered_by_name(session: Session, show_players: ShowPlayers, tmp_path: Path) -> None:
    panel = show_players(session)
    assert session.folded == {}
    QTest.mouseClick(section(panel, "players_breath").header, Qt.MouseButton.LeftButton)
    header = section(panel, "players_presets").header
    header.setFocus()
    QTest.keyClick(header, Qt.Key.Key_Right)
    assert session.folded == {"players_breath": True, "players_presets": False}
    kept = Settings(tmp_path / "editor.toml")
    kept.folded = dict(session.folded)
    kept.sync()
    for name, folded in Settings(tmp_path / "editor.toml").folded.items():
        session.set_folded(name, folded)
    again = show_players(session)
    assert not section(again, "players_breath").is_open
    assert section(again, "players_presets").is_open
    assert section(again, "players_motion").is_open
