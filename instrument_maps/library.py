"""The available instruments: bundled maps, and those in the user's own folder (see `app.formats.user_folder`)."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import msgspec

from app.errors import MapError, Message
from app.formats.user_folder import Read, Shelf, UserFolder
from instrument_maps.check_model import model_problems
from instrument_maps.load import MODELS, NOT_MAPS, bundled_maps, named_map
from instrument_maps.model import InstrumentMap
from instrument_maps.score_order import in_score_order


@dataclass(frozen=True)
class Library(Shelf[InstrumentMap]):
    """All available instruments, as the folders were last read."""

    @cached_property
    def maps(self) -> Mapping[str, InstrumentMap]:
        """All maps by id, in the order of ids."""
        return dict(sorted(self.items.items()))

    @cached_property
    def in_score_order(self) -> tuple[InstrumentMap, ...]:
        """All maps in the order in which a score lists instruments."""
        return tuple(in_score_order(self.maps.values()))

    @property
    def own(self) -> Mapping[str, Path]:
        """Files of the maps that the user added, by map id."""
        return self.files

    def find(self, id: str) -> InstrumentMap:
        """Return the map with an id. Raises MapError if there is none."""
        try:
            return self.maps[id]
        except KeyError:
            raise MapError("map.unknown", id=id) from None

    def model_path(self, instrument: InstrumentMap) -> Path:
        """Return the file of a map's model: beside the user's own map, else the bundled one.

        Raises
        ------
        MapError
            The model is in no folder.
        """
        folders = (self.folder, MODELS) if instrument.id in self.own else (MODELS,)
        for folder in folders:
            if os.path.isfile(folder / instrument.model):
                return folder / instrument.model
        raise MapError("map.unreadable", file=instrument.model, detail="no such model")


def _own_map(path: Path) -> Read[InstrumentMap]:
    """Read a map in the user's folder: the map, or all its faults. Raises AppError."""
    instrument = named_map(path)
    beside = path.parent / instrument.model
    wrong = model_problems(instrument, beside if os.path.isfile(beside) else MODELS / instrument.model)
    reported = tuple(
        Message("table.invalid", {"file": str(path), "place": where, "detail": detail}) for where, detail in wrong
    )
    # Another model makes another instrument, even if the map is unchanged.
    return Read(None if reported else msgspec.structs.replace(instrument), (beside,), reported)


LIBRARY = UserFolder("instruments", (".glb",), Library, bundled_maps, _own_map, NOT_MAPS)
FOLDER_VARIABLE = LIBRARY.variable
own_folder, begin, library, reload = LIBRARY.folder, LIBRARY.begin, LIBRARY.now, LIBRARY.reload


def find_map(id: str) -> InstrumentMap:
    """Return the map with an id. Raises MapError if there is none."""
    return library().find(id)


def all_maps() -> Mapping[str, InstrumentMap]:
    """Return all maps by id, sorted."""
    return library().maps


def model_path(instrument: InstrumentMap) -> Path:
    """Return the file of a map's model; see `Library.model_path`."""
    return library().model_path(instrument)
