"""Reading of untrusted images as textures, and decoding of textures to pixels, within size limits. Pillow is imported
on first use.
"""

from __future__ import annotations

import io
import warnings
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final, Literal, get_args

import numpy as np
import numpy.typing as npt

from app.arrays import SingleArray
from app.formats.textures import PNG_MAGIC, MaterialTextures, Texture, TextureUse, texture_of

if TYPE_CHECKING:
    from PIL.Image import Image

FREE_PX: Final = 2**24
PX_PER_BYTE: Final = 64
"""Greatest number of pixels per byte of an image, in addition to a fixed amount: a few bytes can claim any number of
pixels.
"""
MOST_SIDE_PX: Final = 8192
MOST_SCANS: Final = 64
"""Greatest number of scans in a JPEG, each of which is a pass over the picture; real files have about ten."""
JPEG_QUALITY: Final = 92
TextureSize = Literal[0, 512, 1024, 2048, 4096]
TEXTURE_SIZES: Final[tuple[TextureSize, ...]] = get_args(TextureSize)
"""Choices for the longest side of exported textures in pixels; 0 means no textures."""
USUAL_TEXTURE_PX: Final = 2048
_JPEG_MAGIC: Final = b"\xff\xd8"
_SCAN: Final = b"\xff\xda"
_FORMATS: Final = ("PNG", "JPEG", "WEBP", "BMP", "TGA")
_AS_THEY_ARE: Final = ("L", "LA", "RGB", "RGBA", "P", "1")
"""Modes of Pillow that every program reads; images of other modes (CMYK, 16 bits) are converted."""

Pixels = npt.NDArray[np.uint8]


class ImageReader:
    """Makes textures from the images of one file; each image is checked once.

    Parameters
    ----------
    size_bytes : int
        Size of the file, to which the total size of its images is limited.
    own : bool
        Whether this program wrote the file, so that images need not be checked.
    """

    def __init__(self, size_bytes: int, own: bool = False) -> None:
        self._left_px = FREE_PX + PX_PER_BYTE * size_bytes
        self._own = own
        self._seen: dict[int, tuple[bytes, Texture | None]] = {}

    def texture(self, name: str, content: bytes) -> Texture | None:
        """Return the texture for an image's bytes; None if the image is invalid, incomplete or too large."""
        if id(content) not in self._seen:
            # A reference to the content is kept, so that its id is not reused.
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
    """Decode a texture to RGBA (height, width, 4), scaled down so that no side exceeds ``most_px``; None if it cannot
    be read."""
    image = _smaller(texture.content, most_px)
    return None if image is None else np.asarray(image.convert("RGBA"))


@lru_cache(maxsize=32)
def small(texture: Texture) -> Pixels | None:
    """Decode a texture with at most 256 pixels a side, for average colours."""
    return decoded(texture, 256)


def mean(texture: Texture) -> float:
    """Return the mean of a grey texture, 0..1; 0.5 if it cannot be read."""
    pixels = small(texture)
    return 0.5 if pixels is None else float(pixels[..., 0].mean()) / 255.0


def resized(textures: MaterialTextures, most_px: int) -> MaterialTextures:
    """Return textures scaled down so that no side exceeds ``most_px``."""

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
    return _encoded(texture, texture.name, fitted)


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
    # Colours of transparent pixels are kept: they show at edges when the image is scaled down.
    color, alpha = image.convert("RGB"), image.getchannel("A")
    fitted = color.resize(size, Image.Resampling.BOX)
    fitted.putalpha(alpha.resize(size, Image.Resampling.BOX))
    return fitted


def _has_alpha(image: Image) -> bool:
    return "A" in image.getbands() or "transparency" in image.info


def _opened(content: bytes) -> Image | None:
    """Open an image without decoding its pixels; None if it is invalid."""
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
    """Decode the pixels of an image; return whether it is complete."""
    try:
        image.load()
    except _UNREADABLE:
        return False
    return True


def _png(image: Image) -> bytes:
    stream = io.BytesIO()
    image.save(stream, "PNG", compress_level=6)
    return stream.getvalue()


@lru_cache(maxsize=128)
def tinted(texture: Texture, factor: tuple[float, float, float], solid: bool) -> Texture:
    """Return an sRGB texture with its linear colours multiplied by ``factor``, and without alpha if ``solid``; the
    texture itself if nothing changes or it cannot be read.
    """
    image = _opened(texture.content)
    if image is None or (factor == (1.0, 1.0, 1.0) and not (solid and _has_alpha(image))):
        return texture
    image = _smaller(texture.content, MOST_SIDE_PX)
    if image is None:
        return texture
    levels = np.arange(256) / 255.0
    light = np.where(levels <= 0.04045, levels / 12.92, ((levels + 0.055) / 1.055) ** 2.4)
    bands = [*image.convert("RGBA").split()]
    for band, share in enumerate(factor):
        part = np.clip(light * share, 0.0, 1.0)
        shown = np.where(part <= 0.0031308, 12.92 * part, 1.055 * part ** (1.0 / 2.4) - 0.055)
        bands[band] = bands[band].point(np.round(shown * 255.0).astype(int).tolist())
    mode = "RGBA" if _has_alpha(image) and not solid else "RGB"
    return _encoded(texture, f"{texture.name}_tinted", _merged(mode, bands))


@lru_cache(maxsize=128)
def scaled_channel(texture: Texture, band: str, role: str, factor: float) -> Texture:
    """Return one channel (``R``, ``G`` or ``B``) of a texture as a grey image, multiplied by a factor; the texture
    itself if it cannot be read. ``role`` is the use of the new texture."""
    image = _smaller(texture.content, MOST_SIDE_PX)
    if image is None:
        return texture
    levels = np.clip(np.round(np.arange(256) * factor), 0, 255).astype(int).tolist()
    grey = image.convert("RGB").getchannel(band).point(levels)
    return _encoded(texture, f"{texture.name}_{role}", grey)


@lru_cache(maxsize=128)
def opacity(texture: Texture, factor: float) -> Texture:
    """Return the alpha of a texture, multiplied by a factor, as an image whose grey and alpha both have it; the texture
    itself if it cannot be read.
    """
    image = _smaller(texture.content, MOST_SIDE_PX)
    if image is None:
        return texture
    levels = np.clip(np.round(np.arange(256) * factor), 0, 255).astype(int).tolist()
    alpha = image.convert("RGBA").getchannel("A").point(levels)
    return texture_of(f"{texture.name}_opacity", _png(_merged("LA", [alpha, alpha])))


@lru_cache(maxsize=32)
def changed_by_stages(texture: Texture, stages: tuple[Texture, ...], before: float, after: float) -> Texture:
    """Return a texture changed in the way that textures of equal size and layout change from one stage to another; if
    it is one of them, the stage itself.

    Parameters
    ----------
    stages : tuple of Texture
        At least two textures, such as those of a young, a middle-aged and an old face, between which is interpolated.
    before, after : float
        Stages of the given texture and of the result: 0 for the first of ``stages``, 1 for the second and so on; more
        than the last for what comes after it.
    """
    if before == after:
        return texture
    from PIL import Image

    changed = _between_stages(stages, after)
    if texture != stages[min(int(before), len(stages) - 1)]:
        # Of another skin only lines and shadows are changed: it has other colours, and its eyes and lips are elsewhere
        # by a pixel or two.
        grey = np.maximum(changed, 1.0).mean(axis=2) / np.maximum(_between_stages(stages, before), 1.0).mean(axis=2)
        changed = _stage(texture) * np.clip(grey, *_MOST_CHANGE)[..., None]
    image = Image.fromarray(np.clip(np.round(changed), 0.0, 255.0).astype(np.uint8))
    return _encoded(texture, f"{texture.name}_{after:g}", image)


_MOST_CHANGE: Final = (0.4, 1.1)
"""Least and greatest factor by which a texture that is not one of the stages is changed."""


def _between_stages(stages: tuple[Texture, ...], place: float) -> SingleArray:
    """Return the colours (height, width, 3) of a stage, interpolated; beyond the last stage lines grow deeper as before
    it, and colours stay.
    """
    last = len(stages) - 1
    first = min(int(place), last - 1)
    below, above = (_stage(one).astype(np.float32) for one in stages[first : first + 2])
    within: SingleArray = below + np.float32(min(place, last) - first) * (above - below)
    within += np.float32(max(place - last, 0.0)) * (above - below).mean(axis=2, keepdims=True)
    return within


@lru_cache(maxsize=4)
def _stage(texture: Texture) -> Pixels:
    """Return the colours (height, width, 3) of one of this program's own textures."""
    pixels = decoded(texture, MOST_SIDE_PX)
    if pixels is None:
        raise ValueError(f"the texture {texture.name} cannot be read")
    return pixels[..., :3]


def with_opacity(color: Texture, mask: Texture) -> Texture:
    """Return a colour texture with the alpha of another image, or with that image's brightness if it has no alpha."""
    first, second = _smaller(color.content, MOST_SIDE_PX), _smaller(mask.content, MOST_SIDE_PX)
    if first is None or second is None or color == mask:
        return color
    alpha = second.convert("RGBA").getchannel("A") if _has_alpha(second) else second.convert("L")
    image = first.convert("RGB")
    image.putalpha(alpha.resize(first.size))
    return texture_of(color.name, _png(image))


def packed_surface(roughness: Texture | None, metallic: Texture | None) -> Texture:
    """Return an image with roughness in the green and metallic in the blue channel, from grey images; a missing one is
    white.
    """
    first, second = (None if one is None else _smaller(one.content, MOST_SIDE_PX) for one in (roughness, metallic))
    size = next((image.size for image in (first, second) if image is not None), (1, 1))
    white = _white(size)
    bands = [white, *(white if image is None else image.convert("L").resize(size) for image in (first, second))]
    name = next(one.name for one in (roughness, metallic) if one is not None)
    return texture_of(f"{name}_orm", _png(_merged("RGB", bands)))


def _white(size: tuple[int, int]) -> Image:
    from PIL import Image

    return Image.new("L", size, 255)


def _merged(mode: str, bands: list[Image]) -> Image:
    from PIL import Image

    return Image.merge(mode, bands[: len(mode)])


def _encoded(texture: Texture, name: str, image: Image) -> Texture:
    """Return an image encoded as a texture in the file format of another texture."""
    if texture.mime_type == "image/png":
        return texture_of(name, _png(image))
    stream = io.BytesIO()
    image.save(stream, "JPEG", quality=JPEG_QUALITY)
    return texture_of(name, stream.getvalue())


def montage(
    name: str,
    tiles: Sequence[tuple[Texture | tuple[int, int, int], tuple[int, int, int, int]]],
    size: tuple[int, int],
    fill: tuple[int, ...],
    exact: bool = True,
) -> Texture:
    """Return one texture in which textures and plain colours are placed as tiles.

    Parameters
    ----------
    tiles : sequence of (Texture or (int, int, int), (int, int, int, int))
        Tiles, each with its left, top, width and height in pixels; a texture that cannot be read leaves its tile empty.
    size : (int, int)
        Width and height of the result in pixels.
    fill : tuple of int
        RGB or RGBA colour of pixels that no tile covers.
    exact : bool
        Whether to keep every number; otherwise the texture is a JPEG, a fraction as large, without alpha.
    """
    from PIL import Image

    mode = "RGBA" if len(fill) == 4 else "RGB"
    whole = Image.new(mode, size, fill)
    for tile, (left, top, width, height) in tiles:
        if isinstance(tile, tuple):
            whole.paste(tile, (left, top, left + width, top + height))
            continue
        image = _smaller(tile.content, max(width, height))
        if image is not None:
            whole.paste(image.convert(mode).resize((width, height)), (left, top))
    if exact:
        return texture_of(name, _png(whole))
    stream = io.BytesIO()
    whole.save(stream, "JPEG", quality=JPEG_QUALITY)
    return texture_of(name, stream.getvalue())


def size_px(texture: Texture) -> tuple[int, int]:
    """Return the width and height of a texture; 1 and 1 if it cannot be read."""
    image = _opened(texture.content)
    return (1, 1) if image is None else (image.width, image.height)
