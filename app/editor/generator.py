"""Plans and motion kept up with the document: after every edit, beside the window, the newest first.

What an edit touches is planned at once where that takes no time, else by a thread that yields to the window; the same
thread makes the motion, what is looked at first.
"""

from __future__ import annotations

import sys
import threading
import time
import weakref
from functools import partial
from typing import Protocol

from PySide6.QtCore import QObject, QTimer, Signal

from app.editor.calls import Reporter
from app.editor.memory import give_back
from app.editor.session import Session, Severity
from app.editor.tasks import Progress, StopRequested, Tasks
from app.errors import AppError, Cancelled, Message
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion, PlayerFault
from app.project.document import Change
from app.project.model import Project
from app.rig.characters.character_library import character_library
from instrument_maps.library import library
from metadata.library import metadata_library

AT_ONCE_NOTES = 2500
"""Number of notes that are planned within the time of two pictures ..."""
AT_ONCE_S = 0.1
"""... unless they turn out to cost more of the processor than this: many players, or what no musician writes."""
REPORTED_NOTES = 6000
"""Number of notes from which planning shows its progress and can be stopped."""
SWITCH_S = 0.001
"""The window gets the interpreter back from the worker within this time."""
REPORT_S = 0.04
"""Other poses at the playhead are reported to the window at once, but no more often than this ..."""
REPORT_READY_S = 0.25
"""... and of how much is made this often."""
GIVE_WAY = 3.0
"""Where the window or another thread worked too while something was made that no one waits for, the worker rests so
many times as long as that took: two threads of Python hold each other up far more than they compute."""
OTHERS_S = 0.0005
"""Less than this is no work: timers."""
MOST_REST_S = 0.1
GIVE_BACK_CHUNKS = 64
"""Memory that was needed on the way is returned once everything is made, but not after a few chunks of an edit."""
REPORT_BROKEN_S = 0.5
"""Interval of reports of broken contacts while much is made: every list of problems is filled again by one."""
REST_WHILE_JUDGING = 3.0
"""Contacts of motion that there is no room to keep are judged while nothing plays, resting this many times as long as
the work took: an hour of an orchestra takes minutes, and no one waits for it."""
REST_WHILE_PLAYING = 1.0
"""While the performance plays the worker rests this many times as long as it worked."""


def _goes_on() -> bool:
    return False


class Generator(QObject):
    """Makes performance and motion of a session's project, until it is closed.

    Parameters
    ----------
    tasks : Tasks
        Where plans are made that take long.

    Signals
    -------
    motion_changed()
        Poses are there that were not, or are other ones.
    front_changed()
        The player in front does what an edit changed. It is drawn before the panels follow the new plans, which takes
        them longer than making it.
    ready_changed(float)
        Share 0..1 of the motion that is made.
    """

    motion_changed = Signal()
    front_changed = Signal()
    ready_changed = Signal(float)

    def __init__(self, session: Session, tasks: Tasks) -> None:
        super().__init__()
        self._session, self._tasks = session, tasks
        self._asked = 0
        """Plans are numbered as they are asked for."""
        self._shown = 0
        """Number of the newest that was shown, or would be of no use: older ones are dropped."""
        self._long = False
        """True while a long planning is under way."""
        self._holding: frozenset[tuple[str, str]] = frozenset()
        """Characters and instruments whose holds are being found ..."""
        self._hold_stopped: StopRequested = _goes_on
        """... and whether the user has stopped that."""
        self._ready = -1.0
        self.live = LiveMotion(session.performance)
        """The motion of all players: the viewport draws `LiveMotion.pose`."""
        self._worker = _Worker(self.live, Reporter(self, lambda generator: generator._end.alive))
        self._end = weakref.finalize(self, self._worker.close)
        session.changed.connect(self._project_changed)
        session.performance_changed.connect(self._show)
        session.instruments_changed.connect(self._plan_again)
        session.characters_changed.connect(self._plan_again)
        session.choreographies_changed.connect(self._plan_again)
        session.metadata_changed.connect(self._plan_again)
        session.playhead_changed.connect(self._request_poses)
        session.players_changed.connect(self._request_poses)
        session.playing_changed.connect(self._worker.set_playing)
        self._request_poses()
        self._worker.start()

    @property
    def up_to_date(self) -> bool:
        """True if the session's plans are those of its project, on the instruments, characters and metadata there are
        now."""
        performance = self._session.performance
        now = performance.library is library() and performance.characters is character_library()
        now = now and performance.metadata.is_still(metadata_library())
        return performance.project is self._session.project and now

    @property
    def ready_share(self) -> float:
        """Share 0..1 of the motion that is made."""
        return self.live.ready_share

    def close(self) -> None:
        """End the worker; nothing is made any more."""
        self._end()

    def _project_changed(self, change: Change) -> None:
        if change.opened:
            self._shown = self._asked
            self._long = False
            self._worker.drop()
        self._plan(change.after)

    def _plan_again(self) -> None:
        self._plan(self._session.project)

    def _plan(self, project: Project) -> None:
        if self._long:
            # It is finished first: of edits that come faster than plans, some are seen.
            return
        # Two threads of Python hold each other up: the user waits for this one, until the edit is drawn.
        self._worker.pause()
        QTimer.singleShot(0, self, self._worker.go_on)
        try:
            performance = Performance(project, self._session.performance)
            unheld = performance.unheld
            if unheld:
                waiting = frozenset(player.id for player in unheld)
                performance = Performance(project, self._session.performance, waiting)
        except AppError as error:
            self._session.notice(error.message, Severity.ERROR)
            return
        if unheld:
            self._hold_reported(performance)
        self._asked += 1
        notes = performance.unplanned_notes
        if notes > REPORTED_NOTES:
            self._worker.drop()
            self._plan_reported(performance)
        elif notes > AT_ONCE_NOTES or self._worker.planning:
            self._worker.plan(performance, self._asked)
        else:
            try:
                made = performance.prepare_within(AT_ONCE_S)
            except AppError as error:
                self._session.notice(error.message, Severity.ERROR)
                return
            if not made:
                self._worker.plan(performance, self._asked)
                return
            self._shown = self._asked
            try:
                self._make_now(performance)
            finally:
                # Also where the player in front met a fault.
                self._session.set_performance(performance)

    def _make_now(self, performance: Performance) -> None:
        """What the player in front does at the playhead is there before anything is drawn: one picture, and it is
        right. But in a drag, of which more will come, and where players are others, whose figures have to be loaded."""
        before, done = self._session.performance, self._session.document.done
        same_figures = performance.project.players is before.project.players and performance.library is before.library
        if same_figures and not (done and done[-1].gesture is not None):
            self.live.show(performance)
            for player_id in self._session.players[:1]:
                self.live.make_now(player_id, self._session.playhead_s)
            self.front_changed.emit()

    def _hold_reported(self, performance: Performance) -> None:
        """Find out how instruments are held that no one held before; the others play on meanwhile. Where the user
        stops that, the next edit asks again."""
        requested = frozenset((player.character_id, player.instrument_id) for player in performance.unheld)
        if requested <= self._holding and not self._hold_stopped():
            return
        self._holding, self._hold_stopped = requested, _goes_on

        def work(progress: Progress, stop_requested: StopRequested) -> None:
            self._hold_stopped = stop_requested
            performance.hold(stop_requested, progress)

        def ended() -> None:
            # Also what was stopped because other players came has ended then: theirs go on.
            if self._holding is requested:
                self._holding = frozenset()

        name = Message("work.hold", {"players": len(performance.unheld)})
        self._tasks.run(name, work, lambda _: self._plan_again(), key="hold", ended=ended)

    def _plan_reported(self, performance: Performance) -> None:
        number = self._asked
        self._long = True

        def work(progress: Progress, stop_requested: StopRequested) -> Performance:
            try:
                performance.prepare(lambda: stop_requested() or self._shown >= number, progress)
            finally:
                # Also where the user stopped it: then no one is reported.
                if self._shown < number:
                    self._long = False
            return performance

        name = Message("work.plan", {"players": len(performance.project.players)})
        self._tasks.run(
            name,
            work,
            lambda made: self._planned(made, number, None),
            lambda error: self._planned(performance, number, error),
            key="plan",
        )

    def _planned(self, performance: Performance, number: int, error: AppError | None) -> None:
        if number <= self._shown:
            return
        self._shown = number
        if error is not None:
            self._session.notice(error.message, Severity.ERROR)
            return
        self._session.set_performance(performance)
        if not self.up_to_date and not self._worker.planning:
            self._plan(self._session.project)

    def _show(self) -> None:
        self.live.show(self._session.performance)
        self.live.request(self._session.playhead_s, player_ids=self._session.players)
        # Once the panels have shown the plans: two threads of Python hold each other up.
        QTimer.singleShot(0, self, self._worker.wake)
        self.motion_changed.emit()

    def _request_poses(self, *_: object) -> None:
        self.live.request(self._session.playhead_s, player_ids=self._session.players)
        self._worker.wake()

    def _worked(self, ready: float) -> None:
        if ready != self._ready:
            self._ready = ready
            self.ready_changed.emit(ready)

    def _fell(self, fault: BaseException) -> None:
        """A fault of the program that the worker met is reported like one that the window met."""
        raise fault


class _Clock(Protocol):
    """What the module `time` has of clocks: a module is of no class that could be named."""

    def monotonic(self) -> float: ...

    def process_time(self) -> float: ...

    def thread_time(self) -> float: ...

    def sleep(self, seconds: float, /) -> None: ...


class _Worker:
    """The thread: plans first, then motion. Holds nothing of the window, so that it may end at any time."""

    def __init__(self, live: LiveMotion, report: Reporter[Generator], clock: _Clock = time) -> None:
        self._live, self._report, self._clock = live, report, clock
        self._changed = threading.Condition()
        self._pending: tuple[Performance, int] | None = None
        self._planning = False
        self._dropped = threading.Event()
        self._requests = 0
        self._met = -1
        """Requests up to this one are served."""
        self._closed = False
        self._playing = False
        self._paused = False
        self._given_back = 0
        """Amount of motion made when memory was returned last."""
        self._reported_s = 0.0
        self._reported_seen = live.seen
        self._reported_seen_s = 0.0
        self._judging = True
        """True while there may be contacts to judge besides the motion that is made to be seen."""
        self._reported_broken = live.broken
        self._reported_broken_s = 0.0
        self._thread = threading.Thread(target=self._run, name="generator", daemon=True)
        self._switch_s = sys.getswitchinterval()

    def start(self) -> None:
        sys.setswitchinterval(SWITCH_S)
        self._thread.start()

    @property
    def planning(self) -> bool:
        return self._planning or self._pending is not None

    def plan(self, performance: Performance, number: int) -> None:
        """Plan this next, instead of what waits."""
        with self._changed:
            self._pending = (performance, number)
            self._changed.notify()

    def drop(self) -> None:
        """What is planned is of no use any more."""
        with self._changed:
            self._pending = None
            self._dropped.set()

    def wake(self) -> None:
        """Something else is requested."""
        with self._changed:
            self._requests += 1
            self._changed.notify()

    def pause(self) -> None:
        """Make no more motion, once what is being made is, until `go_on`."""
        self._paused = True

    def go_on(self) -> None:
        """The window does not need the processor for itself any more."""
        with self._changed:
            self._paused = False
            self._changed.notify()

    def set_playing(self, playing: bool) -> None:
        with self._changed:
            self._playing = playing
            self._changed.notify()

    def close(self) -> None:
        with self._changed:
            self._closed = True
            self._pending = None
            self._dropped.set()
            self._changed.notify()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join(2.0)
        sys.setswitchinterval(self._switch_s)

    def _run(self) -> None:
        while not self._closed:
            with self._changed:
                while self._waits:
                    self._changed.wait()
                job, self._pending = self._pending, None
                self._planning = job is not None
                self._dropped.clear()
            if job is not None:
                self._make_plans(*job)
            elif not self._idle:
                self._make_motion()
            elif not self._closed:
                self._judge()

    @property
    def _waits(self) -> bool:
        if self._closed or self._pending is not None:
            return False
        return self._paused or (self._idle and (self._playing or not self._judging))

    @property
    def _idle(self) -> bool:
        return self._met == self._requests and self._pending is None and not self._closed

    def _make_plans(self, performance: Performance, number: int) -> None:
        failed: AppError | None = None
        try:
            performance.prepare(self._dropped.is_set)
        except Cancelled:
            return
        except AppError as error:
            failed = error
        except Exception as fault:  # noqa: BLE001 - reported in the window's thread
            self._report(partial(Generator._fell, fault=fault))
            return
        finally:
            self._planning = False
        self._report(partial(Generator._planned, performance=performance, number=number, error=failed))

    def _make_motion(self) -> None:
        clock, requests = self._clock, self._requests
        start_s, others_s = clock.monotonic(), clock.process_time() - clock.thread_time()
        try:
            more = self._live.work(lambda: self._closed or self._paused or self._pending is not None)
        except PlayerFault as fault:
            # The others go on.
            self._report(partial(Generator._fell, fault=fault))
            return
        except Exception as fault:  # noqa: BLE001 - reported in the window's thread
            self._met = requests
            self._report(partial(Generator._fell, fault=fault))
            return
        now_s = clock.monotonic()
        others_s = clock.process_time() - clock.thread_time() - others_s
        if not more:
            self._met = requests
            self._judging = True
            if self._live.made - self._given_back >= GIVE_BACK_CHUNKS:
                self._given_back = self._live.made
                give_back()
        awaited = not self._live.is_seen
        self._report_broken(now_s, not more)
        if self._live.seen != self._reported_seen and (now_s - self._reported_seen_s >= REPORT_S or not awaited):
            self._reported_seen, self._reported_seen_s = self._live.seen, now_s
            self._report(lambda generator: generator.motion_changed.emit())
        if now_s - self._reported_s >= REPORT_READY_S or not more:
            self._reported_s = now_s
            self._report(partial(Generator._worked, ready=self._live.ready_share))
        if self._playing:
            clock.sleep(REST_WHILE_PLAYING * (now_s - start_s))
        elif not awaited and others_s > OTHERS_S:
            self._rest(min(GIVE_WAY * (now_s - start_s), MOST_REST_S), requests)

    def _rest(self, rest_s: float, requests: int) -> None:
        """Until something else is requested than these, at most so long."""
        with self._changed:
            self._changed.wait_for(
                lambda: self._closed or self._pending is not None or self._requests != requests, timeout=rest_s
            )

    def _judge(self) -> None:
        start_s = self._clock.monotonic()
        try:
            self._judging = self._live.judge(lambda: not self._idle)
        except PlayerFault as fault:
            self._report(partial(Generator._fell, fault=fault))
            return
        except Exception as fault:  # noqa: BLE001 - reported in the window's thread
            self._judging = False
            self._report(partial(Generator._fell, fault=fault))
            return
        now_s = self._clock.monotonic()
        self._report_broken(now_s, not self._judging)
        with self._changed:
            if self._judging and self._idle:
                self._changed.wait(REST_WHILE_JUDGING * (now_s - start_s))

    def _report_broken(self, now_s: float, at_once: bool) -> None:
        broken = self._live.broken
        if broken is not self._reported_broken and (at_once or now_s - self._reported_broken_s >= REPORT_BROKEN_S):
            self._reported_broken, self._reported_broken_s = broken, now_s
            self._report(lambda generator: generator._session.set_broken(broken))
