"""Wording in the person's language."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

from app.errors import Message
from app.messages import TEMPLATES
from widgets.common.argument_words import WORDED, argument_word


def message_text(message: Message) -> str:
    """A message as a sentence in the language of the editor."""
    template = QCoreApplication.translate("Message", TEMPLATES[message.id])
    words = {name: argument_word(str(message.arguments[name])) for name in WORDED if name in message.arguments}
    return template.format(**{**message.arguments, **words})
