"""Landmarks for a character without them, found from joints, skin weights, normals, and the face's morph or shape.

Names are those of bundled characters: ``right.index.pad``, ``left.palm``, ``lips.contact``, ``left.foot.sole`` and so
on. Landmarks of a finger whose skin moves with the hand (a mitten) are on that skin at the finger's place.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.rig.characters.face_profile import at_height, lowest_of_face_m, nose_base_m, notch_m
from app.rig.ik import Side
from app.rig.mesh import Mesh
from app.rig.model import Character, Landmark, Skeleton
from app.rig.skeleton import ancestors, rest_positions
from metadata.load import load_skeleton

FINGERS = ("thumb", "index", "middle", "ring", "little")
JAW_MORPHS = ("jawOpen", "aa", "A")
"""Morphs that open the mouth, by common names."""
PAD_VERTICES, SIDE_VERTICES, PALM_VERTICES, WEB_VERTICES, LIP_VERTICES = 6, 4, 8, 5, 6
MIDLINE_M, SOLE_M = 0.008, 0.008
FIRM = 0.95
"""Weight of the foot above which a vertex of the sole stands with it."""
COINCIDE_M = 1e-6
"""Distance in metres below which joints coincide."""
PATCH_M = 0.006
"""Radius in metres of the area of a landmark's vertices around the nearest one; larger areas would have a centre deep
inside a finger.
"""
BARE_MIDDLE = (0.62, 0.5, 0.55)
"""Middle of the visible part of each phalanx, as a share of its length; the web covers half of the first."""
PALM_M = 0.014
"""Radius in metres of the palm's area, which is flat and has few vertices."""
FACING = (0.7, 0.5)
"""Least cosine between a landmark's normals and its direction, and a second value if there are no such normals."""
LEAST_WEIGHTS = (0.5, 0.25)
"""Least skin weights of a joint's vertices, tried in turn."""
BEFORE = 0.35
"""Distance of a face's skin from the head's joint, as a share of the foremost one's, above which it belongs to the
front.
"""
EYES_M, HEAD_M = 0.06, 0.217
"""Distance of the eyes, and height of the head's skin, in metres, for which the lengths in this module were chosen."""


@dataclass(frozen=True, eq=False)
class _Skin:
    """A mesh in the rest pose: positions and normals (V, 3) of V vertices, and their weights (V, J) on all J joints."""

    mesh: Mesh
    positions: FloatArray
    normals: FloatArray
    weights: FloatArray


def found_landmarks(skeleton: Skeleton, joint_from_mesh: FloatArray, meshes: tuple[Mesh, ...]) -> dict[str, Landmark]:
    """Return the landmarks on a character's skin by name, such as palms, finger tips and lips.

    A landmark that cannot be found (a palm on a hand without skin) is omitted.
    """
    skins = [_rest_skin(skeleton, joint_from_mesh, mesh) for mesh in meshes if len(mesh.positions_m)]
    found: dict[str, Landmark] = {}
    for side in ("left", "right"):
        found.update(_hand(skeleton, skins, side))
        found.update(_sole(skeleton, skins, side))
    head = _Head.of(skeleton, skins)
    for lips in (*(_lips_by_jaw(skin, head) for skin in skins), _lips_by_shape(skins, head)):
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


def _own(skin: _Skin, joints: list[int], least: float) -> IndexArray:
    """Return the indices (K,) of vertices for which the weights of the given joints add up to more than ``least``."""
    return np.flatnonzero(skin.weights[:, joints].sum(axis=1) > least)


def _patch(
    skin: _Skin, own: IndexArray, origin: FloatArray, direction: FloatArray, count: int, within_m: float = PATCH_M
) -> IndexArray:
    """Return the indices (K,) of ``count`` vertices, among those with the indices ``own``, around the point at which a
    ray from ``origin`` inside a limb leaves its skin; those nearest to it if no skin faces ``direction``.
    """
    off = skin.positions[own] - origin
    along = off @ direction
    across = np.linalg.norm(off - along[:, None] * direction, axis=1)
    ahead = skin.normals[own] @ direction
    facing = next((found for least in FACING if (found := (ahead > least) & (along > 0.0)).any()), None)
    if facing is None:
        return _nearest(skin, own, origin, count, within_m)
    place = origin + direction * along[facing][np.argmin(across[facing])]
    return _nearest(skin, own[facing], place, count, within_m)


def _nearest(skin: _Skin, own: IndexArray, place: FloatArray, count: int, within_m: float = PATCH_M) -> IndexArray:
    far = np.linalg.norm(skin.positions[own] - place, axis=1)
    order = np.argsort(far, kind="stable")[:count]
    return np.sort(own[order[far[order] <= max(within_m, 1.25 * far[order[0]])]])


def _hand(skeleton: Skeleton, skins: list[_Skin], side: Side) -> dict[str, Landmark]:
    profile, rest = load_skeleton(), rest_positions(skeleton)
    names = {finger: profile.fingers[side][finger].joints for finger in FINGERS}  # type: ignore[index]
    fingers = [skeleton.index(name) for finger in FINGERS for name in names[finger]]
    wrist = skeleton.index(f"{side}Hand")
    counts = [int((skin.weights[:, [wrist, *fingers]].sum(axis=1) > 0.5).sum()) for skin in skins]
    on_fingers = [int((skin.weights[:, fingers].sum(axis=1) > 0.5).sum()) for skin in skins]
    if not any(counts):
        return {}
    # Rings, nails and sleeves are attached to a hand too; the mesh with most vertices on it is the hand.
    skin = skins[max(range(len(skins)), key=lambda place: (on_fingers[place], counts[place]))]
    hand = _own(skin, [wrist, *fingers], 0.5)
    places: dict[str, tuple[_Skin, IndexArray]] = {}
    for finger in FINGERS:
        for order, phalanx in ((0, "_proximal"), (1, "_middle"), (2, "")):
            if finger == "thumb" and order == 0:
                continue
            joint = skeleton.index(names[finger][order])
            around, own = _of_phalanx(skin, skins, joint, 0.8 if order == 2 else 0.6)
            before = joint if order < 2 else skeleton.index(names[finger][1])
            following = skeleton.index(names[finger][order + 1]) if order < 2 else joint
            bone = rest[following] - rest[before]
            length = float(np.linalg.norm(bone))
            if length < COINCIDE_M:
                # In a finger of two bones the missing joint is placed on the next bone and points along the finger.
                bone = rest[skeleton.index(names[finger][2])] - rest[skeleton.index(names[finger][0])]
                length = float(np.linalg.norm(bone))
            if length < COINCIDE_M:
                continue
            bone /= length
            # Rotating about the flexion axis moves the bone to the palm, about the sideways axis towards the thumb.
            axes = profile.joint_axes(names[finger][order])
            palmar, thumbward = np.cross(axes.flexion, bone), np.cross(axes.sideways, bone)
            reach = length
            if order == 2:
                # Without skin to measure, a fingertip is assumed as long as the phalanx before it.
                reach = float(((around.positions[own] - rest[joint]) @ bone).max()) if len(own) else 0.9 * length
            middle = rest[joint] + bone * reach * BARE_MIDDLE[order]
            for place, direction, count in (("pad", palmar, PAD_VERTICES), ("side", thumbward, SIDE_VERTICES)):
                towards = direction / np.linalg.norm(direction)
                rows = _patch(around, own if len(own) else hand, middle, towards, count)
                places[f"{finger}.{place}{phalanx}"] = around, rows
    knuckle = rest[skeleton.index(f"{side}MiddleProximal")]
    down = np.array([0.0, -1.0, 0.0])
    places["palm"] = skin, _patch(skin, hand, rest[wrist] + 0.6 * (knuckle - rest[wrist]), down, PALM_VERTICES, PALM_M)
    web = (rest[skeleton.index(f"{side}IndexProximal")] + rest[skeleton.index(f"{side}ThumbProximal")]) / 2
    places["thumb_web"] = skin, _nearest(skin, hand, web, WEB_VERTICES)
    places["hand"] = skin, hand
    return {f"{side}.{name}": _landmark(*place) for name, place in places.items()}


def _of_phalanx(hand: _Skin, skins: list[_Skin], joint: int, least: float) -> tuple[_Skin, IndexArray]:
    """Return the mesh that covers a finger bone, and the indices of its vertices that move with the joint.

    That is the hand's mesh, or another one (a glove or sleeve) with most of these vertices. Vertices whose weight is
    above ``least`` move with the joint; if there are none, those with smaller weights.
    """
    for weight in (least, *LEAST_WEIGHTS):
        own = {id(skin): _own(skin, [joint], weight) for skin in skins}
        most = max(skins, key=lambda skin: len(own[id(skin)]))
        if len(own[id(most)]):
            skin = hand if 2 * len(own[id(hand)]) >= len(own[id(most)]) else most
            return skin, own[id(skin)]
    return hand, np.zeros(0, np.intp)


def _sole(skeleton: Skeleton, skins: list[_Skin], side: Side) -> dict[str, Landmark]:
    """Return the landmarks of the lowest skin of a foot: of its shoe, or of the leg if nothing moves with the foot."""
    named = (f"{side}Foot", f"{side}Toes"), (f"{side}LowerLeg",)
    for names in named:
        joints = [skeleton.names.index(name) for name in names if name in skeleton.names]
        own = [(skin, rows) for skin in skins if len(rows := _own(skin, joints, 0.5))]
        if own:
            skin, rows = min(own, key=lambda one: float(one[0].positions[one[1], 1].min()))
            height = skin.positions[rows, 1]
            lowest = rows[height < height.min() + SOLE_M]
            # The shaft of a boot, which the shin moves by its share, does not stand.
            firm = lowest[skin.weights[lowest][:, joints].sum(axis=1) > FIRM]
            return {f"{side}.foot.sole": _landmark(skin, firm if len(firm) else lowest)}
    return {}


@dataclass(frozen=True, eq=False)
class _Head:
    """Place and size of a head.

    Attributes
    ----------
    joints : list of int
        The head's joint and all joints below it.
    place : (3,) float64
        Position of the head's joint.
    eyes_m : float or None
        Height of the eyes.
    size : float
        Size relative to the head for which the lengths in this module were chosen.
    """

    joints: list[int]
    place: FloatArray
    eyes_m: float | None
    size: float

    @classmethod
    def of(cls, skeleton: Skeleton, skins: list[_Skin]) -> _Head:
        head, rest = skeleton.index("head"), rest_positions(skeleton)
        joints = [joint for joint in range(len(skeleton.names)) if head in ancestors(skeleton, joint)]
        eyes = _eyes(skeleton, tuple(skin.mesh for skin in skins))
        if eyes is not None:
            return cls(joints, rest[head], float(eyes[0][1]), float(np.linalg.norm(eyes[0] - eyes[1])) / EYES_M)
        heights = [skin.positions[rows, 1] for skin in skins if len(rows := _own(skin, joints, 0.5))]
        if not heights:
            return cls(joints, rest[head], None, 1.0)
        # The position of the joint within a head differs between rigs.
        low_m, high_m = np.percentile(np.concatenate(heights), [0.5, 99.5])
        return cls(joints, rest[head], None, float(high_m - low_m) / HEAD_M)


def eye_distance(character: Character) -> float:
    """Return the distance of the eyes in metres; estimated from the head's height if there are none."""
    eyes = _eyes(character.skeleton, character.meshes)
    if eyes is not None:
        return float(np.linalg.norm(eyes[0] - eyes[1]))
    skins = [_rest_skin(character.skeleton, character.joint_from_mesh, mesh) for mesh in character.meshes]
    return EYES_M * _Head.of(character.skeleton, skins).size


def _eyes(skeleton: Skeleton, meshes: tuple[Mesh, ...]) -> tuple[FloatArray, FloatArray] | None:
    """Return the positions (3,) of left and right eye in the rest pose; None if there are none, or only added joints
    without skin."""
    names = ("leftEye", "rightEye")
    if not set(names) <= set(skeleton.names):
        return None
    rest = rest_positions(skeleton)
    left, right = (skeleton.index(name) for name in names)
    carry = [any(np.any(mesh.weights[mesh.joints == joint] > 0.5) for mesh in meshes) for joint in (left, right)]
    apart = float(np.linalg.norm(rest[left] - rest[right])) > 0.0
    return (rest[left], rest[right]) if all(carry) and apart else None


def _lips_by_jaw(skin: _Skin, head: _Head) -> dict[str, Landmark]:
    """Return the landmarks of the lips from the morph that opens the jaw: adjacent vertices near the midline of which
    it lowers one and not the other.
    """
    jaw = next((morph for name in JAW_MORPHS for morph in skin.mesh.morphs if morph.name == name), None)
    if jaw is None or not len(jaw.vertices):
        return {}
    drop = np.zeros(len(skin.positions))
    drop[jaw.vertices] = -jaw.deltas_m[:, 1]
    middle = np.abs(skin.positions[:, 0] - head.place[0]) < MIDLINE_M * head.size
    most = drop[middle].max(initial=0.0)
    if most <= 0.0:
        return {}
    lower = np.flatnonzero(middle & (drop > 0.6 * most))
    upper = np.flatnonzero(middle & (drop < 0.3 * most))
    if not len(lower) or not len(upper):
        return {}
    gaps = np.linalg.norm(skin.positions[upper][:, None] - skin.positions[lower][None], axis=2)
    # The foremost position at which the lips nearly touch: behind it is the inside of the mouth.
    score = gaps - 0.5 * (skin.positions[upper, 2][:, None] + skin.positions[lower, 2][None])
    first, second = np.unravel_index(np.argsort(score, axis=None, kind="stable")[:LIP_VERTICES], gaps.shape)
    contact = np.unique(np.concatenate([upper[first], lower[second]]))
    return {
        "lips.contact": _landmark(skin, contact),
        "lips.upper": _landmark(skin, np.unique(upper[first])),
        "lips.lower": _landmark(skin, np.unique(lower[second])),
    }


def _lips_by_shape(skins: list[_Skin], head: _Head) -> dict[str, Landmark]:
    """Return the landmarks of the lips by name on a face without morphs: at a share of the way from eyes to chin, in
    the notch of the profile if there is one."""
    profiles = [_profile(skin, head) for skin in skins]
    # Hair, lashes and teeth are attached to the head too: the face covers most of the lower half of its front.
    covered = _covered(skins, profiles, head)
    place = max(range(len(skins)), key=covered.__getitem__, default=-1)
    if place < 0 or len(profiles[place]) < 3:
        return {}
    skin, front = skins[place], profiles[place]
    at = skin.positions[front]
    # The chin, below which the profile recedes to the neck.
    foremost_m, middle_m = float(at[:, 2].max()), float(skin.positions[_own(skin, head.joints, 0.5), 2].mean())
    forward = at[:, 2] > foremost_m - 0.65 * (foremost_m - middle_m)
    if not forward.any():  # no vertex lies in front of the middle, so it is not a face
        return {}
    forward &= at[:, 1] >= lowest_of_face_m(at, forward, float(head.place[1]))
    front, at = front[forward], at[forward]
    chin_m = float(at[:, 1].min())
    # Without eye joints the eyes are assumed half way up the head.
    top_m = float(skin.positions[_own(skin, head.joints, 0.5), 1].max())
    eyes_m = head.eyes_m if head.eyes_m is not None else (chin_m + top_m) / 2.0
    requested_m = notch_m(at, eyes_m, chin_m)
    base_m = nose_base_m(at, eyes_m, chin_m)
    if base_m is not None and requested_m > base_m - (base_m - chin_m) / 6.0:
        requested_m = base_m - (base_m - chin_m) / 3.0
    if base_m is not None:
        # The nose itself is excluded if anything else is near, its base only if something between it and the chin is.
        under = at[:, 1] < base_m
        off_m = np.abs(at[under, 1] - requested_m).min(initial=np.inf)
        if off_m < (eyes_m - chin_m) / 4.0:
            kept = under if off_m < (base_m - chin_m) / 4.0 else at[:, 1] <= base_m
            front, at = front[kept], at[kept]
    contact = front[at_height(at, requested_m, PATCH_M * head.size, LIP_VERTICES)]
    heights = skin.positions[contact, 1]
    upper, lower = contact[heights >= np.median(heights)], contact[heights <= np.median(heights)]
    found = {"lips.contact": contact, "lips.upper": upper, "lips.lower": lower}
    return {name: _landmark(skin, np.sort(rows)) for name, rows in found.items()}


def _covered(skins: list[_Skin], profiles: list[IndexArray], head: _Head) -> list[tuple[int, float]]:
    """Return the part of a head's front below the eyes that the profile of each of S meshes covers: the number of
    height steps, each as high as a landmark's patch, in which it has vertices, and the height in metres between its
    lowest vertex and the eyes.

    Vertices far behind the foremost one, such as those of a neck, do not count.
    """
    eyes_m = head.place[1] + 0.3 * HEAD_M * head.size if head.eyes_m is None else head.eyes_m
    places = [skin.positions[front] for skin, front in zip(skins, profiles, strict=True)]
    foremost_m = max((float(at[:, 2].max()) for at in places if len(at)), default=0.0)
    least_m = head.place[2] + BEFORE * (foremost_m - head.place[2])
    found = []
    for at in places:
        high_m = np.minimum(at[at[:, 2] > least_m, 1], eyes_m)
        steps = np.unique(np.floor(high_m[high_m < eyes_m] / (PATCH_M * head.size)))
        found.append((len(steps), float(np.ptp(high_m)) if len(high_m) else 0.0))
    return found


def _profile(skin: _Skin, head: _Head) -> IndexArray:
    """Return the indices (K,) of the foremost vertices of a head near the middle of the face, which face forwards."""
    own = _own(skin, head.joints, 0.5)
    off = np.abs(skin.positions[own, 0] - head.place[0])
    if not len(own):
        return own
    ahead = skin.normals[own, 2] > 0.2
    near = own[ahead & (off < MIDLINE_M * head.size)]
    if len(near) < 3:
        near = own[ahead & (off < 3.0 * MIDLINE_M * head.size)]
    # Neither the inside of the mouth nor vertices behind the skin.
    at = skin.positions[near]
    beside = np.abs(at[:, 1][:, None] - at[:, 1][None]) < PATCH_M * head.size
    outer = np.where(beside, at[:, 2][None], -np.inf).max(axis=1, initial=-np.inf)
    found: IndexArray = near[at[:, 2] > outer - PATCH_M * head.size]
    return found


def _landmark(skin: _Skin, vertices: IndexArray) -> Landmark:
    return Landmark(skin.mesh.name, vertices.astype(np.int32))
