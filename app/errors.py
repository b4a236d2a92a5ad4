"""The error family and the messages of the whole program.

Below the command line and the shell nothing is worded: a message is an id plus arguments, and the code that
shows it words it (English templates in `app.messages`, which the editor translates).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeAlias

import msgspec

from app.encoding import shown

Argument: TypeAlias = str | int | float | bool
Progress: TypeAlias = Callable[[float], None]
"""Called with the share 0..1 of work that is done, perhaps by its thread."""
StopRequested: TypeAlias = Callable[[], bool]
"""Asked by work now and then; true stops it, with `Cancelled`."""


class Message(msgspec.Struct, frozen=True, gc=False):
    """Something to report to the user: a warning, a reason, a problem.

    Attributes
    ----------
    id : str
        Dotted, e.g. ``"midi.track_truncated"``; names the template.
    arguments : dict of str to str, int, float or bool
        What the template is filled with (file, track, bar, note ...). Texts are made readable (`app.encoding.shown`):
        the names of files are among them, and messages are stored, printed and shown.
    """

    id: str
    arguments: dict[str, Argument] = {}

    def __post_init__(self) -> None:
        for value in self.arguments.values():
            if isinstance(value, str) and not (value.isascii() and value.isprintable()):
                break
        else:
            return  # Of most, and a plan has hundreds of thousands.
        readable = {name: shown(value) if isinstance(value, str) else value for name, value in self.arguments.items()}
        msgspec.structs.force_setattr(self, "arguments", readable)


class AppError(Exception):
    """An error the user can act on; anything else that escapes a parser is a bug.

    Parameters
    ----------
    id : str
        Message id, as in `Message`.
    **arguments
        What the template is filled with.
    """

    def __init__(self, id: str, /, **arguments: Argument) -> None:
        self.message = Message(id, arguments)
        detail = ", ".join(f"{key}={value!r}" for key, value in arguments.items())
        super().__init__(f"{id} ({detail})" if detail else id)


TOO_DEEP: Final = "lists or objects nested too deeply"
"""A fault that a library reports in words about Python's stack."""


def shortened(detail: object, most: int = 200) -> str:
    """Shorten what a library says about a fault, for a message: it may quote any amount of the file."""
    text = TOO_DEEP if isinstance(detail, RecursionError) else str(detail)
    return text if len(text) <= most else f"{text[: most - 1]}…"


class FileError(AppError):
    """A file that cannot be read or written; ``file`` is always among the arguments."""


class MapError(AppError):
    """A table (instrument map, metadata, preset, settings) that is not valid; names the file and the line or key."""


class UsageError(AppError):
    """A request that makes no sense: an unknown player, parameter or range."""


class Cancelled(AppError):
    """The user stopped the work; nothing half-written stays."""


def raise_if_stopped(stop_requested: StopRequested) -> None:
    """Raise `Cancelled` if the work is to stop."""
    if stop_requested():
        raise Cancelled("work.stopped")


def stoppable(progress: Callable[[float], None], stop_requested: StopRequested) -> Callable[[float], None]:
    """A report of progress that raises `Cancelled` if the work is to stop."""

    def report(share: float) -> None:
        raise_if_stopped(stop_requested)
        progress(share)

    return report
