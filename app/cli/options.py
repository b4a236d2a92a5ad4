"""Options shared by several sub-commands, types of their values, and opening the given project."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from fractions import Fraction
from pathlib import Path
from typing import Final, TypeVar

import msgspec

from app.cli.commands import fill_help
from app.cli.part_instruments import assign_message, unassigned_parts, with_instruments, with_pitches
from app.cli.speech import said, sentence
from app.cli.terminal import warn
from app.encoding import is_encoding, shown
from app.errors import FileError, Message, UsageError
from app.plan.generate import COME_UP_S, PREROLL_BEATS, PREROLL_LEAST_S
from app.project import limits
from app.project.casting import ConductorPlace, conductor_place
from app.project.choreography_files import bundled_choreographies
from app.project.dancer_settings import USUAL_NAME, setting_names, with_dancer_settings, with_dancers
from app.project.edit.outfits import with_outfits
from app.project.edit.piece import PieceSettings, piece_settings, set_piece_settings, set_preroll
from app.project.frame_rate import exact_number
from app.project.frame_rate import frame_rate as typed_rate
from app.project.importing import cleaning, import_project, usual_rows
from app.project.model import Project, map_choices, preroll_of_new, with_settings
from app.project.parameters import parameter_names, parse_settings
from app.project.storage import is_project_file, load
from app.rig.characters.character_library import characters
from app.score.read import read_contents
from instrument_maps.library import library
from instrument_maps.model import InstrumentMap
from metadata.library import metadata_library

_MOST_SHOWN = 40
"""Number of characters of an invalid number that are quoted in its error."""

N = TypeVar("N", int, float, Fraction)


def bounded_number(least: N, most: N, quantity: str, parse: Callable[[str], N]) -> Callable[[str], N]:
    """Return a function that parses an option's value as a number within bounds.

    Parameters
    ----------
    least, most : number
        Bounds, which are allowed themselves. NaN and infinity are always refused.
    quantity : str
        Text id that describes the number in errors, such as "a number of seconds".
    parse : callable
        `int`, `float` or `exact_number`; raises ValueError for invalid text.

    Returns
    -------
    callable
        Function for ``type=`` of `argparse`; raises ArgumentTypeError for text that is no such number.
    """

    def parsed(text: str) -> N:
        try:
            value = parse(text)
            possible = least <= value <= most
        except (ValueError, ZeroDivisionError, OverflowError):
            possible = False
        if not possible:
            bounds = {"least": _plain(least), "most": _plain(most)}
            raise argparse.ArgumentTypeError(said("cli.no_number", typed=_cut(text), quantity=said(quantity), **bounds))
        return value

    return parsed


def _cut(typed: str) -> str:
    """Return a typed text for an error that quotes it, shortened if it is long."""
    return typed if len(typed) <= _MOST_SHOWN else f"{typed[:_MOST_SHOWN]}..."


def _plain(number: float | Fraction) -> str:
    """Return a bound of an option as text, without needless digits."""
    return f"{number:g}" if isinstance(number, float) else str(number)


LONGEST_S: Final = 24 * 3600.0
"""Greatest length of a piece or recording in seconds: a day."""

frame_rate = bounded_number(*limits.FPS, "quantity.frame_rate", typed_rate)
whole_number = bounded_number(0, 2**63 - 1, "quantity.whole_number", int)
beats = bounded_number(*limits.PREROLL_BEATS, "quantity.beats", float)
section_intensity = bounded_number(*limits.SECTION_INTENSITY, "quantity.multiplier", float)
_felt_quarters = bounded_number(
    *limits.FELT_BEAT_QUARTERS,
    "quantity.felt_beat",
    lambda text: float(exact_number(text)),
)
_stage_m = bounded_number(*limits.STAGE_M, "quantity.metres", float)
AUTOMATIC: Final = "auto"
NO_CONDUCTOR: Final = "none"
USUAL_CONDUCTOR: Final = "usual"
seconds = bounded_number(-LONGEST_S, LONGEST_S, "quantity.seconds", float)
"""Type of an option in seconds of the performance, negative before the first beat."""


def picture_size(least_px: tuple[int, int], most_px: tuple[int, int]) -> Callable[[str], tuple[int, int]]:
    """Return a parser for option values such as ``1600x1000`` that refuses sizes outside the bounds.

    Both bounds are (width, height) in pixels.
    """

    def parsed(text: str) -> tuple[int, int]:
        width, _, height = text.partition("x")
        # Limited to the number of digits that `int` accepts.
        if not all(side.isascii() and side.isdecimal() and len(side) <= _MOST_SHOWN for side in (width, height)):
            raise argparse.ArgumentTypeError(said("cli.no_size", typed=_cut(text)))
        result = int(width), int(height)
        if not all(least <= value <= most for least, value, most in zip(least_px, result, most_px, strict=True)):
            bounds = {"least": f"{least_px[0]}x{least_px[1]}", "most": f"{most_px[0]}x{most_px[1]}"}
            raise argparse.ArgumentTypeError(said("cli.size_outside", typed=text, **bounds))
        return result

    return parsed


def felt_beat(text: str) -> float | str:
    """Parse the typed felt beat: a note value as a number of quarters, or `AUTOMATIC` to derive it from metre and
    tempo.
    """
    return AUTOMATIC if text.strip().casefold() == AUTOMATIC else _felt_quarters(text)


def conductor(text: str) -> ConductorPlace | str:
    """Parse the typed place of the conductor: a place on the stage, `USUAL_CONDUCTOR` or `NO_CONDUCTOR`."""
    place = text.strip().casefold()
    if place in (NO_CONDUCTOR, USUAL_CONDUCTOR):
        return place
    x, comma, z = place.partition(",")
    if not comma:
        raise argparse.ArgumentTypeError(said("cli.no_place", typed=_cut(text)))
    return ConductorPlace(_stage_m(x), _stage_m(z), on_stage=True)


def text_encoding(text: str) -> str:
    """Return the typed name of a text encoding, if Python knows it."""
    if not is_encoding(text):
        raise argparse.ArgumentTypeError(said("cli.no_encoding", typed=text))
    return text


def add_players_option(command: argparse.ArgumentParser) -> None:
    """Declare the repeatable option ``--player`` that selects players by name."""
    command.add_argument("--player", dest="players", action="append", default=[], metavar="NAME")


def add_file_options(command: argparse.ArgumentParser) -> None:
    """Declare the file and the options for reading it."""
    command.add_argument("file", type=Path, metavar="FILE")
    command.add_argument("--encoding", type=text_encoding, metavar="NAME")
    command.add_argument("--assign", action="append", default=[], metavar='"PART=INSTRUMENT"')
    command.add_argument("--written", action="append", default=[], metavar="PLAYER")
    command.add_argument("--sounding", action="append", default=[], metavar="PLAYER")
    takes = command.add_mutually_exclusive_group()
    takes.add_argument("--clean-takes", dest="clean_takes", action="store_const", const=True)
    takes.add_argument("--keep-takes", dest="clean_takes", action="store_const", const=False)


def add_source_options(command: argparse.ArgumentParser) -> None:
    """Declare the file and all options that influence its players."""
    add_file_options(command)
    settings = command.add_argument(
        "--set", dest="settings", action="append", default=[], metavar='"PLAYER.parameter=value"'
    )
    fill_help(settings, parameters=", ".join(parameter_names()), dancers=", ".join(setting_names()))
    dancers = command.add_argument("--dancer", dest="dancers", action="append", default=[], metavar='"[NAME=]DANCE"')
    fill_help(dancers, usual=USUAL_NAME, possible=", ".join(bundled_choreographies()) or "-")
    command.add_argument("--outfit", dest="outfits", action="append", default=[], metavar='"[NAME=]OUTFIT[,COLOUR...]"')
    command.add_argument("--seed", type=whole_number, metavar="N")
    preroll = command.add_argument("--preroll", type=beats, metavar="BEATS")
    fill_help(preroll, least_s=f"{PREROLL_LEAST_S:g}", usual=f"{PREROLL_BEATS:g}", come_up_s=f"{COME_UP_S:g}")
    command.add_argument("--felt-beat", type=felt_beat, metavar="QUARTERS")
    command.add_argument("--section-intensity", type=section_intensity, metavar="TIMES")
    command.add_argument("--conductor", type=conductor, metavar="PLACE")


def add_ignored_option(command: argparse.ArgumentParser) -> None:
    """Add the option that lists ignored problems."""
    command.add_argument("--ignored", action="store_true")


def add_title_option(command: argparse.ArgumentParser) -> None:
    """Declare the option for the piece's title, for commands that write it."""
    fill_help(command.add_argument("--title", metavar="TEXT"), most=limits.MOST_NAME)


def add_rate_option(command: argparse.ArgumentParser) -> None:
    """Declare the frame rate of the picture."""
    command.add_argument("--fps", type=frame_rate, metavar="RATE")


def open_project(arguments: argparse.Namespace, if_empty: str = "") -> Project:
    """Return the project in a file, or a new one for a MIDI file or score, with the command's options applied.

    Faulty instruments of the user, and parts of a MIDI file without an instrument, are reported and excluded; the
    report includes a command that assigns instruments to these parts.

    Parameters
    ----------
    if_empty : str
        Message id for a file without players or dancers; empty if the command does not need them.

    Raises
    ------
    AppError
        If the file cannot be read, the options do not fit it, no part has an instrument, or there are no players
        although the command needs them.
    """
    known = library()
    maps = known.maps
    for problems in known.problems.values():
        warn(sentence(problems[0]))
    for problems in metadata_library().problems.values():
        warn(sentence(problems[0]))
    project, message = _opened(arguments, maps)
    project = with_dancers(project, getattr(arguments, "dancers", ()))
    if if_empty and not project.performers:
        refused = _drums_only(arguments, project) or message or Message(if_empty, {"file": shown(arguments.file)})
        raise FileError(refused.id, **refused.arguments)
    if message is not None:
        warn(sentence(message))
    project, of_players = with_dancer_settings(project, arguments.settings, tuple(characters()))
    settings = parse_settings(of_players, [player.name for player in project.players], maps, tuple(characters()))
    found = set_piece_settings(project, _piece(arguments, project))
    if getattr(arguments, "preroll", None) is None and not is_project_file(arguments.file):
        # A new piece starts as early as a player needs to raise the instrument, rounded to its beat.
        found = set_preroll(found, preroll_of_new(found))
    return with_outfits(with_settings(found, settings, maps), getattr(arguments, "outfits", ()))


def _drums_only(arguments: argparse.Namespace, project: Project) -> Message | None:
    """Return a message about a piece of percussion only, to which a dancer can dance; None for other pieces."""
    known = bundled_choreographies()
    if not (known and project.score.percussion):
        return None
    return Message("dancer.drums_only", {"file": shown(arguments.file), "choreography": known[0]})


def _piece(arguments: argparse.Namespace, project: Project) -> PieceSettings:
    """Return the piece's settings changed by the typed options; options that the command does not declare change
    nothing.
    """
    asked = {
        "title": getattr(arguments, "title", None),
        "fps": getattr(arguments, "fps", None),
        "preroll_beats": getattr(arguments, "preroll", None),
        "felt_beat_quarters": getattr(arguments, "felt_beat", None),
        "seed": getattr(arguments, "seed", None),
        "section_intensity": getattr(arguments, "section_intensity", None),
        "conductor": getattr(arguments, "conductor", None),
    }
    given = {field: value for field, value in asked.items() if value is not None}
    if given.get("felt_beat_quarters") == AUTOMATIC:
        given["felt_beat_quarters"] = None
    if given.get("conductor") == NO_CONDUCTOR:
        given["conductor"] = None
    elif given.get("conductor") == USUAL_CONDUCTOR:
        place = conductor_place([player.stage for player in project.bodies])
        given["conductor"] = msgspec.structs.replace(place, on_stage=True)
    return msgspec.structs.replace(piece_settings(project), **given)


def _saved_project(arguments: argparse.Namespace) -> Project:
    if arguments.encoding is not None:
        raise UsageError("project.encoding", file=str(arguments.file))
    if arguments.written or arguments.sounding:
        raise UsageError("project.written", file=str(arguments.file))
    if arguments.clean_takes is not None:
        raise UsageError("project.takes", file=str(arguments.file))
    if arguments.assign:
        raise UsageError("project.assign", file=str(arguments.file))
    return load(arguments.file)


def _opened(arguments: argparse.Namespace, maps: Mapping[str, InstrumentMap]) -> tuple[Project, Message | None]:
    """Open a project or import a MIDI file.

    Returns
    -------
    (Project, Message or None)
        The project, and a message about parts without an instrument.
    """
    if is_project_file(arguments.file):
        return _saved_project(arguments), None
    contents, choices = read_contents(arguments.file, encoding=arguments.encoding), map_choices(maps.values())
    rows = with_instruments(contents.channels, usual_rows(contents, maps), arguments.assign, list(maps))
    if arguments.clean_takes is not None:
        rows = cleaning(rows, arguments.clean_takes)
    unassigned = unassigned_parts(contents.channels, rows, choices)
    for names, written in ((arguments.written, True), (arguments.sounding, False)):
        if names:
            rows = with_pitches(contents, rows, names, written, maps)
    seed = getattr(arguments, "seed", None) or 0
    source = str(arguments.file.absolute())
    project = import_project(contents, rows, maps, source, encoding=arguments.encoding, seed=seed)
    if unassigned:
        return project, assign_message(arguments, unassigned)
    others = () if project.performers else unassigned_parts(contents.channels, rows, choices, of_others=True)
    return project, assign_message(arguments, others, "assign.others") if others else None
