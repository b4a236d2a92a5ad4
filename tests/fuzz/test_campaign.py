"""Mutants of every kind of file: each is read or refused, at little cost, and what is read can be saved and played.

Six seconds in all; ``./test --fuzz 30`` takes thirty. What fails is made smaller and kept in ``tests/data/hostile``,
where `test_found` reads it ever after.
"""

from __future__ import annotations

import pytest

from tests.fuzz.harness.campaign import SIZES, Tally, attack, keep, minimised
from tests.fuzz.harness.readers import GROUPS, KINDS

MOST_KEPT = 5
"""Greatest number of failures per kind that are reduced and kept; more would have the same cause."""


@pytest.mark.fuzz
@pytest.mark.parametrize("group", GROUPS)
def test_nothing_but_a_refusal_escapes(group: str, pytestconfig: pytest.Config, record_property: object) -> None:
    assert callable(record_property)
    kinds = [name for name, kind in KINDS.items() if kind.group == group]
    seed = pytestconfig.getoption("--fuzz-seed")
    tallies = attack(kinds, pytestconfig.getoption("--fuzz") * 60.0 / len(GROUPS), seed)
    for kind, tally in tallies.items():
        record_property("fuzz", _row(kind, tally))
    reported = [
        _kept(kind, failure, tally) for kind, tally in tallies.items() for failure in list(tally.failures)[:MOST_KEPT]
    ]
    assert not reported, "\n\n".join(reported)
    assert all(tally.tries for tally in tallies.values())


def _kept(kind: str, failure: str, tally: Tally) -> str:
    count, data, result = tally.failures[failure]
    path = keep(kind, minimised(kind, data, failure))
    return (
        f"{kind}: {failure} ({count} times); kept as {path}\n{result.detail}\n"
        f"again: python -m pytest tests/fuzz/test_found.py -k {path.stem}"
    )


def _row(kind: str, tally: Tally) -> str:
    failed = sum(count for count, _, _ in tally.failures.values())
    worst = "; ".join(
        f"{size // 1000} KB {rows['cpu_s'][0]:.2f} s {rows['peak_mb'][0]:.0f} MB"
        for size in SIZES
        if (rows := tally.worst.get(size)) and {"cpu_s", "peak_mb"} <= set(rows)
    )
    return (
        f"{kind:>18}: {tally.tries:7} files, {tally.accepted:7} read, {tally.refused:7} refused, "
        f"{failed:4} failed; most up to {worst}"
    )
