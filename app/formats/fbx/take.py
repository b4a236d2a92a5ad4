"""Reading of the animation of a binary FBX file written by this program: one take with linear or cubic keys
on frames.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

import numpy as np

from app.arrays import AnyFloatArray, FloatArray, IntArray
from app.errors import FileError
from app.formats.cubics import cubic_values
from app.formats.fbx import ticks
from app.formats.fbx.curves import CUBIC, LINEAR, OWN_SLOPES
from app.formats.fbx.encode import Element
from app.formats.fbx.graph import FbxObject, ObjectGraph, numbers, properties_of

MOST_VALUES = 2**25
"""Greatest number of values: frames times bones, and vertices times influences; far above real files, and small enough
for any computer.
"""
_MOST_FRAMES = 2**20
"""Greatest number of frames in a clip, some hours, since a few keys could claim any length."""
_KEY_PARTS = ("right slope", "next left slope", "weights", "velocities")
_ANIMATED = {
    "Lcl Rotation": ("LimbNode", 3),
    "Lcl Translation": ("LimbNode", 3),
    "DeformPercent": ("BlendShapeChannel", 1),
}


class FbxCurve(NamedTuple):
    """Keys of a curve as stored in an FBX file: frames (K,) and values (K,).

    Cubic keys also have slopes (K - 1, 2) per frame at both ends of each span; these are None for linear keys.
    """

    frames: IntArray
    values: AnyFloatArray
    slopes: FloatArray | None = None

    @property
    def rests(self) -> bool:
        """True if the value is constant."""
        return self.slopes is None and bool((self.values == self.values[0]).all())

    def at(self, frames: int) -> FloatArray:
        """Return the curve's values at all frames (frames,): lines or cubics between the keys, constant before and
        after them.
        """
        if len(self.frames) == frames:
            return self.values.astype(np.float64)
        if self.slopes is not None:
            return cubic_values(self.values.astype(np.float64), self.slopes, self.frames, frames)
        found: FloatArray = np.interp(np.arange(frames), self.frames, self.values)
        return found


class FbxTake(NamedTuple):
    """The animation of a file: curves by channel and property."""

    name: str
    fps: Fraction
    frames: int
    curves: dict[tuple[int, str], list[FbxCurve]]


def read_take(graph: ObjectGraph, root: Element) -> FbxTake | None:
    """Return the first take of a file; None if there is none."""
    stacks = graph.of_kind("AnimationStack", "")
    if not stacks:
        return None
    settings = properties_of(graph.section(root, "GlobalSettings"))
    mode, custom = numbers(settings.get("TimeMode", ())), numbers(settings.get("CustomFrameRate", ()))
    fps = ticks.rate(int(mode[0]) if mode else 0, custom[0] if custom else 0.0)
    if fps is None:
        raise FileError("fbx.missing", file=graph.file, what="frame rate")
    stop = numbers(properties_of(stacks[0].element).get("LocalStop", ()))
    if not stop:
        raise FileError("fbx.missing", file=graph.file, what="end of the animation")
    last = ticks.nearest_frames(np.array(stop[:1]), fps)[0]
    if not 0 <= last < _MOST_FRAMES:
        raise FileError("fbx.unsupported", file=graph.file, what=f"{last + 1} frames")
    frames = int(last) + 1
    curves = _curves(graph, stacks[0], ticks.frame_ticks(fps, frames), fps)
    for (target, to_property), channels in curves.items():
        moved = graph.objects[target].sub_class if target in graph.objects else ""
        # The weight of a morph of another mesh is a property of the root.
        if _ANIMATED.get(to_property, ("LimbNode", 1)) != (moved, len(channels)):
            raise FileError("fbx.unsupported", file=graph.file, what=f"animation of {to_property}")
    return FbxTake(stacks[0].name, fps, frames, curves)


def _curves(
    graph: ObjectGraph, stack: FbxObject, frame_ticks: IntArray, fps: Fraction
) -> dict[tuple[int, str], list[FbxCurve]]:
    """Return the curves of every animated property, by object id and property name; one curve for each channel of the
    property.
    """
    result: dict[tuple[int, str], list[FbxCurve]] = {}
    # Equal arrays of a file become one array.
    known: dict[int, tuple[IntArray, IntArray]] = {}
    for layer in graph.below(stack, "AnimationLayer"):
        for node in graph.below(layer, "AnimationCurveNode"):
            channels = []
            for curve in graph.below(node, "AnimationCurve"):
                key_ticks = graph.integers(curve.element, "KeyTime")
                values = graph.stored(curve.element, "KeyValueFloat", 1)[:, 0]
                if id(key_ticks) not in known:
                    known[id(key_ticks)] = key_ticks, _key_frames(graph, key_ticks, frame_ticks, fps)
                if len(values) != len(key_ticks):
                    raise FileError("fbx.contradiction", file=graph.file, detail=f"times and values of {node.name}")
                slopes = _slopes(graph, curve.element, len(values), fps)
                channels.append(FbxCurve(known[id(key_ticks)][1], values, slopes))
            targets = [(target, to) for target, to in graph.parents.get(node.id, ()) if to]
            if len(targets) != 1 or not channels:
                raise FileError("fbx.missing", file=graph.file, what=f"target or curve of {node.name}")
            result[targets[0]] = channels
    if not result:
        raise FileError("fbx.missing", file=graph.file, what="animation curve")
    return result


def _slopes(graph: ObjectGraph, curve: Element, count: int, fps: Fraction) -> FloatArray | None:
    """Return the slopes at both sides of each cubic key of an FBX curve as in `FbxCurve`; None if the keys are linear.
    ``count`` is the expected number of keys."""
    flags = graph.integers(curve, "KeyAttrFlags")
    if len(flags) == 1 and flags[0] & LINEAR:
        return None
    data = graph.stored(curve, "KeyAttrDataFloat", len(_KEY_PARTS)).astype(np.float64)
    own = CUBIC | OWN_SLOPES
    if len(flags) != count or len(data) != count or ((flags & own) != own).any():
        raise FileError("fbx.unsupported", file=graph.file, what="keys that are neither linear nor cubic")
    return data[:-1, :2] / float(fps)


def _key_frames(graph: ObjectGraph, key_ticks: IntArray, frame_ticks: IntArray, fps: Fraction) -> IntArray:
    """Return the frame numbers (N,) of an FBX curve's N keys. Raises FileError for keys between or outside
    the frames.
    """
    frames = ticks.nearest_frames(key_ticks.astype(np.float64), fps)
    there = len(frames) and 0 <= frames.min() <= frames.max() < len(frame_ticks)
    if not there or (np.diff(frames) <= 0).any() or not np.array_equal(frame_ticks[frames], key_ticks):
        raise FileError("fbx.unsupported", file=graph.file, what="keys that are not on the frames")
    return frames
