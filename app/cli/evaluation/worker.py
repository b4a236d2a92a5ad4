"""Worker process that makes an evaluation for the editor's window; started by `app.evaluation.process`."""

from __future__ import annotations

import threading

from app.child import MessageChannel, channel_to_parent
from app.errors import AppError, Message
from app.evaluation.make import make_evaluation
from app.evaluation.process import Answer, EvaluationFinished, EvaluationJob, EvaluationProgress, EvaluationRefused
from app.messages import text


def main() -> None:
    """Make the evaluation that the parent process requests; entry point of the worker process."""
    channel: MessageChannel[EvaluationJob] = channel_to_parent(EvaluationJob, "evaluation")
    job = channel.receive()
    stopped = threading.Event()
    threading.Thread(target=_until_closed, args=(channel, stopped), daemon=True).start()
    try:
        answer = _made(job, channel, stopped)
    except AppError as error:
        answer = EvaluationRefused(error.message)
    channel.send(answer)


def _made(job: EvaluationJob, channel: MessageChannel[EvaluationJob], stopped: threading.Event) -> Answer:
    # imports all of Qt
    from widgets.viewport.offscreen import offscreen

    def report(share: float, message: Message) -> None:
        channel.send(EvaluationProgress(share, message))

    made = make_evaluation(job.opened(), job.request, offscreen, text, report, stopped.is_set)
    video = made.video
    return EvaluationFinished(
        clips=len(made.key.clips),
        pairs=made.pairs,
        left_out=tuple((one.player.name, one.reason) for one in made.left_out),
        offset_s=None if video is None else video.offset_s,
        confidence=None if video is None else video.confidence,
    )


def _until_closed(channel: MessageChannel[EvaluationJob], stopped: threading.Event) -> None:
    """Wait until the parent process closes the channel or ends, then set ``stopped``."""
    while channel.incoming.read(1):
        pass
    stopped.set()


if __name__ == "__main__":
    main()
