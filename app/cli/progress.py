"""A line with the progress of work on a terminal; elsewhere a line for each grip that is computed."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from app.performance.ensemble import Performance
    from app.project.performers import Player

from app.cli.speech import said
from app.cli.terminal import say
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
    minutes for an instrument that can hardly be held; progress is printed on standard error: on a terminal as a line
    that is overwritten, elsewhere as a line for each grip whose computation begins.
    """
    chosen = {player.id for player in players}
    unheld = [player for player in performance.unheld if player.id in chosen]
    progress = Progress(sys.stderr)
    try:
        for number, player in enumerate(unheld):
            announced = _announcement(player, number + 1, len(unheld), sys.stderr)

            def reported(share: float, before: int = number, announced: Callable[[float], None] = announced) -> None:
                announced(share)
                progress((before + share) / len(unheld), said("cli.finding_grips"))

            performance.hold(progress=reported, players=[player])
    finally:
        progress.clear()


def _announcement(player: Player, number: int, count: int, stream: TextIO) -> Callable[[float], None]:
    """Return a function that is called with the completed share of a player's grip, and prints one line about it.

    Nothing is printed on a terminal, nor for a grip that is stored already, which is never partly done.
    """
    printed = stream.isatty()

    def announced(share: float) -> None:
        nonlocal printed
        if printed or share <= 0.0:
            return
        printed = True
        line = said(
            "cli.finding_grip_of",
            player=player.name,
            character=player.character_id,
            instrument=player.instrument_id,
            number=number,
            count=count,
        )
        say(line, stream=stream)

    return announced
