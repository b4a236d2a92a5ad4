"""Random numbers and seeds that are functions of names only, so that they are equal on every machine and in every
run.
"""

from __future__ import annotations

import hashlib
from functools import lru_cache

_BETWEEN = "\x1f"


def chance(*parts: str | int) -> float:
    """Return a number in [0, 1) determined by its arguments, such as seed, player and score position."""
    return share_of(hashlib.blake2b(_BETWEEN.join(map(str, parts)).encode(), digest_size=8).digest())


def seed_of(*parts: str | int) -> int:
    """Return a seed determined by its arguments, 0 to 2**31 - 1."""
    return int(chance(*parts) * 2**31)


def next_seed(name: str, seed: int) -> int:
    """Return the next seed of a series, for commands that generate another variation."""
    return seed_of("another", name, seed)


def performed_seed(seed: int, piece_seed: int) -> int:
    """Combine the seeds of a performer and of the piece, so that a change of the piece's seed changes all
    performers.
    """
    return (seed + piece_seed) % 2**63


@lru_cache(maxsize=4096)
def partial_digest(parts: tuple[str | int, ...]) -> hashlib.blake2b:
    """Hash all parts but the last, which thousands of positions share. Copy the result and add the last part;
    `share_of` then gives the same number as `chance` for all parts.
    """
    return hashlib.blake2b(_BETWEEN.join([*map(str, parts), ""]).encode(), digest_size=8)


def share_of(digest: bytes) -> float:
    """Convert a digest of eight bytes to a number in [0, 1)."""
    return int.from_bytes(digest, "big") / 2.0**64
