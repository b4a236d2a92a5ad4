"""Files that cannot be read or written."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "file.cannot_read": "{file} cannot be read: {reason}",
    "file.cannot_write": "{file} cannot be written: {reason}",
    "file.not_regular": "{file} is not a file but a folder, a pipe or a device; choose a file",
    "file.too_large": "{file} is too large ({size_mb} MB; at most {most_mb} MB are read); choose a smaller file",
    "json.invalid": "{file} is damaged: {detail}",
    "settings.value": "{file}: {place}: {detail}; the default is used",
    "settings.set_aside": (
        "{file} cannot be used: settings changed now last only until the editor ends; correct the file or remove it"
    ),
    "export.done": "files written to {folder}: {count}",
    "video.done": "the film is written: {file}",
    "video.failed": "{file} cannot be written as a film: {detail}",
}
