"""Numbering of names that occur more than once."""

from __future__ import annotations

from collections.abc import Callable, Iterable


def numbered(
    names: Iterable[str], taken: Iterable[str] = (), key: Callable[[str], str] = str.casefold
) -> tuple[str, ...]:
    """Return the names in order; repetitions get the first free number appended.

    Parameters
    ----------
    taken : iterable of str
        Names that are already in use.
    key : callable
        Function whose results must differ; by default the name ignoring case.
    """
    used = {key(name) for name in taken}
    last: dict[str, int] = {}
    result = []
    for name in names:
        different, number = name, last.get(key(name), 1)
        while key(different) in used:
            number += 1
            different = f"{name}_{number}"
        last[key(name)] = number
        used.add(key(different))
        result.append(different)
    return tuple(result)
