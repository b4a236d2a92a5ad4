"""Several dancers to one piece: common properties and places."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final, Literal, get_args

import numpy as np

from app.choreography.clip import MotionClip
from app.choreography.coming_to_rest import ENDS_S, GOES_ON_S
from app.choreography.dance import Dance, Manner
from app.choreography.generate import Choreographer
from app.choreography.rhythm import Rhythm, delayed

Formation = Literal["unison", "canon", "mirror", "individual"]
FORMATIONS: Final[tuple[Formation, ...]] = get_args(Formation)

CANON_BEATS: Final = 4.0
"""Felt beats between the starts of two dancers in canon."""
APART_M: Final[dict[Formation, float]] = {"unison": 2.0, "canon": 3.0, "mirror": 3.0, "individual": 3.6}
"""Distance in metres between neighbouring dancers: those who dance alike simultaneously do not collide, others keep
within about `app.choreography.stage.STAGE_M` of their places.
"""


@dataclass(frozen=True)
class Role:
    """Start and place of one of several dancers who dance to one piece.

    Attributes
    ----------
    delay_beats : float
        Start of the dance in felt beats after the music.
    x_m : float
        Place in the row, towards the left of a dancer facing the audience.
    """

    manner: Manner
    delay_beats: float
    x_m: float


def roles(formation: Formation, dancers: int, manner: Manner, sources: int) -> tuple[Role, ...]:
    """Assign roles to dancers in a row, ordered from the audience's left.

    Parameters
    ----------
    formation : {"unison", "canon", "mirror", "individual"}
        Same dance; same dance one after another; same dance with every other one mirrored; or different dances with
        different seed, preferred source and size.
    manner : Manner
        Style of the first dancer, from which the others' are derived.
    sources : int
        Number of sources (captured dancers) of the model.
    """
    found = []
    for number in range(dancers):
        own = manner
        if formation == "mirror":
            own = replace(manner, mirrored=manner.mirrored != bool(number % 2))
        if formation == "individual" and number:
            random = np.random.default_rng([manner.seed, number])
            own = replace(
                manner,
                seed=int(random.integers(2**31)),
                source=number % sources if manner.source is None else manner.source,
                size=manner.size * float(random.uniform(0.85, 1.15)),
            )
        place_m = APART_M[formation] * (number - 0.5 * (dancers - 1))
        found.append(Role(own, CANON_BEATS * number if formation == "canon" else 0.0, place_m))
    return tuple(found)


def dance_together(
    choreographer: Choreographer, rhythm: Rhythm, cast: tuple[Role, ...], fps: Fraction
) -> tuple[Dance, ...]:
    """Choreograph a dance for every role of a cast, each at its own position on stage and all of equal length. Equal
    arguments give identical results.
    """
    rhythms = [delayed(rhythm, role.delay_beats) if role.delay_beats else rhythm for role in cast]
    end_s = max((one.end_s for one in rhythms), default=0.0) + GOES_ON_S + ENDS_S
    return tuple(
        _at(choreographer.dance(one, role.manner, fps, end_s=end_s), role.x_m)
        for one, role in zip(rhythms, cast, strict=True)
    )


def _at(dance: Dance, x_m: float) -> Dance:
    """Return the dance moved sideways by ``x_m`` metres, to its place in the row of dancers."""
    if x_m == 0.0:
        return dance
    move = np.array((x_m, 0.0, 0.0))
    clip: MotionClip = replace(dance.clip, hips_m=dance.clip.hips_m + move)
    standing = (replace(one, place_m=(one.place_m[0] + x_m, *one.place_m[1:])) for one in dance.standing)
    return replace(dance, clip=clip, standing=tuple(standing))
