"""The kinds of file that a player's character and instrument are written to."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, Literal

from app.formats.scene import Scene
from app.formats.usd import UsdSound, refuse_without_usd

Format = Literal["fbx", "bvh", "glb", "usd"]
FileContent = Literal["character", "instrument"]


@dataclass(frozen=True)
class WriteOptions:
    """What some kinds of file take beside the scene.

    Attributes
    ----------
    sound : str or None
        Name of a sound file in the same folder that starts with frame 0.
    bone_names : mapping of int to str
        Other names than the scene's, by bone, for files that are chosen by the names of their bones.
    """

    sound: str | None = None
    bone_names: Mapping[int, str] = field(default_factory=dict)


@dataclass(frozen=True)
class FileFormat:
    """A kind of file.

    Attributes
    ----------
    suffix : str
        With its dot.
    holds : tuple of str
        Whose scenes it can hold, each in a file of its own.
    work : float
        How long a player's files take to write, beside those of the other formats.
    write : callable
        Writes a scene that has a clip.
    write_stage : callable or None
        Writes several such scenes, each with a name and a place, into one file; None: it can hold one only.
    reduces_keys : bool
        Whether it can have fewer keys than one on every frame.
    bones_by_name : bool
        Whether bones may get other names in it (`WriteOptions.bone_names`).
    package : str
        What `refuse` finds missing.
    refuse : callable
        Raises UsageError where what writes this kind of file is not installed.
    """

    suffix: str
    holds: tuple[FileContent, ...]
    work: float
    write: Callable[[Path, Scene, WriteOptions], None]
    write_stage: Callable[[Path, Iterable[Scene], WriteOptions], None] | None = None
    refuse: Callable[[], None] = lambda: None
    reduces_keys: bool = True
    bones_by_name: bool = False
    package: str = ""


# The writers are loaded when something is written: the command line names the formats in its help.


def _fbx(path: Path, scene: Scene, beside: WriteOptions) -> None:
    from app.formats.fbx.write import write_scene

    write_scene(path, scene)


def _fbx_stage(path: Path, scenes: Iterable[Scene], beside: WriteOptions) -> None:
    from app.formats.fbx.write import write_scenes

    write_scenes(path, scenes)


def _bvh(path: Path, scene: Scene, beside: WriteOptions) -> None:
    from app.export.skeleton import scene_bvh
    from app.formats.bvh import write_bvh

    write_bvh(path, scene_bvh(scene, beside.bone_names))


def _glb(path: Path, scene: Scene, beside: WriteOptions) -> None:
    from app.formats.gltf.write import write_glb

    write_glb(path, scene)


def _glb_stage(path: Path, scenes: Iterable[Scene], beside: WriteOptions) -> None:
    from app.formats.gltf.write import write_glbs

    write_glbs(path, scenes)


def _usd(path: Path, scene: Scene, beside: WriteOptions) -> None:
    from app.formats.usd import write_usd

    write_usd(path, scene, _usd_sound(beside))


def _usd_stage(path: Path, scenes: Iterable[Scene], beside: WriteOptions) -> None:
    from app.formats.usd import write_usds

    write_usds(path, scenes, _usd_sound(beside))


def _usd_sound(beside: WriteOptions) -> UsdSound | None:
    return None if beside.sound is None else UsdSound(beside.sound, 0.0)


FILE_FORMATS: Final[Mapping[Format, FileFormat]] = {
    "fbx": FileFormat(".fbx", ("character", "instrument"), 3.0, _fbx, _fbx_stage),
    "bvh": FileFormat(".bvh", ("character",), 1.0, _bvh, reduces_keys=False, bones_by_name=True),
    "glb": FileFormat(".glb", ("character", "instrument"), 2.0, _glb, _glb_stage),
    "usd": FileFormat(
        ".usdc", ("character", "instrument"), 6.0, _usd, _usd_stage, refuse_without_usd, package="usd-core"
    ),
}
"""In the order in which they are written and listed."""

USUAL_FORMATS: Final[tuple[Format, ...]] = ("fbx", "bvh")
"""Formats by default."""
