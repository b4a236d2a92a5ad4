"""A cache limited in bytes, compared with a list in order of use."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from app.formats.fbx.byte_cache import ByteCache

MOST, LARGEST = 20, 12


@given(st.lists(st.tuples(st.booleans(), st.integers(0, 6)), max_size=60))
def test_it_keeps_what_was_used_last_and_has_room(steps: list[tuple[bool, int]]) -> None:
    cache = ByteCache[int, str](MOST, LARGEST)
    used: list[int] = []
    for keeps, key in steps:
        size = 2 * key + 1
        if keeps:
            cache.keep(key, str(key), size)
            if size <= LARGEST and key not in used:
                used.append(key)
                while sum(2 * one + 1 for one in used) > MOST:
                    del used[0]
        else:
            assert cache.get(key) == (str(key) if key in used else None)
            if key in used:
                used.append(used.pop(used.index(key)))
