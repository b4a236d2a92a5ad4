"""Seats players of large instruments high enough: on a higher seat the thighs descend to the knees.

An instrument on its endpin or on straps is before the lap, and as tall for everyone. On the usual seat the hands of a
small player would be in the lap, and the instrument on its pin would end below the floor.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import msgspec
import numpy as np

from app.motion.contacts.clear_carriage import lacking_in_nod_m, lacking_m
from app.motion.contacts.solve import PlayerBody
from app.motion.contacts.still_player import ContactCurves
from app.motion.contacts.trunk_and_legs import Stance, hips_path, stance, trunk
from app.motion.contacts.upper_body import upper_body
from instrument_maps.hold import Carriage, Support
from instrument_maps.model import Endpin
from metadata.model import Posture

LOWER_DEG = np.linspace(0.0, 24.0, 7)
"""Tried angles by which the thighs descend more than in the posture."""
LOWER_M_PER_DEG = 0.0006
"""Room that counts as much as a degree of that."""
ROOM_M = 0.03
"""Room that a still body leaves between hands and lap for the motion, in which trunk and head go down."""
PIN_LEFT_M = 0.04
"""Length by which a pin can still be drawn out on a still body, for breaths that lift the instrument."""
ACCEPTED_M = 0.01
"""Lacking room for which the usual seat is kept."""


def seated_clear(
    player: PlayerBody, posture: Posture, usual: Carriage, endpin: Endpin | None, supports: Sequence[Support] = ()
) -> PlayerBody:
    """Return the player on a seat that leaves room between arms and body and above the floor.

    Unchanged where there is room, for a standing player, and for an instrument on the lap, or in the hands alone if it
    is held as usual or the player wears own clothes.

    Parameters
    ----------
    posture : Posture
        Posture of the player on the usual seat.
    usual : Carriage
        Usual carriage of the instrument.
    endpin : Endpin or None
        Pin of the instrument, which stays on the floor if it is there on the usual seat.
    supports : sequence of Support
        Straps on which the instrument hangs.
    """
    if player.shape is None or not player.place.seated:
        return player
    hung = endpin is not None or bool(supports)
    if not hung and (player.carriage == usual or not player.shape.tight):
        return player
    lacking = _lacking_m if hung else lacking_in_nod_m
    best, least_m, from_deg = player, lacking(player), 0.0
    if least_m <= ACCEPTED_M:
        return player
    for lower_deg in LOWER_DEG[1:].tolist():
        place = stance(player.skeleton, _lower(posture, lower_deg), player.place.ankle)
        if place.hips_m[1] <= player.place.hips_m[1]:
            from_deg = lower_deg
            continue
        tried = on_seat(player, place, endpin)
        if (tried.stand is None) is not (player.stand is None):
            break
        cost_m = lacking(tried) + LOWER_M_PER_DEG * (lower_deg - from_deg)
        # A lap that is not in the way does not get out of it.
        if cost_m >= least_m:
            break
        best, least_m = tried, cost_m
    return best


def on_seat(player: PlayerBody, place: Stance, endpin: Endpin | None) -> PlayerBody:
    """Return the player on another seat, with an instrument that stands on its endpin where that reaches the floor."""
    base = trunk(player.skeleton, *hips_path(place, player.skeleton, player.still), player.still)
    return replace(player, place=place, base=base, stand=None).standing_on(endpin)


def highest_seat(players: Iterable[PlayerBody]) -> Stance:
    """Return the place of the one who sits highest, of players with one body."""
    return max((player.place for player in players), key=lambda place: float(place.hips_m[1]))


def _lower(posture: Posture, lower_deg: float) -> Posture:
    """Return a seated posture with the thighs lowered; the shanks keep their angle."""
    return msgspec.structs.replace(
        posture,
        hip_flexion_deg=posture.hip_flexion_deg - lower_deg,
        knee_bend_deg=posture.knee_bend_deg - lower_deg,
    )


def _lacking_m(player: PlayerBody) -> float:
    """Return the room in metres that arms lack, and the length of an instrument's pin that would be below the floor or
    is drawn out too far.
    """
    if player.stand is None:
        return lacking_m(player, ROOM_M)
    pin_m = player.stand.pin_m(upper_body(player, ContactCurves(player.still, {}, {}, np.zeros(1))).carried)
    too_far_m = pin_m - (player.stand.endpin.most_m - PIN_LEFT_M)
    return lacking_m(player, ROOM_M) + max(0.0, -pin_m, too_far_m)
