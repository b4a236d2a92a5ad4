"""Picture of a track's notes for a row of the import."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QRectF
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from app.arrays import IntArray
from app.editor.design_tokens import Tokens
from app.score.track_channel import TrackChannel

ROW_PX = 40
"""Height in pixels of a row in the import dialog."""


class NotesPreview(QWidget):
    """A track's notes over the whole piece, as a small piano roll."""

    def __init__(self, channels: Sequence[TrackChannel], end_tick: int, tokens: Tokens) -> None:
        super().__init__()
        self._onsets = np.concatenate([np.asarray(channel.onset_ticks, np.float64) for channel in channels])
        self._ends = np.concatenate([np.asarray(channel.end_ticks, np.float64) for channel in channels])
        self._pitches = np.concatenate([np.asarray(channel.pitches, np.intp) for channel in channels])
        self._end_tick, self._tokens = max(end_tick, 1), tokens
        self.setMinimumHeight(ROW_PX - 8)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        area = QRectF(self.rect()).adjusted(2, 5, -2, -5)
        painter.fillRect(self.rect().adjusted(0, 2, 0, -2), QColor(self._tokens.sunken))
        low = int(self._pitches.min())
        span = max(int(self._pitches.max()) - low, 11) + 1
        height = area.height() / span
        colour = QColor(self._tokens.accent if self.isEnabled() else self._tokens.text_dim)
        for pitch, begin, end in self._runs(area.width()):
            top = area.bottom() - (pitch - low + 1) * height
            painter.fillRect(QRectF(area.left() + begin, top, end - begin, max(height, 1.5)), colour)

    def _runs(self, width_px: float) -> list[tuple[int, int, int]]:
        """Return horizontal runs for drawing: pitch, first column of pixels, and column after the last one."""
        columns = max(int(width_px), 1)
        begins = np.clip((self._onsets * columns / self._end_tick).astype(np.intp), 0, columns - 1)
        ends = np.clip(np.ceil(self._ends * columns / self._end_tick).astype(np.intp), begins + 1, columns)
        changes: IntArray = np.zeros((128, columns + 1), np.int64)
        np.add.at(changes, (self._pitches, begins), 1)
        np.add.at(changes, (self._pitches, ends), -1)
        sounding = np.cumsum(changes, axis=1) > 0
        edges = np.diff(sounding, axis=1, prepend=False)
        pitches, columns_of = np.nonzero(edges)
        pairs = zip(pitches[::2].tolist(), columns_of[::2].tolist(), columns_of[1::2].tolist(), strict=True)
        return list(pairs)
