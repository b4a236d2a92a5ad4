"""The reference video that is seen with a piece."""

from __future__ import annotations

import msgspec


class VideoTrack(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A film of real players, or of another animation.

    Attributes
    ----------
    path : str
        Absolute, as this machine knows it; a project's file keeps it relative to itself.
    offset_s : float
        Performance time (score second 0 is tick 0) at which its first picture is seen.
    confidence : float or None
        0..1 of an estimated offset; None: set by hand.
    """

    path: str
    offset_s: float = 0.0
    confidence: float | None = None
