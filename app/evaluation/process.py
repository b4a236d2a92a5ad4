"""An evaluation made by a process of its own: the window stays alive, and its drawing is not disturbed.

The child reads a `Job` from its input and answers with `Reported`, at last with `Finished` or `Refused`. It stops and
takes back what it has written when its input ends.

Messages
--------
evaluate.ended(detail): the process has ended without an answer.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Final, TypeAlias

import msgspec

from app.child import StartedChild, ended_on_request
from app.errors import AppError, Cancelled, Message, shortened
from app.evaluation.request import Request
from app.formats.scratch import scratch_folder
from app.project.model import Project
from app.project.storage import decode, encode

_BESIDE: Final = "project"
"""A project's paths are relative to its file."""
Report: TypeAlias = Callable[[float, Message], None]


class Job(msgspec.Struct, frozen=True):
    """What a process needs to know."""

    project: bytes
    beside: str
    request: Request

    def opened(self) -> Project:
        """The project that is performed."""
        return decode(self.project, Path(self.beside) / _BESIDE)


class Reported(msgspec.Struct, frozen=True, tag=True):
    """How much is done, 0..1, and what is being done."""

    share: float
    message: Message


class Refused(msgspec.Struct, frozen=True, tag=True):
    """Why nothing was written."""

    message: Message


class Finished(msgspec.Struct, frozen=True, tag=True):
    """What was written.

    Attributes
    ----------
    left_out : tuple of (str, Message)
        Performers who could not be drawn, with the reasons.
    confidence : float or None
        Of the film's place, where its sound gave it.
    """

    clips: int
    pairs: int
    left_out: tuple[tuple[str, Message], ...]
    offset_s: float | None = None
    confidence: float | None = None


Answer = Reported | Refused | Finished


def made_by_process(
    module: str, project: Project, request: Request, report: Report, stop_requested: Callable[[], bool]
) -> Finished:
    """Make an evaluation in another process: all of it or nothing.

    Parameters
    ----------
    module : str
        What is run: it serves a `Job`.

    Raises
    ------
    AppError
        As `app.evaluation.make.make_evaluation`; ``evaluate.ended``.
    Cancelled
    """
    with scratch_folder() as folder, (folder / "complaint.txt").open("w+b") as printed:
        job = Job(encode(project, folder / _BESIDE), str(folder), request)
        try:
            child = StartedChild[Answer](Answer, module, stderr=printed)
        except OSError as error:
            raise AppError("evaluate.ended", detail=str(error)) from error
        with ended_on_request(child.process, stop_requested, child.hang_up):
            try:
                child.send(job)
                while isinstance(answer := child.receive(), Reported):
                    report(answer.share, answer.message)
            except BrokenPipeError as error:
                if stop_requested():
                    raise Cancelled("work.stopped") from error
                status = child.ended()
                printed.seek(0)
                lines = printed.read().decode(errors="replace").strip().splitlines()
                detail = lines[-1] if lines else f"status {status}"
                raise AppError("evaluate.ended", detail=shortened(detail)) from error
            finally:
                child.ended()
    if isinstance(answer, Refused):
        if stop_requested() or answer.message.id == "work.stopped":
            raise Cancelled("work.stopped")
        raise AppError(answer.message.id, **answer.message.arguments)
    return answer
