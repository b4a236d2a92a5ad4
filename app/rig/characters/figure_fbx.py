"""Reading of figures from FBX files.

The rest pose is the bind pose of the skins, as in Unreal, if all skins agree; else the pose of the nodes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray, IntArray, SingleArray
from app.errors import FileError
from app.formats.fbx.foreign import FbxCluster, FbxContent, FbxMesh, FbxNode, read_foreign_fbx
from app.formats.fbx.foreign_textures import FbxTextures
from app.formats.scene import Material
from app.rig.characters.figure_build import (
    SINGULAR,
    FigurePart,
    NodeHierarchy,
    build_figure,
    rest_pose,
    transforms_differ,
)
from app.rig.figure import Figure
from app.rig.mesh import Mesh, Morph

MOST_INFLUENCES: Final = 16
FREE_MOVES: Final = 2**19
MOST_VERTICES_OF_POINT: Final = 16


def fbx_figure(path: Path) -> Figure:
    """Read a figure from an FBX file. Raises FileError."""
    content = read_foreign_fbx(path)
    bound = _bind_pose(content)
    posed = np.array([node.world_from_node for node in content.nodes])
    world = rest_pose([node.parent for node in content.nodes], posed, bound)
    parts: list[FigurePart] = []
    hidden = _hidden(content.nodes)
    textures = FbxTextures(path, content)
    for mesh in content.meshes:
        parts += _parts(mesh, textures, content.nodes, world, hidden)
    nodes = NodeHierarchy(
        names=[node.name for node in content.nodes],
        parents=[node.parent for node in content.nodes],
        world_from_node=world,
        joints={index for index, node in enumerate(content.nodes) if node.kind == "BONE"}
        | {cluster.node for mesh in content.meshes for skin in mesh.skins for cluster in skin},
        other={index for index, node in enumerate(content.nodes) if node.kind not in ("BONE", "EMPTY", "UNKNOWN")},
        skipped={0},
    )
    return build_figure(str(path), "fbx", nodes, parts)


def fbx_images(path: Path) -> dict[str, bytes]:
    """Read the images beside an FBX file that it uses, by name. Raises FileError."""
    content = read_foreign_fbx(path)
    textures = FbxTextures(path, content)
    for mesh in content.meshes:
        for material in mesh.materials:
            textures.material(material)
    return textures.beside


def _bind_pose(content: FbxContent) -> Mapping[int, FloatArray]:
    """Return the world transform (4, 4) of each bone in the pose in which its skin was bound, by bone; empty if skins
    contradict each other.
    """
    bound: dict[int, FloatArray] = {}
    for mesh in content.meshes:
        for skin in mesh.skins:
            whole: FloatArray | None = None
            for cluster in skin:
                if abs(np.linalg.det(cluster.world_from_bone)) < SINGULAR:
                    return {}
                known = bound.setdefault(cluster.node, cluster.world_from_bone)
                placed = cluster.world_from_bone @ cluster.bone_from_mesh
                whole = placed if whole is None else whole
                if transforms_differ(known, cluster.world_from_bone) or transforms_differ(whole, placed):
                    return {}
    return bound


def _hidden(nodes: tuple[FbxNode, ...]) -> frozenset[int]:
    """Return the hidden nodes: invisible ones, and all but the first level of detail in each group."""
    hidden: set[int] = set()
    grouped: set[int] = set()
    for index, node in enumerate(nodes):
        if node.parent in hidden or not node.visible:
            hidden.add(index)
        elif node.parent >= 0 and nodes[node.parent].kind == "LOD_GROUP":
            if node.parent in grouped:
                hidden.add(index)
            grouped.add(node.parent)
    return frozenset(hidden)


def _parts(
    mesh: FbxMesh,
    textures: FbxTextures,
    nodes: tuple[FbxNode, ...],
    world: FloatArray,
    hidden: frozenset[int],
) -> list[FigurePart]:
    shown = [node for node in mesh.nodes if node not in hidden]
    if not len(mesh.points) or not len(mesh.faces) or not shown:
        return []
    clusters = [cluster for skin in mesh.skins for cluster in skin if len(cluster.points)]
    built, points = _triangulated(mesh, textures)
    if clusters:
        joints, weights = _influences(clusters, len(mesh.points))
        table = np.array([world[cluster.node] @ cluster.bone_from_mesh for cluster in clusters])
        own = tuple(cluster.node for cluster in clusters)
        return [FigurePart(replace(built, joints=joints[points], weights=weights[points]), own, table)]
    count = len(built.positions_m)
    rigid = replace(built, joints=np.zeros((count, 1), np.int32), weights=np.ones((count, 1), np.float32))
    parts = []
    for node in shown:
        posed = nodes[node]
        if abs(np.linalg.det(posed.world_from_node)) > SINGULAR:
            place = world[node] @ np.linalg.inv(posed.world_from_node) @ posed.world_from_geometry
            parts.append(FigurePart(rigid, (node,), place[None]))
    return parts


def _influences(clusters: list[FbxCluster], count: int) -> tuple[npt.NDArray[np.int32], SingleArray]:
    """Return the indices of clusters (each of one bone) and their weights (P, K) for P points of an FBX mesh, heaviest
    first.

    K is the greatest number of clusters at any point.
    """
    points = np.concatenate([cluster.points for cluster in clusters])
    weights = np.concatenate([cluster.weights[: len(cluster.points)] for cluster in clusters])
    owners = np.repeat(np.arange(len(clusters)), [len(cluster.points) for cluster in clusters])
    order = np.lexsort((-weights, points))
    points, weights, owners = points[order], weights[order], owners[order]
    place = np.arange(len(points)) - np.searchsorted(points, points)
    width = min(int(place.max(initial=0)) + 1, MOST_INFLUENCES)
    kept = place < width
    joints, shares = np.zeros((count, width), np.int32), np.zeros((count, width), np.float32)
    joints[points[kept], place[kept]] = owners[kept]
    shares[points[kept], place[kept]] = weights[kept]
    return joints, shares


def _triangulated(mesh: FbxMesh, textures: FbxTextures) -> tuple[Mesh, IntArray]:
    """Return a mesh without skin that has a vertex for each combination of point, normal and texture coordinate, and
    for each vertex (V,) the index of its point."""
    corners = mesh.corners
    normals = np.zeros((len(corners), 3)) if mesh.normals is None else mesh.normals
    uvs = np.zeros((len(corners), 2)) if mesh.uvs is None else mesh.uvs
    keys = np.column_stack([corners, np.round(normals * 1e3), np.round(np.clip(uvs, -1e6, 1e6) * 1e5)]).astype(np.int64)
    _, first, vertex_of_corner = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    vertex_of_corner = vertex_of_corner.reshape(-1)
    points = corners[first]
    triangles, owners = _fans(mesh.faces)
    texture = uvs[first]
    texture[:, 1] = 1.0 - texture[:, 1]
    surfaces = tuple(map(textures.material, mesh.materials))
    built = Mesh(
        name=mesh.name,
        positions_m=mesh.points[points].astype(np.float32),
        normals=normals[first].astype(np.float32),
        uvs=texture.astype(np.float32),
        triangles=vertex_of_corner[triangles].astype(np.int32),
        triangle_materials=mesh.face_materials[owners].astype(np.int32),
        materials=surfaces or (Material("default", (0.8, 0.8, 0.8, 1.0), 0.0, 0.8),),
        joints=np.zeros((len(points), 1), np.int32),
        weights=np.zeros((len(points), 1), np.float32),
        morphs=_morphs(textures.file, mesh, points),
    )
    return built, points


def _fans(faces: IntArray) -> tuple[IntArray, IntArray]:
    """Return the corners (T, 3) of the T triangles into which polygons are divided, and the polygon (T,) of each."""
    counts = np.maximum(faces[:, 1] - 2, 0)
    owners = np.repeat(np.arange(len(faces)), counts)
    step = np.arange(len(owners)) - np.repeat(np.cumsum(counts) - counts, counts)
    begin = faces[owners, 0]
    return np.column_stack([begin, begin + step + 1, begin + step + 2]), owners


def _morphs(file: str, mesh: FbxMesh, points: IntArray) -> tuple[Morph, ...]:
    order = np.argsort(points, kind="stable")
    ranked = points[order]
    found: dict[str, Morph] = {}
    last: dict[str, int] = {}
    # A point becomes a vertex for each of its normals and texture coordinates; the number is unlimited for single
    # points only.
    left = FREE_MOVES + MOST_VERTICES_OF_POINT * sum(len(morph.points) for morph in mesh.morphs)
    for morph in mesh.morphs:
        touched, place = np.unique(morph.points, return_inverse=True)
        moved = np.zeros((len(touched), 3))
        np.add.at(moved, place.reshape(-1), morph.deltas)
        begin, end = np.searchsorted(ranked, touched), np.searchsorted(ranked, touched, side="right")
        left -= int((end - begin).sum())
        if left < 0:
            raise FileError("figure.too_large", file=file)
        vertices = np.sort(order[np.repeat(begin, end - begin) + _counted(end - begin)])
        name, number = morph.name, last.get(morph.name, 1)
        while name in found:
            number += 1
            name = f"{morph.name}_{number}"
        last[morph.name] = number
        deltas = moved[np.searchsorted(touched, points[vertices])]
        found[name] = Morph(name, vertices.astype(np.int32), deltas.astype(np.float32), None)
    return tuple(found.values())


def _counted(counts: IntArray) -> IntArray:
    """Return 0 to n - 1 for each n in ``counts``, concatenated."""
    result: IntArray = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    return result
