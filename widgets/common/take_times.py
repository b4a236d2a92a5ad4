"""Date and time of a take in local format."""

from __future__ import annotations

from PySide6.QtCore import QDateTime, QLocale, Qt


def when_text(recorded: str) -> str:
    """Return day and time at which a take was recorded, in the user's format; empty if unknown."""
    moment = _moment(recorded)
    return QLocale().toString(moment, QLocale.FormatType.ShortFormat) if moment.isValid() else ""


def clock_text(recorded: str) -> str:
    """Return the time of day at which a take was recorded, in the user's format; empty if unknown."""
    moment = _moment(recorded)
    return QLocale().toString(moment.time(), QLocale.FormatType.ShortFormat) if moment.isValid() else ""


def _moment(recorded: str) -> QDateTime:
    return QDateTime.fromString(recorded, Qt.DateFormat.ISODateWithMs).toLocalTime()
