"""The viewport without a window, for pictures on the command line."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from PySide6.QtCore import QCoreApplication, QEvent
from PySide6.QtGui import QColor, QFont, QFontMetrics, QImage, QPainter, QTransform
from PySide6.QtWidgets import QApplication

from app.editor.design_tokens import THEMES, Tokens
from app.editor.session import Session
from app.errors import AppError, Cancelled, Message, Progress, StopRequested, raise_if_stopped
from app.export.pictures import Picture
from app.performance.cast import LeftOut
from app.performance.chunks import Pose, Posed
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion, PlayerFault
from app.project.camera_bookmarks import CameraBookmark, View
from app.project.performers import Player
from widgets.common.font import apply_font
from widgets.viewport.camera import Camera
from widgets.viewport.canvas import pixels, why_no_gl
from widgets.viewport.panel import Draw, ViewportPanel

T = TypeVar("T")

_CAPTION_PX = (10, 24)
"""Least and greatest font size in pixels of captions."""
_CAPTION_PER_WIDTH = 1 / 26
_DOT = " · "
"""Separator between parts of a caption."""


class Offscreen:
    """Draws a project's players in an invisible viewport; see `offscreen`."""

    def __init__(
        self, performance: Performance, theme: str, stop_requested: StopRequested, posed: Posed | None = None
    ) -> None:
        project = performance.project
        self._live = LiveMotion(performance)
        self._session = Session(project, _AtOnce(stop_requested))
        self._session.set_tokens(THEMES[theme])
        self._panel = ViewportPanel(self._session, _MadePoses(self._live, stop_requested, posed))
        # In a large piece only the player in front has been loaded.
        self._panel.scene.load()

    def film(
        self,
        size: tuple[int, int],
        span_s: tuple[float, float],
        view: View | CameraBookmark,
        player_ids: tuple[str, ...],
        cameras: dict[float, Camera] | None = None,
        marked: bool = True,
    ) -> Draw:
        """Return a function that draws the pictures of a film; see `ViewportPanel.film`."""
        selected = tuple(own for own in player_ids if own not in self._session.project.dancer_ids)
        self._session.set_players(selected if marked else ())
        self._session.viewport.show("names", marked)
        return self._panel.film(*size, span_s, view, marked, player_ids, cameras)

    @property
    def left_out(self) -> list[LeftOut]:
        """Return the performers that could not be drawn so far."""
        found = list[LeftOut]()
        loaded = self._panel.scene.loaded
        unseen = {} if loaded is None else {one.player.id: one.reason for one in loaded.left_out}
        for performer in self._session.project.performers:
            lacking = self._live.performance.lacking(performer) if isinstance(performer, Player) else ()
            # Named as in exports and reports.
            reason = next(iter(lacking), None) or self._live.error(performer.id) or unseen.get(performer.id)
            if reason is not None:
                found.append(LeftOut(performer, reason))
        return found

    def shows(self, player_ids: tuple[str, ...]) -> bool:
        """Return whether any of these players can be drawn; any player at all if none is given."""
        stage = self._panel.scene.stage
        return stage is not None and bool(stage.rows(player_ids) if player_ids else stage.members)

    def close(self) -> None:
        """Close the 3D view and free its graphics memory."""
        self._panel.close()
        self._panel.deleteLater()
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete.value)


@contextlib.contextmanager
def offscreen(
    performance: Performance, theme: str, stop_requested: StopRequested, posed: Posed | None = None
) -> Iterator[Offscreen]:
    """Yield an invisible viewport of a performance's project.

    Parameters
    ----------
    posed : Posed, optional
        Changes the poses of the performance before they are drawn.

    Raises
    ------
    AppError
        GL does not work.
    Cancelled
    """
    application = QApplication.instance() or QApplication(["suisou"])
    assert isinstance(application, QApplication)
    apply_font(application)
    reason = why_no_gl()
    if reason is not None:
        raise AppError("picture.film_no_gl", reason=reason)
    made = Offscreen(performance, theme, stop_requested, posed)
    try:
        yield made
    finally:
        made.close()


def captions(texts: Sequence[tuple[str, str]], width: int, theme: str) -> list[Picture]:
    """Return captions for pictures of a width: two lines of text each, the second one fainter. If a first line is too
    wide, all are broken at their middle dots.

    Returns
    -------
    list of (H, width, 4) uint8
        Captions of equal height.
    """
    tokens: Tokens = THEMES[theme]
    font = QFont(QApplication.font())
    least, most = _CAPTION_PX
    font.setPixelSize(round(min(max(width * _CAPTION_PER_WIDTH, least), most)))
    metrics = QFontMetrics(font)
    step, margin = metrics.height(), metrics.descent()
    lines: list[tuple[tuple[str, str], ...]] = [
        ((first, tokens.text), (second, tokens.text_dim)) for first, second in texts
    ]
    if any(metrics.horizontalAdvance(first) > width - margin for first, _ in texts):
        lines = [
            (*((part, tokens.text) for part in first.split(_DOT)), (second, tokens.text_dim)) for first, second in texts
        ]
    height = step * max(map(len, lines), default=0) + margin
    found = []
    for rows in lines:
        image = QImage(width, height, QImage.Format.Format_RGBA8888)
        image.fill(QColor(tokens.sunken))
        painter = QPainter(image)
        painter.setFont(font)
        for row, (line, color) in enumerate(rows):
            painter.setPen(QColor(color))
            # A text still wider than its picture is condensed.
            narrower = min(1.0, (width - 2.0 * margin) / max(metrics.horizontalAdvance(line), 1))
            painter.setTransform(QTransform(narrower, 0.0, 0.0, 1.0, margin, metrics.ascent() + row * step))
            painter.drawText(0, 0, line)
        painter.end()
        found.append(pixels(image))
    return found


class _MadePoses:
    """Poses of a performance, computed when requested, in chunks of frames."""

    def __init__(self, live: LiveMotion, stop_requested: StopRequested, posed: Posed | None) -> None:
        self._live, self._stop_requested, self._posed = live, stop_requested, posed

    def poses(self, player_ids: Sequence[str], time_s: float) -> Sequence[Pose | None]:
        """Return the pose of each player at a time if it is computed, else None (see
        `app.editor.poses.PoseSource.poses`).
        """
        poses = self._live.poses(player_ids, time_s)
        return [self._seen(*one, time_s) for one in zip(player_ids, poses, strict=True)]

    def _seen(self, player_id: str, pose: Pose | None, time_s: float) -> Pose | None:
        return pose if pose is None or self._posed is None else self._posed(player_id, time_s, pose)

    def pose_now(self, player_id: str, time_s: float) -> Pose | None:
        """Return a player's pose at a time, waiting until it is computed. Raises Cancelled if stopped."""
        live = self._live
        live.request(time_s, 0.0)
        while not live.is_seen:
            raise_if_stopped(self._stop_requested)
            # A player stopped by a fault of the program is excluded, with the reason.
            with contextlib.suppress(PlayerFault):
                if not live.work():
                    break
        return (
            None
            if live.error(player_id) is not None
            else self._seen(player_id, live.pose_now(player_id, time_s), time_s)
        )


class _AtOnce:
    """Task runner that runs work immediately instead of in the background, since there is no window."""

    def __init__(self, stop_requested: StopRequested) -> None:
        self._stop_requested = stop_requested

    @property
    def writing(self) -> tuple[Message, ...]:
        """Return an empty tuple, since work is never in the background."""
        return ()

    def run(
        self,
        name: Message,
        work: Callable[[Progress, StopRequested], T],
        done: Callable[[T], None],
        failed: Callable[[AppError], None] | None = None,
        key: str | None = None,
        ended: Callable[[], None] | None = None,
        *,
        writes: bool = False,
    ) -> None:
        """Run work and pass the result to ``done``; see `app.editor.tasks.Tasks.run`. Errors without ``failed`` are
        raised, also Cancelled.
        """
        try:
            result = work(lambda share: None, self._stop_requested)
        except Cancelled:
            raise
        except AppError as error:
            if failed is None:
                raise
            failed(error)
        else:
            done(result)
        finally:
            if ended is not None:
                ended()
