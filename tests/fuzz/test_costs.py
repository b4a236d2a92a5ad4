"""Test the cost of the worst small files, of every reader and every known way: ``./test --fuzz`` alone, as it is
slow."""

from __future__ import annotations

import pytest

from tests.fuzz.harness.costly import ALL_COSTLY
from tests.fuzz.harness.readers import KINDS
from tests.fuzz.harness.table import costs, worst

LEAST_MINUTES = 5.0
"""Minutes of an attack below which these files are tested only in small versions, by `test_found`."""


@pytest.mark.fuzz
@pytest.mark.parametrize("kind", ALL_COSTLY)
def test_the_worst_files_keep_within_the_bounds(
    kind: str, pytestconfig: pytest.Config, record_property: object
) -> None:
    if pytestconfig.getoption("--fuzz") < LEAST_MINUTES:
        pytest.skip("takes minutes")
    assert callable(record_property)
    found = list(costs(kind))
    for cost in worst(found):
        record_property("fuzz", str(cost))
    failed = [f"{cost}\n{cost.result.detail}" for cost in found if cost.result.failure]
    assert not failed, "\n\n".join(failed)


def test_every_costly_file_has_a_reader() -> None:
    """The other way round, too, but for journals: what they hold is bounded as a project is."""
    assert ALL_COSTLY.keys() ^ KINDS.keys() == {"journal"}
