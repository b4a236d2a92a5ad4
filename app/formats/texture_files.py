"""Writing of textures as separate files in one folder, each once, shared by all files of an export."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from app.formats.atomic import atomic_write
from app.formats.files import cannot_write
from app.formats.textures import Texture

TEXTURES_FOLDER: Final = "Textures"


def texture_files(folder: Path) -> tuple[str, ...]:
    """Return the relative paths, with slashes, of the textures in a folder's texture folder."""
    return tuple(sorted(f"{TEXTURES_FOLDER}/{path.name}" for path in folder.glob(f"{TEXTURES_FOLDER}/*")))


class TextureFiles:
    """Collects the textures of files that are being written."""

    def __init__(self) -> None:
        self._named: dict[str, Texture] = {}

    def path(self, texture: Texture) -> str:
        """Register a texture, and return its relative path with slashes; `write` writes the file."""
        self._named[texture.file_name] = texture
        return f"{TEXTURES_FOLDER}/{texture.file_name}"

    def write(self, folder: Path) -> None:
        """Write all registered textures into a folder's texture folder; existing files are kept.

        Raises
        ------
        FileError
            A file cannot be written.
        """
        for name, texture in self._named.items():
            target = folder / TEXTURES_FOLDER / name
            try:
                target.parent.mkdir(exist_ok=True)
                there = target.stat().st_size if os.path.isfile(target) else -1
            except OSError as error:
                raise cannot_write(target, error) from error
            # The name is derived from the content, so several processes may write the same file.
            if there != len(texture.content):
                with atomic_write(target, follow_link=False) as stream:
                    stream.write(texture.content)
