"""Options of the command line that select bars of a piece."""

from __future__ import annotations

import argparse
from fractions import Fraction
from typing import TYPE_CHECKING

from app.cli.options import beats, whole_number
from app.errors import UsageError

if TYPE_CHECKING:
    from app.performance.ensemble import Performance
    from app.performance.span import FrameSpan


def add_bar_options(command: argparse.ArgumentParser) -> None:
    """Declare the options for the first and last bar."""
    command.add_argument("--from-bar", type=whole_number, metavar="N")
    command.add_argument("--to-bar", type=whole_number, metavar="N")


def add_lead_in_option(command: argparse.ArgumentParser) -> None:
    """Declare the option for the number of beats before the first bar."""
    command.add_argument("--lead-in", type=beats, metavar="BEATS")


def requested_bars(performance: Performance, arguments: argparse.Namespace) -> tuple[int, int] | None:
    """Return the first and last requested bar; None for the whole piece.

    Raises
    ------
    UsageError
        The piece lacks one of the bars, or the last is before the first.
    """
    if arguments.from_bar is None and arguments.to_bar is None:
        return None
    score = performance.project.score
    lowest = 0 if score.pickup_ticks else 1
    highest = score.last_bar
    first = lowest if arguments.from_bar is None else arguments.from_bar
    last = highest if arguments.to_bar is None else arguments.to_bar
    for bar in (arguments.from_bar, arguments.to_bar):
        if bar is not None and not lowest <= bar <= highest:
            raise UsageError("bars.no_bar", number=bar, lowest=lowest, highest=highest)
    if first > last:
        raise UsageError("bars.order", first=first, last=last)
    return first, last


def requested_span(performance: Performance, arguments: argparse.Namespace, fps: Fraction) -> FrameSpan:
    """Return the range of frames of the requested bars including the lead-in, or of all bars.

    Raises
    ------
    UsageError
        If the piece lacks one of the bars, the last is before the first, or a lead-in is requested without a first bar.
    """
    from app.performance.span import bars_span

    requested_bars(performance, arguments)
    if arguments.lead_in is not None and arguments.from_bar is None:
        raise UsageError("bars.lead_in")
    return bars_span(performance, fps, (arguments.from_bar, arguments.to_bar), arguments.lead_in or 0.0)
