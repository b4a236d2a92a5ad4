"""Texts by their ids in the language of the editor."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication


def tr(text_id: str) -> str:
    """The text of an id; the id itself where there is none. Objects of Qt have the same as their method ``tr``."""
    return QCoreApplication.translate("", text_id)
