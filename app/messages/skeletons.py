"""The skeleton that files are written on, and an asset it is for."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "skeleton.root_added": "{file} has several root bones ({bones}); Unreal takes only one, so the bone {root} was put "
    "above them",
    "skeleton.armature_left_out": "{file}: {armature}, which Blender keeps the bones in, is no bone in Unreal and is "
    "left out; the root bone is {root}",
    "skeleton.other_root": "the root bone is {ours}, the asset's is {theirs}: Unreal would refuse the animation",
    "skeleton.other_parent": "{bone} hangs from {ours}, in the asset from {theirs}",
    "skeleton.other_unit": "lengths are {factor} times the asset's: it is in another unit",
    "skeleton.not_in_asset": "{count} {count:bone that moves is|bones that move are} not in the asset, so that what "
    "{count:it does|they do} would be lost: {bones}",
    "skeleton.additional": "{count} {count:bone|bones} that nothing moves {count:is|are} not in the asset: {bones}",
    "skeleton.missing": "{count} {count:bone|bones} of the asset {count:is|are} not in the file and "
    "{count:keeps its|keep their} rest pose: {bones}",
    "skeleton.rotation": "{count} {count:bone rests|bones rest} turned against the asset, at most by {most} degrees "
    "({bone})",
    "skeleton.position": "{count} {count:bone rests|bones rest} elsewhere than in the asset, at most by {most} mm "
    "({bone})",
    "skeleton.differs": "{file} has another skeleton than the one that {player} would be written on: {detail}",
}
"""Message id -> English template."""
