"""Thread that computes plans and motion, yielding to the window."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from PySide6.QtCore import QObject

from app.editor.freed_memory import give_back
from app.editor.window_thread_calls import Reporter
from app.errors import AppError, Cancelled
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion, PlayerFault
from app.plan.model import Problem

T = TypeVar("T", bound=QObject)

SWITCH_S = 0.001
"""Longest time in seconds for which the worker may keep the interpreter from the window's thread."""
REPORT_S = 0.04
"""Least interval in seconds of signals to the window that poses at the playhead have changed."""
REPORT_READY_S = 0.25
"""Least interval in seconds of signals to the window about progress."""
GIVE_WAY = 3.0
"""Rest of the worker after low-priority work, as a multiple of that work's time, if the window or another thread worked
too, since two threads of Python delay each other far more than they compute.
"""
OTHERS_S = 0.0005
"""Work shorter than this time in seconds, such as a timer, does not count as work of another thread."""
MOST_REST_S = 0.1
GIVE_BACK_CHUNKS = 64
"""Number of computed chunks after which memory is returned to the system; an edit computes fewer."""
REPORT_BROKEN_S = 0.5
"""Interval in seconds of reports of broken contacts during long computations, since each one fills all lists of
problems again.
"""
REST_WHILE_JUDGING = 3.0
"""Pause after judging contacts of motion that is not kept, as a multiple of the work's time, while nothing plays: an
hour of an orchestra takes minutes at low priority.
"""
QUIET_S = 2.0
"""Time in seconds without requests after which the arms of each player are measured, which takes about a second."""
REST_WHILE_PLAYING = 1.0
"""Pause of the worker during playback, as a multiple of the time that it worked."""


class _Clock(Protocol):
    """Interface of a clock of the module `time`, which has no class to refer to."""

    def monotonic(self) -> float: ...

    def process_time(self) -> float: ...

    def thread_time(self) -> float: ...

    def sleep(self, seconds: float, /) -> None: ...


@dataclass(frozen=True)
class Reports(Generic[T]):
    """Functions by which the planning worker reports to the window, called on the worker's thread.

    Attributes
    ----------
    planned : callable
        A plan is finished (with its number), or failed with an error.
    moved : callable
        Motion was computed.
    worked : callable
        A share 0..1 of the motion is computed.
    broken : callable
        The broken contacts and arms in clothes found in the motion, as problems by player id.
    fell : callable
        An unexpected exception ended the worker.
    """

    planned: Callable[[T, Performance, int, AppError | None], None]
    moved: Callable[[T], None]
    worked: Callable[[T, float], None]
    broken: Callable[[T, Mapping[str, tuple[Problem, ...]]], None]
    fell: Callable[[T, BaseException], None]


class PlanWorker(Generic[T]):
    """Worker thread that computes plans first, then motion. It has no reference to objects of the window, so it may end
    at any time.
    """

    def __init__(self, live: LiveMotion, report: Reporter[T], says: Reports[T], clock: _Clock = time) -> None:
        self._live, self._report, self._says, self._clock = live, report, says, clock
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
        self._measuring = True
        """True while there may be arms to measure."""
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
        """Request the plan of a performance from the worker thread; it replaces any request that still waits.
        ``number`` identifies the result."""
        with self._changed:
            self._pending = (performance, number)
            self._changed.notify()

    def drop(self) -> None:
        """Discard the requested plans that are not finished."""
        with self._changed:
            self._pending = None
            self._dropped.set()

    def wake(self) -> None:
        """Wake the thread if it waits, because there is a new request."""
        with self._changed:
            self._requests += 1
            self._changed.notify()

    def pause(self) -> None:
        """Pause the computation of motion after the chunk in progress, until `go_on` is called."""
        self._paused = True

    def go_on(self) -> None:
        """Continue the computation of motion after `pause`."""
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
            elif self._judging:
                self._judge()
            else:
                self._measure_arms()

    @property
    def _waits(self) -> bool:
        if self._closed or self._pending is not None:
            return False
        return self._paused or (self._idle and (self._playing or not (self._judging or self._measuring)))

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
            self._fell(fault)
            return
        finally:
            self._planning = False
        planned = self._says.planned
        self._report(lambda listener: planned(listener, performance, number, failed))

    def _make_motion(self) -> None:
        clock, requests = self._clock, self._requests
        start_s, others_s = clock.monotonic(), clock.process_time() - clock.thread_time()
        try:
            more = self._live.work(lambda: self._closed or self._paused or self._pending is not None)
        except PlayerFault as fault:
            # The other players' plans continue.
            self._fell(fault)
            return
        except Exception as fault:  # noqa: BLE001 - reported in the window's thread
            self._met = requests
            self._fell(fault)
            return
        now_s = clock.monotonic()
        others_s = clock.process_time() - clock.thread_time() - others_s
        if not more:
            self._met = requests
            self._judging = self._measuring = True
            if self._live.made - self._given_back >= GIVE_BACK_CHUNKS:
                self._given_back = self._live.made
                give_back()
        awaited = not self._live.is_seen
        self._report_broken(now_s, not more)
        if self._live.seen != self._reported_seen and (now_s - self._reported_seen_s >= REPORT_S or not awaited):
            self._reported_seen, self._reported_seen_s = self._live.seen, now_s
            self._report(self._says.moved)
        if now_s - self._reported_s >= REPORT_READY_S or not more:
            self._reported_s = now_s
            worked, ready = self._says.worked, self._live.ready_share
            self._report(lambda listener: worked(listener, ready))
        if self._playing:
            clock.sleep(REST_WHILE_PLAYING * (now_s - start_s))
        elif not awaited and others_s > OTHERS_S:
            self._rest(min(GIVE_WAY * (now_s - start_s), MOST_REST_S), requests)

    def _rest(self, rest_s: float, requests: int) -> None:
        """Wait at most ``rest_s`` seconds, and less if there is a new request after number ``requests``."""
        with self._changed:
            self._changed.wait_for(
                lambda: self._closed or self._pending is not None or self._requests != requests, timeout=rest_s
            )

    def _judge(self) -> None:
        start_s = self._clock.monotonic()
        try:
            self._judging = self._live.judge(lambda: not self._idle)
        except PlayerFault as fault:
            self._fell(fault)
            return
        except Exception as fault:  # noqa: BLE001 - reported in the window's thread
            self._judging = False
            self._fell(fault)
            return
        now_s = self._clock.monotonic()
        self._report_broken(now_s, not self._judging)
        with self._changed:
            if self._judging and self._idle:
                self._changed.wait(REST_WHILE_JUDGING * (now_s - start_s))

    def _measure_arms(self) -> None:
        """Measure the arms of a player once there has been no request for `QUIET_S`."""

        def awaited() -> bool:
            return not self._idle or self._paused or self._playing

        with self._changed:
            if self._changed.wait_for(awaited, timeout=QUIET_S):
                return
        try:
            self._measuring = self._live.measure_arms(awaited)
        except Exception as fault:  # noqa: BLE001 - reported in the window's thread
            self._fell(fault)
        self._report_broken(self._clock.monotonic(), True)

    def _report_broken(self, now_s: float, at_once: bool) -> None:
        broken = self._live.broken
        if broken is not self._reported_broken and (at_once or now_s - self._reported_broken_s >= REPORT_BROKEN_S):
            self._reported_broken, self._reported_broken_s = broken, now_s
            show_broken = self._says.broken
            self._report(lambda listener: show_broken(listener, broken))

    def _fell(self, fault: BaseException) -> None:
        fell = self._says.fell
        self._report(lambda listener: fell(listener, fault))
