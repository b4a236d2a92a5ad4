"""Writing of BVH files that all common programs can read.

Uses the dialect that bvhio, bvh, pybvh, Blender, assimp and three.js read alike: position channels only on the root,
whose OFFSET is zero (some readers add it to the channels, others replace it); three rotation channels on every joint,
in its own order; a frame time with enough digits for a long recording. Source: M. Meredith, S. Maddock, "Motion Capture
File Formats Explained" (University of Sheffield, 2001).
"""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator

import numpy as np

from app.arrays import AnyFloatArray
from app.formats.atomic import atomic_write
from app.formats.bvh.clip import POSITIONS, BvhClip
from app.formats.fixed_point import table_text
from app.formats.joint_angles import AXES, channel_degrees

_ORDER = "ZXY"
"""Rotation order of joints without an order of their own."""
_ROWS = 256
"""Number of frames converted to text at a time."""


def write_bvh(path: str | os.PathLike[str], clip: BvhClip) -> None:
    """Write a BVH file atomically.

    Parameters
    ----------
    clip : BvhClip
        Clip to write. Names must not contain blanks; joints may be in any order with parents first (the file is depth
        first). The root's offset is not written, since `root_translation_cm` has its position. Every joint without a
        child needs an end site.

    Raises
    ------
    FileError
        The file cannot be written.
    ValueError
        The values contradict each other.
    """
    pieces = bvh_pieces(clip)
    with atomic_write(path) as stream:
        stream.writelines(pieces)


def bvh_pieces(clip: BvhClip) -> Iterator[bytes | bytearray]:
    """Yield the file's bytes piece by piece, generated on demand."""
    _check(clip)
    children: list[list[int]] = [[] for _ in clip.names]
    for joint, parent in enumerate(clip.parents[1:], start=1):
        children[parent].append(joint)
    lines = ["HIERARCHY"]
    order: list[int] = []
    _joint_lines(clip, children, lines, order)
    frames = len(clip.rotations_xyzw)
    # One digit more than a double holds at this size, so that the time of the last frame of an hour is exact.
    lines += ["MOTION", f"Frames: {frames}", f"Frame Time: {float(1 / clip.fps):.16f}", ""]
    return itertools.chain(["\n".join(lines).encode("utf-8")], _table_pieces(clip, order))


def _table_pieces(clip: BvhClip, order: list[int]) -> Iterator[bytearray]:
    """Yield the channels frame by frame, with the joints in the given order."""
    orders = _orders(clip)
    angles = channel_degrees(clip.rotations_xyzw, orders)
    channels = np.array([[AXES.index(axis) for axis in orders[joint]] for joint in order])
    angles = angles[np.array(order)[:, None], channels]
    frames = angles.shape[-1]
    for first in range(0, frames, _ROWS):
        rows = slice(first, first + _ROWS)
        places = clip.root_translation_cm[rows]
        turns = angles[..., rows].reshape(-1, len(places)).T
        yield from table_text(np.concatenate([places, turns], axis=1, dtype=np.float64))


def _joint_lines(clip: BvhClip, children: list[list[int]], lines: list[str], order: list[int]) -> None:
    """Append the lines of the hierarchy to ``lines``, and the joints to ``order``, depth first."""
    turning = [" ".join(f"{axis}rotation" for axis in order) for order in _orders(clip)]
    # Items still to be written, last first: a joint and its depth, or a closing brace of a depth.
    pending: list[tuple[int | None, int]] = [(0, 0)]
    while pending:
        joint, depth = pending.pop()
        indent = "\t" * depth
        if joint is None:
            lines.append(indent + "}")
            continue
        order.append(joint)
        offset = np.zeros(3) if joint == 0 else clip.offsets_cm[joint]
        placing = f"CHANNELS 3 {turning[joint]}" if joint else f"CHANNELS 6 {' '.join(POSITIONS)} {turning[joint]}"
        lines += [
            f"{indent}{'JOINT' if joint else 'ROOT'} {clip.names[joint]}",
            indent + "{",
            f"{indent}\tOFFSET {_vector(offset)}",
            f"{indent}\t{placing}",
        ]
        if not children[joint]:
            end = _vector(clip.end_sites_cm[joint])
            lines += [f"{indent}\tEnd Site", indent + "\t{", f"{indent}\t\tOFFSET {end}", indent + "\t}"]
        pending.append((None, depth))
        pending += [(child, depth + 1) for child in reversed(children[joint])]


def _orders(clip: BvhClip) -> tuple[str, ...]:
    return clip.orders or (_ORDER,) * len(clip.names)


def _vector(values: AnyFloatArray) -> str:
    return " ".join(f"{value + 0.0:.6f}" for value in values)


def _check(clip: BvhClip) -> None:
    count = len(clip.names)
    if not count or clip.parents[0] != -1 or len(clip.parents) != count:
        raise ValueError("one parent per joint, and the first joint is the root")
    if any(not 0 <= parent < joint for joint, parent in enumerate(clip.parents[1:], start=1)):
        raise ValueError("a parent must come before its joint, and only the first joint is a root")
    if len(set(clip.names)) != count or any(name.split() != [name] for name in clip.names):
        raise ValueError("joints must have different names without blanks")
    missing = set(range(count)) - set(clip.parents) - set(clip.end_sites_cm)
    if missing:
        raise ValueError(f"no end site for {', '.join(clip.names[joint] for joint in sorted(missing))}")
    frames = len(clip.rotations_xyzw)
    if clip.rotations_xyzw.shape != (frames, count, 4) or clip.root_translation_cm.shape != (frames, 3) or not frames:
        raise ValueError("rotations (F, J, 4) and root translations (F, 3) of at least one frame")
    if any(sorted(order) != sorted(AXES) for order in clip.orders) or len(_orders(clip)) != count:
        raise ValueError("one order of all three axes per joint, or none at all")
    if clip.translations_cm:
        raise ValueError("only the root moves")
    if np.shape(clip.offsets_cm) != (count, 3) or not np.isfinite(clip.offsets_cm).all() or clip.fps <= 0:
        raise ValueError("one finite offset per joint, and a frame rate above zero")
