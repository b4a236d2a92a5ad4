"""Reference video at the playhead: frames are read in the background, and its offset is found by its sound."""

from __future__ import annotations

from functools import partial
from math import floor
from pathlib import Path
from typing import Final

from PySide6.QtCore import QObject, QTimer

from app.audio.decode import decode
from app.audio.offset import Estimate, estimate_offset
from app.audio.track import RATE_HZ
from app.editor.picture_reader import PictureReader
from app.editor.recording_alignment import SURE
from app.editor.session import Session, Severity
from app.editor.window_thread_calls import Reporter
from app.errors import AppError, Message, Progress, StopRequested
from app.formats.other_computers import may_touch
from app.formats.video import VideoFacts, video_facts
from app.project.edit.piece import set_video_offset
from app.project.undoable_document import Change
from app.score.beat_following import message_of_place

MOST_PX: Final = (1280, 720)
"""Largest width and height in pixels at which pictures are decoded."""
_NEAR: Final = 1e-3
"""Tolerance for showing a picture that begins after the playhead, as a share of a picture's duration."""


class ReferenceVideo(QObject):
    """Shows the project's video at the playhead.

    Parameters
    ----------
    session : Session
        Session whose `video` receives the frames; it becomes the parent.
    """

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._path = ""
        """Path of the video that was opened last, readable or not."""
        self._facts: VideoFacts | None = None
        self._reader: PictureReader | None = None
        self._unplaced = ""
        """Path of a video that was just added: its place is to be looked for."""
        session.changed.connect(self._changed)
        session.media_agreed.connect(self._read_agreed)
        session.playhead_changed.connect(self.refresh)
        session.video.changed.connect(self._state_changed)

    def refresh(self) -> None:
        """Show the frame of the video at the playhead."""
        video, facts, reader = self._session.project.video, self._facts, self._reader
        if video is None or facts is None or reader is None:
            return
        at = (self._session.playhead_s - video.offset_s) * float(facts.rate)
        number = floor(at + _NEAR)
        picture = reader.request(number)
        if picture is not None or number < 0 or reader.is_beyond(number):
            self._session.video.set_picture(picture)

    def close(self) -> None:
        """Stop reading the video, and end the reading thread."""
        reader, self._reader = self._reader, None
        if reader is not None:
            reader.close()

    # Change of the video

    def _changed(self, change: Change) -> None:
        before, after = change.before.video, change.after.video
        if change.opened:
            self._unplaced = ""
        elif before is None and after is not None:
            # An existing offset was chosen by the user or belongs to the recording.
            self._unplaced = after.path if after.offset_s == 0.0 and after.confidence is None else ""
        path = after.path if after is not None else ""
        if path != self._path:
            self._take(path)
        elif before is not after:
            self.refresh()

    def _read_agreed(self) -> None:
        """Read the video, after the user has allowed reading it from another computer."""
        if self._facts is None:
            self._take(self._path)

    def _take(self, path: str) -> None:
        self.close()
        self._path, self._facts = path, None
        state = self._session.video
        state.set(ratio=0.0, fault=None)
        state.set_picture(None)
        if not path or not may_touch(path):
            return

        def work(progress: Progress, stop_requested: StopRequested) -> VideoFacts:
            return video_facts(path)

        def done(facts: VideoFacts) -> None:
            if path != self._path:
                return
            self._facts = facts
            state.set(ratio=facts.width / facts.height)
            self._open()
            if path == self._unplaced and facts.has_sound and self._session.project.score.end_tick:
                self.estimate(unasked=True)

        def failed(error: AppError) -> None:
            if path == self._path:
                self._refuse(error)

        name = Message("work.read_video", {"file": Path(path).name})
        # Deferred: the edit that adds the video is still being reported.
        QTimer.singleShot(0, self, lambda: self._session.tasks.run(name, work, done, failed, key="video"))

    def _state_changed(self) -> None:
        if self._session.video.placement == "hidden":
            self.close()
            self._session.video.set_picture(None)
        elif self._reader is None:
            self._open()

    def _open(self) -> None:
        facts = self._facts
        if facts is None or self._session.video.placement == "hidden":
            return
        report = Reporter(self, partial(_reads, path=self._path))
        self._reader = PictureReader(
            self._path,
            facts,
            facts.fitted(*MOST_PX),
            lambda: report(ReferenceVideo.refresh),
            lambda error: report(lambda video: video._refuse(error)),
        )
        self.refresh()

    def _refuse(self, error: AppError) -> None:
        self._session.video.set(fault=error.message)
        self._session.notice(error.message, Severity.ERROR)

    # Offset

    def estimate(self, unasked: bool = False) -> None:
        """Find the video's offset by its sound, and set it as an edit.

        Parameters
        ----------
        unasked : bool
            Whether the video was just added: an uncertain offset is then reported but not set.
        """
        project = self._session.project
        if project.video is None:
            return
        path = project.video.path
        self._unplaced = ""

        def work(progress: Progress, stop_requested: StopRequested) -> Estimate:
            sound = decode(path, lambda share: progress(0.5 * share), stop_requested)
            return estimate_offset(
                sound.samples, RATE_HZ, project.score, lambda share: progress(0.5 + 0.5 * share), stop_requested
            )

        def done(estimate: Estimate) -> None:
            video = self._session.project.video
            if video is not None and video.path == path:
                self._place(estimate, unasked)

        self._session.tasks.run(Message("work.estimate_offset"), work, done, key="estimate_video")

    def _place(self, estimate: Estimate, unasked: bool) -> None:
        percent = round(100 * estimate.confidence)
        is_sure = estimate.confidence >= SURE
        severity = Severity.INFORMATION if is_sure else Severity.WARNING
        if unasked and not is_sure:
            self._session.notice(Message("video.not_recognised", {"percent": percent}), severity)
            return
        self._session.attempt(
            Message("edit.estimate_video_offset"),
            lambda project: set_video_offset(project, estimate.offset_s, estimate.confidence),
        )
        self._session.notice(
            message_of_place(
                "video.offset_found", {"offset_s": estimate.offset_s, "percent": percent}, estimate.runner_up
            ),
            severity,
        )


def _reads(video: ReferenceVideo, path: str) -> bool:
    return video._reader is not None and video._path == path
