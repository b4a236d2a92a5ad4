"""Conversion of a file's content to a figure, from nodes with scales and meshes in different spaces.

Scales are applied to the geometry, and every vertex is moved to its world position at rest.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.errors import FileError, Message
from app.formats.unique_names import numbered
from app.rig import quaternion
from app.rig.characters.bone_placements import local_placements
from app.rig.figure import Figure, Origin
from app.rig.mesh import Mesh, Morph, scaled_mesh

MOST_BONES: Final = 5000
MOST_VERTICES: Final = 3_000_000
PLAUSIBLE_M: Final = (0.3, 4.0)
"""Plausible heights of figures in metres, from a doll to a giant."""
TALLEST_M: Final = 2.5
"""Height in metres above any person with a hat: a taller figure is accepted with a note."""
ODD_HEIGHT: Final = "figure.odd_height"
"""Id of the note about a figure of implausible height that no unit explains."""
PERSON_M: Final = (0.9, 2.3)
GROWN_M: Final = (1.4, 2.1)
"""Heights in metres that a corrected unit must produce; the units are powers of ten and inches."""
INCH_M: Final = 0.0254
AGREEMENT: Final = 1e-3
"""Largest relative difference of transforms that count as equal."""
SINGULAR: Final = 1e-18
"""Determinant of a transform below which it is degenerate."""


@dataclass(frozen=True, eq=False)
class NodeHierarchy:
    """Nodes of a file with their parents and rest transforms.

    Attributes
    ----------
    parents : sequence of int
        Parents in any order; -1 for none.
    world_from_node : (N, 4, 4) float64
        Transforms at rest, including scales.
    joints : collection of int
        Nodes that the file uses as bones: of skins or of the humanoid.
    other : collection of int
        Nodes that are never bones: meshes, cameras, lights.
    skipped : collection of int
        Root node of the file, which is omitted.
    posed : (N, 4, 4) float64 or None
        Transforms of the nodes as stored in a VRM file, which is its T-pose.
    """

    names: Sequence[str]
    parents: Sequence[int]
    world_from_node: FloatArray
    joints: Collection[int]
    other: Collection[int]
    skipped: Collection[int] = ()
    posed: FloatArray | None = None


@dataclass(frozen=True, eq=False)
class FigurePart:
    """A mesh in its own space, and the nodes that move it.

    Attributes
    ----------
    mesh : Mesh
        Mesh whose `Mesh.joints` are indices in `nodes`.
    nodes : tuple of int
        Nodes of the file that move the mesh, M of them.
    world_from_mesh : (M, 4, 4) float64
        Transform of the mesh's space for each of these nodes, at rest.
    """

    mesh: Mesh
    nodes: tuple[int, ...]
    world_from_mesh: FloatArray


def build_figure(
    file: str,
    origin: Origin,
    nodes: NodeHierarchy,
    parts: Sequence[FigurePart],
    humanoid: Mapping[str, int] | None = None,
    expressions: Mapping[str, Mapping[str, float]] | None = None,
) -> Figure:
    """Return a figure built from nodes and meshes.

    Parameters
    ----------
    file : str
        Name of the file, for messages.
    origin : str
        Format of the file.
    nodes : NodeHierarchy
        All nodes of the file.
    parts : sequence of FigurePart
        Meshes and the nodes that move them.
    humanoid : mapping of str to int
        Node of each VRM 1.0 joint that the file names.
    expressions : mapping of str to mapping of str to float, optional
        Weights of morphs in each expression of the file.

    Raises
    ------
    FileError
        There are no bones, or the counts exceed those of any character.
    """
    if len(nodes.names) > MOST_BONES or sum(len(part.mesh.positions_m) for part in parts) > MOST_VERTICES:
        raise FileError("figure.too_large", file=file)
    if not np.isfinite(nodes.world_from_node).all():
        raise FileError("model.invalid", file=file, detail="a bone's transform is not finite")
    listed = _bones(nodes)
    if not listed:
        raise FileError("figure.no_bones", file=file)
    bone_of = {node: bone for bone, node in enumerate(listed)}
    above = [_nearest_above(nodes, node, bone_of) for node in range(len(nodes.names))]
    parents = tuple(-1 if nodes.parents[node] < 0 else above[nodes.parents[node]] for node in listed)
    world = nodes.world_from_node[listed]
    rotations, positions = nearest_rotations(world), world[:, :3, 3]
    translations, turns = local_placements(parents, positions, rotations)
    posed = None
    if nodes.posed is not None and np.isfinite(nodes.posed).all():
        standing = nodes.posed[listed]
        _, posed = local_placements(parents, standing[:, :3, 3], nearest_rotations(standing))
    figure = Figure(
        file=file,
        origin=origin,
        bone_names=numbered((nodes.names[node] or f"node_{node}" for node in listed), key=str),
        parents=parents,
        translations_m=translations,
        rotations=turns,
        meshes=_named_apart([_at_rest(part, above) for part in parts]),
        humanoid={joint: bone_of[node] for joint, node in (humanoid or {}).items() if node in bone_of},
        expressions=expressions or {},
        posed=posed,
        notes=tuple(note for part in parts if (note := _unheld(part, file)) is not None),
    )
    return _in_metres(figure)


def transforms_differ(a: FloatArray, b: FloatArray) -> bool:
    """Return whether two transforms (4, 4) differ too much to be of the same bone in the same pose."""
    return bool(np.abs(a - b).max() > AGREEMENT * max(1e-6, float(np.abs(a[:3]).max())))


def rest_pose(parents: Sequence[int], posed: FloatArray, bound: Mapping[int, FloatArray]) -> FloatArray:
    """Return rest transforms (N, 4, 4): joints in the pose in which their skin was bound, other nodes relative to them.

    The result is the bind pose of the skin: only there skinning changes nothing, whereas in any other pose vertices
    with several bones would already be blended.

    Parameters
    ----------
    parents : sequence of int
        Parents in any order; -1 for none.
    posed : (N, 4, 4) float64
        World transforms of the nodes as stored in the file.
    bound : mapping of int to (4, 4) float64
        World transforms of nodes when their skin was bound.
    """
    world = posed.copy()
    children: dict[int, list[int]] = {}
    for node, parent in enumerate(parents):
        children.setdefault(parent, []).append(node)
    pending = list(children.get(-1, []))
    while pending:
        node = pending.pop()
        pending.extend(children.get(node, []))
        parent = parents[node]
        if node in bound:
            world[node] = bound[node]
        elif parent >= 0 and abs(np.linalg.det(posed[parent])) > SINGULAR:
            world[node] = world[parent] @ np.linalg.inv(posed[parent]) @ posed[node]
    return world


def turned(
    nodes: NodeHierarchy, parts: Sequence[FigurePart], turn: FloatArray
) -> tuple[NodeHierarchy, tuple[FigurePart, ...]]:
    """Return nodes and meshes of a figure with the world rotated by a matrix (4, 4)."""
    return (
        replace(
            nodes,
            world_from_node=turn @ nodes.world_from_node,
            posed=None if nodes.posed is None else turn @ nodes.posed,
        ),
        tuple(replace(part, world_from_mesh=turn @ part.world_from_mesh) for part in parts),
    )


def _bones(nodes: NodeHierarchy) -> list[int]:
    """Return the nodes that become bones, parents first, children in the file's order.

    Bones are the nodes that the file uses as bones, their ancestors, and their descendants without another purpose. In
    a file without skins all nodes are bones.
    """
    children: dict[int, list[int]] = {}
    for node, parent in enumerate(nodes.parents):
        children.setdefault(parent, []).append(node)
    order: list[int] = []
    pending = list(reversed(children.get(-1, [])))
    while pending:
        node = pending.pop()
        order.append(node)
        pending.extend(reversed(children.get(node, [])))
    joints = set(nodes.joints) or set(order)
    below = set(joints)
    for node in order:
        if nodes.parents[node] in below and node not in nodes.other:
            below.add(node)
    chosen = set(below)
    for node in reversed(order):
        if node in chosen and nodes.parents[node] >= 0:
            chosen.add(nodes.parents[node])
    return [node for node in order if node in chosen and node not in nodes.skipped]


def _nearest_above(nodes: NodeHierarchy, node: int, bone_of: Mapping[int, int]) -> int:
    """Return the bone of a node or of its nearest ancestor with a bone; -1 if there is none."""
    while node >= 0 and node not in bone_of:
        node = nodes.parents[node]
    return bone_of.get(node, -1)


def nearest_rotations(world: FloatArray) -> FloatArray:
    """Return the rotations (N, 4) nearest to N transforms (N, 4, 4) that may also scale, shear and mirror."""
    left, _, right = np.linalg.svd(world[:, :3, :3])
    left[:, :, 2] *= np.linalg.det(left @ right)[:, None]
    return quaternion.from_matrix(left @ right)


def _named_apart(meshes: Sequence[Mesh]) -> tuple[Mesh, ...]:
    names = numbered((mesh.name or "mesh" for mesh in meshes), key=str)
    return tuple(replace(mesh, name=name) for mesh, name in zip(meshes, names, strict=True))


def _unheld(part: FigurePart, file: str) -> Message | None:
    """Return a note for the user if vertices of a skinned mesh have no bones; None otherwise."""
    count = int((part.mesh.weights.sum(axis=1) <= 0.0).sum())
    if not count:
        return None
    return Message("figure.unheld", {"file": file, "mesh": part.mesh.name, "count": count})


def _at_rest(part: FigurePart, above: Sequence[int]) -> Mesh:
    """Return the mesh of a figure's part with its vertices in world space at rest.

    ``above`` has the bone of each node of the file; the indices in `Mesh.joints` of the result are these bones.
    """
    mesh = part.mesh
    weights = np.maximum(mesh.weights.astype(np.float64), 0.0)
    total = weights.sum(axis=1)
    bones = np.array([max(above[node], 0) for node in part.nodes], dtype=np.int32)
    # A vertex without weights follows the root bone, so that it is not left behind.
    weights[total <= 0.0] = np.eye(1, weights.shape[1])
    weights /= weights.sum(axis=1, keepdims=True)
    joints = np.where(total[:, None] > 0.0, mesh.joints, int(np.argmin(bones)))
    matrices = part.world_from_mesh[:, :3, :]
    blended = np.zeros((len(joints), 3, 4))
    for column in range(joints.shape[1]):
        used = weights[:, column] > 0.0
        blended[used] += weights[used, column, None, None] * matrices[joints[used, column]]
    turn = blended[:, :, :3]
    positions = np.einsum("vij,vj->vi", turn, mesh.positions_m.astype(np.float64)) + blended[:, :, 3]
    across = np.stack([np.cross(turn[:, :, i - 2], turn[:, :, i - 1]) for i in range(3)], axis=2)
    mirrored = np.linalg.det(turn) < 0.0
    size = np.maximum(np.cbrt(np.abs(np.linalg.det(turn))), 1e-12)
    across /= (np.where(mirrored, -1.0, 1.0) * size**2)[:, None, None]
    normals = np.einsum("vij,vj->vi", across, mesh.normals.astype(np.float64))
    triangles = mesh.triangles
    if len(triangles):
        inside_out = mirrored[triangles[:, 0]]
        triangles = np.where(inside_out[:, None], triangles[:, ::-1], triangles)
    return replace(
        mesh,
        positions_m=positions.astype(np.float32),
        normals=_unit(normals).astype(np.float32),
        triangles=triangles,
        joints=bones[joints],
        weights=weights.astype(np.float32),
        morphs=tuple(_morph_at_rest(morph, turn, across) for morph in mesh.morphs),
    )


def _morph_at_rest(morph: Morph, turn: FloatArray, across: FloatArray) -> Morph:
    rows = morph.vertices
    normals = morph.normal_deltas
    return Morph(
        name=morph.name,
        vertices=rows,
        deltas_m=np.einsum("vij,vj->vi", turn[rows], morph.deltas_m.astype(np.float64)).astype(np.float32),
        normal_deltas=None
        if normals is None
        else np.einsum("vij,vj->vi", across[rows], normals.astype(np.float64)).astype(np.float32),
    )


def _unit(vectors: FloatArray) -> FloatArray:
    result: FloatArray = vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-12)
    return result


def _in_metres(figure: Figure) -> Figure:
    """Return the figure scaled to a plausible height, if exactly one unit explains its height."""
    height_m = figure_height(figure)
    if height_m is None:
        return figure
    if PLAUSIBLE_M[0] <= height_m <= TALLEST_M:
        return figure
    factor = unit_factor(height_m) if height_m > PLAUSIBLE_M[1] or height_m < PLAUSIBLE_M[0] else None
    if factor is None:
        note = Message(ODD_HEIGHT, {"file": figure.file, "height_m": round(height_m, 4)})
        return replace(figure, notes=(*figure.notes, note))
    note = Message("figure.scaled", {"file": figure.file, "height_m": round(height_m, 4), "factor": factor})
    return replace(_scaled(figure, factor), notes=(*figure.notes, note))


def figure_height(figure: Figure) -> float | None:
    """Return the height from the lowest to the highest vertex in metres; None if there are no meshes."""
    heights = [mesh.positions_m[:, 1] for mesh in figure.meshes if len(mesh.positions_m)]
    if not heights:
        return None
    return float(max(values.max() for values in heights) - min(values.min() for values in heights))


def has_odd_height(figure: Figure) -> bool:
    """Return whether a figure has an implausible height that no unit explains."""
    return any(note.id == ODD_HEIGHT for note in figure.notes)


def at_height(figure: Figure, height_m: float) -> Figure:
    """Return the figure scaled to a height; unchanged if the height is 0 or the figure has no mesh."""
    own_m = figure_height(figure)
    if not height_m or not own_m:
        return figure
    notes = tuple(note for note in figure.notes if note.id != ODD_HEIGHT)
    return replace(_scaled(figure, height_m / own_m), notes=notes)


def _scaled(figure: Figure, factor: float) -> Figure:
    return replace(
        figure,
        translations_m=figure.translations_m * factor,
        meshes=tuple(scaled_mesh(mesh, factor) for mesh in figure.meshes),
    )


def unit_factor(height_m: float) -> float | None:
    """Return the factor to metres that gives a human height; None unless exactly one unit does."""
    if not height_m > 0.0:
        return None
    found = [10.0**power for power in range(-5, 6) if PERSON_M[0] <= height_m * 10.0**power <= PERSON_M[1]]
    if GROWN_M[0] <= height_m * INCH_M <= GROWN_M[1]:
        found.append(INCH_M)
    return found[0] if len(found) == 1 else None
