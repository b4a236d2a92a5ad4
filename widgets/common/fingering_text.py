"""Fingerings in a few letters, for places that are narrow."""

from __future__ import annotations

import re
from functools import lru_cache
from itertools import groupby

_NUMBERED = re.compile(r"^([^\W\d_]+)(\d)$")


@lru_cache(maxsize=4096)
def short_label(label: str) -> str:
    """Neighbours that differ in their number alone are put together: ``"L1 L2 L3 R1 T"`` is ``"L123 R1 T"``."""
    words = label.split(" ")
    if len(words) < 2:
        return label
    reported: list[str] = []
    for letters, run in groupby(words, lambda word: found[1] if (found := _NUMBERED.match(word)) else ""):
        own = list(run)
        reported += [letters + "".join(word[len(letters) :] for word in own)] if letters else own
    return " ".join(reported)
