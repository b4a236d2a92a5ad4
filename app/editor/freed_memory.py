"""Returns freed memory to the operating system."""

from __future__ import annotations

import ctypes
import sys
from typing import Any, Final

_ARENA_MAX: Final = -8
_MMAP_THRESHOLD: Final = -3
"""Value of ``M_MMAP_THRESHOLD`` in ``malloc.h`` of the GNU C library."""
_ARENAS: Final = 2
_LARGE_BYTES: Final = 2**20


def give_back() -> None:
    """Return free memory to the operating system, which glibc on Linux otherwise keeps for every thread.

    Takes some milliseconds without blocking other Python threads. Systems other than Linux do this by themselves.
    """
    trim = _of_c_library("malloc_trim")
    if trim is not None:
        trim(0)


def share_memory() -> None:
    """Make all threads started from now on share few memory arenas, so that memory freed by one thread is used by the
    next. Python threads rarely run in parallel, so contention is small. Large blocks are allocated separately and
    returned to the system immediately.
    """
    option = _of_c_library("mallopt")
    if option is not None:
        option(_ARENA_MAX, _ARENAS)
        option(_MMAP_THRESHOLD, _LARGE_BYTES)


def _of_c_library(name: str) -> Any:
    """Return a function of the C library by name; None if the library lacks it or the system is not Linux."""
    return getattr(ctypes.CDLL(None), name, None) if sys.platform == "linux" else None
