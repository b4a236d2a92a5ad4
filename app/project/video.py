"""The reference video shown with a piece."""

from __future__ import annotations

import msgspec


class VideoTrack(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A video of real players, or of another animation.

    Attributes
    ----------
    path : str
        Absolute path; project files store it relative to themselves.
    offset_s : float
        Performance time of its first frame; score second 0 is tick 0.
    confidence : float or None
        Confidence 0..1 of an estimated offset; None if set by hand.
    """

    path: str
    offset_s: float = 0.0
    confidence: float | None = None
