"""Skeletons of other makers as lists of bones (``tests/data/skeletons``), and figures and faces that consist of names
only.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from app.rig.figure import Figure
from app.rig.mesh import Mesh, Morph

FOLDER = Path(__file__).parents[1] / "data" / "skeletons"


@dataclass(frozen=True)
class ListedBone:
    """A bone with its place in the world and the joint that it represents (empty: none)."""

    name: str
    parent: str
    place_m: tuple[float, float, float]
    joint: str


def listed(name: str) -> list[ListedBone]:
    """Read a list of ``tests/data/skeletons``."""
    bones = []
    for line in (FOLDER / f"{name}.tsv").read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            bone, parent, x, y, z, joint = line.split("\t")
            bones.append(ListedBone(bone, parent, (float(x), float(y), float(z)), joint))
    return bones


def figure_of(
    bones: Sequence[ListedBone],
    rename: Callable[[str], str] = lambda name: name,
    humanoid: dict[str, int] | None = None,
    skinned: Sequence[str] = (),
) -> Figure:
    """Make a figure with a vertex for each skinned bone; parents must precede their children."""
    at = {bone.name: index for index, bone in enumerate(bones)}
    parents = [at[bone.parent] if bone.parent else -1 for bone in bones]
    places = np.array([bone.place_m for bone in bones])
    meshes = (_dots(places[[at[name] for name in skinned]], [at[name] for name in skinned]),) if skinned else ()
    return Figure(
        file="list",
        origin="vrm1" if humanoid else "gltf",
        bone_names=tuple(rename(bone.name) for bone in bones),
        parents=tuple(parents),
        translations_m=places - np.where(np.array(parents)[:, None] >= 0, places[parents], 0.0),
        rotations=np.tile([0.0, 0.0, 0.0, 1.0], (len(bones), 1)),
        meshes=meshes,
        humanoid=humanoid or {},
    )


def _dots(places: np.ndarray, bones: Sequence[int], morphs: Sequence[Morph] = ()) -> Mesh:
    """Make a mesh without triangles whose vertices each belong to one bone."""
    count = len(bones)
    return Mesh(
        name="dots",
        positions_m=places.astype(np.float32),
        normals=np.tile(np.array([0.0, 0.0, 1.0], dtype=np.float32), (count, 1)),
        uvs=np.zeros((count, 2), dtype=np.float32),
        triangles=np.zeros((0, 3), dtype=np.int32),
        triangle_materials=np.zeros(0, dtype=np.int32),
        materials=(),
        joints=np.array(bones, dtype=np.int32)[:, None],
        weights=np.ones((count, 1), dtype=np.float32),
        morphs=tuple(morphs),
    )


def face_of(morphs: Sequence[str], expressions: dict[str, dict[str, float]] | None = None) -> Figure:
    """Make a figure of one bone whose mesh has morphs with these names."""
    place = np.array([[0.0, 1.5, 0.0]], dtype=np.float32)
    mesh = _dots(place, [0], [Morph(name, np.array([0], dtype=np.int32), place, None) for name in morphs])
    bones = [ListedBone("head", "", (0.0, 1.5, 0.0), "head")]
    return replace(figure_of(bones), meshes=(mesh,), expressions=expressions or {})
