"""Everything that a reader accepts into a project can be saved and is read back unchanged."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from app.capture.journal import read_journal
from app.capture.journal_to_takes import takes_of
from app.errors import AppError, Message
from app.formats.toml import toml
from app.messages import LANGUAGES, text
from app.plan.by_hand.additive_curve import AdditiveCurve, CurveKey
from app.project import presets
from app.project.edit.additive import paste_keys
from app.project.edit.notes import copied, paste, read_clip
from app.project.edit.piece import put_expression, set_audio
from app.project.edit.players import rename, set_parameters
from app.project.edit.takes import add_takes
from app.project.importing import import_project, usual_rows
from app.project.model import Project, with_settings
from app.project.parameters import parameter_names, parse_settings
from app.project.piece_metadata import load_metadata, metadata_of, with_metadata
from app.project.reimport import reimported
from app.project.storage import decode, encode
from app.project.undoable_document import Document
from app.score.read import read_contents
from app.score.take import ControllerMapping
from instrument_maps.library import all_maps
from tests.unit.project.pieces import ANGRY, full_project
from widgets.timeline.model.additive.additive_curves import clip_keys, clip_text

PLACE = Path("/music/piece.suisou")
PROJECT = full_project()
CURVE = next(item for item in PROJECT.corrections["1.1.1"] if isinstance(item, AdditiveCurve))
EDIT = Message("edit.add_note", {"of": "1"})

TEXTS = ["", "\0", "x" * 1_000_000, "\ud800", "\x1b[2J\u202e", "nan", "../../x", "a\nb", "\u2028", "{0}", "１", "-"]
NUMBERS = [
    *(0, -1, 1, 127, 128, 2**31 - 1, -(2**31), 2**53 + 1, 2**63 - 1, 2**63, -(2**63), 10**30),
    *(-0.0, 0.5, 5e-324, 1e308, -1e308, float("nan"), float("inf"), -float("inf"), True),
]
HOSTILE: list[Any] = [*TEXTS, *NUMBERS, [], {}, [[]], [1, 1], {"": 1}]
SLOW = {"deadline": None, "suppress_health_check": list(HealthCheck)}


def check(read: Callable[[], Project]) -> bool:
    """Return whether a reader accepts an input; if so, check that the project can be edited, saved and read again."""
    try:
        project = read()
        Document(PROJECT).apply(EDIT, project)
    except AppError as error:
        said = [text(error.message, language) for language in LANGUAGES]
    else:
        assert decode(encode(project, PLACE), PLACE) == project
        return True
    assert all(map(str.isprintable, said))
    return False


def paths(value: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path] * bool(path) + [found for key, item in items for found in paths(item, (*path, key))]


def changes(table: Any) -> st.SearchStrategy[Any]:
    """A table with hostile values, or places of it missing or doubled."""
    places = paths(table)

    def changed(drawn: list[tuple[tuple[str | int, ...], Any]]) -> Any:
        whole = json.loads(json.dumps(table))
        for path, hostile in drawn:
            place = whole
            try:
                for key in path[:-1]:
                    place = place[key]
                place[path[-1]] = hostile
            except (KeyError, IndexError, TypeError):
                continue
        return whole

    return st.lists(st.tuples(st.sampled_from(places), st.sampled_from(HOSTILE)), min_size=1, max_size=3).map(changed)


def plain(value: Any) -> Any:
    """The value as a table of TOML: without None."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items() if item is not None}
    return [plain(item) for item in value] if isinstance(value, list | tuple) else value


METADATA = plain(msgspec.to_builtins(metadata_of(PROJECT)))
PRESET = plain(msgspec.to_builtins(presets.preset_of(PROJECT.players[0].parameters, "Mine")))
EXPRESSION = plain(msgspec.to_builtins(ANGRY))
CLIP = msgspec.to_builtins(copied(PROJECT, {"1:1", "1:2", "2:1"}))
KEYS = json.loads(clip_text(CURVE.channel, CURVE.keys))


def written(folder: Path, name: str, table: Any) -> Path:
    file = folder / name
    file.parent.mkdir(exist_ok=True)
    file.write_bytes(toml(table).encode("utf-8", "surrogatepass"))
    return file


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("read")


def test_unchanged_all_are_accepted(folder: Path) -> None:
    assert check(lambda: with_metadata(PROJECT, load_metadata(written(folder, "piece.toml", METADATA))).project)
    assert check(lambda: pasted_notes(json.dumps(CLIP).encode()))
    assert check(lambda: pasted_keys(json.dumps(KEYS).encode()))


@given(changes(METADATA))
@example({**METADATA, "ticks_per_quarter": 32767})
@example({**METADATA, "expressions": METADATA["expressions"] * 2})
@settings(max_examples=150, **SLOW)
def test_metadata(folder: Path, table: Any) -> None:
    check(lambda: with_metadata(PROJECT, load_metadata(written(folder, "piece.toml", table))).project)


@given(changes({"name": PRESET["name"], **PRESET["parameters"]}))
@settings(max_examples=100, **SLOW)
def test_presets(folder: Path, table: Any) -> None:
    written(folder, "presets/one.toml", table)
    for preset in presets.presets(folder / "presets").items.values():
        check(lambda preset=preset: set_parameters(PROJECT, ("1.1.1",), **preset.parameters))


@given(changes(EXPRESSION))
@settings(max_examples=100, **SLOW)
def test_expressions(folder: Path, table: Any) -> None:
    written(folder, "expressions/one.toml", table)
    for expression in presets.expressions(folder / "expressions").items.values():
        check(lambda expression=expression: put_expression(PROJECT, expression))


def pasted_notes(content: bytes) -> Project:
    clip = read_clip(content)
    return PROJECT if clip is None else paste(PROJECT, "1.1.1", clip, 480)[0]


def pasted_keys(content: bytes, at_tick: int = 0) -> Project:
    return paste_keys(PROJECT, "1.1.1", CURVE.name, clip_keys(content, CURVE.channel), at_tick)


@given(changes(CLIP))
@settings(max_examples=100, **SLOW)
def test_notes_of_the_clipboard(clip: Any) -> None:
    check(lambda: pasted_notes(json.dumps(clip).encode()))


@given(changes(KEYS), st.sampled_from([0, 960, 2**31 - 1]))
@settings(max_examples=100, **SLOW)
def test_keys_of_the_clipboard(keys: Any, at_tick: int) -> None:
    check(lambda: pasted_keys(json.dumps(keys).encode(), at_tick))


@pytest.mark.parametrize("content", [b"\xff", b"[" * 100_000, b"null", b"{}"])
def test_what_another_program_has_put_on_the_clipboard_is_nothing(content: bytes) -> None:
    assert pasted_notes(content) is PROJECT
    assert pasted_keys(content) is PROJECT


@given(st.sampled_from(parameter_names()), st.sampled_from([*TEXTS, *map(str, NUMBERS)]) | st.text(max_size=20))
@settings(max_examples=200, **SLOW)
def test_settings_of_the_command_line(parameter: str, value: str) -> None:
    maps, names = all_maps(), [player.name for player in PROJECT.players]

    def edited() -> Project:
        return with_settings(PROJECT, parse_settings([f"*.{parameter}={value}"], names, maps, ["man_adult"]), maps)

    check(edited)


@given(st.sampled_from(TEXTS) | st.text(max_size=20))
@settings(max_examples=30, **SLOW)
def test_names_and_paths_from_the_window(name: str) -> None:
    check(lambda: rename(PROJECT, "1.1.1", name))
    check(lambda: set_audio(PROJECT, f"/music/{name}.wav"))


JOURNAL = b"""{"version": 1, "port": "P", "started": "2026-01-01T00:00:00Z", "epoch_ns": 0, "latency_s": 0.0}
s 0 0.0 0
e 1000 903c64
e 500000000 803c00
s 1000000000 1.0 0
end 1000000000
"""


@given(
    st.lists(
        st.tuples(
            st.integers(0, len(JOURNAL.split(b" ")) - 1),
            st.sampled_from([str(number).encode() for number in NUMBERS]) | st.binary(max_size=6),
        ),
        max_size=2,
    )
)
@settings(max_examples=150, **SLOW)
def test_journals_of_takes(folder: Path, drawn: list[tuple[int, bytes]]) -> None:
    words = JOURNAL.split(b" ")
    for place, word in drawn:
        words[place] = word
    file = folder / "take.journal"
    file.write_bytes(b" ".join(words))

    def adopted() -> Project:
        takes = takes_of(read_journal(file), PROJECT.score.tempo_map, ControllerMapping(), "Take {number}")
        return add_takes(PROJECT, "1.1.1", takes)[0] if takes else PROJECT

    check(adopted)


def midi(name: bytes, tempo: bytes, metre: bytes, division: bytes) -> bytes:
    def chunk(kind: bytes, data: bytes) -> bytes:
        return kind + len(data).to_bytes(4) + data

    def meta(kind: int, data: bytes) -> bytes:
        return bytes((0, 0xFF, kind, *varlen(len(data)))) + data

    events = meta(3, name) + meta(0x51, tempo) + meta(0x58, metre) + meta(6, name)
    events += bytes.fromhex("00c038 00903c40 8360803c00 00ff2f00")
    return chunk(b"MThd", bytes((0, 0, 0, 1)) + division) + chunk(b"MTrk", events)


def varlen(number: int) -> bytes:
    groups = [number & 0x7F]
    while number := number >> 7:
        groups.insert(0, 0x80 | (number & 0x7F))
    return bytes(groups)


contents_of_midi = st.builds(
    midi,
    st.sampled_from([one[:20_000].encode("utf-8", "surrogatepass") for one in TEXTS]) | st.binary(max_size=12),
    st.binary(min_size=3, max_size=3),
    st.binary(min_size=4, max_size=4),
    st.sampled_from([b"\x01\xe0", b"\0\1", b"\x7f\xff", b"\xe7\x28", b"\0\0"]),
)


def imported(file: Path, content: bytes) -> Project:
    file.write_bytes(content)
    contents = read_contents(file)
    return import_project(contents, usual_rows(contents, all_maps()), all_maps(), str(file))


@given(contents_of_midi)
@settings(max_examples=40, **SLOW)
def test_midi_files(folder: Path, content: bytes) -> None:
    check(lambda: imported(folder / "piece.mid", content))


@given(contents_of_midi, contents_of_midi)
@settings(max_examples=15, **SLOW)
def test_midi_files_that_take_the_place_of_others(folder: Path, content: bytes, later: bytes) -> None:
    def read_again() -> Project:
        project = imported(folder / "piece.mid", content)
        (folder / "piece.mid").write_bytes(later)
        return reimported(project, folder / "piece.mid", all_maps()).project

    check(read_again)


@given(
    st.lists(
        st.builds(
            CurveKey,
            st.sampled_from([0, 1, 480, 2**31 - 1, 2**40, 480.0]),
            st.sampled_from([0.0, 1.0, float("nan"), 1e308, 181.0, 2**70]),
        ),
        max_size=2,
    ),
    st.sampled_from(["bell.up", "bell.upp", "\ud800", "x" * 10_000]),
    st.sampled_from(["a", "", "\ud800", "x" * 10_000]),
)
@settings(max_examples=100, **SLOW)
def test_an_edit_that_makes_what_cannot_be_saved_is_refused(keys: list[CurveKey], channel: str, name: str) -> None:
    curve = AdditiveCurve(name, channel, tuple(keys))

    check(lambda: replace(PROJECT, corrections={**PROJECT.corrections, "1.1.1": (curve,)}))
