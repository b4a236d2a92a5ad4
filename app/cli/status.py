"""Exit statuses, and the report of excluded players."""

from __future__ import annotations

import signal
from collections.abc import Iterable
from typing import Final

from app.cli.speech import said
from app.cli.terminal import warn

DONE: Final = 0
BAD_INPUT: Final = 1
"""Exit status: a file is faulty or cannot be written, and nothing was done."""
BAD_USE: Final = 2
NO_DISPLAY: Final = 3
"""Exit status: the editor, or a film, needs a display and there is none."""
PARTIAL: Final = 4
"""Exit status: finished, but players or pairs were excluded, or a take was written to another folder than requested."""
STOPPED: Final = 128 + signal.SIGINT
"""Exit status: stopped by Ctrl-C."""


def report_left_out(left_out: Iterable[tuple[str, str]]) -> int:
    """Print the excluded players with the reasons on stderr, one per line, and return the exit status."""
    status = DONE
    for player, reason in left_out:
        warn(said("player.left_out", player=player, reason=reason))
        status = PARTIAL
    return status
