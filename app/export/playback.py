"""A file's scene played back: where its bones and its deformed surfaces are, in metres."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from app.export.joints import world_transforms
from app.formats.scene import Clip, Scene, SkinnedMesh
from app.rig import quaternion
from app.rig.skinning import Skin

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.integer]
METRES = 0.01


@dataclass(frozen=True, eq=False)
class Playback:
    """A scene with a clip, as any reader of the file would play it."""

    scene: Scene
    clip: Clip

    @cached_property
    def bone_names(self) -> tuple[str, ...]:
        """Names of the bones."""
        return tuple(bone.name for bone in self.scene.bones)

    @cached_property
    def parents(self) -> tuple[int, ...]:
        """Index of each bone's parent, -1 for the root."""
        return tuple(bone.parent for bone in self.scene.bones)

    @cached_property
    def rest_m(self) -> FloatArray:
        """Rest translations (J, 3)."""
        return np.stack([np.asarray(bone.translation_cm, np.float64) for bone in self.scene.bones]) * METRES

    def rotations(self, first: int, last: int) -> FloatArray:
        """Local rotations (n, J, 4) of the frames ``first`` .. ``last - 1``."""
        return quaternion.normalize(self.clip.rotations_xyzw[first:last])

    def translations_m(self, first: int, last: int) -> FloatArray:
        """Local translations (n, J, 3) of the frames ``first`` .. ``last - 1``."""
        result = np.tile(self.rest_m, (last - first, 1, 1))
        for bone, translation_cm in self.clip.translations_cm.items():
            result[:, bone] = translation_cm[first:last].astype(np.float64) * METRES
        return result

    def world(self, first: int, last: int) -> FloatArray:
        """World transforms (n, J, 4, 4) of the frames ``first`` .. ``last - 1``."""
        return world_transforms(self.parents, self.translations_m(first, last), self.rotations(first, last))

    def morphs(self, first: int, last: int) -> dict[str, npt.NDArray[np.floating]]:
        """Weights (n,) of the morphs at the frames ``first`` .. ``last - 1``."""
        return {name: np.asarray(weights)[first:last] for name, weights in self.clip.morph_weights.items()}


class Surface:
    """Some vertices of a mesh, ready to be deformed.

    Parameters
    ----------
    playback : Playback
    mesh : SkinnedMesh
        One of its scene's.
    vertices : (V,) integer array

    Attributes
    ----------
    skin : Skin
        Its joints are the file's bones.
    """

    def __init__(self, playback: Playback, mesh: SkinnedMesh, vertices: IntArray) -> None:
        weights = _dense_weights(mesh, vertices, len(playback.bone_names))
        bones = np.flatnonzero(weights.any(axis=0))
        binds = np.asarray(mesh.world_from_bone_bind, np.float64)[bones].copy()
        binds[:, :3, 3] *= METRES
        bone_from_mesh: FloatArray = np.asarray(np.linalg.inv(binds), np.float64)
        self._playback = playback
        self.skin: Skin = Skin(
            positions_m=np.asarray(mesh.vertices_cm, np.float64)[vertices] * METRES,
            joints=bones,
            weights=weights[:, bones],
            joint_from_mesh=bone_from_mesh[:, :3],
            morphs=_touching_morphs(playback.clip, mesh, vertices),
        )

    def positions_m(self, world: FloatArray, first: int, last: int) -> FloatArray:
        """Deformed positions (n, V, 3); ``world`` is `Playback.world` of the same frames."""
        return self.skin.deformed(world, self._playback.morphs(first, last))


def _dense_weights(mesh: SkinnedMesh, vertices: IntArray, bones: int) -> FloatArray:
    """Weights (V, J) with sum 1, as a reader normalises them."""
    weights = np.zeros((len(vertices), bones))
    rows = np.arange(len(vertices))
    for column in range(mesh.joint_indices.shape[1]):
        np.add.at(weights, (rows, mesh.joint_indices[vertices, column]), mesh.weights[vertices, column])
    weights /= weights.sum(axis=1, keepdims=True)
    return weights


def _touching_morphs(clip: Clip, mesh: SkinnedMesh, vertices: IntArray) -> dict[str, FloatArray]:
    """Displacement (V, 3) in metres of every morph of the clip that moves one of the vertices."""
    once, copies = np.unique(vertices, return_inverse=True)
    place = np.full(len(mesh.vertices_cm), -1)
    place[once] = np.arange(len(once))
    touching = {}
    for morph in mesh.morphs:
        rows = place[morph.vertex_indices]
        if morph.name not in clip.morph_weights or not (rows >= 0).any():
            continue
        deltas_m = np.zeros((len(once), 3))
        deltas_m[rows[rows >= 0]] = np.asarray(morph.position_deltas_cm, np.float64)[rows >= 0] * METRES
        if deltas_m.any():
            touching[morph.name] = deltas_m[copies]
    return touching
