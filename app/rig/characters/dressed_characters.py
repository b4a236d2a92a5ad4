"""Characters in outfits: clothes can be changed on persons, not on other figures."""

from __future__ import annotations

from functools import lru_cache

from app.rig.characters.character_library import bundled_characters, character_library, character_named
from app.rig.model import Character
from app.rig.people.bundled_people import bundled_people, bundled_person, our_name
from app.rig.people.dressed import dressed, dressed_id
from app.rig.people.person import Person, originals
from app.rig.people.wardrobe import OutfitChoice, Tint, tailored_for, wardrobe


def person_behind(id: str) -> Person | None:
    """Return the person that a character is made from; None for other figures and unknown ids."""
    if id in bundled_characters():
        return Person(id, originals()[id])
    if id in bundled_people():
        return bundled_person(id)
    entry = character_library().own.get(id)
    return None if entry is None else entry.person


def character_in(id: str, choice: OutfitChoice) -> Character:
    """Return a character in an outfit, or unchanged if it is not a person. Raises the errors of `character_named`."""
    character = character_named(id)
    return _dressed(character, choice) if choice.id else character


def dressed_as(id: str, choice: OutfitChoice) -> str:
    """Return the id of the character that `character_in` returns, without building it. It differs for all clothes and
    colours.
    """
    person = person_behind(id)
    return id if person is None else dressed_id(id, person, choice)


def hats_of(id: str, choice: OutfitChoice) -> tuple[str, ...]:
    """Return the names of the meshes of hats that a character wears with an outfit, without building it."""
    outfit = wardrobe().get(choice.id)
    person = None if outfit is None else person_behind(id)
    made = None if outfit is None or person is None else outfit.files.get(tailored_for(person))
    return () if made is None else tuple(mesh for mesh, place in made[1].parts.items() if place == "hat")


def worn_colours(id: str, choice: OutfitChoice) -> dict[Tint, str] | None:
    """Return the colours of a character's outfit as worn, ``#rrggbb`` by part; None in its own clothes."""
    person, outfit = person_behind(id), wardrobe().get(choice.id)
    if person is None or outfit is None or tailored_for(person) not in outfit.files:
        return None
    own = outfit.colours_by_body.get(tailored_for(person), {})
    return {tint: choice.colour(tint) or colour for tint, colour in own.items()}


def character_title(id: str, language: str = "en") -> str:
    """Return the name of a bundled character in a language (``en`` or ``ja``), or the title of a user's own; empty if
    it has only an id.
    """
    name, entry = our_name(id), character_library().own.get(id)
    if name is None:
        return entry.title if entry is not None else ""
    return name.ja if language == "ja" else name.en


@lru_cache(maxsize=64)
def _dressed(character: Character, choice: OutfitChoice) -> Character:
    person = person_behind(character.id)
    return character if person is None else dressed(character, person, choice)
