"""Computation of the events without a player's corrections, which the inspector shows next to the corrected ones."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QObject, Signal

from app.editor.session import Session
from app.errors import AppError, Message, Progress, StopRequested
from app.performance.ensemble import Performance
from app.plan.model import PlayerPlan
from app.project.model import Project

AT_ONCE_NOTES = 3000
"""Number of notes up to which a change is planned immediately, since that is not noticeable; see `AT_ONCE_S`."""
AT_ONCE_S = 0.1
"""Processor time in seconds above which plans are no longer made immediately."""


class Generated(QObject):
    """Computes plans of single players without their manual changes.

    Signals
    -------
    changed()
        A requested plan is available.
    """

    changed = Signal()

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self._player_id: str | None = None
        self._of: Performance | None = None
        self._plan: PlayerPlan | None = None
        self._bare: Performance | None = None
        self._underway: tuple[Performance, str] | None = None

    def plan(self, player_id: str) -> PlayerPlan | None:
        """Return a player's plan without corrections; None while it is computed (see `changed`)."""
        performance = self._session.performance
        if not performance.planned or player_id not in performance.plans:
            return None
        if not performance.project.corrections.get(player_id):
            return performance.plans[player_id]
        if self._of is performance and self._player_id == player_id:
            return self._plan
        if self._underway != (performance, player_id):
            self._make(performance, player_id)
        return self._plan if self._of is performance and self._player_id == player_id else None

    def _make(self, performance: Performance, player_id: str) -> None:
        # Most edits do not affect the values without corrections, so the previous ones are reused.
        before = self._bare if self._bare is not None and self._player_id == player_id else performance
        bare = Performance(_without_corrections(performance.project, player_id), before, performance.waiting)
        if bare.unplanned_notes <= AT_ONCE_NOTES:
            try:
                made = bare.prepare_within(AT_ONCE_S)
            except AppError:
                return
            if made:
                self._keep(performance, player_id, bare)
                return
        self._underway = (performance, player_id)

        def work(progress: Progress, stop_requested: StopRequested) -> Performance:
            bare.prepare(stop_requested, progress)
            return bare

        def done(made: Performance) -> None:
            self._underway = None
            self._keep(performance, player_id, made)
            self.changed.emit()

        name = performance.project.player(player_id).name
        self._session.tasks.run(Message("work.compare", {"player": name}), work, done, key="compare")

    def _keep(self, performance: Performance, player_id: str, bare: Performance) -> None:
        self._of, self._player_id, self._bare = performance, player_id, bare
        self._plan = bare.plans[player_id]


def _without_corrections(project: Project, player_id: str) -> Project:
    return replace(project, corrections={id: items for id, items in project.corrections.items() if id != player_id})
