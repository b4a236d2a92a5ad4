"""Textures and the materials that show them: made of the description, and put into the slots of meshes.

A material is made once and then left alone, so that what an artist changes in it stays; so is one of the artist's own
in a slot.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TypeVar

import unreal

from suisou_import import assets
from suisou_import.performance import Figure, Map, Performance, Surface, Texture, check_file
from suisou_import.problem import Problem, problem

FILE_TAG = "SuisouFile"
"""Metadata of a texture: digest of the file from which it was imported."""
MATERIAL_TAG = "SuisouMaterial"
"""Metadata of a material: version of its graph."""
TEXTURES_TAG = "SuisouTextures"
"""Metadata of a material: paths of its textures."""
GRAPH = "1"

_Expression = TypeVar("_Expression", bound=unreal.MaterialExpression)


def largest(performance: Performance, texture: Texture, others: Sequence[Performance]) -> tuple[Performance, Texture]:
    """The performance that has a texture with the largest image, and that: all that share the asset show it alike.

    Parameters
    ----------
    others : sequence of Performance
        Among which one with a larger image counts if its file is as it was exported.
    """
    for other in sorted(others, key=lambda one: one.piece):
        for same in other.textures:
            if same.asset == texture.asset and same.px > texture.px:
                try:
                    check_file(other, same.file)
                except (Problem, OSError):
                    continue
                performance, texture = other, same
    return performance, texture


def import_texture(performance: Performance, texture: Texture) -> None:
    """Make a texture, or bring it up to date where its file has changed."""
    digest = performance.files[texture.file][1]
    there = assets.existing(texture.asset)
    if there is None or unreal.EditorAssetLibrary.get_metadata_tag(there, FILE_TAG) != digest:
        made = assets.import_image(performance, texture.file, texture.asset)
        compressions = unreal.TextureCompressionSettings
        compression = {"normal": compressions.TC_NORMALMAP, "masks": compressions.TC_MASKS}
        made.set_editor_property("srgb", texture.kind == "color")
        made.set_editor_property("compression_settings", compression.get(texture.kind, compressions.TC_DEFAULT))
        # Green of the file points up (OpenGL), Unreal's down.
        made.set_editor_property("flip_green_channel", texture.kind == "normal")
        unreal.EditorAssetLibrary.set_metadata_tag(made, FILE_TAG, digest)


def make_material(performance: Performance, surface: Surface) -> None:
    """Make a material; an existing one is unchanged."""
    there = assets.existing(surface.asset)
    if there is not None and unreal.EditorAssetLibrary.get_metadata_tag(there, MATERIAL_TAG) == GRAPH:
        return
    if there is None:
        folder, _, name = surface.asset.rpartition("/")
        tools = unreal.AssetToolsHelpers.get_asset_tools()
        there = tools.create_asset(name, folder, unreal.Material, unreal.MaterialFactoryNew())
    if not isinstance(there, unreal.Material):
        raise problem("not_imported", asset=surface.asset, file=performance.folder)
    # Tagged before anything else, so that an incomplete material is recognised as the plug-in's.
    assets.tag(there, performance)
    _settings(there, surface)
    unreal.MaterialEditingLibrary.delete_all_material_expressions(there)
    _Graph(there).build(surface)
    unreal.MaterialEditingLibrary.recompile_material(there)
    unreal.EditorAssetLibrary.set_metadata_tag(there, TEXTURES_TAG, " ".join(surface.textures))
    unreal.EditorAssetLibrary.set_metadata_tag(there, MATERIAL_TAG, GRAPH)


def assign(performance: Performance, figure: Figure) -> None:
    """Put its materials into the slots of a figure's mesh, except where an artist has put another."""
    mesh = assets.existing(figure.mesh)
    if not isinstance(mesh, unreal.SkeletalMesh):
        return
    wanted = {_plain(slot): path for slot, path in figure.materials.items()}
    folder = figure.mesh.rpartition("/")[0]
    slots = list(mesh.materials)
    changed = False
    for slot in slots:
        name, present = str(slot.material_slot_name), slot.material_interface
        if present is not None and not _replaceable(performance, present):
            continue
        path = wanted.get(_plain(name))
        if path is None and (present is None or not unreal.EditorAssetLibrary.get_metadata_tag(present, MATERIAL_TAG)):
            continue
        # Exported without textures now, it has the material that the importer made beside the mesh.
        material = assets.existing(path or f"{folder}/{name}")
        if isinstance(material, unreal.MaterialInterface) and material is not present:
            slot.material_interface = material
            changed = True
    if changed:
        mesh.materials = slots


def in_use(paths: set[str]) -> set[str]:
    """Paths of the materials used by the meshes among some assets, and of the materials' textures."""
    found: set[str] = set()
    for path in paths:
        mesh = assets.existing(path)
        for slot in mesh.materials if isinstance(mesh, unreal.SkeletalMesh) else ():
            material = slot.material_interface
            if material is not None:
                found.add(material.get_path_name().split(".")[0])
                found.update(unreal.EditorAssetLibrary.get_metadata_tag(material, TEXTURES_TAG).split())
    return found


def _replaceable(performance: Performance, material: unreal.MaterialInterface) -> bool:
    """Return whether a material was made by this plug-in, or is the engine's default."""
    return material.get_path_name().startswith("/Engine/") or assets.is_ours(material, performance.piece)


def _plain(name: str) -> str:
    """Normalised name of a slot: the importer changes some characters, and case is ignored."""
    return re.sub(r"[^a-z0-9]+", "_", name.lower())


def _settings(material: unreal.Material, surface: Surface) -> None:
    modes = {"mask": unreal.BlendMode.BLEND_MASKED, "blend": unreal.BlendMode.BLEND_TRANSLUCENT}
    material.set_editor_property("blend_mode", modes.get(surface.alpha, unreal.BlendMode.BLEND_OPAQUE))
    material.set_editor_property("two_sided", surface.two_sided)
    material.set_editor_property("opacity_mask_clip_value", surface.cutoff)
    material.set_editor_property("used_with_skeletal_mesh", True)
    material.set_editor_property("used_with_morph_targets", True)


class _Graph:
    """Graph of a material under construction, with a column of nodes for each step."""

    def __init__(self, material: unreal.Material) -> None:
        self._material = material
        self._rows = 0

    def build(self, surface: Surface) -> None:
        """Make all nodes: base colour x tint, opacity, normal, roughness, metal, occlusion."""
        properties = unreal.MaterialProperty
        tint = self._vector("Tint", *surface.base_color)
        if surface.color is None:
            self._output(tint, "", properties.MP_BASE_COLOR)
            self._opacity(surface.alpha, tint, "A")
        else:
            color = self._sample("BaseColor", surface.color, unreal.MaterialSamplerType.SAMPLERTYPE_COLOR)
            self._output(self._times(color, "RGB", tint, ""), "", properties.MP_BASE_COLOR)
            if surface.alpha != "opaque":
                self._opacity(surface.alpha, self._times(color, "A", tint, "A"), "")
        if surface.normal is not None:
            normal = self._sample("Normal", surface.normal, unreal.MaterialSamplerType.SAMPLERTYPE_NORMAL)
            lean = self._vector("NormalScale", surface.normal_scale, surface.normal_scale, 1.0, 1.0)
            self._output(self._times(normal, "RGB", lean, ""), "", properties.MP_NORMAL)
        masks = unreal.MaterialSamplerType.SAMPLERTYPE_MASKS
        roughness = self._scalar("Roughness", surface.roughness)
        metallic = self._scalar("Metallic", surface.metallic)
        packed = None
        if surface.surface is None:
            self._output(roughness, "", properties.MP_ROUGHNESS)
            self._output(metallic, "", properties.MP_METALLIC)
        else:
            packed = self._sample("ORM", surface.surface, masks)
            self._output(self._times(packed, "G", roughness, ""), "", properties.MP_ROUGHNESS)
            self._output(self._times(packed, "B", metallic, ""), "", properties.MP_METALLIC)
        if surface.occlusion is not None:
            own = packed is None or surface.occlusion != surface.surface
            image = self._sample("Occlusion", surface.occlusion, masks) if packed is None or own else packed
            strength = self._scalar("OcclusionStrength", surface.occlusion_strength)
            self._output(self._faded(image, strength), "", properties.MP_AMBIENT_OCCLUSION)

    def _opacity(self, alpha: str, node: unreal.MaterialExpression, output: str) -> None:
        properties = unreal.MaterialProperty
        if alpha != "opaque":
            self._output(node, output, properties.MP_OPACITY_MASK if alpha == "mask" else properties.MP_OPACITY)

    def _node(self, kind: type[_Expression], column: int) -> _Expression:
        self._rows += 1
        place = (-300 * column, 150 * self._rows)
        node = unreal.MaterialEditingLibrary.create_material_expression(self._material, kind, *place)
        if not isinstance(node, kind):
            raise problem("not_changed", asset=self._material.get_path_name())
        return node

    def _vector(self, name: str, *values: float) -> unreal.MaterialExpression:
        node = self._node(unreal.MaterialExpressionVectorParameter, 3)
        node.set_editor_property("parameter_name", name)
        node.set_editor_property("default_value", unreal.LinearColor(*values))
        return node

    def _scalar(self, name: str, value: float) -> unreal.MaterialExpression:
        node = self._node(unreal.MaterialExpressionScalarParameter, 3)
        node.set_editor_property("parameter_name", name)
        node.set_editor_property("default_value", value)
        return node

    def _sample(self, name: str, use: Map, kind: unreal.MaterialSamplerType) -> unreal.MaterialExpression:
        texture = assets.existing(use.texture)
        if not isinstance(texture, unreal.Texture2D):
            raise problem("not_imported", asset=use.texture, file=name)
        node = self._node(unreal.MaterialExpressionTextureSampleParameter2D, 3)
        node.set_editor_property("parameter_name", name)
        node.set_editor_property("texture", texture)
        node.set_editor_property("sampler_type", kind)
        if (use.scale, use.offset) != ((1.0, 1.0), (0.0, 0.0)):
            places = self._node(unreal.MaterialExpressionTextureCoordinate, 5)
            places.set_editor_property("u_tiling", use.scale[0])
            places.set_editor_property("v_tiling", use.scale[1])
            offset = self._node(unreal.MaterialExpressionConstant2Vector, 5)
            offset.set_editor_property("r", use.offset[0])
            offset.set_editor_property("g", use.offset[1])
            moved = self._node(unreal.MaterialExpressionAdd, 4)
            self._link(places, "", moved, "A")
            self._link(offset, "", moved, "B")
            # The first input, the coordinates, has other names in other engines.
            self._link(moved, "", node, "")
        return node

    def _times(
        self, first: unreal.MaterialExpression, output: str, second: unreal.MaterialExpression, other: str
    ) -> unreal.MaterialExpression:
        node = self._node(unreal.MaterialExpressionMultiply, 1)
        self._link(first, output, node, "A")
        self._link(second, other, node, "B")
        return node

    def _faded(
        self, image: unreal.MaterialExpression, strength: unreal.MaterialExpression
    ) -> unreal.MaterialExpression:
        """Red of an image, nearer to 1 for lower strength."""
        node = self._node(unreal.MaterialExpressionLinearInterpolate, 1)
        node.set_editor_property("const_a", 1.0)
        self._link(image, "R", node, "B")
        self._link(strength, "", node, "Alpha")
        return node

    def _link(
        self, source: unreal.MaterialExpression, output: str, target: unreal.MaterialExpression, place: str
    ) -> None:
        if not unreal.MaterialEditingLibrary.connect_material_expressions(source, output, target, place):
            raise problem("not_changed", asset=self._material.get_path_name())

    def _output(self, node: unreal.MaterialExpression, output: str, place: unreal.MaterialProperty) -> None:
        if not unreal.MaterialEditingLibrary.connect_material_property(node, output, place):
            raise problem("not_changed", asset=self._material.get_path_name())
