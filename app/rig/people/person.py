"""A person as a file says: the finished body it is made from, its phenotype, colours, and whose clothes and hair."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType

import msgspec

from app.errors import MapError
from app.formats.toml import read_toml, shaped
from app.rig.people.body_shapes import Phenotype, age_of

Color = tuple[float, float, float]


class PersonName(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Names of a person in both languages."""

    en: str
    ja: str


class OriginalBody(Phenotype, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A finished body as a table says: its phenotype, and whoever can be made from it.

    Attributes
    ----------
    name : PersonName
        Empty of one that is there only to be made people from.
    made_from : str
        Id of another finished body that it is made from itself; empty: it is a file.
    hands : float
        Size of its hands, those of the body that it is made from being 1.
    hip_joints_m : float
        Distance between its hip joints; 0: as its phenotype moves them.
    heights_m, years : (float, float)
        Ranges of height and age of people made from it, whose hands are as large as its own.
    """

    name: PersonName = PersonName("", "")
    made_from: str = ""
    hands: float = 1.0
    hip_joints_m: float = 0.0
    heights_m: tuple[float, float] = (1.4, 2.1)
    years: tuple[float, float] = (15.0, 90.0)


class Person(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Contents of a file of a person.

    Attributes
    ----------
    original : str
        Id of the finished body: its hands stay as they are, everything else goes with the phenotype.
    name : PersonName
        Empty of the user's own people, who have a title.
    colors : dict of str to (float, float, float)
        By material: linear base colour.
    worn : dict of str to str
        By mesh (``hair``, ``shirt`` ...) the finished body that it is taken from.
    hair : str
        Style of hair by itself, a file of ``resources/characters/hair``; empty: the finished body's.
    skin : str
        Picture of the skin in ``resources/characters/skin``; empty: the finished body's.
    not_cast_for : list of str
        Ids of instruments that the body plays only beyond the bounds: it is too small for them.
    carriages : dict of str to (float, float, float)
        By instrument that the body carries in another way than is usual, so that its wrists stay straight: how far, in
        shares of the ranges of pitch, yaw and roll.
    """

    original: str
    phenotype: Phenotype
    name: PersonName = PersonName("", "")
    colors: dict[str, Color] = {}
    worn: dict[str, str] = {}
    hair: str = ""
    skin: str = ""
    not_cast_for: list[str] = []
    carriages: dict[str, tuple[float, float, float]] = {}


def read_person(path: Path) -> Person:
    """Read the file of a person. Raises FileError, MapError."""
    return checked(shaped(read_toml(path), Person, str(path)), str(path))


def checked(person: Person, file: str) -> Person:
    """Return a person whose numbers are within their bounds. Raises MapError ``table.invalid``."""
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
    """Return the styles of hair by themselves: id and file; its folder has the finished body's name."""
    return MappingProxyType({path.stem: path for path in sorted((_folder() / "hair").glob("*/*.glb"))})


@cache
def skins() -> Mapping[str, Path]:
    """Return the pictures of skin by themselves: id and file."""
    return MappingProxyType({path.stem: path for path in sorted((_folder() / "skin").glob("*.jpg"))})


def _folder() -> Path:
    return Path(str(files("resources"))) / "characters"


@cache
def originals() -> Mapping[str, OriginalBody]:
    """Return the finished bodies, by id."""
    path = _folder() / "originals.toml"
    return MappingProxyType(shaped(read_toml(path), dict[str, OriginalBody], str(path)))


def ranges(ids: Collection[str]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return between which heights in metres, and which years of age, people of some of the finished bodies are."""
    lows, highs = zip(*((one.heights_m, one.years) for one in map(originals().__getitem__, ids)), strict=True)
    (least_m, most_m), (youngest, oldest) = (zip(*both, strict=True) for both in (lows, highs))
    return (min(least_m), max(most_m)), (min(youngest), max(oldest))


def _bounded(person: Person) -> list[tuple[str, float, float, float]]:
    """Return place, least allowed value, value and greatest allowed value of each number of a person."""
    phenotype, original = person.phenotype, originals()[person.original]
    (least_m, most_m), (youngest, oldest) = original.heights_m, map(age_of, original.years)
    found = [("phenotype.height_m", least_m, phenotype.height_m, most_m)]
    found.append(("phenotype.age", youngest, phenotype.age, oldest))
    names = ("sex", "muscle", "weight", "proportions", "cup", "firmness", "african", "asian", "caucasian")
    found += [(f"phenotype.{name}", 0.0, getattr(phenotype, name), 1.0) for name in names]
    found += [(f"phenotype.local.{name}", -1.0, value, 1.0) for name, value in phenotype.local.items()]
    found += [(f"carriages.{name}", -1.0, part, 1.0) for name, shares in person.carriages.items() for part in shares]
    found += [(f"colors.{name}", 0.0, part, 1.0) for name, color in person.colors.items() for part in color]
    return found
