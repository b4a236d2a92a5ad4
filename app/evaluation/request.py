"""Settings of an evaluation as a value that can be sent to another process."""

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
"""Default frame rate in frames per second."""
MOST_EXCERPTS: Final = 20
LEAST_S, MOST_S = 1.0, 60.0
"""Limits of an excerpt's length in seconds."""

_OF_VIEW: Final[dict[str, tuple[Aspect, ...]]] = {
    "ensemble": ASPECTS,
    "hands": ("fingers_arms",),
    "mouth": ("mouth",),
    "feet": ("body",),
    "top": ("fingers_arms", "body"),
}
_OF_ONE: Final[tuple[Aspect, ...]] = ("fingers_arms", "body", "mouth")


class EvaluationRequest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Settings of an evaluation. Paths are encoded by `app.encoding.stored`.

    Attributes
    ----------
    folder : str
        Output folder, created if necessary.
    title : str
        Title of the piece for viewers.
    film, keyframes : str
        Videos of real players and of other animation; empty for none.
    film_offset_s, keyframes_offset_s : float or None
        Performance time of their first picture in seconds; None to find it by the sound.
    follow_film : bool
        Whether to perform the piece at the film's tempo.
    variants : tuple of Variant
        Variants; empty for all that are possible.
    bars : (int, int) or None
        First and last bar of a single excerpt; None to choose excerpts automatically.
    excerpts : int
        Number of automatically chosen excerpts.
    excerpt_s : float
        Their length in seconds.
    view : str
        View of the players as in ``suisou film --view``.
    player_ids : tuple of str
        Players that the view shows.
    size : (int, int)
        Width and height of a clip in pixels; even.
    seed : int
        Seed of the codes.
    theme : str
        Theme with the background colours.
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
    """Return the variants of an evaluation in the order of `VARIANTS`.

    Raises
    ------
    UsageError
        A variant has no video, or there are fewer than two variants.
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
    """Return the aspects that viewers can judge in a view.

    Parameters
    ----------
    seen : int
        Number of visible performers; the ensemble cannot be judged with a single one.
    """
    aspects = _OF_VIEW.get(view, _OF_ONE)
    return tuple(aspect for aspect in aspects if aspect != "ensemble" or seen > 1)
