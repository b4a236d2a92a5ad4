"""Plans of all players of a project, computed once from a snapshot and shared."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from threading import RLock
from typing import Final

from app.contacts.breaks import by_time
from app.errors import AppError, Cancelled, MapError, Message, Progress, StopRequested, raise_if_stopped
from app.performance import hats
from app.performance.acting_problems import unfit_choreography, unknown_acting
from app.performance.bodies import hold_now, is_held, suited_to
from app.performance.body_problems import body_problems
from app.performance.ensemble_steps import HELD, LINE, PLAYED, WHOLE, all_expressions, with_parts, work_of
from app.performance.loudness import note_marks, unaccented
from app.plan.acting import with_style
from app.plan.by_hand.mark_corrections import corrected_marks
from app.plan.doubling import InstrumentChange, changes, first_played
from app.plan.faces.glances import StagePlace
from app.plan.generate import EnsemblePlanning, MonophonicPart, Piece, frame_around
from app.plan.model import CONDUCTOR, PlayerPlan, Problem, TimeFrame, no_events
from app.plan.music.dynamics_from_velocities import VelocityReading, read_velocities
from app.plan.music.written_dynamics import written_dynamics
from app.plan.parameters import PlayerParameters
from app.project.model import Project
from app.project.performers import Player
from app.rig.characters.character_library import character_library
from app.score.limits import too_long
from app.steps import StepResults, StepRuns
from instrument_maps.library import library
from instrument_maps.map_table import Posture
from instrument_maps.model import InstrumentMap
from metadata.library import MetadataLibrary, metadata_library
from metadata.model import Expression

EYES_M: Final[Mapping[Posture, float]] = {"standing": 1.58, "seated": 1.22}
CONDUCTOR_EYES_M: Final = 1.8
"""Approximate height in metres of the eyes of a conductor on a podium."""

_PLAYED_BY_LINE: Final = (*PLAYED.functions, "corrections", "name")
"""Results and values of `PLAYED` that `LINE` may read."""
_CHECKED: Final = {""}
"""Choreographies that were already read once, which takes a second."""


class Performance:
    """A project with the plans of its players.

    A player without instrument map or with a missing character stays in the ensemble: the plan has a problem and,
    without a map, no events.

    Instruments, characters, styles, habits and expressions are those available at its creation.

    Parameters
    ----------
    project : Project
        The immutable project.
    before : Performance, optional
        The performance before an edit, whose unchanged results are reused as the same objects. The result does not
        depend on it.
    waiting : frozenset of str
        Players not shown yet, because another task is still computing their grips (`hold`).

    Raises
    ------
    AppError
        The piece is too long to be processed; damaged files can claim months.
    """

    def __init__(
        self, project: Project, before: Performance | None = None, waiting: frozenset[str] = frozenset()
    ) -> None:
        long = too_long(project.score)
        if long is not None:
            raise AppError("piece.too_long", **long)
        self.project = project
        self.waiting = waiting
        self.library = library()
        self.characters = character_library()
        self.metadata: MetadataLibrary = metadata_library()
        self.unseen = dict[str, Message]()
        """By player id, once there are plans: why players cannot be seen, streamed or exported."""
        # A performance without any plans may have been made from one that has some.
        self._before: Performance | None = before if before is None or before.planned else before._before
        self._lock = RLock()
        """Held while a step is done."""
        self._planning = RLock()
        """Held until all plans are made."""
        self._plans = dict[str, PlayerPlan]()
        """By player id, as far as they are made."""
        self._problems = dict[str, tuple[Problem, ...]]()
        self.begun: EnsemblePlanning | None = None
        """Planning that is under way."""
        self.planned: bool = False
        """True if the plans are made already: asking for them then costs nothing."""
        self._runs: StepRuns = StepRuns(None if self._before is None else self._before._runs)
        self._players: dict[str, StepResults] = {player.id: self._begun(player) for player in project.players}
        self._whole: StepResults = self._runs.begin(
            WHOLE,
            clock=project.score.tempo_map,
            metre_map=project.metre_map,
            accompaniment=project.score.accompaniment,
            velocities=tuple(results.of(unaccented) for results in self._players.values()),
            installed=self.metadata.expressions_by_name,
            own=project.expressions,
        )

    def _begun(self, player: Player) -> StepResults:
        return self._runs.begin(
            PLAYED,
            player.id,
            part=self.project.part(player),
            own_parameters=player.parameters,
            name=player.name,
            musician_id=self.project.musician(player).id,
            corrections=self.project.corrections.get(player.id, ()),
            section_intensity=self.project.section_intensity,
            styles=self.metadata.styles.items,
            habits=self.metadata.habits.items,
        )

    @cached_property
    def piece(self) -> Piece:
        """Tempo, metres and other data of the piece that all players share."""
        with self._lock:
            return self._whole.of(Piece)

    @cached_property
    def parts(self) -> tuple[MonophonicPart, ...]:
        """Parts of the players with an instrument, in project order."""
        with self._lock:
            parts = []
            for player in self.project.players:
                try:
                    instrument = self.instrument(player)
                except MapError:
                    continue
                parts.append(self._line(player, instrument))
            return tuple(parts)

    @cached_property
    def velocity_reading(self) -> VelocityReading:
        """Interpretation of the velocities of all parts together."""
        with self._lock:
            return self._whole.of(read_velocities)

    def marks(self, player: Player) -> dict[str, str]:
        """The dynamic in force at each of a player's notes, by note id."""
        part = self.project.part(player)
        marks = corrected_marks(part.marks, self.project.corrections.get(player.id, ()))
        written = written_dynamics(marks, part.source, self.piece.clock.ticks_per_quarter)
        found = note_marks(part, self.velocity_reading, written)
        return {note.id: mark for note, mark in zip(part.notes, found, strict=True)}

    def _line(self, player: Player, instrument: InstrumentMap) -> MonophonicPart:
        played = self._players[player.id]
        begun = self._runs.begin(
            LINE,
            player.id,
            player_id=player.id,
            instrument=instrument,
            part=self.project.part(player),
            velocity_reading=self.velocity_reading,
            musician=player.doubles,
            **{name: played[name] for name in _PLAYED_BY_LINE},
        )
        return begun.of(MonophonicPart)

    def parameters(self, player: Player) -> PlayerParameters:
        """Effective parameters of a player: the player's own, adjusted by style and habits."""
        with self._lock:
            return self._players[player.id].of(with_style)

    @cached_property
    def span_ticks(self) -> tuple[int, int]:
        """Onset of the first note and end of the last note that is played or danced to."""
        players = [self.project.player(part.player_id) for part in self.parts]
        played = [part for part in map(self.project.part, players) if part.notes]
        first_ticks = [part.notes[0].onset_tick for part in played]
        last_ticks = [part.end_tick for part in played]
        if self.project.dancers:
            # Dancers move to percussion too.
            first_ticks += [hit.tick for hit in self.project.score.percussion[:1]]
            last_ticks.append(self.project.score.sounding_end_tick)
        return min(first_ticks, default=0), max(last_ticks, default=0)

    @cached_property
    def time_frame(self) -> TimeFrame:
        """The time span of the performance from pre-roll to end, the same for all players."""
        first_tick, last_tick = self.span_ticks
        beat_ticks = self.project.metre_map.felt_ticks_at(first_tick)
        frame = frame_around(first_tick, last_tick, self.piece.clock, self.project.preroll_beats, beat_ticks)
        return frame if self._before is None or self._before.time_frame != frame else self._before.time_frame

    @cached_property
    def places(self) -> dict[str, StagePlace]:
        """Positions on stage of the players and of the conductor, if there is one, by id."""
        found = {}
        for player in self.project.players:
            stage, eyes_m = player.stage, EYES_M[player.parameters.posture]
            found[player.id] = StagePlace(stage.x_m, stage.z_m, stage.turn_rad, eyes_m)
        conductor = self.project.conducting
        if conductor is not None:
            found[CONDUCTOR] = StagePlace(conductor.x_m, conductor.z_m, math.pi, CONDUCTOR_EYES_M)
        return found if self._before is None or self._before.places != found else self._before.places

    def prepare(
        self,
        stop_requested: StopRequested = lambda: False,
        progress: Progress = lambda share: None,
        first: Callable[[], Sequence[str]] = tuple,
        planned: Callable[[tuple[str, ...]], None] = lambda player_ids: None,
    ) -> None:
        """Make all plans not made yet; other threads may use finished ones meanwhile.

        Parameters
        ----------
        stop_requested, progress : callable
            Called between musicians; ``progress`` with the share done, 0..1.
        first : callable
            Called between musicians: returns ids of players to plan next. The order does not affect results.
        planned : callable
            Called with the ids of a musician's players whose `plan` and `problems` are final.

        Raises
        ------
        Cancelled
            ``stop_requested`` returned True; the next call starts again.
        """
        with self._planning:
            if self.planned:
                return
            with self._lock:
                self.begun = planning = self._begin_planning(stop_requested)
            left = {musician.id: self.project.played_by(musician) for musician in self.project.bodies}
            musicians = {player.id: musician for musician, played in left.items() for player in played}
            count = len(left)
            while left:
                asked = (musicians.get(player_id) for player_id in first())
                played = left.pop(next((one for one in asked if one in left), next(iter(left))))
                with self._lock:
                    self._plan_musician(planning, played, stop_requested)
                progress(1.0 - len(left) / count)
                planned(tuple(player.id for player in played))
            with self._lock:
                self._end_planning()

    def _begin_planning(self, stop_requested: StopRequested) -> EnsemblePlanning:
        self.unseen, self._plans, self._problems = {}, {}, {}
        return EnsemblePlanning(
            self.piece,
            self.parts,
            self.time_frame,
            self.project.seed,
            expressions=self.expressions,
            rules=self.metadata.all_rules,
            gestures=self.metadata.gestures.items,
            places=self.places,
            runs=self._runs,
            stop_requested=stop_requested,
        )

    def _plan_musician(
        self, planning: EnsemblePlanning, played: tuple[Player, ...], stop_requested: StopRequested
    ) -> None:
        """Plan all instruments of one musician, including the changes between them, and find their problems."""
        made = {player.id: planning.plan(player.id) for player in played if player.id in planning.player_ids}
        turns = (first_played(made), changes(made)) if len(made) > 1 else None
        for player in played:
            # Finding out what hands reach takes as long as planning if there are many players.
            raise_if_stopped(stop_requested)
            plan = self._in_hands(player, made, turns)
            self._problems[player.id] = self._problems_of(player, plan)
            self._plans[player.id] = plan

    def _end_planning(self) -> None:
        self._plans = {player.id: self._plans[player.id] for player in self.project.players}
        _CHECKED.update(player.parameters.choreography for player in self.project.players)
        self._runs.close()
        self.planned, self.begun, self._before = True, None, None

    def prepare_within(self, cpu_s: float) -> bool:
        """Make all plans if that is estimated to take less than ``cpu_s``; returns whether they are made.

        Parameters
        ----------
        cpu_s : float
            Limit of the thread's own processor time. If a choreography must be loaded first, or a hat compared with an
            instrument, no plan is made.
        """
        players = self.project.players
        if any(one.parameters.choreography not in _CHECKED or not self._is_hat_known(one) for one in players):
            return False
        end_s = time.thread_time() + cpu_s
        try:
            self.prepare(lambda: time.thread_time() > end_s)
        except Cancelled:
            return False
        return True

    def _is_hat_known(self, player: Player) -> bool:
        instrument = self.library.maps.get(player.instrument_id)
        return instrument is None or not is_held(player, instrument) or hats.is_known(player)

    def _in_hands(
        self,
        player: Player,
        made: Mapping[str, PlayerPlan],
        turns: tuple[str, tuple[InstrumentChange, ...]] | None,
    ) -> PlayerPlan:
        """Return a player's plan, empty for a player without an instrument. For a musician with several instruments,
        events while this one is put aside are removed; ``made`` are the plans of all the musician's players, ``turns``
        the instrument changes.
        """
        plan = made.get(player.id)
        if plan is None:
            return no_events(player.id, self.time_frame)
        if turns is None:
            return plan
        first, found = turns
        held = self._runs.begin(
            HELD,
            player.id,
            plan=plan,
            first=first,
            found=found,
            names={one: self.project.player(one).name for one in made},
        )
        return held.of(with_parts)

    def _problems_of(self, player: Player, plan: PlayerPlan) -> tuple[Problem, ...]:
        """Problems of a player's plan, of missing files of the player, and of notes out of reach."""
        lacking, unreached = self.lacking(player), tuple[Problem, ...]()
        if lacking:
            self.unseen[player.id] = lacking[0]
        else:
            instrument, waiting = self.instrument(player), player.id in self.waiting
            found = body_problems(player, instrument, plan.fingerings, waiting, self._runs)
            lacking, unreached = found.lacking + unfit_choreography(player, self.time_frame), found.unreached
            if found.unseen is not None:
                self.unseen[player.id] = found.unseen
        lacking += unknown_acting(player, self.metadata)
        frame = self.time_frame
        reported = tuple(Problem(message, None, frame.first_frame_s, frame.end_s) for message in lacking) + unreached
        return by_time(reported + plan.problems) if reported else plan.problems

    @cached_property
    def plans(self) -> dict[str, PlayerPlan]:
        """The plans of all players by id, made on first use."""
        self.prepare()
        return self._plans

    def problems(self, player_id: str) -> tuple[Problem, ...]:
        """Problems of a player that are known before its motion is computed, by time: those of the plan, of instrument
        and character, and notes out of reach. Empty for dancers.
        """
        if player_id not in self._plans:
            self.prepare()
        return self._problems.get(player_id, ())

    @cached_property
    def expressions(self) -> dict[str, Expression]:
        """All expressions by name; the project's override the user's, and those override bundled ones."""
        with self._lock:
            return self._whole.of(all_expressions)

    @property
    def unplanned_notes(self) -> int:
        """Estimate the number of notes still to be planned; players unaffected by an edit count nothing, and edits that
        move no breath or cue count little.
        """
        if self.planned:
            return 0
        before = self._before
        if before is None or self.piece is not before.piece or self.time_frame != before.time_frame:
            return sum(len(part.notes) for part in self.parts)
        same_rules = self.metadata.all_rules is before.metadata.all_rules
        if self.project.seed != before.project.seed or self.expressions is not before.expressions or not same_rules:
            return sum(len(part.notes) for part in self.parts)
        known = {part.player_id: part for part in before.parts}
        return sum(work_of(part, known.get(part.player_id)) for part in self.parts)

    def is_planned(self, player_id: str) -> bool:
        """Return whether the plan of a player has been made."""
        return player_id in self._plans

    def plan(self, player: Player) -> PlayerPlan:
        """Return the plan of a player, made on first use."""
        known = self._plans.get(player.id)
        return self.plans[player.id] if known is None else known

    def instrument(self, player: Player) -> InstrumentMap:
        """Return the instrument map of a player. Raises MapError if it does not exist; `lacking` has the reason."""
        instrument = self.library.maps.get(player.instrument_id)
        if instrument is None:
            message = self._no_instrument(player)
            raise MapError(message.id, **message.arguments)
        return instrument

    def lacking(self, player: Player) -> tuple[Message, ...]:
        """Return messages about the instrument or character of a player that is missing or damaged."""
        found = []
        if player.instrument_id not in self.library.maps:
            found.append(self._no_instrument(player))
        if player.character_id not in self.characters.sources:
            problems = {path.stem: reported[0] for path, reported in self.characters.problems.items()}
            missing = Message("project.character_missing", {"player": player.name, "id": player.character_id})
            found.append(problems.get(player.character_id, missing))
        return tuple(found)

    def _no_instrument(self, player: Player) -> Message:
        for path, problems in self.library.problems.items():
            if path.stem == player.instrument_id:
                return problems[0]
        return Message("project.instrument_missing", {"player": player.name, "id": player.instrument_id})

    @property
    def unheld(self) -> tuple[Player, ...]:
        """Players whose grip of the instrument has not been computed yet, which takes seconds each."""
        found = []
        for player in self.project.players:
            instrument = self.library.maps.get(player.instrument_id)
            if instrument is not None and not is_held(player, instrument):
                found.append(player)
        return tuple(found)

    def hold(
        self,
        stop_requested: StopRequested = lambda: False,
        progress: Progress = lambda share: None,
        players: Iterable[Player] | None = None,
    ) -> None:
        """Compute the missing grips of players on their instruments.

        Parameters
        ----------
        stop_requested, progress : callable
            Called often; ``progress`` with the share done, 0..1.
        players : iterable of Player, optional
            Players to include; all by default.

        Raises
        ------
        Cancelled
            ``stop_requested`` returned True; finished grips are kept.
        """
        chosen = None if players is None else {player.id for player in players}
        unheld = [player for player in self.unheld if chosen is None or player.id in chosen]

        for number, player in enumerate(unheld):

            def reported(share: float, before: int = number) -> None:
                raise_if_stopped(stop_requested)
                progress((before + share) / len(unheld))

            reported(0.0)
            hold_now(player, self.instrument(player), reported)

    def held(self, player: Player) -> InstrumentMap:
        """Return the instrument map fitted to the player's body in size and contacts. Raises AppError if the instrument
        or the character is missing or damaged.
        """
        return suited_to(player, self.instrument(player)).instrument


def changes_of(performance: Performance, played: Sequence[Player]) -> tuple[str, tuple[InstrumentChange, ...]]:
    """Return the instrument changes of a musician who plays several instruments, and before them the id of the player
    whose instrument is in hand first.
    """
    plans = {player.id: performance.plan(player) for player in played}
    return first_played(plans), changes(plans)
