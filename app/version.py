"""Name and version of the program."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version


def program_version() -> str:
    """Return the installed version, or ``0+checkout`` if the program runs from a checkout."""
    try:
        return version("suisou")
    except PackageNotFoundError:
        return "0+checkout"
