"""Positions of texts over the picture."""

from __future__ import annotations

import math

import numpy as np
import pytest
from PySide6.QtCore import QPointF, QRectF

from tests.unit.viewport.poses import posed_stage
from widgets.viewport.camera import Camera
from widgets.viewport.framing import turn_rad
from widgets.viewport.handles import TARGETS, handles
from widgets.viewport.overlay import HANDLE_RADIUS_PX, NAME_UP_M, clear_of, faces

SIZE = (714.0, 262.0)
READING = QRectF(0.0, 0.0, 150.0, 20.0)


@pytest.mark.parametrize("row", [0, 2, 3])
@pytest.mark.parametrize("side_deg", [0.0, -90.0, 90.0])
def test_a_reading_covers_neither_face_name_nor_handle(row: int, side_deg: float) -> None:
    stage = posed_stage()
    place = stage.members[row].world_from_player[:, 3]
    camera = Camera((place[0], 1.4, place[2]), turn_rad(stage, row) + math.radians(side_deg), 0.0, 2.5)
    seen = faces(stage, camera, SIZE)
    over_m = stage.joint_m(row, "head") + np.array([0.0, 0.12 + NAME_UP_M, 0.0])
    (name,), _ = camera.project([over_m], *SIZE)
    taken = [*seen, QRectF(name[0] - 40.0, name[1] - 10.0, 80.0, 20.0)]
    assert len(seen) == 4
    for handle in handles(stage, row):
        (at,), _ = camera.project([handle.at_m], *SIZE)
        box = clear_of(READING, QPointF(*at), taken, SIZE)
        assert QRectF(0.0, 0.0, *SIZE).contains(box), handle.target
        assert not any(box.intersects(other) for other in taken), handle.target
        assert not box.intersects(QRectF(at[0] - HANDLE_RADIUS_PX, at[1] - HANDLE_RADIUS_PX, 26.0, 26.0)), handle.target
    assert len(handles(stage, row)) == len(TARGETS)


def test_a_reading_is_over_its_handle_where_nothing_is_in_the_way() -> None:
    box = clear_of(READING, QPointF(300.0, 200.0), (), SIZE)
    assert box.size() == READING.size()
    assert box.center().x() == 300.0
    assert box.bottom() < 200.0 - HANDLE_RADIUS_PX
