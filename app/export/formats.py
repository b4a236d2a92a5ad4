"""File formats for players' characters and instruments: a table with one row for each, including its writer."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final, Literal, TypeAlias

from app.arrays import AnyFloatArray
from app.errors import UsageError
from app.export.rig_options import Attachment
from app.formats.images import USUAL_TEXTURE_PX
from app.formats.levels_of_detail import with_levels
from app.formats.scene import Scene, SkinnedMesh, without_meshes
from app.formats.texture_colors import with_textures
from app.formats.usd import UsdSound
from app.formats.usd_package import refuse_without_usd

Format: TypeAlias = str
"""Id of a `FileFormat`."""
FileContent = Literal["character", "instrument", "props"]
"""Content of a file; props are a musician's straps and chair."""
_BESIDE: Final[tuple[FileContent, ...]] = ("instrument", "props")


@dataclass(frozen=True, eq=False)
class WriteOptions:
    """Options for writing a file, of which each format uses those that it supports.

    Attributes
    ----------
    sound : str or None
        Name of a sound file in the same folder that starts at frame 0.
    bone_names : mapping of int to str
        Bone names that differ from the scene's, for formats that allow this.
    expressions : mapping of str to mapping of str to float
        Further facial expressions, as weights of the scene's morphs.
    meshes : bool
        Whether to write meshes in formats that can omit them.
    texture_px : int
        Longest side of textures in pixels; 0 for no textures.
    levels : int
        Levels of detail of the meshes, 1 to `MOST_LEVELS`.
    t_pose : ndarray, shape (B, 4), or None
        Rotations of the scene's bones relative to their parents in the T-pose.
    """

    sound: str | None = None
    bone_names: Mapping[int, str] = field(default_factory=dict)
    expressions: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    meshes: bool = True
    texture_px: int = USUAL_TEXTURE_PX
    levels: int = 1
    t_pose: AnyFloatArray | None = None


@dataclass(frozen=True)
class FileFormat:
    """A file format.

    Attributes
    ----------
    id, label : str
        Id as typed in a command, and label shown in every language.
    suffix : str
        Suffix with its dot.
    holds : tuple of str
        Kinds of scenes that it can hold, each in a separate file.
    held_in : Format
        Other format in which instruments are written, if it cannot hold them; empty if they are not written.
    humanoid : bool
        Whether characters are always written on VRM's humanoid skeleton.
    work : float
        Relative time to write a player's files.
    write : callable
        Writes scenes with clips, each as soon as it is generated: one scene, or several of a stage with names and
        places.
    stage : bool
        Whether it can hold several scenes.
    read : callable or None
        Reads a file with one scene back, with the vertex order of the written meshes. Files in the first requested
        format that has this function are measured.
    usual : bool
        Whether it is written by default.
    reduces_keys : bool
        Whether it allows fewer keys than one on every frame.
    tangents : bool
        Whether reduced keys have tangents, which not every program reads.
    keys_by_pose : bool
        Whether all bones share their keys.
    without_meshes : bool
        Whether meshes can be omitted (`WriteOptions.meshes`).
    face_without_meshes : bool
        Whether files without meshes have the weights of the face.
    face_names : bool
        Whether the curves of the face have names that can be chosen.
    textured : bool
        Whether surfaces have textures.
    bones_by_name : bool
        Whether bones can be renamed (`WriteOptions.bone_names`).
    package : str
        Package that `refuse` checks for.
    refuse : callable
        Raises UsageError if the required package is not installed.
    """

    id: Format
    label: str
    suffix: str
    holds: tuple[FileContent, ...]
    work: float
    write: Callable[[Path, Iterable[Scene], WriteOptions], None]
    held_in: Format = ""
    humanoid: bool = False
    stage: bool = True
    read: Callable[[Path, Sequence[SkinnedMesh]], Scene] | None = None
    usual: bool = False
    reduces_keys: bool = True
    tangents: bool = False
    keys_by_pose: bool = False
    without_meshes: bool = False
    face_without_meshes: bool = False
    face_names: bool = False
    textured: bool = False
    bones_by_name: bool = False
    package: str = ""
    refuse: Callable[[], None] = lambda: None

    def key(self, held: FileContent) -> str:
        """Return the key of a file in a report, such as ``character_fbx``, from what the file holds and the format."""
        return f"{held}_{self.id}"


# Writers and readers are imported on use, since the command line lists the formats in its help.


def _shown(scenes: Iterable[Scene], options: WriteOptions) -> Iterator[Scene]:
    """Yield scenes with the meshes, textures and levels of detail that the options request."""
    for scene in scenes:
        if options.meshes:
            yield with_levels(with_textures(scene, options.texture_px), options.levels)
        else:
            yield without_meshes(scene)


def _write_fbx(path: Path, scenes: Iterable[Scene], beside: WriteOptions) -> None:
    from app.formats.fbx.write import write_scenes

    write_scenes(path, _shown(scenes, beside))


def _read_fbx(path: Path, written: Sequence[SkinnedMesh]) -> Scene:
    from app.formats.fbx.read import read_scene

    return read_scene(path)


def _write_bvh(path: Path, scenes: Iterable[Scene], beside: WriteOptions) -> None:
    from app.export.bvh_clip import scene_bvh
    from app.formats.bvh.write import write_bvh

    (scene,) = scenes
    write_bvh(path, scene_bvh(scene, beside.bone_names, beside.t_pose))


def _write_glb(path: Path, scenes: Iterable[Scene], beside: WriteOptions) -> None:
    from app.formats.gltf.write import write_glbs

    write_glbs(path, _shown(scenes, beside))


def _read_glb(path: Path, written: Sequence[SkinnedMesh]) -> Scene:
    from app.formats.gltf.read_scene import read_scene

    return read_scene(path, written)


def _write_usd(path: Path, scenes: Iterable[Scene], beside: WriteOptions) -> None:
    from app.formats.usd import write_usds

    write_usds(
        path,
        _shown(scenes, replace(beside, meshes=True)),
        None if beside.sound is None else UsdSound(beside.sound, 0.0),
    )


def _read_usd(path: Path, written: Sequence[SkinnedMesh]) -> Scene:
    from app.formats.usd_read_scene import read_scene

    return read_scene(path)


def _write_vrma(path: Path, scenes: Iterable[Scene], beside: WriteOptions) -> None:
    from app.formats.gltf.vrma import write_vrma

    (scene,) = scenes
    write_vrma(path, scene, beside.expressions)


def _read_vrma(path: Path, written: Sequence[SkinnedMesh]) -> Scene:
    from app.formats.gltf.vrma import read_vrma

    return read_vrma(path, written)


_ALL: Final[tuple[FileContent, ...]] = ("character", "instrument", "props")

FILE_FORMATS: Final[Mapping[Format, FileFormat]] = {
    row.id: row
    for row in (
        FileFormat(
            "fbx",
            "FBX",
            ".fbx",
            _ALL,
            3.0,
            _write_fbx,
            read=_read_fbx,
            usual=True,
            tangents=True,
            without_meshes=True,
            face_without_meshes=True,
            face_names=True,
            textured=True,
        ),
        FileFormat(
            "bvh",
            "BVH",
            ".bvh",
            ("character",),
            1.0,
            _write_bvh,
            stage=False,
            usual=True,
            reduces_keys=False,
            bones_by_name=True,
        ),
        FileFormat(
            "glb",
            "GLB",
            ".glb",
            _ALL,
            2.0,
            _write_glb,
            read=_read_glb,
            tangents=True,
            without_meshes=True,
            face_names=True,
            textured=True,
        ),
        FileFormat(
            "usd",
            "USD",
            ".usdc",
            _ALL,
            6.0,
            _write_usd,
            read=_read_usd,
            keys_by_pose=True,
            face_names=True,
            textured=True,
            package="usd-core",
            refuse=refuse_without_usd,
        ),
        FileFormat(
            "vrma",
            "VRM Animation",
            ".vrma",
            ("character",),
            1.0,
            _write_vrma,
            held_in="glb",
            humanoid=True,
            stage=False,
            read=_read_vrma,
        ),
    )
}
"""File formats in the order of writing and listing."""

USUAL_FORMATS: Final = tuple(row.id for row in FILE_FORMATS.values() if row.usual)
"""Ids of the formats that are exported by default."""


def files_of(formats: Collection[Format], reads: bool = False) -> tuple[tuple[FileFormat, FileContent], ...]:
    """Return the files to write for each player, in order, as pairs of format and content (such as ``character``).

    Parameters
    ----------
    formats : collection of str
        Ids of the requested formats.
    reads : bool
        Whether to return only the files that are read back for measuring; these do not include props.
    """
    rows = requested(formats)
    if reads:
        rows = tuple(row for row in rows if row.read is not None)[:1]
    found: list[tuple[FileFormat, FileContent]] = []
    for row in rows:
        found += [(row, held) for held in row.holds]
        found += [(FILE_FORMATS[row.held_in], held) for held in _BESIDE if row.held_in]
    return tuple(one for one in dict.fromkeys(found) if not reads or one[1] != "props")


def requested(formats: Collection[Format]) -> tuple[FileFormat, ...]:
    """Return the rows of `FILE_FORMATS` for the requested formats, in the table's order."""
    return tuple(row for id, row in FILE_FORMATS.items() if id in formats)


def refuse_attachment(formats: Collection[Format], attachment: Attachment) -> None:
    """Raise UsageError if instruments are to be attached to bones, but files of some format cannot have these bones."""
    without = [row.label for row in requested(formats) if row.humanoid]
    if without and attachment != "free":
        raise UsageError("attachment.formats", formats=", ".join(without))


def names_where(true: Callable[[FileFormat], bool]) -> str:
    """Return the ids, separated by commas, of the formats for which a condition is true."""
    return ", ".join(row.id for row in FILE_FORMATS.values() if true(row))
