"""Plans the breaths of a player.

`app.plan.breath.rests_for_breath` chooses the rests to breathe in by their length in seconds, the playing before, and
the air left. The length of the rest in felt beats decides the kind of breath (T6 of the 2018 thesis; the thresholds are
player parameters): below last_beat the breath takes the whole rest; in [last_beat, prepare) the last beat; from prepare
on a preparatory motion is added in the beat before. Every breath ends at the onset that follows it. If no rest comes
before the air runs out, and at clear phrase ends once some air is used, a catch breath is taken in a short silence or
out of the tail of the previous note, whose lips then leave early while its sound goes on. If running notes are too
short for that, the player leaves out a note.
"""

from __future__ import annotations

from typing import NamedTuple

import msgspec
import numpy as np

from app.errors import Message
from app.plan.breath.air_by_note import GivenBreaths, air_stock, air_taken
from app.plan.breath.breath_depths import too_long, with_depths
from app.plan.breath.breaths_in_rests import AIR_SHORT, WRITTEN, WRITTEN_BY_HAND, because, blown_breaths, rest_breaths
from app.plan.breath.catch_breath_lengths import CATCH_MIN_S
from app.plan.breath.catch_breaths import broken_slurs, catch_breath_notes, catch_breaths, hasty_at_marks
from app.plan.breath.lungs import drawn_share
from app.plan.breath.rests_for_breath import ALWAYS_S, Decided, RestNeeds, breathed_in, rest_needs, why
from app.plan.breath.score_for_breath import Breather, BreathScore, read_score
from app.plan.breath.staggered_breaths import BreathConstraints, within_held
from app.plan.by_hand.corrected_events import removed_ids, without_removed
from app.plan.by_hand.corrections import BY_HAND, Correction, SetBreath
from app.plan.event_id import EventId
from app.plan.kinds import BEFORE_NOTES, BREATH_KINDS
from app.plan.model import BreathEvent, Problem, TimeFrame
from app.plan.music.breath_controller import BreathEnvelope
from app.plan.music.piece import EPSILON, LineTimes, Piece, Seeds
from app.plan.music.written_marks import WrittenMarks, unwritten
from app.plan.parameters import PlayerParameters
from app.score.model import Note
from instrument_maps.wind import Air


class BreathPlan(msgspec.Struct, frozen=True):
    """Breaths of a part, and the notes they shorten or replace.

    Attributes
    ----------
    generated_ids : frozenset of str
        Ids of all events that the rules made, including removed ones.
    early_end_s : dict of int to float
        By note index: time at which the lips leave early for a catch breath.
    catches : tuple of int
        Indices of notes with a catch breath before them; other players of the same part avoid these places.
    left_out : tuple of int
        Indices of notes left out for catch breaths; other players of the same rhythm leave out different ones.
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
    """Place every breath of a part.

    Parameters
    ----------
    air : Air or None
        Air use of the instrument, from its map.
    shared : BreathConstraints
        Places where other players in unison breathe.
    seeds : Seeds
        Random choice between equally good places, different for each player.
    envelope : BreathEnvelope or None
        The recorded breath. If it shows breaths, they are placed in its gaps and at breath marks only.
    written : WrittenMarks, optional
        Breath marks, where a breath is always taken, and slurs, within which none is taken while there is air.
    """
    if not notes:
        return BreathPlan((), (), frozenset(), {}, ())
    written = written or unwritten(len(notes))
    line = Breather(notes, times, piece, parameters, {note.id: index for index, note in enumerate(notes)}, written)
    score = read_score(line, air, envelope)
    given = _given(line, score, frame, corrections, shared)
    rests = _rests_used(line, score, given)
    stock = air_stock(line, score, given, rests.spare)
    catches = catch_breath_notes(line, score, stock, given.may, shared, seeds)
    made = [index for index in catches if index not in rests.spare]
    caught = catch_breaths(line, score, stock, made, shared.after_hold)
    in_rests = _in_rests(line, score, given, rests, catches)
    refill = stock.refill.copy()
    for event in (*caught, *in_rests):
        if event.draws_air and not event.is_within and refill[line.number_of(event)] == 0.0:
            refill[line.number_of(event)] = drawn_share(event.end_s - event.start_s)
    events = tuple(sorted([*in_rests, *given.by_hand, *caught], key=lambda event: (event.start_s, event.end_s)))
    early_end_s, cut = _cut_notes(line, events)
    said = (*broken_slurs(line, caught, stock.room, score.rests.sounding_tick), *hasty_at_marks(line, caught))
    return BreathPlan(
        events=with_depths(events, stock.used, score.lung_s, refill, line.index_of),
        problems=(*cut, *said, *too_long(notes, times, stock.used, score.lung_s, refill)),
        generated_ids=frozenset(event.id for event in (*given.generated, *caught)),
        early_end_s=early_end_s,
        catches=tuple(catches),
        left_out=stock.room.left_out(catches),
    )


class _RestsUsed(NamedTuple):
    """Rests that are used for breathing.

    Attributes
    ----------
    needs, decided : RestNeeds, Decided
        Conditions and decisions for each note.
    spare : dict of int to BreathEvent
        Breaths in rests that are not needed, by note index.
    """

    needs: RestNeeds
    decided: Decided
    spare: dict[int, BreathEvent]


def _given(
    breather: Breather,
    score: BreathScore,
    frame: TimeFrame,
    corrections: tuple[Correction, ...],
    shared: BreathConstraints,
) -> GivenBreaths:
    notes, times, piece, parameters = breather.notes, breather.times, breather.piece, breather.parameters
    if score.gaps is not None:
        generated = (*blown_breaths(notes, times, piece, parameters, frame, score.gaps), *score.within)
    else:
        generated = rest_breaths(notes, times, piece, parameters, frame, score.rests)
        if not parameters.circular_breathing:
            generated += within_held(notes, times, piece, score.used, score.lung_s, shared)
    placed = {item.about: item for item in corrections
              if isinstance(item, SetBreath) and item.note_id in breather.index_of}  # fmt: skip
    by_hand = tuple(_by_hand(item, times, breather.index_of[item.note_id], piece) for item in placed.values())
    removed, hand_ids = removed_ids(corrections), frozenset(event.id for event in by_hand)
    kept = [event for event in without_removed(generated, removed) if event.id not in hand_ids]
    if score.gaps is None:
        unused = {breather.number_of(event) for event in kept if event.draws_air and not event.is_within
                  and _is_unused(breather, score, event)}  # fmt: skip
        kept = [event for event in kept if event.is_within or breather.number_of(event) not in unused]
    may = np.ones(len(notes), dtype=bool)
    ids = [
        id for id in map(EventId.parse, removed | hand_ids) if id.kind in BEFORE_NOTES and id.of in breather.index_of
    ]
    may[[breather.index_of[id.of] for id in ids if BREATH_KINDS[id.kind].draws_air]] = False
    return GivenBreaths(generated, tuple(kept), by_hand, may)


def _is_unused(breather: Breather, score: BreathScore, event: BreathEvent) -> bool:
    """Return whether nothing but a catch breath can be taken in the rest of a breath event: the rest is too short
    without shortening the previous note, or under a slur.
    """
    index = breather.number_of(event)
    is_marked = index > 0 and bool(breather.written.breath[index - 1])
    if event.end_s - event.start_s < CATCH_MIN_S - EPSILON and (is_marked or breather.parameters.breath_need > 0.0):
        return True
    is_slurred = index > 0 and bool(breather.written.joined[index - 1])
    return is_slurred and not is_marked and float(score.rests.lasts_s[index]) < ALWAYS_S - EPSILON


def _rests_used(breather: Breather, score: BreathScore, given: GivenBreaths) -> _RestsUsed:
    """Choose the rests to breathe in; the first breath and breaths set by hand, written or recorded are always used."""
    _, steady_used, refill = air_taken(breather, score, given)
    needs = rest_needs(score.rests.lasts_s, breather.parameters.breath_need, score.lung_s)
    certain = [*breather.marked, *(breather.number_of(event) for event in given.by_hand)]
    # A breath within a note needs no rest.
    within = [breather.number_of(event) for event in given.kept if event.is_within]
    certain += [index for index in within if not score.rests.lasts_s[index]]
    for column in needs:
        column[[0, *certain]] = 0.0
    played_s = np.concatenate(([0.0], np.cumsum(score.sounded_s)))
    decided = breathed_in(steady_used, played_s, score.lung_s, refill, needs)
    if score.gaps is not None:
        return _RestsUsed(needs, decided, {})
    kept = [event for event in given.kept if event.draws_air and not event.is_within]
    spare = {breather.number_of(event): event for event in kept if not decided.breathed[breather.number_of(event)]}
    return _RestsUsed(needs, decided, spare)


def _in_rests(
    breather: Breather, score: BreathScore, given: GivenBreaths, rests: _RestsUsed, catches: list[int]
) -> list[BreathEvent]:
    """Build the final list of breaths in rests, including catch breaths in rests, each with its preparation
    and reason.
    """
    unused = rests.spare.keys() - set(catches)
    result = []
    for event in given.kept:
        index = breather.number_of(event)
        if event.is_within or index == 0 or score.gaps is not None:
            result.append(event)
        elif index not in unused:
            if breather.written.breath[index - 1]:
                reason = WRITTEN_BY_HAND if breather.written.breath_by_hand[index - 1] else WRITTEN
            elif index in rests.spare:
                reason = AIR_SHORT
            else:
                reason = why(index, score.rests.lasts_s, rests.needs, rests.decided)
            if event.draws_air:
                event = msgspec.structs.replace(event, reason=because(event.reason, reason))
            result.append(event)
    return result


def _cut_notes(breather: Breather, events: tuple[BreathEvent, ...]) -> tuple[dict[int, float], list[Problem]]:
    """Find the notes whose lips leave early for a breath: the time in seconds by note index, and problems where a
    breath set by hand cuts a note too much.
    """
    times = breather.times
    early_end_s: dict[int, float] = {}
    problems = []
    for event in events:
        index = breather.number_of(event)
        before = index - 1
        if not event.draws_air or before < 0 or event.start_s >= times.played_end_s[before]:
            continue
        if event.corrected:
            note_id = breather.notes[before].id
            message = Message("breath.inside_note", {"note": note_id})
            problems.append(Problem(message, note_id, event.start_s, event.end_s))
        while before >= 0 and event.start_s < times.played_end_s[before]:
            early_end_s[before] = max(event.start_s, float(times.onset_s[before]))
            before -= 1
    return early_end_s, problems


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
