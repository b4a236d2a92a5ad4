"""Costs of every fingering and of every motion between two fingerings, for the search."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.plan.fingering.fingering_table import (
    CENTS_PER_UNIT,
    FULLY_AUDIBLE_S,
    IN_PLACE_COST,
    FingeringTable,
    pitch_controls,
    table_of,
)
from app.plan.fingering.trills_and_runs import TRILL_S, attacked_notes, chromatic_notes, glissando_steps, trill_steps
from app.plan.music.piece import LineTimes
from app.plan.music.written_marks import NO_FINGERINGS, WrittenFingerings
from app.score.model import Note
from instrument_maps.fingering_label import written_choice
from instrument_maps.model import Control, Fingering, InstrumentMap

OUT_OF_PLACE_COST = 6.0
"""Cost of a fingering meant for a purpose (`IN_PLACE_COST`) elsewhere, in addition to its rank."""
BESIDE_COST = -0.5
"""Cost of a fingering that keeps a lever turned (tag "beside") next to a note whose first choice turns it; see
`BESIDE_S`."""
BESIDE_S = 0.5
"""Silence between the two notes from which `BESIDE_COST` no longer applies."""
RARE_TRILL_COST = 18.0
"""Additional cost of a rare fingering in a trill, where it would otherwise win by saving motion at every step."""
QUICK_S = 0.15
"""Time in seconds from the previous or to the next note below which a note is fast."""
LOUD, SOFT = 0.75, 0.35
# Costs of movement.
FAST_S = 0.085
"""Time in seconds per note below which fingers reach their limit (16ths at about 176 beats/min): tapping one finger
reaches 6 to 7 per second, alternating fingers about twice that.
"""
TRILL_COST = 3.0
"""Factor for the cost of haste in trills, whose repetition tires."""
LIP_TRILL_WEIGHT, LEVER_TRILL_WEIGHT = 1.1, 0.75
"""Number of finger moves that a lip trill's step equals, and additional moves if a thumb's lever is turned, which is
slow.
"""
MOVE_COST = 0.15
"""Cost of each finger that moves in a hurried step, even where keys may stay down; decides between otherwise equal
fingerings.
"""
GLISSANDO_COST = 6.0
"""Cost of a glissando's step in which the slide moves against the direction of the pitch, or a lever is turned."""
LIFTED_S = 0.12
"""Silence in seconds from which a finger changes keys at no cost."""
KEY_TO_KEY_MOVES = 4
"""Additional moves that a finger's change from one key to another equals in comparisons of passages."""
EASY_STEP_S, HURRIED_STEP_S = 0.5, 0.12
"""Lengths in seconds of steps in which an awkward change costs nothing, and in which it has full cost; linear
between.
"""
ROLL_COST = 0.8
"""Cost of a finger that rolls onto an additional key or off it."""
TOGETHER_COST = 0.9
"""Cost of turning a thumb's lever while fingers move, as when changing sides on a double horn."""
TURN_COST = 0.6
"""Cost of rotating a hand to press a key with the side of a finger while other fingers of the hand move."""
BREAK_COST, BREAK_FINGERS = 0.25, 3
"""Cost of each moving finger beyond this number where the line crosses into another register."""
SLIDE_EASY = 0.7
"""Share of the available time up to which a slide's move costs nothing."""
SLIDE_COST = 3.0
"""Cost of a slide's move that uses all of the available time, in proportion above `SLIDE_EASY`."""
SLIDE_LATE = 1.8
"""Cost of a slide that does not arrive in time; see `SLIDE_LATE_RATE`."""
SLIDE_LATE_RATE = 3.0
"""Further cost of a late slide for each multiple of the available time that it would need."""
SLIDE_MAX_SPEED_M_S = 2.5
"""Speed in m/s of a trombonist's arm in fast passages, if the instrument's map has none."""
SLIDE_METRE_COST = 1.0
"""Cost per metre of a slide's move in a hurried step, so that the nearest of several reachable positions wins."""
SAME_PLACE = 0.1
"""Difference, as a share of the travel, below which two places of a slide are the same position."""
LEGATO_COST = 1.25
"""Additional cost of a slide's move between notes without a gap, which smears."""
REVERSAL_COST = 0.5
"""Cost of reversing the slide's direction at speed."""
OTHER_PLACE_COST = 4.0
"""Cost, in hurried steps, of a note at another slide position than the same pitch two notes before."""
REPEATED_COST, REPEATED_HOME_COST = 8.0, 0.8
"""Costs of another fingering for a repeated note without a trill, correction or silence; lower for returning to a
better one if there is time.
"""
REPEATED_HURRIED_S, REPEATED_EASY_S = 0.3, 0.4
"""Lengths in seconds of steps in which the lower cost does not apply, and from which it applies fully."""
REPEATED_REST_S = 0.5
"""Silence in seconds after which another fingering costs nothing; in proportion below."""
TOLERANCE = 1e-9
"""Tolerance for rounding errors of sums."""


@dataclass(frozen=True)
class Motions:
    """Motions from each of the K fingerings of a note to each of the K fingerings of the next, for a part of N notes.

    Attributes
    ----------
    pair : (N-1,) int64
        Row in ``moves`` for the step from each note to the next.
    moves : (U, K, K) float64
        Number of fingers that move, for each of the U different pairs of pitches; a move between keys counts as
        several.
    slide_m, needed_s, share : (N-1, K, K) float64, or (N-1, 1, 1) without a slide
        Slide travel in metres, the time it takes, and its share of the available time (over 1: it starts early).
    cost : (N-1, K, K) float64
        Cost for the search.
    """

    pair: IntArray
    moves: FloatArray
    slide_m: FloatArray
    needed_s: FloatArray
    share: FloatArray
    cost: FloatArray


@dataclass(frozen=True)
class FingeringProblem:
    """Input of the fingering search: the fingerings of each note with their costs, as arrays.

    Attributes
    ----------
    in_score : dict of int to int
        Column of the fingering given in the score, by note.
    glides : (N,) bool or None
        Mask of notes from which a glissando in the score leads to the next.
    """

    times: LineTimes
    table: FingeringTable
    pitch_index: IntArray
    controls: tuple[Control, ...]
    allowed: BoolArray
    in_score: dict[int, int] = field(default_factory=dict)
    glides: BoolArray | None = None

    @cached_property
    def has_slide(self) -> bool:
        """True if the instrument has a slide that determines the pitch."""
        return any(control.kind == "slide" for control in self.controls)

    @cached_property
    def in_trill(self) -> BoolArray:
        """Mask (N-1,) of the steps from a note to the next that are part of a trill."""
        return trill_steps(self.times)

    @cached_property
    def local_cost(self) -> FloatArray:
        """Cost (N, K) of each of K fingerings of N notes by itself, such as for poor intonation; infinite where the
        note has fewer fingerings or a correction excludes one.
        """
        table, index, times = self.table, self.pitch_index, self.times
        out_of_tune = np.maximum(np.abs(table.cents) - np.abs(table.cents[:, :1]), 0.0) / CENTS_PER_UNIT
        audible = np.minimum(times.duration_s / FULLY_AUDIBLE_S, 1.0)[:, None]
        cost = table.cost[index]
        if table.meant_for:
            least = np.full(cost.shape, np.inf)
            meant = np.zeros(cost.shape, dtype=bool)
            for tag, which in table.meant_for.items():
                meant |= which[index]
                fits = which[index] & self._where(tag)[:, None]
                least = np.where(fits, np.minimum(least, IN_PLACE_COST[tag]), least)
            cost = np.where(meant, np.where(np.isfinite(least), least, cost + OUT_OF_PLACE_COST), cost)
        if table.beside.any():
            cost = np.where(self._beside, BESIDE_COST, cost)
        cost = cost + out_of_tune[index] * audible
        if table.rare.any() and self.in_trill.any():
            cost += RARE_TRILL_COST * (table.rare[index] & self._where("trill")[:, None])
        return np.where(self.allowed, cost, np.inf)

    @property
    def _beside(self) -> BoolArray:
        """Mask (N, K) of fingerings that keep a lever turned because the usual fingering of the note just before or
        after, at another pitch, needs it turned.
        """
        table, times, index = self.table, self.times, self.pitch_index
        near = (times.onset_s[1:] - times.played_end_s[:-1] < BESIDE_S) & (index[1:] != index[:-1])
        first = table.levers[index, 0]
        here = table.levers[index]
        found = np.zeros(here.shape, dtype=bool)
        found[1:] |= near[:, None] & (here[1:] == first[:-1, None])
        found[:-1] |= near[:, None] & (here[:-1] == first[1:, None])
        return np.asarray(found & table.beside[index] & (here != 0))

    def _where(self, tag: str) -> BoolArray:
        """Mask (N,) of the notes to which a tag of fingerings applies, such as ``"trill"``, ``"fast"`` or
        ``"forte"``.
        """
        times = self.times
        match tag:
            case "trill":
                return _either_side(self.in_trill, len(times.pitch))
            case "fast":
                quick = np.diff(times.onset_s) <= QUICK_S + TOLERANCE
                return _either_side(quick & ~self.in_trill, len(times.pitch))
            case "chromatic":
                return chromatic_notes(times)
            case "attack":
                return attacked_notes(times, self.table.register[self.pitch_index], self.in_trill)
            case "forte":
                return times.loudness >= LOUD
            case _:
                return times.loudness <= SOFT

    @cached_property
    def motions(self) -> Motions:
        """Motions of fingers and slides, and their costs, from each fingering of a note to each of the next."""
        table, times, index, count = self.table, self.times, self.pitch_index, len(self.table.choices)
        gap = np.maximum(times.onset_s[1:] - times.played_end_s[:-1], 0.0)
        step = np.maximum(times.onset_s[1:] - times.onset_s[:-1], 1e-3)
        pairs, pair = np.unique(index[:-1] * count + index[1:], return_inverse=True)
        before, after = pairs // count, pairs % count
        fingers = self.table.places.between(before, after)
        crossing = self.table.register[before] != self.table.register[after]
        crossed = np.where(crossing[:, None, None], np.maximum(fingers.moves - BREAK_FINGERS, 0.0), 0.0)
        awkward = ROLL_COST * fingers.rolls + TOGETHER_COST * fingers.together + BREAK_COST * crossed
        awkward += TURN_COST * fingers.turns
        if table.leaves_down:
            awkward += MOVE_COST * fingers.moves
        pace = self._pace
        hurry = np.maximum(FAST_S / step - 1.0, 0.0)
        trill_hurry = TRILL_COST * np.maximum(TRILL_S / step - 1.0, 0.0)
        hurry = np.where(self.in_trill, np.maximum(trill_hurry, hurry), hurry)
        touching = np.clip(1.0 - gap / LIFTED_S, 0.0, 1.0)
        trill = np.where(self.in_trill, TRILL_COST, 1.0)
        cost = np.zeros((len(pair), *fingers.weighted.shape[1:]))
        for amount, rate in ((fingers.weighted, hurry), (awkward, pace), (fingers.key_to_key, touching * trill)):
            if amount.any() and rate.any():
                cost += amount[pair] * rate[:, None, None]
        if self.in_trill.any():
            still = (fingers.moves == 0.0) & (before != after)[:, None, None]
            more = LIP_TRILL_WEIGHT * still + LEVER_TRILL_WEIGHT * fingers.levers
            cost += more[pair] * np.where(self.in_trill, hurry, 0.0)[:, None, None]
        again, away, home = self._repeated(gap)
        other = np.ones(cost.shape[1:])
        cost[again] += away[:, None, None] * np.triu(other, 1) + home[:, None, None] * np.tril(other, -1)
        moves = fingers.moves + KEY_TO_KEY_MOVES * fingers.apart
        nothing = np.zeros((len(pair), 1, 1))
        if not self.has_slide:
            return Motions(pair, moves, nothing, nothing, nothing, cost)
        slide_m, needed_s, share, slide_cost = self._slides(gap)
        cost += SLIDE_METRE_COST * slide_m * pace[:, None, None]
        gliding = glissando_steps(times)
        if self.glides is not None:
            gliding = gliding | self.glides[:-1]
        if gliding.any():
            back = (self._slide_change() * np.diff(times.pitch)[:, None, None] >= 0.0) | (moves[pair] > 0.0)
            slide_cost = np.where(gliding[:, None, None], GLISSANDO_COST * back, slide_cost)
        cost += slide_cost * trill[:, None, None]
        return Motions(pair, moves, slide_m, needed_s, share, cost)

    def _repeated(self, gap: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
        """Indices of the steps that repeat a pitch, and for each the costs of changing to a worse and to a better
        fingering; steps fixed by a correction are excluded.
        """
        alike = (self.allowed[1:] == self.allowed[:-1]).all(axis=1)
        again = np.flatnonzero((self.pitch_index[1:] == self.pitch_index[:-1]) & alike)
        touching = np.clip(1.0 - gap[again] / REPEATED_REST_S, 0.0, 1.0)
        easy = (REPEATED_HURRIED_S, REPEATED_EASY_S)
        home = np.interp(np.diff(self.times.onset_s)[again], easy, (REPEATED_COST, REPEATED_HOME_COST))
        # A slide may leave a good position just in time; a player who releases one key to press another could have
        # started with the other.
        away = home if self.has_slide else np.full(len(again), REPEATED_COST)
        return again, away * touching, home * touching

    @cached_property
    def _pace(self) -> FloatArray:
        """Pace (N-1,) of every step from a note to the next: 0 for slow steps to 1 for quick ones."""
        step = np.diff(self.times.onset_s)
        return np.asarray(np.clip((EASY_STEP_S - step) / (EASY_STEP_S - HURRIED_STEP_S), 0.0, 1.0))

    def _slide_change(self) -> FloatArray:
        """Change (N - 1, K, K) of the slide's extension, as a share of its travel, from each of K fingerings of a note
        to each of the next of N notes."""
        places = [place for place, control in enumerate(self.controls) if control.kind == "slide"]
        values = self.table.values[self.pitch_index][:, :, places].sum(axis=2)
        return np.asarray(values[1:, None, :] - values[:-1, :, None], dtype=np.float64)

    def _slides(self, gap: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Travel (metres), time (seconds), share of the available time and cost of a slide's way from each of K
        fingerings to each of the next note, each (N - 1, K, K)."""
        values, played = self.table.values[self.pitch_index], self.times.duration_s[:-1]
        shape = (len(gap), values.shape[1], values.shape[1])
        slide_m, needed_s, share, cost = (np.zeros(shape) for _ in range(4))
        for place, control in enumerate(self.controls):
            if control.kind != "slide":
                continue
            delta = values[1:, None, :, place] - values[:-1, :, None, place]
            distance = np.abs(delta) * control.travel_m
            takes = distance / (control.max_speed_m_s or SLIDE_MAX_SPEED_M_S)
            available = np.maximum(gap + control.move_note_share * played, 1e-3)[:, None, None]
            part = takes / available
            slide_m += distance
            share = np.maximum(share, part)
            needed_s = np.maximum(needed_s, takes)
            smear = np.where(gap > 0.0, 1.0, LEGATO_COST)[:, None, None]
            cost += smear * SLIDE_COST * np.clip(part - SLIDE_EASY, 0.0, 1.0 - SLIDE_EASY)
            cost += np.where(part > 1.0, SLIDE_LATE + SLIDE_LATE_RATE * (part - 1.0), 0.0)
        return slide_m, needed_s, share, cost

    @cached_property
    def reversal_cost(self) -> FloatArray | None:
        """Cost (N-2, K, K, K) for three successive notes: reversing the slide at speed, and returning to a pitch in
        another position; None without a slide.
        """
        slides = [place for place, control in enumerate(self.controls) if control.kind == "slide"]
        if not slides or len(self.pitch_index) < 3:
            return None
        place = self.table.values[self.pitch_index][:, :, slides[0]]
        change = place[1:, None, :] - place[:-1, :, None]
        hurried = np.maximum(self.motions.share - SLIDE_EASY, 0.0)
        turns = change[:-1, :, :, None] * change[1:, None, :, :] < -1e-6
        both = np.minimum(hurried[:-1, :, :, None], hurried[1:, None, :, :])
        elsewhere = np.abs(place[2:, None, :] - place[:-2, :, None]) > SAME_PLACE
        returns = (self.pitch_index[2:] == self.pitch_index[:-2]) * np.minimum(self._pace[:-1], self._pace[1:])
        cost = turns * np.minimum(both, 1.0) * REVERSAL_COST
        cost += OTHER_PLACE_COST * (elsewhere * returns[:, None, None])[:, :, None, :]
        return np.asarray(cost, dtype=np.float64)

    def goes_further(self, path: IntArray, other: IntArray, starts: IntArray, ends: IntArray) -> BoolArray:
        """For each span of notes ``starts[i]``..``ends[i]``, return whether ``path`` moves further or faster than
        ``other``.

        With a slide this compares its travel and its fastest motion relative to the available time; without one, the
        finger moves.
        """
        inside = ends > starts
        spans = np.stack((starts, ends), axis=1).ravel()
        motions, steps = self.motions, np.arange(len(path) - 1)

        def along(amount: FloatArray, rows: IntArray, way: IntArray) -> FloatArray:
            # One additional entry for a span that begins at the last note.
            return np.append(amount[rows, way[:-1], way[1:]], 0.0)

        if not self.has_slide:
            more = along(motions.moves, motions.pair, path) - along(motions.moves, motions.pair, other)
            return np.asarray(inside & (np.add.reduceat(more, spans)[::2] > TOLERANCE))
        more = along(motions.slide_m, steps, path) - along(motions.slide_m, steps, other)
        further = np.add.reduceat(more, spans)[::2] > TOLERANCE
        fastest, allowed = (np.maximum.reduceat(along(motions.share, steps, way), spans)[::2] for way in (path, other))
        return np.asarray(inside & (further | (fastest > allowed + TOLERANCE)))


def fingering_problem(
    notes: tuple[Note, ...],
    times: LineTimes,
    instrument: InstrumentMap,
    pins: dict[str, str],
    by_hand: BoolArray | None = None,
    written: WrittenFingerings = NO_FINGERINGS,
) -> FingeringProblem:
    """Set up the search for fingerings. ``pins`` maps note ids to labels required by corrections; labels unknown to the
    map, here or in ``written`` (fingerings in the score), are ignored (see `plan_fingerings`). ``by_hand`` (N,) marks
    notes stopped by the hand in the bell.
    """
    stopped = instrument.stopped if by_hand is not None and by_hand.any() else None
    if stopped is not None and by_hand is not None:
        times = replace(times, pitch=times.pitch + stopped.fingered_semitones * by_hand)
    pitches, pitch_index = np.unique(times.pitch, return_inverse=True)
    table = table_of(tuple(int(pitch) for pitch in pitches), instrument)
    allowed = table.valid[pitch_index]
    if stopped is not None and by_hand is not None and stopped.without:
        without = [place for place, item in enumerate(pitch_controls(instrument)) if item.name in stopped.without]
        plain = allowed & (table.values[pitch_index][:, :, without] == 0.0).all(axis=2)
        allowed = np.where((by_hand & plain.any(axis=1))[:, None], plain, allowed)
    in_score = _in_score(written.label, table.choices, pitch_index, instrument)
    if pins or in_score:
        for index, note in enumerate(notes):
            pinned = _pinned(table.choices[pitch_index[index]], pins.get(note.id))
            if pinned is None:
                pinned = in_score.get(index)
            if pinned is not None:
                allowed[index] = False
                allowed[index, pinned] = True
    controls = pitch_controls(instrument)
    glides = np.array(written.glides) if any(written.glides) else None
    return FingeringProblem(times, table, pitch_index.astype(np.int64), controls, allowed, in_score, glides)


def _in_score(
    written: Sequence[str], choices: Sequence[tuple[Fingering, ...]], pitch_index: IntArray, instrument: InstrumentMap
) -> dict[int, int]:
    """Find the fingerings that the score prescribes: for each such note, by index, the column of that fingering among
    the note's choices. Fingerings that the instrument map lacks are omitted.
    """
    found = {}
    for index, text in enumerate(written):
        column = written_choice(text, choices[pitch_index[index]], instrument.controls) if text else None
        if column is not None:
            found[index] = column
    return found


def _either_side(steps: BoolArray, count: int) -> BoolArray:
    """Mask (N,) of N notes (``count``) that have a marked step (N-1,) to the next or from the previous note."""
    notes = np.zeros(count, dtype=bool)
    notes[:-1] |= steps
    notes[1:] |= steps
    return notes


def _pinned(ranked: tuple[Fingering, ...], label: str | None) -> int | None:
    if label is None:
        return None
    return next((column for column, fingering in enumerate(ranked) if fingering.label == label), None)
