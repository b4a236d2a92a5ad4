"""An evaluation made for a window that stays alive meanwhile: the other side of `app.evaluation.process`."""

from __future__ import annotations

import os
import sys
import threading
from typing import IO

import msgspec

from app.errors import AppError, Message
from app.evaluation.make import make_evaluation
from app.evaluation.process import Answer, Finished, Job, Refused, Reported
from app.messages import text
from app.own_process import receive, send


def main() -> None:
    """Make the evaluation that is asked for."""
    # What libraries print would be taken for an answer.
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    job = msgspec.msgpack.decode(receive(sys.stdin.buffer), type=Job)
    stopped = threading.Event()
    threading.Thread(target=_until_closed, args=(sys.stdin.buffer, stopped), daemon=True).start()
    try:
        answer = _made(job, answers, stopped)
    except AppError as error:
        answer = Refused(error.message)
    _answer(answers, answer)


def _made(job: Job, answers: IO[bytes], stopped: threading.Event) -> Answer:
    # All of Qt.
    from widgets.viewport.offscreen import offscreen

    def report(share: float, message: Message) -> None:
        _answer(answers, Reported(share, message))

    made = make_evaluation(job.opened(), job.request, offscreen, text, report, stopped.is_set)
    video = made.video
    return Finished(
        clips=len(made.key.clips),
        pairs=made.pairs,
        left_out=tuple((one.player.name, one.reason) for one in made.left_out),
        offset_s=None if video is None else video.offset_s,
        confidence=None if video is None else video.confidence,
    )


def _answer(answers: IO[bytes], answer: Answer) -> None:
    send(answers, msgspec.msgpack.encode(answer))


def _until_closed(stream: IO[bytes], stopped: threading.Event) -> None:
    """Wait until who asked closes the input, or has ended."""
    while stream.read(1):
        pass
    stopped.set()


if __name__ == "__main__":
    main()
