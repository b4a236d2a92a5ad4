"""Skeletons as lists of bones: those of other makers in ``tests/data/skeletons``, and any BVH file's."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from app.rig.figure import Figure
from app.rig.model import Mesh, Morph

FOLDER = Path(__file__).parents[1] / "data" / "skeletons"


@dataclass(frozen=True)
class ListedBone:
    """A bone where it is in the world, and the joint it is known to be (empty: none)."""

    name: str
    parent: str
    place_m: tuple[float, float, float]
    joint: str


def listed(name: str) -> list[ListedBone]:
    """A list of ``tests/data/skeletons``."""
    bones = []
    for line in (FOLDER / f"{name}.tsv").read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            bone, parent, x, y, z, joint = line.split("\t")
            bones.append(ListedBone(bone, parent, (float(x), float(y), float(z)), joint))
    return bones


def bvh_bones(path: Path) -> list[ListedBone]:
    """The joints of a BVH file at rest, metres; its places are scaled to a figure of about 1.7 m."""
    names: list[str] = []
    parents: list[int] = []
    offsets: list[list[float]] = []
    stack: list[int] = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        word, *rest = line.split() or [""]
        if word in ("ROOT", "JOINT", "End"):
            parents.append(stack[-1] if stack else -1)
            stack.append(len(names))
            names.append(rest[0] if word != "End" else "")
            offsets.append([])
        elif word == "OFFSET":
            offsets[stack[-1]] = [float(number) for number in rest]
        elif word == "}":
            stack.pop()
        elif word == "MOTION":
            break
    places = np.array(offsets)
    places[0] = 0.0
    for bone, parent in enumerate(parents):
        if parent >= 0:
            places[bone] += places[parent]
    places *= 1.7 / np.ptp(places[:, 1])
    places[:, 1] -= places[:, 1].min()
    return [
        ListedBone(name, names[parent] if parent >= 0 else "", (float(x), float(y), float(z)), "")
        for name, parent, (x, y, z) in zip(names, parents, places, strict=True)
        if name
    ]


def figure_of(
    bones: Sequence[ListedBone],
    rename: Callable[[str], str] = lambda name: name,
    humanoid: dict[str, int] | None = None,
    skinned: Sequence[str] = (),
) -> Figure:
    """A figure, with a vertex for each of the skinned bones; a parent must be before its children."""
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
    """A mesh without triangles whose vertices each hang on one bone."""
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
    """A figure of one bone whose mesh has morphs of these names."""
    place = np.array([[0.0, 1.5, 0.0]], dtype=np.float32)
    mesh = _dots(place, [0], [Morph(name, np.array([0], dtype=np.int32), place, None) for name in morphs])
    bones = [ListedBone("head", "", (0.0, 1.5, 0.0), "head")]
    return replace(figure_of(bones), meshes=(mesh,), expressions=expressions or {})
