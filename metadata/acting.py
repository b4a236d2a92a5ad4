"""Acting of players as data: styles and habits, which multiply the amounts of a player's motion layers."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, TypeAlias, TypeVar

import msgspec

from metadata.tables import Title, check_name, check_title, decoded, invalid

Factor: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0, le=4.0)]
SECTION_PLAYER = "section_player"
"""Name of the style in which every factor is 1."""
SEPARATOR = ","
"""Separator of names in a text; no name contains it."""


class Factors(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Factors by which a style or habit multiplies a player's amounts of motion, named like the parameters."""

    sway: Factor = 1.0
    weight_shift: Factor = 1.0
    bell_height: Factor = 1.0
    phrase_motion: Factor = 1.0
    stillness: Factor = 1.0
    footwork: Factor = 1.0
    toe_taps: Factor = 1.0
    breath_motion: Factor = 1.0
    cue_size: Factor = 1.0
    face_intensity: Factor = 1.0
    lip_motion: Factor = 1.0
    gaze: Factor = 1.0
    blinks: Factor = 1.0
    gestures: Factor = 1.0


AMOUNTS = Factors.__struct_fields__
"""Names of the parameters that styles and habits multiply."""


class Style(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A style of playing: factors for the amounts of a player's motion layers.

    Attributes
    ----------
    variation : float
        Greatest difference of a player's amounts from the style's as a share: 0.2 is 20 % to either side.
    """

    name: str
    title: Title
    description: Title = Title("")
    factors: Factors = Factors()
    variation: Annotated[float, msgspec.Meta(ge=0.0, le=0.5)] = 0.2


class Habit(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A habit: factors by which a player performs actions more or less than others of the same style."""

    name: str
    title: Title
    factors: Factors
    description: Title = Title("")


T = TypeVar("T", Style, Habit)


def read_style(path: Path) -> Style:
    """Read and check a style. Raises FileError, MapError."""
    return _checked(path, decoded(path, Style))


def read_habit(path: Path) -> Habit:
    """Read and check a habit. Raises FileError, MapError."""
    habit = _checked(path, decoded(path, Habit))
    if habit.factors == Factors():
        raise invalid(path, "factors", "must have at least one factor other than 1")
    return habit


def names_in(text: str) -> tuple[str, ...]:
    """Split a comma-separated text into names, such as those of habits, each once and sorted."""
    return tuple(sorted({name for part in text.split(SEPARATOR) if (name := part.strip())}))


def as_text(names: tuple[str, ...]) -> str:
    """Join names to one comma-separated text, each once and sorted."""
    return SEPARATOR.join(sorted(set(names)))


def _checked(path: Path, table: T) -> T:
    check_name(path, table.name)
    if SEPARATOR in table.name or not table.name.isprintable():
        raise invalid(path, "name", "must be printable and without commas")
    check_title(path, table.title)
    return table


# Created while the import lock is held, as in `metadata.load`.
for _type in (Style, Habit):
    msgspec.json.Decoder(_type)
