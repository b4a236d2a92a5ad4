"""Catch breaths: their places, their form and their reasons."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.errors import Argument, Message
from app.plan.breath.air_by_note import AirStock
from app.plan.breath.breaths_in_rests import blown_catch
from app.plan.breath.catch_breath_lengths import CATCH_MIN_S, Room
from app.plan.breath.catch_breath_places import AirSupply, catch_places
from app.plan.breath.lungs import FULL_BREATH_S, levels, short_catches
from app.plan.breath.phrase_ends import ComparedLine
from app.plan.breath.score_for_breath import Breather, BreathScore
from app.plan.breath.staggered_breaths import BreathConstraints
from app.plan.model import BreathEvent, Problem
from app.plan.music.piece import EPSILON, LineTimes, Seeds


def catch_breath_notes(
    breather: Breather, score: BreathScore, stock: AirStock, may: BoolArray, shared: BreathConstraints, seeds: Seeds
) -> list[int]:
    """Indices of notes with a catch breath before them: chosen at the tempo of the score, corrected where tempo changes
    need more air.
    """
    taken = np.zeros(len(breather.notes), dtype=bool)
    taken[list(shared.caught)] = True
    missing = np.bincount(np.array(shared.left_out, np.int64), minlength=len(breather.notes))

    def between(times: LineTimes, used: FloatArray, filled: FloatArray, free_s: float) -> list[int]:
        compared = ComparedLine(times, breather.piece, score.rests.sounding_tick, breather.written, taken, seeds)
        return catch_places(compared, AirSupply(used, score.lung_s, filled, free_s), may, missing, stock.room)

    # All players breathe at written marks and after notes held together, and none just before.
    after_hold = sorted(shared.after_hold) if score.gaps is None else []
    first = {*breather.marked, *(index for index in after_hold if not breather.written.joined[index - 1])}
    first = {index for index in first if may[index] and stock.refill[index] == 0.0 and stock.room.length_s[index] > 0.0}
    given = stock.refill.copy()
    at = sorted(first)
    given[at] = np.minimum(stock.room.lasts_s[at] / FULL_BREATH_S, 1.0)
    may = may.copy()
    may[[index - 1 for index in after_hold]] = False
    # A player that breathes in every rest (as the source document demands) or only when empty needs no breath at phrase
    # ends.
    free_s = (breather.parameters.breath_need or 1.0) * score.lung_s
    catches = between(score.steady, stock.steady_used, given, free_s)
    if score.steady is score.written:
        return stock.room.apart(sorted({*first, *catches}))
    filled = given.copy()
    filled[catches] = np.minimum(stock.room.lasts_s[catches] / FULL_BREATH_S, 1.0)
    again = short_catches(stock.used, score.lung_s, given, filled)
    filled[again] = given[again]
    more = between(score.written, stock.used, filled, np.inf)
    return stock.room.apart(sorted({*first, *catches} - {*again.tolist()} | {*more}))


def catch_breaths(
    breather: Breather, score: BreathScore, stock: AirStock, catches: list[int], after_hold: Collection[int]
) -> list[BreathEvent]:
    """Catch breath events before the given notes, except in rests that have a breath of their own."""
    found: dict[int, BreathEvent] = {}
    if score.gaps is not None:
        blown = [index for index in catches if score.gaps.played[index] and not breather.written.breath[index - 1]]
        found = {index: blown_catch(breather.notes[index], breather.piece, score.gaps, index) for index in blown}
    found |= _made(breather, score, stock, [index for index in catches if index not in found], after_hold)
    return [found[index] for index in catches]


def _made(
    breather: Breather, score: BreathScore, stock: AirStock, catches: list[int], after_hold: Collection[int]
) -> dict[int, BreathEvent]:
    """Create the catch breaths that take time from the end of the previous note, by index of the note that follows."""
    if not catches:
        return {}
    notes, times, room = breather.notes, breather.times, stock.room
    lung_s, rests = score.lung_s, score.rests.sounding_tick
    phrase_ends = _not_for_air(stock, lung_s, catches)
    at = np.array(catches)
    onset_s, start_s = times.onset_s[at], times.onset_s[at] - room.lasts_s[at]
    breaths = np.flatnonzero(stock.refill > 0.0)
    place = np.searchsorted(breaths, at)
    first, last = np.concatenate(([0], breaths))[place], np.append(breaths, len(notes))[place]
    rows = zip(
        catches,
        np.where(room.length_s[at] > 0.0, 0, room.dropped[at]).tolist(),
        np.round(breather.piece.clock.ticks(start_s)).astype(np.int64).tolist(),
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
        if breather.written.breath[index - 1]:
            reason = Message(
                "breath.by_hand" if breather.written.breath_by_hand[index - 1] else "breath.written", short
            )
        elif index in after_hold and not dropped:
            reason = Message("breath.after_hold", {"after_note": after})
        elif dropped:
            reason = _dropping(breather, index, dropped, why)
        elif index in phrase_ends:
            reason = Message("breath.phrase_end", short)
        else:
            reason = Message(_catch(breather, rests, index), {**short, **why})
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


def _catch(breather: Breather, rests: IntArray, index: int) -> str:
    """Return the id of the message that explains a catch breath for lack of air; it depends on whether the note is
    under a slur.
    """
    if not breather.written.joined[index - 1]:
        return "breath.catch"
    return "breath.catch_rest_slurred" if rests[index] > 0 else "breath.catch_slurred"


def _dropping(breather: Breather, index: int, dropped: int, why: dict[str, Argument]) -> Message:
    """Return the message that explains a breath for which ``dropped`` notes are left out; it depends on whether they
    are under a slur.
    """
    arguments: dict[str, Argument] = {"after_note": breather.notes[index - 1].id, **why}
    if dropped > 1:
        arguments["first_note"] = breather.notes[index - dropped].id
    slurred = breather.written.joined[index - 1 - dropped : index]
    if not slurred.any():
        return Message("breath.catch_dropped" if dropped == 1 else "breath.catch_dropped_two", arguments)
    if slurred.all():
        arguments["why"] = "breath.slur_broken"
    else:
        arguments["why"] = "breath.slur_begins_late" if slurred[-1] else "breath.slur_ends_early"
    return Message("breath.catch_dropped_slurred" if dropped == 1 else "breath.catch_dropped_two_slurred", arguments)


def _needed_s(stock: AirStock, lung_s: float, first: IntArray, last: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return, for stretches of notes from ``first`` to ``last``, the air they need and the air available, in seconds of
    playing. Both are computed at the tempo of the score, or as played for stretches that lack air only as played.
    """
    played_s, steady_s = (used[last] - used[first] for used in (stock.used, stock.steady_used))
    full_s = levels(stock.steady_used, lung_s, stock.refill)[first] * lung_s
    is_short = played_s > stock.air_s[first]
    return np.where(is_short, played_s, steady_s), np.where(is_short, stock.air_s[first], full_s)


def _not_for_air(stock: AirStock, lung_s: float, catches: list[int]) -> set[int]:
    """The notes among ``catches`` before which the air would also last without the catch breath."""
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


def broken_slurs(breather: Breather, caught: list[BreathEvent], room: Room, rests: IntArray) -> list[Problem]:
    """Return problems for catch breaths under slurs; none for those that are marked in the score or in a rest.

    Parameters
    ----------
    rests : (N,) int64
        Ticks of rest before each note.
    """
    problems = []
    for event in caught:
        index = breather.number_of(event)
        dropped = int(room.dropped[index]) if room.length_s[index] == 0.0 else 0
        breaks = breather.written.joined[index - 1 - dropped : index].any() and (dropped or not rests[index])
        if breaks and not breather.written.breath[index - 1]:
            note_id = breather.notes[index - 1].id
            message = Message("breath.breaks_slur", {"note": note_id})
            problems.append(Problem(message, note_id, event.start_s, event.end_s))
    return problems


def hasty_at_marks(breather: Breather, caught: list[BreathEvent]) -> list[Problem]:
    """Return problems for breath marks that follow notes too short to leave time for an unhurried breath."""
    problems = []
    for event in caught:
        before, lasts_s = breather.number_of(event) - 1, event.end_s - event.start_s
        if breather.written.breath[before] and lasts_s < CATCH_MIN_S - EPSILON:
            note_id = breather.notes[before].id
            lengths: dict[str, Argument] = {
                "lasts_ms": round(1000.0 * lasts_s),
                "least_ms": round(1000.0 * CATCH_MIN_S),
            }
            message = Message("breath.mark_too_short", {"note": note_id, **lengths})
            problems.append(Problem(message, note_id, event.start_s, event.end_s))
    return problems
