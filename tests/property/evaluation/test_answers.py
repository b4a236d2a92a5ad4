"""Any content of a viewer's file is read or refused with the program's error."""

from __future__ import annotations

import contextlib
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from app.errors import FileError
from app.evaluation.answers import Answer, decode_answers, encode_answers
from app.evaluation.key import ASPECTS, SCALES
from app.evaluation.results import tabulate
from app.messages import LANGUAGES, text
from tests.support.viewers import answer_of, key_of

FILE = Path("answers.csv")
KEY = key_of(excerpts=1)
CODES = [clip.code for clip in KEY.clips]


@st.composite
def answers(draw: st.DrawFn) -> list[Answer]:
    """Some of one viewer, each question once."""
    shown = draw(st.lists(st.lists(st.sampled_from(CODES), min_size=1, max_size=2), min_size=1, max_size=4))
    found = []
    for position, codes in enumerate(shown, start=1):
        pair = len(codes) == 2
        for side, code in zip(("left", "right") if pair else ("",), codes, strict=True):
            for aspect in draw(st.lists(st.sampled_from(ASPECTS), min_size=1, max_size=2, unique=True)):
                found.append(
                    answer_of(
                        code,
                        position=position,
                        presentation="pair" if pair else "single",
                        side=side,
                        aspect=aspect,
                        scale=draw(st.sampled_from(SCALES)),
                        answer=draw(st.none() | st.integers(1, 5)),
                        seconds=draw(st.integers(0, 9999)) / 10.0,
                    )
                )
    return found


def only_our_error(content: bytes) -> None:
    """Check that a file is read or refused with texts in both languages, and tabulated or refused."""
    error = None
    try:
        tabulate(KEY, [decode_answers(content, FILE)])
    except FileError as raised:
        error = raised
    if error is not None:
        assert [text(error.message, language) for language in LANGUAGES]


@given(answers())
def test_answers_survive_the_file(given_answers: list[Answer]) -> None:
    assert list(decode_answers(encode_answers(given_answers), FILE).answers) == given_answers


@given(st.binary(max_size=200))
def test_bytes(content: bytes) -> None:
    only_our_error(content)


@given(answers(), st.data())
def test_damage(given_answers: list[Answer], data: st.DataObject) -> None:
    content = bytearray(encode_answers(given_answers))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(content) - 1))
        kind = data.draw(st.sampled_from(("set", "cut", "remove", "repeat")))
        if kind == "set":
            content[at] = data.draw(st.integers(0, 255))
        elif kind == "cut" and at:
            del content[at:]
        elif kind == "remove" and len(content) > 1:
            del content[at]
        else:
            content[at:at] = content[at : at + 40]
    only_our_error(bytes(content))


@given(answers(), st.text(max_size=30), st.integers(0, 10))
def test_any_text_as_a_value(given_answers: list[Answer], value: str, column: int) -> None:
    lines = encode_answers(given_answers).decode().split("\r\n")
    fields = lines[1].split(",")
    fields[column] = value
    with contextlib.suppress(UnicodeEncodeError):
        only_our_error("\r\n".join([lines[0], ",".join(fields), *lines[2:]]).encode())
