"""BVH files of any program.

Messages (with ``file``): ``file.cannot_read``, ``bvh.syntax``, ``bvh.truncated``, ``bvh.motion``,
``bvh.no_frames``, ``bvh.number``,
``bvh.frame_time`` (found), ``bvh.frames`` (found), ``bvh.too_large``, ``bvh.unsupported``.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from decimal import Decimal
from fractions import Fraction

import numpy as np

from app.arrays import AnyFloatArray, FloatArray
from app.errors import FileError, shortened
from app.formats import euler
from app.formats.bvh.clip import AXES, POSITIONS, BvhClip
from app.formats.files import read_file
from app.formats.rates import exact_rate

_DEEPEST = 512
_FREE_ROTATIONS = 2**20
_MILLISECONDS = (2.0, 200.0)
"""A frame time in this range would be of 5 to 500 frames per second in milliseconds, and in seconds of no motion."""
MOST_BYTES = 2**29


def read_bvh(path: str | os.PathLike[str]) -> BvhClip:
    """Read a BVH file with any channels in any order, also with positions of joints other than the root.

    Position channels take the place of the offset, as in most programs; a root offset is left out. Rotations are about
    the axes in the order of their channels, where one is missing by 0.

    Raises
    ------
    FileError
        If it is no such file.
    """
    file = os.fspath(path)
    text = read_file(path, MOST_BYTES).decode("utf-8", "replace")
    return decode_bvh(text, file)


def decode_bvh(text: str, file: str) -> BvhClip:
    """Clip of a file's text, as `read_bvh`."""
    head, _, motion = text.partition("MOTION")
    hierarchy = _Hierarchy(file)
    hierarchy.read(head)
    return _motion(motion, hierarchy, file)


class _Hierarchy:
    """The skeleton as it is read."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.names: list[str] = []
        self.parents: list[int] = []
        self.offsets: list[list[float]] = []
        self.channels: list[list[str]] = []
        self.end_sites: dict[int, FloatArray] = {}

    def read(self, head: str) -> None:
        lines = ((number, line.split()) for number, line in enumerate(head.splitlines(), start=1))
        rows = ((number, words) for number, words in lines if words)
        number, words = self._next(rows)
        if words != ["HIERARCHY"]:
            raise self._syntax(number, words)
        open_joints: list[int] = []
        for number, words in rows:
            if (
                words[0] == ("JOINT" if self.names else "ROOT")
                and len(words) > 1
                and bool(open_joints or not self.names)
            ):
                self._open(number, "_".join(words[1:]), open_joints)
                self._brace(rows)
            elif words[:2] == ["End", "Site"] and open_joints:
                self._brace(rows)
                number, words = self._next(rows)
                self.end_sites[open_joints[-1]] = np.array(self._offset(number, words))
                self._brace(rows, "}")
            elif words[0] == "OFFSET" and open_joints:
                self.offsets[open_joints[-1]] = self._offset(number, words)
            elif words[0] == "CHANNELS" and open_joints:
                self._channels(number, words, open_joints[-1])
            elif words == ["}"] and open_joints:
                open_joints.pop()
            else:
                raise self._syntax(number, words)
        if open_joints or not self.names:
            raise FileError("bvh.truncated", file=self.file)

    def _open(self, number: int, name: str, open_joints: list[int]) -> None:
        if len(open_joints) >= _DEEPEST:
            raise FileError("bvh.unsupported", file=self.file, line=number, what="a skeleton nested so deeply")
        self.parents.append(open_joints[-1] if open_joints else -1)
        open_joints.append(len(self.names))
        self.names.append(name)
        self.offsets.append([0.0, 0.0, 0.0])
        self.channels.append([])

    def _channels(self, number: int, words: list[str], joint: int) -> None:
        names = words[2:]
        if words[1:2] != [str(len(names))]:
            raise self._syntax(number, words)
        known = {*POSITIONS, *(f"{axis}rotation" for axis in AXES)}
        if len(set(names)) != len(names) or not known.issuperset(names):
            raise FileError("bvh.unsupported", file=self.file, line=number, what=shortened(" ".join(names), 80))
        self.channels[joint] = names

    def _offset(self, number: int, words: list[str]) -> list[float]:
        try:
            values = [float(word) for word in words[1:]]
        except ValueError as error:
            raise self._syntax(number, words) from error
        if words[0] != "OFFSET" or len(values) != 3 or not np.isfinite(values).all():
            raise self._syntax(number, words)
        return values

    def _next(self, rows: Iterator[tuple[int, list[str]]]) -> tuple[int, list[str]]:
        row = next(rows, None)
        if row is None:
            raise FileError("bvh.truncated", file=self.file)
        return row

    def _brace(self, rows: Iterator[tuple[int, list[str]]], brace: str = "{") -> None:
        number, words = self._next(rows)
        if words != [brace]:
            raise self._syntax(number, words)

    def _syntax(self, number: int, words: list[str]) -> FileError:
        return FileError("bvh.syntax", file=self.file, line=number, found=" ".join(words)[:40])


def _motion(motion: str, hierarchy: _Hierarchy, file: str) -> BvhClip:
    words = motion.split()
    try:
        if words[0] != "Frames:" or words[2:4] != ["Frame", "Time:"]:
            raise FileError("bvh.no_frames", file=file)
        frames, frame_time = int(words[1]), float(words[4])
        values = np.array(words[5:], dtype=np.float64)
    except (IndexError, ValueError) as error:
        raise FileError("bvh.number", file=file) from error
    width = sum(len(channels) for channels in hierarchy.channels)
    if not 1e-6 < frame_time < 1e6:
        raise FileError("bvh.frame_time", file=file, found=words[4][:40])
    if not 1 <= frames < 2**31:
        raise FileError("bvh.frames", file=file, found=words[1][:40])
    if not np.isfinite(values).all():
        raise FileError("bvh.number", file=file)
    if len(values) != frames * width:
        raise FileError("bvh.motion", file=file, found=len(values), frames=frames, width=width)
    if frames * len(hierarchy.names) > _FREE_ROTATIONS + 4 * len(values):
        # Joints need not have channels, and then cost the file nothing in a frame.
        raise FileError("bvh.too_large", file=file)
    table = values.reshape(frames, width)
    offsets = np.array(hierarchy.offsets)
    offsets[0] = 0.0
    rotations = np.zeros((frames, len(hierarchy.names), 4))
    rotations[..., 3] = 1.0
    translations: dict[int, AnyFloatArray] = {}
    column = 0
    for joint, channels in enumerate(hierarchy.channels):
        columns = table[:, column : column + len(channels)]
        column += len(channels)
        turned = [at for at, name in enumerate(channels) if name not in POSITIONS]
        if turned:
            rotations[:, joint] = _rotations(columns[:, turned], "".join(channels[at][0] for at in turned))
        if len(turned) < len(channels) or not joint:
            places = np.tile(offsets[joint], (frames, 1))
            for at in set(range(len(channels))) - set(turned):
                places[:, AXES.index(channels[at][0])] = columns[:, at]
            translations[joint] = places
    root_translation = translations.pop(0)
    for joint in [joint for joint, places in translations.items() if (places == places[0]).all()]:
        offsets[joint] = translations.pop(joint)[0]
    mistaken = _MILLISECONDS[0] <= frame_time <= _MILLISECONDS[1]
    return BvhClip(
        tuple(hierarchy.names),
        tuple(hierarchy.parents),
        offsets,
        hierarchy.end_sites,
        _rate(frame_time, words[4], 1000 if mistaken else 1),
        root_translation,
        rotations,
        translations,
        frame_time if mistaken else None,
    )


def _rotations(angles_degrees: AnyFloatArray, order: str) -> FloatArray:
    """Quaternions of angles (F, up to 3) about these axes; about the others by nothing."""
    missing = "".join(axis for axis in AXES if axis not in order)
    return euler.quaternions(np.pad(angles_degrees, ((0, 0), (0, len(missing)))), order + missing)


def _rate(frame_time: float, written: str, units_per_s: int) -> Fraction:
    """The rate that a frame time means, which is often written with few digits: .03333 is 30 frames per second."""
    digit = float(Decimal(10) ** int(Decimal(written).as_tuple().exponent))
    return exact_rate(units_per_s / frame_time, 0.5 * digit / frame_time)
