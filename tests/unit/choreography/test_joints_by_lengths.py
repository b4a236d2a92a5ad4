"""Bodies without bone names: those of the same clips with names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from app.choreography.captured_body import captured_body
from app.formats.bvh.read import read_bvh
from app.rig import quaternion
from tests.support.dance_measures import SHARED
from tests.support.rerigged import without_names

CLIPS = sorted((SHARED / "mocap").glob("animateddrawings_*.bvh"))


@pytest.mark.skipif(not CLIPS, reason="no clips")
@pytest.mark.parametrize("path", CLIPS, ids=lambda path: path.stem)
def test_arms_and_thumbs_are_found_without_names(path: Path) -> None:
    """A collar bone as long as a forearm is no upper arm; of two branches of a hand the one aside is the thumb."""
    bvh = read_bvh(path)
    named, found = captured_body(bvh, "a.bvh"), captured_body(without_names(bvh), "a.bvh")
    arms = {joint for joint in named.body.joints if joint.endswith(("Arm", "Hand", "ThumbMetacarpal"))}
    assert {joint: found.body.joints.get(joint) for joint in arms} == {
        joint: named.body.joints[joint] for joint in arms
    }
    for joint, turn in named.t_pose.items():
        apart = quaternion.multiply(quaternion.conjugate(turn), found.t_pose[joint])
        off_deg = np.rad2deg(np.linalg.norm(quaternion.to_rotation_vector(apart), axis=-1))
        assert np.max(off_deg) < 3.0, joint
