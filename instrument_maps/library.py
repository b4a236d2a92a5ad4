"""The instruments a person has: the bundled maps and those of their own folder, read again when its files change.

A person's own map wins over the bundled one of its id; what is wrong with a file is told and the last good version of
it stays in use. Everybody asks `library`; `reload` alone replaces it, by another value.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from threading import RLock
from typing import TypeAlias

import msgspec
import platformdirs

from app.errors import AppError, MapError, Message
from app.formats.files import files_in
from instrument_maps.check_model import model_problems
from instrument_maps.load import MODELS, NOT_MAPS, bundled_maps, named_map
from instrument_maps.model import InstrumentMap

FOLDER_VARIABLE = "SUISOU_INSTRUMENTS"
"""Environment variable that names another folder for a person's own maps."""

Stamp: TypeAlias = frozenset[tuple[str, int, int]]
"""Names, times and sizes of the files of a folder; and why it could not be listed."""


def own_folder() -> Path:
    """Where a person's own maps and models are; need not exist."""
    named = os.environ.get(FOLDER_VARIABLE)
    return Path(named) if named else platformdirs.user_data_path("suisou", appauthor=False) / "instruments"


@dataclass(frozen=True)
class Library:
    """All instruments, as they were when the folders were read.

    Attributes
    ----------
    folder : Path
        A person's own.
    maps : mapping of str to InstrumentMap
        By id, in the order of the ids. As long as a map and its model are what they were, it is the same object.
    own : mapping of str to Path
        Files of the maps that are a person's own.
    problems : mapping of Path to tuple of Message
        What is wrong with a person's files. Where an earlier version of such a map was good, ``maps`` has that.
    revisions : mapping of str to int
        How often the map of each id became another one; of those that never did, nothing.
    stamp : frozenset
        The files that were read.
    """

    folder: Path
    maps: Mapping[str, InstrumentMap]
    own: Mapping[str, Path] = field(default_factory=dict)
    problems: Mapping[Path, tuple[Message, ...]] = field(default_factory=dict)
    revisions: Mapping[str, int] = field(default_factory=dict)
    stamp: Stamp = frozenset()

    def find(self, id: str) -> InstrumentMap:
        """Return the map of this id; MapError (``map.unknown``) where there is none."""
        try:
            return self.maps[id]
        except KeyError:
            raise MapError("map.unknown", id=id) from None

    def model_path(self, instrument: InstrumentMap) -> Path:
        """Return the file of a map's model: beside a person's own map, else the bundled one.

        Raises
        ------
        MapError
            ``map.unreadable`` where no folder has it.
        """
        folders = (self.folder, MODELS) if instrument.id in self.own else (MODELS,)
        for folder in folders:
            if os.path.isfile(folder / instrument.model):
                return folder / instrument.model
        raise MapError("map.unreadable", file=instrument.model, detail="no such model")


def read_library(folder: Path, before: Library | None = None) -> Library:
    """Read a person's folder anew.

    Parameters
    ----------
    folder : Path
        One that is not there holds no maps.
    before : Library, optional
        What was read before: unchanged maps stay the objects they were, and the good versions of files that are wrong
        now stay in use.
    """
    problems: dict[Path, tuple[Message, ...]] = {}
    listed = _listed(folder, problems)
    stamp = _stamp(listed) | {(problem.id, 0, 0) for told in problems.values() for problem in told}
    if before is not None and before.folder == folder and before.stamp == stamp:
        return before
    maps, own = dict(bundled_maps()), dict[str, Path]()
    for path in listed:
        if path.suffix.lower() != ".toml" or path.name in NOT_MAPS:
            continue
        earlier = None if before is None or path.stem not in before.own else before.maps[path.stem]
        found, wrong = _own_map(path)
        if wrong:
            problems[path] = wrong
            found = earlier
        if found is None:
            continue
        own[path.stem] = path
        same = found == earlier and _model_stamp(stamp, found) == _model_stamp(before.stamp if before else stamp, found)
        maps[path.stem] = earlier if same and earlier is not None else found
    revisions = dict(before.revisions) if before is not None else {}
    known = before.maps if before is not None else maps
    for id in {**maps, **known}:
        if maps.get(id) is not known.get(id):
            revisions[id] = revisions.get(id, 0) + 1
    return Library(folder, dict(sorted(maps.items())), own, problems, revisions, stamp)


def _own_map(path: Path) -> tuple[InstrumentMap | None, tuple[Message, ...]]:
    """A map of a person's folder, or everything that is wrong with it."""
    try:
        instrument = named_map(path)
    except AppError as error:
        return None, (error.message,)
    beside = path.parent / instrument.model
    wrong = model_problems(instrument, beside if os.path.isfile(beside) else MODELS / instrument.model)
    told = tuple(
        Message("table.invalid", {"file": str(path), "place": where, "detail": detail}) for where, detail in wrong
    )
    return (None if told else msgspec.structs.replace(instrument)), told


def _listed(folder: Path, problems: dict[Path, tuple[Message, ...]]) -> list[Path]:
    """Maps and models of a person's folder; what is wrong with the folder itself is added to the problems."""
    try:
        return files_in(folder, ".toml", ".glb")
    except AppError as error:
        problems[folder] = (error.message,)
        return []


def _stamp(paths: Iterable[Path]) -> Stamp:
    stamps = []
    for path in paths:
        try:
            status = path.stat()
        except OSError:
            continue  # Gone between listing and looking: as if it were not listed.
        stamps.append((path.name, status.st_mtime_ns, status.st_size))
    return frozenset(stamps)


def _model_stamp(stamp: Stamp, instrument: InstrumentMap) -> Stamp:
    return frozenset(row for row in stamp if row[0] == instrument.model)


_lock = RLock()
_library: Library | None = None


def begin() -> Library:
    """Have the bundled maps alone, unless the folder was read already: for a program that reads it beside its window
    (`reload`)."""
    global _library
    with _lock:
        _library = _library or Library(own_folder(), dict(sorted(bundled_maps().items())))
        return _library


def library() -> Library:
    """Return the instruments as they were last read; the first who asks reads them."""
    return _library if _library is not None else reload()


def reload() -> Library:
    """Read the person's folder again if something in it changed, and return what everybody gets from now on."""
    global _library
    with _lock:
        _library = read_library(own_folder(), _library)
        return _library


def find_map(id: str) -> InstrumentMap:
    """Return the map of this id; MapError (``map.unknown``) where there is none."""
    return library().find(id)


def all_maps() -> Mapping[str, InstrumentMap]:
    """Return all maps by id, in the order of the ids."""
    return library().maps


def model_path(instrument: InstrumentMap) -> Path:
    """Return the file of a map's model; see `Library.model_path`."""
    return library().model_path(instrument)
