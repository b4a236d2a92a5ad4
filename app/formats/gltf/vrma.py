"""Reading and writing of VRM Animation 1.0 (.vrma): motion of a humanoid, its expressions and its gaze, without a mesh.

A scene has humanoid bones under their VRM names, hips first; all rest rotations are identity, so that readers cannot
disagree about them, and only the hips translate. A bone named `LOOK_AT` is the gaze, no humanoid bone: its rotation on
the head is the direction of view. Each morph of the clip is a custom expression; further expressions are sums of them.
An expression's weight is the X of a node's translation.

Source: VRM consortium, "VRMC_vrm_animation-1.0" (README.md of 1.0, where the gaze is a rotation).
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence, Set
from typing import Any, Final

import numpy as np
import pygltflib as gltf

from app.arrays import AnyFloatArray, AnyIntArray, FloatArray
from app.errors import FileError
from app.formats.gltf.document import GlbDocument
from app.formats.gltf.model import GltfAnimation
from app.formats.gltf.read import read_glb
from app.formats.gltf.read_scene import channel_values, clip_frames
from app.formats.gltf.samplers import METRES, Samplers
from app.formats.gltf.write import node_at, write_document
from app.formats.scene import Bone, Clip, NodePlace, Scene, SkinnedMesh, check_scene

EXTENSION: Final = "VRMC_vrm_animation"
LOOK_AT: Final = "lookAt"
GAZE_EXPRESSIONS: Final = ("lookUp", "lookDown", "lookLeft", "lookRight")
"""Expressions that an animation must not contain, since the gaze replaces them."""
PRESETS: Final = frozenset(
    (
        *("happy", "angry", "sad", "relaxed", "surprised", "neutral"),
        *("aa", "ih", "ou", "ee", "oh"),
        *("blink", "blinkLeft", "blinkRight"),
    )
)
_UNTURNED: Final = np.array([0.0, 0.0, 0.0, 1.0])
_FIRST: Final = 1
"""Index of the first bone's node."""


def write_vrma(
    path: str | os.PathLike[str], scene: Scene, sums: Mapping[str, Mapping[str, float]] | None = None
) -> None:
    """Write a scene as a VRM animation, atomically; meshes are not written.

    Parameters
    ----------
    path : path
        File to write.
    scene : Scene
        Scene with a clip, on humanoid bones with identity rest rotations.
    sums : mapping of str to mapping of str to float, optional
        Further expressions, as weights of the clip's morphs.

    Raises
    ------
    FileError
        The file cannot be written.
    ValueError
        The scene cannot be a VRM animation.
    """
    clip = _checked(scene)
    document = GlbDocument(gltf.GLTF2(asset=gltf.Asset(version="2.0", generator=scene.creator)))
    out = document.gltf
    # Viewers scale and place the node above the hips.
    out.nodes.append(gltf.Node(name="root", children=[_FIRST]))
    for bone in scene.bones:
        out.nodes.append(node_at(bone.name, NodePlace(bone.translation_cm, bone.rotation_xyzw)))
        if bone.parent >= 0:
            parent = out.nodes[_FIRST + bone.parent]
            parent.children = [*(parent.children or []), len(out.nodes) - 1]
    samplers = Samplers(document, clip)
    samplers.add_clip(scene, clip, _FIRST, (), (), _without_gaze(scene, clip))
    extension = {"specVersion": "1.0", **_bones(scene)}
    faces = len(out.nodes)
    expressions = _expressions(clip, sums or {})
    for name, (weights, keys) in expressions.items():
        moved = np.zeros((clip.frames, 3), np.float32)
        moved[:, 0] = weights
        samplers.add(len(out.nodes), "translation", moved, keys)
        out.nodes.append(gltf.Node(name=name))
    tables: dict[str, dict[str, Any]] = {}
    for node, name in enumerate(expressions, faces):
        tables.setdefault("preset" if name in PRESETS else "custom", {})[name] = {"node": node}
    if tables:
        extension["expressions"] = tables
    out.scenes.append(gltf.Scene(nodes=[0, *range(faces, len(out.nodes))]))
    out.scene = 0
    out.extensions = {EXTENSION: extension}
    out.extensionsUsed = [EXTENSION]
    write_document(path, document)


def _checked(scene: Scene) -> Clip:
    """Return the clip of a scene; ValueError if a VRM animation cannot hold the scene."""
    check_scene(scene)
    clip = scene.clip
    if clip is None or scene.bones[0].name != "hips" or set(clip.translations_cm) - {0}:
        raise ValueError("a VRM animation has a clip that moves the hips, its first bone, and no other")
    turned = [bone.name for bone in scene.bones if not np.allclose(np.abs(bone.rotation_xyzw), _UNTURNED, atol=1e-6)]
    if turned:
        raise ValueError(f"bones of a VRM animation are unturned at rest, not {turned}")
    return clip


def _without_gaze(scene: Scene, clip: Clip) -> list[int]:
    """Return the gaze's bone if it never turns: without keys, an animation leaves the gaze of a figure as it is."""
    turned = np.abs(clip.rotations_xyzw[..., 3]).min(axis=0) < 1.0
    return [at for at, bone in enumerate(scene.bones) if bone.name == LOOK_AT and not turned[at]]


def _bones(scene: Scene) -> dict[str, Any]:
    """Return the tables of bones and of the gaze in the VRM animation extension, as JSON."""
    gaze = next((at for at, bone in enumerate(scene.bones) if bone.name == LOOK_AT), None)
    nodes = {bone.name: {"node": _FIRST + at} for at, bone in enumerate(scene.bones) if at != gaze}
    found: dict[str, Any] = {"humanoid": {"humanBones": nodes}}
    if gaze is not None:
        offset_m = np.asarray(scene.bones[gaze].translation_cm) * METRES
        found[LOOK_AT] = {"node": _FIRST + gaze, "offsetFromHeadBone": offset_m.tolist()}
    return found


def _expressions(
    clip: Clip, sums: Mapping[str, Mapping[str, float]]
) -> dict[str, tuple[AnyFloatArray, AnyIntArray | None]]:
    """Return the weights (F,), 0..1, of all expressions, and the frames of their keys (None for all frames)."""
    keys = clip.keys
    found = {
        name: (np.clip(weights, 0.0, 1.0), None if keys is None else keys.morphs[name])
        for name, weights in clip.morph_weights.items()
        if name not in GAZE_EXPRESSIONS
    }
    for name, parts in sums.items():
        there = {morph: share for morph, share in parts.items() if morph in clip.morph_weights}
        if name in found or name in GAZE_EXPRESSIONS or not there:
            continue
        weights = np.sum(
            [share * np.asarray(clip.morph_weights[morph], np.float64) for morph, share in there.items()], 0
        )
        own = None if keys is None else np.unique(np.concatenate([keys.morphs[morph] for morph in there]))
        found[name] = np.clip(weights, 0.0, 1.0), own
    return found


def read_vrma(path: str | os.PathLike[str], written: Sequence[SkinnedMesh]) -> Scene:
    """Read a file written by `write_vrma`, with the meshes that follow its bones and expressions.

    Parameters
    ----------
    written : sequence of SkinnedMesh
        The meshes of the written scene.

    Raises
    ------
    FileError
        The file was not written by `write_vrma`, or is damaged.
    """
    file, model = os.fspath(path), read_glb(path, animated=True)
    try:
        extension: Mapping[str, Any] = model.extensions[EXTENSION]
        nodes = {int(bone["node"]): name for name, bone in extension["humanoid"]["humanBones"].items()}
        if LOOK_AT in extension:
            nodes[int(extension[LOOK_AT]["node"])] = LOOK_AT
        row_of = {node: row for row, node in enumerate(sorted(nodes))}
        bones = tuple(
            Bone(nodes[node], row_of.get(place.parent, -1), place.translation / METRES, place.rotation_xyzw)
            for node, place in ((node, model.nodes[node]) for node in row_of)
        )
        tables: Mapping[str, Any] = extension.get("expressions", {})
        faces = {int(one["node"]): name for table in tables.values() for name, one in table.items()}
        (animation,) = model.animations
        known = {morph.name for mesh in written for morph in mesh.morphs}
        clip = _clip(animation, row_of, faces, known)
        scene = Scene(bones, tuple(written), clip, model.generator)
        check_scene(scene)
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise FileError("gltf.damaged", file=file, what=str(error)) from error
    return scene


def _clip(animation: GltfAnimation, row_of: Mapping[int, int], faces: Mapping[int, str], known: Set[str]) -> Clip:
    """Return an animation as a clip: bones by ``row_of`` (index by node), and those expressions in ``faces`` (name by
    node) that are ``known``.
    """
    fps, times_s = clip_frames(animation)
    rotations = np.tile(_UNTURNED, (len(times_s), len(row_of), 1))
    translations: dict[int, FloatArray] = {}
    weights: dict[str, AnyFloatArray] = {}
    for channel in animation.channels:
        if channel.node in faces:
            if faces[channel.node] in known:
                weights[faces[channel.node]] = channel_values(channel, times_s)[:, 0]
        elif channel.path == "rotation":
            rotations[:, row_of[channel.node]] = channel_values(channel, times_s)
        else:
            translations[row_of[channel.node]] = channel_values(channel, times_s) / METRES
    return Clip(animation.name, fps, len(times_s), rotations, translations, weights)
