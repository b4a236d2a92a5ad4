"""Where vertices of a hand are in the frames of an instrument's nodes, and how far they move.

For `app.contacts.depths`: all in single precision, and over whole arrays of vertices and frames.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.rig.skinning import Skin

FloatArray = npt.NDArray[np.float64]
SingleArray = npt.NDArray[np.float32]
IntArray = npt.NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Carried:
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


def carried(skin: Skin) -> Carried:
    """The vertices of a skin."""
    count = int(np.count_nonzero(skin.weights, axis=1).max())
    carriers = np.argsort(-skin.weights, axis=1, kind="stable")[:, :count]
    from_mesh = skin.joint_from_mesh[carriers]
    places_m = np.einsum("vkij,vj->vki", from_mesh[..., :3], skin.positions_m) + from_mesh[..., 3]
    return Carried(
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


def joints_in_node(world_from_node: FloatArray, world_from_joint: SingleArray) -> SingleArray:
    """``node_from_joint`` (F, J, 3, 4) of ``world_from_node`` (F, 4, 4) and ``world_from_joint`` (F, 3, J, 4)."""
    node_from_world = np.linalg.inv(world_from_node)[:, :3].astype(np.float32)
    frames, _, joints, _ = world_from_joint.shape
    turned = (node_from_world[:, :, :3] @ world_from_joint.reshape(frames, 3, 4 * joints)).reshape(frames, 3, joints, 4)
    turned[..., 3] += node_from_world[:, :, None, 3]
    return np.ascontiguousarray(turned.transpose(0, 2, 1, 3))


class Poses:
    """Where vertices are in the frame of a node, and how far they move.

    Parameters
    ----------
    hand : Carried
    node_from_joint : (F, J, 3, 4) float32
    morphs : dict of str to (F,) float32
        Weights.
    """

    def __init__(self, hand: Carried, node_from_joint: SingleArray, morphs: Mapping[str, SingleArray]) -> None:
        self._hand, self._node_from_joint, self._morphs = hand, node_from_joint, morphs

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

    def moves(self, size: int, blocks: IntArray) -> Moves:
        """How far joints move from the middle frames of some blocks (B,) of a size."""
        placed = self._node_from_joint.reshape(-1, size, *self._node_from_joint.shape[1:])[blocks]
        moved = placed - placed[:, size // 2, None]
        curves = {name: curve.reshape(-1, size)[blocks] for name, curve in self._morphs.items()}
        return Moves(
            hand=self._hand,
            chords=_chords(moved[..., :3]).max(axis=1),
            shifts_m=_lengths(moved[..., 3]).max(axis=1),
            greatest={name: np.abs(curve).max(axis=1) for name, curve in curves.items()},
            changes={name: np.abs(curve - curve[:, size // 2, None]).max(axis=1) for name, curve in curves.items()},
        )


@dataclass(frozen=True, eq=False)
class Moves:
    """How far joints move from the middle frame of each block.

    Attributes
    ----------
    hand : Carried
    chords : (B, J) float32
        What is 1 from a joint is moved by its turning by no more.
    shifts_m : (B, J) float32
        Of the joints themselves.
    greatest, changes : dict of str to (B,) float32
        Weights of the morphs, and their changes.
    """

    hand: Carried
    chords: SingleArray
    shifts_m: SingleArray
    greatest: Mapping[str, SingleArray]
    changes: Mapping[str, SingleArray]

    def most_m(self, blocks: IntArray, vertices: IntArray) -> SingleArray:
        """What vertices (N,) move at most in blocks (N,)."""
        hand = self.hand
        result, first = np.zeros(len(blocks), dtype=np.float32), blocks * len(hand.joints)
        for carrier in range(hand.carriers.shape[1]):
            rows = np.flatnonzero(hand.weights[:, carrier].take(vertices))
            block, vertex = blocks[rows], vertices[rows]
            at = first[rows] + hand.carriers[:, carrier].take(vertex)
            arms_m, moves_m = hand.arms_m[:, carrier].take(vertex), self.shifts_m.reshape(-1).take(at)
            for name, greatest in self.greatest.items():
                lengths_m = _lengths(hand.morphs[name][vertex, carrier])
                arms_m += greatest[block] * lengths_m
                moves_m += self.changes[name][block] * lengths_m
            moves_m += self.chords.reshape(-1).take(at) * arms_m
            result[rows] += hand.weights[:, carrier].take(vertex) * moves_m
        return result


def steadiest(world_from_node: Sequence[FloatArray], world_from_joint: SingleArray) -> int:
    """The node (each (F, 4, 4)) in whose frame the middle of some joints (F, 3, J, 4) moves least."""
    middle_m = world_from_joint[..., 3].mean(axis=2, dtype=np.float64)
    ways_m = []
    for here in world_from_node:
        local_m = np.einsum("fji,fj->fi", here[:, :3, :3], middle_m - here[:, :3, 3])
        ways_m.append(np.abs(np.diff(local_m, axis=0)).sum())
    return int(np.argmin(ways_m))


class Parts:
    """Where the nodes of an instrument are in the frame of one of them.

    Parameters
    ----------
    world_from_node : sequence of (F, 4, 4) float64
        By node.
    base : int
        That node.
    reaches_m : (N,) float64
        How far from its origin a node has anything.
    """

    def __init__(self, world_from_node: Sequence[FloatArray], base: int, reaches_m: FloatArray) -> None:
        first = world_from_node[base]
        node_from_base = np.empty((len(world_from_node), len(first), 3, 4), dtype=np.float32)
        for node, here in enumerate(world_from_node):
            back = here[:, :3, :3].transpose(0, 2, 1)
            node_from_base[node, ..., :3] = back @ first[:, :3, :3]
            node_from_base[node, ..., 3] = np.einsum("fij,fj->fi", back, first[:, :3, 3] - here[:, :3, 3])
        self._node_from_base = node_from_base
        self._reaches_m = reaches_m.astype(np.float32)

    def moves(self, size: int) -> PartMoves:
        """How far nodes move from the middle frames of blocks of a size."""
        nodes, frames = self._node_from_base.shape[:2]
        placed = self._node_from_base.reshape(nodes, frames // size, size, 3, 4)
        middle = placed[:, :, size // 2]
        if size == 1:
            still = np.zeros(middle.shape[:2], dtype=np.float32)
            return PartMoves(size, middle, still, still, self._reaches_m)
        origin_m = -np.einsum("nbji,nbj->nbi", middle[..., :3], middle[..., 3])
        shifts_m = _lengths(np.einsum("nbsij,nbj->nbsi", placed[..., :3], origin_m) + placed[..., 3])
        chords = _chords(placed[..., :3] - middle[:, :, None, :, :3])
        return PartMoves(size, middle, chords.max(axis=2), shifts_m.max(axis=2), self._reaches_m)


@dataclass(frozen=True, eq=False)
class PartMoves:
    """How far nodes move from the middle frame of each block.

    Attributes
    ----------
    size : int
        Frames of a block.
    node_from_base : (N, B, 3, 4) float32
        In the middle frames.
    chords : (N, B) float32
        What is 1 from a node's origin is moved by its turning by no more.
    shifts_m : (N, B) float32
        Of the origins themselves.
    reaches_m : (N,) float32
        How far from its origin a node has anything.
    """

    size: int
    node_from_base: SingleArray
    chords: SingleArray
    shifts_m: SingleArray
    reaches_m: SingleArray

    def placed(self, blocks: IntArray, nodes: IntArray, base_m: SingleArray, moves_m: SingleArray) -> Placed:
        """Place points in the frames of nodes (N,) in the middle of blocks (N,).

        Parameters
        ----------
        base_m : (N, 3) float32
            Points in the frame of the base.
        moves_m : (N,) float32
            How far they move there within their block.
        """
        at = nodes * self.chords.shape[1] + blocks
        matrix = self.node_from_base.reshape(-1, 3, 4).take(at, axis=0)
        places_m = np.einsum("nij,nj->ni", matrix[..., :3], base_m) + matrix[..., 3]
        lengths_m, reaches_m = _lengths(places_m), self.reaches_m.take(nodes)
        # However far a point is, its distance changes by no more than what the node has moves.
        turns_m = self.chords.reshape(-1).take(at) * np.minimum(lengths_m, reaches_m)
        return Placed(places_m, moves_m + self.shifts_m.reshape(-1).take(at), turns_m, lengths_m - reaches_m)


@dataclass(frozen=True, eq=False)
class Placed:
    """Points in the frames of nodes in the middle of blocks, and what their distances change within.

    Attributes
    ----------
    places_m : (N, 3) float32
    shifts_m, turns_m : (N,) float32
        How much the distance from the node's bodies changes at most: by shifts, and by the node's turning.
    beyond_m : (N,) float32
        How far the point is beyond the node's reach, however that turns.
    """

    places_m: SingleArray
    shifts_m: SingleArray
    turns_m: SingleArray
    beyond_m: SingleArray

    def __getitem__(self, rows: npt.NDArray[np.bool_]) -> Placed:
        return Placed(self.places_m[rows], self.shifts_m[rows], self.turns_m[rows], self.beyond_m[rows])

    @property
    def moves_m(self) -> SingleArray:
        """How much the distance changes within the block at most."""
        return self.shifts_m + self.turns_m

    def least_m(self, middle_m: SingleArray) -> SingleArray:
        """Distances (N,) in the whole block, or less, of distances in its middle, or less."""
        least_m: SingleArray = np.maximum(middle_m - self.turns_m, self.beyond_m) - self.shifts_m
        return least_m


def _chords(changes: SingleArray) -> SingleArray:
    """What is 1 from the origin is moved by these changes (..., 3, 3) of a rotation by no more."""
    # A turn by an angle moves it by the chord, 2 sin(angle / 2), at most.
    chords: SingleArray = np.sqrt(np.einsum("...ij,...ij->...", changes, changes) / np.float32(2.0))
    return chords


def _lengths(vectors: SingleArray) -> SingleArray:
    """Lengths of vectors (..., 3)."""
    lengths_m: SingleArray = np.sqrt(np.einsum("...i,...i->...", vectors, vectors))
    return lengths_m
