"""A dance as a value: style, segments with times, and motion."""

from __future__ import annotations

from dataclasses import dataclass

from app.arrays import FloatArray
from app.choreography.clip import MotionClip
from app.choreography.foot_plants import FootPlant


@dataclass(frozen=True)
class Manner:
    """Style of one dancer.

    Attributes
    ----------
    seed : int
        Seed; another seed gives another dance to the same music.
    source : int or None
        Index of the model's source whose motion is preferred.
    size : float
        Size of the motion of trunk and arms; 1 as captured.
    melody : float
        Weight of melody, bass and accents relative to percussion, 0..1.
    weight : float
        Weight of the dance, -1 (light) to 1 (heavy): at 1 knees bend more by `app.choreography.standing_feet.DEEPER` of
        a leg.
    """

    seed: int = 0
    source: int | None = None
    size: float = 1.0
    weight: float = 0.0
    mirrored: bool = False
    melody: float = 0.5


@dataclass(frozen=True)
class SegmentStep:
    """A danced segment: its place, accent and times.

    Attributes
    ----------
    segment : int
        Index of the segment in the model.
    place : int
        Index of its accent in the grid of beats and their divisions.
    start_s, accent_s, end_s : float
        Times in the piece, in seconds, of the segment's start, accent and end.
    """

    segment: int
    state: int
    place: int
    start_s: float
    accent_s: float
    end_s: float


@dataclass(frozen=True, eq=False)
class Dance:
    """A generated dance.

    Attributes
    ----------
    clip : MotionClip
        Motion whose frame 0 is at ``first_s``.
    speeds : (T,) float64
        Speed of the source's time in each frame: 1 as captured, 0 at rest.
    seams : tuple of int
        Frames at which motion begins that does not continue the capture before it.
    standing : tuple of FootPlant
        Spans in which a foot stands still.
    """

    clip: MotionClip
    first_s: float
    steps: tuple[SegmentStep, ...]
    speeds: FloatArray
    seams: tuple[int, ...]
    standing: tuple[FootPlant, ...]
