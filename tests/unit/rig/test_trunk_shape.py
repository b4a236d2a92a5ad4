"""Shapes of trunks: depths of known points in finished bodies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.rig.characters.character_library import character_named
from app.rig.characters.dressed_characters import character_in
from app.rig.mesh import Mesh
from app.rig.people.wardrobe import OutfitChoice
from app.rig.trunk_shape import ALONG, BEYOND_M, TrunkShape, dressed_shape, trunk_shape


def shape_of(id: str) -> TrunkShape:
    """Return the shape of a character that has one."""
    found = trunk_shape(character_named(id))
    assert found is not None
    return found


@pytest.mark.parametrize("id", ["man_adult", "woman_adult"])
def test_the_middle_of_a_trunk_is_deep_and_the_air_before_it_is_not(id: str) -> None:
    """The joints of the spine lie in the body; half a metre ahead there is nothing."""
    shape, names = shape_of(id), character_named(id).skeleton.names
    inner = [number for number, joint in enumerate(shape.joints) if names[joint] in ("hips", "spine", "chest")]
    assert len(inner) == 3
    for number in inner:
        middle, ahead = shape.depths_m(number, np.array([[0.0, 0.0, 0.02], [0.0, 0.0, 0.5]]))
        assert middle > 0.05
        assert ahead == -BEYOND_M


def test_depth_changes_by_no_more_than_the_way() -> None:
    """From the spine straight ahead the depth falls as the way grows, until it is outside."""
    shape = shape_of("woman_adult")
    number = [character_named("woman_adult").skeleton.names[joint] for joint in shape.joints].index("spine")
    ahead_m = np.linspace(0.09, 0.2, 31)
    depths_m = shape.depths_m(number, np.stack([np.full(31, 0.06), np.full(31, 0.03), ahead_m], axis=1))
    assert depths_m[0] > 0.01
    assert depths_m[-1] < -0.02
    assert (np.diff(depths_m) < 0.0).all()
    assert np.abs(np.diff(depths_m)).max() < 0.008


def test_sleeves_are_thicker_at_the_elbow() -> None:
    """A forearm in a shirt has between two and seven centimetres about its bone."""
    for radii_m in shape_of("man_adult").radii_m.values():
        assert radii_m.shape == ALONG.shape
        assert 0.07 > radii_m[0] > radii_m[-1] > 0.02


def test_outfits_do_not_change_the_shape() -> None:
    """A motion is the same in every outfit: the shape is that of the own clothes."""
    own = character_named("man_adult")
    assert trunk_shape(replace(own, meshes=(), undressed=own)) is trunk_shape(own)
    assert trunk_shape(replace(own, meshes=())) is None


def test_room_before_worn_clothes_is_never_less_and_more_for_a_tunic() -> None:
    own, worn = shape_of("woman_adult"), dressed_shape(character_in("woman_adult", OutfitChoice("marching")))
    assert worn is not None
    assert worn.joints == own.joints
    more_m = []
    for number in range(len(own.joints)):
        low_m, high_m = (corner_m[number, 0] for corner_m in own.bounds_m)
        points_m = np.random.default_rng(number).uniform(low_m + 0.06, high_m - 0.06, (400, 3))
        before_m, after_m = (one.depths_m(number, points_m) + one.room_m for one in (own, worn))
        more_m.append((after_m - before_m)[np.abs(before_m) < 0.03])
    # The points of both grids differ.
    assert np.percentile(np.concatenate(more_m), 2) > -0.006
    assert np.percentile(np.concatenate(more_m), 90) > 0.005
    for side, radii_m in own.radii_m.items():
        assert (worn.radii_m[side] + worn.room_m >= radii_m + own.room_m - 1e-9).all()


def test_the_lap_of_a_long_skirt_that_goes_with_the_shins_too_is_part_of_the_shape() -> None:
    """A centimetre below the cloth is inside, also where shins have a fifth of its weight."""
    character = character_in("cast_sachiko", OutfitChoice("evening"))
    shape, names = dressed_shape(character), character.skeleton.names
    assert shape is not None
    depths_m = []
    for mesh in character.meshes:

        def share(*joints: str, mesh: Mesh = mesh) -> np.ndarray:
            held = np.isin(mesh.joints, [names.index(joint) for joint in joints])
            return np.where(held, mesh.weights, 0.0).sum(axis=1)

        trunk, shins = share("hips", "leftUpperLeg", "rightUpperLeg"), share("leftLowerLeg", "rightLowerLeg")
        front = (trunk > 0.7) & (trunk < 0.88) & (trunk + shins > 0.9) & (mesh.normals[:, 2] > 0.5)
        for thigh in ("leftUpperLeg", "rightUpperLeg"):
            lap = front & (share(thigh) > 0.4)
            to_thigh = character.joint_from_mesh[names.index(thigh)]
            points_m = (mesh.positions_m[lap] - 0.01 * mesh.normals[lap]) @ to_thigh[:3, :3].T + to_thigh[:3, 3]
            depths_m.extend(shape.depths_m(shape.joints.index(names.index(thigh)), points_m))
    assert len(depths_m) > 20
    assert np.median(depths_m) > 0.0
