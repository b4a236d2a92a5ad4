"""The kinds of file that a player's character and instrument are written to."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, Literal

from app.formats.scene import Scene
from app.formats.usd import refuse_without_usd

Format = Literal["fbx", "bvh", "glb", "usd"]
SettingBinding = Literal["character", "instrument"]


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
    refuse : callable
        Raises UsageError where what writes this kind of file is not installed.
    """

    suffix: str
    holds: tuple[SettingBinding, ...]
    work: float
    write: Callable[[Path, Scene, WriteOptions], None]
    refuse: Callable[[], None] = lambda: None


# The writers are loaded when something is written: the command line names the formats in its help.


def _fbx(path: Path, scene: Scene, beside: WriteOptions) -> None:
    from app.formats.fbx.write import write_scene

    write_scene(path, scene)


def _bvh(path: Path, scene: Scene, beside: WriteOptions) -> None:
    from app.export.skeleton import scene_bvh
    from app.formats.atomic import atomic_write
    from app.formats.bvh import encode_bvh

    with atomic_write(path) as stream:
        stream.write(encode_bvh(scene_bvh(scene, beside.bone_names)))


def _glb(path: Path, scene: Scene, beside: WriteOptions) -> None:
    from app.formats.gltf.write import write_glb

    write_glb(path, scene)


def _usd(path: Path, scene: Scene, beside: WriteOptions) -> None:
    from app.formats.usd import Sound, write_usd

    write_usd(path, scene, None if beside.sound is None else Sound(beside.sound, 0.0))


FILE_FORMATS: Final[Mapping[Format, FileFormat]] = {
    "fbx": FileFormat(".fbx", ("character", "instrument"), 3.0, _fbx),
    "bvh": FileFormat(".bvh", ("character",), 1.0, _bvh),
    "glb": FileFormat(".glb", ("character", "instrument"), 2.0, _glb),
    "usd": FileFormat(".usdc", ("character", "instrument"), 6.0, _usd, refuse_without_usd),
}
"""In the order in which they are written and listed."""

USUAL_FORMATS: Final[tuple[Format, ...]] = ("fbx", "bvh")
"""What is written if no one says otherwise."""
