"""The models of the bundled instruments."""

from __future__ import annotations

from app.rig.instrument import load_instrument
from app.rig.model import InstrumentModel
from instrument_maps.load import model_path
from instrument_maps.model import InstrumentMap


def bundled_instrument(instrument_map: InstrumentMap) -> InstrumentModel:
    """Load the bundled model of a map. Raises MapError or FileError."""
    return load_instrument(model_path(instrument_map), instrument_map)
