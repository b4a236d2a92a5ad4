"""Viewers' files as saved by the page and by spreadsheets, and refused ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.errors import FileError
from app.evaluation.answers import COLUMNS, MOST_BYTES, decode_answers, encode_answers, read_answers
from app.messages import error_text, text
from tests.support.viewers import answer_of

FILE = Path("answers.csv")
TWO = (answer_of("c01"), answer_of("c02", position=2, answer=None, seconds=0.0))
CONTENT = encode_answers(TWO)
LINES = CONTENT.decode("utf-8-sig").split("\r\n")


def refused(content: bytes) -> FileError:
    """Error about a file, which names the file and has a text in both languages."""
    with pytest.raises(FileError) as raised:
        decode_answers(content, FILE)
    message = raised.value.message
    assert message.arguments["file"] == "answers.csv"
    assert "answers.csv" in text(message)
    assert "answers.csv" in text(message, "ja")
    return raised.value


def changed(line: int, **columns: str) -> bytes:
    """File with other values in a line."""
    values = dict(zip(COLUMNS, LINES[line - 1].split(","), strict=True)) | columns
    return "\r\n".join([*LINES[: line - 1], ",".join(values.values()), *LINES[line:]]).encode()


def test_what_the_page_writes_is_read_back() -> None:
    assert CONTENT.startswith(b"\xef\xbb\xbfevaluation,viewer,language,position,presentation,side,clip,aspect,scale,")
    found = decode_answers(CONTENT, FILE)
    assert found.answers == TWO
    assert found.lines == (2, 3)
    assert (found.viewer, found.evaluation) == ("a0000001", "c0ffee01")
    assert encode_answers(found.answers) == CONTENT


@pytest.mark.parametrize(
    "content",
    [
        CONTENT.removeprefix(b"\xef\xbb\xbf"),
        CONTENT.replace(b"\r\n", b"\n"),
        CONTENT.replace(b"\r\n", b"\r"),
        CONTENT.replace(b",", b";").replace(b"9.5", b"9,5"),
        CONTENT.replace(b",", b"\t").replace(b"9.5", b"9,5"),
        CONTENT.replace(b"c01", b'"c01"').replace(b"9.5", b'"9,5"'),
        CONTENT + b",,,,,,,,,,\r\n\r\n",
    ],
    ids=["no mark", "Unix", "old Mac", "German Excel", "tabs", "quoted", "empty rows"],
)
def test_what_a_spreadsheet_saves_is_read(content: bytes) -> None:
    assert decode_answers(content, FILE).answers == TWO


@pytest.mark.parametrize(
    ("columns", "column"),
    [
        ({"answer": "6"}, "answer"),
        ({"answer": "0"}, "answer"),
        ({"answer": "null"}, "answer"),
        ({"answer": "3.5"}, "answer"),
        ({"evaluation": "1.23E+67"}, "evaluation"),
        ({"viewer": "Anna"}, "viewer"),
        ({"language": "de"}, "language"),
        ({"position": "0"}, "position"),
        ({"presentation": "triple"}, "presentation"),
        ({"side": "middle"}, "side"),
        ({"clip": "film"}, "clip"),
        ({"aspect": "feet"}, "aspect"),
        ({"scale": "beauty"}, "scale"),
        ({"seconds": "nan"}, "seconds"),
        ({"seconds": "-1"}, "seconds"),
        ({"seconds": ""}, "seconds"),
    ],
)
def test_a_wrong_value_is_named_with_its_line(columns: dict[str, str], column: str) -> None:
    error = refused(changed(3, **columns))
    assert error.message.id == "results.value"
    assert (error.message.arguments["line"], error.message.arguments["column"]) == (3, column)
    assert f"line 3: {column} is {columns[column]!r}" in error_text(error)


@pytest.mark.parametrize(
    ("content", "id", "line"),
    [
        (b"", "results.header", None),
        (b"PK\x03\x04" + bytes(30), "results.not_text", None),
        (CONTENT.decode().encode("utf-16"), "results.not_text", None),
        (CONTENT.replace(b"c01", "コ01".encode("cp932")), "results.not_text", None),
        (CONTENT.replace(b"viewer", b"person", 1), "results.header", None),
        ("\r\n".join(LINES[1:]).encode(), "results.header", None),
        (CONTENT[:-2], "results.cut_off", 3),
        (CONTENT[: CONTENT.rindex(b"body")], "results.cut_off", 3),
        (CONTENT[: CONTENT.rindex(b",body")] + b"\r\n", "results.row", 3),
        (f"{LINES[0]}\r\n".encode(), "results.empty", None),
        (changed(3, viewer="b0000002"), "results.viewers", 3),
        (changed(3, evaluation="c0ffee02"), "results.viewers", 3),
        (changed(3, position="1", clip="c01"), "results.repeated", 3),
        (changed(3, side="left"), "results.side", 3),
        (changed(3, presentation="pair"), "results.side", 3),
        (changed(3, clip='"c02'), "results.row", 3),
    ],
)
def test_what_is_no_whole_file_is_refused(content: bytes, id: str, line: int | None) -> None:
    error = refused(content)
    assert error.message.id == id
    assert error.message.arguments.get("line") == line


def test_a_huge_file_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "answers.csv"
    with path.open("wb") as stream:
        stream.truncate(MOST_BYTES + 1)
    with pytest.raises(FileError) as raised:
        read_answers(path)
    assert raised.value.message.id == "file.too_large"
