"""What a person types, as values: frame rates, bars, players."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias

import msgspec

from app.errors import UsageError
from app.messages import text as worded
from app.plan.generate import PREROLL_BEATS, PREROLL_LEAST_S
from app.project.model import Project, map_choices, project_from_score, with_settings
from app.project.names import unique_names
from app.project.parameters import parameter_names, parse_settings, select_players
from app.project.storage import is_project_file, load
from app.rig.character_library import characters
from app.score.choose import MapChoice
from app.score.model import Score
from app.score.parts import usual_wishes
from app.score.read import read_contents, wished_score
from instrument_maps.library import library
from instrument_maps.model import InstrumentMap

Commands: TypeAlias = "argparse._SubParsersAction[argparse.ArgumentParser]"
"""Where a sub-command declares itself."""

LOWEST_FPS = 1
HIGHEST_FPS = 240
_PULLED_DOWN = (24, 30, 48, 60, 120)
"""Nominal rates that television slows by 1000/1001; 29.97 means 30000/1001 and not 2997/100."""


def frame_rate(text: str) -> Fraction:
    """Frames per second from ``60``, ``29.97`` or ``30000/1001``.

    Raises
    ------
    argparse.ArgumentTypeError
        Not a rate between 1 and 240.
    """
    try:
        rate = Fraction(text.strip())
    except (ValueError, ZeroDivisionError):
        raise argparse.ArgumentTypeError(f"{text!r} is not a frame rate such as 24, 29.97 or 30000/1001") from None
    if "/" not in text:
        for nominal in _PULLED_DOWN:
            pulled_down = Fraction(nominal * 1000, 1001)
            # The usual short forms keep two or three decimals: 23.98, 23.976, 29.97, 59.94.
            if abs(rate - pulled_down) < Fraction(1, 200):
                rate = pulled_down
    if not LOWEST_FPS <= rate <= HIGHEST_FPS:
        raise argparse.ArgumentTypeError(f"{text!r} is not between {LOWEST_FPS} and {HIGHEST_FPS} frames per second")
    return rate


def frame_rate_text(rate: Fraction) -> str:
    """``60`` or ``30000/1001``."""
    return str(rate.numerator) if rate.denominator == 1 else f"{rate.numerator}/{rate.denominator}"


def whole_number(text: str) -> int:
    """A whole number of at least 0."""
    try:
        number = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None
    if not 0 <= number < 2**63:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 0 on")
    return number


def beats(text: str) -> float:
    """A finite number of beats, 0 to 64."""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not 0.0 <= number <= 64.0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of beats from 0 to 64")
    return number


def felt_beat(text: str) -> float:
    """The length of a felt beat in quarters, 1/16 to 16; also as a fraction."""
    try:
        number = float(Fraction(text.strip()))
    except (ValueError, ZeroDivisionError, OverflowError):
        number = math.nan
    if not 1 / 16 <= number <= 16.0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a length in quarters such as 1, 1.5 or 1/2")
    return number


def text_encoding(text: str) -> str:
    """The name of an encoding that turns bytes into text."""
    try:
        b"ab".decode(text, errors="replace")  # looks it up; nothing is asked of an empty text
    except (LookupError, ValueError):
        raise argparse.ArgumentTypeError(f"{text!r} is not the name of a text encoding") from None
    return text


def add_file_options(command: argparse.ArgumentParser) -> None:
    """Declare the file and how it is read."""
    command.add_argument("file", type=Path, metavar="FILE", help="a Standard MIDI File or a .suisou project")
    command.add_argument(
        "--encoding",
        type=text_encoding,
        metavar="NAME",
        help="of a MIDI file's texts (default: each is UTF-8 if it can be, else CP932, else Latin-1)",
    )
    command.add_argument(
        "--written",
        action="append",
        default=[],
        metavar="PLAYER",
        help="a MIDI file has this player's pitches as they are written for a transposing instrument, not as they "
        "sound; PLAYER may be a pattern such as '*sax*'; repeatable",
    )


def add_source_options(command: argparse.ArgumentParser) -> None:
    """Declare the file and everything that decides what its players do."""
    add_file_options(command)
    command.add_argument(
        "--set",
        dest="settings",
        action="append",
        default=[],
        metavar='"PLAYER.parameter=value"',
        help=f"set a player's parameter; PLAYER may be a pattern such as '*'; repeatable. "
        f"Parameters: {', '.join(parameter_names())}",
    )
    command.add_argument(
        "--seed", type=whole_number, metavar="N", help="another performance (default: the project's, 0)"
    )
    command.add_argument(
        "--preroll",
        type=beats,
        metavar="BEATS",
        help=f"beats before the first note, at least {PREROLL_LEAST_S:g} s (default: the project's, {PREROLL_BEATS:g})",
    )
    command.add_argument(
        "--felt-beat",
        type=felt_beat,
        metavar="QUARTERS",
        help="length of the beat that the players feel: 1.5 for a fast 6/8, 2 for alla breve (default: the project's, "
        "1); breaths, cues, sway and the pre-roll count in it",
    )


def open_project(arguments: argparse.Namespace) -> Project:
    """The project that a file holds, or a MIDI file with its players cast; what the options say comes on top. What is
    wrong with a person's own instruments is said, and those are left out.

    Raises
    ------
    AppError
        Those of reading, and `UsageError` of what makes no sense, ``project.encoding`` (file) and
        ``project.written`` (file) among them.
    """
    known = library()
    maps = known.maps
    for problems in known.problems.values():
        print(f"suisou: {worded(problems[0])}", file=sys.stderr)
    project = _saved_project(arguments) if is_project_file(arguments.file) else _cast_project(arguments, maps)
    settings = parse_settings(
        arguments.settings, [player.name for player in project.players], maps, tuple(characters())
    )
    return with_settings(project, settings, maps)


def _saved_project(arguments: argparse.Namespace) -> Project:
    if arguments.encoding is not None:
        raise UsageError("project.encoding", file=str(arguments.file))
    if arguments.written:
        raise UsageError("project.written", file=str(arguments.file))
    project = load(arguments.file)
    asked = {
        "seed": arguments.seed,
        "preroll_beats": arguments.preroll,
        "felt_beat_quarters": arguments.felt_beat,
    }
    return replace(project, **{field: value for field, value in asked.items() if value is not None})


def _cast_project(arguments: argparse.Namespace, maps: Mapping[str, InstrumentMap]) -> Project:
    return project_from_score(
        _read_score(arguments, map_choices(maps.values())),
        maps,
        seed=arguments.seed or 0,
        preroll_beats=PREROLL_BEATS if arguments.preroll is None else arguments.preroll,
        felt_beat_quarters=1.0 if arguments.felt_beat is None else arguments.felt_beat,
    )


def _read_score(arguments: argparse.Namespace, maps: Sequence[MapChoice]) -> Score:
    """The score of a MIDI file, with the pitches that are written ones transposed."""
    contents = read_contents(arguments.file, encoding=arguments.encoding)
    wishes = usual_wishes(contents.streams, maps)
    score = wished_score(contents, wishes, maps)
    if not arguments.written:
        return score
    chosen = select_players(arguments.written, unique_names(part.name for part in score.parts))
    places = {(score.parts[index].track, score.parts[index].channel) for index in chosen}
    streams = [contents.streams[wish.streams[0]] for wish in wishes]
    asked = [
        msgspec.structs.replace(wish, written=(stream.track, stream.channel) in places)
        for wish, stream in zip(wishes, streams, strict=True)
    ]
    return wished_score(contents, asked, maps)
