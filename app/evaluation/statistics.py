"""Statistics of answers: intervals, rank tests, agreement. Values of different viewers are never pooled.

Functions return None instead of NaN for values that cannot be computed, and issue no warnings.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final, Literal

import msgspec
import numpy as np
from scipy import stats

from app.arrays import FloatArray

LEVEL: Final = 0.95
SIGNIFICANT: Final = 0.05
_EXACT: Final = 200
"""Greatest number of differences with exact calculation; the normal approximation is as good for more."""


class Summary(msgspec.Struct, frozen=True):
    """Mean and spread over viewers.

    Attributes
    ----------
    viewers : int
        Number of viewers.
    mean, median : float
        Mean and median over the viewers.
    deviation : float or None
        Standard deviation of the sample; None for a single viewer.
    low, high : float or None
        Confidence interval of the mean at `LEVEL` by Student's t; None for a single viewer. Its width is 0 without
        spread.
    """

    viewers: int
    mean: float
    median: float
    deviation: float | None
    low: float | None
    high: float | None


class Comparison(msgspec.Struct, frozen=True):
    """Differences of two conditions, paired by viewer.

    Attributes
    ----------
    viewers : int
        Number of viewers who judged both.
    differing : int
        Number of viewers with a difference other than zero; only these are ranked.
    mean : float
        Mean difference, first minus second.
    statistic : float or None
        Wilcoxon's signed-rank statistic, the smaller sum of ranks; None if all differences are zero.
    p : float or None
        Two-sided probability.
    effect : float or None
        Matched-pairs rank-biserial correlation, -1 to 1: positive if the first is judged better.
    """

    viewers: int
    differing: int
    mean: float
    statistic: float | None
    p: float | None
    effect: float | None


def summary(values: Sequence[float]) -> Summary | None:
    """Summarise one value per viewer; None if there are no viewers."""
    if not values:
        return None
    given = np.asarray(values, np.float64)
    mean, median = float(given.mean()), float(np.median(given))
    if len(given) == 1:
        return Summary(1, mean, median, None, None, None)
    deviation = float(given.std(ddof=1))
    half = float(stats.t.ppf(0.5 + LEVEL / 2.0, len(given) - 1)) * deviation / math.sqrt(len(given))
    return Summary(len(given), mean, median, deviation, mean - half, mean + half)


def compared(differences: Sequence[float]) -> Comparison | None:
    """Test whether differences, one per viewer, are other than zero (Wilcoxon's signed-rank test); None without
    viewers.

    Zeros are omitted (Wilcoxon's original method). Differences that are equal up to rounding share a rank.
    """
    if not differences:
        return None
    given = np.round(np.asarray(differences, np.float64), 9)
    mean, ranked = float(given.mean()), given[given != 0.0]
    if not len(ranked):
        return Comparison(len(given), 0, mean, None, None, None)
    ranks = stats.rankdata(np.abs(ranked))
    above, below = float(ranks[ranked > 0.0].sum()), float(ranks[ranked < 0.0].sum())
    p = float(_wilcoxon_p(ranked, "two-sided"))
    return Comparison(len(given), len(ranked), mean, min(above, below), p, (above - below) / (above + below))


def lower_p(differences: Sequence[float]) -> float | None:
    """Return the one-sided p of Wilcoxon's signed-rank test that differences are below zero; None if all are zero."""
    given = np.round(np.asarray(differences, np.float64), 9)
    ranked = given[given != 0.0]
    return float(_wilcoxon_p(ranked, "less")) if len(ranked) else None


def _wilcoxon_p(ranked: FloatArray, alternative: Literal["two-sided", "less"]) -> float:
    """Return the p of Wilcoxon's signed-rank test for differences, none of which is zero.

    Exact even with ties, which are usual among means of a few steps: scipy enumerates all signs then, which takes a
    second for 13 viewers, and is not exact for more.
    """
    if len(ranked) > _EXACT:
        return min(1.0, float(stats.wilcoxon(ranked, alternative=alternative, method="approx").pvalue))
    # Doubled, because ranks of ties are multiples of one half.
    doubled = np.rint(2.0 * stats.rankdata(np.abs(ranked))).astype(np.int64)
    chances = np.zeros(int(doubled.sum()) + 1)
    chances[0] = 1.0
    for rank in doubled.tolist():
        # Under the null hypothesis each rank is positive or negative with equal chance.
        chances[rank:] = chances[rank:] + chances[: len(chances) - rank]
        chances *= 0.5
    above = int(doubled[ranked > 0.0].sum())
    below_p, above_p = float(chances[: above + 1].sum()), float(chances[above:].sum())
    return min(1.0, below_p if alternative == "less" else 2.0 * min(below_p, above_p))


def smallest_p(differing: int) -> float:
    """Return the smallest two-sided p that this number of viewers can reach, if all their differences have one sign."""
    return min(1.0, 2.0 ** (1 - differing))


def holm(ps: Sequence[float]) -> list[float]:
    """Correct p values of several comparisons by Holm's method (1979), in the given order."""
    order = sorted(range(len(ps)), key=lambda index: ps[index])
    corrected, least = [0.0] * len(ps), 0.0
    for rank, index in enumerate(order):
        least = max(least, min(1.0, (len(ps) - rank) * ps[index]))
        corrected[index] = least
    return corrected


def ordinal_alpha(ratings: Mapping[object, Sequence[int]]) -> float | None:
    """Compute Krippendorff's alpha for ordinal data (Krippendorff 2011, "Computing Krippendorff's alpha-reliability").

    Parameters
    ----------
    ratings : mapping of unit to sequence of int
        Viewers' ratings of each unit; viewers without a rating are omitted.

    Returns
    -------
    float or None
        1 for full agreement, 0 for chance. None if no unit has two ratings, or all ratings are equal.
    """
    pairable = [given for given in ratings.values() if len(given) > 1]
    values = sorted({value for given in pairable for value in given})
    if len(values) < 2:
        return None
    place = {value: index for index, value in enumerate(values)}
    coincidences = np.zeros((len(values), len(values)))
    for given in pairable:
        counts = np.bincount([place[value] for value in given], minlength=len(values)).astype(np.float64)
        coincidences += (np.outer(counts, counts) - np.diag(counts)) / (len(given) - 1)
    totals = coincidences.sum(axis=1)
    # The distance between two steps is the number of ratings between them, plus half of their own.
    middles = np.cumsum(totals) - totals / 2.0
    distances = np.square(middles[:, None] - middles[None, :])
    expected = float((np.outer(totals, totals) * distances).sum()) / (float(totals.sum()) - 1.0)
    return 1.0 - float((coincidences * distances).sum()) / expected
