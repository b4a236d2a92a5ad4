"""Files that cannot be read or written."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "file.cannot_read": "{file} cannot be read: {reason}",
    "file.cannot_write": "{file} cannot be written: {reason}",
    "file.unreadable": "{file} cannot be read: {detail}",
    "export.done": "files written to {folder}: {count}",
    "video.done": "the film is written: {file}",
    "video.failed": "{file} cannot be written as a film: {detail}",
}
