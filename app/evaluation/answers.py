"""Viewers' answers: the files that the questionnaire page writes, one for each viewer.

A file may be as written by the page or saved again by a spreadsheet: with or without a byte order mark, separated by
commas, semicolons or tabs, and with decimal commas. Other deviations are refused.
"""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Final, Literal

import msgspec
from msgspec import Meta

from app.errors import FileError, shortened
from app.evaluation.key import STEPS, Aspect, Presentation, Scale
from app.formats.files import read_file

MOST_BYTES: Final = 4_000_000
MOST_S: Final = 1e7
_SEPARATORS: Final = ",;\t"
_LONGEST: Final = 60
"""Greatest number of characters quoted of an invalid value."""


class Answer(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """One answer of one viewer about one clip.

    Attributes
    ----------
    evaluation : str
        Id of the evaluation, as in its key.
    viewer : str
        Id that the page assigned to the viewer.
    language : {"en", "ja"}
        Language of the page.
    position : int
        Number of the clip or pair in the order of this viewer, from 1.
    presentation : {"single", "pair"}
        Whether the clip was shown alone or beside another one.
    side : {"left", "right", ""}
        Side within a pair; empty for a single clip.
    clip : str
        Code of the clip as in the key.
    aspect, scale : str
        The question: the aspect that was judged, and the scale of the answer.
    answer : int or None
        1 (worst) to `STEPS` (best); None where the viewer chose "cannot judge".
    seconds : float
        Seconds from the first showing to the answer.
    """

    evaluation: Annotated[str, Meta(pattern="^[0-9a-f]{8}$")]
    viewer: Annotated[str, Meta(pattern="^[0-9a-f]{8}$")]
    language: Literal["en", "ja"]
    position: Annotated[int, Meta(ge=1, le=100_000)]
    presentation: Presentation
    side: Literal["left", "right", ""]
    clip: Annotated[str, Meta(pattern="^c[0-9]{2,4}$")]
    aspect: Aspect
    scale: Scale
    answer: Annotated[int, Meta(ge=1, le=STEPS)] | None
    seconds: Annotated[float, Meta(ge=0.0, le=MOST_S)]

    @property
    def question(self) -> tuple[int, str, str, str, str]:
        """Return the key of the question, which a viewer answers once."""
        return self.position, self.side, self.clip, self.aspect, self.scale


COLUMNS: Final = Answer.__struct_fields__
"""Columns of the file's header in order."""

_EXPECTED: Final = {
    "evaluation": "8 hexadecimal digits",
    "viewer": "8 hexadecimal digits",
    "language": "en, ja",
    "position": "1, 2, 3 ...",
    "presentation": "single, pair",
    "side": "left, right",
    "clip": "c01, c02 ...",
    "aspect": "fingers_arms, body, mouth, ensemble",
    "scale": "naturalness, synchrony",
    "answer": "1, 2, 3, 4, 5",
    "seconds": "12.3",
}


class ViewerFile(msgspec.Struct, frozen=True):
    """The answers of one viewer of an evaluation, read from a file.

    Attributes
    ----------
    path : Path
        The file that was read.
    answers : tuple of Answer
        Answers, at least one, all by the same viewer.
    lines : tuple of int
        Line number of each answer in the file, from 1.
    """

    path: Path
    answers: tuple[Answer, ...]
    lines: tuple[int, ...]

    @property
    def viewer(self) -> str:
        """The id of the viewer who gave the answers in the file."""
        return self.answers[0].viewer

    @property
    def evaluation(self) -> str:
        """The id of the evaluation to which the answers in the file belong."""
        return self.answers[0].evaluation


def read_answers(path: Path) -> ViewerFile:
    """Read the answers in the file of one viewer.

    Raises
    ------
    FileError
        The file cannot be read or is not a valid file of answers.
    """
    return decode_answers(read_file(path, MOST_BYTES), path)


def decode_answers(content: bytes, path: Path) -> ViewerFile:
    """Parse the content of a viewer's file; ``path`` names the file in errors. Raises as `read_answers`."""
    file = str(path)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FileError("results.not_text", file=file) from error
    if "\0" in text:
        raise FileError("results.not_text", file=file)
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    header = lines[0]
    separator = max(_SEPARATORS, key=header.count)
    if tuple(_fields(header, separator)) != COLUMNS:
        raise FileError("results.header", file=file, expected=",".join(COLUMNS))
    if lines[-1]:
        # Digits may be missing in the last field of the line.
        raise FileError("results.cut_off", file=file, line=len(lines))
    rows = [
        (number, _fields(line, separator))
        for number, line in enumerate(lines[1:], start=2)
        if line.strip(_SEPARATORS + " ")  # spreadsheets may leave empty rows
    ]
    if not rows:
        raise FileError("results.empty", file=file)
    found = ViewerFile(path, tuple(_answer(row, line, file) for line, row in rows), tuple(line for line, _ in rows))
    _check_whole(found)
    return found


def encode_answers(answers: Sequence[Answer]) -> bytes:
    """Format answers as a CSV file, like the evaluation's web page does."""
    lines = [",".join(COLUMNS)]
    for answer in answers:
        values = msgspec.structs.asdict(answer) | {"seconds": f"{answer.seconds:.1f}"}
        lines.append(",".join("" if value is None else str(value) for value in values.values()))
    return ("\ufeff" + "".join(f"{line}\r\n" for line in lines)).encode()


def _fields(line: str, separator: str) -> list[str]:
    """Split a line into its fields. Fields never contain line ends, so an unclosed quote affects only its own line."""
    try:
        rows = list(csv.reader([line], delimiter=separator))
    except csv.Error:
        return [line]
    return [field.strip() for field in rows[0]] if rows else []


def _answer(row: Sequence[str], line: int, file: str) -> Answer:
    if len(row) != len(COLUMNS):
        raise FileError("results.row", file=file, line=line, found=len(row), expected=len(COLUMNS))
    values: dict[str, object] = {}
    for column, field in zip(COLUMNS, row, strict=True):
        raw = field.replace(",", ".") if column == "seconds" else field
        try:
            # "Cannot judge" is stored as an empty field; decoding with None would accept the word "null".
            empty = column == "answer" and not raw
            values[column] = None if empty else msgspec.convert(raw, _KINDS[column], strict=False)
        except msgspec.ValidationError as error:
            quoted, expected = shortened(field, _LONGEST), _EXPECTED[column]
            raise FileError(
                "results.value", file=file, line=line, column=column, found=quoted, expected=expected
            ) from error
    answer = Answer(**values)  # type: ignore[arg-type]
    if (answer.presentation == "pair") != bool(answer.side):
        raise FileError("results.side", file=file, line=line)
    return answer


def _check_whole(found: ViewerFile) -> None:
    """Raise FileError unless the file is of one viewer and one evaluation, without repeated answers."""
    known: dict[tuple[int, str, str, str, str], int] = {}
    for answer, line in zip(found.answers, found.lines, strict=True):
        if (answer.viewer, answer.evaluation) != (found.viewer, found.evaluation):
            raise FileError("results.viewers", file=str(found.path), line=line)
        first = known.setdefault(answer.question, line)
        if first != line:
            raise FileError("results.repeated", file=str(found.path), line=line, first=first)


_KINDS: Final = {field.name: field.type for field in msgspec.structs.fields(Answer)} | {
    "answer": Annotated[int, Meta(ge=1, le=STEPS)]
}
