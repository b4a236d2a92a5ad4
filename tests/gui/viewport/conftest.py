"""A viewport of the bundled quartet, with motion computed on request."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt
import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.performance.chunks import Pose
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.project.model import Project
from tests.gui.conftest import planned_quartet
from tests.support.windows import show
from widgets.viewport.panel import ViewportPanel

AT_S = 6.0
SIZE = (480, 270)

Picture = npt.NDArray[np.uint8]


_LIVE: dict[int, tuple[Project, LiveMotion]] = {}
"""Poses by project; projects are kept, so that their identity is not reused."""


def _live(project: Project) -> LiveMotion:
    if id(project) not in _LIVE:
        _LIVE[id(project)] = (project, LiveMotion(Performance(project, planned_quartet())))
    return _LIVE[id(project)][1]


class MadeNow:
    """Poses of a session's current project, computed synchronously."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self.missing = False

    def poses(self, player_ids: Sequence[str], time_s: float) -> list[Pose | None]:
        """None until motion is reported as available."""
        return [None if self.missing else self.pose_now(player_id, time_s) for player_id in player_ids]

    def pose_now(self, player_id: str, time_s: float) -> Pose | None:
        """Pose of the newest project."""
        return _live(self._session.project).pose_now(player_id, time_s)


@pytest.fixture
def poses(session: Session) -> MadeNow:
    """Motion of the session."""
    return MadeNow(session)


@pytest.fixture
def viewport(qtbot: QtBot, session: Session, poses: MadeNow) -> ViewportPanel:
    """A visible viewport with the ensemble in it."""
    session.set_playhead(AT_S)
    panel = ViewportPanel(session, poses)
    qtbot.addWidget(panel)
    panel.resize(*SIZE)
    show(panel)
    assert panel.has_gl, panel.message()
    QApplication.processEvents()
    return panel


@pytest.fixture
def shot(viewport: ViewportPanel) -> Callable[..., Picture]:
    """Small picture of a view at a time."""

    def take(view: str | None = None, time_s: float = AT_S) -> Picture:
        return viewport.render_image(320, 180, time_s, view)

    return take
