"""Shapes that the renderer draws: players, the crowd behind them, and solids."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from vispy import gloo

from widgets.viewport.cast import Member, Stage
from widgets.viewport.geometry import (
    Crowd,
    character_levels,
    crowd,
    edges,
    instrument_levels,
    stand,
    supports_geometry,
)
from widgets.viewport.shape_model import Geometry, LevelsOfDetail

MOST_NEAR = 12
"""Greatest number of performers that are drawn with finer levels of detail while the picture moves."""
MOST_NEAR_AT_REST = 30
"""The same in a picture that stays or is kept, such as a film's: a school's band."""


@dataclass(frozen=True, eq=False)
class Shapes:
    """Geometries of everything on a stage, by level of detail: characters by id, instruments by map id; straps and
    chairs by player id; the stand.
    """

    characters: Mapping[str, LevelsOfDetail]
    instruments: Mapping[str, LevelsOfDetail]
    supports: Mapping[str, Geometry]
    stand: Geometry


def shapes_of(stage: Stage, before: Shapes | None = None) -> Shapes:
    """Return the shapes of a stage, reusing those in ``before``. Finer levels of detail are made if all performers may
    be near; in a larger band when they are seen near.
    """
    # Clothes that are no longer worn are dropped, or each colour tried would be kept.
    known = {} if before is None else before.characters
    characters: dict[str, LevelsOfDetail] = {}
    for member in stage.members:
        character = member.assets.character
        if character.id not in characters:
            found = known.get(character.id)
            characters[character.id] = character_levels(character) if found is None else found
    # Nodes of instruments and straps are numbered after all joints, which depends on the other players.
    instruments, supports = {}, {}
    for member in stage.members:
        if member.assets.held is not None and member.assets.map.id not in instruments:
            instruments[member.assets.map.id] = instrument_levels(member.assets.instrument, stage.first_node)
        if member.supports is not None:
            supports[member.player_id] = supports_geometry(member.supports, stage.first_support)
    if len(stage.members) <= MOST_NEAR:
        for levels in (*characters.values(), *instruments.values()):
            levels.complete()
    return Shapes(characters, instruments, supports, stand(stage.stand_bone))


def crowd_of(stage: Stage, shapes: Shapes) -> Crowd:
    """Return the coarsest geometries of all performers, concatenated."""
    parts: list[tuple[int, Geometry]] = []
    for row, member in enumerate(stage.members):
        if member.has_body:
            parts.append((row, shapes.characters[member.assets.character.id][-1]))
        if member.assets.held is not None:
            parts.append((row, shapes.instruments[member.assets.map.id][-1]))
        if member.supports is not None:
            parts.append((row, shapes.supports[member.player_id]))
        if member.stand_m is not None:
            parts.append((row, shapes.stand))
    return crowd(parts)


def unmade(stage: Stage, shapes: Shapes, rows: Iterable[int]) -> dict[int, list[LevelsOfDetail]]:
    """Return those of some members of a stage, by row, of whom finer levels of detail are not made yet, with these."""
    found: dict[int, list[LevelsOfDetail]] = {}
    for row in map(int, rows):
        member = stage.members[row]
        drawn = [shapes.characters[member.assets.character.id]] if member.has_body else []
        drawn += [shapes.instruments[member.assets.map.id]] if member.assets.held is not None else []
        missing = [levels for levels in drawn if not levels.is_complete]
        if missing:
            found[row] = missing
    return found


def looks_same(one: Stage, other: Stage) -> bool:
    return len(one.members) == len(other.members) and all(
        own.assets is its.assets and parts_of(own) == parts_of(its)
        for own, its in zip(one.members, other.members, strict=True)
    )


def parts_of(member: Member) -> tuple[bool, object, bool]:
    return member.has_body, member.supports, member.stand_m is not None


def sides(geometry: Geometry | Crowd) -> tuple[tuple[bool, Any], ...]:
    """Return the triangles as index buffers, one-sided and two-sided ones, each with whether back faces are culled."""
    parts = ((True, geometry.triangles[: geometry.one_sided]), (False, geometry.triangles[geometry.one_sided :]))
    return tuple((culled, gloo.IndexBuffer(part)) for culled, part in parts if len(part))


def looks(geometry: Geometry) -> tuple[tuple[bool, int, Any], ...]:
    """Return the triangles of each textured material: whether back faces are culled, index of the material in
    `Geometry.looks` (-1 for vertex colours), and an index buffer.
    """
    if geometry.groups is None:
        return tuple((culled, -1, indices) for culled, indices in sides(geometry))
    groups = ((int(first), int(count), int(look)) for first, count, look in geometry.groups)
    return tuple(
        (first < geometry.one_sided, look, gloo.IndexBuffer(geometry.triangles[first : first + count]))
        for first, count, look in groups
    )


def draw_sides(program: Any, sides: tuple[tuple[bool, Any], ...]) -> None:
    for culled, triangles in sides:
        gloo.set_state(cull_face=culled)
        program.draw("triangles", triangles)


class Solid:
    """A geometry in buffers of the graphics card.

    Parameters
    ----------
    fine : bool
        Whether it is the finest level of detail of its figure.
    """

    def __init__(self, geometry: Geometry, fine: bool = False) -> None:
        self.geometry, self.fine = geometry, fine
        self.surface = gloo.VertexBuffer(geometry.surface)
        self.triangles = looks(geometry)
        self.uvs = None if geometry.uvs is None else gloo.VertexBuffer(np.ascontiguousarray(geometry.uvs))
        self._shape: Any = None
        self._edges: Any = None

    @property
    def shape(self) -> Any:
        """The vertices at rest as a vertex buffer, made at the first use."""
        if self._shape is None:
            self._shape = gloo.VertexBuffer(self.geometry.shape)
        return self._shape

    @property
    def edges(self) -> Any:
        """The edges, each once, as an index buffer, made at the first use."""
        if self._edges is None:
            self._edges = gloo.IndexBuffer(edges(self.geometry))
        return self._edges
