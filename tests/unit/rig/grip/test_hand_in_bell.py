"""The hand in a horn's bell is nowhere seen from outside, through the metal."""

from __future__ import annotations

import numpy as np
import pytest

from app.rig import quaternion, skinning
from app.rig.characters.character_library import character_named
from app.rig.grip.finger_poses import finger_rotations
from app.rig.grip.fitting.grip_files import hold_for
from app.rig.grip.grip_pose import hand_targets
from app.rig.model import InstrumentModel
from app.rig.skeleton import forward
from instrument_maps.load import bundled_maps
from metadata.load import load_body
from resources.build import instrument_horn
from tests.support.deformed import deform
from tests.support.models import bundled_instrument

NEAR_M, DEEP_M = 0.02, 0.16
"""Distances from the rim between which hand and metal are compared."""
WALL_M = (-0.0003, 0.005)
"""Bounds of the outer wall about the nominal one; the inner wall is inside them, tubes of the coil are outside."""


def about_axis(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances of points (N, 3) in the root frame from the rim, inwards, and from the bell's axis, metres."""
    bell = instrument_horn.hand()
    off = points - bell.centre
    depth = -off @ bell.out
    return depth, np.linalg.norm(off + depth[:, None] * bell.out, axis=1)


def outer_wall(model: InstrumentModel) -> tuple[np.ndarray, np.ndarray]:
    """Distances from the rim, and radii of the metal's outer side there, of the rings of a model's vertices."""
    depth, radius = about_axis(np.concatenate([mesh.positions_m for mesh in model.meshes]))
    off = radius - instrument_horn.BELL.radius(np.maximum(depth, 0.0))
    own = (depth > 0.0) & (depth < 2.0 * DEEP_M) & (off > WALL_M[0]) & (off < WALL_M[1])
    places = np.round(depth[own], 3)
    rings = np.unique(places)
    return rings, np.array([radius[own][places == ring].max() for ring in rings])


@pytest.mark.parametrize("body", ["man_adult", "woman_adult"])
@pytest.mark.parametrize("name", ["horn_F_single", "horn_double_F_Bb"])
def test_no_skin_shows_outside_the_bell(body: str, name: str) -> None:
    instrument, character = bundled_maps()[name], character_named(body)
    model = bundled_instrument(instrument)
    hold = hold_for(character, model, instrument, load_body())
    rotations = np.tile(quaternion.IDENTITY, (1, len(character.skeleton.names), 1))
    rotations[:, list(hold.finger_joints)] = finger_rotations(hold, {}, 1)
    joints = forward(character.skeleton, rotations)
    hand = next(one for one in hold.hands if one.side == "right")
    mark = character.landmarks["right.hand"]
    skin = deform(skinning.patch(character, skinning.mesh_named(character, mark.mesh), mark.vertices), joints)[0]
    wrist, _ = joints.of(character.skeleton.index("rightHand"))
    place, turn = hand_targets(hand, np.zeros((1, 3)), quaternion.IDENTITY[None], {}, {})
    depth, radius = about_axis(place + quaternion.rotate(turn, skin - wrist))
    seen = (depth > NEAR_M) & (depth < DEEP_M)
    assert np.count_nonzero(seen) > 500
    through_mm = 1000.0 * (radius[seen] - np.interp(depth[seen], *outer_wall(model)))
    assert through_mm.max() < 0.0
