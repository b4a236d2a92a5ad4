"""Presets by mouse and keys."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit, QToolButton

from app.editor.session import Session
from app.project import presets
from app.project.edit.players import set_parameters
from tests.gui.players.conftest import ShowPlayers
from tests.support.windows import child
from widgets.common.combo import Combo
from widgets.common.section import Section


def test_a_preset_is_saved_applied_and_deleted(
    session: Session, show_players: ShowPlayers, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(presets, "preset_folder", lambda: tmp_path / "presets")
    panel = show_players(session, 1400)

    def click(name: str) -> None:
        QTest.mouseClick(child(panel, QToolButton, name), Qt.MouseButton.LeftButton)

    QTest.mouseClick(child(panel, Section, "players_presets").header, Qt.MouseButton.LeftButton)
    first, second, third, _ = (player.id for player in session.project.players)
    session.document.open(set_parameters(session.project, (first,), amplitude=0.2, sway=1.7, posture="seated"))
    field, combo = panel.findChild(QLineEdit, "preset_name"), panel.findChild(Combo, "preset_choice")
    assert field is not None
    assert combo is not None
    QTest.keyClicks(field, "Calm / seated")
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert combo.shown == "Calm / seated"
    session.set_players((second, third))
    seeds = [player.parameters.seed for player in session.project.players]
    click("preset_apply")
    for id in (second, third):
        parameters = session.project.player(id).parameters
        assert (parameters.amplitude, parameters.sway, parameters.posture) == (0.2, 1.7, "seated")
    assert [player.parameters.seed for player in session.project.players] == seeds
    assert len(session.document.done) == 1
    click("preset_delete")
    assert not presets.presets(tmp_path / "presets").items
    assert combo.shown is None
