"""One line of progress on a terminal; silence elsewhere."""

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
    """Shows how far the work is, on one line that is written over.

    Parameters
    ----------
    stream : text stream
        Usually standard error. Nothing is written where it is not a terminal.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._active = stream.isatty()
        self._shown = ""
        self._last_s = -1.0

    def __call__(self, fraction: float, label: str) -> None:
        """Show ``fraction`` (0..1) done of the work that ``label`` names; at most ten times a second."""
        now_s = time.monotonic()
        if not self._active or (now_s - self._last_s < 0.1 and fraction < 1.0):
            return
        self._last_s = now_s
        line = cut(f"{round(100 * min(max(fraction, 0.0), 1.0)):3d} %  {shown(label)}", 78)
        self._stream.write(f"\r{on_left(line, width(self._shown))}")
        self._stream.flush()
        self._shown = line

    def clear(self) -> None:
        """Take the line away."""
        if self._shown:
            self._stream.write(f"\r{' ' * width(self._shown)}\r")
            self._stream.flush()
            self._shown = ""


def find_holds(performance: Performance, players: Iterable[Player]) -> None:
    """Find out how players hold their instruments, where it is not known yet. It takes seconds for each, and minutes
    for an instrument that can hardly be held: progress is shown on standard error."""
    progress = Progress(sys.stderr)
    try:
        performance.hold(progress=lambda share: progress(share, said("cli.finding_grips")), players=players)
    finally:
        progress.clear()
