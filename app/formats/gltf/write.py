"""Writing of scenes as binary glTF 2.0 files (GLB).

Metres, Y up, facing +Z; bones are nodes below one root, meshes are next to it and share one skin. With several scenes
each root is below a node with the scene's name and place. A mesh with animated morph targets is on that node itself,
since Blender otherwise leaves an empty for a node with keys; the node's place has no effect on skinned meshes. A mesh
has one primitive per material. Influences after the fourth are in a second set, so that readers of only one set show
the closest skin. The clip is one animation with keys on frames at ``n / fps`` seconds; glTF times are float32, within
0.12 ms after an hour. The rate and number of frames are stored in the animation's extras.
Lower levels of detail are nodes of no scene, named by the extension MSFT_lod. They have the morph targets of their mesh
in the same order, but no channels: a program that shows them takes the mesh's weights, and one that does not, such as
three.js, warns of channels whose nodes are in no scene.

Source: Khronos, "glTF 2.0 Specification", sections 3.6, 3.7, 3.11 and 4; "MSFT_lod".
"""

from __future__ import annotations

import os
import struct
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pygltflib as gltf

from app.arrays import AnyFloatArray, AnyIntArray
from app.errors import FileError
from app.formats.atomic import atomic_write
from app.formats.gltf.container import BINARY, JSON, MAGIC
from app.formats.gltf.document import GlbDocument, Pieces, listed
from app.formats.gltf.primitives import Primitive, primitives
from app.formats.gltf.samplers import METRES, Samplers, weights_move
from app.formats.gltf.write_materials import add_materials
from app.formats.levels_of_detail import LEAST_HEIGHTS
from app.formats.scene import Material, MorphTarget, NodePlace, Scene, SkinnedMesh, checked_scenes
from app.formats.skin import influences

_MOST_BYTES = 2**32 - 1
_PER_SET = 4
_LOD = "MSFT_lod"


def write_glb(path: str | os.PathLike[str], scene: Scene) -> None:
    """Write a scene as a GLB file, atomically and deterministically.

    Raises
    ------
    FileError
        The file cannot be written, or would exceed the 4 GB limit of GLB.
    ValueError
        The scene is inconsistent.
    """
    write_glbs(path, (scene,))


def write_glbs(path: str | os.PathLike[str], scenes: Iterable[Scene]) -> None:
    """Write several scenes into one file, like `write_glb`; each scene is released when the next is requested."""
    write_document(path, _document(scenes))


def write_document(path: str | os.PathLike[str], document: GlbDocument) -> None:
    """Write a document as a GLB file, atomically."""
    pieces = _pieces(document)
    if sum(_size(piece) for piece in pieces) > _MOST_BYTES:
        raise FileError("file.cannot_write", file=os.fspath(path), reason="GLB > 4 GB")
    with atomic_write(path) as stream:
        stream.writelines(pieces)


def glb_pieces(scenes: Iterable[Scene]) -> Pieces:
    """Return the bytes of a GLB file with the scenes, in pieces that are written one after the other."""
    return _pieces(_document(scenes))


def _pieces(document: GlbDocument) -> Pieces:
    document.gltf.bufferViews = document.buffer.views
    binary = document.buffer.pieces()
    binary_size = sum(_size(piece) for piece in binary)
    if binary_size:
        document.gltf.buffers = [gltf.Buffer(byteLength=binary_size)]
    text = document.gltf.gltf_to_json().encode()
    text += b" " * (-len(text) % 4)
    chunks = [struct.pack("<II", len(text), JSON), text]
    if binary_size:
        chunks += [struct.pack("<II", binary_size, BINARY), *binary]
    whole = 12 + sum(_size(piece) for piece in chunks)
    return [struct.pack("<4sII", MAGIC, 2, whole & _MOST_BYTES), *chunks]


def _size(piece: bytes | memoryview) -> int:
    return memoryview(piece).nbytes


# ---------------------------------------------------------------------------------------------------------- document


def _document(scenes: Iterable[Scene]) -> GlbDocument:
    document = GlbDocument(gltf.GLTF2(asset=gltf.Asset(version="2.0")))
    out = document.gltf
    roots: list[int] = []
    materials: dict[Material, int] = {}
    samplers: Samplers | None = None
    for scene in checked_scenes(scenes):
        out.asset.generator = scene.creator
        first, mesh_nodes = _add_figure(document, scene, roots, materials)
        if scene.clip is not None:
            samplers = Samplers(document, scene.clip) if samplers is None else samplers
            samplers.add_clip(scene, scene.clip, first, scene.meshes, mesh_nodes[: len(scene.meshes)])
    add_materials(document, materials)
    out.scenes.append(gltf.Scene(nodes=roots))
    out.scene = 0
    return document


def _add_figure(
    document: GlbDocument, scene: Scene, roots: list[int], materials: dict[Material, int]
) -> tuple[int, list[int]]:
    """Add the nodes of a scene to a glTF document: its place, bones and meshes. Return the index of the first bone's
    node, and of each mesh's node.
    """
    out = document.gltf
    roots.append(len(out.nodes))
    if scene.place is not None:
        out.nodes.append(node_at(scene.name, scene.place))
        out.nodes[-1].children = [len(out.nodes)]
    first = len(out.nodes)
    for bone in scene.bones:
        out.nodes.append(node_at(bone.name, NodePlace(bone.translation_cm, bone.rotation_xyzw)))
        if bone.parent >= 0:
            parent = out.nodes[first + bone.parent]
            parent.children = [*(parent.children or []), len(out.nodes) - 1]
    placed = None if scene.place is None else next((one for one in scene.meshes if weights_move(scene.clip, one)), None)
    mesh_nodes: list[int] = []
    for mesh in scene.meshes:
        mesh_nodes.append(first - 1 if mesh is placed else len(out.nodes))
        if mesh is not placed:
            roots.append(len(out.nodes))
            out.nodes.append(gltf.Node(name=mesh.name))
    for mesh, node in zip(scene.meshes, [*mesh_nodes], strict=True):
        if mesh.levels:
            levels = [*range(len(out.nodes), len(out.nodes) + len(mesh.levels))]
            out.nodes += [gltf.Node(name=level.name) for level in mesh.levels]
            _show_levels(document, out.nodes[node], levels)
            mesh_nodes += levels
    for mesh, node in zip(every_mesh(scene), mesh_nodes, strict=True):
        out.nodes[node].mesh, out.nodes[node].skin = len(out.meshes), len(out.skins)
        out.meshes.append(_mesh(document, mesh, len(scene.bones), materials))
    # Programs name the armature after the skin and recognise bones by the skin.
    binds = scene.meshes[0].world_from_bone_bind if scene.meshes else _rest_transforms(scene)
    out.skins.append(_skin(document, binds, scene.title, first))
    return first, mesh_nodes


def every_mesh(scene: Scene) -> tuple[SkinnedMesh, ...]:
    """Return all meshes of a scene in the order of the file: the meshes themselves, then the lower levels of detail of
    each.
    """
    return (*scene.meshes, *(level for mesh in scene.meshes for level in mesh.levels))


def _show_levels(document: GlbDocument, node: gltf.Node, levels: list[int]) -> None:
    """State in a node the nodes that replace it at increasing distance; these are in no scene."""
    node.extensions = {_LOD: {"ids": levels}}
    node.extras = {"MSFT_screencoverage": [*LEAST_HEIGHTS[: len(levels)], 0.0]}
    document.use_extension(_LOD)


def _rest_transforms(scene: Scene) -> AnyFloatArray:
    """Return the rest transforms (J, 4, 4) of the scene's J bones in the world."""
    world: list[AnyFloatArray] = []
    for bone in scene.bones:
        local = NodePlace(bone.translation_cm, bone.rotation_xyzw).matrix
        world.append(local if bone.parent < 0 else world[bone.parent] @ local)
    return np.stack(world)


def node_at(name: str, place: NodePlace) -> gltf.Node:
    rotation = np.asarray(place.rotation_xyzw, dtype=np.float64)
    return gltf.Node(
        name=name,
        translation=listed(np.asarray(place.translation_cm) * METRES),
        rotation=listed(rotation / np.linalg.norm(rotation)),
    )


def _skin(document: GlbDocument, world_from_bone_bind: AnyFloatArray, name: str, first: int) -> gltf.Skin:
    binds = np.array(world_from_bone_bind, dtype=np.float64)
    binds[:, :3, 3] *= METRES
    # Stored by columns; the last row of each must be exact.
    inverse = np.linalg.inv(binds)
    inverse[:, 3] = [0.0, 0.0, 0.0, 1.0]
    columns = inverse.transpose(0, 2, 1).reshape(-1, 16).astype(np.float32)
    accessor = document.accessor("binds", columns)
    return gltf.Skin(
        name=name, inverseBindMatrices=accessor, skeleton=first, joints=list(range(first, first + len(binds)))
    )


def _mesh(document: GlbDocument, mesh: SkinnedMesh, bone_count: int, materials: dict[Material, int]) -> gltf.Mesh:
    joints, weights = influences(mesh)
    joint_type = np.uint8 if bone_count <= 2**8 else np.uint16
    sets = -(-joints.shape[1] // _PER_SET)
    spare = ((0, 0), (0, sets * _PER_SET - joints.shape[1]))
    joints, weights = np.pad(joints, spare).astype(joint_type), np.pad(weights, spare).astype(np.float32)
    positions = (np.asarray(mesh.vertices_cm, dtype=np.float64) * METRES).astype(np.float32)
    result = gltf.Mesh(name=mesh.name, primitives=[])
    for primitive in primitives(mesh):
        chosen = primitive.vertices

        def attribute(kind: str, values: npt.NDArray[Any], bounds: bool = False) -> int:
            return document.accessor(kind, values, target=gltf.ARRAY_BUFFER, bounds=bounds)

        attributes = gltf.Attributes(
            POSITION=attribute("positions", positions[chosen], bounds=True),
            NORMAL=attribute("normals", primitive.normals.astype(np.float32)),
            TEXCOORD_0=None if primitive.uvs is None else attribute("uvs", primitive.uvs.astype(np.float32)),
        )
        for number in range(sets):
            columns = slice(number * _PER_SET, (number + 1) * _PER_SET)
            # The library defines one set only but keeps attributes of any other name.
            setattr(attributes, f"JOINTS_{number}", attribute("joints", joints[chosen, columns]))
            setattr(attributes, f"WEIGHTS_{number}", attribute("weights", weights[chosen, columns]))
        indices = primitive.triangles.ravel()
        # The largest value of an index type restarts a strip, so it cannot be an index.
        index_type = np.uint16 if len(chosen) < 2**16 else np.uint32
        result.primitives.append(
            gltf.Primitive(
                attributes=attributes,
                indices=document.accessor(
                    "indices", indices.astype(index_type), target=gltf.ELEMENT_ARRAY_BUFFER, flat=True
                ),
                material=materials.setdefault(mesh.materials[primitive.material], len(materials)),
                targets=_targets(document, mesh.morphs, primitive, len(mesh.vertices_cm)),
            )
        )
    if mesh.morphs:
        result.extras = {"targetNames": [morph.name for morph in mesh.morphs]}
    return result


def _targets(
    document: GlbDocument, morphs: Sequence[MorphTarget], primitive: Primitive, vertex_count: int
) -> list[dict[str, int]]:
    """Return the JSON of a glTF primitive's morph targets, accessor by attribute. All primitives of a mesh have the
    same targets, some with zeros only."""
    with_normals = any(morph.normal_deltas is not None for morph in morphs)
    count = len(primitive.vertices)
    zeros: list[int] = []

    def accessor(rows: AnyIntArray, deltas: AnyFloatArray) -> int:
        moved = deltas.any(axis=1)
        if moved.any():
            return document.sparse(count, rows[moved], deltas[moved])
        if not zeros:
            zeros.append(document.sparse(count, rows[:0], deltas[:0]))
        return zeros[0]

    result = []
    row_of_vertex = np.full(vertex_count, -1)
    for morph in morphs:
        row_of_vertex[morph.vertex_indices] = np.arange(len(morph.vertex_indices))
        places = row_of_vertex[primitive.vertices]
        row_of_vertex[morph.vertex_indices] = -1
        rows = np.flatnonzero(places >= 0)
        chosen = places[rows]
        target = {"POSITION": accessor(rows, (morph.position_deltas_cm[chosen] * METRES).astype(np.float32))}
        if with_normals:
            deltas = np.zeros((0, 3)) if morph.normal_deltas is None else morph.normal_deltas[chosen]
            target["NORMAL"] = accessor(rows[: len(deltas)], deltas.astype(np.float32))
        result.append(target)
    return result
