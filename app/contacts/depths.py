"""How deep hands and fingers go into the closed bodies that stand for an instrument.

The deepest vertex of every frame is found by branch and bound. A block of frames is judged by its middle frame: how far
a vertex moves from there is bounded by how far its joints and the instrument's parts move, and a distance changes by no
more than a point moves. Vertices that cannot be the deepest in any frame of a block are dropped; for the others shorter
blocks are judged, down to single frames. While a hand moves too far within a block, its vertices are judged in groups.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from app.contacts.distance_field import DistanceField
from app.contacts.hand_poses import (
    Carried,
    IntArray,
    PartMoves,
    Parts,
    Poses,
    SingleArray,
    carried,
    joints_in_node,
)
from app.rig.skinning import Skin
from instrument_maps.model import Proxy

FloatArray = npt.NDArray[np.float64]
AnyFloatArray = npt.NDArray[np.floating]

BLOCKS = (128, 16, 4, 1)
"""Frames of the blocks, each a multiple of the next."""
GROUP = 8
"""Vertices per group, about."""
STRETCH = 1.3
"""How much further from its middle than in the bind pose a vertex of a group may come when the hand bends."""
STILL_M = 0.003
"""A group that moves less within a block is judged vertex by vertex."""
_ROUNDING_M = np.float32(1e-6)
"""More than two ways of placing a vertex in single precision differ."""


class HandDepths:
    """The skin of a hand and the bodies it must not enter.

    Parameters
    ----------
    hand : Skin
        Of hand and fingers.
    bodies : sequence of Proxy
    """

    def __init__(self, hand: Skin, bodies: Sequence[Proxy]) -> None:
        self._hand = carried(hand)
        self._groups = _groups(hand)
        self._nodes, self._field = _field(tuple(bodies))

    def depths_m(
        self,
        world_from_joint: FloatArray,
        morphs: Mapping[str, AnyFloatArray],
        world_from_node: Mapping[str, FloatArray],
        least_m: FloatArray | None = None,
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
        least_m : (F,) float64, optional
            What is no deeper need not be found; 0 if absent.

        Returns
        -------
        (F,) float64
            Metres, ``least_m`` where nothing is deeper.
        """
        frames = len(world_from_joint)
        if not frames or not self._nodes:
            return np.zeros(frames) if least_m is None else least_m
        # Whole blocks: the last frame is repeated.
        padded = np.minimum(np.arange(-(-frames // BLOCKS[0]) * BLOCKS[0]), frames - 1)
        depths_m = np.zeros(len(padded), dtype=np.float32)
        if least_m is not None:
            depths_m[:] = least_m[padded]
        weights = {name: np.asarray(morphs[name], np.float32)[padded] for name in self._hand.morphs if name in morphs}
        joints = world_from_joint[:, self._hand.joints, :3].transpose(0, 2, 1, 3).astype(np.float32, order="C")[padded]
        nodes = [world_from_node[node][padded] for node in self._nodes]
        search = _Search(self._hand, self._groups, self._field, joints, weights, nodes)
        search.begin(depths_m.reshape(-1, BLOCKS[0]))
        for size in BLOCKS:
            search.judge_roughly(size, depths_m.reshape(-1, size))
            search.judge_exactly(depths_m.reshape(-1, size))
            if not search.open:
                break
        return depths_m[:frames].astype(np.float64)


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Blocks (N,), the nodes (N,) whose bodies are judged, and what may be deepest in them: vertices (N,), or groups of
    them (N,)."""

    blocks: IntArray
    nodes: IntArray
    items: IntArray

    def __len__(self) -> int:
        return len(self.blocks)

    def __getitem__(self, rows: npt.NDArray[np.bool_]) -> _Pairs:
        return _Pairs(self.blocks[rows], self.nodes[rows], self.items[rows])

    def __add__(self, other: _Pairs) -> _Pairs:
        both = ((self.blocks, other.blocks), (self.nodes, other.nodes), (self.items, other.items))
        return _Pairs(*map(np.concatenate, both))

    def split(self, parts: int) -> _Pairs:
        """The same in each of the parts of the blocks."""
        blocks = self.blocks[:, None] * parts + np.arange(parts)
        return _Pairs(blocks.ravel(), np.repeat(self.nodes, parts), np.repeat(self.items, parts))


_NONE = _Pairs(*np.zeros((3, 0), dtype=np.intp))


class _Search:
    """The search for the deepest vertex.

    Parameters
    ----------
    hand : Carried
    groups : _Groups
    field : DistanceField
    world_from_joint : (F, 3, J, 4) float32
    morphs : dict of str to (F,) float32
        Weights.
    world_from_node : list of (F, 4, 4) float64
        By node. Of hand and nodes all that moves is judged in the frame of the first.
    """

    def __init__(
        self,
        hand: Carried,
        groups: _Groups,
        field: DistanceField,
        world_from_joint: SingleArray,
        morphs: Mapping[str, SingleArray],
        world_from_node: list[FloatArray],
    ) -> None:
        self._hand, self._groups, self._field = hand, groups, field
        self._world_from_joint, self._morphs, self._world_from_node = world_from_joint, morphs, world_from_node
        self._poses = Poses(hand, joints_in_node(world_from_node[0], world_from_joint), morphs)
        self._parts = Parts(world_from_node)
        self._size = BLOCKS[0]
        self._grouped = self._single = _NONE
        self._distances_m = self._moves_m = np.zeros(0, dtype=np.float32)
        self._places_m = np.zeros((0, 3), dtype=np.float32)

    @property
    def open(self) -> bool:
        """Whether anything may still be deepest."""
        return len(self._grouped) + len(self._single) > 0

    def begin(self, depths_m: SingleArray) -> None:
        """Find the groups that come near the boxes around the bodies of each node; parameters as of
        `judge_roughly`, for blocks of the first size."""
        blocks, groups = np.mgrid[: len(depths_m), : len(self._groups.middles)].reshape(2, -1)
        moves, parts = self._poses.moves(self._size, np.arange(len(depths_m))), self._parts.moves(self._size)
        frames, vertices = blocks * self._size + self._size // 2, self._groups.middles[groups]
        places_m = self._poses.places_m(frames, vertices)
        reach_m = moves.most_m(blocks, vertices) + self._groups.radii_m[groups] + _ROUNDING_M
        least_m = depths_m.min(axis=1)[blocks]
        found = [_NONE]
        for node in range(len(self._world_from_node)):
            nodes = np.full(len(blocks), node)
            there_m = self._parts.places_m(frames, nodes, places_m)
            near = reach_m + parts.most_m(blocks, nodes, there_m) - self._field.beyond_m(there_m, node) > least_m
            found.append(_Pairs(blocks[near], nodes[near], groups[near]))
        self._grouped = _Pairs(
            np.concatenate([some.blocks for some in found]),
            np.concatenate([some.nodes for some in found]),
            np.concatenate([some.items for some in found]),
        )

    def judge_roughly(self, size: int, depths_m: SingleArray) -> None:
        """Judge by the grids, block by block.

        Parameters
        ----------
        size : int
            Frames of a block.
        depths_m : (B, size) float32
            How deep something is at least: raised by what is found.
        """
        grouped, single = (pairs.split(self._size // size) for pairs in (self._grouped, self._single))
        self._size = size
        parts = self._parts.moves(size)
        middles = _Pairs(grouped.blocks, grouped.nodes, self._groups.middles[grouped.items])
        _, about_m, moves_m = self._rough(middles, parts, depths_m)
        near = moves_m + self._groups.radii_m[grouped.items] - about_m > depths_m.min(axis=1)[grouped.blocks]
        still = moves_m < STILL_M
        self._grouped = grouped[near & ~still]
        single += self._groups.vertices(grouped[near & still])
        self._places_m, self._distances_m, self._moves_m = self._rough(single, parts, depths_m)
        self._single = single

    def judge_exactly(self, depths_m: SingleArray) -> None:
        """Judge what may still be deepest after `judge_roughly`; parameters as there."""
        near = self._moves_m - self._distances_m > depths_m.min(axis=1)[self._single.blocks]
        pairs, moves_m, places_m = self._single[near], self._moves_m[near], self._places_m[near]
        if self._size == 1:
            places_m, moves_m = self._placed_m(pairs), np.zeros(len(pairs), dtype=np.float32)
        distances_m = self._field.distances_m(places_m.astype(np.float64), pairs.nodes).astype(np.float32)
        _raise(depths_m, pairs.blocks, -distances_m - moves_m)
        self._single = pairs[moves_m - distances_m > depths_m.min(axis=1)[pairs.blocks]]

    def _placed_m(self, pairs: _Pairs) -> SingleArray:
        """Places (N, 3) of vertices at single frames in the frames of their nodes, without the first one's detour."""
        places_m = np.empty((len(pairs), 3), dtype=np.float32)
        for node, world_from_node in enumerate(self._world_from_node):
            rows = np.flatnonzero(pairs.nodes == node)
            frames, at = np.unique(pairs.blocks[rows], return_inverse=True)
            local = joints_in_node(world_from_node[frames], self._world_from_joint[frames])
            morphs = {name: curve[frames] for name, curve in self._morphs.items()}
            places_m[rows] = Poses(self._hand, local, morphs).places_m(at, pairs.items[rows])
        return places_m

    def _rough(
        self, pairs: _Pairs, parts: PartMoves, depths_m: SingleArray
    ) -> tuple[SingleArray, SingleArray, SingleArray]:
        """Places of vertices in the middle frames, their least distances there, and how far they move."""
        there = np.zeros(len(depths_m), dtype=bool)
        there[pairs.blocks] = True
        frames = pairs.blocks * self._size + self._size // 2
        places_m = self._parts.places_m(frames, pairs.nodes, self._poses.places_m(frames, pairs.items))
        moves_m = parts.most_m(pairs.blocks, pairs.nodes, places_m) + _ROUNDING_M
        if self._size > 1:
            moves = self._poses.moves(self._size, np.flatnonzero(there))
            moves_m += moves.most_m((np.cumsum(there) - 1)[pairs.blocks], pairs.items)
        about_m, error_m = self._field.about_m(places_m, pairs.nodes), np.float32(self._field.error_m)
        _raise(depths_m, pairs.blocks, -about_m - error_m - moves_m)
        return places_m, about_m - error_m, moves_m


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
        return _Pairs(grouped.blocks[row], grouped.nodes[row], members[there])


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


@lru_cache(maxsize=8)
def _field(bodies: tuple[Proxy, ...]) -> tuple[tuple[str, ...], DistanceField]:
    """Nodes with bodies, and the distances to these. Cached: two hands, and players of one kind, are near the same."""
    by_node: dict[str, list[Proxy]] = {}
    for body in bodies:
        by_node.setdefault(body.node, []).append(body)
    return tuple(by_node), DistanceField(list(by_node.values()))
