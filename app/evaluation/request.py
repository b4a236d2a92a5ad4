"""Settings of an evaluation, as a value that can be sent to another process."""

from __future__ import annotations

from typing import Final

import msgspec

from app.errors import UsageError
from app.evaluation.design import Presentations
from app.evaluation.key import ASPECTS, VARIANTS, Aspect, Variant

EXCERPTS: Final = 3
SECONDS: Final = 8.0
SIZE: Final = (640, 360)
FPS: Final = 30
"""Usual numbers."""
MOST_EXCERPTS: Final = 20
LEAST_S, MOST_S = 1.0, 60.0
"""Limits of an excerpt's length."""

_OF_VIEW: Final[dict[str, tuple[Aspect, ...]]] = {
    "ensemble": ASPECTS,
    "hands": ("fingers_arms",),
    "mouth": ("mouth",),
    "feet": ("body",),
    "top": ("fingers_arms", "body"),
}
_OF_ONE: Final[tuple[Aspect, ...]] = ("fingers_arms", "body", "mouth")


class EvaluationRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Settings of an evaluation. Paths are as `app.encoding.stored` writes them.

    Attributes
    ----------
    folder : str
        Where it is written; made if it is not there.
    title : str
        Of the piece, as viewers read it.
    film, keyframes : str
        Videos of real players and of animation from elsewhere; empty: none.
    film_offset_s, keyframes_offset_s : float or None
        Performance time of their first picture; None: found by their sound.
    follow_film : bool
        Whether the piece is performed at the tempo of the film.
    variants : tuple of Variant
        Empty: all that can be made of what there is.
    bars : (int, int) or None
        First and last bar of the one excerpt; None: excerpts are chosen.
    excerpts : int
    excerpt_s : float
        How many excerpts of which length are chosen.
    view : str
    player_ids : tuple of str
        Whom the view is about.
    size : (int, int)
        Of one clip, pixels; even.
    seed : int
        Codes are drawn with it.
    theme : str
        Colours behind the players.
    """

    folder: str
    title: str
    film: str = ""
    keyframes: str = ""
    film_offset_s: float | None = None
    keyframes_offset_s: float | None = None
    follow_film: bool = False
    variants: tuple[Variant, ...] = ()
    bars: tuple[int, int] | None = None
    excerpts: int = EXCERPTS
    excerpt_s: float = SECONDS
    view: str = "ensemble"
    player_ids: tuple[str, ...] = ()
    size: tuple[int, int] = SIZE
    fps: tuple[int, int] = (FPS, 1)
    presentation: Presentations = "both"
    seed: int = 0
    theme: str = "dark"


def variants_of(request: EvaluationRequest) -> tuple[Variant, ...]:
    """The variants of an evaluation, in the order of `VARIANTS`.

    Raises
    ------
    UsageError
        ``evaluate.needs_file``: of one there is no video; ``evaluate.too_few``: fewer than two cannot be compared.
    """
    videos: dict[Variant, tuple[str, str]] = {
        "film": (request.film, "--film"),
        "keyframes": (request.keyframes, "--keyframes"),
    }
    for variant, (file, option) in videos.items():
        if variant in request.variants and not file:
            raise UsageError("evaluate.needs_file", variant=variant, option=option)
    possible = [variant for variant in VARIANTS if variant not in videos or videos[variant][0]]
    found = tuple(variant for variant in possible if not request.variants or variant in request.variants)
    if len(found) < 2:
        raise UsageError("evaluate.too_few")
    return found


def aspects_of(view: str, seen: int) -> tuple[Aspect, ...]:
    """Aspects that viewers can judge in a view.

    Parameters
    ----------
    seen : int
        How many performers are in the picture: one makes no ensemble.
    """
    aspects = _OF_VIEW.get(view, _OF_ONE)
    return tuple(aspect for aspect in aspects if aspect != "ensemble" or seen > 1)
