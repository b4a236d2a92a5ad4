"""An inspector whose session plans immediately after every edit."""

from __future__ import annotations

from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.performance.ensemble import Performance
from app.project import presets
from app.project.undoable_document import Change
from tests.support.windows import show_in_front
from widgets.inspector.panel import InspectorPanel


@pytest.fixture
def planned(session: Session) -> Session:
    def follow(change: Change) -> None:
        performance = Performance(change.after, session.performance)
        performance.prepare()
        session.set_performance(performance)

    session.performance.prepare()
    session.changed.connect(follow)
    return session


@pytest.fixture
def panel(planned: Session, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> InspectorPanel:
    monkeypatch.setattr(presets, "expression_folder", lambda: tmp_path / "expressions")
    made = InspectorPanel(planned)
    qtbot.addWidget(made)
    made.resize(320, 1000)
    show_in_front(made)
    return made
