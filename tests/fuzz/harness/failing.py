"""A `child` whose reader fails in every way, to test that each failure is detected."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from app.errors import AppError, FileError
from tests.fuzz.harness import child
from tests.fuzz.harness.readers import KINDS, Kind, accepted


def failing(path: Path, folder: Path) -> None:
    """Fail as stated in the file."""
    match path.read_bytes().strip():
        case b"refuse":
            raise FileError("file.cannot_read", file=str(path), reason="refused")
        case b"unworded":
            raise AppError("no.such.message")
        case b"late":
            with accepted("save"):
                raise FileError("file.cannot_write", file=str(path), reason="full")
        case b"abort":
            os.abort()
        case b"hang":
            while True:
                pass
        case b"large":
            np.ones(300 * 2**20 // 8 * 4)
        case b"larger":
            np.ones(2**40)
        case data if b"x" in data:
            raise KeyError("x")


if __name__ == "__main__":
    KINDS["failing"] = Kind("failing", failing, lambda: [b"good"], (), ".txt")
    # A gigabyte took more than 2 s to be filled on a slow machine.
    child.HANG_CPU_S = 6
    child.main()
