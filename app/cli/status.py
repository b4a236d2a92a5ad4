"""Exit statuses, and the report of excluded players."""

from __future__ import annotations

import signal
from collections.abc import Iterable
from typing import Final

from app.cli.speech import said
from app.cli.terminal import warn

DONE: Final = 0
BAD_INPUT: Final = 1
"""A file is wrong or cannot be written: nothing was done."""
BAD_USE: Final = 2
NO_DISPLAY: Final = 3
"""The editor has nowhere to open, or a film cannot be drawn."""
PARTIAL: Final = 4
"""Done, but players or pairs were excluded, or a take lies elsewhere than asked."""
STOPPED: Final = 128 + signal.SIGINT
"""Stopped with Ctrl-C."""


def report_left_out(left_out: Iterable[tuple[str, str]]) -> int:
    """Name the excluded players with the reasons, a line for each on stderr; the exit status."""
    status = DONE
    for player, reason in left_out:
        warn(said("player.left_out", player=player, reason=reason))
        status = PARTIAL
    return status
