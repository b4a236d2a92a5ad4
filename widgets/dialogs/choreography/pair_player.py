"""Player for the music of a pair in step with its motion, to check the offset."""

from __future__ import annotations

from typing import Final

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import QSlider, QWidget

from app.audio.mix import project_to_hear
from app.audio.playback import Playback
from app.audio.track import RATE_HZ, Mix
from app.choreography.read_pair import ReadPair
from app.editor.session import Session
from app.editor.stems import Stems
from app.project.model import Project
from widgets.common.controls import IconButton, Retranslated, named
from widgets.common.layouts import in_row
from widgets.common.plain import Label
from widgets.dialogs.choreography.learn_draft import PairContents, PairDraft, offset_s_of

_FRAME_MS: Final = 16
_STEPS_PER_S: Final = 1000
_STEP_MS, _PAGE_MS = 20, 1000
_SAID_PX: Final = 250
"""Width in pixels for the longest text, so that the slider does not move."""


class PairPlayer(Retranslated, QWidget):
    """Play button and slider. Times are those of the motion file in seconds.

    Signals
    -------
    moved(float)
        Time at the playhead, in seconds.

    Parameters
    ----------
    playback : Playback
        Separate playback of this widget, which becomes its child.
    """

    moved = Signal(float)

    def __init__(self, session: Session, playback: Playback, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._playback = session, playback
        playback.setParent(self)
        self._stems = Stems(session.tasks, self, key="learn_sound")
        self._read: ReadPair | None = None
        self._project: Project | None = None
        """The music as it is heard; None until it is first played."""
        self._span_s = (0.0, 0.0)
        self._offset_s = 0.0
        self.button = IconButton(session, "play", "pair_player.play_space", self.toggle, "pair_play")
        self.slider = self.texted(
            named(QSlider(Qt.Orientation.Horizontal), "pair_place"),
            tip="pair_player.drag_to_scrub",
            name="pair_player.drag_to_scrub",
        )
        self.slider.setSingleStep(_STEP_MS)
        self.slider.setPageStep(_PAGE_MS)
        self._said = named(Label(), "pair_said")
        self._said.setMinimumWidth(_SAID_PX)
        in_row(self.button, (self.slider, 1), self._said, of=self, margins=0)
        self._timer = QTimer(self, interval=_FRAME_MS, timerType=Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._follow)
        self.slider.valueChanged.connect(self._scrubbed)
        playback.playing_changed.connect(self._playing_changed)
        self._stems.changed.connect(self._take_sound)
        # Only one of the two sounds at a time.
        session.playing_changed.connect(self._give_way)
        self.show_pair(PairDraft(), PairContents())

    @property
    def position_s(self) -> float:
        """Time of the playhead in seconds."""
        return self._playback.position_s()

    @property
    def is_playing(self) -> bool:
        """True while a pair of motion and music plays."""
        return self._playback.is_playing

    def show_pair(self, draft: PairDraft, found: PairContents) -> None:
        """Set the pair and offset, effective immediately during playback."""
        read, analysis = found.read, found.analysis
        self.setEnabled(read is not None and analysis is not None)
        if read is None or analysis is None:
            self.stop()
            self._read = self._project = None
            self._say()
            return
        self._offset_s, before = offset_s_of(draft, found), self._offset_s
        if read is not self._read:
            self.stop()
            self._read, self._project = read, None
            start_s = read.motion.start_s
            self._span_s = start_s, start_s + analysis.clip.length_s
            self._playback.set_span(*self._span_s)
            self._playback.set_mix(Mix())
            self._playback.seek(start_s)
            self.slider.blockSignals(True)
            self.slider.setRange(0, round(analysis.clip.length_s * _STEPS_PER_S))
            self.slider.setValue(0)
            self.slider.blockSignals(False)
        elif self._offset_s != before and self._project is not None:
            self._take_sound()
            self._ask_for_sound()
        self._say()

    def toggle(self) -> None:
        """Play from the playhead, or stop."""
        if self.is_playing:
            self.stop()
        elif self.isEnabled():
            piece = self._session.playback
            if piece is not None:
                piece.stop()
            self._prepare()
            self._playback.set_volume(self._session.listening.volume)
            self._playback.play()

    def stop(self) -> None:
        """Stop playing; the position stays."""
        self._playback.stop()

    def close_down(self) -> None:
        """Stop the sound and its rendering before the dialog closes."""
        self.stop()
        self._stems.stop()

    def scrub(self, time_s: float) -> None:
        """Move to a time, and play a moment of sound."""
        if self.isEnabled():
            self._prepare()
            self._playback.set_volume(self._session.listening.volume)
            self._playback.scrub(min(max(time_s, self._span_s[0]), self._span_s[1]))
            self._follow()

    def _scrubbed(self, value: int) -> None:
        self.scrub(self._span_s[0] + value / _STEPS_PER_S)

    def _prepare(self) -> None:
        """Start rendering the music, which is postponed until first needed."""
        if self._project is None and self._read is not None:
            self._project = project_to_hear(self._read.score)
            self._take_sound()
        self._ask_for_sound()

    def _ask_for_sound(self) -> None:
        if self._project is not None:
            self._stems.follow(self._project, self.position_s - self._offset_s)

    def _take_sound(self) -> None:
        """Give the rendered sound, shifted by the offset, to the playback."""
        if self._project is not None:
            by = round(self._offset_s * RATE_HZ)
            self._playback.set_mix(Mix(track.moved(by) for track in self._stems.tracks(self._project)))
        self._say()

    def _follow(self) -> None:
        """Move the playhead to the time of the audible sound."""
        time_s = min(max(self.position_s, self._span_s[0]), self._span_s[1])
        self.slider.blockSignals(True)
        self.slider.setValue(round((time_s - self._span_s[0]) * _STEPS_PER_S))
        self.slider.blockSignals(False)
        if self.is_playing and not self._stems.covers(time_s - self._offset_s):
            self._ask_for_sound()
        self._say()
        self.moved.emit(time_s)

    def _playing_changed(self, playing: bool) -> None:
        self.button.show_picture("stop" if playing else "play")
        if playing:
            self._timer.start()
        else:
            self._timer.stop()
        if self._read is not None:
            self._follow()

    def _give_way(self, playing: bool) -> None:
        if playing:
            self.stop()

    def _say(self) -> None:
        if self._read is None:
            self._said.setText("")
            return
        time = self.tr("pair_player.time").format(seconds=f"{self.position_s:.2f}", end=f"{self._span_s[1]:.2f}")
        notes = [time]
        if self._project is not None and self._stems.is_busy:
            notes.append(self.tr("pair_player.preparing_sound").format(percent=round(100 * self._stems.ready)))
        elif self._playback.is_silent:
            notes.append(self.tr("pair_player.no_audio_device"))
        self._said.setText(" · ".join(notes))

    def retranslate(self) -> None:
        self._say()
