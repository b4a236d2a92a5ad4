"""Streams poses of performers during playback, scrubbing, rest and recording: see `app.stream`.

Sending runs on a thread; the window provides the requested performers, the playback position, and whether something
moves. Frames that the network does not accept immediately are dropped. At rest it continues slowly, so that receivers
see the connection.
"""

from __future__ import annotations

import threading
import time
import weakref
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

from PySide6.QtCore import QObject

from app.editor.live_poses import LivePoses
from app.editor.poses import PoseSource
from app.editor.session import Session, Severity
from app.editor.settings import Settings
from app.editor.streaming import RATES_HZ, StreamState
from app.editor.window_thread_calls import Reporter
from app.errors import AppError, Message, Progress, StopRequested
from app.performance.cast import attempt
from app.project.casting import StagePosition
from app.project.performers import Dancer, Player
from app.rig.characters.character_library import character_named
from app.rig.model import Character
from app.stream.faces import FACE_NAMES, FaceNames
from app.stream.sender import MOST_PORT, TO_MANY, Address, Sender, SendOutcome, StreamError, find_address, reaches_many
from app.stream.vmc import IN_THE_MIDDLE, Sent

RESTING_S: Final = 0.2
"""Seconds between two frames while nothing moves."""
SETTLED_S: Final = 0.5
"""Seconds after the last movement for which frames are sent at the full rate, since receivers smooth them."""
RETRY_S: Final = 2.0
"""Seconds until the next attempt after a failure to send."""
REPORT_S: Final = 0.5
"""Interval in seconds of reports about the stream."""
ALONE_S: Final = 1.0
"""Seconds without a playback position after which the window is considered to hang, and streaming stops."""
_SECOND_S: Final = 1.0


class Streamer(QObject):
    """Sends poses to other programs as set in `session.streaming`.

    Parameters
    ----------
    session : Session
        Session that becomes the parent.
    settings : Settings
        Settings that store the destination, but not whether streaming was on.
    poses : PoseSource
        Source of the poses, read on the sending thread.
    """

    def __init__(self, session: Session, settings: Settings, poses: PoseSource) -> None:
        super().__init__(session)
        self._session, self._settings, self._state = session, settings, session.streaming
        self._poses = LivePoses(session, poses)
        self._address: Address | None = None
        self._asked: tuple[str, int, bool] | None = None
        """Host and port of the address that is looked up, and whether it may be a broadcast address."""
        self._thread: _Thread | None = None
        self._ending: weakref.finalize[[], Streamer] | None = None
        """Closes the thread, also where the owner does not."""
        self._restore()
        self._settled = self._requested()
        self._state.changed.connect(self._changed)
        session.changed.connect(self._request)
        session.players_changed.connect(self._request)
        session.dancer_changed.connect(self._request)
        live = session.live_players
        for signal in (
            *(session.playhead_changed, session.playing_changed, session.performance_changed),
            *(live.changed, live.struck),
        ):
            signal.connect(self.moved)

    # Requests

    def _restore(self) -> None:
        settings = self._settings
        faces = settings.stream_faces
        self._state.set(
            host=settings.stream_host or self._state.host,
            port=settings.stream_port or self._state.port,
            everyone=settings.stream_everyone,
            rate_hz=settings.stream_rate_hz if settings.stream_rate_hz in RATES_HZ else self._state.rate_hz,
            faces=next((name for name in FACE_NAMES if name == faces), self._state.faces),
        )

    def _requested(self) -> tuple[object, ...]:
        state = self._state
        return state.on, state.host, self._broadcast, state.port, state.everyone, state.faces, state.rate_hz

    @property
    def _broadcast(self) -> bool:
        """Return whether the host is a broadcast address that the user has confirmed."""
        return self._state.broadcast == self._state.host

    def _changed(self) -> None:
        requested = self._requested()
        if requested == self._settled:
            return
        self._settled = requested
        state, settings = self._state, self._settings
        settings.stream_host, settings.stream_port = state.host, state.port
        settings.stream_everyone, settings.stream_faces = state.everyone, state.faces
        settings.stream_rate_hz = state.rate_hz
        if not state.on:
            self.close()
        elif (state.host, state.port, self._broadcast) != self._asked:
            self._look_up()
        else:
            self._request()

    def _look_up(self) -> None:
        """Look up the address of the host name in the background, since this may take seconds."""
        asked = host, port, broadcast = self._state.host, self._state.port, self._broadcast
        self.close()
        self._asked = asked
        self._state.set(state="looking")

        def work(progress: Progress, stop_requested: StopRequested) -> Address:
            address = find_address(host, port)
            if not broadcast and reaches_many(address):
                raise StreamError(TO_MANY, host=host)
            return address

        def done(address: Address) -> None:
            if self._asked == asked:
                self._begin(address)

        def failed(error: AppError) -> None:
            if self._asked == asked:
                self._fail(error.message)

        self._session.tasks.run(Message("work.stream", {"host": host}), work, done, failed, key="stream")

    def _begin(self, address: Address) -> None:
        self._address = address
        self._state.set(state="sending", trouble=None)
        thread = _Thread(self._poses, Reporter(self, lambda streamer: streamer._thread is thread))
        self._thread, self._ending = thread, weakref.finalize(self, thread.close)
        thread.begin()
        self._request()

    def close(self) -> None:
        """Stop sending."""
        self._asked = self._address = None
        if self._ending is not None:
            self._ending()
        self._thread = self._ending = None
        self._state.set(state="off", lines=(), sent_hz=0, trouble=None)

    def _request(self, *_: object) -> None:
        """Tell the sending thread the performers to send and the address of the receiver."""
        if self._address is None or self._thread is None:
            return
        state, project = self._state, self._session.project
        lines = state.planned(project, self._session.in_front)
        if lines != state.lines:
            state.set(lines=lines)
            if state.everyone and len(lines) < len(project.seen):
                reported = Message(
                    "stream.no_room", {"count": len(project.seen), "port": state.port, "most": MOST_PORT}
                )
                self._session.notice(reported, Severity.WARNING)
        everyone = {performer.id: performer for performer in project.performers}
        performers = [everyone[line.player_id] for line in lines]
        beside = [project.played_by(one)[1:] if isinstance(one, Player) else () for one in performers]
        self._thread.request(
            _Request(
                address=self._address,
                performers=tuple(performers),
                beside=tuple(beside),
                ports=tuple(line.port for line in lines),
                stages=tuple(one.stage if state.everyone else IN_THE_MIDDLE for one in performers),
                faces=state.faces,
                rate_hz=state.rate_hz,
                broadcast=self._broadcast,
            )
        )
        self.moved()

    def moved(self, *_: object) -> None:
        """Tell the sending thread the playback position, because it has changed or something in the viewport moves."""
        if self._thread is None:
            return
        session, playback = self._session, self._session.playback
        if session.playing and playback is not None:
            anchor = _Anchor(playback.position_s(), time.perf_counter(), session.listening.speed, session.loop_s)
        else:
            anchor = _Anchor(session.playhead_s, time.perf_counter(), 0.0, None)
        self._thread.move(anchor)

    # Reports

    def _report(self, sent_hz: int, no_receiver: bool) -> None:
        state: StreamState = "no_receiver" if no_receiver else "sending"
        self._state.set(state=state, sent_hz=sent_hz, trouble=None)

    def _fail(self, message: Message) -> None:
        """Report a failure to send once; sending is tried again while streaming is on."""
        if self._state.trouble != message:
            self._session.notice(message, Severity.ERROR)
        self._state.set(state="failed", trouble=message, sent_hz=0)

    def _fell(self, fault: BaseException) -> None:
        """End streaming after an unexpected exception of the sending thread."""
        self._state.set(on=False)
        raise fault


@dataclass(frozen=True)
class _Request:
    """Request to the sending thread: receiver's address, performers, and a port for each.

    Attributes
    ----------
    beside : tuple of tuple of Player
        Players of the other instruments that each performer (a musician) plays.
    stages : tuple of StagePosition
        Position of each performer on the stage.
    faces : FaceNames
        Names under which the curves of faces are sent.
    """

    address: Address
    performers: tuple[Player | Dancer, ...]
    beside: tuple[tuple[Player, ...], ...]
    ports: tuple[int, ...]
    stages: tuple[StagePosition, ...]
    faces: FaceNames
    rate_hz: int
    broadcast: bool


@dataclass(frozen=True)
class _Anchor:
    """Position and speed of playback at a moment of `time.perf_counter`, from which later positions are computed."""

    position_s: float
    at_s: float
    speed: float
    loop_s: tuple[float, float] | None

    def position(self, now_s: float) -> float:
        """Return the position of playback in seconds at a moment of `time.perf_counter`, at most the end of
        the loop.
        """
        position_s = self.position_s + min(now_s - self.at_s, ALONE_S) * self.speed
        if self.loop_s is not None and self.position_s < self.loop_s[1]:
            return min(position_s, self.loop_s[1])
        return position_s


class _Thread:
    """Thread that sends frames of poses at a rate. It has no reference to objects of the window."""

    def __init__(self, poses: LivePoses, say: Reporter[Streamer]) -> None:
        self._poses, self._say = poses, say
        self._changed = threading.Condition()
        self._request: _Request | None = None
        self._anchor = _Anchor(0.0, 0.0, 0.0, None)
        self._moved_s = 0.0
        self._closed = False
        self._began_s = time.perf_counter()
        self._senders: dict[int, Sender] = {}
        self._sent: dict[str, tuple[tuple[Character, str | None, FaceNames, tuple[str, ...]], Sent]] = {}
        self._frames: deque[float] = deque()
        self._reported_s = self._began_s
        self._thread = threading.Thread(target=self._run, name="streamer", daemon=True)

    # Calls of the window

    def begin(self) -> None:
        self._thread.start()

    def request(self, request: _Request) -> None:
        with self._changed:
            self._request = request
            self._changed.notify()

    def move(self, anchor: _Anchor) -> None:
        with self._changed:
            rested = time.perf_counter() - self._moved_s > SETTLED_S
            self._anchor, self._moved_s = anchor, time.perf_counter()
            if rested:
                self._changed.notify()

    def close(self) -> None:
        with self._changed:
            self._closed = True
            self._changed.notify()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join(2.0)

    # Thread

    def _run(self) -> None:
        due_s = time.perf_counter()
        try:
            while not self._closed:
                due_s = self._step(due_s)
        except Exception as error:  # noqa: BLE001 - reported in the window's thread
            self._say(partial(Streamer._fell, fault=error))
        finally:
            self._close_senders()

    def _step(self, due_s: float) -> float:
        """Send the frame that is due, and return the time of the next one."""
        with self._changed:
            moved_s = self._moved_s
            # Woken early when something moves again or another request arrives.
            while not self._closed and (self._request is None or time.perf_counter() < due_s):
                if self._request is not None and self._moved_s != moved_s and self._rests(moved_s):
                    break
                self._changed.wait(None if self._request is None else max(due_s - time.perf_counter(), 0.0))
            request, anchor = self._request, self._anchor
        if self._closed or request is None:
            return due_s
        now_s = time.perf_counter()
        try:
            no_receiver = self._send(request, anchor.position(now_s), now_s)
        except AppError as error:
            self._close_senders()
            self._say(partial(Streamer._fail, message=error.message))
            return time.perf_counter() + RETRY_S
        self._report(now_s, no_receiver)
        if anchor.speed or self._poses.is_live:
            self._moved_s = max(self._moved_s, now_s)
        step_s = RESTING_S if self._rests(self._moved_s) else 1.0 / request.rate_hz
        # Due times follow the clock and not the last frame, which keeps the rate; missed frames are skipped.
        due_s += step_s
        return due_s if now_s - step_s < due_s <= now_s + step_s else now_s + step_s

    @staticmethod
    def _rests(moved_s: float) -> bool:
        return time.perf_counter() - moved_s > SETTLED_S

    def _send(self, request: _Request, time_s: float, now_s: float) -> bool:
        """Send the poses at the time ``time_s`` of all performers; return True if no receiver answers."""
        for port in self._senders.keys() - set(request.ports):
            self._senders.pop(port).close()
        everything = [*(one.id for one in request.performers), *(one.id for played in request.beside for one in played)]
        posed = dict(zip(everything, self._poses.poses(everything, time_s), strict=True))
        # Instruments that are played besides but cannot be shown are not sent.
        beside = {
            performer.id: [one for one in played if posed[one.id] is not None]
            for performer, played in zip(request.performers, request.beside, strict=True)
        }
        # A player whose character was removed after the pose was made is listed among the problems.
        sent = attempt(
            request.performers, lambda performer: self._sent_of(performer, request.faces, beside[performer.id])
        ).made
        outcomes = list[SendOutcome]()
        for performer, port, stage in zip(request.performers, request.ports, request.stages, strict=True):
            pose = posed[performer.id]
            others = [other for one in beside[performer.id] if (other := posed[one.id]) is not None]
            # Poses that do not exist yet are not sent: the receiver keeps the last one.
            if pose is not None and performer.id in sent:
                datagrams = sent[performer.id].datagrams(pose, now_s - self._began_s, stage, others)
                if port not in self._senders:
                    self._senders[port] = Sender(request.address.port(port), request.broadcast)
                outcomes.append(self._senders[port].send(datagrams))
        if outcomes and SendOutcome.DROPPED not in outcomes:
            self._frames.append(now_s)
        return bool(outcomes) and all(outcome is SendOutcome.NO_RECEIVER for outcome in outcomes)

    def _sent_of(self, performer: Player | Dancer, faces: FaceNames, beside: Sequence[Player]) -> Sent:
        """Return the encoder of a performer's stream, replaced after a change of character, instruments or
        curve names.
        """
        instrument = performer.instrument_id if isinstance(performer, Player) else None
        of = (character_named(performer.character_id), instrument, faces, tuple(one.instrument_id for one in beside))
        known = self._sent.get(performer.id)
        if known is None or known[0] != of:
            known = self._sent[performer.id] = (of, Sent(*of))
        return known[1]

    def _report(self, now_s: float, no_receiver: bool) -> None:
        if now_s - self._reported_s < REPORT_S:
            return
        self._reported_s = now_s
        while self._frames and now_s - self._frames[0] > _SECOND_S:
            self._frames.popleft()
        self._say(partial(Streamer._report, sent_hz=len(self._frames), no_receiver=no_receiver))

    def _close_senders(self) -> None:
        for sender in self._senders.values():
            sender.close()
        self._senders.clear()
