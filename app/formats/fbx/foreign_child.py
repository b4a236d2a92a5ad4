"""Child process that reads one FBX file of another program with ufbx and prints its contents (see `foreign`).

The binding (0.0.5) crashes when its objects are freed, and damaged files may crash any C reader: so nothing is freed,
and the process exits without clean-up.
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

from app.child_limits import confine_this_process
from app.formats.motion_limits import longest_motion_s

NO_READER: Final = 5
"""Exit status: the library is missing or cannot be loaded; there is no wheel for some Python versions."""
try:
    import ufbx
except ImportError:
    os._exit(NO_READER)

FREE_NUMBERS, NUMBERS_PER_BYTE = 2**20, 4
"""Limit of the numbers in a file: a fixed amount, plus this many per byte. Real files need a fifth of it; arrays of
equal values can be compressed by a factor of a thousand.
"""

FREE_MOTION_NUMBERS: Final = 2**24
"""Fixed amount of motion values, since few keys may represent many frames: two minutes of a hundred nodes at 60 frames
per second.
"""
FIGURE_LIMITS, MOTION_LIMITS = "ufbx.figure", "ufbx.motion"
"""Rows of `app.child_limits.LIMITS`."""
MOTION: Final = "motion"
"""Argument that requests nodes and their animation instead of meshes."""
TRANSFORM: Final = 10
"""Number of values of a transform: translation, rotation xyzw, scale."""
MOST_S: Final = 24 * 3600.0
USUAL_FPS, OTHERWISE_FPS = (1.0, 240.0), 30.0

DEEPEST: Final = 500
"""Greatest nesting depth of nodes, as for glTF."""

T = TypeVar("T")
_kept: list[object] = []


def _keep(value: T) -> T:
    """Keep a reference to a value of ufbx, so that it is never freed, and return it."""
    _kept.append(value)
    return value


def _every(values: Iterable[T]) -> list[T]:
    return _keep(list(_keep(values)))


class _Written:
    """The arrays to be printed, which the description references by name.

    Parameters
    ----------
    most : int
        Greatest total count of numbers in the arrays; more raise MemoryError.
    """

    def __init__(self, most: int) -> None:
        self.arrays: dict[str, npt.NDArray[Any]] = {}
        self.images: list[str] = []
        self.image_numbers: dict[int, int] = {}
        self._left = most

    def take(self, count: int) -> None:
        """Count numbers that are about to be allocated; raise MemoryError if there would be too many."""
        self._left -= count
        if self._left < 0:
            raise MemoryError

    def add(self, values: npt.NDArray[Any]) -> str:
        name = f"a{len(self.arrays)}"
        self.arrays[name] = values
        return name

    def vectors(self, values: Any, width: int) -> str:
        """Store vectors of a number of components, and return the array's name. ufbx gives them as plain tuples, which
        may be freed; faces with many shapes have millions.
        """
        self.take(width * len(_keep(values)))
        numbers = (number for vector in values for number in vector)
        return self.add(np.fromiter(numbers, np.float64).reshape(-1, width))

    def numbers(self, values: Any, kind: type[np.int64] | type[np.float64]) -> str:
        self.take(len(_keep(values)))
        return self.add(np.fromiter(values, kind))


def _matrix(matrix: Any) -> list[list[float]]:
    """Return the rows of a 3 x 4 matrix, which ufbx stores by columns."""
    rows: list[list[float]] = np.array([list(column) for column in _keep(matrix)], dtype=np.float64).T.tolist()
    return rows


def _mesh(mesh: Any, written: _Written) -> dict[str, Any]:
    written.take(2 * len(_keep(mesh.faces)))
    spans = np.array([(face.index_begin, face.num_indices) for face in mesh.faces], dtype=np.int64)
    nodes = [_keep(node).typed_id for node in _every(mesh.instances)]
    # Each node with the mesh becomes a mesh of its own.
    written.take(len(nodes) * len(_keep(mesh.vertex_indices)))
    return {
        "name": mesh.name,
        "nodes": nodes,
        "points": written.vectors(mesh.vertices, 3),
        "corners": written.numbers(mesh.vertex_indices, np.int64),
        "faces": written.add(spans.reshape(-1, 2)),
        "face_materials": written.numbers(mesh.face_material, np.int64),
        "normals": _attribute(mesh.vertex_normal, 3, written),
        "uvs": _attribute(mesh.vertex_uv, 2, written),
        "materials": [_material(material, written) for material in _every(mesh.materials)],
        "skins": [_skin(skin, written) for skin in _every(mesh.skin_deformers)],
        "morphs": [
            morph
            for deformer in _every(mesh.blend_deformers)
            for channel in _every(deformer.channels)
            for morph in _morph(deformer, channel, written)
        ],
    }


def _attribute(attribute: Any, width: int, written: _Written) -> list[str] | None:
    """Store the values of a mesh attribute, and for each corner the index of its value; return the names of both
    arrays, or None if the mesh lacks the attribute.
    """
    if not _keep(attribute).exists:
        return None
    return [written.vectors(attribute.values, width), written.numbers(attribute.indices, np.int64)]


def _material(material: Any, written: _Written) -> dict[str, Any]:
    surface, older = _keep(_keep(material).pbr), _keep(material.fbx)
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
        "base_color": [color.x, color.y, color.z, opacity],
        "roughness": roughness,
        "metallic": metallic,
        "bump": bump.value_vec4.x if (bump := _keep(older.bump_factor)).has_value else 1.0,
        "textures": {
            role: found
            for role, maps in (
                ("color", (surface.base_color,)),
                ("opacity", (surface.opacity, older.transparency_factor, older.transparency_color)),
                ("normal", (surface.normal_map, older.normal_map)),
                ("roughness", (surface.roughness,)),
                ("metallic", (surface.metalness,)),
            )
            if (found := _texture(maps, written)) is not None
        },
    }


def _texture(maps: Iterable[Any], written: _Written) -> dict[str, Any] | None:
    """Return a description of the first image among some maps of a material: file name, content if embedded, and
    placement; None if there is none.
    """
    for own in _every(maps):
        texture = _keep(own.texture)
        if texture is None or not texture.has_file:
            continue
        content = _keep(texture.content)
        moved, scaled = (0.0, 0.0), (1.0, 1.0)
        if texture.has_uv_transform:
            place = _keep(texture.uv_transform)
            (moved_u, moved_v, _), (scale_u, scale_v, _) = tuple(place.translation), tuple(place.scale)
            moved, scaled = (moved_u, moved_v), (scale_u, scale_v)
        return {
            "name": texture.name,
            "file": texture.relative_filename or texture.filename,
            "image": _image(texture.typed_id, content, written) if len(content) else None,
            "moved": moved,
            "scaled": scaled,
        }
    return None


def _image(key: int, content: Any, written: _Written) -> int:
    """Store an image's content once for all materials that share it, and return its index."""
    if key not in written.image_numbers:
        written.take(len(content) // 8)
        written.image_numbers[key] = len(written.images)
        written.images.append(written.add(np.frombuffer(bytes(content), np.uint8)))
    return written.image_numbers[key]


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
                "points": written.numbers(cluster.vertices, np.int64),
                "weights": written.numbers(cluster.weights, np.float64),
            }
        )
    return clusters


def _morph(deformer: Any, channel: Any, written: _Written) -> list[dict[str, Any]]:
    """Describe the last shape of an FBX morph channel, the one at full weight; empty if it has none."""
    frames = _every(_keep(channel).keyframes)
    if not frames:
        return []
    shape = _keep(frames[-1].shape)
    name, prefix = channel.name or shape.name, _keep(deformer).name
    # Maya prefixes each channel with the deformer's name; Unreal removes it too.
    if prefix and name.startswith(prefix) and name[len(prefix) : len(prefix) + 1] in (".", "_"):
        name = name[len(prefix) + 1 :] or name
    return [
        {
            "name": name,
            "points": written.numbers(shape.offset_vertices, np.int64),
            "deltas": written.vectors(shape.position_offsets, 3),
        }
    ]


def _load(data: bytes, *, animated: bool) -> Any:
    return _keep(
        ufbx.load_memory(
            data,
            file_format=ufbx.FileFormat.FBX,
            ignore_animation=not animated,
            ignore_embedded=animated,
            load_external_files=False,
            generate_missing_normals=True,
            normalize_normals=True,
            clean_skin_weights=True,
            skip_skin_vertices=True,
            skip_mesh_parts=True,
            target_axes=ufbx.axes_right_handed_y_up,
            target_unit_meters=1.0,
            space_conversion=ufbx.SpaceConversion.ADJUST_TRANSFORMS,
            node_depth_limit=DEEPEST,
        )
    )


def _nodes(scene: Any, written: _Written) -> list[dict[str, Any]]:
    # Matrices, a name and smaller values.
    written.take(64 * len(_keep(scene.nodes)))
    return [
        {
            "name": node.name,
            "parent": -1 if (parent := _keep(node.parent)) is None else parent.typed_id,
            "kind": _keep(node.attrib_type).name,
            "visible": bool(node.visible),
            "world_from_node": _matrix(node.node_to_world),
            "world_from_geometry": _matrix(node.geometry_to_world),
        }
        for node in _every(scene.nodes)
    ]


def read(data: bytes) -> tuple[dict[str, Any], dict[str, npt.NDArray[Any]]]:
    """Read nodes and meshes from the bytes of an FBX file, in metres, right-handed, Y up. Return a JSON description,
    and the arrays to which it refers by name.
    """
    scene = _load(data, animated=False)
    written = _Written(FREE_NUMBERS + NUMBERS_PER_BYTE * len(data))
    nodes = _nodes(scene, written)
    meshes = [_mesh(mesh, written) for mesh in _every(scene.meshes)]
    return {"nodes": nodes, "meshes": meshes, "images": written.images}, written.arrays


def read_motion(data: bytes) -> tuple[dict[str, Any], dict[str, npt.NDArray[Any]]]:
    """Read from the bytes of an FBX file the nodes, bind transforms, and local transforms in all frames of the longest
    animation. Return a JSON description, and the arrays to which it refers by name.
    """
    scene = _load(data, animated=True)
    written = _Written(FREE_MOTION_NUMBERS + NUMBERS_PER_BYTE * len(data))
    nodes = _nodes(scene, written)
    bound = [
        (node.typed_id, _matrix(cluster.bind_to_world))
        for skin in _every(scene.skin_deformers)
        for cluster in _every(skin.clusters)
        if (node := _keep(cluster.bone_node)) is not None
    ]
    fps = float(_keep(scene.settings).frames_per_second)
    fps = fps if USUAL_FPS[0] <= fps <= USUAL_FPS[1] else OTHERWISE_FPS
    stack = max(_every(scene.anim_stacks), key=_length_s, default=None)
    length_s = 0.0 if stack is None else _length_s(stack)
    if not 0.0 <= length_s < MOST_S:
        raise MemoryError
    content = {"nodes": nodes, "bound": bound, "fps": fps, "length_s": length_s}
    if stack is None or length_s > longest_motion_s(fps, len(nodes), len(data)):
        # The caller refuses an animation of this length, so its frames are not evaluated.
        return {**content, "transforms": written.add(np.empty((0, len(nodes), TRANSFORM)))}, written.arrays
    frames = round(length_s * fps) + 1
    written.take(TRANSFORM * frames * len(nodes))
    anim = _keep(stack.anim)
    values = np.empty((frames, len(nodes), TRANSFORM))
    for at, node in enumerate(_every(scene.nodes)):
        for frame in range(frames):
            # Copied as tuples, because ufbx may free its own values.
            moved, turned, scaled = ufbx.evaluate_transform(anim, node, float(stack.time_begin) + frame / fps)
            values[frame, at] = (*moved, *turned, *scaled)
    return {**content, "transforms": written.add(values)}, written.arrays


def _length_s(stack: Any) -> float:
    """Return the duration of an animation stack in seconds."""
    return float(stack.time_end) - float(stack.time_begin)


def main() -> None:
    """Read the FBX file on standard input, and print a JSON description and its arrays as ``.npz``."""
    gc.disable()
    output = sys.stdout.buffer
    status = 0
    try:
        data = _keep(sys.stdin.buffer.read())
        is_motion = sys.argv[1:] == [MOTION]
        confine_this_process(MOTION_LIMITS if is_motion else FIGURE_LIMITS, len(data))
        content, arrays = read_motion(data) if is_motion else read(data)
        packed = io.BytesIO()
        text = np.frombuffer(json.dumps(content).encode(), dtype=np.uint8)
        np.savez(packed, allow_pickle=False, description=text, **arrays)
        output.write(packed.getvalue())
    except (ufbx.OutOfMemoryError, ufbx.MemoryLimitError):
        status = 4
    except ufbx.UfbxError as error:
        output.write(str(error)[:300].encode())
        status = 3
    except MemoryError:
        status = 4
    output.flush()
    # Exit without the interpreter's cleanup, which must not free memory of ufbx.
    os._exit(status)


if __name__ == "__main__":
    main()
