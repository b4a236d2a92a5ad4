"""Textures as plain values: encoded images, and their use in materials."""

from __future__ import annotations

import hashlib
import re
import unicodedata
from dataclasses import dataclass, field
from typing import Final, Literal
from weakref import WeakValueDictionary

AlphaMode = Literal["opaque", "mask", "blend"]

PNG_MAGIC: Final = b"\x89PNG\r\n\x1a\n"
_MOST_NAME: Final = 40
_UNSAFE: Final = re.compile(r"[^A-Za-z0-9_-]+")


@dataclass(frozen=True)
class Texture:
    """An image as the bytes of a PNG or JPEG file. Textures with equal bytes are equal, regardless of name.

    Attributes
    ----------
    digest : str
        Hash of the content, 32 hexadecimal digits.
    """

    digest: str
    name: str = field(compare=False)
    content: bytes = field(compare=False, repr=False)

    @property
    def mime_type(self) -> str:
        """Media type of the image, ``image/png`` or ``image/jpeg``."""
        return "image/png" if self.content.startswith(PNG_MAGIC) else "image/jpeg"

    @property
    def file_name(self) -> str:
        """File name of the image: letters, digits, ``_`` and ``-`` of its name, and the start of the digest."""
        plain = unicodedata.normalize("NFKD", self.name).encode("ascii", "ignore").decode()
        stem = _UNSAFE.sub("_", plain).strip("_")[:_MOST_NAME] or "texture"
        return f"{stem}_{self.digest[:8]}{'.png' if self.mime_type == 'image/png' else '.jpg'}"


@dataclass(frozen=True)
class TextureUse:
    """A texture in a material; it repeats in both directions.

    Attributes
    ----------
    scale, offset : (float, float)
        Image coordinates are ``scale * uv + offset``, v down, as in glTF's ``KHR_texture_transform``.
    """

    texture: Texture
    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)

    @property
    def offset_up(self) -> tuple[float, float]:
        """Offset for texture coordinates and images in which v points up."""
        return self.offset[0], 1.0 - self.scale[1] - self.offset[1]


@dataclass(frozen=True)
class MaterialTextures:
    """Textures of a metallic-roughness material, as in glTF 2.0; each is multiplied with the material's value.

    Attributes
    ----------
    color : TextureUse or None
        Colour in sRGB; its alpha is used unless the material is opaque.
    normal : TextureUse or None
        Normals in tangent space, green up (OpenGL).
    metallic_roughness : TextureUse or None
        Linear: green is roughness, blue is metallic.
    occlusion : TextureUse or None
        Occlusion of ambient light, linear, in the red channel.
    normal_scale, occlusion_strength : float
        Strength of the normal map and of the occlusion.
    """

    color: TextureUse | None = None
    normal: TextureUse | None = None
    metallic_roughness: TextureUse | None = None
    occlusion: TextureUse | None = None
    normal_scale: float = 1.0
    occlusion_strength: float = 1.0

    @property
    def uses(self) -> tuple[TextureUse, ...]:
        """Return all textures that the material has: colour, normal, metal and roughness, occlusion."""
        found = (self.color, self.normal, self.metallic_roughness, self.occlusion)
        return tuple(use for use in found if use is not None)


NO_TEXTURES: Final = MaterialTextures()

_known: Final[WeakValueDictionary[tuple[str, str], Texture]] = WeakValueDictionary()
"""Textures in use, so that equal textures of different files share memory."""


def texture_of(name: str, content: bytes) -> Texture:
    """Return the texture for the bytes of a PNG or JPEG file, without checking them."""
    digest = hashlib.blake2b(content, digest_size=16).hexdigest()
    return _known.setdefault((digest, name), Texture(digest, name, content))
