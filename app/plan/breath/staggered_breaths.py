"""Staggers breaths of players in unison or octaves: they avoid breathing before the same notes, and breathe at
different times within held notes.

In running notes without another chance to breathe, players of the same rhythm leave out different notes, also in thirds
and chords, so that no gap is heard.

After a fermata they breathe together.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from itertools import chain
from operator import itemgetter
from typing import Final, NamedTuple, TypeAlias

import numpy as np

from app.arrays import FloatArray
from app.errors import Message
from app.plan.breath.breaths_in_rests import breath_at
from app.plan.breath.lungs import FULL_BREATH_S
from app.plan.event_id import EventId
from app.plan.model import BreathEvent
from app.plan.music.fermatas import Fermata
from app.plan.music.notation import PLACES, notated
from app.plan.music.piece import EPSILON, LineTimes, Piece
from app.score.model import Note

UNISON_NOTES = 4
"""Least number of consecutive notes shared with others that form a unison; fewer may coincide by chance."""
HELD_S = 5.0
"""Length in seconds of notes from which players may breathe within them."""
ABOUT = 0.8
"""Least length of another player's note, relative to a note, for that player to hold it through a breath."""
HELD_SHARE = 0.75
"""Share of the lungs that a player uses for one part of a note."""
APART_S = 2.0
"""Distance in seconds at which breaths within a section go unnoticed."""
LED_TO_SHARE = 0.4
"""Least share of the lungs that is left at the start of a held note that other notes lead to."""
FROM_EDGES_S = 1.0
"""Seconds after the start and before the end of a held note without breaths, unless the lungs are too small for
that.
"""
LEAST_STEP_S = 2 * FULL_BREATH_S
"""Least seconds between breaths within one note, however small the lungs are, so that half of the note sounds."""
TRIED = 17
"""Number of times compared for each breath within a note."""
COMPARED = 8
"""Number of players whose catch breaths form one step of the plan, which is recomputed after an edit of one of them."""

Place: TypeAlias = int
"""Place of a note (`PLACES` a quarter) and its pitch class, as one number."""


class SharedLine(NamedTuple):
    """Summary of a part for comparison with other parts.

    Attributes
    ----------
    places : tuple of Place
        One number for each note, made of its notated onset and pitch class: equal for notes in unison or octaves.
    known : frozenset of Place
        The places as a set.
    onsets : tuple of int
        Notated onset of each note, as a number.
    rhythm : frozenset of int
        The onsets as a set.
    ordered : tuple of int
        Note indices in the order of their places.
    held_s : tuple of (int, float)
        Notes that last at least `HELD_S`: index and length in seconds.
    """

    places: tuple[Place, ...]
    known: frozenset[Place]
    onsets: tuple[int, ...]
    rhythm: frozenset[int]
    ordered: tuple[int, ...]
    held_s: tuple[tuple[int, float], ...]

    def notes_at(self, place: Place) -> tuple[int, ...]:
        """Return the indices of the part's notes at a place (onset and pitch class)."""
        first = bisect_left(self.ordered, place, key=self.places.__getitem__)
        return self.ordered[first : bisect_right(self.ordered, place, first, key=self.places.__getitem__)]

    def holds(self, place: Place, length_s: float) -> bool:
        """Return whether the part has a note at a place (onset and pitch class) that lasts at least about
        ``length_s``.
        """
        if place not in self.known:
            return False
        for index in self.notes_at(place):
            held = bisect_left(self.held_s, index, key=itemgetter(0))
            if held < len(self.held_s) and self.held_s[held][0] == index and self.held_s[held][1] >= ABOUT * length_s:
                return True
        return False


class Breathed(NamedTuple):
    """Breaths of one player, compared with those of players in unison: places of notes after catch breaths, onsets of
    notes left out for them, and breaths within held notes."""

    line: SharedLine
    caught: frozenset[Place]
    left_out: frozenset[int]
    within: tuple[tuple[Place, float], ...]


class BreathConstraints(NamedTuple):
    """Restrictions of a player's breaths due to other players.

    Attributes
    ----------
    caught : frozenset of int
        Indices of notes before which others in unison take catch breaths.
    left_out : tuple of int
        Indices of notes that others of the same rhythm leave out to breathe, repeated once for each such player.
    held : tuple of (int, tuple of float)
        Held notes that others hold too, with the times in seconds at which those breathe.
    after_hold : frozenset of int
        Indices of the notes that follow a common hold: all breathe before them and not before the held note.
    """

    caught: frozenset[int] = frozenset()
    left_out: tuple[int, ...] = ()
    held: tuple[tuple[int, tuple[float, ...]], ...] = ()
    after_hold: frozenset[int] = frozenset()


ALONE = BreathConstraints()


def shared_line(times: LineTimes, piece: Piece) -> SharedLine:
    """Summarise a part by the notated places of its notes, for comparison with other parts."""
    if not len(times.onset_tick):
        return SharedLine((), frozenset(), (), frozenset(), (), ())
    quarter = piece.clock.ticks_per_quarter
    onsets = np.rint(notated(times, piece).onset_tick * PLACES / quarter).astype(np.int64)
    places = tuple((onsets * 12 + times.pitch % 12).tolist())
    rhythm = tuple(onsets.tolist())
    held_s = tuple(
        (index, float(times.duration_s[index])) for index in np.flatnonzero(times.duration_s >= HELD_S).tolist()
    )
    ordered = tuple(sorted(range(len(places)), key=places.__getitem__))
    return SharedLine(places, frozenset(places), rhythm, frozenset(rhythm), ordered, held_s)


def after_holds(held: tuple[Fermata, ...], times: LineTimes) -> frozenset[int]:
    """For each fermata, find the note with which a part continues: the first that begins in the last part of the hold
    or after it. Returns the notes' indices.
    """
    if not held or not len(times.onset_tick):
        return frozenset()
    over = [one.start_tick + 3 * (one.release_tick - one.start_tick) // 4 for one in held]
    notes = np.searchsorted(times.onset_tick, np.array(over))
    return frozenset(notes[(notes > 0) & (notes < len(times.onset_tick))].tolist())


class Met(NamedTuple):
    """Breaths of other players in unison with a part: by player, the notes before which they take catch breaths, and
    the notes they leave out.
    """

    line: SharedLine
    breathed: tuple[Breathed, ...]
    caught: tuple[frozenset[int], ...]
    left_out: tuple[tuple[int, ...], ...]


NO_NOTES: Final = frozenset[int]()


def compared_with_others(line: SharedLine, breathed: tuple[Breathed, ...], before: Met | None) -> Met:
    """Compare a part with the players whose breaths are already planned; comparisons with unchanged players are reused
    from ``before``.
    """
    known = () if before is None or before.line != line else before.breathed
    caught, left_out = [], []
    for number, other in enumerate(breathed):
        if before is not None and number < len(known) and known[number] == other:
            caught.append(before.caught[number])
            left_out.append(before.left_out[number])
            continue
        meets, sounds = not other.caught.isdisjoint(line.known), not other.left_out.isdisjoint(line.rhythm)
        caught.append(caught_in_unison(line, other.line, other.caught) if meets else NO_NOTES)
        left_out.append(left_out_in_rhythm(line, other.line, other.left_out) if sounds else ())
    return Met(line, breathed, tuple(caught), tuple(left_out))


def shared_with(
    line: SharedLine, others: tuple[SharedLine, ...], met: Met, after_hold: frozenset[int]
) -> BreathConstraints:
    """Combine the breaths of other players to restrictions for one player's breaths.

    Parameters
    ----------
    others : tuple of SharedLine
        Parts of all other players.
    met : Met
        Comparison with the players whose breaths are already planned.
    after_hold : frozenset of int
        `after_holds` of the player.
    """
    held = []
    taken: dict[Place, list[float]] = {}
    for place, at_s in (pair for other in met.breathed for pair in other.within if line.held_s):
        taken.setdefault(place, []).append(at_s)
    for index, length_s in line.held_s:
        place = line.places[index]
        if any(other.holds(place, length_s) for other in others):
            held.append((index, tuple(sorted(taken.get(place, ())))))
    left_out = tuple(sorted(chain.from_iterable(met.left_out)))
    return BreathConstraints(NO_NOTES.union(*met.caught), left_out, tuple(held), after_hold)


def caught_in_unison(line: SharedLine, other: SharedLine, caught: frozenset[Place]) -> frozenset[int]:
    """Indices of notes of a part before which another player in unison takes a catch breath.

    Parameters
    ----------
    caught : frozenset of Place
        Places of the other player's catch breaths.
    """
    met = caught & line.known
    return frozenset(index for place in met for index in line.notes_at(place) if _in_unison(line, other, index))


def left_out_in_rhythm(line: SharedLine, other: SharedLine, left_out: frozenset[int]) -> tuple[int, ...]:
    """Indices of notes that sound when another player of the same rhythm leaves a note out.

    Parameters
    ----------
    left_out : frozenset of int
        Onsets of the notes that the other player leaves out.
    """
    least = min(UNISON_NOTES, len(line.onsets), len(other.onsets))
    return tuple(
        index
        for index, onset in enumerate(line.onsets)
        if onset in left_out and _together(line.onsets, other.rhythm, index, least)
    )


def _in_unison(line: SharedLine, other: SharedLine, index: int) -> bool:
    least = min(UNISON_NOTES, len(line.places), len(other.places))
    return _together(line.places, other.known, index, least)


def _together(places: Sequence[int], known: frozenset[int], index: int, least: int) -> bool:
    """Return whether ``places[index]`` is in a run of at least ``least`` consecutive places that are all in
    ``known``.
    """
    count = 1
    for step in (-1, 1):
        place = index + step
        while count < least and 0 <= place < len(places) and places[place] in known:
            count, place = count + 1, place + step
    return count >= least


def within_held(
    notes: Sequence[Note], times: LineTimes, piece: Piece, used: FloatArray, lung_s: float, shared: BreathConstraints
) -> tuple[BreathEvent, ...]:
    """Plan breaths within held notes that need most of a player's air or more, if other players hold the same note on
    meanwhile.

    Parameters
    ----------
    used : (N + 1,) float
        `app.plan.breath.lungs.air_used_s`.
    """
    events = []
    for index, others_s in shared.held:
        air_s = float(used[index + 1] - used[index])
        if air_s <= HELD_SHARE * lung_s:
            continue
        first_s, last_s = float(times.onset_s[index]), float(times.played_end_s[index])
        reason = Message("breath.staggered", {"air_s": round(air_s, 2), "lung_s": round(lung_s, 2)})
        lungful_s = (last_s - first_s) * lung_s / air_s
        # The notes before it use air too.
        begun_s = lungful_s if index == 0 or times.silence_tick[index] > 0 else LED_TO_SHARE * lungful_s
        starts_s = _handed_on(first_s, last_s, lungful_s, begun_s, others_s)
        for number, start_s in enumerate(starts_s, 1):
            id = str(EventId("within", notes[index].id, number))
            events.append(breath_at(id, piece, start_s, start_s + FULL_BREATH_S, reason))
    return tuple(events)


def _handed_on(
    first_s: float, last_s: float, lungful_s: float, begun_s: float, others_s: tuple[float, ...]
) -> list[float]:
    """Choose times of breaths within a note: equal steps, no stretch longer than the air lasts, away from other
    players' breaths; of these the fewest breaths, closest to the middle. The first comes at most ``begun_s`` after the
    note begins.
    """
    length_s, taken_s = last_s - first_s, np.array([*others_s, math.inf])
    most = max(int(length_s / LEAST_STEP_S), 1)
    least = min(max(math.ceil(length_s / lungful_s - EPSILON) - 1, 1), most)
    found: list[tuple[tuple[float, float, int, float], list[float]]] = []
    for count in range(least, min(least + 2, most) + 1):
        for step_s in (length_s / count, length_s / (count + 1)):
            ends_s = length_s - (count - 1) * step_s - FULL_BREATH_S
            edge_s = min(FROM_EDGES_S, ends_s / 2.0)
            for first in np.linspace(edge_s, ends_s - edge_s, TRIED).tolist():
                starts_s = first_s + first + step_s * np.arange(count)
                longest_s = max(first, ends_s - first, step_s - FULL_BREATH_S if count > 1 else 0.0)
                apart_s = float(np.abs(starts_s[:, None] - taken_s).min())
                over_s = max(0.0, longest_s - lungful_s - EPSILON, first - begun_s)
                order = (over_s, -min(apart_s, APART_S), count, abs(first - ends_s / 2.0))
                found.append((order, starts_s.tolist()))
    return min(found)[1]


def breathed_of(
    line: SharedLine,
    notes: Sequence[Note],
    caught: Sequence[int],
    left_out: Sequence[int],
    events: Sequence[BreathEvent],
) -> Breathed:
    """Summarise a player's breaths for comparison with players in unison.

    Parameters
    ----------
    caught : sequence of int
        Indices of notes with a catch breath before them.
    left_out : sequence of int
        Indices of notes left out for a catch breath.
    events : sequence of BreathEvent
        All breaths of the player.
    """
    within = [(EventId.parse(event.id).of, event.start_s) for event in events if event.is_within]
    index_of = {note.id: index for index, note in enumerate(notes)} if within else {}
    return Breathed(
        line,
        frozenset(line.places[index] for index in caught),
        frozenset(line.onsets[index] for index in left_out),
        tuple((line.places[index_of[note_id]], start_s) for note_id, start_s in within),
    )
