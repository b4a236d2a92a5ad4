"""Making an evaluation in a process of its own, so that the window stays responsive.

The child reads an `EvaluationJob` from its input and answers with `EvaluationProgress`, and at the end with
`EvaluationFinished` or `EvaluationRefused`. When its input ends, it stops and deletes the files it has written.
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
"""Name of the project file that relative paths refer to."""
Report: TypeAlias = Callable[[float, Message], None]


class EvaluationJob(msgspec.Struct, frozen=True):
    """Input of the separate process that makes the clips of an evaluation."""

    project: bytes
    beside: str
    request: EvaluationRequest

    def opened(self) -> Project:
        """Return the project whose performance the evaluation uses."""
        return decode(self.project, Path(self.beside) / _BESIDE)


class EvaluationProgress(msgspec.Struct, frozen=True, tag=True):
    """Progress of an evaluation: the completed share, 0..1, and the current work."""

    share: float
    message: Message


class EvaluationRefused(msgspec.Struct, frozen=True, tag=True):
    """Report that the evaluation failed and nothing was written, with the reason."""

    message: Message


class EvaluationFinished(msgspec.Struct, frozen=True, tag=True):
    """Report of a finished evaluation: the clips and pairs written, and the performers left out.

    Attributes
    ----------
    left_out : tuple of (str, Message)
        Performers that could not be drawn, with the reasons.
    confidence : float or None
        Confidence of the film's position, if it was found by sound.
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
    """Make an evaluation in another process, completely or not at all.

    Parameters
    ----------
    module : str
        Module to run, which processes an `EvaluationJob`.

    Raises
    ------
    AppError
        As `app.evaluation.make.make_evaluation`, or the process ended unexpectedly.
    Cancelled
        ``stop_requested`` returned true.
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
