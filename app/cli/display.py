"""Check for a display before Qt is imported, which would end the process. Does not import Qt."""

from __future__ import annotations

import os
import re
import shlex
import socket
import sys
from collections.abc import Mapping
from importlib.resources import as_file, files
from pathlib import Path
from typing import Final

from app.cli.speech import said

WITHOUT: Final = ("offscreen", "minimal", "minimalegl", "vnc", "eglfs", "linuxfb")
"""Platforms of Qt that need no display server."""
X_PORT: Final = 6000
ANSWER_S: Final = 3.0
_DISPLAY = re.compile(r"^(?:(?P<host>[^:/]*)(?:/\w+)?|(?P<path>/.*)):(?P<number>\d+)(?:\.\d+)?$")


def virtual(command: str) -> str:
    """Return advice on drawing without a display by running a command on a virtual display."""
    return said("cli.virtual_display", command=command)


def why_no_display(
    environment: Mapping[str, str] = os.environ,
    platform: str = sys.platform,
    what: str = "",
    instead: str = "",
) -> str | None:
    """Return the reason why the editor or a film cannot be drawn, as a sentence for the command line; None if it can.

    Parameters
    ----------
    what, instead : str
        Name of the task that needs a display, and a command that needs none; by default the editor, and the other
        commands.
    """
    if not platform.startswith("linux") or environment.get("QT_QPA_PLATFORM", "").partition(":")[0] in WITHOUT:
        return None
    what, instead = what or said("cli.editor"), instead or said("cli.without_display")
    display, wayland = environment.get("DISPLAY", ""), environment.get("WAYLAND_DISPLAY", "")
    if not display and not wayland:
        return said("cli.no_display", what=what, instead=instead)
    if (wayland and _answers(_wayland_socket(wayland, environment))) or (display and _x_answers(display)):
        return None
    asked = ", ".join(filter(None, (wayland, display)))
    return said("cli.silent_display", what=what, asked=asked, instead=instead)


def example_hint() -> str:
    """Return a command line that exports the example to files, for systems on which the editor cannot open."""
    with as_file(files("resources") / "examples" / "quartet.mid") as path:
        command = f"suisou export {shlex.quote(str(path.absolute()))} --to out"
    return said("cli.example_hint", command=command)


def _wayland_socket(name: str, environment: Mapping[str, str]) -> Path:
    return Path(environment.get("XDG_RUNTIME_DIR", "/")) / name


def _x_answers(display: str) -> bool:
    found = _DISPLAY.match(display)
    if found is None or found["path"]:
        # Other systems have other rules, which Qt applies.
        return True
    number = int(found["number"])
    if found["host"] in ("", "unix"):
        path = f"/tmp/.X11-unix/X{number}"
        return _answers(Path(path)) or _answers(Path(f"\0{path}"))
    try:
        with socket.create_connection((found["host"], X_PORT + number), ANSWER_S):
            return True
    except OSError:
        return False


def _answers(path: Path) -> bool:
    try:
        with socket.socket(socket.AF_UNIX) as connection:
            connection.settimeout(ANSWER_S)
            connection.connect(str(path))
            return True
    except (OSError, ValueError):
        return False
