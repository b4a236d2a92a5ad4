"""Videos with which a performance is compared (real players, or other animation), synchronised by their sound."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from app.audio.decode import decode
from app.audio.track import RATE_HZ, AudioSegment, Block, Mix, MixTrack, Samples
from app.errors import AppError, FileError, Progress, StopRequested
from app.evaluation.excerpts import Excerpt
from app.formats.video import VideoFacts, VideoPictures, video_facts, video_pictures
from app.project.model import Project

Picture = npt.NDArray[np.uint8]

RECOGNISED: Final = 0.5
"""Confidence below which a video's sound is considered to be of another piece."""
MOST_DRIFT_S: Final = 0.1
"""Offset in seconds at the end of the piece above which a video's tempo differs from the piece's."""
MOST_S: Final = 2 * 3600.0
"""Longest part of the sound that is analysed, in seconds."""
_EARLY_S: Final = 0.05
"""Seconds by which a video may begin after the first moment that is shown of it."""


@dataclass(frozen=True, eq=False)
class ImportedVideo:
    """A video with its position in the piece.

    Attributes
    ----------
    offset_s : float
        Performance time of the first picture in seconds.
    facts : VideoFacts
        Size, frame rate and length of the video.
    samples : (N, 2) int16 or None
        Sound at `RATE_HZ`; None if there is none.
    confidence : float or None
        Confidence of the position, 0..1; None if the user gave the position.
    """

    path: Path
    offset_s: float
    facts: VideoFacts
    samples: Samples | None
    confidence: float | None = None

    @property
    def covered_s(self) -> tuple[float, float]:
        """Span of the performance in seconds that the video shows."""
        length_s = self.facts.duration_s
        if length_s <= 0.0:
            length_s = math.inf if self.samples is None else len(self.samples) / RATE_HZ
        return self.offset_s, self.offset_s + length_s

    def sound(self, excerpt: Excerpt) -> Block:
        """Return the sound of the video during an excerpt, shape (N, 2)."""
        assert self.samples is not None
        mix = Mix([MixTrack([AudioSegment(round(self.offset_s * RATE_HZ), self.samples)])])
        return mix.read(round(excerpt.from_s * RATE_HZ), round(excerpt.duration_s * RATE_HZ))

    def require_covered(self, excerpt: Excerpt) -> None:
        """Raise FileError if the video does not show all of an excerpt."""
        require_covered(self.path, self.covered_s, excerpt)


def require_covered(path: Path, covered_s: tuple[float, float], excerpt: Excerpt) -> None:
    """Raise FileError unless a file that shows the span ``covered_s`` of the performance shows all of an excerpt."""
    first_s, last_s = covered_s
    if excerpt.from_s < first_s - _EARLY_S or excerpt.until_s > last_s + _EARLY_S:
        raise FileError(
            "evaluate.not_covered",
            file=str(path),
            from_s=excerpt.from_s,
            until_s=excerpt.until_s,
            first_s=first_s,
            last_s=last_s,
        )


def import_video(
    project: Project,
    path: Path,
    offset_s: float | None,
    progress: Progress,
    stop_requested: StopRequested,
    follow: bool = False,
) -> tuple[ImportedVideo, Project]:
    """Open a video and find its position in the piece; returns both the video and the project, changed to the video's
    tempo if requested.

    Parameters
    ----------
    offset_s : float or None
        Position in seconds; None to find it by comparing the sound with the piece.
    follow : bool
        Whether the piece must take the video's tempo.

    Raises
    ------
    FileError
        The video cannot be read or its sound does not fit the piece.
    AppError
        The sound cannot be followed.
    Cancelled
        ``stop_requested`` returned true.
    """
    facts = video_facts(str(path))
    if not facts.has_sound:
        if offset_s is None or follow:
            raise FileError("evaluate.silent_video", file=str(path))
        return ImportedVideo(path, offset_s, facts, None), project
    samples = decode(str(path), stop_requested=stop_requested).samples[: round(MOST_S * RATE_HZ)]
    progress(0.3)
    if offset_s is not None and not follow:
        return ImportedVideo(path, offset_s, facts, samples), project
    with _about(path):
        found = _followed if follow else _found
        return found(project, path, facts, samples, lambda share: progress(0.3 + 0.7 * share), stop_requested)


@contextlib.contextmanager
def _about(path: Path) -> Iterator[None]:
    """Context manager that adds the video's name to errors about its sound."""
    try:
        yield
    except AppError as error:
        message = error.message
        if message.id == "audio.nothing_to_compare":
            raise FileError("evaluate.silent_video", file=str(path)) from error
        if message.id == "audio.not_followed":
            percent = message.arguments["percent"]
            raise FileError("evaluate.not_followed", file=str(path), percent=percent) from error
        raise


def _found(
    project: Project, path: Path, facts: VideoFacts, samples: Samples, progress: Progress, stop_requested: StopRequested
) -> tuple[ImportedVideo, Project]:
    from app.audio.offset import estimate_offset

    found = estimate_offset(samples, RATE_HZ, project.score, progress, stop_requested)
    percent = round(100 * found.confidence)
    if found.confidence < RECOGNISED:
        raise FileError("evaluate.other_piece", file=str(path), percent=percent)
    score = project.score
    drift_s = abs(found.tempo_ratio - 1.0) * float(score.tempo_map.seconds(float(score.end_tick)))
    if drift_s > MOST_DRIFT_S:
        faster = round(100.0 * (found.tempo_ratio - 1.0), 1)
        raise FileError("evaluate.other_tempo", file=str(path), percent=faster)
    return ImportedVideo(path, found.offset_s, facts, samples, found.confidence), project


def _followed(
    project: Project, path: Path, facts: VideoFacts, samples: Samples, progress: Progress, stop_requested: StopRequested
) -> tuple[ImportedVideo, Project]:
    from app.audio.follow import beats_of, follow
    from app.project.edit.follow import follow_recording

    score = project.score
    following = follow(samples, RATE_HZ, score, beats_of(project.metre_map, score.end_tick), progress, stop_requested)
    followed = follow_recording(project, following, path)
    assert followed.audio is not None
    video = ImportedVideo(path, followed.audio.offset_s, facts, samples, following.mean_confidence)
    # The video contains no recording that could replace the synthesiser.
    return video, replace(followed, audio=project.audio)


@contextlib.contextmanager
def pictures_of(video: ImportedVideo, from_s: float, size: tuple[int, int]) -> Iterator[Callable[[float], Picture]]:
    """Context manager for a function that returns the video's picture at ascending performance times, whole and centred
    in a frame of the given size.
    """
    facts = video.facts
    share = min(size[0] / facts.width, size[1] / facts.height)
    inner = (max(round(facts.width * share / 2) * 2, 2), max(round(facts.height * share / 2) * 2, 2))
    first = _number(video, from_s)
    with video_pictures(str(video.path), facts.rate, inner, first) as pictures:
        yield _Framed(video, pictures, size, inner)


class _Framed:
    """Function object that places the pictures of a video in a frame; after the video's end it repeats the last
    picture.
    """

    def __init__(
        self, video: ImportedVideo, pictures: VideoPictures, size: tuple[int, int], inner: tuple[int, int]
    ) -> None:
        self._video, self._pictures = video, pictures
        self._frame = np.zeros((size[1], size[0], 3), np.uint8)
        left, top = (size[0] - inner[0]) // 2, (size[1] - inner[1]) // 2
        self._place = slice(top, top + inner[1]), slice(left, left + inner[0])

    def __call__(self, time_s: float) -> Picture:
        """Return the picture at a time in seconds."""
        number, picture = _number(self._video, time_s), None
        while self._pictures.next <= number and (found := self._pictures.read()) is not None:
            picture = found
        if picture is not None:
            self._frame[self._place] = picture
        return self._frame


def _number(video: ImportedVideo, time_s: float) -> int:
    """Return the index of a video's picture at a performance time."""
    return max(math.floor((time_s - video.offset_s) * video.facts.rate + 1e-3), 0)
