"""Access to the optional package usd-core, which writes USD files."""

from __future__ import annotations

import ctypes
import importlib.util
import os
import sys
from functools import cache
from pathlib import Path
from typing import Final

from app.child import typed_python
from app.errors import UsageError

_MODULES: Final = ("Tf", "Gf", "Kind", "Sdf", "Usd", "UsdGeom", "UsdMedia", "UsdShade", "UsdSkel", "UsdUtils", "Vt")
"""Modules of the package that Suisou uses."""


def usd_installed() -> bool:
    """Return whether usd-core is installed."""
    return importlib.util.find_spec("pxr") is not None


def refuse_without_usd() -> None:
    """Raise UsageError if usd-core is not installed."""
    if not usd_installed():
        raise UsageError("usd.missing", python=typed_python())


@cache
def open_libraries() -> None:
    """Load the package's shared libraries without holding the interpreter's lock, unlike an import.

    Prevents a deadlock: while an import loads them, the system's loader is locked, and they wait for the interpreter's
    lock. Another thread may hold that lock in numpy while it waits for the loader.
    """
    found = importlib.util.find_spec("pxr")
    if sys.platform != "linux" or found is None:
        return
    # A library that cannot be opened is reported by the import that follows.
    system = ctypes.CDLL(None)
    system.dlopen.argtypes, system.dlopen.restype = (ctypes.c_char_p, ctypes.c_int), ctypes.c_void_p
    for folder in found.submodule_search_locations or ():
        for name in _MODULES:
            library = Path(folder) / name / f"_{name[0].lower()}{name[1:]}.so"
            system.dlopen(os.fsencode(library), os.RTLD_NOW)
