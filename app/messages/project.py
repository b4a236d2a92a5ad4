"""Projects: files, recovery, re-import."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    # Files
    "project.damaged": (
        "{file} is no project file or is damaged: {detail}; the version before it was last saved may be beside it, "
        "with .bak at the end of its name"
    ),
    "project.invalid": (
        "{file} cannot be opened: {place}: {detail}; put it right there in a text editor, or open the version before "
        "it was last saved, which has .bak at the end of its name"
    ),
    "project.newer": (
        "{file} was saved by a newer version of the program (its file version is {version}, this program knows up to "
        "{known}); open it with the newer version"
    ),
    "project.too_large": "{file} is larger than the {most_mb} MB that a project can have; it is no project file",
    "project.cannot_save": (
        "{file} was not saved, it could not be opened again: {place}: {detail}; undo the last edit, then save"
    ),
    "project.read_only": "{file} is write-protected; save it under another name or allow writing",
    "project.instrument_missing": (
        "{player} plays the instrument {id!r}, which is not installed; choose another one or install it"
    ),
    "project.character_missing": (
        "{player} is the character {id!r}, which is not installed; choose another one or install it"
    ),
    "project.unknown_remark": "a remark of another version of the program ({remark})",
}
