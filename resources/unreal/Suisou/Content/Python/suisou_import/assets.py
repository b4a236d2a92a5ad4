"""Meshes, skeletons, animations, images and the sound: made, updated in place, and removed when no one plays them.

FBX goes through the older importer (`suisou_import.fbx_options`), since newer engines would take Interchange. Every
asset of ours bears the name of its piece as metadata; what does not is someone else's and is not touched.
"""

from __future__ import annotations

import hashlib
from typing import TypeVar

import unreal

from suisou_import.fbx_options import animation_options, mesh_options, older_importer
from suisou_import.performance import SHARED, Figure, Performance, found, read
from suisou_import.problem import Problem, problem, text

_Asset = TypeVar("_Asset", bound=unreal.Object)

PIECE_TAG = "SuisouPiece"
MADE_FOR_TAG = "SuisouMadeFor"
"""Metadata of assets that an importer makes in addition to a mesh, its materials: path of the mesh."""
FIRST_FRAME_TAG, FIRST_SECOND_TAG = "SuisouFirstFrame", "SuisouFirstSecond"
"""Metadata of animated assets: number of the first frame in the whole piece, and that frame's time in seconds after the
first beat.
"""
BONES_TAG = "SuisouBones"


def existing(path: str) -> unreal.Object | None:
    """Asset at a path; None if there is none."""
    return unreal.EditorAssetLibrary.load_asset(path) if unreal.EditorAssetLibrary.does_asset_exist(path) else None


def is_ours(asset: unreal.Object, piece: str) -> bool:
    """Return whether this plug-in made an asset for a piece."""
    return unreal.EditorAssetLibrary.get_metadata_tag(asset, PIECE_TAG) == piece


def is_replaceable(path: str, asset: unreal.Object, piece: str) -> bool:
    """Return whether this plug-in made an asset for a piece, or for any piece if the asset is shared."""
    made_for = unreal.EditorAssetLibrary.get_metadata_tag(asset, PIECE_TAG)
    return made_for == piece or (path.startswith(SHARED) and bool(made_for))


def tag(asset: unreal.Object, performance: Performance) -> None:
    """Mark an asset as made by this plug-in."""
    unreal.EditorAssetLibrary.set_metadata_tag(asset, PIECE_TAG, performance.piece)
    if isinstance(asset, (unreal.AnimSequence, unreal.LevelSequence)):
        unreal.EditorAssetLibrary.set_metadata_tag(asset, FIRST_FRAME_TAG, str(performance.first_frame))
        unreal.EditorAssetLibrary.set_metadata_tag(asset, FIRST_SECOND_TAG, f"{performance.first_frame_s:.6f}")


def import_mesh(performance: Performance, figure: Figure) -> bool:
    """Make the mesh and the skeleton of a figure, and of all that share them, or bring them up to date.

    Returns
    -------
    bool
        Whether they are made anew although they were there, because the bones are others now.
    """
    bones = hashlib.sha256("\n".join(figure.bones).encode("utf-8")).hexdigest()
    skeleton = existing(figure.skeleton)
    anew = False
    if skeleton is not None and unreal.EditorAssetLibrary.get_metadata_tag(skeleton, BONES_TAG) != bones:
        played = [other.animation for other in performance.figures if other.skeleton == figure.skeleton]
        for path in (*played, figure.mesh, figure.skeleton):
            _delete(path)
        skeleton, anew = None, True
    folder = figure.mesh.rpartition("/")[0]
    before = set(_listed(folder))
    _import(
        performance, figure.file, figure.mesh, mesh_options(skeleton if isinstance(skeleton, unreal.Skeleton) else None)
    )
    mesh = _made(performance, figure.mesh, figure.file, unreal.SkeletalMesh)
    made = mesh.skeleton
    if made is None:
        raise problem("not_imported", asset=figure.skeleton, file=figure.file)
    if skeleton is None:
        # The importer calls it after the mesh.
        if not unreal.EditorAssetLibrary.rename_loaded_asset(made, figure.skeleton):
            raise problem("not_changed", asset=figure.skeleton)
        tag(made, performance)
        unreal.EditorAssetLibrary.set_metadata_tag(made, BONES_TAG, bones)
    for path in set(_listed(folder)) - before - {figure.mesh, figure.skeleton}:
        beside = existing(path)
        if beside is not None:
            tag(beside, performance)
            unreal.EditorAssetLibrary.set_metadata_tag(beside, MADE_FOR_TAG, figure.mesh)
    return anew


def import_animation(performance: Performance, figure: Figure) -> unreal.AnimSequence:
    """Make the animation of a figure on its skeleton, or bring it up to date."""
    skeleton = existing(figure.skeleton)
    if not isinstance(skeleton, unreal.Skeleton):
        raise problem("not_imported", asset=figure.skeleton, file=figure.file)
    there = existing(figure.animation)
    if isinstance(there, unreal.AnimSequence) and there.get_editor_property("skeleton") is not skeleton:
        _delete(figure.animation)
    _import(performance, figure.file, figure.animation, animation_options(skeleton, performance.rate))
    return _made(performance, figure.animation, figure.file, unreal.AnimSequence)


def import_sound(performance: Performance) -> unreal.SoundWave:
    """Make the sound, or bring it up to date."""
    _import(performance, performance.sound.file, performance.sound.asset, None)
    return _made(performance, performance.sound.asset, performance.sound.file, unreal.SoundWave)


def import_image(performance: Performance, file: str, asset: str) -> unreal.Texture2D:
    """Make a texture of an image, or bring it up to date."""
    _import(performance, file, asset, None)
    return _made(performance, asset, file, unreal.Texture2D)


def remove_leftovers(performance: Performance, shown: set[str]) -> list[str]:
    """Remove assets made by this plug-in that are no longer used; return the reports about them.

    Parameters
    ----------
    shown : set of str
        Paths of what excluded performers are shown with, and of what meshes that stay show.
    """
    requested = set(performance.assets) | performance.staying | shown
    gone: list[str] = []
    for path in _listed(performance.content):
        asset = existing(path)
        if asset is None or path in requested or not is_ours(asset, performance.piece):
            continue
        made_for = unreal.EditorAssetLibrary.get_metadata_tag(asset, MADE_FOR_TAG)
        if made_for not in requested:
            gone.append(path)
    reported = []
    inside = performance.content + "/"
    for path in sorted(gone, key=_order):
        users = unreal.EditorAssetLibrary.find_package_referencers_for_asset(path)
        others = sorted(str(user) for user in users if not str(user).startswith(inside))
        if others:
            reported.append(text("kept", asset=path, user=others[0]))
        else:
            _delete(path)
            reported.append(text("removed", asset=path))
    return reported + _remove_shared(performance, requested)


def _remove_shared(performance: Performance, requested: set[str]) -> list[str]:
    """Remove textures that no piece needs and no asset uses; return the reports about them."""
    try:
        others = [read(folder) for folder in found(performance.folder.parent) if folder != performance.folder]
    except Problem:
        return []  # the requirements of that piece are unknown
    needed = requested | {texture.asset for one in others for texture in one.textures}
    reported = []
    for path in sorted(_listed(SHARED.rstrip("/")) - needed):
        asset = existing(path)
        if asset is None or not is_replaceable(path, asset, performance.piece):
            continue
        if not unreal.EditorAssetLibrary.find_package_referencers_for_asset(path):
            _delete(path)
            reported.append(text("removed", asset=path))
    return reported


def _order(path: str) -> tuple[int, str]:
    """Return the key by which assets are sorted: animations, meshes, skeletons, materials, the rest; then the path."""
    prefixes = ("A_", "SK_", "SKEL_", "M_")
    name = path.rpartition("/")[2]
    return next((index for index, prefix in enumerate(prefixes) if name.startswith(prefix)), len(prefixes)), path


def _import(performance: Performance, file: str, asset: str, options: unreal.FbxImportUI | None) -> None:
    folder, _, name = asset.rpartition("/")
    task = unreal.AssetImportTask()
    task.set_editor_property("filename", str(performance.path(file)))
    task.set_editor_property("destination_path", folder)
    task.set_editor_property("destination_name", name)
    task.set_editor_property("replace_existing", True)
    task.set_editor_property("replace_existing_settings", True)
    task.set_editor_property("automated", True)
    task.set_editor_property("save", False)
    if options is not None:
        task.set_editor_property("factory", unreal.FbxFactory())
        task.set_editor_property("options", options)
    with older_importer():
        unreal.AssetToolsHelpers.get_asset_tools().import_asset_tasks([task])
    if not list(task.get_editor_property("imported_object_paths")):
        raise problem("not_imported", asset=asset, file=performance.path(file))


def _made(performance: Performance, path: str, file: str, kind: type[_Asset]) -> _Asset:
    asset = existing(path)
    if not isinstance(asset, kind):
        raise problem("not_imported", asset=path, file=performance.path(file))
    tag(asset, performance)
    return asset


def _listed(folder: str) -> set[str]:
    """Paths of the assets in a folder and its subfolders."""
    if not unreal.EditorAssetLibrary.does_directory_exist(folder):
        return set()
    return {str(path).split(".")[0] for path in unreal.EditorAssetLibrary.list_assets(folder)}


def _delete(path: str) -> None:
    if existing(path) is not None and not unreal.EditorAssetLibrary.delete_asset(path):
        raise problem("not_changed", asset=path)
