"""Straps and chairs of a project's musicians, as required by their instruments' maps and by their postures."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import cast

import numpy as np

from app.arrays import FloatArray
from app.identity_cache import IdentityCache
from app.motion.body_motion import BodyMotion
from app.motion.contacts.clear_seat import highest_seat
from app.motion.contacts.ready_player import body_as_fitted
from app.motion.contacts.solve import PlayerBody, body_with_help, needs, poses, with_elbows_out
from app.motion.contacts.still_player import ContactCurves
from app.motion.contacts.trunk_and_legs import Stance, hips_path, solve_legs, stance, trunk
from app.motion.model import Motion
from app.performance.bodies import body_of, dressed_character
from app.plan.parameters import PlayerParameters
from app.project.performers import Player
from app.rig import quaternion
from app.rig.grip.carriage import carrying
from app.rig.grip.grip_pose import GripPose
from app.rig.model import Character
from app.rig.skeleton import forward
from app.rig.supports.make import Asked, made_supports
from app.rig.supports.model import Hook, Supports
from app.rig.supports.seat_fit import chair_fit
from instrument_maps.hold import Support
from instrument_maps.map_table import Posture as PostureName
from instrument_maps.model import InstrumentMap
from metadata.model import Body

_MADE: IdentityCache[Supports | None] = IdentityCache(128)


@dataclass(frozen=True, eq=False)
class HeldInstrument:
    """An instrument with the grip of the musician who plays it; the grip is None until it is computed."""

    player: Player
    instrument: InstrumentMap
    grip: GripPose | None


def supports_of(character: Character, held: Sequence[HeldInstrument]) -> Supports | None:
    """Return the straps and the chair of a musician; None if none are needed. Equal musicians share one object.

    Parameters
    ----------
    character : Character
        The musician's body.
    held : sequence of HeldInstrument
        All instruments of the musician in order; the posture is that for the first.
    """
    maps = tuple(one.instrument for one in held)
    grips = tuple(one.grip for one in held)
    player = held[0].player
    posture = sys.intern(maps[0].hold.possible(player.parameters.posture))
    # As in the motion, whose outfit has all its materials.
    worn = character if character.own is not None else dressed_character(player)
    return _MADE.step(_supports, character, worn, body_of(player), posture, *maps, *grips)


def _supports(
    character: Character, dressed: Character, body: Body, posture: str, *held: InstrumentMap | GripPose | None
) -> Supports | None:
    maps = [cast(InstrumentMap, one) for one in held[: len(held) // 2]]
    grips = [cast(GripPose | None, one) for one in held[len(held) // 2 :]]
    named = cast(PostureName, posture)
    parameters, players = PlayerParameters(posture=named), dict[int, PlayerBody]()
    for number, (instrument, grip) in enumerate(zip(maps, grips, strict=True)):
        if grip is not None and (worn(instrument, named) or instrument.endpin is not None):
            players[number] = body_as_fitted(parameters, instrument, dressed, grip, body)
    sits = body.postures[named].seat_height_shank > 0.0
    joints = still_joints(character, maps[0], body, named, highest_seat(players.values()) if players else None)
    fit = chair_fit(character, joints) if sits else None
    asked: dict[str, Asked] = {}
    for number, instrument in enumerate(maps):
        if number not in players:
            continue
        for support in worn(instrument, named):
            hook = Hook(number, np.asarray(support.hook_m, np.float64))
            known = asked.get(support.kind)
            if known is not None:
                asked[support.kind] = replace(known, hooks=(*known.hooks, hook))
                continue
            held_still, low = (still_pose(players[number], lowered) for lowered in (0.0, 1.0))
            ends = [instrument_matrices(one)[0] for one in (held_still, low)]
            # Clothes lie on the shoulders as they are while the arms hold the instrument.
            joints = joints if asked else joints_of(character, held_still)[0]
            hook_m, low_m = (matrix[:, :3] @ hook.at_m + matrix[:, 3] for matrix in ends)
            asked[support.kind] = Asked(support.kind, (hook,), hook_m, low_m)
    return made_supports(character, joints, tuple(asked.values()), fit)


def still_pose(player: PlayerBody, lowered: float = 0.0) -> Motion:
    """Pose of a player who keeps still, as a motion of one frame; ``lowered`` is 0 with the instrument at the lips, 1
    with it lowered.
    """
    still = replace(player.still, lowered=np.array([lowered]))
    curves = ContactCurves(still, {}, {}, np.zeros(1))
    curves = replace(curves, body=body_with_help(player, curves.body, needs(player, curves)))
    return poses(player, replace(curves, body=with_elbows_out(player, curves)), Fraction(1), 0.0)


def worn(instrument: InstrumentMap, posture: PostureName) -> tuple[Support, ...]:
    """Return the straps on which an instrument hangs when it is played in a posture."""
    return instrument.hold.worn(posture)


def still_joints(
    character: Character, instrument: InstrumentMap, body: Body, posture: PostureName, place: Stance | None = None
) -> FloatArray:
    """Transforms ``world_from_joint`` (J, 3, 4) of all J joints of a player who keeps still, with the arms as in the
    T-pose, in the player's frame; ``place`` is that of feet and hips if it is not the posture's.
    """
    skeleton, hold = character.skeleton, instrument.hold
    shape = carrying(body, hold.possible(posture), hold.carriage(posture))
    place, still = stance(skeleton, shape, body.limits["foot"]) if place is None else place, BodyMotion.still(shape)
    hips_m, hips = hips_path(place, skeleton, still)
    local = {skeleton.index("hips"): hips} | trunk(skeleton, hips_m, hips, still).local
    local |= solve_legs(place, skeleton, hips_m, hips, still.feet)
    rotations = np.tile(quaternion.IDENTITY, (1, len(skeleton.names), 1))
    for joint, values in local.items():
        rotations[:, joint] = values
    found: FloatArray = forward(skeleton, rotations, hips_m).matrices()[0]
    return found


def joints_of(character: Character, motion: Motion) -> FloatArray:
    """Transforms ``world_from_joint`` (F, J, 3, 4) of J joints in the F frames of a motion, in the player's frame."""
    turns = quaternion.normalize(motion.rotations)
    return forward(character.skeleton, turns, motion.hips_m.astype(np.float64)).matrices()


def instrument_matrices(motion: Motion) -> FloatArray:
    """``world_from_instrument`` (F, 3, 4) of a motion, in the player's frame."""
    turn = quaternion.to_matrix(quaternion.normalize(motion.instrument_rotation))
    return np.concatenate([turn, motion.instrument_position_m.astype(np.float64)[..., None]], axis=-1)
