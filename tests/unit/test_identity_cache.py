"""Results are cached by the identity of their inputs, up to a number."""

from __future__ import annotations

import pytest

from app.identity_cache import IdentityCache


def _made(key: object) -> list[object]:
    return [key]


def test_the_same_object_gets_the_same_result() -> None:
    cache: IdentityCache[list[object]] = IdentityCache(4)
    key, twin = [1], [1]
    first = cache.step(_made, key)
    assert first == [key]
    assert cache.step(_made, key) is first
    assert cache.step(_made, twin) is not first
    assert cache.has(key)
    assert not cache.has([1])


def test_the_one_unused_for_longest_goes() -> None:
    cache: IdentityCache[list[object]] = IdentityCache(2)
    a, b, c = object(), object(), object()
    kept, lost = cache.step(_made, a), cache.step(_made, b)
    assert cache.step(_made, a) is kept
    cache.step(_made, c)
    assert cache.step(_made, a) is kept
    assert cache.step(_made, b) is not lost


def test_an_identity_is_never_given_away_while_it_is_kept() -> None:
    cache: IdentityCache[list[object]] = IdentityCache(100)
    results = [cache.step(_made, [number]) for number in range(50)]
    assert results == [[[number]] for number in range(50)]


def test_help_is_given_and_is_no_part_of_the_key() -> None:
    cache: IdentityCache[tuple[str, object]] = IdentityCache(4)
    key = object()
    assert cache.helped(lambda help, given: (help, given), "a", key) == ("a", key)
    assert cache.helped(lambda help, given: (help, given), "b", key) == ("a", key)


def test_a_function_that_reads_more_than_its_inputs_is_refused() -> None:
    cache: IdentityCache[object] = IdentityCache(4)
    more = object()
    with pytest.raises(TypeError, match="reads more than its arguments"):
        cache.step(lambda key: (key, more), object())
