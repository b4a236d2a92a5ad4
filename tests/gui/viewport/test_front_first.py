"""In a large cast, the first selected player's figure is loaded first."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.project.model import Project
from tests.gui.conftest import quartet_project
from tests.gui.viewport.conftest import AT_S, MadeNow
from tests.support.doubled import flutist
from widgets.viewport import scene as module
from widgets.viewport.pose_tool import PoseTool
from widgets.viewport.scene import ViewportScene

pytestmark = pytest.mark.drawn


@pytest.mark.parametrize(("project", "front", "few"), [(quartet_project, 2, 3), (flutist, 1, 1)])
def test_of_many_who_is_in_front_is_on_the_stage_before_the_others_are_loaded(
    qtbot: QtBot,
    session: Session,
    poses: MadeNow,
    monkeypatch: pytest.MonkeyPatch,
    project: Callable[[], Project],
    front: int,
    few: int,
) -> None:
    opened, stages, shown = project(), list[list[str]](), list[bool]()
    player = opened.players[front]
    session.document.open(opened)
    session.set_players((player.id,))
    session.set_playhead(AT_S)
    scene = ViewportScene(session, poses, PoseTool(session))
    everyone = [one.id for musician in opened.bodies for one in opened.played_by(musician)]

    def staged() -> None:
        stage = scene.stage
        assert stage is not None
        stages.append([member.player_id for member in stage.members])
        scene.pose(AT_S)
        shown.append(bool(stage.shown.all()))

    scene.staged.connect(staged)
    scene.load()
    assert stages == [everyone], "few are loaded at once"
    scene.load()
    assert len(stages) == 1, "nothing is loaded again"
    stages.clear()
    monkeypatch.setattr(module, "FEW", few)
    scene = ViewportScene(session, poses, PoseTool(session))
    scene.staged.connect(staged)
    scene.load()
    assert stages == [[one.id for one in opened.played_by(player)], everyone]
    assert all(shown)
    assert scene.loaded is not None
    assert scene.loaded.crowd is not None


@pytest.mark.parametrize("moves", [True, False])
def test_the_others_are_loaded_once_it_moves_or_after_some_time(
    qtbot: QtBot, session: Session, poses: MadeNow, monkeypatch: pytest.MonkeyPatch, moves: bool
) -> None:
    monkeypatch.setattr(module, "FEW", 3)
    monkeypatch.setattr(module, "FRONT_MS", 10**6 if moves else 50)
    poses.missing = True
    scene = ViewportScene(session, poses, PoseTool(session))
    counts = list[int]()
    scene.staged.connect(lambda: counts.append(0 if scene.stage is None else len(scene.stage.members)))
    scene.load()
    scene.pose(AT_S)
    assert counts == [1]
    if moves:
        poses.missing = False
        scene.pose(AT_S)
    qtbot.waitUntil(lambda: counts == [1, len(session.project.players)])
    scene.pose(AT_S)
    assert len(counts) == 2, "nothing is loaded again"
