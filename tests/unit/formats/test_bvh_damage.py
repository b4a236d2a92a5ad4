"""BVH files with more or less text than usual are read as far as they are certain, and messages name the line."""

from __future__ import annotations

import codecs
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from app.errors import FileError, Message
from app.formats.bvh.read import decode_bvh
from app.rig.motion_file import read_motion_file
from tests.support.encoded import encode_bvh
from tests.unit.formats.test_bvh import clip

FRAMES = 12
TEXT = encode_bvh(clip(frames=FRAMES)).decode()
LINES = TEXT.splitlines()
HEAD, ROWS = LINES[:-FRAMES], LINES[-FRAMES:]
WIDTH = len(ROWS[0].split())

AFTER = {
    "a comment": "# exported by hand",
    "a comment of C": "// end of take 3",
    "a word": "END",
    "a word and numbers": "frames: 12",
    "a count": "12 frames written",
    "a sentence with commas": "Captured 3.5.2026, take 2, all rights reserved",
    "a brace": "}",
    "fewer numbers than a frame": "0 0 0",
    "more numbers than a frame": ROWS[0] + " 1 2 3",
    "another block": "\n".join(["}", "PROPERTIES", "{", "scale 1.0", "}"]),
    "another file": TEXT.rstrip(),
}


@pytest.mark.parametrize("name", AFTER)
def test_text_after_the_last_row_is_ignored_and_its_line_named(name: str) -> None:
    expected = decode_bvh(TEXT, "a.bvh")
    for blank in ("", "\n\n"):
        found = decode_bvh(f"{TEXT.rstrip()}\n{blank}{AFTER[name]}\n", "a.bvh")
        line = len(LINES) + 1 + len(blank)
        assert found.guesses == (Message("motion.text_ignored", {"line": line}),)
        np.testing.assert_array_equal(found.rotations_xyzw, expected.rotations_xyzw)


@pytest.mark.parametrize("name", ["a comment", "a word", "a brace"])
def test_text_after_the_rows_is_ignored_where_fewer_frames_came_than_stated(name: str) -> None:
    found = decode_bvh(f"{TEXT.rstrip()}\n{AFTER[name]}\n".replace("Frames: 12", "Frames: 13"), "a.bvh")
    assert [guess.id for guess in found.guesses] == ["motion.text_ignored", "motion.rows"]
    assert len(found.rotations_xyzw) == FRAMES


def test_comments_are_ignored_anywhere() -> None:
    commented = ["# a studio's name", *HEAD[:3], "  # the hips", *HEAD[3:], *ROWS[:4], "// cut 2", *ROWS[4:]]
    found = decode_bvh("\n".join(commented), "a.bvh")
    assert found.guesses == (Message("motion.text_ignored", {"line": 2 + len(HEAD) + 4 + 1}),)
    np.testing.assert_array_equal(found.rotations_xyzw, decode_bvh(TEXT, "a.bvh").rotations_xyzw)


def test_a_row_that_breaks_off_within_a_number_is_an_incomplete_row() -> None:
    found = decode_bvh(f"{TEXT.rstrip().rpartition(' ')[0]} -", "a.bvh")
    assert found.guesses == (Message("motion.row_cut", {"frames": FRAMES, "found": FRAMES - 1}),)


def _moved(rows: list[str], giving: int, taking: int) -> list[str]:
    """Rows of which one has a number more, another one less."""
    rows = list(rows)
    rows[taking] += " 4.5"
    rows[giving] = rows[giving].rpartition(" ")[0]
    return rows


@pytest.mark.parametrize(("long", "short"), [(3, 4), (4, 3), (2, 9), (9, 2), (0, 11), (10, 11)])
def test_a_long_and_a_short_row_are_not_read_as_if_numbers_slid_between_them(long: int, short: int) -> None:
    with pytest.raises(FileError) as raised:
        decode_bvh("\n".join([*HEAD, *_moved(ROWS, short, long)]), "a.bvh")
    first = min(long, short)
    found = WIDTH + (1 if long < short else -1)
    arguments = {"file": "a.bvh", "line": len(HEAD) + 1 + first, "found": found, "width": WIDTH}
    assert raised.value.message == Message("bvh.row", arguments)


@pytest.mark.parametrize("numbers", [1, 7, WIDTH - 1, WIDTH + 1, 5 * WIDTH, 10_000])
def test_numbers_in_lines_of_any_length_are_read(numbers: int) -> None:
    words = " ".join(ROWS).split()
    lines = [" ".join(words[at : at + numbers]) for at in range(0, len(words), numbers)]
    found = decode_bvh("\n".join([*HEAD, *lines]), "a.bvh")
    assert found.guesses == ()
    np.testing.assert_array_equal(found.rotations_xyzw, decode_bvh(TEXT, "a.bvh").rotations_xyzw)


def test_single_rows_may_be_broken_into_lines() -> None:
    broken = [*ROWS[:5], *ROWS[5].rsplit(" ", 9), *ROWS[6:]]
    found = decode_bvh("\n".join([*HEAD, *broken]), "a.bvh")
    assert found.guesses == ()
    np.testing.assert_array_equal(found.rotations_xyzw, decode_bvh(TEXT, "a.bvh").rotations_xyzw)


def test_damage_between_rows_is_named_by_its_line() -> None:
    for at, row in ((4, "a word"), (6, ROWS[6].replace("1", "x", 1)), (8, "nan " * WIDTH)):
        with pytest.raises(FileError) as raised:
            decode_bvh("\n".join([*HEAD, *ROWS[:at], row, *ROWS[at + 1 :]]), "a.bvh")
        assert raised.value.message.id == "bvh.number"
        assert raised.value.message.arguments["line"] == len(HEAD) + at + 1


def _closings() -> list[int]:
    """Indices of the lines that close a joint, not an end site."""
    return [at for at, line in enumerate(HEAD) if line.strip() == "}" and "OFFSET" not in HEAD[at - 1]]


@pytest.mark.parametrize("closing", _closings())
def test_a_missing_closing_brace_is_named_by_its_line(closing: int) -> None:
    with pytest.raises(FileError) as raised:
        decode_bvh("\n".join([*HEAD[:closing], *HEAD[closing + 1 :], *ROWS]), "a.bvh")
    # The line that followed the brace, now in its place.
    assert raised.value.message == Message("bvh.brace", {"file": "a.bvh", "line": closing + 1})


def test_a_missing_closing_brace_without_indentation_is_named_by_the_end_of_the_skeleton() -> None:
    flat = [line.strip() for line in LINES]
    closing = _closings()[0]
    with pytest.raises(FileError) as raised:
        decode_bvh("\n".join([*flat[:closing], *flat[closing + 1 :]]), "a.bvh")
    assert raised.value.message == Message("bvh.brace", {"file": "a.bvh", "line": flat.index("MOTION")})


def test_a_file_that_ends_within_its_skeleton_is_named_by_its_last_line() -> None:
    for lines in (5, 10, _closings()[-1]):
        with pytest.raises(FileError) as raised:
            decode_bvh("\n".join(LINES[:lines]), "a.bvh")
        assert raised.value.message == Message("bvh.truncated", {"file": "a.bvh", "line": lines})


def test_motion_without_the_word_is_read() -> None:
    line = LINES.index("MOTION") + 1
    found = decode_bvh("\n".join([*LINES[: line - 1], *LINES[line:]]), "a.bvh")
    assert found.guesses == (Message("motion.no_keyword", {"line": line}),)
    np.testing.assert_array_equal(found.rotations_xyzw, decode_bvh(TEXT, "a.bvh").rotations_xyzw)


@pytest.mark.parametrize("kept", ["", "MOTION\n", "MOTION\nFrames: 12\n"])
def test_motion_without_its_head_is_named_by_its_line(kept: str) -> None:
    skeleton = TEXT.split("MOTION")[0]
    with pytest.raises(FileError) as raised:
        decode_bvh(skeleton + kept, "a.bvh")
    assert raised.value.message.id == "bvh.no_frames"
    assert raised.value.message.arguments["line"] == len(skeleton.splitlines()) + bool(kept)


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be", "utf-8"])
@pytest.mark.parametrize("mark", [True, False])
@pytest.mark.parametrize("ends", ["\n", "\r\n", "\r"])
def test_encodings_and_line_ends_are_recognised(encoding: str, mark: bool, ends: str, tmp_path: Path) -> None:
    marks = {"utf-16-le": codecs.BOM_UTF16_LE, "utf-16-be": codecs.BOM_UTF16_BE, "utf-8": codecs.BOM_UTF8}
    path = tmp_path / "a.bvh"
    path.write_bytes(mark * marks[encoding] + TEXT.replace("\n", ends).encode(encoding))
    np.testing.assert_array_equal(read_motion_file(path).rotations_xyzw, decode_bvh(TEXT, "a").rotations_xyzw)


CHANGES: dict[str, Callable[[str], str]] = {
    "tabs": lambda text: text.replace(" ", "\t"),
    "blanks at the ends of lines": lambda text: text.replace("\n", "  \n"),
    "a tab at the ends of lines": lambda text: text.replace("\n", "\t\n"),
    "numbers with an exponent": lambda text: re.sub(r"(?<=\.\d{6})(?=[ \n])", "e+00", text),
    "no line end": lambda text: text.rstrip(),
    "a form feed": lambda text: text + "\f\n",
    "an end of file of DOS": lambda text: text + "\x1a",
    "a null byte": lambda text: text + "\0",
}


@pytest.mark.parametrize("name", CHANGES)
def test_blanks_do_not_matter(name: str) -> None:
    found = decode_bvh(CHANGES[name](TEXT), "a.bvh")
    np.testing.assert_array_equal(found.rotations_xyzw, decode_bvh(TEXT, "a.bvh").rotations_xyzw)
