"""Small scenes with known values for testing playback."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from scipy.spatial.transform import Rotation

from app.formats.scene import Bone, Clip, Material, MorphTarget, Scene, SkinnedMesh


def random_scene(seed: int, vertices: int = 60, frames: int = 7) -> Scene:
    """Chain of four bones that bends a cloud of vertices with two morphs."""
    random = np.random.default_rng(seed)
    bones = tuple(
        Bone(name, parent, random.uniform(-3, 3, 3), np.array([0.0, 0.0, 0.0, 1.0]))
        for name, parent in (("root", -1), ("a", 0), ("b", 1), ("c", 1))
    )
    binds = np.tile(np.eye(4), (4, 1, 1))
    binds[:, :3, :3] = Rotation.random(4, random_state=seed).as_matrix()
    binds[:, :3, 3] = random.uniform(-3, 3, (4, 3))
    weights = random.uniform(0.1, 1, (vertices, 2))
    mesh = SkinnedMesh(
        name="cloud",
        vertices_cm=random.uniform(-5, 5, (vertices, 3)),
        faces=np.arange(vertices // 3 * 3).reshape(-1, 3),
        normals=np.tile([0.0, 1.0, 0.0], (vertices, 1)),
        uvs=None,
        materials=(Material("plain", (1.0, 1.0, 1.0, 1.0)),),
        face_materials=None,
        joint_indices=random.integers(0, 4, (vertices, 2)),
        weights=weights / weights.sum(axis=1, keepdims=True),
        world_from_bone_bind=binds,
        morphs=tuple(
            MorphTarget(name, np.arange(first, vertices, 3), random.uniform(-1, 1, (len(range(first, vertices, 3)), 3)))
            for name, first in (("smile", 0), ("frown", 1))
        ),
    )
    clip = Clip(
        name="clip",
        fps=Fraction(30),
        frames=frames,
        rotations_xyzw=Rotation.random(frames * 4, random_state=seed + 1).as_quat().reshape(frames, 4, 4),
        translations_cm={1: random.uniform(-2, 2, (frames, 3))},
        morph_weights={"smile": random.uniform(0, 1, frames)},
    )
    return Scene(bones, (mesh,), clip)


def slow_positions_m(scene: Scene, frame: int) -> np.ndarray:
    """Vertices of the first mesh, deformed one by one according to the definition."""
    clip, mesh = scene.clip, scene.meshes[0]
    assert clip is not None
    world: list[np.ndarray] = []
    for index, bone in enumerate(scene.bones):
        local = np.eye(4)
        local[:3, :3] = Rotation.from_quat(clip.rotations_xyzw[frame, index]).as_matrix()
        local[:3, 3] = clip.translations_cm[index][frame] if index in clip.translations_cm else bone.translation_cm
        world.append(local if bone.parent < 0 else world[bone.parent] @ local)
    result = []
    for vertex, bind in enumerate(mesh.vertices_cm):
        position = bind.copy()
        for morph in mesh.morphs:
            for row in np.flatnonzero(morph.vertex_indices == vertex):
                weight = clip.morph_weights[morph.name][frame] if morph.name in clip.morph_weights else 0.0
                position = position + weight * morph.position_deltas_cm[row]
        moved = np.zeros(4)
        for joint, weight in zip(mesh.joint_indices[vertex], mesh.weights[vertex], strict=True):
            moved += weight * (world[joint] @ np.linalg.inv(mesh.world_from_bone_bind[joint]) @ np.append(position, 1))
        result.append(moved[:3] / 100.0)
    return np.array(result)
