"""Options of an FBX import: every one that the class has, since the user's last dialog leaves its own behind.

The importer that takes them is the one before Interchange. Newer engines give FBX files to Interchange even where a
task names the factory, so it is switched off for the time of an import (`older_importer`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import unreal

INTERCHANGE = "Interchange.FeatureFlags.Import.FBX"
"""Console variable that makes Interchange import FBX files."""


@contextmanager
def older_importer() -> Iterator[None]:
    """Disable Interchange for FBX files temporarily; engines without the variable do not use it."""
    if not unreal.SystemLibrary.get_console_variable_bool_value(INTERCHANGE):
        yield
        return
    _switch("0")
    try:
        yield
    finally:
        _switch("1")


def _switch(value: str) -> None:
    subsystem = unreal.get_editor_subsystem(unreal.UnrealEditorSubsystem)
    if subsystem is not None:
        unreal.SystemLibrary.execute_console_command(subsystem.get_editor_world(), f"{INTERCHANGE} {value}")


def mesh_options(skeleton: unreal.Skeleton | None) -> unreal.FbxImportUI:
    """Options for a skeletal mesh; without a skeleton it gets one of its own."""
    return _options(unreal.FBXImportType.FBXIT_SKELETAL_MESH, skeleton, 0)


def animation_options(skeleton: unreal.Skeleton, rate: tuple[int, int]) -> unreal.FbxImportUI:
    """Options for an animation at a rate."""
    return _options(unreal.FBXImportType.FBXIT_ANIMATION, skeleton, sample_rate(rate))


def sample_rate(rate: tuple[int, int]) -> int:
    """Rate for the importer; 0 (the best for the file's keys) if it is no integer."""
    numerator, denominator = rate
    return 0 if numerator % denominator else numerator // denominator


def _options(kind: unreal.FBXImportType, skeleton: unreal.Skeleton | None, rate: int) -> unreal.FbxImportUI:
    options = unreal.FbxImportUI()
    _set(options, import_ui(kind, skeleton))
    _set(options.get_editor_property("skeletal_mesh_import_data"), skeletal_mesh())
    _set(options.get_editor_property("anim_sequence_import_data"), animation(rate))
    _set(options.get_editor_property("static_mesh_import_data"), static_mesh())
    _set(options.get_editor_property("texture_import_data"), textures())
    return options


def _set(target: unreal.Object, values: Mapping[str, Any]) -> None:
    """Set properties; unknown ones are written to the log."""
    for name, value in values.items():
        try:
            target.get_editor_property(name)
            target.set_editor_property(name, value)
        except Exception as error:  # noqa: BLE001  the engine raises it itself
            unreal.log(f"Suisou: this engine does not take the FBX option {name}: {error}")


def import_ui(kind: unreal.FBXImportType, skeleton: unreal.Skeleton | None) -> dict[str, Any]:
    """Properties of `unreal.FbxImportUI`, without its data objects."""
    mesh = kind == unreal.FBXImportType.FBXIT_SKELETAL_MESH
    return {
        "is_obj_import": False,
        "automated_import_should_detect_type": False,
        "original_import_type": kind,
        "mesh_type_to_import": kind,
        "import_as_skeletal": True,
        "import_rigid_mesh": False,
        "import_mesh": mesh,
        "import_animations": not mesh,
        "import_materials": mesh,
        "import_textures": False,
        # An artist's materials stay on a mesh that is brought up to date.
        "reset_to_fbx_on_material_conflict": False,
        "skeleton": skeleton,
        "create_physics_asset": False,
        "physics_asset": None,
        # The task names the asset.
        "override_full_name": True,
        "override_animation_name": "",
        "auto_compute_lod_distances": True,
        "lod_number": 0,
        "minimum_lod_number": 0,
        **{f"lod_distance{number}": 0.0 for number in range(8)},
    }


def _scene() -> dict[str, Any]:
    """Properties of all data objects: the file's axes and centimetres become Unreal's."""
    # Engines before 5.6 have no such policy.
    newer = hasattr(unreal, "CoordinateSystemPolicy")
    return {
        "convert_scene": True,
        "convert_scene_unit": True,
        "force_front_x_axis": False,
        "coordinate_system_policy": unreal.CoordinateSystemPolicy.MATCH_UP_FORWARD_AXES if newer else None,
        "import_translation": unreal.Vector(),
        "import_rotation": unreal.Rotator(),
        "import_uniform_scale": 1.0,
    }


def _mesh() -> dict[str, Any]:
    """Properties of the data of both kinds of meshes: normals and tangents are the file's."""
    return {
        **_scene(),
        "transform_vertex_to_absolute": True,
        "bake_pivot_in_vertex": False,
        "import_mesh_lods": True,
        "normal_import_method": unreal.FBXNormalImportMethod.FBXNIM_IMPORT_NORMALS_AND_TANGENTS,
        "normal_generation_method": unreal.FBXNormalGenerationMethod.MIKK_T_SPACE,
        "compute_weighted_normals": True,
        "reorder_material_to_fbx_order": True,
        "vertex_color_import_option": unreal.VertexColorImportOption.REPLACE,
        "vertex_override_color": unreal.Color(),
    }


def skeletal_mesh() -> dict[str, Any]:
    """Properties of `unreal.FbxSkeletalMeshImportData`."""
    return {
        **_mesh(),
        "import_content_type": unreal.FBXImportContentType.FBXICT_ALL,
        "import_meshes_in_bone_hierarchy": True,
        "import_morph_targets": True,
        "import_vertex_attributes": False,
        "keep_sections_separate": False,
        "preserve_smoothing_groups": True,
        "update_skeleton_reference_pose": True,
        "use_t0_as_ref_pose": False,
        # Vertices nearer than this become one, and so much moves in a morph target at least: centimetres.
        "threshold_position": 0.00002,
        "threshold_tangent_normal": 0.00002,
        "threshold_uv": 0.0009765625,
        "morph_threshold_position": 0.0015,
    }


def animation(rate: int) -> dict[str, Any]:
    """Properties of `unreal.FbxAnimSequenceImportData`."""
    return {
        **_scene(),
        "animation_length": unreal.FBXAnimationLengthImportType.FBXALIT_EXPORTED_TIME,
        "frame_import_range": unreal.Int32Interval(),
        # Left alone, everything is sampled at 30 frames per second.
        "use_default_sample_rate": False,
        "custom_sample_rate": rate,
        "snap_to_closest_frame_boundary": True,
        "import_bone_tracks": True,
        "import_meshes_in_bone_hierarchy": True,
        "preserve_local_transform": False,
        "remove_redundant_keys": False,
        "import_custom_attribute": False,
        "delete_existing_custom_attribute_curves": False,
        "delete_existing_non_curve_custom_attributes": False,
        "set_material_drive_parameter_on_custom_attribute": False,
        "material_curve_suffixes": ["_mat"],
        # The face: curves that bear the names of the morph targets. Those that are flat now go.
        "do_not_import_curve_with_zero": True,
        "delete_existing_morph_target_curves": True,
        "add_curve_metadata_to_skeleton": True,
    }


def static_mesh() -> dict[str, Any]:
    """Properties of `unreal.FbxStaticMeshImportData`, of which nothing is imported."""
    return {
        **_mesh(),
        "auto_generate_collision": False,
        "build_nanite": False,
        "build_reversed_index_buffer": False,
        "combine_meshes": False,
        "distance_field_resolution_scale": 1.0,
        "generate_lightmap_u_vs": False,
        "one_convex_hull_per_ucx": True,
        "remove_degenerates": True,
        "static_mesh_lod_group": "None",
    }


def textures() -> dict[str, Any]:
    """Properties of `unreal.FbxTextureImportData`: materials are made new, of colours alone."""
    return {
        **_scene(),
        "material_search_location": unreal.MaterialSearchLocation.LOCAL,
        "base_material_name": unreal.SoftObjectPath(),
        "base_color_name": "",
        "base_diffuse_texture_name": "",
        "base_emissive_color_name": "",
        "base_emmisive_texture_name": "",
        "base_normal_texture_name": "",
        "base_opacity_texture_name": "",
        "base_specular_texture_name": "",
        "invert_normal_maps": False,
    }
