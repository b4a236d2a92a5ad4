"""Limits the amplitude of players in thick clothes to what their arms have room for.

A large cue or sway brings trunk, lap and instrument nearer to each other. Elbows go out of their way, but no farther
than their wrists allow, so that with some instruments and bodies a forearm would end in the jacket.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import msgspec
import numpy as np

from app.arrays import BoolArray, FloatArray
from app.motion.contacts.arms_off_trunk import remaining
from app.motion.contacts.clear_carriage import yielding, yields
from app.motion.contacts.solve import PlayerBody, body_with_help, needs
from app.motion.contacts.still_player import ContactCurves
from app.motion.contacts.upper_body import upper_body
from app.plan.by_hand.pose_corrections import NECK_SHARES, TRUNK_SHARES
from app.plan.parameters import PlayerParameters
from metadata.model import AmplitudeScale, Body
from metadata.units import at_amplitude

AMPLITUDES: Final = np.array([1.0, 0.9, 0.8, 0.7, 0.6, 0.5])
"""Tried amplitudes; the last one, the usual, is never limited."""
DEEP_M: Final = 0.004
"""Depth in metres, in the shape of the body, from which an arm in a large cue is in the way ..."""
STOPPED_RAD: Final = float(np.deg2rad(0.5))
"""... if its wrist is so far past the end of its range, so that it lets the elbow go no farther."""
TRUNK_BOWS, HEAD_BOWS, BELL_DIPS = 0.6, 0.75, 0.9
"""Shares of a cue's full sizes that show in a large one, since the breath before it takes trunk and head back."""
LEANS, TILTS = np.array([0.25, 0.4]), np.array([0.2, 0.4])
"""Shares of a full sway that trunk and head have, to opposite sides, in a large cue and in a sway alone."""
CUED = np.array([1.0, 0.0])
"""Shares of a large cue in both."""
INHALED: Final = 0.75
"""Share of a full breath that is in the lungs then."""


def with_room_for_arms(player: PlayerBody, body: Body) -> PlayerBody:
    """Return the player with the greatest amplitude at which wrists let arms stay out of thick clothes."""
    if player.shape is None or not player.shape.tight or not _in_the_way(player, body, AMPLITUDES[:1])[0]:
        return player
    clear = ~_in_the_way(player, body, AMPLITUDES)
    clear[-1] = True
    return replace(player, most_amplitude=float(AMPLITUDES[np.argmax(clear)]))


def limited_to_arms(parameters: PlayerParameters, player: PlayerBody) -> PlayerParameters:
    """Reduce the amplitude to what the player's arms have room for."""
    if parameters.amplitude <= player.most_amplitude:
        return parameters
    return msgspec.structs.replace(parameters, amplitude=player.most_amplitude)


def _in_the_way(player: PlayerBody, body: Body, amplitudes: FloatArray) -> BoolArray:
    """Return whether an arm is in thick clothes in large cues and sways at A amplitudes (A,) since its wrist stops the
    elbow, leaning to either side, however hands yield to fingers."""
    rows, poses = yields(player) + 1, 2 * len(CUED)
    count = poses * len(amplitudes)
    sides = np.tile([-1.0, 1.0], rows * count // 2)
    cued, leans, tilts = (np.tile(np.repeat(each, 2), rows * len(amplitudes)) for each in (CUED, LEANS, TILTS))

    def of(scale: AmplitudeScale) -> FloatArray:
        sizes = [at_amplitude(scale, amplitude) for amplitude in amplitudes.tolist()]
        return np.tile(np.repeat(sizes, poses), rows)

    def bent(angles: dict[str, FloatArray], trunk_deg: FloatArray, neck_deg: FloatArray) -> dict[str, FloatArray]:
        added = {joint: np.deg2rad(share * trunk_deg) for joint, share in TRUNK_SHARES.items()}
        added |= {joint: np.deg2rad(share * neck_deg) for joint, share in NECK_SHARES.items()}
        return {joint: values + added.get(joint, 0.0) for joint, values in angles.items()}

    still, cue, breath = player.still.for_frames(rows * count), body.cue, body.breath
    side_deg, inhaled = sides * of(body.sway.side_deg), INHALED * of(breath.shown)
    moved = replace(
        still,
        forward_rad=bent(still.forward_rad, TRUNK_BOWS * cued * of(cue.trunk_deg), HEAD_BOWS * cued * of(cue.head_deg)),
        left_rad=bent(still.left_rad, leans * side_deg, -tilts * side_deg),
        bell_cue_rad=-np.deg2rad(BELL_DIPS * cued * of(cue.bell_dip_deg)),
        shoulders_rad=still.shoulders_rad + np.deg2rad(breath.shoulder_lift_deg * inhaled),
        elbows_rad=still.elbows_rad + np.deg2rad(breath.elbow_out_deg * inhaled),
    )
    curves = ContactCurves(moved, {}, {}, np.zeros(rows * count), yielding(player, 1, count))
    curves = replace(curves, body=body_with_help(player, moved, needs(player, curves)))
    left = remaining(player, curves, upper_body(player, curves))
    assert left is not None
    stuck = (left.depth_m > DEEP_M) & (left.bent_rad > STOPPED_RAD)
    in_the_way: BoolArray = np.logical_or.reduce(stuck.reshape(rows, len(amplitudes), poses), axis=(0, 2))
    return in_the_way
