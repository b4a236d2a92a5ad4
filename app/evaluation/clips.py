"""Clips of the variants with the same span, size, sound and camera, one file for each code."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any, Final, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from app.audio.track import RATE_HZ, Block
from app.errors import Message, Progress, StopRequested
from app.evaluation.imported_videos import ImportedVideo, pictures_of
from app.evaluation.request import EvaluationRequest
from app.export.video import video_into
from app.performance.cast import LeftOut, require_players
from app.performance.chunks import Posed
from app.performance.ensemble import Performance
from app.performance.span import FrameSpan

Picture = npt.NDArray[np.uint8]
Draw: TypeAlias = Callable[[float], Picture]
"""Function from a time in seconds to a picture (H, W, 3 or 4); times ascend."""

CRF: Final = 22
"""Rate factor of x264, chosen so that all clips fit on one page."""


class PerformanceRenderer(Protocol):
    """Protocol of a renderer for pictures of a performance, so that evaluations do not depend on the viewport."""

    @property
    def left_out(self) -> Sequence[LeftOut]:
        """Return the performers that could not be drawn so far."""
        ...

    def shows(self, player_ids: tuple[str, ...]) -> bool:
        """Return whether any of the given players can be drawn; without ids, whether any player can."""
        ...

    def film(
        self,
        size: tuple[int, int],
        span_s: tuple[float, float],
        view: Any,
        player_ids: tuple[str, ...],
        cameras: dict[float, Any] | None = None,
        marked: bool = True,
    ) -> Draw:
        """Return a function that draws the pictures of a film; arguments as of
        `widgets.viewport.offscreen.Offscreen.film`.
        """
        ...


Stages: TypeAlias = Callable[
    [Performance, str, StopRequested, Posed | None], AbstractContextManager[PerformanceRenderer]
]
"""Function from a performance and a theme to its renderer, with replaced poses if given."""


@dataclass(frozen=True, eq=False)
class ClipScene:
    """Scene of an excerpt, equal in every variant.

    Attributes
    ----------
    span : FrameSpan
        Frames of the excerpt.
    sound : (N, 2) float32
        Sound at `RATE_HZ`.
    cameras : dict of float to object
        Camera of each picture by time, set after one variant has been drawn.
    """

    span: FrameSpan
    sound: Block
    cameras: dict[float, Any]


def draw_ours(
    shown_on: AbstractContextManager[PerformanceRenderer],
    request: EvaluationRequest,
    files: Mapping[Path, ClipScene],
    wording: Callable[[Message], str],
    report: Progress,
) -> tuple[LeftOut, ...]:
    """Draw the clips of a variant that the program generates (possibly with replaced poses) into files, and return the
    performers that could not be drawn.

    Raises FileError if no performer can be drawn.
    """
    drawn = _drawn(files, report)
    with shown_on as stage:
        if not stage.shows(request.player_ids):
            require_players(stage.left_out, request.title, wording)
        for path, scene in files.items():
            span_s = (scene.span.first_frame_s, scene.span.end_s)
            draw = stage.film(request.size, span_s, request.view, request.player_ids, scene.cameras, marked=False)
            _write(path, scene, request.size, draw, drawn)
        return tuple(stage.left_out)


def cut_video(video: ImportedVideo, size: tuple[int, int], files: Mapping[Path, ClipScene], report: Progress) -> None:
    """Cut the excerpts from a video, and give them the sound that all variants share."""
    drawn = _drawn(files, report)
    for path, scene in files.items():
        with pictures_of(video, scene.span.first_frame_s, size) as draw:
            _write(path, scene, size, draw, drawn)


def _drawn(files: Mapping[Path, ClipScene], report: Progress) -> Callable[[], None]:
    """Return a function to be called after each picture, which then reports the completed share."""
    whole, done = sum(scene.span.count for scene in files.values()), count(1)
    return lambda: report(next(done) / whole)


def _write(path: Path, scene: ClipScene, size: tuple[int, int], draw: Draw, drawn: Callable[[], None]) -> None:
    span = scene.span
    step_s = span.fps.denominator / span.fps.numerator
    with video_into(path, size, span.fps, scene.sound, RATE_HZ, CRF) as film:
        for index in range(span.count):
            film.write(draw(span.first_frame_s + index * step_s))
            drawn()
