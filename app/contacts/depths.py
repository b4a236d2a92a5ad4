"""How deep hands and fingers go into the closed bodies that stand for an instrument.

The deepest vertex of every frame is found by branch and bound. A block of frames is judged by its middle frame: how far
a vertex moves from there is bounded by how far its joints move, and a distance changes by no more than a point moves.
Vertices that cannot be the deepest in any frame of a block are dropped; for the others shorter blocks are judged, down
to single frames. While a hand moves too far within a block, its vertices are judged in groups.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from app.contacts.distance_field import DistanceField, SingleArray
from app.rig.skinning import Skin
from instrument_maps.model import Proxy

FloatArray = npt.NDArray[np.float64]
AnyFloatArray = npt.NDArray[np.floating]
IntArray = npt.NDArray[np.intp]

BLOCKS = (128, 16, 4, 1)
"""Frames of the blocks, each a multiple of the next."""
GROUP = 8
"""Vertices per group, about."""
STRETCH = 1.3
"""How much further from its middle than in the bind pose a vertex of a group may come when the hand bends."""
STILL_M = 0.003
"""A group that moves less within a block is judged vertex by vertex."""


class HandDepths:
    """The skin of a hand and the bodies it must not enter.

    Parameters
    ----------
    hand : Skin
        Of hand and fingers.
    bodies : sequence of Proxy
    """

    def __init__(self, hand: Skin, bodies: Sequence[Proxy]) -> None:
        self._hand = _carried(hand)
        self._groups = _groups(hand)
        self._fields = _fields(tuple(bodies))

    def depths_m(
        self,
        world_from_joint: FloatArray,
        morphs: Mapping[str, AnyFloatArray],
        world_from_node: Mapping[str, FloatArray],
    ) -> FloatArray:
        """Greatest depth of any vertex in any body, at each of some frames.

        Parameters
        ----------
        world_from_joint : (F, J, 4, 4) float64
            Of the joints that the skin's numbers mean.
        morphs : dict of str to (F,)
            Weights by morph name.
        world_from_node : dict of str to (F, 4, 4) float64
            Of the instrument's nodes.

        Returns
        -------
        (F,) float64
            Metres, 0 where everything is outside.
        """
        frames = len(world_from_joint)
        # Whole blocks: the last frame is repeated.
        padded = np.minimum(np.arange(-(-frames // BLOCKS[0]) * BLOCKS[0]), frames - 1)
        depths_m = np.zeros(len(padded), dtype=np.float32)
        weights = {name: np.asarray(morphs[name], np.float32)[padded] for name in self._hand.morphs if name in morphs}
        joints = world_from_joint[:, self._hand.joints, :3].transpose(0, 2, 1, 3).astype(np.float32, order="C")
        searches = []
        for node, field in self._fields.items():
            node_from_world = np.linalg.inv(world_from_node[node])[:, :3].astype(np.float32)
            poses = _Poses(self._hand, _local(node_from_world, joints)[padded], weights)
            searches.append(_Search(field, poses, self._groups))
        for size in BLOCKS:
            blocks_m = depths_m.reshape(-1, size)
            for search in searches:
                search.judge_roughly(size, blocks_m)
            for search in searches:
                search.judge_exactly(blocks_m)
            searches = [search for search in searches if search.open]
        return depths_m[:frames].astype(np.float64)


@dataclass(frozen=True, eq=False)
class _Carried:
    """Vertices and the joints that carry them.

    Attributes
    ----------
    joints : (J,) int
        Those that carry any.
    carriers : (V, K) int
        Rows of ``joints``, the strongest first.
    weights : (V, K) float32
    places_m : (V, K, 3) float32
        In the frame of each carrier.
    arms_m : (V, K) float32
        From each carrier to the vertex.
    morphs : dict of str to (V, K, 3) float32
        Displacements, in the frame of each carrier.
    """

    joints: IntArray
    carriers: IntArray
    weights: SingleArray
    places_m: SingleArray
    arms_m: SingleArray
    morphs: Mapping[str, SingleArray]


def _carried(skin: Skin) -> _Carried:
    count = int(np.count_nonzero(skin.weights, axis=1).max())
    carriers = np.argsort(-skin.weights, axis=1, kind="stable")[:, :count]
    from_mesh = skin.joint_from_mesh[carriers]
    places_m = np.einsum("vkij,vj->vki", from_mesh[..., :3], skin.positions_m) + from_mesh[..., 3]
    return _Carried(
        joints=skin.joints,
        carriers=carriers,
        weights=np.take_along_axis(skin.weights, carriers, axis=1).astype(np.float32),
        places_m=places_m.astype(np.float32),
        arms_m=np.linalg.norm(places_m, axis=2).astype(np.float32),
        morphs={
            name: np.einsum("vkij,vj->vki", from_mesh[..., :3], deltas_m).astype(np.float32)
            for name, deltas_m in skin.morphs.items()
        },
    )


class _Poses:
    """Where vertices are in the frame of a node, and how far they move.

    Parameters
    ----------
    hand : _Carried
    node_from_joint : (F, J, 3, 4) float32
    morphs : dict of str to (F,) float32
        Weights.
    """

    def __init__(self, hand: _Carried, node_from_joint: SingleArray, morphs: Mapping[str, SingleArray]) -> None:
        self._hand, self._node_from_joint, self._morphs = hand, node_from_joint, morphs
        self.frames = len(node_from_joint)

    def places_m(self, frames: IntArray, vertices: IntArray) -> SingleArray:
        """Where vertices (N,) are at frames (N,): (N, 3)."""
        hand = self._hand
        result = np.zeros((len(frames), 3), dtype=np.float32)
        matrices = self._node_from_joint.reshape(-1, 12)
        first = frames * len(hand.joints)
        for carrier in range(hand.carriers.shape[1]):
            rows = np.flatnonzero(hand.weights[:, carrier].take(vertices))
            at, vertex = first[rows], vertices[rows]
            places_m = hand.places_m[:, carrier].take(vertex, axis=0)
            for name, curve in self._morphs.items():
                places_m += curve[frames[rows], None] * hand.morphs[name][vertex, carrier]
            matrix = matrices.take(at + hand.carriers[:, carrier].take(vertex), axis=0).reshape(-1, 3, 4)
            moved_m = np.einsum("nij,nj->ni", matrix[..., :3], places_m) + matrix[..., 3]
            result[rows] += hand.weights[:, carrier].take(vertex)[:, None] * moved_m
        return result

    def moves(self, size: int) -> _Moves:
        """How far joints move from the middle frames of blocks of some size."""
        blocks = self._node_from_joint.reshape(-1, size, *self._node_from_joint.shape[1:])
        moved = blocks - blocks[:, size // 2, None]
        curves = {name: curve.reshape(-1, size) for name, curve in self._morphs.items()}
        return _Moves(
            hand=self._hand,
            # A turn by an angle moves what is 1 from the joint by the chord, 2 sin(angle / 2), at most.
            chords=np.sqrt(np.einsum("bsjik,bsjik->bsj", moved[..., :3], moved[..., :3]).max(axis=1) / 2.0),
            shifts_m=np.sqrt(np.einsum("bsji,bsji->bsj", moved[..., 3], moved[..., 3]).max(axis=1)),
            greatest={name: float(np.abs(curve).max()) for name, curve in curves.items()},
            changes={name: np.abs(curve - curve[:, size // 2, None]).max(axis=1) for name, curve in curves.items()},
        )


@dataclass(frozen=True, eq=False)
class _Moves:
    """How far joints move from the middle frame of each block.

    Attributes
    ----------
    hand : _Carried
    chords : (B, J) float32
        What is 1 from a joint is moved by its turning by no more.
    shifts_m : (B, J) float32
        Of the joints themselves.
    greatest : dict of str to float
        Weights of the morphs.
    changes : dict of str to (B,) float32
        Of the morphs' weights.
    """

    hand: _Carried
    chords: SingleArray
    shifts_m: SingleArray
    greatest: Mapping[str, float]
    changes: Mapping[str, SingleArray]

    def most_m(self, blocks: IntArray, vertices: IntArray) -> SingleArray:
        """What vertices (N,) move at most in blocks (N,)."""
        hand = self.hand
        arms_m = hand.arms_m.take(vertices, axis=0)
        at = blocks[:, None] * len(hand.joints) + hand.carriers.take(vertices, axis=0)
        result = self.shifts_m.reshape(-1).take(at)
        for name, greatest in self.greatest.items():
            lengths_m = np.linalg.norm(hand.morphs[name][vertices], axis=2)
            arms_m += greatest * lengths_m
            result += self.changes[name][blocks, None] * lengths_m
        result += self.chords.reshape(-1).take(at) * arms_m
        found: SingleArray = np.einsum("nk,nk->n", hand.weights.take(vertices, axis=0), result)
        return found


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Blocks (N,) and what may be deepest in them: vertices (N,), or groups of them (N,)."""

    blocks: IntArray
    items: IntArray

    def __len__(self) -> int:
        return len(self.blocks)

    def __getitem__(self, rows: npt.NDArray[np.bool_]) -> _Pairs:
        return _Pairs(self.blocks[rows], self.items[rows])

    def __add__(self, other: _Pairs) -> _Pairs:
        return _Pairs(np.concatenate([self.blocks, other.blocks]), np.concatenate([self.items, other.items]))

    def split(self, parts: int) -> _Pairs:
        """The same in each of the parts of the blocks."""
        blocks = self.blocks[:, None] * parts + np.arange(parts)
        return _Pairs(blocks.ravel(), np.repeat(self.items, parts))


class _Search:
    """The search for the deepest vertex in the bodies of one node.

    Parameters
    ----------
    field : DistanceField
    poses : _Poses
        In the frame of the node.
    groups : _Groups
    """

    def __init__(self, field: DistanceField, poses: _Poses, groups: _Groups) -> None:
        self._field, self._poses, self._groups = field, poses, groups
        self._size = BLOCKS[0]
        everything = np.mgrid[: poses.frames // BLOCKS[0], : len(groups.middles)]
        self._grouped, self._single = _Pairs(*everything.reshape(2, -1)), _Pairs(*np.zeros((2, 0), dtype=np.intp))
        self._places_m = self._moves_m = self._possible_m = np.zeros(0, dtype=np.float32)

    @property
    def open(self) -> bool:
        """Whether anything may still be deepest."""
        return len(self._grouped) + len(self._single) > 0

    def judge_roughly(self, size: int, depths_m: SingleArray) -> None:
        """Judge by the grid, block by block.

        Parameters
        ----------
        size : int
            Frames of a block.
        depths_m : (B, size) float32
            How deep something is at least: raised by what is found.
        """
        grouped, single = (pairs.split(self._size // size) for pairs in (self._grouped, self._single))
        self._size = size
        moves = self._poses.moves(size)
        middles = _Pairs(grouped.blocks, self._groups.middles[grouped.items])
        _, about_m, moves_m = self._rough(middles, moves, depths_m)
        near = moves_m + self._groups.radii_m[grouped.items] - about_m > depths_m.min(axis=1)[grouped.blocks]
        still = moves_m < STILL_M
        self._grouped = grouped[near & ~still]
        single += self._groups.vertices(grouped[near & still])
        self._places_m, about_m, self._moves_m = self._rough(single, moves, depths_m)
        self._single, self._possible_m = single, self._moves_m - about_m

    def judge_exactly(self, depths_m: SingleArray) -> None:
        """Judge what may still be deepest after `judge_roughly`; parameters as there."""
        near = self._possible_m > depths_m.min(axis=1)[self._single.blocks]
        pairs, moves_m = self._single[near], self._moves_m[near]
        distances_m = self._field.distances_m(self._places_m[near].astype(np.float64)).astype(np.float32)
        _raise(depths_m, pairs.blocks, -distances_m - moves_m)
        self._single = pairs[moves_m - distances_m > depths_m.min(axis=1)[pairs.blocks]]

    def _rough(
        self, pairs: _Pairs, moves: _Moves, depths_m: SingleArray
    ) -> tuple[SingleArray, SingleArray, SingleArray]:
        """Places of vertices in the middle frames, their least distances there, and how far they move."""
        places_m = self._poses.places_m(pairs.blocks * self._size + self._size // 2, pairs.items)
        moves_m = moves.most_m(pairs.blocks, pairs.items)
        about_m = self._field.about_m(places_m)
        _raise(depths_m, pairs.blocks, -about_m - np.float32(self._field.error_m) - moves_m)
        return places_m, about_m - np.float32(self._field.error_m), moves_m


def _raise(depths_m: SingleArray, blocks: IntArray, found_m: SingleArray) -> None:
    """Raise the least depths (B, size) of blocks to what was found (N,) in some of them (N,)."""
    deepest_m = np.zeros(len(depths_m), dtype=np.float32)
    np.maximum.at(deepest_m, blocks, found_m)
    np.maximum(depths_m, deepest_m[:, None], out=depths_m)


@dataclass(frozen=True, eq=False)
class _Groups:
    """Vertices in groups.

    Attributes
    ----------
    members : (G, M) int
        Vertices, -1 where a group has fewer.
    middles : (G,) int
        The vertex nearest to the middle.
    radii_m : (G,) float32
        Around it.
    """

    members: IntArray
    middles: IntArray
    radii_m: SingleArray

    def vertices(self, grouped: _Pairs) -> _Pairs:
        """The vertices of groups, in the same blocks."""
        members = self.members[grouped.items]
        row, _ = there = np.nonzero(members >= 0)
        return _Pairs(grouped.blocks[row], members[there])


def _groups(skin: Skin) -> _Groups:
    """Groups of vertices that lie together and go with the same joint."""
    strongest = np.argmax(skin.weights, axis=1)
    groups = [
        rows for joint in np.unique(strongest) for rows in _split(np.flatnonzero(strongest == joint), skin.positions_m)
    ]
    members = np.full((len(groups), max(map(len, groups))), -1, dtype=np.intp)
    middles, radii_m = np.zeros(len(groups), dtype=np.intp), np.zeros(len(groups), dtype=np.float32)
    for index, rows in enumerate(groups):
        points_m = skin.positions_m[rows]
        middle = int(np.argmin(np.linalg.norm(points_m - points_m.mean(axis=0), axis=1)))
        members[index, : len(rows)], middles[index] = rows, rows[middle]
        radii_m[index] = np.linalg.norm(points_m - points_m[middle], axis=1).max() * STRETCH
    return _Groups(members, middles, radii_m)


def _split(rows: IntArray, positions_m: FloatArray) -> list[IntArray]:
    """Halve along the longest side until the groups are small."""
    if len(rows) <= GROUP:
        return [rows]
    extent = np.ptp(positions_m[rows], axis=0)
    order = rows[np.argsort(positions_m[rows, int(np.argmax(extent))], kind="stable")]
    half = len(order) // 2
    return _split(order[:half], positions_m) + _split(order[half:], positions_m)


def _local(node_from_world: SingleArray, world_from_joint: SingleArray) -> SingleArray:
    """``node_from_joint`` (F, J, 3, 4) of ``world_from_joint`` (F, 3, J, 4)."""
    frames, _, joints, _ = world_from_joint.shape
    turned = (node_from_world[:, :, :3] @ world_from_joint.reshape(frames, 3, -1)).reshape(frames, 3, joints, 4)
    turned[..., 3] += node_from_world[:, :, None, 3]
    return np.ascontiguousarray(turned.transpose(0, 2, 1, 3))


@lru_cache(maxsize=8)
def _fields(bodies: tuple[Proxy, ...]) -> Mapping[str, DistanceField]:
    """By node. Cached: two hands, and players of one kind, are near the same bodies."""
    by_node: dict[str, list[Proxy]] = {}
    for body in bodies:
        by_node.setdefault(body.node, []).append(body)
    return {node: DistanceField(some) for node, some in by_node.items()}
