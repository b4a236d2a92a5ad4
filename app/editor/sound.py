"""Keeps recording, players and metronome ready for playback while the project changes.

During playback the playhead follows the sound.
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject, Qt, QTimer

from app.audio.click import click_track
from app.audio.decode import AudioRecording, decode
from app.audio.followed_recording import FollowOptions
from app.audio.mix import recording_track
from app.audio.offset import Estimate, estimate_offset
from app.audio.playback import Playback
from app.audio.track import RATE_HZ, Mix, MixTrack
from app.audio.waveform_peaks import Peaks
from app.editor.generator import REPORTED_NOTES
from app.editor.listening import RecordedTake
from app.editor.recording_alignment import follow_in_background, take_estimate
from app.editor.session import Session, Severity
from app.editor.stems import Stems
from app.errors import AppError, Message, Progress, StopRequested
from app.formats.other_computers import may_touch
from app.plan.generate import frame_around
from app.plan.model import TimeFrame
from app.project.edit.players import change as change_players
from app.project.edit.takes import comp_whole
from app.project.model import Project
from app.project.undoable_document import Change

_FRAME_MS = 16
_TAKE_WAIT_MS = 1000
"""Longest wait in milliseconds before the audition of a take; the beginning is rendered first."""
_TAKE_LOOK_MS = 50


_CLICKS_ON_S = 1800.0
"""Seconds for which the metronome continues after the end of the piece during recording."""


class EditorSound(QObject):
    """Playback, metronome and previews of the editor.

    Parameters
    ----------
    session : Session
        Session that gets the playback and becomes the parent.
    playback : Playback, optional
        Playback to use; by default one that plays on the system's audio device.
    audible : bool
        Whether sound can be played; otherwise the recording is only read for its waveform.
    """

    def __init__(self, session: Session, playback: Playback | None = None, audible: bool = True) -> None:
        super().__init__(session)
        self._session = session
        self.playback = playback if playback is not None else Playback(parent=self)
        self._audible = audible
        if audible:
            session.playback = self.playback
        self._stems = Stems(session.tasks, self)
        self._recording: AudioRecording | None = None
        self._path = ""
        """Path of the recording that was requested last, readable or not."""
        self._estimated: set[str] = set()
        """Paths of recordings whose place was looked for."""
        self._unplaced = ""
        """Path of a recording that was just added: its place is to be looked for."""
        self._click: tuple[tuple[object, ...], MixTrack] | None = None
        self._chosen: tuple[object, ...] = ()
        """Source, metronome and percussion of the mix that was made last."""
        self._counted_s: tuple[float, float] | None = None
        """While a take is recorded: where counting in begins, and where the take does."""
        self._audition: tuple[Project, RecordedTake, Project] | None = None
        """The project with a take in the place of a part, and what it was made from."""
        self._take_waits_ms = 0
        self._held_back = False
        """A large piece was opened, and is being planned: synthesising it would hold that up, and no one listens."""
        self._own_move = False
        self._reported_silent = False
        self._frame_timer = QTimer(self, interval=_FRAME_MS, timerType=Qt.TimerType.PreciseTimer)
        self._frame_timer.timeout.connect(self._follow_sound)
        self._take_timer = QTimer(self, interval=_TAKE_LOOK_MS)
        self._take_timer.timeout.connect(self._play_take)
        self._stems.changed.connect(self._stems_changed)
        session.changed.connect(self._changed)
        session.performance_changed.connect(self._go_on)
        session.media_agreed.connect(self._read_agreed)
        session.playhead_changed.connect(self._playhead_moved)
        session.loop_changed.connect(lambda: self.playback.set_loop(session.loop_s))
        session.listening.changed.connect(self._listening_changed)
        self.playback.playing_changed.connect(self._playing_changed)
        self.playback.silent_changed.connect(self._silent_changed)
        self._listening_changed()

    @property
    def recording(self) -> AudioRecording | None:
        """Return the decoded audio recording of the project; None if there is none or it is not read yet."""
        return self._recording

    @property
    def is_busy(self) -> bool:
        """Return whether some of the sound is not rendered yet."""
        return self._stems.is_busy

    # Playhead

    def _follow_sound(self) -> None:
        self._own_move = True
        try:
            self._session.set_playhead(self.playback.position_s())
        finally:
            self._own_move = False

    def _playhead_moved(self, playhead_s: float) -> None:
        project = self._sounding_project()
        if self._synthesiser_audible(project) and not self._held_back and not self._stems.covers(playhead_s):
            self._stems.follow(project, playhead_s)
        if self._own_move or not self._audible:
            return
        if self._session.listening.scrub_sound:
            self.playback.scrub(playhead_s)
        else:
            self.playback.seek(playhead_s)

    def _playing_changed(self, playing: bool) -> None:
        if playing:
            self._go_on()
            self._frame_timer.start()
        else:
            self._frame_timer.stop()
            self._session.listening.set(take=None)
        self._follow_sound()
        self._session.set_playing(playing)

    def _silent_changed(self, silent: bool) -> None:
        self._session.listening.set(silent=silent)
        if silent and not self._reported_silent:
            self._reported_silent = True
            self._session.notice(Message("audio.no_device"), Severity.WARNING)

    # Takes

    def listen(self, take: RecordedTake, from_s: float) -> None:
        """Play a take from a time as soon as its beginning is rendered, until playback stops."""
        self.playback.stop()
        self._session.set_playhead(from_s)
        self._session.listening.set(take=take)
        self._take_waits_ms = _TAKE_WAIT_MS
        self._take_timer.start()
        self._play_take()

    def stop_listening(self) -> None:
        """End the audition of a take."""
        self._take_timer.stop()
        self.playback.stop()
        self._session.listening.set(take=None)

    def _play_take(self) -> None:
        self._take_waits_ms -= _TAKE_LOOK_MS
        if self._session.listening.take is None:
            self._take_timer.stop()
        elif not self._stems.is_busy or self._take_waits_ms <= 0:
            self._take_timer.stop()
            self.playback.play(self._session.playhead_s)

    def _sounding_project(self) -> Project:
        """Return the project as it is to be heard, with the take being auditioned in place of its player's part."""
        project, take = self._session.project, self._session.listening.take
        recorded = project.takes.get(take.player_id) if take is not None else None
        if take is None or recorded is None or (take.take_id and all(take.take_id != t.id for t in recorded.takes)):
            return project
        known = self._audition
        if known is None or known[0] is not project or known[1] is not take:
            audition = comp_whole(project, take.player_id, take.take_id)
            # A recording of the piece already contains the part, so the take is added to it alone.
            over = project.audio is not None and self._session.listening.source == "recording"
            everyone = [player.id for player in project.players]
            if take.alone or over:
                audition = change_players(audition, everyone, soloed=False)
                audition = change_players(audition, [take.player_id], soloed=True)
            else:
                audition = change_players(audition, [take.player_id], muted=False)
            self._audition = known = (project, take, audition)
        return known[2]

    # Sound

    def _changed(self, change: Change) -> None:
        if change.opened:
            self.stop_listening()
            self._estimated.clear()
            self._unplaced = ""
            self._held_back = self._session.performance.project is not change.after and _is_large(change.after)
            if self._held_back:
                self._stems.clear()
                self._session.listening.set(ready=self._stems.ready)
        elif change.before.audio is None and change.after.audio is not None:
            audio = change.after.audio
            # An offset that exists already, or existed before an undo, was chosen by the user.
            fresh = audio.offset_s == 0.0 and audio.confidence is None and audio.path not in self._estimated
            self._unplaced = audio.path if fresh else ""
        self._take()

    def _listening_changed(self) -> None:
        listening = self._session.listening
        self.playback.set_speed(listening.speed)
        self.playback.set_volume(listening.volume)
        chosen = (listening.source, listening.click, listening.percussion, listening.take)
        if chosen != self._chosen:
            self._chosen = chosen
            self._audition = None
            self._take()

    def _take(self) -> None:
        """Prepare the sound of the project as it is after an edit."""
        project = self._sounding_project()
        self._set_span(project)
        path = project.audio.path if project.audio is not None else ""
        if path != self._path:
            self._read(path)
        if self._synthesiser_audible(project) and not self._held_back:
            self._stems.follow(project, self._session.playhead_s)
        self._set_mix()

    def _go_on(self) -> None:
        """Start the synthesis that was deferred until the piece is planned or played."""
        if self._held_back:
            self._held_back = False
            self._take()

    def set_recording(self, counted_s: tuple[float, float] | None) -> None:
        """Set the time range in seconds of a recording's count-in, while recording; playback then continues past the
        end of the piece. None when nothing is being recorded.
        """
        self._counted_s = counted_s
        self._set_span(self._sounding_project())
        self._set_mix()

    def _set_span(self, project: Project) -> None:
        frame, score = span_of(project), project.score
        end_s = max(score.tempo_map.seconds(float(score.sounding_end_tick)), frame.end_s)
        self.playback.set_span(frame.first_frame_s, end_s if self._counted_s is None else float("inf"))

    def _stems_changed(self) -> None:
        self._session.listening.set(ready=self._stems.ready)
        self._set_mix()

    def _synthesiser_audible(self, project: Project) -> bool:
        listening = self._session.listening
        return self._audible and (
            project.audio is None or listening.source != "recording" or listening.take is not None
        )

    def _set_mix(self) -> None:
        session = self._session
        project, listening = self._sounding_project(), session.listening
        tracks: list[MixTrack] = []
        alone = listening.take is not None and listening.take.alone
        if (
            project.audio is not None
            and self._recording is not None
            and listening.source != "synthesiser"
            and not alone
        ):
            tracks.append(recording_track(self._recording, project.audio.offset_s))
        if self._synthesiser_audible(project):
            tracks.extend(self._stems.tracks(project, listening.percussion))
        if listening.click:
            tracks.append(self._clicks(project))
        elif self._counted_s is not None:
            tracks.append(click_track(project, *self._counted_s))
        self.playback.set_mix(Mix(tracks))

    def _clicks(self, project: Project) -> MixTrack:
        score, frame = project.score, span_of(project)
        sources = (score.tempo_map, project.metre_map)
        start_s, end_s = frame.first_frame_s, frame.end_s
        if self._counted_s is not None:
            start_s, end_s = min(start_s, self._counted_s[0]), max(end_s, self._counted_s[1]) + _CLICKS_ON_S
        key = (*sources, start_s, end_s)
        if self._click is None or self._click[0] != key:
            self._click = (key, click_track(project, start_s, end_s))
        return self._click[1]

    # Recording

    def _read_agreed(self) -> None:
        """Read the recording, after the user has allowed reading it from another computer."""
        if self._recording is None:
            self._path = ""
            self._take()

    def _read(self, path: str) -> None:
        self._recording = None
        self._path = path
        self._session.listening.set_waveform(None)
        if not path or not may_touch(path):
            return

        def work(progress: Progress, stop_requested: StopRequested) -> tuple[AudioRecording, Peaks]:
            recording = decode(path, progress, stop_requested)
            return recording, Peaks(recording.samples, RATE_HZ)

        def done(result: tuple[AudioRecording, Peaks]) -> None:
            audio = self._session.project.audio
            if audio is None or audio.path != path:
                return
            self._recording, waveform = result
            for warning in self._recording.warnings:
                self._session.notice(warning, Severity.WARNING)
            self._session.listening.set_waveform(waveform)
            self._set_mix()
            if self._audible and path == self._unplaced and self._session.project.score.end_tick:
                self.estimate(unasked=True)

        def failed(error: AppError) -> None:
            self._session.notice(error.message, Severity.ERROR)

        # Deferred: the edit that adds the recording is still being reported.
        QTimer.singleShot(
            0,
            self,
            lambda: self._session.tasks.run(
                Message("work.read_recording", {"file": Path(path).name}), work, done, failed, key="recording"
            ),
        )

    def estimate(self, unasked: bool = False, with_tempo: bool = False) -> None:
        """Estimate the recording's offset from its sound, and set it as an edit.

        Parameters
        ----------
        unasked : bool
            Whether the recording was just added: an uncertain offset is then reported but not set.
        with_tempo : bool
            Whether to fit the score's tempo too.
        """
        recording, project = self._recording, self._session.project
        if recording is None or project.audio is None:
            return
        self._estimated.add(recording.path)
        self._unplaced = ""

        def work(progress: Progress, stop_requested: StopRequested) -> Estimate:
            return estimate_offset(recording.samples, RATE_HZ, project.score, progress, stop_requested)

        def done(estimate: Estimate) -> None:
            audio = self._session.project.audio
            if audio is None or audio.path != recording.path:
                return
            take_estimate(self._session, estimate, unasked, with_tempo)

        self._session.tasks.run(Message("work.estimate_offset"), work, done, key="estimate")

    def follow(self, options: FollowOptions | None = None) -> None:
        """Align every beat to the recording as an edit, and report uncertain bars."""
        if self._recording is not None and self._session.project.audio is not None:
            follow_in_background(self._session, self._recording, options or FollowOptions())


def _is_large(project: Project) -> bool:
    return sum(len(project.part(player).notes) for player in project.players) > REPORTED_NOTES


def span_of(project: Project) -> TimeFrame:
    """Return the time frame of the performance, which is known before the players are planned."""
    parts = [project.part(player) for player in project.players]
    first_tick = min((part.notes[0].onset_tick for part in parts if part.notes), default=0)
    last_tick = max((part.end_tick for part in parts), default=0)
    beat_ticks = project.metre_map.felt_ticks_at(first_tick)
    return frame_around(first_tick, last_tick, project.score.tempo_map, project.preroll_beats, beat_ticks)
