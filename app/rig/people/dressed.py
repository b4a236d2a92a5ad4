"""People in outfits: garments from a file are fitted to a body and replace its own clothes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Final

import numpy as np

from app.arrays import BoolArray, IndexArray
from app.formats.scene import Material
from app.rig.characters.load_character import load_character
from app.rig.mesh import Mesh
from app.rig.model import Character, Landmark
from app.rig.people.body_shapes import body_shapes
from app.rig.people.bundled_people import finished_body, whole_phenotype
from app.rig.people.laps import laid_on_lap
from app.rig.people.make_person import SKIN, SKIN_MATERIAL, Original, carried, original_of
from app.rig.people.person import Person, originals
from app.rig.people.wardrobe import OutfitChoice, OutfitFacts, linear_colour, tailored_for, wardrobe

SAME_PLACE: Final = 1e-5
"""Distance in texture coordinates up to which two vertices are at one place of the skin."""


def dressed_id(id: str, person: Person, choice: OutfitChoice) -> str:
    """Return the id of a character in its clothes; without an outfit, its own id."""
    outfit = wardrobe().get(choice.id)
    if outfit is None or tailored_for(person) not in outfit.files:
        return id
    colours = (f"{tint}_{choice.colour(tint)[1:]}" for tint in outfit.tints if choice.colour(tint))
    return "-".join((id, choice.id, *colours))


def dressed(character: Character, person: Person, choice: OutfitChoice) -> Character:
    """Return a person in an outfit; body, face and hair are shared with the person in its own clothes.

    Parameters
    ----------
    character : Character
        Character made from ``person``.
    choice : OutfitChoice
        Outfit and colours; with an unknown outfit the person is returned unchanged.
    """
    outfit = wardrobe().get(choice.id)
    if outfit is None or tailored_for(person) not in outfit.files:
        return character
    path, facts = outfit.files[tailored_for(person)]
    table = originals()[person.original]
    other = None if facts.body in (person.original, table.made_from) else character
    file = _garments(path, facts.body)
    finished, skin = _finished(character), next(mesh for mesh in character.meshes if mesh.name == SKIN)
    worn = carried(file, body_shapes(), whole_phenotype(person), table.hands, other)
    worn = _seated_well(worn, facts, character)
    worn = tuple(_joined(mesh, file, finished, skin) for mesh in worn)
    own = [_uncovered(mesh, facts, finished) for mesh in character.meshes if mesh.name not in facts.hides]
    own, garments = ([_coloured(mesh, facts, choice, skin) for mesh in meshes] for meshes in (own, worn))
    landmarks = {
        name: _on(garments, character, mark) if mark.mesh in facts.hides else mark
        for name, mark in character.landmarks.items()
    }
    id, meshes = dressed_id(character.id, person, choice), (*own, *garments)
    return replace(character, id=id, meshes=meshes, landmarks=landmarks, undressed=character)


@lru_cache(maxsize=64)
def without(character: Character, names: tuple[str, ...]) -> Character:
    """Return a dressed character without some garments, under an id of its own; equal ones share one object."""
    if not names:
        return character
    kept = tuple(mesh for mesh in character.meshes if mesh.name not in names)
    return replace(character, id=id_without(character.id, names), meshes=kept)


def id_without(id: str, names: Sequence[str]) -> str:
    """Return the id of a dressed character that leaves off some garments."""
    return "-".join((id, *(f"without_{name}" for name in names)))


def _finished(character: Character) -> Character:
    """Return the finished body that a character was made from, directly or through another body."""
    while character.made_from is not None:
        character = character.made_from
    return character


def _seated_well(worn: tuple[Mesh, ...], facts: OutfitFacts, character: Character) -> tuple[Mesh, ...]:
    """Return garments in which coats and shirts lie on the lap of a seated player."""
    below = [mesh for mesh in worn if facts.parts.get(mesh.name) == "bottom"]
    return tuple(laid_on_lap(mesh, below, character) if facts.parts.get(mesh.name) == "top" else mesh for mesh in worn)


def _joined(mesh: Mesh, file: Original, finished: Character, skin: Mesh) -> Mesh:
    """Return a mesh of an outfit; where its bare skin continues the person's own, as at a wrist, both get the same
    vertices.
    """
    if any(material.name != SKIN_MATERIAL for material in mesh.materials):
        return mesh
    rows, body_rows = _common_vertices(file, mesh.name, finished)
    positions_m, normals = mesh.positions_m.copy(), mesh.normals.copy()
    positions_m[rows], normals[rows] = skin.positions_m[body_rows], skin.normals[body_rows]
    return replace(mesh, positions_m=positions_m, normals=normals)


@lru_cache(maxsize=64)
def _common_vertices(file: Original, name: str, finished: Character) -> tuple[IndexArray, IndexArray]:
    """Return the vertices of a mesh of an outfit that have the texture coordinates of vertices of a finished body's
    skin, and these. All bodies share the layout of the skin, also those that the outfit was not fitted to.
    """
    from scipy.spatial import cKDTree  # slow to import; needed for few outfits

    mesh = next(mesh for mesh in file.character.meshes if mesh.name == name)
    skin = next(mesh for mesh in finished.meshes if mesh.name == SKIN)
    far, nearest = cKDTree(skin.uvs).query(mesh.uvs)
    rows = np.flatnonzero(np.asarray(far) < SAME_PLACE)
    return rows, np.asarray(nearest, np.intp)[rows]


def _on(garments: Sequence[Mesh], character: Character, mark: Landmark) -> Landmark:
    """Return a landmark of a removed mesh, such as the sole of a shoe, placed on the nearest vertices of the
    garments.
    """
    before = next(mesh for mesh in character.meshes if mesh.name == mark.mesh)
    place_m = before.positions_m[mark.vertices].mean(axis=0)
    far_m = [np.linalg.norm(mesh.positions_m - place_m, axis=1) for mesh in garments]
    garment = min(range(len(garments)), key=lambda index: float(far_m[index].min()))
    nearest = np.argsort(far_m[garment], kind="stable")[: len(mark.vertices)]
    return Landmark(garments[garment].name, nearest.astype(np.int32))


@lru_cache(maxsize=48)
def _garments(path: Path, body: str) -> Original:
    """Return the garments of a file, prepared on the bundled body that they were fitted to."""
    return original_of(load_character(path), body_shapes(), originals()[body])


def _uncovered(mesh: Mesh, facts: OutfitFacts, finished: Character) -> Mesh:
    """Return a mesh of a person without the skin that clothes cover. Vertices stay, so that landmarks keep their
    indices.
    """
    if mesh.name != SKIN or not facts.hides_skin:
        return mesh
    seen = _seen_triangles(finished, tuple(facts.hides_skin))
    return replace(mesh, triangles=mesh.triangles[seen], triangle_materials=mesh.triangle_materials[seen])


@lru_cache(maxsize=32)
def _seen_triangles(finished: Character, hidden: tuple[int, ...]) -> BoolArray:
    """Return for each triangle (T,) of a bundled body's skin whether it stays visible; ``hidden`` are vertices of the
    base mesh under clothes.
    """
    made, shapes = finished_body(finished, finished.id), body_shapes()
    covered = np.isin(shapes.vertices[made.bindings[SKIN].corners[:, 0]], hidden)
    skin = next(mesh for mesh in finished.meshes if mesh.name == SKIN)
    return np.asarray(~covered[skin.triangles].all(axis=1))


def _coloured(mesh: Mesh, facts: OutfitFacts, choice: OutfitChoice, skin: Mesh) -> Mesh:
    """Return a mesh in the chosen colours; where a garment shows skin, it gets the person's."""
    materials = _materials(mesh.materials, facts, choice, skin)
    return mesh if materials == mesh.materials else replace(mesh, materials=materials)


def _materials(
    materials: Sequence[Material], facts: OutfitFacts, choice: OutfitChoice, skin: Mesh
) -> tuple[Material, ...]:
    made = []
    for material in materials:
        tint = facts.tints.get(material.name)
        if material.name == SKIN_MATERIAL:
            material = next(one for one in skin.materials if one.name == SKIN_MATERIAL)
        elif tint is not None and choice.colour(tint):
            mean = facts.means.get(material.name, 1.0)
            red, green, blue = (min(1.0, part / mean) for part in linear_colour(choice.colour(tint)))
            material = replace(material, base_color=(red, green, blue, material.base_color[3]))
        made.append(material)
    return tuple(made)
