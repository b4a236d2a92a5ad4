"""Statistics compared with published examples, scipy, and slow direct calculations."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from app.evaluation.statistics import compared, holm, lower_p, ordinal_alpha, smallest_p, summary

# Darwin's cross- and self-fertilised maize (Fisher 1935; Cureton 1967; the example of scipy's documentation).
MAIZE = [6, 8, 14, 16, 23, 24, 28, 29, 41, -48, 49, 56, 60, -67, 75]
# Hamilton's depression factor after tranquilliser minus before (Hollander & Wolfe 1973, table 3.1; R's ?wilcox.test).
DEPRESSION = np.subtract(
    [0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29], [1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30]
)
# Hours of sleep gained, first minus second drug (Student 1908; R's `sleep`).
SLEEP = [-1.2, -2.4, -1.3, -1.3, 0.0, -1.0, -1.8, -0.8, -4.6, -1.4]
# Four coders, twelve units ("C" data, Krippendorff 2011); a point is a missing rating.
CODERS = "11.1 2232 3333 3333 2222 1234 4444 1121 2222 .555 ..11 ..3."
# Five coders, forty items (Hayes & Krippendorff 2007, table 1).
ITEMS = (
    "112.2 1101. 2333. .00.0 000.0 000.0 102.1 1.20. 222.2 2111. .100. 0000. 1222. 33223 111.1 111.1 212.2 1233. "
    "1101. 000.0 0011. 00.00 2333. 0000. 12.22 0111. 00010 1212. 1122. 112.2 110.0 2121. 22.22 3222. 222.2 223.2 "
    "222.2 22.12 2222. 111.1"
)

steps = st.lists(st.integers(-4, 4), min_size=1, max_size=9)


def units(rows: str) -> dict[int, list[int]]:
    return {index: [int(value) for value in row if value != "."] for index, row in enumerate(rows.split())}


def test_wilcoxon_of_darwins_maize() -> None:
    found = compared(MAIZE)
    assert (found.viewers, found.differing, found.statistic) == (15, 15, 24.0)
    assert found.p == pytest.approx(0.041259765625, abs=1e-12)
    # (96 - 24) / 120, the matched-pairs rank-biserial correlation by its definition (Kerby 2014).
    assert found.effect == pytest.approx(0.6)


def test_wilcoxon_of_hollander_and_wolfe() -> None:
    assert lower_p(DEPRESSION.tolist()) == pytest.approx(0.01953, abs=5e-6)
    found = compared(DEPRESSION.tolist())
    assert found.statistic == 5.0


@given(steps)
def test_wilcoxon_with_ties_is_the_count_of_all_signs(differences: list[int]) -> None:
    found, left = compared(differences), [value for value in differences if value]
    assert found.mean == pytest.approx(sum(differences) / len(differences))
    if not left:
        assert (found.p, found.effect, found.differing) == (None, None, 0)
        return
    ranks = stats.rankdata(np.abs(left))
    above = ranks[np.array(left) > 0].sum()
    sums = [sum(itertools.compress(ranks, signs)) for signs in itertools.product((0, 1), repeat=len(left))]
    higher, lower = np.mean([value >= above for value in sums]), np.mean([value <= above for value in sums])
    assert found.p == pytest.approx(min(1.0, 2.0 * min(higher, lower)))
    assert lower_p(differences) == pytest.approx(lower)
    assert found.p >= smallest_p(len(left)) - 1e-12


@pytest.mark.parametrize("count", [2, 7, 20, 50])
def test_wilcoxon_without_ties_is_scipys(count: int) -> None:
    differences = np.random.default_rng(count).normal(0.3, 1.0, count).tolist()
    found = compared(differences)
    assert found.p == pytest.approx(stats.wilcoxon(differences, method="exact").pvalue)
    assert found.statistic == stats.wilcoxon(differences).statistic


def test_wilcoxon_goes_over_into_the_normal_approximation() -> None:
    drawn = np.random.default_rng(3).integers(-3, 5, 800)
    few, many = drawn[drawn != 0][:200], drawn[drawn != 0][:201]
    for differences in (few, many):
        found = compared(differences.tolist())
        assert found.p == pytest.approx(stats.wilcoxon(differences, method="approx").pvalue, abs=2e-4)


def test_equal_means_of_different_sums_share_a_rank() -> None:
    third, same = 1.0 / 3.0, 4.0 - 11.0 / 3.0
    assert third != same
    found = compared([third, same, -third])
    assert found.statistic == 2.0


def test_interval_of_students_sleep() -> None:
    found = summary(SLEEP)
    assert (found.low, found.high) == pytest.approx((-2.4598858, -0.7001142), abs=1e-7)
    assert (found.mean, found.median, found.deviation) == pytest.approx((-1.58, -1.3, 1.2299955), abs=1e-7)


def test_what_cannot_be_computed_is_none() -> None:
    assert summary([]) is compared([]) is None
    one = summary([4.0])
    assert (one.mean, one.median, one.deviation, one.low, one.high) == (4.0, 4.0, None, None, None)
    same = summary([3.0, 3.0, 3.0])
    assert (same.deviation, same.low, same.high) == (0.0, 3.0, 3.0)
    assert lower_p([0.0, 0.0]) is None
    assert ordinal_alpha({}) is ordinal_alpha({"a": [3], "b": [4]}) is ordinal_alpha({"a": [3, 3], "b": [3, 3]}) is None


def test_holm_is_rs() -> None:
    # p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm") in R.
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([]) == []
    assert holm([0.7, 0.9]) == [1.0, 1.0]


def test_alpha_of_krippendorff_2011() -> None:
    assert ordinal_alpha(units(CODERS)) == pytest.approx(0.815, abs=5e-4)


def test_alpha_of_hayes_and_krippendorff_2007() -> None:
    assert ordinal_alpha(units(ITEMS)) == pytest.approx(0.7598, abs=5e-5)


@given(st.lists(st.lists(st.integers(1, 5), max_size=5), max_size=6))
def test_alpha_is_that_of_pairs_of_ratings(given_ratings: list[list[int]]) -> None:
    """By the definition: observed over expected distance of pairs of ratings, one pair after another."""
    ratings = [rating for rating in given_ratings if len(rating) > 1]
    everything = [value for rating in ratings for value in rating]
    found = ordinal_alpha(dict(enumerate(given_ratings)))
    if len(set(everything)) < 2:
        assert found is None
        return
    counts = {value: everything.count(value) for value in set(everything)}

    def distance(one: int, other: int) -> float:
        low, high = min(one, other), max(one, other)
        between = sum(count for value, count in counts.items() if low <= value <= high)
        return float(between - (counts[low] + counts[high]) / 2) ** 2

    observed = sum(
        distance(one, other) / (len(rating) - 1)
        for rating in ratings
        for one, other in itertools.permutations(rating, 2)
    )
    expected = sum(distance(one, other) for one, other in itertools.permutations(everything, 2))
    assert found is not None
    assert math.isclose(found, 1.0 - observed / (expected / (len(everything) - 1)), abs_tol=1e-9)
