"""Hands that consist of several bones, one for each finger from the wrist on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from app.rig.characters.bone_placements import world_placements
from app.rig.figure import Figure

AT_ONE_PLACE: Final = 0.01
"""Distance, relative to the forearm, below which bones begin at the same place."""


def bones_beside_hands(figure: Figure, bones: Mapping[str, int]) -> dict[int, str]:
    """Return the joint (left or right hand) of each additional bone that belongs to a hand, by bone.

    Such a bone begins at the place of the hand's mapped bone and has the same parent, as in a hand with a bone for each
    finger from the wrist on.

    Parameters
    ----------
    bones : mapping of str to int
        Bones by VRM 1.0 joint.
    """
    places, _ = world_placements(figure.parents, figure.translations_m, figure.rotations)
    mapped, found = set(bones.values()), dict[int, str]()
    for joint, arm in ((f"{side}Hand", bones.get(f"{side}LowerArm")) for side in ("left", "right")):
        hand = bones.get(joint)
        if hand is None or arm is None:
            continue
        near = AT_ONE_PLACE * float(np.linalg.norm(places[hand] - places[arm]))
        for bone in set(figure.parents) - mapped - {-1}:
            if figure.parents[bone] == figure.parents[hand] and np.linalg.norm(places[bone] - places[hand]) < near:
                found[bone] = joint
    return found
