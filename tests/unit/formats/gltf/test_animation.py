"""Interpolation of channels compared with scipy; damaged channels are refused."""

from __future__ import annotations

import json
import struct
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial.transform import Rotation, Slerp

from app.errors import FileError
from app.formats.gltf.animation import sampled
from app.formats.gltf.model import GltfChannel
from app.formats.gltf.read import decode_gltf
from tests.support.encoded import encode_glb
from tests.unit.formats import scenes
from tests.unit.formats.gltf.test_write import _document

KEYS_S = np.array([0.5, 0.6, 1.0, 2.5])
AT_S = np.array([0.0, 0.5, 0.53, 0.6, 0.8, 1.0, 1.7, 2.5, 9.0])
INSIDE_S = np.clip(AT_S, 0.5, 2.5)
VALUES = np.random.default_rng(1).normal(size=(4, 3, 4))


def unit(values: np.ndarray) -> np.ndarray:
    return values / np.linalg.norm(values, axis=-1, keepdims=True)


def test_lines_and_steps() -> None:
    values = VALUES[:, 0, :3]
    linear = sampled(GltfChannel(0, "translation", "LINEAR", KEYS_S, values), AT_S)
    expected = [np.interp(AT_S, KEYS_S, values[:, axis]) for axis in range(3)]
    np.testing.assert_allclose(linear, np.transpose(expected), atol=1e-12)
    steps = sampled(GltfChannel(0, "scale", "STEP", KEYS_S, values), AT_S)
    np.testing.assert_array_equal(steps, values[[0, 0, 0, 1, 1, 2, 2, 3, 3]])
    alone = sampled(GltfChannel(0, "translation", "LINEAR", KEYS_S[:1], values[:1]), AT_S)
    np.testing.assert_allclose(alone, np.tile(values[0], (len(AT_S), 1)))


def test_rotations_go_the_shorter_way_at_even_speed() -> None:
    keys = unit(VALUES[:, 0])
    keys[1] = -keys[0]  # the same rotation, said otherwise
    found = sampled(GltfChannel(0, "rotation", "LINEAR", KEYS_S, keys), AT_S)
    expected = Slerp(KEYS_S, Rotation.from_quat(keys))(INSIDE_S)
    assert (Rotation.from_quat(found) * expected.inv()).magnitude().max() < 1e-9


@pytest.mark.parametrize(("path", "width"), [("translation", 3), ("rotation", 4)])
def test_splines(path: str, width: int) -> None:
    keys = VALUES[:, :, :width]
    found = sampled(GltfChannel(0, path, "CUBICSPLINE", KEYS_S, keys.reshape(-1, width)), AT_S)
    for start in range(3):
        span = slice(start, start + 2)
        slopes = np.stack([keys[start, 2], keys[start + 1, 0]])
        curve = CubicHermiteSpline(KEYS_S[span], keys[span, 1], slopes)
        within = (KEYS_S[start] <= INSIDE_S) & (KEYS_S[start + 1] >= INSIDE_S)
        expected = curve(INSIDE_S[within])
        np.testing.assert_allclose(found[within], unit(expected) if width == 4 else expected, atol=1e-9)


def test_what_we_write_is_read_and_only_if_requested() -> None:
    scene = scenes.character(Fraction(30), frames=7)
    assert scene.clip is not None
    data = encode_glb(scene)
    assert decode_gltf(data, "x.glb").animations == ()
    (animation,) = decode_gltf(data, "x.glb", animated=True).animations
    turned = {one.node: one for one in animation.channels if one.path == "rotation"}
    assert set(turned) == set(range(len(scene.bones)))
    for bone, channel in turned.items():
        found = sampled(channel, np.arange(7) / 30.0)
        given = unit(np.asarray(scene.clip.rotations_xyzw[:, bone], np.float64))
        assert np.abs(np.einsum("fi,fi->f", found, given)).min() > 1.0 - 1e-6


@pytest.mark.parametrize(
    ("place", "value", "problem"),
    [
        (("samplers", 0, "interpolation"), "BEZIER", "gltf.unsupported"),
        (("samplers", 0, "input"), 10**6, "gltf.damaged"),
        (("samplers", 0, "output"), 0, "gltf.damaged"),
        (("samplers", 0, "input"), None, "gltf.damaged"),
        (("channels", 0, "sampler"), 10**6, "gltf.damaged"),
        (("channels", 0, "sampler"), ["x"], "gltf.damaged"),
        (("channels", 0, "target"), {"node": 10**6, "path": "rotation"}, "gltf.damaged"),
    ],
)
def test_damage_is_named(place: tuple[Any, ...], value: object, problem: str) -> None:
    data = encode_glb(scenes.character(Fraction(30), frames=7))
    document = _document(data)
    owner: Any = document["animations"][0]
    for key in place[:-1]:
        owner = owner[key]
    owner[place[-1]] = value
    with pytest.raises(FileError) as caught:
        decode_gltf(changed(data, document), "x.glb", animated=True)
    assert caught.value.message.id == problem


def test_channels_of_other_things_are_left_out() -> None:
    data = encode_glb(scenes.character(Fraction(30), frames=7))
    document = _document(data)
    targets = [channel["target"] for channel in document["animations"][0]["channels"]]
    for target, path in zip(targets, (["rotation"], {}, None, "pointer", 3), strict=False):
        target["path"] = path
    (animation,) = decode_gltf(changed(data, document), "x.glb", animated=True).animations
    moving = [target for target in targets[5:] if target["path"] != "weights"]
    assert len(animation.channels) == len(moving)


def changed(data: bytes, document: dict[str, Any]) -> bytes:
    """File with another document."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + struct.unpack_from("<I", data, 12)[0] :]
    return struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest


def test_a_step_at_a_frame_is_seen_at_that_frame() -> None:
    """Keys are stored in float32, in which 12.6 s is slightly later than the frame at 12.6."""
    frames = np.arange(300)
    keys_s = (frames / 30.0).astype(np.float32).astype(np.float64)
    values = np.repeat(frames[:, None], 3, axis=1).astype(np.float64)
    found = sampled(GltfChannel(0, "translation", "STEP", keys_s, values), frames / 30.0)
    np.testing.assert_array_equal(found[:, 0], frames)
    between = sampled(GltfChannel(0, "translation", "STEP", keys_s, values), (frames + 0.9) / 30.0)
    np.testing.assert_array_equal(between[:, 0], frames)
