"""Recording in the editor: the device, the running take, and adding it to the project.

A separate process (`app.capture.recorder`) records the MIDI events with their times into a file, the journal, and is
told the playback position continually. When recording ends, the passes of the journal become takes of the project in
one edit; the journal is kept until the takes are saved.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from math import floor
from pathlib import Path
from typing import Final

import msgspec
from PySide6.QtCore import QObject, Qt, QTimer, Signal

from app.audio.playback import Playback
from app.capture.journal import LARGEST_LATENCY_S, Journal, JournalHeader, read_journal
from app.capture.journal_to_takes import takes_of
from app.capture.link import RecorderLink
from app.capture.port_names import matching
from app.capture.protocol import (
    Back,
    Events,
    EventsSaved,
    Lost,
    Moved,
    News,
    NotStarted,
    Opened,
    Ports,
    RecordingFinished,
    RequestRefused,
    Restarted,
)
from app.editor.files import Files
from app.editor.live_player import LivePlayer
from app.editor.recording import NO_DEVICE
from app.editor.session import Session, Severity
from app.editor.settings import Settings
from app.editor.sound import EditorSound
from app.editor.translated import tr
from app.editor.window_thread_calls import window_calls
from app.encoding import stored
from app.errors import AppError, Argument, Message
from app.project.edit.takes import add_takes, comp
from app.project.journals import in_second_places, journal_path, journals_of, second_path
from app.project.model import Project
from app.project.storage import file_named
from app.score.sounding import SoundingNotes
from app.score.take import ControllerMapping, Take, curve_values, decoded, is_wired
from metadata.load import load_controllers, recognised_controller
from metadata.model import Controller

EARLY_S: Final = 0.12
"""Seconds before the start of a take in which a note still belongs to the take."""
SYNC_MS: Final = 40
"""Interval in milliseconds at which the recorder process receives the position of playback."""
_STILL_S: Final = 1e-6

_JUMP_S: Final = 0.25
"""Deviation in seconds of the playback position from the expected one that indicates a jump, by the user or
by a loop.
"""

MakeLink = Callable[[Callable[[], None]], RecorderLink]


@dataclass
class _Running:
    """A take that is being recorded: its journal files, its player and its start."""

    path: Path
    second_path: Path
    player_id: str
    start_s: float
    loop_s: tuple[float, float] | None
    mapping: ControllerMapping
    project: Project
    passes: int = 1
    first_s: float | None = None
    last_s: float = 0.0
    last_ns: int = 0


class Recorder(QObject):
    """The editor's recorder. Its process starts when a device is first requested.

    Parameters
    ----------
    session : Session
        Session whose `recording` is updated; becomes the parent.
    files : Files
        Files of the editor; journals are next to the project's file.
    settings : Settings
        Settings that store the device and its properties.
    sound : EditorSound
        Sound that plays the count-in and continues past the end of the piece.
    make_link : callable
        Makes the connection to the recorder's process.
    now_ns : callable
        Clock by which events get their times, in nanoseconds.
    make_playback : callable
        Creates a playback for a beep or clicks in addition to the performance.

    Signals
    -------
    device_missing()
        The user started a take although no device is chosen or connected.
    """

    device_missing = Signal()

    def __init__(
        self,
        session: Session,
        files: Files,
        settings: Settings,
        sound: EditorSound,
        make_link: MakeLink | None = None,
        now_ns: Callable[[], int] = time.perf_counter_ns,
        make_playback: Callable[[], Playback] = Playback,
    ) -> None:
        super().__init__(session)
        self._session, self._files, self._settings, self._sound = session, files, settings, sound
        self._state = session.recording
        self._make_link: MakeLink = make_link if make_link is not None else RecorderLink
        self.now_ns = now_ns
        self.make_playback = make_playback
        self._link: RecorderLink | None = None
        self._live = LivePlayer(session, self.recorded_player, self)
        self._sounding: SoundingNotes[None] = SoundingNotes()
        self._running: _Running | None = None
        self._adopting: list[_Running] = []
        self._adopted: dict[Path, Take] = {}
        """Journals whose takes are in the project, and not known to be in a file yet."""
        self._sync_timer = QTimer(self, interval=SYNC_MS, timerType=Qt.TimerType.PreciseTimer)
        self._sync_timer.timeout.connect(self._sync)
        self._state.set(
            port=settings.midi_port,
            count_in_bars=settings.count_in_bars,
            connection="waiting" if settings.midi_port else "none",
        )
        self._know(settings.midi_port)
        files.changed.connect(self._files_changed)
        files.opened.connect(self._project_opened)
        session.playing_changed.connect(self._playing_changed)

    # Device

    def begin(self) -> None:
        """Start looking for MIDI devices, unless this was done before."""
        if self._link is not None:
            return
        ask = window_calls().ask
        self._link = self._make_link(lambda: ask(self.poll))
        if self._state.port:
            self._link.open(self._state.port)

    def begin_where_remembered(self) -> None:
        """Look for the MIDI device that was used last; do nothing if none was used."""
        if self._state.port:
            self.begin()

    def choose(self, port: str) -> None:
        """Record from a MIDI device from now on, also after it is reconnected; an empty name records from none."""
        self.begin()
        if port == self._state.port:
            return
        assert self._link is not None
        self._settings.midi_port = port
        self._state.set(port=port, connection="waiting" if port else "none", refusal=None)
        self._silence()
        self._know(port)
        self._link.open(port or None)

    def _find_again(self, ports: tuple[str, ...]) -> None:
        """Find the device used last under its current name, since systems and versions number ports differently."""
        before = self._state.port
        if not before or before in ports or self._state.connection != "waiting":
            return
        found = matching(before, ports)
        if len(found) == 1:
            self._settings.rename_midi_device(before, found[0])
            self.choose(found[0])

    def set_count_in(self, bars: int) -> None:
        """Set the number of bars that are counted before a take."""
        self._settings.count_in_bars = bars
        self._state.set(count_in_bars=bars)

    def set_controller(self, controller: str) -> None:
        """Set the preset (see ``metadata/controllers``) of the MIDI controller that is connected."""
        self._settings.set_midi_device(self._state.port, "controller", controller)
        self._settings.set_midi_device(self._state.port, "breath", "")
        self._know(self._state.port)

    def set_mapping(self, mapping: ControllerMapping) -> None:
        """Set the MIDI messages by which the device sends breath and bite."""
        for name, value in (("channel", str(mapping.channel)), ("breath", mapping.breath), ("bite", mapping.bite)):
            self._settings.set_midi_device(self._state.port, name, value)
        self._know(self._state.port)

    def set_latency(self, latency_s: float) -> None:
        """Store the latency of the connected MIDI device in seconds, by which recorded notes are moved earlier."""
        self._settings.set_midi_device(self._state.port, "latency_s", repr(float(latency_s)))
        self._know(self._state.port)

    def _know(self, port: str) -> None:
        """Set the state to the settings stored for a device: preset, latency and mapping."""
        controllers = load_controllers()
        controller = self._settings.midi_device(port, "controller")
        if controller not in controllers:
            controller = recognised_controller(port).name
        try:
            latency_s = float(self._settings.midi_device(port, "latency_s") or 0.0)
        except ValueError:
            latency_s = 0.0
        # Also handles values such as nan or an hour from a hand-edited settings file.
        latency_s = latency_s if abs(latency_s) <= LARGEST_LATENCY_S else 0.0
        self._state.set(
            controller=controller, latency_s=latency_s, mapping=self._mapping(port, controllers[controller])
        )

    def _mapping(self, port: str, controller: Controller) -> ControllerMapping:
        """Return the mapping of MIDI messages to breath and bite: the one set for the device, else that of
        its preset.
        """
        said = {name: self._settings.midi_device(port, name) for name in ("channel", "breath", "bite")}
        try:
            return msgspec.convert({**said, "channel": int(said["channel"])}, ControllerMapping)
        except (ValueError, msgspec.ValidationError):
            # No setting was stored, or the settings file was edited by hand.
            return ControllerMapping(controller.channel, controller.breath[0], controller.bite)

    # Reports from the recorder

    def poll(self) -> None:
        """Receive and handle the messages of the recorder's process."""
        if self._link is None:
            return
        for reported in self._link.poll():
            self._take(reported)

    def _take(self, reported: News) -> None:
        state = self._state
        match reported:
            case Ports():
                state.set(ports=reported.inputs)
                self._find_again(reported.inputs)
                # The system no longer blocks the device; whether it can be opened is reported next.
                if reported.system and state.refusal is not None and state.port not in reported.inputs:
                    state.set(connection="waiting" if state.port else "none", refusal=None)
            case Opened() | Back():
                state.set(connection="open", refusal=None)
                if isinstance(reported, Back):
                    self._session.notice(Message("record.device_back", {"device": reported.port}))
            case Lost():
                state.set(connection="lost")
                self._silence()
                id = "record.device_lost_running" if state.running else "record.device_lost"
                self._session.notice(Message(id, {"device": reported.port}), Severity.WARNING)
            case RequestRefused():
                self._refused(reported.reason)
            case NotStarted():
                self._session.notice(reported.reason, Severity.ERROR)
                self._running = None
                self._ended()
            case Restarted():
                self._session.notice(reported.reason, Severity.WARNING)
            case Events():
                self._on_received(reported)
            case EventsSaved():
                state.set(events=reported.count)
            case Moved():
                self._moved(Path(os.fsdecode(reported.path)), reported.reason)
            case RecordingFinished():
                self._finished(Path(os.fsdecode(reported.path)))

    def _refused(self, reason: Message) -> None:
        """Report a failure of the recorder's process, such as a device that cannot be opened."""
        state = self._state
        if reason.id == "capture.port_not_here":
            # The editor waits for the device; no warning is needed when a window opens without it.
            state.set(connection="waiting", refusal=None)
            return
        if reason.id in NO_DEVICE:
            # The loss of the device and the rescue of the take have just been reported; the dialog shows why it is not
            # back.
            is_reported = state.connection == "lost"
            is_ours = reason.arguments.get("port", state.port) == state.port
            if is_ours:
                state.set(connection="refused" if state.port else "none", refusal=reason)
            if not state.port or is_reported:
                # Or no device was requested yet; the list of devices shows it.
                return
        self._session.notice(reason, Severity.ERROR)

    def _on_received(self, events: Events) -> None:
        mapping = self._state.mapping
        breath = self._state.breath
        for ns, raw in zip(events.times_ns, events.messages, strict=True):
            message = decoded(raw.hex())
            if message is None or not is_wired(message, mapping):
                continue
            self._sounding.receive(raw, None)
            breath = next((value for kind, value in curve_values(message, mapping) if kind == "breath"), breath)
            self._live.report(ns / 1e9, raw.hex(), mapping)
        self._state.set_played(breath, next((pitch for _, pitch in reversed(self._sounding.notes)), None))
        self._state.received.emit(events)

    def _silence(self) -> None:
        """End the notes of the player that still sound, after the device was lost or changed."""
        self._sounding.end_all()
        self._state.set_played(0.0, None)
        self._live.silence()

    # Take

    def toggle(self) -> None:
        """Start recording a take, or end the take that is being recorded."""
        if self._state.running:
            self.stop()
        else:
            self.record()

    def record(self) -> None:
        """Count in and record the armed player from the playhead, in the loop if there is one."""
        session, state = self._session, self._state
        player_id = self.recorded_player()
        playback = session.playback
        if player_id is None:
            session.notice(Message("record.no_player"), Severity.WARNING)
            return
        if playback is None:
            return
        self.begin()
        if state.connection != "open" or self._link is None:
            session.notice(Message("record.no_device"), Severity.WARNING)
            self.device_missing.emit()
            return
        start_s = session.playhead_s
        if session.loop_s is not None and not session.loop_s[0] <= start_s < session.loop_s[1]:
            start_s = session.loop_s[0]
        # Nothing sounds before the piece begins: a take started in the pre-roll, as after Home, begins with the piece.
        lead_s, start_s = start_s, max(start_s, 0.0)
        if self._state.count_in_bars:
            lead_s = self.count_in_from_s(start_s)
        try:
            path = journal_path(self._files.path, *self._files.recovery_stems)
        except AppError as error:
            session.notice(error.message, Severity.ERROR)
            return
        # After a crash the take is looked for beside the project file, so the project must be saved too.
        self._files.write_soon()
        header = JournalHeader(
            project=stored(self._files.path or ""),
            player=player_id,
            port=state.port,
            controller=state.controller,
            latency_s=state.latency_s,
            started=datetime.now(UTC).isoformat(timespec="milliseconds"),
        )
        elsewhere = second_path(path, *self._files.recovery_stems).absolute()
        self._running = _Running(
            path, elsewhere, player_id, start_s, session.loop_s, self._state.mapping, session.project
        )
        self._link.start(path, header, elsewhere)
        self._sound.set_recording((lead_s, start_s))
        state.set(running=True, start_s=start_s, counted_from_s=lead_s, passes=1, events=0)
        playback.play(lead_s)
        self._sync_timer.start()

    def recorded_player(self) -> str | None:
        """Return the id of the player to record: the armed player, else the active one; None without players."""
        ids = {player.id for player in self._session.project.players}
        if self._state.armed in ids:
            return self._state.armed
        return self._session.player.id if self._session.player is not None else None

    def count_in_from_s(self, start_s: float) -> float:
        """Return the time in seconds at which the count-in of a take begins: whole bars before the bar in which the
        take starts, so that the first click is on a downbeat.
        """
        if self._state.count_in_bars == 0:
            return start_s
        score = self._session.project.score
        bar = score.metre_map.bar_of_tick(round(score.tempo_map.ticks(start_s)))
        start, end = score.metre_map.span_of_bar(bar)
        return score.tempo_map.seconds(float(start - self._state.count_in_bars * (end - start)))

    def stop(self) -> None:
        """End the take and stop playback."""
        if self._session.playback is not None and self._session.playback.is_playing:
            # Stopping the playback notifies `_playing_changed`, which ends the take.
            self._session.playback.stop()
        else:
            self._end_take()

    def _playing_changed(self, playing: bool) -> None:
        if not playing and self._running is not None:
            self._end_take()

    def _sync(self) -> None:
        running, playback = self._running, self._session.playback
        if running is None or playback is None or self._link is None or not playback.is_playing:
            return
        ns, position_s = self.now_ns(), playback.position_s()
        if running.first_s is None:
            running.first_s = running.last_s = position_s
            return
        # A device just opened is silent at first.
        if running.passes == 1 and abs(position_s - running.first_s) < _STILL_S:
            return
        speed = self._session.listening.speed
        expected_s = running.last_s + speed * (ns - running.last_ns) / 1e9
        if running.last_ns and abs(position_s - expected_s) > _JUMP_S:
            self._turn(running, ns, position_s, speed)
        self._link.sync(ns, position_s, running.passes - 1)
        running.last_ns, running.last_s = ns, position_s

    def _turn(self, running: _Running, ns: int, position_s: float, speed: float) -> None:
        """Begin a new pass in the journal, after the loop has restarted or playback has jumped.

        Parameters
        ----------
        ns : int
            Time of the recorder's clock at which playback was at ``position_s``.
        """
        assert self._link is not None
        if running.loop_s is not None and position_s < running.last_s:
            begin_s, end_s = running.loop_s
            turn_ns = max(ns - round((position_s - begin_s) / speed * 1e9), running.last_ns)
            self._link.sync(turn_ns, end_s, running.passes - 1)
            self._link.sync(turn_ns, begin_s, running.passes)
        running.passes += 1
        self._state.set(passes=running.passes)

    def _end_take(self) -> None:
        running, self._running = self._running, None
        if running is not None and self._link is not None:
            if not running.last_ns and self._session.playback is not None:
                # The take ended before its position was known, so the position is reported now.
                self._link.sync(self.now_ns(), self._session.playback.position_s(), 0)
            self._adopting.append(running)
            self._link.stop()
        self._ended()

    def _ended(self) -> None:
        self._sync_timer.stop()
        self._state.set(running=False)
        self._sound.set_recording(None)

    # Journal and recovery

    def _moved(self, path: Path, reason: str) -> None:
        """Use the new path of a take's journal, which the recorder moved because it could not write to the first one,
        and warn the user.

        ``reason`` says why.
        """
        for running in (*self._adopting, *([self._running] if self._running is not None else ())):
            if running.second_path == path:
                said: dict[str, Argument] = {"file": str(running.path), "reason": reason, "journal": str(path)}
                running.path = path
                self._session.notice(Message("record.goes_on_elsewhere", said), Severity.WARNING)

    def _finished(self, path: Path) -> None:
        running = next((running for running in self._adopting if running.path == path), None)
        if running is None:
            return
        self._adopting.remove(running)
        try:
            journal = read_journal(path)
        except AppError as error:
            self._session.notice(error.message, Severity.ERROR)
            return
        takes = takes_of(
            journal,
            running.project.score.tempo_map,
            running.mapping,
            tr("recorder.take"),
            running.start_s,
            taken=_names(self._session.project, running.player_id),
        )
        if not takes:
            path.unlink(missing_ok=True)
            self._session.notice(Message("record.nothing_played"), Severity.WARNING)
            return
        self._adopt(path, running.player_id, takes, self._state.punch_ticks if self._state.punch else None)

    def _adopt(
        self, path: Path, player_id: str, takes: tuple[Take, ...], punch: tuple[int, int] | None, brought: bool = True
    ) -> bool:
        """Add takes to the project and use the last complete one in the part; return whether that succeeded.

        Parameters
        ----------
        path : Path
            Journal of the takes, deleted once they are saved.
        punch : (int, int) or None
            Range of ticks in which the part uses the take; None for all of it.
        brought : bool
            Whether the part uses a take at all.
        """
        if player_id not in {player.id for player in self._session.project.players}:
            self._session.notice(Message("record.player_gone", {"file": str(path)}), Severity.ERROR)
            return False

        def recorded(project: Project) -> Project:
            project, ids = add_takes(project, player_id, takes)
            if not brought:
                return project
            chosen = _whole(takes)
            take = takes[chosen]
            start_tick, end_tick = floor(_first_tick(take)), round(take.end_tick) + 1
            if punch is not None:
                start_tick, end_tick = max(start_tick, punch[0]), min(end_tick, punch[1])
            return comp(project, player_id, ids[chosen], start_tick, end_tick)

        if not self._session.attempt(Message("edit.record", {"count": len(takes)}), recorded):
            return False
        self._adopted[path] = takes[0]
        # Saved within a second, instead of the usual half a minute.
        self._files.write_soon()
        return True

    def _files_changed(self) -> None:
        """Delete the journals whose takes are saved in the project's file."""
        if not self._adopted or self._files.unwritten:
            return
        document = self._session.document
        known = {take.recorded for recorded in document.project.takes.values() for take in recorded.takes}
        # If another project was opened meanwhile, no file contains the takes, so their journal is kept.
        is_this = bool(document.done or document.undone)
        for path, take in self._adopted.items():
            if take.recorded in known or is_this:
                path.unlink(missing_ok=True)
        self._adopted.clear()

    def _project_opened(self) -> None:
        """Add to the opened project the takes whose recording was interrupted by a crash."""
        if self._state.running:
            self.stop()
        # Takes of another project stay beside its file until it is opened again.
        self._adopting.clear()
        self._state.set(armed="", punch=False, punch_ticks=None)
        if self._files.is_open:
            for path in journals_of(self._files.path, *self._files.recovery_stems):
                try:
                    self._recover(path, read_journal(path))
                except AppError as error:
                    self._session.notice(error.message, Severity.WARNING)
            self._recover_elsewhere()

    def _recover_elsewhere(self) -> None:
        """Add to the open project its takes whose journals were moved to another folder."""
        document = self._files.path
        if document is None:
            return
        for path in in_second_places(*self._files.recovery_stems):
            try:
                journal = read_journal(path)
            except AppError:
                # The project of this journal is unknown, so the journal is kept.
                continue
            if file_named(journal.header.project) == str(document):
                self._recover(path, journal)

    def _recover(self, path: Path, journal: Journal) -> None:
        project = self._session.project
        known = {take.recorded for recorded in project.takes.values() for take in recorded.takes}
        controller = load_controllers().get(journal.header.controller) or recognised_controller(journal.header.port)
        mapping = ControllerMapping(controller.channel, controller.breath[0], controller.bite)
        name = tr("recorder.recovered_take")
        takes = takes_of(journal, project.score.tempo_map, mapping, name, taken=_names(project, journal.header.player))
        if not takes or journal.header.started in known:
            path.unlink(missing_ok=True)
            return
        if self._adopt(path, journal.header.player, takes, None, brought=False):
            self._session.notice(Message("record.recovered", {"count": len(takes)}))

    def close(self) -> None:
        """End the recorder's process; a take that is being recorded is completed in its journal."""
        self._sync_timer.stop()
        if self._link is not None:
            link, self._link = self._link, None
            link.stop()
            link.close()


def _names(project: Project, player_id: str) -> tuple[str, ...]:
    """Return the names of all takes recorded for a player."""
    recorded = project.takes.get(player_id)
    return tuple(take.name for take in recorded.takes) if recorded is not None else ()


def _first_tick(take: Take) -> float:
    """Return the tick at which a take begins, slightly earlier if its first note was struck just before the start."""
    onsets_s, start_s = take.played.onsets_s, take.start_us / 1e6
    early_s = onsets_s[(onsets_s >= start_s - EARLY_S) & (onsets_s < start_s)]
    return take.tempo_map.ticks(float(early_s[0]) if len(early_s) else start_s)


def _whole(takes: tuple[Take, ...]) -> int:
    """Return the index of the take to use in the part: the last one that covers nearly all of the loop."""
    longest_us = max(take.end_us - take.start_us for take in takes)
    whole = [index for index, take in enumerate(takes) if take.end_us - take.start_us > 0.9 * longest_us]
    return whole[-1]
