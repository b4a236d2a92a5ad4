"""The whole stage in one file: everyone's character and instruments, each at the player's place."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from app.export.character import CENTIMETRES, character_scene
from app.export.file_names import figure_stems, sound_name, stage_names
from app.export.formats import FILE_FORMATS, Format, WriteOptions
from app.export.instrument import instrument_scene
from app.export.keyed import keyed_character, keyed_instrument
from app.export.report import StageFigure, StageReport, stage_place
from app.export.request import ExportCast, Request
from app.formats.scene import Place, Scene
from app.performance.motion import player_motion
from app.project.casting import StagePosition
from app.project.names import file_stem
from app.project.performers import Dancer, Player


def write_stage(
    request: Request, cast: ExportCast, folder: Path, reported: Callable[[float], None] = lambda share: None
) -> StageReport:
    """Write the stage in every requested format that can hold it.

    Motions are made anew for each file, player by player, so that one player's at a time is in memory.

    Parameters
    ----------
    request : Request
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
            for figure, scene in _figures(request, cast, name, lambda share: reported((begun + share) / len(files))):
                figures[figure.node] = figure
                yield scene

        write = FILE_FORMATS[name].write_stage
        assert write is not None, "a format without it has no such file"
        write(folder / file, scenes(), beside)
    reported(1.0)
    return StageReport(dict(files), tuple(figures.values()))


def _figures(
    request: Request, cast: ExportCast, name: Format, reported: Callable[[float], None]
) -> Iterator[tuple[StageFigure, Scene]]:
    """Everyone's character and instruments, each with its place, for a file of a format."""
    performance, span, creator = request.performance, request.span, request.creator
    stems, take = figure_stems(performance), file_stem(Path(request.source).stem)
    everyone = len(cast.performers) + len(cast.dances)
    keys, formats = request.keys, frozenset((name,))

    def placed(one: Player | Dancer, stage: StagePosition, scene: Scene) -> tuple[StageFigure, Scene]:
        assert scene.clip is not None
        scene = replace(scene, place=_place(stage), clip=replace(scene.clip, name=take))
        return StageFigure(scene.name, one.name, stage_place(stage)), scene

    for number, performer in enumerate(cast.performers):
        reported(number / everyone)
        musician, target = performer.player, cast.targets[performer.player.id].target
        for one in (performer, *cast.doubles.get(musician.id, ())):
            names, motion = stems[one.player.id], player_motion(performance, one, span)
            if one is performer:
                character = character_scene(one.character, motion, names["character"], creator, target)
                character = keyed_character(character, keys, formats, one.character, target)
                yield placed(musician, musician.stage, character)
                del character
            held = instrument_scene(one.instrument, one.model, motion, names["instrument"], creator)
            yield placed(one.player, musician.stage, keyed_instrument(held, keys, formats))
    here = {dancer.id: dancer for dancer in request.dancers}
    for number, dancing in enumerate(cast.dances, len(cast.performers)):
        reported(number / everyone)
        dancer, target = here[dancing.dancer.id], cast.targets[dancing.dancer.id].target
        motion = dancing.motion(span.fps, span.first, span.count)
        character = character_scene(dancing.character, motion, stems[dancer.id]["character"], creator, target)
        character = keyed_character(character, keys, formats, dancing.character, target)
        yield placed(dancer, dancer.stage, character)


def _place(stage: StagePosition) -> Place:
    """On the floor, turned from +Z towards +X."""
    half = stage.turn_rad / 2.0
    return Place(
        np.array([stage.x_m, 0.0, stage.z_m]) * CENTIMETRES, np.array([0.0, math.sin(half), 0.0, math.cos(half)])
    )
