"""Remarks that came with a file: messages of another version of the program may have no words in this one."""

from __future__ import annotations

from app.errors import Message
from app.messages import text


def sayable(message: Message) -> Message:
    """The message itself where it can be worded, else ``project.unknown_remark`` (remark), which names it."""
    try:
        text(message)
    except (KeyError, IndexError, ValueError, TypeError, AttributeError):
        return Message("project.unknown_remark", {"remark": message.id})
    return message
