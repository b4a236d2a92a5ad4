"""Child process that exports musicians of a piece, to use several cores.

The child is a forked copy of the exporting process (`serve`), or this module run as a program, which first reads an
`ExportJob`. It receives ids of musicians; for each it writes the files, and sends `Share` repeatedly and finally
`Exported`. It ends with its input or at a failure, in which case the parent process repeats the work and reports the
error.
"""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import msgspec

from app.child import MessageChannel, channel_to_parent
from app.errors import AppError
from app.export.face_curves import FaceOptions
from app.export.formats import Format
from app.export.player import ExportedPlayer, export_player
from app.export.request import CastMusician, ExportRequest, cast_of
from app.export.rig_options import RigOptions
from app.export.target import SkeletonChoice
from app.formats.keys import KeyChoice
from app.messages import text
from app.performance.ensemble import Performance
from app.performance.span import FrameSpan
from app.project.storage import decode, encode


class ExportJob(msgspec.Struct, frozen=True):
    """An `ExportRequest` without players and dancers, as sent to a process; paths are bytes, since they may not be
    valid text.
    """

    project: bytes
    folder: bytes
    formats: frozenset[Format]
    fps: tuple[int, int]
    first: int
    count: int
    first_frame_s: float
    source: str
    creator: str
    skeleton: SkeletonChoice
    rig: RigOptions
    asset: bytes | None
    sound: bool
    bvh_names: str
    keys: KeyChoice
    face: FaceOptions
    motion_only: bool
    texture_px: int
    levels: int
    few_materials: bool | None
    props: bool


class Share(msgspec.Struct, frozen=True, tag=True):
    """Progress of the work on a musician, 0..1."""

    done: float


class Exported(msgspec.Struct, frozen=True, tag=True):
    """Message that a musician's files are written."""

    player: ExportedPlayer


Answer = Share | Exported


def job_of(request: ExportRequest, folder: Path) -> ExportJob:
    """Return the job that makes a process write the request into a folder."""
    span = request.span
    return ExportJob(
        project=encode(request.performance.project, folder / "project"),
        folder=os.fsencode(folder),
        formats=request.formats,
        fps=span.fps.as_integer_ratio(),
        first=span.first,
        count=span.count,
        first_frame_s=span.first_frame_s,
        source=request.source,
        creator=request.creator,
        skeleton=request.skeleton,
        rig=request.rig,
        asset=None if request.asset is None else os.fsencode(request.asset.absolute()),
        sound=request.sound,
        bvh_names=request.bvh_names,
        keys=request.keys,
        face=request.face,
        motion_only=request.motion_only,
        texture_px=request.texture_px,
        levels=request.levels,
        few_materials=request.few_materials,
        props=request.props,
    )


def _request(job: ExportJob) -> ExportRequest:
    folder = Path(os.fsdecode(job.folder))
    return ExportRequest(
        performance=Performance(decode(job.project, folder / "project")),
        players=(),
        folder=folder,
        formats=job.formats,
        span=FrameSpan(Fraction(*job.fps), job.first, job.count, job.first_frame_s),
        bars=None,
        source=job.source,
        creator=job.creator,
        skeleton=job.skeleton,
        rig=job.rig,
        asset=None if job.asset is None else Path(os.fsdecode(job.asset)),
        sound=job.sound,
        bvh_names=job.bvh_names,
        keys=job.keys,
        face=job.face,
        motion_only=job.motion_only,
        texture_px=job.texture_px,
        levels=job.levels,
        few_materials=job.few_materials,
        props=job.props,
    )


def serve(
    request: ExportRequest, musicians: Sequence[CastMusician], folder: Path, channel: MessageChannel[str]
) -> None:
    """Export the musicians of a cast whose ids are read from a channel, until it ends.

    Parameters
    ----------
    request : ExportRequest
        The export.
    musicians : sequence of CastMusician
        Musicians that may be requested.
    folder : path
        Folder to write into.
    channel : MessageChannel
        Channel to the parent process.
    """
    known = {musician.player.id: musician for musician in musicians}
    # On failure the parent process repeats the work and reports the error.
    with contextlib.suppress(BrokenPipeError, AppError):
        while True:
            _export(request, known[channel.receive()], folder, channel)


def _export(request: ExportRequest, musician: CastMusician, folder: Path, channel: MessageChannel[Any]) -> None:
    exported = export_player(request, musician, folder, lambda share: channel.send(Share(share)))
    channel.send(Exported(exported))


def main() -> None:
    """Read an export job, then export the musicians whose ids the parent process sends."""
    channel: MessageChannel[Any] = channel_to_parent(ExportJob | str, "export")
    try:
        request = _request(channel.receive())
        while True:
            player = request.performance.project.player(channel.receive())
            (musician,) = cast_of(replace(request, players=(player,)), text).musicians
            _export(request, musician, request.folder, channel)
    except BrokenPipeError:
        return
    except AppError:
        sys.exit(1)


if __name__ == "__main__":
    main()
