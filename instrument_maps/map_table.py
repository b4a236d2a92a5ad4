"""Base class of the tables of an instrument map."""

from __future__ import annotations

from typing import Literal, TypeAlias

import msgspec

Vector: TypeAlias = tuple[float, float, float]
Hand: TypeAlias = Literal["left", "right"]
Posture: TypeAlias = Literal["standing", "seated"]


class MapTable(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Base class of the tables in a map file: immutable, and refusing unknown keys."""
