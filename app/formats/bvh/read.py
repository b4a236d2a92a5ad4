"""Reading of BVH files of any program.

Programs differ in capitals, blanks and braces, in the number of rows relative to "Frames:", and in the unit of the
frame time; some write a byte order mark, scales, or several skeletons. Guesses are recorded in the clip.
"""

from __future__ import annotations

import codecs
import os
import re
from collections.abc import Iterator
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from typing import Final

import numpy as np

from app.arrays import AnyFloatArray, FloatArray
from app.errors import FileError, Message, shortened
from app.formats import euler
from app.formats.bvh.clip import AXES, POSITIONS, BvhClip
from app.formats.bvh.rows import COMMENTS, read_rows, without_commas
from app.formats.files import read_file
from app.formats.rates import exact_rate

MOST_BYTES: Final = 2**29
_DEEPEST: Final = 512
_FREE_ROTATIONS: Final = 2**20
_CHANNELS: Final = {name.lower(): name for axis in AXES for name in (f"{axis}position", f"{axis}rotation")}
_SCALES: Final = frozenset(f"{axis.lower()}scale" for axis in AXES)
_MILLISECONDS: Final = (2.0, 200.0)
"""Range of frame times that are milliseconds (5 to 500 frames per second); in seconds they would be too slow for
motion.
"""
_RATES: Final = (
    *(12, 15, 23.976, 24, 25, 29.97, 30, 48, 50, 59.94, 60, 72, 75, 90),
    *(100, 119.88, 120, 144, 150, 180, 200, 240, 250, 300, 360, 480, 500),
)
"""Frame rates of film, games and motion capture. A frame time near one of them is read as that rate, unless it also
fits a rate in milliseconds.
"""
_NEAR: Final = 0.002
"""Relative difference below which a rate equals one of `_RATES`."""
_MOTION: Final = re.compile(r"(?:^|[\r\n])[ \t]*MOTION(?=\s|$)", re.IGNORECASE)
_FRAMES_LINE: Final = re.compile(r"(?=[\r\n][ \t]*Frames\s*:)", re.IGNORECASE)
_FRAMES: Final = re.compile(r"\s*Frames\s*:\s*(\S+)\s+Frame[ \t]*Time\s*:\s*(\S+)", re.IGNORECASE)
_BRACES: Final = re.compile(r"([{}])")


def read_bvh(path: str | os.PathLike[str], figure: str = "") -> BvhClip:
    """Read a BVH file with any channels in any order, including positions of joints other than the root.

    Position channels replace the offset, as in most programs; a root offset is ignored. Rotations are applied in the
    order of their channels; missing axes have angle 0.

    Parameters
    ----------
    figure : str
        Name of the skeleton to read if there are several (`BvhClip.figures`); empty for the first.

    Raises
    ------
    FileError
        The file is no valid BVH file, or has no skeleton of that name.
    """
    data = read_file(path, MOST_BYTES)
    return decode_bvh(data.decode(encoding(data), "replace"), os.fspath(path), figure)


def encoding(data: bytes) -> str:
    """Return the encoding of the text that begins with these bytes; UTF-16 is recognised without a mark too."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    if b"\0" in data[:2]:
        return "utf-16-be" if data[:1] == b"\0" else "utf-16-le"
    return "utf-8-sig"


def decode_bvh(text: str, file: str, figure: str = "") -> BvhClip:
    """Parse the text of a BVH file; see `read_bvh`. ``file`` is its name for messages."""
    found, headless = _MOTION.search(text), _FRAMES_LINE.search(text)
    start, stop = found.span() if found else headless.span() if headless else (len(text), len(text))
    skeleton = _Skeleton(file)
    skeleton.read(text[:start], is_all=start == len(text))
    line = len(text[:stop].splitlines())
    clip = _motion(text[stop:], skeleton, line, figure)
    if found:
        return clip
    return replace(clip, guesses=(Message("motion.no_keyword", {"line": line + 1}), *clip.guesses))


class _Skeleton:
    """The joints of all skeletons of a file while it is parsed."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.names: list[str] = []
        self.parents: list[int] = []
        self.offsets: list[list[float]] = []
        self.channels: list[list[str]] = []
        self.end_sites: dict[int, FloatArray] = {}
        self.lines = 0

    @property
    def roots(self) -> list[int]:
        """Return the index of each skeleton's root joint."""
        return [joint for joint, parent in enumerate(self.parents) if parent < 0]

    def figure(self, first: int) -> _Skeleton:
        """Return the skeleton with the root joint ``first``, with its joints counted from 0."""
        stop = next((root for root in self.roots if root > first), len(self.names))
        found, own = _Skeleton(self.file), slice(first, stop)
        found.names, found.offsets, found.channels = self.names[own], self.offsets[own], self.channels[own]
        found.parents = [-1, *(parent - first for parent in self.parents[first + 1 : stop])]
        found.end_sites = {joint - first: end for joint, end in self.end_sites.items() if first <= joint < stop}
        return found

    def read(self, head: str, *, is_all: bool) -> None:
        """Parse the skeletons; ``is_all`` if nothing follows in the file."""
        pieces = ((number, piece.split()) for number, line in _lines(head) for piece in _BRACES.split(line))
        rows = ((number, words) for number, words in pieces if words)
        self.lines = len(head.splitlines())
        number, words = self._next(rows)
        if [word.upper() for word in words] != ["HIERARCHY"]:
            raise self._syntax(number, words)
        open_joints: list[int] = []
        for number, words in rows:
            key = words[0].upper()
            if key == ("JOINT" if open_joints else "ROOT") and len(words) > 1:
                self._open(number, "_".join(words[1:]), open_joints)
                self._brace(rows)
            elif open_joints and "".join(words[:2]).upper().startswith("ENDSITE"):
                self._brace(rows)
                number, words = self._next(rows)
                self.end_sites[open_joints[-1]] = np.array(self._offset(number, words))
                self._brace(rows, "}")
            elif key == "OFFSET" and open_joints:
                self.offsets[open_joints[-1]] = self._offset(number, words)
            elif key == "CHANNELS" and open_joints:
                self._channels(number, words, open_joints[-1])
            elif words == ["}"] and open_joints:
                open_joints.pop()
            else:
                raise self._syntax(number, words)
        if open_joints and not is_all:
            raise FileError("bvh.brace", file=self.file, line=_unclosed(head))
        if open_joints or not self.names:
            raise FileError("bvh.truncated", file=self.file, line=self.lines)

    def _open(self, number: int, name: str, open_joints: list[int]) -> None:
        if len(open_joints) >= _DEEPEST:
            raise FileError("bvh.unsupported", file=self.file, line=number, what="a skeleton nested so deeply")
        self.parents.append(open_joints[-1] if open_joints else -1)
        open_joints.append(len(self.names))
        self.names.append(name)
        self.offsets.append([0.0, 0.0, 0.0])
        self.channels.append([])

    def _channels(self, number: int, words: list[str], joint: int) -> None:
        names = [name.lower() for name in words[2:]]
        if words[1:2] != [str(len(names))]:
            raise self._syntax(number, words)
        if len(set(names)) != len(names) or not set(names) <= _CHANNELS.keys() | _SCALES:
            raise FileError("bvh.unsupported", file=self.file, line=number, what=shortened(" ".join(words[2:]), 80))
        self.channels[joint] = [_CHANNELS.get(name, "") for name in names]

    def _offset(self, number: int, words: list[str]) -> list[float]:
        try:
            values = [float(word) for word in without_commas([words[1:]], 3)[0]]
        except ValueError as error:
            raise self._syntax(number, words) from error
        if words[0].upper() != "OFFSET" or len(values) != 3 or not np.isfinite(values).all():
            raise self._syntax(number, words)
        return values

    def _next(self, rows: Iterator[tuple[int, list[str]]]) -> tuple[int, list[str]]:
        row = next(rows, None)
        if row is None:
            raise FileError("bvh.truncated", file=self.file, line=self.lines)
        return row

    def _brace(self, rows: Iterator[tuple[int, list[str]]], brace: str = "{") -> None:
        number, words = self._next(rows)
        if words != [brace]:
            raise self._syntax(number, words)

    def _syntax(self, number: int, words: list[str]) -> FileError:
        return FileError("bvh.syntax", file=self.file, line=number, found=" ".join(words)[:40])


def _lines(text: str) -> Iterator[tuple[int, str]]:
    numbered = enumerate(text.splitlines(), start=1)
    return ((number, line) for number, line in numbered if not line.lstrip().startswith(COMMENTS))


def _unclosed(head: str) -> int:
    """Line of a skeleton before which a closing brace is missing: where the indentation goes back, else the line after
    the last one.
    """
    outer: list[int] = []
    indented = any(line[:1].isspace() for _, line in _lines(head))
    for number, line in _lines(head):
        words, depth = line.upper().split(), len(line) - len(line.lstrip())
        opens = bool(words) and words[0].startswith(("ROOT", "JOINT", "END"))
        if indented and words and outer and (depth < outer[-1] or (opens and depth == outer[-1])):
            return number
        outer += [depth] * opens
        del outer[max(0, len(outer) - line.count("}")) :]
    return len(head.splitlines()) + 1


def _is_number(word: str) -> bool:
    try:
        return bool(np.isfinite(float(word)))
    except ValueError:
        return False


def _motion(motion: str, skeleton: _Skeleton, line: int, figure: str) -> BvhClip:
    """Parse the text after MOTION, which begins at the line number ``line``, for one skeleton of the file."""
    file = skeleton.file
    said = _FRAMES.match(motion)
    if said is None:
        raise FileError("bvh.no_frames", file=file, line=max(1, line))
    frames_line, time_line = (line - 1 + len(motion[: said.end(group)].splitlines()) for group in (1, 2))
    frames = _whole(said[1])
    # A decimal comma is accepted.
    written = said[2].replace(",", ".", 1)
    frame_time = float(written) if _is_number(written) else 0.0
    if not 1e-6 < frame_time < 1e6:
        raise FileError("bvh.frame_time", file=file, line=time_line, found=said[2][:40])
    if not 1 <= frames < 2**31:
        raise FileError("bvh.frames", file=file, line=frames_line, found=said[1][:40])
    width = sum(len(channels) for channels in skeleton.channels)
    before_table = line - 1 + len(motion[: said.end()].splitlines())
    values, guesses = read_rows(motion[said.end() :], frames, width, file, before_table)
    roots = skeleton.roots
    names = _numbered([skeleton.names[joint] for joint in roots])
    if figure and figure not in names:
        raise FileError("motion.no_figure", file=file, figure=figure, figures=shortened(", ".join(names), 200))
    if len(roots) > 1:
        first = roots[names.index(figure) if figure else 0]
        before = sum(len(channels) for channels in skeleton.channels[:first])
        skeleton, values = skeleton.figure(first), values[:, before:]
    fps, rate_guess = _rate(frame_time, written)
    clip = _clip(values, skeleton, fps, rate_guess, guesses)
    return replace(clip, figures=tuple(names), figure=figure or names[0]) if len(names) > 1 else clip


def _whole(word: str) -> int:
    """Parse a whole number; 0 for any other text."""
    try:
        return int(word)
    except ValueError:
        return 0


def _numbered(names: list[str]) -> list[str]:
    """Return names made unique: the second "Hips" becomes "Hips (2)"."""
    earlier = [names[:at].count(name) for at, name in enumerate(names)]
    return [f"{name} ({before + 1})" if before else name for name, before in zip(names, earlier, strict=True)]


def _clip(
    table: FloatArray,
    skeleton: _Skeleton,
    fps: Fraction,
    rate_guess: Message | None,
    guesses: tuple[Message, ...],
) -> BvhClip:
    """Return the clip of a skeleton from the table of its channels; the table may have further columns of other
    skeletons.
    """
    frames, joints = len(table), len(skeleton.names)
    if frames * joints > _FREE_ROTATIONS + 4 * table.size:
        # Joints need no channels, and then cost the file no bytes in a frame.
        raise FileError("bvh.too_large", file=skeleton.file)
    offsets = np.array(skeleton.offsets)
    offsets[0] = 0.0
    rotations = np.zeros((frames, joints, 4))
    rotations[..., 3] = 1.0
    translations: dict[int, AnyFloatArray] = {}
    column = 0
    for joint, channels in enumerate(skeleton.channels):
        columns = table[:, column : column + len(channels)]
        column += len(channels)
        turned = [at for at, name in enumerate(channels) if name.endswith("rotation")]
        placed = [at for at, name in enumerate(channels) if name in POSITIONS]
        if turned:
            rotations[:, joint] = _rotations(columns[:, turned], "".join(channels[at][0] for at in turned))
        if placed or not joint:
            places = np.tile(offsets[joint], (frames, 1))
            for at in placed:
                places[:, AXES.index(channels[at][0])] = columns[:, at]
            translations[joint] = places
    root_translation = translations.pop(0)
    for joint in [joint for joint, places in translations.items() if (places == places[0]).all()]:
        offsets[joint] = translations.pop(joint)[0]
    return BvhClip(
        tuple(skeleton.names),
        tuple(skeleton.parents),
        offsets,
        skeleton.end_sites,
        fps,
        root_translation,
        rotations,
        translations,
        rate_guess,
        guesses,
    )


def _rotations(angles_degrees: AnyFloatArray, order: str) -> FloatArray:
    """Return quaternions (F, 4) from angles (F, up to 3) in degrees about the axes in ``order``; missing axes have
    angle 0.
    """
    missing = "".join(axis for axis in AXES if axis not in order)
    return euler.quaternions(np.pad(angles_degrees, ((0, 0), (0, len(missing)))), order + missing)


def _rate(frame_time: float, written: str) -> tuple[Fraction, Message | None]:
    """Return the frame rate for a frame time, which is often rounded (.03333 is 30 frames per second), and a note if it
    was guessed.

    A number that is impossible in seconds is taken as milliseconds, or as the rate itself.
    """
    digit = float(Decimal(10) ** int(Decimal(written).as_tuple().exponent))
    accuracy = 0.5 * digit / frame_time
    if frame_time >= _MILLISECONDS[0] and _is_usual(frame_time, 0.0) and not _is_usual(1000 / frame_time, accuracy):
        rate = exact_rate(frame_time, accuracy)
        return rate, Message("motion.rate_as_time", {"rate": str(rate), "said": frame_time})
    if _MILLISECONDS[0] <= frame_time <= _MILLISECONDS[1]:
        rate = exact_rate(1000 / frame_time, accuracy)
        return rate, Message("motion.milliseconds", {"rate": str(rate), "said": frame_time})
    return exact_rate(1 / frame_time, accuracy), None


def _is_usual(fps: float, accuracy: float) -> bool:
    return any(abs(fps - rate) <= max(_NEAR, accuracy) * rate for rate in _RATES)
