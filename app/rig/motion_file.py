"""Reading of motion files of other programs by the format of their content."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from app.errors import FileError
from app.formats.bvh.clip import BvhClip
from app.formats.bvh.read import encoding, read_bvh
from app.formats.files import open_file

SUFFIXES: Final = (".bvh", ".fbx", ".glb", ".gltf", ".vrma")
"""Suffixes of motion files; the content determines the format."""
_HEAD_BYTES: Final = 4096


def read_motion_file(path: str | os.PathLike[str], figure: str = "") -> BvhClip:
    """Read the motion of a BVH, FBX or glTF file (.glb, .gltf, .vrma) with any suffix.

    Parameters
    ----------
    figure : str
        Root of the skeleton to read from a BVH file with several; empty for the first.

    Raises
    ------
    FileError
        The file has none of these formats, or cannot be read.
    """
    with open_file(path) as stream:
        head = stream.read(_HEAD_BYTES)
    kind = _kind(head) or Path(path).suffix.lower()
    if kind == ".bvh":
        return read_bvh(path, figure)
    # Their libraries are slow to import.
    from app.rig.node_motion import read_fbx_motion, read_gltf_motion

    if kind == ".fbx":
        return read_fbx_motion(Path(path))
    if kind in SUFFIXES:
        return read_gltf_motion(Path(path))
    raise FileError("motion.format", file=os.fspath(path))


def _kind(head: bytes) -> str:
    """Return the suffix for a file with this beginning; empty if unknown."""
    text = head.decode(encoding(head), "replace").lstrip()
    if text[:9].upper() == "HIERARCHY":
        return ".bvh"
    if text.startswith(("Kaydara FBX Binary", "; FBX")) or "FBXHeaderExtension" in text:
        return ".fbx"
    return ".glb" if text.startswith(("glTF", "{")) else ""
