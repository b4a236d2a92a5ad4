"""Bodies without bone names: those of the same clips with names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from app.choreography.captured_body import captured_body
from app.formats.bvh.read import read_bvh
from app.rig import quaternion
from tests.support.dance_measures import SHARED
from tests.support.rerigged import with_prop, without_names
from tests.unit.choreography.test_command import write_clip
from tests.unit.choreography.test_cuts import arm_swings

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


def test_of_two_branches_of_a_hand_the_one_aside_is_the_thumb(tmp_path: Path) -> None:
    bvh = read_bvh(write_clip(tmp_path / "swings.bvh", arm_swings(60)))
    thumbs: dict[str, int] = {}
    for side, out in (("left", 1.0), ("right", -1.0)):
        for ways in ((2.0 * out, 0.0, 5.0), (8.0 * out, 0.0, 0.0)):
            thumbs.setdefault(f"{side}ThumbMetacarpal", len(bvh.names))
            bvh = with_prop(bvh, f"{side}Hand", [ways])
    found = captured_body(without_names(bvh), "a.bvh").body.joints
    assert {joint: found.get(joint) for joint in thumbs} == thumbs
