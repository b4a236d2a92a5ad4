"""File names that are not UTF-8, as extracted from a Japanese zip archive."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest
from hypothesis import strategies as st

NAME = "クラリネット"
"""Intended name."""

on_bytes = pytest.mark.skipif(sys.platform != "linux", reason="names are text there")


def odd(folder: Path, ending: str = "") -> Path:
    """Path in a folder with the name `NAME` encoded in CP932."""
    return folder / os.fsdecode(f"{NAME}{ending}".encode("cp932"))


def is_odd(path: Path | str) -> bool:
    """Return whether a path ends with the bytes of `NAME` in CP932."""
    return Path(os.fsencode(path).decode("latin-1")).stem.encode("latin-1") == NAME.encode("cp932")


byte_names = (
    st.binary(min_size=1, max_size=20)
    .map(lambda name: os.fsdecode(name.replace(b"\0", b"\1").replace(b"/", b"\2")))
    .filter(lambda name: name not in (".", ".."))
)
"""Strategy for any file name that may occur on the system."""
