"""The bundled people, made from bundled bodies when they are needed."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache, lru_cache
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Final

import msgspec

from app.formats.images import changed_by_stages
from app.formats.textures import Texture, texture_of
from app.rig.characters.load_character import load_character
from app.rig.model import Character
from app.rig.people.body_shapes import Phenotype, body_m, body_shapes, years_of
from app.rig.people.looks_by_age import colors_by_age, skin_change, skin_stages
from app.rig.people.make_person import SKIN_MATERIAL, Original, original_of, person_character
from app.rig.people.moved_joints import arm_after_m
from app.rig.people.person import Person, PersonName, hair_styles, originals, read_person, skins

SKIN_STEPS: Final = 8
"""Number of steps between one stage of skin by age and the next."""
PEOPLE_VERSION = 1
"""Version of the method that makes bodies from phenotypes; grips for people of another version are fitted again."""


@cache
def bundled_people() -> Mapping[str, Path]:
    """Return the files of the bundled people by id, in the order of their ids. Looked up once."""
    folder = _folder() / "people"
    return MappingProxyType({path.stem: path for path in sorted(folder.glob("*.toml"))})


@lru_cache(maxsize=64)
def bundled_person(id: str) -> Person:
    """Return the description of one of the bundled people; KeyError if there is none."""
    return read_person(bundled_people()[id])


def our_name(id: str) -> PersonName | None:
    """Return the names of a bundled character; None for any other."""
    named = bundled_person(id) if id in bundled_people() else originals().get(id)
    return None if named is None else named.name


def our_years(id: str) -> float:
    """Return the age of a bundled character in years."""
    return years_of((bundled_person(id).phenotype if id in bundled_people() else originals()[id]).age)


def like(id: str, measures: Mapping[str, float]) -> Person:
    """Return a new person for the user: a copy of a bundled one with some measures of the phenotype changed, whose hair
    and skin follow its age.
    """
    person = bundled_person(id)
    phenotype = msgspec.structs.replace(person.phenotype, **measures)
    return msgspec.structs.replace(
        person, name=PersonName("", ""), not_cast_for=[], phenotype=phenotype, looks_years=round(our_years(id), 2)
    )


def hands_id(id: str) -> str:
    """Return the id of the character that has the same hands as a bundled one: for a person, its bundled body."""
    return bundled_person(id).original if id in bundled_people() else id


def not_cast_for(id: str) -> frozenset[str]:
    """Return the ids of instruments that a bundled character is too small for and is not cast for."""
    return frozenset(bundled_person(id).not_cast_for) if id in bundled_people() else frozenset()


def person_of(id: str, person: Person, named: Callable[[str], Character]) -> Character:
    """Make the character of a person.

    Parameters
    ----------
    id : str
        Id of the character.
    named : callable
        Returns a bundled body by its id.
    """
    worn = {mesh: finished_body(finished_character(owner, named), owner) for mesh, owner in person.worn.items()}
    if person.hair:
        worn["hair"] = _style(person.hair)
    original = finished_body(finished_character(person.original, named), person.original)
    whole = whole_phenotype(person)
    skin = _skin_by_age(person, original.character)
    made = person_character(id, original, body_shapes(), whole, colors_by_age(person), worn, skin)
    return replace(made, made_of=_made_of(whole))


def finished_character(id: str, named: Callable[[str], Character]) -> Character:
    """Return a bundled body, read from its file or made from another body. Raises KeyError for other ids.

    ``named`` returns a character by its id.
    """
    table = originals()[id]
    return _made(id, named(table.made_from)) if table.made_from else named(id)


@lru_cache(maxsize=4)
def _made(id: str, before: Character) -> Character:
    """Return a bundled body that is made from another one (``before``), with hands of its own size."""
    table = originals()[id]
    original, shapes = finished_body(before, before.id), body_shapes()
    made = person_character(id, original, shapes, table, hands=table.hands, hip_joints_m=table.hip_joints_m)
    return replace(made, made_of=_made_of(table))


def _made_of(phenotype: Phenotype) -> str:
    """Return a digest of a phenotype and of the shapes, to identify the body, whose last bits differ between
    processors.
    """
    digest = hashlib.blake2b(f"{PEOPLE_VERSION}\n".encode(), digest_size=16)
    digest.update(msgspec.json.encode(phenotype, order="sorted"))
    digest.update(_shapes_digest())
    return digest.hexdigest()


@cache
def _shapes_digest() -> bytes:
    return hashlib.blake2b((_folder() / "bodies.arrays").read_bytes(), digest_size=16).digest()


def person_arm_m(person: Person, named: Callable[[str], Character]) -> float:
    """Return the length in metres of a person's upper and lower arm without making the person; ``named`` returns a body
    by id.
    """
    shapes = body_shapes()
    bodies = (body_m(shapes, one) for one in (whole_phenotype(person), originals()[person.original]))
    after, before = (body[len(shapes.vertices) :] for body in bodies)
    return arm_after_m(
        finished_character(person.original, named), dict(zip(shapes.joints, after - before, strict=True))
    )


def whole_phenotype(person: Person) -> Phenotype:
    """Return a person's phenotype, in which local changes that it does not set are those of the bundled body."""
    local = {**originals()[person.original].local, **person.phenotype.local}
    return msgspec.structs.replace(person.phenotype, local=local)


@lru_cache(maxsize=4)
def finished_body(character: Character, id: str) -> Original:
    """Prepare a bundled body for making people from it; cached."""
    return original_of(character, body_shapes(), originals()[id])


@lru_cache(maxsize=16)
def _style(name: str) -> Original:
    """Return a hairstyle, prepared on the bundled body that it was fitted to."""
    path = hair_styles()[name]
    return original_of(load_character(path), body_shapes(), originals()[path.parent.name])


def _skin_by_age(person: Person, original: Character) -> Texture | None:
    """Return the texture of a person's skin at its age; None for the bundled body's own."""
    before, after = skin_change(person)
    # In steps, since a texture takes a moment to make while a slider moves.
    after = before + round((after - before) * SKIN_STEPS) / SKIN_STEPS
    if after == before:
        return _skin(person.skin) if person.skin else None
    older = skin_stages(person)[1:]
    young = _own_skin(original)
    given = _skin(person.skin) if person.skin else young
    return changed_by_stages(given, (young, *map(_skin, older)), before, after)


def _own_skin(original: Character) -> Texture:
    """Return the texture of a bundled body's skin."""
    materials = (material for mesh in original.meshes for material in mesh.materials)
    return next(one.textures.color.texture for one in materials if one.name == SKIN_MATERIAL and one.textures.color)


@lru_cache(maxsize=16)
def _skin(name: str) -> Texture:
    return texture_of(f"skin_{name}_color", skins()[name].read_bytes())


def _folder() -> Path:
    return Path(str(files("resources"))) / "characters"
