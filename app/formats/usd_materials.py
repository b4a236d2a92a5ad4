"""Writing of the preview surfaces of a USD file, with textures as separate files.

Source: OpenUSD documentation, "UsdPreviewSurface Specification".
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Final

from app.formats.scene import Material
from app.formats.texture_files import TextureFiles
from app.formats.textures import TextureUse

_SRGB, _RAW = "sRGB", "raw"
_RGBA: Final = (1.0, 1.0, 1.0, 1.0)
_NOTHING: Final = (0.0, 0.0, 0.0, 0.0)


class UsdMaterials:
    """The preview surfaces of a file, each made on first use.

    Parameters
    ----------
    identifiers : callable
        Returns valid prim names that differ from those in use.
    """

    def __init__(
        self, stage: Any, path: str, files: TextureFiles, identifiers: Callable[[Iterable[str], set[str]], Any]
    ) -> None:
        self._stage, self._path = stage, path
        self._files, self._identifiers = files, identifiers
        self._made: dict[Material, Any] = {}
        self._taken: set[str] = set()

    def __getitem__(self, surface: Material) -> Any:
        from pxr import UsdGeom

        if not self._made:
            UsdGeom.Scope.Define(self._stage, self._path)
        if surface not in self._made:
            (name,) = self._identifiers([surface.name], self._taken)
            self._taken.add(name)
            self._made[surface] = self._material(surface, f"{self._path}/{name}")
        return self._made[surface]

    def _material(self, surface: Material, path: str) -> Any:
        from pxr import Gf, Sdf, UsdShade

        material = UsdShade.Material.Define(self._stage, path)
        material.GetPrim().SetDisplayName(surface.name)
        shader = UsdShade.Shader.Define(self._stage, f"{path}/Surface")
        shader.CreateIdAttr("UsdPreviewSurface")
        color = Gf.Vec3f(*surface.base_color[:3])
        shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(color)
        for number, value in (
            ("metallic", surface.metallic),
            ("roughness", surface.roughness),
            ("opacity", surface.base_color[3]),
        ):
            shader.CreateInput(number, Sdf.ValueTypeNames.Float).Set(float(value))
        if surface.alpha_mode == "mask":
            shader.CreateInput("opacityThreshold", Sdf.ValueTypeNames.Float).Set(float(surface.alpha_cutoff))
        self._connect_textures(surface, shader, path)
        material.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
        return material

    def _connect_textures(self, surface: Material, shader: Any, path: str) -> None:
        from pxr import Sdf

        textures, floats = surface.textures, Sdf.ValueTypeNames.Float
        colors, normals = Sdf.ValueTypeNames.Color3f, Sdf.ValueTypeNames.Normal3f

        def connect(value: str, kind: Any, image: Any, output: str, output_kind: Any) -> None:
            made = image.CreateOutput(output, output_kind)
            shader.CreateInput(value, kind).ConnectToSource(made)

        if textures.color is not None:
            image = self._image(f"{path}/Color", textures.color, _SRGB, surface.base_color, _NOTHING)
            connect("diffuseColor", colors, image, "rgb", Sdf.ValueTypeNames.Float3)
            if surface.alpha_mode != "opaque":
                untinted = (1.0, 1.0, 1.0, surface.base_color[3])
                if surface.base_color != untinted:
                    # Blender takes the tinted color of a picture that has a scale for its alpha.
                    image = self._image(f"{path}/Opacity", textures.color, _SRGB, untinted, _NOTHING)
                connect("opacity", floats, image, "a", floats)
        if textures.normal is not None:
            lean = float(textures.normal_scale)
            spread, bias = (2.0 * lean, 2.0 * lean, 2.0, 1.0), (-lean, -lean, -1.0, 0.0)
            image = self._image(f"{path}/Normal", textures.normal, _RAW, spread, bias)
            connect("normal", normals, image, "rgb", Sdf.ValueTypeNames.Float3)
        strength = float(textures.occlusion_strength)
        rough = 1.0, surface.roughness, surface.metallic, 1.0
        image = None
        if textures.metallic_roughness is not None:
            shared = textures.occlusion == textures.metallic_roughness
            scale, bias = ((strength, *rough[1:]), (1.0 - strength, 0.0, 0.0, 0.0)) if shared else (rough, _NOTHING)
            image = self._image(f"{path}/Roughness", textures.metallic_roughness, _RAW, scale, bias)
            connect("roughness", floats, image, "g", floats)
            connect("metallic", floats, image, "b", floats)
        if textures.occlusion is not None:
            if textures.occlusion != textures.metallic_roughness:
                scale, bias = (strength, 1.0, 1.0, 1.0), (1.0 - strength, 0.0, 0.0, 0.0)
                image = self._image(f"{path}/Occlusion", textures.occlusion, _RAW, scale, bias)
            connect("occlusion", floats, image, "r", floats)

    def _image(
        self,
        path: str,
        use: TextureUse,
        space: str,
        scale: tuple[float, float, float, float],
        bias: tuple[float, float, float, float],
    ) -> Any:
        from pxr import Gf, Sdf, UsdShade

        kinds = Sdf.ValueTypeNames
        image = UsdShade.Shader.Define(self._stage, path)
        image.CreateIdAttr("UsdUVTexture")
        image.CreateInput("file", kinds.Asset).Set(Sdf.AssetPath(f"./{self._files.path(use.texture)}"))
        image.CreateInput("sourceColorSpace", kinds.Token).Set(space)
        image.CreateInput("wrapS", kinds.Token).Set("repeat")
        image.CreateInput("wrapT", kinds.Token).Set("repeat")
        if scale != _RGBA:
            image.CreateInput("scale", kinds.Float4).Set(Gf.Vec4f(*map(float, scale)))
        if bias != _NOTHING:
            image.CreateInput("bias", kinds.Float4).Set(Gf.Vec4f(*bias))
        places = UsdShade.Shader.Define(self._stage, f"{path}_st")
        places.CreateIdAttr("UsdPrimvarReader_float2")
        places.CreateInput("varname", kinds.String).Set("st")
        found = places.CreateOutput("result", kinds.Float2)
        if use.scale != (1.0, 1.0) or use.offset != (0.0, 0.0):
            moved = UsdShade.Shader.Define(self._stage, f"{path}_place")
            moved.CreateIdAttr("UsdTransform2d")
            moved.CreateInput("in", kinds.Float2).ConnectToSource(found)
            moved.CreateInput("scale", kinds.Float2).Set(Gf.Vec2f(*use.scale))
            moved.CreateInput("translation", kinds.Float2).Set(Gf.Vec2f(*use.offset_up))
            found = moved.CreateOutput("result", kinds.Float2)
        image.CreateInput("st", kinds.Float2).ConnectToSource(found)
        return image
