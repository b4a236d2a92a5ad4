"""A musician's files: the character and the instruments, written and then measured as a reader plays them back."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import msgspec

from app.contacts.missed_contacts import missed_mm
from app.contacts.reach import notes_out_of_reach
from app.encoding import shown
from app.export.attachment import in_world, own_path, without_place
from app.export.bone_names import profile_names
from app.export.character import character_scene
from app.export.equipped_skeleton import socket_names
from app.export.file_names import figure_stems, file_names, sound_name
from app.export.formats import FILE_FORMATS, FileContent, FileFormat, Format, WriteOptions
from app.export.instrument import instrument_scene
from app.export.keyed import KeyCount, key_count, keyed_character, keyed_instrument
from app.export.measure import PlayerMeasurement, measure_player
from app.export.report import DoubleReport, MutedSpan, PlayerReport, SkeletonReport, stage_place
from app.export.request import ExportCast, ExportRequest
from app.export.target import TargetSkeleton, Trajectory, instrument_path
from app.export.targets import CheckedTarget
from app.export.threads import in_threads
from app.formats.fbx.read import read_scene
from app.formats.scene import Scene
from app.motion.model import Motion
from app.performance.cast import Performer
from app.performance.ensemble import Performance, changes_of
from app.performance.motion import player_motion
from app.performance.performance_problems import judged_problems
from app.plan.model import Problem
from app.rig.model import Character
from metadata.load import load_skeleton

_MOTION_WORK, _MEASURES_WORK = 1.0, 5.0
"""Beside `FileFormat.work`."""


class ExportedPlayer(msgspec.Struct, frozen=True):
    """What was written of a musician.

    Attributes
    ----------
    report : PlayerReport
    problems : dict of str to tuple of Problem
        By the id of each of the musician's players.
    torso_rad : tuple of (float, float) or None
        Angles of the torso frame by frame, sideways and forward; None where nothing was measured.
    """

    report: PlayerReport
    problems: dict[str, tuple[Problem, ...]]
    torso_rad: list[tuple[float, float]] | None


def export_player(
    request: ExportRequest,
    cast: ExportCast,
    performer: Performer,
    folder: Path,
    reported: Callable[[float], None],
    cores: int = 1,
) -> ExportedPlayer:
    """Write and measure the files of a musician.

    Parameters
    ----------
    request : ExportRequest
    cast : ExportCast
    performer : Performer
        One of the cast's.
    folder : path
    reported : callable
        Called with the share 0..1 that is done; what it raises stops the work.
    cores : int
        As of `player_motion`.
    """
    names, stems = file_names(request.performance, request.formats), figure_stems(request.performance)
    doubles, checked = cast.doubles.get(performer.player.id, ()), cast.targets[performer.player.id]
    reported(0.0)
    performance, target, files = request.performance, checked.target, names[performer.player.id]
    requested = {name: kind for name, kind in FILE_FORMATS.items() if name in request.formats}
    work = _MOTION_WORK + sum(kind.work for kind in requested.values()) + _MEASURES_WORK * ("fbx" in requested)
    work *= 1 + len(doubles)
    motion = player_motion(
        performance, performer, request.span, progress=lambda share: reported(_MOTION_WORK / work * share), cores=cores
    )
    held_by = {held for kind in requested.values() for held in kind.holds}
    paths = held_paths(request, target, motion, doubles)
    scenes = _scenes(request, performer, doubles, target, motion, paths, stems[performer.player.id], held_by)
    keys = key_count(*scenes.values())
    beside = write_options(request, performer.character, target)
    problems: dict[str, tuple[Problem, ...]] = {}
    written: dict[FileContent, Scene] = {}

    def write(name: Format, kind: FileFormat, held: FileContent) -> None:
        path = folder / files[f"{held}_{name}"]
        kind.write(path, scenes[held], beside)
        if name == "fbx":
            # Read back at once, while other files are written.
            written[held] = read_scene(path)

    writing = [(name, kind, held) for name, kind in requested.items() for held in kind.holds]
    writers = [partial(write, *one) for one in writing]
    shares = [kind.work / len(kind.holds) for _, kind, _ in writing] + [0.0]
    done = [_MOTION_WORK]

    def finished(index: int) -> None:
        done.append(shares[index])
        reported(sum(done) / work)

    tasks = [*writers, partial(_judge, problems, performance, performer, motion)]
    in_threads(tasks, finished)
    scenes.clear()
    del motion, writers, tasks  # the files are measured, not what they were made from
    _, found = changes_of(performance, [one.player for one in (performer, *doubles)])
    changing = tuple((change.start_s, change.end_s) for change in found)
    judging = _Judging(request, target, changing)
    sockets = socket_names(target) or ("",) * (1 + len(doubles))
    measured = judging.measured(
        performer, written, sockets[0], lambda share: reported((sum(done) + _MEASURES_WORK * share) / work)
    )
    reports = []
    for index, double in enumerate(doubles, 1):

        def measuring(share: float, done: int = index) -> None:
            reported((done + share) / (1 + len(doubles)))

        measuring(0.0)
        own_files = names[double.player.id]
        motion = player_motion(performance, double, request.span)
        held_stem = stems[double.player.id]["instrument"]
        scene = instrument_scene(
            double.instrument, double.model, motion, held_stem, request.creator, own_path(target, motion)
        )
        scene = keyed_instrument(scene, request.keys, request.formats)
        own_keys = key_count(scene)
        for name, kind in requested.items():
            if "instrument" in kind.holds:
                kind.write(folder / own_files[f"instrument_{name}"], scene, beside)
        _judge(problems, performance, double, motion)
        del motion, scene
        if "fbx" in requested:
            own_fbx: dict[FileContent, str] = {
                "character": files["character_fbx"],
                "instrument": own_files["instrument_fbx"],
            }
            written = {held: read_scene(folder / name) for held, name in own_fbx.items()}
        own = judging.measured(double, written, sockets[index], measuring)
        reports.append(DoubleReport(**_reported(request, double, own_files, sockets[index], own, own_keys)))
    reported(1.0)
    player = performer.player
    report = PlayerReport(
        **_reported(request, performer, files, sockets[0], measured, keys),
        character=player.character_id,
        posture=performance.instrument(player).hold.possible(player.parameters.posture),
        stage=stage_place(player.stage),
        sway_correlation=None,
        lean_correlation=None,
        skeleton=skeleton_report(request, checked),
        doubles=tuple(reports),
    )
    torso_rad = None if measured is None else measured.torso_rad.tolist()
    return ExportedPlayer(report, problems, torso_rad)


def _judge(
    problems: dict[str, tuple[Problem, ...]], performance: Performance, performer: Performer, motion: Motion
) -> None:
    """Add what is wrong with a player's performance."""
    problems[performer.player.id] = judged_problems(performance, performer, motion)


@dataclass(frozen=True)
class _Judging:
    """What the files of a musician are measured with; without FBX files nothing is."""

    request: ExportRequest
    target: TargetSkeleton
    changing: tuple[tuple[float, float], ...]

    def measured(
        self, performer: Performer, read: dict[FileContent, Scene], socket: str, reported: Callable[[float], None]
    ) -> PlayerMeasurement | None:
        """What the files hold of a player: the musician's character and the instrument, which may hang on a socket.
        The scenes are taken out of ``read``."""
        if not read:
            return None
        character, instrument = read.pop("character"), read.pop("instrument")
        if socket:
            instrument = in_world(instrument, character, socket)
        return measure_player(
            without_place(character, self.target.place),
            without_place(instrument, self.target.place),
            performer.character,
            performer.instrument,
            self.request.performance.plan(performer.player),
            performer.body,
            load_skeleton(performer.body.skeleton),
            self.request.span.first_frame_s,
            reported,
            self.target,
            self.changing,
            notes_out_of_reach(self.request.performance.problems(performer.player.id)),
        )


def _reported(
    request: ExportRequest,
    performer: Performer,
    files: dict[str, str],
    socket: str,
    measured: PlayerMeasurement | None,
    keys: KeyCount,
) -> dict[str, Any]:
    """What is reported of a player, whether the musician's first one or one who doubles."""
    player, span = performer.player, request.span
    return {
        "name": player.name,
        "part": request.performance.project.part(player).name,
        "instrument": player.instrument_id,
        "size": performer.instrument.size,
        "missed": missed_mm(performer.hold),
        "files": files,
        "socket": socket or None,
        "notes": sum(span.shows_onset(note.start_s) for note in request.performance.plan(player).fingerings),
        "measures": None if measured is None else measured.measures,
        "keys": keys,
        "mutes": tuple(
            MutedSpan(event.kind, round(event.start_s, 6), round(event.end_s, 6))
            for event in request.performance.plan(player).mutes
            if event.end_s > span.first_frame_s and event.start_s < span.end_s
        ),
    }


def skeleton_report(request: ExportRequest, checked: CheckedTarget) -> SkeletonReport:
    asset = None if request.asset is None else shown(request.asset.name)
    return SkeletonReport(checked.target.choice, asset, checked.differences, request.rig)


def write_options(request: ExportRequest, character: Character, target: TargetSkeleton) -> WriteOptions:
    return WriteOptions(
        sound=sound_name(request.source) if request.sound else None,
        bone_names=profile_names(request.bvh_names, target, character.skeleton) if request.bvh_names else {},
    )


def held_paths(
    request: ExportRequest, target: TargetSkeleton, motion: Motion, doubles: Sequence[Performer]
) -> tuple[Trajectory, ...]:
    """Where a musician's instruments are; nothing where they hang on no sockets.

    Parameters
    ----------
    motion : Motion
        Of the first instrument's player.
    doubles : sequence of Performer
        Of the other instruments.
    """
    if not target.sockets:
        return ()
    others = (player_motion(request.performance, double, request.span) for double in doubles)
    return (instrument_path(motion), *map(instrument_path, others))


def _scenes(
    request: ExportRequest,
    performer: Performer,
    doubles: Sequence[Performer],
    target: TargetSkeleton,
    motion: Motion,
    paths: Sequence[Trajectory],
    stems: dict[FileContent, str],
    held: set[FileContent],
) -> dict[FileContent, Scene]:
    """The scenes that some format asked for can hold."""
    scenes: dict[FileContent, Scene] = {}
    if "character" in held:
        scene = character_scene(performer.character, motion, stems["character"], request.creator, target, paths)
        models = [one.model for one in (performer, *doubles)]
        scenes["character"] = keyed_character(scene, request.keys, request.formats, performer.character, target, models)
    if "instrument" in held:
        path = own_path(target, motion)
        scene = instrument_scene(
            performer.instrument, performer.model, motion, stems["instrument"], request.creator, path
        )
        scenes["instrument"] = keyed_instrument(scene, request.keys, request.formats)
    return scenes
