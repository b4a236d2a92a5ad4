"""Reads the description of an export, ``performance.json``, and compares it with the files that it names."""

from __future__ import annotations

import contextlib
import hashlib
import json
import math
import re
from pathlib import Path
from typing import Any, NamedTuple

from suisou_import.problem import Problem, problem

SCHEMA = 6
DESCRIPTION = "performance.json"
ROOT = "/Game/Suisou/"
SHARED = ROOT + "Textures/"
"""Folder of textures, which all pieces share."""
_ASSET = re.compile(r"/Game/Suisou(/[A-Za-z0-9_]+)+")
_MOST_BYTES = 256 << 20
_FILE = re.compile(r"[A-Za-z0-9_]+/[A-Za-z0-9_]+\.(fbx|wav|png|jpg)")


class Place(NamedTuple):
    """Place of an actor: Unreal's centimetres and degrees."""

    x_cm: float
    y_cm: float
    z_cm: float
    yaw_deg: float
    roll_deg: float = 0.0


ON_SOCKET = Place(0.0, 0.0, 0.0, 0.0, -90.0)
"""Relative to a bone that an instrument hangs on. A bone keeps the axes of its file, with Y up; the importer turns what
is imported as an asset of its own to Z up."""


AT_ACTOR = Place(0.0, 0.0, 0.0, 0.0)
ON_ACTOR = "None"
"""The ``socket`` of a figure that hangs on another actor as a whole: Unreal's name of no bone."""


class Figure(NamedTuple):
    """A skeletal mesh and what it does. ``mesh``, ``skeleton`` and ``animation`` are paths of assets; what hangs on a
    bone, the ``socket``, of another figure, or on all of it, has the animation of that as its ``holder``.
    ``materials`` are those with textures, by the names of their slots."""

    name: str
    file: str
    place: Place
    bones: tuple[str, ...]
    mesh: str
    skeleton: str
    animation: str
    socket: str = ""
    holder: str = ""
    materials: dict[str, str] = {}


class Texture(NamedTuple):
    """An image that becomes a texture of a kind: ``color``, ``normal`` or ``masks``; ``px`` is its longest side, 0 in
    an export of an earlier Suisou."""

    file: str
    asset: str
    kind: str
    px: int = 0


class Map(NamedTuple):
    """A texture of a material; its coordinates are ``scale * uv + offset``."""

    texture: str
    scale: tuple[float, float]
    offset: tuple[float, float]


class Surface(NamedTuple):
    """A material; ``alpha`` is ``opaque``, ``mask`` or ``blend``. Green of ``surface`` is roughness, blue metal."""

    asset: str
    base_color: tuple[float, float, float, float]
    metallic: float
    roughness: float
    normal_scale: float
    occlusion_strength: float
    two_sided: bool
    alpha: str
    cutoff: float
    color: Map | None
    normal: Map | None
    surface: Map | None
    occlusion: Map | None

    @property
    def textures(self) -> list[str]:
        """Paths of its textures without duplicates."""
        maps = (self.color, self.normal, self.surface, self.occlusion)
        return list(dict.fromkeys(one.texture for one in maps if one is not None))


class Sound(NamedTuple):
    """The sound file, and the time at which it begins."""

    file: str
    asset: str
    offset_s: float
    duration_s: float


class LeftOut(NamedTuple):
    """A player or dancer who could not be exported, with the reason. ``assets`` are paths that an earlier export may
    have imported.
    """

    name: str
    reason: str
    assets: tuple[str, ...]


class Performance(NamedTuple):
    """A piece, played. ``bars`` are numbers and frames, ``markers`` texts, bars and frames, ``files`` lengths and
    hashes; ``first_frame`` is the number that frame 0 has in the whole piece, ``first_frame_s`` its time there."""

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
    left_out: tuple[LeftOut, ...]
    first_frame: int
    first_frame_s: float
    textures: tuple[Texture, ...]
    surfaces: tuple[Surface, ...]

    @property
    def staying(self) -> set[str]:
        """Paths of assets of excluded performers: an update leaves them as they are."""
        return {path for one in self.left_out for path in one.assets}

    @property
    def assets(self) -> list[str]:
        """Paths of all its assets without duplicates: figures of the same body share its mesh and skeleton."""
        own = [path for figure in self.figures for path in (figure.mesh, figure.skeleton, figure.animation)]
        shown = [*(one.asset for one in self.textures), *(one.asset for one in self.surfaces)]
        return list(dict.fromkeys([*own, self.sound.asset, self.sequence, *shown]))

    @property
    def bodies(self) -> list[Figure]:
        """First figure of each mesh, whose file is imported."""
        return list({figure.mesh: figure for figure in reversed(self.figures)}.values())[::-1]

    def path(self, file: str) -> Path:
        """Return the path of a file that the description names relative to its folder."""
        return self.folder.joinpath(*file.split("/"))


def found(sources: Path) -> list[Path]:
    """Folders of performances in the folder of sources, in order. Raises `Problem` where that cannot be listed."""
    try:
        return sorted(filter(_has_description, sources.iterdir())) if sources.is_dir() else []
    except OSError as error:
        raise problem("unreadable", file=sources, detail=error) from error


def others(performance: Performance) -> list[Performance]:
    """The other performances among the sources that can be understood."""
    read_ones = []
    for folder in found(performance.folder.parent):
        if folder != performance.folder:
            with contextlib.suppress(Problem):
                read_ones.append(read(folder))
    return read_ones


def _has_description(folder: Path) -> bool:
    try:
        return (folder / DESCRIPTION).is_file()
    except OSError:
        return True  # `read` says what is wrong


def read(folder: Path) -> Performance:
    """Read the performance of a folder. Raises `Problem` if its description is invalid."""
    file = folder / DESCRIPTION
    try:
        with file.open("rb") as stream:
            data = stream.read(_MOST_BYTES + 1)
        if len(data) > _MOST_BYTES:
            raise ValueError("it is too large")
        content = json.loads(data.decode("utf-8"))
        if content["schema"] > SCHEMA:
            raise problem("newer", file=file)
        return _performance(folder, content)
    except (OSError, ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError) as error:
        detail = f"{type(error).__name__}: {error}"
        raise problem("unreadable", file=file, detail=detail) from error


def check_files(performance: Performance) -> None:
    """Raise `Problem` if a file differs from the exported one."""
    for name in performance.files:
        check_file(performance, name)


def check_file(performance: Performance, name: str) -> None:
    """Raise `Problem` where one file of a performance is not what Suisou exported."""
    (length, digest), path = performance.files[name], performance.path(name)
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
        _figure(name, content_of, player["place"], player["character"])
        for player in content["players"]
        for name, content_of in (
            (str(player["name"]), player["character"]),
            ("{} ({})".format(player["name"], player["instrument_id"]), player["instrument"]),
            # Missing in exports of earlier versions of Suisou.
            *(
                ("{} ({})".format(player["name"], double["instrument_id"]), double["instrument"])
                for double in player.get("doubles", ())
            ),
            # They are in the player's space, and go where the player's actor goes.
            *(
                ("{} (props)".format(player["name"]), {**worn, "socket": ON_ACTOR})
                for worn in (player.get("props"),)
                if worn is not None
            ),
        )
    ]
    # Missing in exports of earlier versions of Suisou.
    figures += [
        _figure(str(dancer["name"]), dancer["character"], dancer["place"]) for dancer in content.get("dancers", ())
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
            max(_finite(sound["offset_s"]), 0.0),
            _finite(sound["duration_s"]),
        ),
        figures=tuple(figures),
        bars=tuple((int(bar["number"]), int(bar["frame"])) for bar in content["bars"]),
        # Missing in exports of earlier versions of Suisou.
        markers=tuple(
            (str(marker["text"]), int(marker["bar"]), int(marker["frame"])) for marker in content.get("markers", ())
        ),
        files={_matching(_FILE, name): (int(of["bytes"]), str(of["sha256"])) for name, of in content["files"].items()},
        left_out=tuple(
            LeftOut(str(one["name"]), str(one["reason"]), tuple(_matching(_ASSET, path) for path in one["assets"]))
            for one in content.get("left_out", ())
        ),
        # Missing in exports of earlier versions of Suisou.
        first_frame=_at_least(0, content.get("first_frame", 0)),
        first_frame_s=_finite(content["first_frame_s"]),
        # Missing in exports of earlier versions of Suisou.
        textures=tuple(_texture(one) for one in content.get("textures", ())),
        surfaces=tuple(_surface(one) for one in content.get("materials", ())),
    )
    if read_performance.content != ROOT + piece:
        raise ValueError("its assets are not in its own folder")
    inside = read_performance.content + "/"
    assets = read_performance.assets
    alike = {(figure.mesh, figure.skeleton, figure.bones) for figure in figures}
    textures = {one.asset for one in read_performance.textures}
    surfaces = {one.asset for one in read_performance.surfaces}
    count = 2 * len(alike) + len(figures) + 2 + len(read_performance.textures) + len(read_performance.surfaces)
    apart = len({path.lower() for path in assets}) == len(assets) == count
    # In exports of earlier versions of Suisou textures are in the piece's folder.
    shared = {path for path in textures if path.startswith(SHARED)}
    own = [path for path in [*assets, *read_performance.staying] if path not in shared]
    if not apart or not all(path.startswith(inside) for path in own):
        raise ValueError("its assets are not apart, or not in its own folder")
    shown_in = {path for figure in figures for path in figure.materials.values()}
    mapped = {path for one in read_performance.surfaces for path in one.textures}
    if not shown_in <= surfaces or not mapped <= textures:
        raise ValueError("it names materials or textures that it does not describe")
    files = {figure.file for figure in figures} | {one.file for one in read_performance.textures}
    if not files | {read_performance.sound.file} <= set(read_performance.files):
        raise ValueError("it does not say what all of its files hold")
    return read_performance


def _figure(name: str, content: dict[str, Any], place: dict[str, Any], holder: dict[str, Any] | None = None) -> Figure:
    # Missing in exports of earlier versions of Suisou.
    socket = str(content.get("socket", ""))
    stands = Place(*(_finite(place[field]) for field in ("x_cm", "y_cm", "z_cm", "yaw_deg")))
    return Figure(
        name=name,
        file=_matching(_FILE, content["file"]),
        place=(AT_ACTOR if socket == ON_ACTOR else ON_SOCKET) if socket else stands,
        bones=tuple(str(bone) for bone in content["bones"]),
        mesh=_matching(_ASSET, content["mesh"]),
        skeleton=_matching(_ASSET, content["skeleton"]),
        animation=_matching(_ASSET, content["animation"]),
        socket=socket,
        holder=_matching(_ASSET, holder["animation"]) if holder is not None and socket else "",
        materials={str(slot): _matching(_ASSET, path) for slot, path in content.get("materials", {}).items()},
    )


def _texture(content: dict[str, Any]) -> Texture:
    kind = _matching(re.compile("color|normal|masks"), content["kind"])
    px = _at_least(0, content.get("px", 0))
    return Texture(_matching(_FILE, content["file"]), _matching(_ASSET, content["asset"]), kind, px)


def _surface(content: dict[str, Any]) -> Surface:
    red, green, blue, opacity = (_finite(value) for value in content["base_color"])
    numbers = ("metallic", "roughness", "normal_scale", "occlusion_strength")
    metallic, roughness, normal_scale, occlusion_strength = (_finite(content[name]) for name in numbers)
    return Surface(
        asset=_matching(_ASSET, content["asset"]),
        base_color=(red, green, blue, opacity),
        metallic=metallic,
        roughness=roughness,
        normal_scale=normal_scale,
        occlusion_strength=occlusion_strength,
        two_sided=bool(content["two_sided"]),
        alpha=_matching(re.compile("opaque|mask|blend"), content["alpha"]),
        cutoff=_finite(content["cutoff"]),
        color=_map(content["color"]),
        normal=_map(content["normal"]),
        surface=_map(content["surface"]),
        occlusion=_map(content["occlusion"]),
    )


def _map(content: dict[str, Any] | None) -> Map | None:
    if content is None:
        return None
    (u_scale, v_scale), (u, v) = ([_finite(value) for value in content[name]] for name in ("scale", "offset"))
    return Map(_matching(_ASSET, content["texture"]), (u_scale, v_scale), (u, v))


def _matching(pattern: re.Pattern[str], value: Any) -> str:
    if not isinstance(value, str) or not pattern.fullmatch(value):
        raise ValueError(f"{value!r} is no name that Suisou gives")
    return value


def _finite(value: Any) -> float:
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(f"{value!r} is not a finite number")
    return number


def _at_least(least: int, value: Any) -> int:
    if not isinstance(value, int) or value < least:
        raise ValueError(f"{value!r} is not a number from {least}")
    return value
