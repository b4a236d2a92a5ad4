"""Animations of FBX and glTF files, converted to the form of BVH files for `app.choreography.read_motion`.

Nodes have rest rotations and scales, which joints of BVH files lack. So each node becomes a joint with the node's
rotation relative to its rest, below a common root. The rest pose is the bind pose of the skin, or the file's pose
without animation. The longest animation is read.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, Final

import numpy as np

from app.arrays import FloatArray
from app.errors import FileError
from app.formats.bvh.clip import BvhClip
from app.formats.fbx.foreign import read_foreign_motion
from app.formats.gltf.animation import sampled
from app.formats.gltf.container import field
from app.formats.gltf.model import GltfAnimation, GltfModel
from app.formats.motion_limits import require_frames
from app.formats.rates import exact_rate
from app.rig import quaternion
from app.rig.characters.figure_build import SINGULAR, nearest_rotations, rest_pose
from app.rig.characters.figure_gltf import bind_pose
from app.rig.gltf_source import read_source

MOST_FPS: Final = 240.0
LEAST_BAKED_FPS: Final = 20.0
"""Rate in frames per second below which keys are considered to be set by hand, and the curves between them are sampled
at `OTHERWISE_FPS`.
"""
OTHERWISE_FPS: Final = Fraction(60)
ROOT: Final = "file"
VRM_ANIMATION: Final = "VRMC_vrm_animation"


@dataclass(frozen=True, eq=False)
class _Nodes:
    """An animated hierarchy of N nodes in metres, Y up.

    Attributes
    ----------
    names, parents
        Name and parent of each node; parents in any order, -1 for none.
    other : collection of int
        Nodes that are not bones unless bones are below them: meshes, cameras, lights.
    rest : (N, 4, 4) float64
        World transforms at rest.
    translations_m, rotations, scales : (F, N, 3), (F, N, 4), (F, N, 3) float64
        Values relative to the parent in F frames.
    """

    names: Sequence[str]
    parents: Sequence[int]
    other: Collection[int]
    rest: FloatArray
    fps: Fraction
    translations_m: FloatArray
    rotations: FloatArray
    scales: FloatArray


def read_fbx_motion(path: Path) -> BvhClip:
    """Read the longest animation of an FBX file. Raises FileError."""
    content = read_foreign_motion(path)
    require_frames(str(path), content.length_s, float(content.fps), len(content.nodes), path.stat().st_size)
    if len(content.transforms) < 2:
        raise FileError("motion.no_animation", file=str(path))
    parents = [node.parent for node in content.nodes]
    posed = np.array([node.world_from_node for node in content.nodes])
    bound = {node: world for node, world in content.bound if abs(np.linalg.det(world)) > SINGULAR}
    return _clip(
        _Nodes(
            [node.name for node in content.nodes],
            parents,
            {at for at, node in enumerate(content.nodes) if node.kind not in ("BONE", "EMPTY", "UNKNOWN")},
            rest_pose(parents, posed, bound),
            content.fps,
            content.transforms[..., :3],
            content.transforms[..., 3:7],
            content.transforms[..., 7:],
        )
    )


def read_gltf_motion(path: Path) -> BvhClip:
    """Read the longest animation of a glTF file (.glb, .gltf, .vrma). Raises FileError."""
    source = read_source(path, animated=True)
    gltf = source.gltf
    bones, no_bones = _vrm_animation(gltf)
    animations = [
        replace(one, channels=tuple(channel for channel in one.channels if channel.node not in no_bones))
        for one in gltf.animations
    ]
    animation = max(animations, key=_length_s, default=None)
    if animation is None or _length_s(animation) <= 0.0:
        raise FileError("motion.no_animation", file=str(path))
    first_s = min(channel.times_s[0] for channel in animation.channels)
    fps = _usual_fps(animation)
    require_frames(str(path), _length_s(animation), float(fps), len(gltf.nodes), gltf.size_bytes)
    count = round(_length_s(animation) * float(fps)) + 1
    values = _sampled(gltf, animation, first_s + np.arange(count) / float(fps))
    parents = [node.parent for node in gltf.nodes]
    rest = rest_pose(parents, source.world_from_node, bind_pose(source))
    other = {at for at, node in enumerate(gltf.nodes) if node.mesh is not None} | no_bones
    names = [bones.get(at, node.name) for at, node in enumerate(gltf.nodes)]
    return _clip(_Nodes(names, parents, other, rest, fps, *values))


def _vrm_animation(gltf: GltfModel) -> tuple[dict[int, str], set[int]]:
    """Return the humanoid bone of each node, and the nodes that carry expressions and gaze, of a VRM animation."""
    extension = field(gltf.extensions, VRM_ANIMATION)
    kinds = field(extension, "expressions")
    faces = [one for kind in ("preset", "custom") for one in _members(field(kinds, kind)).values()]
    bones = _members(field(field(extension, "humanoid"), "humanBones"))
    named = {node: name for name, bone in bones.items() for node in _node(gltf, bone)}
    return named, {node for one in (*faces, field(extension, "lookAt")) for node in _node(gltf, one)} - named.keys()


def _members(value: object) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}


def _node(gltf: GltfModel, owner: object) -> tuple[int, ...]:
    """Return the index of the node that an object of a glTF extension refers to; empty if it does not exist."""
    node = field(owner, "node")
    return (node,) if isinstance(node, int) and 0 <= node < len(gltf.nodes) else ()


def _length_s(animation: GltfAnimation) -> float:
    if not animation.channels:
        return 0.0
    first = min(channel.times_s[0] for channel in animation.channels)
    return float(max(channel.times_s[-1] for channel in animation.channels) - first)


def _usual_fps(animation: GltfAnimation) -> Fraction:
    """Return the frame rate of the densest keys, if these are baked, since glTF stores no rate."""
    keys = max((channel.times_s for channel in animation.channels), key=len)
    # Times are float32 seconds, whose steps are coarse in long animations.
    fps = float((len(keys) - 1) / (keys[-1] - keys[0]))
    return exact_rate(fps, 1e-4) if LEAST_BAKED_FPS <= fps <= MOST_FPS else OTHERWISE_FPS


def _sampled(gltf: GltfModel, animation: GltfAnimation, times_s: FloatArray) -> list[FloatArray]:
    """Return translations (F, N, 3), rotations (F, N, 4) and scales (F, N, 3) of N nodes at F times; nodes without
    animation keep the file's values.
    """
    kept: dict[str, tuple[str, int]] = {
        "translation": ("translation", 3),
        "rotation": ("rotation_xyzw", 4),
        "scale": ("scale", 3),
    }
    values = {}
    for path, (attribute, width) in kept.items():
        still = np.array([getattr(node, attribute) for node in gltf.nodes]).reshape(-1, width)
        values[path] = np.tile(still, (len(times_s), 1, 1))
    # A file may animate one target several times; the last channel applies.
    targets = {(channel.node, channel.path): channel for channel in animation.channels}
    for channel in targets.values():
        values[channel.path][:, channel.node] = sampled(channel, times_s)
    return [values[path] for path in kept]


def _clip(nodes: _Nodes) -> BvhClip:
    """Return the animation as a BVH clip with a joint for each bone, rotated relative to its rest."""
    order = _bones(nodes.parents, nodes.other)
    joint_of = {node: 1 + at for at, node in enumerate(order)}
    frames = len(nodes.rotations)
    rest_turns, rest_places = nearest_rotations(nodes.rest), nodes.rest[:, :3, 3]
    world = np.empty((len(nodes.names), frames, 4))
    scale = np.empty((len(nodes.names), 3))
    rotations = np.zeros((frames, 1 + len(order), 4))
    rotations[..., 3] = 1.0
    offsets = np.zeros((1 + len(order), 3))
    translations: dict[int, FloatArray] = {}
    above = np.zeros((frames, 4))
    above[:, 3] = 1.0
    for node in order:
        parent, joint = nodes.parents[node], joint_of[node]
        carrier = world[parent] if parent >= 0 else above
        rest_of_carrier = rest_turns[parent] if parent >= 0 else quaternion.IDENTITY
        size = scale[parent] if parent >= 0 else np.ones(3)
        world[node] = quaternion.multiply(carrier, nodes.rotations[:, node])
        # An animated scale is a squash, which bones of bodies do not have.
        scale[node] = size * nodes.scales[0, node]
        turned_carrier = quaternion.multiply(carrier, quaternion.conjugate(rest_of_carrier))
        turned = quaternion.multiply(world[node], quaternion.conjugate(rest_turns[node]))
        rotations[:, joint] = quaternion.multiply(quaternion.conjugate(turned_carrier), turned)
        offsets[joint] = rest_places[node] - (rest_places[parent] if parent >= 0 else 0.0)
        moved = quaternion.rotate(rest_of_carrier, size * nodes.translations_m[:, node])
        if np.abs(moved - offsets[joint]).max() > 1e-6:
            translations[joint] = 100.0 * moved
    return BvhClip(
        names=(ROOT, *(nodes.names[node] or f"node_{node}" for node in order)),
        parents=(-1, *(joint_of.get(nodes.parents[node], 0) for node in order)),
        offsets_cm=100.0 * offsets,
        end_sites_cm={},
        fps=nodes.fps,
        root_translation_cm=np.zeros((frames, 3)),
        rotations_xyzw=rotations,
        translations_cm=translations,
    )


def _bones(parents: Sequence[int], other: Collection[int]) -> list[int]:
    """Return the nodes that are bones or have bones below them, parents first; ``other`` nodes are no bones
    themselves.
    """
    children: dict[int, list[int]] = {}
    for node, parent in enumerate(parents):
        children.setdefault(parent, []).append(node)
    order: list[int] = []
    pending = children.get(-1, [])[::-1]
    while pending:
        node = pending.pop()
        order.append(node)
        pending += children.get(node, [])[::-1]
    kept: set[int] = set()
    for node in reversed(order):
        if node not in other or any(child in kept for child in children.get(node, [])):
            kept.add(node)
    return [node for node in order if node in kept]
