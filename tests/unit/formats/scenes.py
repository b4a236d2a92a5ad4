"""Synthetic scenes for tests of files, with positions of their joints from an independent calculation."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
from scipy.spatial.transform import Rotation

from app.formats.scene import Bone, Clip, Material, MorphTarget, Scene, SkinnedMesh
from tests.support.readers import Expected

BONES = (
    # name, parent, offset in cm
    ("root", -1, (0, 0, 0)),
    ("hips", 0, (0, 95, 0)),  # straight above its parent: Blender connects such bones and drops their location keys
    ("spine", 1, (0, 10, -1)),
    ("chest", 2, (0, 14, -2)),
    ("neck", 3, (0, 22, 1)),
    ("head", 4, (0, 9, 2)),
    ("leftShoulder", 3, (3, 18, 0)),
    ("leftUpperArm", 6, (12, 0, -1)),
    ("leftLowerArm", 7, (27, 0, 0)),
    ("leftHand", 8, (25, 0, 1)),
    ("leftIndexProximal", 9, (9, 0, 2)),
    ("leftIndexDistal", 10, (4, 0, 0)),
    ("rightShoulder", 3, (-3, 18, 0)),
    ("rightUpperArm", 12, (-12, 0, -1)),
    ("rightLowerArm", 13, (-27, 0, 0)),
    ("rightHand", 14, (-25, 0, 1)),
    ("leftUpperLeg", 1, (9, -4, 0)),
    ("leftLowerLeg", 16, (0, -42, 1)),
    ("leftFoot", 17, (0, -41, -3)),
    ("rightUpperLeg", 1, (-9, -4, 0)),
    ("rightLowerLeg", 19, (0, -42, 1)),
    ("rightFoot", 20, (0, -41, -3)),
)


def rotations(seed: int, frames: int, joints: int, amplitude_rad: float) -> np.ndarray:
    """Smooth random rotations (F, J, 4) about varying axes."""
    generator = np.random.default_rng(seed)
    speed = generator.uniform(0.02, 0.15, (1, joints, 3))
    phase = generator.uniform(0, 2 * np.pi, (1, joints, 3))
    vectors = amplitude_rad * np.sin(speed * np.arange(frames)[:, None, None] + phase)
    return Rotation.from_rotvec(vectors.reshape(-1, 3)).as_quat().reshape(frames, joints, 4)


def world_from_bones(bones: tuple[Bone, ...], translations: np.ndarray, quaternions: np.ndarray) -> np.ndarray:
    """World transforms (F, J, 4, 4) from local ones, joint by joint with scipy's matrices."""
    frames, joints, _ = translations.shape
    result = np.zeros((frames, joints, 4, 4))
    for joint, bone in enumerate(bones):
        local = np.tile(np.eye(4), (frames, 1, 1))
        local[:, :3, :3] = Rotation.from_quat(quaternions[:, joint]).as_matrix()
        local[:, :3, 3] = translations[:, joint]
        result[:, joint] = local if bone.parent < 0 else result[:, bone.parent] @ local
    return result


def _rest_bones(seed: int, rest_amplitude_rad: float) -> tuple[Bone, ...]:
    rest = rotations(seed, 1, len(BONES), rest_amplitude_rad)[0]
    orders = list(itertools.permutations(np.eye(3)))
    return tuple(
        Bone(name, parent, np.array(offset, dtype=float), rest[joint], np.array(orders[joint % len(orders)]))
        for joint, (name, parent, offset) in enumerate(BONES)
    )


def _sphere(center: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices, triangles and normals of a small icosahedron."""
    golden = (1 + 5**0.5) / 2
    points = [(0, s, t * golden) for s in (1, -1) for t in (1, -1)]
    points = [tuple(np.roll(p, k)) for p in points for k in range(3)]
    directions = np.array(points, dtype=float) / np.hypot(1, golden)
    triples = [
        (a, b, c)
        for a in range(12)
        for b in range(a + 1, 12)
        for c in range(b + 1, 12)
        if max(np.linalg.norm(directions[i] - directions[j]) for i, j in ((a, b), (b, c), (a, c))) < 1.1
    ]
    outward = [(a, b, c) if np.linalg.det(directions[[a, b, c]]) > 0 else (a, c, b) for a, b, c in triples]
    return center + radius * directions, np.array(outward), directions


def _mesh(name: str, joints: list[int], binds: np.ndarray, morph_names: tuple[str, ...], seed: int) -> SkinnedMesh:
    """Ball around each joint, with weights blended between the joint, its parent and two others."""
    generator = np.random.default_rng(seed)
    vertices, faces, normals, indices = [], [], [], []
    for number, joint in enumerate(joints):
        ball, triangles, directions = _sphere(binds[joint, :3, 3], 2.0)
        vertices.append(ball)
        faces.append(triangles + 12 * number)
        normals.append(directions)
        others = generator.integers(0, len(binds), (12, 5))
        indices.append(np.column_stack([np.full(12, joint), others]))
    weights = generator.random((12 * len(joints), 6)) * [10, 1, 1, 0, 1, 0.5]
    weights /= weights.sum(axis=1, keepdims=True)
    all_faces = np.concatenate(faces)
    morphs = tuple(
        MorphTarget(morph, np.arange(k, 12 * len(joints), 3), generator.normal(size=(4 * len(joints), 3)))
        for k, morph in enumerate(morph_names)
    )
    materials = (
        Material(f"{name}_front", (0.8, 0.5, 0.4, 1.0), 0.0, 0.55),
        Material(f"{name}_back", (0.1, 0.2, 0.3, 0.5), 0.25, 0.7),
    )
    return SkinnedMesh(
        name=name,
        vertices_cm=np.concatenate(vertices),
        faces=all_faces,
        normals=np.concatenate(normals),
        uvs=generator.random((12 * len(joints), 2)),
        materials=materials,
        face_materials=(np.arange(len(all_faces)) % 2).astype(np.int32),
        joint_indices=np.concatenate(indices),
        weights=weights,
        world_from_bone_bind=binds,
        morphs=morphs,
    )


def character(fps: Fraction, frames: int = 49, amplitude_rad: float = 0.6) -> Scene:
    """Twenty-two bones and three skinned meshes bound in another pose than the rest pose, two of them with morphs."""
    bones = _rest_bones(11, 0.3)
    bind_rotations = rotations(12, 1, len(bones), 0.2)
    bind_rotations[:, :2] = [0, 0, 0, 1]
    offsets = np.array([bone.translation_cm for bone in bones])
    binds = world_from_bones(bones, offsets[None], bind_rotations)[0]
    meshes = (
        _mesh("Body", list(range(2, 22)), binds, ("jawOpen", "browInnerUp"), 1),
        _mesh("Teeth", [5], binds, ("jawOpen",), 2),
        _mesh("Shirt", [2, 3, 7, 13], binds, (), 3),
    )
    time = np.arange(frames)
    clip = Clip(
        "Performance",
        fps,
        frames,
        rotations(13, frames, len(bones), amplitude_rad).astype(np.float32),
        {
            0: np.column_stack([3 * np.sin(0.1 * time), 0 * time, 2 * np.cos(0.05 * time)]),
            1: offsets[1] + np.column_stack([np.sin(0.2 * time), 4 * np.sin(0.07 * time), np.cos(0.3 * time)]),
        },
        {"jawOpen": 0.5 - 0.5 * np.cos(0.2 * time), "browInnerUp": np.linspace(0, 1, frames)},
    )
    return Scene(bones, meshes, clip, "Suisou test")


def instrument(fps: Fraction, frames: int = 49) -> Scene:
    """A root with rigid moving parts, two of them vertically above their parent."""
    identity = np.array([0.0, 0.0, 0.0, 1.0])
    parts = (("root", -1, (0, 0, 0)), ("valve_1", 0, (0, 8, 0)), ("valve_2", 0, (3, 8, 0)), ("slide", 0, (0, 0, 20)),
             ("water_key", 3, (0, 5, 0)))  # fmt: skip
    bones = tuple(Bone(name, parent, np.array(place, dtype=float), identity) for name, parent, place in parts)
    offsets = np.array([bone.translation_cm for bone in bones])
    quaternions = np.tile(identity, (frames, len(bones), 1))
    quaternions[:, 0] = rotations(21, frames, 1, 0.8)[:, 0]
    binds = world_from_bones(bones, offsets[None], quaternions[:1] * 0 + identity)[0]
    vertices, faces, normals = zip(*(_sphere(place, 1.5) for place in binds[:, :3, 3]), strict=True)
    mesh = SkinnedMesh(
        "Brass",
        np.concatenate(vertices),
        np.concatenate([triangles + 12 * number for number, triangles in enumerate(faces)]),
        np.concatenate(normals),
        None,
        (Material("Brass", (0.8, 0.6, 0.2, 1.0), 1.0, 0.35, True),),
        None,
        np.repeat(np.arange(len(bones)), 12)[:, None],
        np.ones((12 * len(bones), 1)),
        binds,
    )
    time = np.arange(frames)
    moves = {
        0: np.column_stack([np.sin(0.1 * time), 120 + np.cos(0.1 * time), 30 + 0 * time]),
        1: offsets[1] - np.column_stack([0 * time, 0.8 + 0.8 * np.sin(0.4 * time), 0 * time]),
        3: offsets[3] + np.column_stack([0 * time, 0 * time, 30 + 30 * np.sin(0.15 * time)]),
        4: offsets[4] + np.column_stack([0 * time, np.sin(0.3 * time), 0 * time]),
    }
    return Scene(bones, (mesh,), Clip("Performance", fps, frames, quaternions, moves))


def expected(scene: Scene) -> Expected:
    """Values that every reader should find in a scene's file."""
    assert scene.clip is not None
    clip = scene.clip
    translations = np.tile([bone.translation_cm for bone in scene.bones], (clip.frames, 1, 1)).astype(float)
    for bone, values in clip.translations_cm.items():
        translations[:, bone] = values
    worlds = world_from_bones(scene.bones, translations, np.asarray(clip.rotations_xyzw, dtype=float))
    sampled = sorted({0, 1, clip.frames // 3, clip.frames // 2, clip.frames - 2, clip.frames - 1})
    return Expected(
        fps=clip.fps,
        frames=clip.frames,
        sampled=sampled,
        joints_cm={bone.name: worlds[sampled, joint, :3, 3] for joint, bone in enumerate(scene.bones)},
        parents={bone.name: scene.bones[bone.parent].name if bone.parent >= 0 else None for bone in scene.bones},
        weights={name: values[sampled] for name, values in clip.morph_weights.items()},
    )
