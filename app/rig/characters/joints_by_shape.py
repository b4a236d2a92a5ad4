"""Mapping from bones to joints by shape only (symmetry, chains, extents), for skeletons with meaningless names.

All results are guesses based on common proportions and must be reported as such.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import Final

import numpy as np

from app.arrays import FloatArray

MIRROR_TOLERANCE: Final = 0.03
"""Largest distance of a bone from its partner's mirror image, relative to the figure's height."""
OFF_CENTRE: Final = 0.02
"""Distance from the middle above which a bone belongs to a side, relative to the figure's height."""
IN_MIDDLE: Final = 0.004
"""Same limit for a bone with a partner on the other side."""
ALIKE: Final = 0.1
"""Relative difference below which distances are similar."""
HIP_BESIDE: Final = 0.03
"""Least distance of a leg's start from the middle, relative to the figure's height."""
ANKLE_HEIGHT: Final = 0.045
FOOT_HEIGHT: Final = 0.12
"""Height above the floor below which a bone may belong to a foot, relative to the figure's height."""
ARM_LENGTH: Final = 0.30
"""Usual distance from shoulder to wrist, relative to the figure's height."""
HAND_AWAY: Final = 0.15
"""Least distance of a hand from the start of the arm, relative to the figure's height."""
PALM_AWAY: Final = 0.5
"""Distance from the forearm's start beyond which chains of fingers begin, relative to the length of the upper arm;
chains from a hand begin nearer.
"""
AT_ONE_PLACE: Final = 0.02
"""Distance below which bones begin at the same place, relative to the preceding bone."""
UPWARDS: Final = 0.3
"""Least upward share of a neck's direction; a jaw points forward."""
HEAD_TOP: Final = 0.1
"""Distance above the preceding bone beyond which a last bone is the top of the head, relative to the figure's
height.
"""
NEAR_LEGS: Final = 0.4
"""Largest distance of the hips below the upper legs, relative to the height of the upper legs above the floor."""
LEG_LENGTH: Final = 0.46
"""Usual distance from hip to ankle, relative to the figure's height."""
FINGERS: Final = ("Index", "Middle", "Ring", "Little")
PARTS: Final = ("Proximal", "Intermediate", "Distal")
THUMB: Final = ("ThumbMetacarpal", "ThumbProximal", "ThumbDistal")


@dataclass(frozen=True, eq=False)
class Tree:
    """Bones at rest in the world.

    Attributes
    ----------
    parents : tuple of int
        Parent of each bone; parents come before their children.
    above : tuple of frozenset of int
        All ancestors of each bone.
    below : tuple of int
        Number of descendants of each bone.
    positions_m : (B, 3) float64
        World positions.
    skinned : frozenset of int
        Bones with skin; all bones if none has skin.
    """

    parents: tuple[int, ...]
    children: tuple[tuple[int, ...], ...]
    above: tuple[frozenset[int], ...]
    below: tuple[int, ...]
    positions_m: FloatArray
    skinned: frozenset[int]

    def path(self, top: int, bone: int) -> list[int]:
        """Return the bones on the path from ``top`` (excluded) down to ``bone``."""
        found = [bone]
        while (parent := self.parents[found[-1]]) not in (top, -1):
            found.append(parent)
        return found[::-1]

    def distance(self, one: int, other: int) -> float:
        """Return the straight distance of two bones in metres."""
        return float(np.linalg.norm(self.positions_m[one] - self.positions_m[other]))

    def depth(self, bone: int) -> int:
        """Return the number of ancestors of a bone."""
        return len(self.above[bone])


def tree_of(parents: Sequence[int], positions_m: FloatArray, skinned: frozenset[int]) -> Tree:
    """Return the tree for bones with the given parents and world positions; an empty ``skinned`` counts all bones as
    skinned.
    """
    children: list[list[int]] = [[] for _ in parents]
    above: list[frozenset[int]] = []
    for bone, parent in enumerate(parents):
        above.append(above[parent] | {parent} if parent >= 0 else frozenset())
        if parent >= 0:
            children[parent].append(bone)
    below = [0] * len(parents)
    for bone in range(len(parents) - 1, -1, -1):
        if parents[bone] >= 0:
            below[parents[bone]] += below[bone] + 1
    return Tree(
        tuple(parents),
        tuple(map(tuple, children)),
        tuple(above),
        tuple(below),
        positions_m,
        skinned or frozenset(range(len(parents))),
    )


class _Halves:
    """Division of bones into left, right and middle, with the mirror image of each."""

    def __init__(self, tree: Tree) -> None:
        self.tree = tree
        used = sorted(tree.skinned | {bone for skin in tree.skinned for bone in tree.above[skin]})
        points = tree.positions_m
        self.floor = float(points[used, 1].min())
        self.height = max(float(points[used, 1].max()) - self.floor, 1e-9)
        self.centre = float(np.median(points[used, 0]))
        self.used = used
        mirrored = points * (-1.0, 1.0, 1.0) + (2.0 * self.centre, 0.0, 0.0)
        self.partner: dict[int, int] = {}
        places, depths = points[used], np.array([tree.depth(bone) for bone in used])
        for at, bone in enumerate(used):
            far = np.linalg.norm(places - mirrored[bone], axis=1)
            # Among bones at about the same position, one at the same depth of the tree is preferred, and the bone
            # itself to others.
            steps = np.round(far / self.height, 2)
            near = np.flatnonzero(steps == steps.min())
            unlike = np.abs(depths[near] - depths[at])
            near = near[unlike == unlike.min()]
            partner = at if at in near else int(near[np.argmin(far[near])])
            if far[partner] < MIRROR_TOLERANCE * self.height:
                self.partner[bone] = used[partner]

    def side(self, bone: int) -> int:
        """Return the side of a bone: 1 for left (+X), -1 for right, 0 for the middle."""
        off = (float(self.tree.positions_m[bone, 0]) - self.centre) / self.height
        in_middle = IN_MIDDLE if self.partner.get(bone, bone) != bone else OFF_CENTRE
        return 0 if abs(off) < in_middle else (1 if off > 0.0 else -1)

    def left_ends(self, below: int) -> list[int]:
        """Return the bones of the left side at the ends of chains below ``below`` that have a mirror image."""
        return [
            bone
            for bone in self.used
            if self.side(bone) > 0
            and below in self.tree.above[bone]
            and bone in self.partner
            and not any(child in self.partner for child in self.tree.children[bone])
        ]

    def meeting(self, bone: int) -> int | None:
        """Return the deepest common ancestor of a bone and its mirror image; None without one."""
        both = self.tree.above[bone] & self.tree.above[self.partner[bone]]
        return max(both, key=self.tree.depth) if both else None

    def way(self, end: int) -> list[int]:
        """Return the bones from below the common ancestor of a chain and its mirror image down to the chain's last bone
        ``end``.
        """
        top = self.meeting(end)
        return self.tree.path(-1 if top is None else top, end)


def joints_by_shape(tree: Tree) -> dict[str, int]:
    """Return bones by VRM 1.0 joint as far as they can be recognised; empty if no body is found."""
    if not tree.parents:
        return {}
    halves = _Halves(tree)
    roots = [bone for bone in halves.used if tree.parents[bone] < 0]
    if not roots:
        return {}
    root = max(roots, key=lambda bone: tree.below[bone])
    ends = halves.left_ends(root)
    if not ends:
        return {}
    hips, joints = _legs(halves, ends)
    if hips is None:
        return {}
    beside = {joints[side + "UpperLeg"] for side in ("left", "right")}
    arms = [bone for bone in ends if not beside & (tree.above[bone] | {bone})]
    if not arms:
        return joints
    # Wings are longer than arms and attached to the same bone, but have no fingers; a skirt is attached to the hips.
    tip = max(
        arms,
        key=lambda bone: (
            hips in tree.above[halves.way(bone)[0]] and halves.meeting(bone) != hips,
            _hand_of_fingers(halves, halves.way(bone)) is not None,
            tree.positions_m[bone, 0],
            -bone,
        ),
    )
    chest = halves.meeting(tip)
    if chest is None or halves.side(chest) != 0:
        return joints
    joints |= _arms(halves, {"left": tree.path(chest, tip), "right": tree.path(chest, halves.partner[tip])})
    hips, chain = _hips(tree, joints, hips, tree.path(hips, chest) if chest != hips else [])
    return joints | {"hips": hips} | spread_spine(tree, chain) | _head(halves, chest)


def trunk_by_limbs(tree: Tree, limbs: Mapping[str, int]) -> dict[str, int]:
    """Return hips, spine and head of a figure with known upper legs and upper arms; empty if there are no bones
    between.
    """
    legs = [limbs[side + "UpperLeg"] for side in ("left", "right")]
    arms = [limbs.get(side + "Shoulder", limbs[side + "UpperArm"]) for side in ("left", "right")]
    under_legs = frozenset.intersection(*(tree.above[bone] for bone in legs))
    under_arms = frozenset.intersection(*(tree.above[bone] for bone in arms))
    shared = under_legs & under_arms
    if not shared:
        return {}
    hips = max(shared, key=tree.depth)
    chest = max(under_arms, key=tree.depth)
    if chest == hips:
        return {}
    hips, chain = _hips(tree, limbs, hips, tree.path(hips, chest))
    carrying = [bone for bone in chain if bone in tree.skinned]
    return {"hips": hips} | spread_spine(tree, carrying or chain) | _head(_Halves(tree), chest)


def _hips(tree: Tree, limbs: Mapping[str, int], carrier: int, chain: list[int]) -> tuple[int, list[int]]:
    """Return the hips, and the bones from there to the chest. Legs may be attached to the hips, or to a root or control
    bone.

    Parameters
    ----------
    carrier : int
        Common ancestor of legs and trunk.
    chain : list of int
        Bones from below it to the chest.
    """
    places = tree.positions_m
    legs = [limbs[f"{side}UpperLeg"] for side in ("left", "right")]
    height, floor = places[legs, 1].mean(), places[[limbs[f"{side}Foot"] for side in ("left", "right")], 1].mean()
    low = height - places[carrier, 1] > NEAR_LEGS * (height - floor)
    if low and len(chain) > 1 and chain[0] in tree.skinned:
        return chain[0], chain[1:]
    return carrier, chain


def _legs(halves: _Halves, ends: list[int]) -> tuple[int | None, dict[str, int]]:
    """Return hips and legs: the lowest chain that ends in a foot pointing forward, or the lowest chain.

    A foot attached to the root, as in a rig with inverse kinematics, belongs to a leg without a foot that ends at it.
    """
    tree = halves.tree
    loose = [way for end in ends if len(way := halves.way(end)) <= 2 and _low(halves, way[0])]
    found: list[tuple[bool, float, int, int, dict[str, int]]] = []
    for end in ends:
        hips = halves.meeting(end)
        if hips is None or halves.side(hips) != 0:
            continue
        way = halves.way(end)
        foot = _loose_foot(halves, way, loose)
        mirrored = [halves.partner.get(bone, -1) for bone in foot]
        if -1 in mirrored:
            foot = mirrored = []
        if foot:
            way = [bone for bone in way if not _alike(halves, bone, foot[0])]
        other = [] if not way else tree.path(hips, halves.partner[way[-1]])
        left, right = _leg(halves, "left", way + foot), _leg(halves, "right", other + mirrored)
        if left and right:
            ahead = _points_ahead(halves, way + foot) is not None
            found.append(
                (not ahead, round(float(tree.positions_m[end, 1]) / halves.height, 2), end, hips, left | right)
            )
    if not found:
        return None, {}
    _, _, _, hips, joints = min(found, key=lambda one: one[:3])
    return hips, {"hips": hips} | joints


def _low(halves: _Halves, bone: int) -> bool:
    return bool(halves.tree.positions_m[bone, 1] - halves.floor < FOOT_HEIGHT * halves.height)


def _alike(halves: _Halves, one: int, other: int) -> bool:
    """Return whether two bones have the same position, within a tolerance."""
    return halves.tree.distance(one, other) < MIRROR_TOLERANCE * halves.height


def _loose_foot(halves: _Halves, way: list[int], loose: list[list[int]]) -> list[int]:
    """Return the bones of a foot that is not attached to its leg, from the chains in ``loose``; empty if the leg
    ``way`` has a foot of its own.
    """
    if len(way) < 2 or (len(way) > 2 and way[-1] in halves.tree.skinned and _low(halves, way[-1])):
        return []
    if _low(halves, way[0]):
        return []
    last = halves.tree.positions_m[way[-1]]
    near = [foot for foot in loose if foot[0] not in way and foot[0] in halves.tree.skinned]
    found = min(near, key=lambda foot: float(np.linalg.norm(halves.tree.positions_m[foot[0]] - last)), default=[])
    off = halves.tree.positions_m[found[0]] - last if found else np.zeros(3)
    return found if float(np.hypot(off[0], off[2])) < FOOT_HEIGHT * halves.height else []


def _leg(halves: _Halves, side: str, path: list[int]) -> dict[str, int]:
    tree, height = halves.tree, halves.height
    if not path:
        return {}
    ankle = _ankle(halves, path)
    upper = path[: path.index(ankle)]
    beside = [bone for bone in upper if abs(tree.positions_m[bone, 0] - halves.centre) > HIP_BESIDE * height]
    upper = beside if len(beside) >= 2 else upper
    if len(upper) < 2:
        return {}
    thigh, knee = (upper[at] for at in _two(tree, [(upper, ankle)], LEG_LENGTH * height))
    found = {f"{side}UpperLeg": thigh, f"{side}LowerLeg": knee, f"{side}Foot": ankle}
    ahead = max(tree.children[ankle], key=lambda bone: (tree.positions_m[bone, 2], -bone), default=None)
    if ahead is not None and tree.positions_m[ahead, 2] > tree.positions_m[ankle, 2]:
        found[f"{side}Toes"] = ahead
    return found


def _ankle(halves: _Halves, path: list[int]) -> int:
    """Return the ankle of a leg: the bone at which the chain turns forward near the floor; if the foot does not point
    forward, the bone at the height of an ankle.
    """
    places, floor = halves.tree.positions_m, halves.floor
    ankle = _points_ahead(halves, path)
    if ankle is not None:
        return ankle
    return min(path, key=lambda bone: abs(float(places[bone, 1]) - floor - ANKLE_HEIGHT * halves.height))


def _points_ahead(halves: _Halves, path: list[int]) -> int | None:
    """Return the bone near the floor from which the next bone of a chain lies forward; None if there is none."""
    for bone, next_ in pairwise(path):
        ahead = halves.tree.positions_m[next_] - halves.tree.positions_m[bone]
        if _low(halves, bone) and ahead[2] > 0.5 * np.linalg.norm(ahead):
            return bone
    return None


def _arms(halves: _Halves, paths: Mapping[str, list[int]]) -> dict[str, int]:
    """Return the joints of both arms from the bones below the chest to the finger tip on each side. Arms with equally
    many bones begin and bend at corresponding ones.
    """
    found = {side: _hand(halves, side, path) for side, path in paths.items()}
    limbs = {side: (upper, hand) for side, (upper, hand, _) in found.items() if len(upper) >= 2}
    alike = len({len(upper) for upper, _ in limbs.values()}) == 1
    joints: dict[str, int] = {}
    for side, (upper, hand) in limbs.items():
        both = list(limbs.values()) if alike else [(upper, hand)]
        start, elbow = _two(halves.tree, both, ARM_LENGTH * halves.height)
        joints |= {f"{side}UpperArm": upper[start], f"{side}LowerArm": upper[elbow], f"{side}Hand": hand}
        if start:
            joints[f"{side}Shoulder"] = upper[0]
        joints |= found[side][2] or fingers(halves.tree, side, hand)
    return joints


def _hand(halves: _Halves, side: str, path: list[int]) -> tuple[list[int], int, dict[str, int]]:
    """Return the parts of an arm: the bones before its hand, the hand, and the joints of the fingers if the palm has
    several bones.

    ``path`` are the bones from below the chest to the finger tip.
    """
    tree, height = halves.tree, halves.height
    hand = _hand_of_fingers(halves, path)
    if hand is None:
        # Without fingers: the bone before the end that gives the best arm.
        ends = path[2:]
        if not ends:
            return [], path[-1], {}
        hand = min(ends, key=lambda bone: _off(tree, path[: path.index(bone)], bone, ARM_LENGTH * height))
    upper = path[: path.index(hand)]
    palm = hand_of_palms(tree, side, upper[-1], hand) if upper else {}
    if palm:
        upper, hand = [*upper, hand], palm[f"{side}Hand"]
    return upper, hand, palm


def _hand_of_fingers(halves: _Halves, path: list[int]) -> int | None:
    """Return the bone of an arm with three or more chains attached, if there is one."""
    tree = halves.tree
    for bone in path:
        if len(_chains(tree, bone)) >= 3 and tree.distance(path[0], bone) > HAND_AWAY * halves.height:
            return bone
    return None


def _chains(tree: Tree, bone: int) -> list[int]:
    """Return the first bones of the chains of at least two bones attached to a bone."""
    used = tree.skinned.union(*(tree.above[skin] for skin in tree.skinned))
    return [child for child in tree.children[bone] if not used.isdisjoint(tree.children[child])]


def hand_of_palms(tree: Tree, side: str, upper: int, forearm: int) -> dict[str, int]:
    """Return the hand and fingers of a forearm whose fingers are attached at the wrist, each by a bone of its own;
    empty if a single bone is the hand.

    The bone of the middle finger is used as the hand.
    """
    far = PALM_AWAY * tree.distance(upper, forearm)
    away = [bone for bone in _chains(tree, forearm) if tree.distance(forearm, bone) > far]
    near = [
        [other for other in away if tree.distance(bone, other) < AT_ONE_PLACE * tree.distance(forearm, bone)]
        for bone in away
    ]
    palms = max(near, key=len, default=[])
    if len(palms) < 2:
        return {}
    digits = fingers(tree, side, forearm, palms)
    middle = digits.get(f"{side}MiddleProximal", digits.get(f"{side}IndexProximal"))
    hand = next((palm for palm in palms if middle is not None and palm in tree.above[middle]), palms[0])
    return {f"{side}Hand": hand} | digits


def _two(tree: Tree, limbs: Sequence[tuple[list[int], int]], length_m: float) -> tuple[int, int]:
    """Return the indices of the first and the middle bone of a limb, with the halves as equal and the length as near to
    ``length_m`` as possible, summed over ``limbs`` with equally many bones.
    """

    def off_m(upper: list[int], end: int, pair: tuple[int, int]) -> float:
        start, middle = (upper[at] for at in pair)
        uneven_m = abs(tree.distance(start, middle) - tree.distance(middle, end))
        return uneven_m + 0.5 * abs(tree.distance(start, end) - length_m)

    return min(combinations(range(len(limbs[0][0])), 2), key=lambda pair: sum(off_m(*limb, pair) for limb in limbs))


def _off(tree: Tree, upper: list[int], end: int, length_m: float) -> float:
    """Return the deviation of the best choice of a limb's first and middle bone from equal halves and a length of
    ``length_m`` (0 is perfect).

    Ratios are compared, since the arms of a toy child may be half as long.
    """
    ratios = []
    for start, middle in combinations(upper, 2):
        halves = np.maximum((tree.distance(start, middle), tree.distance(middle, end)), 1e-9)
        ratios.append(abs(np.log(halves[0] / halves[1])) + 0.5 * abs(np.log(halves.sum() / length_m)))
    return float(min(ratios))


def fingers(tree: Tree, side: str, hand: int, palms: Sequence[int] = ()) -> dict[str, int]:
    """Return the fingers of a hand: the chain farthest to the side is the thumb, the others follow by distance from it.

    Parameters
    ----------
    hand : int
        Bone that the chains are attached to.
    palms : sequence of int
        Bones at the wrist that belong to fingers other than the thumb.
    """
    tips = [bone for bone, above in enumerate(tree.above) if hand in above and not tree.children[bone]]
    paths = [tree.path(hand, tip) for tip in tips]
    shared = Counter(bone for path in paths for bone in path)
    chains = []
    for path in paths:
        chain = [bone for bone in path if bone in tree.skinned and shared[bone] == 1]
        if len(chain) > 3:
            # Of more than three bones the first is a metacarpal if it is the longest; otherwise the last is only a
            # fingertip.
            lengths = [tree.distance(one, other) for one, other in pairwise(chain)]
            chain = chain[-3:] if lengths[0] >= max(lengths[1:]) else chain[:3]
        if len(chain) >= 2:
            chains.append(chain)
    if len(chains) < 2:
        return {}
    wrist = palms[0] if palms else hand
    ways = np.array([tree.positions_m[chain[-1]] - tree.positions_m[wrist] for chain in chains])
    ways /= np.maximum(np.linalg.norm(ways, axis=1, keepdims=True), 1e-9)
    thumb = int(np.argmin((ways @ ways.T).sum(axis=1)))
    others = [chain for index, chain in enumerate(chains) if index != thumb]
    others = [[bone for bone in chain if bone not in palms] for chain in others]
    others.sort(key=lambda chain: tree.distance(chain[0], chains[thumb][-1]))
    found = dict(zip((side + part for part in THUMB), chains[thumb], strict=False))
    for finger, chain in zip(FINGERS, others, strict=False):
        found |= dict(zip((side + finger + part for part in PARTS), chain, strict=False))
    return found


def spread_spine(tree: Tree, chain: Sequence[int]) -> dict[str, int]:
    """Return spine, chest and upper chest of the bones from hips to neck: the lowest, the middle and the highest."""
    if len(chain) <= 2:
        return dict(zip(("spine", "chest"), chain, strict=False))
    first, last = chain[0], chain[-1]
    off = {bone: abs(tree.distance(first, bone) - tree.distance(bone, last)) for bone in chain[1:-1]}
    # Of two bones equally near to the middle the lower one.
    near = min(off.values()) + ALIKE * tree.distance(first, last)
    middle = next(bone for bone in off if off[bone] <= near)
    return {"spine": first, "chest": middle, "upperChest": last}


def _head(halves: _Halves, chest: int) -> dict[str, int]:
    tree, used = halves.tree, frozenset(halves.used)
    chain: list[int] = []
    bone = chest
    while True:
        central = [child for child in tree.children[bone] if halves.side(child) == 0 and child in used]
        up = {child: tree.positions_m[child] - tree.positions_m[bone] for child in central}
        higher = [child for child in central if up[child][1] > UPWARDS * float(np.linalg.norm(up[child]))]
        if not higher or len(chain) == 4:
            break
        # The branch with most descendants leads to the head.
        bone = max(higher, key=lambda child: (tree.below[child], -child))
        chain.append(bone)
    while len(chain) > 1 and chain[-1] not in tree.skinned:
        chain.pop()
    top = len(chain) > 1 and not used & set(tree.children[chain[-1]])
    if top and tree.distance(chain[-2], chain[-1]) > HEAD_TOP * halves.height:
        chain.pop()
    if not chain:
        return {}
    return {"head": chain[-1]} | ({"neck": chain[0]} if len(chain) > 1 else {})
