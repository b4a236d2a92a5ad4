"""A written model is read back to the bit, and a damaged one is refused with file and place."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.choreography import model_file
from app.choreography.learn import Pair, learn
from app.choreography.model import ChoreographyModel, TrainingPair
from app.choreography.model_file import VERSION, decode_model, encode_model, read_model, write_model
from app.errors import FileError
from app.messages import error_text
from tests.unit.choreography.test_features import random_clip
from tests.unit.choreography.test_learn import SWINGS
from tests.unit.choreography.test_music_offset import danced

CLIP = random_clip(1, 301)
MODEL = learn([SWINGS, Pair(CLIP, "a.bvh", danced(CLIP, 0.0, 1), "a.mid")], states=None, seed=0, name="two")
CONTENT = encode_model(MODEL)


def is_same(a: ChoreographyModel, b: ChoreographyModel) -> bool:
    arrays = [
        (x, y)
        for one, other in zip(a.clips, b.clips, strict=True)
        for x, y in (
            (one.hips_m, other.hips_m),
            (one.rotations, other.rotations),
            (one.shape.offsets_m, other.shape.offsets_m),
            (one.shape.ends_m, other.shape.ends_m),
        )
    ]
    arrays += [(a.transition, b.transition), (a.emission, b.emission), (a.initial, b.initial)]
    return (
        (a.name, a.sources, a.segments) == (b.name, b.sources, b.segments)
        and [clip.fps for clip in a.clips] == [clip.fps for clip in b.clips]
        and all(x.dtype == y.dtype and np.array_equal(x, y) for x, y in arrays)
    )


def test_a_learned_model_is_read_back_to_the_bit(tmp_path: Path) -> None:
    write_model(tmp_path / "two.choreography", MODEL)
    assert is_same(read_model(tmp_path / "two.choreography"), MODEL)


def test_a_user_can_read_it() -> None:
    lines = CONTENT.decode("utf-8").splitlines()
    assert lines[1:4] == [f'"choreography_version": {VERSION},', '"name": "two",', '"fps": "60",']
    assert "made for this test" in lines[5]
    first = MODEL.segments[0]
    assert f" [0,{first.start},{first.accent},{first.end},{first.state}]," in lines


def test_a_file_of_version_1_has_no_sounds() -> None:
    document = json.loads(changed("choreography_version", to=1))
    del document["sounds"]
    old = decode_model(json.dumps(document).encode(), "old")
    assert is_same(old, replace(MODEL, segments=tuple(replace(one, sounds=()) for one in MODEL.segments)))


texts = st.text(max_size=40)


@given(data=st.data())
@settings(max_examples=50, deadline=None)
def test_any_model_is_read_back(data: st.DataObject) -> None:
    states = data.draw(st.integers(1, 6))
    generator = np.random.default_rng(data.draw(st.integers(0, 2**32 - 1)))
    sources = tuple(
        TrainingPair(
            data.draw(texts),
            data.draw(texts),
            data.draw(st.floats(-1e4, 1e4)),
            data.draw(st.none() | st.floats(0.0, 1.0)),
            data.draw(texts),
            data.draw(st.booleans()),
        )
        for _ in MODEL.sources
    )
    rows = [generator.dirichlet(np.full(width, 0.3), states) for width in (states, 47)]
    segments = tuple(
        type(one)(one.clip, one.start, one.accent, one.end, at % states) for at, one in enumerate(MODEL.segments)
    )
    model = ChoreographyModel(data.draw(texts), sources, MODEL.clips, segments, rows[0], rows[1], rows[0][0])
    assert is_same(decode_model(encode_model(model), "x"), model)


def refused(content: bytes) -> FileError:
    with pytest.raises(FileError) as caught:
        decode_model(content, "x.choreography")
    assert caught.value.message.arguments["file"] == "x.choreography"
    assert "x.choreography" in error_text(caught.value)
    return caught.value


def changed(*path: str | int, to: Any) -> bytes:
    """File with one value replaced."""
    document = json.loads(CONTENT)
    place = document
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = to
    return json.dumps(document).encode()


@pytest.mark.parametrize(
    ("path", "value", "place"),
    [
        (("fps",), "60.0", "fps"),
        (("fps",), "100000/1", "fps"),
        (("fps",), "0", "fps"),
        (("sources", 0, "offset_s"), 1e300, "sources[0].offset_s"),
        (("sources", 1, "offset_confidence"), 1.5, "sources[1].offset_confidence"),
        (("sources", 1, "cuts_given"), 1, "JSON"),
        (("sources",), [], "sources"),
        (("bodies",), [], "bodies"),
        (("bodies", 0, "offsets_m"), [], "bodies[0].offsets_m"),
        (("bodies", 0, "ends_m", 2, 1), 1e30, "bodies[0].ends_m"),
        (("motions", 0, "frames"), 0, "motions[0].frames"),
        (("motions", 0, "frames"), -1, "motions[0].frames"),
        (("motions", 0, "frames"), 2**62, "motions[0].hips_m"),
        (("motions", 1, "hips_m"), "", "motions[1].hips_m"),
        (("segments", 0, 0), 1, "segments[1]"),
        (("segments", 3, 0), 2, "segments[3]"),
        (("segments", 3, 1), 0, "segments[3]"),
        (("segments", 3, 2), 2**62, "segments[3]"),
        (("segments", 3, 4), -1, "segments[3]"),
        (("segments", 3, 4), 99, "segments[3]"),
        (("segments",), [[0, 1, 2, 3, 0]] * 50, "segments[1]"),
        (("sounds",), [[0]], "sounds"),
        (("sounds", 3), [46, 47], "sounds[3]"),
        (("melodies", 3), [-1], "melodies[3]"),
        (("initial",), [], "initial"),
        (("initial", 0), 2.0, "initial"),
        (("transition", 0, 0), -0.5, "transition"),
        (("transition",), [[1e308] * len(MODEL.initial)] * len(MODEL.initial), "transition"),
        (("emission", 0), [1.0], "emission"),
        (("choreography_version",), 0, "choreography_version"),
        (("name",), 5, "JSON"),
        (("extra",), 5, "JSON"),
    ],
)
def test_a_wrong_value_is_named(path: tuple[str | int, ...], value: Any, place: str) -> None:
    error = refused(changed(*path, to=value))
    assert error.message.id == "choreography.damaged"
    assert error.message.arguments["place"] == place


@pytest.mark.parametrize("number", [np.nan, np.inf, -1e30, 0.0])
def test_motion_that_is_no_motion_is_refused(number: float) -> None:
    clip = MODEL.clips[0]
    damaged = clip.rotations.copy()
    damaged[5, 3] = number
    model = ChoreographyModel(
        "x",
        MODEL.sources,
        (type(clip)(clip.shape, clip.fps, clip.hips_m, damaged), *MODEL.clips[1:]),
        MODEL.segments,
        MODEL.transition,
        MODEL.emission,
        MODEL.initial,
    )
    assert refused(encode_model(model)).message.arguments["place"] == "motions[0].rotations"


def test_a_newer_file_says_so() -> None:
    error = refused(changed("choreography_version", to=VERSION + 1).replace(b'"name"', b'"title"'))
    assert error.message.id == "choreography.newer"


def test_a_huge_file_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model_file, "MOST_BYTES", 1000)
    write_model(tmp_path / "a.choreography", MODEL)
    with pytest.raises(FileError) as caught:
        read_model(tmp_path / "a.choreography")
    assert caught.value.message.id == "file.too_large"


def test_what_cannot_be_written_leaves_the_file_as_it_was(tmp_path: Path) -> None:
    with pytest.raises(FileError):
        write_model(tmp_path / "missing" / "a.choreography", MODEL)


anything = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**70), 2**70) | st.floats(allow_nan=False) | texts,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(texts, inner, max_size=3),
    max_leaves=6,
)


@given(data=st.data())
@settings(max_examples=150, deadline=None)
def test_any_other_value_anywhere_is_read_or_refused(data: st.DataObject) -> None:
    document = json.loads(CONTENT)
    path: list[Any] = []
    place: Any = document
    while isinstance(place, dict | list) and (not path or data.draw(st.booleans())):
        keys = list(place) if isinstance(place, dict) else list(range(len(place)))
        if not keys:
            break
        path.append(data.draw(st.sampled_from(keys)))
        place = place[path[-1]]
    try:
        decode_model(changed(*path, to=data.draw(anything)), "x.choreography")
    except FileError as error:
        if error.message.arguments["file"] != "x.choreography":
            raise
