"""Writing of the whole stage as one file: all characters and instruments at their places."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import chain, count
from pathlib import Path

from app.errors import Progress
from app.export.attachment import attached
from app.export.figures import (
    dancer_scene,
    held_scene,
    musician_scene,
    props_scene,
    supports_of_musician,
)
from app.export.file_names import sound_name, stage_names
from app.export.formats import FILE_FORMATS, Format, WriteOptions
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
    request: ExportRequest, cast: ExportCast, folder: Path, reported: Progress = lambda share: None
) -> StageReport:
    """Write the stage in every requested format that supports it.

    Motions are generated again for each file, so that only one player's is in memory at a time.

    Parameters
    ----------
    request : ExportRequest
        The export.
    cast : ExportCast
        Performers on the stage.
    folder : path
        Folder to write into.
    reported : callable
        Called with the share done, 0..1; may raise Cancelled.
    """
    files = stage_names(request.performance, request.formats, request.source)
    sound = sound_name(request.source) if request.sound else None
    beside = WriteOptions(
        sound=sound, meshes=not request.motion_only, texture_px=request.texture_px, levels=request.levels
    )
    figures: dict[str, StageFigure] = {}
    for number, (name, file) in enumerate(files.items()):

        def scenes(begun: int = number, name: Format = name) -> Iterator[Scene]:
            materials: dict[str, Material] = {}
            own = replace(request, formats=frozenset((name,)))
            for here, scene in _figures(own, cast, lambda share: reported((begun + share) / len(files))):
                figures.update({figure.node: figure for figure in here})
                yield with_own_names(scene, materials)

        FILE_FORMATS[name].write(folder / file, scenes(), beside)
    reported(1.0)
    return StageReport(dict(files), tuple(figures.values()))


def with_own_names(scene: Scene, known: dict[str, Material]) -> Scene:
    """Return a scene in which materials that differ from a previous figure's material of the same name are renamed,
    such as ``skin`` to ``skin_2``.

    Programs that find materials by name would otherwise show wrong colours, and others would rename them differently.

    Parameters
    ----------
    known : dict of str to Material
        Materials of the previous figures; this scene's are added.
    """

    def named(material: Material) -> Material:
        others = (replace(material, name=f"{material.name}_{number}") for number in count(2))
        return next(one for one in chain((material,), others) if known.setdefault(one.name, one) == one)

    meshes = tuple(replace(mesh, materials=tuple(map(named, mesh.materials))) for mesh in scene.meshes)
    return replace(scene, meshes=meshes)


def _figures(
    request: ExportRequest, cast: ExportCast, reported: Progress
) -> Iterator[tuple[tuple[StageFigure, ...], Scene]]:
    """Yield for each node of the stage file its characters and instruments, and its scene; a scene holds several if
    instruments are attached to the character.
    """
    performance, span = request.performance, request.span
    take, everyone = file_stem(Path(request.source).stem), len(cast.ids)

    def figure(one: Player | Dancer, stage: StagePosition, scene: Scene, socket: str | None = None) -> StageFigure:
        return StageFigure(scene.name, one.name, stage_place(stage), socket)

    def placed(target: TargetSkeleton, stage: StagePosition, scene: Scene) -> Scene:
        assert scene.clip is not None
        # A root bone at the player's place is below a node at the origin.
        place = floor_place(stage) if target.place is None else ORIGIN
        return replace(scene, place=place, clip=replace(scene.clip, name=take))

    for number, musician in enumerate(cast.musicians):
        reported(number / everyone)
        player, target, sockets = musician.player, musician.target, musician.sockets
        motion = player_motion(performance, musician.performers[0], span)
        character = musician_scene(request, musician, motion)
        figures, hanging = [figure(player, player.stage, character)], list[Scene]()
        if not sockets:
            yield tuple(figures), placed(target, player.stage, character)
            del character
        motions = [motion]
        for performer in musician.performers:
            one = performer.player
            if one is not player:
                motion = player_motion(performance, performer, span)
                motions.append(motion)
            held = held_scene(request, musician, performer, motion)
            if sockets:
                hanging.append(held)
                figures.append(figure(one, player.stage, held, sockets[one.id]))
            else:
                yield (figure(one, player.stage, held),), placed(target, player.stage, held)
        if sockets:
            yield tuple(figures), placed(target, player.stage, attached(character, hanging, target))
        supports = supports_of_musician(request, musician)
        if supports is not None:
            props = props_scene(request, musician, supports, motions)
            yield (figure(player, player.stage, props),), placed(target, player.stage, props)
    for number, dancer in enumerate(cast.dancers, len(cast.musicians)):
        reported(number / everyone)
        stage = dancer.dancer.stage
        character = dancer_scene(request, dancer, dancer.dancing.motion(span.fps, span.first, span.count))
        yield (figure(dancer.dancer, stage, character),), placed(dancer.target, stage, character)
