"""Wording in the person's language."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

from app.errors import Message
from app.messages import TEMPLATES


def message_text(message: Message) -> str:
    """A message as a sentence in the language of the editor."""
    template = QCoreApplication.translate("Message", TEMPLATES[message.id])
    return template.format(**message.arguments)
