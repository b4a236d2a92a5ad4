"""``suisou edit``: the editor's command line. It is read here; the editor itself is started by `app.__main__`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Final

from app.cli.options import picture_size, seconds
from app.messages import LANGUAGES
from app.project.cameras import VIEWS

THEMES: Final = ("dark", "light")
LEAST_PX, MOST_PX = (960, 600), (7680, 4320)


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the sub-command."""
    command.description = "Opens the editor. With --screenshot it draws its window once, writes the picture and ends."
    command.add_argument(
        "file", type=Path, nargs="?", metavar="FILE", help="a project, a MIDI file or a score (MusicXML)"
    )
    command.add_argument("--screenshot", type=Path, metavar="OUT.png", help="write a picture of the window and end")
    command.add_argument(
        "--time", dest="time_s", type=seconds, default=0.0, metavar="S", help="where the playhead is (default 0)"
    )
    command.add_argument("--view", choices=VIEWS, default="", help="how the players are seen")
    command.add_argument(
        "--size",
        type=picture_size(LEAST_PX, MOST_PX),
        default=(1600, 1000),
        metavar="WxH",
        help="of the picture (default 1600x1000)",
    )
    command.add_argument("--language", choices=tuple(LANGUAGES), default="", help="of the editor")
    command.add_argument("--theme", choices=THEMES, default="", help="of the editor")
    command.set_defaults(run=None)
