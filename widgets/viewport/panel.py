"""The viewport: the players on their stage, seen from anywhere, selected and posed by hand."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, QRectF, QSize, Qt, QTimer
from PySide6.QtGui import QImage, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QWheelEvent
from PySide6.QtWidgets import QLabel, QMenu, QStackedWidget, QVBoxLayout, QWidget

from app.errors import Message
from app.project.document import Change
from widgets.common.session import Session, Severity
from widgets.common.text import message_text
from widgets.common.viewport_state import SHOWN, VIEWS, View
from widgets.viewport.camera import Camera, between, dolly, followed, frame, orbit, pan, triple
from widgets.viewport.canvas import Canvas, Picture, pixels, why_no_gl
from widgets.viewport.cast import Stage
from widgets.viewport.contacts import touches
from widgets.viewport.figures import Loaded, cast_key, load, moved, same_figures
from widgets.viewport.handles import TARGETS, Handle, handles
from widgets.viewport.header import Header
from widgets.viewport.limbs import Limbs, hit
from widgets.viewport.look import look_of, rgb
from widgets.viewport.overlay import Marks, Name, handle_at, over_head_m, paint
from widgets.viewport.pose_tool import PoseTool
from widgets.viewport.poses import Posed, Poses, same
from widgets.viewport.renderer import Emphasis
from widgets.viewport.views import bounds, in_the_way, tracked, view_camera
from widgets.viewport.worn_face import WornFaces

Floats = npt.NDArray[np.float64]

TRANSITION_S = 0.35
FRAME_MS = 16
WAIT_MS = 90
"""Between two looks whether a pose that is not there yet has been made."""
SETTLED_S = 4.0
"""After an edit poses may still change for this long."""
MENU = (
    ("viewport.frame", "viewport.frame_all"),
    tuple(f"viewport.{view}" for view in VIEWS),
    tuple(f"viewport.{what}" for what in SHOWN),
    ("viewport.pose", "application.full_screen"),
)
"""The menu under the right button: groups of actions."""
CLICK_PX = 4.0
"""A press that moves less is a click."""
FOLLOWED_M = 0.0008
"""A close-up nearer to its middle than this has arrived."""


class ViewportPanel(QWidget):
    """The players in three dimensions.

    Without a working GL the panel says why in plain Qt, and everything else of the editor works.

    Parameters
    ----------
    session : Session
    poses : Poses
    """

    def __init__(self, session: Session, poses: Poses, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("viewport")
        self._session = session
        self._poses: Poses = WornFaces(session, poses)
        self._loaded: Loaded | None = None
        self._loading = False
        self._camera = Camera()
        self._flight: tuple[Camera, Camera, float] | None = None
        self._shown_view: View = "ensemble"
        self._touched = False
        """Whether the camera stands where a person moved it; else it is the view's own."""
        self._shift_m = np.zeros(3)
        self._last_frame_s = perf_counter()
        self._settle_until_s = 0.0
        self._missing = False
        self._hovered: int | None = None
        self._tool = PoseTool(session)
        self._press: QPointF | None = None
        self._pointer: QPointF | None = None
        self._dragging = False
        self._override: tuple[Camera, View] | None = None

        self.header = Header(session, self)
        self._stack = QStackedWidget(self)
        self._reason = QLabel(self._stack)
        self._reason.setObjectName("viewport_reason")
        self._reason.setWordWrap(True)
        self._reason.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._reason.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._reason.setMargin(24)
        self._stack.addWidget(self._reason)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.header)
        layout.addWidget(self._stack, 1)

        self._canvas: Canvas | None = None
        self._overlay: _Overlay | None = None
        self._failure = self._start_gl()
        self._ticker = QTimer(self)
        self._ticker.setInterval(FRAME_MS)
        self._ticker.timeout.connect(self._tick)
        self._waiter = QTimer(self)
        self._waiter.setInterval(WAIT_MS)
        self._waiter.timeout.connect(self.poses_changed)

        session.changed.connect(self._project_changed)
        session.performance_changed.connect(self._performance_changed)
        session.players_changed.connect(self._players_changed)
        session.selection_changed.connect(self._update)
        session.playhead_changed.connect(self.refresh)
        session.preview_changed.connect(self.refresh)
        session.theme_changed.connect(self._dress)
        session.viewport.changed.connect(self._state_changed)
        session.viewport.viewed.connect(self._view_asked)
        session.viewport.framed.connect(self._frame_asked)
        self._dress()
        self.retranslate()
        self._load()

    # What others ask

    @property
    def has_gl(self) -> bool:
        """Whether players can be drawn here."""
        return self._canvas is not None

    @property
    def camera(self) -> Camera:
        """The camera, or where its flight ends."""
        return self._flight[1] if self._flight is not None else self._camera

    def set_camera(self, camera: Camera, at_once: bool = False) -> None:
        """Look from there; a short flight leads to it."""
        if at_once or not self.isVisible():
            self._camera, self._flight = camera, None
        else:
            self._flight = (self._camera, camera, perf_counter())
            self._ticker.start()
        self._update()

    def set_poses(self, poses: Poses) -> None:
        """Take poses from there from now on."""
        self._poses = WornFaces(self._session, poses)
        self.refresh()

    def poses_changed(self) -> None:
        """Motion has been made or made anew; what is not at the playhead does not matter here."""
        if self._loaded is None or self._canvas is None:
            return
        stage, time_s = self._loaded.stage, self._session.playhead_s
        for row, member in enumerate(stage.members):
            pose = self._poses.pose(member.player_id, time_s)
            # A pose that is not there yet leaves the one before it.
            if pose is not None and not same(pose, stage.poses[row]):
                self.refresh()
                return
        self._wait()

    def player_at(self, x_px: float, y_px: float) -> str | None:
        """Id of the player under a point of the picture."""
        row = self._row_at(QPointF(x_px, y_px))
        return None if row is None or self._loaded is None else self._loaded.stage.members[row].player_id

    def canvas_widget(self) -> QWidget | None:
        """The widget that is drawn in; None without GL."""
        native: QWidget | None = self._canvas.native if self._canvas is not None else None
        return native

    def handle_places(self) -> dict[str, QPointF]:
        """Where the pose tool's handles are in the picture."""
        widget = self.canvas_widget()
        if widget is None:
            return {}
        found = self._handles()
        if not found:
            return {}
        places, _ = self._camera.project(np.array([item.at_m for item in found]), widget.width(), widget.height())
        return {item.target: QPointF(*place) for item, place in zip(found, places, strict=True)}

    def render_image(
        self, width: int, height: int, time_s: float, view: View | None = None
    ) -> npt.NDArray[np.uint8] | None:
        """A picture of a moment, with the names and marks that are shown.

        Parameters
        ----------
        width, height : int
            Pixels.
        time_s : float
            Seconds of the performance.
        view : View, optional
            The camera as it stands if absent.

        Returns
        -------
        (height, width, 4) uint8 or None
            None without GL, or while the figures are not loaded.
        """
        canvas, loaded = self._canvas, self._loaded
        if canvas is None or loaded is None:
            return None
        stage = loaded.stage
        seen = {member.player_id: pose for member, pose in zip(stage.members, stage.poses, strict=True)}
        self._take(stage, {player_id: self._poses.pose_now(player_id, time_s) for player_id in seen})
        camera = self._camera
        if view is not None:
            camera = view_camera(
                view, loaded.stage, self._rows(), replace(camera, fov_deg=Camera().fov_deg), width / height
            )
        elif (middle := self._tracked(loaded.stage)) is not None:
            camera = replace(camera, target_m=triple(middle + self._shift_m))
        self._override = (camera, view if view is not None else self._shown_view)
        try:
            picture = canvas.render_image(width, height)
        finally:
            self._override = None
        if picture is None:
            return None
        marks = self._marks(camera)
        if marks:
            image = QImage(picture.data, width, height, 4 * width, QImage.Format.Format_RGBA8888)
            painter = QPainter(image)
            painter.setFont(self.font())
            paint(painter, marks, loaded.stage, camera, (width, height), self._session.tokens)
            painter.end()
            picture = pixels(image)
        # What the window shows has not changed.
        stage.pose(seen)
        return picture

    # GL

    def _start_gl(self) -> str | None:
        """Make the canvas; why that does not work, None where it does."""
        reason = why_no_gl()
        if reason is not None:
            return reason
        try:
            canvas = Canvas(self._picture, self._drawing_failed)
        except Exception as error:  # noqa: BLE001  Drivers and vispy fail in many ways; the editor works without.
            return f"{type(error).__name__}: {error}"
        native: QWidget = canvas.native
        native.setObjectName("viewport_canvas")
        native.setMouseTracking(True)
        native.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        native.setMinimumSize(QSize(160, 120))
        native.installEventFilter(self)
        self._canvas = canvas
        self._stack.addWidget(native)
        self._stack.setCurrentWidget(native)
        self._overlay = _Overlay(self, native)
        return None

    def _drawing_failed(self, reason: str) -> None:
        self._failure = reason
        # Not while Qt paints the widget that is taken away.
        QTimer.singleShot(0, self, self._give_up)

    def _give_up(self) -> None:
        self._canvas = None
        self._overlay = None
        self._ticker.stop()
        self._waiter.stop()
        self._stack.setCurrentWidget(self._reason)
        self.retranslate()

    def _picture(self, width: int, height: int) -> Picture:
        """What to draw: asked by the canvas."""
        camera = self._override[0] if self._override is not None else self._camera
        hovered = None if self._override is not None else self._hovered
        aside = frozenset[int]()
        if self._loaded is not None:
            aside = in_the_way(self._view(), self._loaded.stage, self._rows(), camera)
        moving = self._session.playing or self._dragging or self._flight is not None
        emphasis = Emphasis(
            self._rings(), hovered, aside, self._shows_wires(), in_motion=moving and self._override is None
        )
        return camera, look_of(self._session.tokens), emphasis

    def _view(self) -> View:
        return self._override[1] if self._override is not None else self._shown_view

    def _shows_wires(self) -> bool:
        return self._session.viewport.shows("wireframe")

    def _rings(self) -> dict[int, tuple[float, float, float]]:
        if self._loaded is None:
            return {}
        project, stage = self._session.project, self._loaded.stage
        known = {player.id: player for player in project.players}
        chosen = [player_id for player_id in self._session.players if player_id in known]
        rows = {player_id: stage.index(player_id) for player_id in chosen}
        return {row: rgb(self._session.colour(known[own])) for own, row in rows.items() if row is not None}

    # Figures and poses

    def _load(self) -> None:
        project = self._session.project
        before = self._loaded
        if before is not None and same_figures(before.key, cast_key(project)):
            if before.key != cast_key(project):
                self._show_stage(moved(project, before))
            return
        if self._canvas is None:
            return
        self._loading = True
        shapes = before.shapes if before is not None else None
        self._session.tasks.run(
            Message("work.load_figures"),
            lambda progress, stop_wanted: load(project, shapes, progress, stop_wanted),
            self._figures_loaded,
            key="viewport.load",
        )
        self._update()

    def _figures_loaded(self, loaded: Loaded | None) -> None:
        self._loading = False
        if loaded is None:
            return
        if not same_figures(loaded.key, cast_key(self._session.project)):
            self._load()
            return
        self._show_stage(loaded)
        for reason in loaded.absent.values():
            self._session.notice(reason, Severity.WARNING)
        # Places may have changed while the figures were loaded.
        self._load()

    def _show_stage(self, loaded: Loaded) -> None:
        self._loaded = loaded
        self._hovered = None
        if self._canvas is not None:
            self._canvas.prepare(lambda renderer: renderer.set_stage(loaded.stage, loaded.shapes))
        self.refresh()

    def _take(self, stage: Stage, poses: dict[str, Posed | None]) -> None:
        before = int(stage.shown.sum())
        stage.pose(poses)
        if int(stage.shown.sum()) != before:
            self._place_camera()

    def _place_camera(self) -> None:
        """Where the view puts it, unless a person has moved it."""
        if not self._touched and self._loaded is not None and self._loaded.stage.shown.any():
            self._camera, self._flight = self._camera_of(self._shown_view), None

    def refresh(self) -> None:
        """Show the pose at the playhead."""
        loaded = self._loaded
        if loaded is None or self._canvas is None:
            return
        time_s = self._session.playhead_s
        poses = {member.player_id: self._poses.pose(member.player_id, time_s) for member in loaded.stage.members}
        self._take(loaded.stage, poses)
        self._missing = any(pose is None for pose in poses.values())
        self._wait()
        self._follow()
        self._update()

    def _wait(self) -> None:
        """Look again soon, as long as poses are missing or may still change after an edit."""
        waiting = self._missing or perf_counter() < self._settle_until_s
        if waiting != self._waiter.isActive():
            if waiting:
                self._waiter.start()
            else:
                self._waiter.stop()

    def _follow(self) -> None:
        """Let a close-up follow its player."""
        now_s = perf_counter()
        elapsed_s, self._last_frame_s = min(now_s - self._last_frame_s, 0.1), now_s
        if self._loaded is None or self._flight is not None or self._dragging:
            return
        middle = self._tracked(self._loaded.stage)
        if middle is None:
            return
        goal = middle + self._shift_m
        self._camera = followed(self._camera, goal, elapsed_s)
        if np.linalg.norm(goal - np.asarray(self._camera.target_m)) > FOLLOWED_M:
            self._ticker.start()

    def _tracked(self, stage: Stage) -> Floats | None:
        rows = self._rows()
        return tracked(self._shown_view, stage, rows[0]) if rows else None

    def _tick(self) -> None:
        """A frame of a flight, or of following after the playhead has stopped."""
        if self._flight is not None:
            start, end, since_s = self._flight
            share = (perf_counter() - since_s) / TRANSITION_S
            self._camera = between(start, end, share)
            if share >= 1.0:
                self._flight = None
            self._last_frame_s = perf_counter()
            self._update()
            return
        self._ticker.stop()
        self._follow()
        self._update()

    def _update(self) -> None:
        if self._canvas is not None:
            self._canvas.update()
        if self._overlay is not None:
            self._overlay.refresh()

    # Changes of the session

    def _project_changed(self, change: Change) -> None:
        if change.opened:
            self._touched = False
            self._tool.release()
        if cast_key(change.before) != cast_key(change.after) or change.opened:
            self._load()
        self._update()

    def _performance_changed(self) -> None:
        self._settle_until_s = perf_counter() + SETTLED_S
        self.refresh()

    def _players_changed(self) -> None:
        if self._shown_view != "ensemble" and self._loaded is not None:
            self._shift_m = np.zeros(3)
            self.set_camera(self._camera_of(self._shown_view))
        if self._session.preview_morphs is not None:
            # The face that is being made goes to whoever is in front now.
            self.refresh()
        self._update()

    def _state_changed(self) -> None:
        if not self._session.viewport.posing:
            self._tool.cancel()
        self._show_note()
        self._update()

    def _view_asked(self) -> None:
        self._shown_view = self._session.viewport.view
        self._touched = False
        self._shift_m = np.zeros(3)
        self.set_camera(self._camera_of(self._shown_view))

    def _frame_asked(self, selected: bool) -> None:
        """Frame players as the camera stands."""
        if self._loaded is None:
            return
        stage = self._loaded.stage
        everyone = [row for row in range(len(stage.members)) if stage.shown[row]]
        rows = [row for row in self._rows() if stage.shown[row]] if selected else everyone
        if rows:
            self._shown_view = "ensemble"
            self._touched = True
            self.set_camera(frame(self.camera, *bounds(stage, rows), self._aspect()))

    def _camera_of(self, view: View) -> Camera:
        if self._loaded is None:
            return self._camera
        start = self._override[0] if self._override is not None else self._camera
        return view_camera(view, self._loaded.stage, self._rows(), start, self._aspect())

    def _rows(self) -> list[int]:
        """Rows of the selected players, the one in front first."""
        if self._loaded is None:
            return []
        rows = [self._loaded.stage.index(player_id) for player_id in self._session.players]
        return [row for row in rows if row is not None]

    def _aspect(self) -> float:
        widget = self.canvas_widget()
        return widget.width() / max(widget.height(), 1) if widget is not None else 16.0 / 9.0

    # Marks over the picture

    def _handles(self) -> tuple[Handle, ...]:
        rows = self._rows()
        if not self._session.viewport.posing or self._loaded is None or not rows:
            return ()
        return handles(self._loaded.stage, rows[0])

    def _marks(self, camera: Camera) -> Marks:
        loaded, state, session = self._loaded, self._session.viewport, self._session
        if loaded is None:
            return Marks()
        stage = loaded.stage
        players = {player.id: player for player in session.project.players}
        rows = self._rows()
        names = []
        if state.shows("names"):
            for row, member in enumerate(stage.members):
                player = players.get(member.player_id)
                if player is not None and stage.shown[row]:
                    names.append(
                        Name(player.name, session.colour(player), over_head_m(stage, row, camera.up), row in rows)
                    )
        skeletons = []
        if state.shows("skeleton"):
            for row, member in enumerate(stage.members):
                if stage.shown[row] and member.player_id in players:
                    skeletons.append((row, session.colour(players[member.player_id])))
        correction = self._tool.correction
        reading = ""
        if correction is not None:
            reading = self._reading(correction.up_deg, correction.left_deg, correction.roll_deg)
        return Marks(
            names=names,
            skeletons=skeletons,
            touches=touches(stage, rows[0]) if state.shows("contacts") and rows and stage.shown[rows[0]] else (),
            handles=self._handles(),
            grasped=self._tool.grasped,
            corrected=self._tool.corrected(TARGETS) if state.posing else frozenset(),
            reading=reading,
        )

    def _reading(self, up_deg: float, left_deg: float, roll_deg: float) -> str:
        parts = []
        if up_deg:
            parts.append((self.tr("up {degrees}°") if up_deg > 0 else self.tr("down {degrees}°"), up_deg))
        if left_deg:
            parts.append((self.tr("left {degrees}°") if left_deg > 0 else self.tr("right {degrees}°"), left_deg))
        if roll_deg:
            lean = self.tr("lean left {degrees}°") if roll_deg > 0 else self.tr("lean right {degrees}°")
            parts.append((lean, roll_deg))
        return "  ".join(text.format(degrees=f"{abs(value):.1f}") for text, value in parts) or "0°"

    def message(self) -> str:
        """What is said in the picture's place or in its middle; empty where there is nothing to say."""
        if self._failure is not None:
            return ""
        if not self._session.project.players:
            return self.tr("No players yet. Open or import a piece to see it performed.")
        if self._loaded is None:
            return self.tr("Loading the players …")
        if not self._loaded.stage.shown.any():
            if self._loaded.absent and not self._loaded.stage.members:
                return "\n".join(message_text(reason) for reason in self._loaded.absent.values())
            return self.tr("Making the first motion …")
        return ""

    def _show_note(self) -> None:
        note = ""
        if self._session.viewport.posing:
            note = self.tr("Drag a handle; Shift finer, Alt leans, double-click gives back")
        self.header.set_note(note)

    # The pointer

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """What happens on the canvas."""
        kind = event.type()
        if isinstance(event, QMouseEvent):
            if kind == QEvent.Type.MouseButtonPress:
                return self._pressed(event)
            if kind == QEvent.Type.MouseMove:
                return self._moved(event)
            if kind == QEvent.Type.MouseButtonRelease:
                return self._released(event)
            if kind == QEvent.Type.MouseButtonDblClick:
                return self._double_clicked(event)
        elif isinstance(event, QWheelEvent):
            return self._wheeled(event)
        elif isinstance(event, QKeyEvent) and kind == QEvent.Type.KeyPress:
            return self._key_pressed(event)
        elif kind == QEvent.Type.Leave:
            self._hover(None)
        elif kind == QEvent.Type.Resize and self._overlay is not None:
            self._place_camera()
            self._overlay.fit()
        return super().eventFilter(watched, event)

    def _size(self) -> tuple[float, float]:
        widget = self.canvas_widget()
        return (float(widget.width()), float(widget.height())) if widget is not None else (1.0, 1.0)

    def _pressed(self, event: QMouseEvent) -> bool:
        at = event.position()
        self._press = self._pointer = at
        self._dragging = False
        if event.button() == Qt.MouseButton.LeftButton:
            handle = handle_at(self._handles(), self._camera, at.x(), at.y(), self._size())
            if handle is not None:
                self._tool.grasp(handle)
                self._update()
        return True

    def _moved(self, event: QMouseEvent) -> bool:
        at = event.position()
        if self._press is None or self._pointer is None or not event.buttons():
            self._hover(at)
            return True
        step, self._pointer = at - self._pointer, at
        if not self._dragging and (at - self._press).manhattanLength() < CLICK_PX:
            return True
        if not self._dragging:
            self._dragging = True
            step = at - self._press
        self._flight = None
        modifiers = event.modifiers()
        shift = bool(modifiers & Qt.KeyboardModifier.ShiftModifier)
        if self._tool.grasped is not None:
            lean = bool(modifiers & Qt.KeyboardModifier.AltModifier)
            self._tool.drag(self._camera, step.x(), step.y(), self._size()[1], shift, lean)
            self.refresh()
        elif event.buttons() & Qt.MouseButton.MiddleButton or (event.buttons() & Qt.MouseButton.LeftButton and shift):
            before = np.asarray(self._camera.target_m)
            self._touched = True
            self._camera = pan(self._camera, step.x(), step.y(), self._size()[1])
            self._shift_m = self._shift_m + np.asarray(self._camera.target_m) - before
        elif event.buttons() & Qt.MouseButton.LeftButton:
            self._touched = True
            self._camera = orbit(self._camera, step.x(), step.y())
        elif event.buttons() & Qt.MouseButton.RightButton:
            self._touched = True
            self._camera = dolly(self._camera, -step.y() / 40.0)
        self._update()
        return True

    def _released(self, event: QMouseEvent) -> bool:
        clicked = self._press is not None and not self._dragging
        self._press = self._pointer = None
        self._dragging = False
        if self._tool.grasped is not None:
            self._tool.release()
        elif clicked and event.button() == Qt.MouseButton.LeftButton:
            self._select(event.position(), bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier))
        elif clicked and event.button() == Qt.MouseButton.RightButton:
            self._show_menu(event.globalPosition().toPoint())
        self._hover(event.position())
        self._follow()
        self._update()
        return True

    def _double_clicked(self, event: QMouseEvent) -> bool:
        at = event.position()
        handle = handle_at(self._handles(), self._camera, at.x(), at.y(), self._size())
        if handle is not None:
            self._tool.reset(handle.target)
        elif self._row_at(at) is not None:
            self._session.viewport.frame(True)
        return True

    def _wheeled(self, event: QWheelEvent) -> bool:
        steps = event.angleDelta().y() / 120.0 if event.angleDelta().y() else event.pixelDelta().y() / 60.0
        self._touched = True
        self.set_camera(dolly(self._camera, steps), at_once=True)
        return True

    def _key_pressed(self, event: QKeyEvent) -> bool:
        if event.key() == Qt.Key.Key_Escape:
            if self._tool.cancel():
                self._press = self._pointer = None
                self._dragging = False
                self.refresh()
                return True
            if self._session.viewport.posing:
                self._session.viewport.set_posing(False)
                return True
        # Everything else is the shell's: shortcuts and navigation.
        event.ignore()
        return False

    def _select(self, at: QPointF, add: bool) -> None:
        row = self._row_at(at)
        if row is None or self._loaded is None:
            return
        player_id = self._loaded.stage.members[row].player_id
        before = self._session.players
        if not add:
            self._session.set_players((player_id,))
        elif player_id not in before:
            self._session.set_players((*before, player_id))
        elif len(before) > 1:
            self._session.set_players(tuple(own for own in before if own != player_id))

    def _show_menu(self, at: QPoint) -> None:
        """What can be done here, from the table of actions."""
        menu = QMenu(self)
        menu.setObjectName("viewport_menu")
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for group in MENU:
            rows = [self._session.actions[name] for name in group if name in self._session.actions]
            if rows:
                menu.addActions(rows)
                menu.addSeparator()
        if menu.actions():
            menu.popup(at)
        else:
            menu.deleteLater()

    def _row_at(self, at: QPointF) -> int | None:
        if self._loaded is None or not self._loaded.stage.shown.any():
            return None
        found = hit(Limbs(self._loaded.stage).capsules(), *self._camera.ray(at.x(), at.y(), *self._size()))
        return found[0] if found is not None else None

    def _hover(self, at: QPointF | None) -> None:
        handle = None
        if at is not None:
            handle = handle_at(self._handles(), self._camera, at.x(), at.y(), self._size())
        row = self._row_at(at) if at is not None and handle is None else None
        widget = self.canvas_widget()
        if widget is not None:
            if handle is not None:
                widget.setCursor(Qt.CursorShape.SizeAllCursor)
            elif row is not None:
                widget.setCursor(Qt.CursorShape.PointingHandCursor)
            else:
                widget.unsetCursor()
        if row != self._hovered:
            self._hovered = row
            self._update()

    # Looks and language

    def _dress(self) -> None:
        tokens = self._session.tokens
        self._reason.setStyleSheet(f"background: {tokens.sunken}; color: {tokens.text};")
        self._update()

    def retranslate(self) -> None:
        """Set all texts again."""
        self.setWindowTitle(self.tr("Viewport"))
        self.setAccessibleName(self.tr("Viewport"))
        if self._failure is not None:
            self._reason.setText(
                self.tr(
                    "The players cannot be drawn here: there is no usable OpenGL 2.\n({reason})\n\n"
                    "Timeline, players, inspector, sound and export work all the same. "
                    "An up-to-date graphics driver usually brings the picture back."
                ).format(reason=self._failure)
            )
        self._show_note()
        self._update()

    def changeEvent(self, event: QEvent) -> None:
        """Follow the language."""
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


class _Overlay(QWidget):
    """Lies over the canvas while there is something to paint; the pointer passes through."""

    def __init__(self, panel: ViewportPanel, native: QWidget) -> None:
        super().__init__(native)
        self.setObjectName("viewport_overlay")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAttribute(Qt.WidgetAttribute.WA_NoSystemBackground)
        self._panel = panel
        self._native = native
        self._marks = Marks()
        self.hide()

    def refresh(self) -> None:
        """Paint again, or go away where there is nothing to paint."""
        self._marks = self._panel._marks(self._panel._camera)
        wanted = bool(self._marks) or bool(self._panel.message())
        if wanted != self.isVisibleTo(self._native):
            self.setVisible(wanted)
            self.fit()
        if wanted:
            self.update()

    def fit(self) -> None:
        """Cover the canvas."""
        self.setGeometry(self._native.rect())

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the marks, or what there is to say."""
        panel, painter = self._panel, QPainter(self)
        tokens = panel._session.tokens
        message = panel.message()
        if message:
            painter.setPen(tokens.text_dim)
            painter.drawText(
                QRectF(self.rect()).adjusted(24, 24, -24, -24),
                int(Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap),
                message,
            )
        elif panel._loaded is not None:
            size = (float(self.width()), float(self.height()))
            paint(painter, self._marks, panel._loaded.stage, panel._camera, size, tokens)
        painter.end()
