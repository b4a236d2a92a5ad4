"""Name and version of the program."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version


def program_version() -> str:
    """The installed version; one that says so where the program runs from a checkout."""
    try:
        return version("suisou")
    except PackageNotFoundError:
        return "0+checkout"
