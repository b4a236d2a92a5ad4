"""Generates the plans of an ensemble: the time frame, the leader and the cues, then every player, by pure functions."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Mapping
from copy import copy
from operator import attrgetter
from typing import Final

import msgspec

from app.errors import StopRequested, raise_if_stopped
from app.plan.breath.staggered_breaths import Breathed, SharedLine, breathed_of, shared_line
from app.plan.by_hand.corrected_events import sound_corrections
from app.plan.by_hand.corrections import Correction, RemoveEvent, SetBreath, SetCue, of_kinds
from app.plan.by_hand.mark_corrections import mark_corrections
from app.plan.cues.cues import plan_cues
from app.plan.cues.entries import entries
from app.plan.faces.glances import StagePlace
from app.plan.gestures.gestures import mean_pitch
from app.plan.gestures.sways import pulse
from app.plan.model import CONDUCTOR, PlayerPlan, Problem, TimeFrame
from app.plan.music.ending import ending_of
from app.plan.music.felt_bars import lowest, with_felt_bars
from app.plan.music.fermatas import fermatas
from app.plan.music.one_note_at_a_time import one_at_a_time
from app.plan.music.piece import LineTimes, MonophonicPart, NoteTimes, Piece, note_times
from app.plan.music.written_marks import written_marks
from app.plan.parameters import PlayerParameters, parameters_deciding
from app.plan.player import AMONG_OTHERS, PLAYER
from app.score.model import Note
from app.score.tempo import TempoMap
from app.steps import StepResults, StepRuns, StepTable, reading
from instrument_maps.model import InstrumentMap
from metadata.gestures import Gesture
from metadata.library import bundled_gestures, bundled_rules
from metadata.load import load_expressions
from metadata.model import Expression
from metadata.rules import Rule

__all__ = ["EnsemblePlanning", "MonophonicPart", "Piece", "frame_around"]

PREROLL_BEATS = 4.0
PREROLL_LEAST_S = 2.0
COME_UP_S = 3.0
"""Least seconds of a new piece before its first note, in which players are at rest and raise their instruments."""
MOST_PREROLL_BEATS = 32
START_BEATS = 2.0
"""Beats for the start: the preparatory beat, and a pickup's missing part of the beat before."""
AFTER_LAST_S = 6.0
"""Seconds after the last note for holding still, lowering the instrument, looking up and bowing."""


def frame_around(
    first_tick: int,
    last_tick: int,
    clock: TempoMap,
    preroll_beats: float = PREROLL_BEATS,
    beat_ticks: int | None = None,
) -> TimeFrame:
    """Return the span of a performance that sounds from one tick to another: from a pre-roll (a number of beats, at
    least `PREROLL_LEAST_S`) before the first to `AFTER_LAST_S` after the last tick. Times before the first tick are
    negative.

    Parameters
    ----------
    beat_ticks : int or None
        The felt beat; None is a quarter.
    """
    beat = beat_ticks or clock.ticks_per_quarter
    first_s = clock.seconds(float(first_tick))
    # The start is computed with the first tempo, regardless of the tempo before it.
    given_s = min(preroll_beats, START_BEATS) * (clock.seconds(float(first_tick + beat)) - first_s)
    preroll_s = clock.seconds(first_tick - preroll_beats * beat)
    start_s = min(preroll_s, first_s - PREROLL_LEAST_S)
    if first_s - start_s < given_s - 1e-6:
        start_s = first_s - given_s
    return TimeFrame(start_s, clock.seconds(float(last_tick)) + AFTER_LAST_S)


def usual_preroll(beat_s: float) -> float:
    """Number of felt beats before the first note of a new piece: four, or as many as the players need to raise their
    instruments.
    """
    return max(PREROLL_BEATS, float(min(math.ceil(COME_UP_S / beat_s - 1e-6), MOST_PREROLL_BEATS)))


class EnsemblePlanning:
    """Plans the players of an ensemble one after another, in any order, with the same result.

    For the players before a requested one only their breaths are computed.

    Parameters
    ----------
    frame : TimeFrame
        The time frame, from `frame_around` or longer.
    expressions, rules, gestures : optional
        Expressions, rules and gestures available to the plan; the bundled ones by default.
    places : mapping of str to StagePlace, optional
        Place of each player, and of the conductor under `CONDUCTOR`; a player without a place looks at no other.
    runs : StepRuns, optional
        Cache of earlier results; unchanged results are returned as the same objects.
    stop_requested : callable
        Called between two players.

    Raises
    ------
    Cancelled
        ``stop_requested`` returned True.
    """

    def __init__(
        self,
        piece: Piece,
        parts: tuple[MonophonicPart, ...],
        frame: TimeFrame,
        seed: int = 0,
        *,
        expressions: Mapping[str, Expression] | None = None,
        rules: tuple[Rule, ...] | None = None,
        gestures: Mapping[str, Gesture] | None = None,
        places: Mapping[str, StagePlace] | None = None,
        runs: StepRuns | None = None,
        stop_requested: StopRequested = lambda: False,
    ) -> None:
        self._runs = StepRuns() if runs is None else runs
        everyone: dict[str, object] = {"piece": piece, "frame": frame, "seed": seed, "stage": places or {}}
        everyone |= {
            "faces": load_expressions() if expressions is None else expressions,
            "rules": bundled_rules() if rules is None else rules,
            "known_gestures": bundled_gestures() if gestures is None else gestures,
        }
        playable: dict[str, StepResults] = {}
        for part in parts:
            raise_if_stopped(stop_requested)
            playable[part.player_id] = self._runs.begin(LINE, part.player_id, **everyone, **_fields(part))
        shared = _shared_by_all(parts, playable, everyone, self._runs)
        everyone |= {name: shared[name] for name in ("fermatas", "cue_events", "cue_ids", "pulse", "last_s")}
        everyone |= {"piece": shared["piece_felt"], "piece_ending": shared["ending"]}
        self._everyone = everyone
        self._musicians: tuple[str, ...] = shared["musicians"]
        self._playable, self._plans = playable, dict[str, PlayerPlan]()
        self._together = _shared_lines(playable, everyone, self._runs)
        self._usual_pitches = [results.of(mean_pitch) for results in playable.values()]
        self.player_ids = tuple(part.player_id for part in parts)
        self._parts, self._stop_requested, self._clock = parts, stop_requested, piece.clock
        self._breathed: list[Breathed] = []
        self._begun = dict[str, StepResults]()

    def plan(self, player_id: str) -> PlayerPlan:
        """Return a player's plan, computed on the first call. Raises Cancelled."""
        if player_id not in self._plans:
            number = self.player_ids.index(player_id)
            while len(self._breathed) < number:
                raise_if_stopped(self._stop_requested)
                self._breathed.append(self._player(len(self._breathed)).of(breathed_of))
            raise_if_stopped(self._stop_requested)
            self._plans[player_id] = self._player(number).of(PlayerPlan)
        return self._plans[player_id]

    def excerpt(self, first_s: float, end_s: float) -> EnsemblePlanning:
        """Create the planning of a shorter span for the same players: only notes that begin in the span are planned,
        with the cues there. Facts about the whole piece (felt bars, fermatas, the ending, the players' usual pitches)
        are kept.
        """
        clock, other = self._clock, copy(self)
        cues = self._everyone["cue_events"]
        assert isinstance(cues, tuple)
        near = tuple(cue for cue in cues if first_s <= cue.start_s and cue.end_s <= end_s)
        other._everyone = everyone = {**self._everyone, "cue_events": near}
        span = clock.ticks(first_s), clock.ticks(end_s)
        other._parts = tuple(_within(part, *span) for part in self._parts)
        other._runs, other._breathed, other._plans, other._begun = StepRuns(), [], {}, {}
        other._playable = {
            part.player_id: other._runs.begin(LINE, part.player_id, **everyone, **_fields(part))
            for part in other._parts
        }
        other._together = _shared_lines(other._playable, everyone, other._runs)
        return other

    def finished(self) -> dict[str, PlayerPlan]:
        """Plan the remaining players, and return the plans of all. Raises Cancelled."""
        return {player_id: self.plan(player_id) for player_id in self.player_ids}

    def _player(self, number: int) -> StepResults:
        """Create the planning steps of the player with this index, after planning the breaths of all
        players before it.
        """
        part = self._parts[number]
        player_id, results = part.player_id, self._playable[part.player_id]
        if player_id in self._begun:
            return self._begun[player_id]
        others = (*self._together[:number], *self._together[number + 1 :])
        neighbours = {"shared_line": self._together[number], "others": others}
        own = {**self._everyone, **neighbours, "breathed": tuple(self._breathed[:number])}
        own |= {"times": results.of(note_times), "player_id": player_id}
        among = self._runs.begin(AMONG_OTHERS, player_id, **own)
        begun = self._begun[player_id] = self._runs.begin(
            PLAYER,
            player_id,
            **own | _fields(part) | {"notes": results["played_notes"], "corrections": results["sound_corrections"]},
            **{name: among[name] for name in AMONG_OTHERS.functions},
            usual_pitch=self._usual_pitches[number],
            reported=results["reported"],
            written=results.of(written_marks),
            alone=self._musicians.count(part.musician or player_id) == 1,
        )
        return begun


def _shared_by_all(
    parts: tuple[MonophonicPart, ...],
    playable: Mapping[str, StepResults],
    everyone: Mapping[str, object],
    runs: StepRuns,
) -> StepResults:
    """Create the planning steps that involve all players at once, such as cues."""
    stage = everyone["stage"]
    assert isinstance(stage, Mapping)
    return runs.begin(
        ENSEMBLE,
        **everyone,
        all_times=tuple(results.of(note_times) for results in playable.values()),
        leading=tuple(results.of(_leading) for results in playable.values()),
        musicians=tuple(part.musician or part.player_id for part in parts),
        conducted=CONDUCTOR in stage,
    )


def _shared_lines(
    playable: Mapping[str, StepResults], everyone: Mapping[str, object], runs: StepRuns
) -> list[SharedLine]:
    """Return a summary of each player's part, used to find players who play the same notes or rhythm."""
    return [
        runs.begin(SHARED_LINE, player_id, **everyone, times=results.of(note_times)).of(shared_line)
        for player_id, results in playable.items()
    ]


def _within(part: MonophonicPart, first_tick: float, end_tick: float) -> MonophonicPart:
    """Return the part with only those notes that begin in a span."""
    onset = attrgetter("onset_tick")
    kept = slice(bisect_left(part.notes, first_tick, key=onset), bisect_left(part.notes, end_tick, key=onset))
    loudness, levels = part.loudness[kept], part.levels[kept]
    return msgspec.structs.replace(part, notes=part.notes[kept], loudness=loudness, levels=levels)


def _fields(part: MonophonicPart) -> dict[str, object]:
    """Return the fields of a part by name, with its map as ``instrument``."""
    given = msgspec.structs.asdict(part)
    return {**given, "instrument": given.pop("instrument_map")}


def _bare(
    player_id: str,
    notes: tuple[Note, ...],
    instrument: InstrumentMap,
    loudness: tuple[float, ...],
    levels: tuple[float, ...],
) -> MonophonicPart:
    return MonophonicPart(player_id, notes, instrument, loudness=loudness, levels=levels)


def _leading(
    player_id: str,
    played_notes: tuple[Note, ...],
    instrument: InstrumentMap,
    parameters: PlayerParameters,
    sound_corrections: tuple[Correction, ...],
    musician: str,
) -> MonophonicPart:
    """Return a player's part with only those fields that affect the planning of cues."""
    corrections = of_kinds(sound_corrections, (SetCue, RemoveEvent, SetBreath))
    return MonophonicPart(
        player_id, played_notes, instrument, parameters_deciding(parameters, "cues"), corrections, musician=musician
    )


def _reported(unsound: tuple[Problem, ...], apart: tuple[Problem, ...]) -> tuple[Problem, ...]:
    return unsound + apart


def _rhythms(all_times: tuple[LineTimes, ...]) -> tuple[NoteTimes, ...]:
    return tuple(times.rhythm for times in all_times)


def _first_s(all_times: tuple[LineTimes, ...]) -> float:
    """Return the onset of the first note of all players."""
    return min((float(times.onset_s[0]) for times in all_times if len(times.onset_s)), default=0.0)


def _last_s(all_times: tuple[LineTimes, ...]) -> float:
    """Return the end of the last note of all players."""
    return max((float(times.played_end_s.max()) for times in all_times if len(times.onset_s)), default=0.0)


LINE: Final = StepTable(
    clock="piece.clock",
    first_frame_s="frame.first_frame_s",
    sounding=reading(sound_corrections, expressions="faces", at_s="first_frame_s"),
    sound_corrections="sounding.events",
    unsound="sounding.problems",
    bare=_bare,
    single=reading(one_at_a_time, part="bare"),
    played_notes="single.part.notes",
    played_loudness="single.part.loudness",
    played_levels="single.part.levels",
    apart="single.problems",
    quarter="clock.ticks_per_quarter",
    mark_corrections=mark_corrections,
    written=reading(written_marks, notes="played_notes", ticks_per_quarter="quarter", corrections="mark_corrections"),
    times=reading(
        note_times, notes="played_notes", loudness="played_loudness", written="written", levels="played_levels"
    ),
    usual_pitch=mean_pitch,
    reported=_reported,
    leading=_leading,
)
"""Steps that compute the playable part of a line, its times, and reports about the rest."""
SHARED_LINE: Final = StepTable(shared_line=shared_line)
"""Steps that compute a line's facts for others in unison with it, with the piece's felt beats."""
ENSEMBLE: Final = StepTable(
    rhythms=_rhythms,
    low=reading(lowest, lines="all_times"),
    piece_felt=reading(with_felt_bars, lines="rhythms"),
    entries=reading(entries, all_times="rhythms", piece="piece_felt", held="fermatas", musicians="musicians"),
    fermatas=reading(fermatas, all_times="rhythms", piece="piece_felt"),
    cues=reading(plan_cues, found="entries", parts="leading", piece="piece_felt", conducted="conducted"),
    cue_events="cues.events",
    cue_ids="cues.ids",
    first_s=_first_s,
    pulse=reading(pulse, piece="piece_felt", swing_at_s="first_s"),
    ending=reading(ending_of, piece="piece_felt"),
    last_s=_last_s,
)
"""Steps that concern all players, from the piece and every line's times."""
