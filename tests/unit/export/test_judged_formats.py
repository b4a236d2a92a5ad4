"""Every format with a skin is measured, with the same results."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from app.export.report import PlayerReport
from app.export.request import ExportRequest
from app.export.run import export
from app.formats.keys import KeyChoice
from app.formats.usd_package import usd_installed
from app.messages import text
from app.performance.ensemble import Performance
from app.performance.span import bars_span
from tests.gui.conftest import quartet_project

FORMATS = ("glb", "vrma", *(("usd",) if usd_installed() else ()))
Measured = Callable[[str, KeyChoice], PlayerReport]


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Measured:
    """Report on a player whose files have one format only."""
    performance = Performance(quartet_project())
    fps = Fraction(24)
    request = ExportRequest(
        performance=performance,
        players=performance.project.players[:1],
        folder=tmp_path_factory.mktemp("judged"),
        formats=frozenset(),
        span=bars_span(performance, fps, (2, 2)),
        bars=(2, 2),
        source="quartet.mid",
        creator="Suisou test",
        processes=1,
    )
    known: dict[tuple[str, KeyChoice], PlayerReport] = {}

    def report(kind: str, keys: KeyChoice) -> PlayerReport:
        if (kind, keys) not in known:
            folder: Path = request.folder / f"{kind}_{keys}"
            asked = replace(request, folder=folder, formats=frozenset((kind,)), keys=keys)
            (known[kind, keys],) = export(asked, text).players
        return known[kind, keys]

    return report


def _numbers(value: Any, path: str = "") -> dict[str, float]:
    """All numbers of a report's measures by their path."""
    if isinstance(value, dict):
        return {key: number for name, one in value.items() for key, number in _numbers(one, f"{path}/{name}").items()}
    return {path: float(value)} if isinstance(value, int | float) else {}


@pytest.mark.parametrize("keys", ["every", "reduced"])
@pytest.mark.parametrize("kind", FORMATS)
def test_the_measures_are_those_of_fbx(measured: Measured, kind: str, keys: KeyChoice) -> None:
    fbx, other = (measured(one, "every").measures for one in ("fbx", kind))
    assert fbx is not None
    found = measured(kind, keys).measures
    assert found is not None
    assert found.sounding_frames == fbx.sounding_frames > 20
    assert found.contacts
    assert found.contacts.keys() == fbx.contacts.keys()
    if keys == "reduced":
        # Within the tolerance of reduced keys.
        assert all(abs(one.max_mm - fbx.contacts[name].max_mm) < 1.5 for name, one in found.contacts.items())
        return
    assert other is not None
    expected, numbers = (_numbers(msgspec.to_builtins(one)) for one in (fbx, other))
    assert numbers.keys() == expected.keys()
    # Angular accelerations are second differences of the files' single precision.
    off = {
        name: abs(numbers[name] - expected[name])
        for name in expected
        if "acceleration" not in name and name != "/arms/frame"
    }
    worst = max(off, key=lambda name: off[name])
    assert off[worst] < 0.02, worst
    assert np.isclose(numbers["/acceleration/value"], expected["/acceleration/value"], rtol=0.02)
