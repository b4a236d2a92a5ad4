"""``.choreography`` files: a learned choreography with its motion, provenance and licence texts.

A JSON document with each row of a table on its own line: readable data first, the motion (little-endian float32 in
base64) last. Names in it are only texts and never paths.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.choreography.body import ENDS, SEGMENTS
from app.choreography.clip import BodyShape, MotionClip
from app.choreography.model import ChoreographyModel, MotionSegment, TrainingPair
from app.choreography.rhythm import SYMBOLS
from app.errors import FileError, shortened
from app.formats.atomic import atomic_write
from app.formats.files import read_file
from app.formats.json_data import decode_json

VERSION: Final = 2
"""Version of the format; files of version 1 lack the sounds during each motion."""
MOST_BYTES: Final = 128 * 2**20
"""About an hour and a half of motion."""
FPS: Final = (1, 240)
LARGEST_M: Final = 1000.0
"""Greatest distance in metres of a body from its start, and greatest length of a bone."""
LARGEST_S: Final = 24 * 3600.0
UNIT: Final = 1e-4
"""Tolerance of the norms of quaternions and of the sums of probabilities."""

_FPS = re.compile(r"[1-9][0-9]{0,8}(?:/[1-9][0-9]{0,8})?", re.ASCII)


class _Version(msgspec.Struct):
    choreography_version: int


class _Body(msgspec.Struct, forbid_unknown_fields=True):
    offsets_m: list[tuple[float, float, float]]
    ends_m: list[tuple[float, float, float]]


class _Motion(msgspec.Struct, forbid_unknown_fields=True):
    """A clip's motion in a choreography file: hips and rotations as bytes of arrays, which JSON stores as base64."""

    frames: int
    hips_m: bytes
    rotations: bytes


class _File(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    choreography_version: int
    name: str
    fps: str
    sources: list[TrainingPair]
    initial: list[float]
    transition: list[list[float]]
    emission: list[list[float]]
    segments: list[tuple[int, int, int, int, int]]
    """Clip, start, accent, end, state."""
    sounds: list[list[int]] = []
    """Symbols during each segment."""
    melodies: list[list[int]] = []
    """Symbols of the melody in addition to percussion."""
    bodies: list[_Body]
    motions: list[_Motion]


_DECODER = msgspec.json.Decoder(_File)


def write_model(path: str | os.PathLike[str], model: ChoreographyModel) -> None:
    """Write a model to a file atomically; motion is stored as float32.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    content = encode_model(model)
    with atomic_write(path) as stream:
        stream.write(content)


def read_model(path: str | os.PathLike[str]) -> ChoreographyModel:
    """Read a model.

    Raises
    ------
    FileError
        The file cannot be read, or is no choreography.
    """
    return decode_model(read_file(path, MOST_BYTES), os.fspath(path))


def encode_model(model: ChoreographyModel) -> bytes:
    """Return the contents of the ``.choreography`` file of a model."""
    fps = model.clips[0].fps
    content = _File(
        choreography_version=VERSION,
        name=model.name,
        fps=str(fps),
        sources=list(model.sources),
        initial=model.initial.tolist(),
        transition=model.transition.tolist(),
        emission=model.emission.tolist(),
        segments=[(one.clip, one.start, one.accent, one.end, one.state) for one in model.segments],
        sounds=[list(one.sounds) for one in model.segments],
        melodies=[list(one.melody) for one in model.segments],
        bodies=[_Body(clip.shape.offsets_m.tolist(), clip.shape.ends_m.tolist()) for clip in model.clips],
        motions=[
            _Motion(len(clip), clip.hips_m.astype("<f4").tobytes(), clip.rotations.astype("<f4").tobytes())
            for clip in model.clips
        ],
    )
    rows = [f'"{key}": {_rows(value)}' for key, value in msgspec.to_builtins(content).items()]
    return ("{\n" + ",\n".join(rows) + "\n}\n").encode("utf-8")


def _rows(value: Any) -> str:
    """Format a value as JSON with each element of a list on its own line."""
    if not isinstance(value, list):
        return msgspec.json.encode(value).decode("utf-8")
    return "[\n " + ",\n ".join(msgspec.json.encode(row).decode("utf-8") for row in value) + "\n]"


def decode_model(content: bytes, file: str) -> ChoreographyModel:
    """Parse the bytes of a ``.choreography`` file; parameters and errors as of `read_model`."""
    check = _Check(file)
    try:
        version = decode_json(content, _Version, file).choreography_version
        if version > VERSION:
            raise FileError("choreography.newer", file=file, version=version, known=VERSION)
        raw = decode_json(content, _DECODER, file)
    except FileError as error:
        if error.message.id != "json.invalid":
            raise
        raise check.error("JSON", str(error.message.arguments["detail"])) from error
    if version < 1:
        raise check.error("choreography_version", str(version))
    fps = check.fps(raw.fps)
    states = len(raw.initial)
    check.is_true("initial", 1 <= states <= len(raw.segments), f"{states} states of {len(raw.segments)} motions")
    check.is_true("sources", len(raw.sources) == len(raw.motions) >= 1, f"{len(raw.sources)} of {len(raw.motions)}")
    check.is_true("bodies", len(raw.bodies) == len(raw.motions), f"{len(raw.bodies)} of {len(raw.motions)}")
    for number, source in enumerate(raw.sources):
        check.source(f"sources[{number}]", source)
    clips = tuple(
        check.clip(number, fps, body, motion)
        for number, (body, motion) in enumerate(zip(raw.bodies, raw.motions, strict=True))
    )
    segments = tuple(MotionSegment(*row) for row in raw.segments)
    check.segments(segments, clips, states)
    for place, symbols in (("sounds", raw.sounds), ("melodies", raw.melodies)):
        check.symbols(place, symbols, len(segments))
    missing: list[list[int]] = [[]] * len(segments)
    heard = zip(segments, raw.sounds or missing, raw.melodies or missing, strict=True)
    segments = tuple(replace(one, sounds=tuple(sounds), melody=tuple(melody)) for one, sounds, melody in heard)
    return ChoreographyModel(
        name=raw.name,
        sources=tuple(raw.sources),
        clips=clips,
        segments=segments,
        transition=check.probabilities("transition", raw.transition, (states, states)),
        emission=check.probabilities("emission", raw.emission, (states, len(SYMBOLS))),
        initial=check.probabilities("initial", raw.initial, (states,)),
    )


class _Check:
    """Validates the contents of a choreography file; its errors name the wrong field."""

    def __init__(self, file: str) -> None:
        self._file = file

    def error(self, place: str, detail: str) -> FileError:
        return FileError("choreography.damaged", file=self._file, place=place, detail=shortened(detail))

    def is_true(self, place: str, condition: bool, detail: str) -> None:
        if not condition:
            raise self.error(place, detail)

    def fps(self, text: str) -> Fraction:
        self.is_true("fps", _FPS.fullmatch(text) is not None, text)
        fps = Fraction(text)
        self.is_true("fps", FPS[0] <= fps <= FPS[1], text)
        return fps

    def source(self, place: str, source: TrainingPair) -> None:
        self.is_true(f"{place}.offset_s", abs(source.offset_s) <= LARGEST_S, str(source.offset_s))
        confidence = source.offset_confidence
        self.is_true(f"{place}.offset_confidence", confidence is None or 0.0 <= confidence <= 1.0, str(confidence))

    def clip(self, number: int, fps: Fraction, body: _Body, motion: _Motion) -> MotionClip:
        offsets = self._lengths(f"bodies[{number}].offsets_m", body.offsets_m, len(SEGMENTS))
        ends = self._lengths(f"bodies[{number}].ends_m", body.ends_m, len(ENDS))
        place = f"motions[{number}]"
        self.is_true(f"{place}.frames", motion.frames >= 1, str(motion.frames))
        hips = self._array(f"{place}.hips_m", motion.hips_m, (motion.frames, 3))
        self.is_true(f"{place}.hips_m", bool((np.abs(hips) <= LARGEST_M).all()), "a place is out of range")
        turns = self._array(f"{place}.rotations", motion.rotations, (motion.frames, len(SEGMENTS), 4))
        # The sum of squares of non-finite values is not near 1 either; float64 holds the square of every float32.
        unit = np.abs(np.einsum("fsi,fsi->fs", turns, turns) - 1.0) <= 2.0 * UNIT
        self.is_true(f"{place}.rotations", bool(unit.all()), "a rotation is no unit quaternion")
        return MotionClip(BodyShape.of(offsets, ends), fps, hips, turns)

    def segments(self, segments: Sequence[MotionSegment], clips: Sequence[MotionClip], states: int) -> None:
        clip, free = 0, 0
        for number, one in enumerate(segments):
            place = f"segments[{number}]"
            self.is_true(place, clip <= one.clip < len(clips), f"clip {one.clip}")
            clip, free = one.clip, free if one.clip == clip else 0
            in_order = free <= one.start < one.accent < one.end <= len(clips[clip])
            self.is_true(place, in_order, f"frames {one.start}, {one.accent}, {one.end}")
            self.is_true(place, 0 <= one.state < states, f"state {one.state}")
            free = one.end
        missing = set(range(states)) - {one.state for one in segments}
        self.is_true("segments", not missing, f"no motion of state {min(missing, default=0)}")

    def symbols(self, place: str, symbols: Sequence[Sequence[int]], segments: int) -> None:
        self.is_true(place, len(symbols) in (0, segments), f"{len(symbols)} of {segments}")
        for number, own in enumerate(symbols):
            self.is_true(f"{place}[{number}]", all(0 <= one < len(SYMBOLS) for one in own), "no percussion symbol")

    def probabilities(self, place: str, rows: Sequence[Any], shape: tuple[int, ...]) -> FloatArray:
        lengths = {len(row) for row in rows} if len(shape) > 1 else {shape[-1]}
        self.is_true(place, len(rows) == shape[0] and lengths == {shape[-1]}, f"its size is not {shape}")
        values = np.array(rows, np.float64)
        # Only values up to 1 are summed, since the sum of larger ones could overflow.
        right = (np.abs(values - 0.5) <= 0.5).all() and (np.abs(values.sum(axis=-1) - 1.0) <= UNIT).all()
        self.is_true(place, bool(right), "a row of probabilities does not sum to 1")
        return values

    def _lengths(self, place: str, rows: Sequence[Sequence[float]], count: int) -> FloatArray:
        self.is_true(place, len(rows) == count, f"{len(rows)} rows, not {count}")
        self.is_true(place, all(math.fabs(value) <= LARGEST_M for row in rows for value in row), "out of range")
        return np.array(rows, np.float64)

    def _array(self, place: str, content: bytes, shape: tuple[int, ...]) -> FloatArray:
        self.is_true(place, len(content) == 4 * math.prod(shape), f"{len(content)} bytes for {shape[0]} frames")
        values = np.frombuffer(content, "<f4").reshape(shape)
        self.is_true(place, bool(np.isfinite(values).all()), "a number is not finite")
        return values.astype(np.float64)
