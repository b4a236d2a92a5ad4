"""Reads one FBX file of another program by ufbx and prints what it holds; a process of its own (see `foreign`).

The binding (0.0.5) crashes when its objects are freed, and a damaged file may crash any reader in C: so nothing is
freed here, and the process ends without tidying up.
"""

from __future__ import annotations

import gc
import io
import json
import os
import sys
from collections.abc import Iterable
from typing import Any, Final, TypeVar

import numpy as np
import numpy.typing as npt
import ufbx

MOST_BYTES: Final = 6 * 2**30
"""Address space this process may take, where the system can limit it."""

T = TypeVar("T")
_kept: list[object] = []


def _keep(value: T) -> T:
    """The value, which is never freed."""
    _kept.append(value)
    return value


def _every(values: Iterable[T]) -> list[T]:
    return _keep(list(_keep(values)))


class _Written:
    """Arrays by number, beside the description that names them."""

    def __init__(self) -> None:
        self.arrays: dict[str, npt.NDArray[Any]] = {}

    def add(self, values: npt.NDArray[Any]) -> str:
        name = f"a{len(self.arrays)}"
        self.arrays[name] = values
        return name


def _matrix(matrix: Any) -> list[list[float]]:
    """Rows of a 3 x 4 matrix, of which ufbx has the columns."""
    rows: list[list[float]] = np.array([list(column) for column in _keep(matrix)], dtype=np.float64).T.tolist()
    return rows


def _vectors(values: Any, width: int) -> npt.NDArray[np.float64]:
    """Numbers of vectors, which are plain tuples and may be freed: a face of many shapes has millions."""
    numbers = (number for vector in _keep(values) for number in vector)
    return np.fromiter(numbers, np.float64).reshape(-1, width)


def _whole(values: Any) -> npt.NDArray[np.int64]:
    return np.fromiter(_keep(values), np.int64)


def _mesh(mesh: Any, written: _Written) -> dict[str, Any]:
    spans = np.array([(face.index_begin, face.num_indices) for face in _keep(mesh.faces)], dtype=np.int64)
    return {
        "name": mesh.name,
        "nodes": [_keep(node).typed_id for node in _every(mesh.instances)],
        "points": written.add(_vectors(mesh.vertices, 3)),
        "corners": written.add(_whole(mesh.vertex_indices)),
        "faces": written.add(spans.reshape(-1, 2)),
        "face_materials": written.add(_whole(mesh.face_material)),
        "normals": _attribute(mesh.vertex_normal, 3, written),
        "uvs": _attribute(mesh.vertex_uv, 2, written),
        "materials": [_material(material) for material in _every(mesh.materials)],
        "skins": [_skin(skin, written) for skin in _every(mesh.skin_deformers)],
        "morphs": [
            morph
            for deformer in _every(mesh.blend_deformers)
            for channel in _every(deformer.channels)
            for morph in _morph(deformer, channel, written)
        ],
    }


def _attribute(attribute: Any, width: int, written: _Written) -> list[str] | None:
    """Values and, by corner, which of them."""
    if not _keep(attribute).exists:
        return None
    return [written.add(_vectors(attribute.values, width)), written.add(_whole(attribute.indices))]


def _material(material: Any) -> dict[str, Any]:
    surface = _keep(_keep(material).pbr)
    color = _keep(_keep(surface.base_color).value_vec4)
    roughness, metallic, opacity = (
        _keep(value).value_vec4.x if value.has_value else otherwise
        for value, otherwise in (
            (_keep(surface.roughness), 0.8),
            (_keep(surface.metalness), 0.0),
            (_keep(surface.opacity), 1.0),
        )
    )
    return {
        "name": material.name,
        "color": [color.x, color.y, color.z, opacity],
        "roughness": roughness,
        "metallic": metallic,
    }


def _skin(skin: Any, written: _Written) -> list[dict[str, Any]]:
    clusters = []
    for cluster in _every(_keep(skin).clusters):
        bone = _keep(cluster.bone_node)
        if bone is None:
            continue
        clusters.append(
            {
                "node": bone.typed_id,
                "bone_from_mesh": _matrix(cluster.geometry_to_bone),
                "world_from_bone": _matrix(cluster.bind_to_world),
                "points": written.add(_whole(cluster.vertices)),
                "weights": written.add(np.fromiter(_keep(cluster.weights), np.float64)),
            }
        )
    return clusters


def _morph(deformer: Any, channel: Any, written: _Written) -> list[dict[str, Any]]:
    """The last of a channel's shapes: what it is at its full weight."""
    frames = _every(_keep(channel).keyframes)
    if not frames:
        return []
    shape = _keep(frames[-1].shape)
    name, prefix = channel.name or shape.name, _keep(deformer).name
    # Maya puts the deformer's name before each channel's; Unreal drops it too.
    if prefix and name.startswith(prefix) and name[len(prefix) : len(prefix) + 1] in (".", "_"):
        name = name[len(prefix) + 1 :] or name
    return [
        {
            "name": name,
            "points": written.add(_whole(shape.offset_vertices)),
            "deltas": written.add(_vectors(shape.position_offsets, 3)),
        }
    ]


def read(path: str) -> tuple[dict[str, Any], dict[str, npt.NDArray[Any]]]:
    """Nodes and meshes of a file, in metres, right-handed, Y up."""
    scene = _keep(
        ufbx.load_file(
            path,
            file_format=ufbx.FileFormat.FBX,
            ignore_animation=True,
            ignore_embedded=True,
            load_external_files=False,
            generate_missing_normals=True,
            normalize_normals=True,
            clean_skin_weights=True,
            skip_skin_vertices=True,
            skip_mesh_parts=True,
            target_axes=ufbx.axes_right_handed_y_up,
            target_unit_meters=1.0,
            space_conversion=ufbx.SpaceConversion.ADJUST_TRANSFORMS,
            node_depth_limit=1000,
        )
    )
    written = _Written()
    nodes = [
        {
            "name": node.name,
            "parent": -1 if (parent := _keep(node.parent)) is None else parent.typed_id,
            "is_root": node.is_root,
            "kind": _keep(node.attrib_type).name,
            "visible": bool(node.visible),
            "world_from_node": _matrix(node.node_to_world),
            "world_from_geometry": _matrix(node.geometry_to_world),
        }
        for node in _every(scene.nodes)
    ]
    meshes = [_mesh(mesh, written) for mesh in _every(scene.meshes)]
    return {"nodes": nodes, "meshes": meshes}, written.arrays


def main() -> None:
    """Print the file named on the command line: a JSON description and the arrays it names, as ``.npz``."""
    gc.disable()
    try:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
    except ImportError:
        pass  # Windows has no such limit; what the parent waits for is limited.
    output = sys.stdout.buffer
    status = 0
    try:
        content, arrays = read(sys.argv[1])
        packed = io.BytesIO()
        text = np.frombuffer(json.dumps(content).encode(), dtype=np.uint8)
        np.savez(packed, allow_pickle=False, description=text, **arrays)
        output.write(packed.getvalue())
    except ufbx.UfbxError as error:
        output.write(str(error)[:300].encode())
        status = 3
    except MemoryError:
        status = 4
    output.flush()
    # Not even the interpreter's own end may free what ufbx gave.
    os._exit(status)


if __name__ == "__main__":
    main()
