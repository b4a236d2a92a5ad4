"""Requirements of the import, checked before anything is changed."""

from __future__ import annotations

import unreal

from suisou_import import assets
from suisou_import.performance import Performance, check_files
from suisou_import.problem import problem

PLUGINS = {
    "EditorScriptingUtilities": ("EditorAssetLibrary", "EditorDialog"),
    "SequencerScripting": ("MovieSceneScriptingDoubleChannel",),
    "LevelSequenceEditor": ("LevelSequenceFactoryNew", "LevelSequenceEditorSubsystem"),
}
"""Names provided by each plug-in, which are missing without it."""
FUNCTIONS = {
    "LevelSequence": (
        "add_track",
        "find_tracks_by_exact_type",
        "set_tick_resolution",
        "delete_marked_frame",
        "get_binding_id",
    ),
    "MovieScene3DAttachSection": ("set_constraint_binding_id",),
    "MovieSceneSection": ("get_all_channels", "set_range_seconds"),
    "EditorAssetLibrary": ("find_package_referencers_for_asset", "set_metadata_tag"),
    "ScopedSlowTask": ("should_cancel",),
    "FbxFactory": (),
    "MaterialEditingLibrary": ("create_material_expression", "connect_material_property", "recompile_material"),
    "MaterialFactoryNew": (),
}
"""Names that older engines may lack."""


def check_engine() -> None:
    """Raise `Problem` if the editor lacks a requirement."""
    for plugin, names in PLUGINS.items():
        if not all(hasattr(unreal, name) for name in names):
            raise problem("plugin_off", name=plugin)
    missing = [name for name in FUNCTIONS if not hasattr(unreal, name)]
    missing += [
        f"{name}.{function}"
        for name, functions in FUNCTIONS.items()
        for function in functions
        if hasattr(unreal, name) and not hasattr(getattr(unreal, name), function)
    ]
    if missing:
        version = unreal.SystemLibrary.get_engine_version()
        raise problem("old_engine", version=version, names=", ".join(missing))


def check_performance(performance: Performance) -> None:
    """Raise `Problem` if files differ from the exported ones, or if an asset of another origin would be replaced."""
    check_files(performance)
    for path in performance.assets:
        asset = assets.existing(path)
        if asset is not None and not assets.is_replaceable(path, asset, performance.piece):
            raise problem("not_ours", asset=path)
    sequence = assets.existing(performance.sequence)
    if isinstance(sequence, unreal.LevelSequence) and sequence.is_read_only():
        raise problem("read_only", asset=performance.sequence)
