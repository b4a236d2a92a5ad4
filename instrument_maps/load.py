"""Reading of instrument maps from TOML to `InstrumentMap`, with the exact place of faults."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

import msgspec

from app.errors import AppError, MapError, Message
from app.formats.files import files_in
from app.formats.table_cache import kept
from app.formats.toml import parse_toml, shaped, toml_text
from instrument_maps.extend import BASE, WITHOUT, extended, not_there
from instrument_maps.fingering_label import controls_of
from instrument_maps.model import InstrumentMap
from instrument_maps.validate import problems

FOLDER = Path(__file__).parent
"""Folder of the bundled maps."""

MODELS = FOLDER.parent / "resources" / "instruments"
"""Folder of the bundled models."""

NOT_MAPS = frozenset({"instrument_names.toml"})

MOST_BASES = 16
"""Greatest number of maps that extend each other in a chain."""


def parse_map(text: str, file: str) -> InstrumentMap:
    """Parse the text of a map file.

    Parameters
    ----------
    text : str
        Content of the file, TOML.
    file : str
        The file's name for messages.

    Raises
    ------
    MapError
        The text is invalid; with line and column, or the key path, of the first problem.
    """
    instrument = _shaped(text, file)
    for path, detail in problems(instrument):
        raise MapError("table.invalid", file=file, place=path, detail=detail)
    return instrument


def load_map(path: Path | str) -> InstrumentMap:
    """Read one map file.

    Raises
    ------
    MapError
        See `parse_map`.
    FileError
        The file cannot be read.
    """
    return parse_map(toml_text(path), str(path))


def check_map(path: Path | str) -> tuple[Message, ...]:
    """Return all faults of a map file including its model; empty for a valid map.

    A syntax or schema error hides later faults and is returned alone.
    """
    from instrument_maps.check_model import model_problems

    file = Path(path)
    try:
        instrument = _shaped(toml_text(file), str(file))
    except AppError as error:
        return (error.message,)
    found = [*problems(instrument)]
    if not any(where == "model" for where, _ in found):
        model = file.parent / instrument.model
        found += model_problems(instrument, model if os.path.exists(model) else MODELS / instrument.model)
    return tuple(
        Message("table.invalid", {"file": str(file), "place": where, "detail": detail}) for where, detail in found
    )


@cache
def bundled_maps() -> Mapping[str, InstrumentMap]:
    """Return the bundled maps by id, sorted."""
    return kept("maps", "maps", FOLDER, _KEPT, lambda: _folder_maps(FOLDER))


def model_path(instrument: InstrumentMap) -> Path:
    """Return the file of a bundled map's model. Raises MapError if there is none."""
    path = MODELS / instrument.model
    if not os.path.isfile(path):
        raise MapError("map.unreadable", file=instrument.model, detail="no such model")
    return path


def _folder_maps(folder: Path) -> dict[str, InstrumentMap]:
    return {path.stem: named_map(path) for path in files_in(folder, ".toml") if path.name not in NOT_MAPS}


def named_map(path: Path) -> InstrumentMap:
    """Read a map file whose name must equal the map's id. Raises as `load_map`."""
    instrument = load_map(path)
    if instrument.id != path.stem:
        detail = f"'{instrument.id}' is not the file's name, '{path.stem}'"
        raise MapError("table.invalid", file=str(path), place="id", detail=detail)
    return instrument


def _shaped(text: str, file: str) -> InstrumentMap:
    """Parse, extend and convert a map, checking only the types of its values."""
    instrument = shaped(_extended(parse_table(text, file), file, ()), InstrumentMap, file)
    reported = [
        msgspec.structs.replace(fingering, controls=controls_of(fingering.label, instrument.controls) or {})
        if not fingering.controls
        else fingering
        for fingering in instrument.fingerings
    ]
    return msgspec.structs.replace(instrument, fingerings=tuple(reported))


@lru_cache(maxsize=4)
def parse_table(text: str, file: str) -> dict[str, Any]:
    """Parse a map's file as TOML. The table must not be modified, since several maps extend it. Raises MapError."""
    return parse_toml(text, file)


def _extended(table: dict[str, Any], file: str, above: tuple[Path, ...]) -> dict[str, Any]:
    """Merge a map's table with the map that it extends, which is searched for in the same folder and then among the
    bundled maps; ``above`` are the files that extend this one.
    """
    if BASE not in table:
        return table
    base, own = table[BASE], Path(file).absolute()
    if not isinstance(base, str) or not base.isidentifier():
        raise MapError("table.invalid", file=file, place=BASE, detail=f"{base!r} is not the id of a map")
    # The user's map may extend the bundled one of the same name.
    paths = [path for path in (folder / f"{base}.toml" for folder in (own.parent, FOLDER)) if path != own]
    path = next((path for path in paths if os.path.isfile(path)), None)
    if path in above or (path is None and base == own.stem):
        raise MapError("table.invalid", file=file, place=BASE, detail=f"'{base}' extends itself")
    if len(above) >= MOST_BASES:
        raise MapError("table.invalid", file=file, place=BASE, detail=f"more than {MOST_BASES} maps extend one another")
    if path is None:
        raise MapError("table.invalid", file=file, place=BASE, detail=f"there is no map named '{base}'")
    below = _extended(parse_table(toml_text(path), str(path)), str(path), (*above, own))
    wrong = not_there(below, table)
    if wrong is not None:
        raise MapError("table.invalid", file=file, place=WITHOUT, detail=wrong)
    return extended(below, table)


# Created while the import lock is held: msgspec crashes if two threads use a type for the first time at once.
_KEPT = msgspec.msgpack.Decoder(dict[str, InstrumentMap])
