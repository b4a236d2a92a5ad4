"""Depth of hands in closed bodies, group by group and body by body: a reference for the faster method of the program.
Vertices are grouped, and only groups near a body are examined vertex by vertex; this is exact, because a group's
vertices stay within its radius.

Vertices are grouped, and only groups whose middle is near enough to a body are looked at vertex by vertex: nothing is
left out, because a group's vertices stay within its radius.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, FloatArray
from app.rig.grip.instrument_proxy import signed_distance
from app.rig.skinning import Skin
from instrument_maps.hold import Proxy

GROUP = 8
"""Approximate number of vertices per group."""
BLOCK = 32
"""Number of frames examined together."""
STRETCH = 1.3
"""Factor by which the distance of a vertex from its group's centre in the bind pose may grow when the hand bends."""


@dataclass(frozen=True, eq=False)
class _Group:
    members: AnyIntArray
    """Indices of the hand's vertices."""
    middle: int
    radius_m: float


class GroupedDepths:
    """Skin of a hand and the bodies that it must not penetrate.

    Parameters
    ----------
    hand : Skin
        Of hand and fingers.
    bodies : sequence of Proxy
    """

    def __init__(self, hand: Skin, bodies: Sequence[Proxy]) -> None:
        self._by_node: dict[str, list[Proxy]] = {}
        for body in bodies:
            self._by_node.setdefault(body.node, []).append(body)
        strongest = np.argmax(hand.weights, axis=1)
        groups = [
            _group(rows, hand.positions_m)
            for joint in np.unique(strongest)
            for rows in _split(np.flatnonzero(strongest == joint), hand.positions_m)
        ]
        self._radii_m = np.array([group.radius_m for group in groups])
        self._middles = hand.part(np.array([group.middle for group in groups]))
        self._members = [hand.part(group.members) for group in groups]

    def depths_m(
        self,
        world_from_joint: FloatArray,
        morphs: Mapping[str, AnyFloatArray],
        world_from_node: Mapping[str, FloatArray],
    ) -> FloatArray:
        """Greatest depth of any vertex in any body at each of some frames.

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
        deepest = np.zeros(len(world_from_joint))
        middles = self._middles.deformed(world_from_joint, morphs)
        node_from_world = {node: np.linalg.inv(world_from_node[node]) for node in self._by_node}
        found = [
            (float(possible.max()), group, body, possible)
            for node, bodies in self._by_node.items()
            for blocks in [_Blocks(_moved(node_from_world[node], middles))]
            for body in bodies
            for group, possible in blocks.possible_depths(body, self._radii_m)
        ]
        points: dict[int, FloatArray] = {}
        # The probably deepest groups come first; those that cannot be deeper than the result are skipped.
        for _, group, body, possible in sorted(found, key=lambda item: -item[0]):
            frames = possible > deepest
            if not frames.any():
                continue
            if group not in points:
                points[group] = self._members[group].deformed(world_from_joint, morphs)
            local = _moved(node_from_world[body.node][frames], points[group][frames])
            deepest[frames] = np.maximum(deepest[frames], -signed_distance(body, local).min(axis=1))
        return deepest


class _Blocks:
    """Positions of points (n, G, 3) for blocks of frames: hands hardly move relative to what they hold, so one test of
    a point's centre can exclude a whole block.
    """

    def __init__(self, places: AnyFloatArray) -> None:
        self._frames = len(places)
        padding = -self._frames % BLOCK
        padded = np.concatenate([places, np.repeat(places[-1:], padding, axis=0)])
        self._places = padded.reshape(-1, BLOCK, *places.shape[1:])
        low, high = self._places.min(axis=1), self._places.max(axis=1)
        self._middle = (low + high) / 2.0
        self._wander = np.linalg.norm(high - low, axis=-1) / 2.0

    def possible_depths(self, body: Proxy, radii: FloatArray) -> Iterator[tuple[int, FloatArray]]:
        """Yield for each point near a body its index and the greatest possible depth (n,) in the body of anything
        within the point's radius (G,).
        """
        # A distance changes by no more than the point moves, so nothing within reach is passed over.
        close = signed_distance(body, self._middle) < radii + self._wander
        block, point = np.nonzero(close)
        if not len(block):
            return
        depths = radii[point, None] - signed_distance(body, self._places[block, :, point])
        for index in np.unique(point).tolist():
            rows = point == index
            possible = np.zeros(close.shape[0] * BLOCK)
            possible.reshape(-1, BLOCK)[block[rows]] = depths[rows]
            if (possible[: self._frames] > 0.0).any():
                yield index, possible[: self._frames]


def _moved(matrices: AnyFloatArray, points: AnyFloatArray) -> AnyFloatArray:
    """Transform points (n, V, 3) by matrices (n, 4, 4)."""
    return points @ matrices[:, :3, :3].swapaxes(1, 2) + matrices[:, None, :3, 3]


def _split(rows: AnyIntArray, positions_m: FloatArray) -> list[AnyIntArray]:
    """Halve groups along their longest side until they are small."""
    if len(rows) <= GROUP:
        return [rows]
    extent = np.ptp(positions_m[rows], axis=0)
    order = rows[np.argsort(positions_m[rows, int(np.argmax(extent))], kind="stable")]
    half = len(order) // 2
    return _split(order[:half], positions_m) + _split(order[half:], positions_m)


def _group(rows: AnyIntArray, positions_m: FloatArray) -> _Group:
    points = positions_m[rows]
    middle = int(np.argmin(np.linalg.norm(points - points.mean(axis=0), axis=1)))
    radius_m = float(np.linalg.norm(points - points[middle], axis=1).max()) * STRETCH
    return _Group(rows, int(rows[middle]), radius_m)
