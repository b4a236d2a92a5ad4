"""Assets of MakeHuman (hair, brows, lashes, teeth, suits, shoes) fitted onto any body of its base mesh.

A `.mhclo` binds every vertex of its `.obj` to three vertices of the base mesh `hm08`, helper geometry included: shares
of the three, and an offset that grows with the body along each axis (two vertices and the distance between them in the
base mesh). The same binding carries skin weights and the shapes of the face. `.mhmat` names the textures.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from character_surface import Surface, modelled, split_seams, triangulate

if TYPE_CHECKING:
    from character_skeleton import SkeletonFit
    from character_source import Source

HM08_VERTICES = 19158
LEAST_WEIGHT = 1e-4
_AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Binding:
    """N vertices bound to a base mesh: a plain value, so that any shape of the base mesh gives theirs.

    Attributes
    ----------
    corners : (N, 3) base vertices.
    shares : (N, 3) their shares, rows sum to 1; a vertex beside its triangle has negative ones.
    offsets : (N, 3) offsets in units of the reference distances' own mesh (decimetres).
    scale_pairs : (3, 2) base vertices per axis, the distance of which along that axis scales the offsets.
    scale_lengths : (3,) those distances where the offsets count as they are (decimetres).
    """

    corners: np.ndarray
    shares: np.ndarray
    offsets: np.ndarray
    scale_pairs: np.ndarray
    scale_lengths: np.ndarray

    def carried(self, values: np.ndarray) -> np.ndarray:
        """(N, K) values of the bound vertices from (V, K) ones of the base mesh, by the shares alone."""
        return np.einsum("nc,nck->nk", self.shares, values[self.corners])

    def scale(self, vertices: np.ndarray) -> np.ndarray:
        """(3,) lengths per unit of offset on a body with (V, 3) vertices."""
        ends = vertices[self.scale_pairs]
        axes = np.arange(3)
        return np.abs(ends[axes, 0, axes] - ends[axes, 1, axes]) / self.scale_lengths

    def positions(self, vertices: np.ndarray) -> np.ndarray:
        """(N, 3) places on a body with (V, 3) vertices."""
        return self.carried(vertices) + self.offsets * self.scale(vertices)

    def skin_weights(self, weights: np.ndarray) -> np.ndarray:
        """(N, J) skin weights from the base mesh's (V, J): none negative, none tiny, rows sum to 1."""
        carried = self.carried(weights)
        carried[carried < LEAST_WEIGHT] = 0.0
        return carried / carried.sum(axis=1, keepdims=True)

    def at(self, rows: np.ndarray) -> Binding:
        """The binding of some of the vertices, in the order of `rows`."""
        return Binding(self.corners[rows], self.shares[rows], self.offsets[rows], self.scale_pairs, self.scale_lengths)


@dataclass(frozen=True)
class AssetMaterial:
    """Textures that a `.mhmat` names, by its own keywords (`diffuseTexture`, `normalmapTexture` ...)."""

    name: str
    textures: Mapping[str, Path]


@dataclass(frozen=True)
class Asset:
    """One `.mhclo` with its `.obj`.

    Attributes
    ----------
    binding : the N vertices' binding to the base mesh.
    faces, uv_faces : (F, 4) vertices and texture coordinates of the corners; a triangle has its last corner twice.
    uvs : (T, 2), origin at the lower left.
    deleted : (D,) base vertices under the asset, which are not to be shown.
    material : the `.mhmat` beside it, None where the file names none that exists.
    """

    name: str
    binding: Binding
    faces: np.ndarray
    uv_faces: np.ndarray
    uvs: np.ndarray
    deleted: np.ndarray
    material: Path | None


def _ranges(words: list[str]) -> list[int]:
    """Indices of a list such as `3 - 5 8`, both ends of a range included."""
    numbers: list[int] = []
    until = False
    for word in words:
        if word == "-":
            until = True
        elif until:
            numbers.extend(range(numbers[-1] + 1, int(word) + 1))
            until = False
        else:
            numbers.append(int(word))
    return numbers


def _bound(words: list[str]) -> list[float]:
    """The nine numbers of a vertex: three base vertices, shares, offset; a lone number is a base vertex itself."""
    if len(words) == 1:
        return [float(words[0])] * 3 + [1.0, 0.0, 0.0] + [0.0, 0.0, 0.0]
    if len(words) != 9:
        raise ValueError(f"a vertex is bound by 1 or 9 numbers, not by {len(words)}: {' '.join(words)}")
    return [float(word) for word in words]


def _read_obj(path: Path) -> tuple[int, np.ndarray, np.ndarray, np.ndarray]:
    """Number of vertices, texture coordinates, and the corners of the faces in both."""
    count = 0
    uvs: list[list[float]] = []
    corners: list[list[list[int]]] = []
    for line in path.read_text(encoding="utf-8").splitlines():
        keyword, *words = line.split() or [""]
        if keyword == "v":
            count += 1
        elif keyword == "vt":
            uvs.append([float(word) for word in words[:2]])
        elif keyword == "f":
            face = [[int(part) - 1 for part in word.split("/")[:2]] for word in words]
            if len(face) not in (3, 4):
                raise ValueError(f"{path} has a face of {len(face)} corners")
            corners.append(face if len(face) == 4 else [*face, face[-1]])
    table = np.array(corners, dtype=np.int64)
    return count, np.array(uvs), table[:, :, 0], table[:, :, 1]


def read_asset(path: Path, base_vertices: int = HM08_VERTICES) -> Asset:
    """A `.mhclo` and the `.obj` that it names.

    Raises
    ------
    ValueError
        If the two have different numbers of vertices, a scale is missing, or a vertex is none of the base mesh.
    """
    header: dict[str, list[str]] = {}
    rows: list[list[float]] = []
    deleted: list[str] = []
    section = ""
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        if words[0] in ("verts", "delete_verts"):
            section = words[0]
        elif words[0][0].isalpha():
            # Keywords may come between `verts` and its numbers.
            header[words[0]] = words[1:]
        elif section == "verts":
            rows.append(_bound(words))
        elif section == "delete_verts":
            deleted.extend(words)
    count, uvs, faces, uv_faces = _read_obj(path.parent / header["obj_file"][0])
    if count != len(rows):
        raise ValueError(f"{path} binds {len(rows)} vertices, its mesh has {count}")
    missing = [axis for axis in _AXES if f"{axis}_scale" not in header]
    if missing:
        raise ValueError(f"{path} has no scale along {', '.join(missing)}")
    table = np.array(rows)
    scales = [header[f"{axis}_scale"] for axis in _AXES]
    binding = Binding(
        corners=table[:, :3].astype(np.int64),
        shares=table[:, 3:6] / table[:, 3:6].sum(axis=1, keepdims=True),
        offsets=table[:, 6:9],
        scale_pairs=np.array([[int(word) for word in words[:2]] for words in scales]),
        scale_lengths=np.array([float(words[2]) for words in scales]),
    )
    if binding.corners.min() < 0 or max(binding.corners.max(), binding.scale_pairs.max()) >= base_vertices:
        raise ValueError(f"{path} is bound to vertices that the base mesh does not have")
    material = path.parent / header["material"][0] if header.get("material") else None
    return Asset(
        name=" ".join(header.get("name", [path.stem])),
        binding=binding,
        faces=faces,
        uv_faces=uv_faces,
        uvs=uvs,
        deleted=np.array(sorted(set(_ranges(deleted))), dtype=np.int64),
        material=material if material is not None and material.is_file() else None,
    )


def read_material(path: Path) -> AssetMaterial:
    """The textures of a `.mhmat` that lie beside it."""
    name, textures = path.stem, {}
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if len(words) > 1 and words[0] == "name":
            name = " ".join(words[1:])
        elif len(words) > 1 and words[0].endswith("Texture"):
            texture = path.parent / words[1]
            if texture.is_file():
                textures[words[0]] = texture
    return AssetMaterial(name, textures)


def asset_surface(
    asset: Asset, source: Source, fit: SkeletonFit, name: str, material: str, *, morphs: bool = False
) -> Surface:
    """An asset on a body, skinned like the skin beneath it, with the shapes of the face where `morphs` is true.

    One vertex per place in the texture; normals are smooth across the seams of the texture.
    """
    vertex, uv_index, faces = split_seams(asset.faces, asset.uv_faces)
    binding = asset.binding.at(vertex)
    positions = binding.positions(source.vertices)
    shapes = (
        {label: binding.carried(delta) for label, delta in zip(source.morph_names, source.morph_deltas, strict=True)}
        if morphs
        else {}
    )
    return modelled(
        name,
        positions,
        binding.skin_weights(fit.weights),
        {material: triangulate(faces, positions)},
        uvs=asset.uvs[uv_index],
        morphs=shapes,
    )
