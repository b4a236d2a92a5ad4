"""Damaged files raise errors of ours and nothing else, and cost little."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.choreography.model_file import decode_model
from app.errors import AppError
from app.formats.bvh.read import decode_bvh
from app.formats.fbx.read import decode_scene
from app.formats.gltf.read import decode_gltf
from tests.support.encoded import encode_bvh, encode_glb, encode_scene
from tests.unit.choreography.test_model_file import CONTENT
from tests.unit.formats import scenes
from tests.unit.formats.gltf.test_read import character
from tests.unit.formats.test_bvh import clip

INSTRUMENT, CHARACTER = scenes.instrument(Fraction(24), frames=5), scenes.character(Fraction(24), frames=3)
GOOD: dict[str, tuple[bytes, Callable[[bytes], object]]] = {
    "fbx": (encode_scene(INSTRUMENT), lambda data: decode_scene(data, "x.fbx")),
    "fbx with morphs": (encode_scene(CHARACTER), lambda data: decode_scene(data, "x.fbx")),
    "bvh": (encode_bvh(clip(frames=3)), lambda data: decode_bvh(data.decode("utf-8", "replace"), "x.bvh")),
    "choreography": (CONTENT, lambda data: decode_model(data, "x.choreography")),
    "glb": (character().glb(), lambda data: decode_gltf(data, "x.glb")),
    "glb with animation": (encode_glb(CHARACTER), lambda data: decode_gltf(data, "x.glb", animated=True)),
}


def _read(read: Callable[[bytes], object], data: bytes) -> None:
    try:
        read(data)
    except AppError as error:
        if "file" not in error.message.arguments:
            raise


def test_the_good_files_are_good() -> None:
    for data, read in GOOD.values():
        read(data)


@pytest.mark.parametrize("name", GOOD)
@given(seed=st.integers(0, 2**32 - 1), flips=st.integers(1, 8))
@settings(max_examples=250, deadline=None)
def test_flipped_bytes(name: str, seed: int, flips: int) -> None:
    data, read = GOOD[name]
    damaged = np.frombuffer(data, np.uint8).copy()
    generator = np.random.default_rng(seed)
    # The head of a file decides most, so half of the damage goes there.
    places = generator.integers(0, len(data) if seed % 2 else min(len(data), 3000), flips)
    damaged[places] = generator.choice([0, 1, 0x20, 0x7F, 0xFF, generator.integers(256)], flips)
    _read(read, damaged.tobytes())


@pytest.mark.parametrize("name", GOOD)
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=80, deadline=None)
def test_cut_doubled_and_exchanged_pieces(name: str, seed: int) -> None:
    data, read = GOOD[name]
    generator = np.random.default_rng(seed)
    start, stop = sorted(generator.integers(0, len(data), 2).tolist())
    to = int(generator.integers(0, len(data)))
    for damaged in (
        data[:start],
        data[:start] + data[stop:],
        data[:stop] + data[start:],
        data[:to] + data[start:stop] + data[to + stop - start :],
    ):
        _read(read, damaged)


@pytest.mark.parametrize("name", GOOD)
@given(data=st.binary(max_size=200))
@settings(max_examples=100, deadline=None)
def test_anything_after_a_good_beginning(name: str, data: bytes) -> None:
    good, read = GOOD[name]
    for kept in (0, 4, 27, 60, 200):
        _read(read, good[:kept] + data)


@pytest.mark.parametrize("name", ["fbx", "glb"])
def test_lengths_that_lie_take_no_memory(name: str) -> None:
    """Places all over the first part of the file become a huge number, one at a time."""
    data, read = GOOD[name]
    tracemalloc.start()
    try:
        for place in range(12, min(len(data) - 4, 2500), 7):
            _read(read, data[:place] + b"\xff\xff\xff\x7f" + data[place + 4 :])
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 64 * 2**20
