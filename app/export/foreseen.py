"""Preview of an export for the dialog and the command line: files that it will write, replace, remove or keep."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from app.encoding import shown
from app.errors import Message
from app.export.earlier_exports import other_bars, remark_on_files_that_stay
from app.export.file_names import REPORT, file_names, sound_name, stage_names
from app.export.formats import Format, files_of, requested
from app.export.unreal.project import UnrealProject, find_project
from app.export.unreal.run import plan_export
from app.formats.keys import KeyChoice
from app.performance.ensemble import Performance


@dataclass(frozen=True)
class Foreseen:
    """Preview of an export: files that it will write, replace, remove or keep.

    Attributes
    ----------
    count : int
        Number of files that will be written.
    replaced, removed : tuple of str
        Names of existing files that will be replaced or removed.
    kept : tuple of Message
        Messages about existing files that will be kept.
    remarks : tuple of Message
        Remarks about an earlier export (with other bars, of the same music under another name, or files that stay),
        about formats whose files will have no face, and about keys that not every program reads completely.
    project : UnrealProject or None
        The Unreal project; None for an export into a folder.
    """

    count: int
    replaced: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()
    kept: tuple[Message, ...] = ()
    remarks: tuple[Message, ...] = ()
    project: UnrealProject | None = None


def foresee_unreal(
    place: Path,
    performance: Performance,
    player_ids: tuple[str, ...],
    source: str,
    bars: tuple[int, int] | None,
    props: bool = True,
) -> Foreseen:
    """Return a preview of an export of some bars (None for all) into an Unreal project, given by its file or folder.

    ``props`` is whether straps and chairs are written.

    Raises
    ------
    FileError
        There is no project, or files of another program would be replaced.
    """
    unreal = find_project(place)
    plan = plan_export(performance, player_ids, source, unreal, by_length=True, bars=bars, props=props)
    return Foreseen(
        count=len(plan.written),
        replaced=tuple(shown(path.name) for path in plan.replaced),
        removed=tuple(shown(path.name) for path in plan.removed),
        kept=plan.kept,
        remarks=plan.remarks,
        project=unreal,
    )


def foresee_folder(
    folder: Path,
    performance: Performance,
    player_ids: tuple[str, ...],
    formats: frozenset[Format],
    source: str,
    sound: bool,
    stage: bool,
    *,
    bars: tuple[int, int] | None = None,
    props: bool = True,
    motion_only: bool = False,
    keys: KeyChoice = "every",
) -> Foreseen:
    """Return a preview of an export into a folder.

    Parameters
    ----------
    source : str
        Name of the piece's file.
    sound, stage : bool
        Whether the sound is written, and whether the whole stage is written in one file.
    bars : (int, int) or None
        First and last bar that is exported; None for the whole piece.
    props : bool
        Whether straps and chairs are written.
    motion_only : bool
        Whether meshes are left out.
    keys : KeyChoice
        Choice of the frames with keys.
    """
    names = file_names(performance, formats, props)
    project = performance.project
    # For a musician this includes the other instruments.
    everything = [
        *player_ids,
        *(one.id for one in project.players if one.doubles in player_ids and project.musician(one) is not one),
    ]
    written = [name for player_id in everything for name in names[player_id].values()] + [REPORT]
    if sound:
        written.append(sound_name(source))
    if stage:
        written += stage_names(performance, formats, source).values()
    replaced = tuple(name for name in written if os.path.exists(folder / name))
    remarks = [other_bars(folder, bars) if replaced else None, remark_on_files_that_stay(folder, written)]
    remarks += [_without_face(formats), _with_meshes(formats)] if motion_only else []
    remarks.append(_with_tangents(formats) if keys == "reduced" else None)
    return Foreseen(len(written), replaced, remarks=tuple(remark for remark in remarks if remark is not None))


def _without_face(formats: frozenset[Format]) -> Message | None:
    """Return a remark about formats whose files have no face if they are written without meshes; None if there are
    none.
    """
    faceless = [row.label for row in requested(formats) if row.without_meshes and not row.face_without_meshes]
    return Message("motion_only.no_face", {"formats": ", ".join(faceless)}) if faceless else None


def _with_meshes(formats: frozenset[Format]) -> Message | None:
    """Return a remark about formats whose files have meshes in any case; None if there are none."""
    meshed = [row.label for row in requested(formats) if row.textured and not row.without_meshes]
    return Message("motion_only.with_meshes", {"formats": ", ".join(meshed)}) if meshed else None


def _with_tangents(formats: frozenset[Format]) -> Message | None:
    """Return a remark about formats whose reduced keys have tangents that Blender ignores; None if there are none."""
    labels = dict.fromkeys(row.label for row, _ in files_of(formats) if row.tangents)
    return Message("keys.tangents", {"formats": ", ".join(labels)}) if labels else None
