"""A performance to files: characters, instruments, report. Players who cannot be exported are excluded and named.

Messages: those of `app.export.request`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import msgspec

from app.contacts.bounds import FloatArray
from app.contacts.hold import missed_mm
from app.contacts.reach import unreached
from app.encoding import shown
from app.errors import Cancelled, Message
from app.export.bone_names import profile_names
from app.export.character import character_scene
from app.export.dancers import measure_dancer, standing_frames
from app.export.folder import files_into
from app.export.formats import FILE_FORMATS, Format, SettingBinding, WriteOptions
from app.export.instrument import instrument_scene
from app.export.measure import Measured, greatest_correlations, measure_player
from app.export.report import (
    DancerReport,
    DoubleReport,
    LeftOutReport,
    PlayerReport,
    Report,
    SkeletonReport,
    UnplayedPart,
    encode_report,
    stage_place,
)
from app.export.request import ExportCast, Request, cast_of
from app.export.sound import write_sound
from app.export.target import TargetSkeleton
from app.export.targets import CheckedTarget
from app.formats.atomic import atomic_write
from app.formats.fbx.read import read_scene
from app.formats.scene import Scene
from app.motion.model import Motion
from app.performance.cast import Performer
from app.performance.dancers import Dancing
from app.performance.ensemble import Performance, changes_of
from app.performance.judged import judged_problems
from app.performance.motion import player_motion
from app.plan.model import Problem
from app.plan.problem_lines import problem_lines
from app.project.names import file_stems
from app.project.performers import Dancer
from metadata.load import load_skeleton

Progress = Callable[[float, str], None]
"""Called with the share 0..1 that is done and whose work it is."""

_MOTION_WORK, _MEASURES_WORK = 1.0, 5.0
"""WriteOptions `FileFormat.work`."""
_SOUND_WORK = 0.3
"""WriteOptions a player's."""


def export(
    request: Request,
    wording: Callable[[Message], str],
    stop_requested: Callable[[], bool] = lambda: False,
    progress: Progress = lambda share, label: None,
) -> Report:
    """Write the files of every player asked for who can be exported, and ``report.json``: all of them, or none.

    Parameters
    ----------
    request : Request
    wording : callable
        Words a message for the report.
    stop_requested, progress : callable

    Raises
    ------
    FileError
        See `cast_of`; ``file.cannot_write``.
    UsageError
        ``usd.missing``.
    Cancelled
        ``stop_requested`` said so.
    """
    return write_cast(request, cast_of(request, wording, stop_requested), wording, stop_requested, progress)


def write_cast(
    request: Request,
    cast: ExportCast,
    wording: Callable[[Message], str],
    stop_requested: Callable[[], bool] = lambda: False,
    progress: Progress = lambda share, label: None,
) -> Report:
    """`export` of a request's cast."""
    stems, names = _stems(request.performance), file_names(request.performance, request.formats)
    reports: list[PlayerReport] = []
    torsos: dict[str, FloatArray] = {}
    problems: dict[str, tuple[Problem, ...]] = {}
    dancers: list[DancerReport] = []
    everyone = len(cast.performers) + len(cast.dances)
    whole = everyone + (_SOUND_WORK if request.sound else 0.0)
    with files_into(request.folder) as folder:
        for index, performer in enumerate(cast.performers):
            player = performer.player

            def reported(share: float, done: int = index, name: str = player.name) -> None:
                if stop_requested():
                    raise Cancelled("work.stopped")
                progress((done + share) / whole, name)

            checked = cast.targets[player.id]
            report, measured, found = _export_player(
                request,
                performer,
                cast.doubles.get(player.id, ()),
                checked.target,
                stems[player.id],
                names,
                folder,
                reported,
            )
            asset = None if request.asset is None else shown(request.asset.name)
            skeleton = SkeletonReport(checked.target.choice, asset, checked.differences)
            report = msgspec.structs.replace(report, skeleton=skeleton)
            reports.append(report)
            problems |= found
            if measured is not None:
                torsos[player.id] = measured.torso_rad
        here = {dancer.id: dancer for dancer in request.dancers}
        for index, dancing in enumerate(cast.dances, len(cast.performers)):
            dancer = here[dancing.dancer.id]

            def moved(share: float, done: int = index, name: str = dancer.name) -> None:
                if stop_requested():
                    raise Cancelled("work.stopped")
                progress((done + share) / whole, name)

            checked = cast.targets[dancer.id]
            dancers.append(
                _export_dancer(request, dancer, dancing, checked, stems[dancer.id], names[dancer.id], folder, moved)
            )
        if request.sound:
            sound = sound_name(request.source)

            def mixed(share: float) -> None:
                progress((everyone + _SOUND_WORK * share) / whole, sound)

            write_sound(folder / sound, request.performance.project, request.span, mixed, stop_requested)
        compared = _compared(reports, cast.player_ids, torsos)
        report_value = _report(request, cast, compared, tuple(dancers), problems, wording)
        with atomic_write(folder / REPORT) as stream:
            stream.write(encode_report(report_value))
    return report_value


def file_names(performance: Performance, formats: frozenset[Format]) -> dict[str, dict[str, str]]:
    """Names of the files of every player and dancer: by id, then by what they hold. Who doubles has a file of the
    instrument alone, named after the musician."""
    names: dict[str, dict[str, str]] = {}
    stems = _stems(performance)
    for musician in performance.project.bodies:
        stem, taken = stems[musician.id], set[str]()
        for player in performance.project.played_by(musician):
            held_stem = f"{stem}_{player.instrument_id}"
            if held_stem in taken:
                held_stem = f"{held_stem}_{stems[player.id]}"
            taken.add(held_stem)
            held_stems: dict[SettingBinding, str] = {"character": stem, "instrument": held_stem}
            names[player.id] = {
                f"{held}_{name}": f"{held_stems[held]}{kind.suffix}"
                for name, kind in FILE_FORMATS.items()
                if name in formats
                for held in kind.holds
                if held == "instrument" or player is musician
            }
    for dancer in performance.project.dancers:
        names[dancer.id] = {
            f"character_{name}": f"{stems[dancer.id]}{kind.suffix}"
            for name, kind in FILE_FORMATS.items()
            if name in formats
        }
    return names


def sound_name(source: str) -> str:
    """Name of the sound's file, after the piece's."""
    (stem,) = file_stems([Path(source).stem])
    return f"{stem}.wav"


REPORT = "report.json"
"""Name of the file that says what the others hold."""


def _export_player(
    request: Request,
    performer: Performer,
    doubles: tuple[Performer, ...],
    target: TargetSkeleton,
    stem: str,
    names: dict[str, dict[str, str]],
    folder: Path,
    reported: Callable[[float], None],
) -> tuple[PlayerReport, Measured | None, dict[str, tuple[Problem, ...]]]:
    """Write what a person plays; its report, what was measured, and what is wrong with it by the id of each player."""
    reported(0.0)
    performance, character, files = request.performance, performer.character, names[performer.player.id]
    requested = {name: kind for name, kind in FILE_FORMATS.items() if name in request.formats}
    work = _MOTION_WORK + sum(kind.work for kind in requested.values()) + _MEASURES_WORK * ("fbx" in requested)
    work *= 1 + len(doubles)
    motion = player_motion(
        performance, performer, request.span, progress=lambda share: reported(_MOTION_WORK / work * share)
    )
    held_by = {held for kind in requested.values() for held in kind.holds}
    scenes = _scenes(request, performer, target, motion, stem, held_by)
    beside = WriteOptions(
        sound=sound_name(request.source) if request.sound else None,
        bone_names=profile_names(request.bvh_names, target, character.skeleton) if request.bvh_names else {},
    )
    done = _MOTION_WORK
    for name, kind in requested.items():
        for held in kind.holds:
            kind.write(folder / files[f"{held}_{name}"], scenes[held], beside)
        done += kind.work
        reported(done / work)
    problems = {performer.player.id: judged_problems(performance, performer, motion)}
    del motion, scenes  # the files are measured, not what they were made from
    _, found = changes_of(performance, [one.player for one in (performer, *doubles)])
    changing = tuple((change.start_s, change.end_s) for change in found)
    judging = _Judging(request, target, folder, files.get("character_fbx"), changing)
    measured = judging.measured(performer, files, lambda share: reported((done + _MEASURES_WORK * share) / work))
    reports = []
    for index, double in enumerate(doubles, 1):
        begun = index / (1 + len(doubles))
        reported(begun)
        own_files = names[double.player.id]
        motion = player_motion(performance, double, request.span)
        scene = instrument_scene(double.instrument, double.model, motion, stem, request.creator)
        for name, kind in requested.items():
            if "instrument" in kind.holds:
                kind.write(folder / own_files[f"instrument_{name}"], scene, beside)
        problems[double.player.id] = judged_problems(performance, double, motion)
        del motion, scene
        own = judging.measured(double, own_files, _part_of(reported, begun, 1.0 / (1 + len(doubles))))
        reports.append(_double_report(request, double, own_files, own))
    reported(1.0)
    report = msgspec.structs.replace(_player_report(request, performer, files, measured), doubles=tuple(reports))
    return report, measured, problems


def _part_of(reported: Callable[[float], None], begun: float, share: float) -> Callable[[float], None]:
    """Tells of a part of some work."""
    return lambda done: reported(begun + share * done)


@dataclass(frozen=True)
class _Judging:
    """What the files of a musician are measured with; without an FBX file of the character nothing is."""

    request: Request
    target: TargetSkeleton
    folder: Path
    character: str | None
    changing: tuple[tuple[float, float], ...]

    def measured(
        self, performer: Performer, held: dict[str, str], reported: Callable[[float], None]
    ) -> Measured | None:
        """What the files hold of a player: the musician's character and the instrument."""
        if self.character is None:
            return None
        return measure_player(
            read_scene(self.folder / self.character),
            read_scene(self.folder / held["instrument_fbx"]),
            performer.character,
            performer.instrument,
            self.request.performance.plan(performer.player),
            performer.body,
            load_skeleton(performer.body.skeleton),
            self.request.span.first_frame_s,
            reported,
            self.target,
            self.changing,
            unreached(self.request.performance.problems(performer.player.id)),
        )


def _double_report(
    request: Request, double: Performer, files: dict[str, str], measured: Measured | None
) -> DoubleReport:
    player, span = double.player, request.span
    return DoubleReport(
        name=player.name,
        part=request.performance.project.part(player).name,
        instrument=player.instrument_id,
        size=double.instrument.size,
        missed=missed_mm(double.hold),
        files=files,
        notes=sum(span.shows_onset(note.start_s) for note in request.performance.plan(player).fingerings),
        measures=None if measured is None else measured.measures,
    )


def _export_dancer(
    request: Request,
    dancer: Dancer,
    dancing: Dancing,
    checked: CheckedTarget,
    stem: str,
    files: dict[str, str],
    folder: Path,
    reported: Callable[[float], None],
) -> DancerReport:
    reported(0.0)
    character, target, span = dancing.character, checked.target, request.span
    motion = dancing.motion(span.fps, span.first, span.count)
    reported(0.3)
    scene = character_scene(character, motion, stem, request.creator, target)
    beside = WriteOptions(
        sound=sound_name(request.source) if request.sound else None,
        bone_names=profile_names(request.bvh_names, target, character.skeleton) if request.bvh_names else {},
    )
    for name, kind in FILE_FORMATS.items():
        if name in request.formats:
            kind.write(folder / files[f"character_{name}"], scene, beside)
    reported(0.8)
    measures = None
    if "fbx" in request.formats:
        read = read_scene(folder / files["character_fbx"])
        measures = measure_dancer(read, character, target, standing_frames(dancing, span))
    reported(1.0)
    starts_s = [step.start_s for step in dancing.dance(span.fps).steps]
    asset = None if request.asset is None else shown(request.asset.name)
    return DancerReport(
        name=dancer.name,
        choreography=dancing.choreographer.model.name,
        character=dancer.character_id,
        files=files,
        stage=stage_place(dancer.stage),
        steps=sum(span.first_frame_s <= start_s < span.end_s for start_s in starts_s),
        skeleton=SkeletonReport(target.choice, asset, checked.differences),
        measures=measures,
    )


def _scenes(
    request: Request, performer: Performer, target: TargetSkeleton, motion: Motion, stem: str, held: set[SettingBinding]
) -> dict[SettingBinding, Scene]:
    """The scenes that some format asked for can hold."""
    scenes: dict[SettingBinding, Scene] = {}
    if "character" in held:
        scenes["character"] = character_scene(performer.character, motion, stem, request.creator, target)
    if "instrument" in held:
        scenes["instrument"] = instrument_scene(performer.instrument, performer.model, motion, stem, request.creator)
    return scenes


def _stems(performance: Performance) -> dict[str, str]:
    """File stems by the id of the player or dancer; the same for any selection of players."""
    project = performance.project
    names = {one.id: one.name for one in project.players} | {one.id: one.name for one in project.dancers}
    return dict(zip(names, file_stems(list(names.values())), strict=True))


def _player_report(
    request: Request, performer: Performer, files: dict[str, str], measured: Measured | None
) -> PlayerReport:
    player, span = performer.player, request.span
    plan = request.performance.plan(player)
    return PlayerReport(
        name=player.name,
        part=request.performance.project.part(player).name,
        instrument=player.instrument_id,
        character=player.character_id,
        size=performer.instrument.size,
        missed=missed_mm(performer.hold),
        posture=request.performance.instrument(player).hold.possible(player.parameters.posture),
        files=files,
        stage=stage_place(player.stage),
        notes=sum(span.shows_onset(note.start_s) for note in plan.fingerings),
        measures=None if measured is None else measured.measures,
        sway_correlation=None,
        lean_correlation=None,
    )


def _compared(
    reports: list[PlayerReport], player_ids: tuple[str, ...], torsos: dict[str, FloatArray]
) -> tuple[PlayerReport, ...]:
    """The reports with how alike the players move, where there are several to compare."""
    if len(torsos) < 2:
        return tuple(reports)
    sway = greatest_correlations({name: torso[:, 0] for name, torso in torsos.items()})
    lean = greatest_correlations({name: torso[:, 1] for name, torso in torsos.items()})
    return tuple(
        msgspec.structs.replace(
            report, sway_correlation=round(sway[player_id], 4), lean_correlation=round(lean[player_id], 4)
        )
        for report, player_id in zip(reports, player_ids, strict=True)
    )


def _report(
    request: Request,
    cast: ExportCast,
    players: tuple[PlayerReport, ...],
    dancers: tuple[DancerReport, ...],
    problems: dict[str, tuple[Problem, ...]],
    wording: Callable[[Message], str],
) -> Report:
    project, span = request.performance.project, request.span
    warnings = [
        f"{player.name}: {line}"
        for performer in cast.performers
        for player in (performer.player, *(double.player for double in cast.doubles.get(performer.player.id, ())))
        for line in (
            *(map(wording, cast.targets[player.id].messages) if player is performer.player else ()),
            *problem_lines(problems[player.id], project.score, wording, player.part_id),
        )
    ]
    rate = span.fps
    return Report(
        version=request.creator,
        source=request.source,
        first_frame_s=span.first_frame_s,
        fps=rate.numerator / rate.denominator,
        fps_exact=str(rate),
        frames=span.count,
        end_s=span.end_s,
        bars=request.bars,
        seed=project.seed,
        players=players,
        warnings=(*(wording(message) for message in project.score.warnings), *warnings),
        unplayed=tuple(
            UnplayedPart(part.name, wording(part.reason), part.note_count) for part in project.score.unplayed
        ),
        left_out=tuple(LeftOutReport(one.player.name, wording(one.reason)) for one in cast.left_out),
        sound=sound_name(request.source) if request.sound else None,
        dancers=dancers,
    )
