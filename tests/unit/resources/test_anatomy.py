"""Committed bodies have human proportions: every length is within two standard deviations of published tables."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from app.rig.characters.character_library import character_named
from app.rig.mesh import Mesh
from app.rig.people.bundled_people import finished_character
from app.rig.skeleton import rest_positions
from resources.build.character_lids import lid_edges_m
from tests.unit.resources.test_characters import FINGERS, STATURE_M, Character, MeshData, load

TABLE = tomllib.loads(
    (Path(__file__).resolve().parents[3] / "resources" / "build" / "anatomy.toml").read_text(encoding="utf-8")
)
COLUMN = {"woman_adult": "women", "man_adult": "men", "child": "children"}
CHILD = "child"
MOST = 2.0


@pytest.fixture(params=[*sorted(STATURE_M), CHILD])
def character(request: pytest.FixtureRequest) -> Character:
    return child() if request.param == CHILD else load(request.param)


@cache
def child() -> Character:
    """The child, made from a bundled body, as if read from a file."""
    made = finished_character(CHILD, character_named)
    names, places = made.skeleton.names, rest_positions(made.skeleton)
    moves = made.joint_from_mesh.copy()
    moves[:, :3, 3] += places
    return Character(
        CHILD,
        load("woman_adult").gltf,
        {},
        dict(zip(names, places, strict=True)),
        list(names),
        np.linalg.inv(made.joint_from_mesh),
        {mesh.name: _mesh(mesh, moves) for mesh in made.meshes},
        {name: {"mesh": mark.mesh, "vertices": mark.vertices} for name, mark in made.landmarks.items()},
    )


def _mesh(mesh: Mesh, moves: np.ndarray) -> MeshData:
    positions = mesh.positions_m.astype(float)
    weights = np.zeros((len(positions), len(moves)))
    np.add.at(weights, (np.arange(len(positions))[:, None], mesh.joints), mesh.weights)
    moved = np.einsum("jab,nb->nja", moves, np.column_stack([positions, np.ones(len(positions))]))[..., :3]
    morphs = {}
    for morph in mesh.morphs:
        morphs[morph.name] = np.zeros_like(positions)
        morphs[morph.name][morph.vertices] = morph.deltas_m
    t_pose = np.einsum("nj,nja->na", weights, moved)
    return MeshData(
        positions, mesh.normals, np.zeros((0, 2)), weights, t_pose, {mesh.materials[0].name: mesh.triangles}, morphs
    )


def apart_m(character: Character, *joints: str) -> float:
    """Length in metres of a path along joints."""
    places = np.array([character.joints[joint] for joint in joints])
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())


def eye(character: Character, side: str) -> tuple[np.ndarray, float]:
    """Centre and radius of an eyeball in the pose of the meshes."""
    joint = character.joint_names.index(side + "Eye")
    ball = character.meshes["eyes"]
    own = ball.positions[ball.weights[:, joint] > 0.5]
    centre = character.bind[joint, :3, 3]
    return centre, float(np.median(np.linalg.norm(own - centre, axis=1)))


def lids(character: Character, side: str, aside_m: float = 0.0, **shapes: float) -> tuple[float, float]:
    """Heights of both lids' edges relative to the centre of an eye."""
    body = character.meshes["body"]
    centre, radius = eye(character, side)
    points = body.positions + sum((weight * body.morphs[name] for name, weight in shapes.items()), np.zeros(3))
    triangles = np.concatenate([faces for name, faces in body.triangles.items() if name == "skin"])
    near = np.linalg.norm(body.positions[triangles].mean(axis=1) - centre, axis=1) < 0.04
    return lid_edges_m(points, triangles[near], centre, radius, aside_m)


def lengths_mm(character: Character) -> dict[str, float]:
    """Every length of the table by its name there."""
    body, joints = character.meshes["body"], character.joints
    head = body.positions[body.weights[:, character.joint_names.index("head")] > 0.6]
    eyes = (eye(character, "left")[0] + eye(character, "right")[0]) / 2
    skull = head[head[:, 1] > eyes[1] + 0.04]
    middle = head[np.abs(head[:, 0]) < 0.004]
    front = middle[middle[:, 2] > eyes[2] - 0.02]
    # The deepest place between brow and nose; the lowest of the chin.
    nose_root = front[np.abs(front[:, 1] - eyes[1] - 0.004) < 0.012]
    sellion = nose_root[np.argmin(nose_root[:, 2])]
    chin = front[front[:, 2] > eyes[2] - 0.012]
    menton = chin[np.argmin(chin[:, 1])]
    hand = character.at("left.hand")
    knuckles = [joints[f"left{finger}Proximal"] for finger in ("Index", "Little")]
    across = hand[(hand[:, 0] > knuckles[1][0] - 0.004) & (hand[:, 0] < knuckles[0][0] + 0.004)]
    # Without the thumb.
    across = across[across[:, 2] < knuckles[0][2] + 0.016]
    trousers = character.meshes["trousers"].t_pose
    low, high = joints["leftLowerLeg"][1] + 0.15, joints["hips"][1]
    hips = trousers[(trousers[:, 1] > low) & (trousers[:, 1] < high)]
    lower, upper = lids(character, "left")
    return {
        "hip_joints": 1e3 * apart_m(character, "leftUpperLeg", "rightUpperLeg"),
        "femur": 1e3 * apart_m(character, "leftUpperLeg", "leftLowerLeg"),
        "tibia": 1e3 * apart_m(character, "leftLowerLeg", "leftFoot"),
        "humerus": 1e3 * apart_m(character, "leftUpperArm", "leftLowerArm"),
        "forearm": 1e3 * apart_m(character, "leftLowerArm", "leftHand"),
        "arm": 1e3 * apart_m(character, "leftUpperArm", "leftLowerArm", "leftHand"),
        "shoulder_joints": 1e3 * apart_m(character, "leftUpperArm", "rightUpperArm"),
        "hip_breadth": 1e3 * float(np.ptp(hips[:, 0])),
        "hand": 1e3 * float(hand[:, 0].max() - joints["leftHand"][0]),
        "hand_breadth": 1e3 * float(np.ptp(across[:, 2])),
        "head_breadth": 1e3 * float(np.ptp(skull[:, 0])),
        "head_length": 1e3 * float(np.ptp(head[head[:, 1] > eyes[1] + 0.012, 2])),
        "face_height": 1e3 * float(sellion[1] - menton[1]),
        "pupils": 1e3 * apart_m(character, "leftEye", "rightEye"),
        "eyeball": 2e3 * eye(character, "left")[1],
        "lid_aperture": 1e3 * (upper - lower),
    }


def test_every_length_is_a_persons(character: Character) -> None:
    measured = lengths_mm(character)
    assert measured.keys() == TABLE["lengths"].keys()
    for name, row in TABLE["lengths"].items():
        source = row.get(f"{COLUMN[character.name]}_source") or row.get("source")
        published = row.get("both") or row.get(COLUMN[character.name])
        if published is not None:
            mean, deviation = published
            off = (measured[name] + row.get("inside", 0) - mean) / deviation
            assert abs(off) < MOST, f"{name}: {measured[name]:.1f} mm is {off:+.1f} deviations off"
            assert source in TABLE["sources"]


@pytest.mark.parametrize("side", ["left", "right"])
def test_every_bone_of_the_hand_is_as_long_as_a_persons(character: Character, side: str) -> None:
    hand = character.at(f"{side}.hand")
    place = character.landmarks[f"{side}.hand"]
    # Fingers of children have the shares of grown-ups' hands.
    lengths = TABLE["lengths"]["hand"]
    size = 1.0
    if character.name == CHILD:
        size = 2.0 * lengths["children"][0] / (lengths["women"][0] + lengths["men"][0])
    weights = character.meshes[place["mesh"]].weights[place["vertices"]]
    for finger in FINGERS:
        names = ("Metacarpal", "Proximal", "Distal") if finger == "Thumb" else ("Proximal", "Intermediate", "Distal")
        joints = [f"{side}{finger}{name}" for name in names]
        axis = character.joints[joints[2]] - character.joints[joints[1]]
        own = hand[weights[:, character.joint_names.index(joints[2])] > 0.5] - character.joints[joints[2]]
        tip = float((own @ axis).max() / np.linalg.norm(axis))
        row = TABLE["bones"][finger]
        found = np.array([apart_m(character, *joints[:2]), apart_m(character, *joints[1:]), tip]) * 1e3
        wanted = size * np.add(row["mean"], (0.0, 0.0, row["flesh"]))
        off = (found - wanted) / (size * np.array(row["deviation"]))
        assert np.abs(off).max() < MOST, f"{finger}: {found.round(1)} mm are {off.round(1)} deviations off"


@pytest.mark.parametrize("side", ["left", "right"])
def test_lids_rest_open_and_close_wholly(character: Character, side: str) -> None:
    lower, upper = lids(character, side)
    iris_m = 0.0059
    assert 0.001 < iris_m - upper < 0.0025
    assert -0.001 < iris_m + lower < 0.0015
    blink = {f"eyeBlink{side.capitalize()}": 1.0}
    for aside_m in (-0.008, -0.004, 0.0, 0.004, 0.008):
        assert lids(character, side, aside_m, **blink) == (0.0, 0.0)
        assert np.ptp(lids(character, side, aside_m)) > 0.003


def test_both_sides_of_a_hand_lie_about_its_knuckles(character: Character) -> None:
    """A finger bends in the palm and not in the web: its first joint is well before the place where fingers
    separate.
    """
    for finger in FINGERS[1:]:
        knuckle, first = (character.joints[f"left{finger}{name}"] for name in ("Proximal", "Intermediate"))
        pad = character.at(f"left.{finger.lower()}.pad_proximal").mean(axis=0)
        assert 0.5 < (pad - knuckle)[0] / (first - knuckle)[0] < 0.75
