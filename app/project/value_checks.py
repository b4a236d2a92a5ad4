"""Checks of values in a project: bounds, order, lengths and uniqueness; a fault is a key path with a description."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise
from typing import Final, TypeAlias

from app.encoding import is_text, restored, stored
from app.errors import shortened
from app.plan.parameters import Bounds
from app.project import limits
from app.project.performers import Dancer, Player
from app.rig.people.wardrobe import TINTS

Fault: TypeAlias = tuple[str, str]
"""Key path of a value, and its error."""

COLOUR: Final = re.compile(r"#[0-9a-fA-F]{6}", re.ASCII)
MOST_NAME: Final = 60
"""Greatest number of characters of a performer's name in a message."""


def about(
    performer: Player | Dancer | None, found: Iterable[Fault], where: Callable[[str], str] = lambda place: ""
) -> Iterator[Fault]:
    """Yield faults with the performer's name added to the description, since list indices mean little to users.

    Parameters
    ----------
    where : callable
        Returns further information for a fault's key path, such as the bar.
    """
    who = "dancer" if isinstance(performer, Dancer) else "player"
    for place, detail in found:
        named = [] if performer is None else [f"{who} {shortened(performer.name, MOST_NAME)!r}"]
        said = ", ".join((*named, *filter(None, (shortened(where(place), 2 * MOST_NAME),))))
        yield place, f"{detail} ({said})" if said else detail


def faults_at_key(prefix: str, found: Iterable[Fault]) -> Iterator[Fault]:
    """Yield faults with their key paths prefixed by the key of the checked value."""
    for place, detail in found:
        yield f"{prefix}.{place}", detail


def faults_of_bounds(place: str, value: float, bounds: Bounds) -> Iterator[Fault]:
    """Yield a fault at the key path ``place`` if a number is outside its bounds."""
    # Also false for NaN, and for integers too large for a float.
    if not bounds[0] <= value <= bounds[1]:
        yield place, f"must be from {bounds[0]:.15g} to {bounds[1]:.15g}"


def in_order(place: str, ticks: Sequence[int]) -> Iterator[Fault]:
    """Yield a fault at the key path ``place`` if ticks do not begin with 0, do not ascend, or are too large."""
    if not ticks:
        yield place, "must not be empty"
        return
    if ticks[0] != 0:
        yield f"{place}[0].tick", "must be 0"
    for index, (tick, following) in enumerate(pairwise(ticks), 1):
        if following <= tick:
            yield f"{place}[{index}].tick", "ticks must ascend"
            return
    if ticks[-1] > limits.LAST_TICK:
        yield f"{place}[{len(ticks) - 1}].tick", f"must be at most {limits.LAST_TICK}"


def unique(place: str, values: Iterable[str], field: str = "id", taken: Iterable[str] = ()) -> Iterator[Fault]:
    """Yield a fault for values that occur twice or are ``taken`` elsewhere.

    ``place`` is the key path of their list, ``field`` the field of each item that has the value.
    """
    seen = set(taken)
    for index, value in enumerate(values):
        if value in seen:
            yield f"{place}[{index}].{field}", f"{value!r} appears twice"
        seen.add(value)


def text_faults(place: str, value: str, most: int = limits.MOST_TEXT) -> Iterator[Fault]:
    """Yield a fault at the key path ``place`` if a text is not valid Unicode or has more than ``most`` characters."""
    if len(value) > most:
        yield place, f"at most {most} characters"
    elif not is_text(value):
        yield place, "must be Unicode text"


def path_faults(place: str, value: str) -> Iterator[Fault]:
    """Yield a fault at the key path ``place`` if a path is too long or impossible for a file; its name may be any
    bytes.
    """
    if len(value) > limits.MOST_TEXT:
        yield place, f"at most {limits.MOST_TEXT} characters"
    elif "\0" in value or restored(stored(value)) != value:
        yield place, "must be the path of a file"


def id_faults(place: str, value: str, least: int = 1) -> Iterator[Fault]:
    """Yield a fault at the key path ``place`` if an id has fewer than ``least`` characters, is too long, or is not
    valid Unicode.
    """
    if not least <= len(value) <= limits.MOST_ID:
        yield place, f"must have from {least} to {limits.MOST_ID} characters"
    elif not is_text(value):
        yield place, "must be Unicode text"


def look_faults(performer: Player | Dancer, place: str) -> Iterator[Fault]:
    """Yield the faults of a performer's place on the stage, colour and clothes."""
    outfit = performer.outfit
    yield from id_faults(f"{place}.outfit.id", outfit.id, least=0)
    colours = {"colour": performer.colour, **{f"outfit.{tint}": outfit.colour(tint) for tint in TINTS}}
    for name, colour in colours.items():
        if colour and not COLOUR.fullmatch(colour):
            yield f"{place}.{name}", 'must be empty or like "#3366cc"'
    yield from faults_of_bounds(f"{place}.stage.x_m", performer.stage.x_m, limits.STAGE_M)
    yield from faults_of_bounds(f"{place}.stage.z_m", performer.stage.z_m, limits.STAGE_M)
    yield from faults_of_bounds(f"{place}.stage.turn_rad", performer.stage.turn_rad, limits.TURN_RAD)
