"""Updates plans and motion after every edit, in the background, the newest edit first."""

from __future__ import annotations

import weakref
from collections.abc import Mapping
from threading import Event
from time import monotonic, sleep

from PySide6.QtCore import QObject, QTimer, Signal

from app.editor.plan_worker import PlanWorker, Reports
from app.editor.session import Session, Severity
from app.editor.tasks import Tasks
from app.editor.window_thread_calls import Reporter
from app.errors import AppError, Message, Progress, StopRequested, raise_if_stopped
from app.motion.perform import PerformanceCurves
from app.performance.cast import Performer
from app.performance.ensemble import Performance
from app.performance.excerpt import PerformanceExcerpt, is_worth_it
from app.performance.live import LiveMotion
from app.plan.model import Problem, TimeFrame
from app.project.model import Project
from app.project.undoable_document import Change
from app.rig.characters.character_library import character_library
from instrument_maps.library import library
from metadata.library import metadata_library

AT_ONCE_NOTES = 2500
"""Number of notes up to which a change is planned immediately, within two screen refreshes; see `AT_ONCE_S`."""
AT_ONCE_S = 0.1
"""Processor time in seconds above which later changes are planned in the background, as for many players or unusual
music.
"""
REPORTED_NOTES = 6000
"""Number of notes from which planning shows its progress and can be stopped."""
MOST_WAIT_S = 30.0
"""Longest wait in seconds for the motion of all players around the playhead before the rest of the piece is planned."""
LOOK_S = 0.01


def _goes_on() -> bool:
    return False


def _arm_problems(
    performer: Performer, curves: PerformanceCurves, frame: TimeFrame, stop_requested: StopRequested
) -> tuple[Problem, ...]:
    from app.export.arm_problems import performer_arm_problems  # not needed until the window is at rest

    return performer_arm_problems(performer, curves, frame, stop_requested)


class Generator(QObject):
    """Plans the performance of a session's project and computes its motion after each edit, until `close`.

    Parameters
    ----------
    tasks : Tasks
        Runner of slow planning tasks.

    Signals
    -------
    motion_changed()
        Poses were added or changed.
    front_changed()
        The active player's pose was updated after an edit; emitted before panels update to the new plans, which takes
        longer.
    ready_changed(float)
        Share 0..1 of the motion that is computed.
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
        self._opened = True
        """True until all plans of an opened piece are made ..."""
        self._coming: Performance | None = None
        """... and what is being planned meanwhile, once players in front have plans."""
        self._around: Performance | None = None
        """The performance that an excerpt was planned of."""
        self._holding: frozenset[tuple[str, str]] = frozenset()
        """Characters and instruments whose holds are being found ..."""
        self._hold_stopped: StopRequested = _goes_on
        """... and whether the user has stopped that."""
        self._ready = -1.0
        self.live = LiveMotion(session.performance, arm_problems=_arm_problems)
        """The motion of all players: the viewport draws `LiveMotion.pose`."""
        reports = Reports(
            Generator._planned, Generator._moved, Generator._worked, Generator._show_broken, Generator._fell
        )
        self._report = Reporter(self, lambda generator: generator._end.alive)
        self._worker = PlanWorker(self.live, self._report, reports)
        self._end = weakref.finalize(self, self._worker.close)
        session.changed.connect(self._project_changed)
        session.performance_changed.connect(self._show)
        session.instruments_changed.connect(self._plan_again)
        session.characters_changed.connect(self._plan_again)
        session.choreographies_changed.connect(self._plan_again)
        session.metadata_changed.connect(self._plan_again)
        session.playhead_changed.connect(self._request_poses)
        session.players_changed.connect(self._show_front)
        session.playing_changed.connect(self._worker.set_playing)
        self._request_poses()
        self._worker.start()

    @property
    def up_to_date(self) -> bool:
        """Return whether the session's plans belong to its project and to the current instruments, characters and
        metadata.
        """
        performance = self._session.performance
        now = performance.library is library() and performance.characters is character_library()
        now = now and performance.metadata.is_still(metadata_library())
        return performance.project is self._session.project and now

    @property
    def ready_share(self) -> float:
        """Return the computed share of the motion, 0..1."""
        return self.live.ready_share

    def close(self) -> None:
        """End the worker thread."""
        self._end()

    def _project_changed(self, change: Change) -> None:
        if change.opened:
            self._shown = self._asked
            self._long = False
            self._opened = True
            self._worker.drop()
        self._plan(change.after)

    def _plan_again(self) -> None:
        self._plan(self._session.project)

    def _plan(self, project: Project) -> None:
        if self._long:
            # The current plan is finished first: if edits come faster than plans, intermediate results are shown.
            return
        # Threads of Python slow each other down, so the worker pauses until the window has drawn the edit.
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
                # Runs also if planning the player in front failed.
                self._session.set_performance(performance)

    def _make_now(self, performance: Performance) -> None:
        """Compute the active player's pose at the playhead before the next picture is drawn, so that it shows the edit.

        Does nothing during a drag, or if the players or the library of figures have changed.
        """
        before, done = self._session.performance, self._session.document.done
        same_figures = performance.project.players is before.project.players and performance.library is before.library
        if same_figures and not (done and done[-1].gesture is not None):
            self.live.show(performance)
            for player_id in self._session.players[:1]:
                self.live.make_now(player_id, self._session.playhead_s)
            self.front_changed.emit()

    def _hold_reported(self, performance: Performance) -> None:
        """Compute in the background the hand grips of players for whom they are missing, while other players are shown
        already.

        If the user cancels this, the next edit starts it again.
        """
        requested = frozenset((player.character_id, player.instrument_id) for player in performance.unheld)
        if requested <= self._holding and not self._hold_stopped():
            return
        self._holding, self._hold_stopped = requested, _goes_on

        def work(progress: Progress, stop_requested: StopRequested) -> None:
            self._hold_stopped = stop_requested
            performance.hold(stop_requested, progress)

        def ended() -> None:
            # Also reached if the work was stopped because other players were requested; their work continues.
            if self._holding is requested:
                self._holding = frozenset()

        name = Message("work.hold", {"players": len(performance.unheld)})
        self._tasks.run(name, work, lambda _: self._plan_again(), key="hold", ended=ended)

    def _plan_reported(self, performance: Performance) -> None:
        number, session = self._asked, self._session
        self._long = True

        def work(progress: Progress, stop_requested: StopRequested) -> Performance:
            def stopped() -> bool:
                return stop_requested() or self._shown >= number

            def planned(player_ids: tuple[str, ...]) -> None:
                if not set(player_ids).isdisjoint(session.players):
                    self._report(lambda generator: generator._first_planned(performance, number))
                if self._opened and self._around is not performance and is_worth_it(performance):
                    self._around = performance
                    self._move_everyone(performance, number, stopped)

            try:
                performance.prepare(stopped, progress, lambda: session.players, planned)
            finally:
                # Also reached if the user stopped the work, in which case no player was reported.
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

    def _move_everyone(self, performance: Performance, number: int, stopped: StopRequested) -> None:
        """Plan all players in a short excerpt around the playhead, and wait until their motion in it is computed.

        Called on the planning thread when a piece is opened.

        Parameters
        ----------
        number : int
            Number of the planning request; older requests show nothing.
        """
        excerpt = PerformanceExcerpt(performance, self._session.playhead_s)
        excerpt.prepare(stopped)
        shown = Event()

        def show(generator: Generator) -> None:
            if number > generator._shown and generator._opened:
                generator.live.show_excerpt(performance, excerpt)
                generator._request_poses()
            shown.set()

        self._report(show)
        end_s = monotonic() + MOST_WAIT_S
        while not (shown.is_set() and self.live.is_moving) and monotonic() < end_s:
            raise_if_stopped(stopped)
            sleep(LOOK_S)

    def _first_planned(self, performance: Performance, number: int) -> None:
        if number > self._shown and self._opened:
            self._coming = performance
            self._show_front()

    def _show_front(self) -> None:
        """Show the selected players of an opened piece while the others are still being planned."""
        coming = self._coming
        if coming is not None:
            musicians = [coming.project.player(one) for one in self._session.players if coming.is_planned(one)]
            played = [player.id for one in musicians for player in coming.project.played_by(one)]
            self.live.show_first(coming, played)
        self._request_poses()

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
        self._opened, self._coming, self._around = False, None, None
        self.live.show(self._session.performance)
        self.live.request(self._session.playhead_s, player_ids=self._session.players)
        # Resumes after the panels have shown the plans, since threads of Python slow each other down.
        QTimer.singleShot(0, self, self._worker.wake)
        self.motion_changed.emit()

    def _request_poses(self, *_: object) -> None:
        self.live.request(self._session.playhead_s, player_ids=self._session.players)
        self._worker.wake()

    def _worked(self, ready: float) -> None:
        if ready != self._ready:
            self._ready = ready
            self.ready_changed.emit(ready)

    def _moved(self) -> None:
        self.motion_changed.emit()

    def _show_broken(self, broken: Mapping[str, tuple[Problem, ...]]) -> None:
        self._session.set_broken(broken)

    def _fell(self, fault: BaseException) -> None:
        """Raise again an unexpected exception of the worker thread, so that it is reported like one in the window."""
        raise fault
