"""Prints what the worst small files cost: CPU seconds and MB, by reader and size.

``python -m tests.fuzz.harness.table [KIND ...]``; every file is read in a process that is measured (`child`).
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from tests.fuzz.harness.campaign import SIZES, Child, Result
from tests.fuzz.harness.costly import ALL_COSTLY
from tests.fuzz.harness.readers import KINDS

GOAL_CPU_S: Final = 5.0
GOAL_MB: Final = 1024.0


class Cost(NamedTuple):
    """Cost of reading a file of one kind and size."""

    kind: str
    way: str
    size: int
    result: Result

    @property
    def is_beyond(self) -> bool:
        """Return whether it costs more than the goal or fails."""
        result = self.result
        return bool(result.failure) or result.cpu_s > GOAL_CPU_S or result.peak_mb > GOAL_MB

    def __str__(self) -> str:
        result = self.result
        said = result.failure or result.place or result.outcome
        mark = "  <-- beyond" if self.is_beyond else ""
        return (
            f"{self.kind:>16} {self.size // 1000:4} KB {result.cpu_s:7.2f} s {result.peak_mb:6.0f} MB  "
            f"{self.way}: {said}{mark}"
        )


def costs(kind: str, sizes: Sequence[int] = SIZES) -> Iterator[Cost]:
    """Read every costly file of a kind."""
    with Child([kind]) as child:
        for way, make in ALL_COSTLY[kind].items():
            for size in sizes:
                yield Cost(kind, way, size, child.run(kind, make(size)))


def worst(found: Sequence[Cost]) -> list[Cost]:
    """The costliest of each size, by time and by memory; and every one beyond the goal."""
    chosen = {id(one): one for one in found if one.is_beyond}
    for size in dict.fromkeys(one.size for one in found):
        of_size = [one for one in found if one.size == size]
        for one in (max(of_size, key=lambda one: one.result.cpu_s), max(of_size, key=lambda one: one.result.peak_mb)):
            chosen[id(one)] = one
    return sorted(chosen.values(), key=lambda one: (one.size, -one.result.cpu_s))


def main(kinds: Sequence[str]) -> None:
    """Print the table of some kinds, of all by default."""
    for kind in kinds or [kind for kind in KINDS if kind in ALL_COSTLY]:
        for one in worst(list(costs(kind))):
            print(one, flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
