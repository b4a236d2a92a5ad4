"""Export of a musician: the files of character and instruments are written, read back and measured."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import msgspec

from app.arrays import FloatArray
from app.contacts.breaks import by_time
from app.contacts.missed_contacts import missed_mm
from app.contacts.reach import notes_out_of_reach
from app.encoding import shown
from app.errors import Progress
from app.export.arm_problems import arm_problems
from app.export.attachment import in_world, without_place
from app.export.bvh_clip import profile_names
from app.export.face_curves import FaceOptions
from app.export.figures import held_scene, musician_scene, props_scene, supports_of_musician
from app.export.file_names import file_names, sound_name
from app.export.formats import FileContent, FileFormat, Format, WriteOptions, files_of
from app.export.humanoid import vrm_expressions
from app.export.measure import PlayerJudge, PlayerMeasurement
from app.export.report import DoubleReport, MutedSpan, PlayerReport, SkeletonReport, character_report, stage_place
from app.export.request import CastMusician, ExportRequest
from app.export.scene_keys import KeyCount, key_count
from app.export.target import TargetSkeleton
from app.export.targets import CheckedTarget
from app.export.threads import in_threads
from app.formats.scene import Scene
from app.performance.cast import Performer
from app.performance.dances import danced_feet
from app.performance.ensemble import changes_of
from app.performance.motion import player_motion
from app.performance.performance_problems import judged_problems
from app.plan.model import Problem
from app.rig.model import Character

_MOTION_WORK, _MEASURES_WORK = 1.0, 5.0
"""Work of making the motion and the measurements, in the unit of `FileFormat.work`."""


class ExportedPlayer(msgspec.Struct, frozen=True):
    """Result of exporting a musician.

    Attributes
    ----------
    report : PlayerReport
        Report on the musician's files.
    problems : dict of str to tuple of Problem
        Problems by the id of each of the musician's players.
    torso_rad : tuple of (float, float) or None
        Angles of the torso in each frame, sideways and forward; None if nothing was measured.
    """

    report: PlayerReport
    problems: dict[str, tuple[Problem, ...]]
    torso_rad: list[tuple[float, float]] | None


def export_player(
    request: ExportRequest, musician: CastMusician, folder: Path, reported: Progress, cores: int = 1
) -> ExportedPlayer:
    """Write and measure the files of a musician.

    Parameters
    ----------
    request : ExportRequest
        The export.
    musician : CastMusician
        Musician to export.
    folder : path
        Folder to write into.
    reported : callable
        Called with the share done, 0..1; its exceptions stop the work.
    cores : int
        Number of processor cores to use, see `player_motion`.
    """
    reports: list[DoubleReport] = []
    problems: dict[str, tuple[Problem, ...]] = {}
    torsos: list[FloatArray | None] = []
    figure: Scene | None = None
    for index, performer in enumerate(musician.performers):

        def share_of(share: float, done: int = index) -> None:
            reported((done + share) / len(musician.performers))

        written = _write(request, musician, performer, folder, share_of, cores, figure)
        figure = written.figure
        measured = _measured(request, musician, performer, written.read, share_of)
        problems[performer.player.id] = by_time((*written.problems, *_of_arms(request, measured)))
        reports.append(_reported(request, musician, performer, written.keys, measured))
        torsos.append(None if measured is None else measured.torso_rad)
    reported(1.0)
    player, supports = musician.player, supports_of_musician(request, musician)
    has_props = any(held == "props" for _, held in files_of(request.formats))
    report = PlayerReport(
        **msgspec.structs.asdict(reports[0]),
        character=player.character_id,
        posture=request.performance.instrument(player).hold.possible(player.parameters.posture),
        stage=stage_place(player.stage),
        sway_correlation=None,
        lean_correlation=None,
        skeleton=skeleton_report(request, musician.checked),
        doubles=tuple(reports[1:]),
        props=supports.kinds if supports is not None and has_props else (),
        person=character_report(player, musician.left_off),
    )
    return ExportedPlayer(report, problems, None if torsos[0] is None else torsos[0].tolist())


@dataclass(frozen=True)
class _Written:
    """Result of writing one instrument of a musician: number of keys, the character's scene if it was written,
    problems, and the files read back for measuring.
    """

    keys: KeyCount
    figure: Scene | None
    problems: tuple[Problem, ...]
    read: dict[FileContent, Scene]


def _write(
    request: ExportRequest,
    musician: CastMusician,
    performer: Performer,
    folder: Path,
    reported: Progress,
    cores: int,
    figure: Scene | None,
) -> _Written:
    """Write the files of one instrument of a musician, with the first instrument also those of the character.

    ``figure`` is the scene of an already written character.
    """
    performance, first = request.performance, performer is musician.performers[0]
    rows, reads = files_of(request.formats), files_of(request.formats, reads=True)
    files = file_names(performance, request.formats)
    work = _work(request.formats)
    reported(0.0)
    motion = player_motion(
        performance, performer, request.span, progress=lambda share: reported(_MOTION_WORK / work * share), cores=cores
    )
    scenes: dict[tuple[FileContent, bool], Scene] = {}
    supports = supports_of_musician(request, musician) if first else None
    for row, held in rows:
        kind = held, row.humanoid
        if kind in scenes:
            continue
        if held == "props" and supports is not None:
            motions = [motion, *(player_motion(performance, one, request.span) for one in musician.performers[1:])]
            scenes[kind] = props_scene(request, musician, supports, motions)
        elif held == "instrument":
            scenes[kind] = held_scene(request, musician, performer, motion)
        elif held == "character" and first:
            scenes[kind] = musician_scene(request, musician, motion, row)
    keys = key_count(*_counted(scenes))
    options = write_options(request, musician.character, musician.target)
    read: dict[FileContent, Scene] = {}
    problems: list[tuple[Problem, ...]] = []

    def write(row: FileFormat, held: FileContent) -> None:
        scene = scenes.get((held, row.humanoid))
        path = folder / files[musician.player.id if scene is None else performer.player.id][row.key(held)]
        if scene is not None:
            row.write(path, (scene,), options)
        if (row, held) in reads and row.read is not None:
            # Read back at once, in parallel with writing other files.
            known = figure if scene is None else scene
            assert known is not None
            read[held] = read_again(row, path, known, options.meshes)

    def judge() -> None:
        problems.append(judged_problems(performance, performer, motion))

    writing = [(row, held) for row, held in rows if (held, row.humanoid) in scenes or (row, held) in reads]
    shares = [row.work / len(row.holds) for row, _ in writing] + [0.0]
    done = [_MOTION_WORK]

    def finished(index: int) -> None:
        done.append(shares[index])
        reported(sum(done) / work)

    in_threads([*(partial(write, *one) for one in writing), judge], finished)
    judged = (scenes[held, row.humanoid] for row, held in reads or rows if held == "character" and first)
    return _Written(keys, next(judged, figure), problems[0], read)


def read_again(row: FileFormat, path: Path, written: Scene, in_file: bool) -> Scene:
    """Read a written file back for measuring.

    Meshes are taken from ``written`` unless they are ``in_file``; so are the weights of the face if the format has none
    without meshes.
    """
    assert row.read is not None
    if in_file or not row.without_meshes:
        return row.read(path, written.meshes)
    found = row.read(path, ())
    assert found.clip is not None
    shapes = {morph.name for mesh in written.meshes for morph in mesh.morphs}
    face = (found if row.face_without_meshes else written).clip
    assert face is not None
    weights = {name: values for name, values in face.morph_weights.items() if name in shapes}
    return replace(found, meshes=written.meshes, clip=replace(found.clip, morph_weights=weights))


def _counted(scenes: Mapping[tuple[FileContent, bool], Scene]) -> Iterable[Scene]:
    """Return the scenes whose keys are counted: the first scene of each content, if a character is written on two
    skeletons.

    The keys of ``scenes`` are the content, and whether the scene has the humanoid skeleton of VRM.
    """
    return {held: scene for (held, _), scene in reversed([*scenes.items()])}.values()


def _work(formats: frozenset[Format]) -> float:
    """Return the work of exporting one instrument of a musician in the given formats, relative to other instruments,
    for the progress bar."""
    measures = _MEASURES_WORK if files_of(formats, reads=True) else 0.0
    return _MOTION_WORK + sum(row.work / len(row.holds) for row, _ in files_of(formats)) + measures


def _of_arms(request: ExportRequest, measured: PlayerMeasurement | None) -> tuple[Problem, ...]:
    """Return the problems of arms that are too deep in trunk or clothes in the files; none if none were read."""
    if measured is None:
        return ()
    return arm_problems(measured.measures.arms, request.span.first_frame_s, float(request.span.fps))


def _measured(
    request: ExportRequest,
    musician: CastMusician,
    performer: Performer,
    read: dict[FileContent, Scene],
    reported: Progress,
) -> PlayerMeasurement | None:
    """Measure the files of a player (character and instrument, which may be attached to a socket); None if none was
    read. Removes the scenes from ``read``.
    """
    if not read:
        return None
    ((kind, _), *_) = files_of(request.formats, reads=True)
    performance, target = request.performance, musician.target_in(kind)
    character, instrument = read.pop("character"), read.pop("instrument")
    if musician.sockets:
        instrument = in_world(instrument, character, musician.sockets[performer.player.id])
    _, changes = changes_of(performance, [one.player for one in musician.performers])
    judge = PlayerJudge(
        performer,
        performance.plan(performer.player),
        target,
        tuple((change.start_s, change.end_s) for change in changes),
        notes_out_of_reach(performance.problems(performer.player.id)),
        danced_feet(performance, performer.player),
        # A VRM animation has names of its own.
        FaceOptions(parts=request.face.parts) if kind.humanoid else request.face,
    )
    done = 1.0 - _MEASURES_WORK / _work(request.formats)
    return judge.measure(
        without_place(character, target.place),
        without_place(instrument, target.place),
        request.span.first_frame_s,
        lambda share: reported(done + (1.0 - done) * share),
    )


def _reported(
    request: ExportRequest,
    musician: CastMusician,
    performer: Performer,
    keys: KeyCount,
    measured: PlayerMeasurement | None,
) -> DoubleReport:
    """Return the report about one instrument that a musician plays: its files, keys and measures."""
    player, span, performance = performer.player, request.span, request.performance
    plan = performance.plan(player)
    files = file_names(performance, request.formats, request.with_props)[player.id]
    if supports_of_musician(request, musician) is None:
        files = {key: name for key, name in files.items() if not key.startswith("props")}
    return DoubleReport(
        name=player.name,
        part=performance.project.part(player).name,
        instrument=player.instrument_id,
        size=performer.instrument.size,
        missed=missed_mm(performer.grip),
        files=files,
        socket=musician.sockets.get(player.id),
        notes=sum(span.shows_onset(note.start_s) for note in plan.fingerings),
        measures=None if measured is None else measured.measures,
        keys=keys,
        mutes=tuple(
            MutedSpan(event.kind, round(event.start_s, 6), round(event.end_s, 6))
            for event in plan.mutes
            if event.end_s > span.first_frame_s and event.start_s < span.end_s
        ),
    )


def skeleton_report(request: ExportRequest, checked: CheckedTarget) -> SkeletonReport:
    asset = None if request.asset is None else shown(request.asset.name)
    return SkeletonReport(checked.target.choice, asset, checked.differences, request.rig)


def write_options(request: ExportRequest, character: Character, target: TargetSkeleton) -> WriteOptions:
    return WriteOptions(
        sound=sound_name(request.source) if request.sound else None,
        bone_names=profile_names(request.bvh_names, target, character.skeleton) if request.bvh_names else {},
        expressions=vrm_expressions(character),
        meshes=not request.motion_only,
        texture_px=request.texture_px,
        levels=request.levels,
        t_pose=target.t_pose,
    )
