"""Looks by age: hair and brows turn grey, and skin becomes that of an older or younger face.

Colours and skin in the file of a person are those at one age (`Person.looks_years`); at another age they are changed
from there. Without such an age they are shown as they are.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from app.rig.people.body_shapes import years_of
from app.rig.people.person import Color, Person, originals

GREY_YEARS: Final = (35.0, 50.0, 60.0, 70.0, 80.0, 90.0)
GREY_SHARES: Final = (0.0, 0.2, 0.48, 0.74, 0.9, 0.97)
"""Share of grey hairs by age, a little before the mean of Panhard, Lozano and Loussouarn (2012), whose 45 to 65 year
olds have 27 % (<https://doi.org/10.1111/j.1365-2133.2012.11095.x>).
"""
FULLY_GREY: Final[dict[str, Color]] = {"hair": (0.60, 0.59, 0.57), "brows": (0.24, 0.235, 0.225)}
"""Linear colours of hair without pigment, by material; brows keep some."""
DARKEST: Final[Color] = (0.010, 0.0085, 0.0075)
"""Linear colour of hair with the most pigment."""


def colors_by_age(person: Person) -> dict[str, Color]:
    """Return the linear colours of a person at its age, by material."""
    if not person.looks_years:
        return person.colors
    share, before = (float(np.interp(years, GREY_YEARS, GREY_SHARES)) for years in _years(person))
    return {
        name: _greyed(color, FULLY_GREY[name], share, before) if name in FULLY_GREY else color
        for name, color in person.colors.items()
    }


def _greyed(color: Color, grey: Color, share: float, before: float) -> Color:
    """Return the colour of hair of which ``share`` is grey, from its colour when the share was ``before``.

    Colours are mixed by their cube roots, close to perceived lightness: dark hairs shade the grey ones beside them.
    """
    if share == before:
        return color
    triples = np.cbrt([color, grey, DARKEST]).T.tolist()
    red, green, blue = (_greyed_part(part, white, least, share, before) ** 3 for part, white, least in triples)
    return red, green, blue


def _greyed_part(part: float, white: float, least: float, share: float, before: float) -> float:
    if share >= before:
        return part + max(white - part, 0.0) * (share - before) / max(1.0 - before, 1e-9)
    # What remains without the grey hairs, which are not known exactly: dyed hair may have none.
    pigment = min(max((part - before * white) / (1.0 - before), least), part)
    return min(pigment + share * max(white - pigment, 0.0), part)


def skin_stages(person: Person) -> tuple[str, ...]:
    """Return the names of the skins of the person's sex by age; the first is empty for the bundled body's own."""
    return ("", *originals()[person.original].aged_skins)


def skin_change(person: Person) -> tuple[float, float]:
    """Return the places among the stages of the skin in a person's file and of its skin at its age: 0 for the first,
    1 for the second and so on, and more than the last for someone older.
    """
    table, stages = originals()[person.original], skin_stages(person)
    given = float(stages.index(person.skin)) if person.skin in stages else 0.0
    if not person.looks_years or len(stages) < 2:
        return given, given
    ages = (YOUNG_YEARS, *table.aged_skins.values())
    now, before, oldest = (_stage_at(years, ages) for years in (*_years(person), table.years[1]))
    if now >= before:
        return given, given + (max(oldest, given) - given) * (now - before) / max(oldest - before, 1e-9)
    return given, given * now / before


def _stage_at(years: float, ages: tuple[float, ...]) -> float:
    """Return the stage at an age among stages at ascending ``ages``; beyond the last it goes on as before it."""
    place = float(np.interp(years, ages, np.arange(len(ages))))
    return place + max(years - ages[-1], 0.0) / (ages[-1] - ages[-2])


YOUNG_YEARS: Final = 28.0
"""Age in years at which a face begins to change towards the first older skin."""


def _years(person: Person) -> tuple[float, float]:
    """Return a person's age and the age at which it looks as in its file, both in years."""
    return years_of(person.phenotype.age), person.looks_years
