"""Import of a performance into the project step by step, with progress and results for the user."""

from __future__ import annotations

from collections.abc import Callable

import unreal

from suisou_import import assets, checks, materials, sequence
from suisou_import.fbx_options import sample_rate
from suisou_import.performance import SHARED, Performance, others
from suisou_import.problem import Cancelled, problem, text


def bring_in(performance: Performance) -> list[str]:
    """Import a performance, or bring what was imported up to date.

    Returns
    -------
    list of str
        What is reported to the user besides that it is done.

    Raises
    ------
    Problem, Cancelled
    """
    reported: list[str] = []
    count = len(performance.bodies) + len(performance.figures) + 4
    count += len(performance.textures) + len(performance.surfaces)
    with unreal.ScopedSlowTask(count, performance.title) as task:
        task.make_dialog(True)

        def step(name: str, /, **arguments: object) -> None:
            if task.should_cancel():
                raise Cancelled
            task.enter_progress_frame(1, text(name, **arguments))

        step("step_check")
        checks.check_performance(performance)
        _assets(performance, step, reported)
    return reported + [text("left_out", name=one.name, reason=one.reason) for one in performance.left_out]


def _assets(performance: Performance, step: Callable[..., None], reported: list[str]) -> None:
    anew: set[str] = set()
    for figure in performance.bodies:
        step("step_mesh", name=figure.name)
        if assets.import_mesh(performance, figure):
            anew.add(figure.mesh)
            reported.append(text("new_skeleton", asset=figure.mesh))
    larger: dict[str, int] = {}
    sharing = others(performance) if performance.textures else []
    for texture in performance.textures:
        step("step_texture", name=texture.asset.rpartition("/")[2])
        owner, shown = materials.largest(performance, texture, sharing)
        materials.import_texture(owner, shown)
        if owner is not performance:
            larger[owner.piece] = larger.get(owner.piece, 0) + 1
    reported += [text("larger_textures", count=count, piece=piece) for piece, count in larger.items()]
    for surface in performance.surfaces:
        step("step_material", name=surface.asset.rpartition("/")[2])
        materials.make_material(performance, surface)
    for figure in performance.bodies:
        materials.assign(performance, figure)
    for figure in performance.figures:
        step("step_animation", name=figure.name)
        animation = assets.import_animation(performance, figure)
        keys = int(animation.get_editor_property("number_of_sampled_keys"))
        if sample_rate(performance.rate) and keys != performance.frames:
            reported.append(text("other_length", asset=figure.animation, keys=keys, frames=performance.frames))
    step("step_sound")
    assets.import_sound(performance)
    step("step_sequence")
    reported += sequence.build(performance, anew)
    staying = sequence.shown_with(performance)
    staying |= materials.in_use({figure.mesh for figure in performance.bodies} | performance.staying | staying)
    reported += assets.remove_leftovers(performance, staying)
    step("step_save")
    folders = [performance.content, *([SHARED.rstrip("/")] if performance.textures else [])]
    for folder in folders:
        if not unreal.EditorAssetLibrary.save_directory(folder, only_if_is_dirty=True, recursive=True):
            raise problem("not_saved", folder=folder)


def show(performance: Performance) -> None:
    """Open the sequence, or refresh it if it is open."""
    asset = assets.existing(performance.sequence)
    if isinstance(asset, unreal.LevelSequence):
        unreal.LevelSequenceEditorBlueprintLibrary.open_level_sequence(asset)
        unreal.LevelSequenceEditorBlueprintLibrary.refresh_current_level_sequence()
