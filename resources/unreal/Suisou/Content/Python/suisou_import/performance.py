"""What Suisou exported: ``performance.json``, read and held against the files that it speaks of."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path
from typing import Any, NamedTuple

from suisou_import.problem import problem

SCHEMA = 1
DESCRIPTION = "performance.json"
ROOT = "/Game/Suisou/"
_ASSET = re.compile(r"/Game/Suisou(/[A-Za-z0-9_]+)+")
_FILE = re.compile(r"[A-Za-z0-9_]+/[A-Za-z0-9_]+\.(fbx|wav)")


class Place(NamedTuple):
    """Where an actor stands: Unreal's centimetres and degrees."""

    x_cm: float
    y_cm: float
    z_cm: float
    yaw_deg: float


class Figure(NamedTuple):
    """A skeletal mesh and what it does. The last three are paths of assets."""

    name: str
    file: str
    place: Place
    bones: tuple[str, ...]
    mesh: str
    skeleton: str
    animation: str


class Sound(NamedTuple):
    """What is heard, and when it begins."""

    file: str
    asset: str
    offset_s: float
    duration_s: float


class Performance(NamedTuple):
    """A piece, played. ``bars`` are numbers and frames, ``markers`` texts, bars and frames, ``files`` lengths and
    hashes."""

    folder: Path
    piece: str
    title: str
    content: str
    sequence: str
    rate: tuple[int, int]
    frames: int
    sound: Sound
    figures: tuple[Figure, ...]
    bars: tuple[tuple[int, int], ...]
    markers: tuple[tuple[str, int, int], ...]
    files: dict[str, tuple[int, str]]

    @property
    def assets(self) -> list[str]:
        """Paths of all its assets."""
        own = [path for figure in self.figures for path in (figure.mesh, figure.skeleton, figure.animation)]
        return [*own, self.sound.asset, self.sequence]

    def path(self, file: str) -> Path:
        """Where a file is."""
        return self.folder.joinpath(*file.split("/"))


def found(sources: Path) -> list[Path]:
    """Folders of performances in the folder of sources, in order."""
    if not sources.is_dir():
        return []
    return sorted(folder for folder in sources.iterdir() if (folder / DESCRIPTION).is_file())


def read(folder: Path) -> Performance:
    """The performance of a folder. Raises `Problem` where its description cannot be understood."""
    file = folder / DESCRIPTION
    try:
        with file.open(encoding="utf-8") as stream:
            content = json.load(stream)
        if content["schema"] > SCHEMA:
            raise problem("newer", file=file)
        return _performance(folder, content)
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        detail = f"{type(error).__name__}: {error}"
        raise problem("unreadable", file=file, detail=detail) from error


def check_files(performance: Performance) -> None:
    """Raise `Problem` where a file is not what Suisou exported."""
    for name, (length, digest) in performance.files.items():
        path = performance.path(name)
        if not path.is_file():
            raise problem("missing_file", file=path)
        seen = hashlib.sha256()
        with path.open("rb") as stream:
            for block in iter(lambda: stream.read(1 << 20), b""):
                seen.update(block)
        if path.stat().st_size != length or seen.hexdigest() != digest:
            raise problem("changed_file", file=path)


def _performance(folder: Path, content: dict[str, Any]) -> Performance:
    piece = _matching(re.compile(r"[A-Za-z0-9_]+"), content["piece"])
    figures = [
        _figure(name, content_of, player["place"])
        for player in content["players"]
        for name, content_of in (
            (str(player["name"]), player["character"]),
            ("{} ({})".format(player["name"], player["instrument_id"]), player["instrument"]),
        )
    ]
    sound = content["sound"]
    read_performance = Performance(
        folder=folder,
        piece=piece,
        title=str(content["title"]) or piece,
        content=_matching(_ASSET, content["content"]),
        sequence=_matching(_ASSET, content["sequence"]),
        rate=(_at_least(1, content["rate"]["numerator"]), _at_least(1, content["rate"]["denominator"])),
        frames=_at_least(1, content["frames"]),
        sound=Sound(
            _matching(_FILE, sound["file"]),
            _matching(_ASSET, sound["asset"]),
            max(float(sound["offset_s"]), 0.0),
            float(sound["duration_s"]),
        ),
        figures=tuple(figures),
        bars=tuple((int(bar["number"]), int(bar["frame"])) for bar in content["bars"]),
        # Of an export of an earlier Suisou there are none.
        markers=tuple(
            (str(marker["text"]), int(marker["bar"]), int(marker["frame"])) for marker in content.get("markers", ())
        ),
        files={_matching(_FILE, name): (int(of["bytes"]), str(of["sha256"])) for name, of in content["files"].items()},
    )
    if read_performance.content != ROOT + piece:
        raise ValueError("its assets are not in its own folder")
    inside = read_performance.content + "/"
    assets = read_performance.assets
    if len({path.lower() for path in assets}) != len(assets) or not all(path.startswith(inside) for path in assets):
        raise ValueError("its assets are not apart, or not in its own folder")
    if not {figure.file for figure in figures} | {read_performance.sound.file} <= set(read_performance.files):
        raise ValueError("it does not say what all of its files hold")
    return read_performance


def _figure(name: str, content: dict[str, Any], place: dict[str, Any]) -> Figure:
    return Figure(
        name=name,
        file=_matching(_FILE, content["file"]),
        place=Place(*(float(place[field]) for field in Place._fields)),
        bones=tuple(str(bone) for bone in content["bones"]),
        mesh=_matching(_ASSET, content["mesh"]),
        skeleton=_matching(_ASSET, content["skeleton"]),
        animation=_matching(_ASSET, content["animation"]),
    )


def _matching(pattern: re.Pattern[str], value: Any) -> str:
    if not isinstance(value, str) or not pattern.fullmatch(value):
        raise ValueError(f"{value!r} is no name that Suisou gives")
    return value


def _at_least(least: int, value: Any) -> int:
    if not isinstance(value, int) or value < least:
        raise ValueError(f"{value!r} is not a number from {least}")
    return value
