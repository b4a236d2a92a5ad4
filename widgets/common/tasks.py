"""What panels and commands ask of whoever runs slow work."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

from app.errors import AppError, Message

T = TypeVar("T")

Progress = Callable[[float], None]
"""Called with the share 0..1 that is done; may be called from the worker."""
StopRequested = Callable[[], bool]
"""Asked now and then by the worker; true stops the work."""


class Tasks(Protocol):
    """Runs work beside the window; shows its name and progress in the status line, where it can be cancelled."""

    def run(
        self,
        name: Message,
        work: Callable[[Progress, StopRequested], T],
        done: Callable[[T], None],
        failed: Callable[[AppError], None] | None = None,
        key: str | None = None,
        ended: Callable[[], None] | None = None,
    ) -> None:
        """Start work in a thread; ``done`` or ``failed`` follows in the window's thread.

        Parameters
        ----------
        name : Message
            What is being done.
        work : callable
            Gets progress and stop_wanted; it takes snapshots of values and touches no widget.
        done : callable
            Gets the result. Not called after a cancel.
        failed : callable, optional
            Gets an error the user can act on; without it the session shows it.
        key : str, optional
            Work with a key takes the place of work with the same key, which is stopped.
        ended : callable, optional
            Called in the window's thread when the work is over, however it went and before anything else is reported.
        """
        ...
