"""The people that come with the program, made from its finished bodies when they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache, lru_cache
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType

import msgspec

from app.formats.textures import Texture, texture_of
from app.rig.characters.load_character import load_character
from app.rig.model import Character
from app.rig.people.body_shapes import Phenotype, body_m, body_shapes
from app.rig.people.make_person import Original, original_of, person_character
from app.rig.people.moved_joints import arm_after_m
from app.rig.people.person import Person, PersonName, hair_styles, phenotypes, read_person, skins


@cache
def bundled_people() -> Mapping[str, Path]:
    """Return the people: id and file, in the order of their ids. Looked up once."""
    folder = _folder() / "people"
    return MappingProxyType({path.stem: path for path in sorted(folder.glob("*.toml"))})


@lru_cache(maxsize=64)
def bundled_person(id: str) -> Person:
    """Return one of the people as its file says; KeyError where there is none."""
    return read_person(bundled_people()[id])


def like(id: str, measures: Mapping[str, float]) -> Person:
    """Return a person of the user's own who is like one of ours, with some measures of the phenotype changed."""
    person = bundled_person(id)
    phenotype = msgspec.structs.replace(person.phenotype, **measures)
    return msgspec.structs.replace(person, name=PersonName("", ""), not_cast_for=[], phenotype=phenotype)


def hands_id(id: str) -> str:
    """Return the id of the character whose hands a character of ours has: of a person the finished body's."""
    return bundled_person(id).original if id in bundled_people() else id


def not_cast_for(id: str) -> frozenset[str]:
    """Return the ids of instruments that a character of ours is too small for, and not cast for."""
    return frozenset(bundled_person(id).not_cast_for) if id in bundled_people() else frozenset()


def person_of(id: str, person: Person, named: Callable[[str], Character]) -> Character:
    """Make a person.

    Parameters
    ----------
    named : callable
        Gives a finished body by its id.
    """
    worn = {mesh: finished_body(named(owner), owner) for mesh, owner in person.worn.items()}
    if person.hair:
        worn["hair"] = _style(person.hair)
    original = finished_body(named(person.original), person.original)
    skin = _skin(person.skin) if person.skin else None
    return person_character(id, original, body_shapes(), whole_phenotype(person), person.colors, worn, skin)


def person_arm_m(person: Person, named: Callable[[str], Character]) -> float:
    """Return the length of a person's arm, upper and lower, before the person is made."""
    shapes = body_shapes()
    bodies = (body_m(shapes, one) for one in (whole_phenotype(person), phenotypes()[person.original]))
    after, before = (body[len(shapes.vertices) :] for body in bodies)
    return arm_after_m(named(person.original), dict(zip(shapes.joints, after - before, strict=True)))


def whole_phenotype(person: Person) -> Phenotype:
    """Return the phenotype of a person, who has the local changes of the finished body where there are no others."""
    local = {**phenotypes()[person.original].local, **person.phenotype.local}
    return msgspec.structs.replace(person.phenotype, local=local)


@lru_cache(maxsize=4)
def finished_body(character: Character, id: str) -> Original:
    """Prepare a finished body for making people from it; done once."""
    return original_of(character, body_shapes(), phenotypes()[id])


@lru_cache(maxsize=16)
def _style(name: str) -> Original:
    """Hair by itself on the finished body that it is fitted to."""
    path = hair_styles()[name]
    return original_of(load_character(path), body_shapes(), phenotypes()[path.parent.name])


@lru_cache(maxsize=16)
def _skin(name: str) -> Texture:
    return texture_of(f"skin_{name}_color", skins()[name].read_bytes())


def _folder() -> Path:
    return Path(str(files("resources"))) / "characters"
