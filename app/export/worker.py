"""Musicians of a piece exported by a process of their own, so that several cores work on a piece.

The child is this module, run as a program: it reads a `Job` from its input, then ids of musicians; for each it writes
the files and answers with `Share`, the work that is done, and at last `Exported`. It ends when its input does, and
where something fails: the process that started it does the same work again, and reports what is wrong.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec

from app.errors import AppError
from app.export.formats import Format
from app.export.player import ExportedPlayer, export_player
from app.export.request import Request, cast_of
from app.export.rig_options import RigOptions
from app.export.target import SkeletonChoice
from app.formats.keys import KeyChoice
from app.messages import text
from app.own_process import receive, send
from app.performance.ensemble import Performance
from app.performance.span import FrameSpan
from app.project.storage import decode, encode


class Job(msgspec.Struct, frozen=True):
    """A `Request` without its players and dancers, as it is sent."""

    project: bytes
    folder: str
    formats: frozenset[Format]
    fps: tuple[int, int]
    first: int
    count: int
    first_frame_s: float
    source: str
    creator: str
    skeleton: SkeletonChoice
    rig: RigOptions
    asset: str | None
    sound: bool
    bvh_names: str
    keys: KeyChoice


class Share(msgspec.Struct, frozen=True, tag=True):
    """How much of the work on a musician is done, 0..1."""

    done: float


class Exported(msgspec.Struct, frozen=True, tag=True):
    """A musician's files are written."""

    player: ExportedPlayer


Answer = Share | Exported


def job_of(request: Request, folder: Path) -> Job:
    """What a process needs to know of a request, to write into a folder."""
    span = request.span
    return Job(
        project=encode(request.performance.project, folder / "project"),
        folder=str(folder),
        formats=request.formats,
        fps=span.fps.as_integer_ratio(),
        first=span.first,
        count=span.count,
        first_frame_s=span.first_frame_s,
        source=request.source,
        creator=request.creator,
        skeleton=request.skeleton,
        rig=request.rig,
        asset=None if request.asset is None else str(request.asset.absolute()),
        sound=request.sound,
        bvh_names=request.bvh_names,
        keys=request.keys,
    )


def _request(job: Job) -> Request:
    folder = Path(job.folder)
    return Request(
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
        asset=None if job.asset is None else Path(job.asset),
        sound=job.sound,
        bvh_names=job.bvh_names,
        keys=job.keys,
    )


def main() -> None:
    """Export the musicians whose ids are sent."""
    encoder = msgspec.msgpack.Encoder()
    try:
        request = _request(msgspec.msgpack.decode(receive(sys.stdin.buffer), type=Job))
        while True:
            player = request.performance.project.player(receive(sys.stdin.buffer).decode())
            cast = cast_of(replace(request, players=(player,)), text)
            (performer,) = cast.performers
            exported = export_player(
                request,
                cast,
                performer,
                request.folder,
                lambda share: send(sys.stdout.buffer, encoder.encode(Share(share))),
            )
            send(sys.stdout.buffer, encoder.encode(Exported(exported)))
    except BrokenPipeError:
        return
    except AppError:
        sys.exit(1)


if __name__ == "__main__":
    main()
