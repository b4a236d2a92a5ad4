"""Binary FBX: encoder and decoder are inverse, the layout follows the format's rules, and damaged files are refused."""

from __future__ import annotations

import hashlib
import struct
import zlib
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as st_numpy

from app.errors import FileError
from app.formats.fbx import decode, encode
from app.formats.fbx.encode import Element, pack_array
from app.formats.fbx.write import write_scene
from tests.support.encoded import encode_elements
from tests.support.fbx_dump import text
from tests.support.readers import QUICK_FBX, judge
from tests.unit.formats import scenes

SCALARS = st.one_of(
    st.booleans(),
    st.integers(-(2**15), 2**15 - 1).map(np.int16),
    st.integers(-(2**31), 2**31 - 1).map(np.int32),
    st.integers(-(2**63), 2**63 - 1).map(np.int64),
    st.floats(width=32).map(np.float32),
    st.floats(),
    st.text(max_size=40),
    st.binary(max_size=40),
)
ARRAYS = st.sampled_from(["f4", "f8", "i4", "i8", "?"]).flatmap(
    lambda kind: st_numpy.arrays(np.dtype(kind), st.integers(0, 60))
)
NAMES = st.text("ABCabc123|_", max_size=12)
LEAVES = st.builds(lambda name, values: Element(name, tuple(values)), NAMES, st.lists(SCALARS | ARRAYS, max_size=4))
TREES = st.recursive(
    LEAVES,
    lambda inner: st.builds(
        lambda name, values, children: Element(name, tuple(values), tuple(children)),
        NAMES,
        st.lists(SCALARS, max_size=2),
        st.lists(inner, max_size=3),
    ),
    max_leaves=12,
)


def _same(left: Element, right: Element) -> bool:
    """Compare trees to the bit, including types and the presence of a block."""
    if left.name != right.name or len(left.properties) != len(right.properties):
        return False
    for mine, other in zip(left.properties, right.properties, strict=True):
        if isinstance(mine, np.ndarray):
            if not isinstance(other, np.ndarray) or mine.dtype != other.dtype or mine.tobytes() != other.tobytes():
                return False
        elif type(mine) is not type(other) or np.array(mine).tobytes() != np.array(other).tobytes():
            return False
    if (left.children is None) != (right.children is None):
        return False
    pairs = zip(left.children or (), right.children or (), strict=False)
    return len(left.children or ()) == len(right.children or ()) and all(_same(a, b) for a, b in pairs)


@given(st.lists(TREES, max_size=4))
@settings(max_examples=200, deadline=None)
def test_what_is_encoded_is_decoded(elements: list[Element]) -> None:
    decoded = decode.read_elements(encode_elements(elements), "made-up.fbx")
    assert decoded.properties == (np.int32(7400),)
    assert _same(Element("", (), tuple(elements)), Element("", (), decoded.children))


@given(st.lists(TREES, max_size=3), st.integers(0, 2**32))
@settings(max_examples=150, deadline=None)
def test_64_bit_offsets_hold_the_same(elements: list[Element], seed: int) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(encode, "_LARGEST_OFFSET", 0)
        decoded = decode.read_elements(encode_elements(elements), "made-up.fbx")
    assert decoded.properties == (np.int32(7500),)
    assert _same(Element("", (), tuple(elements)), Element("", (), decoded.children))


def test_a_file_past_the_limit_is_of_version_7500_throughout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(encode, "_LARGEST_OFFSET", 20_000)
    scene = scenes.character(Fraction(60))
    path = tmp_path / "large.fbx"
    write_scene(path, scene)
    root = decode.read_elements(path.read_bytes(), "large.fbx")
    header = root.child("FBXHeaderExtension")
    said = header.child("FBXVersion")
    assert said.properties == (np.int32(7500),)
    judge(path, scenes.expected(scene), QUICK_FBX)


@pytest.mark.parametrize("records", range(16))
def test_the_footer_is_where_it_belongs(records: int) -> None:
    """For every remainder of the length, the version word is at a multiple of 16, after one to sixteen zeros."""
    data = encode_elements([Element("A" * records)] if records else [])
    version_at = len(data) - 16 - 120 - 4
    assert version_at % 16 == 0
    assert data[version_at : version_at + 4] == struct.pack("<I", 7400)
    assert data[-16:] == encode.FOOTER_END
    start = data.index(encode.FOOTER_ID)
    assert 4 + 1 <= version_at - (start + 16) <= 4 + 16
    assert not any(data[start + 16 : version_at])


@pytest.mark.parametrize("value", [1, None, 1j, np.int8(1), np.zeros((2, 2)), np.zeros(3, np.float16), ["a"]])
def test_a_value_whose_form_would_be_a_guess_is_refused(value: object) -> None:
    with pytest.raises(TypeError):
        encode_elements([Element("A", (value,))])


def test_a_packed_array_is_its_array() -> None:
    values = np.arange(1000, dtype=np.int64)
    for packed in (pack_array(values), pack_array(values, compress=False)):
        (element,) = decode.read_elements(encode_elements([Element("A", (packed,))]), "x").children or ()
        np.testing.assert_array_equal(element.properties[0], values)


def _file(record: bytes) -> bytes:
    return encode.MAGIC + struct.pack("<I", 7400) + record + bytes(13)


def _record(properties: bytes, count: int = 1, end: int | None = None) -> bytes:
    size = 27 + 13 + 1 + len(properties)
    return struct.pack("<IIIB", size if end is None else end, count, len(properties), 1) + b"A" + properties


def _array(code: bytes, count: int, encoding: int, body: bytes, length: int | None = None) -> bytes:
    return code + struct.pack("<III", count, encoding, len(body) if length is None else length) + body


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (b"", "not_binary"),
        (b"; FBX 7.4.0 project file", "not_binary"),
        (_file(b"")[:-1], "truncated"),
        (_file(_record(b"C\1", end=1000)), "truncated"),
        (_file(_record(b"C\1", end=30)), "bad_record"),
        (_file(_record(b"C\1", count=2)), "bad_property"),
        (_file(_record(b"C\1", count=0)), "bad_record"),
        (_file(_record(b"Z\1")), "bad_property"),
        (_file(_record(b"L\1\2")), "bad_property"),
        (_file(_record(b"S" + struct.pack("<I", 2**32 - 1))), "bad_property"),
        (_file(_record(_array(b"d", 3, 0, bytes(23)))), "bad_array"),
        (_file(_record(_array(b"d", 2**32 - 1, 0, bytes(8)))), "bad_array"),
        (_file(_record(_array(b"d", 2**32 - 1, 1, zlib.compress(bytes(80))))), "bad_array"),
        (_file(_record(_array(b"d", 9, 1, zlib.compress(bytes(80))))), "bad_array"),
        (_file(_record(_array(b"d", 11, 1, zlib.compress(bytes(80))))), "bad_array"),
        (_file(_record(_array(b"d", 10, 1, zlib.compress(bytes(80))[:-3]))), "bad_array"),
        (_file(_record(_array(b"d", 10, 1, b"no zlib at all"))), "bad_array"),
        (_file(_record(_array(b"d", 1, 2, bytes(8)))), "bad_array"),
        (_file(struct.pack("<IIIB", 0, 1, 0, 0)), "bad_record"),
    ],
)
def test_damage_is_named(data: bytes, problem: str) -> None:
    with pytest.raises(FileError) as raised:
        decode.read_elements(data, "bad.fbx")
    assert raised.value.message.id == f"fbx.{problem}"
    assert raised.value.message.arguments["file"] == "bad.fbx"


def test_records_nest_only_so_deep() -> None:
    deep = struct.pack("<IIIB", 10**6, 0, 0, 0) * 10_000
    with pytest.raises(FileError) as raised:
        decode.read_elements(encode.MAGIC + struct.pack("<I", 7400) + deep + bytes(10**6), "deep.fbx")
    assert raised.value.message.id == "fbx.too_deep"


def test_the_dump_shows_every_kind_of_property() -> None:
    properties = (True, np.int16(-1), np.int32(2), np.int64(3), np.float32(0.5), -0.0, "a\0\1b", b"\x01\xff",
                  np.arange(3, dtype=np.int32), np.arange(100.0))  # fmt: skip
    root = Element("", (np.int32(7400),), (Element("A", properties, (Element("B", (), ()), Element("C"))),))
    values = hashlib.blake2b(np.arange(100.0).tobytes(), digest_size=8).hexdigest()
    assert text(root) == (
        "version 7400\n"
        "A: true -1h 2 3l 0.5 0.0 'a\\x00\\x01b' bytes:01ff int32[3](0 1 2)"
        " float64[100](0.0 1.0 2.0 3.0 .. 99.0; " + values + ")\n"
        "  B: {}\n"
        "  C:\n"
    )
