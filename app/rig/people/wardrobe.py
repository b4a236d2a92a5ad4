"""The wardrobe: bundled outfits, and the facts stored in their files.

A file has only garments, skinned to the joints of the bundled body that they are fitted to. It is for everyone
(``<outfit>.glb``), or for people of one bundled body (``<outfit>_man.glb``, ``<outfit>_woman.glb``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, Literal

import msgspec

from app.errors import FileError
from app.formats.files import open_file
from app.formats.gltf.container import field, split
from app.rig.people.person import Person, PersonName, originals

Tint = Literal["main", "second", "accent"]
TINTS: Final[tuple[Tint, ...]] = ("main", "second", "accent")
"""Colours of an outfit that can be chosen."""
OWN_CLOTHES: Final = ""
"""Id of the character's own clothes, without an outfit."""
_HEADER: Final = 20
"""Number of bytes before the document in a binary glTF file."""


class OutfitChoice(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Clothes chosen for a character.

    Attributes
    ----------
    id : str
        Id of the outfit; empty for the person's own clothes.
    main, second, accent : str
        Colours as ``#rrggbb``; empty for those of the outfit.
    """

    id: str = OWN_CLOTHES
    main: str = ""
    second: str = ""
    accent: str = ""

    def colour(self, tint: Tint) -> str:
        """Return the chosen colour of a part of the outfit as ``#rrggbb``; empty if none was chosen."""
        chosen: str = getattr(self, tint)
        return chosen


NO_CHOICE: Final = OutfitChoice()


class OutfitFacts(msgspec.Struct, frozen=True):
    """Facts stored in a file of garments, under ``suisou.outfit`` in the extras of its scene.

    Attributes
    ----------
    body : str
        Bundled body that the garments are fitted to; empty if the file's name has it.
    parts : dict of str to str
        Place on the body where each mesh is worn, by mesh.
    hides : list of str
        Meshes of the person that are removed.
    hides_skin : list of int
        Vertices of the base mesh; faces of the skin between them are removed.
    tints : dict of str to str
        Chosen colour (main, second or accent) of each material of the file or of the person's own clothes.
    means : dict of str to float
        Mean of the neutral texture of each material, by which a colour is divided; 1 without a texture.
    """

    id: str
    title: PersonName
    parts: dict[str, str]
    body: str = ""
    hides: list[str] = []
    hides_skin: list[int] = []
    tints: dict[str, Tint] = {}
    means: dict[str, float] = {}


@dataclass(frozen=True)
class Outfit:
    """An outfit of the wardrobe.

    Attributes
    ----------
    files : mapping of str to (Path, OutfitFacts)
        File and facts for people that are tailored for as each bundled body (`tailored_for`).
    colours : dict of str to str
        The outfit's own colours as ``#rrggbb``, by part whose colour can be chosen, in their order.
    colours_by_body : mapping of str to dict of str to str
        The same as worn by people of each bundled body; parts that its garments do not have are missing.
    """

    id: str
    title: PersonName
    files: Mapping[str, tuple[Path, OutfitFacts]]
    colours: Mapping[Tint, str]
    colours_by_body: Mapping[str, Mapping[Tint, str]]

    @property
    def tints(self) -> tuple[Tint, ...]:
        """Parts of the outfit whose colour can be chosen."""
        return tuple(self.colours)


@cache
def wardrobe() -> Mapping[str, Outfit]:
    """Return the outfits by id, in their order. Looked up once. Raises FileError."""
    found: dict[str, dict[str, tuple[Path, OutfitFacts]]] = {}
    colours: dict[str, dict[str, dict[Tint, str]]] = {}
    for path in sorted(_folder().glob("*.glb")):
        facts, factors = _facts(path)
        ending = path.stem.rpartition("_")[2]
        bodies = _bodies_with_files()
        named = [id for id in bodies if id.partition("_")[0] == ending]
        body = facts.body or (named or bodies)[0]
        whole = msgspec.structs.replace(facts, body=body)
        worn_by = named or bodies
        for material, tint in facts.tints.items():
            factor = factors.get(material) or _factors(_document(_folder().parent / f"{body}.glb")).get(material)
            if factor is not None:
                mean = facts.means.get(material, 1.0)
                colour = _hexadecimal([mean * part for part in factor])
                for id in worn_by:
                    colours.setdefault(facts.id, {}).setdefault(id, {}).setdefault(tint, colour)
        for id in worn_by:
            found.setdefault(facts.id, {})[id] = (path, whole)
    return MappingProxyType({id: _outfit(id, found[id], colours.get(id, {})) for id in sorted(found)})


def tailored_for(person: Person) -> str:
    """Return the id of the bundled body whose garments a person wears: its own, or for a body that is made from
    another one, which has no garments, the one of the person's sex.
    """
    if not originals()[person.original].made_from:
        return person.original
    return min(_bodies_with_files(), key=lambda id: abs(originals()[id].sex - person.phenotype.sex))


def _bodies_with_files() -> list[str]:
    return [id for id, table in originals().items() if not table.made_from]


def _folder() -> Path:
    return Path(str(files("resources"))) / "characters" / "wardrobe"


def _outfit(id: str, made: Mapping[str, tuple[Path, OutfitFacts]], colours: Mapping[str, Mapping[Tint, str]]) -> Outfit:
    title = next(iter(made.values()))[1].title
    by_body = {body: {tint: own[tint] for tint in TINTS if tint in own} for body, own in colours.items()}
    of_all = {tint: next(own[tint] for own in by_body.values() if tint in own) for tint in TINTS if _has(by_body, tint)}
    return Outfit(id, title, MappingProxyType(dict(made)), MappingProxyType(of_all), MappingProxyType(by_body))


def _has(by_body: Mapping[str, Mapping[Tint, str]], tint: Tint) -> bool:
    return any(tint in own for own in by_body.values())


def _facts(path: Path) -> tuple[OutfitFacts, dict[str, list[float]]]:
    """Return the facts of a file of garments, and the linear base colours of its materials by name. Raises
    FileError.
    """
    document = _document(path)
    scenes: list[Any] = field(document, "scenes") or [None]
    told = field(field(field(scenes[0], "extras"), "suisou"), "outfit")
    try:
        return msgspec.convert(told, OutfitFacts), _factors(document)
    except msgspec.ValidationError as error:
        raise FileError("model.invalid", file=str(path), detail=f"damaged: {error}") from error


def _document(path: Path) -> dict[str, Any]:
    """Read the JSON document of a bundled glTF binary, without the rest of the file. Raises FileError."""
    with open_file(path) as stream:
        head = stream.read(_HEADER)
        document, _ = split(head + stream.read(int.from_bytes(head[12:16], "little")), str(path))
    return document


def _factors(document: dict[str, Any]) -> dict[str, list[float]]:
    """Return the linear base colours of the materials of a glTF document by name."""
    return {
        field(one, "name"): (field(field(one, "pbrMetallicRoughness"), "baseColorFactor") or [1.0, 1.0, 1.0])[:3]
        for one in field(document, "materials") or []
    }


def linear_colour(colour: str) -> tuple[float, float, float]:
    """Convert a colour ``#rrggbb`` to linear red, green and blue 0..1 (IEC 61966-2-1)."""
    red, green, blue = (int(colour[place : place + 2], 16) / 255.0 for place in (1, 3, 5))
    return _linear(red), _linear(green), _linear(blue)


def _hexadecimal(linear: Sequence[float]) -> str:
    """Convert a colour of linear red, green and blue 0..1 to ``#rrggbb``."""
    parts = [12.92 * value if value <= 0.0031308 else 1.055 * value ** (1.0 / 2.4) - 0.055 for value in linear]
    return "#" + "".join(f"{round(255.0 * min(max(part, 0.0), 1.0)):02x}" for part in parts)


def _linear(value: float) -> float:
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4
