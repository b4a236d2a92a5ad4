"""Checks of written files before they replace files in a project."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Final

import numpy as np
import soundfile

from app.arrays import FloatArray
from app.errors import FileError
from app.formats.fbx.decode import read_elements
from app.formats.fbx.graph import numbers, properties_of
from app.formats.fbx.read import decode_scene

_SETTINGS: Final = {
    "UpAxis": 1.0,
    "UpAxisSign": 1.0,
    "FrontAxis": 2.0,
    "FrontAxisSign": 1.0,
    "CoordAxis": 0.0,
    "CoordAxisSign": 1.0,
    "UnitScaleFactor": 1.0,
}
"""Axis and unit settings that Unreal's importer expects: Y up, right-handed, facing +Z, centimetres."""
_SAME_CM: Final = 0.01


@dataclass(frozen=True, eq=False)
class Expected:
    """Expected contents of a file.

    Attributes
    ----------
    fps : Fraction
        Frames per second.
    frames : int
        Number of frames.
    bones : sequence of str
        Bone names, the root first.
    low_cm, high_cm : ndarray, shape (3,)
        Bounding box of the mesh, which reveals wrong scale or axes.
    morphs : frozenset of str
        Names of the morphs.
    """

    fps: Fraction
    frames: int
    bones: Sequence[str]
    low_cm: FloatArray
    high_cm: FloatArray
    morphs: frozenset[str]


def check_fbx(path: Path, expected: Expected) -> None:
    """Raise FileError if an FBX file differs from what is expected."""
    data = path.read_bytes()
    file = os.fspath(path)
    settings = read_elements(data, file).child("GlobalSettings")
    found = {} if settings is None else {name: numbers(row) for name, row in properties_of(settings).items()}
    for name, value in _SETTINGS.items():
        _same(path, name, found.get(name, []), [value])
    scene = decode_scene(data, file)
    clip = scene.clip
    _same(path, "frame rate", None if clip is None else str(clip.fps), str(expected.fps))
    _same(path, "frames", None if clip is None else clip.frames, expected.frames)
    _same(path, "bones", [bone.name for bone in scene.bones], list(expected.bones))
    vertices = np.concatenate([mesh.vertices_cm for mesh in scene.meshes])
    for what, box, requested in (
        ("low corner", vertices.min(axis=0), expected.low_cm),
        ("high corner", vertices.max(axis=0), expected.high_cm),
    ):
        if np.abs(box - requested).max() > _SAME_CM:
            _wrong(path, what, np.round(box, 3).tolist(), np.round(requested, 3).tolist())
    morphs = {morph.name for mesh in scene.meshes for morph in mesh.morphs}
    _same(path, "morph targets", sorted(morphs), sorted(expected.morphs))


def check_wave(path: Path, rate_hz: int, channels: int, samples: int) -> None:
    """Raise FileError unless a recording is a 16-bit PCM WAV file of the expected rate, channels and length."""
    with path.open("rb") as stream, soundfile.SoundFile(stream) as file:
        found = (file.format, file.subtype, file.samplerate, file.channels, file.frames)
    _same(path, "sound", list(found), ["WAV", "PCM_16", rate_hz, channels, samples])


def _same(path: Path, what: str, found: object, requested: object) -> None:
    if found != requested:
        _wrong(path, what, found, requested)


def _wrong(path: Path, what: str, found: object, requested: object) -> None:
    raise FileError("unreal.file_wrong", file=path.name, what=what, found=str(found), requested=str(requested))
