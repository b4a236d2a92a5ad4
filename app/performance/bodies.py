"""Who plays, with what: characters, bodies, models and holds of players; each is loaded once."""

from __future__ import annotations

from app.identity_cache import IdentityCache
from app.project.model import Player
from app.rig.character_library import character_named
from app.rig.hold import Hold
from app.rig.hold_file import hold_for
from app.rig.instrument import load_instrument
from app.rig.model import Character, InstrumentModel
from instrument_maps.library import model_path
from instrument_maps.model import InstrumentMap
from metadata.load import load_body
from metadata.model import Body

_MODELS: IdentityCache[InstrumentModel] = IdentityCache(128)
"""More than there are instruments: in an orchestra with one more than these, each would be read again at every edit."""
_HOLDS: IdentityCache[Hold] = IdentityCache(256)


def character_of(player: Player) -> Character:
    """The character that plays. Raises UsageError where there is none of its id."""
    return character_named(player.character_id)


def body_of(player: Player) -> Body:
    """How the player's kind of body moves."""
    return load_body()


def model_of(instrument: InstrumentMap) -> InstrumentModel:
    """The model a map names; loaded once. Raises MapError or FileError."""
    return _MODELS.get((instrument,), lambda: load_instrument(model_path(instrument), instrument))


def hold_of(player: Player, instrument: InstrumentMap) -> Hold:
    """How a player's body holds an instrument; fitted once for each pair."""
    character, model, body = character_of(player), model_of(instrument), body_of(player)
    return _HOLDS.get((character, model, instrument, body), lambda: hold_for(character, model, instrument, body))
