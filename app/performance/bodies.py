"""Who plays, with what: characters, bodies, instruments as they play them, models and holds; each is made once."""

from __future__ import annotations

from functools import lru_cache

from app.identity_cache import IdentityCache
from app.project.model import Player
from app.rig.character_library import character_named
from app.rig.hold import Hold
from app.rig.hold_file import hold_for
from app.rig.instrument import load_instrument
from app.rig.model import Character, InstrumentModel
from app.rig.stature import leg_size, sized_body, sized_model
from app.rig.suited import Suited, suited
from instrument_maps.library import model_path
from instrument_maps.model import InstrumentMap
from metadata.load import load_body
from metadata.model import Body

_MODELS: IdentityCache[InstrumentModel] = IdentityCache(128)
"""More than there are instruments: in an orchestra with one more than these, each would be read again at every edit."""
_HOLDS: IdentityCache[Hold] = IdentityCache(256)


_SUITED: IdentityCache[Suited] = IdentityCache(256)


def character_of(player: Player) -> Character:
    """The character that plays. Raises UsageError where there is none of its id."""
    return character_named(player.character_id)


def body_of(player: Player) -> Body:
    """How the player's kind of body moves: as far as legs of its length go."""
    return _body(round(leg_size(character_of(player).skeleton), 3))


@lru_cache(maxsize=64)
def _body(size: float) -> Body:
    return sized_body(load_body(), size)


def model_of(instrument: InstrumentMap) -> InstrumentModel:
    """The model a map names, of the size it says; loaded once. Raises MapError or FileError."""

    def loaded() -> InstrumentModel:
        return sized_model(load_instrument(model_path(instrument), instrument), instrument.size)

    return _MODELS.get((instrument,), loaded)


def suited_to(player: Player, instrument: InstrumentMap) -> Suited:
    """An instrument as a player's body plays it: its size, and what touches it; found once for each pair."""
    character, body = character_of(player), body_of(player)
    return _SUITED.get(
        (character, instrument, body), lambda: suited(character, instrument, body, lambda: model_of(instrument))
    )


def hold_of(player: Player, instrument: InstrumentMap) -> Hold:
    """How a player's body holds an instrument that is suited to it; fitted once for each pair."""
    character, model, body = character_of(player), model_of(instrument), body_of(player)
    return _HOLDS.get((character, model, instrument, body), lambda: hold_for(character, model, instrument, body))
