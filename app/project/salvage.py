"""Extracts the largest part of a project that can be saved, if the whole cannot."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from itertools import islice
from typing import Any, Final, NamedTuple, TypeVar

from app.project.check import faults
from app.project.model import Project
from app.project.value_checks import Fault

T = TypeVar("T")

_MOST: Final = 1000
"""Number of examined errors in a field; with more, the whole value is discarded."""
_FIELD: Final = re.compile(r"\w+", re.ASCII)
_FIELDS: Final = {"edited_notes": "read_notes", "edited_curves": "read_curves"}
"""Names of fields of a project that differ from the keys of its file."""


class Salvaged(NamedTuple):
    """A project without the values that cannot be saved.

    Attributes
    ----------
    left_out : tuple of Fault
        Faults of the values that were left out or replaced by earlier ones.
    """

    project: Project
    left_out: tuple[Fault, ...]


def salvaged(project: Project, former: Project | None = None) -> Salvaged | None:
    """Return the project without the corrections, expressions and other values that cannot be saved.

    Parameters
    ----------
    former : Project, optional
        An earlier valid version of the project, which provides values that cannot be left out.

    Returns
    -------
    Salvaged or None
        None if nothing can be saved without an earlier version.
    """
    found = tuple(islice(faults(project), _MOST))
    places = [place for place, _ in found]
    less = _without(project, places)
    if _is_sound(less):
        return Salvaged(less, found)
    if former is None or not _is_sound(former):
        return None
    names = {name for place, _ in faults(less) if (name := _field(place)) is not None}
    mixed = replace(less, **{name: getattr(former, name) for name in names})
    return Salvaged(mixed if _is_sound(mixed) else former, found)


def _is_sound(project: Project) -> bool:
    return next(faults(project), None) is None


def _without(project: Project, places: list[str]) -> Project:
    return replace(
        project,
        corrections=_kept_items("corrections", project.corrections, places),
        dance_corrections=_kept_items("dance_corrections", project.dance_corrections, places),
        expressions=_kept("expressions", project.expressions, places),
        audio=None if _is_at("audio", places) else project.audio,
        video=None if _is_at("video", places) else project.video,
        source="" if _is_at("source", places) else project.source,
    )


def _kept_items(name: str, items: Mapping[str, tuple[T, ...]], places: list[str]) -> dict[str, tuple[T, ...]]:
    kept = {key: _kept(f"{name}[{key!r}]", values, places) for key, values in items.items()}
    return {key: values for key, values in kept.items() if values and f"{name}[{key!r}]" not in places}


def _kept(place: str, values: tuple[T, ...], places: list[str]) -> tuple[T, ...]:
    return tuple(value for index, value in enumerate(values) if not _is_at(f"{place}[{index}]", places))


def _is_at(place: str, places: list[str]) -> bool:
    """Return whether a key path equals one of the faulty key paths or contains one."""
    return any(one == place or one.startswith((f"{place}.", f"{place}[")) for one in places)


def _field(place: str) -> str | None:
    """Return the name of the project's field that contains a key path of its stored form; None if unknown."""
    found = _FIELD.match(place)
    name: Any = None if found is None else _FIELDS.get(found[0], found[0])
    return name if name in Project.__dataclass_fields__ else None
