"""Chances and seeds that depend on nothing but what names them: the same on every machine and in every run."""

from __future__ import annotations

import hashlib
from functools import lru_cache

_BETWEEN = "\x1f"


def chance(*parts: str | int) -> float:
    """A number in [0, 1) for what these name: the same seed, player and score position give the same one."""
    return share_of(hashlib.blake2b(_BETWEEN.join(map(str, parts)).encode(), digest_size=8).digest())


def seed_of(*parts: str | int) -> int:
    """A seed for what these name, 0 to 2**31 - 1."""
    return int(chance(*parts) * 2**31)


def next_seed(name: str, seed: int) -> int:
    """Another seed for who had this one: what every die throws. Thrown again, it is yet another."""
    return seed_of("another", name, seed)


def performed_seed(seed: int, piece_seed: int) -> int:
    """The seed of a performer within a piece: a change of the piece's seed changes all performers."""
    return (seed + piece_seed) % 2**63


@lru_cache(maxsize=4096)
def partial_digest(parts: tuple[str | int, ...]) -> hashlib.blake2b:
    """The digest of what comes before the last part: thousands of places of a line have it in common. Copy it, add the
    last part, and `share_of` is the chance of all."""
    return hashlib.blake2b(_BETWEEN.join([*map(str, parts), ""]).encode(), digest_size=8)


def share_of(digest: bytes) -> float:
    """A digest of eight bytes as a number in [0, 1)."""
    return int.from_bytes(digest, "big") / 2.0**64
