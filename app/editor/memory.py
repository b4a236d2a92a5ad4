"""Memory that was freed goes back to the system."""

from __future__ import annotations

import ctypes
import sys
from typing import Any


def give_back() -> None:
    """Return to the system what is free in between: the C library of Linux keeps it otherwise, for every thread anew.

    It takes some milliseconds, in which other threads of Python work on. Elsewhere the system does so by itself.
    """
    trim = _trim()
    if trim is not None:
        trim(0)


def _trim() -> Any:
    if sys.platform != "linux":
        return None
    # Other C libraries than GNU's have no such function.
    return getattr(ctypes.CDLL(None), "malloc_trim", None)
