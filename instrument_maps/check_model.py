"""Checks that a map and its model agree: existing nodes with correct rest transforms, touch points on their surface."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from app.arrays import FloatArray
from app.errors import FileError
from app.formats.gltf.model import GltfModel
from app.formats.gltf.read import read_glb
from instrument_maps.model import ROOT, InstrumentMap
from instrument_maps.surface import nearest_point
from instrument_maps.value_checks import Problem

SURFACE_M = 0.001
"""Greatest distance in metres of a touch point from the surface."""


def model_problems(instrument: InstrumentMap, path: Path) -> Iterator[Problem]:
    """Yield the faults in a map's model as problems, each with the key path in the map."""
    if not os.path.isfile(path):
        yield "model", f"there is no file '{instrument.model}' beside the map or among the bundled models"
        return
    try:
        model = read_glb(path)
    except FileError as error:
        details = ", ".join(f"{value}" for key, value in error.message.arguments.items() if key != "file")
        yield "model", f"'{instrument.model}' cannot be read: {error.message.id}{f' ({details})' if details else ''}"
        return
    names = {node.name: index for index, node in enumerate(model.nodes)}
    if ROOT not in names:
        yield "model", f"'{instrument.model}' has no node named '{ROOT}'"
        return
    missing = set()
    places = root_from_node(model, names[ROOT])
    moving = [(f"controls[{index}].node", control.node) for index, control in enumerate(instrument.controls)]
    moving += [(f"links[{index}].node", link.node) for index, link in enumerate(instrument.links)]
    if instrument.endpin is not None:
        moving.append(("endpin.node", instrument.endpin.node))
    for key, node in moving:
        if node is None:
            continue
        if node not in names:
            missing.add(node)
            yield key, f"'{instrument.model}' has no node named '{node}'"
        elif not np.allclose(places[names[node]][:3, :3], np.eye(3), atol=1e-4):
            yield key, f"'{node}' must rest unturned and unscaled in '{instrument.model}'"
    surfaces = node_triangles(instrument, model)
    yield from _touches(instrument, surfaces, missing)
    pin = instrument.endpin
    if pin is not None and pin.node not in missing and len(surfaces[pin.node]):
        tip_m = np.array(pin.tip_m) - places[names[pin.node]][:3, 3]
        distance_m, _ = nearest_point(surfaces[pin.node], tip_m)
        if distance_m > SURFACE_M:
            yield "endpin.tip_m", f"is {distance_m * 1000:.1f} mm off the surface of '{pin.node}'"


def _touches(instrument: InstrumentMap, surfaces: dict[str, FloatArray], missing: set[str]) -> Iterator[Problem]:
    for index, contact in enumerate(instrument.contacts):
        if contact.node in missing or contact.node not in surfaces:
            continue
        triangles = surfaces[contact.node]
        if not len(triangles):
            yield f"contacts[{index}].node", f"'{contact.node}' has no surface in '{instrument.model}'"
            continue
        distance_m, normal = nearest_point(triangles, np.array(contact.position_m))
        if distance_m > SURFACE_M:
            yield f"contacts[{index}].position_m", f"is {distance_m * 1000:.1f} mm off the surface of '{contact.node}'"
        elif normal @ np.array(contact.normal) < 0.5:
            yield f"contacts[{index}].normal", f"does not point out of the surface of '{contact.node}'"


def root_from_node(model: GltfModel, root: int) -> FloatArray:
    """Rest transforms of all nodes in the frame of the node ``root``, (N, 4, 4)."""
    local = np.tile(np.eye(4), (len(model.nodes), 1, 1))
    for index, node in enumerate(model.nodes):
        x, y, z, w = node.rotation_xyzw / np.linalg.norm(node.rotation_xyzw)
        turn = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
        local[index, :3, :3] = turn * node.scale
        local[index, :3, 3] = node.translation
    world = local.copy()
    for index, node in enumerate(model.nodes):
        above = node.parent
        while above >= 0:
            world[index] = local[above] @ world[index]
            above = model.nodes[above].parent
    places: FloatArray = np.linalg.inv(world[root]) @ world
    return places


def node_triangles(instrument: InstrumentMap, model: GltfModel) -> dict[str, FloatArray]:
    """Return the T triangles (T, 3, 3) that move with each node of the map, by node, in the node's frame."""
    names = {node.name: index for index, node in enumerate(model.nodes)}
    places = root_from_node(model, names[ROOT])
    requested = {names[name]: name for name in (ROOT, *instrument.nodes) if name in names}
    found: dict[str, list[FloatArray]] = {name: [] for name in requested.values()}
    for index, node in enumerate(model.nodes):
        owner = index
        while owner >= 0 and owner not in requested:
            owner = model.nodes[owner].parent
        if node.mesh is None or owner < 0:
            continue
        owner_from_node = np.linalg.inv(places[owner]) @ places[index]
        for primitive in model.meshes[node.mesh].primitives:
            points = primitive.positions @ owner_from_node[:3, :3].T + owner_from_node[:3, 3]
            found[requested[owner]].append(points[primitive.triangles])
    return {name: np.concatenate(parts) if parts else np.zeros((0, 3, 3)) for name, parts in found.items()}
