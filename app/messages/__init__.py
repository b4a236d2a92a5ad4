"""English wording of every message of the program: id -> template, filled with the message's arguments.

The command line prints these; the editor translates them (context ``Message``). One module per subject.
"""

from __future__ import annotations

from typing import Final

from app.errors import AppError, Message
from app.messages import audio, edit, files, formats, notes, picture, plan, project, request, score, tables, work

TEMPLATES: Final[dict[str, str]] = {
    **audio.TEMPLATES,
    **edit.TEMPLATES,
    **files.TEMPLATES,
    **formats.TEMPLATES,
    **notes.TEMPLATES,
    **picture.TEMPLATES,
    **plan.TEMPLATES,
    **project.TEMPLATES,
    **request.TEMPLATES,
    **score.TEMPLATES,
    **tables.TEMPLATES,
    **work.TEMPLATES,
}


def text(message: Message) -> str:
    """The message as an English sentence."""
    return TEMPLATES[message.id].format(**message.arguments)


def error_text(error: AppError) -> str:
    """What went wrong, as an English sentence."""
    return text(error.message)
