"""``suisou evaluate``: makes clips and a questionnaire by which viewers compare a performance with real players."""

from __future__ import annotations

import argparse
import os
import secrets
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Final

from app.cli.bars import add_bar_options, requested_bars
from app.cli.commands import fill_help
from app.cli.display import virtual, why_no_display
from app.cli.drawing import nearest, parsed_view, require_writable, stoppable
from app.cli.edit import THEMES
from app.cli.options import (
    add_players_option,
    add_source_options,
    bounded_number,
    frame_rate,
    open_project,
    picture_size,
    seconds,
    whole_number,
)
from app.cli.progress import Progress
from app.cli.speech import error_sentence, said, sentence
from app.cli.status import NO_DISPLAY, report_left_out
from app.cli.terminal import say, warn
from app.encoding import stored
from app.errors import AppError, Cancelled, UsageError
from app.evaluation.design import PRESENTATIONS
from app.evaluation.key import KEY_FILE, VARIANTS, Variant
from app.evaluation.request import (
    EXCERPTS,
    FPS,
    LEAST_S,
    MOST_EXCERPTS,
    MOST_S,
    SECONDS,
    SIZE,
    EvaluationRequest,
    variants_of,
)
from app.project.camera_bookmarks import VIEWS

if TYPE_CHECKING:
    from app.evaluation.make import Made
    from app.project.model import Project

LEAST_PX, MOST_PX = (64, 64), (1920, 1920)

_excerpts = bounded_number(1, MOST_EXCERPTS, "quantity.excerpts", int)
_length = bounded_number(LEAST_S, MOST_S, "quantity.seconds", float)


def variants(typed: str) -> tuple[Variant, ...]:
    """Return the variants of performances named in a text, separated by commas."""
    names = [name.strip().casefold() for name in typed.split(",") if name.strip()]
    found = tuple(variant for variant in VARIANTS if variant in names)
    unknown = [name for name in names if name not in VARIANTS]
    if unknown or not found:
        wrong = unknown[0] if unknown else typed
        raise argparse.ArgumentTypeError(said("cli.not_one_of", typed=wrong[:40], possible=", ".join(VARIANTS)))
    return found


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of the command that makes an evaluation."""
    add_source_options(command)
    command.add_argument("--to", type=Path, required=True, metavar="DIR")
    _add_variants_options(command)
    add_bar_options(command)
    _add_clip_options(command)
    command.add_argument("--draw", type=whole_number, metavar="N")
    command.add_argument("--theme", choices=THEMES, default=THEMES[0])
    command.set_defaults(run=evaluate)


def _add_variants_options(command: argparse.ArgumentParser) -> None:
    """Declare the options for the variants to compare."""
    command.add_argument("--film", type=Path, metavar="VIDEO")
    command.add_argument("--film-offset", type=seconds, metavar="S")
    command.add_argument("--follow-film", action="store_true")
    command.add_argument("--keyframes", type=Path, metavar="PATH")
    command.add_argument("--keyframes-offset", type=seconds, metavar="S")
    command.add_argument("--variants", type=variants, default=(), metavar="NAMES")


def _add_clip_options(command: argparse.ArgumentParser) -> None:
    """Declare the options for the clips and their appearance."""
    fill_help(command.add_argument("--excerpts", type=_excerpts, metavar="N"), usual=EXCERPTS)
    fill_help(command.add_argument("--seconds", type=_length, metavar="S"), usual=f"{SECONDS:g}")
    command.add_argument("--view", choices=VIEWS)
    add_players_option(command)
    command.add_argument("--presentation", choices=PRESENTATIONS, default="both")
    size = command.add_argument("--size", type=picture_size(LEAST_PX, MOST_PX), default=SIZE, metavar="WxH")
    fill_help(size, usual=f"{SIZE[0]}x{SIZE[1]}")
    fill_help(command.add_argument("--fps", dest="rate", type=frame_rate, metavar="RATE"), usual=FPS)


def evaluate(arguments: argparse.Namespace) -> int:
    """Write the evaluation, print the excluded players, and return the exit status."""
    from app.evaluation.make import make_evaluation
    from app.export.tree import clean_up

    _check_options(arguments)
    clean_up()
    project = open_project(arguments, if_empty="picture.no_players")
    request = _request(arguments, project)
    variants_of(request)
    require_writable(arguments.to, nearest(arguments.to))
    reason = why_no_display(what="'suisou evaluate'", instead=virtual("evaluate"))
    if reason is not None:
        warn(reason)
        return NO_DISPLAY
    # imports all of Qt
    from widgets.viewport.offscreen import offscreen

    progress = Progress(sys.stderr)
    with stoppable() as stop_requested:
        try:
            made = make_evaluation(
                project, request, offscreen, sentence, lambda share, at: progress(share, sentence(at)), stop_requested
            )
        except AppError as error:
            # ffmpeg received the same Ctrl-C and rejects further input.
            if stop_requested() or isinstance(error, Cancelled):
                raise KeyboardInterrupt from error
            if error.message.id not in ("picture.film_no_gl", "picture.no_gl"):
                raise
            warn(error_sentence(error))
            return NO_DISPLAY
        finally:
            progress.clear()
    _report(made)
    return report_left_out((one.player.name, sentence(one.reason)) for one in made.left_out)


def _check_options(arguments: argparse.Namespace) -> None:
    """Raise UsageError for options that do not fit each other, sizes of odd pixels, or a single variant."""
    needing: Final = (
        ("--film-offset", arguments.film_offset is not None, "--film", arguments.film),
        ("--follow-film", arguments.follow_film, "--film", arguments.film),
        ("--keyframes-offset", arguments.keyframes_offset is not None, "--keyframes", arguments.keyframes),
    )
    for option, given, needs, there in needing:
        if given and there is None:
            raise UsageError("picture.film_option", option=option, needs=needs)
    pairs = [("--film-offset", "--follow-film", arguments.film_offset is not None and arguments.follow_film)]
    bars = arguments.from_bar is not None or arguments.to_bar is not None
    for option, value in (("--excerpts", arguments.excerpts), ("--seconds", arguments.seconds)):
        pairs.append((option, "--from-bar/--to-bar", bars and value is not None))
    for option, other, both in pairs:
        if both:
            raise UsageError("evaluate.one_choice", option=option, other=other)
    if any(side % 2 for side in arguments.size):
        raise UsageError("picture.odd_size", width=arguments.size[0], height=arguments.size[1])


def _request(arguments: argparse.Namespace, project: Project) -> EvaluationRequest:
    view, player_ids = parsed_view(arguments, project)
    if arguments.view is None and not arguments.players and len(project.seen) == 1:
        view, player_ids = "front", (project.seen[0].id,)
    return EvaluationRequest(
        folder=stored(arguments.to),
        title=project.score.title or arguments.file.stem,
        film="" if arguments.film is None else stored(arguments.film),
        keyframes="" if arguments.keyframes is None else stored(arguments.keyframes),
        film_offset_s=arguments.film_offset,
        keyframes_offset_s=arguments.keyframes_offset,
        follow_film=arguments.follow_film,
        variants=arguments.variants,
        bars=_bars(arguments, project),
        excerpts=arguments.excerpts or EXCERPTS,
        excerpt_s=arguments.seconds or SECONDS,
        view=view,
        player_ids=player_ids,
        size=arguments.size,
        fps=(FPS, 1) if arguments.rate is None else arguments.rate.as_integer_ratio(),
        presentation=arguments.presentation,
        seed=secrets.randbits(31) if arguments.draw is None else arguments.draw,
        theme=arguments.theme,
    )


def _bars(arguments: argparse.Namespace, project: Project) -> tuple[int, int] | None:
    from app.performance.ensemble import Performance

    return requested_bars(Performance(project), arguments)


def _report(made: Made) -> None:
    clips = made.key.clips
    say(
        said(
            "evaluate.made",
            folder=str(made.folder),
            clips=len(clips),
            pairs=made.pairs,
            variants=len({clip.variant for clip in clips}),
            excerpts=len({clip.excerpt for clip in clips}),
            viewers=made.viewers,
        )
    )
    for excerpt in sorted({clip.excerpt for clip in clips}):
        clip = next(clip for clip in clips if clip.excerpt == excerpt)
        say(said("evaluate.excerpt", number=excerpt, from_s=clip.from_s, until_s=clip.until_s))
    if made.video is not None and made.video.confidence is not None:
        percent = round(100 * made.video.confidence)
        say(said("evaluate.film_placed", offset_s=made.video.offset_s, percent=percent))
    page = os.path.join(made.folder, "evaluation.html")  # noqa: PTH118 - as the user wrote the folder
    say(said("evaluate.give_page", page=page, key=KEY_FILE))
