"""Memory that was freed goes back to the system."""

from __future__ import annotations

import ctypes
import sys
from typing import Any, Final

_ARENA_MAX: Final = -8
_MMAP_THRESHOLD: Final = -3
"""Constant of malloc.h of GNU's C library."""
_ARENAS: Final = 2
_LARGE_BYTES: Final = 2**20


def give_back() -> None:
    """Return to the system what is free in between: the C library of Linux keeps it otherwise, for every thread again.

    It takes some milliseconds, in which other threads of Python work on. Elsewhere the system does so by itself.
    """
    trim = _of_c_library("malloc_trim")
    if trim is not None:
        trim(0)


def share_memory() -> None:
    """Have all threads that are begun from now on take memory from the same few places: what one has freed serves the
    next. Python runs one of them at a time, so they seldom wait for one another there. What is large has a place of its
    own, which goes back to the system at once; else more and more of it lies between what is small and stays."""
    option = _of_c_library("mallopt")
    if option is not None:
        option(_ARENA_MAX, _ARENAS)
        option(_MMAP_THRESHOLD, _LARGE_BYTES)


def _of_c_library(name: str) -> Any:
    """A function that GNU's C library has, and others on Linux may lack."""
    return getattr(ctypes.CDLL(None), name, None) if sys.platform == "linux" else None
