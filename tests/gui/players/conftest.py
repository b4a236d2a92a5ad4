"""The panel of players on screen."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.shell.theme import unstyled
from tests.support.windows import show_in_front
from widgets.players.panel import PlayersPanel

ShowPlayers = Callable[..., PlayersPanel]


@pytest.fixture
def show_players(qt_app: QApplication, qtbot: QtBot) -> ShowPlayers:
    """Function that shows the panel for a session in its current state."""

    def show(session: Session, height_px: int = 1200) -> PlayersPanel:
        with unstyled(qt_app):
            panel = PlayersPanel(session)
        qtbot.addWidget(panel)
        panel.resize(320, height_px)
        show_in_front(panel)
        return panel

    return show
