"""Follows the recording as a task, takes over what was found as one edit, and reports what is doubtful."""

from __future__ import annotations

from app.audio.decode import AudioRecording
from app.audio.followed_recording import Followed, FollowOptions, listen, take_over
from app.editor.session import Session, Severity
from app.editor.tasks import Progress, StopRequested
from app.errors import Message
from app.score.beat_following import bars_named, message_of_place


def follow_in_background(session: Session, recording: AudioRecording, options: FollowOptions) -> None:
    """Put every beat where the recording has it; nothing where the project has another recording or score by then."""
    project = session.project

    def work(progress: Progress, stop_requested: StopRequested) -> Followed:
        return listen(project, recording.samples, recording.path, options, progress, stop_requested)

    def done(followed: Followed) -> None:
        audio, score = session.project.audio, session.project.score
        if audio is not None and audio.path == recording.path and score is project.score:
            _take(session, followed, recording.path)

    session.tasks.run(Message("work.follow_recording"), work, done, key="estimate")


def _take(session: Session, followed: Followed, path: str) -> None:
    following = followed.following
    if not session.attempt(Message("edit.follow_recording"), lambda project: take_over(project, followed, path)):
        return
    metre_map = session.project.metre_map
    doubtful = following.doubtful_bars(metre_map)
    percent = round(100 * following.mean_confidence)
    id = "audio.followed_but" if doubtful else "audio.followed"
    severity = Severity.WARNING if doubtful else Severity.INFORMATION
    bars = bars_named(*((first, last) for first, last, _ in doubtful)) if doubtful else {}
    session.notice(message_of_place(id, {"percent": percent, **bars}, following.runner_up), severity)
    for span in following.missing:
        first, last = metre_map.bar_of_tick(int(span.start)), metre_map.bar_of_tick(max(int(span.end) - 1, 0))
        session.notice(Message("align.bars_outside", bars_named((first, last))), Severity.WARNING)
    for span in following.added:
        session.notice(Message("align.only_recorded", {"start_s": span.start, "end_s": span.end}), Severity.WARNING)
