"""Textures beside the files that show them: in one folder, each of them once, however many files name it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from app.formats.atomic import atomic_write
from app.formats.files import cannot_write
from app.formats.textures import Texture

TEXTURES_FOLDER: Final = "Textures"


def texture_files(folder: Path) -> tuple[str, ...]:
    """Paths of the textures that were written into a folder, from it, with slashes."""
    return tuple(sorted(f"{TEXTURES_FOLDER}/{path.name}" for path in folder.glob(f"{TEXTURES_FOLDER}/*")))


class TextureFiles:
    """Textures of files that are being put together."""

    def __init__(self) -> None:
        self._named: dict[str, Texture] = {}

    def path(self, texture: Texture) -> str:
        """The path of a texture from the files that name it, with slashes; it is written by `write`."""
        self._named[texture.file_name] = texture
        return f"{TEXTURES_FOLDER}/{texture.file_name}"

    def write(self, folder: Path) -> None:
        """Write all that were asked for into a folder's folder of textures; those that are there already stay.

        Raises
        ------
        FileError
            ``file.cannot_write``.
        """
        for name, texture in self._named.items():
            target = folder / TEXTURES_FOLDER / name
            try:
                target.parent.mkdir(exist_ok=True)
                there = target.stat().st_size if os.path.isfile(target) else -1
            except OSError as error:
                raise cannot_write(target, error) from error
            # The name says what is in it; several processes may write the same.
            if there != len(texture.content):
                with atomic_write(target, follow_link=False) as stream:
                    stream.write(texture.content)
