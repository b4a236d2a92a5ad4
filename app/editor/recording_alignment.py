"""Aligns the score with the recording: applies an offset, a tempo or all beats as one edit, and reports uncertain
bars.
"""

from __future__ import annotations

from app.audio.decode import AudioRecording
from app.audio.followed_recording import Followed, FollowOptions, listen, take_over
from app.audio.offset import Estimate
from app.editor.session import Session, Severity
from app.errors import Message, Progress, StopRequested
from app.project.edit.piece import set_offset
from app.project.edit.tempo import scale_tempo
from app.project.model import Project
from app.score.beat_following import bars_named, message_of_place

SURE = 0.5
"""Confidence from which an estimated offset is applied without asking the user."""
SAME_TEMPO = 0.002
"""Relative difference below which tempi are equal: 6 ms in 3 s."""


def take_estimate(session: Session, estimate: Estimate, unasked: bool, with_tempo: bool) -> None:
    """Set an estimated offset of the recording, and optionally the estimated tempo, as one edit; report the confidence.

    Parameters
    ----------
    unasked : bool
        Whether the recording was just added: an uncertain offset is then reported but not set.
    """
    percent = round(100 * estimate.confidence)
    if estimate.confidence < SURE and (unasked or with_tempo):
        session.notice(Message("audio.not_recognised", {"percent": percent}), Severity.WARNING)
        return
    other_tempo = abs(estimate.tempo_ratio - 1.0) > SAME_TEMPO
    fitted = other_tempo and with_tempo

    def placed(project: Project) -> Project:
        project = set_offset(project, estimate.offset_s, estimate.confidence)
        return scale_tempo(project, estimate.tempo_ratio) if fitted else project

    session.attempt(Message("edit.fit_tempo" if fitted else "edit.estimate_offset"), placed)
    tempo_percent = 100 * (estimate.tempo_ratio - 1.0)
    arguments = {"offset_s": estimate.offset_s, "percent": percent, "tempo_percent": tempo_percent}
    id = "audio.offset_found"
    if other_tempo:
        id = "audio.tempo_fitted" if with_tempo else "audio.other_tempo"
    severity = Severity.INFORMATION if estimate.confidence >= SURE else Severity.WARNING
    session.notice(message_of_place(id, dict(arguments), estimate.runner_up), severity)


def follow_in_background(session: Session, recording: AudioRecording, options: FollowOptions) -> None:
    """Align every beat to the recording in the background; the result is dropped if recording or score have changed."""
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
