"""Conversion of materials of other programs' FBX files to scene materials, with embedded images or image files next to
the FBX file.

The file contains image paths of another computer. Only their names are used: the image is searched in the file's folder
and some subfolders, after links are resolved.
"""

from __future__ import annotations

from pathlib import Path, PurePosixPath
from typing import Final

from app.errors import FileError
from app.formats.fbx.foreign import FbxContent, FbxMaterial, FbxTexture
from app.formats.files import read_file
from app.formats.images import ImageReader, packed_surface, with_opacity
from app.formats.other_computers import is_file
from app.formats.scene import Material
from app.formats.textures import MaterialTextures, Texture, TextureUse

MOST_BESIDE: Final = 2**27
"""Greatest total size in bytes of all image files beside an FBX file."""
FOLDERS: Final = (".", "Textures", "textures", "Texture", "Tex", "tex", "images", "Images")
_MOST_FILES: Final = 256
_FARTHEST: Final = 1e6


def media_folder(path: Path) -> Path:
    """Return the folder next to an FBX file in which its images are searched first."""
    return path.with_name(f"{path.stem}.fbm")


class FbxTextures:
    """Converts the materials of one file, reading each image once."""

    def __init__(self, path: Path, content: FbxContent) -> None:
        self.file = str(path)
        self._path = path
        self._left, self._left_files = MOST_BESIDE, _MOST_FILES
        self._embedded = [image.tobytes() for image in content.images]
        self._images = ImageReader(sum(map(len, self._embedded)) + MOST_BESIDE // 8)
        self._beside: dict[str, bytes] = {}

    def material(self, surface: FbxMaterial) -> Material:
        """Return the scene material for a material of the FBX file, with those textures that can be read; if its images
        have opacity, it is cut out.
        """
        found = {role: use for role, one in surface.textures.items() if (use := self._use(one)) is not None}
        color, opacity = found.get("color"), found.get("opacity")
        cut = color is not None and opacity is not None
        if color is not None and opacity is not None:
            color = TextureUse(with_opacity(color.texture, opacity.texture), color.scale, color.offset)
        rough, metal = found.get("roughness"), found.get("metallic")
        placed = rough or metal
        packed = None
        if placed is not None:
            images = None if rough is None else rough.texture, None if metal is None else metal.texture
            packed = TextureUse(packed_surface(*images), placed.scale, placed.offset)
        red, green, blue, alpha = surface.base_color
        bump = surface.bump if 0.0 <= surface.bump < _FARTHEST else 1.0
        # A texture replaces the value.
        return Material(
            surface.name,
            (1.0, 1.0, 1.0, 1.0 if opacity is not None else alpha) if color is not None else (red, green, blue, alpha),
            1.0 if metal is not None else surface.metallic,
            1.0 if rough is not None else surface.roughness,
            cut,
            MaterialTextures(
                color,
                found.get("normal"),
                packed,
                normal_scale=bump,
            ),
            "mask" if cut else None,
        )

    @property
    def beside(self) -> dict[str, bytes]:
        """Return the image files next to the FBX file that the materials converted so far use, by name."""
        return {name: content for name, content in self._beside.items() if content}

    def _use(self, texture: FbxTexture) -> TextureUse | None:
        made = self._texture(texture)
        if made is None or not all(abs(number) < _FARTHEST for number in (*texture.scaled, *texture.moved)):
            return None
        (scale_u, scale_v), (moved_u, moved_v) = texture.scaled, texture.moved
        # v points down in texture coordinates.
        return TextureUse(made, (scale_u, scale_v), (-moved_u * scale_u, 1.0 - scale_v + moved_v * scale_v))

    def _texture(self, texture: FbxTexture) -> Texture | None:
        name = PurePosixPath(texture.file.replace("\\", "/")).name
        content = self._found(name) if texture.image is None else self._embedded[texture.image]
        return self._images.texture(Path(name).stem or texture.name, content) if content else None

    def _found(self, name: str) -> bytes:
        """Return the content of an image file by its name; empty if it is not found."""
        if name in self._beside or not name or "\0" in name or self._left_files <= 0:
            return self._beside.get(name, b"")
        self._left_files -= 1
        content = b""
        folder = self._path.parent.resolve()
        for below in (media_folder(self._path).name, *FOLDERS):
            try:
                file = (folder / below / name).resolve()
                if not is_file(file) or not file.is_relative_to(folder):
                    continue
                content = read_file(file, self._left)
            except (OSError, RuntimeError, ValueError, FileError):
                continue  # a figure is shown without textures that cannot be read
            break
        self._left -= len(content)
        self._beside[name] = content
        return content
