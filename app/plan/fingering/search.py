"""The search for fingerings: what every choice and every motion costs, and the cheapest way through a line.

Viterbi over the ranked fingerings of every note, exact also where a cost concerns three notes (turning a slide back).
It looks only where leaving the first choices can pay, so slow music costs nothing. What fingers do between two pitches
is counted in `app.plan.fingering.finger_travel`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.plan.fingering.finger_travel import FingerPlaces, finger_places
from app.plan.fingering.trills_and_runs import TRILL_S, attacked_notes, chromatic_notes, glissando_steps, trill_steps
from app.plan.music.piece import LineTimes
from app.score.model import Note
from instrument_maps.model import Control, Fingering, InstrumentMap

# What choosing an alternate costs. The unit is one step down in rank.
RANK_COST = 1.0
MOST_RANKS = 3
"""Further down the list an alternate is no stranger: woodwinds have many, ordered by little."""
CENTS_PER_UNIT = 20.0
"""An alternate worse in tune than the first choice by this much costs one unit on a fully audible note: about
what a listener notices in a melody."""
FULLY_AUDIBLE_S = 0.25
"""The intonation of shorter notes is less audible; their cost falls in proportion."""
FORKED_COST = 0.5
"""A forked fingering sounds covered, beside its rank."""
IN_PLACE_COST = {"trill": 0.5, "fast": 0.5, "forte": 0.5, "piano": 0.5, "chromatic": -0.5, "attack": -4.0}
"""A fingering that is meant for trills, fast passages, chromatic runs, attacks, loud or soft notes costs this there,
whatever its rank, ..."""
OUT_OF_PLACE_COST = 6.0
"""... and so much more than its rank elsewhere."""
BESIDE_COST = -0.5
"""A fingering that keeps a lever turned (tag "beside") costs this next to a note whose first choice turns it, ..."""
BESIDE_S = 0.5
"""... unless so long a silence is between them."""
HELD_COST = 0.1
"""A key left down that the note does not need (tag "held") costs this, whatever its rank."""
RARE_COST = 10.0
"""A fingering that players know and hardly ever take (tag "rare") costs this beside its rank, ..."""
RARE_TRILL_COST = 18.0
"""... and so much more in a trill, which saves motion with every step."""
QUICK_S = 0.15
"""A note is fast that lasts no longer than this, from the one before or to the next."""
LOUD, SOFT = 0.75, 0.35

# What moving costs.
FAST_S = 0.085
"""Below this time per note (16ths at about 176 beats/min) fingers begin to be the limit: tapping one finger reaches 6-7
per second, alternating fingers about twice that."""
TRILL_COST = 3.0
"""A trill repeats its motion, so it tires: hurry counts this much more."""
LIP_TRILL_WEIGHT, LEVER_TRILL_WEIGHT = 1.1, 0.75
"""A step of a trill that nothing but the lips makes counts as so many moves; one that turns a thumb's lever as so many
more, for the lever is slow."""
MOVE_COST = 0.15
"""Each finger that moves in a hurried step, where keys may be left down: it decides between what is else alike."""
GLISSANDO_COST = 6.0
"""A step of a glissando in which the slide does not go the way of the pitch, or a lever is turned."""
LIFTED_S = 0.12
"""In a silence this long a finger is free: it goes from key to key for nothing."""
KEY_TO_KEY_MOVES = 4
"""Such a way counts as so many moves more when passages are compared."""
EASY_STEP_S, HURRIED_STEP_S = 0.5, 0.12
"""What is awkward costs nothing in steps this long, all in steps this short, in proportion between."""
ROLL_COST = 0.8
"""A finger rolls onto a further key, or off it."""
TOGETHER_COST = 0.9
"""A thumb's lever is turned while fingers move: on a double horn the sides are changed."""
TURN_COST = 0.6
"""A hand turns to work a key with the side of a finger while others of its fingers move."""
BREAK_COST, BREAK_FINGERS = 0.25, 3
"""Each finger beyond so many that moves as the line crosses into another register."""
SLIDE_EASY = 0.7
"""A slide that needs at most this part of the time it has costs nothing."""
SLIDE_COST = 3.0
"""Cost of using all the time there is, above `SLIDE_EASY`."""
SLIDE_LATE = 1.8
"""Cost of not arriving in time, ..."""
SLIDE_LATE_RATE = 3.0
"""... and for each time more that it would need."""
SLIDE_MAX_SPEED_M_S = 2.5
"""Where the map does not say: speed of a trombonist's arm in fast passages."""
SLIDE_METRE_COST = 1.0
"""Each metre of a slide's way in a hurried step: of ways that all arrive in time the nearer one is taken."""
SAME_PLACE = 0.1
"""Places of a slide that differ by less of its travel are one position."""
LEGATO_COST = 1.25
"""A slide moved between notes that touch smears; counts more than one moved in a gap."""
REVERSAL_COST = 0.5
"""Turning the slide back at speed."""
OTHER_PLACE_COST = 4.0
"""A note in another place of the slide than the same pitch two notes before, in hurried steps: no one changes it within
a figure for little."""

REPEATED_COST, REPEATED_HOME_COST = 8.0, 0.8
"""Another fingering for a note that is repeated: no one changes it without a trill, a correction or a silence, but to
come back to a better one where there is time."""
REPEATED_HURRIED_S, REPEATED_EASY_S = 0.3, 0.4
"""There is none in steps as short as the one, and enough from the other on."""
REPEATED_REST_S = 0.5
"""After so long a silence another fingering costs nothing, in proportion before."""

PHRASE_SILENCE_S = 0.25
"""A silence this long divides phrases, for the comparison with the first choices."""
TOLERANCE = 1e-9
"""Rounding of sums of metres and shares."""


@dataclass(frozen=True)
class FingeringTable:
    """Fingerings of the pitches of a part, padded to K.

    Attributes
    ----------
    values : (P, K, C) float64
        Of the controls of pitch.
    cost : (P, K) float64
        What each costs by its rank.
    cents : (P, K) float64
    valid : (P, K) bool
        Which the search may choose; obsolete ones only a correction may.
    meant_for : dict of str to (P, K) bool
        Which are meant for a trill, for fast, loud or soft notes.
    register : (P,) int64
        How many breaks lie below the pitch.
    rare : (P, K) bool
        Which are hardly ever used.
    beside : (P, K) bool
        Which keep a lever turned for their neighbours.
    levers : (P, K) int64
        Levers that each turns, as bits.
    leaves_down : bool
        Whether any fingering of the instrument leaves a key down that its note does not need (tag "held").
    places : FingerPlaces
        Where every finger is in each of them.
    """

    choices: tuple[tuple[Fingering, ...], ...]
    values: FloatArray
    cost: FloatArray
    cents: FloatArray
    valid: BoolArray
    meant_for: dict[str, BoolArray]
    register: IntArray
    rare: BoolArray
    beside: BoolArray
    levers: IntArray
    leaves_down: bool
    places: FingerPlaces


@dataclass(frozen=True)
class Motions:
    """What it takes to get from each fingering of a note to each of the next.

    Attributes
    ----------
    pair : (N-1,) int64
        Of each step, its row in ``moves``.
    moves : (U, K, K) float64
        Fingers that move, by pair of pitches; a way from key to key counts as several.
    slide_m, needed_s, share : (N-1, K, K) float64, or (N-1, 1, 1) without a slide
        Travel of slides in metres, the time that takes, and the part of the available time that it is (over 1: it
        starts early).
    cost : (N-1, K, K) float64
        What the search pays.
    """

    pair: IntArray
    moves: FloatArray
    slide_m: FloatArray
    needed_s: FloatArray
    share: FloatArray
    cost: FloatArray


@dataclass(frozen=True)
class FingeringProblem:
    """The search as arrays: what each note may be played with, and what that costs."""

    times: LineTimes
    table: FingeringTable
    pitch_index: IntArray
    controls: tuple[Control, ...]
    allowed: BoolArray

    @property
    def has_slide(self) -> bool:
        """True if a slide is among the controls of pitch."""
        return any(control.kind == "slide" for control in self.controls)

    @cached_property
    def in_trill(self) -> BoolArray:
        """(N-1,): whether the step from a note to the next is part of a trill."""
        return trill_steps(self.times)

    @cached_property
    def local_cost(self) -> FloatArray:
        """(N, K): what a fingering costs by itself; inf where there is none or a correction forbids it."""
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
        """(N, K): fingerings that keep a lever turned which the first choice of a neighbour at another pitch turns."""
        table, times, index = self.table, self.times, self.pitch_index
        near = (times.onset_s[1:] - times.played_end_s[:-1] < BESIDE_S) & (index[1:] != index[:-1])
        first = table.levers[index, 0]
        here = table.levers[index]
        found = np.zeros(here.shape, dtype=bool)
        found[1:] |= near[:, None] & (here[1:] == first[:-1, None])
        found[:-1] |= near[:, None] & (here[:-1] == first[1:, None])
        return np.asarray(found & table.beside[index] & (here != 0))

    def _where(self, tag: str) -> BoolArray:
        """(N,): the notes that fingerings with this tag are meant for."""
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
        """What every step takes."""
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
        if gliding.any():
            back = (self._slide_change() * np.diff(times.pitch)[:, None, None] >= 0.0) | (moves[pair] > 0.0)
            slide_cost = np.where(gliding[:, None, None], GLISSANDO_COST * back, slide_cost)
        cost += slide_cost * trill[:, None, None]
        return Motions(pair, moves, slide_m, needed_s, share, cost)

    def _repeated(self, gap: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
        """Steps to the same pitch again, and what a worse and a better fingering cost there; not where a correction
        pins one."""
        alike = (self.allowed[1:] == self.allowed[:-1]).all(axis=1)
        again = np.flatnonzero((self.pitch_index[1:] == self.pitch_index[:-1]) & alike)
        touching = np.clip(1.0 - gap[again] / REPEATED_REST_S, 0.0, 1.0)
        easy = (REPEATED_HURRIED_S, REPEATED_EASY_S)
        home = np.interp(np.diff(self.times.onset_s)[again], easy, (REPEATED_COST, REPEATED_HOME_COST))
        # A slide leaves a good place in time too; who lets a key go and presses another could have done so at first.
        away = home if self.has_slide else np.full(len(again), REPEATED_COST)
        return again, away * touching, home * touching

    @cached_property
    def _pace(self) -> FloatArray:
        """(N-1,): how hurried every step is, from 0 to 1."""
        step = np.diff(self.times.onset_s)
        return np.asarray(np.clip((EASY_STEP_S - step) / (EASY_STEP_S - HURRIED_STEP_S), 0.0, 1.0))

    def _slide_change(self) -> FloatArray:
        """(N-1, K, K): how far the slides go out, as a part of their travel."""
        places = [place for place, control in enumerate(self.controls) if control.kind == "slide"]
        values = self.table.values[self.pitch_index][:, :, places].sum(axis=2)
        return np.asarray(values[1:, None, :] - values[:-1, :, None], dtype=np.float64)

    def _slides(self, gap: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Travel, time, share of the available time and cost of the slides' ways, each (N-1, K, K)."""
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
        """(N-2, K, K, K): turning a slide back at speed, and to another place for the same pitch, by the fingerings of
        three notes; None without a slide."""
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
        """Of spans of notes ``starts[i]``..``ends[i]``: whether a path goes further in them than another, or faster.

        Compared are the travel of slides and the fastest of their motions, as a part of the time it has; where there is
        no slide, the moves of fingers (beside one, a lever's moves are no travel).
        """
        inside = ends > starts
        spans = np.stack((starts, ends), axis=1).ravel()
        motions, steps = self.motions, np.arange(len(path) - 1)

        def along(amount: FloatArray, rows: IntArray, way: IntArray) -> FloatArray:
            # One more, for a span that begins at the last note.
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
) -> FingeringProblem:
    """Set up the search. ``pins`` maps note ids to labels that a correction demands; a label that is no fingering of
    its note is passed over (see `plan_fingerings`). ``by_hand`` (N,) are notes that the hand stops."""
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
    if pins:
        for index, note in enumerate(notes):
            pinned = _pinned(table.choices[pitch_index[index]], pins.get(note.id))
            if pinned is not None:
                allowed[index] = False
                allowed[index, pinned] = True
    return FingeringProblem(times, table, pitch_index.astype(np.int64), pitch_controls(instrument), allowed)


def pitch_controls(instrument: InstrumentMap) -> tuple[Control, ...]:
    """The controls that fingerings name."""
    return tuple(control for control in instrument.controls if control.role == "pitch")


def table_of(pitches: tuple[int, ...], instrument: InstrumentMap) -> FingeringTable:
    """The fingerings of these concert pitches, in their order."""
    choices = tuple(instrument.fingerings_for(pitch) for pitch in pitches)
    controls = pitch_controls(instrument)
    shape = (len(choices), max((len(ranked) for ranked in choices), default=1))
    values = np.zeros((*shape, len(controls)))
    cost, cents, valid = np.zeros(shape), np.zeros(shape), np.zeros(shape, dtype=bool)
    rare, beside, levers = np.zeros(shape, dtype=bool), np.zeros(shape, dtype=bool), np.zeros(shape, dtype=np.int64)
    turned = {item.name: 1 << place for place, item in enumerate(controls) if item.kind == "lever"}
    meant_for: dict[str, BoolArray] = {}
    for row, ranked in enumerate(choices):
        for column, fingering in enumerate(ranked):
            values[row, column] = [fingering.controls.get(item.name, item.rest_value) for item in controls]
            forked = FORKED_COST if fingering.rank > 1 and "forked" in fingering.tags else 0.0
            rare[row, column] = fingering.rank > 1 and "rare" in fingering.tags
            cost[row, column] = RANK_COST * min(fingering.rank - 1, MOST_RANKS) + forked + RARE_COST * rare[row, column]
            if fingering.rank > 1 and "held" in fingering.tags:
                cost[row, column] = HELD_COST
            beside[row, column] = fingering.rank > 1 and "beside" in fingering.tags
            if turned:
                levers[row, column] = sum(
                    turned.get(name, 0) for name, value in fingering.controls.items() if value > 0
                )
            cents[row, column] = fingering.cents
            valid[row, column] = not fingering.is_obsolete
            for tag in IN_PLACE_COST:
                if fingering.rank > 1 and tag in fingering.tags:
                    meant_for.setdefault(tag, np.zeros(shape, dtype=bool))[row, column] = True
    written = np.array([ranked[0].written_pitch for ranked in choices], dtype=np.int64)
    register = np.searchsorted(np.sort(np.array(instrument.breaks, dtype=np.int64)), written, side="right")
    places = finger_places(choices, shape, controls, instrument.contacts)
    leaves_down = any("held" in fingering.tags for fingering in instrument.fingerings)
    return FingeringTable(
        choices,
        values,
        cost,
        cents,
        valid,
        meant_for,
        register.astype(np.int64),
        rare,
        beside,
        levers,
        leaves_down,
        places,
    )


def _either_side(steps: BoolArray, count: int) -> BoolArray:
    """(N,): whether the step to a note or from it is marked."""
    notes = np.zeros(count, dtype=bool)
    notes[:-1] |= steps
    notes[1:] |= steps
    return notes


def _pinned(ranked: tuple[Fingering, ...], label: str | None) -> int | None:
    if label is None:
        return None
    return next((column for column, fingering in enumerate(ranked) if fingering.label == label), None)


def best_path(problem: FingeringProblem) -> IntArray:
    """The cheapest path: for every note the column of its fingering; ties go to the lower rank.

    Only where leaving the cheapest fingerings can pay is searched (see `_windows`).
    """
    local = problem.local_cost
    path: IntArray = np.argmin(local, axis=1).astype(np.int64)
    for first, last in _windows(problem, path):
        path[first : last + 1] = _search(problem, path, first, last)
    return path


def _windows(problem: FingeringProblem, path: IntArray) -> list[tuple[int, int]]:
    """Spans of notes outside of which no cheaper path leaves ``path``, the fingerings that are cheapest by themselves.

    Notes in a row that leave it cost at least ``dearer`` each, and save no more than what the steps at and between them
    cost above the least that they could. Spans for which that does not pay are left out, by the sums of savings.
    """
    count = len(path)
    if count < 2:
        return []
    steps, cost, local = np.arange(count - 1), problem.motions.cost, problem.local_cost
    possible = np.where(problem.allowed[:-1, :, None] & problem.allowed[1:, None, :], cost, np.inf)
    saving = cost[steps, path[:-1], path[1:]] - possible.min(axis=(1, 2))
    if problem.reversal_cost is not None:
        turned = problem.reversal_cost[steps[:-1], path[:-2], path[1:-1], path[2:]]
        saving[1:] += turned
    if not (saving > TOLERANCE).any():
        return []
    others = local - local[np.arange(count), path][:, None]
    others[np.arange(count), path] = np.inf
    dearer = float(others.min())
    # A span of notes first..last has the steps first-1..last; one step more on each side where three notes matter.
    reach = 1 if problem.reversal_cost is None else 2
    if not np.isfinite(dearer):
        return []
    sums = np.concatenate(([0.0], np.cumsum(saving - dearer)))
    lowest = np.minimum.accumulate(sums)
    highest = np.maximum.accumulate(sums[::-1])[::-1]
    # Of a step: the best span of steps that holds it.
    pays = highest[1:] - lowest[:-1] > -dearer * reach - TOLERANCE
    held = np.zeros(count, dtype=bool)
    held[:-1] |= pays
    held[1:] |= pays
    free = np.flatnonzero(held)
    runs = np.split(free, np.flatnonzero(np.diff(free) > 1) + 1)
    return [(max(int(run[0]) - reach, 0), min(int(run[-1]) + reach, count - 1)) for run in runs if len(run)]


def _search(problem: FingeringProblem, path: IntArray, first: int, last: int) -> IntArray:
    """Viterbi over notes first..last inclusive, whose ends stay as in ``path`` unless they are the line's."""
    local, cost = problem.local_cost[first : last + 1].copy(), problem.motions.cost[first:last]
    for end, is_lines in ((0, first == 0), (last - first, last == len(path) - 1)):
        if not is_lines:
            held = local[end, path[first + end]]
            local[end] = np.inf
            local[end, path[first + end]] = held
    reversal = problem.reversal_cost
    if reversal is None:
        return _chain(local, cost)
    return _chain_of_pairs(local, cost, reversal[first : max(last - 1, first)])


def _chain(local: FloatArray, cost: FloatArray) -> IntArray:
    """The cheapest way through a chain of choices; of equal ways the one with the lower ranks.

    Two neighbouring steps are joined to one by the best choice of the note between them, for all pairs of steps at
    once, until one step is left: as many rounds as the logarithm of the number of notes.
    """
    steps = cost + local[1:, None, :]
    steps[0] += local[0][:, None]
    rounds: list[IntArray] = []
    while len(steps) > 1:
        joined = len(steps) // 2 * 2
        before, after = steps[0:joined:2], steps[1:joined:2]
        best = before[:, :, :1] + after[:, :1, :]
        middle = np.zeros(best.shape, dtype=np.int64)
        for choice in range(1, local.shape[1]):
            ways = before[:, :, choice : choice + 1] + after[:, choice : choice + 1, :]
            better = ways < best - TOLERANCE
            np.copyto(best, ways, where=better)
            middle[better] = choice
        rounds.append(middle)
        steps = np.concatenate((best, steps[joined:]))
    first, last = np.unravel_index(int(steps[0].argmin()), steps[0].shape)
    chosen = np.array([first, last], dtype=np.int64)
    for middle in reversed(rounds):
        # An odd step at the end of a round was joined to nothing.
        joined = len(middle)
        between = middle[np.arange(joined), chosen[:joined], chosen[1 : joined + 1]]
        chosen = np.concatenate((np.stack((chosen[:joined], between), axis=1).ravel(), chosen[joined:]))
    return chosen


def _chain_of_pairs(local: FloatArray, cost: FloatArray, reversal: FloatArray) -> IntArray:
    """The same where a cost concerns three notes: a chain of pairs of neighbouring choices."""
    total = local[0][:, None] + cost[0] + local[1][None, :]
    back: list[IntArray] = []
    for note in range(2, len(local)):
        ways = total[:, :, None] + reversal[note - 2]
        back.append(ways.argmin(axis=0))
        total = ways.min(axis=0) + cost[note - 1] + local[note][None, :]
    before, here = np.unravel_index(int(total.argmin()), total.shape)
    chosen = [int(here), int(before)]
    for origin in reversed(back):
        chosen.append(int(origin[chosen[-1], chosen[-2]]))
    return np.array(chosen[::-1], dtype=np.int64)


def even_trills(problem: FingeringProblem, path: IntArray) -> IntArray:
    """Finger the first and the last two notes of every trill as those within: no one changes while trilling."""
    steps = np.concatenate(([False], problem.in_trill, [False]))
    if not steps.any():
        return path
    even = path.copy()
    edges = np.flatnonzero(steps[1:] != steps[:-1]).tolist()
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        for note, within in ((first, first + 2), (first + 1, first + 3), (last, last - 2), (last - 1, last - 3)):
            same = problem.pitch_index[note] == problem.pitch_index[within]
            # A correction of one of the two is for that note alone.
            if same and (problem.allowed[note] == problem.allowed[within]).all():
                even[note] = path[within]
    return even


def never_worse(problem: FingeringProblem, path: IntArray) -> IntArray:
    """Fall back to first choices wherever the path travels further or faster than they do, alternate run by run and
    phrase by phrase. What a correction pins stays in both."""
    first_path = np.argmin(problem.local_cost, axis=1)
    different = np.flatnonzero(path != first_path)
    if len(different) == 0:
        return path
    count = len(path)
    # A slide that stays near for a note between two alternates gains on the first what it may lose on the second.
    breaks = np.flatnonzero(np.diff(different) > (2 if problem.has_slide else 1))
    starts, ends = different[np.append(0, breaks + 1)], different[np.append(breaks, len(different) - 1)]
    silence = problem.times.onset_s[1:] - problem.times.played_end_s[:-1] >= PHRASE_SILENCE_S
    # With the notes on either side, which runs may share (no step belongs to two of them), but across no rest: there
    # is time to change.
    before = starts - ~np.append(True, silence)[starts]
    after = ends + ~np.append(silence, True)[ends]
    worse = problem.goes_further(path, first_path, before, after)
    path = _with_first_choices(path, first_path, starts[worse], ends[worse])
    starts = np.append(0, np.flatnonzero(silence) + 1)
    ends = np.append(starts[1:], count) - 1
    worse = problem.goes_further(path, first_path, starts, ends)
    return _with_first_choices(path, first_path, starts[worse], ends[worse])


def _with_first_choices(path: IntArray, first_path: IntArray, starts: IntArray, ends: IntArray) -> IntArray:
    """The path with the first choices in the spans of notes ``starts[i]``..``ends[i]``."""
    edges = np.zeros(len(path) + 1, dtype=np.int64)
    edges[starts] += 1
    edges[ends + 1] -= 1
    return np.where(np.cumsum(edges[:-1]) > 0, first_path, path)
