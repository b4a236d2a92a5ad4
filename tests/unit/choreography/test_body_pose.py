"""Drawn bodies: feet and knees as they were captured, seen from any side."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from app.choreography.body import SEGMENTS
from app.choreography.body_pose import body_pose, knee_caps, t_pose_of
from app.choreography.clip import BodyShape, MotionClip
from app.rig import quaternion
from tests.unit.choreography.test_features import shape
from widgets.dialogs.choreography.body_view import VIEWS, BodyView

SHAPE = shape()

LEFT_KNEE = SEGMENTS.index("leftLowerLeg")


def kneeling(axis: tuple[float, float, float], faces_deg: float = 0.0) -> MotionClip:
    """Bend the left knee about an axis, up to 60 degrees."""
    rotations = np.tile(quaternion.IDENTITY, (30, len(SEGMENTS), 1))
    rotations[:, 0] = quaternion.from_axis_angle((0.0, 1.0, 0.0), math.radians(faces_deg))
    rotations[:, LEFT_KNEE] = quaternion.from_axis_angle(axis, np.linspace(0.0, math.pi / 3.0, 30))
    return MotionClip(SHAPE, Fraction(60), np.tile(SHAPE.offsets_m[:1], (30, 1)), rotations)


@pytest.mark.parametrize("faces_deg", [0.0, 130.0])
def test_knees_point_to_where_they_bend_and_not_along_the_bones_axes(faces_deg: float) -> None:
    assert knee_caps(kneeling((1.0, 0.0, 0.0), faces_deg))[0] == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
    assert knee_caps(kneeling((-1.0, 0.0, 0.0), faces_deg))[0] == pytest.approx((0.0, 0.0, -1.0), abs=1e-6)
    assert knee_caps(kneeling((0.0, 0.0, 1.0), faces_deg))[0] == pytest.approx((-1.0, 0.0, 0.0), abs=1e-6)
    clip = kneeling((1.0, 0.0, 0.0), faces_deg)
    # The right knee never bends: no line is drawn.
    assert not knee_caps(clip)[1].any()
    assert len(body_pose(clip, 0, knee_caps(clip)).knees) == 1


def test_in_t_pose_feet_stand_flat_with_their_toes_where_they_were_captured() -> None:
    for way, sign in (((0.0, -0.05, 0.17), 1.0), ((0.0, -0.05, -0.17), -1.0)):
        ends = SHAPE.ends_m.copy()
        ends[3:] = way
        clip = replace(kneeling((1.0, 0.0, 0.0)), shape=BodyShape.of(SHAPE.offsets_m, ends))
        feet = body_pose(t_pose_of(clip), 0).feet
        assert np.ptp(feet[:, 1:, 1]) == pytest.approx(0.0, abs=1e-9)
        assert np.all(feet[:, 0, 1] > feet[:, 1:, 1].max(axis=1))
        toes, heel = feet[:, 3:5].mean(axis=1), feet[:, [1, 6]].mean(axis=1)
        # Seen from the body's right, what is ahead is at the right.
        ahead = VIEWS["side"].seen(toes) - VIEWS["side"].seen(heel)
        assert np.all(sign * ahead[:, 0] > 0.1)
        assert VIEWS["front"].seen(toes - heel)[:, 0] == pytest.approx([0.0, 0.0], abs=1e-9)


def test_a_view_is_a_rotation_and_follows_the_mouse() -> None:
    points = np.eye(3)
    for view in (*VIEWS.values(), BodyView(2.0, 1.0)):
        seen = view.seen(points)
        assert seen @ seen.T == pytest.approx(np.eye(3))
        assert np.linalg.det(seen) == pytest.approx(1.0)
    # What is near the viewer moves to the right, and down, with the mouse.
    near = np.array([0.0, 0.0, 1.0])
    turned = BodyView().dragged(30.0, 20.0)
    assert turned.seen(near)[0] > 0.1
    assert turned.seen(near)[1] < -0.1
    assert BodyView().dragged(0.0, 10000.0).pitch_rad < math.pi / 2.0
