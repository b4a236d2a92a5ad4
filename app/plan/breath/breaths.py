"""Breaths of a player.

Which rests are breathed in says `app.plan.breath.rests_for_breath`: by seconds, playing and air. How, says the length
of the rest in felt beats (T6 of the 2018 thesis; the thresholds are the player's): below last_beat the breath takes the
whole rest; in [last_beat, prepare) the last beat; from prepare on a preparatory motion comes in the beat before that.
Every breath ends at the onset it serves. Where no rest serves within the lungs' budget, and at clear ends of phrases
once some of the air is used, a catch breath is taken: in the short silence there, or out of the tail of the note
before, whose lips then leave early while its sound stays. In runs whose notes are too short for that the player leaves
out a note: its lips leave at once.

Messages: ``breath.first``, ``breath.rest_whole``, ``breath.last_beat``, ``breath.prepared``, ``breath.preparation``,
``breath.catch``, ``breath.catch_dropped``, ``breath.catch_dropped_two``, ``breath.phrase_end``, ``breath.after_hold``,
``breath.blown``, ``breath.blown_preparation``, ``breath.blown_short``, ``breath.written``, ``breath.catch_slurred``,
``breath.breaks_slur``.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

import msgspec
import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.errors import Argument, Message
from app.plan.breath.breath_depths import too_long, with_depths
from app.plan.breath.breaths_in_rests import (
    AIR_SHORT,
    WRITTEN,
    because,
    blown_breaths,
    blown_catch,
    rest_breaths,
    within_note,
)
from app.plan.breath.catch_breath_lengths import CATCH_MIN_S, Room, catch_lengths_s, drop_lengths_s
from app.plan.breath.catch_breath_places import AirSupply, catch_places
from app.plan.breath.lungs import (
    FULL_BREATH_S,
    air_used_s,
    drawn_share,
    levels,
    lungful_s,
    short_catches,
    with_circular_breathing,
)
from app.plan.breath.phrase_ends import ComparedLine
from app.plan.breath.rests_for_breath import ALWAYS_S, Decided, RestNeeds, breathed_in, rest_needs, why
from app.plan.breath.staggered_breaths import BreathConstraints, within_held
from app.plan.by_hand.corrected_events import removed_ids, without_removed
from app.plan.by_hand.corrections import BY_HAND, Correction, SetBreath
from app.plan.event_id import EventId
from app.plan.kinds import BEFORE_NOTES, BREATH_KINDS
from app.plan.model import BreathEvent, Problem, TimeFrame
from app.plan.music.breath_controller import BreathEnvelope, BreathGaps, gaps_within, silences
from app.plan.music.notation import at_score_tempo, heard_rests_s, notated, usual_release
from app.plan.music.piece import EPSILON, LineTimes, Piece, Seeds, gaps_s
from app.plan.music.rests import Rests, are_audible, rest_ticks
from app.plan.music.written_marks import WrittenMarks, unwritten
from app.plan.parameters import PlayerParameters
from app.score.model import Note
from instrument_maps.wind import Air


class BreathPlan(msgspec.Struct, frozen=True):
    """Breaths of a line, with what else follows from them.

    Attributes
    ----------
    generated_ids : frozenset of str
        Every event the rules made, removed ones among them.
    early_end_s : dict of int to float
        Notes (by index) whose lips leave early for a catch breath, and when.
    catches : tuple of int
        Notes (by index) before which a catch breath is taken; players of the same part avoid them.
    left_out : tuple of int
        Notes (by index) that are left out for catch breaths; players of the same rhythm leave out others.
    """

    events: tuple[BreathEvent, ...]
    problems: tuple[Problem, ...]
    generated_ids: frozenset[str]
    early_end_s: dict[int, float]
    catches: tuple[int, ...]
    left_out: tuple[int, ...] = ()


def plan_breaths(
    *,
    notes: tuple[Note, ...],
    times: LineTimes,
    piece: Piece,
    parameters: PlayerParameters,
    frame: TimeFrame,
    corrections: tuple[Correction, ...],
    shared: BreathConstraints,
    seeds: Seeds,
    air: Air | None,
    envelope: BreathEnvelope | None,
    written: WrittenMarks | None = None,
) -> BreathPlan:
    """Place every breath of a line.

    Parameters
    ----------
    air : Air or None
        How long a lungful lasts on the instrument, as its map says.
    shared : BreathConstraints
        Where others of a unison breathe.
    seeds : Seeds
        What distinguishes this player where places are equally good.
    envelope : BreathEnvelope or None
        The breath that was blown. Where it shows breaths, they are where it has gaps and nowhere else but at breath
        marks.
    written : WrittenMarks, optional
        Breath marks, at which a breath is always taken, and slurs, within which none is taken while there is air.
    """
    if not notes:
        return BreathPlan((), (), frozenset(), {}, ())
    written = written or unwritten(len(notes))
    line = _Breather(notes, times, piece, parameters, {note.id: index for index, note in enumerate(notes)}, written)
    score = _read(line, air, envelope)
    given = _given(line, score, frame, corrections, shared)
    rests = _rests_used(line, score, given)
    stock = _stock(line, score, given, rests.spare)
    catches = _catches(line, score, stock, given.may, shared, seeds)
    caught = _caught(line, score, stock, [index for index in catches if index not in rests.spare], shared.after_hold)
    in_rests = _in_rests(line, score, given, rests, catches)
    refill = stock.refill.copy()
    for event in (*caught, *in_rests):
        if event.draws_air and not event.is_within and refill[line.number_of(event)] == 0.0:
            refill[line.number_of(event)] = drawn_share(event.end_s - event.start_s)
    events = tuple(sorted([*in_rests, *given.by_hand, *caught], key=lambda event: (event.start_s, event.end_s)))
    early_end_s, cut = _cut_notes(line, events)
    slurs = _broken_slurs(line, caught, stock.room)
    return BreathPlan(
        events=with_depths(events, stock.used, score.lung_s, refill, line.index_of),
        problems=(*cut, *slurs, *too_long(notes, times, stock.used, score.lung_s, refill)),
        generated_ids=frozenset(event.id for event in (*given.generated, *caught)),
        early_end_s=early_end_s,
        catches=tuple(catches),
        left_out=stock.room.left_out(catches),
    )


class _Breather(NamedTuple):
    """A player with the notes of one breathing line; ``index_of`` is by their ids."""

    notes: tuple[Note, ...]
    times: LineTimes
    piece: Piece
    parameters: PlayerParameters
    index_of: dict[str, int]
    written: WrittenMarks

    @property
    def marked(self) -> list[int]:
        """The notes before which the score has a breath mark."""
        found: list[int] = (1 + np.flatnonzero(self.written.breath[:-1])).tolist()
        return found

    def number_of(self, event: BreathEvent) -> int:
        """The note that a breath is before, or within."""
        return self.index_of[EventId.parse(event.id).of]


class _Score(NamedTuple):
    """Breathing clues of a part.

    Attributes
    ----------
    written, steady : LineTimes
        As a score would have it, and that without short changes of tempo, by which is decided what is needed.
    sounded_s : (N,) float64
        How long each note sounds, at the tempo of the score.
    gaps : BreathGaps or None
        Where the breath that was blown shows breaths.
    used, steady_used : (N + 1,) float
        `app.plan.breath.lungs.air_used_s` of both.
    lung_s : float
        `app.plan.breath.lungs.lungful_s`.
    within : tuple of BreathEvent
        Breaths that were recorded within notes.
    """

    written: LineTimes
    steady: LineTimes
    rests: Rests
    sounded_s: FloatArray
    gaps: BreathGaps | None
    used: FloatArray
    steady_used: FloatArray
    lung_s: float
    within: tuple[BreathEvent, ...]


class _Given(NamedTuple):
    """The breaths that rests, silences and the animator give.

    Attributes
    ----------
    generated : tuple of BreathEvent
        What the rules made of rests, ...
    kept : tuple of BreathEvent
        ... less what was removed or set by hand.
    may : (N,) bool
        Before which notes the rules may make a breath.
    """

    generated: tuple[BreathEvent, ...]
    kept: tuple[BreathEvent, ...]
    by_hand: tuple[BreathEvent, ...]
    may: BoolArray


class _RestsUsed(NamedTuple):
    """Breaths in rests that are taken.

    Attributes
    ----------
    needs, decided : RestNeeds, Decided
        By note.
    spare : dict of int to BreathEvent
        The breaths in rests that are not needed, by their notes.
    """

    needs: RestNeeds
    decided: Decided
    spare: dict[int, BreathEvent]


class _Stock(NamedTuple):
    """The air there is without catch breaths, and what these could bring.

    Attributes
    ----------
    used, steady_used : (N + 1,) float
        As of `_Score`, less what breaths within notes and through the nose bring.
    refill : (N,) float
        Part of the lungs that the breath before each note fills.
    air_s : (N,) float
        How much air there is at each note.
    """

    used: FloatArray
    steady_used: FloatArray
    refill: FloatArray
    air_s: FloatArray
    room: Room


def _read(line: _Breather, air: Air | None, envelope: BreathEnvelope | None) -> _Score:
    times, piece = line.times, line.piece
    gaps = None if envelope is None or not envelope.has_breath_gaps(times) else silences(envelope, times)
    lung_s = lungful_s(line.parameters, air)
    if gaps is not None:
        assert envelope is not None
        used = air_used_s(times, air, envelope)
        within = tuple(within_note(line.notes[index], piece, *gap_s) for index, *gap_s in gaps_within(envelope, times))
        rests = _rests(times, times, times, piece)
        return _Score(times, times, rests, times.duration_s, gaps, used, used, lung_s, within)
    written = notated(times, piece)
    steady = at_score_tempo(written, piece)
    used = air_used_s(written, air)
    steady_used = used if steady is written else air_used_s(steady, air)
    played = steady if written is times else at_score_tempo(times, piece)
    sounded_s = np.maximum(steady.duration_s, played.duration_s)
    return _Score(written, steady, _rests(steady, played, times, piece), sounded_s, None, used, steady_used, lung_s, ())


def _rests(steady: LineTimes, played: LineTimes, times: LineTimes, piece: Piece) -> Rests:
    """The rests of the score, which decides what is one and how long it is.

    What is a rest by its seconds lasts at least as long as it is heard, wherever a score would have it.
    What is so long that it is always breathed in is so at any tempo.

    Parameters
    ----------
    steady, played : LineTimes
        As a score would have the line, and as it is played, both at the tempo of the score.
    """
    written = rest_ticks(steady, piece.beat_ticks_at(times.onset_tick))
    audible = are_audible(played, usual_release(played)) & (times.silence_tick > 0)
    written = np.where(audible, np.maximum(written, times.silence_tick), written)
    is_rest = (written > 0) & (times.silence_tick > 0)
    written_s, sounding_s = gaps_s(steady), gaps_s(times)
    lasts_s = np.where(audible, np.maximum(written_s, heard_rests_s(played)), written_s)
    lasts_s = np.where(sounding_s >= ALWAYS_S - EPSILON, np.maximum(lasts_s, sounding_s), lasts_s)
    return Rests(*(np.where(is_rest, column, 0) for column in (times.silence_tick, written, lasts_s)))


def _given(
    line: _Breather, score: _Score, frame: TimeFrame, corrections: tuple[Correction, ...], shared: BreathConstraints
) -> _Given:
    notes, times, piece, parameters = line.notes, line.times, line.piece, line.parameters
    if score.gaps is not None:
        generated = (*blown_breaths(notes, times, piece, parameters, frame, score.gaps), *score.within)
    else:
        generated = rest_breaths(notes, times, piece, parameters, frame, score.rests)
        if not parameters.circular_breathing:
            generated += within_held(notes, times, piece, score.used, score.lung_s, shared)
    placed = {item.about: item for item in corrections
              if isinstance(item, SetBreath) and item.note_id in line.index_of}  # fmt: skip
    by_hand = tuple(_by_hand(item, times, line.index_of[item.note_id], piece) for item in placed.values())
    removed, hand_ids = removed_ids(corrections), frozenset(event.id for event in by_hand)
    kept = [event for event in without_removed(generated, removed) if event.id not in hand_ids]
    if score.gaps is None:
        unused = {line.number_of(event) for event in kept if event.draws_air and not event.is_within
                  and _is_unused(line, score, event)}  # fmt: skip
        kept = [event for event in kept if event.is_within or line.number_of(event) not in unused]
    may = np.ones(len(notes), dtype=bool)
    ids = [id for id in map(EventId.parse, removed | hand_ids) if id.kind in BEFORE_NOTES and id.of in line.index_of]
    may[[line.index_of[id.of] for id in ids if BREATH_KINDS[id.kind].draws_air]] = False
    return _Given(generated, tuple(kept), by_hand, may)


def _is_unused(line: _Breather, score: _Score, event: BreathEvent) -> bool:
    """Return whether no breath is taken in a rest, unless as a catch breath: the rest is too short without a part of
    the note before, or it is under a slur."""
    index = line.number_of(event)
    is_marked = index > 0 and bool(line.written.breath[index - 1])
    if event.end_s - event.start_s < CATCH_MIN_S - EPSILON and (is_marked or line.parameters.breath_need > 0.0):
        return True
    is_slurred = index > 0 and bool(line.written.joined[index - 1])
    return is_slurred and not is_marked and float(score.rests.lasts_s[index]) < ALWAYS_S - EPSILON


def _stock(line: _Breather, score: _Score, given: _Given, spare: dict[int, BreathEvent]) -> _Stock:
    """The air there is."""
    times, lung_s = line.times, score.lung_s
    used, steady_used, refill = _taken(line, score, given, spare)
    length_s = catch_lengths_s(score.steady, times, score.rests.sounding_tick)
    for index, event in spare.items():
        length_s[index] = _lasts_s(score, line, event)
    if score.gaps is not None:
        length_s = np.where(score.gaps.played, score.gaps.length_s, length_s)
        drop_s, dropped = np.zeros(len(line.notes)), np.zeros(len(line.notes), np.int64)
    else:
        drop_s, dropped = drop_lengths_s(score.steady, times)
    if line.parameters.circular_breathing:
        used = with_circular_breathing(used, lung_s, refill)
        steady_used = with_circular_breathing(steady_used, lung_s, refill)
    air_s = levels(used, lung_s, refill) * lung_s
    room = Room(length_s, drop_s, dropped).with_marks(line.marked, times)
    return _Stock(used, steady_used, refill, air_s, room)


def _taken(
    line: _Breather, score: _Score, given: _Given, spare: Collection[int] = ()
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The air used, as it is played and at the tempo of the score, and the part of the lungs that the breath before
    each note fills; rests before notes of ``spare`` give none."""
    refill = np.zeros(len(line.notes))
    within: dict[int, list[_Within]] = {}
    for event in (*given.kept, *given.by_hand):
        index = line.number_of(event)
        share = max(0.0, drawn_share(_lasts_s(score, line, event)) * (event.depth if event.corrected else 1.0))
        if event.is_within:
            within.setdefault(index, []).append(_Within(event.start_s, event.end_s, share))
        elif event.draws_air and index not in spare:
            refill[index] = share
    if not within:
        return score.used, score.steady_used, refill
    spent = [np.diff(used) for used in (score.used, score.steady_used)]
    for index, breaths in within.items():
        _breathe_within(line, index, sorted(breaths), spent, refill, score.lung_s)
    used, steady_used = (np.concatenate(([0.0], np.cumsum(column))) for column in spent)
    return used, steady_used, refill


class _Within(NamedTuple):
    """A breath within a note, and the part of the lungs that it fills."""

    start_s: float
    end_s: float
    share: float


def _breathe_within(
    line: _Breather,
    index: int,
    breaths: list[_Within],
    spent: list[FloatArray],
    refill: FloatArray,
    lung_s: float,
) -> None:
    """Count breaths within a note, each its start and the part of the lungs it fills: lungs are counted from note to
    note, so what is held before the first of them is counted with the note before, as if they came before this one."""
    onset_s, end_s = float(line.times.onset_s[index]), float(line.times.played_end_s[index])
    first_s, last_s = max(breaths[0].start_s - onset_s, 0.0), max(end_s - breaths[-1].end_s, 0.0)
    held_s = end_s - breaths[0].start_s - sum(breath.end_s - breath.start_s for breath in breaths)
    brought_s = sum(breath.share for breath in breaths[1:]) * lung_s
    for column in spent:
        rate = float(column[index]) / max(end_s - onset_s, EPSILON)
        before_s = first_s * rate
        column[index] = max(last_s * rate, held_s * rate - brought_s)
        if index and refill[index] == 0.0:
            column[index - 1] += before_s
        else:
            column[index] = max(column[index], before_s)
    refill[index] = max(refill[index], min(breaths[0].share, 1.0))


def _lasts_s(score: _Score, line: _Breather, event: BreathEvent) -> float:
    """Return how long a breath is, as the score would have it where a rest gives it."""
    index, length_s = line.number_of(event), event.end_s - event.start_s
    if index == 0 or event.corrected or score.gaps is not None or event.is_within:
        return length_s
    rest_s = float(score.written.onset_s[index] - score.written.played_end_s[index - 1])
    return min(length_s, rest_s) if rest_s > 0.0 else length_s


def _rests_used(line: _Breather, score: _Score, given: _Given) -> _RestsUsed:
    """Decide which rests are breathed in: the first breath, those set by hand, written and blown always are."""
    _, steady_used, refill = _taken(line, score, given)
    needs = rest_needs(score.rests.lasts_s, line.parameters.breath_need, score.lung_s)
    certain = [*line.marked, *(line.number_of(event) for event in given.by_hand)]
    # No rest is needed for a breath within a note.
    within = [line.number_of(event) for event in given.kept if event.is_within]
    certain += [index for index in within if not score.rests.lasts_s[index]]
    for column in needs:
        column[[0, *certain]] = 0.0
    played_s = np.concatenate(([0.0], np.cumsum(score.sounded_s)))
    decided = breathed_in(steady_used, played_s, score.lung_s, refill, needs)
    if score.gaps is not None:
        return _RestsUsed(needs, decided, {})
    kept = [event for event in given.kept if event.draws_air and not event.is_within]
    spare = {line.number_of(event): event for event in kept if not decided.breathed[line.number_of(event)]}
    return _RestsUsed(needs, decided, spare)


def _in_rests(
    line: _Breather, score: _Score, given: _Given, rests: _RestsUsed, catches: list[int]
) -> list[BreathEvent]:
    """The breaths in rests that are taken, each with its preparation and its reason; catch breaths among them."""
    unused = rests.spare.keys() - set(catches)
    result = []
    for event in given.kept:
        index = line.number_of(event)
        if event.is_within or index == 0 or score.gaps is not None:
            result.append(event)
        elif index not in unused:
            if line.written.breath[index - 1]:
                reason = WRITTEN
            elif index in rests.spare:
                reason = AIR_SHORT
            else:
                reason = why(index, score.rests.lasts_s, rests.needs, rests.decided)
            if event.draws_air:
                event = msgspec.structs.replace(event, reason=because(event.reason, reason))
            result.append(event)
    return result


def _catches(
    line: _Breather, score: _Score, stock: _Stock, may: BoolArray, shared: BreathConstraints, seeds: Seeds
) -> list[int]:
    """The notes before which catch breaths are taken: decided at the tempo of the score, corrected where a change of
    tempo takes more air."""
    taken = np.zeros(len(line.notes), dtype=bool)
    taken[list(shared.caught)] = True
    missing = np.bincount(np.array(shared.left_out, np.int64), minlength=len(line.notes))

    def between(times: LineTimes, used: FloatArray, filled: FloatArray, free_s: float) -> list[int]:
        compared = ComparedLine(times, line.piece, score.rests.sounding_tick, line.written, taken, seeds)
        return catch_places(compared, AirSupply(used, score.lung_s, filled, free_s), may, missing, stock.room)

    # All breathe where it is written and after what they held together, and no one just before that.
    after_hold = sorted(shared.after_hold) if score.gaps is None else []
    first = {*line.marked, *(index for index in after_hold if not line.written.joined[index - 1])}
    first = {index for index in first if may[index] and stock.refill[index] == 0.0 and stock.room.length_s[index] > 0.0}
    given = stock.refill.copy()
    at = sorted(first)
    given[at] = np.minimum(stock.room.lasts_s[at] / FULL_BREATH_S, 1.0)
    may = may.copy()
    may[[index - 1 for index in after_hold]] = False
    # Who breathes in every rest, as the thesis has it, or only when empty, needs no breath for a phrase's end.
    free_s = (line.parameters.breath_need or 1.0) * score.lung_s
    catches = between(score.steady, stock.steady_used, given, free_s)
    if score.steady is score.written:
        return stock.room.apart(sorted({*first, *catches}))
    filled = given.copy()
    filled[catches] = np.minimum(stock.room.lasts_s[catches] / FULL_BREATH_S, 1.0)
    again = short_catches(stock.used, score.lung_s, given, filled)
    filled[again] = given[again]
    more = between(score.written, stock.used, filled, np.inf)
    return stock.room.apart(sorted({*first, *catches} - {*again.tolist()} | {*more}))


def _caught(
    line: _Breather, score: _Score, stock: _Stock, catches: list[int], after_hold: Collection[int]
) -> list[BreathEvent]:
    """The catch breaths before some notes, but for those in rests that would have given one."""
    found: dict[int, BreathEvent] = {}
    if score.gaps is not None:
        blown = [index for index in catches if score.gaps.played[index] and not line.written.breath[index - 1]]
        found = {index: blown_catch(line.notes[index], line.piece, score.gaps, index) for index in blown}
    found |= _made(line, stock, score.lung_s, [index for index in catches if index not in found], after_hold)
    return [found[index] for index in catches]


def _cut_notes(line: _Breather, events: tuple[BreathEvent, ...]) -> tuple[dict[int, float], list[Problem]]:
    """The notes whose lips leave early for a breath, and when; what is to be said where a hand set it so."""
    times = line.times
    early_end_s: dict[int, float] = {}
    problems = []
    for event in events:
        index = line.number_of(event)
        before = index - 1
        if not event.draws_air or before < 0 or event.start_s >= times.played_end_s[before]:
            continue
        if event.corrected:
            note_id = line.notes[before].id
            message = Message("breath.inside_note", {"note": note_id})
            problems.append(Problem(message, note_id, event.start_s, event.end_s))
        while before >= 0 and event.start_s < times.played_end_s[before]:
            early_end_s[before] = max(event.start_s, float(times.onset_s[before]))
            before -= 1
    return early_end_s, problems


def _broken_slurs(line: _Breather, caught: list[BreathEvent], room: Room) -> list[Problem]:
    """Return what is to be said of catch breaths under slurs, unless they are written too."""
    problems = []
    for event in caught:
        index = line.number_of(event)
        first = index - 1 - (int(room.dropped[index]) if room.length_s[index] == 0.0 else 0)
        if line.written.joined[[first, index - 1]].any() and not line.written.breath[index - 1]:
            note_id = line.notes[index - 1].id
            message = Message("breath.breaks_slur", {"note": note_id})
            problems.append(Problem(message, note_id, event.start_s, event.end_s))
    return problems


def _needed_s(stock: _Stock, lung_s: float, first: IntArray, last: IntArray) -> tuple[FloatArray, FloatArray]:
    """Air that stretches of notes take, and that there is for them: as it is played, or at the tempo of the score
    where they are short of air only there."""
    played_s, steady_s = (used[last] - used[first] for used in (stock.used, stock.steady_used))
    full_s = levels(stock.steady_used, lung_s, stock.refill)[first] * lung_s
    is_short = played_s > stock.air_s[first]
    return np.where(is_short, played_s, steady_s), np.where(is_short, stock.air_s[first], full_s)


def _not_for_air(stock: _Stock, lung_s: float, catches: list[int]) -> set[int]:
    """The notes among these before which the air would last until the next breath."""
    share = stock.refill.copy()
    share[catches] = np.minimum(stock.room.lasts_s[catches] / FULL_BREATH_S, 1.0)
    breaths = np.flatnonzero(share > 0.0)
    used_s = np.append(stock.steady_used[breaths], stock.steady_used[-1])
    found: set[int] = set()
    made, air_s, before_s = set(catches), (0.0 if share[0] else 0.5 * lung_s), 0.0
    rows = zip(breaths.tolist(), share[breaths].tolist(), used_s[:-1].tolist(), used_s[1:].tolist(), strict=True)
    for index, more, here_s, next_s in rows:
        if index in made and air_s >= next_s - before_s - EPSILON:
            found.add(index)
        else:
            air_s = min(max(air_s - (here_s - before_s), 0.0) + more * lung_s, lung_s)
            before_s = here_s
    return found


def _made(
    line: _Breather, stock: _Stock, lung_s: float, catches: list[int], after_hold: Collection[int]
) -> dict[int, BreathEvent]:
    """Catch breaths out of the notes before, by the notes that they come before."""
    if not catches:
        return {}
    notes, times, room = line.notes, line.times, stock.room
    phrase_ends = _not_for_air(stock, lung_s, catches)
    at = np.array(catches)
    onset_s, start_s = times.onset_s[at], times.onset_s[at] - room.lasts_s[at]
    breaths = np.flatnonzero(stock.refill > 0.0)
    place = np.searchsorted(breaths, at)
    first, last = np.insert(breaths, 0, 0)[place], np.append(breaths, len(notes))[place]
    rows = zip(
        catches,
        np.where(room.length_s[at] > 0.0, 0, room.dropped[at]).tolist(),
        np.round(line.piece.clock.ticks(start_s)).astype(np.int64).tolist(),
        times.onset_tick[at].tolist(),
        start_s.tolist(),
        onset_s.tolist(),
        np.maximum(times.played_end_s[at - 1] - start_s, 0.0).tolist(),
        (times.played_end_s[last - 1] - times.onset_s[first]).tolist(),
        *(seconds.tolist() for seconds in _needed_s(stock, lung_s, first, last)),
        strict=True,
    )
    found = {}
    for index, dropped, start_tick, end_tick, begins_s, ends_s, from_note_s, phrase_s, air_s, full_s in rows:
        why: dict[str, Argument] = {
            "phrase_s": round(phrase_s, 2),
            "air_s": round(air_s, 2),
            "lung_s": round(full_s, 2),
        }
        after = notes[index - 1].id
        short: dict[str, Argument] = {"after_note": after, "from_note_ms": round(from_note_s * 1000.0)}
        if line.written.breath[index - 1]:
            reason = Message("breath.written", short)
        elif index in after_hold and not dropped:
            reason = Message("breath.after_hold", {"after_note": after})
        elif dropped > 1:
            first_note = notes[index - dropped].id
            reason = Message("breath.catch_dropped_two", {"first_note": first_note, "after_note": after, **why})
        elif dropped:
            reason = Message("breath.catch_dropped", {"after_note": after, **why})
        elif index in phrase_ends:
            reason = Message("breath.phrase_end", short)
        else:
            is_slurred = line.written.joined[index - 1]
            reason = Message("breath.catch_slurred" if is_slurred else "breath.catch", {**short, **why})
        found[index] = BreathEvent(
            id=f"breath:{notes[index].id}",
            kind="breath",
            start_tick=start_tick,
            end_tick=end_tick,
            start_s=begins_s,
            end_s=ends_s,
            depth=1.0,
            reason=reason,
        )
    return found


def _by_hand(item: SetBreath, times: LineTimes, index: int, piece: Piece) -> BreathEvent:
    onset_tick = int(times.onset_tick[index])
    start_tick, end_tick = onset_tick + item.start_offset_tick, onset_tick + item.end_offset_tick
    return BreathEvent(
        id=item.about,
        kind=BREATH_KINDS[item.kind].event_kind,
        start_tick=start_tick,
        end_tick=end_tick,
        start_s=piece.clock.seconds(float(start_tick)),
        end_s=piece.clock.seconds(float(end_tick)),
        depth=item.depth,
        reason=BY_HAND,
        corrected=True,
    )
