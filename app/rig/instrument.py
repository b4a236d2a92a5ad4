"""Loading of instrument models, and transforms of their moving parts for values of the controls."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt

from app.arrays import AnyFloatArray, FloatArray
from app.rig import quaternion
from app.rig.gltf_source import build_mesh, invalid, moved_mesh, read_source
from app.rig.mesh import Mesh
from app.rig.model import InstrumentModel
from instrument_maps.model import ROOT, ControlMotion, InstrumentMap, MovingPart


def load_instrument(path: Path, instrument_map: InstrumentMap) -> InstrumentModel:
    """Load an instrument's model.

    Node 0 of the model is the root named in the map, whose frame is the instrument's. Nodes that controls move follow
    in the map's order. Meshes of every other node belong to its nearest ancestor among these.

    Raises
    ------
    FileError
        The file cannot be read, or lacks a node of the map.
    """
    source = read_source(path)
    try:
        nodes = source.gltf.nodes
        names = [ROOT, *instrument_map.nodes]
        by_name = {node.name: index for index, node in enumerate(nodes)}
        absent = [name for name in names if name not in by_name]
        if absent:
            raise invalid(path, f"no node named {', '.join(absent)}")
        root_from_world = np.linalg.inv(source.world_from_node[by_name[ROOT]])
        node_of = {by_name[name]: index for index, name in enumerate(names)}
        positions = np.array([(root_from_world @ source.world_from_node[by_name[name]])[:3, 3] for name in names])
        meshes: list[Mesh] = []
        for index, node in enumerate(nodes):
            if node.mesh is None:
                continue
            owner = index
            while owner >= 0 and owner not in node_of:
                owner = source.gltf.nodes[owner].parent
            name = source.gltf.meshes[node.mesh].name or node.name or f"mesh_{index}"
            mesh, _ = build_mesh(source, node.mesh, name)
            count = len(mesh.positions_m)
            meshes.append(
                moved_mesh(
                    mesh,
                    root_from_world @ source.world_from_node[index],
                    np.full((count, 1), node_of.get(owner, 0), dtype=np.int32),
                    np.ones((count, 1), dtype=np.float32),
                )
            )
    except (KeyError, IndexError, TypeError, ValueError) as error:
        raise invalid(path, f"damaged: {error!r}") from error
    return InstrumentModel(path.stem, tuple(names), positions, tuple(meshes))


def part_values(part: MovingPart, controls: Mapping[str, AnyFloatArray], frames: int) -> FloatArray:
    """Return the position (F,) of a part, 0..1, for values of the controls by name; missing controls are at 0."""
    values = [np.asarray(controls.get(name, np.zeros(frames)), dtype=np.float64) for name in part.controls]
    together: FloatArray = (np.minimum if part.when == "all" else np.maximum).reduce(values)
    return together


def part_transform(motion: ControlMotion, values: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return the transform of a part in the root's frame.

    Parameters
    ----------
    motion : instrument_maps.model.ControlMotion
    values : (F,)
        Positions of the part, 0..1.

    Returns
    -------
    translations_m, rotations : (F, 3) and (F, 4) float64
        A point p of the node at rest moves to ``rotate(rotation, p) + translation``.
    """
    values = np.asarray(values, dtype=np.float64)
    axis = np.asarray(motion.axis, dtype=np.float64)
    if motion.angle_rad is not None:
        pivot = np.asarray(motion.pivot_m, dtype=np.float64)
        rotations = quaternion.from_axis_angle(axis, values * motion.angle_rad)
        return pivot - quaternion.rotate(rotations, pivot), rotations
    return np.multiply.outer(values * (motion.travel_m or 0.0), axis), np.tile(quaternion.IDENTITY, (*values.shape, 1))


def node_transforms(
    model: InstrumentModel, instrument_map: InstrumentMap, controls: Mapping[str, AnyFloatArray], frames: int
) -> tuple[FloatArray, FloatArray]:
    """Return the transforms of a model's nodes in the instrument's frame.

    Parameters
    ----------
    controls : dict of str to (F,)
        Values 0..1 by control; missing controls are at 0.

    Returns
    -------
    positions_m, rotations : (F, N, 3) and (F, N, 4) float64
        ``instrument_from_node`` in the order of ``model.node_names``.
    """
    positions = np.tile(model.node_positions_m, (frames, 1, 1))
    rotations = np.tile(quaternion.IDENTITY, (frames, len(model.node_names), 1))
    for part in instrument_map.moving_parts:
        if any(name in controls for name in part.controls):
            node = model.node_names.index(part.node)
            moved, turned = part_transform(part.motion, part_values(part, controls, frames))
            positions[:, node] = quaternion.rotate(turned, positions[:, node]) + moved
            rotations[:, node] = quaternion.multiply(turned, rotations[:, node])
    return positions, rotations
