"""A dance begins and ends in a natural stand: raised feet are put down with a step, and the body settles between them.
A longer stand is not held like a statue (`app.choreography.quiet_standing`).

The stand is a captured pose near the last one of the dance, with its legs solved again for feet that are flat on the
floor; feet that already stand stay where they are. The difference to it fades out as at a join.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.choreography.body import ENDS, FEET, SEGMENTS
from app.choreography.clip import MotionClip
from app.choreography.contacts import tips_m
from app.choreography.features import height_m
from app.choreography.feet_on_floor import rest_tip_m, soles_m
from app.choreography.foot_plants import REACHED_M, FootPlant
from app.choreography.joins import (
    LEANS_RAD,
    MOST_CARRIED_RAD,
    STATURE_M,
    facing_apart,
    facing_together,
    fading_difference,
    fading_turn,
)
from app.choreography.limbs import within_hinges
from app.choreography.quiet_standing import quietly
from app.choreography.standing_feet import planted
from app.rig import quaternion

RESTS_S: Final = 0.75
"""Time in seconds in which a dance comes to rest after its last motion, and in which it leaves a stand."""
HELD_S: Final = 1.5
"""Time in seconds for which the last stand is held, with what feet and hands need to arrive in it."""
ENDS_S: Final = RESTS_S + HELD_S
"""Time in seconds from the last motion to the end of a clip."""
GOES_ON_S: Final = 0.15
"""Greatest time in seconds for which a last motion goes on after the music."""
LEAST_S: Final = 0.3
"""Least time in seconds for that; with less before the first or after the last motion there is no stand."""
LANDED: Final = 0.73
"""Share of that time after which a raised foot is put down."""
KEPT: Final = 48
"""Number of captured stands from which one is chosen."""
WIDE_M: Final = 0.55
NARROW_M: Final = 0.06
"""Greatest distance of both feet's tips and their least one across, in metres of a body of `STATURE_M`, for both to
stay where they are at the end of a dance."""
HIGH: Final = 0.975
"""Least height of the hips relative to that in the T-pose."""
TURNED_RAD: Final = 0.5
"""Greatest angle in radians between the hips of a stand and their direction for its feet, and by which the hips turn
to the audience while they come to rest."""
CHANGES_RAD: Final = 0.5
"""Mean rotation of the upper body, in radians, that counts as much as one unit of `_strangeness`."""
_ANKLES: Final = [1 + SEGMENTS.index(name) for name in FEET]
_UPPER: Final = [SEGMENTS.index(name) for name in SEGMENTS if "Leg" not in name and "Foot" not in name][1:]
_UP: Final = np.array([0.0, 1.0, 0.0])
_FLAT: Final = np.array([1.0, 0.0, 1.0])
_CARRIED_RAD: FloatArray = np.array([LEANS_RAD, *[MOST_CARRIED_RAD] * len(SEGMENTS)])


@dataclass(frozen=True, eq=False)
class CapturedStands:
    """Captured poses that are most like a natural stand, ahead of +Z and above the origin, of a body of `STATURE_M`.

    Attributes
    ----------
    rotations : (N, 16, 4) float64
        Local rotations.
    high_m : (N,) float64
        Height of the hips.
    tips_m : (N, 2, 3) float64
        Positions of the tips of the feet from the middle between them.
    feet_rad : (N, 2) float64
        Direction of each foot about the vertical.
    strangeness : (N,) float64
        Difference from an even stand.
    hinges : (4, 2) float64
        Ranges of knees and elbows, see `app.choreography.limbs.hinge_ranges`.
    """

    rotations: FloatArray
    high_m: FloatArray
    tips_m: FloatArray
    feet_rad: FloatArray
    strangeness: FloatArray
    hinges: FloatArray


def captured_stands(clips: Sequence[MotionClip], hinges: FloatArray) -> CapturedStands:
    """Return the `KEPT` frames of clips that are most like a natural stand."""
    found = [_stands_of(clip) for clip in clips]
    every = [np.concatenate(parts) for parts in zip(*found, strict=True)]
    best = np.argsort(every[-1], kind="stable")[:KEPT]
    rotations, high_m, tips, feet_rad, strangeness = (part[best] for part in every)
    return CapturedStands(rotations, high_m, tips, feet_rad, strangeness, hinges)


def _stands_of(clip: MotionClip) -> tuple[FloatArray, ...]:
    """Return the attributes of `CapturedStands` for each frame of a clip, in their order."""
    world, scale = clip.world(), STATURE_M / height_m(clip)
    turned_rad = quaternion.twist_angle(clip.rotations[:, 0], _UP)
    back = quaternion.from_axis_angle(_UP, -turned_rad)
    tips = tips_m(clip, world)
    middle = tips.mean(axis=1) * _FLAT
    rotations = clip.rotations.copy()
    rotations[:, 0] = quaternion.multiply(back, rotations[:, 0])
    feet_rad = _wrapped(quaternion.twist_angle(world.rotations[:, _ANKLES], _UP) - turned_rad[:, None])
    seen_m = quaternion.rotate(back[:, None], world.positions_m - middle[:, None]) * scale
    turned = quaternion.multiply(back[:, None], world.rotations)
    strangeness = _strangeness(seen_m, soles_m(clip, world) * scale, feet_rad, turned)
    return (
        rotations,
        clip.hips_m[:, 1] * scale,
        quaternion.rotate(back[:, None], tips - middle[:, None]) * scale,
        feet_rad,
        strangeness,
    )


def _strangeness(joints_m: FloatArray, soles: FloatArray, feet_rad: FloatArray, turned: FloatArray) -> FloatArray:
    """Return the difference (F,) of poses from an even stand: both soles on the floor, about a hip's width apart, under
    an upright body with low hands that looks ahead.

    Parameters
    ----------
    joints_m : (F, 17, 3) float64
        Positions of the root and all segments, seen ahead.
    soles : (F, 2, 2) float64
        Heights in metres of tip and heel of each foot.
    feet_rad : (F, 2) float64
        Direction of each foot.
    turned : (F, 17, 4) float64
        Rotations in the world, seen ahead.
    """
    at = {name: 1 + number for number, name in enumerate(SEGMENTS)}
    ankles = joints_m[:, _ANKLES]
    apart, middle = ankles[:, 0] - ankles[:, 1], ankles.mean(axis=1)
    hips = joints_m[:, at["hips"]]
    leans = [np.arccos(np.clip(quaternion.rotate(turned[:, at[name]], _UP)[:, 1], -1.0, 1.0)) for name in _LEANING]
    hands = joints_m[:, [at["leftHand"], at["rightHand"]], 1] - hips[:, None, 1]
    terms = [
        np.abs(soles).max(axis=(1, 2)) / 0.02,
        (apart[:, 0] - 0.22) / 0.07,
        apart[:, 2] / 0.08,
        np.linalg.norm((hips - middle)[:, [0, 2]], axis=1) / 0.05,
        (hips[:, 1].max(initial=0.0) - hips[:, 1]) / 0.06,
        np.abs(feet_rad - np.array([0.2, -0.2])).max(axis=1) / 0.3,
        np.maximum(hands - 0.1, 0.0).max(axis=1) / 0.15,
        *(lean / 0.15 for lean in leans),
        *(quaternion.twist_angle(turned[:, at[name]], _UP) / 0.4 for name in ("chest", "head")),
    ]
    return np.asarray(np.square(terms).sum(axis=0))


_LEANING: Final = ("hips", "chest", "head")


def between_stands(
    clip: MotionClip,
    moved_m: FloatArray,
    contacts: BoolArray,
    danced: Sequence[int],
    stands: CapturedStands,
    seed: int = 0,
) -> tuple[MotionClip, FloatArray, BoolArray]:
    """Return a motion that begins and ends in a stand, as far as there is time before and after its dance, with
    ``moved_m`` and ``contacts`` that fit.

    Parameters
    ----------
    moved_m : (F, 3) float64
        Displacement of the body by which it stays near its place.
    contacts : (F, 2) bool
        Whether the left and the right foot stand.
    danced : (int, int)
        First frame of the dance and the frame after the last one.
    seed : int
        Seed for breaths and shifts of weight, see `app.choreography.quiet_standing.quietly`.
    """
    room, (first, stop) = LEAST_S * float(clip.fps), danced
    rests, frames = RESTS_S * float(clip.fps), np.arange(len(clip))
    if stop - first < 2:
        return clip, moved_m, contacts
    moved_m, contacts = moved_m.copy(), contacts.copy()
    if len(clip) - stop >= room:
        clip = _to_rest(clip, contacts, stop, stands)
        clip = quietly(clip, np.maximum(frames - stop - rests, 0.0) / float(clip.fps), seed)
        moved_m[stop:] = moved_m[stop - 1]
    if first >= room:
        # The start is an end in reversed time.
        turned = _to_rest(_reversed(clip), contacts[::-1], len(clip) - first, stands)
        clip = quietly(_reversed(turned), np.maximum(first - frames - rests, 0.0) / float(clip.fps), seed)
        moved_m[:first] = moved_m[first]
    return clip, moved_m, contacts


def _reversed(clip: MotionClip) -> MotionClip:
    return replace(clip, hips_m=clip.hips_m[::-1], rotations=clip.rotations[::-1])


def _to_rest(clip: MotionClip, contacts: BoolArray, start: int, stands: CapturedStands) -> MotionClip:
    """Return a motion that comes to rest in a stand from the frame ``start`` on; its ``contacts`` are updated in
    place."""
    fps, count = float(clip.fps), len(clip) - start
    rests_s = min(RESTS_S, count / fps)
    last = clip.span(start - 2, start)
    rest, stayed = _stand(last, contacts[start - 1], stands)
    times_s = np.arange(count) / fps
    step_m = last.hips_m[1] - last.hips_m[0]
    hips_m = rest.hips_m + fading_difference(last.hips_m[1] + step_m - rest.hips_m[0], step_m * fps, times_s, rests_s)
    turn = quaternion.multiply(last.rotations[1], quaternion.conjugate(last.rotations[0]))
    once = quaternion.multiply(turn, last.rotations[1])
    goes_on = facing_apart(np.stack([once, quaternion.multiply(turn, once)]))
    there = facing_apart(rest.rotations)
    off = quaternion.to_rotation_vector(quaternion.multiply(goes_on, quaternion.conjugate(there)))
    spin = off[1] - off[0]
    spin = np.where(np.linalg.norm(spin, axis=-1, keepdims=True) > 1.0, 0.0, spin)
    fading = quaternion.from_rotation_vector(fading_turn(off[0], spin * fps, times_s, _CARRIED_RAD, rests_s))
    stays = np.repeat(there, count, axis=0)
    rotations = facing_together(within_hinges(quaternion.multiply(fading, stays), stays, stands.hinges))
    contacts[start:] = stayed | (times_s >= LANDED * rests_s)[:, None]
    every_hips_m, every = clip.hips_m.copy(order="K"), clip.rotations.copy(order="K")
    every_hips_m[start:], every[start:] = hips_m, rotations
    return replace(clip, hips_m=every_hips_m, rotations=quaternion.continuous(every))


def _stand(last: MotionClip, contacts: BoolArray, stands: CapturedStands) -> tuple[MotionClip, BoolArray]:
    """Return the stand (one frame) in which a motion with the given last frames comes to rest, and which of its feet
    (2,) stay where they are.
    """
    scale, world = height_m(last) / STATURE_M, last.world()
    chosen = _nearest(last.rotations[-1], stands)
    tips, own = tips_m(last, world)[-1] * _FLAT, stands.tips_m[chosen] * _FLAT * scale
    feet_rad = quaternion.twist_angle(world.rotations[-1, _ANKLES], _UP)
    faces_rad = float(_wrapped(quaternion.twist_angle(last.rotations[-1, 0], _UP)))
    # The body goes on to turn towards the audience.
    faces_rad -= min(max(faces_rad, -TURNED_RAD), TURNED_RAD)
    floor_m = np.array([rest_tip_m(last, foot) for foot in range(2)])
    stay = contacts & (tips_m(last, world)[-1, :, 1] < floor_m + REACHED_M)
    turn_rad = _turn_rad(faces_rad, feet_rad - stands.feet_rad[chosen], stay)
    turn = quaternion.from_axis_angle(_UP, turn_rad)
    if stay.all():
        apart = quaternion.rotate(quaternion.conjugate(turn), tips[0] - tips[1]) / scale
        if apart[0] < NARROW_M or np.linalg.norm(apart) > WIDE_M:
            far = np.linalg.norm(tips - last.hips_m[-1] * _FLAT, axis=1)
            stay[int(far.argmax())] = False
    own = quaternion.rotate(turn, own)
    middle = (tips - own)[stay].mean(axis=0) if stay.any() else last.hips_m[-1] * _FLAT
    places = np.where(stay[:, None], tips, middle + own)
    directions = np.where(stay, feet_rad, turn_rad + stands.feet_rad[chosen])
    rotations = stands.rotations[chosen].copy()
    rotations[0] = quaternion.multiply(turn, rotations[0])
    high_m = max(float(stands.high_m[chosen]) * scale, HIGH * float(last.shape.offsets_m[0, 1]))
    hips_m = _between(last, places, directions) + high_m * _UP
    pose = MotionClip(last.shape, last.fps, hips_m[None], rotations[None])
    places[:, 1] = floor_m
    plants = tuple(FootPlant(foot, 0, 1, tuple(place)) for foot, place in enumerate(places.tolist()))
    return planted(_flat_feet(pose, directions), plants), stay


def _between(body: MotionClip, tips: FloatArray, directions_rad: FloatArray) -> FloatArray:
    """Return the point (3,) of the floor in the middle between the ankles of flat feet with given tips (2, 3)."""
    ends_m = body.shape.ends_m[[ENDS.index(name) for name in FEET]]
    ankles = tips - quaternion.rotate(quaternion.from_axis_angle(_UP, directions_rad), ends_m)
    return np.asarray(ankles.mean(axis=0) * _FLAT)


def _nearest(rotations: FloatArray, stands: CapturedStands) -> int:
    """Return the index of a stand that is natural and whose upper body is near that of a pose (16, 4)."""
    off = quaternion.multiply(quaternion.conjugate(rotations[_UPPER]), stands.rotations[:, _UPPER])
    changes_rad = np.linalg.norm(quaternion.to_rotation_vector(off), axis=-1).mean(axis=1)
    return int((stands.strangeness + np.square(changes_rad / CHANGES_RAD)).argmin())


def _turn_rad(faces_rad: float, turns_rad: FloatArray, stay: BoolArray) -> float:
    """Return the direction of a stand: that of the hips, at most `TURNED_RAD` from that of the feet (2,) that stay."""
    if not stay.any():
        return faces_rad
    own_rad = float(np.angle(np.exp(1j * turns_rad[stay]).sum()))
    off_rad = _wrapped(np.asarray(faces_rad - own_rad))
    return own_rad + float(np.clip(off_rad, -TURNED_RAD, TURNED_RAD))


def _flat_feet(pose: MotionClip, directions_rad: FloatArray) -> MotionClip:
    """Return a pose (one frame) with soles parallel to the floor, in the given directions (2,)."""
    turned, rotations = pose.world().rotations[0], pose.rotations.copy()
    for foot, at in enumerate(_ANKLES):
        flat = quaternion.from_axis_angle(_UP, directions_rad[foot])
        rotations[0, at - 1] = quaternion.multiply(quaternion.conjugate(turned[at - 1]), flat)
    return replace(pose, rotations=rotations)


def _wrapped(angles_rad: FloatArray) -> FloatArray:
    return np.asarray(np.angle(np.exp(1j * angles_rad)))
