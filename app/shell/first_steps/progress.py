"""Progress of the tour of first steps, as an immutable value that changes by the user's actions and the
tour's buttons.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Final

from app.plan.by_hand.corrections import PinFingering, SetBreath
from app.plan.model import PlayerPlan
from app.project.model import Project


@dataclass(frozen=True)
class TourFacts:
    """Facts about the editor's state by which completed tasks are recognised.

    Attributes
    ----------
    is_playing : bool
        Whether the piece is being played.
    fingerings : frozenset of (str, PinFingering)
        Fingerings that the user pinned, each with its player's id.
    breaths : frozenset of (str, int)
        Player id and start tick of each breath that the user placed by hand.
    breath_ticks : frozenset of (str, int)
        Player id and start tick of each breath in all plans.
    amplitudes : mapping of str to float
        Amplitude of each player's motion, by player id.
    is_exporting : bool
        True if the export dialog is open.
    """

    is_playing: bool = False
    fingerings: frozenset[tuple[str, PinFingering]] = frozenset()
    breaths: frozenset[tuple[str, int]] = frozenset()
    breath_ticks: frozenset[tuple[str, int]] = frozenset()
    amplitudes: Mapping[str, float] = field(default_factory=dict)
    is_exporting: bool = False


def facts_of(project: Project, plans: Mapping[str, PlayerPlan], is_playing: bool, is_exporting: bool) -> TourFacts:
    """Return the facts about a project and its newest plans by which the tour recognises completed tasks."""
    made = [(player, each) for player in project.players for each in project.corrections.get(player.id, ())]
    return TourFacts(
        is_playing,
        frozenset((player.id, each) for player, each in made if isinstance(each, PinFingering)),
        frozenset(
            (player.id, note.onset_tick + each.start_offset_tick)
            for player, each in made
            if isinstance(each, SetBreath) and not each.added
            for note in project.part(player).notes
            if note.id == each.note_id
        ),
        frozenset((player_id, breath.start_tick) for player_id, plan in plans.items() for breath in plan.breaths),
        {player.id: player.parameters.amplitude for player in project.players},
        is_exporting,
    )


def _has_moved_breath(then: TourFacts, now: TourFacts) -> bool:
    # A breath that was only made deeper begins at the same tick as before.
    return bool(now.breaths - then.breaths - then.breath_ticks)


def _has_other_amplitude(then: TourFacts, now: TourFacts) -> bool:
    return any(now.amplitudes.get(id, amplitude) != amplitude for id, amplitude in then.amplitudes.items())


STOPS: Final[Mapping[str, Callable[[TourFacts, TourFacts], bool]]] = {
    "play": lambda then, now: now.is_playing,
    "fingering": lambda then, now: bool(now.fingerings - then.fingerings),
    "breath": _has_moved_breath,
    "amplitude": _has_other_amplitude,
    "export": lambda then, now: now.is_exporting,
}
"""The stops in order, each with a function of the facts at arrival and the present facts that is true if the task is
done.
"""
_NAMES: Final = tuple(STOPS)


@dataclass(frozen=True)
class TourProgress:
    """Current stop of the tour and the tasks done so far.

    Attributes
    ----------
    arrival : TourFacts
        Facts about the editor when this stop began, with which later facts are compared.
    number : int
        Index of the stop from 0; the number of stops after the tour has ended.
    done : frozenset of str
        Names of the stops whose task was done, even if it was undone later.
    """

    arrival: TourFacts
    number: int = 0
    done: frozenset[str] = frozenset()

    @property
    def stop(self) -> str:
        """Return the name of the stop, empty after the tour has ended."""
        return _NAMES[self.number] if self.number < len(_NAMES) else ""

    @property
    def is_done(self) -> bool:
        """True if the task of this stop is done."""
        return self.stop in self.done

    @property
    def is_last(self) -> bool:
        """True at the last stop."""
        return self.number == len(_NAMES) - 1

    def observe(self, now: TourFacts) -> TourProgress:
        """Return the progress with the task of this stop marked as done, if the facts ``now`` show that it is."""
        if not self.stop or self.is_done:
            return self
        if STOPS[self.stop](self.arrival, now):
            return replace(self, done=self.done | {self.stop})
        if now.breaths == self.arrival.breaths and now.breath_ticks != self.arrival.breath_ticks:
            # Plans may arrive later, and be made again for other reasons than an edited breath.
            return replace(self, arrival=replace(self.arrival, breath_ticks=now.breath_ticks))
        return self

    def next(self, now: TourFacts) -> TourProgress:
        """Return the progress at the next stop, or after the last one, whether or not the task is done.

        ``now`` are the facts with which the stop begins.
        """
        return TourProgress(now, min(self.number + 1, len(_NAMES)), self.done)

    def back(self, now: TourFacts) -> TourProgress:
        """Return the progress at the previous stop, which begins with the facts ``now``."""
        return TourProgress(now, max(self.number - 1, 0), self.done)
