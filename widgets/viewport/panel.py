"""The viewport panel: the players on their stage from any direction, with selection and posing by mouse."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from time import perf_counter

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QEvent, QObject, QPointF, QRectF, QSize, Qt, QTimer
from PySide6.QtGui import QColor, QImage, QPainter
from PySide6.QtWidgets import QStackedWidget, QWidget

from app.arrays import FloatArray
from app.editor.poses import PoseSource
from app.editor.session import Session
from app.editor.viewport_state import SHOWN
from app.errors import AppError
from app.project.camera_bookmarks import VIEWS, CameraBookmark, View
from app.project.undoable_document import Change
from widgets.common.controls import Retranslated, named, wrapped
from widgets.common.layouts import in_column
from widgets.common.menus import offer_actions
from widgets.common.plain import Label
from widgets.viewport.camera import Camera, dolly, frame_points, from_other_side
from widgets.viewport.camera_bookmarks import BookmarkedCamera, shot_of
from widgets.viewport.camera_moves import Eye
from widgets.viewport.canvas import Canvas, Picture, pixels, why_no_gl
from widgets.viewport.cast import Stage
from widgets.viewport.colours_and_lights import Emphasis, look_of
from widgets.viewport.figures import DrawableFigures, cast_key
from widgets.viewport.film_camera import Shot, times_looked_at
from widgets.viewport.framing import (
    corners,
    in_the_way,
    needed_distance_m,
    steady_camera,
    tracked,
    turn_rad,
    view_camera,
)
from widgets.viewport.header import ViewportHeader
from widgets.viewport.overlay import paint
from widgets.viewport.painted_sheet import Layer
from widgets.viewport.pointer import Pointer
from widgets.viewport.pose_tool import PoseTool
from widgets.viewport.renderer import Renderer
from widgets.viewport.scene import ViewportScene
from widgets.viewport.video import BesideVideo, VideoStrip

Draw = Callable[[float], npt.NDArray[np.uint8]]
"""Function that draws a film's picture (height, width, 4) of a time in seconds."""

QUICK_S = 0.02
"""Seconds below which a picture may be drawn twice."""
FRAME_MS = 16
WAIT_MS = 90
"""Interval in milliseconds at which a missing pose is requested again."""
REST = 4.0
"""Pause between pictures while figures are loaded, relative to the time of the last picture, since each picture delays
loading.
"""
SETTLED_S = 4.0
"""Seconds after an edit during which poses may still change."""
LEAST_SIZE = QSize(160, 120)
MENU = (
    *("viewport.frame", "viewport.frame_all", ""),
    *(f"viewport.{view}" for view in VIEWS),
    "viewport.other_side",
    "cameras.keep",
    "",
    *(f"viewport.{what}" for what in SHOWN),
    *("", "viewport.pose", "application.full_screen"),
)
"""Context menu: actions, and separators between groups."""


class ViewportPanel(Retranslated, QWidget):
    """Panel that shows the players in 3D.

    If GL does not work, the panel shows the reason, and the rest of the editor works.

    Parameters
    ----------
    session : Session
        Session with the piece.
    poses : PoseSource
        Source of the poses.
    """

    def __init__(self, session: Session, poses: PoseSource, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("viewport")
        self._session = session
        self._eye = Eye()
        self._tool = PoseTool(session)
        self.scene = ViewportScene(session, poses, self._tool, self)
        self._settle_until_s = 0.0
        self._elsewhere: tuple[Camera, Shot] | None = None
        self._framed: tuple[Camera | None, Sequence[int]] = None, ()
        """Camera that framed performers, and their rows; it holds until the camera is moved."""
        """Camera and shot of a picture that is not the window's, while it is drawn."""

        self.header = ViewportHeader(session, self)
        session.viewport.camera = BookmarkedCamera(session, self._eye, self.scene, self.header, self._go)
        self._stack = QStackedWidget(self)
        self._reason = wrapped(named(Label(parent=self._stack), "viewport_reason"))
        self._reason.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._reason.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._reason.setMargin(24)
        self._stack.addWidget(self._reason)
        video = (BesideVideo(session, self._stack, self), 1), VideoStrip(session, self)
        in_column(self.header, *video, of=self, margins=0, spacing=0)

        self._canvas: Canvas | None = None
        self._layer: Layer | None = None
        self._pointer: Pointer | None = None
        self._failure = self._start_gl()
        self._ticker = QTimer(self, interval=FRAME_MS)
        self._ticker.timeout.connect(self._tick)
        self._waiter = QTimer(self, interval=WAIT_MS)
        self._waiter.timeout.connect(self.poses_changed)
        self._live = QTimer(self, interval=FRAME_MS)
        self._live.timeout.connect(self._show_live)
        self._listen()
        self._apply_theme()
        self.texted(self, title="viewport_panel.viewport", name="viewport_panel.viewport")
        self.retranslate()
        if self._canvas is not None:
            self.scene.load()

    def _listen(self) -> None:
        session, scene = self._session, self.scene
        session.changed.connect(self._project_changed)
        session.performance_changed.connect(self._performance_changed)
        session.instruments_changed.connect(self._instruments_changed)
        session.characters_changed.connect(self._instruments_changed)
        session.players_changed.connect(self._players_changed)
        session.dancer_changed.connect(self._update)
        session.selection_changed.connect(self._selection_changed)
        session.playhead_changed.connect(self.refresh)
        session.playing_changed.connect(self._update)
        session.preview_changed.connect(self.refresh)
        session.theme_changed.connect(self._apply_theme)
        session.live_players.changed.connect(self._live_changed)
        session.live_players.struck.connect(self._struck)
        session.video.changed.connect(self._update)
        session.video.pictured.connect(self._video_pictured)
        session.viewport.changed.connect(self._state_changed)
        session.viewport.viewed.connect(self._view_asked)
        session.viewport.framed.connect(self._frame_asked)
        session.viewport.turned.connect(self._turn)
        session.viewport.dollied.connect(self._dolly)
        scene.staged.connect(self._staged)
        scene.shown.connect(self._place_camera)
        scene.refined.connect(self._update)
        if self._pointer is not None:
            self._pointer.moved.connect(self._update)
            self._pointer.posed.connect(self.refresh)
            self._pointer.released.connect(self.refresh)
            self._pointer.menu_asked.connect(lambda at: offer_actions(session, MENU, self, "viewport_menu", at))
            self._pointer.framed.connect(lambda row: self._frame([row]))

    # Requests of other parts

    @property
    def has_gl(self) -> bool:
        """True if players can be drawn."""
        return self._canvas is not None

    @property
    def camera(self) -> Camera:
        """The camera, or the camera at the end of its flight."""
        return self._eye.destination

    @property
    def hovered(self) -> str | None:
        """Id of the player or dancer under the pointer."""
        stage, row = self.scene.stage, self._pointer.hovered if self._pointer is not None else None
        return None if stage is None or row is None else stage.members[row].player_id

    def canvas_widget(self) -> QWidget | None:
        """The widget in which the stage is drawn; None without GL."""
        native: QWidget | None = self._canvas.native if self._canvas is not None else None
        return native

    def handle_places(self) -> dict[str, QPointF]:
        """Return the positions of the pose tool's handles in the picture in pixels, by handle."""
        widget, found = self.canvas_widget(), self.scene.handles()
        if widget is None or not found:
            return {}
        places, _ = self._eye.camera.project(np.array([item.at_m for item in found]), widget.width(), widget.height())
        return {item.target: QPointF(*place) for item, place in zip(found, places, strict=True)}

    def message(self) -> str:
        """Return the text shown instead of a picture or in its middle; empty if there is none."""
        return self._reason.text() if self._failure is not None else self.scene.message()

    def set_poses(self, poses: PoseSource) -> None:
        """Set the source of poses."""
        self.scene.set_poses(poses)
        self.refresh()

    def poses_changed(self) -> None:
        """Redraw after new motion has been computed for the playhead's time."""
        if self._canvas is None:
            return
        at_s = self._session.playhead_s
        resting = self.scene.missing and self._canvas.rested_s < REST * self._canvas.drawing_s
        if (resting and self.scene.lacks(at_s)) or not self.scene.is_outdated(at_s):
            self._wait()
        else:
            self.refresh()

    def draw_now(self) -> None:
        """Draw the poses at the playhead immediately, unless drawing is slow; then it is done after the panels are
        updated.
        """
        if self._canvas is not None and self._canvas.drawing_s < QUICK_S:
            self.scene.pose(self._session.playhead_s)
            self._canvas.draw_now()

    def refresh(self) -> None:
        """Show the poses at the playhead."""
        if self._canvas is None:
            return
        self.scene.pose(self._session.playhead_s)
        self._wait()
        self._follow()
        self._update()

    def render_image(self, width: int, height: int, time_s: float, view: View | None = None) -> npt.NDArray[np.uint8]:
        """Return an image (height, width, 4) of the stage at ``time_s`` with the names and marks of the window, in the
        present view unless another is given.
        """
        return self.film(width, height, (time_s, time_s), view, True)(time_s)

    def film(
        self,
        width: int,
        height: int,
        span_s: tuple[float, float],
        view: View | CameraBookmark | None = None,
        marked: bool = False,
        player_ids: tuple[str, ...] | None = None,
        cameras: dict[float, Camera] | None = None,
    ) -> Draw:
        """Return a function that draws a film's pictures in order.

        Parameters
        ----------
        width, height : int
            Pixels.
        span_s : (float, float)
            Range of the pictures in seconds of the performance.
        view : View or CameraBookmark, optional
            View of the film; by default the present camera.
        marked : bool
            Whether to draw the names and marks of the window, and rings around selected players.
        player_ids : tuple of str, optional
            Performers that the view is about; by default the selected players.
        cameras : dict of float to Camera, optional
            Cameras by time: the first film of a span adds them, and another film then uses the same.

        Returns
        -------
        callable
            Function from a time in seconds to a picture (height, width, 4) uint8.

        Raises
        ------
        AppError
            GL does not work, or figures are still being loaded; the returned function raises this too.
        """
        self._require_stage()
        chosen = self._session.players if player_ids is None else player_ids
        if isinstance(view, CameraBookmark):
            shot = shot_of(view, chosen, self._session.project, cameras)
        elif cameras and view is not None:
            shot = Shot(view, self._eye.camera, chosen, cameras=cameras)
        else:
            shot = self._shot(view, width / height, span_s, chosen, cameras)
        shot.marked = marked
        return partial(self._render, width, height, shot)

    def _require_stage(self) -> tuple[Canvas, Stage]:
        if self._canvas is None:
            raise AppError("picture.no_gl", reason=self._failure or "")
        if self.scene.stage is None:
            raise AppError("picture.loading")
        return self._canvas, self.scene.stage

    def _render(self, width: int, height: int, shot: Shot, time_s: float) -> npt.NDArray[np.uint8]:
        canvas, stage = self._require_stage()
        shown = self.scene.poses()
        self.scene.pose_now(time_s)
        try:
            camera = shot.camera_at(stage, time_s)
            self._elsewhere = (camera, shot)
            picture = canvas.render_image(width, height)
            if picture is None:
                raise AppError("picture.no_gl", reason=self._failure or "QOpenGLContext")
            marks = self.scene.marks(camera) if shot.marked else None
            if not marks:
                return picture
            image = QImage(picture.data, width, height, 4 * width, QImage.Format.Format_RGBA8888)
            painter = QPainter(image)
            painter.setFont(self.font())
            paint(painter, marks, stage, camera, (width, height), self._session.tokens)
            painter.end()
            return pixels(image)
        finally:
            # The display in this window has not changed.
            self._elsewhere = None
            self.scene.take(shown)

    def _shot(
        self,
        view: View | None,
        aspect: float,
        span_s: tuple[float, float],
        player_ids: tuple[str, ...],
        cameras: dict[float, Camera] | None,
    ) -> Shot:
        """Return the camera of a film: that of a view, or if None the window's."""
        if view is None:
            return Shot(self._eye.view, self._eye.camera, player_ids, self._eye.centred(np.zeros(3)))
        _, stage = self._require_stage()
        shown = self.scene.poses()
        looked_at = tuple(shown) if view == "ensemble" else player_ids

        def posed() -> Iterator[Stage]:
            for time_s in times_looked_at(len(looked_at), *span_s):
                self.scene.pose_now(time_s, looked_at)
                yield stage

        try:
            camera = replace(self._eye.camera, fov_deg=Camera().fov_deg)
            steady = steady_camera(view, posed(), stage.rows(player_ids), camera, aspect)
            return Shot(view, steady, player_ids, cameras=cameras)
        finally:
            self.scene.take(shown)

    # GL

    def _start_gl(self) -> str | None:
        """Make the canvas; return the reason if GL does not work, else None."""
        reason = why_no_gl()
        if reason is not None:
            return reason
        try:
            canvas = Canvas(self._picture, self._drawing_failed, self.scene.refine)
        except Exception as error:  # noqa: BLE001  Drivers and vispy fail in many ways; the editor works without.
            return f"{type(error).__name__}: {error}"
        native: QWidget = canvas.native
        native.setObjectName("viewport_canvas")
        native.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        native.setMinimumSize(LEAST_SIZE)
        native.installEventFilter(self)
        self._canvas = canvas
        self._stack.addWidget(native)
        self._stack.setCurrentWidget(native)
        self._pointer = Pointer(native, self._session, self._eye, self.scene, self._tool)
        self._layer = Layer(native, self._paint)
        return None

    def _drawing_failed(self, reason: str) -> None:
        self._failure = reason
        # Deferred until Qt has finished painting the widget to be removed.
        QTimer.singleShot(0, self, self._give_up)

    def _give_up(self) -> None:
        self._canvas = self._layer = self._pointer = None
        for timer in (self._ticker, self._waiter, self._live):
            timer.stop()
        self._stack.setCurrentWidget(self._reason)
        self.retranslate()

    def _picture(self, width: int, height: int) -> Picture:
        """Return camera, look and emphasis of the present picture, for the canvas."""
        stage, pointer, session = self.scene.stage, self._pointer, self._session
        here = self._elsewhere is None
        camera, view, marked = self._eye.camera, self._eye.view, True
        rows = self.scene.viewed_rows(view)
        if self._elsewhere is not None and stage is not None:
            camera, shot = self._elsewhere
            view, rows, marked = shot.view, stage.rows(shot.player_ids), shot.marked
        moving = (
            session.playing or self._live.isActive() or self._eye.flying or (pointer is not None and pointer.dragging)
        )
        emphasis = Emphasis(
            rings=self.scene.rings(pointer.hovered if pointer is not None and here else None) if marked else {},
            podium=self.scene.podium() if marked else None,
            in_the_way=in_the_way(view, stage, rows, camera) if stage is not None else {},
            wireframe=session.viewport.shows("wireframe"),
            props=session.viewport.shows("props"),
            video=session.video.picture if here and session.video.placement == "behind" else None,
            video_opacity=session.video.opacity,
            is_final=not here,
            in_motion=moving and here,
        )
        return camera, look_of(session.tokens), emphasis

    def _paint(self, painter: QPainter, size: tuple[float, float]) -> None:
        """Paint names and marks over the picture, or a message instead; ``size`` is width and height in pixels."""
        message, stage = self.scene.message(), self.scene.stage
        if message:
            painter.setPen(QColor(self._session.tokens.text_dim))
            box = QRectF(0.0, 0.0, *size).adjusted(24.0, 24.0, -24.0, -24.0)
            painter.drawText(box, int(Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap), message)
        elif stage is not None:
            camera = self._eye.camera
            paint(painter, self.scene.marks(camera), stage, camera, size, self._session.tokens)

    def _update(self) -> None:
        """Request a redraw."""
        if self._canvas is not None:
            self._canvas.update()
        if self._layer is not None:
            self._layer.refresh(bool(self.scene.message()) or self._has_marks())

    def _video_pictured(self) -> None:
        if self._session.video.placement == "behind":
            self._update()

    def _selection_changed(self) -> None:
        # Only handles of poses refer to the selected span.
        if self._session.viewport.posing:
            self._update()

    def _has_marks(self) -> bool:
        state = self._session.viewport
        return state.posing or any(state.shows(what) for what in SHOWN if what not in ("wireframe", "props"))

    # Camera

    def _tracked(self) -> FloatArray | None:
        """Return the point (3,) in the world that the view keeps in the middle; None if it follows nothing."""
        stage, rows = self.scene.stage, self.scene.viewed_rows(self._eye.view)
        return tracked(self._eye.view, stage, rows[0]) if stage is not None and rows else None

    def _needed_m(self) -> float | None:
        """Return the distance in metres at which all of a close-up is visible; None if it is constant."""
        stage, rows, widget = self.scene.stage, self.scene.rows(), self.canvas_widget()
        if stage is None or not rows or widget is None:
            return None
        aspect = widget.width() / max(widget.height(), 1)
        return needed_distance_m(self._eye.view, stage, rows[0], self._eye.camera, aspect)

    def _view_camera(self) -> Camera:
        stage, widget = self.scene.stage, self.canvas_widget()
        if stage is None or widget is None:
            return self._eye.camera
        aspect = widget.width() / max(widget.height(), 1)
        return view_camera(self._eye.view, stage, self.scene.viewed_rows(self._eye.view), self._eye.camera, aspect)

    def _place_camera(self) -> None:
        """Place the camera by the view, unless the user has moved it."""
        stage = self.scene.stage
        if not self._eye.touched and stage is not None and stage.shown.any():
            self._eye.jump(self._view_camera())

    def _go(self, camera: Camera) -> None:
        if self.isVisible() and self._canvas is not None:
            self._eye.fly(camera, perf_counter())
            self._ticker.start()
        else:
            self._eye.jump(camera)
        self._update()

    def _follow(self) -> None:
        """Move a close-up towards its player."""
        dragging = self._pointer is not None and self._pointer.dragging
        if self._eye.follow(None if dragging else self._tracked(), perf_counter(), self._needed_m()):
            self._ticker.start()

    def _tick(self) -> None:
        """Draw the next picture of a flight, or of following after the playhead has stopped."""
        if not self._eye.advance(perf_counter()):
            self._ticker.stop()
            self._follow()
        self._update()

    def _wait(self) -> None:
        """Check for new poses repeatedly, as long as a pose is missing or may still change after an edit."""
        stage, changing = self.scene.stage, self.scene.missing or perf_counter() < self._settle_until_s
        waiting = changing and stage is not None and bool(stage.members)
        if waiting and not self._waiter.isActive():
            self._waiter.start()
        elif not waiting:
            self._waiter.stop()

    # Changes of the session

    def _project_changed(self, change: Change) -> None:
        if change.opened:
            self._tool.release()
            self.scene.leave()
            self._session.viewport.set(bookmarks=())
            self._session.viewport.set_view("ensemble")
        if self._canvas is not None and (change.opened or cast_key(change.before) != cast_key(change.after)):
            self.scene.load()
        self._update()

    def _staged(self) -> None:
        loaded = self.scene.loaded
        if self._canvas is None or self._pointer is None:
            return
        self._pointer.forget()
        if loaded is not None and loaded.stage.members:
            self._canvas.prepare(lambda renderer: self._send(renderer, loaded))
        else:
            self._canvas.clear_stage()
        self.refresh()

    def _send(self, renderer: Renderer, loaded: DrawableFigures) -> None:
        renderer.set_stage(loaded.stage, loaded.shapes, loaded.crowd)
        self.scene.sent(loaded.shapes)

    def _instruments_changed(self) -> None:
        if self._canvas is not None:
            self.scene.load()

    def _performance_changed(self) -> None:
        self._settle_until_s = perf_counter() + SETTLED_S
        self.refresh()

    def _live_changed(self) -> None:
        """Start drawing continuously when a player plays live, and stop when none does."""
        if self._session.live_players.is_shown and self._canvas is not None:
            self._live.start()
        else:
            self._live.stop()
        self.refresh()

    def _struck(self) -> None:
        """Redraw immediately when a live player begins a note."""
        if self._live.isActive():
            self._live.start()
            self.refresh()

    def _show_live(self) -> None:
        if not self._session.live_players.is_shown:
            # Players played live return to the performance.
            self._live.stop()
            self.refresh()
        # During playback each change of the playhead draws anyway.
        if not self._session.playing:
            self.refresh()

    def _players_changed(self) -> None:
        if self._eye.view != "ensemble":
            self._eye.choose(self._eye.view)
            self._go(self._view_camera())
        self._update()

    def _state_changed(self) -> None:
        if not self._session.viewport.posing:
            self._tool.cancel()
        self._show_note()
        self._update()

    def _view_asked(self) -> None:
        self._eye.choose(self._session.viewport.view)
        if self.scene.stage is not None:
            self._go(self._view_camera())

    def _turn(self) -> None:
        """Move the camera to the other side: from the front to the back, or to the mirror image of another view."""
        stage, rows = self.scene.stage, self.scene.rows()
        if stage is not None:
            self._eye.touched = True
            self._go(from_other_side(self._eye.destination, turn_rad(stage, rows[0]) if rows else 0.0))

    def _dolly(self, steps: float) -> None:
        """Move the camera towards its target, or away from it for negative ``steps``."""
        self._eye.touched = True
        self._go(dolly(self._eye.destination, steps))

    def _frame_asked(self, selected: bool) -> None:
        """Move the camera, keeping its direction, so that all or the selected players fill the picture."""
        self._frame(self.scene.visible(selected))

    def _frame(self, rows: Sequence[int]) -> None:
        stage, widget = self.scene.stage, self.canvas_widget()
        if stage is None or widget is None or not rows:
            return
        self._eye.choose("ensemble")
        self._eye.touched = True
        camera = self._framing(stage, widget, rows)
        self._framed = camera, rows
        self._go(camera)

    def _framing(self, stage: Stage, widget: QWidget, rows: Sequence[int]) -> Camera:
        return frame_points(self._eye.destination, corners(stage, rows), widget.width() / max(widget.height(), 1))

    def _resized(self) -> None:
        """Place the camera for the new size by the view, or again around the performers that were framed."""
        stage, widget = self.scene.stage, self.canvas_widget()
        framed, rows = self._framed
        if framed != self._eye.destination or stage is None or widget is None or max(rows) >= len(stage.members):
            self._place_camera()
            return
        camera = self._framing(stage, widget, rows)
        self._framed = camera, rows
        self._eye.jump(camera)

    # Appearance and language

    def _apply_theme(self) -> None:
        tokens = self._session.tokens
        self._reason.setStyleSheet(f"background: {tokens.sunken}; color: {tokens.text};")
        self._update()

    def _show_note(self) -> None:
        note = ""
        if self._session.viewport.posing:
            note = self.tr("viewport_panel.drag_handle_shift_finely_alt")
        self.header.set_note(note)

    def retranslate(self) -> None:
        if self._failure is not None:
            self._reason.setText(self.tr("viewport_panel.players_cannot_be_drawn_here").format(reason=self._failure))
        self._show_note()
        self._update()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Place the camera again when the canvas is resized, unless the user has moved it since."""
        if event.type() == QEvent.Type.Resize:
            self._resized()
        return super().eventFilter(watched, event)
