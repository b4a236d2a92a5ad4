"""Python's share of a picture during playback, by the number of players, without GL."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from statistics import median

import msgspec
import pytest
from pytestqt.qtbot import QtBot
from vispy.gloo.gl import use_gl

from app.editor.session import Session
from app.performance.chunks import Pose
from app.project.casting import Footprint, stage_seats
from app.project.model import Project
from tests.support.tasks import ImmediateTasks
from tests.unit.viewport.poses import live, quartet
from widgets.viewport.panel import ViewportPanel

FRAMES = 40


def calibration_s() -> float:
    """Time in seconds of a fixed amount of plain Python on this machine at present."""
    started = time.perf_counter()
    total = 0
    for number in range(200_000):
        total += number * number
    assert total
    return time.perf_counter() - started


def crowd(count: int) -> Project:
    """The quartet's players again and again, each at a place of their own."""
    project = quartet()
    places = stage_seats((Footprint(),) * count)
    players = tuple(
        msgspec.structs.replace(
            project.players[index % 4], id=f"player_{index}", name=f"Player {index + 1}", stage=places[index]
        )
        for index in range(count)
    )
    return replace(project, players=players)


class Ready:
    """Poses of a whole second computed in advance, since computing motion is measured elsewhere."""

    def __init__(self, project: Project) -> None:
        source = quartet().players
        self._poses = {
            (player.id, frame): live().pose_now(source[index % 4].id, 6.0 + frame / 60.0)
            for index, player in enumerate(project.players)
            for frame in range(FRAMES)
        }

    def poses(self, player_ids: Sequence[str], time_s: float) -> list[Pose | None]:
        return [self.pose_now(player_id, time_s) for player_id in player_ids]

    def pose_now(self, player_id: str, time_s: float) -> Pose | None:
        return self._poses[player_id, round((time_s - 6.0) * 60.0) % FRAMES]


@pytest.mark.bench
@pytest.mark.parametrize("count", [4, 12, 30, 50])
def test_frame(
    count: int,
    qtbot: QtBot,
    request: pytest.FixtureRequest,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    project = crowd(count)
    session = Session(project, ImmediateTasks())
    session.set_playhead(6.0)
    poses = Ready(project)
    started = time.perf_counter()
    panel = ViewportPanel(session, poses)
    loaded_s = time.perf_counter() - started
    qtbot.addWidget(panel)
    panel.resize(1280, 720)
    panel.show()
    qtbot.waitExposed(panel)
    canvas = panel._canvas
    assert canvas is not None
    panel.render_image(64, 36, 6.0)
    canvas.set_current()
    # Python's part of every command is done, but nothing reaches the card.
    monkeypatch.setattr("vispy.gloo.gl.dummy.DummyProxy.__call__", lambda *arguments: 0)
    use_gl("dummy")
    request.addfinalizer(lambda: use_gl("gl2"))
    costs: dict[str, list[float]] = {"poses": [], "draw": []}
    session.set_playing(True)
    for frame in range(FRAMES):
        began = time.perf_counter()
        session.set_playhead(6.0 + frame / 60.0)
        posed = time.perf_counter()
        canvas._draw(1280, 720)
        canvas.context.flush_commands()
        costs["poses"].append(posed - began)
        costs["draw"].append(time.perf_counter() - posed)
    unit = median(calibration_s() for _ in range(5))
    whole = median(a + b for a, b in zip(costs["poses"], costs["draw"], strict=True))
    with capsys.disabled():
        print(
            f"\n{count} players: {1000 * whole:.2f} ms of Python a frame "
            f"(poses and marks {1000 * median(costs['poses']):.2f}, drawing {1000 * median(costs['draw']):.2f}), "
            f"{whole / unit:.3f} of the calibration loop ({1000 * unit:.1f} ms); made ready in {loaded_s:.2f} s"
        )
