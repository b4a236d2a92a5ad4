"""A learned choreography: basic motions, their probabilities, and their motion."""

from __future__ import annotations

from dataclasses import dataclass

from app.arrays import FloatArray
from app.choreography.clip import MotionClip


@dataclass(frozen=True)
class TrainingPair:
    """A pair of motion and music from which a model was learned.

    Attributes
    ----------
    motion_name, music_name : str
        Names of the files, without folders.
    offset_s : float
        Time of the motion at the music's first tick in seconds.
    offset_confidence : float or None
        Confidence of the offset, 0..1; None if the user gave the offset.
    credits : str
        Provenance and licence of the motion, as text; empty if not given.
    cuts_given : bool
        Whether the user set the cuts; False by default in older files.
    """

    motion_name: str
    music_name: str
    offset_s: float
    offset_confidence: float | None
    credits: str
    cuts_given: bool = False


@dataclass(frozen=True)
class MotionSegment:
    """One motion between two minima of the angular acceleration: frames of a clip of the model.

    Attributes
    ----------
    start, accent, end : int
        Frames at the minimum, the maximum and the next minimum; the segment is ``start`` to ``end`` (half-open), and
        the next segment of the clip begins at ``end`` if it follows directly.
    state : int
        Index of its basic motion.
    sounds : tuple of int
        Percussion symbols during it in time order; missing in files of version 1.
    melody : tuple of int
        Symbols for melody, bass and accents (`app.choreography.derived_rhythm`) in addition to percussion.
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
    """A learned choreography, the contents of a ``.choreography`` file.

    Attributes
    ----------
    clips : tuple of MotionClip
        Repaired motion of each source, all at one frame rate, each with its own body shape.
    segments : tuple of MotionSegment
        Segments by clip and start.
    transition : (K, K) float64
        ``A[i, j]``: probability of state j after state i, smoothed; rows sum to 1.
    emission : (K, 47) float64
        ``B[i, o]``: probability of percussion symbol o in state i, smoothed; rows sum to 1.
    initial : (K,) float64
        Probability of each state at the beginning, smoothed; sums to 1.
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
        """Number of basic motions of the choreography."""
        return len(self.initial)
