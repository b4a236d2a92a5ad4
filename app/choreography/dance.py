"""A dance as a value: how a dancer dances, which segments when, and the motion of it."""

from __future__ import annotations

from dataclasses import dataclass

from app.arrays import FloatArray
from app.choreography.clip import MotionClip
from app.choreography.standing_feet import FootPlant


@dataclass(frozen=True)
class Manner:
    """Style of one dancer.

    Attributes
    ----------
    seed : int
        Another seed is another dance to the same music.
    source : int or None
        Number of the model's source whose motion is preferred.
    size : float
        Of trunk and arms about their usual pose, 1 as captured.
    melody : float
        0..1: how much melody, bass and accents count beside percussion.
    weight : float
        -1 to 1: how light or heavy it is danced; knees bend by
        `app.choreography.standing_feet.DEEPER` of a leg more at 1.
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
        In the model.
    place : int
        Of its accent in the grid of beats and their divisions.
    start_s, accent_s, end_s : float
        In the piece.
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
        Its frame 0 is at ``first_s``.
    speeds : (T,) float64
        Of the source's time, by frame: 1 as captured, 0 at rest.
    seams : tuple of int
        Frames at which motion begins that does not follow in the capture on what was before.
    standing : tuple of FootPlant
        Where feet stand.
    """

    clip: MotionClip
    first_s: float
    steps: tuple[SegmentStep, ...]
    speeds: FloatArray
    seams: tuple[int, ...]
    standing: tuple[FootPlant, ...]
