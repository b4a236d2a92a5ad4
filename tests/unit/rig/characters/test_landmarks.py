"""Landmarks found from geometry equal the bundled characters' named ones."""

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from numpy.typing import ArrayLike

from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.characters.landmarks import found_landmarks
from app.rig.characters.t_pose import heaviest
from app.rig.figure import Figure
from app.rig.grip.lips import fit_lips
from app.rig.mesh import Mesh, Morph
from app.rig.model import Character
from app.rig.skeleton import JointTransforms, forward, rest_positions
from app.rig.skinning import landmark_positions, mesh_named, patch, skin_matrices
from instrument_maps.load import bundled_maps
from metadata.load import load_body

TOLERANCE_M = {"thumb": 0.008, "pad": 0.006, "side": 0.006, "palm": 0.006, "lips": 0.008, "sole": 0.03}


def normal(character: Character, name: str, transforms: JointTransforms) -> np.ndarray:
    """Mean outward normal (3,) of a landmark in the first frame."""
    landmark = character.landmarks[name]
    part = patch(character, mesh_named(character, landmark.mesh), landmark.vertices)
    turns = skin_matrices(part.joints, part.joint_from_mesh, transforms)[0, :, :, :3]
    mean: np.ndarray = np.einsum("vj,jab,vb->a", part.weights, turns, part.normals)
    return mean / np.linalg.norm(mean)


@pytest.mark.parametrize("id", bundled_characters())
def test_what_is_found_lies_on_what_is_named(id: str) -> None:
    named = character_named(id)
    found = found_landmarks(named.skeleton, named.joint_from_mesh, named.meshes)
    assert set(named.landmarks) <= set(found)
    bare = Character(named.id, named.skeleton, named.joint_from_mesh, named.meshes, found)
    still = forward(named.skeleton, np.tile([0.0, 0.0, 0.0, 1.0], (1, len(named.skeleton.names), 1)))
    names = sorted(name for name in named.landmarks if not name.endswith(".hand"))
    off = np.linalg.norm(landmark_positions(bare, names, still) - landmark_positions(named, names, still), axis=2)[0]
    for name, distance in zip(names, off, strict=True):
        bound = next(bound for part, bound in TOLERANCE_M.items() if part in name)
        assert distance <= bound, name
    # Thumbs point their own way in every rig: only the fingers' pads are sure to face as named.
    pads = [name for name in names if name.endswith(".pad") and "thumb" not in name]
    alike = [float(normal(bare, name, still) @ normal(named, name, still)) for name in pads]
    assert np.degrees(np.arccos(np.clip(alike, -1.0, 1.0))).max() < 35.0


NOSE = ((0.20, 0.07), (0.11, 0.10), (0.09, 0.095), (0.06, 0.12), (0.05, 0.122), (0.018, 0.095), (-0.012, 0.09))
"""Profile of a head with few vertices, as height and distance in front of its joint: forehead, brow, nose, its base,
chin.
"""
WIDE_CHIN = (
    *((0.447, 0.0), (0.428, 0.059), (0.38, 0.113), (0.315, 0.15), (0.241, 0.154), (0.159, 0.174)),
    *((0.129, 0.184), (0.107, 0.169), *6 * ((0.041, 0.151),), (0.022, 0.127), (-0.004, 0.024)),
)
"""Profile of a large head without a vertex between the nose's base and the edge of the chin (Quaternius' knight)."""
FULL_LIPS = (
    *((0.43, -0.1), (0.37, -0.015), (0.356, 0.078), (0.324, -0.128), (0.258, 0.147), (0.141, 0.145), (0.112, 0.151)),
    *((0.088, 0.162), (0.047, 0.139), (0.039, 0.136), (0.008, 0.035), (-0.006, 0.108)),
)
"""Profile of a head with a bun, and with lips nearer to the nose's tip than to the chin (Babylon.js' girl)."""
BALL = tuple((0.22 * float(np.cos(turn)) + 0.1, 0.22 * float(np.sin(turn))) for turn in np.linspace(0.1, 3.0, 20))
COLLAR = ((0.03, -0.04), (-0.09, 0.11), (-0.10, 0.11))


@pytest.mark.parametrize(
    ("profile", "lips"),
    [
        (NOSE, (-0.01, 0.02)),
        (WIDE_CHIN, (0.06, 0.09)),
        (FULL_LIPS, (0.03, 0.05)),
        (BALL, (-0.06, 0.05)),
        ((*BALL[:13], *COLLAR), (0.0, 0.15)),
    ],
    ids=["nose", "wide chin", "full lips", "ball", "collar"],
)
def test_a_still_face_of_few_vertices_has_its_mouth_below_the_nose(
    profile: tuple[tuple[float, float], ...], lips: tuple[float, float]
) -> None:
    """There is no vertex at the lips; neither the tip of the nose, which is nearest, nor a collar is used."""
    body = character_named("woman_adult")
    points = np.array([(0.0, up, ahead) for up, ahead in profile] + [(side, 0.1, -0.1) for side in (-0.08, 0.08)] * 4)
    mesh = on_head(body, "head", points)
    still = np.tile(np.eye(4), (len(body.skeleton.names), 1, 1))
    still[:, :3, 3] = -rest_positions(body.skeleton)
    found = found_landmarks(body.skeleton, still, (mesh,))
    height_m = float(points[found["lips.contact"].vertices, 1].mean())
    assert lips[0] < height_m < lips[1]


def test_a_face_is_told_from_the_underside_of_its_chin() -> None:
    """Two meshes: a face of few vertices, and the skin below it back to the neck, which has more."""
    body = character_named("woman_adult")
    face = on_head(body, "face", [(0.0, 0.24, 0.13), (0.0, 0.14, 0.16), (0.0, 0.06, 0.15), (0.0, -0.02, 0.13)])
    under = [(0.0, up, ahead) for up, ahead in ((-0.021, 0.12), (-0.028, 0.121), (-0.05, 0.03), (-0.06, 0.03))]
    still = np.tile(np.eye(4), (len(body.skeleton.names), 1, 1))
    still[:, :3, 3] = -rest_positions(body.skeleton)
    found = found_landmarks(body.skeleton, still, (on_head(body, "under", under), face))
    assert found["lips.contact"].mesh == "face"


DRAWN = [(side, up, 0.12) for up in (0.02, 0.04, -0.015, -0.07, 0.08) for side in (-0.02, 0.0, 0.02)]
SLIT = [(side, up, 0.121) for up in (0.0005, -0.0005) for side in (-0.003, 0.0, 0.003)]


@pytest.mark.parametrize(("opens_m", "jaw"), [(0.022, "jawOpen"), (0.001, "")], ids=["opens", "hardly opens"])
def test_a_drawn_mouth_opens_upwards_and_downwards(opens_m: float, jaw: str) -> None:
    """A slit whose shape moves both lips and nothing else; a shape that leaves it shut does not set the lips apart."""
    body = character_named("woman_adult")
    slit = np.arange(len(DRAWN), len(DRAWN) + len(SLIT), dtype=np.int32)
    opened = np.array([(0.0, 0.5 * opens_m if up > 0.0 else -0.5 * opens_m, 0.0) for _, up, _ in SLIT], np.float32)
    morph = Morph("jawOpen", slit, opened, None)
    mesh = replace(on_head(body, "face", [*DRAWN, *SLIT]), morphs=(morph,))
    still = np.tile(np.eye(4), (len(body.skeleton.names), 1, 1))
    still[:, :3, 3] = -rest_positions(body.skeleton)
    found = found_landmarks(body.skeleton, still, (mesh,))
    person = replace(body, joint_from_mesh=still, meshes=(mesh,), landmarks=found)
    lips = fit_lips(person, bundled_maps()["flute"], load_body())
    assert lips.jaw == jaw
    if jaw:
        assert set(found["lips.contact"].vertices) <= set(slit.tolist())
        assert lips.gap_rest_m == pytest.approx(0.001, abs=2e-4)
        assert lips.gap_deltas_m[jaw] == pytest.approx(0.022, abs=0.003)


def test_a_sole_is_what_stands_with_the_foot() -> None:
    """Half of the lowest vertices move with the shin by a part, as in a boot whose shaft reaches the floor."""
    body = character_named("woman_adult")
    foot, shin = body.skeleton.index("leftFoot"), body.skeleton.index("leftLowerLeg")
    place = rest_positions(body.skeleton)[foot]
    points = [(0.01 * step, 0.001 * step - place[1], 0.0) for step in range(6)]
    boot = on_head(body, "boot", points)
    weights = np.array([[1.0, 0.0]] * 3 + [[0.6, 0.4]] * 3, np.float32)
    joints = np.tile(np.array([foot, shin], np.int32), (6, 1))
    boot = replace(boot, positions_m=(place + np.asarray(points)).astype(np.float32), joints=joints, weights=weights)
    still = np.tile(np.eye(4), (len(body.skeleton.names), 1, 1))
    still[:, :3, 3] = -rest_positions(body.skeleton)
    sole = found_landmarks(body.skeleton, still, (boot,))["left.foot.sole"]
    assert sole.vertices.tolist() == [0, 1, 2]


def on_head(body: Character, name: str, points: ArrayLike) -> Mesh:
    """Mesh of vertices (V, 3) in the head's frame that move with the head and face forwards."""
    head, count = body.skeleton.index("head"), len(np.asarray(points))
    return replace(
        body.meshes[0],
        name=name,
        positions_m=(rest_positions(body.skeleton)[head] + np.asarray(points)).astype(np.float32),
        normals=np.tile(np.float32([0.0, 0.0, 1.0]), (count, 1)),
        uvs=np.zeros((count, 2), np.float32),
        triangles=np.array([[0, 1, 2]], np.int32),
        triangle_materials=np.zeros(1, np.int32),
        joints=np.full((count, 1), head, np.int32),
        weights=np.ones((count, 1), np.float32),
        morphs=(),
    )


def test_a_vertex_is_held_by_the_bone_with_most_of_its_weight() -> None:
    mesh = SimpleNamespace(
        positions_m=np.arange(9.0).reshape(3, 3),
        weights=np.array([[0.2, 0.8], [0.7, 0.3], [0.5, 0.5]]),
        joints=np.array([[4, 9], [4, 9], [7, 2]]),
    )
    points, bones = heaviest(cast(Figure, SimpleNamespace(meshes=(mesh, mesh))))
    assert points.tolist() == 2 * mesh.positions_m.tolist()
    assert bones.tolist() == 2 * [9, 4, 7]
