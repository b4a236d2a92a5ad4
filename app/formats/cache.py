"""A cache of results that cost more to compute than to read, in a folder that may be emptied at any time."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

import platformdirs

CACHE_VARIABLE: Final = "SUISOU_CACHE"
"""Environment variable that names another folder, with one for each kind in it."""


def cache_folder(kind: str) -> Path:
    """Return the user's folder for results of a kind; it may not be there yet."""
    named = os.environ.get(CACHE_VARIABLE)
    return (Path(named) if named else platformdirs.user_cache_path("suisou", appauthor=False)) / kind
