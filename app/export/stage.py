"""The whole stage in one file: everyone's character and instruments, each at the player's place."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import chain, count
from pathlib import Path

from app.export.attachment import attached, own_path
from app.export.character import character_scene
from app.export.equipped_skeleton import socket_names
from app.export.file_names import figure_stems, sound_name, stage_names
from app.export.formats import FILE_FORMATS, Format, WriteOptions
from app.export.instrument import instrument_scene
from app.export.keyed import keyed_character, keyed_instrument
from app.export.player import held_paths
from app.export.report import StageFigure, StageReport, stage_place
from app.export.request import ExportCast, ExportRequest
from app.export.rig import ORIGIN, floor_place
from app.export.target import TargetSkeleton
from app.formats.scene import Material, Scene
from app.performance.motion import player_motion
from app.project.casting import StagePosition
from app.project.names import file_stem
from app.project.performers import Dancer, Player


def write_stage(
    request: ExportRequest, cast: ExportCast, folder: Path, reported: Callable[[float], None] = lambda share: None
) -> StageReport:
    """Write the stage in every requested format that can hold it.

    Motions are made anew for each file, player by player, so that one player's at a time is in memory.

    Parameters
    ----------
    request : ExportRequest
    cast : ExportCast
    folder : path
    reported : callable
        Called with the share 0..1 that is done; may raise Cancelled.
    """
    files = stage_names(request.performance, request.formats, request.source)
    beside = WriteOptions(sound=sound_name(request.source) if request.sound else None)
    figures: dict[str, StageFigure] = {}
    for number, (name, file) in enumerate(files.items()):

        def scenes(begun: int = number, name: Format = name) -> Iterator[Scene]:
            materials: dict[str, Material] = {}
            for here, scene in _figures(request, cast, name, lambda share: reported((begun + share) / len(files))):
                figures.update({figure.node: figure for figure in here})
                yield with_own_names(scene, materials)

        write = FILE_FORMATS[name].write_stage
        assert write is not None, "a format without it has no such file"
        write(folder / file, scenes(), beside)
    reported(1.0)
    return StageReport(dict(files), tuple(figures.values()))


def with_own_names(scene: Scene, known: dict[str, Material]) -> Scene:
    """The scene with another name for each material that another figure has otherwise: ``skin``, ``skin_2`` ...

    Programs that find materials by name would show one figure in another's colours, and the others would each make up
    another name.

    Parameters
    ----------
    known : dict of str to Material
        Materials of the figures before; this one's are added.
    """

    def named(material: Material) -> Material:
        others = (replace(material, name=f"{material.name}_{number}") for number in count(2))
        return next(one for one in chain((material,), others) if known.setdefault(one.name, one) == one)

    meshes = tuple(replace(mesh, materials=tuple(map(named, mesh.materials))) for mesh in scene.meshes)
    return replace(scene, meshes=meshes)


def _figures(
    request: ExportRequest, cast: ExportCast, format: Format, reported: Callable[[float], None]
) -> Iterator[tuple[tuple[StageFigure, ...], Scene]]:
    """Everyone's character and instruments, each with its place, for a file of a format; on one skeleton where
    instruments hang on sockets."""
    performance, span, creator = request.performance, request.span, request.creator
    stems, take = figure_stems(performance), file_stem(Path(request.source).stem)
    everyone = len(cast.performers) + len(cast.dances)
    keys, formats = request.keys, frozenset((format,))

    def figure(one: Player | Dancer, stage: StagePosition, node: str, socket: str | None = None) -> StageFigure:
        return StageFigure(node, one.name, stage_place(stage), socket)

    def placed(target: TargetSkeleton, stage: StagePosition, scene: Scene) -> Scene:
        assert scene.clip is not None
        # A root bone that stands at the place has a node at the origin.
        place = floor_place(stage) if target.place is None else ORIGIN
        return replace(scene, place=place, clip=replace(scene.clip, name=take))

    for number, performer in enumerate(cast.performers):
        reported(number / everyone)
        musician, target = performer.player, cast.targets[performer.player.id].target
        doubles = cast.doubles.get(musician.id, ())
        motion = player_motion(performance, performer, span)
        paths, name = held_paths(request, target, motion, doubles), stems[musician.id]["character"]
        character = character_scene(performer.character, motion, name, creator, target, paths)
        models = [one.model for one in (performer, *doubles)]
        character = keyed_character(character, keys, formats, performer.character, target, models)
        figures, sockets = [figure(musician, musician.stage, name)], socket_names(target)
        if not sockets:
            yield tuple(figures), placed(target, musician.stage, character)
            del character
        hanging = []
        for index, one in enumerate((performer, *doubles)):
            motion = motion if one is performer else player_motion(performance, one, span)
            name = stems[one.player.id]["instrument"]
            held = instrument_scene(one.instrument, one.model, motion, name, creator, own_path(target, motion))
            held = keyed_instrument(held, keys, formats)
            if sockets:
                hanging.append(held)
                figures.append(figure(one.player, musician.stage, name, sockets[index]))
            else:
                yield (figure(one.player, musician.stage, name),), placed(target, musician.stage, held)
        if sockets:
            yield tuple(figures), placed(target, musician.stage, attached(character, hanging, target))
    here = {dancer.id: dancer for dancer in request.dancers}
    for number, dancing in enumerate(cast.dances, len(cast.performers)):
        reported(number / everyone)
        dancer, target = here[dancing.dancer.id], cast.targets[dancing.dancer.id].target
        motion = dancing.motion(span.fps, span.first, span.count)
        name = stems[dancer.id]["character"]
        character = character_scene(dancing.character, motion, name, creator, target)
        character = keyed_character(character, keys, formats, dancing.character, target)
        yield (figure(dancer, dancer.stage, name),), placed(target, dancer.stage, character)
