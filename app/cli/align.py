"""``suisou align``: gives a piece the tempo of a recording."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Final

from app.cli.options import LONGEST_S, add_file_options, bounded_number, open_project
from app.cli.progress import Progress
from app.cli.speech import said, sentence
from app.cli.terminal import say, warn
from app.errors import FileError, UsageError

if TYPE_CHECKING:
    from app.audio.followed_recording import Followed
    from app.project.model import Project
    from app.score.beat_following import Following

_MIDI: Final = (".mid", ".midi")
_PROJECT: Final = ".suisou"

_seconds = bounded_number(0.0, LONGEST_S, "quantity.seconds", float)


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou align``."""
    add_file_options(command)
    command.add_argument("recording", type=Path, metavar="RECORDING")
    command.add_argument("--from", dest="from_s", type=_seconds, metavar="S")
    command.add_argument("--until", dest="until_s", type=_seconds, metavar="S")
    command.add_argument("--notes", action="store_true")
    command.add_argument("--dynamics", action="store_true")
    command.add_argument("--stems", action="append", default=[], metavar="PLAYER=FILE")
    command.add_argument("--to", type=Path, required=True, metavar="OUT")
    command.set_defaults(run=align, settings=[])


def align(arguments: argparse.Namespace) -> None:
    """Find the beats of the recording, write the piece with its tempo, and print a report.

    Raises
    ------
    AppError
        The output is of an unsupported kind or is the input itself, a player is unknown, the given range is empty, or
        reading, writing or following the recording fails.
    """
    from app.audio.followed_recording import take_over
    from app.project.midi_out import export_midi
    from app.project.storage import save
    from instrument_maps.library import library

    target: Path = arguments.to
    kind = target.suffix.lower()
    if kind not in (_PROJECT, *_MIDI):
        raise UsageError("align.kind", file=str(target))
    if any(_same(target, one) for one in (arguments.file, arguments.recording)):
        raise FileError("align.onto_itself", file=str(target))
    project = open_project(arguments)
    followed = _follow(project, arguments)
    aligned = take_over(project, followed, arguments.recording)
    if kind == _PROJECT:
        save(aligned, target)
    else:
        for warning in export_midi(aligned, target, library().maps):
            warn(sentence(warning))
    _report(aligned, followed.following, target)


def _same(one: Path, other: Path) -> bool:
    try:
        return one.samefile(other)
    except OSError:
        return False  # the output file does not exist yet


def _follow(project: Project, arguments: argparse.Namespace) -> Followed:
    """Follow the recording, and return the result in seconds of the whole recording even if only a part was
    requested.
    """
    from app.audio.decode import decode
    from app.audio.followed_recording import FollowOptions, listen
    from app.audio.track import RATE_HZ

    stems = dict(_stem(project, text) for text in arguments.stems)
    options = FollowOptions(notes=arguments.notes, dynamics=arguments.dynamics or bool(stems), stems=stems)
    progress = Progress(sys.stderr)
    label = said("align.listening", file=arguments.recording.name)
    try:
        recording = decode(str(arguments.recording), lambda share: progress(0.2 * share, label))
        for warning in recording.warnings:
            warn(sentence(warning))
        first = round((arguments.from_s or 0.0) * RATE_HZ)
        last = len(recording.samples) if arguments.until_s is None else round(arguments.until_s * RATE_HZ)
        samples = recording.samples[first:last]
        if not len(samples):
            raise UsageError("align.nothing_between", file=str(arguments.recording), seconds=recording.duration_s)
        return listen(
            project,
            samples,
            arguments.recording,
            options,
            lambda share: progress(0.2 + 0.8 * share, label),
            begins_s=first / RATE_HZ,
        )
    finally:
        progress.clear()


def _stem(project: Project, given: str) -> tuple[str, str]:
    """Return the player id and path of ``PLAYER=FILE``; a player is given by name, or by number from 1 on."""
    name, _, path = given.partition("=")
    for number, player in enumerate(project.players, 1):
        if name.casefold() in (player.name.casefold(), player.id.casefold(), str(number)):
            return player.id, path
    raise UsageError("align.no_such_player", player=name, known=", ".join(one.name for one in project.players) or "-")


def _report(project: Project, following: Following, target: Path) -> None:
    """Print the written file, uncertain bars, and passages that only the piece or only the recording has."""
    from app.score.beat_following import bars_named

    changes = project.score.tempo_map.bpm
    say(
        said(
            "align.written",
            file=str(target),
            beats=len(following.ticks),
            slowest=min(bpm for _, bpm in changes),
            fastest=max(bpm for _, bpm in changes),
            start_s=_second_of_bar(project, following, 1),
            percent=round(100 * following.mean_confidence),
        )
    )
    runner_up = following.runner_up
    if runner_up is not None:
        start_s = _second_of_bar(project, following, 1) + runner_up.later_s
        percent = round(100 * runner_up.confidence)
        say(said("align.runner_up", start_s=start_s, later_s=runner_up.later_s, percent=percent))
    bar_of_tick = project.metre_map.bar_of_tick
    for span in following.missing:
        first, last = bar_of_tick(int(span.start)), bar_of_tick(max(int(span.end) - 1, int(span.start)))
        warn(said("align.bars_outside", **bars_named((first, last))))
    for span in following.added:
        warn(said("align.only_recorded", start_s=span.start, end_s=span.end))
    for first, last, percent in following.doubtful_bars(project.metre_map):
        warn(said("align.doubtful", percent=percent, **bars_named((first, last))))


def _second_of_bar(project: Project, following: Following, bar: int) -> float:
    tick = project.metre_map.tick_of_bar(bar)
    return float(project.score.tempo_map.seconds(float(tick)) + following.recording_s[0])
