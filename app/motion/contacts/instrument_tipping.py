"""Limits how far an instrument tilts relative to the chest, by the wrists' ranges, the height of the elbows and the
room between arms and body."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.arrays import FloatArray
from app.motion.contacts.arms import solve_arms
from app.motion.contacts.arms_off_trunk import remaining
from app.motion.contacts.carried_instrument import freedom, tips_freely
from app.motion.contacts.clear_carriage import HEAD_NODS_DEG, NOD_DEG, yielding, yields
from app.motion.contacts.help_for_far_hands import clavicle_of
from app.motion.contacts.solve import PlayerBody, body_with_help, needs
from app.motion.contacts.still_player import ContactCurves
from app.motion.contacts.upper_body import upper_body
from app.motion.contacts.wrists import LOST_RAD, BellRoom
from app.rig import quaternion
from app.rig.grip.grip_pose import StationBlend
from app.rig.ik import arm

MOST_DEG, STEP_DEG = 40, 2
"""Greatest tip of an instrument from its playing position in either direction, and step of the tried angles, in
degrees.
"""
HELD_MOST_DEG = 20
"""Same tip of an instrument that does not follow the head freely."""
NEARLY_RAD = float(np.deg2rad(0.25))
"""Additional angle in radians by which tipping the instrument may move a wrist outside its range."""
NEARLY_M = 0.002
"""Additional depth in metres of arms in the body that tipping the instrument may cause."""
RAISED_RAD = float(np.deg2rad(12.0))
"""Greatest angle in radians by which tipping the instrument may raise an elbow, so that arms do not flap for a nod."""


def with_bell_room(player: PlayerBody) -> PlayerBody:
    """Return the player with the range of instrument tilt set that both wrists and elbows can follow."""
    tight = player.shape is not None and player.shape.tight
    if player.stand is not None or not tips_freely(player.carriage, thickly_dressed=tight):
        return player
    most_deg = MOST_DEG if freedom(player.carriage) == 1.0 else HELD_MOST_DEG
    tipped = np.deg2rad(np.arange(-most_deg, most_deg + 1, STEP_DEG))
    placed = yielding(player, 1, len(tipped))
    found = _wrists_elbows_and_depths(player, np.tile(tipped, yields(player) + 1), placed)
    bent, raised, depth_m = (values.reshape(-1, len(tipped)) for values in found)
    usual, usually, usually_m = (values[:, len(tipped) // 2, None] for values in (bent, raised, depth_m))
    fits = np.logical_and.reduce((bent <= usual + NEARLY_RAD) | (usual > LOST_RAD))
    fits &= np.logical_and.reduce(raised <= usually + RAISED_RAD)
    fits &= np.logical_and.reduce(depth_m <= np.maximum(usually_m + NEARLY_M, 0.0))
    if tight and player.place.seated and fits[len(tipped) // 2]:
        fitting = np.flatnonzero(fits)
        nodding_m = _depth_in_nod_m(player, tipped[fitting])
        least_m = nodding_m[np.searchsorted(fitting, len(tipped) // 2)]
        fits[fitting] = nodding_m <= np.maximum(least_m + NEARLY_M, 0.0)
    room = BellRoom.within(tipped + np.deg2rad(player.carriage.pitch_down_deg[1]), fits)
    return replace(player, bell_room=room)


def _depth_in_nod_m(player: PlayerBody, tipped_rad: FloatArray) -> FloatArray:
    """Return the greatest depth (F,) in metres of forearms and hands in a large nod, in which the lap is nearest, with
    the instrument tilted down beside the chest by F angles, however hands yield to fingers."""
    count, rows = len(tipped_rad), yields(player) + 1
    tipped_rad, frames = np.tile(tipped_rad, rows), count * rows
    still = player.still.for_frames(frames)
    bent_rad = {joint: np.deg2rad(NOD_DEG.get(joint, 0.0)) + rad for joint, rad in still.forward_rad.items()}
    # The head tips it already.
    still = replace(still, forward_rad=bent_rad, bell_down_rad=tipped_rad - np.deg2rad(HEAD_NODS_DEG))
    curves = ContactCurves(still, {}, {}, np.zeros(frames), yielding(player, 1, count))
    curves = replace(curves, body=body_with_help(player, still, needs(player, curves)))
    left = remaining(player, curves, upper_body(player, curves))
    return np.full(count, -np.inf) if left is None else left.depth_m.reshape(rows, count).max(axis=0)


def _wrists_elbows_and_depths(
    player: PlayerBody, tipped_rad: FloatArray, placed: dict[str, StationBlend]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """For a still body with the instrument tilted down by F angles: the larger excess of a wrist over its range, the
    elevation of the higher elbow above its shoulder, each (F,) in radians, and the greatest depth (F,) in metres of
    forearms and hands in the body.
    """
    still = replace(player.still.for_frames(len(tipped_rad)), bell_down_rad=tipped_rad)
    curves = ContactCurves(still, {}, {}, np.zeros(len(tipped_rad)), placed)
    curves = replace(curves, body=body_with_help(player, still, needs(player, curves)))
    upper = upper_body(player, curves)
    arms, left = solve_arms(player, curves, upper), remaining(player, curves, upper)
    bent, raised = np.zeros(len(tipped_rad)), np.full(len(tipped_rad), -np.inf)
    for hand in player.grip.hands:
        limb = arm(player.skeleton, hand.side)
        bent = np.maximum(bent, player.wrists[hand.side].outside_rad(arms[limb.end]))
        clavicle, _ = clavicle_of(player.skeleton, hand.side)
        along_m = player.skeleton.offsets_m[limb.lower]
        up_m = quaternion.rotate(quaternion.multiply(arms[clavicle], arms[limb.upper]), along_m)[:, 1]
        raised = np.maximum(raised, np.arcsin(up_m / np.linalg.norm(along_m)))
    return bent, raised, np.full(len(bent), -np.inf) if left is None else left.depth_m
