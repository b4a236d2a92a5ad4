"""What a viewer answered: one row of the file that the questionnaire page writes."""

from __future__ import annotations

from typing import Annotated, Final, Literal, TypeAlias, get_args

import msgspec
from msgspec import Meta

Aspect: TypeAlias = Literal["fingers_arms", "body", "mouth", "ensemble"]
Scale: TypeAlias = Literal["naturalness", "synchrony"]
Presentation: TypeAlias = Literal["single", "pair"]

ASPECTS: Final[tuple[Aspect, ...]] = get_args(Aspect)
SCALES: Final[tuple[Scale, ...]] = get_args(Scale)
STEPS: Final = 5
"""Answers are 1 (worst) to 5 (best)."""
MOST_S: Final = 1e6


class Answer(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, gc=False):
    """One answer of one viewer about one clip.

    Attributes
    ----------
    evaluation : str
        Id of the evaluation, as in its key.
    viewer : str
        Id that the page gave this viewer.
    language : {"en", "ja"}
        In which the page was read.
    position : int
        Place in the order in which this viewer saw clips or pairs, from 1.
    presentation : {"single", "pair"}
    side : {"left", "right", ""}
        Where in a pair; empty for a clip on its own.
    clip : str
        Code of the clip, as in the key.
    aspect, scale : str
        What was asked about.
    answer : int or None
        1 to `STEPS`; None where the viewer chose "cannot judge".
    seconds : float
        From the first showing to the answer.
    """

    evaluation: Annotated[str, Meta(pattern="^[0-9a-f]{8}$")]
    viewer: Annotated[str, Meta(pattern="^[0-9a-f]{8}$")]
    language: Literal["en", "ja"]
    position: Annotated[int, Meta(ge=1, le=10_000)]
    presentation: Presentation
    side: Literal["left", "right", ""]
    clip: Annotated[str, Meta(pattern="^c[0-9]{2,4}$")]
    aspect: Aspect
    scale: Scale
    answer: Annotated[int, Meta(ge=1, le=STEPS)] | None
    seconds: Annotated[float, Meta(ge=0.0, le=MOST_S)]


COLUMNS: Final = Answer.__struct_fields__
"""The header of the file, in this order."""
