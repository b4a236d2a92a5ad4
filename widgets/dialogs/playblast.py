"""Dialog that makes a film of the viewport with sound."""

from __future__ import annotations

import os
import queue
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QSize, QTimer, Signal
from PySide6.QtGui import QStandardItemModel
from PySide6.QtWidgets import QWidget

from app.arrays import SingleArray
from app.editor.session import Session
from app.encoding import shown
from app.errors import AppError, Cancelled, Message, Progress, StopRequested
from app.export.video import SOUND_RATE_HZ, video_into
from app.performance.span import FrameSpan, cut_span, led_into_s, whole_span
from app.project.camera_bookmarks import VIEWS, CameraBookmark, View
from app.project.frame_rate import USUAL_FILM_RATE, USUAL_RATES, frame_rate_text
from widgets.common.controls import Button, Check, named, selectable, wrapped
from widgets.common.layouts import in_column, in_form, in_row
from widgets.common.paths import PathEdit, ask_where_to_save, show_folder
from widgets.common.plain import ComboBox, Label
from widgets.common.text import sentence
from widgets.dialogs.export_range import BeatsBox
from widgets.dialogs.progress_dialog import WorkingDialog, stopping

Pictures = npt.NDArray[np.uint8]
Draw = Callable[[float], Pictures]
"""Function from a time in seconds to a picture (H, W, 3 or 4)."""
Film = Callable[[int, int, tuple[float, float], View | CameraBookmark | None, bool], Draw]
"""Function from width, height, span in seconds, view (None for the viewport's present one) or bookmark, and a flag to a
function that draws the pictures in order.
"""
Sound = Callable[[float, float, int], SingleArray]
"""Function from start and end in seconds and a sample rate to samples (N, 2) of the sound; runs in the background."""

SIZES: Final = ((1280, 720), (1920, 1080), (2560, 1440), (3840, 2160), (1080, 1920))
_WHOLE, _LOOP, _SELECTION = "whole_piece", "loop", "selection"
_AHEAD = 8
"""Greatest number of pictures that wait for the encoder."""


class PlayblastDialog(WorkingDialog):
    """Dialog that makes a film of the viewport.

    Parameters
    ----------
    film : Film
        Returns a function that draws the pictures; both are called in the window's thread.
    path : Path
        Proposed file.
    """

    filmed = Signal(object)
    """Signal: path of the film."""

    def __init__(self, session: Session, film: Film, sound: Sound, path: Path, parent: QWidget | None = None) -> None:
        super().__init__("playblast", "playblast", parent)
        self._session, self._film, self._sound = session, film, sound
        self._performance = session.performance
        self._pictures: queue.Queue[Pictures] = queue.Queue(_AHEAD)
        self._trouble: AppError | None = None
        """Error that stopped the drawing of pictures."""
        self._span: FrameSpan | None = None
        self._drawn = 0
        self._draw_at: Draw | None = None
        """Draws the film's pictures."""

        self._size = named(ComboBox(), "playblast_size")
        for width, height in SIZES:
            self._size.addItem(f"{width} × {height}", (width, height))
        self._rate = named(ComboBox(), "playblast_rate")
        for rate in sorted({*USUAL_RATES, session.project.fps}):
            self._rate.addItem(frame_rate_text(rate), str(rate))
        self._rate.setCurrentIndex(self._rate.findData(str(min(session.project.fps, USUAL_FILM_RATE))))
        ranges = {each: f"playblast_dialog.{each}" for each in (_WHOLE, _LOOP, _SELECTION)}
        self._range = self.texted(named(ComboBox(), "playblast_range"), options=ranges)
        self._lead_in = self.texted(
            BeatsBox("playblast_lead_in"), suffix="export_dialog.beats", tip="playblast_dialog.lead_in_tip"
        )
        self._offered: dict[str, tuple[float, float] | None] = {}
        """Spans of the loop and of the selection, seconds, as they were offered last."""
        self._offer_ranges()
        session.loop_changed.connect(self._offer_ranges)
        session.selection_changed.connect(self._offer_ranges)
        views = {str(view): f"playblast_dialog.{view}" for view in VIEWS}
        views = {"": "playblast_dialog.current_viewport", **views}
        self._view = self.texted(named(ComboBox(), "playblast_view"), options=views)
        for camera in session.project.cameras:
            self._view.addItem(camera.name, camera)
        self._with_sound = named(Check("playblast_dialog.include_audio"), "playblast_sound")
        self._with_sound.setChecked(True)
        self._with_marks = named(Check("playblast_dialog.include_marks"), "playblast_marks")
        self._file = named(PathEdit(path), "playblast_file")
        self._choose = Button("playblast_dialog.choose", self._choose_file)
        self._state = selectable(wrapped(named(Label(), "playblast_state")))
        self._state.setMinimumHeight(40)
        self._file.textChanged.connect(self._show_state)

        # One picture for each turn of the event loop, so that the window stays responsive.
        self._timer = QTimer(self, interval=0)
        self._timer.timeout.connect(self._draw)
        self._build()
        self.texted(self, title="playblast_dialog.playblast")
        self.retranslate()

    def _build(self) -> None:
        file = in_row((self._file, 1), self._choose)
        self._form = in_form(
            {
                "playblast_dialog.view": self._view,
                "playblast_dialog.range": self._range,
                "playblast_dialog.lead_in": self._lead_in,
                "playblast_dialog.size": self._size,
                "playblast_dialog.frames_per_second": self._rate,
                "playblast_dialog.sound": self._with_sound,
                "playblast_dialog.overlays": self._with_marks,
                "playblast_dialog.file": file,
            }
        )
        self.fields = (
            self._size,
            self._rate,
            self._range,
            self._lead_in,
            self._view,
            self._with_sound,
            self._with_marks,
            self._file,
            self._choose,
        )
        buttons = self._box("playblast_dialog.make_film", self.start, self._show_folder)
        self._range.currentIndexChanged.connect(self._show_lead_in)
        self._show_lead_in()
        in_column(self._form, (self._state, 1), self._under_way, self._progress, buttons, of=self)

    def start(self) -> None:
        """Start making the film with the chosen options."""
        if self._running or not self._start.isEnabled():
            return
        self._performance = self._session.performance
        self._span = span = self._requested_span()
        self._drawn, self._trouble, self._draw_at = 0, None, None
        # The thread receives only what it needs, not the dialog.
        self._pictures = pictures = queue.Queue[Pictures](_AHEAD)
        self._show.hide()
        self._set_running(True)
        self._state.setText("")
        stop = self._stop
        path, size = self._file.path, self._size.currentData()
        assert path is not None, "the button is disabled without one"
        with_sound, sound = self._with_sound.isChecked(), self._sound

        def work(progress: Progress, stop_requested: StopRequested) -> Path:
            samples = sound(span.first_frame_s, span.end_s, SOUND_RATE_HZ) if with_sound else None
            asked = stopping(stop, stop_requested)
            with video_into(path, (size[0], size[1]), span.fps, samples) as film:
                for index in range(span.count):
                    film.write(_next(pictures, asked))
                    progress((index + 1) / span.count)
            return path

        self._timer.start()
        self._session.tasks.run(
            Message("work.playblast"), work, self._done, self._failed, key="playblast", ended=self._finish, writes=True
        )

    def _draw(self) -> None:
        """Draw the next picture, unless too many pictures wait for the encoder."""
        span = self._span
        if span is None or not self._running or self._drawn >= span.count:
            self._timer.stop()
            return
        if self._pictures.full():
            self._timer.setInterval(2)
            return
        self._timer.setInterval(0)
        time_s = span.first_frame_s + self._drawn * span.fps.denominator / span.fps.numerator
        try:
            if self._draw_at is None:
                width, height = self._size.currentData()
                view = self._view.currentData() or None
                marked = self._with_marks.isChecked()
                self._draw_at = self._film(width, height, (span.first_frame_s, span.end_s), view, marked)
            picture = self._draw_at(time_s)
        except Exception as error:
            # The encoder stops and removes what it has written.
            self._stop.set()
            self._timer.stop()
            if not isinstance(error, AppError):
                raise
            self._trouble = error
            return
        self._pictures.put(picture)
        self._drawn += 1
        frame = self.tr("playblast_dialog.frame").format(number=self._drawn, count=span.count)
        self._show_share(self._drawn / span.count, frame)

    def _done(self, path: Path) -> None:
        self._under_way.hide()
        self._state.setText(self.tr("playblast_dialog.video_saved").format(file=shown(path)))
        self._show.show()
        self._session.notice(Message("video.done", {"file": str(path)}))
        self.filmed.emit(path)

    def _failed(self, error: AppError) -> None:
        self._state.setText(sentence(error.message))

    def _finish(self) -> None:
        self._timer.stop()
        self._draw_at = None
        self._set_running(False)
        if self._trouble is not None:
            self._failed(self._trouble)

    def _offer_ranges(self) -> None:
        """Offer the loop and the selected range if they exist, and select the range of the last film."""
        selected, clock = self._session.selection.span, self._session.project.score.tempo_map
        before, rows = self._offered, self._range.model()
        self._offered = {
            _LOOP: self._session.loop_s,
            _SELECTION: None if selected is None else (clock.seconds(selected[0]), clock.seconds(selected[1])),
        }
        if self._running:
            return
        assert isinstance(rows, QStandardItemModel)
        for name, span_s in self._offered.items():
            row = self._range.findData(name)
            rows.item(row).setEnabled(span_s is not None)
            if span_s is not None and span_s != before.get(name):
                self._range.setCurrentIndex(row)
        if self._offered.get(self._range.currentData(), ()) is None:
            self._range.setCurrentIndex(self._range.findData(_WHOLE))

    def _requested_span(self) -> FrameSpan:
        frame, fps = self._performance.time_frame, Fraction(self._rate.currentData())
        span_s = self._offered.get(self._range.currentData())
        if span_s is None:
            return whole_span(frame, fps)
        start_tick = self._performance.piece.clock.ticks(span_s[0])
        return cut_span(frame, fps, led_into_s(self._performance, start_tick, self._lead_in.value()), span_s[1])

    def _show_lead_in(self) -> None:
        self._form.setRowVisible(self._lead_in, self._range.currentData() != _WHOLE)

    def _choose_file(self) -> None:
        proposal = self._file.path or Path("film.mp4")
        chosen = ask_where_to_save(
            self, self.tr("playblast_dialog.film"), proposal, self.tr("playblast_dialog.films_mp4")
        )
        if chosen is not None:
            self._file.set_path(chosen if chosen.suffix.lower() == ".mp4" else chosen.with_name(f"{chosen.name}.mp4"))

    def _show_folder(self) -> None:
        if self._file.path is not None:
            show_folder(self._file.path.parent)

    def _show_state(self) -> None:
        path = self._file.path
        self._start.setEnabled(path is not None and not self._running)
        exists = path is not None and os.path.isfile(path)
        self._state.setText(self.tr("playblast_dialog.replaces_file") if exists else "")

    def retranslate(self) -> None:
        super().retranslate()
        if not self._running and not self._show.isVisible():
            self._show_state()

    def sizeHint(self) -> QSize:
        return QSize(620, 360)


def _next(pictures: queue.Queue[Pictures], stop_requested: Callable[[], bool]) -> Pictures:
    """Wait for the next picture, and return it. Raises Cancelled."""
    while not stop_requested():
        try:
            return pictures.get(timeout=0.1)
        except queue.Empty:
            continue
    raise Cancelled("work.stopped")
