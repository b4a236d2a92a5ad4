"""The search for fingerings: what every choice and every motion costs, and the cheapest way through a line.

Viterbi over the ranked fingerings of every note, exact also where a cost concerns three notes (turning a slide back).
Steps that cost nothing whatever is chosen divide a line into pieces that are solved apart, so slow music costs nothing.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from app.plan.line import IntArray, LineTimes
from app.plan.model import FloatArray, Note
from instrument_maps.model import Control, Fingering, InstrumentMap

BoolArray = npt.NDArray[np.bool_]

# What choosing an alternate costs. The unit is one step down in rank.
RANK_COST = 1.0
CENTS_PER_UNIT = 20.0
"""An alternate worse in tune than the first choice by this much costs one unit on a note that can be heard out: about
what a listener notices in a melody."""
HEARD_OUT_S = 0.25
"""Shorter notes do not let their intonation be heard; their cost falls in proportion."""

# What moving costs.
FAST_S = 0.085
"""Below this time per note (16ths at about 176 beats/min) fingers begin to be the limit: tapping one finger reaches 6-7
per second, alternating fingers about twice that."""
TRILL_S = 0.15
"""A trill is at least `TRILL_NOTES` notes of at most this length alternating by a second."""
TRILL_NOTES = 4
TRILL_COST = 3.0
"""A trill repeats its motion, so it tires: hurry counts this much more."""
LEVER_COST = 0.5
"""A lever under a thumb of its own moves beside the others."""
CONTRARY_COST = 0.5
"""One finger going up while another goes down is harder than both going one way."""
SLIDE_EASY = 0.7
"""A slide that needs at most this part of the time it has costs nothing."""
SLIDE_COST = 3.0
"""Cost of using all the time there is, above `SLIDE_EASY`."""
SLIDE_LATE = 8.0
"""Cost of not arriving in time: more than any alternate's."""
SLIDE_LATE_RATE = 10.0
SLIDE_MAX_SPEED_M_S = 2.5
"""Where the map does not say: speed of a trombonist's arm in fast passages."""
LEGATO_COST = 1.25
"""A slide moved between notes that touch smears; counts more than one moved in a gap."""
REVERSAL_COST = 0.5
"""Turning the slide back at speed."""

PHRASE_SILENCE_S = 0.25
"""A silence this long divides phrases, for the comparison with the first choices."""
_MOVED = 0.5
TOLERANCE = 1e-9
"""Rounding of sums of metres and shares."""


@dataclass(frozen=True)
class Table:
    """Fingerings of the pitches of a line, padded to K: values (P, K, C), and costs (P, K)."""

    choices: tuple[tuple[Fingering, ...], ...]
    values: FloatArray
    rank: IntArray
    cents: FloatArray
    valid: BoolArray


@dataclass(frozen=True)
class Motions:
    """What it takes to get from each fingering of a note to each of the next: arrays (N-1, K, K).

    Attributes
    ----------
    fingers : moves of valves and levers, counted (contrary ones and levers weighted)
    moves : the same, plainly counted
    slide_m : travel of slides, metres
    needed_s : time the slide's motion takes
    share : part of the available time that the slide needs (over 1: it starts early)
    cost : what the search pays
    """

    fingers: FloatArray
    moves: FloatArray
    slide_m: FloatArray
    needed_s: FloatArray
    share: FloatArray
    cost: FloatArray


@dataclass(frozen=True)
class Travel:
    """What a path of fingerings takes over a span of notes: travel of slides, moves of fingers where there is no slide
    (beside one, a lever's moves are no travel), and the fastest motion, as a part of the time it has."""

    slide_m: float
    moves: float
    peak_share: float

    def exceeds(self, other: Travel) -> bool:
        """Whether this path goes further or needs a faster motion than the other."""
        further = self.slide_m > other.slide_m + TOLERANCE or self.moves > other.moves + TOLERANCE
        return further or self.peak_share > other.peak_share + TOLERANCE


@dataclass(frozen=True)
class FingeringProblem:
    """The search as arrays: what each note may be played with, and what that costs."""

    times: LineTimes
    table: Table
    pitch_index: IntArray
    controls: tuple[Control, ...]
    allowed: BoolArray

    @property
    def has_slide(self) -> bool:
        """Whether a slide is among the controls of pitch."""
        return any(control.kind == "slide" for control in self.controls)

    @cached_property
    def in_trill(self) -> BoolArray:
        """(N-1,): whether the step from a note to the next is part of a trill."""
        return trill_steps(self.times)

    @cached_property
    def local_cost(self) -> FloatArray:
        """(N, K): what a fingering costs by itself; inf where there is none or a correction forbids it."""
        table, index = self.table, self.pitch_index
        out_of_tune = np.maximum(np.abs(table.cents) - np.abs(table.cents[:, :1]), 0.0) / CENTS_PER_UNIT
        heard = np.minimum(self.times.duration_s / HEARD_OUT_S, 1.0)[:, None]
        cost = RANK_COST * (table.rank[index] - 1) + out_of_tune[index] * heard
        return np.where(self.allowed, cost, np.inf)

    @cached_property
    def motions(self) -> Motions:
        """What every step takes."""
        times, index = self.times, self.pitch_index
        values = self.table.values[index]
        change = values[1:, None, :, :] - values[:-1, :, None, :]
        played = times.duration_s[:-1]
        gap = np.maximum(times.onset_s[1:] - times.played_end_s[:-1], 0.0)
        step = np.maximum(times.onset_s[1:] - times.onset_s[:-1], 1e-3)
        fingers, moves, slide_m, needed_s, share, slide_cost = (np.zeros(change.shape[:3]) for _ in range(6))
        up, down = np.zeros(change.shape[:3], dtype=bool), np.zeros(change.shape[:3], dtype=bool)
        for place, control in enumerate(self.controls):
            delta = change[..., place]
            if control.kind == "slide":
                distance = np.abs(delta) * control.travel_m
                takes = distance / (control.max_speed_m_s or SLIDE_MAX_SPEED_M_S)
                available = np.maximum(gap + control.move_note_share * played, 1e-3)[:, None, None]
                part = takes / available
                slide_m += distance
                share = np.maximum(share, part)
                needed_s = np.maximum(needed_s, takes)
                smear = np.where(gap > 0.0, 1.0, LEGATO_COST)[:, None, None]
                slide_cost += smear * SLIDE_COST * np.clip(part - SLIDE_EASY, 0.0, 1.0 - SLIDE_EASY)
                slide_cost += np.where(part > 1.0, SLIDE_LATE + SLIDE_LATE_RATE * (part - 1.0), 0.0)
            else:
                moved = np.abs(delta) > _MOVED
                moves += moved
                fingers += moved * (LEVER_COST if control.kind == "lever" else 1.0)
                if control.kind == "press":
                    up |= delta < -_MOVED
                    down |= delta > _MOVED
        fingers += CONTRARY_COST * (up & down)
        hurry = np.maximum(FAST_S / step - 1.0, 0.0)
        trill_hurry = TRILL_COST * np.maximum(TRILL_S / step - 1.0, 0.0)
        hurry = np.where(self.in_trill, np.maximum(trill_hurry, hurry), hurry)[:, None, None]
        trill = np.where(self.in_trill, TRILL_COST, 1.0)[:, None, None]
        return Motions(fingers, moves, slide_m, needed_s, share, fingers * hurry + slide_cost * trill)

    @cached_property
    def reversal_cost(self) -> FloatArray | None:
        """(N-2, K, K, K): turning a slide back at speed, by the fingerings of three notes; None without a slide."""
        slides = [place for place, control in enumerate(self.controls) if control.kind == "slide"]
        if not slides or len(self.pitch_index) < 3:
            return None
        place = self.table.values[self.pitch_index][:, :, slides[0]]
        change = place[1:, None, :] - place[:-1, :, None]
        hurried = np.maximum(self.motions.share - SLIDE_EASY, 0.0)
        turns = change[:-1, :, :, None] * change[1:, None, :, :] < -1e-6
        both = np.minimum(hurried[:-1, :, :, None], hurried[1:, None, :, :])
        return np.asarray(turns * np.minimum(both, 1.0) * REVERSAL_COST, dtype=np.float64)

    def travel(self, path: IntArray, first: int, last: int) -> Travel:
        """What a path takes from note ``first`` to note ``last`` inclusive."""
        steps = np.arange(first, last)
        a, b = path[first:last], path[first + 1 : last + 1]
        motions = self.motions
        return Travel(
            float(motions.slide_m[steps, a, b].sum()),
            0.0 if self.has_slide else float(motions.moves[steps, a, b].sum()),
            float(motions.share[steps, a, b].max(initial=0.0)),
        )

    def path_cost(self, path: IntArray) -> float:
        """What the search pays for a path, over the whole line."""
        count = len(path)
        notes, steps = np.arange(count), np.arange(count - 1)
        cost = float(self.local_cost[notes, path].sum() + self.motions.cost[steps, path[:-1], path[1:]].sum())
        if self.reversal_cost is not None:
            cost += float(self.reversal_cost[steps[:-1], path[:-2], path[1:-1], path[2:]].sum())
        return cost


def trill_steps(times: LineTimes) -> BoolArray:
    """(N-1,): whether the step to the next note belongs to a trill (see `TRILL_S`, `TRILL_NOTES`)."""
    count = len(times.pitch)
    steps = max(count - 1, 0)
    result = np.zeros(steps, dtype=bool)
    if count < TRILL_NOTES:
        return result
    interval = np.diff(times.pitch)
    quick = (np.diff(times.onset_s) <= TRILL_S) & (np.abs(interval) >= 1) & (np.abs(interval) <= 2)
    turns = quick[1:] & quick[:-1] & (interval[1:] == -interval[:-1])
    need = TRILL_NOTES - 2
    windows: BoolArray = np.asarray(np.lib.stride_tricks.sliding_window_view(turns, need).all(axis=1))
    for shift in range(need + 1):
        result[shift : shift + len(windows)] |= windows
    return result


def fingering_problem(
    notes: tuple[Note, ...], times: LineTimes, instrument: InstrumentMap, pins: dict[str, str]
) -> FingeringProblem:
    """Set up the search. ``pins`` maps note ids to labels that a correction demands; a label that is no fingering of
    its note is passed over (see `plan_fingerings`)."""
    pitches, pitch_index = np.unique(times.pitch, return_inverse=True)
    choices = tuple(instrument.fingerings_for(int(pitch)) for pitch in pitches)
    controls = tuple(control for control in instrument.controls if control.role == "pitch")
    width = max((len(ranked) for ranked in choices), default=1)
    values = np.zeros((len(choices), width, len(controls)))
    rank = np.ones((len(choices), width), dtype=np.int64)
    cents = np.zeros((len(choices), width))
    valid = np.zeros((len(choices), width), dtype=bool)
    for row, ranked in enumerate(choices):
        for column, fingering in enumerate(ranked):
            values[row, column] = [fingering.controls.get(item.name, item.rest_value) for item in controls]
            rank[row, column] = fingering.rank
            cents[row, column] = fingering.cents
            valid[row, column] = True
    allowed = valid[pitch_index]
    if pins:
        for index, note in enumerate(notes):
            pinned = _pinned(choices[pitch_index[index]], pins.get(note.id))
            if pinned is not None:
                allowed[index] = False
                allowed[index, pinned] = True
    return FingeringProblem(
        times, Table(choices, values, rank, cents, valid), pitch_index.astype(np.int64), controls, allowed
    )


def _pinned(ranked: tuple[Fingering, ...], label: str | None) -> int | None:
    if label is None:
        return None
    return next((column for column, fingering in enumerate(ranked) if fingering.label == label), None)


def best_path(problem: FingeringProblem) -> IntArray:
    """The cheapest path: for every note the column of its fingering; ties go to the lower rank.

    Steps that cost nothing whatever is chosen divide the line into independent pieces; only the others are searched.
    """
    local = problem.local_cost
    path: IntArray = np.argmin(local, axis=1).astype(np.int64)
    cost = problem.motions.cost
    reachable = problem.allowed[:-1, :, None] & problem.allowed[1:, None, :]
    busy = np.flatnonzero((cost * reachable).any(axis=(1, 2)))
    if len(busy) == 0:
        return path
    for run in np.split(busy, np.flatnonzero(np.diff(busy) > 1) + 1):
        first, last = int(run[0]), int(run[-1]) + 1
        path[first : last + 1] = _search(problem, first, last)
    return path


def _search(problem: FingeringProblem, first: int, last: int) -> IntArray:
    """Viterbi over pairs of neighbouring choices (a reversal concerns three notes), notes first..last inclusive."""
    local, cost, reversal = problem.local_cost, problem.motions.cost, problem.reversal_cost
    total = local[first][:, None] + cost[first] + local[first + 1][None, :]
    back: list[IntArray] = []
    for note in range(first + 2, last + 1):
        ways = total[:, :, None] if reversal is None else total[:, :, None] + reversal[note - 2]
        origin = ways.argmin(axis=0)
        best = ways.min(axis=0)
        back.append(np.broadcast_to(origin, cost.shape[1:]))
        total = best + cost[note - 1] + local[note][None, :]
    before, here = np.unravel_index(int(total.argmin()), total.shape)
    chosen = [int(here), int(before)]
    for origin in reversed(back):
        chosen.append(int(origin[chosen[-1], chosen[-2]]))
    return np.array(chosen[::-1], dtype=np.int64)


def never_worse(problem: FingeringProblem, path: IntArray) -> IntArray:
    """Fall back to first choices wherever the path travels further or slower than they do, alternate run by run and
    phrase by phrase. What a correction pins stays in both."""
    first_path = np.argmin(problem.local_cost, axis=1)
    path = path.copy()
    different = np.flatnonzero(path != first_path)
    if len(different) == 0:
        return path
    count = len(path)
    for run in np.split(different, np.flatnonzero(np.diff(different) > 1) + 1):
        low, high = max(int(run[0]) - 1, 0), min(int(run[-1]) + 1, count - 1)
        if problem.travel(path, low, high).exceeds(problem.travel(first_path, low, high)):
            path[run] = first_path[run]
    silence = problem.times.onset_s[1:] - problem.times.played_end_s[:-1]
    edges = [0, *(np.flatnonzero(silence >= PHRASE_SILENCE_S) + 1).tolist(), count]
    for start, end in itertools.pairwise(edges):
        same = (path[start:end] == first_path[start:end]).all()
        if not same and problem.travel(path, start, end - 1).exceeds(problem.travel(first_path, start, end - 1)):
            path[start:end] = first_path[start:end]
    return path
