"""One captured motion on other rigs: with other bone axes, names and sides."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from scipy.spatial.transform import Rotation

from app.arrays import FloatArray
from app.formats.bvh.clip import BvhClip
from app.rig import quaternion

Axes = Callable[[BvhClip], FloatArray]
"""New axes (J, 4) of each bone in its old ones."""


def rerigged(bvh: BvhClip, axes: Axes) -> BvhClip:
    """Clip with every joint at the same place in every frame, but another zero pose."""
    new, turns = axes(bvh), np.array(bvh.rotations_xyzw)
    offsets, moved = np.array(bvh.offsets_cm, np.float64), dict(bvh.translations_cm)
    for joint, parent in enumerate(bvh.parents):
        turned = quaternion.multiply(bvh.rotations_xyzw[:, joint], new[joint])
        if parent >= 0:
            back = quaternion.conjugate(new[parent])
            turned = quaternion.multiply(back, turned)
            offsets[joint] = quaternion.rotate(back, offsets[joint])
            if joint in moved:
                moved[joint] = quaternion.rotate(back, moved[joint])
        turns[:, joint] = turned
    ends = {joint: quaternion.rotate(quaternion.conjugate(new[joint]), end) for joint, end in bvh.end_sites_cm.items()}
    return replace(bvh, offsets_cm=offsets, rotations_xyzw=turns, end_sites_cm=ends, translations_cm=moved)


def along(axis: int) -> Axes:
    """Rotate every bone's axes so that one points along the bone: X as in LAFAN1 and MotionBuilder, Y as in Rokoko
    Studio and Bandai-Namco.
    """

    def axes(bvh: BvhClip) -> FloatArray:
        found = []
        for joint in range(len(bvh.names)):
            nexts = [bvh.offsets_cm[other] for other, parent in enumerate(bvh.parents) if parent == joint]
            way = np.asarray(nexts[0] if nexts else bvh.end_sites_cm.get(joint, np.zeros(3)))
            first = way if np.linalg.norm(way) > 1e-6 else np.array([0.0, 1.0, 0.0])
            frame = np.linalg.qr(np.column_stack([first, [0.3, 0.2, 0.9], [0.1, 0.9, 0.2]]))[0]
            frame[:, 0] *= np.sign(frame[:, 0] @ first)
            frame[:, 2] = np.cross(frame[:, 0], frame[:, 1])
            found.append(quaternion.from_matrix(np.roll(frame, axis, axis=1)))
        return np.array(found)

    return axes


def at_random(bvh: BvhClip) -> FloatArray:
    """Rotate every bone's axes randomly."""
    return np.asarray(Rotation.random(len(bvh.names), random_state=3).as_quat(), np.float64)


def rolled(bvh: BvhClip) -> FloatArray:
    """Rotate every bone's axes by right angles about the forward direction, as for a pelvis on its side or knees that
    point sideways.
    """
    angles = 0.5 * np.pi * (1 + np.arange(len(bvh.names)) % 3)
    return np.array([quaternion.from_axis_angle((0.0, 0.0, 1.0), angle) for angle in angles])


REST_POSES: Final[Mapping[str, Axes]] = {"x": along(0), "y": along(1), "random": at_random, "rolled": rolled}


def renamed(bvh: BvhClip, names: Callable[[str], str]) -> BvhClip:
    """Clip with other names."""
    return replace(bvh, names=tuple(map(names, bvh.names)))


def without_names(bvh: BvhClip) -> BvhClip:
    """Clip with meaningless names."""
    return replace(bvh, names=tuple(f"b{(7 * joint) % 97}" for joint in range(len(bvh.names))))


def turned(bvh: BvhClip, turn: FloatArray) -> BvhClip:
    """Clip in a world with other axes, with rotated bones."""
    back = quaternion.conjugate(turn)

    def placed(ways: FloatArray) -> FloatArray:
        return quaternion.rotate(turn, ways)

    return replace(
        bvh,
        offsets_cm=placed(bvh.offsets_cm),
        rotations_xyzw=quaternion.multiply(turn, quaternion.multiply(bvh.rotations_xyzw, back)),
        root_translation_cm=placed(bvh.root_translation_cm),
        end_sites_cm={joint: placed(end) for joint, end in bvh.end_sites_cm.items()},
        translations_cm={joint: placed(ways) for joint, ways in bvh.translations_cm.items()},
    )


def mirrored(bvh: BvhClip) -> BvhClip:
    """Mirrored clip, in which bones named left are on the right."""
    across, turn = np.array([-1.0, 1.0, 1.0]), np.array([1.0, -1.0, -1.0, 1.0])
    return replace(
        bvh,
        offsets_cm=bvh.offsets_cm * across,
        rotations_xyzw=bvh.rotations_xyzw * turn,
        root_translation_cm=bvh.root_translation_cm * across,
        end_sites_cm={joint: end * across for joint, end in bvh.end_sites_cm.items()},
        translations_cm={joint: ways * across for joint, ways in bvh.translations_cm.items()},
    )


def without_joints(bvh: BvhClip, lost: Callable[[str], bool]) -> BvhClip:
    """Clip without some bones at the ends of chains; the preceding bone then ends at the start of the
    farthest of them.
    """
    kept = [joint for joint, name in enumerate(bvh.names) if not lost(name)]
    new = {joint: at for at, joint in enumerate(kept)}
    ends = {new[joint]: end for joint, end in bvh.end_sites_cm.items() if joint in new}
    for joint, parent in enumerate(bvh.parents):
        carrier = new.get(parent)
        if joint not in new and carrier is not None:
            ends[carrier] = max(ends.get(carrier, np.zeros(3)), bvh.offsets_cm[joint], key=np.linalg.norm)
    return replace(
        bvh,
        names=tuple(bvh.names[joint] for joint in kept),
        parents=tuple(new.get(bvh.parents[joint], -1) for joint in kept),
        offsets_cm=bvh.offsets_cm[kept],
        rotations_xyzw=bvh.rotations_xyzw[:, kept],
        end_sites_cm=ends,
        translations_cm={new[joint]: ways for joint, ways in bvh.translations_cm.items() if joint in new},
    )


def with_prop(bvh: BvhClip, bone: str, ways: Sequence[tuple[float, float, float]]) -> BvhClip:
    """Same motion with a stiff chain of additional bones in a hand, such as a sword; lengths in centimetres."""
    first, at = len(bvh.names), bvh.names.index(bone)
    still = np.zeros((len(bvh.rotations_xyzw), len(ways), 4))
    still[..., 3] = 1.0
    ends = {joint: end for joint, end in bvh.end_sites_cm.items() if joint != at}
    return replace(
        bvh,
        names=(*bvh.names, *(f"prop{number}" for number in range(len(ways)))),
        parents=(*bvh.parents, at, *range(first, first + len(ways) - 1)),
        offsets_cm=np.concatenate([bvh.offsets_cm, ways]),
        end_sites_cm={**ends, first + len(ways) - 1: np.array(ways[-1])},
        rotations_xyzw=np.concatenate([bvh.rotations_xyzw, still], axis=1),
    )


def together(*texts: str) -> str:
    """Join the figures of several BVH files with equal numbers of frames in one file."""
    heads, motions = zip(*(text.split("MOTION", 1) for text in texts), strict=True)
    tables = [motion.strip().splitlines() for motion in motions]
    rows = [" ".join(row) for row in zip(*(table[2:] for table in tables), strict=True)]
    hierarchy = "".join(head[head.index("ROOT") :] for head in heads)
    return "\n".join(["HIERARCHY", f"{hierarchy}MOTION", *tables[0][:2], *rows, ""])
