"""Reading of a character's file in any format: glTF, GLB, VRM 0.x and 1.0, FBX."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from app.errors import FileError
from app.formats.files import open_file
from app.formats.gltf.container import MAGIC
from app.rig.characters.figure_gltf import gltf_figure
from app.rig.figure import Figure
from app.rig.gltf_source import invalid

SUFFIXES: Final = (".vrm", ".glb", ".gltf", ".fbx")
"""Suffixes of the files that can be opened."""


def is_glb(path: Path) -> bool:
    """Return whether a file is a glTF binary by its content. Raises FileError if it cannot be read."""
    with open_file(path) as opened:
        return opened.read(4) == MAGIC


def suffix_by_content(path: Path) -> str:
    """Return the suffix (``.glb``, ``.gltf`` or ``.fbx``) that fits a file's first bytes; empty for other formats.

    Text files of FBX have no fixed beginning, so their name decides. Raises FileError if the file cannot be read.
    """
    with open_file(path) as opened:
        start = opened.read(64)
    if start.startswith(MAGIC):
        return ".glb"
    if start.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{"):
        return ".gltf"
    return ".fbx" if start.startswith(b"Kaydara FBX") or path.suffix.lower() == ".fbx" else ""


def read_figure(path: Path) -> Figure:
    """Read the figure in a file.

    Raises
    ------
    FileError
        The file cannot be read, is damaged, too large or of an unknown format, or contains no skeleton.
    """
    suffix = suffix_by_content(path)
    try:
        if suffix in (".glb", ".gltf"):
            return gltf_figure(path)
        if suffix == ".fbx":
            # Starts another process; bundled characters are GLB files.
            from app.rig.characters.figure_fbx import fbx_figure

            return fbx_figure(path)
    except (KeyError, IndexError, TypeError, ValueError, OverflowError) as error:
        raise invalid(path, f"damaged: {error!r}") from error
    raise FileError("figure.unknown_format", file=str(path))
