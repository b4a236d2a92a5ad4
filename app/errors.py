"""Exceptions and messages of the whole program.

Code below the command line and the window contains no texts: a message is an id with arguments, and the code that shows
it looks up the text (`app.messages`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeAlias

import msgspec

from app.encoding import shown

Argument: TypeAlias = str | int | float | bool
Progress: TypeAlias = Callable[[float], None]
"""Function that is called with the completed share of work, 0..1, possibly by the thread that does the work."""
StopRequested: TypeAlias = Callable[[], bool]
"""Function that work calls regularly; if it returns true, the work stops with `Cancelled`."""


class Message(msgspec.Struct, frozen=True, gc=False):
    """A message for the user: a warning, a reason, a problem.

    Attributes
    ----------
    id : str
        Id of the template: the name of an area, a dot, and the name of the message in it.
    arguments : dict of str to str, int, float or bool
        Values for the template (file, track, bar, note and so on). Texts are made readable (`app.encoding.shown`),
        since file names are among them and messages are stored, printed and displayed.
    """

    id: str
    arguments: dict[str, Argument] = {}

    def __post_init__(self) -> None:
        for value in self.arguments.values():
            if isinstance(value, str) and not (value.isascii() and value.isprintable()):
                break
        else:
            return  # The usual case; a plan has hundreds of thousands of messages.
        readable = {name: shown(value) if isinstance(value, str) else value for name, value in self.arguments.items()}
        msgspec.structs.force_setattr(self, "arguments", readable)


class AppError(Exception):
    """An error that the user can act on; any other exception raised by a parser is a bug.

    Parameters
    ----------
    id : str
        Message id, as in `Message`.
    **arguments
        Values for the message's template.
    """

    def __init__(self, id: str, /, **arguments: Argument) -> None:
        self.message = Message(id, arguments)
        detail = ", ".join(f"{key}={value!r}" for key, value in arguments.items())
        super().__init__(f"{id} ({detail})" if detail else id)


TOO_DEEP: Final = "lists or objects nested too deeply"
"""Detail for errors that a library reports in terms of Python's stack."""


def shortened(detail: object, most: int = 200) -> str:
    """Shorten a library's description of a fault for a message, since it may quote any amount of the file."""
    text = TOO_DEEP if isinstance(detail, RecursionError) else str(detail)
    return text if len(text) <= most else f"{text[: most - 1]}…"


class FileError(AppError):
    """A file cannot be read or written; ``file`` is always among the arguments."""


class MapError(AppError):
    """A table (instrument map, metadata, preset, settings) is invalid; the message names the file and the line or
    key.
    """


class UsageError(AppError):
    """A request is invalid, as with an unknown player, parameter or range."""


class Cancelled(AppError):
    """The user stopped the work; nothing half-finished is left."""


def raise_if_stopped(stop_requested: StopRequested) -> None:
    """Raise `Cancelled` if ``stop_requested`` returns True."""
    if stop_requested():
        raise Cancelled("work.stopped")


def stoppable(progress: Callable[[float], None], stop_requested: StopRequested) -> Callable[[float], None]:
    """Wrap a progress function so that it raises `Cancelled` if the work must stop."""

    def report(share: float) -> None:
        raise_if_stopped(stop_requested)
        progress(share)

    return report
