"""Memory that was freed goes back to the system."""

from __future__ import annotations

import ctypes
import sys
from typing import Any, Final

_ARENA_MAX: Final = -8
"""M_ARENA_MAX in malloc.h of GNU's C library."""
_ARENAS: Final = 2


def give_back() -> None:
    """Return to the system what is free in between: the C library of Linux keeps it otherwise, for every thread anew.

    It takes some milliseconds, in which other threads of Python work on. Elsewhere the system does so by itself.
    """
    trim = _of_c_library("malloc_trim")
    if trim is not None:
        trim(0)


def share_memory() -> None:
    """Have all threads that are begun from now on take memory from the same few places: what one has freed serves the
    next. Python runs one of them at a time, so they seldom wait for one another there."""
    option = _of_c_library("mallopt")
    if option is not None:
        option(_ARENA_MAX, _ARENAS)


def _of_c_library(name: str) -> Any:
    """A function that GNU's C library has, and others on Linux may lack."""
    return getattr(ctypes.CDLL(None), name, None) if sys.platform == "linux" else None
