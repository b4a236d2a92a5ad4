"""Characters, bodies, instruments, models and grips of players, each cached."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from functools import cache, lru_cache

from app.arrays import FloatArray
from app.errors import FileError, MapError, Message, Progress, UsageError, shortened
from app.identity_cache import IdentityCache
from app.motion.contacts.ready_player import put_aside_transform
from app.project.performers import Dancer, Player
from app.rig.characters.character_library import carriage_of, character_named, character_revision, our_characters
from app.rig.characters.dressed_characters import character_in
from app.rig.grip.body_size import leg_size, sized_body, sized_model
from app.rig.grip.carriage import carried_by
from app.rig.grip.fitting.fit_terms import no_progress
from app.rig.grip.fitting.fitted_instrument import FittedInstrument, fitted_to_body
from app.rig.grip.fitting.grip_files import bundled_path, hold_for, own_hold
from app.rig.grip.grip_pose import GripPose
from app.rig.grip.visible_share import hidden_message
from app.rig.grip.whole_hands import within_reach
from app.rig.instrument import load_instrument
from app.rig.model import Character, InstrumentModel
from app.rig.people.bundled_people import hands_id
from app.rig.people.person import Person
from instrument_maps.library import library, model_path
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from metadata.load import load_body
from metadata.model import Body

_MODELS: IdentityCache[InstrumentModel] = IdentityCache(128)
"""Cache of instrument models, larger than the number of instruments, so that no model is read again at every edit."""
_HOLDS: IdentityCache[GripPose] = IdentityCache(256)
_STRAINED: IdentityCache[bool] = IdentityCache(512)
_HIDDEN: IdentityCache[Message | None] = IdentityCache(256)
_HELD: set[tuple[str, int, str, int]] = set()
"""Pairs of character and instrument, by id and revision, whose grips are computed."""
_CARRIED: IdentityCache[InstrumentMap] = IdentityCache(256)
_SUITED: IdentityCache[FittedInstrument] = IdentityCache(256)


def character_of(player: Player) -> Character:
    """The player's character. Raises UsageError for an unknown id."""
    return character_named(player.character_id)


def dressed_character(performer: Player | Dancer) -> Character:
    """Return a player's or dancer's character in the chosen outfit. Raises UsageError for an unknown id."""
    return character_in(performer.character_id, performer.outfit)


def body_of(player: Player) -> Body:
    """Return the player's body, with motion scaled by the length of its legs."""
    return _body(round(leg_size(character_of(player).skeleton), 3))


@lru_cache(maxsize=64)
def _body(size: float) -> Body:
    return sized_body(load_body(), size)


def model_of(instrument: InstrumentMap) -> InstrumentModel:
    """Return the 3D model of an instrument map, scaled to the map's size; cached. Raises MapError or FileError."""
    return _MODELS.step(_loaded, _as_usual(instrument))


def _as_usual(instrument: InstrumentMap) -> InstrumentMap:
    """Return the bundled map of an instrument if the given map differs from it only in how the instrument is carried;
    else the given map.
    """
    usual = bundled_maps().get(instrument.id, instrument)
    fields = (name for name in InstrumentMap.__struct_fields__ if name != "hold")
    return usual if all(getattr(usual, name) is getattr(instrument, name) for name in fields) else instrument


def _loaded(instrument: InstrumentMap) -> InstrumentModel:
    return sized_model(load_instrument(model_path(instrument), instrument), instrument.size)


def suited_to(player: Player, instrument: InstrumentMap) -> FittedInstrument:
    """Return the instrument adapted to a player's body in size and contacts; cached for each pair of body and
    instrument.
    """
    # Bundled characters and people are complete and play instruments unchanged: plans are made before any character is
    # loaded.
    if player.character_id in our_characters() or character_of(player).hands_of is not None:
        shares = carriage_of(player.character_id, instrument.id)
        if shares is None or bundled_maps().get(instrument.id) is not instrument:
            return FittedInstrument(instrument, ())
        return FittedInstrument(_CARRIED.step(carried_by, instrument, shares), ())
    return _SUITED.step(_suited, character_of(player), instrument, body_of(player))


def _suited(character: Character, instrument: InstrumentMap, body: Body) -> FittedInstrument:
    with _worked_out(character, instrument):
        return fitted_to_body(character, instrument, body, lambda: model_of(instrument))


def hold_of(player: Player, instrument: InstrumentMap, progress: Progress = no_progress) -> GripPose:
    """Return the grip of a player's body on a fitted instrument; cached for each pair.

    ``instrument`` is the map of the fitted instrument, as returned by `suited_to`.
    """
    return _HOLDS.helped(_hold, progress, character_of(player), model_of(instrument), instrument, body_of(player))


def _hold(
    progress: Progress, character: Character, model: InstrumentModel, instrument: InstrumentMap, body: Body
) -> GripPose:
    with _worked_out(character, instrument):
        hands = character.hands_of
        if hands is None:
            grip = hold_for(character, model, instrument, body, progress)
            return within_reach(character, model, instrument, body, grip)
        own = own_hold(character, model, instrument, load_body())
        if own is not None:
            return own
        fitted = hold_for(hands, model, _as_usual(instrument), load_body(), progress)
        from app.rig.grip.fitting.same_hands import with_own_arms  # slow to import, like a fit

        return with_own_arms(fitted, character, instrument, body)


def hidden_on(player: Player, instrument: InstrumentMap) -> Message | None:
    """Return a warning about hands and head that hide most of a fitted instrument; None if enough of it is in sight, as
    always with the hands of bundled bodies.

    Cached for each grip, which is computed if it is not known.
    """
    character = character_of(player)
    if character.hands_of is not None:
        return None
    model = model_of(instrument)
    return _HIDDEN.step(hidden_message, character, model, instrument, body_of(player), hold_of(player, instrument))


def is_strained(character: Character, instrument: InstrumentMap) -> bool:
    """Return whether a character made from another body's data bends its wrists much further with an instrument than
    that body does; False for other characters.
    """
    return character.hands_of is not None and _STRAINED.step(_strained, character, character.hands_of, instrument)


def strained_on(character: Character, person: Person) -> tuple[str, ...]:
    """Return the ids of the bundled instruments that a person cannot play in a natural posture: wrists would bend too
    far, or no grip is known for the body.
    """
    found = []
    for instrument in bundled_maps().values():
        shares = person.carriages.get(instrument.id)
        carried = instrument if shares is None else carried_by(instrument, shares)
        if not _is_stored(person.original, instrument.id) or is_strained(character, carried):
            found.append(instrument.id)
    return tuple(found)


def _strained(character: Character, hands: Character, instrument: InstrumentMap) -> bool:
    from app.rig.grip.fitting.same_hands import are_strained  # slow to import, like a fit

    body, usual, model = load_body(), _as_usual(instrument), model_of(instrument)
    with _worked_out(character, instrument):
        fitted = hold_for(hands, model, usual, body)
        return are_strained(fitted, character, hands, (instrument, usual), body)


def lies_at(player: Player, instrument: InstrumentMap, number: int) -> tuple[FloatArray, FloatArray] | None:
    """Position (3,) and rotation (4,), in the player's frame, at which an instrument lies while the musician plays
    another one; None until the grip is computed.

    Parameters
    ----------
    instrument : InstrumentMap
        Map of the instrument library.
    number : int
        Index of the instrument among the musician's instruments, from 0.
    """
    if not is_held(player, instrument):
        return None
    suitable = suited_to(player, instrument).instrument
    grip = hold_of(player, suitable)
    rest = put_aside_transform(player.parameters, suitable, character_of(player), grip, body_of(player), number)
    return rest.position_m[0], rest.rotation[0]


@contextlib.contextmanager
def _worked_out(character: Character, instrument: InstrumentMap) -> Iterator[None]:
    """Context manager for computing a grip: failures with a user's own character or instrument, whose shape may be
    unusable, become MapError, a problem of the player. For bundled ones the exception is raised unchanged, since it is
    a bug.

    Raises
    ------
    MapError
        The grip could not be computed.
    """
    try:
        yield
    except (ArithmeticError, LookupError, ValueError) as error:
        if character.id in our_characters() and instrument.id not in library().own:
            raise
        detail = shortened(f"{type(error).__name__}: {error}")
        named = {"character": character.id, "instrument": instrument.id}
        raise MapError("character.hold_failed", **named, detail=detail) from error


def is_held(player: Player, instrument: InstrumentMap) -> bool:
    """Return whether the grip of a player on an instrument of the library is already computed."""
    ours = player.character_id in our_characters() and bundled_maps().get(instrument.id) is instrument
    return (ours and _is_stored(player.character_id, instrument.id)) or _pair(player, instrument) in _HELD


def hold_now(player: Player, instrument: InstrumentMap, progress: Progress = no_progress) -> None:
    """Compute the grip of a player on a library instrument, so that `is_held` is true afterwards.

    Errors in a character or model are ignored here, since they are reported when it is used.
    """
    with contextlib.suppress(UsageError, FileError, MapError):
        hold_of(player, suited_to(player, instrument).instrument, progress)
    _HELD.add(_pair(player, instrument))


def _pair(player: Player, instrument: InstrumentMap) -> tuple[str, int, str, int]:
    revision = library().revisions.get(instrument.id, 0)
    return player.character_id, character_revision(player.character_id), instrument.id, revision


@cache
def _is_stored(character_id: str, instrument_id: str) -> bool:
    return os.path.isfile(bundled_path(hands_id(character_id), instrument_id))
