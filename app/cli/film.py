"""``suisou film``: draws the viewport as a film, as pictures or as a contact sheet, without a window."""

from __future__ import annotations

import argparse
import math
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from msgspec import structs

from app.cli.bars import add_bar_options, add_lead_in_option, requested_span
from app.cli.commands import add_language_option, fill_help
from app.cli.display import virtual, why_no_display
from app.cli.drawing import kept_camera, nearest, parsed_view, require_writable, stoppable
from app.cli.edit import MOST_PX, THEMES
from app.cli.options import (
    add_players_option,
    add_source_options,
    bounded_number,
    frame_rate,
    open_project,
    picture_size,
)
from app.cli.progress import Progress, find_holds
from app.cli.speech import error_sentence, said, sentence, spoken
from app.cli.status import NO_DISPLAY, report_left_out
from app.cli.terminal import say, warn
from app.errors import AppError, Cancelled, FileError, Message, StopRequested, UsageError
from app.messages import text
from app.project.camera_bookmarks import VIEWS, CameraBookmark, View
from app.project.frame_rate import USUAL_FILM_RATE, exact_number, frame_rate_text

if TYPE_CHECKING:
    from app.export.pictures import PictureWriter
    from app.performance.ensemble import Performance
    from app.performance.span import FrameSpan

LEAST_PX: Final = (64, 64)
FILM_PX, SHEET_PX = (1280, 720), (320, 180)
USUAL_EVERY_S: Final = Fraction(1, 2)
MOST_COLUMNS: Final = 200
_VIEWS_OF_ALL: Final[tuple[View, ...]] = ("front", "side", "top")
"""Views that show all performers, dancers too, unless players are named; close-ups are of one."""

Kind: TypeAlias = Literal["mp4", "folder", "sheet"]

_every = bounded_number(Fraction(1, 120), Fraction(3600), "quantity.seconds", exact_number)
_columns = bounded_number(1, MOST_COLUMNS, "quantity.columns", int)


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou film``."""
    add_source_options(command)
    place = command.add_mutually_exclusive_group(required=True)
    place.add_argument("--to", type=Path, metavar="OUT")
    place.add_argument("--sheet", type=Path, metavar="OUT.png")
    seen = command.add_mutually_exclusive_group()
    seen.add_argument("--view", choices=VIEWS)
    seen.add_argument("--camera", metavar="NAME")
    add_players_option(command)
    add_bar_options(command)
    add_lead_in_option(command)
    size = command.add_argument("--size", type=picture_size(LEAST_PX, MOST_PX), metavar="WxH")
    fill_help(size, film=_size_text(FILM_PX), sheet=_size_text(SHEET_PX))
    fill_help(command.add_argument("--fps", dest="rate", type=frame_rate, metavar="RATE"), most=USUAL_FILM_RATE)
    command.add_argument("--marks", action="store_true")
    command.add_argument("--no-sound", action="store_true")
    fill_help(command.add_argument("--every", type=_every, metavar="S"), usual=float(USUAL_EVERY_S))
    command.add_argument("--columns", type=_columns, metavar="N")
    add_language_option(command)
    command.add_argument("--theme", choices=THEMES, default=THEMES[0])
    command.set_defaults(run=film)


def _size_text(size: tuple[int, int]) -> str:
    return f"{size[0]}x{size[1]}"


@dataclass(frozen=True, eq=False)
class _Film:
    """Settings of a film: the performance, the view, the moments and the output file.

    Attributes
    ----------
    kind : str
        ``sheet``, ``mp4`` or ``folder``.
    player_ids : tuple of str
        Ids of the players at whom the camera is directed; empty for all.
    columns : int
        Number of columns of a contact sheet.
    """

    arguments: argparse.Namespace
    kind: Kind
    performance: Performance
    view: View | CameraBookmark
    player_ids: tuple[str, ...]
    span: FrameSpan
    size: tuple[int, int]
    columns: int

    @property
    def path(self) -> Path:
        """Return the path of the video file or of the folder of pictures to write."""
        path: Path = self.arguments.sheet or self.arguments.to
        return path

    @property
    def step_s(self) -> float:
        """Return the time between frames in seconds."""
        return float(1 / self.span.fps)

    @property
    def times_s(self) -> list[float]:
        """Return the times of the frames in seconds."""
        return [self.span.first_frame_s + index * self.step_s for index in range(self.span.count)]


def film(arguments: argparse.Namespace) -> int:
    """Draw and write the film, print the excluded players, and return the exit status."""
    from app.export.tree import clean_up
    from app.performance.ensemble import Performance

    kind = _kind(arguments)
    _check_options(arguments, kind)
    clean_up()
    project = open_project(arguments, if_empty="picture.no_players")
    view, player_ids = parsed_view(arguments, project, of_all=_VIEWS_OF_ALL)
    seen = view if arguments.camera is None else kept_camera(project, arguments.camera)
    performance = Performance(project)
    span = shown_span(performance, arguments, kind)
    size = arguments.size or (SHEET_PX if kind == "sheet" else FILM_PX)
    columns = _columns_of_sheet(arguments, span)
    requested = _Film(arguments, kind, performance, seen, player_ids, span, size, columns)
    _check_target(requested)
    reason = why_no_display(what="'suisou film'", instead=virtual("film"))
    if reason is not None:
        warn(reason)
        return NO_DISPLAY
    find_holds(performance, project.players)
    with stoppable() as stop_requested:
        try:
            return _draw(requested, stop_requested)
        except AppError as error:
            # The encoder received the same Ctrl-C and rejects further input.
            if stop_requested() or isinstance(error, Cancelled):
                raise KeyboardInterrupt from error
            if error.message.id not in ("picture.film_no_gl", "picture.no_gl"):
                raise
            warn(error_sentence(error))
            return NO_DISPLAY


def _draw(film: _Film, stop_requested: StopRequested) -> int:
    """Draw the frames of a film and write them to the output, and return the exit status of the command."""
    # imports all of Qt
    from app.performance.cast import require_players
    from widgets.viewport.offscreen import offscreen

    span, size, count = film.span, film.size, film.span.count
    progress = Progress(sys.stderr)
    with offscreen(film.performance, film.arguments.theme, stop_requested) as viewport:
        if not viewport.shows(film.player_ids):
            require_players(viewport.left_out, str(film.arguments.file), sentence)
        try:
            with _WRITERS[film.kind](film, stop_requested) as writer:
                progress(0.0, said("drawing.preparing"))
                draw = viewport.film(
                    size, (span.first_frame_s, span.end_s), film.view, film.player_ids, marked=film.arguments.marks
                )
                for number, time_s in enumerate(film.times_s, start=1):
                    if stop_requested():
                        raise KeyboardInterrupt
                    writer.write(draw(time_s))
                    progress(number / count, said("drawing.frame", number=number, count=count))
        finally:
            progress.clear()
        left_out = viewport.left_out
    step = said("drawing.pace_sheet", step_s=film.step_s)
    pace = step if film.kind == "sheet" else said("drawing.pace", rate=frame_rate_text(span.fps))
    drawn = {"path": str(film.path), "size": _size_text(size), "pace": pace}
    say(said("drawing.written", count=count, first_s=film.times_s[0], last_s=film.times_s[-1], **drawn))
    return report_left_out((one.player.name, sentence(one.reason)) for one in left_out)


def _kind(arguments: argparse.Namespace) -> Kind:
    """Return the kind of output. Raises UsageError for an unsuitable suffix."""
    if arguments.sheet is not None:
        if arguments.sheet.suffix.lower() != ".png":
            raise UsageError("picture.sheet_ending", file=str(arguments.sheet))
        return "sheet"
    suffix = arguments.to.suffix.lower()
    if os.path.isdir(arguments.to):
        return "folder"
    if suffix == ".mp4":
        return "mp4"
    if suffix[1:].isalnum() and not suffix[1:].isdecimal():
        raise UsageError("picture.film_ending", file=str(arguments.to))
    return "folder"


def _check_options(arguments: argparse.Namespace, kind: Kind) -> None:
    """Raise UsageError for options that do not fit this kind of film, or sizes of odd pixels."""
    sheet_only = {"--every": arguments.every, "--columns": arguments.columns}
    for option, value in sheet_only.items():
        if value is not None and kind != "sheet":
            raise UsageError("picture.film_option", option=option, needs="--sheet")
    if arguments.rate is not None and kind == "sheet":
        raise UsageError("picture.film_option", option="--fps", needs="--to")
    if arguments.no_sound and kind != "mp4":
        raise UsageError("picture.film_option", option="--no-sound", needs="--to OUT.mp4")
    if kind == "mp4" and arguments.size is not None and any(side % 2 for side in arguments.size):
        raise UsageError("picture.odd_size", width=arguments.size[0], height=arguments.size[1])


def shown_span(performance: Performance, arguments: argparse.Namespace, kind: Kind) -> FrameSpan:
    """Return the range of frames of a film, or of the pictures of a sheet; the first is at the start of the requested
    bars.

    Raises
    ------
    UsageError
        If the piece lacks one of the bars, the last is before the first, or a lead-in is requested without a first bar.
    """
    fps = performance.project.fps
    if kind != "sheet":
        return requested_span(performance, arguments, arguments.rate or min(fps, USUAL_FILM_RATE))
    span, every_s = requested_span(performance, arguments, fps), arguments.every or USUAL_EVERY_S
    count = math.ceil(span.count / (fps * every_s))
    return structs.replace(span, fps=1 / every_s, first=0, count=count)


def _columns_of_sheet(arguments: argparse.Namespace, span: FrameSpan) -> int:
    from app.export.pictures import usual_columns

    return arguments.columns or usual_columns(span.count, 1 / span.fps)


def _check_target(film: _Film) -> None:
    """Raise UsageError or FileError before drawing if the sheet is too large, or the file or folder cannot be written
    or holds other frames.
    """
    from app.export.pictures import MOST_SHEET_PX, require_no_other_frames, sheet_size

    if film.kind == "folder":
        require_writable(film.path, nearest(film.path))
        require_no_other_frames(film.path, film.span.first, film.span.count)
        return
    _require_folder(film.path)
    width, height = sheet_size(film.size, 0, film.columns, film.span.count)
    if film.kind == "sheet" and max(width, height) > MOST_SHEET_PX:
        raise UsageError(
            "picture.sheet_too_large", count=film.span.count, width=width, height=height, most=MOST_SHEET_PX
        )


def _require_folder(path: Path) -> None:
    """Raise FileError before drawing if a file cannot be written at a path."""
    if os.path.isdir(path):
        raise FileError("file.cannot_write", file=str(path), reason="it is a folder")
    require_writable(path, path.parent)


@contextmanager
def _mp4(film: _Film, stop_requested: StopRequested) -> Iterator[PictureWriter]:
    from app.audio.mix import mixdown
    from app.export.video import SOUND_RATE_HZ, video_into

    span, samples = film.span, None
    if not film.arguments.no_sound:
        progress = Progress(sys.stderr)
        try:
            samples = mixdown(
                film.performance.project,
                span.first_frame_s,
                span.end_s,
                SOUND_RATE_HZ,
                lambda share: progress(share, said("drawing.sound")),
                stop_requested,
            )
        finally:
            progress.clear()
    with video_into(film.path, film.size, span.fps, samples) as video:
        yield video


@contextmanager
def _frames(film: _Film, stop_requested: StopRequested) -> Iterator[PictureWriter]:
    from app.export.pictures import frames_into

    with frames_into(film.path, film.span.first, film.span.count) as frames:
        yield frames


@contextmanager
def _sheet(film: _Film, stop_requested: StopRequested) -> Iterator[PictureWriter]:
    from app.export.pictures import sheet_into
    from widgets.viewport.offscreen import captions

    texts = caption_texts(film.performance, film.times_s, spoken().language)
    strips = captions(texts, film.size[0], film.arguments.theme)
    with sheet_into(film.path, film.size, film.columns, strips) as sheet:
        yield sheet


_WRITERS: Final = {"mp4": _mp4, "folder": _frames, "sheet": _sheet}


def caption_texts(performance: Performance, times_s: Sequence[float], language: str) -> list[tuple[str, str]]:
    """Return two caption texts for each moment: its time with the frame number at the project's frame rate, and its
    score position.
    """
    metres, fps = performance.project.score.metre_map, float(performance.project.fps)
    found = []
    for time_s in times_s:
        frame = round((time_s - performance.time_frame.first_frame_s) * fps)
        # Tempi are stored in whole microseconds, so a time on the beat is not exactly at a tick.
        tick = round(float(performance.piece.clock.ticks(time_s)))
        time_text = f"{time_s:.2f}".replace("-", "−")
        found.append((text(Message("picture.time", {"time": time_text, "frame": frame}), language), metres.label(tick)))
    return found
