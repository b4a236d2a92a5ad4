"""Images from anywhere -> textures, and textures -> pixels, within bounds. Pillow is loaded where it is needed."""

from __future__ import annotations

import io
import warnings
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from app.formats.textures import PNG_MAGIC, MaterialTextures, Texture, TextureUse, texture_of

if TYPE_CHECKING:
    from PIL.Image import Image

FREE_PX: Final = 2**24
PX_PER_BYTE: Final = 64
"""Most pixels that are looked at, and most for each byte of the images: a few bytes can be any number."""
MOST_SIDE_PX: Final = 8192
MOST_SCANS: Final = 64
"""Scans that a JPEG may have, each of which is a pass over the picture; real ones have about ten."""
JPEG_QUALITY: Final = 92
_JPEG_MAGIC: Final = b"\xff\xd8"
_SCAN: Final = b"\xff\xda"
_FORMATS: Final = ("PNG", "JPEG", "WEBP", "BMP", "TGA")
_AS_THEY_ARE: Final = ("L", "LA", "RGB", "RGBA", "P", "1")
"""Modes of Pillow that every program reads; others (CMYK, 16 bits) are written again."""

Pixels = npt.NDArray[np.uint8]


class ImageReader:
    """Makes textures of the images of one file, each looked at once: many surfaces share one.

    Parameters
    ----------
    size_bytes : int
        Of all images together.
    own : bool
        Whether the file is one of ours, whose images need not be looked at.
    """

    def __init__(self, size_bytes: int, own: bool = False) -> None:
        self._left_px = FREE_PX + PX_PER_BYTE * size_bytes
        self._own = own
        self._seen: dict[int, tuple[bytes, Texture | None]] = {}

    def texture(self, name: str, content: bytes) -> Texture | None:
        """The texture of an image's bytes; None where they are no whole image, or one too large."""
        if id(content) not in self._seen:
            # The content is kept, so that its id is no other's.
            self._seen[id(content)] = content, self._read(name, content)
        return self._seen[id(content)][1]

    def _read(self, name: str, content: bytes) -> Texture | None:
        if self._own and content.startswith((PNG_MAGIC, _JPEG_MAGIC)):
            return texture_of(name, content)
        image = _opened(content)
        if image is None:
            return None
        self._left_px -= image.width * image.height
        if self._left_px < 0:
            return None
        kept = content.startswith((PNG_MAGIC, _JPEG_MAGIC)) and image.mode in _AS_THEY_ARE
        if kept:
            image.draft("RGB", (1, 1))
        if not _loaded(image):
            return None
        return texture_of(name, content if kept else _png(image.convert("RGBA" if _has_alpha(image) else "RGB")))


def decoded(texture: Texture, most_px: int) -> Pixels | None:
    """A texture as (H, W, 4) RGBA, made so small that no side is longer; None where it cannot be read."""
    image = _smaller(texture.content, most_px)
    return None if image is None else np.asarray(image.convert("RGBA"))


@lru_cache(maxsize=32)
def small(texture: Texture) -> Pixels | None:
    """A texture as `decoded` with at most 256 pixels a side: for colours."""
    return decoded(texture, 256)


def resized(textures: MaterialTextures, most_px: int) -> MaterialTextures:
    """Textures of which no side is longer."""

    def fit(use: TextureUse | None) -> TextureUse | None:
        return None if use is None else replace(use, texture=_resized(use.texture, most_px))

    return replace(
        textures,
        color=fit(textures.color),
        normal=fit(textures.normal),
        metallic_roughness=fit(textures.metallic_roughness),
        occlusion=fit(textures.occlusion),
    )


@lru_cache(maxsize=128)
def _resized(texture: Texture, most_px: int) -> Texture:
    image = _opened(texture.content)
    if image is None or max(image.size) <= most_px:
        return texture
    fitted = _smaller(texture.content, most_px)
    if fitted is None:
        return texture
    if texture.mime_type == "image/png":
        return texture_of(texture.name, _png(fitted))
    stream = io.BytesIO()
    fitted.convert("RGB").save(stream, "JPEG", quality=JPEG_QUALITY)
    return texture_of(texture.name, stream.getvalue())


def _smaller(content: bytes, most_px: int) -> Image | None:
    from PIL import Image

    image = _opened(content)
    if image is None:
        return None
    share = min(1.0, most_px / max(image.size))
    size = max(round(image.width * share), 1), max(round(image.height * share), 1)
    image.draft("RGB", size)
    if not _loaded(image):
        return None
    if image.mode == "P" or image.mode not in _AS_THEY_ARE:
        image = image.convert("RGBA" if _has_alpha(image) else "RGB")
    if image.size == size:
        return image
    if image.mode != "RGBA":
        return image.resize(size, Image.Resampling.BOX)
    # Colours of what is cut out stay: they are seen at its edges when the image is made smaller again.
    color, alpha = image.convert("RGB"), image.getchannel("A")
    fitted = color.resize(size, Image.Resampling.BOX)
    fitted.putalpha(alpha.resize(size, Image.Resampling.BOX))
    return fitted


def _has_alpha(image: Image) -> bool:
    return "A" in image.getbands() or "transparency" in image.info


def _opened(content: bytes) -> Image | None:
    """An image whose pixels are not read yet; None where it is none."""
    from PIL import Image

    if content.startswith(_JPEG_MAGIC) and content.count(_SCAN) > MOST_SCANS:
        return None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            image = Image.open(io.BytesIO(content), formats=_FORMATS)
    except _UNREADABLE:
        return None
    except (Image.DecompressionBombError, Image.DecompressionBombWarning):
        return None
    return image if max(image.size) <= MOST_SIDE_PX else None


_UNREADABLE: Final[tuple[type[Exception], ...]] = (OSError, ValueError, SyntaxError, EOFError)


def _loaded(image: Any) -> bool:
    """Read the pixels; return whether there are all."""
    try:
        image.load()
    except _UNREADABLE:
        return False
    return True


def _png(image: Image) -> bytes:
    stream = io.BytesIO()
    image.save(stream, "PNG", compress_level=6)
    return stream.getvalue()
