"""Damaged files in the program's own formats: each reader reports an error or ignores the file, whatever
its bytes are.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import pytest

from app.capture.journal import read_journal
from app.choreography.model_file import read_model
from app.cli.batch import NOTES, _read_notes
from app.errors import AppError, FileError
from app.evaluation.answers import read_answers
from app.evaluation.key import read_key
from app.evaluation.keyframes import _report
from app.evaluation.measures import read_measures
from app.export.file_names import REPORT
from app.export.unreal.layout import MANIFEST
from app.export.unreal.manifest import read_manifest
from app.formats.atomic import atomic_write
from app.formats.table_cache import kept
from app.formats.user_folder import stamp_of
from app.messages import LANGUAGES, text
from app.project.piece_metadata import load_metadata
from app.project.presets import expressions, presets
from app.project.recovery import recoverable
from app.project.storage import autosave_facts, load
from instrument_maps.load import load_map
from metadata.load import read_expression
from widgets.viewport.shape_cache import _read as read_shapes

DEEP = 100_000
BYTES = {
    "empty": b"",
    "no UTF-8": b'{"version": 1, "name": "\xff", "choreography_version": 1, "schema_version": 1}\n',
    "a key that is no UTF-8": b'{"a\xff": 1}\n',
    "UTF-16": '{"version": 1}'.encode("utf-16"),
    "deep lists": b'{"version": 1, "x": ' + b"[" * DEEP + b"]" * DEEP + b"}\n",
    "deep tables": b'{"x":' * DEEP + b"1" + b"}" * DEEP,
    "deep TOML": b"x = " + b"[" * DEEP,
    "long name of TOML": b".".join([b"a"] * DEEP) + b" = 1",
    "numbers": b'{"version": 1e400, "schema_version": 99999999999999999999999999999, "choreography_version": -0.0}\n',
    "NUL": b"\0" * 64,
    "NUL in a text": b'name = "a\\u0000b"\nmodel = "a\\u0000.glb"\n',
    "MessagePack": b"\x91" * 4000,
}
Read = Callable[[Path], Any]
READERS: dict[str, Read] = {
    "project": load,
    "key of an evaluation": read_key,
    "measures": read_measures,
    "answers": read_answers,
    "journal": read_journal,
    "choreography": read_model,
    "metadata of a piece": load_metadata,
    "expression": read_expression,
    "instrument map": load_map,
}


@pytest.mark.parametrize("content", BYTES.values(), ids=BYTES)
@pytest.mark.parametrize("read", READERS.values(), ids=READERS)
def test_a_reader_refuses_in_words_that_name_the_file(read: Read, content: bytes, tmp_path: Path) -> None:
    file = tmp_path / "own.toml"
    file.write_bytes(content)
    with pytest.raises(AppError) as raised:
        read(file)
    for language in LANGUAGES:
        said = text(raised.value.message, language)
        assert file.name in said
        assert len(said) < 1500
        assert "recursion" not in said


@pytest.mark.parametrize("content", BYTES.values(), ids=BYTES)
def test_what_lies_in_a_folder_is_a_problem_and_the_rest_goes_on(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "one.toml").write_bytes(content)
    for found in (presets(tmp_path), expressions(tmp_path)):
        assert not found.items
    (tmp_path / "0123.json").write_bytes(content)
    (tmp_path / "0123.suisou").write_bytes(content)
    assert recoverable(tmp_path) == ()
    assert autosave_facts(content) is None


@pytest.mark.parametrize("content", BYTES.values(), ids=BYTES)
def test_reports_notes_and_caches(content: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / REPORT).write_bytes(content)
    with pytest.raises(FileError) as raised:
        _report(tmp_path)
    assert raised.value.message.id == "evaluate.keyframes_report"
    (tmp_path / MANIFEST).write_bytes(content)
    with pytest.raises(FileError):
        read_manifest(tmp_path)
    assert read_shapes(tmp_path / REPORT) is None
    monkeypatch.setattr("app.formats.table_cache.cache_folder", lambda kind: tmp_path)
    monkeypatch.setattr("app.formats.table_cache.digest_of", lambda folder: "x")
    (tmp_path / "name-x.msgpack").write_bytes(content)
    decoder = msgspec.msgpack.Decoder(dict[str, list[str]])
    assert kept("kind", "name", tmp_path, decoder, lambda: {"made": ["again"]}) == {"made": ["again"]}


@pytest.mark.parametrize("content", BYTES.values(), ids=BYTES)
def test_notes_of_an_export_are_set_aside_and_every_piece_is_exported_again(
    content: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / NOTES
    file.write_bytes(content)
    assert _read_notes(file) == {}
    said = capsys.readouterr().err
    assert str(file) in said
    assert f"{NOTES}.damaged" in said
    assert file.with_name(f"{NOTES}.damaged").read_bytes() == content
    assert _read_notes(file) == {}
    assert capsys.readouterr().err == ""


def test_a_name_that_no_file_can_have(tmp_path: Path) -> None:
    path = tmp_path / "a\0b"
    with pytest.raises(FileError), atomic_write(path):
        raise AssertionError("there is no such file")
    assert stamp_of([path]) == frozenset()
