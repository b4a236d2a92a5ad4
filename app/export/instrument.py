"""Conversion of an instrument with its moving parts to the scene of a file, in the space of its player.

The root bone is the instrument's place in the world; every moving part is a bone below it, named after its control, or
after its node if no control moves it by itself.
"""

from __future__ import annotations

import numpy as np

from app.export.bind_pose import CENTIMETRES
from app.export.bone_axes import OBJECT_AXES
from app.export.character import mesh_names, skinned_mesh
from app.export.target import Trajectory, instrument_path
from app.formats.joined_meshes import join_meshes
from app.formats.scene import Bone, Clip, Scene
from app.motion.model import Motion
from app.rig import quaternion
from app.rig.instrument import part_transform, part_values
from app.rig.model import InstrumentModel
from instrument_maps.model import InstrumentMap


def instrument_scene(
    instrument: InstrumentMap,
    model: InstrumentModel,
    motion: Motion,
    name: str,
    creator: str,
    path: Trajectory | None = None,
) -> Scene:
    """Return the scene of a player's instrument.

    Parameters
    ----------
    instrument : InstrumentMap
        Map of the instrument.
    model : InstrumentModel
        The model named in the map.
    motion : Motion
        Motion of the player who holds it.
    name, creator : str
        Name of armature and animation and prefix of the mesh's name; program and version.
    path : Trajectory, optional
        Path of the root bone; by default that of the instrument.
    """
    bones = instrument_bones(instrument, model)
    binds = np.tile(np.eye(4), (len(bones), 1, 1))
    binds[:, :3, 3] = model.node_positions_m * CENTIMETRES
    (mesh_name,) = mesh_names([f"{name}_mesh"], (bone.name for bone in bones))
    meshes = [skinned_mesh(mesh, mesh.name, mesh.joints, mesh.weights, binds) for mesh in model.meshes]
    return Scene(
        bones=bones,
        meshes=(join_meshes(meshes, mesh_name),),
        clip=instrument_clip(instrument, model, motion, name, path),
        creator=creator,
        name=name,
    )


def instrument_bones(instrument: InstrumentMap, model: InstrumentModel) -> tuple[Bone, ...]:
    """Return one bone for each node of an instrument's model, named after the moving part there, else after the
    node."""
    by_node = {part.node: part.name for part in instrument.moving_parts}
    unturned = np.array([0.0, 0.0, 0.0, 1.0])
    root_m = model.node_positions_m[0]
    return tuple(
        Bone(
            name=by_node.get(node, node),
            parent=-1 if index == 0 else 0,
            translation_cm=(model.node_positions_m[index] - (root_m if index else 0.0)) * CENTIMETRES,
            rotation_xyzw=unturned,
            axes=None if index else OBJECT_AXES,
        )
        for index, node in enumerate(model.node_names)
    )


def instrument_clip(
    instrument: InstrumentMap, model: InstrumentModel, motion: Motion, name: str, path: Trajectory | None = None
) -> Clip:
    """Return the clip of an instrument's moving parts and of its root bone, whose path is ``path`` or else that of the
    instrument in ``motion``.
    """
    rotations = np.zeros((motion.frames, len(model.node_names), 4))
    rotations[..., 3] = 1.0
    path = instrument_path(motion) if path is None else path
    rotations[:, 0] = path.rotations
    translations_cm = {0: path.positions_m.astype(np.float64) * CENTIMETRES}
    for part in instrument.moving_parts:
        node = model.node_names.index(part.node)
        rest_m = model.node_positions_m[node] - model.node_positions_m[0]
        moved_m, rotation = part_transform(part.motion, part_values(part, motion.controls, motion.frames))
        position_m = quaternion.rotate(rotation, rest_m) + moved_m
        translations_cm[node] = position_m * CENTIMETRES
        rotations[:, node] = rotation
    return Clip(name, motion.fps, motion.frames, rotations, translations_cm)
