"""Entry point of ``python -m app`` and of the command ``suisou``: runs a sub-command or the editor.

Qt is imported only after the editor is known to be requested.
"""

from __future__ import annotations

import os
import signal
import sys

from app.score.suffixes import MUSIC

TYPE_CHECKING = False
if TYPE_CHECKING:
    from argparse import Namespace
    from collections.abc import Sequence
    from types import FrameType

UTF8_MODE = "PYTHONUTF8"
"""Environment variable of Python's UTF-8 mode."""
OPENED = (".suisou", *MUSIC)
"""Suffixes of files that open in the editor if given without a command, as a desktop does."""


def main() -> int:
    """Run the program with the process's arguments, and return the exit status."""
    # Ctrl-C ends the program at once while modules load, since nothing needs cleanup yet. The commands and the editor
    # install handlers of their own.
    signal.signal(signal.SIGINT, end_at_once)
    if sys.getfilesystemencoding() != "utf-8" and os.environ.get(UTF8_MODE) != "1":
        begin_again_in_utf8()
    status = run(sys.argv[1:])
    if status == 128 + signal.SIGINT:
        # Python would exit with the signal's status if KeyboardInterrupt was raised within `exec` (in generated code of
        # a dataclass, for example), even if it was caught.
        sys.stdout.flush()
        os._exit(status)
    # The work is done; Python calls no signal handlers during its own shutdown.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    return status


def begin_again_in_utf8() -> None:
    """Restart this process in a mode in which Python's file names are UTF-8 regardless of the locale, as in Qt; a
    terminal keeps its encoding.
    """
    encoding = {"PYTHONIOENCODING": f"{sys.stderr.encoding}:backslashreplace"} if sys.stderr.isatty() else {}
    os.execve(sys.executable, sys.orig_argv, {**os.environ, UTF8_MODE: "1", **encoding})


def end_at_once(number: int, frame: FrameType | None) -> None:
    """Signal handler that ends the process without output, with the exit status of a program killed by the signal."""
    os._exit(128 + number)


def run(arguments: Sequence[str]) -> int:
    """Run the program with arguments (without its own name), and return the exit status."""
    from pathlib import Path

    from app.cli import main as command_line
    from app.cli import parser
    from app.cli.commands import worded_argparse
    from app.cli.speech import command_first, requested_speech, said, speaking
    from app.cli.status import BAD_USE, NO_DISPLAY
    from app.cli.terminal import warn

    requested = command_first(arguments)
    if not requested or requested[0].startswith("--language") or requested[0].lower().endswith(OPENED):
        requested.insert(0, "edit")
    with speaking(requested_speech(requested)), worded_argparse():
        if requested[0] != "edit":
            if Path(requested[0]).suffix and not requested[0].startswith("-"):
                warn(said("file.cannot_open", file=requested[0], kinds=", ".join(OPENED)))
                return BAD_USE
            return command_line(requested)
        from app.cli.display import example_hint, why_no_display

        try:
            parsed = parser().parse_args(requested)
        except SystemExit as stop:  # argparse: --help ends with 0, bad use with 2
            return stop.code if isinstance(stop.code, int) else BAD_USE
        reason = why_no_display()
        if reason is not None:
            warn(reason)
            if parsed.file is None:
                warn(example_hint())
            return NO_DISPLAY
        return edit(parsed)


def edit(parsed: Namespace) -> int:
    """Start the editor with the options of the command line."""
    # A warning about sound libraries missing on this system would not help the user.
    os.environ.setdefault("QT_LOGGING_RULES", "qt.multimedia.symbolsresolver=false;qt.multimedia.ffmpeg=false")
    from app.cli.speech import error_sentence
    from app.cli.status import BAD_INPUT, BAD_USE, STOPPED
    from app.cli.terminal import warn
    from app.errors import AppError, UsageError
    from app.shell.app import LaunchOptions
    from app.shell.app import run as run_editor

    start = LaunchOptions(
        file=parsed.file,
        screenshot=parsed.screenshot,
        time_s=parsed.time_s,
        view=parsed.view,
        language=parsed.language,
        theme=parsed.theme,
        size=parsed.size,
    )
    try:
        return run_editor(start)
    except AppError as error:
        warn(error_sentence(error))
        return BAD_USE if isinstance(error, UsageError) else BAD_INPUT
    except KeyboardInterrupt:
        return STOPPED


if __name__ == "__main__":
    sys.exit(main())
