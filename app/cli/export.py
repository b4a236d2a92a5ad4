"""``suisou export``: exports a MIDI file or a project as animation files of its players."""

from __future__ import annotations

import argparse
import os
import signal
import sys
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from app.cli.bars import add_bar_options, add_lead_in_option, requested_bars, requested_span
from app.cli.commands import add_pitch_options, fill_help
from app.cli.options import (
    add_ignored_option,
    add_players_option,
    add_rate_option,
    add_source_options,
    add_title_option,
    bounded_number,
    open_project,
)
from app.cli.progress import Progress, find_holds
from app.cli.speech import said, sentence
from app.cli.status import report_left_out
from app.cli.summary import project_summary, summary
from app.cli.terminal import interrupted_by, say, warn
from app.encoding import shown
from app.errors import UsageError
from app.export.face_curves import CURVE_NAMES, DEFAULT_FACE, FACE_PARTS, FaceOptions, FacePart
from app.export.foreseen import foresee_folder, foresee_unreal
from app.export.formats import FILE_FORMATS, USUAL_FORMATS, Format, names_where, refuse_attachment, requested
from app.export.request import ExportRequest
from app.export.rig_options import ATTACHMENTS, DEFAULT_RIG, EYE_TURNS, REST_POSES, ROOT_BONES, RigOptions
from app.export.run import export as write
from app.export.tree import clean_up
from app.formats.images import TEXTURE_SIZES, USUAL_TEXTURE_PX
from app.formats.keys import KEY_CHOICES
from app.formats.levels_of_detail import MOST_LEVELS, levels_for
from app.messages import text
from app.performance.ensemble import Performance
from app.project.parameters import select_players
from app.version import program_version
from metadata.load import names

if TYPE_CHECKING:
    from app.export.target import SkeletonChoice

MOST_NAMED: Final = 3
"""Greatest number of files that are named in a message about several files."""
SKELETONS: Final[tuple[SkeletonChoice, ...]] = ("own", "ue5", "suisou")


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou export``."""
    add_source_options(command)
    add_title_option(command)
    place = command.add_mutually_exclusive_group(required=True)
    place.add_argument("--to", type=Path, metavar="DIR")
    place.add_argument("--unreal", type=Path, metavar="PROJECT")
    formats = command.add_argument("--format", dest="formats", action="extend", type=file_formats, metavar="FORMAT")
    fill_help(formats, formats=", ".join(FILE_FORMATS), usual=",".join(USUAL_FORMATS))
    add_rate_option(command)
    add_players_option(command)
    _add_skeleton_options(command)
    _add_content_options(command)
    add_ignored_option(command)
    command.add_argument("--jobs", type=jobs, metavar="N")
    command.add_argument("--scheduler", metavar="ADDRESS")
    command.add_argument("--piece", type=Path, help=argparse.SUPPRESS)
    add_bar_options(command)
    add_lead_in_option(command)
    add_pitch_options(command)
    command.set_defaults(run=export)


def _add_skeleton_options(command: argparse.ArgumentParser) -> None:
    """Declare the export options that choose the skeleton, its bones and a check against an asset."""
    command.add_argument("--skeleton", choices=SKELETONS)
    add_rig_options(command)
    command.add_argument("--check-skeleton", type=Path, metavar="ASSET")
    known = names("bone_names")
    bones = command.add_argument("--bvh-names", choices=known, default="", metavar="PROFILE")
    fill_help(bones, formats=names_where(lambda kind: kind.bones_by_name), names=", ".join(known))


def _add_content_options(command: argparse.ArgumentParser) -> None:
    """Declare the options for additional files, and for reducing animation keys."""
    command.add_argument("--sound", action="store_true")
    stage = command.add_argument("--stage", action="store_true")
    fill_help(stage, formats=names_where(lambda kind: kind.stage))
    command.add_argument("--face-names", choices=CURVE_NAMES, default=DEFAULT_FACE.names)
    parts = command.add_argument("--face-parts", type=face_parts, default=FACE_PARTS, metavar="PARTS")
    fill_help(parts, parts=", ".join(FACE_PARTS))
    alone = command.add_argument("--motion-only", action="store_true")
    fill_help(alone, formats=names_where(lambda kind: kind.without_meshes))
    command.add_argument("--without-props", action="store_true")
    sizes = tuple(texture_size_text(px) for px in TEXTURE_SIZES)
    textures = command.add_argument("--texture-size", choices=sizes, default=texture_size_text(USUAL_TEXTURE_PX))
    fill_help(textures, formats=names_where(lambda kind: kind.textured), usual=USUAL_TEXTURE_PX)
    levels = command.add_argument("--levels-of-detail", type=level_count, default=0, metavar="N")
    fill_help(levels, formats=names_where(lambda kind: kind.textured), most=MOST_LEVELS)
    keys = command.add_argument("--keys", choices=KEY_CHOICES, default="every")
    fill_help(keys, formats=names_where(lambda kind: kind.reduces_keys))


def add_rig_options(command: argparse.ArgumentParser) -> None:
    """Declare the options for attaching instruments, and for additions to the skeletons."""
    command.add_argument("--instrument", choices=ATTACHMENTS, default=DEFAULT_RIG.instrument)
    command.add_argument("--root-bone", choices=ROOT_BONES, default=DEFAULT_RIG.root_bone)
    command.add_argument("--rest-pose", choices=REST_POSES, default=DEFAULT_RIG.rest_pose)
    command.add_argument("--twist-bones", action="store_true")
    command.add_argument("--eyes", choices=EYE_TURNS, default=DEFAULT_RIG.eyes)


def texture_size_text(px: int) -> str:
    """Return the text by which a size of textures is typed as an option: a number of pixels, or ``off`` for 0."""
    return str(px) if px else "off"


jobs = bounded_number(1, 256, "quantity.processes", int)
level_count = bounded_number(1, MOST_LEVELS, "quantity.levels_of_detail", int)


def file_formats(text: str) -> list[Format]:
    """Return the formats of a text such as ``fbx`` or ``fbx,glb``.

    Raises
    ------
    argparse.ArgumentTypeError
        The text is empty or contains an unknown format.
    """
    names = _names(text, FILE_FORMATS, "cli.no_format")
    return [name for name in FILE_FORMATS if name in names]


def face_parts(text: str) -> tuple[FacePart, ...]:
    """Return the parts of a face of a text such as ``brows`` or ``brows,eyes``.

    Raises
    ------
    argparse.ArgumentTypeError
        The text is empty or contains an unknown part.
    """
    names = _names(text, FACE_PARTS, "cli.no_face_part")
    return tuple(part for part in FACE_PARTS if part in names)


def _names(text: str, possible: Collection[str], refusal: str) -> list[str]:
    """Return the names in a text that separates them by commas.

    Parameters
    ----------
    possible : collection of str
        Names that are allowed.
    refusal : str
        Id of the error message for other names.
    """
    names = [name.strip().casefold() for name in text.split(",")]
    unknown = [name for name in names if name not in possible]
    if unknown:
        typed = ", ".join(map(repr, unknown))
        raise argparse.ArgumentTypeError(said(refusal, typed=typed, possible=", ".join(possible)))
    return names


def export(arguments: argparse.Namespace) -> int:
    """Write the files, print their contents and the excluded players, and return the exit status."""
    if arguments.scheduler is None:
        # What cannot be written here is reported before any piece is read; other machines may be able to.
        for kind in requested(arguments.formats or ()):
            kind.refuse()
    if arguments.piece is not None:
        arguments.file = arguments.piece
    elif os.path.isdir(arguments.file):
        from app.cli.batch import export_folder

        with interrupted_by(signal.SIGTERM):
            return export_folder(arguments)
    elif arguments.scheduler is not None:
        raise UsageError("dask.one_piece")
    formats = _requested_formats(arguments)
    # Errors of the Unreal project are reported before any file is read.
    unreal = None
    if arguments.unreal is not None:
        from app.export.unreal.project import find_project

        unreal = find_project(arguments.unreal)
    clean_up()
    project = open_project(arguments, if_empty="export.no_players")
    performance = Performance(project)
    skeleton: SkeletonChoice = arguments.skeleton or ("own" if unreal is None else "ue5")
    folder = arguments.to if unreal is None else unreal.folder
    request = _request(arguments, performance, formats, folder, skeleton)
    if arguments.piece is None:
        say_what_is_there(request, arguments.unreal)
    progress = Progress(sys.stderr)
    try:
        with interrupted_by(signal.SIGTERM):
            if unreal is None:
                report = write(request, text, progress=progress, shown_in=sentence)
                reported = summary(report, arguments.to)
            else:
                from app.export.unreal.run import export_into

                written = export_into(request, unreal, text, progress=progress, shown_in=sentence)
                report = written.report
                reported = project_summary(written, unreal, skeleton, chosen=arguments.skeleton is not None)
    finally:
        progress.clear()
    say(*reported)
    return report_left_out((one.player, one.reason) for one in report.left_out)


def say_what_is_there(request: ExportRequest, unreal: Path | None) -> None:
    """Print the existing files that an export will replace or remove, and how their content differs, before anything is
    written.

    Parameters
    ----------
    unreal : path or None
        File or folder of an Unreal project; None if the export goes into the request's folder.

    Raises
    ------
    FileError
        If the Unreal project contains files of another program under the same names.
    """
    performance, source, bars = request.performance, request.source, request.bars
    ids = (*(one.id for one in request.players), *(one.id for one in request.dancers))
    if unreal is not None:
        seen = foresee_unreal(unreal, performance, ids, source, bars, request.with_props)
    else:
        seen = foresee_folder(
            request.folder,
            performance,
            ids,
            request.formats,
            source,
            request.sound,
            request.stage,
            bars=bars,
            props=request.with_props,
            motion_only=request.motion_only,
            keys=request.keys,
        )
    for id, files in (("export_report.will_replace", seen.replaced), ("export_report.will_remove", seen.removed)):
        if files:
            warn(said(id, folder=str(request.folder), count=len(files), files=_some(files)))
    for message in seen.remarks:
        warn(sentence(message))


def _some(files: Sequence[str]) -> str:
    """Return file names joined by commas, with ``…`` in place of all but the first few."""
    return ", ".join([*files[:MOST_NAMED], *(["…"] if len(files) > MOST_NAMED else [])])


def _request(
    arguments: argparse.Namespace,
    performance: Performance,
    formats: frozenset[Format],
    folder: Path,
    skeleton: SkeletonChoice,
) -> ExportRequest:
    """Return the export request that the command's options describe, for files in a folder."""
    project = performance.project
    names = [*(player.name for player in project.players), *(dancer.name for dancer in project.dancers)]
    chosen = select_players(arguments.players, names)
    count = len(project.players)
    players = tuple(project.players[index] for index in chosen if index < count)
    # Reported before the plans, which say what a body cannot reach.
    musicians = dict.fromkeys(project.musician(player) for player in players)
    find_holds(performance, [player for musician in musicians for player in project.played_by(musician)])
    return ExportRequest(
        performance=performance,
        players=players,
        folder=folder,
        formats=formats,
        span=requested_span(performance, arguments, project.fps),
        bars=requested_bars(performance, arguments),
        source=shown(arguments.file.name),
        creator=f"Suisou {program_version()}",
        skeleton=skeleton,
        rig=RigOptions(
            arguments.instrument, arguments.root_bone, arguments.rest_pose, arguments.twist_bones, arguments.eyes
        ),
        asset=arguments.check_skeleton,
        sound=arguments.sound,
        stage=arguments.stage,
        bvh_names=arguments.bvh_names,
        dancers=tuple(project.dancers[index - count] for index in chosen if index >= count),
        processes=arguments.jobs,
        keys=arguments.keys,
        face=FaceOptions(arguments.face_names, arguments.face_parts),
        motion_only=arguments.motion_only,
        texture_px=next(px for px in TEXTURE_SIZES if texture_size_text(px) == arguments.texture_size),
        levels=levels_for(arguments.levels_of_detail, arguments.unreal is not None),
        props=not arguments.without_props,
        with_ignored=arguments.ignored,
    )


def _requested_formats(arguments: argparse.Namespace) -> frozenset[Format]:
    """Return the requested formats. Raises `UsageError` if none of them supports another requested option."""
    if arguments.unreal is not None and arguments.formats:
        raise UsageError("unreal.formats")
    formats: frozenset[Format] = frozenset(arguments.formats or USUAL_FORMATS)
    if arguments.stage and arguments.unreal is not None:
        raise UsageError("unreal.stage")
    if arguments.stage and not any(kind.stage for kind in requested(formats)):
        raise UsageError("stage.formats", possible=names_where(lambda kind: kind.stage))
    if arguments.keys != "every" and arguments.unreal is not None:
        raise UsageError("unreal.keys")
    if arguments.keys != "every" and not any(kind.reduces_keys for kind in requested(formats)):
        raise UsageError("keys.formats", possible=names_where(lambda kind: kind.reduces_keys))
    if arguments.face_names != DEFAULT_FACE.names and arguments.unreal is not None:
        raise UsageError("unreal.face_names")
    if arguments.face_names != DEFAULT_FACE.names and not any(kind.face_names for kind in requested(formats)):
        raise UsageError("face_names.formats", possible=names_where(lambda kind: kind.face_names))
    if arguments.motion_only and arguments.unreal is not None:
        raise UsageError("unreal.motion_only")
    if arguments.motion_only and not any(kind.without_meshes for kind in requested(formats)):
        raise UsageError("motion_only.formats", possible=names_where(lambda kind: kind.without_meshes))
    refuse_attachment(formats, arguments.instrument)
    return formats
