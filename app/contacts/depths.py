"""Penetration depths of hands and fingers in an instrument, which is represented by closed bodies.

The deepest vertex of every frame is found by branch and bound. A block of frames is bounded by its middle frame: a
distance changes by no more than the movement of the vertex, which is bounded by the movement of joints and parts.
Vertices that cannot be deepest in any frame of a block are dropped; the rest is examined in shorter blocks, down to
single frames. Blocks contain similar frames, regardless of time. While a hand moves much within a block, its vertices
are treated in groups. Everything is computed in the frame of the part relative to which the hand moves least, such as a
slide.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from app.arrays import AnyFloatArray, BoolArray, FloatArray, IndexArray, SingleArray
from app.contacts.distance_field import DistanceField
from app.contacts.hand_poses import (
    NodePoints,
    Parts,
    VertexPoses,
    joints_in_node,
    moving_parts_m,
    skinned_vertices,
    steadiest,
)
from app.contacts.similar_frames import order_by_similarity
from app.rig.skinning import Skin
from instrument_maps.hold import Proxy

BLOCKS = (128, 16, 4, 1)
"""Lengths in frames of nested blocks, each a multiple of the next."""
GROUP = 8
"""Approximate number of vertices per group."""
STRETCH = 1.3
"""Factor by which the distance of a vertex from the centre of its group in the bind pose may grow when the
hand bends.
"""
STILL_M = 0.006
"""Groups that move less than this distance in metres within a block are judged vertex by vertex."""
_ARM_M = 0.02
"""Distance in metres from each joint of the point by which frames are compared, so that rotations count too."""
_ROUNDING_M = np.float32(1e-6)
"""Bound in metres of the rounding error of a vertex position in single precision, for any order of operations."""


class HandDepths:
    """The skin of a hand, and the bodies that it must not penetrate.

    Parameters
    ----------
    hand : Skin
        Skin of hand and fingers.
    bodies : sequence of Proxy
        Closed bodies that represent the instrument.

    Attributes
    ----------
    joints : (J,) int
        Joints that hold a vertex.
    """

    def __init__(self, hand: Skin, bodies: Sequence[Proxy]) -> None:
        self._hand = skinned_vertices(hand)
        self.joints = self._hand.joints
        strongest = np.argmax(hand.weights, axis=1).astype(np.int32)
        self._groups = _groups(hand.positions_m.tobytes(), strongest.tobytes())
        self._nodes, self._field = _field(tuple(bodies))

    def depths_m(
        self,
        world_from_joint: AnyFloatArray,
        morphs: Mapping[str, AnyFloatArray],
        world_from_node: Mapping[str, FloatArray],
        least_m: FloatArray | None = None,
        least_of: Callable[[FloatArray], float] = lambda found_m: 0.0,
    ) -> FloatArray:
        """Compute at each frame the greatest depth of any vertex of the hand in any body of the instrument.

        Parameters
        ----------
        world_from_joint : (F, J, 3, 4)
            Transforms of `joints`.
        morphs : dict of str to (F,)
            Morph weights by name.
        world_from_node : dict of str to (F, 4, 4) float64
            Transforms of the instrument's nodes.
        least_m : (F,) float64, optional
            Depths below which exact values are not needed; 0 by default.
        least_of : callable
            Function from lower bounds of all depths found so far (F,) to such a limit for all frames; called
            repeatedly.

        Returns
        -------
        (F,) float64
            Depth in metres; ``least_m`` where nothing is deeper.
        """
        frames = len(world_from_joint)
        if not frames or not self._nodes:
            return np.zeros(frames) if least_m is None else least_m
        sizes = [size for size in BLOCKS if size <= frames]
        joints = world_from_joint.transpose(0, 2, 1, 3).astype(np.float32, order="C")
        base = steadiest([world_from_node[node] for node in self._nodes], joints)
        # Padded to whole blocks by repeating the last frame.
        order = np.minimum(np.arange(-(-frames // sizes[0]) * sizes[0]), frames - 1)
        local = joints_in_node(world_from_node[self._nodes[base]], joints)
        features = (local[:, 3] + local[:, 0] * np.float32(_ARM_M)).transpose(1, 0, 2).reshape(frames, -1)
        parts_m = moving_parts_m([world_from_node[node] for node in self._nodes], base, local[:, 3].mean(axis=(1, 2)))
        order = order[order_by_similarity(np.concatenate([features, parts_m], axis=1)[order], sizes[0], 4)]
        depths_m = np.zeros(len(order), dtype=np.float32)
        if least_m is not None:
            depths_m[:] = least_m[order]
        weights = {name: np.asarray(morphs[name], np.float32)[order] for name in self._hand.morphs if name in morphs}
        nodes = [world_from_node[node][order] for node in self._nodes]
        poses = VertexPoses(self._hand, local[:, :, order], weights)
        parts = Parts(nodes, base, self._field.reaches_m)
        search = _Search(self._groups, self._field, poses, joints[order], weights, nodes, parts)
        search.begin(sizes[0], depths_m.reshape(-1, sizes[0]))
        found_m = np.empty(frames)
        for size in sizes:
            search.judge_roughly(size, depths_m.reshape(-1, size))
            search.judge_exactly(depths_m.reshape(-1, size))
            found_m[order] = depths_m
            if not search.open:
                break
            np.maximum(depths_m, np.float32(least_of(found_m)), out=depths_m)
        return found_m


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Candidates of the search for the deepest vertices: S pairs of a block of frames and a vertex, expanded to N pairs
    with nearby nodes of the instrument.

    Attributes
    ----------
    blocks, items : (S,) int
        Block and vertex (or group) of each candidate, placed once for all its nodes.
    spots, nodes : (N,) int
        Index of the candidate, and node, for each pair.
    """

    blocks: IndexArray
    items: IndexArray
    spots: IndexArray
    nodes: IndexArray

    def __len__(self) -> int:
        return len(self.spots)

    def __getitem__(self, rows: BoolArray) -> _Pairs:
        spots = self.spots[rows]
        used = np.zeros(len(self.blocks), dtype=bool)
        used[spots] = True
        return _Pairs(self.blocks[used], self.items[used], (np.cumsum(used) - 1)[spots], self.nodes[rows])

    def __add__(self, other: _Pairs) -> _Pairs:
        spots = other.spots + len(self.blocks)
        both = ((self.blocks, other.blocks), (self.items, other.items), (self.spots, spots), (self.nodes, other.nodes))
        return _Pairs(*map(np.concatenate, both))

    def of_blocks(self, values: SingleArray) -> SingleArray:
        """Expand values per block (B,) to values per pair (N,): each pair gets the value of its block."""
        found: SingleArray = values[self.blocks][self.spots]
        return found

    def split(self, parts: int) -> _Pairs:
        """Split every block of frames into ``parts`` shorter blocks, and repeat the pairs for each of them."""
        blocks, spots = ((values[:, None] * parts + np.arange(parts)).ravel() for values in (self.blocks, self.spots))
        return _Pairs(blocks, np.repeat(self.items, parts), spots, np.repeat(self.nodes, parts))


_NONE = _Pairs(*np.zeros((4, 0), dtype=np.intp))


class _Search:
    """State of the search for the deepest vertex.

    Parameters
    ----------
    groups : _Groups
        Groups of vertices of the hand.
    field : DistanceField
        Signed distances from the instrument's bodies.
    poses : VertexPoses
        Poses in the frame of the base node.
    world_from_joint : (F, 3, J, 4) float32
        Transforms of the hand's joints.
    morphs : dict of str to (F,) float32
        Morph weights.
    world_from_node : list of (F, 4, 4) float64
        Transforms by node.
    parts : Parts
        Nodes of the instrument in the frame of the base node, relative to which the hand moves least.
    """

    def __init__(
        self,
        groups: _Groups,
        field: DistanceField,
        poses: VertexPoses,
        world_from_joint: SingleArray,
        morphs: Mapping[str, SingleArray],
        world_from_node: list[FloatArray],
        parts: Parts,
    ) -> None:
        self._groups, self._field = groups, field
        self._world_from_joint, self._morphs, self._world_from_node = world_from_joint, morphs, world_from_node
        self._poses = poses
        self._parts = parts
        self._moved = self._parts.moves(1)
        self._grouped = self._single = _NONE

    @property
    def open(self) -> bool:
        """True while the search still has candidates."""
        return len(self._grouped) + len(self._single) > 0

    def begin(self, size: int, depths_m: SingleArray) -> None:
        """Collect the candidates: groups of vertices near the bounding boxes of the nodes' bodies. Parameters as in
        `judge_roughly`.
        """
        self._moved = self._parts.moves(size)
        blocks, groups = np.mgrid[: len(depths_m), : len(self._groups.middles)].reshape(2, -1)
        spots, nodes = np.mgrid[: len(blocks), : len(self._world_from_node)].reshape(2, -1)
        pairs = _Pairs(blocks, groups, spots, nodes)
        placed = self._placed(pairs, self._groups.middles[groups])
        least_m = placed.least_m(self._field.beyond_m(placed.places_m.T, nodes)) - self._groups.radii_m[groups][spots]
        self._grouped = pairs[-least_m > pairs.of_blocks(depths_m.min(axis=1))]

    def judge_roughly(self, size: int, depths_m: SingleArray) -> None:
        """Reduce the candidates to those that may be deepest, by the bodies' approximate distance grids and blocks of
        frames.

        Parameters
        ----------
        size : int
            Frames per block.
        depths_m : (B, size) float32
            Lower bounds of the greatest depth in each frame of B blocks; raised in place.
        """
        grouped, single = (pairs.split(self._moved.size // size) for pairs in (self._grouped, self._single))
        if size != self._moved.size:
            self._moved = self._parts.moves(size)
        near, placed = self._near(
            grouped, self._groups.middles[grouped.items], self._groups.radii_m[grouped.items], depths_m
        )
        still = placed.moves_m < STILL_M
        self._grouped = grouped[near & ~still]
        single += self._groups.vertices(grouped[near & still])
        near, placed = self._near(single, single.items, np.zeros(len(single.items), dtype=np.float32), depths_m)
        self._single, self._singly = single[near], placed[near]

    def judge_exactly(self, depths_m: SingleArray) -> None:
        """Compute the exact depths of the remaining candidates, and raise ``depths_m``; parameters as in
        `judge_roughly`.
        """
        pairs, places_m, moves_m = self._single, self._singly.places_m, self._singly.moves_m
        if self._moved.size == 1:
            places_m, moves_m = self._exactly_m(pairs), np.zeros_like(moves_m)
        distances_m = self._field.distances_m(places_m.T.astype(np.float64), pairs.nodes).astype(np.float32)
        _raise(depths_m, pairs, -distances_m - moves_m)
        self._single = pairs[moves_m - distances_m > pairs.of_blocks(depths_m.min(axis=1))]

    def _exactly_m(self, pairs: _Pairs) -> SingleArray:
        """Exact positions (3, N) of the candidates' vertices at single frames, in the frames of their nodes."""
        places_m = np.empty((3, len(pairs)), dtype=np.float32)
        blocks, vertices = pairs.blocks[pairs.spots], pairs.items[pairs.spots]
        for node in np.unique(pairs.nodes).tolist():
            rows = np.flatnonzero(pairs.nodes == node)
            frames, at = np.unique(blocks[rows], return_inverse=True)
            local = joints_in_node(self._world_from_node[node][frames], self._world_from_joint[frames])
            morphs = {name: curve[frames] for name, curve in self._morphs.items()}
            places_m[:, rows] = VertexPoses(self._poses.hand, local, morphs).places_m(at, vertices[rows])
        return places_m

    def _placed(self, pairs: _Pairs, vertices: IndexArray) -> NodePoints:
        """Positions of the candidate vertices (S,) in the frames of their nodes, at the middle frame of each block,
        with bounds on their movement.
        """
        size, spots = self._moved.size, pairs.spots
        middles = pairs.blocks * size + size // 2
        places_m, moves_m = self._poses.places_m(middles, vertices), np.full(len(vertices), _ROUNDING_M)
        if size > 1:
            there, at = np.unique(pairs.blocks, return_inverse=True)
            moves_m += self._poses.moves(size, there).most_m(at, vertices)
        return self._moved.placed(pairs.blocks[spots], pairs.nodes, places_m.take(spots, axis=1), moves_m[spots])

    def _near(
        self, pairs: _Pairs, vertices: IndexArray, radii_m: SingleArray, depths_m: SingleArray
    ) -> tuple[BoolArray, NodePoints]:
        """Mask (N,) of the pairs whose vertex may be the deepest in any frame of its block, and the positions of the
        vertices. ``radii_m`` (S,) are the radii of the groups around the vertices (S,). Known depths (B, size) of the
        frames of B blocks are raised in place.
        """
        placed, own_m = self._placed(pairs, vertices), radii_m[pairs.spots]
        # Anything this far away is certainly less deep than the depth found so far.
        clear_m = own_m + placed.moves_m - pairs.of_blocks(depths_m.min(axis=1))
        about_m, error_m = self._field.about_m(placed.places_m.T, pairs.nodes, clear_m, placed.moves_m)
        _raise(depths_m, pairs, -about_m - error_m - placed.moves_m)
        least_m = placed.least_m(about_m - error_m) - own_m
        return -least_m > pairs.of_blocks(depths_m.min(axis=1)), placed


def _raise(depths_m: SingleArray, pairs: _Pairs, found_m: SingleArray) -> None:
    """Raise the known depths (B, size) of the frames of B blocks to the depths (N,) found for N pairs, in place."""
    rows = np.flatnonzero(found_m > 0.0)
    deepest_m = np.zeros(len(depths_m), dtype=np.float32)
    np.maximum.at(deepest_m, pairs.blocks[pairs.spots[rows]], found_m[rows])
    np.maximum(depths_m, deepest_m[:, None], out=depths_m)


@dataclass(frozen=True, eq=False)
class _Groups:
    """Groups of neighbouring vertices.

    Attributes
    ----------
    members : (G, M) int
        Vertex indices, padded with -1.
    middles : (G,) int
        Vertex nearest to the group's centre.
    radii_m : (G,) float32
        Radius around that vertex.
    """

    members: IndexArray
    middles: IndexArray
    radii_m: SingleArray

    def vertices(self, grouped: _Pairs) -> _Pairs:
        """Expand pairs with groups of vertices to pairs with the single vertices, in the same blocks."""
        members = self.members[grouped.items]
        row, _ = there = np.nonzero(members >= 0)
        counts = np.bincount(row, minlength=len(members))
        first, many = (np.cumsum(counts) - counts)[grouped.spots], counts[grouped.spots]
        pair = np.repeat(np.arange(len(grouped)), many)
        within = np.arange(len(pair)) - (np.cumsum(many) - many)[pair]
        return _Pairs(grouped.blocks[row], members[there], first[pair] + within, grouped.nodes[pair])


@lru_cache(maxsize=16)
def _groups(places_m: bytes, strongest: bytes) -> _Groups:
    """Group neighbouring vertices with the same strongest joint; cached by content, since players may share a body."""
    positions_m, joints = np.frombuffer(places_m).reshape(-1, 3), np.frombuffer(strongest, dtype=np.int32)
    groups = [rows for joint in np.unique(joints) for rows in _split(np.flatnonzero(joints == joint), positions_m)]
    members = np.full((len(groups), max(map(len, groups))), -1, dtype=np.intp)
    middles, radii_m = np.zeros(len(groups), dtype=np.intp), np.zeros(len(groups), dtype=np.float32)
    for index, rows in enumerate(groups):
        points_m = positions_m[rows]
        middle = int(np.argmin(np.linalg.norm(points_m - points_m.mean(axis=0), axis=1)))
        members[index, : len(rows)], middles[index] = rows, rows[middle]
        radii_m[index] = np.linalg.norm(points_m - points_m[middle], axis=1).max() * STRETCH
    return _Groups(members, middles, radii_m)


def _split(rows: IndexArray, positions_m: FloatArray) -> list[IndexArray]:
    """Halve a group of vertices along its longest side until every group has at most `GROUP` vertices; returns the rows
    of each group.
    """
    if len(rows) <= GROUP:
        return [rows]
    extent = np.ptp(positions_m[rows], axis=0)
    order = rows[np.argsort(positions_m[rows, int(np.argmax(extent))], kind="stable")]
    half = len(order) // 2
    return _split(order[:half], positions_m) + _split(order[half:], positions_m)


@lru_cache(maxsize=8)
def _field(bodies: tuple[Proxy, ...]) -> tuple[tuple[str, ...], DistanceField]:
    """Build the distance field of the bodies, and return it with the names of the nodes that have bodies; cached, since
    hands and similar players share it.
    """
    by_node: dict[str, list[Proxy]] = {}
    for body in bodies:
        by_node.setdefault(body.node, []).append(body)
    return tuple(by_node), DistanceField(list(by_node.values()))
