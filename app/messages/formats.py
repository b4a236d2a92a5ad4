"""FBX, BVH and USD files."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "fbx.not_binary": "{file} is not a binary FBX file",
    "fbx.truncated": "{file} ends in the middle of a record (byte {offset})",
    "fbx.bad_record": "{file}: the record at byte {offset} does not fit into its surroundings",
    "fbx.bad_property": "{file}: the property at byte {offset} is of an unknown kind or too long for its record",
    "fbx.bad_array": "{file}: the array at byte {offset} is damaged",
    "fbx.too_deep": "{file}: the records at byte {offset} are nested too deeply",
    "fbx.missing": "{file} has no {what}",
    "fbx.unsupported": "{file}: {what} is not supported",
    "fbx.not_fbx": "{file} is not an FBX file",
    "fbx.foreign_damaged": "{file} is damaged ({detail}); export it again",
    "fbx.too_large": "{file} describes far more data than a file of its size holds; export the character alone",
    "fbx.contradiction": "{file} contradicts itself: {detail}",
    "bvh.syntax": "{file}, line {line}: {found} does not belong here",
    "bvh.truncated": "{file} ends too early",
    "bvh.motion": "{file}: the motion does not fit the skeleton ({detail})",
    "bvh.too_large": "{file} describes far more data than a file of its size holds; export the motion alone",
    "bvh.unsupported": "{file}, line {line}: {what} is not supported",
    "motion.incomplete": "{file}: no bone was found for {joints}; only the motion of a whole human body can be read",
    "motion.far": "{file} is damaged: it has a joint farther away than any body goes; export it again",
    "motion.format": "{file} is not a file of motion that can be read; export the motion as BVH, FBX or GLB",
    "motion.no_animation": "{file} has no animation; export it with its animation baked",
    "motion.too_long": "{file} has too much motion to be read at once; export it in shorter parts",
    "usd.missing": "USD files need the package usd-core, which is not installed: pip install usd-core",
}
