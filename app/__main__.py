"""``python -m app``, and the installed command ``suisou``: a sub-command, or the editor.

Nothing of Qt is imported before it is known that the editor is wanted.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from argparse import Namespace

NO_DISPLAY = 1
NO_DISPLAY_TEXT = (
    "suisou: the editor needs a display and there is none (neither DISPLAY nor WAYLAND_DISPLAY is set). "
    "'suisou export' and 'suisou inspect' work without one; 'suisou --help' lists all commands."
)


def main() -> int:
    """Run with the process's arguments and return the exit status."""
    return run(sys.argv[1:])


def run(arguments: Sequence[str]) -> int:
    """Run with these arguments (without the program's own name) and return the exit status."""
    from app.cli import BAD_INPUT, BAD_USE, parser
    from app.cli import main as command_line

    if arguments and arguments[0] != "edit":
        return command_line(arguments)
    try:
        parsed = parser().parse_args(["edit", *arguments[1:]])
    except SystemExit as stop:  # argparse: --help ends with 0, bad use with 2
        return stop.code if isinstance(stop.code, int) else BAD_USE
    if display_missing():
        sys.stderr.write(f"{NO_DISPLAY_TEXT}\n")
        return NO_DISPLAY
    try:
        return edit(parsed)
    except KeyboardInterrupt:
        return BAD_INPUT


def edit(parsed: Namespace) -> int:
    """Start the editor as the command line says."""
    # Which sound libraries this system lacks is nothing a person can act on.
    os.environ.setdefault("QT_LOGGING_RULES", "qt.multimedia.symbolsresolver=false;qt.multimedia.ffmpeg=false")
    from app.cli import BAD_INPUT
    from app.errors import AppError
    from app.messages import error_text
    from app.shell.app import Start
    from app.shell.app import run as run_editor

    start = Start(
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
        sys.stderr.write(f"suisou: {error_text(error)}\n")
        return BAD_INPUT


def display_missing() -> bool:
    """Whether this is a system of displays without one; asked before Qt, which would end the process."""
    if not sys.platform.startswith("linux"):
        return False
    if os.environ.get("QT_QPA_PLATFORM", "").partition(":")[0] in ("offscreen", "minimal", "vnc", "eglfs", "linuxfb"):
        return False
    return not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


if __name__ == "__main__":
    sys.exit(main())
