"""Straps and chair of a musician combined: one set of bones, and one mesh for each kind of strap or chair."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import FloatArray
from app.rig.model import Character
from app.rig.supports.chair import CHAIR, ChairFit, chair
from app.rig.supports.model import Hook, SupportBone, Supports
from app.rig.supports.straps import MadeStrap, Sitter, Wearer, made_strap
from app.rig.supports.taut_string import posed_trunk
from instrument_maps.hold import SupportKind
from metadata.model import BREATH_MORPHS

_FULL_OF_AIR = dict.fromkeys(BREATH_MORPHS, 1.0)


@dataclass(frozen=True, eq=False)
class Asked:
    """Request for a strap.

    Attributes
    ----------
    kind : SupportKind
        Kind of strap.
    hooks : tuple of Hook
        Places on the musician's instruments where it is hooked in.
    hook_m, low_m : (3,) float64
        Position of the first of them in the player's frame, with the instrument played and with it lowered.
    """

    kind: SupportKind
    hooks: tuple[Hook, ...]
    hook_m: FloatArray
    low_m: FloatArray


def made_supports(
    character: Character, joints: FloatArray, asked: Sequence[Asked], fit: ChairFit | None
) -> Supports | None:
    """Make straps and chair for a body in a pose.

    Parameters
    ----------
    joints : (J, 3, 4) float64
        ``world_from_joint`` in the player's frame.
    asked : sequence of Asked
        Requested straps.
    fit : ChairFit or None
        Chair; None if the player stands.

    Returns
    -------
    Supports or None
        None if there are neither straps nor a chair.
    """
    sitter = None if fit is None else Sitter(fit.middle_m, fit.half_width_m)
    made = list[MadeStrap]()
    if asked:
        wearer = Wearer(character.skeleton, joints, posed_trunk(character, joints, _FULL_OF_AIR), sitter)
        for one in asked:
            strap = made_strap(one.kind, wearer, one.hooks, (one.hook_m, one.low_m), len(made))
            made += [] if strap is None else [strap]
    names = character.skeleton.names
    bones: dict[str, SupportBone] = {}
    meshes = []
    for strap in made:
        numbers = []
        for bone in strap.bones:
            name = bone.name or names[bone.joint]
            place_m = joints[bone.joint, :, 3] if bone.role == "joint" else bone.place_m
            bones.setdefault(name, replace(bone, name=name, place_m=place_m))
            numbers.append([*bones].index(name))
        meshes.append(replace(strap.mesh, joints=np.array(numbers, np.int32)[strap.mesh.joints]))
    if fit is not None:
        bones[CHAIR] = SupportBone(CHAIR, "still", np.array([0.0, 0.0, fit.middle_m[2]]))
        meshes.append(chair(fit, len(bones) - 1))
    if not meshes:
        return None
    kinds = tuple(mesh.name for mesh in meshes)
    return Supports(kinds, tuple(meshes), tuple(bones.values()), tuple(one.strap for one in made), joints)
