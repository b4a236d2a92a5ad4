"""Landmarks of a character that brings none: found from joints, skin weights, normals and the jaw's morph.

Names are those of our own characters: ``right.index.pad``, ``left.palm``, ``lips.contact``, ``left.foot.sole`` ...
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.rig.model import Landmark, Mesh, Skeleton
from app.rig.skeleton import rest_positions
from metadata.load import load_skeleton

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.intp]

FINGERS = ("thumb", "index", "middle", "ring", "little")
JAW_MORPHS = ("jawOpen", "aa", "A")
"""Morphs that open the mouth, by the names that files use."""
PAD_VERTICES, SIDE_VERTICES, PALM_VERTICES, WEB_VERTICES, LIP_VERTICES = 6, 4, 8, 5, 6
MIDLINE_M, SOLE_M = 0.008, 0.008


@dataclass(frozen=True, eq=False)
class _Skin:
    """A mesh in the rest pose: positions and normals (V, 3), weights (V, J) on all joints."""

    mesh: Mesh
    positions: FloatArray
    normals: FloatArray
    weights: FloatArray


def found_landmarks(skeleton: Skeleton, joint_from_mesh: FloatArray, meshes: tuple[Mesh, ...]) -> dict[str, Landmark]:
    """Find the landmarks of a character.

    A landmark for which the character has nothing (no jaw morph: no lips) is absent.
    """
    skins = [_rest_skin(skeleton, joint_from_mesh, mesh) for mesh in meshes]
    found: dict[str, Landmark] = {}
    for side in ("left", "right"):
        skin = _most_on(skins, [skeleton.index(f"{side}{name}") for name in ("Hand", "IndexDistal", "ThumbDistal")])
        if skin is not None:
            found.update(_hand(skeleton, skin, side))
        sole = _most_on(skins, [skeleton.index(f"{side}Foot")], lowest=True)
        if sole is not None:
            found[f"{side}.foot.sole"] = _sole(skeleton, sole, side)
    for skin in skins:
        lips = _lips(skin)
        if lips:
            found.update(lips)
            break
    return found


def _rest_skin(skeleton: Skeleton, joint_from_mesh: FloatArray, mesh: Mesh) -> _Skin:
    weights = np.zeros((len(mesh.positions_m), len(skeleton.names)))
    np.add.at(weights, (np.arange(len(weights))[:, None], mesh.joints), mesh.weights)
    world = joint_from_mesh[:, :3, :].copy()
    world[..., 3] += rest_positions(skeleton)
    blended = np.tensordot(weights, world, axes=(1, 0))
    positions = np.einsum("vij,vj->vi", blended[..., :3], mesh.positions_m) + blended[..., 3]
    normals = np.einsum("vij,vj->vi", blended[..., :3], mesh.normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    return _Skin(mesh, positions, normals, weights)


def _most_on(skins: list[_Skin], joints: list[int], lowest: bool = False) -> _Skin | None:
    """The mesh that covers joints: with the most vertices there, or (a shoe over a foot) the lowest one."""
    covering = [skin for skin in skins if all((skin.weights[:, joint] > 0.5).any() for joint in joints)]
    if not covering:
        return None
    if lowest:
        return min(covering, key=lambda skin: float(skin.positions[skin.weights[:, joints[0]] > 0.5, 1].min()))
    return max(covering, key=lambda skin: int((skin.weights[:, joints] > 0.5).sum()))


def _patch(skin: _Skin, own: IntArray, origin: FloatArray, direction: FloatArray, count: int) -> IntArray:
    """Vertices about the place where a ray from inside a limb leaves its skin; empty where none faces that way."""
    off = skin.positions[own] - origin
    along = off @ direction
    across = np.linalg.norm(off - along[:, None] * direction, axis=1)
    facing = (skin.normals[own] @ direction > 0.5) & (along > 0.0)
    if not facing.any():
        return np.zeros(0, dtype=np.intp)
    place = origin + direction * along[facing][np.argmin(across[facing])]
    return _nearest(skin, own[facing], place, count)


def _nearest(skin: _Skin, own: IntArray, place: FloatArray, count: int) -> IntArray:
    order = np.argsort(np.linalg.norm(skin.positions[own] - place, axis=1), kind="stable")
    return np.sort(own[order[:count]])


def _hand(skeleton: Skeleton, skin: _Skin, side: str) -> dict[str, Landmark]:
    profile, rest = load_skeleton(), rest_positions(skeleton)
    joints = [skeleton.index(f"{side}Hand")]
    places: dict[str, IntArray] = {}
    for finger in FINGERS:
        names = profile.fingers[side][finger].joints  # type: ignore[index]
        joints += [skeleton.index(name) for name in names]
        for order, phalanx in ((0, "_proximal"), (1, "_middle"), (2, "")):
            if finger == "thumb" and order == 0:
                continue
            joint = skeleton.index(names[order])
            own = np.flatnonzero(skin.weights[:, joint] > (0.8 if order == 2 else 0.6))
            if not len(own):
                continue
            before = joint if order < 2 else skeleton.index(names[1])
            following = skeleton.index(names[order + 1]) if order < 2 else joint
            bone = rest[following] - rest[before]
            bone /= np.linalg.norm(bone)
            # Turning about the flexion axis takes the bone to the palm, about the sideways axis to the thumb's side.
            axes = profile.joint_axes(names[order])
            palmar, thumbward = np.cross(axes.flexion, bone), np.cross(axes.sideways, bone)
            along = (skin.positions[own] - rest[joint]) @ bone
            reach = float(along.max()) if order == 2 else float(np.linalg.norm(rest[following] - rest[joint]))
            middle = rest[joint] + bone * reach * (0.5 if order < 2 else 0.55)
            for place, direction, count in (("pad", palmar, PAD_VERTICES), ("side", thumbward, SIDE_VERTICES)):
                towards = direction / np.linalg.norm(direction)
                places[f"{finger}.{place}{phalanx}"] = _patch(skin, own, middle, towards, count)
    hand = np.flatnonzero(skin.weights[:, joints].sum(axis=1) > 0.5)
    wrist, knuckle = rest[joints[0]], rest[skeleton.index(f"{side}MiddleProximal")]
    down = np.array([0.0, -1.0, 0.0])
    places["palm"] = _patch(skin, hand, wrist + 0.6 * (knuckle - wrist), down, PALM_VERTICES)
    web = (rest[skeleton.index(f"{side}IndexProximal")] + rest[skeleton.index(f"{side}ThumbProximal")]) / 2
    places["thumb_web"] = _nearest(skin, hand, web, WEB_VERTICES)
    places["hand"] = hand
    return {f"{side}.{name}": _landmark(skin, rows) for name, rows in places.items() if len(rows)}


def _sole(skeleton: Skeleton, skin: _Skin, side: str) -> Landmark:
    joints = [skeleton.names.index(name) for name in (f"{side}Foot", f"{side}Toes") if name in skeleton.names]
    own = np.flatnonzero(skin.weights[:, joints].sum(axis=1) > 0.5)
    height = skin.positions[own, 1]
    return _landmark(skin, own[height < height.min() + SOLE_M])


def _lips(skin: _Skin) -> dict[str, Landmark]:
    """Where the mouth parts: at the midline, vertices the jaw's morph takes along next to such it leaves."""
    jaw = next((morph for name in JAW_MORPHS for morph in skin.mesh.morphs if morph.name == name), None)
    if jaw is None:
        return {}
    drop = np.zeros(len(skin.positions))
    drop[jaw.vertices] = -jaw.deltas_m[:, 1]
    middle = np.abs(skin.positions[:, 0]) < MIDLINE_M
    lower = np.flatnonzero(middle & (drop > 0.6 * drop.max()))
    upper = np.flatnonzero(middle & (np.abs(drop) < 0.3 * drop.max()))
    if not len(lower) or not len(upper):
        return {}
    gaps = np.linalg.norm(skin.positions[upper][:, None] - skin.positions[lower][None], axis=2)
    # The foremost place where the lips all but touch: behind it are the insides of the mouth.
    score = gaps - 0.5 * (skin.positions[upper, 2][:, None] + skin.positions[lower, 2][None])
    first, second = np.unravel_index(np.argsort(score, axis=None, kind="stable")[:LIP_VERTICES], gaps.shape)
    contact = np.unique(np.concatenate([upper[first], lower[second]]))
    return {
        "lips.contact": _landmark(skin, contact),
        "lips.upper": _landmark(skin, np.unique(upper[first])),
        "lips.lower": _landmark(skin, np.unique(lower[second])),
    }


def _landmark(skin: _Skin, vertices: IntArray) -> Landmark:
    return Landmark(skin.mesh.name, vertices.astype(np.int32))
