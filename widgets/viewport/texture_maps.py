"""Textures on the graphics card: shared by performers, smaller for distant ones, within a memory limit."""

from __future__ import annotations

from collections import OrderedDict
from typing import Any, Final

import numpy as np
from vispy import gloo
from vispy.gloo import gl

from app.formats.images import Pixels, decoded, small
from app.formats.scene import Material
from app.formats.textures import Texture, TextureUse

NEAR_PX: Final = 1024
"""Longest side in pixels of a texture for near performers; for far ones that of `app.formats.images.small`."""
MOST_BYTES: Final = 192 * 2**20
"""Limit in bytes of all textures on the card, plus a third for mipmaps; the least recently drawn are dropped."""
BLENDED: Final = 2.0
"""Cutoff value that means transparency by dithering."""
MULTISAMPLED, WHOLE_PIXELS = 0.02, 0.25
"""Least share of a pixel that cut-out parts must cover: with multisampling, and without, where thin brows would
otherwise break up.
"""
_GL_LINEAR_MIPMAP_LINEAR: Final = 0x2703
_WHITE: Final = np.full((1, 1, 4), 255, np.uint8)
_FLAT: Final = np.array([[[128, 128, 255, 255]]], np.uint8)


class TextureMaps:
    """Cache of textures in the current GL context."""

    def __init__(self) -> None:
        self._maps: OrderedDict[tuple[str, bool], Any] = OrderedDict()
        self._bytes = 0
        self._white, self._flat = texture_of_pixels(_WHITE), texture_of_pixels(_FLAT)
        self.left = 0
        """Number of textures that may still be read for this picture."""

    def clear(self) -> None:
        """Remove all textures; the graphics card frees them with the next picture."""
        self._maps.clear()
        self._bytes = 0

    def undress(self, program: Any) -> None:
        """Set a shader program to draw in vertex colours, without textures."""
        program["u_textured"] = 0.0
        program["u_color_map"], program["u_surface_map"], program["u_normal_map"] = self._white, self._white, self._flat

    def dress(self, program: Any, look: Material, near: bool) -> None:
        """Set a shader program to draw with the textures of a material; the normal map is used only for ``near``
        performers.
        """
        textures = look.textures
        program["u_textured"] = 1.0
        surface = textures.metallic_roughness or textures.occlusion
        program["u_color_map"] = self._map(textures.color, near, self._white)
        program["u_surface_map"] = self._map(surface, near, self._white)
        relief = self._map(textures.normal if near else None, near, self._flat)
        program["u_normal_map"] = relief
        for name, use in (("color", textures.color), ("surface", surface), ("normal", textures.normal)):
            program[f"u_{name}_place"] = (1.0, 1.0, 0.0, 0.0) if use is None else (*use.scale, *use.offset)
        mode = look.alpha_mode
        cutoff = {"opaque": -1.0, "mask": look.alpha_cutoff, "blend": BLENDED}[mode]
        program["u_factor"] = look.base_color
        shared = textures.metallic_roughness is not None
        program["u_surface"] = (look.roughness, look.metallic, textures.normal_scale, cutoff)
        occluded = textures.occlusion is not None and textures.occlusion in (surface, None)
        program["u_shared"] = (
            float(shared),
            textures.occlusion_strength if occluded else 0.0,
            float(max(relief.shape[:2])),
        )
        program["u_color_px"] = float(max(program["u_color_map"].shape[:2]))

    def _map(self, use: TextureUse | None, near: bool, otherwise: Any) -> Any:
        if use is None:
            return otherwise
        key = use.texture.digest, near
        if key not in self._maps:
            if near and self.left <= 0:
                return self._map(use, False, otherwise)
            self.left -= near
            pixels = _pixels(use.texture, near)
            self._maps[key] = otherwise if pixels is None else texture_of_pixels(pixels)
            self._bytes += 0 if pixels is None else pixels.nbytes
            while self._bytes > MOST_BYTES and len(self._maps) > 1:
                _, oldest = self._maps.popitem(last=False)
                self._bytes -= 0 if oldest in (self._white, self._flat) else int(np.prod(oldest.shape))
        self._maps.move_to_end(key)
        return self._maps[key]


def _pixels(texture: Texture, near: bool) -> Pixels | None:
    return decoded(texture, NEAR_PX) if near else small(texture)


def texture_of_pixels(pixels: Pixels) -> Any:
    """Return a texture with mipmaps, so that fine details do not flicker."""
    texture = gloo.Texture2D(np.ascontiguousarray(pixels), interpolation="linear", wrapping="repeat")
    # vispy does not support these modes by name. Its last command leaves the texture bound.
    texture.glir.command("INTERPOLATION", texture.id, _GL_LINEAR_MIPMAP_LINEAR, "linear")
    texture.glir.command("FUNC", "glGenerateMipmap", gl.GL_TEXTURE_2D)
    return texture
