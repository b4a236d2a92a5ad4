"""Remarks that came with a file: messages of another version of the program may have no words in this one."""

from __future__ import annotations

from typing import Final

from app.errors import Message
from app.messages import text

_FORMER: Final = ".".join(("score", "instrument_from_file_name"))
_RENAMED: Final = {_FORMER: "score.instrument_from_title"}
"""Ids of older versions, which have no words any more, and what says the same now."""


def sayable(message: Message) -> Message:
    """The message itself where it can be worded, else ``project.unknown_remark`` (remark), which names it."""
    message = _placed(Message(_RENAMED.get(message.id, message.id), message.arguments))
    try:
        text(message)
    except (KeyError, IndexError, ValueError, TypeError, AttributeError):
        return Message("project.unknown_remark", {"remark": message.id})
    return message


def _placed(message: Message) -> Message:
    """A message of the time when positions were counted as bar and beat, with its position as it is written now."""
    arguments = message.arguments
    bar, beat = arguments.get("bar"), arguments.get("beat")
    if "place" in arguments or not isinstance(bar, int) or not isinstance(beat, int | float):
        return message
    return Message(message.id, {**arguments, "place": f"{bar}.{int(beat)}"})
