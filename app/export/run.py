"""A performance to files: characters, instruments, report.

Messages: ``export.nobody`` (file): "{file}: there is nobody to export"; ``export.too_long`` (file, frames,
most); ``work.stopped``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import msgspec

from app.errors import Cancelled, FileError, Message
from app.export.bone_names import profile_names
from app.export.character import character_scene
from app.export.control_judge import FloatArray
from app.export.folder import files_into
from app.export.formats import FILE_FORMATS, Beside, Format, Held
from app.export.instrument import instrument_scene
from app.export.measure import Measured, contact_name, greatest_correlations, measure_player
from app.export.report import PlayerReport, Report, SkeletonReport, StagePlace, UnplayedPart, encode_report
from app.export.sound import write_sound
from app.export.target import SkeletonChoice, TargetSkeleton
from app.export.targets import CheckedTarget, checked_targets, refuse_grave
from app.formats.atomic import atomic_write
from app.formats.fbx.read import read_scene
from app.formats.scene import Scene
from app.motion.model import Motion
from app.performance.bodies import body_of, character_of, hold_of, model_of
from app.performance.ensemble import Performance
from app.performance.motion import player_motion
from app.performance.span import FrameSpan
from app.project.model import Player
from app.project.names import file_stems
from app.rig.fit import INSIDE_M, missed
from app.rig.hold import Hold
from app.rig.read_figure import read_figure
from metadata.load import load_skeleton

Progress = Callable[[float, str], None]
"""Told the share 0..1 that is done and whose work it is."""

MOST_FRAMES = 432_000
"""Two hours at 60 frames/s: a player's motion and its file are in memory as a whole."""

_MOTION_WORK, _MEASURES_WORK = 1.0, 5.0
"""Beside `FileFormat.work`."""
_SOUND_WORK = 0.3
"""Beside a player's."""


@dataclass(frozen=True)
class Request:
    """What to export.

    Attributes
    ----------
    performance : Performance
    players : tuple of Player
        Those to export; names of files come from all the players, so that they do not depend on the choice.
    folder : path
    formats : frozenset of str
        Of `FILE_FORMATS`.
    span : FrameSpan
    bars : (int, int) or None
        First and last bar asked for, for the report.
    source, creator : str
        Name of the piece's file; program and version.
    skeleton : SkeletonChoice
        What the characters are written on; instruments have one skeleton only.
    sound : bool
        Whether what is heard is written as a WAV file, from the first frame to the last.
    bvh_names : str
        Table of bone names that BVH files have; empty: those of the skeleton.
    asset : path or None
        File of the asset that the animation is for: every player's skeleton is compared with its.
    """

    performance: Performance
    players: tuple[Player, ...]
    folder: Path
    formats: frozenset[Format]
    span: FrameSpan
    bars: tuple[int, int] | None
    source: str
    creator: str
    skeleton: SkeletonChoice = "own"
    asset: Path | None = None
    sound: bool = False
    bvh_names: str = ""


def export(
    request: Request,
    wording: Callable[[Message], str],
    stop_wanted: Callable[[], bool] = lambda: False,
    progress: Progress = lambda share, label: None,
) -> Report:
    """Write the files of every player asked for, and ``report.json``: all of them, or none.

    Parameters
    ----------
    request : Request
    wording : callable
        Words a message for the report.
    stop_wanted, progress : callable

    Raises
    ------
    FileError
        ``export.nobody``; ``export.too_long``; ``file.cannot_write``; ``skeleton.differs`` and what `read_figure`
        says where an asset is given.
    UsageError
        ``usd.missing``.
    Cancelled
        ``stop_wanted`` said so.
    """
    if request.span.count > MOST_FRAMES:
        raise FileError("export.too_long", file=request.source, frames=request.span.count, most=MOST_FRAMES)
    if not request.players:
        raise FileError("export.nobody", file=request.source)
    for name in request.formats:
        FILE_FORMATS[name].refuse()
    checked = _checked(request, wording)
    stems, names = _stems(request.performance), file_names(request.performance, request.formats)
    reports: list[PlayerReport] = []
    torsos: dict[str, FloatArray] = {}
    whole = len(request.players) + (_SOUND_WORK if request.sound else 0.0)
    with files_into(request.folder) as folder:
        for index, player in enumerate(request.players):

            def told(share: float, done: int = index, name: str = player.name) -> None:
                if stop_wanted():
                    raise Cancelled("work.stopped")
                progress((done + share) / whole, name)

            target = checked[player.id].target
            report, measured = _export_player(request, player, target, stems[player.id], names[player.id], folder, told)
            asset = None if request.asset is None else request.asset.name
            skeleton = SkeletonReport(target.choice, asset, checked[player.id].differences)
            report = msgspec.structs.replace(report, skeleton=skeleton)
            reports.append(report)
            if measured is not None:
                torsos[player.id] = measured.torso_rad
        if request.sound:
            sound = sound_name(request.source)

            def mixed(share: float) -> None:
                progress((len(request.players) + _SOUND_WORK * share) / whole, sound)

            write_sound(folder / sound, request.performance.project, request.span, mixed, stop_wanted)
        report_value = _report(request, checked, _compared(reports, request.players, torsos), wording)
        with atomic_write(folder / REPORT) as stream:
            stream.write(encode_report(report_value))
    return report_value


def file_names(performance: Performance, formats: frozenset[Format]) -> dict[str, dict[str, str]]:
    """Names of the files of every player: by player id, then by what they hold."""
    names: dict[str, dict[str, str]] = {}
    for player_id, stem in _stems(performance).items():
        instrument = performance.project.player(player_id).instrument_id
        held_stems: dict[Held, str] = {"character": stem, "instrument": f"{stem}_{instrument}"}
        names[player_id] = {
            f"{held}_{name}": f"{held_stems[held]}{kind.suffix}"
            for name, kind in FILE_FORMATS.items()
            if name in formats
            for held in kind.holds
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
    player: Player,
    target: TargetSkeleton,
    stem: str,
    files: dict[str, str],
    folder: Path,
    told: Callable[[float], None],
) -> tuple[PlayerReport, Measured | None]:
    told(0.0)
    performance = request.performance
    wanted = {name: kind for name, kind in FILE_FORMATS.items() if name in request.formats}
    work = _MOTION_WORK + sum(kind.work for kind in wanted.values()) + _MEASURES_WORK * ("fbx" in wanted)
    motion = player_motion(performance, player, request.span, progress=lambda share: told(_MOTION_WORK / work * share))
    scenes = _scenes(request, player, target, motion, stem, {held for kind in wanted.values() for held in kind.holds})
    beside = Beside(
        sound=sound_name(request.source) if request.sound else None,
        bone_names=profile_names(request.bvh_names, target, character_of(player).skeleton) if request.bvh_names else {},
    )
    done = _MOTION_WORK
    for name, kind in wanted.items():
        for held in kind.holds:
            kind.write(folder / files[f"{held}_{name}"], scenes[held], beside)
        done += kind.work
        told(done / work)
    del motion, scenes  # the files are measured, not what they were made from
    measured = None
    if "fbx" in wanted:
        measured = measure_player(
            read_scene(folder / files["character_fbx"]),
            read_scene(folder / files["instrument_fbx"]),
            character_of(player),
            performance.held(player),
            performance.plan(player),
            body_of(player),
            load_skeleton(body_of(player).skeleton),
            request.span.first_frame_s,
            lambda share: told((done + _MEASURES_WORK * share) / work),
            target,
        )
    told(1.0)
    return _player_report(request, player, files, measured), measured


def _scenes(
    request: Request, player: Player, target: TargetSkeleton, motion: Motion, stem: str, held: set[Held]
) -> dict[Held, Scene]:
    """The scenes that some format asked for can hold."""
    instrument = request.performance.held(player)
    scenes: dict[Held, Scene] = {}
    if "character" in held:
        scenes["character"] = character_scene(character_of(player), motion, stem, request.creator, target)
    if "instrument" in held:
        scenes["instrument"] = instrument_scene(instrument, model_of(instrument), motion, stem, request.creator)
    return scenes


def _checked(request: Request, wording: Callable[[Message], str]) -> dict[str, CheckedTarget]:
    """The skeleton of every player; those that the asset would not take are refused."""
    if request.asset is None:
        return checked_targets(request.players, request.skeleton)
    asset = read_figure(request.asset)
    checked = checked_targets(request.players, request.skeleton, asset)
    refuse_grave(request.players, checked, asset, wording)
    return checked


def _stems(performance: Performance) -> dict[str, str]:
    """File stems by player id; the names are the same whoever is exported."""
    players = performance.project.players
    stems = file_stems([player.name for player in players])
    return {player.id: stem for player, stem in zip(players, stems, strict=True)}


def _missed_mm(hold: Hold) -> dict[str, float]:
    """What a hold itself misses by how much, by the names of the measures: touches, and skin inside the instrument."""
    found = {contact_name(one): round(1000.0 * one.distance_m, 2) for one in missed(hold)}
    deepest_m = max((hand.penetration_m for hand in hold.hands), default=0.0)
    return found | ({"penetration": round(1000.0 * deepest_m, 2)} if deepest_m > INSIDE_M else {})


def _player_report(request: Request, player: Player, files: dict[str, str], measured: Measured | None) -> PlayerReport:
    plan, held = request.performance.plan(player), request.performance.held(player)
    span = request.span
    place = player.stage
    return PlayerReport(
        name=player.name,
        part=request.performance.project.part(player).name,
        instrument=player.instrument_id,
        character=player.character_id,
        size=held.size,
        missed=_missed_mm(hold_of(player, held)),
        posture=request.performance.instrument(player).hold.possible(player.parameters.posture),
        files=files,
        stage=StagePlace(round(place.x_m, 4), round(place.z_m, 4), round(math.degrees(place.turn_rad), 3)),
        notes=sum(span.shows_onset(note.start_s) for note in plan.fingerings),
        measures=None if measured is None else measured.measures,
        sway_correlation=None,
        lean_correlation=None,
    )


def _compared(
    reports: list[PlayerReport], players: tuple[Player, ...], torsos: dict[str, FloatArray]
) -> tuple[PlayerReport, ...]:
    """The reports with how alike the players move, where there are several to compare."""
    if len(torsos) < 2:
        return tuple(reports)
    sway = greatest_correlations({name: torso[:, 0] for name, torso in torsos.items()})
    lean = greatest_correlations({name: torso[:, 1] for name, torso in torsos.items()})
    return tuple(
        msgspec.structs.replace(
            report, sway_correlation=round(sway[player.id], 4), lean_correlation=round(lean[player.id], 4)
        )
        for report, player in zip(reports, players, strict=True)
    )


def _report(
    request: Request,
    checked: dict[str, CheckedTarget],
    players: tuple[PlayerReport, ...],
    wording: Callable[[Message], str],
) -> Report:
    project, span = request.performance.project, request.span
    problems = [
        f"{player.name}: {wording(message)}"
        for player in request.players
        for message in (
            *checked[player.id].messages,
            *(problem.message for problem in request.performance.plan(player).problems),
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
        warnings=(*(wording(message) for message in project.score.warnings), *problems),
        unplayed=tuple(
            UnplayedPart(part.name, wording(part.reason), part.note_count) for part in project.score.unplayed
        ),
        sound=sound_name(request.source) if request.sound else None,
    )
