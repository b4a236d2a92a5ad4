"""Comparison of an export's skeleton with that of an Unreal asset, bone by bone.

Unreal matches bones by name. Another root name, parent or unit of length corrupts an animation, and animation of bones
missing in the asset is dropped silently: these differences are severe, all others informative.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final, Literal, TypeAlias

import msgspec
import numpy as np

from app.errors import Message
from app.export.own_skeleton import has_armature
from app.export.target import TargetSkeleton
from app.rig import quaternion
from app.rig.figure import Figure

DifferenceKind: TypeAlias = Literal[
    "root", "unit", "parent", "additional", "requested", "missing", "rotation", "position"
]

MOST_LISTED: Final = 8
"""Greatest number of bones named in a message about several bones; the report names all."""
POSITION_MM: Final = 0.5
ROTATION_DEG: Final = 0.1
_MEASURED: Final[dict[str, str]] = {"position": "skeleton.position", "rotation": "skeleton.rotation"}
_COUNTED: Final[dict[str, str]] = {kind: f"skeleton.{kind}" for kind in ("additional", "requested", "missing")}
UNIT: Final = (0.2, 5.0)
"""Ratios of lengths beyond which a difference is attributed to another unit instead of another body."""


class SkeletonDifference(msgspec.Struct, frozen=True):
    """A difference between the export's skeleton and an asset's.

    Attributes
    ----------
    kind : DifferenceKind
        Kind of difference, such as a missing bone.
    bone : str
        Name of the bone; empty if it concerns the whole skeleton.
    severe : bool
        Whether the animation would be dropped or corrupted.
    ours, theirs : str
        Name of the root or parent on either side; empty for other kinds.
    amount : float
        Difference in millimetres or degrees, or the factor of lengths; 0 for other kinds.
    """

    kind: DifferenceKind
    bone: str
    severe: bool
    ours: str = ""
    theirs: str = ""
    amount: float = 0.0


def check_skeleton(target: TargetSkeleton, asset: Figure) -> tuple[SkeletonDifference, ...]:
    """Return the differences between the skeleton of an export and that of an asset, most severe first.

    Parameters
    ----------
    target : TargetSkeleton
        Skeleton of the export.
    asset : Figure
        The asset as in its file.
    """
    asset = without_armature(asset)
    ours = {name: bone for bone, name in enumerate(target.names)}
    theirs = {name: bone for bone, name in enumerate(asset.bone_names)}
    moved = {target.names[bone] for bone in target.moved}
    found = [*_roots(target, asset), *_unit(target, asset)]
    requested = {target.names[bone] for bone in target.added}
    # Added joints are the eyes, which do not move if shapes turn them.
    still = {target.names[bone] for bone in target.added if target.joint_of_bone[bone] >= 0 and target.eyes == "shapes"}
    found += [
        SkeletonDifference("requested", name, severe=False)
        if name in requested
        else SkeletonDifference("additional", name, name in moved)
        for name in target.names
        if name not in theirs and name not in still
    ]
    found += [SkeletonDifference("missing", name, severe=False) for name in asset.bone_names if name not in ours]
    for name in (name for name in target.names if name in theirs):
        bone, other = ours[name], theirs[name]
        above, other_above = target.parents[bone], asset.parents[other]
        our_parent = target.names[above] if above >= 0 else ""
        their_parent = asset.bone_names[other_above] if other_above >= 0 else ""
        if our_parent != their_parent:
            # Differences at roots, and parents with other names, are reported elsewhere.
            if our_parent and their_parent and (our_parent in theirs or their_parent in ours):
                found.append(SkeletonDifference("parent", name, severe=True, ours=our_parent, theirs=their_parent))
            continue
        off_mm = 1000.0 * float(np.linalg.norm(target.offsets_m[bone] - asset.translations_m[other]))
        # The motion positions the hips whatever their rest; so are bones that follow something else.
        if off_mm > POSITION_MM and bone not in target.loose:
            found.append(SkeletonDifference("position", name, severe=False, amount=round(off_mm, 2)))
        turn = quaternion.multiply(quaternion.conjugate(asset.rotations[other]), target.rest[bone])
        off_deg = float(np.degrees(np.linalg.norm(quaternion.to_rotation_vector(turn))))
        if off_deg > ROTATION_DEG:
            found.append(SkeletonDifference("rotation", name, severe=False, amount=round(off_deg, 2)))
    return tuple(sorted(found, key=lambda difference: not difference.severe))


def without_armature(asset: Figure) -> Figure:
    """Return an asset as Unreal imports it: without Blender's armature object as root."""
    if not has_armature(asset):
        return asset
    translations, rotations = asset.translations_m[1:].copy(), asset.rotations[1:].copy()
    translations[0] = asset.translations_m[0] + quaternion.rotate(asset.rotations[0], translations[0])
    rotations[0] = quaternion.multiply(asset.rotations[0], rotations[0])
    return replace(
        asset,
        bone_names=asset.bone_names[1:],
        parents=tuple(parent - 1 for parent in asset.parents[1:]),
        translations_m=translations,
        rotations=rotations,
        meshes=(),
    )


def reported(differences: Sequence[SkeletonDifference]) -> tuple[Message, ...]:
    """Return messages about differences, most severe first: for each kind the number and names of its bones, or the
    largest difference.
    """
    messages = [
        _severe(difference) for difference in differences if difference.severe and difference.kind != "additional"
    ]
    lost = [difference for difference in differences if difference.severe and difference.kind == "additional"]
    if lost:
        messages.append(Message("skeleton.not_in_asset", {"count": len(lost), "bones": _listed(lost)}))
    mild = [difference for difference in differences if not difference.severe]
    for kind in dict.fromkeys(difference.kind for difference in mild):
        alike = [difference for difference in mild if difference.kind == kind]
        most = max(alike, key=lambda difference: difference.amount)
        if kind in _MEASURED:
            messages.append(Message(_MEASURED[kind], {"count": len(alike), "most": most.amount, "bone": most.bone}))
        else:
            messages.append(Message(_COUNTED[kind], {"count": len(alike), "bones": _listed(alike)}))
    return tuple(messages)


def _listed(differences: Sequence[SkeletonDifference]) -> str:
    names = [difference.bone for difference in differences]
    return ", ".join(names[:MOST_LISTED]) + (", ..." if len(names) > MOST_LISTED else "")


def _severe(difference: SkeletonDifference) -> Message:
    if difference.kind == "unit":
        return Message("skeleton.other_unit", {"factor": difference.amount})
    if difference.kind == "parent":
        return Message(
            "skeleton.other_parent",
            {"bone": difference.bone, "ours": difference.ours, "theirs": difference.theirs},
        )
    return Message("skeleton.other_root", {"ours": difference.ours, "theirs": difference.theirs})


def _roots(target: TargetSkeleton, asset: Figure) -> list[SkeletonDifference]:
    roots = [name for name, parent in zip(asset.bone_names, asset.parents, strict=True) if parent < 0]
    if roots == [target.names[0]]:
        return []
    return [SkeletonDifference("root", target.names[0], severe=True, ours=target.names[0], theirs=", ".join(roots))]


def _unit(target: TargetSkeleton, asset: Figure) -> list[SkeletonDifference]:
    """Return the difference in units of length, found by comparing the lengths of common bones; empty if the units
    agree.
    """
    theirs = {name: bone for bone, name in enumerate(asset.bone_names)}
    both = [
        (bone, theirs[name]) for bone, name in enumerate(target.names) if name in theirs and target.parents[bone] >= 0
    ]
    lengths = [
        (float(np.linalg.norm(target.offsets_m[bone])), float(np.linalg.norm(asset.translations_m[other])))
        for bone, other in both
    ]
    ratios = [ours / other for ours, other in lengths if min(ours, other) > 1e-5]
    factor = float(np.median(ratios)) if ratios else 1.0
    for note in asset.notes:
        if note.id == "figure.scaled":  # the reader corrected a unit that Unreal would accept unchanged
            factor *= float(note.arguments["factor"])
    if UNIT[0] < factor < UNIT[1]:
        return []
    return [SkeletonDifference("unit", "", severe=True, amount=float(f"{factor:.4g}"))]
