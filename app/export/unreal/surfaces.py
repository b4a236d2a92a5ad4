"""Textured materials of an export for Unreal, and the texture files they are made from."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Literal

import msgspec

from app.export.unreal.layout import CONTENT
from app.export.unreal.names import asset_name
from app.formats.images import resized, size_px
from app.formats.scene import Material
from app.formats.texture_files import TEXTURES_FOLDER
from app.formats.textures import NO_TEXTURES, AlphaMode, Texture, TextureUse
from app.rig.mesh import Mesh

TextureKind = Literal["color", "normal", "masks"]
_SUFFIX: dict[TextureKind, str] = {"color": "D", "normal": "N", "masks": "ORM"}


class UnrealTexture(msgspec.Struct, frozen=True):
    """A texture: its file relative to the description, and its asset.

    The kind determines compression and colour space; a file used as two kinds gives two assets. Green of normals points
    up, as in glTF.
    """

    file: str
    asset: str
    kind: TextureKind
    px: int = 0
    """Longest side of the image in pixels: pieces that share the asset may have images of different sizes."""


class UnrealMap(msgspec.Struct, frozen=True):
    """A texture as used by a material in Unreal: its asset and its place on the surface; image coordinates are ``scale
    * uv + offset``, v down."""

    texture: str
    scale: tuple[float, float]
    offset: tuple[float, float]


class UnrealMaterial(msgspec.Struct, frozen=True):
    """A material with textures, each multiplied with the corresponding value; colours are linear.

    ``surface`` has roughness in green and metallic in blue, ``occlusion`` is in red; ``cutoff`` is the smallest visible
    alpha if alpha cuts out.
    """

    asset: str
    base_color: tuple[float, float, float, float]
    metallic: float
    roughness: float
    normal_scale: float
    occlusion_strength: float
    two_sided: bool
    alpha: AlphaMode
    cutoff: float
    color: UnrealMap | None
    normal: UnrealMap | None
    surface: UnrealMap | None
    occlusion: UnrealMap | None


@dataclass(frozen=True)
class FileContents:
    """Contents of the file of a character or instrument: bones, the root first, and asset of each textured material by
    name.
    """

    bones: tuple[str, ...]
    materials: dict[str, str]


@dataclass
class Surfaces:
    """Collector of the textured materials of meshes.

    Attributes
    ----------
    content : str
        Asset folder of the piece.
    texture_px : int
        Longest side of textures in pixels; 0 for no textures.
    """

    content: str
    texture_px: int
    _images: dict[str, Texture] = field(default_factory=dict)
    _textures: dict[str, UnrealTexture] = field(default_factory=dict)
    _materials: dict[Material, UnrealMaterial] = field(default_factory=dict)

    @property
    def textures(self) -> tuple[UnrealTexture, ...]:
        """Return all textures of the export, sorted by asset path."""
        return tuple(self._textures[asset] for asset in sorted(self._textures))

    @property
    def materials(self) -> tuple[UnrealMaterial, ...]:
        """Return all materials of the export, sorted by asset path."""
        return tuple(sorted(self._materials.values(), key=lambda one: one.asset))

    @property
    def files(self) -> tuple[PurePosixPath, ...]:
        """Return the paths of the texture files, relative to the piece's sources."""
        return tuple(map(PurePosixPath, sorted(self._images)))

    def slots(self, meshes: Iterable[Mesh]) -> dict[str, str]:
        """Add the textured materials of some meshes, and return the asset of each by material name."""
        if not self.texture_px:
            return {}
        textured = (one for mesh in meshes for one in mesh.materials if one.textures != NO_TEXTURES)
        return {material.name: self._material(material).asset for material in textured}

    def write(self, sources: Path) -> None:
        """Write the texture files, scaled down to the requested size, into the piece's sources."""
        fitted: dict[str, Texture] = {}
        for material in self._materials:
            small = resized(material.textures, self.texture_px)
            pairs = zip(material.textures.uses, small.uses, strict=True)
            fitted |= {_file(use.texture): made.texture for use, made in pairs}
        for name in self._images:
            target = sources / name
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(fitted[name].content)

    def _material(self, material: Material) -> UnrealMaterial:
        if material not in self._materials:
            textures = material.textures
            # The name depends on the material and not on the size of its textures, so another size renames nothing.
            digest = hashlib.sha256(repr(material).encode("utf-8", "surrogatepass")).hexdigest()[:8]
            red, green, blue, alpha = (float(value) for value in material.base_color)
            self._materials[material] = UnrealMaterial(
                asset=f"{self.content}/Materials/M_{asset_name(material.name, 'Material')}_{digest}",
                base_color=(red, green, blue, alpha),
                metallic=float(material.metallic),
                roughness=float(material.roughness),
                normal_scale=float(textures.normal_scale),
                occlusion_strength=float(textures.occlusion_strength),
                # Hair cards are visible from both sides.
                two_sided=material.double_sided or material.alpha_mode == "mask",
                alpha=material.alpha_mode,
                cutoff=float(material.alpha_cutoff),
                color=self._map(textures.color, "color"),
                normal=self._map(textures.normal, "normal"),
                surface=self._map(textures.metallic_roughness, "masks"),
                occlusion=self._map(textures.occlusion, "masks"),
            )
        return self._materials[material]

    def _map(self, use: TextureUse | None, kind: TextureKind) -> UnrealMap | None:
        if use is None:
            return None
        file = _file(use.texture)
        self._images[file] = use.texture
        asset = f"{CONTENT}/{TEXTURES_FOLDER}/T_{PurePosixPath(file).stem}_{_SUFFIX[kind]}"
        px = min(max(size_px(use.texture)), self.texture_px)
        self._textures[asset] = UnrealTexture(file, asset, kind, px)
        scale, offset = (tuple(map(float, pair)) for pair in (use.scale, use.offset))
        return UnrealMap(asset, (scale[0], scale[1]), (offset[0], offset[1]))


def _file(texture: Texture) -> str:
    return f"{TEXTURES_FOLDER}/{texture.file_name.replace('-', '_')}"
