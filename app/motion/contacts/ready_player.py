"""Bodies ready to play: a character in its posture with a fitted instrument, computed once for all its motion."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import cast

import numpy as np

from app.arrays import FloatArray
from app.identity_cache import IdentityCache
from app.motion.body_motion import BodyMotion
from app.motion.contacts.arms_room import with_room_for_arms
from app.motion.contacts.carried_instrument import InstrumentTransform
from app.motion.contacts.clear_carriage import lowered_clear, played_clear
from app.motion.contacts.clear_seat import seated_clear
from app.motion.contacts.instrument_put_aside import Aside
from app.motion.contacts.instrument_tipping import with_bell_room
from app.motion.contacts.solve import PlayerBody
from app.motion.contacts.trunk_and_legs import hips_path, stance, trunk
from app.motion.contacts.wrists import wrists_of
from app.motion.faces.morph_weights import usual_morphs
from app.plan.parameters import PlayerParameters
from app.rig.grip.carriage import carrying
from app.rig.grip.grip_pose import GripPose, Lips
from app.rig.grip.lifted_fingers import with_curved_fingers
from app.rig.model import Character, Skeleton
from app.rig.trunk_shape import TrunkShape, dressed_shape
from instrument_maps.map_table import Posture as PostureName
from instrument_maps.model import InstrumentMap
from metadata.load import load_skeleton
from metadata.model import Body, EmbouchureWeights

_CURVED: IdentityCache[GripPose] = IdentityCache(128)
_READY: IdentityCache[PlayerBody] = IdentityCache(128)
_PLAYERS: IdentityCache[PlayerBody] = IdentityCache(128)
"""Grips with curved fingers and other values of a player that do not change with time."""


def put_aside_transform(
    parameters: PlayerParameters,
    instrument_map: InstrumentMap,
    character: Character,
    grip: GripPose,
    body: Body,
    number: int,
) -> InstrumentTransform:
    """Placement, as one frame, of an instrument while its player uses another one; ``number`` is its index among the
    musician's instruments (see `Aside`).
    """
    still = player_body(parameters, instrument_map, character, grip, body)
    place = replace(still, aside=Aside(instrument_map.hold.support_hand, number)).put_aside
    assert place is not None
    return place.rest


def _curved(grip: GripPose, skeleton: Skeleton) -> GripPose:
    return with_curved_fingers(grip, skeleton, load_skeleton())


def player_body(
    parameters: PlayerParameters, instrument_map: InstrumentMap, character: Character, grip: GripPose, body: Body
) -> PlayerBody:
    """Return the time-independent data of a player, including reach of the hands and tilt of the instrument; cached, so
    that equal bodies in equal postures share one object.
    """
    curved = _CURVED.step(_curved, grip, character.skeleton)
    return _READY.step(_with_grip, body_as_fitted(parameters, instrument_map, character, grip, body), curved)


def _with_grip(player: PlayerBody, grip: GripPose) -> PlayerBody:
    return replace(player, grip=grip)


def body_as_fitted(
    parameters: PlayerParameters, instrument_map: InstrumentMap, character: Character, grip: GripPose, body: Body
) -> PlayerBody:
    """Return the data of `player_body` with the fingers as in ``grip``, not curved, which makes no difference to
    anything else: enough for chairs and straps, in less time.

    On the clothes that the character wears it depends how far elbows go out, how a player sits, how far the instrument
    tips, and where it is held and lowered.
    """
    posture_name, shape = sys.intern(parameters.posture), dressed_shape(character)
    return _PLAYERS.step(_made, posture_name, instrument_map, character.skeleton, grip, body, shape)


def _made(
    posture_name: str,
    instrument_map: InstrumentMap,
    skeleton: Skeleton,
    grip: GripPose,
    body: Body,
    shape: TrunkShape | None,
) -> PlayerBody:
    named = cast(PostureName, posture_name)
    carriage = instrument_map.hold.carriage(named)
    posture = carrying(body, instrument_map.hold.possible(named), carriage)
    place = stance(skeleton, posture, body.limits["foot"])
    still = BodyMotion.still(posture)
    made = PlayerBody(
        skeleton=skeleton,
        grip=grip,
        place=place,
        carriage=carriage,
        lowered=instrument_map.hold.lowered(named),
        still=still,
        base=trunk(skeleton, *hips_path(place, skeleton, still), still),
        grip_of_lips_m=_grip_of_lips(grip.lips, body.embouchure[instrument_map.embouchure.kind]),
        water=instrument_map.water,
        stopped=instrument_map.stopped,
        shape=shape,
        wrists=wrists_of(body, load_skeleton()),
    )
    supports = instrument_map.hold.worn(instrument_map.hold.possible(named))
    played = played_clear(made.standing_on(instrument_map.endpin))
    seated = seated_clear(played, posture, carriage, instrument_map.endpin, supports)
    if seated is not played:
        seated = played_clear(replace(seated, carriage=carriage))
    return with_room_for_arms(with_bell_room(lowered_clear(seated, supports)), body)


def _grip_of_lips(lips: Lips, embouchure: EmbouchureWeights) -> FloatArray:
    """Vector (3,) in metres from the mouthpiece's position on one lip to its position between both lips while playing,
    at a medium embouchure.
    """
    morphs = {name: np.array([weight]) for name, weight in usual_morphs(embouchure, lips).items()}
    grip_m: FloatArray = (lips.contact_m(morphs, 1) - lips.carried_m(morphs, 1))[0]
    return grip_m
