"""A light that flashes with the metronome, for playing along without its sound."""

from __future__ import annotations

from math import floor

import numpy as np
from PySide6.QtCore import QSize
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.editor.session import Session

FLASH_S = 0.11
"""Duration of a flash in seconds."""
_BAR, _BEAT, _OFF = "bar", "beat", "off"


class BeatLight(QWidget):
    """Light that flashes on every felt beat while the metronome or a recording runs; brighter on the first beat of a
    bar.
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("beat_light")
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self._session = session
        self.state = _OFF
        session.playing_changed.connect(lambda: self.show_time(session.playhead_s))
        session.theme_changed.connect(self.update)

    def show_time(self, playhead_s: float) -> None:
        """Set the light to the beat at the playhead's time in seconds."""
        state = self._at(playhead_s)
        if state != self.state:
            self.state = state
            self.update()

    def _at(self, playhead_s: float) -> str:
        session = self._session
        if not session.playing or not (session.listening.click or session.recording.running):
            return _OFF
        tempo_map, metre_map = session.project.score.tempo_map, session.project.metre_map
        tick = tempo_map.ticks(playhead_s) + 1e-3
        bar = metre_map.bar_of_tick(floor(tick))
        ticks, beats = metre_map.counted(bar, bar + 1)
        place = int(np.searchsorted(ticks, tick, side="right")) - 1
        if place < 0 or playhead_s - tempo_map.seconds(float(ticks[place])) > FLASH_S * session.listening.speed:
            return _OFF
        return _BEAT if beats[place] else _BAR

    # Qt overrides

    def sizeHint(self) -> QSize:
        return QSize(16, 16)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = self._session.tokens
        colour = {_BAR: tokens.accent, _BEAT: tokens.text, _OFF: tokens.sunken}[self.state]
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QColor(tokens.line_strong))
        painter.setBrush(QColor(colour))
        painter.drawEllipse(self.rect().adjusted(3, 3, -3, -3))
