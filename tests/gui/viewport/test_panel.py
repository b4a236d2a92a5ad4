"""The viewport by mouse and keys: pictures, views, selection, the pose tool."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import inf
from pathlib import Path
from typing import cast

import msgspec
import numpy as np
import numpy.typing as npt
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt, QTimer
from PySide6.QtGui import QImage, QMouseEvent, QWheelEvent
from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtWidgets import QApplication, QMenu, QToolButton, QWidget
from pytestqt.qtbot import QtBot
from vispy import gloo

from app.choreography.model_file import write_model
from app.editor.design_tokens import LIGHT
from app.editor.edit_names import edit_of_parameter
from app.editor.session import Session
from app.editor.settings import Settings
from app.errors import AppError, Message
from app.performance.chunks import Pose
from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import PoseCorrection
from app.project.camera_bookmarks import VIEWS
from app.project.casting import StagePosition
from app.project.edit.dancers import add_dancer, place_dancers, set_body_dance
from app.project.edit.piece import new_piece
from app.project.model import Project
from app.shell.action import Action
from app.shell.actions import ActionTable
from tests.gui.conftest import planned_quartet, quartet_project
from tests.gui.viewport.conftest import AT_S, SIZE, MadeNow
from tests.support.dances import model
from tests.support.windows import child, show
from widgets.viewport.canvas import Canvas, pixels
from widgets.viewport.framing import corners
from widgets.viewport.panel import ViewportPanel
from widgets.viewport.texture_maps import texture_of_pixels

ROOT = Path(__file__).parents[3]
Shot = Callable[..., npt.NDArray[np.uint8]]


def canvas(viewport: ViewportPanel) -> QWidget:
    widget = viewport.canvas_widget()
    assert widget is not None
    return widget


def send(
    widget: QWidget,
    kind: QEvent.Type,
    at: QPointF,
    button: Qt.MouseButton = Qt.MouseButton.LeftButton,
    modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier,
) -> None:
    """Send a mouse event with fractional pixels and modifiers, which QTest does not support."""
    held = Qt.MouseButton.NoButton if kind == QEvent.Type.MouseButtonRelease else button
    own = Qt.MouseButton.NoButton if kind == QEvent.Type.MouseMove else button
    event = QMouseEvent(kind, at, QPointF(widget.mapToGlobal(at)), own, held, modifiers)
    QApplication.sendEvent(widget, event)


def drag(
    widget: QWidget,
    start: QPointF,
    step: QPointF,
    button: Qt.MouseButton = Qt.MouseButton.LeftButton,
    modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier,
    release: bool = True,
) -> None:
    send(widget, QEvent.Type.MouseButtonPress, start, button, modifiers)
    for share in (0.25, 0.5, 0.75, 1.0):
        send(widget, QEvent.Type.MouseMove, start + share * step, button, modifiers)
    if release:
        send(widget, QEvent.Type.MouseButtonRelease, start + step, button, modifiers)


def place_of(viewport: ViewportPanel, row: int, joint: str = "chest") -> QPointF:
    """Point of a joint in the picture."""
    assert viewport.scene.loaded is not None
    size = canvas(viewport).size()
    (place,), _ = viewport.camera.project(viewport.scene.stage.joint_m(row, joint), size.width(), size.height())
    return QPointF(*place)


def differing(one: npt.NDArray[np.uint8], other: npt.NDArray[np.uint8]) -> int:
    """Mask of the pixels that clearly differ."""
    return int((np.abs(one.astype(int) - other.astype(int)).max(axis=2) > 12).sum())


# Pictures


def test_every_view_is_another_picture_and_the_same_picture_twice(shot: Shot) -> None:
    pictures = {view: shot(view) for view in VIEWS}
    for view, picture in pictures.items():
        assert picture.shape == (180, 320, 4)
        assert (picture[..., 3] == 255).all()
        assert picture[..., :3].std() > 8.0
        assert (shot(view) == picture).all(), view
    names = list(pictures)
    for first in names:
        for second in names[names.index(first) + 1 :]:
            assert differing(pictures[first], pictures[second]) > 2000


def test_a_valve_that_goes_down_is_seen(session: Session, viewport: ViewportPanel, poses: MadeNow) -> None:
    """The poses differ in one control only."""
    real = poses.pose_now(session.project.players[0].id, AT_S)
    assert real is not None

    class Pressed:
        value = 0.0

        def poses(self, player_ids: Sequence[str], time_s: float) -> object:
            return [self.pose_now(player_id, time_s) for player_id in player_ids]

        def pose_now(self, player_id: str, time_s: float) -> object:
            found = poses.pose_now(player_id, time_s)
            return replace(found, controls={**found.controls, "valve_1": self.value, "valve_2": self.value})

    pressed = Pressed()
    viewport.set_poses(pressed)
    up = viewport.render_image(640, 360, AT_S, "hands")
    pressed.value = 1.0
    down = viewport.render_image(640, 360, AT_S, "hands")
    assert 20 < differing(up, down) < 20000


def test_a_face_that_opens_its_mouth_is_seen(viewport: ViewportPanel, poses: MadeNow) -> None:
    class Agape:
        jaw = 0.0

        def poses(self, player_ids: Sequence[str], time_s: float) -> object:
            return [self.pose_now(player_id, time_s) for player_id in player_ids]

        def pose_now(self, player_id: str, time_s: float) -> object:
            found = poses.pose_now(player_id, time_s)
            return replace(found, morphs={**found.morphs, "jawOpen": self.jaw})

    agape = Agape()
    viewport.set_poses(agape)
    shut = viewport.render_image(640, 360, AT_S, "mouth")
    agape.jaw = 1.0
    wide = viewport.render_image(640, 360, AT_S, "mouth")
    assert differing(shut, wide) > 300


def test_players_move(shot: Shot) -> None:
    assert differing(shot("hands", 6.0), shot("hands", 6.4)) > 100


def test_the_picture_on_the_screen_is_that_of_the_file(viewport: ViewportPanel, session: Session) -> None:
    session.viewport.show("names", False)
    size = canvas(viewport).size()
    QApplication.processEvents()
    grabbed = viewport.grab().toImage()
    picture = viewport.render_image(size.width(), size.height(), AT_S)
    top = viewport.height() - size.height()
    shown = np.array(
        [
            [grabbed.pixelColor(x, top + y).getRgb()[:3] for x in range(0, size.width(), 16)]
            for y in range(0, size.height(), 16)
        ]
    )
    assert np.median(np.abs(shown.astype(int) - picture[::16, ::16, :3].astype(int))) <= 4


def drawn_small(viewport: ViewportPanel, texture: object) -> npt.NDArray[np.uint8]:
    """Texture (16, 16, 4) as drawn in a few pixels."""
    vertex = "attribute vec2 at; varying vec2 uv; void main() {uv = at * 0.5 + 0.5; gl_Position = vec4(at, 0.0, 1.0);}"
    fragment = "uniform sampler2D map; varying vec2 uv; void main() {gl_FragColor = texture2D(map, uv);}"
    program = gloo.Program(vertex, fragment)
    program["at"], program["map"] = [(-1, -1), (1, -1), (-1, 1), (1, 1)], texture
    native = cast(QOpenGLWidget, canvas(viewport))
    native.makeCurrent()
    target = gloo.FrameBuffer(gloo.Texture2D((16, 16, 4)))
    with target:
        gloo.set_viewport(0, 0, 16, 16)
        gloo.set_state(depth_test=False, blend=False, cull_face=False)
        program.draw("triangle_strip")
        shown: npt.NDArray[np.uint8] = target.read()
    native.doneCurrent()
    return shown


def test_a_texture_finer_than_the_picture_is_seen_as_its_mean(viewport: ViewportPanel) -> None:
    # Columns of which a picture without smaller copies meets only some: brows and hair would be flecks.
    stripes = np.zeros((256, 256, 4), np.uint8)
    stripes[:, ::16] = 255
    shown = drawn_small(viewport, texture_of_pixels(stripes))
    assert np.abs(shown.astype(int) - 255 // 16).max() <= 3


def test_a_picture_of_another_moment_leaves_the_window_as_it_was(viewport: ViewportPanel) -> None:
    assert viewport.scene.loaded is not None
    before = viewport.scene.stage.bones.copy()
    viewport.render_image(64, 36, 10.0, "hands")
    assert (viewport.scene.stage.bones == before).all()


def test_the_light_theme_is_lighter(shot: Shot, session: Session) -> None:
    dark = shot("ensemble")
    session.set_tokens(LIGHT)
    assert shot("ensemble")[..., :3].mean() > dark[..., :3].mean() + 60


def test_who_is_selected_is_seen(shot: Shot, session: Session) -> None:
    session.viewport.show("names", False)
    first = shot("ensemble")
    session.set_players((session.project.players[2].id,))
    assert differing(first, shot("ensemble")) > 40


@pytest.mark.parametrize("what", ["wireframe", "skeleton", "contacts", "names"])
def test_what_is_shown_beside_the_players_is_seen(what: str, shot: Shot, session: Session) -> None:
    session.viewport.show(what, False)
    view = "hands" if what == "contacts" else "ensemble"
    without = shot(view)
    session.viewport.show(what, True)
    assert differing(without, shot(view)) > 60


def test_seated_players_have_chairs_which_can_be_hidden(shot: Shot, session: Session) -> None:
    standing = shot("ensemble")
    project = session.project
    seated = tuple(
        msgspec.structs.replace(player, parameters=msgspec.structs.replace(player.parameters, posture="seated"))
        for player in project.players
    )
    session.apply(edit_of_parameter(project, "posture", session.players), replace(project, players=seated))
    sitting = shot("ensemble")
    assert differing(standing, sitting) > 400
    session.viewport.show("props", False)
    assert differing(sitting, shot("ensemble")) > 100
    session.viewport.show("props", True)
    assert differing(sitting, shot("ensemble")) == 0


def test_who_is_moved_on_the_stage_stands_there_at_once(viewport: ViewportPanel, session: Session) -> None:
    loaded = viewport.scene.loaded
    assert loaded is not None
    player = session.project.players[0]
    moved = msgspec.structs.replace(player, stage=msgspec.structs.replace(player.stage, x_m=player.stage.x_m - 1.0))
    session.apply(
        Message("edit.place_players", {"of": "Trumpet 1"}),
        replace(session.project, players=(moved, *session.project.players[1:])),
    )
    assert viewport.scene.loaded.shapes is loaded.shapes
    before, after = loaded.stage.joint_m(0, "head"), viewport.scene.stage.joint_m(0, "head")
    assert after - before == pytest.approx([-1.0, 0.0, 0.0], abs=1e-6)


def test_the_windows_thread_copies_no_figures(
    session: Session, poses: MadeNow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Drawing data of all players are made with the figures in the background, and freed once they are sent."""
    session.set_playhead(AT_S)
    panel = ViewportPanel(session, poses)
    qtbot.addWidget(panel)
    loaded = panel.scene.loaded
    assert {row for row, _ in loaded.crowd.parts} == set(range(len(loaded.stage.members)))
    made = []
    monkeypatch.setattr("widgets.viewport.shapes.crowd", lambda parts: made.append(parts))
    panel.resize(*SIZE)
    show(panel)
    panel.render_image(64, 36, AT_S)
    player = session.project.players[0]
    place = msgspec.structs.replace(player.stage, x_m=player.stage.x_m + 0.4)
    players = (msgspec.structs.replace(player, stage=place), *session.project.players[1:])
    session.apply(Message("edit.place_players", {"of": "Trumpet 1"}), replace(session.project, players=players))
    panel.render_image(64, 36, AT_S)
    assert panel.has_gl, panel.message()
    assert panel.scene.loaded is not None
    assert panel.scene.loaded is not loaded
    assert panel.scene.loaded.crowd is None
    assert made == []


def test_no_one_is_drawn_before_there_is_a_pose(qtbot: QtBot, session: Session, poses: MadeNow) -> None:
    poses.missing = True
    session.set_playhead(AT_S)
    panel = ViewportPanel(session, poses)
    qtbot.addWidget(panel)
    panel.resize(320, 240)
    panel.show()
    assert panel.message()
    poses.missing = False
    qtbot.waitUntil(lambda: not panel.message())


def test_players_who_appear_one_by_one_are_not_each_drawn_at_once_where_a_picture_takes_long(
    qtbot: QtBot, session: Session, poses: MadeNow
) -> None:
    ids = [player.id for player in session.project.players]
    there = ids[:1]

    class Appearing(MadeNow):
        def poses(self, player_ids: Sequence[str], time_s: float) -> list[Pose | None]:
            return [self.pose_now(one, time_s) if one in there else None for one in player_ids]

    session.set_playhead(AT_S)
    panel = ViewportPanel(session, Appearing(session))
    qtbot.addWidget(panel)
    panel.resize(320, 240)
    panel.show()
    qtbot.waitUntil(lambda: not panel.message())
    canvas = panel._canvas
    assert canvas is not None
    qtbot.waitUntil(lambda: canvas.drawing_s < inf)

    def shown() -> int:
        return sum(pose is not None for pose in panel.scene.poses().values())

    canvas.drawing_s = 1000.0
    there.append(ids[1])
    panel.poses_changed()
    assert shown() == 1
    canvas.drawing_s = 0.0
    panel.poses_changed()
    assert shown() == 2
    canvas.drawing_s = 1000.0
    there.extend(ids[2:])
    panel.poses_changed()
    assert shown() == len(ids), "no one is waited for"


# The camera


def test_keys_and_buttons_choose_views(qtbot: QtBot, viewport: ViewportPanel, session: Session) -> None:
    for view in VIEWS:
        button = child(viewport, QToolButton, f"viewport_view_{view}")
        button.click()
        assert session.viewport.view == view
        assert button.isChecked()
    session.viewport.set_view("side")
    assert viewport.findChild(QToolButton, "viewport_view_side").isChecked()


def test_dragging_orbits_pans_and_the_wheel_dollies(viewport: ViewportPanel) -> None:
    widget, middle = canvas(viewport), QPointF(20, 20)
    before = viewport.camera
    drag(widget, middle, QPointF(60, 30))
    turned = viewport.camera
    assert turned.yaw_rad < before.yaw_rad
    assert turned.pitch_rad > before.pitch_rad
    assert turned.target_m == before.target_m
    drag(widget, middle, QPointF(60, 30), Qt.MouseButton.MiddleButton)
    panned = viewport.camera
    assert panned.yaw_rad == turned.yaw_rad
    assert panned.target_m != turned.target_m
    drag(widget, middle, QPointF(-60, -30), modifiers=Qt.KeyboardModifier.ShiftModifier)
    assert viewport.camera.target_m == pytest.approx(turned.target_m)
    wheel = QWheelEvent(
        middle,
        middle,
        QPoint(),
        QPoint(0, 120),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(widget, wheel)
    assert viewport.camera.distance_m < panned.distance_m


@pytest.mark.parametrize("button", [Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton])
def test_control_and_a_drag_dolly(viewport: ViewportPanel, button: Qt.MouseButton) -> None:
    """For users without a wheel: pens have one button, and users of Blender and Maya use the middle one."""
    before = viewport.camera
    drag(canvas(viewport), QPointF(20, 60), QPointF(0, -40), button, Qt.KeyboardModifier.ControlModifier)
    assert viewport.camera == replace(before, distance_m=viewport.camera.distance_m)
    assert viewport.camera.distance_m < 0.95 * before.distance_m


def test_framing_keeps_the_direction_and_brings_the_player_in(viewport: ViewportPanel, session: Session) -> None:
    drag(canvas(viewport), QPointF(10, 10), QPointF(50, 0))
    session.set_players((session.project.players[3].id,))
    before = viewport.camera
    session.viewport.frame(True)
    after = viewport.camera
    assert after.yaw_rad == before.yaw_rad
    place = place_of(viewport, 3)
    size = canvas(viewport).size()
    assert abs(place.x() - size.width() / 2) < 0.2 * size.width()
    session.viewport.frame(False)
    assert viewport.camera.distance_m > after.distance_m


def test_framed_players_stay_in_a_picture_of_another_shape(viewport: ViewportPanel, session: Session) -> None:
    def shown() -> npt.NDArray[np.float64]:
        stage, size = viewport.scene.stage, canvas(viewport).size()
        assert stage is not None
        points = corners(stage, range(len(stage.members)))
        places, depths = viewport.camera.project(points, size.width(), size.height())
        assert (depths > 0.0).all()
        return 2.0 * places / (size.width(), size.height()) - 1.0

    drag(canvas(viewport), QPointF(10, 10), QPointF(50, 0))
    for act in (lambda: session.viewport.frame(False), lambda: viewport.resize(480, 640)):
        act()
        QApplication.processEvents()
        assert 0.85 < np.abs(shown()).max() < 1.0
    # As moved by the user since, it stays.
    drag(canvas(viewport), QPointF(10, 10), QPointF(50, 0))
    moved = viewport.camera
    viewport.resize(900, 300)
    QApplication.processEvents()
    assert viewport.camera == moved


def test_a_close_up_follows_the_hands_while_playing(qtbot: QtBot, viewport: ViewportPanel, session: Session) -> None:
    session.set_players((session.project.players[3].id,))
    session.viewport.set_view("hands")
    qtbot.wait(500)
    session.set_playing(True)
    stage = viewport.scene.stage
    before = np.asarray(viewport.camera.target_m)
    for time_s in np.arange(6.0, 9.0, 0.1):
        session.set_playhead(float(time_s))
        qtbot.wait(20)
    session.set_playing(False)
    qtbot.wait(900)
    hands = [stage.joint_m(3, side + name) for side in ("left", "right") for name in ("Hand", "MiddleProximal")]
    assert np.asarray(viewport.camera.target_m) == pytest.approx(np.mean(hands, axis=0), abs=0.01)
    assert np.linalg.norm(np.asarray(viewport.camera.target_m) - before) > 0.005


def test_a_view_fills_a_panel_that_is_resized_until_the_camera_is_moved_by_hand(
    qtbot: QtBot, viewport: ViewportPanel
) -> None:
    wide = viewport.camera
    viewport.resize(320, 480)
    qtbot.waitUntil(lambda: viewport.camera.distance_m > 1.2 * wide.distance_m)
    drag(canvas(viewport), QPointF(10, 10), QPointF(20, 0))
    moved = viewport.camera
    viewport.resize(640, 360)
    qtbot.wait(50)
    assert viewport.camera == moved


def test_where_there_is_little_room_the_views_fold_into_a_menu(qtbot: QtBot, viewport: ViewportPanel) -> None:
    folded = child(viewport, QToolButton, "viewport_view")
    segment = child(viewport, QToolButton, "viewport_view_front")
    viewport.resize(640, 360)
    qtbot.waitUntil(segment.isVisible)
    assert not folded.isVisible()
    viewport.resize(300, 300)
    qtbot.waitUntil(folded.isVisible)
    assert not segment.isVisible()
    folded.menu().actions()[4].trigger()
    assert viewport._session.viewport.view == "hands"
    assert folded.text() == folded.menu().actions()[4].text()


def test_the_right_button_offers_the_tables_actions(
    qtbot: QtBot, viewport: ViewportPanel, session: Session, tmp_path: Path
) -> None:
    row = Action("viewport.frame", lambda session: session.viewport.set_view("top"), "view")
    action = ActionTable(session, Settings(tmp_path / "editor.toml"), [row]).actions[row.id]
    qtbot.mouseClick(canvas(viewport), Qt.MouseButton.RightButton, pos=QPoint(5, 5))
    menu = child(viewport, QMenu, "viewport_menu")
    assert action in menu.actions()
    action.trigger()
    assert session.viewport.view == "top"
    menu.close()


# Selection


def test_clicking_selects_and_control_adds(qtbot: QtBot, viewport: ViewportPanel, session: Session) -> None:
    players = [player.id for player in session.project.players]
    for row in (2, 1):
        qtbot.mouseClick(canvas(viewport), Qt.MouseButton.LeftButton, pos=place_of(viewport, row).toPoint())
        assert session.players == (players[row],)
    qtbot.mouseClick(
        canvas(viewport),
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.ControlModifier,
        place_of(viewport, 3).toPoint(),
    )
    assert session.players == (players[1], players[3])
    qtbot.mouseClick(
        canvas(viewport),
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.ControlModifier,
        place_of(viewport, 3).toPoint(),
    )
    assert session.players == (players[1],)
    qtbot.mouseClick(canvas(viewport), Qt.MouseButton.LeftButton, pos=QPoint(4, 4))
    assert session.players == (players[1],)


def test_a_drag_that_begins_on_a_player_selects_no_one(viewport: ViewportPanel, session: Session) -> None:
    before = session.players
    drag(canvas(viewport), place_of(viewport, 2), QPointF(40, 0))
    assert session.players == before


def test_who_is_under_the_pointer_is_known(viewport: ViewportPanel, session: Session) -> None:
    send(canvas(viewport), QEvent.Type.MouseMove, place_of(viewport, 2), Qt.MouseButton.NoButton)
    assert viewport.hovered == session.project.players[2].id
    assert canvas(viewport).cursor().shape() == Qt.CursorShape.PointingHandCursor
    send(canvas(viewport), QEvent.Type.MouseMove, QPointF(3, 3), Qt.MouseButton.NoButton)
    assert viewport.hovered is None
    send(canvas(viewport), QEvent.Type.MouseMove, place_of(viewport, 0), Qt.MouseButton.NoButton)
    assert viewport.hovered == session.project.players[0].id


@pytest.fixture(scope="module")
def danced(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """The quartet with two dancers, whose motion is cached for all tests."""
    path = tmp_path_factory.mktemp("dances") / "steps.choreography"
    write_model(path, model())
    project = quartet_project()
    for x_m in (-2.5, 2.5):
        project, dancer_id = add_dancer(project, path, "Dancer")
        project = place_dancers(project, {dancer_id: StagePosition(x_m, 2.0, 0.0)})
    return project


@pytest.fixture
def two_dancers(viewport: ViewportPanel, session: Session, danced: Project) -> tuple[str, str]:
    """Ids of two dancers beside the players, the second one selected."""
    first, second = danced.dancers
    session.apply(Message("edit.add_dancer"), danced)
    session.set_dancer(second.id)
    QApplication.processEvents()
    return first.id, second.id


def test_clicking_a_dancer_selects_it_and_leaves_the_players(
    qtbot: QtBot, viewport: ViewportPanel, session: Session, two_dancers: tuple[str, str]
) -> None:
    row, players = len(session.project.players), session.players
    none, control = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ControlModifier
    for number, modifier in ((0, none), (1, none), (0, control), (0, control)):
        place = place_of(viewport, row + number).toPoint()
        qtbot.mouseClick(canvas(viewport), Qt.MouseButton.LeftButton, modifier, place)
        assert session.dancer.id == two_dancers[number]
        assert session.players == players
    qtbot.mouseClick(canvas(viewport), Qt.MouseButton.LeftButton, pos=place_of(viewport, 2).toPoint())
    assert session.players == (session.project.players[2].id,)
    assert session.dancer.id == two_dancers[0]
    drag(canvas(viewport), place_of(viewport, row + 1), QPointF(40, 0))
    assert session.dancer.id == two_dancers[0]


def test_the_selected_dancer_is_seen_and_the_one_under_the_pointer_known(
    viewport: ViewportPanel, session: Session, two_dancers: tuple[str, str], shot: Shot
) -> None:
    row = len(session.project.players)
    send(canvas(viewport), QEvent.Type.MouseMove, place_of(viewport, row), Qt.MouseButton.NoButton)
    assert viewport.hovered == two_dancers[0]
    assert canvas(viewport).cursor().shape() == Qt.CursorShape.PointingHandCursor
    session.viewport.show("names", False)
    second = shot("ensemble")
    session.set_dancer(two_dancers[0])
    assert differing(second, shot("ensemble")) > 40


def test_a_double_click_on_a_dancer_frames_that_dancer(
    qtbot: QtBot, viewport: ViewportPanel, session: Session, two_dancers: tuple[str, str]
) -> None:
    row = len(session.project.players)
    before = viewport.camera
    qtbot.mouseDClick(canvas(viewport), Qt.MouseButton.LeftButton, pos=place_of(viewport, row).toPoint())
    after = viewport.camera
    assert after.distance_m < before.distance_m
    assert abs(after.target_m[0] - viewport.scene.stage.joint_m(row, "chest")[0]) < 0.4


# The pose tool


@pytest.fixture
def posing(viewport: ViewportPanel, session: Session, qtbot: QtBot) -> ViewportPanel:
    session.viewport.set_view("front")
    session.viewport.set_posing(True)
    qtbot.wait(500)
    return viewport


def only(session: Session) -> PoseCorrection:
    (found,) = session.project.corrections[session.project.players[0].id]
    assert isinstance(found, PoseCorrection)
    return found


def test_dragging_the_bell_up_is_one_step_that_can_be_undone(posing: ViewportPanel, session: Session) -> None:
    before = session.project
    drag(canvas(posing), posing.handle_places()["bell"], QPointF(0, -12))
    held = only(session)
    assert held.target == "bell"
    assert held.up_deg > 1.0
    score = session.project.score
    tick = round(score.tempo_map.ticks(AT_S))
    assert held.start_tick <= tick < held.end_tick
    assert held.start_tick == score.metre_map.tick_of_bar(score.metre_map.bar_of_tick(tick))
    assert len(session.document.done) == 1
    session.document.undo()
    assert session.project is before


def test_the_player_follows_the_drag(posing: ViewportPanel, session: Session, poses: MadeNow) -> None:
    stage = posing.scene.stage
    before = stage.node_matrix(0)[:, 2].copy()
    drag(canvas(posing), posing.handle_places()["bell"], QPointF(0, -12), release=False)
    assert stage.node_matrix(0)[1, 2] > before[1] + 0.01
    send(canvas(posing), QEvent.Type.MouseButtonRelease, QPointF(0, 0))


def test_a_drag_over_a_chosen_span_covers_it(posing: ViewportPanel, session: Session) -> None:
    session.select(msgspec.structs.replace(session.selection, span=(960, 2400)))
    drag(canvas(posing), posing.handle_places()["head"], QPointF(10, 0))
    held = only(session)
    assert (held.target, held.start_tick, held.end_tick) == ("head", 960, 2400)
    assert held.left_deg > 0.0


def test_a_second_drag_goes_on_from_the_first(posing: ViewportPanel, session: Session) -> None:
    drag(canvas(posing), posing.handle_places()["head"], QPointF(6, 0))
    first = only(session)
    drag(canvas(posing), posing.handle_places()["head"], QPointF(6, 0))
    second = only(session)
    assert second.name == first.name
    assert second.left_deg > first.left_deg
    assert len(session.document.done) == 2


def test_shift_is_finer(posing: ViewportPanel, session: Session) -> None:
    drag(canvas(posing), posing.handle_places()["head"], QPointF(6, 0))
    coarse = only(session).left_deg
    session.document.undo()
    drag(canvas(posing), posing.handle_places()["head"], QPointF(6, 0), modifiers=Qt.KeyboardModifier.ShiftModifier)
    assert only(session).left_deg == pytest.approx(coarse / 4.0, abs=0.2)


def test_escape_gives_a_drag_up(qtbot: QtBot, posing: ViewportPanel, session: Session) -> None:
    before = session.project
    drag(canvas(posing), posing.handle_places()["torso"], QPointF(12, 0), release=False)
    assert session.project is not before
    qtbot.keyClick(canvas(posing), Qt.Key.Key_Escape)
    assert session.project is before
    assert not session.document.done
    # The button is still pressed, but further moves are no drag.
    send(canvas(posing), QEvent.Type.MouseMove, QPointF(100, 100))
    send(canvas(posing), QEvent.Type.MouseButtonRelease, QPointF(100, 100))
    assert session.project is before
    qtbot.keyClick(canvas(posing), Qt.Key.Key_Escape)
    assert not session.viewport.posing


def test_a_drag_that_returns_is_no_step(posing: ViewportPanel, session: Session) -> None:
    before, start = session.project, posing.handle_places()["left_elbow"]
    widget = canvas(posing)
    send(widget, QEvent.Type.MouseButtonPress, start)
    for step in (5.0, 12.0, 4.0, 0.0):
        send(widget, QEvent.Type.MouseMove, start + QPointF(step, -step))
    send(widget, QEvent.Type.MouseButtonRelease, start)
    assert session.project is before
    assert not session.document.done


def test_a_double_click_gives_back_to_the_generator(posing: ViewportPanel, session: Session) -> None:
    drag(canvas(posing), posing.handle_places()["right_elbow"], QPointF(-10, -10))
    assert only(session).target == "right_elbow"
    send(canvas(posing), QEvent.Type.MouseButtonDblClick, posing.handle_places()["right_elbow"])
    assert not session.project.corrections


# Without OpenGL

_WITHOUT = """
import sys
from PySide6.QtWidgets import QApplication, QLabel
from app.errors import AppError
app = QApplication(["suisou"])
from app.shell.language import Language
from app.shell.action import Action
from app.shell.actions import ActionTable
from tests.gui.conftest import planned_quartet, quartet_project
from tests.support.tasks import ImmediateTasks
from app.editor.session import Session
from app.editor.settings import Settings
from widgets.viewport.panel import ViewportPanel

class Nothing:
    def poses(self, player_ids, time_s):
        return [None for _ in player_ids]
    def pose_now(self, player_id, time_s):
        return None

language = Language()
session = Session(quartet_project(), ImmediateTasks())
panel = ViewportPanel(session, Nothing())
panel.resize(400, 300)
panel.show()
app.processEvents()
reason = panel.findChild(QLabel, "viewport_reason")
assert not panel.has_gl
assert reason.isVisible() and "OpenGL" in reason.text() and "offscreen" in reason.text(), reason.text()
try:
    panel.render_image(64, 64, 0.0)
except AppError as error:
    assert error.message.id == "picture.no_gl"
else:
    raise AssertionError("a picture without GL")
for view in ("hands", "ensemble"):
    session.viewport.set_view(view)
session.viewport.set_posing(True)
session.set_playhead(3.0)
session.set_players(())
panel.grab()
print("fine")
"""


def test_without_gl_the_panel_says_why_and_nothing_fails() -> None:
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", _WITHOUT],
        cwd=ROOT,
        env={**os.environ, "QT_QPA_PLATFORM": "offscreen", "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "fine" in done.stdout


def test_a_driver_that_fails_while_drawing_leaves_the_reason(
    qtbot: QtBot, viewport: ViewportPanel, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*arguments: object) -> None:
        raise RuntimeError("lost the device")

    monkeypatch.setattr("widgets.viewport.renderer.Renderer.draw", fails)
    with pytest.raises(AppError, match=r"picture\.no_gl"):
        viewport.render_image(32, 32, AT_S)
    qtbot.waitUntil(lambda: not viewport.has_gl)
    assert "lost the device" in viewport.message()
    with pytest.raises(AppError, match="lost the device"):
        viewport.render_image(32, 32, AT_S)
    viewport.refresh()


def test_what_an_edit_made_is_drawn_at_once_unless_a_picture_takes_long(
    qtbot: QtBot, viewport: ViewportPanel, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn, draw = list[float](), Canvas._draw

    def watched(own: Canvas, width: int, height: int) -> None:
        drawn.append(own.drawing_s)
        draw(own, width, height)

    monkeypatch.setattr(Canvas, "_draw", watched)
    assert viewport._canvas is not None
    for last_s, count in ((0.001, 1), (10.0, 0)):
        # Qt composes a window once a frame.
        qtbot.wait(40)
        drawn.clear()
        viewport._canvas.drawing_s = last_s
        viewport.draw_now()
        assert len(drawn) == count
        assert viewport._canvas.drawing_s > 0.0


def test_it_looks_for_changed_poses_while_anyone_is_there(viewport: ViewportPanel, session: Session) -> None:
    def looking() -> bool:
        return any(timer.isActive() for timer in viewport.findChildren(QTimer))

    session.set_performance(Performance(session.project, planned_quartet()))
    assert looking()
    # After a piece is closed no players are shown, even if plans have just arrived.
    session.document.open(new_piece())
    assert not looking()
    session.set_performance(Performance(session.project))
    assert not looking()


def test_a_picture_needs_no_visible_window(qtbot: QtBot, session: Session, poses: MadeNow, shot: Shot) -> None:
    panel = ViewportPanel(session, poses)
    qtbot.addWidget(panel)
    assert not panel.isVisible()
    picture = panel.render_image(320, 180, AT_S, "ensemble")
    assert differing(picture, shot("ensemble")) < 60
    assert not panel.isVisible()


def test_another_piece_opens_framed_and_without_the_bodies_of_the_one_before(
    viewport: ViewportPanel, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While the new bodies are loading, no old bodies have the new names."""
    first = session.project
    session.viewport.set_view("hands")
    session.set_players((first.players[2].id,))
    tuba = msgspec.structs.replace(first.players[0], instrument_id=first.players[3].instrument_id)
    with monkeypatch.context() as patch:
        patch.setattr(session.tasks, "run", lambda *args, **options: None)
        session.document.open(replace(first, players=(tuba, *first.players[1:])))
        assert viewport.scene.stage is None
        assert viewport.message()
        assert session.viewport.view == "ensemble"
    session.document.open(first)
    QApplication.processEvents()
    assert viewport.scene.stage is not None
    assert viewport.camera == viewport._view_camera()


def test_a_film_has_no_names_and_no_rings_unless_they_are_asked_for(viewport: ViewportPanel, session: Session) -> None:
    def picture(marked: bool) -> npt.NDArray[np.uint8]:
        return viewport.film(320, 180, (AT_S, AT_S), "ensemble", marked)(AT_S)

    marked, plain = picture(True), picture(False)
    assert differing(marked, plain) > 200
    session.viewport.show("names", False)
    session.set_players(())
    assert differing(picture(True), plain) == 0


def test_hovering_leaves_the_body_as_it_is(viewport: ViewportPanel, session: Session) -> None:
    """Only the floor marks the player under the pointer."""
    session.viewport.show("names", False)
    session.viewport.set_view("mouth")
    viewport._eye.jump(viewport.camera)

    def shown() -> npt.NDArray[np.uint8]:
        image = viewport._canvas.native.grabFramebuffer().convertToFormat(QImage.Format.Format_RGBA8888)
        return pixels(image)

    before = shown()
    at = place_of(viewport, 0, "head")
    send(canvas(viewport), QEvent.Type.MouseMove, at, Qt.MouseButton.NoButton)
    QApplication.processEvents()
    assert viewport.hovered == session.players[0]
    assert differing(shown(), before) == 0


def test_the_front_view_is_a_bust_with_the_player_in_the_middle(viewport: ViewportPanel, session: Session) -> None:
    stage = viewport.scene.stage
    assert stage is not None
    for row, player in enumerate(session.project.players):
        session.set_players((player.id,))
        session.viewport.set_view("front")
        (head, feet), _ = viewport.camera.project([stage.joint_m(row, "head"), stage.joint_m(row, "leftFoot")], *SIZE)
        assert head[0] == pytest.approx(SIZE[0] / 2, abs=0.04 * SIZE[0])
        assert 0.0 < head[1] < 0.5 * SIZE[1]
        assert feet[1] > SIZE[1]
    # The feet of a dancing player are visible too.
    player = session.project.players[0]
    session.attempt(Message("edit.parameter"), lambda project: set_body_dance(project, (player.id,), "salsa"))
    session.set_players((player.id,))
    session.viewport.set_view("ensemble")
    session.viewport.set_view("front")
    stage = viewport.scene.stage
    assert stage is not None
    (head, feet), _ = viewport.camera.project([stage.joint_m(0, "head"), stage.joint_m(0, "leftFoot")], *SIZE)
    assert 0.0 < head[1] < feet[1] < SIZE[1]


def test_a_key_shows_the_hands_from_the_other_side(qtbot: QtBot, viewport: ViewportPanel, session: Session) -> None:
    session.viewport.set_view("hands")
    first = viewport.camera
    session.viewport.turn()
    other = viewport.camera
    assert other.target_m == first.target_m
    stage = viewport.scene.stage
    assert stage is not None
    right, left = (camera.right @ stage.members[0].world_from_player[:, 2] for camera in (first, other))
    assert right == pytest.approx(-left)
    assert abs(right) > 0.1
    session.viewport.turn()
    assert viewport.camera.yaw_rad == pytest.approx(first.yaw_rad)
