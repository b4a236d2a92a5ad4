"""Orders of clips are balanced, and codes reveal nothing."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import pytest

from app.evaluation.design import ClipPair, codes, new_id, orders, pairs_of, williams
from app.evaluation.key import VARIANTS, Variant


@pytest.mark.parametrize("count", range(1, 14))
def test_every_clip_is_equally_often_everywhere_and_before_every_other(count: int) -> None:
    rows = williams(count)
    assert len(rows) == (count if count % 2 == 0 or count == 1 else 2 * count)
    assert all(sorted(row) == list(range(count)) for row in rows)
    at = Counter((place, value) for row in rows for place, value in enumerate(row))
    assert len(at) == count * count
    assert len(set(at.values())) == 1
    before = Counter(pair for row in rows for pair in pairwise(row))
    assert len(before) == count * (count - 1)
    assert len(set(before.values())) <= 1


def clips(variants: tuple[Variant, ...], excerpts: int) -> list[tuple[str, Variant, int]]:
    drawn = codes(len(variants) * excerpts, 3)
    places = [(variant, excerpt) for excerpt in range(1, excerpts + 1) for variant in variants]
    return [(code, variant, excerpt) for code, (variant, excerpt) in zip(drawn, places, strict=True)]


@pytest.mark.parametrize(("variants", "excerpts"), [(VARIANTS, 3), (VARIANTS[:4], 2), (VARIANTS[1:3], 1)])
def test_the_table_of_orders_is_balanced(variants: tuple[Variant, ...], excerpts: int) -> None:
    made = clips(variants, excerpts)
    variant_of = {code: variant for code, variant, _ in made}
    singles, pairs = tuple(code for code, _, _ in made), pairs_of(made)
    table = orders(singles, pairs)
    count = len(singles)
    at = Counter((place, variant_of[shown.left]) for row in table for place, shown in enumerate(row[:count]))
    assert len(at) == count * len(variants)
    assert len(set(at.values())) == 1
    before = Counter(
        (variant_of[one.left], variant_of[other.left]) for row in table for one, other in pairwise(row[:count])
    )
    between = {pair: times for pair, times in before.items() if pair[0] != pair[1]}
    assert len(between) == len(variants) * (len(variants) - 1)
    assert len(set(between.values())) == 1
    for one, other in pairs:
        sides = [
            (place, shown) for row in table for place, shown in enumerate(row) if other in (shown.left, shown.right)
        ]
        turns = Counter(shown for place, shown in sides if place >= count)
        assert turns == {ClipPair(one, other): len(table) // 2, ClipPair(other, one): len(table) // 2}
        places = Counter(place for place, _ in sides if place >= count)
        assert len(places) == len(pairs)
        assert len(set(places.values())) == 1


def test_a_pair_is_of_one_excerpt_and_has_ours_in_it() -> None:
    made = clips(VARIANTS, 3)
    variant_of = {code: variant for code, variant, _ in made}
    excerpt_of = {code: excerpt for code, _, excerpt in made}
    pairs = pairs_of(made)
    assert [variant_of[one] for one, _ in pairs] == ["generated"] * 4
    assert {variant_of[other] for _, other in pairs} == set(VARIANTS) - {"generated"}
    assert all(excerpt_of[one] == excerpt_of[other] for one, other in pairs)
    assert {excerpt_of[one] for one, _ in pairs} == {1, 2, 3}


def test_codes_are_drawn_from_the_seed() -> None:
    assert sorted(codes(12, 1)) == [f"c{number:02d}" for number in range(1, 13)]
    assert codes(12, 1) == codes(12, 1) != codes(12, 2)


def test_an_id_is_never_a_number() -> None:
    for _ in range(200):
        made = new_id()
        assert len(made) == 8
        assert made[0] in "abcdf"
        assert set(made) <= set("0123456789abcdef")
