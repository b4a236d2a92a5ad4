"""Loading of characters: bundled glTF files directly, others as figures (`app.rig.characters.figure_to_character`)."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from app.encoding import shown
from app.rig.characters.face_map import FaceMapping, map_morphs
from app.rig.characters.figure_to_character import figure_character
from app.rig.characters.joint_mapping import JointMapping, map_joints
from app.rig.characters.read_figure import is_glb, read_figure
from app.rig.characters.t_pose import facing_ahead, upright
from app.rig.figure import Figure
from app.rig.gltf_source import OURS, GltfSource, build_mesh, invalid, read_source
from app.rig.model import Character, Landmark, Skeleton
from app.rig.skeleton import rest_positions
from metadata.model import REQUIRED_JOINTS


@dataclass(frozen=True, eq=False)
class CharacterFigure:
    """A figure with its mapping of joints and of the face.

    Attributes
    ----------
    figure : Figure
        Figure, upright and facing +Z.
    """

    figure: Figure
    joints: JointMapping
    face: FaceMapping


def load_character(
    path: Path,
    id: str = "",
    joints: Mapping[str, str] | None = None,
    morphs: Mapping[str, Mapping[str, float]] | None = None,
    height_m: float = 0.0,
    hidden: Collection[str] = (),
) -> Character:
    """Load a character from a VRM, glTF or FBX file.

    Parameters
    ----------
    id : str
        Id of the character; empty for the file's name.
    joints : mapping of str to str
        Bone of each corrected VRM 1.0 joint, regardless of the bone's name; empty if there is no bone.
    morphs : mapping of str to mapping of str to float
        Weights of the file's morphs for each corrected ARKit shape.
    height_m : float
        Height of the character; 0 for the height in the file.
    hidden : collection of str
        Meshes of the file to omit.

    Raises
    ------
    FileError
        The file cannot be read, or contains no humanoid that can play.
    """
    try:
        if is_glb(path):
            source = read_source(path)
            if source.gltf.generator == OURS and not height_m and not hidden:
                return _ours(source, id or shown(path.stem))
        reading = read_character(path, joints, morphs)
        known, faces = reading.joints.bones, reading.face.morphs
        return figure_character(reading.figure.without(hidden), id or shown(path.stem), known, faces, height_m)
    except (KeyError, IndexError, TypeError, ValueError) as error:
        raise invalid(path, f"damaged: {error!r}") from error


def read_character(
    path: Path, joints: Mapping[str, str] | None = None, morphs: Mapping[str, Mapping[str, float]] | None = None
) -> CharacterFigure:
    """Read a figure, and identify its joints and face. Raises FileError, but not for missing joints.

    Parameters
    ----------
    joints, morphs : mapping
        The user's corrections, as in `load_character`.
    """
    figure = read_figure(path)
    found = map_joints(figure, joints)
    if set(REQUIRED_JOINTS) <= set(found.bones):
        facing = facing_ahead(upright(figure, found.bones), found.bones)
        if facing is not figure:
            # Left and right depend on the forward direction.
            figure, found = facing, map_joints(facing, joints)
    return CharacterFigure(figure, found, map_morphs(figure, morphs))


def _ours(source: GltfSource, id: str) -> Character:
    """Return a bundled character: its nodes are a normalised skeleton, and a single skin binds all meshes."""
    nodes, (skin,) = source.gltf.nodes, source.gltf.skins
    root = nodes[min(skin.joints)].parent

    def way(node: int) -> tuple[int, ...]:
        return (node,) if node == root else (*way(nodes[node].parent), node)

    # Depth first, with children directly after their parent.
    joints = sorted((root, *skin.joints), key=way)
    joint_of = {node: joint for joint, node in enumerate(joints)}
    parents = tuple(joint_of.get(nodes[node].parent, -1) for node in joints)
    offsets = source.world_from_node[joints, :3, 3]
    offsets[1:] -= offsets[list(parents[1:])]
    skeleton = Skeleton(tuple(nodes[node].name for node in joints), parents, offsets)
    table = np.array([joint_of[node] for node in skin.joints], dtype=np.int32)
    # The skin does not name the root, so it is treated as bound in its rest pose.
    joint_from_mesh = np.tile(np.eye(4), (len(joints), 1, 1))
    joint_from_mesh[:, :3, 3] = -rest_positions(skeleton)
    joint_from_mesh[table] = skin.joint_from_mesh_bind
    meshes = []
    for entry in nodes:
        if entry.mesh is not None:
            mesh, _ = build_mesh(source, entry.mesh, source.gltf.meshes[entry.mesh].name)
            weights = mesh.weights / np.maximum(mesh.weights.sum(axis=1, keepdims=True), 1e-9)
            meshes.append(replace(mesh, joints=table[mesh.joints], weights=weights.astype(np.float32)))
    places = source.gltf.scene_extras["suisou"].get("landmarks", {})
    marks = {
        name: Landmark(place["mesh"], np.asarray(place["vertices"], dtype=np.int32)) for name, place in places.items()
    }
    return Character(id, skeleton, joint_from_mesh, tuple(meshes), marks)
