"""Positions and movement of a hand's vertices in the frames of an instrument's nodes.

For `app.contacts.depths`: single precision, over whole arrays of vertices and frames. Coordinates are separate rows,
since that is faster than triples.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import BoolArray, FloatArray, IndexArray, SingleArray
from app.rig.skinning import Skin

MOVES_M = 0.001
"""Parts of the instrument that move less than this distance in metres near the hand are ignored when frames are
compared.
"""


@dataclass(frozen=True, eq=False)
class SkinnedVertices:
    """V vertices of a skin, each with the K joints that carry it, in arrays for fast computation.

    Attributes
    ----------
    joints : (J,) int
        Joints that hold any vertex.
    carriers : (V, K) int
        Rows of ``joints``, strongest first.
    weights : (V, K) float32
        Weight of each carrying joint.
    places_m : (K, 3, V) float32
        Positions in the frame of each joint.
    arms_m : (V, K) float32
        Distance from each joint to the vertex.
    morphs : dict of str to (K, 3, V) float32
        Displacements in the frame of each joint.
    """

    joints: IndexArray
    carriers: IndexArray
    weights: SingleArray
    places_m: SingleArray
    arms_m: SingleArray
    morphs: Mapping[str, SingleArray]


def skinned_vertices(skin: Skin) -> SkinnedVertices:
    """Convert a skin to arrays for fast skinning: for each vertex the joints that carry it, strongest first."""
    count = int(np.count_nonzero(skin.weights, axis=1).max())
    carriers = np.argsort(-skin.weights, axis=1, kind="stable")[:, :count]
    from_mesh = skin.joint_from_mesh[carriers]
    places_m = np.einsum("vkij,vj->vki", from_mesh[..., :3], skin.positions_m) + from_mesh[..., 3]
    return SkinnedVertices(
        joints=skin.joints,
        carriers=carriers,
        weights=np.take_along_axis(skin.weights, carriers, axis=1).astype(np.float32),
        places_m=_by_carrier(places_m),
        arms_m=np.linalg.norm(places_m, axis=2).astype(np.float32),
        morphs={
            name: _by_carrier(np.einsum("vkij,vj->vki", from_mesh[..., :3], deltas_m))
            for name, deltas_m in skin.morphs.items()
        },
    )


def _by_carrier(vectors: FloatArray) -> SingleArray:
    """Convert vectors (V, K, 3) of V vertices and K carriers to (K, 3, V) in single precision."""
    return vectors.transpose(1, 2, 0).astype(np.float32, order="C")


def joints_in_node(world_from_node: FloatArray, world_from_joint: SingleArray) -> SingleArray:
    """Return the matrices ``node_from_joint`` (3, 4, F, J) of J joints in F frames from ``world_from_node`` (F, 4, 4)
    and ``world_from_joint`` (F, 3, J, 4)."""
    node_from_world = np.linalg.inv(world_from_node)[:, :3].astype(np.float32)
    frames, _, joints, _ = world_from_joint.shape
    turned = (node_from_world[:, :, :3] @ world_from_joint.reshape(frames, 3, 4 * joints)).reshape(frames, 3, joints, 4)
    turned[..., 3] += node_from_world[:, :, None, 3]
    return np.ascontiguousarray(turned.transpose(1, 3, 0, 2))


def _through(matrices: SingleArray, at: IndexArray, points_m: SingleArray) -> SingleArray:
    """Transform N points (3, N) by the matrices selected by ``at`` (N,) among M matrices (3, 4, M)."""
    result = np.empty_like(points_m)
    for axis, row in enumerate(matrices):
        # Summed in the order of a matrix product, to reproduce its rounding.
        moved_m = row[0].take(at)
        moved_m *= points_m[0]
        for column in (1, 2):
            turned_m = row[column].take(at)
            turned_m *= points_m[column]
            moved_m += turned_m
        moved_m += row[3].take(at)
        result[axis] = moved_m
    return result


class VertexPoses:
    """Vertices in the frame of a node, with bounds on their movement.

    Parameters
    ----------
    hand : SkinnedVertices
        Vertices of the hand.
    node_from_joint : (3, 4, F, J) float32
        Transforms of J joints in the node's frame, over F frames.
    morphs : dict of str to (F,) float32
        Morph weights.
    """

    def __init__(self, hand: SkinnedVertices, node_from_joint: SingleArray, morphs: Mapping[str, SingleArray]) -> None:
        self.hand, self._node_from_joint, self._morphs = hand, node_from_joint, morphs

    def places_m(self, frames: IndexArray, vertices: IndexArray) -> SingleArray:
        """Return positions (3, N) of vertices (N,) at frames (N,)."""
        hand = self.hand
        result = np.zeros((3, len(frames)), dtype=np.float32)
        matrices = self._node_from_joint.reshape(3, 4, -1)
        for carrier in range(hand.carriers.shape[1]):
            weights = hand.weights[:, carrier].take(vertices)
            rows = np.flatnonzero(weights)
            every = len(rows) == len(vertices)
            vertex, frame = (vertices, frames) if every else (vertices.take(rows), frames.take(rows))
            places_m = hand.places_m[carrier].take(vertex, axis=1)
            for name, curve in self._morphs.items():
                places_m += curve.take(frame) * hand.morphs[name][carrier].take(vertex, axis=1)
            at = frame * len(hand.joints) + hand.carriers[:, carrier].take(vertex)
            moved_m = _through(matrices, at, places_m)
            moved_m *= weights if every else weights.take(rows)
            if every:
                result += moved_m
            else:
                for axis in range(3):
                    result[axis][rows] += moved_m[axis]
        return result

    def moves(self, size: int, blocks: IndexArray) -> Moves:
        """Bound the movement of the joints within blocks of ``size`` frames, relative to the middle frame of each;
        ``blocks`` (B,) are indices of blocks.
        """
        joints = self._node_from_joint.shape[3]
        placed = self._node_from_joint.reshape(3, 4, -1, size, joints)[:, :, blocks]
        moved = placed - placed[:, :, :, size // 2, None]
        curves = {name: curve.reshape(-1, size)[blocks] for name, curve in self._morphs.items()}
        return Moves(
            hand=self.hand,
            chords=_chords(moved).max(axis=1),
            shifts_m=_lengths(moved[:, 3]).max(axis=1),
            greatest={name: np.abs(curve).max(axis=1) for name, curve in curves.items()},
            changes={name: np.abs(curve - curve[:, size // 2, None]).max(axis=1) for name, curve in curves.items()},
        )


@dataclass(frozen=True, eq=False)
class Moves:
    """Bounds on the movement of J joints within each of B blocks of frames, relative to the block's middle frame.

    Attributes
    ----------
    hand : SkinnedVertices
        Vertices carried by the joints.
    chords : (B, J) float32
        Bound on the movement of a point at distance 1 from a joint by its rotation.
    shifts_m : (B, J) float32
        Movement of the joints themselves.
    greatest, changes : dict of str to (B,) float32
        Largest morph weight in each block, and largest change of it.
    """

    hand: SkinnedVertices
    chords: SingleArray
    shifts_m: SingleArray
    greatest: Mapping[str, SingleArray]
    changes: Mapping[str, SingleArray]

    def most_m(self, blocks: IndexArray, vertices: IndexArray) -> SingleArray:
        """Upper bound (N,) in metres on the movement of vertices (N,) within blocks (N,)."""
        hand = self.hand
        result, first = np.zeros(len(blocks), dtype=np.float32), blocks * len(hand.joints)
        chords, shifts_m = self.chords.reshape(-1), self.shifts_m.reshape(-1)
        for carrier in range(hand.carriers.shape[1]):
            weights = hand.weights[:, carrier].take(vertices)
            rows = np.flatnonzero(weights)
            vertex = vertices.take(rows)
            at = first.take(rows) + hand.carriers[:, carrier].take(vertex)
            arms_m, moves_m = hand.arms_m[:, carrier].take(vertex), shifts_m.take(at)
            for name, greatest in self.greatest.items():
                block, lengths_m = blocks.take(rows), _lengths(hand.morphs[name][carrier]).take(vertex)
                arms_m += greatest.take(block) * lengths_m
                moves_m += self.changes[name].take(block) * lengths_m
            moves_m += chords.take(at) * arms_m
            result[rows] += weights.take(rows) * moves_m
        return result


def steadiest(world_from_node: Sequence[FloatArray], world_from_joint: SingleArray) -> int:
    """Index of the node relative to which a hand moves least, measured by the mean position of its J joints (F, 3, J,
    4) over F frames; each node is given by transforms (F, 4, 4).
    """
    middle_m = world_from_joint[..., 3].mean(axis=2, dtype=np.float64)
    ways_m = []
    for here in world_from_node:
        local_m = np.einsum("fji,fj->fi", here[:, :3, :3], middle_m - here[:, :3, 3])
        ways_m.append(np.abs(np.diff(local_m, axis=0)).sum())
    return int(np.argmin(ways_m))


def moving_parts_m(world_from_node: Sequence[FloatArray], base: int, point_m: SingleArray) -> SingleArray:
    """Coordinates (F, M) of a point of the node ``base`` in the frames of those nodes that move relative to ``base``,
    three columns for each such node; nodes are given by transforms (F, 4, 4).
    """
    world_m = world_from_node[base][:, :3] @ np.append(point_m, 1.0)
    moving = [np.empty((0, len(world_m)), dtype=np.float32)]
    for node, here in enumerate(world_from_node):
        local_m = np.einsum("fji,fj->if", here[:, :3, :3], world_m - here[:, :3, 3])
        ranges_m = np.ptp(local_m, axis=1)
        if node != base and ranges_m.max() > MOVES_M:
            moving.append(local_m[None, np.argmax(ranges_m)].astype(np.float32))
    return np.concatenate(moving).T


class Parts:
    """Positions of an instrument's nodes in the frame of one of them.

    Parameters
    ----------
    world_from_node : sequence of (F, 4, 4) float64
        Transforms by node.
    base : int
        Index of the base node.
    reaches_m : (N,) float64
        Distance of the farthest point from each node's origin.
    """

    def __init__(self, world_from_node: Sequence[FloatArray], base: int, reaches_m: FloatArray) -> None:
        first = world_from_node[base]
        node_from_base = np.empty((3, 4, len(world_from_node), len(first)), dtype=np.float32)
        for node, here in enumerate(world_from_node):
            back = here[:, :3, :3].transpose(0, 2, 1)
            node_from_base[:, :3, node] = (back @ first[:, :3, :3]).transpose(1, 2, 0)
            node_from_base[:, 3, node] = np.einsum("fij,fj->if", back, first[:, :3, 3] - here[:, :3, 3])
        self._node_from_base = node_from_base
        self._reaches_m = reaches_m.astype(np.float32)

    def moves(self, size: int) -> PartMoves:
        """Bound the movement of the nodes within blocks of ``size`` frames, relative to each block's middle frame."""
        nodes, frames = self._node_from_base.shape[2:]
        placed = self._node_from_base.reshape(3, 4, nodes, frames // size, size)
        middle = placed[..., size // 2]
        if size == 1:
            still = np.zeros(middle.shape[2:], dtype=np.float32)
            return PartMoves(size, middle, still, still, self._reaches_m)
        origin_m = -np.einsum("jinb,jnb->inb", middle[:, :3], middle[:, 3])
        shifts_m = _lengths(np.einsum("ijnbs,jnb->inbs", placed[:, :3], origin_m) + placed[:, 3])
        chords = _chords(placed[:, :3] - middle[:, :3, ..., None])
        return PartMoves(size, np.ascontiguousarray(middle), chords.max(axis=2), shifts_m.max(axis=2), self._reaches_m)


@dataclass(frozen=True, eq=False)
class PartMoves:
    """Bounds on the movement of N nodes within each of B blocks of frames, relative to the block's middle frame.

    Attributes
    ----------
    size : int
        Frames per block.
    node_from_base : (3, 4, N, B) float32
        Transforms in the middle frames.
    chords : (N, B) float32
        Bound on the movement of a point at distance 1 from a node's origin by its rotation.
    shifts_m : (N, B) float32
        Movement of the origins.
    reaches_m : (N,) float32
        Distance of the farthest point from a node's origin.
    """

    size: int
    node_from_base: SingleArray
    chords: SingleArray
    shifts_m: SingleArray
    reaches_m: SingleArray

    def placed(self, blocks: IndexArray, nodes: IndexArray, base_m: SingleArray, moves_m: SingleArray) -> NodePoints:
        """Transform points to the frames of nodes (N,) in the middle of blocks (N,).

        Parameters
        ----------
        base_m : (3, N) float32
            Points in the frame of the base node.
        moves_m : (N,) float32
            Movement of the points there within their block.
        """
        at = nodes * self.chords.shape[1] + blocks
        places_m = _through(self.node_from_base.reshape(3, 4, -1), at, base_m)
        lengths_m, reaches_m = _lengths(places_m), self.reaches_m.take(nodes)
        # The distance of any point changes by no more than the movement of the node.
        turns_m = self.chords.reshape(-1).take(at) * np.minimum(lengths_m, reaches_m)
        return NodePoints(places_m, moves_m + self.shifts_m.reshape(-1).take(at), turns_m, lengths_m - reaches_m)


@dataclass(frozen=True, eq=False)
class NodePoints:
    """N points of a hand in the frames of instrument nodes at the middle frame of a block, with bounds on how much
    their distance from the node's bodies changes within the block.

    Attributes
    ----------
    places_m : (3, N) float32
        Positions in metres.
    shifts_m, turns_m : (N,) float32
        Largest change of the distance from the node's bodies: by shifts, and by the node's rotation.
    beyond_m : (N,) float32
        Distance of the point beyond the node's reach, regardless of its rotation.
    """

    places_m: SingleArray
    shifts_m: SingleArray
    turns_m: SingleArray
    beyond_m: SingleArray

    def __getitem__(self, rows: BoolArray) -> NodePoints:
        return NodePoints(self.places_m[:, rows], self.shifts_m[rows], self.turns_m[rows], self.beyond_m[rows])

    @property
    def moves_m(self) -> SingleArray:
        """Largest change (N,) of each point's distance within the block of frames, in metres."""
        return self.shifts_m + self.turns_m

    def least_m(self, middle_m: SingleArray) -> SingleArray:
        """Lower bounds (N,) of the points' distances from the bodies over a whole block, given lower bounds in its
        middle frame.
        """
        least_m: SingleArray = np.maximum(middle_m - self.turns_m, self.beyond_m) - self.shifts_m
        return least_m


def _chords(changes: SingleArray) -> SingleArray:
    """Bound on the movement of a point at distance 1 from the origin, given the ``changes`` (3, 3 or more, ...) of a
    rotation matrix.
    """
    # A rotation moves a point by at most the chord, 2 sin(angle / 2) times its radius.
    square = np.zeros(changes.shape[2:], dtype=np.float32)
    for row in changes:
        for change in row[:3]:
            square += change * change
    chords: SingleArray = np.sqrt(square / np.float32(2.0))
    return chords


def _lengths(vectors: SingleArray) -> SingleArray:
    """Lengths of vectors (3, ...)."""
    x, y, z = vectors
    lengths_m: SingleArray = np.sqrt(x * x + y * y + z * z)
    return lengths_m
