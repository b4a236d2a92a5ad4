"""Presets shared between projects: a player's parameters, and expressions.

Each is a small TOML file in a user folder. It contains its name; the file's name is a cleaned form of that. A project
stores copies of the expressions it uses and does not need these files.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Generic, TypeVar

import msgspec
import platformdirs

from app.encoding import restored, stored
from app.errors import MapError, Message, UsageError
from app.formats.atomic import atomic_write
from app.formats.files import cannot_write, files_in
from app.formats.toml import read_toml, toml
from app.formats.user_folder import Named
from app.plan.parameters import PARAMETERS, PlayerParameters
from app.project import limits
from app.project.check import expression_faults
from app.project.names import clean_name, file_stem
from app.project.parameters import is_possible, range_text
from metadata.load import read_named_expression
from metadata.model import Expression

T = TypeVar("T")

_SHARED: Final = tuple(name for name, parameter in PARAMETERS.items() if not parameter.is_own)
"""Parameters in presets: those that can apply to many players."""
_NAME: Final = "name"


class Preset(msgspec.Struct, frozen=True):
    """A named set of parameters of a player."""

    name: str
    parameters: dict[str, Any]


@dataclass(frozen=True)
class PresetFolder(Generic[T]):
    """Contents of a folder: valid items by name, and messages about invalid files."""

    items: Mapping[str, T]
    problems: tuple[Message, ...] = ()


def preset_folder() -> Path:
    """Return the folder of the user's presets."""
    return platformdirs.user_config_path("suisou", appauthor=False) / "presets"


def expression_folder() -> Path:
    """Return the folder of the user's expressions."""
    return platformdirs.user_data_path("suisou", appauthor=False) / "expressions"


def preset_of(parameters: PlayerParameters, name: str) -> Preset:
    """Create a preset from a player's shareable parameters. Raises UsageError for an empty name."""
    cleaned = clean_name(name)[: limits.MOST_NAME]
    if not cleaned:
        raise UsageError("preset.no_name")
    return Preset(cleaned, {field: getattr(parameters, field) for field in _SHARED})


def presets(folder: Path) -> PresetFolder[Preset]:
    """Read all presets in a folder, sorted by name."""
    return PresetFolder(*_PRESETS.found(folder))


def save_preset(folder: Path, preset: Preset) -> None:
    """Save a preset, replacing one of the same name. Raises FileError."""
    texts = {name: stored(value) if isinstance(value, str) else value for name, value in preset.parameters.items()}
    _save(folder, preset.name, presets(folder).items, _PRESETS, texts)


def delete_preset(folder: Path, name: str) -> None:
    """Delete a preset. Raises UsageError for an unknown name, FileError if its file cannot be deleted."""
    _delete(folder, name, _PRESETS)


def expressions(folder: Path) -> PresetFolder[Expression]:
    """Read all expressions in a folder, sorted by name."""
    return PresetFolder(*_EXPRESSIONS.found(folder))


def save_expression(folder: Path, expression: Expression) -> None:
    """Save an expression, replacing one of the same name. Raises UsageError or FileError."""
    cleaned = clean_name(expression.name)[: limits.MOST_NAME]
    if not cleaned:
        raise UsageError("expression.no_name")
    for place, detail in expression_faults(expression, ""):
        raise UsageError("expression.invalid", name=cleaned, place=place.lstrip("."), detail=detail)
    table = {field: getattr(expression, field) for field in Expression.__struct_fields__ if field != _NAME}
    _save(folder, cleaned, expressions(folder).items, _EXPRESSIONS, table)


def delete_expression(folder: Path, name: str) -> None:
    """Delete an expression. Raises UsageError for an unknown name, FileError if its file cannot be deleted."""
    _delete(folder, name, _EXPRESSIONS)


def _read_preset(path: Path) -> Preset:
    table = read_toml(path, path.name)
    name = table.pop(_NAME, None)
    if not isinstance(name, str) or not 0 < len(name) <= limits.MOST_NAME or name != clean_name(name):
        raise MapError("table.invalid", file=path.name, place=_NAME, detail="must be a name on one line")
    table = {parameter: restored(value) if isinstance(value, str) else value for parameter, value in table.items()}
    for parameter, value in table.items():
        if parameter not in _SHARED:
            raise MapError("table.invalid", file=path.name, place=parameter, detail="not a parameter of presets")
        if not is_possible(parameter, value):
            raise MapError(
                "table.invalid", file=path.name, place=parameter, detail=f"possible: {range_text(parameter)}"
            )
    return Preset(name, table)


_PRESETS: Final = Named(_read_preset, lambda preset: preset.name)
_EXPRESSIONS: Final = Named(read_named_expression, lambda expression: expression.name)


def _save(folder: Path, name: str, known: Mapping[str, object], tables: Named[Any], table: Mapping[str, Any]) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(folder, error) from error
    path = tables.path_of(folder, name) if name in known else None
    if path is None:
        stem = file_stem(name)
        taken = {existing.stem.casefold() for existing in files_in(folder, ".toml")}
        number, path = 2, folder / f"{stem}.toml"
        while path.stem.casefold() in taken:
            number, path = number + 1, folder / f"{stem} ({number}).toml"
    with atomic_write(path) as stream:
        stream.write(toml({_NAME: name, **table}).encode())


def _delete(folder: Path, name: str, tables: Named[Any]) -> None:
    path = tables.path_of(folder, name)
    if path is None:
        raise UsageError("preset.none_of_name", name=name)
    try:
        path.unlink()
    except OSError as error:
        raise cannot_write(path, error) from error
