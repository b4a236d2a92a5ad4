"""Plot of a motion's angular acceleration over time, with cuts that can be moved, added and deleted.

Mouse events are handled here instead of by pyqtgraph, to agree with the timeline: the wheel scrolls, and zooms with
Ctrl; the middle button pans.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final, Literal

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QEvent, QObject, QPointF, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.arrays import FloatArray
from app.choreography.cuts_by_hand import (
    Cuts,
    added_bound,
    automatic_accent,
    bounds,
    extrema,
    moved_accent,
    moved_bound,
    removed_bound,
)
from app.editor.session import Session
from widgets.common.layouts import in_column

NEAR_PX: Final = 6.0
SNAP_PX: Final = 12.0
ZOOM: Final = 1.2
LEAST_SPAN_S: Final = 0.2
_ROOM: Final = 1.12
"""Height of the plot relative to the greatest acceleration."""
_HITS_PART: Final = 0.1
"""Share of the plot's height, at the bottom, for the hits of the music."""
_STEP: Final = 120
_AXIS_PX: Final = 40

Kind = Literal["bound", "accent"]
KINDS: Final[tuple[Kind, ...]] = ("bound", "accent")
_LEFT, _MIDDLE = Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton


@dataclass(frozen=True)
class CutLine:
    """A line of the plot by its index: a boundary or an accent of a basic motion."""

    kind: Kind
    number: int


@dataclass(frozen=True, eq=False)
class _Drag:
    """Drag of a line, or of the visible range if the line is None."""

    line: CutLine | None
    cuts: Cuts
    x_px: float
    view_s: tuple[float, float]


class CutPlot(QWidget):
    """Plot of a motion's acceleration with cuts and music.

    Signals
    -------
    edited(tuple of Cut, object)
        The user changed the cuts; the object is a token shared by all changes of one drag, None for others.
    pointed(int)
        The mouse is over this frame, or a line was moved to it.
    scrubbed(float)
        The mouse was pressed or dragged in the time axis, at this time of the motion file in seconds.

    Parameters
    ----------
    session : Session
        Session with the theme's colours.
    """

    edited = Signal(object, object)
    pointed = Signal(int)
    scrubbed = Signal(float)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self.snaps = True
        """True if dragged lines stop at nearby minima, and accents at maxima."""
        self._curve: FloatArray = np.zeros(0)
        self._fps, self._start_s = Fraction(60), 0.0
        self._hits_s: FloatArray = np.zeros(0)
        self._extrema: dict[Kind, FloatArray] = {"bound": np.zeros(0), "accent": np.zeros(0)}
        self._cuts: Cuts = ()
        self._selected: CutLine | None = None
        self._drag: _Drag | None = None
        self._token: object = None
        self._scrubs = False
        # A GraphicsView instead of a PlotWidget, which would create menus that are never shown.
        self.plot: Any = pg.GraphicsView(self)
        self.plot.setObjectName("cut_plot")
        self.view: Any = pg.ViewBox(enableMenu=False, enableMouse=False)
        self._axes: tuple[Any, Any] = pg.AxisItem("left", linkView=self.view), pg.AxisItem("bottom", linkView=self.view)
        self._items: dict[str, Any] = {
            name: pg.PlotCurveItem(connect="all" if name == "curve" else "pairs")
            for name in ("hits", "curve", "bound", "accent", "selected", "playhead")
        }
        self._dots: Any = pg.ScatterPlotItem(size=7, pen=None)
        self._unfit_spans: tuple[tuple[int, int], ...] = ()
        self._unfit: Any = pg.BarGraphItem(x0=[], x1=[], height=[], pen=None)
        in_column(self.plot, of=self, margins=0)
        self._build()
        self._apply_theme()
        self.show_motion(np.zeros(0), Fraction(60), 0.0, np.zeros(0))
        session.theme_changed.connect(self._apply_theme)

    def _build(self) -> None:
        area: Any = pg.GraphicsLayout()
        area.addItem(self._axes[0], 0, 0)
        area.addItem(self.view, 0, 1)
        area.addItem(self._axes[1], 1, 1)
        area.setContentsMargins(4.0, 6.0, 4.0, 0.0)
        self.plot.setCentralItem(area)
        self.plot.setMinimumHeight(120)
        self.plot.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        for item in (self._unfit, *self._items.values(), self._dots):
            self.view.addItem(item)
        for axis in self._axes:
            axis.enableAutoSIPrefix(False)
        self._axes[0].setWidth(_AXIS_PX)
        self.plot.viewport().setMouseTracking(True)
        for widget in (self.plot, self.plot.viewport()):
            # Files are dropped on the dialog.
            widget.setAcceptDrops(False)
        self.plot.installEventFilter(self)
        self.plot.viewport().installEventFilter(self)

    # Display

    @property
    def cuts(self) -> Cuts:
        """The cuts of the motion that the plot displays."""
        return self._cuts

    @property
    def unfit(self) -> tuple[tuple[int, int], ...]:
        """Spans (start, stop) of frames that are excluded from learning, which the plot shades."""
        return self._unfit_spans

    @property
    def selected(self) -> CutLine | None:
        """The selected line, which the arrow keys move; None if none is selected."""
        return self._selected

    def show_motion(self, curve_rad_s2: FloatArray, fps: Fraction, start_s: float, hits_s: FloatArray) -> None:
        """Show another motion completely.

        Parameters
        ----------
        curve_rad_s2 : (F,) float64
            Angular acceleration at each frame.
        fps : Fraction
            Frames per second.
        start_s : float
            Time in seconds of the motion file's first frame.
        hits_s : (H,) float64
            Times of the motion file in seconds at which percussion sounds.
        """
        self._curve, self._fps, self._start_s = curve_rad_s2, fps, start_s
        minima, maxima = extrema(curve_rad_s2) if len(curve_rad_s2) else (np.zeros(0, np.int64),) * 2
        self._extrema = {"bound": minima.astype(np.float64), "accent": maxima.astype(np.float64)}
        self._cuts, self._selected, self._drag = (), None, None
        self._items["curve"].setData(start_s + np.arange(len(curve_rad_s2)) / float(fps), curve_rad_s2)
        self.view.setYRange(0.0, self._top, padding=0.0)
        for axis in self._axes:
            axis.setStyle(showValues=len(curve_rad_s2) > 0)
        self.show_hits(hits_s)
        self._draw()
        self.fit()

    def show_unfit(self, spans: Sequence[tuple[int, int]]) -> None:
        """Shade spans of frames that are excluded from learning."""
        self._unfit_spans = tuple(spans)
        starts, stops = (self.time_s([span[end] for span in spans]) for end in (0, 1))
        self._unfit.setOpts(x0=starts, x1=stops, height=np.full(len(spans), self._top))

    def show_hits(self, hits_s: FloatArray) -> None:
        """Draw percussion hits of the music at times (N,) in seconds."""
        self._hits_s = hits_s
        self._items["hits"].setData(*_uprights(hits_s, np.full(len(hits_s), _HITS_PART * self._top)))

    def show_playhead(self, time_s: float | None) -> None:
        """Draw the playhead at a time in seconds; None hides it."""
        times_s = np.array([] if time_s is None else [time_s], np.float64)
        self._items["playhead"].setData(*_uprights(times_s, np.full(len(times_s), self._top)))

    def show_cuts(self, cuts: Cuts) -> None:
        """Replace the cuts that the plot displays."""
        self._cuts = cuts
        if self._selected is not None and self._selected.number >= len(self._frames(self._selected.kind)):
            self._selected = None
        self._draw()

    @property
    def _top(self) -> float:
        return _ROOM * max(float(self._curve.max(initial=0.0)), 1.0)

    def _draw(self) -> None:
        ends, accents = np.array(bounds(self._cuts), np.int64), np.array(self._frames("accent"), np.int64)
        heights = self._curve[accents] if len(accents) else np.zeros(0)
        self._items["bound"].setData(*_uprights(self.time_s(ends), np.full(len(ends), self._top)))
        self._items["accent"].setData(*_uprights(self.time_s(accents), heights))
        self._dots.setData(self.time_s(accents), heights)
        chosen = [] if self._selected is None else [self._frames(self._selected.kind)[self._selected.number]]
        self._items["selected"].setData(*_uprights(self.time_s(np.array(chosen)), np.full(len(chosen), self._top)))

    def _frames(self, kind: Kind) -> tuple[int, ...]:
        return bounds(self._cuts) if kind == "bound" else tuple(cut.accent for cut in self._cuts)

    def fit(self) -> None:
        """Zoom the plot out to the whole motion."""
        self._look(self._start_s, self._start_s + max(LEAST_SPAN_S, (len(self._curve) - 1) / float(self._fps)))

    def zoom(self, factor: float, at_s: float) -> None:
        """Zoom by a factor around a time in seconds."""
        left, right = self._span_s()
        self._look(at_s + (left - at_s) / factor, at_s + (right - at_s) / factor)

    def _span_s(self) -> tuple[float, float]:
        left, right = self.view.viewRange()[0]
        return float(left), float(right)

    def _look(self, left_s: float, right_s: float) -> None:
        """Show a range of seconds, limited to the motion and to at least `LEAST_SPAN_S`."""
        first, last = self._start_s, self._start_s + max(LEAST_SPAN_S, (len(self._curve) - 1) / float(self._fps))
        span = min(max(right_s - left_s, LEAST_SPAN_S), last - first)
        middle = (left_s + right_s) / 2.0
        left = min(max(middle - span / 2.0, first), last - span)
        self.view.setXRange(left, left + span, padding=0.0)

    # Conversion of frames and pixels

    def time_s(self, frames: Any) -> Any:
        """Convert frame indices to times of the motion file in seconds."""
        return self._start_s + np.asarray(frames, np.float64) / float(self._fps)

    def x_px(self, frame: float) -> float:
        """Return the x position of a frame in pixels of the plot's viewport."""
        point = self.view.mapViewToScene(QPointF(float(self.time_s(frame)), 0.0))
        return float(self.plot.viewportTransform().map(point).x())

    def _time_at(self, x_px: float) -> float:
        inverse, _ = self.plot.viewportTransform().inverted()
        return float(self.view.mapSceneToView(inverse.map(QPointF(x_px, 0.0))).x())

    def frame_at(self, x_px: float) -> int:
        """Return the frame at an x position of the plot's viewport."""
        return self.frame_of(self._time_at(x_px))

    def frame_of(self, time_s: float) -> int:
        """Return the frame at a time of the motion file, limited to the motion."""
        frame = round((time_s - self._start_s) * float(self._fps))
        return min(max(frame, 0), max(len(self._curve) - 1, 0))

    def _line_at(self, x_px: float) -> CutLine | None:
        """Return the line under the mouse, the nearest of several; None if there is none."""
        # In frames: asking the view for the position of each line takes longer than drawing them.
        frame_px = max(self.x_px(1.0) - self.x_px(0.0), 1e-9)
        under = (x_px - self.x_px(0.0)) / frame_px
        found: list[tuple[float, CutLine]] = []
        for kind in KINDS:
            frames = self._frames(kind)
            if frames:
                aside = np.abs(np.array(frames) - under)
                number = int(np.argmin(aside))
                found.append((float(aside[number]) * frame_px, CutLine(kind, number)))
        near, line = min(found, key=lambda one: one[0], default=(math.inf, None))
        return line if near <= NEAR_PX else None

    def _is_axis(self, event: QMouseEvent) -> bool:
        """Return whether the mouse is in the time axis, below the curve."""
        bottom = self.plot.viewportTransform().map(self.view.sceneBoundingRect().bottomLeft()).y()
        return bool(event.position().y() > bottom)

    # Editing

    def _move(self, line: CutLine, cuts: Cuts, frame: int, token: object) -> None:
        """Move a line of cuts to a frame."""
        if line.kind == "bound":
            moved = moved_bound(cuts, bounds(cuts)[line.number], frame, len(self._curve))
        else:
            moved = moved_accent(cuts, cuts[line.number].accent, frame)
        self._selected = line
        self._ask(moved, token)

    def _ask(self, cuts: Cuts, token: object = None) -> None:
        if cuts != self._cuts:
            # `show_cuts` delivers the edited cuts.
            self.edited.emit(cuts, token)
        else:
            self._draw()
        if self._selected is not None:
            self.pointed.emit(self._frames(self._selected.kind)[self._selected.number])

    def add(self, frame: int) -> None:
        """Add a cut of the motion at a frame."""
        cuts = added_bound(self._cuts, frame, self._curve)
        if cuts != self._cuts:
            self._selected = CutLine("bound", bounds(cuts).index(frame))
            self._ask(cuts)

    def delete(self) -> None:
        """Delete the selected cut, or move a selected accent to the greatest acceleration."""
        line = self._selected
        if line is None:
            return
        frame = self._frames(line.kind)[line.number]
        if line.kind == "bound":
            self._selected = None
            self._ask(removed_bound(self._cuts, frame))
        else:
            self._ask(automatic_accent(self._cuts, frame, self._curve))

    def _snapped(self, kind: Kind, x_px: float, free: bool) -> int:
        frame = self.frame_at(x_px)
        places = self._extrema[kind]
        if free or not self.snaps or not len(places):
            return frame
        nearest = int(places[np.abs(places - frame).argmin()])
        return nearest if abs(self.x_px(nearest) - x_px) <= SNAP_PX else frame

    def _step(self, frames: int) -> None:
        line = self._selected
        if line is not None:
            self._move(line, self._cuts, self._frames(line.kind)[line.number] + frames, None)

    def _choose_next(self, by: int) -> None:
        """Select the line after (1) or before (-1) the selected one, of any kind."""
        lines = sorted((frame, kind, number) for kind in KINDS for number, frame in enumerate(self._frames(kind)))
        if not lines:
            return
        here = [at for at, (_, kind, number) in enumerate(lines) if CutLine(kind, number) == self._selected]
        at = min(max(here[0] + by, 0), len(lines) - 1) if here else 0
        frame, kind, number = lines[at]
        self._selected = CutLine(kind, number)
        time_s = float(self.time_s(frame))
        left, right = self._span_s()
        if not left <= time_s <= right:
            self._look(time_s - (right - left) / 2.0, time_s + (right - left) / 2.0)
        self._draw()
        self.pointed.emit(frame)

    # Mouse and keys

    def _pressed(self, event: QMouseEvent) -> None:
        x_px = event.position().x()
        line = self._line_at(x_px) if event.button() == _LEFT else None
        if event.button() == _LEFT:
            self.plot.setFocus(Qt.FocusReason.MouseFocusReason)
            self._selected = line
            self._draw()
        self._drag = _Drag(line, self._cuts, x_px, self._span_s())
        self._token = object()

    def _moved(self, event: QMouseEvent) -> None:
        x_px, drag = event.position().x(), self._drag
        if drag is None:
            over = self._line_at(x_px) is not None
            self.plot.viewport().setCursor(Qt.CursorShape.SplitHCursor if over else Qt.CursorShape.ArrowCursor)
            if len(self._curve):
                self.pointed.emit(self.frame_at(x_px))
        elif drag.line is not None:
            free = bool(event.modifiers() & Qt.KeyboardModifier.AltModifier)
            self._move(drag.line, drag.cuts, self._snapped(drag.line.kind, x_px, free), self._token)
        else:
            left, right = drag.view_s
            width = max(1.0, self.view.sceneBoundingRect().width())
            by_s = (drag.x_px - x_px) / width * (right - left)
            self._look(left + by_s, right + by_s)

    def _wheeled(self, event: QWheelEvent) -> None:
        turned = event.angleDelta().y() or event.angleDelta().x()
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            self.zoom(ZOOM ** (turned / _STEP), self._time_at(event.position().x()))
        else:
            left, right = self._span_s()
            by_s = -0.1 * (right - left) * turned / _STEP
            self._look(left + by_s, right + by_s)

    def _key(self, event: QKeyEvent) -> bool:
        """Handle a key; return False if it has no function."""
        key, ctrl = event.key(), bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        step = 10 if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else 1
        middle_s = sum(self._span_s()) / 2.0
        if key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            self.delete()
        elif key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            by = -1 if key == Qt.Key.Key_Left else 1
            if ctrl:
                self._choose_next(by)
            else:
                self._step(by * step)
        elif key == Qt.Key.Key_Insert:
            self.add(self.frame_of(middle_s))
        elif key in (Qt.Key.Key_Plus, Qt.Key.Key_Equal, Qt.Key.Key_Minus):
            self.zoom(ZOOM if key != Qt.Key.Key_Minus else 1.0 / ZOOM, middle_s)
        elif key == Qt.Key.Key_F:
            self.fit()
        else:
            return False
        return True

    def _apply_theme(self) -> None:
        tokens = self._session.tokens
        self.plot.setBackground(QColor(tokens.sunken))
        for axis in self._axes:
            axis.setPen(pg.mkPen(tokens.line_strong))
            axis.setTextPen(pg.mkPen(tokens.text_dim))
        pens = {
            "hits": pg.mkPen(tokens.good, width=1),
            "curve": pg.mkPen(tokens.text, width=1),
            "bound": pg.mkPen(tokens.accent, width=1),
            "accent": pg.mkPen(tokens.players[1], width=1, style=Qt.PenStyle.DashLine),
            "selected": pg.mkPen(tokens.by_hand, width=3),
            "playhead": pg.mkPen(tokens.accent, width=3),
        }
        for name, pen in pens.items():
            self._items[name].setPen(pen)
        self._dots.setBrush(pg.mkBrush(tokens.players[1]))
        shade = QColor(tokens.warning)
        shade.setAlphaF(0.3)
        self._unfit.setOpts(brush=pg.mkBrush(shade))

    # Qt overrides

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        kind = event.type()
        if watched is self.plot and kind == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            return self._key(event)
        if watched is self.plot or not self.isEnabled():
            return False
        if kind == QEvent.Type.MouseButtonPress and isinstance(event, QMouseEvent):
            self._scrubs = event.button() == _LEFT and self._is_axis(event)
            if self._scrubs:
                self.plot.setFocus(Qt.FocusReason.MouseFocusReason)
                self.scrubbed.emit(self._time_at(event.position().x()))
            elif event.button() in (_LEFT, _MIDDLE):
                self._pressed(event)
        elif kind == QEvent.Type.MouseMove and isinstance(event, QMouseEvent):
            if self._scrubs:
                self.scrubbed.emit(self._time_at(event.position().x()))
            else:
                self._moved(event)
        elif kind == QEvent.Type.MouseButtonRelease:
            self._drag, self._scrubs = None, False
        elif kind == QEvent.Type.MouseButtonDblClick and isinstance(event, QMouseEvent):
            x_px = event.position().x()
            if event.button() == _LEFT and not self._is_axis(event) and self._line_at(x_px) is None:
                self.add(self.frame_at(x_px))
        elif kind == QEvent.Type.Wheel and isinstance(event, QWheelEvent):
            self._wheeled(event)
        else:
            return False
        return True


def _uprights(times_s: FloatArray, heights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return X and Y (2 N,) of N vertical lines from 0 to their heights, a lower and an upper end for each."""
    return np.repeat(times_s, 2), np.stack([np.zeros(len(heights)), heights], axis=1).ravel()
