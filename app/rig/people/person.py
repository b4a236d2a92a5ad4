"""A person as described in a file: its bundled body, phenotype and colours, and the origin of clothes and hair."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Final

import msgspec

from app.errors import MapError
from app.formats.toml import read_toml, shaped
from app.rig.people.body_shapes import Phenotype, age_of

Color = tuple[float, float, float]

MOST_YEARS: Final = 120.0
"""Greatest age in years that the file of a person may mention."""


class PersonName(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Names of a person in English and Japanese."""

    en: str
    ja: str


class OriginalBody(Phenotype, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A bundled body as described in a table: its phenotype, and the people that can be made from it.

    Attributes
    ----------
    name : PersonName
        Empty for a body that exists only to make people from it.
    made_from : str
        Id of another bundled body that it is made from; empty if it has a file.
    hands : float
        Size of its hands relative to the body that it is made from.
    hip_joints_m : float
        Distance between its hip joints; 0 for the distance by the phenotype.
    heights_m, years : (float, float)
        Ranges of height and age of people made from it, whose hands are as large as its own.
    aged_skins : dict of str to float
        Textures of older skin, and the ages in years at which faces look like them, in ascending order.
    """

    name: PersonName = PersonName("", "")
    made_from: str = ""
    hands: float = 1.0
    hip_joints_m: float = 0.0
    heights_m: tuple[float, float] = (1.4, 2.1)
    years: tuple[float, float] = (15.0, 90.0)
    aged_skins: dict[str, float] = {}


class Person(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Contents of a file of a person.

    Attributes
    ----------
    original : str
        Id of the bundled body, whose hands are kept; everything else changes with the phenotype.
    name : PersonName
        Names; empty for people of the user, which have a title instead.
    colors : dict of str to (float, float, float)
        Linear base colour by material.
    worn : dict of str to str
        Bundled body from which each mesh (such as ``hair`` or ``shirt``) is taken.
    hair : str
        Hairstyle, a file of ``resources/characters/hair``; empty for the bundled body's hair.
    skin : str
        Texture of the skin in ``resources/characters/skin``; empty for the bundled body's.
    looks_years : float
        Age in years at which colours of hair and brows and the skin are as given; at another age they change with it.
        0 if they are as given at any age.
    not_cast_for : list of str
        Ids of instruments for which the body is too small.
    carriages : dict of str to (float, float, float)
        Carriage, by instrument that the body carries differently to keep its wrists straight: deviations of pitch, yaw
        and roll from the usual, -1 to 1, as shares of their ranges.
    """

    original: str
    phenotype: Phenotype
    name: PersonName = PersonName("", "")
    colors: dict[str, Color] = {}
    worn: dict[str, str] = {}
    hair: str = ""
    skin: str = ""
    looks_years: float = 0.0
    not_cast_for: list[str] = []
    carriages: dict[str, tuple[float, float, float]] = {}


def read_person(path: Path) -> Person:
    """Read the file of a person. Raises FileError, MapError."""
    return checked(shaped(read_toml(path), Person, str(path)), str(path))


def checked(person: Person, file: str) -> Person:
    """Return the person unchanged if all its numbers are within their bounds. Raises MapError otherwise."""
    for name in (person.original, *person.worn.values()):
        if name not in originals():
            raise MapError("table.invalid", file=file, place="original", detail="the id of a finished body")
    for place, least, value, most in _bounded(person):
        if not least <= value <= most:
            raise MapError("table.invalid", file=file, place=place, detail=f"a number from {least:g} to {most:g}")
    if person.hair and person.hair not in hair_styles():
        raise MapError("table.invalid", file=file, place="hair", detail="a style of hair that comes with the program")
    if person.skin and person.skin not in skins():
        raise MapError("table.invalid", file=file, place="skin", detail="a skin that comes with the program")
    return person


@cache
def hair_styles() -> Mapping[str, Path]:
    """Return the files of the separate hairstyles by id; a file's folder is named after the bundled body that
    it fits.
    """
    return MappingProxyType({path.stem: path for path in sorted((_folder() / "hair").glob("*/*.glb"))})


@cache
def skins() -> Mapping[str, Path]:
    """Return the files of the separate skin textures by id."""
    return MappingProxyType({path.stem: path for path in sorted((_folder() / "skin").glob("*.jpg"))})


def _folder() -> Path:
    return Path(str(files("resources"))) / "characters"


@cache
def originals() -> Mapping[str, OriginalBody]:
    """Return the descriptions of the bundled bodies by id."""
    path = _folder() / "originals.toml"
    return MappingProxyType(shaped(read_toml(path), dict[str, OriginalBody], str(path)))


def ranges(ids: Collection[str]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the ranges of height in metres and of age in years of people made from any of the given bundled bodies."""
    lows, highs = zip(*((one.heights_m, one.years) for one in map(originals().__getitem__, ids)), strict=True)
    (least_m, most_m), (youngest, oldest) = (zip(*both, strict=True) for both in (lows, highs))
    return (min(least_m), max(most_m)), (min(youngest), max(oldest))


def _bounded(person: Person) -> list[tuple[str, float, float, float]]:
    """Return name, least allowed value, value and greatest allowed value of each number of a person."""
    phenotype, original = person.phenotype, originals()[person.original]
    (least_m, most_m), (youngest, oldest) = original.heights_m, map(age_of, original.years)
    found = [("phenotype.height_m", least_m, phenotype.height_m, most_m)]
    found.append(("phenotype.age", youngest, phenotype.age, oldest))
    found.append(("looks_years", 0.0, person.looks_years, MOST_YEARS))
    names = ("sex", "muscle", "weight", "proportions", "cup", "firmness", "african", "asian", "caucasian")
    found += [(f"phenotype.{name}", 0.0, getattr(phenotype, name), 1.0) for name in names]
    found += [(f"phenotype.local.{name}", -1.0, value, 1.0) for name, value in phenotype.local.items()]
    found += [(f"carriages.{name}", -1.0, part, 1.0) for name, shares in person.carriages.items() for part in shares]
    found += [(f"colors.{name}", 0.0, part, 1.0) for name, color in person.colors.items() for part in color]
    return found
