"""The command line: parses arguments and runs sub-commands. Each sub-command is a module of this folder, loaded only
when it is used (`app.cli.commands`).

Exit status: see `app.cli.status`.
"""

from __future__ import annotations

import argparse
import io
import os
import signal
import sys
from collections.abc import Callable, Sequence
from functools import cache
from typing import Final

from app.cli.commands import (
    TWO_WORDS,
    CommandParser,
    TopFormatter,
    add_commands,
    add_language_option,
    explain,
    worded_argparse,
)
from app.cli.speech import command_first, error_sentence, requested_speech, said, speaking, spoken
from app.cli.status import BAD_INPUT, BAD_USE, DONE, STOPPED
from app.cli.terminal import interrupted_by, warn
from app.encoding import shown
from app.errors import AppError, UsageError
from app.formats.other_computers import agree
from app.version import program_version

EXAMPLES: Final = """\
  suisou edit quartet.mid
  suisou inspect quartet.mid
  suisou export quartet.mid --to out
  suisou export quartet.mid --to out --format fbx --fps 30 --from-bar 1 --to-bar 8
  suisou export pieces/ --to out --jobs 4
  suisou export quartet.mid --to out --set "*.amplitude=0.8" --set "trombone 1.posture=seated"
  suisou film quartet.mid --to hands.mp4 --view hands --player "Trumpet 1" --from-bar 1 --to-bar 4
  suisou film quartet.mid --sheet hands.png --every 0.1 --view hands --to-bar 2
  suisou evaluate quartet.mid --film concert.mp4 --to evaluation
  suisou evaluate results evaluation/answers-*.csv --to evaluation
  suisou midi session.suisou --to session.mid
  suisou align quartet.mid concert.flac --to concert.suisou
  suisou stream quartet.mid --player "Trumpet 1" --loop
  suisou instruments
  suisou instruments scale INSTRUMENT
  suisou metadata
  suisou metadata session.suisou --save session.toml
  suisou characters check figure.vrm
  suisou characters add figure.vrm --name "Ms Mori"
  suisou choreography learn --pair salsa.bvh drums.mid --fps 60 --to salsa.choreography
  suisou ports
  suisou record --port EWI --to take.mid --count-in 1 --tempo 96
"""


def parser() -> CommandParser:
    """Return the parser of the whole command line in the current language."""
    return _parser(spoken().language)


@cache
def _parser(language: str) -> CommandParser:
    top = CommandParser(
        prog="suisou",
        description=said("cli.description"),
        epilog=f"{said('cli.examples')}\n{EXAMPLES}",
        formatter_class=TopFormatter,
    )
    top.add_argument(
        "--version", action="version", version=f"suisou {program_version()}", help=said("cli.version_option")
    )
    add_language_option(top)
    explain(top)
    add_commands(top)
    return top


def main(arguments: Sequence[str]) -> int:
    """Run the program with these arguments (without its own name) and return the exit status."""
    _speak_utf8()
    with speaking(requested_speech(arguments)), worded_argparse():
        return _run(command_first(arguments))


def _run(arguments: Sequence[str]) -> int:
    for argument in arguments:
        # By naming a file on another computer the user agrees that it is accessed.
        agree(argument.partition("=")[2] if argument.startswith("--") else argument)
    broken = next((argument for argument in arguments if "\0" in argument), None)
    if broken is not None:
        return _fail(said("argument.with_nul", argument=broken), BAD_USE)
    try:
        parsed = parser().parse_args(_joined(arguments), argparse.Namespace(given=tuple(arguments)))
        if parsed.command is None:
            parser().print_help()
            return DONE
        run: Callable[[argparse.Namespace], int | None] = parsed.run
        with interrupted_by(signal.SIGINT):
            status = run(parsed)
        sys.stdout.flush()
    except SystemExit as stop:  # argparse: --help and --version exit with 0, incorrect arguments with 2
        return stop.code if isinstance(stop.code, int) else BAD_USE
    except UsageError as error:
        return _fail(error_sentence(error), BAD_USE)
    except AppError as error:
        return _fail(_with_file(error, parsed), BAD_INPUT)
    except KeyboardInterrupt:
        return _fail(said("cli.stopped"), STOPPED)
    except BrokenPipeError:
        # The reader of our output has ended (`| head`), which is no error. Python would report it again at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    return DONE if status is None else status


def _joined(arguments: Sequence[str]) -> list[str]:
    """Return the arguments with a command of two words joined to one."""
    first = " ".join(arguments[:2])
    return [first, *arguments[2:]] if first in TWO_WORDS else list(arguments)


_OTHERWISE_PLACED: Final = frozenset({"file", "folder", "host"})
"""Message arguments that name the file or place of an error themselves."""


def _with_file(error: AppError, parsed: argparse.Namespace) -> str:
    """Return an error's sentence preceded by the input file, if the sentence does not name a file."""
    sentence = error_sentence(error)
    if "file" not in parsed or not _OTHERWISE_PLACED.isdisjoint(error.message.arguments):
        return sentence
    return f"{shown(parsed.file)}: {sentence}"


def _fail(sentence: str, status: int) -> int:
    warn(sentence)
    return status


def _speak_utf8() -> None:
    """Write UTF-8 to pipes and files on every system, and the terminal's own encoding to a terminal; escape characters
    that it lacks.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(encoding=None if stream.isatty() else "utf-8", errors="backslashreplace")
