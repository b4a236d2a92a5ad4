"""A project is restored from its file to the last bit; any other bytes are refused."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import msgspec
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.errors import FileError
from app.messages import error_text
from app.project.check import faults
from app.project.model import Project
from app.project.storage import decode, encode, load, save
from tests.support.projects import projects
from tests.unit.project.pieces import full_project

PLACE = Path("/music/piece.suisou")
WHOLE = encode(full_project(), PLACE)


@given(projects())
@settings(max_examples=50, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
def test_there_and_back(project: Project) -> None:
    assert list(faults(project)) == []
    content = encode(project, PLACE)
    back = decode(content, PLACE)
    assert back == project
    # Equal is not enough: 0.0 equals -0.0, and 1 equals 1.0.
    assert repr(back) == repr(project)
    assert encode(back, PLACE) == content


@given(projects())
@settings(max_examples=5, deadline=None, suppress_health_check=list(HealthCheck))
def test_through_a_real_file(tmp_path_factory: Any, project: Project) -> None:
    folder = tmp_path_factory.mktemp("projects")
    save(project, folder / "piece.suisou")
    assert load(folder / "piece.suisou") == project


def read(content: bytes) -> Project | None:
    try:
        project = decode(content, PLACE)
    except FileError as error:
        sentence = error_text(error)
        assert str(PLACE) in sentence
        return None
    # What was accepted is sound, and can be kept again.
    assert decode(encode(project, PLACE), PLACE) == project
    return project


@given(st.binary(max_size=200))
@settings(max_examples=400, deadline=None)
def test_any_bytes(content: bytes) -> None:
    assert read(content) is None


@given(st.integers(0, len(WHOLE) - 2))
@settings(max_examples=100, deadline=None)
def test_cut_short(length: int) -> None:
    assert read(WHOLE[:length]) is None


@given(st.data())
@settings(max_examples=400, deadline=None)
def test_flipped_bits(data: st.DataObject) -> None:
    content = bytearray(WHOLE)
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] ^= 1 << data.draw(st.integers(0, 7))
    read(bytes(content))


HOSTILE: list[Any] = [
    None, True, -1, 0, 1, 2**31, 2**53 + 1, 2**63, 10**30, -0.0, 1e308, -1e308, 5e-324, 0.5, "", "x", "../../x", "\0",
    "x" * 20_000, [], {}, [[]], [None], {"": 1}, "nan", "1/0", "60", "#12345", "{0}", "%s", "１",
]  # fmt: skip


def paths(value: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    found = [path] if path else []
    if isinstance(value, dict):
        for key, item in value.items():
            found += paths(item, (*path, key))
    elif isinstance(value, list):
        for index, item in enumerate(value):
            found += paths(item, (*path, index))
    return found


PATHS = paths(json.loads(WHOLE))


@given(st.lists(st.tuples(st.sampled_from(PATHS), st.sampled_from(HOSTILE)), min_size=1, max_size=3))
@settings(max_examples=500, deadline=None)
def test_hostile_values(changes: list[tuple[tuple[str | int, ...], Any]]) -> None:
    whole = json.loads(WHOLE)
    for path, hostile in changes:
        place = whole
        try:
            for key in path[:-1]:
                place = place[key]
            place[path[-1]] = hostile
        except (KeyError, IndexError, TypeError):
            continue
    read(json.dumps(whole).encode())


@given(st.sampled_from(PATHS))
@settings(max_examples=200, deadline=None)
def test_doubled_and_missing(path: tuple[str | int, ...]) -> None:
    for double in (True, False):
        whole = json.loads(WHOLE)
        place = whole
        for key in path[:-1]:
            place = place[key]
        if double and isinstance(place, list):
            place.insert(0, place[path[-1]])
        else:
            del place[path[-1]]
        read(json.dumps(whole).encode())


@given(st.integers(1, 200_000))
@settings(max_examples=20, deadline=None)
def test_nested_to_death(depth: int) -> None:
    assert read(b"[" * depth) is None
    deep = b'{"schema_version": 1, "score": ' + b"[" * depth + b"]" * depth + b"}"
    assert read(deep) is None
    in_correction = WHOLE.replace(b'"label": "1\xc2\xb73"', b'"label": ' + b"[" * depth + b"]" * depth)
    assert in_correction != WHOLE
    assert read(in_correction) is None


def test_a_key_no_one_knows_is_not_lost_but_refused() -> None:
    for path in PATHS:
        whole = json.loads(WHOLE)
        place = whole
        for key in path:
            place = place[key]
        if not isinstance(place, dict) or path[-1] in ("arguments", "weights", "corrections"):
            continue
        place["of_tomorrow"] = 1
        assert read(json.dumps(whole).encode()) is None, path


def test_numbers_beyond_floats() -> None:
    assert read(WHOLE.replace(b'"offset_s": -0.132', b'"offset_s": 1e999')) is None
    assert read(WHOLE.replace(b'"offset_s": -0.132', b'"offset_s": NaN')) is None
    assert msgspec.json.decode(WHOLE)["audio"]["offset_s"] == -0.132
