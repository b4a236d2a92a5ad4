"""Evaluation of a file's scene: positions of bones and deformed surfaces, in metres."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, BoolArray, FloatArray
from app.export.joints import matrix_rows, world_rows
from app.formats.scene import Clip, Scene, SkinnedMesh
from app.rig import quaternion
from app.rig.skinning import Skin, skin_of

METRES = 0.01


@dataclass(frozen=True, eq=False)
class ScenePlayback:
    """A scene with a clip, evaluated like in any program that reads the file."""

    scene: Scene
    clip: Clip

    @cached_property
    def bone_names(self) -> tuple[str, ...]:
        """Names of the scene's bones, in the order of their indices."""
        return tuple(bone.name for bone in self.scene.bones)

    @cached_property
    def parents(self) -> tuple[int, ...]:
        """Index of each bone's parent bone, -1 for the root."""
        return tuple(bone.parent for bone in self.scene.bones)

    @cached_property
    def rest_m(self) -> FloatArray:
        """Translations (J, 3) of J bones at rest relative to their parents, metres."""
        return np.stack([np.asarray(bone.translation_cm, np.float64) for bone in self.scene.bones]) * METRES

    def rotations(self, first: int, last: int) -> FloatArray:
        """Return the rotations (n, J, 4) of J bones relative to their parents at the n frames ``first`` .. ``last -
        1``."""
        return quaternion.normalize(self.clip.rotations_xyzw[first:last])

    def translations_m(self, first: int, last: int) -> FloatArray:
        """Return the translations (n, J, 3) of J bones relative to their parents at the n frames ``first`` .. ``last -
        1``, metres."""
        result = np.tile(self.rest_m, (last - first, 1, 1))
        for bone, translation_cm in self.clip.translations_cm.items():
            result[:, bone] = translation_cm[first:last].astype(np.float64) * METRES
        return result

    def bone_rotations(self, bone: int) -> FloatArray:
        """Return the rotations (F, 4) of a bone relative to its parent."""
        return quaternion.normalize(self.clip.rotations_xyzw[:, bone])

    def bone_translations_m(self, bone: int) -> FloatArray:
        """Return the translations (F, 3) of a bone relative to its parent, in metres."""
        if bone not in self.clip.translations_cm:
            return np.tile(self.rest_m[bone], (self.clip.frames, 1))
        return self.clip.translations_cm[bone].astype(np.float64) * METRES

    @cached_property
    def still(self) -> BoolArray:
        """Mask (J,) of the bones that never move relative to their parents."""
        rotations = self.clip.rotations_xyzw
        still: BoolArray = (rotations == rotations[:1]).all(axis=(0, 2))
        still[[*self.clip.translations_cm]] = False
        return still

    def world(self, first: int, last: int) -> FloatArray:
        """Return the world transforms (n, J, 4, 4) of J bones at the n frames ``first`` .. ``last - 1``."""
        result = np.zeros((last - first, len(self.parents), 4, 4))
        result[:, :, :3] = PlaybackBones(self, range(len(self.parents))).world(first, last).transpose(3, 0, 1, 2)
        result[..., 3, 3] = 1.0
        return result

    def morphs(self, first: int, last: int) -> dict[str, AnyFloatArray]:
        """Return the weights (n,) of each morph at the n frames ``first`` .. ``last - 1``."""
        return {name: np.asarray(weights)[first:last] for name, weights in self.clip.morph_weights.items()}


class Surface:
    """Some vertices of a mesh, prepared for deformation.

    Parameters
    ----------
    playback : ScenePlayback
        The scene.
    mesh : SkinnedMesh
        A mesh of the scene.
    vertices : (V,) integer array
        Indices of the vertices.

    Attributes
    ----------
    skin : Skin
        Skin whose joints are the file's bones.
    """

    def __init__(self, playback: ScenePlayback, mesh: SkinnedMesh, vertices: AnyIntArray) -> None:
        binds = np.array(mesh.world_from_bone_bind, np.float64)
        binds[:, :3, 3] *= METRES
        carrying = np.unique(mesh.joint_indices[vertices])
        bone_from_mesh = np.zeros_like(binds)
        bone_from_mesh[carrying] = np.linalg.inv(binds[carrying])
        weights = np.asarray(mesh.weights[vertices], np.float64)
        shown = [morph for morph in mesh.morphs if morph.name in playback.clip.morph_weights]
        self._playback = playback
        self.skin: Skin = skin_of(
            vertices,
            np.asarray(mesh.vertices_cm, np.float64) * METRES,
            mesh.joint_indices[vertices],
            # Normalised as readers do.
            weights / weights.sum(axis=1, keepdims=True),
            bone_from_mesh,
            ((one.name, one.vertex_indices, np.asarray(one.position_deltas_cm) * METRES) for one in shown),
        )

    def positions_m(self, world: FloatArray, first: int, last: int) -> FloatArray:
        """Return the deformed positions (n, V, 3) of V vertices at n frames, metres; ``world`` is `ScenePlayback.world`
        of the same frames."""
        return self.skin.deformed(world, self._playback.morphs(first, last))


class PlaybackBones:
    """World transforms of chosen bones of a playback, with all their ancestors.

    Parameters
    ----------
    playback : ScenePlayback
        The scene.
    bones : iterable of int
        Indices of the chosen bones.

    Attributes
    ----------
    row_of : dict of int to int
        Row in `world` of each bone.
    """

    def __init__(self, playback: ScenePlayback, bones: Iterable[int]) -> None:
        parents, chosen = playback.parents, set[int]()
        for bone in bones:
            while bone >= 0 and bone not in chosen:
                chosen.add(bone)
                bone = parents[bone]
        self.row_of = {bone: row for row, bone in enumerate(sorted(chosen))}
        self._playback = playback
        self._parents = [self.row_of.get(parents[bone], -1) for bone in self.row_of]
        self._still = [bone for bone in self.row_of if playback.still[bone]]
        self._moving = [bone for bone in self.row_of if not playback.still[bone]]
        self._still_rows = np.empty((len(self._still), 3, 4, 1))
        self._place(self._still, 0, 1, self._still_rows)

    def rows(self, bones: Iterable[int]) -> list[int]:
        """Return the rows of some bones in the result of `world`."""
        return [self.row_of[bone] for bone in bones]

    def room(self, frames: int) -> tuple[FloatArray, FloatArray]:
        """Return buffers that `world` fills for a number of frames; they are reused, since allocating them takes longer
        than filling them.
        """
        return np.empty((len(self.row_of), 3, 4, frames)), np.empty((len(self._moving), 3, 4, frames))

    def world(self, first: int, last: int, room: tuple[FloatArray, FloatArray] | None = None) -> FloatArray:
        """Return the world transforms (R, 3, 4, n), without their last row, of R bones for the n frames ``first`` ..
        ``last - 1``.

        Parameters
        ----------
        room : pair of arrays, optional
            Buffers from `room` for at least as many frames; they are overwritten, and a part of them is returned.
        """
        result, moving = (rows[..., : last - first] for rows in room or self.room(last - first))
        self._place(self._moving, first, last, moving)
        local = dict(zip(self._still, self._still_rows, strict=True)) | dict(zip(self._moving, moving, strict=True))
        world_rows(self._parents, [local[bone] for bone in self.row_of], result)
        return result

    def _place(self, bones: Sequence[int], first: int, last: int, rows: FloatArray) -> None:
        """Fill ``rows`` (B, 3, 4, n) with the transforms of B bones relative to their parents in n frames."""
        clip = self._playback.clip
        turns = clip.rotations_xyzw[first:last, bones].astype(np.float64, copy=False)
        matrix_rows(turns.transpose(2, 1, 0), rows[:, :, :3].transpose(1, 2, 0, 3))
        for row, bone in zip(rows, bones, strict=True):
            moved_cm = clip.translations_cm.get(bone)
            if moved_cm is None:
                row[:, 3] = self._playback.rest_m[bone, :, None]
            else:
                row[:, 3] = moved_cm[first:last].T.astype(np.float64) * METRES


class Middles:
    """Mean positions of the vertices of surfaces, such as landmarks.

    The mean of linearly blended vertices is linear in the bones' transforms, so one weighted point per bone, and its
    change by each morph, is stored.

    Parameters
    ----------
    skins : mapping of str to Skin
        Skin of each surface.
    limbs : PlaybackBones
        Bones that hold any of the surfaces.
    """

    def __init__(self, skins: Mapping[str, Skin], limbs: PlaybackBones) -> None:
        self.names = tuple(skins)
        self._shown = tuple(sorted({name for skin in skins.values() for name in skin.morphs}))
        self._points: list[tuple[int, int, FloatArray]] = []
        self._shapes: list[tuple[int, int, FloatArray]] = []
        for index, skin in enumerate(skins.values()):
            rows, shares = limbs.rows(skin.joints.tolist()), skin.weights.T / len(skin.positions_m)
            points_m = np.c_[shares @ skin.positions_m, shares.sum(axis=1)]
            points_m[:, :3] = np.einsum("jik,jk->ji", skin.joint_from_mesh, points_m)
            self._points += [(index, row, point_m) for row, point_m in zip(rows, points_m, strict=True)]
            if skin.morphs:
                columns = [self._shown.index(name) for name in skin.morphs]
                deltas_m = np.array([shares @ deltas for deltas in skin.morphs.values()])
                added = np.zeros((len(rows), 3, len(self._shown)))
                added[..., columns] = np.einsum("jik,mjk->jim", skin.joint_from_mesh[..., :3], deltas_m)
                self._shapes += [(index, row, shapes) for row, shapes in zip(rows, added, strict=True)]

    def places_m(self, world: FloatArray, morphs: Mapping[str, AnyFloatArray]) -> FloatArray:
        """Return the mean positions (K, 3, n) in metres of K surfaces in n frames; ``world`` is `PlaybackBones.world`
        of these frames, ``morphs`` the weights (n,) there.
        """
        result = np.zeros((len(self.names), 3, world.shape[-1]))
        for index, row, point_m in self._points:
            result[index] += point_m @ world[row]
        if self._shapes:
            weights = np.array([morphs[name] for name in self._shown], np.float64)
            for index, row, shapes in self._shapes:
                result[index] += np.einsum("ikn,kn->in", world[row, :, :3], shapes @ weights)
        return result
