"""Convert the wooden mannequin of the package mannequin-x, a figure with another maker's skeleton, to a glTF file."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pygltflib as gltf

FOLDER = "SUISOU_FOREIGN_PACKAGES"
"""Environment variable with the folder of packages that are read but not run."""


def source() -> Path | None:
    """Arrays of the package; None if it is neither installed nor mandatory."""
    folder = os.environ.get(FOLDER, "")
    path = Path(folder) / "mannequin" / "assets" / "wooden.npz"
    if folder and path.is_file():
        return path
    if os.environ.get("CI"):
        raise AssertionError(f"{FOLDER} must hold mannequin-x in CI")
    return None


def write_wooden(arrays: Path, path: Path) -> None:
    """Write the mesh, the joints and the four largest weights of each vertex, unchanged except that the soles are at
    height 0.
    """
    with np.load(arrays, allow_pickle=False) as held:
        names, parents = [str(name) for name in held["joint_names"]], held["parents"].astype(int)
        vertices, faces = held["vertices"].astype(float), held["faces"].astype(int)
        joints, weights = held["skin_joint_indices"].astype(int), held["skin_weights"].astype(float)
        places = held["skin_source_joint_positions"].astype(float)
    lift = np.array([0.0, -vertices[:, 1].min(), 0.0])
    vertices, places = vertices + lift, places + lift
    largest = np.argsort(-weights, axis=1)[:, :4]
    joints, weights = np.take_along_axis(joints, largest, 1), np.take_along_axis(weights, largest, 1)
    joints = np.where(weights > 0.0, joints, 0)
    weights /= weights.sum(axis=1, keepdims=True)

    document, blob = gltf.GLTF2(), bytearray()

    def add(array: np.ndarray, component: int, kind: str) -> int:
        document.bufferViews.append(gltf.BufferView(buffer=0, byteOffset=len(blob), byteLength=array.nbytes))
        blob.extend(array.tobytes())
        blob.extend(b"\0" * (-len(blob) % 4))
        accessor = gltf.Accessor(bufferView=len(document.bufferViews) - 1, componentType=component)
        accessor.count, accessor.type = len(array), kind
        if kind == "VEC3":
            accessor.min, accessor.max = array.min(axis=0).tolist(), array.max(axis=0).tolist()
        document.accessors.append(accessor)
        return len(document.accessors) - 1

    attributes = gltf.Attributes(
        POSITION=add(vertices.astype("<f4"), gltf.FLOAT, "VEC3"),
        JOINTS_0=add(joints.astype("u1"), gltf.UNSIGNED_BYTE, "VEC4"),
        WEIGHTS_0=add(weights.astype("<f4"), gltf.FLOAT, "VEC4"),
    )
    corners = add(faces.reshape(-1).astype("<u2"), gltf.UNSIGNED_SHORT, "SCALAR")
    document.meshes.append(
        gltf.Mesh(name="wooden", primitives=[gltf.Primitive(attributes=attributes, indices=corners)])
    )
    for joint, name in enumerate(names):
        parent = parents[joint]
        place = places[joint] - (places[parent] if parent >= 0 else 0.0)
        children = [int(child) for child in np.flatnonzero(parents == joint)]
        document.nodes.append(gltf.Node(name=name, translation=place.tolist(), children=children))
    bind = np.tile(np.eye(4), (len(names), 1, 1))
    bind[:, :3, 3] = -places
    matrices = add(bind.transpose(0, 2, 1).astype("<f4").reshape(-1, 16), gltf.FLOAT, "MAT4")
    document.skins.append(gltf.Skin(joints=list(range(len(names))), inverseBindMatrices=matrices))
    document.nodes.append(gltf.Node(name="mesh", mesh=0, skin=0))
    document.scenes.append(gltf.Scene(nodes=[0, len(names)]))
    document.scene = 0
    document.buffers.append(gltf.Buffer(byteLength=len(blob)))
    document.set_binary_blob(bytes(blob))
    document.save(str(path))
