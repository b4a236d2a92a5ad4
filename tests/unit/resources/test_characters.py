"""Character files satisfy the requirements of rig, motion and export. They are read with pygltflib and numpy only."""

from __future__ import annotations

import io
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from pygltflib import GLTF2
from scipy.spatial import ConvexHull, cKDTree

FOLDER = Path(__file__).resolve().parents[3] / "resources" / "characters"
STATURE_M = {"woman_adult": 1.68, "man_adult": 1.80}
DTYPES = {5120: "i1", 5121: "u1", 5123: "<u2", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}

# FBX_UNREAL's list; the names are Apple's (ARFaceAnchor.BlendShapeLocation).
ARKIT = {
    f"{name}{side}"
    for name in [
        "eyeBlink",
        "eyeLookDown",
        "eyeLookIn",
        "eyeLookOut",
        "eyeLookUp",
        "eyeSquint",
        "eyeWide",
        "mouthSmile",
        "mouthFrown",
        "mouthDimple",
        "mouthStretch",
        "mouthPress",
        "mouthLowerDown",
        "mouthUpperUp",
        "browDown",
        "browOuterUp",
        "cheekSquint",
        "noseSneer",
    ]
    for side in ("Left", "Right")
} | {
    "jawForward",
    "jawLeft",
    "jawRight",
    "jawOpen",
    "mouthClose",
    "mouthFunnel",
    "mouthPucker",
    "mouthLeft",
    "mouthRight",
    "mouthRollLower",
    "mouthRollUpper",
    "mouthShrugLower",
    "mouthShrugUpper",
    "browInnerUp",
    "cheekPuff",
    "tongueOut",
}

COMPACT = {"hair", "shirt", "trousers"}
BREATH = {"chestExpand", "bellyExpand"}

# VRM 1.0, humanoid.md: the bones we promise and each one's parent.
FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
PARENTS = {"spine": "hips", "chest": "spine", "upperChest": "chest", "neck": "upperChest", "head": "neck"}
for _side in ("left", "right"):
    PARENTS |= {
        f"{_side}Eye": "head",
        f"{_side}Shoulder": "upperChest",
        f"{_side}UpperArm": f"{_side}Shoulder",
        f"{_side}LowerArm": f"{_side}UpperArm",
        f"{_side}Hand": f"{_side}LowerArm",
        f"{_side}UpperLeg": "hips",
        f"{_side}LowerLeg": f"{_side}UpperLeg",
        f"{_side}Foot": f"{_side}LowerLeg",
        f"{_side}Toes": f"{_side}Foot",
    }
    for _finger in FINGERS:
        _phalanges = (
            ("Metacarpal", "Proximal", "Distal") if _finger == "Thumb" else ("Proximal", "Intermediate", "Distal")
        )
        for _phalanx, _parent in zip(
            _phalanges, (f"{_side}Hand", *(f"{_side}{_finger}{p}" for p in _phalanges)), strict=False
        ):
            PARENTS[f"{_side}{_finger}{_phalanx}"] = _parent


@dataclass(frozen=True)
class MeshData:
    positions: np.ndarray
    normals: np.ndarray
    uvs: np.ndarray
    weights: np.ndarray
    t_pose: np.ndarray
    triangles: dict[str, np.ndarray]
    morphs: dict[str, np.ndarray]


@dataclass(frozen=True)
class Character:
    name: str
    gltf: GLTF2
    parents: dict[str, str]
    joints: dict[str, np.ndarray]
    joint_names: list[str]
    bind: np.ndarray
    meshes: dict[str, MeshData]
    landmarks: dict[str, Any]

    def at(self, landmark: str) -> np.ndarray:
        entry = self.landmarks[landmark]
        return self.meshes[entry["mesh"]].t_pose[entry["vertices"]]


def _accessor(gltf: GLTF2, blob: bytes, index: int) -> np.ndarray:
    accessor = gltf.accessors[index]
    dtype, width = np.dtype(DTYPES[accessor.componentType]), WIDTHS[accessor.type]

    def read(view: int, kind: np.dtype, count: int) -> np.ndarray:
        return np.frombuffer(blob, kind, count, gltf.bufferViews[view].byteOffset or 0)

    if accessor.bufferView is None:
        values = np.zeros((accessor.count, width), dtype)
    else:
        # Rows of whole numbers lie on multiples of four bytes.
        room = (gltf.bufferViews[accessor.bufferView].byteStride or width * dtype.itemsize) // dtype.itemsize
        values = read(accessor.bufferView, dtype, accessor.count * room).reshape(-1, room)[:, :width].copy()
    if accessor.normalized:
        values = values.astype(float) / np.iinfo(dtype).max
    if accessor.sparse is not None:
        indices, replaced = accessor.sparse.indices, accessor.sparse.values
        rows = read(indices.bufferView, np.dtype(DTYPES[indices.componentType]), accessor.sparse.count)
        values[rows] = read(replaced.bufferView, dtype, accessor.sparse.count * width).reshape(-1, width)
    return values


@cache
def load(name: str) -> Character:
    gltf = GLTF2().load(str(FOLDER / f"{name}.glb"))
    blob = gltf.binary_blob()
    parents = {gltf.nodes[child].name: node.name for node in gltf.nodes for child in node.children or []}
    world: dict[str, np.ndarray] = {}

    def walk(index: int, above: np.ndarray) -> None:
        node = gltf.nodes[index]
        world[node.name] = above + np.array(node.translation or [0.0, 0.0, 0.0])
        for child in node.children or []:
            walk(child, world[node.name])

    for index in gltf.scenes[0].nodes:
        walk(index, np.zeros(3))
    skin = gltf.skins[0]
    names = [gltf.nodes[index].name for index in skin.joints]
    inverse = _accessor(gltf, blob, skin.inverseBindMatrices).reshape(-1, 4, 4).swapaxes(1, 2).astype(float)
    moves = inverse.copy()
    moves[:, :3, 3] += [world[joint] for joint in names]
    meshes = {}
    for mesh in gltf.meshes:
        attributes = mesh.primitives[0].attributes
        positions = _accessor(gltf, blob, attributes.POSITION).astype(float)
        weights = np.zeros((len(positions), len(names)))
        for number in range(4):
            joints = getattr(attributes, f"JOINTS_{number}", None)
            if joints is not None:
                np.add.at(
                    weights,
                    (np.arange(len(positions))[:, None], _accessor(gltf, blob, joints)),
                    _accessor(gltf, blob, getattr(attributes, f"WEIGHTS_{number}")),
                )
        moved = np.einsum("jab,nb->nja", moves, np.column_stack([positions, np.ones(len(positions))]))[..., :3]
        targets = mesh.primitives[0].targets or []
        meshes[mesh.name] = MeshData(
            positions=positions,
            normals=_accessor(gltf, blob, attributes.NORMAL),
            uvs=_accessor(gltf, blob, attributes.TEXCOORD_0),
            weights=weights,
            t_pose=np.einsum("nj,nja->na", weights, moved),
            triangles={
                gltf.materials[primitive.material].name: _accessor(gltf, blob, primitive.indices).reshape(-1, 3)
                for primitive in mesh.primitives
            },
            morphs={
                label: _accessor(gltf, blob, target["POSITION"] if isinstance(target, dict) else target.POSITION)
                for label, target in zip(mesh.extras.get("targetNames", []), targets, strict=True)
            },
        )
    landmarks = gltf.scenes[0].extras["suisou"]["landmarks"]
    return Character(name, gltf, parents, world, names, np.linalg.inv(inverse), meshes, landmarks)


@pytest.fixture(params=sorted(STATURE_M))
def character(request: pytest.FixtureRequest) -> Character:
    return load(request.param)


def test_every_humanoid_bone_is_there_under_its_vrm_parent(character: Character) -> None:
    humanoid = character.gltf.extensions["VRMC_vrm"]["humanoid"]["humanBones"]
    assert set(humanoid) == set(PARENTS) | {"hips"}
    assert {character.gltf.nodes[entry["node"]].name: name for name, entry in humanoid.items()} == {
        n: n for n in humanoid
    }
    assert {name: character.parents[name] for name in PARENTS} == PARENTS
    assert character.parents["hips"] == "root"
    assert np.allclose(character.joints["root"], 0)


def test_nodes_have_no_rotation_or_scale(character: Character) -> None:
    for node in character.gltf.nodes:
        assert node.rotation is None
        assert node.scale is None
        assert node.matrix is None


def test_bones_are_as_long_in_the_bind_pose_as_in_the_t_pose(character: Character) -> None:
    bind = dict(zip(character.joint_names, character.bind[:, :3, 3], strict=True))
    for name, parent in PARENTS.items():
        in_t_pose = np.linalg.norm(character.joints[name] - character.joints[parent])
        assert np.linalg.norm(bind[name] - bind[parent]) == pytest.approx(in_t_pose, abs=2e-6)


def test_bind_matrices_are_rigid(character: Character) -> None:
    rotations = character.bind[:, :3, :3]
    assert np.allclose(rotations @ rotations.swapaxes(1, 2), np.eye(3), atol=1e-5)
    assert np.allclose(np.linalg.det(rotations), 1, atol=1e-5)


@pytest.mark.parametrize(("side", "sign"), [("left", 1.0), ("right", -1.0)])
def test_t_pose(character: Character, side: str, sign: float) -> None:
    joints = character.joints
    arm = [
        joints[side + name]
        for name in ("UpperArm", "LowerArm", "Hand", "MiddleProximal", "MiddleIntermediate", "MiddleDistal")
    ]
    steps = np.diff(arm, axis=0)
    assert np.allclose(steps[:, 1:], 0, atol=1e-5)
    assert (steps[:, 0] * sign > 0.02).all()
    leg = np.array([joints[side + name] for name in ("UpperLeg", "LowerLeg", "Foot")])
    assert np.allclose(np.diff(leg, axis=0)[:, [0, 2]], 0, atol=1e-5)
    toes = joints[side + "Toes"] - joints[side + "Foot"]
    assert toes[2] > 0.08
    assert abs(toes[0]) < 1e-5
    thumb = joints[side + "ThumbDistal"] - joints[side + "ThumbMetacarpal"]
    assert np.allclose(thumb / np.linalg.norm(thumb), np.array([sign, 0, 1]) / np.sqrt(2), atol=1e-4)
    # Palms look down.
    assert character.at(f"{side}.palm")[:, 1].mean() < joints[side + "Hand"][1] - 0.004


def test_stands_on_the_floor_at_the_origin_facing_z(character: Character) -> None:
    lowest = min(mesh.t_pose[:, 1].min() for mesh in character.meshes.values())
    assert lowest == pytest.approx(0.0, abs=1e-5)
    for side, sign in (("left", 1), ("right", -1)):
        sole = character.at(f"{side}.foot.sole")
        assert len(sole) >= 20
        assert sole[:, 1].max() < 0.005
        assert (sole[:, 0] * sign > 0).all()
    assert character.at("lips.contact")[:, 2].mean() > character.joints["head"][2] + 0.06
    assert np.abs(character.joints["hips"][[0, 2]]).max() < 0.03


def test_human_proportions(character: Character) -> None:
    stature = STATURE_M[character.name]
    top = character.meshes["body"].t_pose[:, 1].max()
    sole_thickness_m = 0.03
    assert stature - 0.005 < top < stature + sole_thickness_m
    hand = character.at("left.hand")[:, 0].max() - character.joints["leftHand"][0]
    assert 0.104 < hand / stature < 0.113  # 0.108: Winter, Biomechanics and Motor Control of Human Movement, fig. 4.1
    span = character.meshes["body"].t_pose[:, 0].max() * 2
    assert 0.95 < span / stature < 1.07


def test_skin_weights(character: Character) -> None:
    for name, mesh in character.meshes.items():
        assert (mesh.weights >= 0).all()
        assert np.allclose(mesh.weights.sum(axis=1), 1, atol=1e-5)
        # Normals of hair and clothes are of one byte a number.
        assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=0.01 if name in COMPACT else 1e-4)
        assert np.isfinite(mesh.uvs).all()
        used = np.unique(np.concatenate(list(mesh.triangles.values())))
        assert np.array_equal(used, np.arange(len(mesh.positions)))
    head = character.joint_names.index("head")
    lips = character.landmarks["lips.upper"]["vertices"] + character.landmarks["lips.lower"]["vertices"]
    assert (character.meshes["body"].weights[lips, head] > 0.9).all()


def test_no_one_is_undressed(character: Character) -> None:
    """The body's skin consists of head, neck and hands; skin below the collar is removed and not only hidden."""
    skin = character.meshes["body"].t_pose
    beyond_cuff = np.abs(skin[:, 0]) > character.joints["leftHand"][0] - 0.06
    above_collar = skin[:, 1] > character.joints["leftShoulder"][1] - 0.02
    assert (beyond_cuff | above_collar).all()
    shirt, trousers, shoes = (character.meshes[name].t_pose for name in ("shirt", "trousers", "shoes"))
    assert shirt[:, 1].min() < trousers[:, 1].max() - 0.02
    assert shirt[:, 0].max() > character.joints["leftHand"][0]
    assert trousers[:, 1].min() < shoes[:, 1].max()
    # Trousers are wider than the shirt at the belt, all round.
    belt = trousers[:, 1].max() - 0.02
    for axis in (0, 2):
        inner = shirt[np.abs(shirt[:, 1] - belt) < 0.015, axis]
        outer = trousers[np.abs(trousers[:, 1] - belt) < 0.015, axis]
        assert outer.max() > inner.max()
        assert outer.min() < inner.min()


def test_the_52_face_shapes(character: Character) -> None:
    assert len(ARKIT) == 52
    for name in ("body", "teeth", "tongue", "brows", "lashes"):
        assert set(character.meshes[name].morphs) - BREATH == ARKIT
    for label, delta in character.meshes["body"].morphs.items():
        if label not in BREATH | {"tongueOut"}:
            assert np.linalg.norm(delta, axis=1).max() > 5e-4, label
    assert np.linalg.norm(character.meshes["tongue"].morphs["tongueOut"], axis=1).max() > 0.01


def _girth_m(character: Character, height_m: float, weight: float) -> float:
    """Girth of the trunk at a height over the clothes: hull of a slab of vertices that belong to neither arms nor
    hands.
    """
    points = []
    for name in ("body", "shirt", "trousers"):
        mesh = character.meshes[name]
        moved = mesh.positions + weight * sum(mesh.morphs.get(label, 0.0) for label in BREATH)
        inside = (np.abs(mesh.positions[:, 1] - height_m) < 0.015) & (np.abs(mesh.positions[:, 0]) < 0.19)
        points.append(moved[inside][:, [0, 2]])
    hull = np.concatenate(points)
    hull = hull[ConvexHull(hull).vertices]
    return float(np.linalg.norm(hull - np.roll(hull, 1, axis=0), axis=1).sum())


def test_a_full_breath_widens_chest_and_belly_clothes_and_all(character: Character) -> None:
    low, high = character.joints["hips"][1], character.joints["neck"][1]
    for share in (0.35, 0.45, 0.55):
        height_m = low + share * (high - low)
        assert 0.02 < _girth_m(character, height_m, 1.0) - _girth_m(character, height_m, 0.0) < 0.043
    # Layers of clothes move together: a shirt does not come through the belt.
    shirt, trousers = character.meshes["shirt"], character.meshes["trousers"]
    for point, delta in zip(trousers.positions, trousers.morphs["bellyExpand"], strict=True):
        if np.linalg.norm(delta) > 1e-3:
            near = np.argmin(np.linalg.norm(shirt.positions - point, axis=1))
            if np.linalg.norm(shirt.positions[near] - point) < 0.01:
                assert np.linalg.norm(shirt.morphs["bellyExpand"][near] - delta) < 3e-3
    # Arms and head stay.
    for name in ("body", "shirt"):
        mesh = character.meshes[name]
        far = (np.abs(mesh.positions[:, 0]) > 0.26) | (mesh.positions[:, 1] > high + 0.05)
        assert max(np.abs(mesh.morphs[label][far]).max() for label in BREATH & set(mesh.morphs)) < 1e-3


@pytest.mark.parametrize(("side", "sign"), [("Left", 1), ("Right", -1)])
def test_shapes_are_on_the_side_they_are_named_for(character: Character, side: str, sign: int) -> None:
    body = character.meshes["body"]
    for label in ("eyeBlink", "mouthSmile", "browDown", "cheekSquint"):
        moved = np.linalg.norm(body.morphs[label + side], axis=1)
        centre = (body.positions * moved[:, None]).sum(axis=0) / moved.sum()
        assert centre[0] * sign > 0.01, label


def test_mouth_shapes_do_what_they_say(character: Character) -> None:
    body, teeth = character.meshes["body"], character.meshes["teeth"]
    upper, lower = (character.landmarks[f"lips.{name}"]["vertices"] for name in ("upper", "lower"))
    opened = body.morphs["jawOpen"]
    assert opened[lower, 1].mean() < -0.015
    assert abs(opened[upper, 1].mean()) < 0.006
    jaw_drop = teeth.morphs["jawOpen"][:, 1]
    assert jaw_drop.min() < -0.015
    assert np.isclose(jaw_drop.max(), 0, atol=1e-4)
    assert body.morphs["jawLeft"][lower, 0].mean() > 0.003
    corner = int(np.linalg.norm(body.morphs["mouthDimpleLeft"], axis=1).argmax())
    assert body.positions[corner, 0] > 0.02
    assert body.morphs["mouthPucker"][corner, 0] < -0.003
    assert body.morphs["mouthSmileLeft"][corner, 1] > 0.003
    # Closing undoes opening at the lips.
    closed = opened[lower] + body.morphs["mouthClose"][lower]
    assert np.abs(closed[:, 1].mean()) < 0.35 * np.abs(opened[lower, 1].mean())


@pytest.mark.parametrize(("side", "sign"), [("left", 1.0), ("right", -1.0)])
def test_finger_landmarks(character: Character, side: str, sign: float) -> None:
    body = character.meshes["body"]
    for finger in FINGERS:
        pad = character.landmarks[f"{side}.{finger.lower()}.pad"]["vertices"]
        distal = character.joint_names.index(f"{side}{finger}Distal")
        assert 4 <= len(pad) <= 10
        assert (body.weights[pad, distal] > 0.9).all()
        place = body.t_pose[pad].mean(axis=0) - character.joints[f"{side}{finger}Distal"]
        if finger != "Thumb":
            assert place[1] < -0.002
            assert 0.006 < place[0] * sign < 0.03
            assert abs(place[2]) < 0.004
            beside = (
                character.at(f"{side}.{finger.lower()}.side").mean(axis=0) - character.joints[f"{side}{finger}Distal"]
            )
            assert beside[2] > 0.003
    web = character.at(f"{side}.thumb_web").mean(axis=0)
    assert character.joints[side + "ThumbMetacarpal"][2] < web[2] < character.joints[side + "ThumbDistal"][2]
    # The thumb's pad looks towards the other fingers or the palm, its nail away from them.
    thumb = np.flatnonzero(body.weights[:, character.joint_names.index(side + "ThumbDistal")] > 0.9)
    pads = character.landmarks[f"{side}.thumb.pad"]["vertices"]
    nail = body.t_pose[thumb[body.normals[thumb] @ body.normals[pads].mean(axis=0) < -0.8]].mean(axis=0)
    pad = body.t_pose[pads].mean(axis=0)
    index = character.joints[side + "IndexDistal"]
    assert np.linalg.norm(pad - index) < np.linalg.norm(nail - index) or pad[1] < nail[1]


def test_left_and_right_mirror_each_other(character: Character) -> None:
    for name, place in character.joints.items():
        if name.startswith("left"):
            other = character.joints["right" + name[4:]]
            assert np.allclose(place * [-1, 1, 1], other, atol=1e-3), name


def test_materials_are_few_and_show_skin_hair_and_eyes(character: Character) -> None:
    materials = {material.name: material for material in character.gltf.materials}
    own = {"skin", "mouth_eyes", "iris", "brows", "hair"}
    assert set(materials) - {"shirt", "trousers", "belt", "shoes", "buttons"} == own
    for name in own:
        assert materials[name].pbrMetallicRoughness.baseColorTexture is not None
    assert materials["skin"].normalTexture is not None
    assert materials["skin"].pbrMetallicRoughness.metallicRoughnessTexture is not None
    for name in ("brows", "hair"):
        assert materials[name].alphaMode == "MASK"
    blob = character.gltf.binary_blob()
    beside = {image.uri for image in character.gltf.images if image.uri is not None}
    assert beside == {f"wardrobe/cloth_{name}.jpg" for name in ("color", "normal", "orm")}
    for image in character.gltf.images:
        if image.uri is not None:
            continue
        view = character.gltf.bufferViews[image.bufferView]
        width, height = Image.open(io.BytesIO(blob[view.byteOffset :][: view.byteLength])).size
        assert {width & (width - 1), height & (height - 1)} == {0}
        assert max(width, height) <= 1024
    assert sum(len(faces) for faces in character.meshes["hair"].triangles.values()) < 8000


def test_brows_lie_on_the_skin_and_follow_its_shapes(character: Character) -> None:
    body, brows, lashes = (character.meshes[name] for name in ("body", "brows", "lashes"))
    near = cKDTree(body.positions).query(brows.positions)
    assert near[0].max() < 0.006
    for label in ("browInnerUp", "browDownLeft", "browOuterUpRight"):
        assert np.linalg.norm(brows.morphs[label] - body.morphs[label][near[1]], axis=1).max() < 0.004, label
    assert brows.morphs["browInnerUp"][:, 1].max() > 0.008
    assert lashes.morphs["eyeBlinkLeft"][:, 1].min() < -0.004


def test_eyes_show_their_pupil_ahead_and_turn_with_their_joints(character: Character) -> None:
    eyes = character.meshes["eyes"]
    for side in ("left", "right"):
        own = eyes.weights[:, character.joint_names.index(side + "Eye")] > 0.99
        pupil = np.intersect1d(np.flatnonzero(own), eyes.triangles["iris"])
        pupil = pupil[np.linalg.norm(eyes.uvs[pupil] - 0.5, axis=1) < 0.01]
        ahead = eyes.t_pose[pupil] - character.joints[side + "Eye"]
        assert (ahead[:, 2] > 0.011).all()
        assert np.abs(ahead[:, :2]).max() < 0.001


def test_licences_are_named_and_files_small(character: Character) -> None:
    vrm = character.gltf.extensions["VRMC_vrm"]
    assert vrm["specVersion"] == "1.0"
    assert "Apache-2.0" in vrm["meta"]["copyrightInformation"]
    assert "CC0" in vrm["meta"]["copyrightInformation"]
    assert (FOLDER / f"{character.name}.glb").stat().st_size < 5e6
    readme = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert f"{character.name}.glb" in readme


def test_expressions_point_at_existing_shapes(character: Character) -> None:
    for name, expression in character.gltf.extensions["VRMC_vrm"]["expressions"]["preset"].items():
        for bind in expression["morphTargetBinds"]:
            mesh = character.gltf.meshes[character.gltf.nodes[bind["node"]].mesh]
            assert 0 <= bind["index"] < len(mesh.extras["targetNames"]), name
            assert 0 < bind["weight"] <= 1
