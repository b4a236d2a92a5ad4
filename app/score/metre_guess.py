"""Guesses the metre of a piece whose file has no time signature, from its notes; only triple and compound metres.

Without a time signature a MIDI file counts as 4/4, which puts most bar lines right for pieces in two or four but none
for pieces in three. A metre is therefore assumed only if the notes leave little doubt that bars are in three. The
choice among these metres, and of the first bar line, is the likeliest candidate.

Each candidate (a metre and a first bar line) is scored by long notes, low notes, entries and harmony changes at its bar
lines and beats, and by repetition after a bar (after Temperley's and Steedman's accounts of metre). The weights were
fitted to 2,427 pieces by a conditional logit over all candidates with L2-regularised maximum likelihood. The pieces are
those of music21's corpus in one metre: folk songs (Essen, O'Neill, Ryan, Aird), chorales and quartets.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray, IntArray
from app.score.metre_map import Metre

STEPS: Final = 4
"""Number of cells per quarter: signals have a resolution of sixteenths."""
MOST_CELLS: Final = 4096
"""Greatest number of examined cells, 256 bars."""
MOST_LINES: Final = 32
LEAST_NOTES: Final = 24
LEAST_ON_GRID: Final = 0.5
"""Mean resultant length 0..1 of onsets around the sixteenths below which quarters say nothing about the notes."""
TRIPLE_LEAST: Final = 0.85
"""Least probability of bars in three for a metre to be assumed; see `BAR_LINES_LEAST`."""
BAR_LINES_LEAST: Final = 0.5
"""Least probability that the found bar lines are correct."""
LAGS: Final = (6, 8, 12, 16, 18, 24, 32, 36, 48)
"""Numbers of cells after which a bar may repeat."""
USUAL_LAGS: Final = (6, 8, 10, 12, 14, 16, 18, 20, 22, 24)
"""Numbers of cells that show how much a piece repeats anyway."""


_CONTRASTS: Final = (
    (3.09, -0.67, 0.60, 1.99, 0.03, 0.30, -1.04, 2.21, 2.15, 1.41, 1.95),
    (1.88, 1.52, 0.00, -0.78, -0.92, 0.64, -2.53, 2.00, 2.06, 0.59, 2.34),
    (-0.99, -0.87, 1.20, -5.53, -0.21, 0.71, -3.54, 2.01, -3.44, 1.44, 0.03),
    (0.36, 0.03, -0.59, -2.91, -0.51, 0.24, -0.02, 0.45, -0.36, -0.66, -1.50),
)
"""A column a signal; rows: bar line against beats, beats against the rest, half bar against beats, bar line against the
eighth before it."""
_COMPOUND_CONTRASTS: Final = (
    (-0.33, -1.31, -1.58, 4.32, -0.09, 0.65, 1.00, -0.39, 0.12, 0.18, -0.42),
    (-1.37, -0.86, -0.58, 5.31, -0.77, 1.25, -1.42, 0.35, -2.13, 0.79, 0.40),
    (0.15, -1.65, 1.09, 5.15, 1.30, -1.44, -0.21, -2.20, -1.01, -1.94, 0.29),
    (-0.64, 0.87, 2.26, -2.55, 1.46, -0.52, 1.03, 0.96, -0.94, -0.27, -0.22),
)
"""Weights added to those of simple metres where the metre is compound or counts in eighths."""
_SHORT_CONTRASTS: Final = (
    (-3.38, 2.10, -1.97, 16.17, 0.23, -0.26, -2.31, 0.01, -1.93, 0.23, -1.42),
    (-1.29, 0.03, 0.16, 13.24, 1.45, -1.20, 2.63, 1.11, -0.36, 1.17, -2.89),
    (0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00),
    (-0.72, 1.32, 0.23, -11.35, 0.38, 0.97, 1.63, -0.61, 0.90, -0.98, 1.38),
)
"""Weights added for bars of two quarters and less."""
_PLACES: Final = ((10.29, 7.33, 16.22, 17.78, -0.34, -0.22, -4.38, -1.43, -0.88, 0.66, -1.09, 2.23, 0.07, -0.30),)
"""Weights with a column for each feature: repetition after a bar, two bars, half a bar and two beats; the file begins
at a bar line, at a beat, between eighths; the first note is at a bar line, the last one at a bar line or a beat;
sixteenths after the bar line; the end after whole bars, at a bar line, at a beat.
"""
_METRES: Final = (
    (3.94, 0.40, 0.91, 3.25, 1.91, -2.26, -3.40, -3.29),
    (-0.67, 23.41, 15.00, 20.05, -8.86, 5.96, -14.15, 12.76),
    (24.17, 29.81, -0.81, 21.42, 11.24, 17.11, -14.22, 4.68),
    (1.01, 0.58, 2.00, 1.82, 2.57, 4.90, 4.28, 2.51),
)
"""Weights with a column for each metre; rows: constant, repetition after a bar, after two bars, and a file that
begins with a bar.
"""


class _Kind(NamedTuple):
    """A candidate metre: numerator and denominator, and the lengths of bar and beat in cells (the smallest unit of
    time).
    """

    numerator: int
    denominator: int
    bar: int
    beat: int

    @property
    def is_compound(self) -> bool:
        return self.denominator == 8

    @property
    def is_triple(self) -> bool:
        return self.bar % 3 == 0


_KINDS: Final = (
    _Kind(2, 4, 8, 4),
    _Kind(3, 4, 12, 4),
    _Kind(4, 4, 16, 4),
    _Kind(3, 8, 6, 2),
    _Kind(6, 8, 12, 6),
    _Kind(9, 8, 18, 6),
    _Kind(12, 8, 24, 6),
    _Kind(3, 2, 24, 8),
)


class Line(NamedTuple):
    """The notes of a channel as parallel arrays: onsets and ends in ticks, and pitches."""

    onset_ticks: Sequence[int]
    end_ticks: Sequence[int]
    pitches: Sequence[int]


class _Signals(NamedTuple):
    """Features of a piece by which metres are guessed: S features and L lines in T cells of time.

    Attributes
    ----------
    values : (S, T) float64
        Each feature centred on 0 and scaled by its spread.
    kinds : (L, T) float64
        For each line the kind of note that begins in each cell; 0: none.
    first, last : int
        Cells of the first and the last onset.
    end : int
        Cell in which the last note ends.
    """

    values: FloatArray
    kinds: FloatArray
    first: int
    last: int
    end: int


def guessed_metres(lines: Sequence[Line], ticks_per_quarter: int) -> tuple[tuple[Metre, ...], int] | None:
    """Guess the metres of a piece and the length of its pickup in ticks, if the notes leave little doubt.

    Parameters
    ----------
    lines : sequence of Line
        Melodic channels with notes, from a file timed in quarters.

    Returns
    -------
    tuple of Metre, int, or None
        Fields of `app.score.model.Score`; None if the notes are ambiguous or in two or four.
    """
    largest = sorted(lines, key=lambda line: len(line.onset_ticks), reverse=True)[:MOST_LINES]
    last_tick = MOST_CELLS * ticks_per_quarter // STEPS
    columns = [_columns(line, last_tick) for line in largest]
    columns = [column for column in columns if column.shape[1]]
    if sum(column.shape[1] for column in columns) < LEAST_NOTES or not _is_on_grid(columns, ticks_per_quarter):
        return None
    found = _likeliest(_candidates(_signals(columns, ticks_per_quarter)))
    if found is None:
        return None
    kind, place = found
    pickup = round(place * ticks_per_quarter / STEPS)
    metres = tuple(Metre(tick, kind.numerator, kind.denominator) for tick in ((0, pickup) if pickup else (0,)))
    return metres, pickup


def _columns(line: Line, last_tick: int) -> IntArray:
    """Return an array (3, N) of onsets, ends and pitches by onset, for notes that begin before a tick."""
    columns = np.array([line.onset_ticks, line.end_ticks, line.pitches], np.int64)
    columns = columns[:, columns[0] < last_tick]
    return np.asarray(columns[:, np.argsort(columns[0], kind="stable")])


def _is_on_grid(columns: Sequence[IntArray], ticks_per_quarter: int) -> bool:
    onsets = np.concatenate([column[0] for column in columns])
    return bool(abs(np.exp(2j * np.pi * STEPS * onsets / ticks_per_quarter).mean()) >= LEAST_ON_GRID)


def _signals(columns: Sequence[IntArray], ticks_per_quarter: int) -> _Signals:
    cells = [np.rint(column[:2] * (STEPS / ticks_per_quarter)).astype(np.int64) for column in columns]
    end = min(max(int(cell[1].max()) for cell in cells), MOST_CELLS)
    last = max(int(cell[0].max()) for cell in cells)
    count = max(end, last) + 1
    sums, kinds, sounding = np.zeros((9, count)), np.zeros((len(columns), count)), np.zeros((12, count + 1))
    for row, (column, (onsets, ends)) in enumerate(zip(columns, cells, strict=True)):
        ends = np.clip(ends, onsets + 1, count)
        np.add.at(sounding, (column[2] % 12, onsets), 1.0)
        np.add.at(sounding, (column[2] % 12, ends), -1.0)
        _add_line(sums, kinds[row], onsets, ends, column[2])
    sums /= len(columns)
    lowest = int(np.argmin([np.median(column[2]) for column in columns]))
    sums[8] = kinds[lowest] != 0.0
    classes = np.cumsum(sounding, axis=1)[:, :-1]
    values = np.vstack([sums, *(_harmony_changes(classes, reach) for reach in (STEPS, 2 * STEPS))])[:, : last + 1]
    usual = values[:, ::2]
    values = np.clip((values - usual.mean(1, keepdims=True)) / (usual.std(1, keepdims=True) + 1e-6), -3.0, 4.0)
    first = min(int(cell[0].min()) for cell in cells)
    return _Signals(values, kinds[:, : last + 1], first, last, end)


def _add_line(sums: FloatArray, kinds: FloatArray, onsets: IntArray, ends: IntArray, pitches: IntArray) -> None:
    """Add to ``sums`` the features of a line's notes by which metres are guessed: onset; long note; note longer than
    the previous one; entry; leap; turning point; note held over; one of the longest notes."""
    at, first = np.unique(onsets, return_index=True)
    top, until = np.maximum.reduceat(pitches, first), np.maximum.reduceat(ends, first)
    steps = np.diff(at, append=max(int(ends.max()), int(at[-1]) + 1))
    usual = float(np.median(steps))
    longer = np.clip(np.log2(steps / usual), -2.0, 2.0)
    before = np.insert(longer[:-1], 0, 0.0)
    moves = np.diff(top, prepend=top[0])
    turns = np.zeros(len(at))
    turns[1:-1] = (moves[1:-1] > 0) & (moves[2:] <= 0)
    held = np.zeros(sums.shape[1] + 1)
    np.add.at(held, onsets + 1, 1.0)
    np.add.at(held, ends, -1.0)
    held = np.cumsum(held)[:-1] > 0.5
    held[at] = False
    sums[0, at] += 1.0
    sums[1, at] += longer
    sums[2, at] += np.clip(longer - before, -2.0, 2.0)
    sums[3, at] += np.insert(at[1:] > until[:-1], 0, True)
    sums[4, at] += np.minimum(np.abs(moves), 12) / 12.0
    sums[5, at] += turns
    sums[6] += held
    sums[7, at] += np.clip(longer, 0.0, 2.0) * (steps >= np.quantile(steps, 0.85))
    kinds[at] = 1.0 + 0.15 * np.clip(np.rint(2.0 * longer), -4, 4) + 0.25 * np.sign(moves)


def _harmony_changes(classes: FloatArray, reach: int) -> FloatArray:
    """Return the difference (T,), 0..1, between the pitch classes in the ``reach`` cells before and after each of T
    cells of time."""
    count = classes.shape[1]
    total = np.cumsum(np.pad(classes, ((0, 0), (reach, reach))), axis=1)[:, : count + 2 * reach]
    before, after = (total[:, k + reach : k + reach + count] - total[:, k : k + count] for k in (0, reach))
    both = (before.sum(0) > 0.0) & (after.sum(0) > 0.0)
    size = np.sqrt((before**2).sum(0) * (after**2).sum(0)) + 1e-9
    changes = np.where(both, 1.0 - (before * after).sum(0) / size, np.nan)
    return np.where(both, changes, np.nanmean(changes) if both.any() else 0.0)


def _alike(kinds: FloatArray, lag: int) -> float:
    """Share, 0..1, of the cells with a note in which the kinds of notes equal those ``lag`` cells earlier."""
    now, before = kinds[:, lag:], kinds[:, :-lag]
    if now.shape[1] < 16:
        return 0.0
    there = (now != 0.0) | (before != 0.0)
    return float((there * (1.0 - np.minimum(np.abs(now - before), 1.0))).sum() / max(int(there.sum()), 1))


def _candidates(signals: _Signals) -> list[tuple[_Kind, int, float]]:
    """Return all candidates (metre, cell of the first bar line) with their probabilities."""
    usual = float(np.mean([_alike(signals.kinds, lag) for lag in USUAL_LAGS]))
    again = {lag: _alike(signals.kinds, lag) - usual for lag in LAGS}
    bars = (signals.last + 1) / (4 * STEPS)
    scale = float(np.clip(np.log2(max(bars, 1.0)) / 5.0, 0.3, 1.2))
    found, scores = [], []
    for number, kind in enumerate(_KINDS):
        cells = np.arange(signals.values.shape[1]) % kind.bar
        counts = np.maximum(np.bincount(cells, minlength=kind.bar), 1)
        folded = np.stack([np.bincount(cells, row, minlength=kind.bar) for row in signals.values]) / counts
        for place in range(kind.bar):
            found.append((kind, place))
            scores.append(_score(np.roll(folded, -place, axis=1), number, place, signals, again, scale))
    odds = np.exp(np.array(scores) - max(scores))
    return [(*one, share) for one, share in zip(found, (odds / odds.sum()).tolist(), strict=True)]


def _score(bar: FloatArray, number: int, place: int, signals: _Signals, again: dict[int, float], scale: float) -> float:
    """Score of a candidate (metre and first bar line) by its fit to the notes; higher is better.

    Parameters
    ----------
    bar : (S, B) float64
        Mean of each feature by cell of the bar.
    number : int
        Index of the metre among the candidates.
    again : dict of int to float
        Repetition after each lag in cells, relative to the piece's general repetition.
    scale : float
        Weight, larger for longer pieces, which have more evidence.
    """
    kind = _KINDS[number]
    down, beats = bar[:, 0], bar[:, kind.beat :: kind.beat].mean(1)
    between = [cell for cell in range(0, kind.bar, 2) if cell % kind.beat]
    others = bar[:, between].mean(1) if between else np.zeros(len(bar))
    half = bar[:, kind.bar // 2] if kind.numerator in (4, 12) else beats
    contrasts = np.stack((down - beats, beats - others, half - beats, down - bar[:, -2]))
    weights = np.array(_CONTRASTS)
    if kind.is_compound:
        weights = weights + np.array(_COMPOUND_CONTRASTS)
    if kind.bar <= 2 * STEPS:
        weights = weights + np.array(_SHORT_CONTRASTS)
    first, last, end = signals.first - place, signals.last - place, signals.end - place
    after_bar, after_two = again[kind.bar], again[2 * kind.bar]
    places = (
        after_bar,
        after_two,
        again.get(kind.bar // 2, 0.0),
        again.get(2 * kind.beat, 0.0),
        place == 0,
        place % kind.beat == 0,
        place % 2 == 1,
        first % kind.bar == 0,
        last % kind.bar == 0,
        last % kind.beat == 0,
        float(bar[0, 1::2].mean() - others[0]),
        signals.end % kind.bar == 0,
        end % kind.bar == 0,
        signals.end % kind.beat == 0,
    )
    own, with_bar, with_two, at_start = (row[number] for row in _METRES)
    evidence = float((weights * contrasts).sum() + np.dot(_PLACES[0], np.array(places, np.float64)))
    return scale * (evidence + with_bar * after_bar + with_two * after_two) + own + at_start * (place == 0)


def _likeliest(candidates: Sequence[tuple[_Kind, int, float]]) -> tuple[_Kind, int] | None:
    """Choose the longest triple metre whose bar lines are probable, with its first bar line; None if there is none."""
    if sum(share for kind, _, share in candidates if kind.is_triple) < TRIPLE_LEAST:
        return None
    likely = []
    for kind, place, share in candidates:
        if kind.is_triple:
            agreeing = sum(other for one, at, other in candidates if one.bar % kind.bar == 0 and at % kind.bar == place)
            if agreeing >= BAR_LINES_LEAST:
                likely.append((kind.bar, share, kind, place))
    if not likely:
        return None
    _, _, kind, place = max(likely, key=lambda one: one[:2])
    return kind, place
