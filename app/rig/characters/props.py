"""Detection of props in a figure's hands (swords, shields, cups), which are in the way of an instrument.

A mesh counts as a prop if it moves with a hand as a whole, while the hand has another mesh. Moreover, it must be
attached to a bone that is not a joint, or be longer than any hand.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from app.arrays import BoolArray
from app.rig.figure import Figure
from app.rig.mesh import Mesh

WHOLLY: Final = 0.999
"""Least weight of every vertex for the bones of one hand."""
REACHES: Final = 1.2
"""Length above which a mesh is a prop, relative to the forearm."""
LEAST_SKIN: Final = 8
"""Least number of vertices of a hand's own skin."""


def props_in_hands(figure: Figure, joints: Mapping[str, int]) -> tuple[str, ...]:
    """Return the names of the meshes that are held props.

    Parameters
    ----------
    joints : mapping of str to int
        Bones by VRM 1.0 joint.

    Returns
    -------
    tuple of str
        Names of meshes, in the file's order.
    """
    found: set[str] = set()
    for side in ("left", "right"):
        wrist, elbow = joints.get(f"{side}Hand"), joints.get(f"{side}LowerArm")
        if wrist is None or elbow is None:
            continue
        of_hand = _below(figure, wrist)
        slots = of_hand & ~np.isin(np.arange(len(of_hand)), list(joints.values()))
        candidates = {mesh.name for mesh in figure.meshes if _held(mesh, of_hand).min(initial=1.0) >= WHOLLY}
        skin = sum(int((_held(mesh, of_hand) > 0.5).sum()) for mesh in figure.meshes if mesh.name not in candidates)
        if skin < LEAST_SKIN:
            continue
        forearm_m = float(np.linalg.norm(figure.translations_m[wrist]))
        for mesh in figure.meshes:
            if mesh.name in candidates and len(mesh.positions_m):
                in_slot = _held(mesh, slots).min() >= WHOLLY
                if in_slot or float(np.ptp(mesh.positions_m, axis=0).max()) > REACHES * forearm_m:
                    found.add(mesh.name)
    names = dict.fromkeys(mesh.name for mesh in figure.meshes)
    return tuple(name for name in names if name in found) if len(found) < len(names) else ()


def _below(figure: Figure, bone: int) -> BoolArray:
    """Return a mask (B,) of the bones that are a given bone or its descendants."""
    below = np.zeros(len(figure.parents), dtype=np.bool_)
    below[bone] = True
    for other, parent in enumerate(figure.parents):
        if parent >= 0 and below[parent]:
            below[other] = True
    return below


def _held(mesh: Mesh, bones: BoolArray) -> np.ndarray:
    """Return for each vertex (V,) of a mesh the sum of its weights on the bones in a mask (B,)."""
    weights: np.ndarray = np.where(bones[mesh.joints], mesh.weights, 0.0).sum(axis=1)
    return weights
