"""``suisou edit``: options of the editor, which is started by `app.__main__`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Final

from app.cli.commands import add_language_option
from app.cli.options import picture_size, seconds
from app.project.camera_bookmarks import VIEWS

THEMES: Final = ("dark", "light")
LEAST_PX, MOST_PX = (960, 600), (7680, 4320)


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou edit``."""
    command.add_argument("file", type=Path, nargs="?", metavar="FILE")
    command.add_argument("--screenshot", type=Path, metavar="OUT.png")
    command.add_argument("--time", dest="time_s", type=seconds, default=0.0, metavar="S")
    command.add_argument("--view", choices=VIEWS, default="")
    command.add_argument("--size", type=picture_size(LEAST_PX, MOST_PX), default=(1600, 1000), metavar="WxH")
    add_language_option(command)
    command.add_argument("--theme", choices=THEMES, default="")
    command.set_defaults(run=None)
