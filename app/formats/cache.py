"""Disk cache for results that are slower to compute than to read; the folder may be emptied at any time."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

import platformdirs

CACHE_VARIABLE: Final = "SUISOU_CACHE"
"""Environment variable with another folder for the caches; each kind of cache has a subfolder."""


def cache_folder(kind: str) -> Path:
    """Return the user's cache folder for a kind of result; it may not exist yet."""
    named = os.environ.get(CACHE_VARIABLE)
    return (Path(named) if named else platformdirs.user_cache_path("suisou", appauthor=False)) / kind
