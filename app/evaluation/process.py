"""An evaluation made by a process of its own: the window stays alive, and its drawing is not disturbed.

The child reads an `EvaluationJob` from its input and answers with `EvaluationProgress`, at last with
`EvaluationFinished` or `EvaluationRefused`. When its input ends, it stops and removes the files that it has written.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Final, TypeAlias

import msgspec

from app.child import StartedChild, ended_on_request
from app.errors import AppError, Cancelled, Message, StopRequested, shortened
from app.evaluation.request import EvaluationRequest
from app.formats.temporary_folders import scratch_folder
from app.project.model import Project
from app.project.storage import decode, encode

_BESIDE: Final = "project"
"""A project's paths are relative to its file."""
Report: TypeAlias = Callable[[float, Message], None]


class EvaluationJob(msgspec.Struct, frozen=True):
    """Input of the process that makes an evaluation."""

    project: bytes
    beside: str
    request: EvaluationRequest

    def opened(self) -> Project:
        """The project that is performed."""
        return decode(self.project, Path(self.beside) / _BESIDE)


class EvaluationProgress(msgspec.Struct, frozen=True, tag=True):
    """Progress of an evaluation: the share that is done, 0..1, and the current work."""

    share: float
    message: Message


class EvaluationRefused(msgspec.Struct, frozen=True, tag=True):
    """Report that the evaluation failed and nothing was written, with the reason."""

    message: Message


class EvaluationFinished(msgspec.Struct, frozen=True, tag=True):
    """Report of a finished evaluation: the clips and pairs written, and those left out.

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


Answer = EvaluationProgress | EvaluationRefused | EvaluationFinished


def made_by_process(
    module: str, project: Project, request: EvaluationRequest, report: Report, stop_requested: StopRequested
) -> EvaluationFinished:
    """Make an evaluation in another process: all of it or nothing.

    Parameters
    ----------
    module : str
        What is run: it serves an `EvaluationJob`.

    Raises
    ------
    AppError
        As `app.evaluation.make.make_evaluation`; ``evaluate.ended``.
    Cancelled
    """
    with scratch_folder() as folder, (folder / "complaint.txt").open("w+b") as printed:
        job = EvaluationJob(encode(project, folder / _BESIDE), str(folder), request)
        try:
            child = StartedChild[Answer](Answer, module, stderr=printed)
        except OSError as error:
            raise AppError("evaluate.ended", detail=str(error)) from error
        with ended_on_request(child.process, stop_requested, child.hang_up):
            try:
                child.send(job)
                while isinstance(answer := child.receive(), EvaluationProgress):
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
    if isinstance(answer, EvaluationRefused):
        if stop_requested() or answer.message.id == "work.stopped":
            raise Cancelled("work.stopped")
        raise AppError(answer.message.id, **answer.message.arguments)
    return answer
