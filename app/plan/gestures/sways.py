"""Swings of the trunk from side to side, half a bar to two bars long, with still bars in between."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from functools import cache

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.errors import Message
from app.plan.events_by_hand import StyleEvent
from app.plan.model import GestureEvent, TimeFrame
from app.plan.music.dynamics import Dynamics, amount_at_vigour
from app.plan.music.piece import NoteTimes, Piece, Seeds
from app.plan.styles import amount_at

SWING_S = 1.1
"""Approximate seconds of the shortest half swing at any tempo: 1, 2, 4 ... beats."""
STIR_S = 10.0
"""Seconds before a note's onset and after its end in which the body moves with the beat."""
RESTING = 0.35
"""Size of the sway while not playing."""
BLOCK = 4
"""Number of shortest swings for which a division is chosen together."""
LEAST_SIZE = 0.75
"""Least random factor for the size of the shortest swings, so that they differ."""
FORMS: tuple[tuple[int, ...], ...] = ((4,), (2, 2), (2, 1, 1), (1, 1, 2), (1, 2, 1), (1, 1, 1, 1))
"""Divisions of a block of beats into swings."""
CALM, LIVELY = (0.34, 0.36, 0.1, 0.1, 0.08, 0.02), (0.06, 0.34, 0.18, 0.16, 0.14, 0.12)
"""Probabilities of the `FORMS` in soft, calm music and in loud music."""
SOFT, LOUD = 0.5, 1.4
"""Vigours of the music at and below which `CALM`, and at and above which `LIVELY`, applies fully."""


@dataclass(frozen=True, eq=False)
class Pulse:
    """Beats and bars of a performance, shared by all players.

    Attributes
    ----------
    swing_beats : int
        Beats of a half swing.
    beat_s : float
        Length of a beat in seconds at the reference time.
    beat_ticks, bar_ticks : (N,) int64
        Ticks at which beats and bars begin, also some before and after the performance. The last bar begins at its end.
    beats_s, bars_s : (N,) float64
        Times in seconds at which beats and bars begin.
    """

    swing_beats: int
    beat_s: float
    beat_ticks: IntArray
    beats_s: FloatArray
    bar_ticks: IntArray
    bars_s: FloatArray


def pulse(piece: Piece, frame: TimeFrame, swing_at_s: float) -> Pulse:
    """The pulse of a performance; the number of beats of a swing is chosen by the tempo at ``swing_at_s``."""
    clock = piece.clock
    at_tick = clock.ticks(swing_at_s)
    beat = int(piece.beat_ticks_at(np.array([at_tick]))[0])
    beat_s = clock.seconds(at_tick + beat) - clock.seconds(at_tick)
    swing_beats = 2 ** max(round(math.log2(SWING_S / beat_s)), 0)
    first_tick, last_tick = int(clock.ticks(frame.first_frame_s)), int(np.ceil(clock.ticks(frame.end_s)))
    # Some players' swings are twice as long and must be complete too.
    margin = 4 * swing_beats * beat
    beats = piece.metre_map.felt_between(first_tick - margin, last_tick + margin)
    bars = np.append(piece.bars(first_tick, last_tick), last_tick)
    in_s = clock.seconds
    return Pulse(swing_beats, beat_s, beats, in_s(beats.astype(np.float64)), bars, in_s(bars.astype(np.float64)))


@dataclass(frozen=True, eq=False)
class Swings:
    """Swings of the trunk from side to side, divided into N units of the shortest swing.

    Attributes
    ----------
    beats : int
        Felt beats in one unit.
    ticks, ends, starts_s, ends_s, amounts
        Start and end of each unit in ticks and seconds, and the position of the trunk at its end, -1..1.
    lasts : (N,) int64
        Number of units in the swing that the unit belongs to; 0 where the body is still.
    """

    beats: int
    ticks: IntArray
    ends: IntArray
    starts_s: FloatArray
    ends_s: FloatArray
    amounts: FloatArray
    lasts: IntArray

    def still_at(self, ticks: IntArray) -> BoolArray:
        """Return a mask (N,) of the ticks at which the body does not sway."""
        if not len(self.ticks):
            return np.ones(len(ticks), np.bool_)
        here = np.maximum(np.searchsorted(self.ticks, ticks, side="right") - 1, 0)
        return np.asarray(self.lasts[here] == 0)

    def __eq__(self, other: object) -> bool:
        """Return whether all arrays are equal, for comparing inputs of cached steps."""
        if not isinstance(other, Swings):
            return NotImplemented
        return all(np.array_equal(getattr(self, one.name), getattr(other, one.name)) for one in fields(self))

    __hash__ = None  # type: ignore[assignment]


def swings_of(
    times: NoteTimes,
    pulse: Pulse,
    frame: TimeFrame,
    seeds: Seeds,
    dynamics: Dynamics,
    stillness: float,
    styles: tuple[StyleEvent, ...] = (),
) -> Swings:
    """Swings from beat to beat, left and right in turn, of varying size; small where the player rests.

    Parameters
    ----------
    stillness : float
        Share 0..1 of the blocks in which the body is still except at their end.
    styles : tuple of StyleEvent
        Spans in another style, with another share of stillness.
    """
    beats, beat_s = pulse.swing_beats, pulse.beat_s
    if seeds.chance("swing") < 0.3 and beats * beat_s < 1.5 * SWING_S:
        # Some players swing at half the tempo of others.
        beats *= 2
    # Counted from the beginning of the piece, so that a longer pre-roll or an added note changes nothing.
    phase = (int(np.searchsorted(pulse.beat_ticks, 0)) + int(seeds.chance("phase") * beats)) % beats
    every_tick, every_s = pulse.beat_ticks[phase::beats], pulse.beats_s[phase::beats]
    origin = int(np.searchsorted(every_tick, 0))
    places = spans_near_notes(times, frame, every_s)
    places = places[(every_s[places + 1] > frame.first_frame_s) & (every_s[places] < frame.end_s)]
    ticks, ends, starts_s, ends_s = every_tick[places], every_tick[places + 1], every_s[places], every_s[places + 1]
    still = np.broadcast_to(amount_at(styles, "stillness", stillness, starts_s), len(starts_s))
    amounts, lasts = _shaped(places - origin, ticks, ends, dynamics.at(starts_s), seeds, still)
    playing = _sounding_share(times, starts_s, ends_s)
    amounts = amounts * (RESTING + (1.0 - RESTING) * playing)
    amounts = amount_at_vigour(amounts, dynamics.at((starts_s + ends_s) / 2.0))
    return Swings(beats, ticks, ends, starts_s, ends_s, amounts, lasts)


def _shaped(
    units: IntArray, ticks: IntArray, ends: IntArray, vigours: FloatArray, seeds: Seeds, stillness: FloatArray
) -> tuple[FloatArray, IntArray]:
    """Return the position (N,) of the trunk, -1..1, at the end of each unit (shortest swing), and the number of units
    of the swing the unit belongs to (0: still).

    Side and size at the end of a block depend on that block alone, so blocks can be changed independently.
    """
    blocks, inner = units // BLOCK, units % BLOCK
    # Position in the score that determines the chances of each block: that of its first unit, even if outside this
    # range.
    firsts = np.concatenate(([True], np.diff(blocks) != 0))[: len(blocks)]
    own = np.cumsum(firsts) - 1
    block, at = blocks[firsts], ticks[firsts]
    until = ends[np.append(np.flatnonzero(firsts)[1:], len(ends)) - 1] if len(ends) else ends
    flip = 1.0 if seeds.chance("side") < 0.5 else -1.0

    def ended(number: IntArray, begun: IntArray, reach: IntArray) -> FloatArray:
        """Return the positions (N,) of the trunk, -1..1, at the ends of blocks of units; successive blocks mostly end
        on opposite sides. ``number`` counts the blocks, ``begun`` has their start ticks, and ``reach`` the ticks up to
        which they affect the motion.
        """
        size = 0.35 + 0.65 * seeds.chances_at("sway", begun, number, reach)
        stays = seeds.chances_at("sway held", begun, number, reach) < 0.2
        side = np.where((number % 2 == 0) ^ stays, flip, -flip)
        return np.asarray(side * size)

    follows = np.concatenate(([False], np.diff(block) == 1))[: len(block)]
    one_before = np.where(follows, np.roll(at, 1), at)
    one_after = np.where(np.append(follows[1:], False)[: len(until)], np.roll(until, -1), until)
    before, after = ended(block - 1, one_before, until), ended(block, at, one_after)
    lively = np.clip((vigours[firsts] - SOFT) / (LOUD - SOFT), 0.0, 1.0)
    often = np.multiply.outer(1.0 - lively, CALM) + np.multiply.outer(lively, LIVELY)
    drawn = seeds.chances_at("sway form", at, block, until)
    form = np.minimum((np.cumsum(often, axis=1) < drawn[:, None]).sum(axis=1), len(FORMS) - 1)
    still = seeds.chances_at("still", at, block, until) < stillness[firsts]
    between = 0.4 + 0.6 * seeds.chances_at("sway between", at, block, until)
    share_before, share_after, share_between, parts = (table[form[own], inner] for table in _turns())
    turned = between * np.where(before >= 0.0, -1.0, 1.0)
    amounts = share_before * before[own] + share_after * after[own] + share_between * turned[own]
    amounts *= LEAST_SIZE + (1.0 - LEAST_SIZE) * seeds.chances_at("sway size", ticks, ends=ends)
    held = still[own]
    amounts = np.where(held & (inner < BLOCK - 1), before[own], np.where(held, after[own], amounts))
    return np.asarray(amounts), np.where(held & (inner < BLOCK - 1), 0, parts).astype(np.int64)


@cache
def _turns() -> tuple[FloatArray, FloatArray, FloatArray, IntArray]:
    """Tables (forms, units) of the ways to divide a block into swings: for each unit the weights of the previous
    block's end, this block's end and the turning point in the trunk's position, and the number of units of the swing.
    """
    shape = (len(FORMS), BLOCK)
    before, after, between, parts = np.zeros(shape), np.zeros(shape), np.zeros(shape), np.zeros(shape, np.int64)
    for row, form in enumerate(FORMS):
        # Ends of the swings of a block: the end of the previous block, the turning points, and its own end.
        ends = [(1.0, 0.0, 0.0)]
        for number in range(len(form) - 1):
            ends.append((0.0, 0.0, 1.0 if number % 2 == 0 else -0.7))
        ends.append((0.0, 1.0, 0.0))
        unit = 0
        for number, length in enumerate(form):
            for step in range(1, length + 1):
                share = step / length
                share = share * share * (3.0 - 2.0 * share)
                mix = [
                    (1.0 - share) * one + share * other
                    for one, other in zip(ends[number], ends[number + 1], strict=True)
                ]
                before[row, unit], after[row, unit], between[row, unit] = mix
                parts[row, unit] = length
                unit += 1
    return before, after, between, parts


def sways(swings: Swings, pulse: Pulse) -> list[GestureEvent]:
    """Return a gesture event for each unit (shortest swing) of the body. Its id is made of the tick, so corrections
    still find it if units are grouped into swings differently.
    """
    beat_s = round(pulse.beat_s, 3)
    reasons = {
        parts: Message("gesture.sway", {"beats": parts * swings.beats, "beat_s": beat_s}) for parts in (1, 2, 4)
    } | {0: Message("gesture.still")}
    columns = (swings.ticks, swings.ends, swings.starts_s, swings.ends_s, swings.amounts, swings.lasts)
    return [
        GestureEvent(f"sway:@{tick}", "sway", tick, end, start_s, end_s, round(amount, 4), reasons[parts])
        for tick, end, start_s, end_s, amount, parts in zip(*(one.tolist() for one in columns), strict=True)
    ]


def _sounding_share(times: NoteTimes, starts_s: FloatArray, ends_s: FloatArray) -> FloatArray:
    """Return the share (N,), 0..1, of each span during which the player's notes sound."""
    if len(times.onset_s) == 0:
        return np.zeros(len(starts_s))
    sounded = np.concatenate(([0.0], np.cumsum(times.duration_s)))
    knots = np.stack((times.onset_s, times.played_end_s), axis=1).ravel()
    values = np.stack((sounded[:-1], sounded[1:]), axis=1).ravel()
    lasts_s = np.interp(ends_s, knots, values) - np.interp(starts_s, knots, values)
    share: FloatArray = np.clip(lasts_s / np.maximum(ends_s - starts_s, 1e-6), 0.0, 1.0)
    return share


def spans_near_notes(times: NoteTimes, frame: TimeFrame, edges_s: FloatArray) -> IntArray:
    """Return ascending indices of the spans between neighbouring edges that are near the start or end of a note, or
    near the frame's ends.

    The cost depends on the number of spans found, not on the number of edges.
    """
    near_s = np.concatenate(([frame.first_frame_s], times.onset_s, times.played_end_s, [frame.end_s]))
    near_s.sort()
    last = len(edges_s) - 1
    lows = np.maximum(np.searchsorted(edges_s, near_s - STIR_S, side="right") - 1, 0)
    highs = np.clip(np.searchsorted(edges_s, near_s + STIR_S, side="left"), lows, last)
    # Each block begins where the previous one ends.
    lows = np.minimum(np.maximum(lows, np.concatenate(([0], np.maximum.accumulate(highs)[:-1]))), highs)
    counts = highs - lows
    before = np.cumsum(counts) - counts
    places: IntArray = np.repeat(lows - before, counts) + np.arange(counts.sum())
    return places
