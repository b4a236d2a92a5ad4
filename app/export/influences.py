"""Reduction of skin weights to four influences per vertex, which game engines require, if the difference is invisible.

A vertex with more influences gets new weights on four bones, fitted by least squares to its positions in poses of the
clip. Where that deviates too much, or where morphs make its deviation uncertain, the weights are fitted one vertex at a
time to its exact positions with the morphs, such that the largest deviation is small. It keeps all influences if it
would ever deviate by more than `FEW_MM` even so.
"""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Final

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, FloatArray, IntArray
from app.export.playback import METRES, PlaybackBones, ScenePlayback
from app.formats.scene import Scene, SkinnedMesh

MOST_INFLUENCES: Final = 4
FEW_MM: Final = 0.5
"""Greatest distance in millimetres by which a vertex may move at any frame if influences are removed."""
_STRONGEST = 6
_POSES, _CHUNK = 48, 256
_EXACT_VERTICES, _EXACT_POSES, _EXACT_ROUNDS = 512, 192, 5
"""Greatest number of vertices that are fitted one at a time (the nearest ones), and poses and rounds of such a fit."""
_HOPELESS = 4.0
"""Multiple of `FEW_MM` from which the first round's largest deviation is not expected to become small enough."""
_SUM = 1e3
"""Weight of the condition that weights sum to 1, against positions in centimetres."""
_RIDGE = 1e-9
"""Regularisation relative to the squares, which keeps weights of bones that move together near their former values."""


def with_few_influences(scene: Scene) -> Scene:
    """Return a scene whose meshes have fewer influences; the scene must have a clip."""
    counts = [np.count_nonzero(mesh.weights, axis=1).max(initial=0) for mesh in scene.meshes]
    if scene.clip is None or max(counts, default=0) <= MOST_INFLUENCES:
        return scene
    playback = ScenePlayback(scene, scene.clip)
    meshes = tuple(
        mesh if count <= MOST_INFLUENCES else _with_few(mesh, playback)
        for mesh, count in zip(scene.meshes, counts, strict=True)
    )
    return replace(scene, meshes=meshes)


def _with_few(mesh: SkinnedMesh, playback: ScenePlayback) -> SkinnedMesh:
    width = int(np.count_nonzero(mesh.weights, axis=1).max())
    order = np.argsort(-np.asarray(mesh.weights, np.float64), axis=1, kind="stable")[:, :width]
    joints = np.take_along_axis(mesh.joint_indices, order, axis=1)
    weights = np.take_along_axis(np.asarray(mesh.weights, np.float64), order, axis=1)
    many = np.flatnonzero(weights[:, MOST_INFLUENCES] > 0.0)
    skinned = _Skinned(mesh, many, joints[many], weights[many], playback)
    fewer, off_mm = skinned.fewer()
    far = np.flatnonzero(off_mm > FEW_MM)
    far = far[np.argsort(off_mm[far], kind="stable")][:_EXACT_VERTICES]
    fewer[far], off_mm[far] = skinned.fewer_exactly(far)
    near = off_mm <= FEW_MM
    weights[many[near]] = fewer[near]
    order = np.argsort(-weights, axis=1, kind="stable")
    width = int(np.count_nonzero(weights, axis=1).max())
    return replace(
        mesh,
        joint_indices=np.take_along_axis(joints, order, axis=1)[:, :width],
        weights=np.take_along_axis(weights, order, axis=1)[:, :width].astype(mesh.weights.dtype),
    )


def _shaped_mm(mesh: SkinnedMesh, playback: ScenePlayback) -> FloatArray:
    """Return the largest distance in millimetres by which morphs of a clip move each of V vertices (V,)."""
    result = np.zeros(len(mesh.vertices_cm))
    for morph in mesh.morphs:
        most = np.abs(playback.clip.morph_weights.get(morph.name, np.zeros(1))).max()
        result[morph.vertex_indices] += 10.0 * most * np.linalg.norm(morph.position_deltas_cm, axis=1)
    return result


def _nearest_four(carried_cm: FloatArray, weights: FloatArray) -> FloatArray:
    """Return weights (K,) of one vertex on at most four bones with the smallest largest deviation in some poses.

    Parameters
    ----------
    carried_cm : (K, 3, f) float64
        Positions to which each of the K bones alone would carry the vertex, in f poses.
    weights : (K,) float64
        The vertex's own weights; non-zero ones come first.
    """
    from scipy.optimize import nnls  # heavy, and seldom needed

    asked = np.einsum("k,kaf->fa", weights, carried_cm)
    best, least_cm = weights, np.inf
    bones = min(_STRONGEST, int(np.count_nonzero(weights)))
    for chosen in itertools.combinations(range(bones), MOST_INFLUENCES):
        ways = carried_cm[[*chosen]].transpose(2, 1, 0)
        emphasis = np.ones(len(asked))
        # Least squares that weigh the largest deviations more in each round come near to the smallest largest one.
        for _ in range(_EXACT_ROUNDS):
            rows = np.sqrt(emphasis)[:, None]
            sums = np.full((1, MOST_INFLUENCES), _SUM)
            system = np.concatenate([(ways * rows[..., None]).reshape(-1, MOST_INFLUENCES), sums])
            found = nnls(system, np.append((asked * rows).ravel(), _SUM))[0]
            found /= max(found.sum(), 1e-12)
            off_cm = np.linalg.norm(ways @ found - asked, axis=1)
            if off_cm.max() < least_cm:
                least_cm, best = off_cm.max(), np.zeros(len(weights))
                best[[*chosen]] = found
            if off_cm.max() > _HOPELESS * FEW_MM / 10.0:
                break
            emphasis *= off_cm / max(off_cm.max(), 1e-12) + 0.02
            emphasis /= emphasis.max()
    return best


class _Skinned:
    """The vertices of a mesh that more than four bones hold, and the search for weights on at most four."""

    def __init__(
        self, mesh: SkinnedMesh, vertices: IntArray, joints: AnyIntArray, weights: FloatArray, playback: ScenePlayback
    ) -> None:
        self._mesh, self._vertices, self._weights, self._playback = mesh, vertices, weights, playback
        self._shaped_mm = _shaped_mm(mesh, playback)[vertices]
        bones, carriers = np.unique(joints, return_inverse=True)
        self._carriers = carriers.reshape(joints.shape)
        self._bones = PlaybackBones(playback, bones.tolist())
        self._rows = self._bones.rows(bones.tolist())
        bone_from_bind = np.linalg.inv(np.asarray(mesh.world_from_bone_bind, np.float64))[joints]
        self._bone_from_bind = bone_from_bind
        places_cm = np.asarray(mesh.vertices_cm, np.float64)[vertices]
        self._own_cm = np.einsum("vkab,vb->vka", bone_from_bind, np.pad(places_cm, ((0, 0), (0, 1)), constant_values=1))

    def _world(self, first: int, last: int) -> FloatArray:
        """Return the world transforms (B, 3, 4, f), centimetres, of the B bones that hold the vertices, in the frames
        from ``first`` to before ``last``."""
        world = self._bones.world(first, last)[self._rows]
        world[:, :, 3] /= METRES
        return world

    def fewer(self) -> tuple[FloatArray, FloatArray]:
        """Return weights (V, K) of V vertices on K bones with at most four non-zero ones, and bounds (V,) in
        millimetres of the vertices' deviations at all frames."""
        assert self._playback.clip is not None
        frames = self._playback.clip.frames
        places = np.unique(np.linspace(0, frames - 1, _POSES).astype(int)).tolist()
        world = np.concatenate([self._world(frame, frame + 1) for frame in places], axis=-1)
        carried = np.einsum("vkacf,vkc->fvka", world[self._carriers], self._own_cm)
        best, least = self._weights.copy(), np.full(len(self._weights), np.inf)
        for chosen in itertools.combinations(range(min(_STRONGEST, carried.shape[2])), MOST_INFLUENCES):
            weights = self._fitted(carried, chosen)
            off = self._off_mm(world, weights) + self._off_shaped_mm(weights)
            better = off < least
            best[better], least[better] = weights[better], off[better]
        worst = np.zeros(len(best))
        for first in range(0, frames, _CHUNK):
            worst = np.maximum(worst, self._off_mm(self._world(first, min(first + _CHUNK, frames)), best))
        return best, worst + self._off_shaped_mm(best)

    def fewer_exactly(self, rows: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return weights (R, K) of the R vertices ``rows`` as `fewer` does, each fitted alone to its positions with
        the morphs, and their largest deviations (R,) in millimetres at any frame.
        """
        if not len(rows):
            return self._weights[rows], np.zeros(0)
        frames = self._playback.clip.frames
        places = np.unique(np.linspace(0, frames - 1, _EXACT_POSES).astype(int))
        carried = np.concatenate([self._carried_cm(rows, frame, frame + 1) for frame in places.tolist()], axis=-1)
        best = np.stack([_nearest_four(one, own) for one, own in zip(carried, self._weights[rows], strict=True)])
        worst = np.zeros(len(rows))
        for first in range(0, frames, _CHUNK):
            carried = self._carried_cm(rows, first, min(first + _CHUNK, frames))
            off_cm = np.einsum("rk,rkaf->raf", best - self._weights[rows], carried)
            worst = np.maximum(worst, 10.0 * np.sqrt(np.einsum("raf,raf->rf", off_cm, off_cm).max(axis=-1)))
        return best, worst

    def _carried_cm(self, rows: IntArray, first: int, last: int) -> FloatArray:
        """Return the positions (R, K, 3, f) in centimetres to which each of its K bones alone would carry each of the
        vertices ``rows``, with the morphs, in the frames from ``first`` to before ``last``."""
        shifts = np.zeros((len(rows), 3, last - first))
        row_of = np.full(len(self._mesh.vertices_cm), -1)
        row_of[self._vertices[rows]] = np.arange(len(rows))
        for morph in self._mesh.morphs:
            curve = self._playback.clip.morph_weights.get(morph.name)
            here = row_of[morph.vertex_indices]
            if curve is not None and (here >= 0).any():
                deltas = np.asarray(morph.position_deltas_cm, np.float64)[here >= 0]
                shifts[here[here >= 0]] += deltas[..., None] * np.asarray(curve, np.float64)[first:last]
        own = np.repeat(self._own_cm[rows][..., None], last - first, axis=-1)
        own[:, :, :3] += np.einsum("rkab,rbf->rkaf", self._bone_from_bind[rows][:, :, :3, :3], shifts)
        return np.asarray(np.einsum("rkacf,rkcf->rkaf", self._world(first, last)[self._carriers[rows]], own))

    def _fitted(self, carried: FloatArray, chosen: tuple[int, ...]) -> FloatArray:
        """Return weights (V, K) of only the bones ``chosen`` that move each vertex as nearly as possible as before
        (least squares). ``carried`` has each vertex as moved by each bone alone.
        """
        first, *others = chosen
        # The weights sum to 1, so the first weight follows from the others.
        ways = carried[:, :, others] - carried[:, :, [first]]
        asked = np.einsum("vk,fvka->fva", self._weights, carried) - carried[:, :, first]
        squares = np.einsum("fvia,fvja->vij", ways, ways)
        sides = np.einsum("fvia,fva->vi", ways, asked)
        whole = self._weights[:, chosen].sum(axis=1, keepdims=True)
        before = self._weights[:, others] / np.maximum(whole, 1e-12)
        ridge = _RIDGE * np.maximum(np.trace(squares, axis1=1, axis2=2), 1e-12)
        squares += ridge[:, None, None] * np.eye(len(others))
        sides += ridge[:, None] * before
        found = np.linalg.solve(squares, sides[..., None])[..., 0]
        part = np.maximum(np.concatenate([1.0 - found.sum(axis=1, keepdims=True), found], axis=1), 0.0)
        result = np.zeros_like(self._weights)
        result[:, [first, *others]] = part / part.sum(axis=1, keepdims=True)
        return result

    def _off_mm(self, world: FloatArray, weights: FloatArray) -> AnyFloatArray:
        """Return the largest deviation (V,) in millimetres of the vertices with other ``weights`` (V, K), over the
        frames of ``world``.
        """
        points = np.zeros((len(weights), len(world), 4))
        changed = (weights - self._weights)[..., None] * self._own_cm
        np.add.at(points, (np.arange(len(weights))[:, None], self._carriers), changed)
        off_cm = np.tensordot(points, world, axes=((1, 2), (0, 2)))
        return np.asarray(10.0 * np.sqrt(np.einsum("vaf,vaf->vf", off_cm, off_cm).max(axis=-1)))

    def _off_shaped_mm(self, weights: FloatArray) -> FloatArray:
        """Return the additional deviation (V,) in millimetres that is possible with other weights, because bones also
        rotate the displacements by morphs.
        """
        off: FloatArray = np.abs(weights - self._weights).sum(axis=1) * self._shaped_mm
        return off
