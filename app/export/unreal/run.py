"""Atomic export of a performance into an Unreal project's folder.

Sources of the piece (FBX, sound, description, report, manifest) are written to ``SuisouSource/<Piece>``, the importing
plug-in to ``Plugins/Suisou``. A repeated export updates files in place and deletes obsolete ones; files made or changed
by others are never touched.

Players that cannot be exported are excluded; their files from earlier exports stay, in the sources and in Unreal.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import TypeVar

import msgspec
import numpy as np

from app.audio.track import RATE_HZ
from app.errors import Message, StopRequested, raise_if_stopped
from app.export.bind_pose import CENTIMETRES
from app.export.earlier_exports import other_bars, same_music
from app.export.figures import supports_of_musician
from app.export.file_names import REPORT as EXPORTED_REPORT
from app.export.file_names import with_props
from app.export.formats import FILE_FORMATS, FileContent
from app.export.instrument import instrument_bones
from app.export.report import DancerReport, DoubleReport, PlayerReport, Report, encode_report
from app.export.request import ExportCast, ExportRequest, cast_of
from app.export.run import Progress, WordedReports, write_cast
from app.export.sound import write_sound
from app.export.supports import support_bones
from app.export.targets import written_meshes
from app.export.tree import TreeChange, files_below, recover, refuse_links_out, tree_into
from app.export.unreal.check import Expected, check_fbx, check_wave
from app.export.unreal.description import UnrealSound, describe, encode_description
from app.export.unreal.layout import (
    DESCRIPTION,
    IMPORTED,
    MANIFEST,
    PLUGIN,
    REPORT,
    SOURCES,
    FigurePlace,
    Layout,
    layout_of,
    piece_name,
)
from app.export.unreal.manifest import Changes, OwnFile, changes, encode_manifest, own_file, read_manifest
from app.export.unreal.plugin import requested_plugin
from app.export.unreal.project import UnrealProject, require_writable
from app.export.unreal.surfaces import FileContents, Surfaces
from app.formats.files import cannot_read
from app.formats.texture_files import TEXTURES_FOLDER
from app.performance.ensemble import Performance
from app.performance.span import FrameSpan
from app.project.performers import Dancer, Player
from app.rig.mesh import Mesh

R = TypeVar("R", PlayerReport, DoubleReport, DancerReport)

_SHARES = {"files": 0.8, "sound": 0.15, "checks": 0.05}


@dataclass(frozen=True)
class Plan:
    """Planned changes of an export in a project.

    Attributes
    ----------
    layout : Layout
        Paths of the piece.
    written : tuple of path
        All files of the piece and plug-in to be written, relative to the project's folder, in order.
    replaced, removed : tuple of path
        Existing files that are replaced or deleted.
    kept : tuple of Message
        Messages about obsolete files changed by hand, which are kept.
    remarks : tuple of Message
        Remarks about an earlier export with other bars, or of the same music under another name.
    plugin : mapping of path to bytes
        Files of the plug-in by relative path; empty if it is up to date.
    staying : mapping of path to OwnFile
        Files of excluded players and dancers, which stay unchanged and listed in the manifest.
    """

    layout: Layout
    written: tuple[PurePosixPath, ...]
    replaced: tuple[PurePosixPath, ...]
    removed: tuple[PurePosixPath, ...]
    kept: tuple[Message, ...]
    remarks: tuple[Message, ...]
    plugin: dict[PurePosixPath, bytes]
    staying: dict[PurePosixPath, OwnFile]


@dataclass(frozen=True)
class UnrealExport:
    """Result of an export into an Unreal project: the planned changes, and the report."""

    plan: Plan
    report: Report


def plan_export(
    performance: Performance,
    performer_ids: tuple[str, ...],
    source: str,
    project: UnrealProject,
    by_length: bool = False,
    left_out: tuple[str, ...] = (),
    bars: tuple[int, int] | None = None,
    textures: tuple[PurePosixPath, ...] | None = None,
    props: bool = True,
) -> Plan:
    """Plan the export of some performers into a project, without writing.

    Parameters
    ----------
    performer_ids : tuple of str
        Ids of the exported performers.
    source : str
        Name of the piece's file, from which folder names are made.
    by_length : bool
        Whether changed files are detected by length only, which is fast.
    left_out : tuple of str
        Ids of excluded performers, whose files from earlier exports stay.
    bars : (int, int) or None
        First and last exported bar; None for the whole piece.
    textures : tuple of path or None
        Texture files relative to the piece's sources; None if still unknown, so that the plan has none and existing
        ones stay.
    props : bool
        Whether straps and chairs are exported.

    Raises
    ------
    FileError
        An existing file prevents the export; see `app.export.unreal.manifest` and `app.export.unreal.plugin`.
    """
    require_writable(project)
    layout = layout_of(performance.project, piece_name(source, project.folder))
    plugin = requested_plugin(project.folder)
    try:
        worn = with_props(performance) if props else frozenset[str]()
        done = [(layout.sources, (*layout.files(performer_ids, left_out, worn), *(textures or ())))]
        if plugin:
            done.append((PurePosixPath(PLUGIN), (*plugin, PurePosixPath(MANIFEST))))
        stays = frozenset(place.file for one in left_out for place in layout.figures(one))
        if textures is None:
            there = read_manifest(project.folder / layout.sources)
            stays |= {path for path in there if path.parent.as_posix() == TEXTURES_FOLDER}
        found: list[tuple[PurePosixPath, Changes]] = [
            (folder, changes(project.folder / folder, coming, by_length, stays if folder == layout.sources else ()))
            for folder, coming in done
        ]
    except OSError as error:
        raise cannot_read(project.folder, error) from error
    plan = Plan(
        layout=layout,
        written=tuple(sorted(folder / path for folder, coming in done for path in coming)),
        replaced=tuple(sorted(folder / path for folder, change in found for path in change.replaced)),
        removed=tuple(sorted(folder / path for folder, change in found for path in change.removed)),
        kept=tuple(message for _, change in found for message in change.kept),
        remarks=tuple(
            remark
            for remark in (
                other_bars(project.folder / layout.sources, bars),
                same_music(project.folder, layout, performance.project),
            )
            if remark is not None
        ),
        plugin=plugin,
        staying=found[0][1].staying,
    )
    refuse_links_out(project.folder, (*plan.written, *plan.removed))
    require_writable(project, (*plan.replaced, *plan.removed))
    return plan


def export_into(
    request: ExportRequest,
    project: UnrealProject,
    wording: Callable[[Message], str],
    stop_requested: StopRequested = lambda: False,
    progress: Progress = lambda share, label: None,
    shown_in: Callable[[Message], str] | None = None,
) -> UnrealExport:
    """Write a performance into a project.

    Parameters
    ----------
    request : ExportRequest
        The export; its folder, formats, sound and stage settings are ignored.
    project : UnrealProject
        The project.
    wording : callable
        Returns a message as text for the report.
    stop_requested, progress : callable
        See `app.export.run.export`.
    shown_in : callable, optional
        See `app.export.run.export`.

    Raises
    ------
    FileError
        The export failed, and nothing was changed.
    Cancelled
        ``stop_requested`` returned True.
    """
    recover(project.folder, project.folder / SOURCES)
    texture_px = request.texture_px
    # Surfaces in the files are plain: materials with textures are made of the description.
    shared = request.shares_materials
    request = replace(
        request,
        formats=frozenset((IMPORTED,)),
        sound=False,
        stage=False,
        texture_px=0,
        few_materials=shared,
    )
    cast = cast_of(request, shown_in or wording, stop_requested)
    layout = layout_of(request.performance.project, piece_name(request.source, project.folder))
    surfaces = Surfaces(layout.content, texture_px)
    materials = {
        place.file.as_posix(): surfaces.slots(meshes) for _, place, _, meshes in _figures_written(request, cast, layout)
    }
    left_out = tuple(one.player.id for one in cast.left_out)
    plan = plan_export(
        request.performance,
        cast.ids,
        request.source,
        project,
        left_out=left_out,
        bars=request.bars,
        textures=surfaces.files,
        props=request.with_props,
    )
    with tree_into(project.folder, project.folder / SOURCES) as change:
        sources = change.new / plan.layout.sources
        reports = _figures(request, cast, plan.layout, sources, (wording, shown_in), stop_requested, progress)
        sound = _sound(request, plan.layout, sources, stop_requested, progress)
        bones = _checked(request, cast, plan.layout, sources, sound, stop_requested, progress)
        surfaces.write(sources)
        files = {path.as_posix(): own_file(sources / path) for path in files_below(sources)}
        contents = {file: FileContents(named, materials[file]) for file, named in bones.items()}
        description = describe(request, cast, plan.layout, wording, sound, contents, files=files, surfaces=surfaces)
        filed = msgspec.structs.replace(reports.filed, textures=tuple(map(str, surfaces.files)))
        (sources / REPORT).write_bytes(encode_report(filed))
        (sources / DESCRIPTION).write_bytes(encode_description(description))
        _vouch(change, plan.layout.sources, request.creator, {}, plan.staying)
        change.last.insert(0, Path(plan.layout.sources / DESCRIPTION))
        if plan.plugin:
            _vouch(change, PurePosixPath(PLUGIN), request.creator, plan.plugin, {})
        change.removed += [Path(path) for path in plan.removed]
    progress(1.0, "")
    return UnrealExport(plan, reports.shown)


def _vouch(
    change: TreeChange,
    folder: PurePosixPath,
    creator: str,
    content: dict[PurePosixPath, bytes],
    staying: dict[PurePosixPath, OwnFile],
) -> None:
    """Write ``content`` and the manifest into a folder of the Unreal project; the manifest lists all new files and
    those that stay.
    """
    place = change.new / folder
    for path, data in content.items():
        (place / path).parent.mkdir(parents=True, exist_ok=True)
        (place / path).write_bytes(data)
    files = {path.as_posix(): own for path, own in staying.items()}
    files |= {path.as_posix(): own_file(place / path) for path in files_below(place)}
    (place / MANIFEST).write_bytes(encode_manifest(files, creator))
    change.last.append(Path(folder / MANIFEST))


def _figures(
    request: ExportRequest,
    cast: ExportCast,
    layout: Layout,
    sources: Path,
    wordings: tuple[Callable[[Message], str], Callable[[Message], str] | None],
    stop_requested: StopRequested,
    progress: Progress,
) -> WordedReports:
    """Write the FBX files of all figures under their names in the project, which the report uses."""
    draft = sources / "draft"
    wording, shown_in = wordings
    reports = write_cast(
        replace(request, folder=draft),
        cast,
        wording,
        stop_requested,
        lambda share, label: progress(_SHARES["files"] * share, label),
        shown_in,
    )
    report = reports.filed

    places_by_content: dict[FileContent, dict[str, FigurePlace]] = {
        "character": layout.characters,
        "instrument": layout.instruments,
        "props": layout.props,
    }

    def placed(performer: Player | Dancer, written: R) -> R:
        names = {}
        for held, places in places_by_content.items():
            key = FILE_FORMATS[IMPORTED].key(held)
            if key in written.files:
                names[key] = places[performer.id].file.as_posix()
                (sources / names[key]).parent.mkdir(parents=True, exist_ok=True)
                (draft / written.files[key]).replace(sources / names[key])
        return msgspec.structs.replace(written, files=names)

    players = []
    for musician, written in zip(cast.musicians, report.players, strict=True):
        doubles = zip(musician.performers[1:], written.doubles, strict=True)
        found = tuple(placed(performer.player, double) for performer, double in doubles)
        players.append(msgspec.structs.replace(placed(musician.player, written), doubles=found))
    dancers = tuple(placed(one.dancer, written) for one, written in zip(cast.dancers, report.dancers, strict=True))
    (draft / EXPORTED_REPORT).unlink()
    draft.rmdir()
    filed, shown = (msgspec.structs.replace(one, players=tuple(players), dancers=dancers) for one in reports)
    return WordedReports(filed, shown)


def _sound(
    request: ExportRequest, layout: Layout, sources: Path, stop_requested: StopRequested, progress: Progress
) -> UnrealSound:
    """Write the sound of the exported span as a wave file, and return its description."""
    project, span = request.performance.project, request.span
    file = sources / layout.sound_file
    file.parent.mkdir(parents=True, exist_ok=True)
    write_sound(
        file,
        project,
        span,
        lambda share: progress(_SHARES["files"] + _SHARES["sound"] * share, file.name),
        stop_requested,
    )
    return UnrealSound(
        file=layout.sound_file.as_posix(),
        asset=layout.sound,
        source="synthesiser" if project.audio is None else "recording",
        offset_s=0.0,
        duration_s=round((span.end_s - span.first_frame_s) * RATE_HZ) / RATE_HZ,
        rate_hz=RATE_HZ,
        channels=2,
    )


def _checked(
    request: ExportRequest,
    cast: ExportCast,
    layout: Layout,
    sources: Path,
    sound: UnrealSound,
    stop_requested: StopRequested,
    progress: Progress,
) -> dict[str, tuple[str, ...]]:
    """Read every written file and compare it with its expected contents; return the bone names of each by file path.
    Raises FileError if a file differs.
    """
    check_wave(sources / sound.file, RATE_HZ, sound.channels, round(sound.duration_s * RATE_HZ))
    bones: dict[str, tuple[str, ...]] = {}
    figures = tuple(_figures_written(request, cast, layout))
    for index, (name, place, named, meshes) in enumerate(figures):
        raise_if_stopped(stop_requested)
        file = place.file.as_posix()
        bones[file] = named
        check_fbx(sources / file, _expected(request.span, named, meshes))
        done = (index + 1) / len(figures)
        progress(_SHARES["files"] + _SHARES["sound"] + _SHARES["checks"] * done, name)
    return bones


def _figures_written(
    request: ExportRequest, cast: ExportCast, layout: Layout
) -> Iterator[tuple[str, FigurePlace, tuple[str, ...], tuple[Mesh, ...]]]:
    """Yield every character and instrument, and all straps and chairs: the performer's name, the paths, the names of
    the bones, and the meshes.
    """
    for musician in cast.musicians:
        player, target = musician.player, musician.target
        meshes = written_meshes(musician.character, target)
        yield player.name, layout.characters[player.id], tuple(target.names), meshes
        for one in musician.performers:
            parts = tuple(bone.name for bone in instrument_bones(one.instrument, one.model))
            yield player.name, layout.instruments[one.player.id], parts, one.model.meshes
        supports = supports_of_musician(request, musician)
        if supports is not None:
            yield player.name, layout.props[player.id], support_bones(supports), supports.meshes
    for dancer in cast.dancers:
        meshes = written_meshes(dancer.character, dancer.target)
        yield dancer.dancer.name, layout.characters[dancer.dancer.id], tuple(dancer.target.names), meshes


def _expected(span: FrameSpan, bones: tuple[str, ...], meshes: tuple[Mesh, ...]) -> Expected:
    positions_cm = np.concatenate([mesh.positions_m for mesh in meshes]).astype(np.float64) * CENTIMETRES
    return Expected(
        fps=span.fps,
        frames=span.count,
        bones=bones,
        low_cm=positions_cm.min(axis=0),
        high_cm=positions_cm.max(axis=0),
        morphs=frozenset(morph.name for mesh in meshes for morph in mesh.morphs),
    )
