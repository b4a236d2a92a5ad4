"""A line with the progress of work on a terminal; nothing is printed elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from app.performance.ensemble import Performance
    from app.project.performers import Player

from app.cli.speech import said
from app.cli.widths import cut, on_left, width
from app.encoding import shown


class Progress:
    """Prints the progress of work on a line that is overwritten.

    Parameters
    ----------
    stream : text stream
        Usually standard error. Nothing is written if it is not a terminal.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._active = stream.isatty()
        self._shown = ""
        self._last_s = -1.0

    def __call__(self, fraction: float, label: str) -> None:
        """Print the completed share ``fraction`` (0..1) of the work ``label``, at most ten times a second."""
        now_s = time.monotonic()
        if not self._active or (now_s - self._last_s < 0.1 and fraction < 1.0):
            return
        self._last_s = now_s
        line = cut(f"{round(100 * min(max(fraction, 0.0), 1.0)):3d} %  {shown(label)}", 78)
        self._stream.write(f"\r{on_left(line, width(self._shown))}")
        self._stream.flush()
        self._shown = line

    def clear(self) -> None:
        """Erase the progress line from the terminal."""
        if self._shown:
            self._stream.write(f"\r{' ' * width(self._shown)}\r")
            self._stream.flush()
            self._shown = ""


def find_holds(performance: Performance, players: Iterable[Player]) -> None:
    """Compute the grips of players on their instruments that are not known yet. This takes seconds for each, and
    minutes for an instrument that can hardly be held; progress is printed on standard error.
    """
    progress = Progress(sys.stderr)
    try:
        performance.hold(progress=lambda share: progress(share, said("cli.finding_grips")), players=players)
    finally:
        progress.clear()
