"""Mapping from a figure's bones to joints: by the file's own data, by names, and by shape.

Names come from tables in ``metadata/bone_names``; the table with most joints in a consistent hierarchy is used. The
left side is at +X, regardless of names.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Mapping, Sequence, Set
from dataclasses import dataclass
from functools import cache
from typing import Final
from weakref import WeakKeyDictionary

import numpy as np

from app.errors import FileError
from app.rig.characters.bone_placements import world_placements
from app.rig.characters.joints_by_shape import (
    Tree,
    hand_of_palms,
    joints_by_shape,
    spread_spine,
    tree_of,
    trunk_by_limbs,
)
from app.rig.figure import MOST_LISTED, Figure
from metadata.known_names import bone_key
from metadata.load import load_bone_names, load_skeleton
from metadata.model import REQUIRED_JOINTS

ENDS: Final = re.compile(r"(Toes|Eye|Metacarpal|Proximal|Intermediate|Distal)$")
"""Joints that names may add to the file's own data."""
LEGS: Final = re.compile(r"(UpperLeg|LowerLeg|Foot|Toes)$")
ARMS: Final = re.compile(r"(Shoulder|UpperArm|LowerArm|Hand|Metacarpal|Proximal|Intermediate|Distal)$")
TRUNK: Final = re.compile(r"^(hips|spine|chest|upperChest|neck|head)$")
LIMBS: Final = re.compile(rf"{LEGS.pattern}|{ARMS.pattern}")
UNLIKE: Final = 0.2
"""Relative difference of the bones' length below which a pair of unnamed bones is symmetrical."""
SIDES: Final = ("left", "right")
ANY: Final = re.compile("")
FINGER: Final = re.compile("Metacarpal|Proximal|Intermediate|Distal")
OPTIONAL: Final = (FINGER, *map(re.compile, ("Toes", "Shoulder", "^neck", "^chest")))
"""Parts of the body that may be missing in names."""
FIRST_BELOW: Final = {"Shoulder": "UpperArm", "neck": "head"}
"""Joint below an optional part that names and shape must agree on."""
CLEARLY: Final = 0.5
"""Share of the distance from right to left that must point to -X for the sides to be exchanged; less means that a
figure faces sideways.
"""
NUMBERED: Final = re.compile(r"[_.]\d+$")
MOST_NUMBERED: Final = 0.8
"""Share of names ending in a number above which the numbers are ignored."""
ENOUGH: Final = 8
"""Least number of required joints that a suitable table of names contains."""
THUMB_BASE: Final = 0.5
"""Share of the distance from the wrist to the index finger within which the thumb's first bone is the metacarpal."""
SHORTEST_AFFIXED: Final = 3
"""Names shorter than this number of characters must match exactly, since many others end in them."""


@dataclass(frozen=True)
class JointMapping:
    """Mapping from bones to joints.

    Attributes
    ----------
    profile : str
        Id of the table of names; ``vrm0`` or ``vrm1`` if the file contains the mapping; empty if mapped by shape.
    bones : mapping of str to int
        Bone of the figure by VRM 1.0 joint.
    missing : tuple of str
        Joints without a bone.
    doubtful : tuple of str
        Joints that were guessed, or whose bone has another place in the hierarchy or side than its name indicates.
    """

    profile: str
    bones: Mapping[str, int]
    missing: tuple[str, ...]
    doubtful: tuple[str, ...]


@dataclass(frozen=True)
class _Found:
    """Mapping of bones to joints that one method found: by names, by the file's own data or by shape."""

    profile: str
    bones: dict[str, int]
    astray: frozenset[str]
    """Joints whose bone is not below the bone of the parent joint."""
    skinned: int
    """Number of mapped bones with skin, since controls of a rig may have the same names."""

    @property
    def required(self) -> int:
        return sum(joint in self.bones for joint in REQUIRED_JOINTS)

    @property
    def score(self) -> float:
        return len(self.bones) + self.required - 2.0 * len(self.astray) + 3.0 * self.skinned


def map_joints(figure: Figure, requested: Mapping[str, str] | None = None) -> JointMapping:
    """Return the joints of a figure.

    Parameters
    ----------
    requested : mapping of str to str
        The user's corrections, bone by joint; empty if the figure lacks the joint.

    Raises
    ------
    FileError
        A correction refers to an unknown joint or bone.
    """
    tree, found, guessed = _without_help(figure)
    bones = dict(found.bones)
    doubtful = set(found.astray) | guessed
    doubtful |= _turn_sides(tree, bones)
    _place_thumbs(tree, bones)
    return corrected(figure, _mapping(found.profile, bones, doubtful), requested or {})


def corrected(
    figure: Figure, mapping: JointMapping, requested: Mapping[str, str], joints: Sequence[str] = ()
) -> JointMapping:
    """Return a mapping with the user's corrections, see `map_joints`.

    Parameters
    ----------
    joints : sequence of str
        Joints that can be corrected; empty for all.
    """
    bones, doubtful = dict(mapping.bones), set(mapping.doubtful)
    for joint, bone in _corrections(figure, requested, joints or _joints()).items():
        if bone is not None:
            for other in [one for one, held in bones.items() if held == bone]:
                del bones[other]
        bones.pop(joint, None)
        if bone is not None:
            bones[joint] = bone
        doubtful.discard(joint)
    return _mapping(mapping.profile, bones, doubtful)


def _mapping(profile: str, bones: Mapping[str, int], doubtful: Collection[str]) -> JointMapping:
    joints = _joints()
    return JointMapping(
        profile=profile,
        bones={joint: bones[joint] for joint in joints if joint in bones},
        missing=tuple(joint for joint in joints if joint not in bones),
        doubtful=tuple(joint for joint in joints if joint in doubtful and joint in bones),
    )


_kept: WeakKeyDictionary[Figure, tuple[Tree, _Found, set[str]]] = WeakKeyDictionary()


def _without_help(figure: Figure) -> tuple[Tree, _Found, set[str]]:
    """Return the automatic mapping of bones to joints, without the user's corrections; cached for each figure, since it
    takes seconds with thousands of bones.
    """
    known = _kept.get(figure)
    if known is None:
        tree = _tree(figure)
        known = _kept[figure] = (tree, *_automatic(figure, tree))
    return known


def _automatic(figure: Figure, tree: Tree) -> tuple[_Found, set[str]]:
    """Return the best mapping of bones to joints found without the user, by names, by the file's own data or by shape,
    and the joints that were guessed.
    """
    named = _by_names(figure, tree)
    if figure.humanoid:
        found = _as_the_file_says(figure, tree, named)
    elif named.required >= ENOUGH:
        found = named
    else:
        shape = joints_by_shape(tree)
        return _Found("", shape, frozenset(), 0), set(shape)
    if figure.humanoid and found.required == len(REQUIRED_JOINTS):
        return found, set()
    bones = dict(found.bones)
    if found.required < len(REQUIRED_JOINTS) or _trunk_beside(tree, bones):
        bones = _completed(tree, found, frozenset(figure.humanoid))
    if not figure.humanoid:
        _add_unnamed(tree, bones)
    kept = {joint for joint, bone in found.bones.items() if bones.get(joint) == bone}
    profile = found.profile if figure.humanoid or len(kept) >= len(bones) / 2 else ""
    return _Found(profile, bones, _astray(tree, bones), 0), set(bones) - kept


def _add_unnamed(tree: Tree, bones: dict[str, int]) -> None:
    """Add fingers, toes, shoulders, neck and chest found by shape to ``bones``, if names did not give them and names
    and shape agree on the joints above.
    """
    lacking = [part for part in OPTIONAL if not any(part.search(joint) for joint in bones)]
    if not lacking:
        return
    shape = joints_by_shape(tree)
    digits = [sum(joint.startswith(side) and FINGER.search(joint) is not None for joint in shape) for side in SIDES]
    if len(set(digits)) > 1 or any(side + "MiddleProximal" not in shape for side in SIDES):
        # Finger chains that differ from those of the other hand, or only two of them, may be hair or a sleeve.
        shape = {joint: bone for joint, bone in shape.items() if not FINGER.search(joint)}
    if any(len(tree.children[bones[side + "Foot"]]) != 1 for side in SIDES if side + "Foot" in bones):
        shape = {joint: bone for joint, bone in shape.items() if not joint.endswith("Toes")}
    shape = {joint: bone for joint, bone in shape.items() if _mirrored(tree, shape, joint)}
    for joint in [joint for joint in _joints() if joint in shape and any(part.search(joint) for part in lacking)]:
        below = FIRST_BELOW.get(re.sub("^(left|right)", "", joint), "")
        side = joint.removesuffix("Shoulder") if below == "UpperArm" else ""
        agreed = [one for one in (_joint_above(joint, bones), side + below) if one]
        if shape[joint] not in bones.values() and all(shape.get(one) == bones.get(one) for one in agreed):
            bones[joint] = shape[joint]


def _mirrored(tree: Tree, shape: Mapping[str, int], joint: str) -> bool:
    """Return whether a joint lies relative to its parent as the mirror image of the other side's joint."""
    if not joint.startswith(SIDES):
        return True
    left = re.sub("^right", "left", joint)
    pair = [(shape.get(one), tree.parents[shape[one]] if one in shape else -1) for one in (left, "right" + left[4:])]
    offsets = [tree.positions_m[bone] - tree.positions_m[top] for bone, top in pair if bone is not None and top >= 0]
    if len(offsets) < len(SIDES):
        return False
    off = offsets[0] - offsets[1] * (-1.0, 1.0, 1.0)
    return float(np.linalg.norm(off)) < UNLIKE * float(np.linalg.norm(offsets[0]))


def _as_the_file_says(figure: Figure, tree: Tree, named: _Found) -> _Found:
    """Return the joints stored in a VRM file, with joints at the ends of chains (such as fingers) added by names."""
    bones = {joint: bone for joint, bone in figure.humanoid.items() if joint in _joints()}
    for joint, bone in named.bones.items():
        if joint not in bones and ENDS.search(joint) and bone not in bones.values():
            top = _joint_above(joint, bones)
            if top is not None and bones[top] in tree.above[bone] and joint not in named.astray:
                bones[joint] = bone
    return _Found(figure.origin if figure.origin.startswith("vrm") else "vrm", bones, _astray(tree, bones), 0)


def _completed(tree: Tree, found: _Found, fixed: Set[str]) -> dict[str, int]:
    """Return the mapping with joints that were not found by names added by shape.

    A part of the body in which a required joint has no name is mapped by shape entirely, if possible: names that skip a
    joint usually stand for other joints (a shoulder is an upper arm, a chest a spine). The trunk is determined by the
    limbs, however these were found.

    Parameters
    ----------
    fixed : set of str
        Joints from the file's own data, which do not change.
    """
    shape = joints_by_shape(tree)
    bones = dict(found.bones)
    for side in SIDES:
        upper, forearm = bones.get(side + "UpperArm"), bones.get(side + "LowerArm")
        if side + "Hand" not in bones and upper is not None and forearm is not None:
            bones |= hand_of_palms(tree, side, upper, forearm)
    for part in (LEGS, ARMS):
        _replace_part(bones, shape, part, fixed)
    if not _lacks(bones, LIMBS):
        trunk = _trunk_beside(tree, bones) if not fixed else {}
        for joint in [joint for joint in bones if trunk and TRUNK.search(joint)]:
            del bones[joint]
        _replace_part(bones, shape | (trunk or trunk_by_limbs(tree, bones)), TRUNK, fixed)
    for joint in REQUIRED_JOINTS:
        if joint not in bones and joint in shape and shape[joint] not in bones.values():
            bones[joint] = shape[joint]
            if joint in _astray(tree, bones):
                del bones[joint]
    if _lacks(bones, ANY) and not _lacks(shape, ANY) and not fixed:
        return shape
    return bones


def _trunk_beside(tree: Tree, bones: Mapping[str, int]) -> dict[str, int]:
    """Return the trunk determined by the limbs, if names give only its upper part, or hips from which the legs do not
    descend; else empty, also if the bones have no hierarchy.
    """
    if _lacks(bones, LIMBS):
        return {}
    trunk = trunk_by_limbs(tree, bones)
    own = [bones[joint] for joint in ("spine", "chest", "upperChest") if joint in bones]
    if "head" not in trunk or bones.get("head", trunk["head"]) != trunk["head"] or not own:
        return {}
    carried = bones.get("hips") in tree.above[bones["leftUpperLeg"]]
    if carried and trunk["spine"] in own:
        return {}
    between = tree.path(trunk["hips"], max(own, key=tree.depth))
    return trunk if set(own) <= set(between) else {}


def _lacks(bones: Mapping[str, int], part: re.Pattern[str]) -> bool:
    return any(joint not in bones for joint in REQUIRED_JOINTS if part.search(joint))


def _replace_part(bones: dict[str, int], shape: Mapping[str, int], part: re.Pattern[str], fixed: Set[str]) -> None:
    """Replace the joints of a part of the body, given by a pattern of their names, by those found by shape, if a
    required one is missing in ``bones`` but not in ``shape``.
    """
    if not _lacks(bones, part) or _lacks({**shape, **{joint: bones[joint] for joint in fixed if joint in bones}}, part):
        return
    for joint in [joint for joint in bones if part.search(joint) and joint not in fixed]:
        del bones[joint]
    for joint, bone in shape.items():
        if part.search(joint) and joint not in bones and not any(bones.get(one) == bone for one in fixed):
            for other in [one for one, held in bones.items() if held == bone]:
                del bones[other]
            bones[joint] = bone


@cache
def _joints() -> tuple[str, ...]:
    return tuple(joint.name for joint in load_skeleton().joints if joint.name != "root")


def _joint_above(joint: str, bones: Mapping[str, int]) -> str | None:
    """Return the nearest ancestor of a joint that has a bone; None if there is none."""
    profile = load_skeleton()
    parent = profile.joint(joint).parent
    while parent and parent not in bones:
        parent = profile.joint(parent).parent
    return parent or None


def _tree(figure: Figure) -> Tree:
    positions, _ = world_placements(figure.parents, figure.translations_m, figure.rotations)
    skinned = {int(bone) for mesh in figure.meshes for bone in np.unique(mesh.joints[mesh.weights > 0.0])}
    return tree_of(figure.parents, positions, frozenset(skinned))


def _by_names(figure: Figure, tree: Tree) -> _Found:
    """Return the mapping by the table of bone names that fits the figure best."""
    spellings = [[bone_key(name) for name in figure.bone_names]]
    if sum(NUMBERED.search(name) is not None for name in figure.bone_names) >= MOST_NUMBERED * len(figure.bone_names):
        spellings.append([bone_key(NUMBERED.sub("", name)) for name in figure.bone_names])
    best = _Found("", {}, frozenset(), 0)
    for profile, table in load_bone_names().items():
        names = table.keys()
        for keys in spellings:
            for prefix, suffix in _affixes(keys, {key for own in names.values() for key in own}):
                bones_of: dict[str, list[int]] = {}
                for bone, key in enumerate(keys):
                    if key.startswith(prefix) and key.endswith(suffix) and len(key) >= len(prefix) + len(suffix):
                        bones_of.setdefault(key[len(prefix) : len(key) - len(suffix)], []).append(bone)
                # Of several bones with one name the one with most descendants belongs to the body.
                place = {
                    key: min(bones, key=lambda bone: (-tree.below[bone], figure.bone_names[bone]))
                    for key, bones in bones_of.items()
                }
                found = _found(profile, tree, {joint: _first(place, own) for joint, own in names.items()})
                if found.score > best.score:
                    best = found
    return best


def _affixes(keys: list[str], known: set[str]) -> list[tuple[str, str]]:
    """Return pairs of prefix and suffix that surround known names in most of a figure's names; the empty pair comes
    first.
    """
    votes: Counter[tuple[str, str]] = Counter()
    names = [name for name in known if len(name) >= SHORTEST_AFFIXED]
    # In a figure with thousands of bones most names contain no known word.
    any_name = re.compile("|".join(map(re.escape, names)))
    for key in set(keys):
        if not any_name.search(key):
            continue
        for name in names:
            at = key.find(name)
            if at >= 0 and len(name) < len(key):
                votes[key[:at], key[at + len(name) :]] += 1
    common = sorted(votes, key=lambda affix: (-votes[affix], affix))
    return [("", ""), *(affix for affix in common[:3] if votes[affix] >= ENOUGH)]


def _first(place: Mapping[str, int], keys: tuple[str, ...]) -> int | None:
    return next((place[key] for key in keys if key in place), None)


def _found(profile: str, tree: Tree, named: Mapping[str, int | None]) -> _Found:
    bones = {joint: bone for joint, bone in named.items() if bone is not None and not joint.startswith("spine.")}
    column = [bone for joint, bone in named.items() if bone is not None and joint.startswith("spine.")]
    column = [bone for bone in column if bone not in bones.values()]
    bones |= spread_spine(tree, sorted(set(column), key=lambda bone: (tree.depth(bone), column.index(bone))))
    # If the order of two joints is reversed, the table is wrong and not the figure.
    for joint in _joints():
        top = _joint_above(joint, bones) if joint in bones else None
        if top is not None and (bones[joint] == bones[top] or bones[joint] in tree.above[bones[top]]):
            del bones[joint]
    return _Found(profile, bones, _astray(tree, bones), sum(bone in tree.skinned for bone in bones.values()))


def _astray(tree: Tree, bones: Mapping[str, int]) -> frozenset[str]:
    """Return the joints whose bone is not a descendant of the bone of the joint above."""
    return frozenset(
        joint
        for joint, bone in bones.items()
        if (top := _joint_above(joint, bones)) is not None and bones[top] not in tree.above[bone]
    )


def _turn_sides(tree: Tree, bones: dict[str, int]) -> set[str]:
    """Exchange left and right in ``bones`` where joints named left are at -X, and return the exchanged joints."""
    turned: set[str] = set()
    for at, own in (
        ("UpperLeg", LEGS),
        ("UpperArm", ARMS),
        ("Eye", re.compile(r"Eye$")),
    ):
        left, right = bones.get(f"left{at}"), bones.get(f"right{at}")
        if left is None or right is None:
            continue
        across = tree.positions_m[left] - tree.positions_m[right]
        if across[0] > -CLEARLY * float(np.linalg.norm(across)) or across[0] == 0.0:
            continue
        swapped = {joint: bone for joint, bone in bones.items() if own.search(joint)}
        for joint in swapped:
            del bones[joint]
        for joint, bone in swapped.items():
            other = joint.replace("left", "right", 1) if joint.startswith("left") else joint.replace("right", "left", 1)
            bones[other] = bone
            turned.add(other)
    return turned


def _place_thumbs(tree: Tree, bones: dict[str, int]) -> None:
    """Remove the metacarpal of a thumb with one or two bones that begins away from the wrist."""
    for side in ("left", "right"):
        base, next_, last = (f"{side}Thumb{part}" for part in ("Metacarpal", "Proximal", "Distal"))
        hand, index = bones.get(f"{side}Hand"), bones.get(f"{side}IndexProximal")
        if base not in bones or last in bones or hand is None or index is None:
            continue
        if tree.distance(hand, bones[base]) > THUMB_BASE * tree.distance(hand, index):
            if next_ in bones:
                bones[last] = bones.pop(next_)
            bones[next_] = bones.pop(base)


def _corrections(figure: Figure, requested: Mapping[str, str], joints: Sequence[str]) -> dict[str, int | None]:
    """Return the bone that the user assigned to each joint, by joint name; None where the joint shall have none. Raises
    FileError for unknown names."""
    found: dict[str, int | None] = {}
    for joint, name in requested.items():
        if joint not in joints:
            raise FileError("figure.no_joint", file=figure.file, joint=joint, joints=", ".join(joints))
        if name and name not in figure.bone_names:
            listed = [*figure.bone_names[:MOST_LISTED], *(["…"] if len(figure.bone_names) > MOST_LISTED else [])]
            raise FileError("figure.no_bone", file=figure.file, joint=joint, bone=name, bones=", ".join(listed))
        found[joint] = figure.bone_names.index(name) if name else None
    return found
