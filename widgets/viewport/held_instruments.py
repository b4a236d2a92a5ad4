"""Transforms of all instruments and their moving parts, computed together.

The motion of nodes in the maps is stored in arrays once, so that thirty kinds of instruments take no longer than one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.model import InstrumentModel
from instrument_maps.model import InstrumentMap, MovingPart

NOWHERE_M = (0.0, 0.0, 0.0)


class Instruments:
    """The instruments of all N performers on a stage, with all their moving parts concatenated.

    Parameters
    ----------
    kits : sequence of (InstrumentModel, InstrumentMap) or None
        Instrument of every row; None for a performer without one.

    Attributes
    ----------
    nodes : int
        Greatest number of nodes of a model.
    """

    def __init__(self, kits: Sequence[tuple[InstrumentModel, InstrumentMap] | None]) -> None:
        self.nodes = max((len(assets[0].node_names) for assets in kits if assets is not None), default=0)
        self._names = [
            ()
            if assets is None
            else tuple(dict.fromkeys(name for part in assets[1].moving_parts for name in part.controls))
            for assets in kits
        ]
        starts = np.cumsum([0, *(len(names) for names in self._names)])
        self._own = [slice(int(start), int(end)) for start, end in pairwise(starts)]
        self._values = np.zeros(int(starts[-1]))
        rows: list[int] = []
        nodes: list[int] = []
        controls: list[list[int]] = []
        parts: list[MovingPart] = []
        for row, assets in enumerate(kits):
            if assets is None:
                continue
            model, instrument = assets
            for part in instrument.moving_parts:
                rows.append(row)
                nodes.append(model.node_names.index(part.node))
                controls.append([int(starts[row]) + self._names[row].index(name) for name in part.controls])
                parts.append(part)
        self._rows, self._nodes = np.array(rows, np.intp), np.array(nodes, np.intp)
        most = max((len(own) for own in controls), default=1)
        # A part with fewer controls is moved by its first one again, with no effect.
        padded = [own + own[:1] * (most - len(own)) for own in controls]
        self._controls = np.array(padded, np.intp).reshape(-1, most)
        self._all_needed = np.array([part.when == "all" for part in parts], dtype=bool)
        motions = [part.motion for part in parts]
        self._axes = np.array([motion.axis for motion in motions], np.float64).reshape(-1, 3)
        self._angles_rad = np.array([motion.angle_rad or 0.0 for motion in motions])
        self._pivots_m = np.array([motion.pivot_m or NOWHERE_M for motion in motions], np.float64).reshape(-1, 3)
        self._travels_m = self._axes * np.array([motion.travel_m or 0.0 for motion in motions])[:, None]

    def work(self, row: int, controls: Mapping[str, float]) -> None:
        """Set the values 0..1 of the controls of the instrument in ``row``; missing ones are at 0."""
        self._values[self._own[row]] = [controls.get(name, 0.0) for name in self._names[row]]

    def matrices(self, held: FloatArray) -> FloatArray:
        """Return the transforms ``world_from_rest`` (N, nodes, 3, 4) of all nodes for ``world_from_instrument`` (N, 3,
        4).
        """
        result = np.empty((len(held), self.nodes, 3, 4))
        result[:] = held[:, None]
        asked = self._values[self._controls]
        values = np.where(self._all_needed, asked.min(axis=1), asked.max(axis=1))
        turns = quaternion.to_matrix(quaternion.from_axis_angle(self._axes, values * self._angles_rad))
        # About the pivot and along the path: a part has one of both.
        moved_m = self._pivots_m - (turns @ self._pivots_m[:, :, None])[..., 0] + values[:, None] * self._travels_m
        owners = held[self._rows]
        result[self._rows, self._nodes, :, :3] = owners[..., :3] @ turns
        result[self._rows, self._nodes, :, 3] = (owners[..., :3] @ moved_m[:, :, None])[..., 0] + owners[..., 3]
        return result
