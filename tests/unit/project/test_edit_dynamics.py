"""Controller curves: set and corrected by the user."""

from __future__ import annotations

import numpy as np
import pytest

from app.errors import UsageError
from app.project.edit.dynamics import change_level, set_dynamics
from app.project.model import Project
from app.score.model import ControllerCurve
from tests.unit.audio.pieces import melody, piece


def project() -> Project:
    curves = (ControllerCurve("expression", (0,), (0.4,)), ControllerCurve("volume", (0,), (1.0,)))
    return piece(melody((0, 960, 60), (960, 960, 62), (1920, 960, 64), curves=curves))


def value(given: Project, tick: int, kind: str = "expression") -> float:
    curve = next(one for one in given.score.parts[0].curves if one.kind == kind)
    return curve.values[int(np.searchsorted(curve.ticks, tick, side="right")) - 1]


def test_a_curve_takes_the_place_of_its_kind_alone() -> None:
    part_id = project().score.parts[0].id
    after = set_dynamics(project(), {part_id: ControllerCurve("expression", (0, 960), (0.2, 0.9))})
    assert value(after, 1000) == 0.9
    assert value(after, 1000, "volume") == 1.0
    assert set_dynamics(after, {}) is after


def test_a_correction_holds_in_its_span_and_blends_back() -> None:
    before = project()
    after = change_level(before, before.players[0].id, "expression", [(960, 1920)], 0.3, 0.5)
    assert value(after, 1440) == pytest.approx(0.7, abs=0.01)
    assert value(after, 100) == 0.4
    assert value(after, 2800) == 0.4
    assert 0.4 < value(after, 1920 + 120) < 0.7
    most = change_level(before, before.players[0].id, "expression", [(960, 1920)], 3.0, 0.5)
    assert value(most, 1440) == 1.0
    assert change_level(before, before.players[0].id, "expression", [], 0.3, 0.5) is before
    with pytest.raises(UsageError, match=r"dynamics\.no_curve"):
        change_level(before, before.players[0].id, "bite", [(0, 1)], 0.3, 0.5)
