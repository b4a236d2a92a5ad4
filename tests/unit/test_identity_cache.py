"""Results are kept by identity, and only so many."""

from __future__ import annotations

from app.identity_cache import IdentityCache


def test_the_same_object_gets_the_same_result() -> None:
    cache: IdentityCache[object] = IdentityCache(4)
    key, twin = [1], [1]
    first = cache.get((key,), object)
    assert cache.get((key,), object) is first
    assert cache.get((twin,), object) is not first


def test_the_one_unused_for_longest_goes() -> None:
    cache: IdentityCache[object] = IdentityCache(2)
    a, b, c = object(), object(), object()
    kept, lost = cache.get((a,), object), cache.get((b,), object)
    assert cache.get((a,), object) is kept
    cache.get((c,), object)
    assert cache.get((a,), object) is kept
    assert cache.get((b,), object) is not lost


def test_an_identity_is_never_given_away_while_it_is_kept() -> None:
    cache: IdentityCache[int] = IdentityCache(100)
    results = [cache.get(([number],), lambda number=number: number) for number in range(50)]  # type: ignore[misc]
    assert results == list(range(50))
