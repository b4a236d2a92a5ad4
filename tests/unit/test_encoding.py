"""File names that are not UTF-8 are preserved and displayed readably."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from app.encoding import ENCODINGS, HIDDEN, PREFIX, is_encoding, restored, shown, stored
from app.errors import FileError, Message
from app.messages import error_text

on_bytes = pytest.mark.skipif(os.name == "nt", reason="names are no bytes there")
# Valid file names: any bytes except NUL and the slash.
NAMES = st.lists(st.binary(min_size=1, max_size=12).map(lambda b: b.replace(b"\0", b"\1")), min_size=1, max_size=4)
KURARINETTO = "クラリネット 50%.mid"


@on_bytes
@given(NAMES, st.booleans())
@example([b"bytes:", b"", b"x%41"], False)
@example([b"\x83N.mid"], True)
@example(["é".encode(), b"\xc3"], True)
def test_every_name_comes_back(names: list[bytes], absolute: bool) -> None:
    raw = (b"/" if absolute else b"") + b"/".join(names)
    path = os.fsdecode(raw)
    kept = stored(path)
    assert os.fsencode(restored(json.loads(json.dumps(kept, ensure_ascii=False).encode()))) == raw
    shown(path).encode()
    try:
        text = raw.decode()
    except UnicodeDecodeError:
        assert kept.startswith(PREFIX)
    else:
        assert kept == text or raw.startswith(PREFIX.encode()), "a path that is UTF-8 is kept as it always was"
        assert shown(path) == text or HIDDEN.search(text)


@given(st.text(st.characters(codec="utf-8")))
def test_any_text_comes_back(text: str) -> None:
    assert restored(stored(text)) == text


def test_a_path_of_another_system_stays_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """On Windows all names are texts."""

    def decode(name: bytes) -> str:
        return name.decode()

    monkeypatch.setattr("app.encoding.os.fsdecode", decode)
    path = f"{PREFIX}/home/%83N.mid"
    assert restored(path) == path
    assert stored(path) == path


@given(st.text(st.characters()))
def test_no_text_is_refused(text: str) -> None:
    """Lone surrogates of any kind, which a path of this system cannot have but a file may name."""
    stored(text).encode()
    assert not HIDDEN.search(shown(text))
    assert shown(shown(text)) == shown(text)


@on_bytes
@pytest.mark.parametrize(
    ("raw", "readable"),
    [
        (KURARINETTO.encode("cp932"), KURARINETTO),
        ("Flöte.mid".encode("latin-1"), "Flöte.mid"),
        ("曲".encode() + b"/" + "フルート.mid".encode("cp932"), "曲/フルート.mid"),
        ("ガ\u3000曲.mid".encode("cp932"), "ガ\u3000曲.mid"),
        (b"\xff\x81\n.mid", r"ÿ\x81\n.mid"),
        ("曲\x1b[2J\r\u202e\u2028.mid".encode(), r"曲\x1b[2J\r\u202e\u2028.mid"),
    ],
)
def test_it_is_shown_as_it_was_meant(raw: bytes, readable: str) -> None:
    assert shown(os.fsdecode(raw)) == readable
    assert shown(Path(os.fsdecode(raw))) == readable


@on_bytes
def test_messages_can_be_stored_and_printed() -> None:
    path = os.fsdecode(KURARINETTO.encode("cp932"))
    assert Message("x", {"file": path, "count": 2}).arguments == {"file": KURARINETTO, "count": 2}
    error = FileError("file.cannot_read", file=path, reason="-")
    assert KURARINETTO in error_text(error)
    str(error).encode()


@pytest.mark.parametrize("name", ["klingon", "base64", "rot13", "punycode", "idna", "undefined", "utf-8\0", ""])
def test_what_turns_not_all_bytes_into_text_is_no_encoding_of_texts(name: str) -> None:
    assert not is_encoding(name)


@pytest.mark.parametrize("name", [*ENCODINGS, "utf-16", "latin-1", "ascii", "shift_jis"])
def test_encodings_to_choose_from_read_any_bytes(name: str) -> None:
    assert is_encoding(name)
    assert isinstance(bytes(range(256)).decode(name, errors="replace"), str)
