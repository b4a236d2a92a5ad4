"""Writes a built instrument as a glTF binary: one named node per moving part, one primitive per material."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pygltflib as gltf

from resources.build.instrument_mesh import Model, Shape

MATERIALS: dict[str, tuple[tuple[float, float, float], float, float]] = {
    # name: base colour (linear), metallic, roughness
    "lacquered_brass": ((0.83, 0.56, 0.19), 1.0, 0.20),
    "silver": ((0.91, 0.90, 0.87), 1.0, 0.14),
    "nickel_silver": ((0.73, 0.71, 0.66), 1.0, 0.24),
    "inner_brass": ((0.52, 0.33, 0.10), 1.0, 0.45),
    "pearl": ((0.90, 0.88, 0.83), 0.0, 0.18),
    "felt": ((0.02, 0.02, 0.022), 0.0, 0.95),
    "cork": ((0.46, 0.29, 0.15), 0.0, 0.9),
    "gold_lacquer": ((0.86, 0.62, 0.26), 1.0, 0.18),
    "rose_brass": ((0.78, 0.45, 0.24), 1.0, 0.20),
    "grenadilla": ((0.020, 0.017, 0.015), 0.0, 0.32),
    "maple": ((0.17, 0.045, 0.018), 0.0, 0.22),
    "pearwood": ((0.42, 0.22, 0.085), 0.0, 0.40),
    "ebonite": ((0.012, 0.012, 0.013), 0.0, 0.16),
    "ivory_plastic": ((0.86, 0.82, 0.70), 0.0, 0.28),
    "dark_plastic": ((0.035, 0.036, 0.040), 0.0, 0.45),
    "cane": ((0.72, 0.56, 0.28), 0.0, 0.70),
    "pad": ((0.80, 0.72, 0.58), 0.0, 0.85),
    "leather": ((0.030, 0.022, 0.017), 0.0, 0.75),
    "rubber": ((0.015, 0.015, 0.015), 0.0, 0.90),
}


def write(model: Model, path: Path) -> None:
    """Write the model; the same model gives the same bytes."""
    out = gltf.GLTF2(asset=gltf.Asset(version="2.0", generator="Suisou build_instruments"))
    blob = bytearray()
    used = [name for name in MATERIALS if any(part.material == name for part in model.parts)]
    for name in used:
        colour, metallic, roughness = MATERIALS[name]
        pbr = gltf.PbrMetallicRoughness(
            baseColorFactor=[*colour, 1.0], metallicFactor=metallic, roughnessFactor=roughness
        )
        out.materials.append(gltf.Material(name=name, pbrMetallicRoughness=pbr, doubleSided=name == "inner_brass"))
    for node, origin in model.origins.items():
        primitives = []
        for index, name in enumerate(used):
            shapes = [part.shape for part in model.parts if part.node == node and part.material == name]
            if shapes:
                primitives.append(_primitive(out, blob, merged(shapes), origin, index))
        out.meshes.append(gltf.Mesh(name=node, primitives=primitives))
        place = None if node == "root" else [float(np.float32(value)) for value in origin]
        out.nodes.append(gltf.Node(name=node, mesh=len(out.meshes) - 1, translation=place))
    out.nodes[0].children = list(range(1, len(out.nodes)))
    out.scenes.append(gltf.Scene(name=path.stem, nodes=[0]))
    out.scene = 0
    out.buffers.append(gltf.Buffer(byteLength=len(blob)))
    out.set_binary_blob(bytes(blob))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"".join(out.save_to_bytes()))


def merged(shapes: list[Shape]) -> Shape:
    """Merge several shapes into one."""
    offsets = np.cumsum([0, *(len(shape.points) for shape in shapes)])
    return Shape(
        np.vstack([shape.points for shape in shapes]),
        np.vstack([shape.normals for shape in shapes]),
        np.vstack([shape.uvs for shape in shapes]),
        np.vstack([shape.faces + offset for shape, offset in zip(shapes, offsets, strict=False)]),
    )


def _primitive(out: gltf.GLTF2, blob: bytearray, shape: Shape, origin: np.ndarray, material: int) -> gltf.Primitive:
    points = (shape.points - origin).astype("<f4")
    attributes = gltf.Attributes(
        POSITION=_accessor(out, blob, points, gltf.VEC3, bounds=True),
        NORMAL=_accessor(out, blob, shape.normals.astype("<f4"), gltf.VEC3),
        TEXCOORD_0=_accessor(out, blob, shape.uvs.astype("<f4"), gltf.VEC2),
    )
    wide = len(points) > 65535
    faces = shape.faces.reshape(-1).astype("<u4" if wide else "<u2")
    indices = _accessor(out, blob, faces, gltf.SCALAR, element=True)
    return gltf.Primitive(attributes=attributes, indices=indices, material=material)


def _accessor(
    out: gltf.GLTF2, blob: bytearray, data: np.ndarray, kind: str, *, bounds: bool = False, element: bool = False
) -> int:
    blob.extend(b"\0" * (-len(blob) % 4))
    view = gltf.BufferView(
        buffer=0,
        byteOffset=len(blob),
        byteLength=data.nbytes,
        target=gltf.ELEMENT_ARRAY_BUFFER if element else gltf.ARRAY_BUFFER,
    )
    blob.extend(data.tobytes())
    out.bufferViews.append(view)
    codes = {"f4": gltf.FLOAT, "u4": gltf.UNSIGNED_INT, "u2": gltf.UNSIGNED_SHORT}
    out.accessors.append(
        gltf.Accessor(
            bufferView=len(out.bufferViews) - 1,
            componentType=codes[data.dtype.str[1:]],
            count=len(data),
            type=kind,
            min=[float(v) for v in data.min(0)] if bounds else None,
            max=[float(v) for v in data.max(0)] if bounds else None,
        )
    )
    return len(out.accessors) - 1
