"""A learned choreography: basic motions, their grammar, and the motion they are made of."""

from __future__ import annotations

from dataclasses import dataclass

from app.arrays import FloatArray
from app.choreography.clip import MotionClip


@dataclass(frozen=True)
class TrainingPair:
    """A pair of motion and music that a model was learned from.

    Attributes
    ----------
    motion_name, music_name : str
        Names of the files, without folders.
    offset_s : float
        The music's first tick is at this time of the motion.
    offset_confidence : float or None
        0..1; None where the user gave the offset.
    credits : str
        Provenance and licence of the motion, as text; empty if not given.
    cuts_given : bool
        The user set where the motion is cut; it was not found. Files that do not say so are of found cuts.
    """

    motion_name: str
    music_name: str
    offset_s: float
    offset_confidence: float | None
    credits: str
    cuts_given: bool = False


@dataclass(frozen=True)
class MotionSegment:
    """One motion between two minima of the angular acceleration: frames of one clip of the model.

    Attributes
    ----------
    start, accent, end : int
        Frames at the minimum, the maximum and the next minimum; the segment is ``start`` to ``end`` (half-open), and
        the next segment of the clip, if it follows at once, begins at ``end``.
    state : int
        The basic motion that it is an instance of.
    sounds : tuple of int
        Percussion symbols that sounded during it, in time order. Files of version 1 do not say them.
    melody : tuple of int
        Symbols for melody, bass and accents (`app.choreography.derived_rhythm`) beside percussion.
    """

    clip: int
    start: int
    accent: int
    end: int
    state: int
    sounds: tuple[int, ...] = ()
    melody: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False)
class ChoreographyModel:
    """Contents of a ``.choreography`` file.

    Attributes
    ----------
    clips : tuple of MotionClip
        The mended motion of each source, all at one frame rate, each with the shape of its own body.
    segments : tuple of MotionSegment
        By clip, then start.
    transition : (K, K) float64
        ``A[i, j]``: probability of state j after state i, smoothed; rows sum to 1.
    emission : (K, 47) float64
        ``B[i, o]``: probability of percussion symbol o in state i, smoothed; rows sum to 1.
    initial : (K,) float64
        Smoothed; sums to 1.
    """

    name: str
    sources: tuple[TrainingPair, ...]
    clips: tuple[MotionClip, ...]
    segments: tuple[MotionSegment, ...]
    transition: FloatArray
    emission: FloatArray
    initial: FloatArray

    @property
    def states(self) -> int:
        """Number of basic motions."""
        return len(self.initial)
