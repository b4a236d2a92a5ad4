"""Excerpt of a long piece shown first: players are planned from the notes around the playhead before the whole piece is
planned.

Plans depend on other notes only within a phrase, a breath or a rest. Planned from about a minute of notes, players move
nearly as they will in the full plan, after a fraction of the time; the full plans then replace these.
"""

from __future__ import annotations

from collections.abc import Callable
from threading import RLock
from typing import Final

from app.errors import StopRequested, raise_if_stopped
from app.performance.ensemble import Performance
from app.plan.model import PlayerPlan, Problem, no_events
from app.project.performers import Player
from app.steps import StepRuns

BEFORE_S: Final = 24.0
AFTER_S: Final = 36.0
"""Seconds before and after a moment whose notes are planned."""
SURE_S: Final = 16.0
"""Seconds near the first and the last of these notes in which nothing is displayed, since players begin and
end there.
"""
WORTH: Final = 4
"""Least length of a piece relative to an excerpt for the excerpt to save time."""


class PerformanceExcerpt(Performance):
    """Plans of players around a moment, shown while the whole performance is being planned.

    Excludes dancers and players with a choreography.

    Parameters
    ----------
    whole : Performance
        The whole performance, whose planning has begun: shared results are taken from it.
    around_s : float
        Time in seconds around which notes are planned.
    """

    def __init__(self, whole: Performance, around_s: float) -> None:
        # Shares the project, instruments, characters, metadata and all steps done so far.
        vars(self).update(vars(whole))
        self._planning, self._before, self._runs, self.begun = RLock(), None, StepRuns(), None
        self.unseen, self._plans, self._problems = {}, {}, {}
        frame = whole.time_frame
        first_s, end_s = max(around_s - BEFORE_S, frame.first_frame_s), min(around_s + AFTER_S, frame.end_s)
        assert whole.begun is not None
        self._around = whole.begun.excerpt(first_s, end_s)
        begins, ends = first_s > frame.first_frame_s, end_s < frame.end_s
        self.shown_s: Final = (first_s + SURE_S * begins, end_s - SURE_S * ends)
        """Span whose motion may be shown, seconds."""

    def prepare(self, stop_requested: StopRequested = lambda: False, *_: Callable[..., object]) -> None:
        """Plan the players that the excerpt includes. Raises Cancelled if stopped."""
        for musician in self.project.bodies:
            raise_if_stopped(stop_requested)
            with self._lock:
                self._plan_musician(self._around, self.project.played_by(musician), stop_requested)

    @property
    def shown_players(self) -> tuple[Player, ...]:
        """Return the players that the excerpt shows: those without a choreography, which would take seconds to
        generate.
        """
        danced = {one.doubles or one.id for one in self.project.players if one.parameters.choreography}
        return tuple(one for one in self.project.players if (one.doubles or one.id) not in danced)

    def plan(self, player: Player) -> PlayerPlan:
        """Return the plan of one player, or an empty one if it is not made yet; never waits."""
        known = self._plans.get(player.id)
        return no_events(player.id, self.time_frame) if known is None else known

    def _problems_of(self, player: Player, plan: PlayerPlan) -> tuple[Problem, ...]:
        # Reported for the whole performance.
        return ()


def is_worth_it(whole: Performance) -> bool:
    """Return whether a performance is so long that an excerpt saves much time."""
    span_s = whole.time_frame.end_s - whole.time_frame.first_frame_s
    return span_s >= WORTH * (BEFORE_S + AFTER_S)
