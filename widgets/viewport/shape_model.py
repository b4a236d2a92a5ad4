"""Drawable parts of an object: vertices, surfaces and triangles for the graphics card, and face morphs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from threading import Lock

import numpy as np
import numpy.typing as npt

from app.arrays import SingleArray
from app.formats.scene import Material

BONES_PER_VERTEX = 6
"""Greatest number of bones that move a vertex, of which the first ``FIRST_BONES`` have attributes of their own."""
FIRST_BONES = 4

SHAPE = np.dtype([("a_position", np.float32, 3), ("a_normal", np.float32, 3)])
SURFACE = np.dtype(
    [
        ("a_bones", np.float32, FIRST_BONES),
        ("a_weights", np.float32, FIRST_BONES),
        ("a_more_bones", np.float32, BONES_PER_VERTEX - FIRST_BONES),
        ("a_more_weights", np.float32, BONES_PER_VERTEX - FIRST_BONES),
        ("a_color", np.float32, 4),
        ("a_metallic", np.float32),
    ]
)


@dataclass(frozen=True, eq=False)
class MorphTargets:
    """Morph targets for the first vertices of a geometry.

    Attributes
    ----------
    count : int
        Number of vertices that any morph moves; they are the first ones of the geometry.
    names : tuple of str
        Names of the morphs.
    targets : tuple of ((K,) int32, (K, 6) float32)
        Moved vertices of each morph, with displacement and change of normal as in `SHAPE`.
    rest : (count, 6) float32
        Position and normal of these vertices at rest.
    """

    count: int
    names: tuple[str, ...]
    targets: tuple[tuple[npt.NDArray[np.int32], SingleArray], ...]
    rest: SingleArray

    def morphed(self, weights: SingleArray) -> npt.NDArray[np.void]:
        """Return the first vertices, morphed by weights (len(names),), as `SHAPE` records."""
        shape = self.rest.copy()
        for index in np.flatnonzero(np.abs(weights) > 1e-4).tolist():
            vertices, deltas = self.targets[index]
            shape[vertices] += weights[index] * deltas
        return shape.view(SHAPE).reshape(-1)


@dataclass(frozen=True, eq=False)
class Geometry:
    """Vertices and triangles of an object at one level of detail, as the graphics card receives them.

    Attributes
    ----------
    shape : (V,) SHAPE
        Vertices at rest, in the space that the bones' matrices transform.
    surfaces : (S,) SURFACE
        Bones as indices into a player's matrices; linear base colour with roughness; metallic.
    triangles : (T, 3) uint16 or uint32
        Triangles; one-sided ones first.
    one_sided : int
        Number of one-sided triangles.
    face : MorphTargets or None
        Morphs of the face; None if there are none.
    surface_of : (V,) uint16 or None
        Index of each vertex's surface, since rigid objects have few. None if each vertex has its own.
    uvs : (V, 2) float32 or None
        Texture coordinates with v pointing down, if there are textures.
    groups : (G, 3) int32 or None
        Ranges of consecutive triangles with one look: first triangle, number of triangles, index of the look; -1 for
        vertex colours. None if all use vertex colours.
    looks : tuple of Material
        Materials with textures, to which ``groups`` refer.
    """

    shape: npt.NDArray[np.void]
    surfaces: npt.NDArray[np.void]
    triangles: npt.NDArray[np.uint16] | npt.NDArray[np.uint32]
    one_sided: int
    face: MorphTargets | None = None
    surface_of: npt.NDArray[np.uint16] | None = None
    uvs: SingleArray | None = None
    groups: npt.NDArray[np.int32] | None = None
    looks: tuple[Material, ...] = ()

    @property
    def surface(self) -> npt.NDArray[np.void]:
        """Return the surface of every vertex as records (V,) of the type SURFACE."""
        if self.surface_of is None:
            return self.surfaces
        return numbers(self.surfaces).take(self.surface_of, axis=0).view(SURFACE).reshape(-1)


class LevelsOfDetail:
    """Levels of detail of a character or instrument, finest first. Only the coarsest is made at once: the others are
    seen of few performers of a large band, and take several times as long.

    Parameters
    ----------
    coarsest : Geometry
        The coarsest level, without morphs.
    count : int
        Number of levels.
    make : callable
        Makes the finer levels; called once, in any thread.
    """

    def __init__(self, coarsest: Geometry, count: int, make: Callable[[], tuple[Geometry, ...]]) -> None:
        self.coarsest = coarsest
        self._count, self._make = count, make
        self._finer: tuple[Geometry, ...] = ()
        self._lock = Lock()

    @property
    def made(self) -> tuple[Geometry, ...]:
        """The levels that are made so far, in any order."""
        return (*self._finer, self.coarsest)

    @property
    def is_complete(self) -> bool:
        """True if all levels are made."""
        return len(self.made) == self._count

    def complete(self) -> None:
        """Make the finer levels if they are missing."""
        with self._lock:
            if not self.is_complete:
                self._finer = self._make()
                self._make = tuple

    def __iter__(self) -> Iterator[Geometry]:
        return (self[level] for level in range(self._count))

    def __getitem__(self, level: int) -> Geometry:
        if level in (-1, self._count - 1):
            return self.coarsest
        self.complete()
        return (*self._finer, self.coarsest)[level]


def numbers(records: npt.NDArray[np.void]) -> SingleArray:
    """Return records of 32-bit floats as rows (N, columns) that share their memory."""
    return records.view(np.float32).reshape(len(records), -1)
