"""A problem, reported to the user in a dialog."""

from __future__ import annotations

import unreal

from suisou_import.texts import TEXTS


class Problem(Exception):
    """An error that the user can solve, shown in a dialog."""


class Cancelled(Exception):
    """The user pressed Cancel."""


def text(name: str, /, **arguments: object) -> str:
    """A text in the editor's language."""
    english, japanese = TEXTS[name]
    language = unreal.InternationalizationLibrary.get_current_language()
    return (japanese if language.lower().startswith("ja") else english).format(**arguments)


def problem(name: str, /, **arguments: object) -> Problem:
    """Make a problem with its text."""
    return Problem(text(name, **arguments))
