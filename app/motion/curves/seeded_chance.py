"""Random numbers that depend only on names and score places, so that runs are bit-identical."""

from __future__ import annotations

import hashlib

import numpy as np


def generator(*names: str | int) -> np.random.Generator:
    """Create a random generator for one purpose, seeded by a stable hash of its names (player, seed, layer,
    event ...).
    """
    text = "\x1f".join(str(name) for name in names)
    digest = hashlib.blake2b(text.encode(), digest_size=16).digest()
    return np.random.Generator(np.random.Philox(int.from_bytes(digest, "little")))
