"""Clips of the variants: the same seconds, size, sound and camera, one file for each code."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from app.audio.track import RATE_HZ, Block
from app.errors import raise_if_stopped
from app.evaluation.imported_videos import ImportedVideo, pictures_of
from app.evaluation.key import Variant
from app.evaluation.variants import performance_of
from app.export.video import video_into
from app.performance.cast import LeftOut
from app.performance.chunks import Posed
from app.performance.ensemble import Performance
from app.performance.span import FrameSpan
from app.project.model import Project

Picture = npt.NDArray[np.uint8]
Draw: TypeAlias = Callable[[float], Picture]
"""Time in seconds to a picture (H, W, 3 or 4); times ascend."""
StopRequested: TypeAlias = Callable[[], bool]
Report: TypeAlias = Callable[[float], None]

CRF: Final = 22
"""x264's rate factor: all clips are part of one page."""


class PerformanceRenderer(Protocol):
    """Renderer of a performance's pictures."""

    @property
    def left_out(self) -> Sequence[LeftOut]:
        """Who cannot be seen, as far as pictures were drawn."""
        ...

    def shows(self, player_ids: tuple[str, ...]) -> bool:
        """Whether any of these players can be seen; of all where none is named."""
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
        """What draws a film: see `widgets.viewport.offscreen.Offscreen.film`."""
        ...


Stages: TypeAlias = Callable[
    [Performance, str, StopRequested, Posed | None], AbstractContextManager[PerformanceRenderer]
]
"""A performance and a theme to what draws it, with other poses than the performance's where there are some."""


@dataclass(frozen=True, eq=False)
class ClipScene:
    """What is shown of an excerpt, the same in every variant.

    Attributes
    ----------
    span : FrameSpan
    sound : (N, 2) float32
        At `RATE_HZ`.
    cameras : dict of float to object
        Of the pictures, once one variant has been drawn.
    """

    span: FrameSpan
    sound: Block
    cameras: dict[float, Any]


@dataclass(frozen=True)
class Framing:
    """How clips are drawn."""

    view: str
    player_ids: tuple[str, ...]
    size: tuple[int, int]
    theme: str


def draw_ours(
    project: Project,
    variant: Variant,
    framing: Framing,
    files: Mapping[Path, ClipScene],
    stages: Stages,
    report: Report,
    stop_requested: StopRequested,
    refuse: Callable[[Sequence[LeftOut]], None],
    posed: Posed | None = None,
) -> tuple[LeftOut, ...]:
    """Draw a variant of ours, or with other poses than ours, into files; who could not be drawn.

    ``refuse`` is called where no one can be drawn; it raises.
    """
    performance = performance_of(project, variant)
    shares = _Shares(files, report)
    with stages(performance, framing.theme, stop_requested, posed) as stage:
        if not stage.shows(framing.player_ids):
            refuse(stage.left_out)
        for path, scene in files.items():
            span_s = (scene.span.first_frame_s, scene.span.end_s)
            draw = stage.film(framing.size, span_s, framing.view, framing.player_ids, scene.cameras, marked=False)
            _write(path, scene, framing.size, draw, shares, stop_requested)
        return tuple(stage.left_out)


def cut_video(
    video: ImportedVideo,
    size: tuple[int, int],
    files: Mapping[Path, ClipScene],
    report: Report,
    stop_requested: StopRequested,
) -> None:
    """Cut the excerpts out of a video, with the sound of all variants."""
    shares = _Shares(files, report)
    for path, scene in files.items():
        with pictures_of(video, scene.span.first_frame_s, size) as draw:
            _write(path, scene, size, draw, shares, stop_requested)


class _Shares:
    """Counts pictures."""

    def __init__(self, files: Mapping[Path, ClipScene], report: Report) -> None:
        self._count = sum(scene.span.count for scene in files.values())
        self._done, self._report = 0, report

    def step(self) -> None:
        self._done += 1
        self._report(self._done / self._count)


def _write(
    path: Path, scene: ClipScene, size: tuple[int, int], draw: Draw, shares: _Shares, stop_requested: StopRequested
) -> None:
    span = scene.span
    step_s = span.fps.denominator / span.fps.numerator
    with video_into(path, size, span.fps, scene.sound, RATE_HZ, CRF) as film:
        for index in range(span.count):
            raise_if_stopped(stop_requested)
            film.write(draw(span.first_frame_s + index * step_s))
            shares.step()
