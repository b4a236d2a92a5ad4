"""A file's scene played back: where its bones and its deformed surfaces are, in metres."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from app.export.joints import world_transforms
from app.formats.scene import Clip, Scene, SkinnedMesh
from app.rig import quaternion
from app.rig.skinning import Skin, skin_of

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

    def bone_rotations(self, bone: int) -> FloatArray:
        """Local rotations (F, 4) of a bone."""
        return quaternion.normalize(self.clip.rotations_xyzw[:, bone])

    def bone_translations_m(self, bone: int) -> FloatArray:
        """Local translations (F, 3) of a bone."""
        if bone not in self.clip.translations_cm:
            return np.tile(self.rest_m[bone], (self.clip.frames, 1))
        return self.clip.translations_cm[bone].astype(np.float64) * METRES

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
        binds = np.array(mesh.world_from_bone_bind, np.float64)
        binds[:, :3, 3] *= METRES
        carrying = np.unique(mesh.joint_indices[vertices])
        bone_from_mesh = np.zeros_like(binds)
        bone_from_mesh[carrying] = np.linalg.inv(binds[carrying])
        weights = np.asarray(mesh.weights, np.float64)[vertices]
        shown = [morph for morph in mesh.morphs if morph.name in playback.clip.morph_weights]
        self._playback = playback
        self.skin: Skin = skin_of(
            vertices,
            np.asarray(mesh.vertices_cm, np.float64) * METRES,
            mesh.joint_indices[vertices],
            # As a reader normalises them.
            weights / weights.sum(axis=1, keepdims=True),
            bone_from_mesh,
            ((one.name, one.vertex_indices, np.asarray(one.position_deltas_cm) * METRES) for one in shown),
        )

    def positions_m(self, world: FloatArray, first: int, last: int) -> FloatArray:
        """Deformed positions (n, V, 3); ``world`` is `Playback.world` of the same frames."""
        return self.skin.deformed(world, self._playback.morphs(first, last))
