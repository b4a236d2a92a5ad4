"""Small motion files that require far more memory or time than their size suggests, one for each known cause."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np

from app.formats.fbx.encode import Element
from tests.fuzz.harness.costly_files import ABOVE, PACKED_FBX, PLACES, fbx, figure, glb

TICKS_PER_S: Final = 46_186_158_000
"""Time units of FBX per second."""


def _body(channels: str) -> str:
    """Hierarchy of a body whose hips have these channels, and nothing else any."""
    below: dict[str, list[str]] = {}
    for joint, above in ABOVE.items():
        below.setdefault(above, []).append(joint)

    def lines(joint: str) -> str:
        place = " ".join(str(100.0 * value) for value in PLACES[joint])
        said = f"CHANNELS {channels}\n" if joint == "hips" and channels else ""
        kind = "ROOT" if joint == "hips" else "JOINT"
        return f"{kind} {joint}\n{{\nOFFSET {place}\n{said}{''.join(map(lines, below.get(joint, ())))}}}\n"

    return "HIERARCHY\n" + lines("hips")


def _bvh(size: int, channels: str, values: Sequence[str], frame_s: str) -> bytes:
    """A body whose hips go through these values again and again."""
    head = _body(channels)
    row = "".join(f"{value}\n" for value in values)
    frames = max((size - len(head)) // len(row), 2) * len(values)
    return (head + f"MOTION\nFrames: {frames}\nFrame Time: {frame_s}\n" + row * (frames // len(values))).encode()


def bvh_one_channel(size: int) -> bytes:
    """Frames of one number."""
    return _bvh(size, "1 Yposition", "99", ".0166667")


def bvh_slow(size: int) -> bytes:
    """Frames of one second each, which learning samples sixty times."""
    return _bvh(size, "1 Yposition", "98", "1")


def bvh_days(size: int) -> bytes:
    """Frames of hours."""
    return _bvh(size, "1 Yposition", "98", "9000")


def bvh_milliseconds(size: int) -> bytes:
    """Frames of a fifth of a second, in milliseconds."""
    return _bvh(size, "1 Yposition", "98", "200")


def bvh_flips(size: int) -> bytes:
    """A body that faces back in every third frame."""
    return _bvh(size, "1 Yrotation", ("0", "0", "99"), ".0041667")


def bvh_noise(size: int) -> bytes:
    """A body that turns about in every frame."""
    return _bvh(size, "1 Yrotation", ("0", "99", "9", "70", "40"), ".001")


def bvh_steps(size: int) -> bytes:
    """A body that goes on in another direction in every fourth frame."""
    return _bvh(size, "1 Yrotation", [str(60 * (at // 4)) for at in range(24)], ".0166667")


def bvh_steps_of_one(size: int) -> bytes:
    """Same motion with as few numbers as possible."""
    return _bvh(size, "1 Yrotation", ("0", "0", "0", "0", "9", "9", "9", "9"), ".0041667")


def _keys(seconds: float, count: int = 2) -> bytes:
    times = [seconds * at / (count - 1) for at in range(count)]
    turns = [(0.0, 0.0, 0.0, 1.0) if at % 2 else (0.0, 0.1, 0.0, 0.995) for at in range(count)]
    return struct.pack(f"<{count}f", *times) + b"".join(struct.pack("<4f", *turn) for turn in turns)


def _target(number: int) -> dict[str, Any]:
    return {"node": 1 + number % 9, "path": "rotation"}


def _animated(seconds: float, count: int = 2, more: int = 0, channels: int = 1) -> bytes:
    """A figure with keys on one rotation, and nodes or channels beside it."""
    data = _keys(seconds, count)
    document: dict[str, Any] = {
        **figure(*[{}] * more),
        "bufferViews": [
            {"buffer": 0, "byteLength": 4 * count},
            {"buffer": 0, "byteOffset": 4 * count, "byteLength": 16 * count},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": count, "type": "SCALAR", "min": [0.0], "max": [seconds]},
            {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC4"},
        ],
        "animations": [
            {
                "channels": [
                    {"sampler": 0, "target": {"node": 1 + at % 9, "path": "rotation"}} for at in range(channels)
                ],
                "samplers": [{"input": 0, "output": 1}],
            }
        ],
    }
    return glb(document, data)


def glb_longest_motion(size: int) -> bytes:
    """Two keys as far apart as may be."""
    return _animated(900.0)


def glb_hours_of_motion(size: int) -> bytes:
    """Two keys hours apart."""
    return _animated(8224.0)


def glb_still_nodes(size: int) -> bytes:
    """Two keys, and thousands of nodes that do not move."""
    nodes = max(size // 3 - 1500 // 3, 1)
    return _animated(min(2**20 / (nodes + 17) / 60.0, 900.0), more=nodes)


def glb_targets(size: int) -> bytes:
    """Thousands of channels of a few nodes."""
    return _animated(900.0, channels=max((size - 1500) // 52, 1))


def glb_dense_keys(size: int) -> bytes:
    """Keys a thousandth of a second apart."""
    count = max((size - 1500) // 20, 2)
    return _animated(900.0, count)


def fbx_take(seconds: float, more: int = 0) -> bytes:
    """A figure with a take of so many seconds and no keys, and nodes beside it."""
    numbers = {joint: 10 + at for at, joint in enumerate(sorted(PLACES, key=lambda joint: joint != "hips"))}
    objects, links = [], [(3, 2)]
    for joint, number in numbers.items():
        place = Element("P", ("Lcl Translation", "Lcl Translation", "", "A", *(100.0 * at for at in PLACES[joint])))
        kept = (Element("Properties70", (), (place,)),)
        objects.append(Element("Model", (np.int64(number), f"{joint}\0\x01Model", "LimbNode"), kept))
        links.append((number, numbers.get(ABOVE.get(joint, ""), 0)))
    for number in range(1000, 1000 + more):
        objects.append(Element("Model", (np.int64(number), "a\0\x01Model", "Null"), ()))
        links.append((number, 0))
    end = Element("P", ("LocalStop", "KTime", "Time", "", np.int64(round(seconds * TICKS_PER_S))))
    begin = Element("P", ("LocalStart", "KTime", "Time", "", np.int64(0)))
    span = (Element("Properties70", (), (begin, end)),)
    objects.append(Element("AnimationStack", (np.int64(2), "a\0\x01AnimStack", ""), span))
    objects.append(Element("AnimationLayer", (np.int64(3), "a\0\x01AnimLayer", ""), ()))
    return fbx(objects, links)


def fbx_longest_motion(size: int) -> bytes:
    """A take as long as may be."""
    return fbx_take(899.0)


def fbx_half_an_hour(size: int) -> bytes:
    """A take of half an hour."""
    return fbx_take(2000.0)


def fbx_still_nodes(size: int) -> bytes:
    """A take of as many nodes as there is room for."""
    nodes = max((size - 4000) // 100, 1)
    return fbx_take(min(2**20 / (nodes + 18) / 30.0, 899.0), nodes)


COSTLY_MOTION: Final[dict[str, tuple[Callable[[int], bytes], ...]]] = {
    "motion": (
        *(bvh_one_channel, bvh_slow, bvh_days, bvh_milliseconds),
        *(bvh_flips, bvh_noise, bvh_steps, bvh_steps_of_one),
    ),
    "fbx_motion": (fbx_longest_motion, fbx_half_an_hour, fbx_still_nodes, *PACKED_FBX),
    "gltf_motion": (glb_longest_motion, glb_hours_of_motion, glb_still_nodes, glb_targets, glb_dense_keys),
}
"""The same as `tests.fuzz.harness.costly_files.COSTLY_FILES`."""
