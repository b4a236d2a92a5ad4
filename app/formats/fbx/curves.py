"""Animation curves of an FBX file: linear keys on every frame, or linear or cubic keys at the frames of `Keys`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, FloatArray, IntArray, SingleArray
from app.formats.cubics import span_slopes
from app.formats.fbx.assembly import Assembly
from app.formats.fbx.encode import Element, PackedArray, pack_array
from app.formats.fbx.sections import integer, property_block, property_row
from app.formats.joint_angles import AXES, PLAIN_ORDER, channel_degrees, channel_quaternions
from app.formats.scene import Bone, Clip

EULER_ORDER = PLAIN_ORDER
"""Rotation order "XYZ" of FBX, in which x is applied first, so that the matrix is Rz Ry Rx; also used for
pre-rotations.
"""
ORDERS = ("ZYX", "YZX", "XZY", "ZXY", "YXZ", "XYZ")
"""Rotation orders by the value of FBX's ``RotationOrder``."""
STEADY_DEG, STEADY_CM = 1e-3, 1e-4
"""Change of an axis in degrees or centimetres below which reduced keys omit it as rounding."""

# Linear keys. Other bits beside "linear" (4), and the tangent data, are those that all readers accept.
_KEY_FLAGS = np.array([0x6104], dtype=np.int32)
_KEY_DATA = np.array([0.0, 0.0, 9.419963346924634e-30, 0.0], dtype=np.float32)
CUBIC, OWN_SLOPES = 0x8, 0x400 | 0x800
"""Flags of a cubic key, and of a key with independent slopes on both sides (``FbxAnimCurveDef`` of the FBX SDK)."""
LINEAR = 0x4


def rotation_curves(bones: Sequence[Bone], clip: Clip) -> FloatArray:
    """Return the angles (B, 3, F) to be written for B bones in F frames: degrees about X, Y and Z relative to the
    bone's rest, in its rotation order.
    """
    angles = channel_degrees(clip.rotations_xyzw, *_resting(bones))
    return angles if clip.keys is None else steady(angles, STEADY_DEG).astype(np.float64, copy=False)


def curve_rotations(bones: Sequence[Bone], degrees: AnyFloatArray) -> FloatArray:
    """Return the rotations (B, F, 4) of B bones in F frames from the degrees (B, F, 3) of their curves, the reverse of
    `rotation_curves`."""
    return channel_quaternions(degrees, *_resting(bones))


def _resting(bones: Sequence[Bone]) -> tuple[tuple[str, ...], FloatArray]:
    """Return the rotation order of each of B bones, and their rest rotations (B, 4)."""
    return tuple(bone.order for bone in bones), np.array([bone.rotation_xyzw for bone in bones], np.float64)


def place_curves(clip: Clip, bone: int) -> AnyFloatArray:
    """Return the positions (3, F) in centimetres to be written for a bone that is translated."""
    places = np.asarray(clip.translations_cm[bone]).T
    return places if clip.keys is None else steady(places, STEADY_CM)


def _cubic(slopes: FloatArray) -> tuple[Element, ...]:
    """Return the FBX records of K cubic keys with slopes (K - 1, 2) per second at both ends of each span."""
    data = np.tile(_KEY_DATA, (len(slopes) + 1, 1))
    data[:-1, :2] = slopes
    flags = np.full(len(data), CUBIC | OWN_SLOPES, np.int32)
    return (
        Element("KeyAttrFlags", (pack_array(flags),)),
        Element("KeyAttrDataFloat", (pack_array(data.ravel()),)),
        Element("KeyAttrRefCount", (pack_array(np.ones(len(data), np.int32)),)),
    )


def steady(curves: AnyFloatArray, least: float) -> AnyFloatArray:
    """Replace curves (..., F) that change by at most ``least`` by their first value."""
    rests = np.ptp(curves, axis=-1, keepdims=True) <= least
    return np.where(rests, curves[..., :1], curves)


class FbxLayerCurves:
    """Writer of the curves of one animation layer. Arrays shared by several curves are encoded once."""

    def __init__(self, assembly: Assembly, layer: int, key_ticks: IntArray) -> None:
        self._assembly = assembly
        self._layer = layer
        self._ticks = key_ticks
        self._at: dict[bytes, tuple[tuple[Element, ...], tuple[Element, ...]]] = {}
        self._resting: dict[bytes, PackedArray] = {}

    def add_clip(
        self,
        bones: Sequence[Bone],
        clip: Clip,
        models: Sequence[int],
        channels: Mapping[str, Sequence[int]],
        *,
        alone: bool = False,
    ) -> None:
        """Animate a figure: ``models`` are the ids of its bones, ``channels`` the ids of the morph channels by name.

        With ``alone`` (no meshes in the file), morphs are written as properties 0..1 of the root, named after them.
        """
        keys = clip.keys
        slopes_fps = float(clip.fps) if keys is not None and keys.curved else 0.0
        rotations = rotation_curves(bones, clip)
        for bone, model in enumerate(models):
            frames = None if keys is None else keys.bones[bone]
            if bone in clip.translations_cm:
                self._add(model, "Lcl Translation", "T", AXES, place_curves(clip, bone), frames, slopes_fps)
            self._add(model, "Lcl Rotation", "R", AXES, rotations[bone], frames, slopes_fps)
        for name, weights in clip.morph_weights.items():
            row = np.asarray(weights, dtype=np.float64)[None]
            percent = row * 100.0
            frames = None if keys is None else keys.morphs[name]
            if alone:
                self._add(models[0], name, name, (name,), row, frames)
            for channel in channels.get(name, ()):
                self._add(channel, "DeformPercent", "DeformPercent", ("DeformPercent",), percent, frames)

    def _add(
        self,
        target: int,
        target_property: str,
        name: str,
        channels: str | tuple[str, ...],
        values: AnyFloatArray,
        frames: AnyIntArray | None,
        slopes_fps: float = 0.0,
    ) -> None:
        """Animate one FBX property; ``values`` (channels, F) has a row for each channel. Keys are at the given frames
        or all; cubic if a frame rate ``slopes_fps`` is given, else linear."""
        defaults = [
            property_row(f"d|{channel}", "Number", "", "A", float(row[0]))
            for channel, row in zip(channels, values, strict=True)
        ]
        node = self._assembly.add("AnimationCurveNode", name, "AnimCurveNode", "", (property_block(*defaults),))
        self._assembly.connect(node, self._layer)
        self._assembly.connect(node, target, target_property)
        for channel, exact, row in zip(channels, values, values.astype(np.float32), strict=True):
            at = None
            if frames is not None:
                at = frames[:1] if (row[slice(None) if slopes_fps else frames] == row[0]).all() else frames
            before, after = self._times(at)
            if slopes_fps and at is not None and len(at) > 1:
                after = _cubic(span_slopes(exact[:, None], at)[..., 0] * slopes_fps)
            keys = Element("KeyValueFloat", (self._keys(row if at is None else row[at]),))
            children = (Element("Default", (float(row[0]),)), *before, keys, *after)
            curve = self._assembly.add("AnimationCurve", "", "AnimCurve", "", children)
            self._assembly.connect(curve, node, f"d|{channel}")

    def _times(self, frames: AnyIntArray | None) -> tuple[tuple[Element, ...], tuple[Element, ...]]:
        """Return the FBX records before and after the values of a curve, which hold the times of its keys (all frames
        if None).
        """
        known = b"" if frames is None else frames.tobytes()
        if known not in self._at:
            key_ticks = self._ticks if frames is None else self._ticks[frames]
            self._at[known] = (
                (integer("KeyVer", 4008), Element("KeyTime", (pack_array(key_ticks),))),
                # Without any of the three the FBX SDK crashes.
                (
                    Element("KeyAttrFlags", (pack_array(_KEY_FLAGS),)),
                    Element("KeyAttrDataFloat", (pack_array(_KEY_DATA),)),
                    Element("KeyAttrRefCount", (pack_array(np.array([len(key_ticks)], dtype=np.int32)),)),
                ),
            )
        return self._at[known]

    def _keys(self, row: SingleArray) -> PackedArray:
        """Return a channel's values (F,) as an encoded FBX array.

        Constant curves are compressed and shared; compressing moving ones is not worth the time.
        """
        if not (row == row[0]).all():
            return pack_array(row, compress=False)
        known = row.tobytes()
        if known not in self._resting:
            self._resting[known] = pack_array(row)
        return self._resting[known]
