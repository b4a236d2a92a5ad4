"""Carries an instrument a little away from a body whose forearms and hands would be inside it, within its ranges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.motion.contacts.arms_off_trunk import Remaining, remaining
from app.motion.contacts.carried_instrument import InstrumentTransform
from app.motion.contacts.solve import PlayerBody, body_with_help, needed_by
from app.motion.contacts.still_player import ContactCurves
from app.motion.contacts.trunk_and_legs import SIDES, neck_m
from app.motion.contacts.upper_body import UpperBody, upper_body
from app.rig import quaternion
from app.rig.grip.grip_pose import StationBlend, giving_for
from app.rig.supports.model import FROM_NECK_M, GROWN_UP_M
from instrument_maps.hold import LoweredPlace, Support
from instrument_maps.map_table import Vector

SHARES = np.array([0.0, -0.4, 0.4, -0.8, 0.8])
"""Shares of the way to the ends of a range that are tried; the rest of it is for the motion."""
AHEAD_M = np.linspace(0.0, 0.10, 6)
"""Distances ahead of its usual place at which a lowered instrument is tried."""
RAISED_M = np.linspace(0.0, 0.20, 5)
"""Heights above its usual place at which a lowered instrument without straps is tried, as by the thighs of who sits."""
LESS_STEEP_DEG = np.array([8.0, 16.0])
"""Angles by which a lowered instrument is tried less steep."""
LOW_BENT_RAD = float(np.deg2rad(0.5))
"""Bend of a wrist beyond its range, with the instrument lowered as usual or halfway there, for which no other place is
tried."""
LACKING_M = 0.005
"""Lacking room of a lowered instrument for which that is tried."""
ROOM_M, LOW_ROOM_M = 0.008, 0.004
"""Room that a still body leaves for the motion: with the instrument at the lips, and lowered."""
NOD_DEG = {"spine": 1.6, "chest": 1.4, "upperChest": 1.0, "neck": 2.9, "head": 3.5}
"""Forward bend of the joints in a large nod, as for an entry, in which forearms and hands stay out of the body too."""
HEAD_NODS_DEG = NOD_DEG["neck"] + NOD_DEG["head"]
"""... and of the head beside the chest."""
BELL_NODS_DEG = 3.0
"""Angle by which the bell sinks in it beside the head."""
SWAY_DEG = {"spine": 2.2, "chest": 1.9, "upperChest": 1.4}
"""Sideways lean of a seated player's trunk to which hands stay off the lap in it."""
SWAY_M = 0.020
"""Room that they leave over the lap besides."""
LAP_ROOM_M = 0.040
"""Room that hands leave over the lap of a seated player, who leans forward in rests, and before thick clothes."""
BENT_M_PER_RAD = float(0.010 / np.deg2rad(1.0))
"""A wrist beyond its range is as bad as so deep an arm."""
OFF_M = 0.006
"""Depth that counts as much as an instrument at the end of a range."""
WORTH_M = 0.002
"""Depth that another angle than the usual one has to save."""


def played_clear(player: PlayerBody) -> PlayerBody:
    """Return the player with the instrument at the lips held at other angles, if forearms or hands would be inside the
    body; unchanged where there is room, or where the instrument stands on the floor."""
    if player.shape is None or player.stand is not None:
        return player
    carriage = player.carriage
    ranges = (carriage.pitch_down_deg, carriage.yaw_left_deg, carriage.roll_left_deg)
    nods = player.shape.tight
    usual = _left(player, np.zeros((1, 3)), ranges, nods=nods)
    if usual is None or usual.depth_m[0] <= -ROOM_M:
        return player
    best = np.zeros(3)
    for axis in range(3):
        tried = np.tile(best, (len(SHARES), 1))
        tried[:, axis] = SHARES
        left = _left(player, tried, ranges, nods=nods)
        assert left is not None
        cost_m = _cost_m(left, ROOM_M) + OFF_M * np.abs(tried).sum(axis=1)
        cost_m[0] -= WORTH_M if nods else 0.0
        best = tried[int(np.argmin(cost_m))]
    if not best.any():
        return player
    pitch, yaw, roll = (_shifted(one, share) for one, share in zip(ranges, best.tolist(), strict=True))
    moved = msgspec.structs.replace(carriage, pitch_down_deg=pitch, yaw_left_deg=yaw, roll_left_deg=roll)
    return replace(player, carriage=moved)


def lacking_m(player: PlayerBody, room_m: float) -> float:
    """Return the room in metres, 0 or more, that forearms and hands lack with the instrument at the lips.

    The instrument is held as usual, and as far down as its range goes. A wrist beyond its range counts too. It is 0 for
    a body of unknown shape. ``room_m`` is the room of the hands, which no turn of an elbow gives them.
    """
    carriage = player.carriage
    ranges = (carriage.pitch_down_deg, carriage.yaw_left_deg, carriage.roll_left_deg)
    left = _left(player, np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), ranges)
    if left is None:
        return 0.0
    return float(np.maximum(_cost_m(left, ROOM_M), left.hands_m + room_m).max(initial=0.0))


def lacking_in_nod_m(player: PlayerBody) -> float:
    """Return the room in metres, 0 or more, that forearms and hands lack as the instrument is held, also in a large
    nod."""
    carriage = player.carriage
    ranges = (carriage.pitch_down_deg, carriage.yaw_left_deg, carriage.roll_left_deg)
    left = _left(player, np.zeros((1, 3)), ranges, nods=True)
    return 0.0 if left is None else max(0.0, float(_cost_m(left, ROOM_M)[0]))


def lowered_clear(player: PlayerBody, supports: Sequence[Support] = ()) -> PlayerBody:
    """Return the player with an instrument that is lowered farther ahead, and without straps higher, where that leaves
    room between arms and body, or wrists in their ranges there and on the way; unchanged where the instrument stands
    on the floor.

    Parameters
    ----------
    supports : sequence of Support
        Straps on which the instrument hangs: it goes ahead about the neck, as far as they reach, and not at all on a
        strap that is fastened to the seat.
    """
    if player.shape is None or player.stand is not None or any(support.kind not in FROM_NECK_M for support in supports):
        return player
    low, halfway = (
        ContactCurves(replace(player.still, lowered=np.full(1, share)), {}, {}, np.zeros(1)) for share in (1.0, 0.5)
    )
    usual, usual_halfway = upper_body(player, low), upper_body(player, halfway)
    left, on_way = _remaining(player, low, usual), _remaining(player, halfway, usual_halfway)
    lap_m = LAP_ROOM_M if player.place.seated or player.shape.tight else LOW_ROOM_M
    if left is None or on_way is None:
        return player
    bent_rad = max(left.bent_rad[0], on_way.bent_rad[0])
    if left.depth_m[0] <= -LOW_ROOM_M and left.hands_m[0] <= -lap_m and bent_rad <= LOW_BENT_RAD:
        return player
    straps_m = _straps_m(player, usual.carried, supports)
    places, costs_m = list[LoweredPlace](), list[float]()
    # On straps it hangs as low as these reach.
    for raised_m in RAISED_M[: 1 if supports else None].tolist():
        for ahead_m in AHEAD_M.tolist():
            lowered = _moved_ahead(player.lowered, ahead_m, straps_m)
            if lowered is None:
                break
            left_m, up_m, forward_m = lowered.offset_m
            places.append(msgspec.structs.replace(lowered, offset_m=(left_m, up_m + raised_m, forward_m)))
            costs_m.append(OFF_M * (ahead_m / float(AHEAD_M[-1]) + 1.5 * raised_m / float(RAISED_M[-1])))
    ways_m = np.array([place.offset_m for place in places]) - np.array(player.lowered.offset_m)
    left = _remaining(player, *_lowered_by(player, low, usual, ways_m))
    on_way = _remaining(player, *_lowered_by(player, halfway, usual_halfway, 0.5 * ways_m))
    lowering_cost_m = _lowering_cost_m(left, on_way, lap_m)
    best = int(np.argmin(lowering_cost_m + costs_m))
    moved = replace(player, lowered=places[best])
    if lowering_cost_m[best] <= LACKING_M:
        return moved
    return _less_steep(player, moved, (low, halfway), lap_m, float(lowering_cost_m[best] + costs_m[best]))


def _lowering_cost_m(left: Remaining | None, on_way: Remaining | None, lap_m: float) -> FloatArray:
    """Return the cost (N,) in metres of N places of a lowered instrument, from what is ``left`` there and halfway
    there."""
    assert left is not None
    assert on_way is not None
    bent_m = BENT_M_PER_RAD * on_way.bent_rad
    return np.maximum(np.maximum(_cost_m(left, LOW_ROOM_M), left.hands_m + lap_m), bent_m)


def _less_steep(
    usual: PlayerBody, moved: PlayerBody, lowering: Sequence[ContactCurves], lap_m: float, least_m: float
) -> PlayerBody:
    """Return the player with the lowered instrument less steep, at its usual place or where it was moved to, if that
    costs less than ``least_m`` metres; otherwise ``moved``. ``lowering`` are curves of it lowered, and halfway there.
    """
    best = moved
    for player in (usual, moved):
        off_m = np.array(player.lowered.offset_m) - np.array(usual.lowered.offset_m)
        for less_deg in LESS_STEEP_DEG.tolist():
            pitch_deg = player.lowered.pitch_down_deg - less_deg
            tried = replace(player, lowered=msgspec.structs.replace(player.lowered, pitch_down_deg=pitch_deg))
            left, on_way = (_remaining(tried, curves, upper_body(tried, curves)) for curves in lowering)
            off = less_deg / LESS_STEEP_DEG[-1] + np.abs(off_m).sum() / AHEAD_M[-1]
            cost_m = float(_lowering_cost_m(left, on_way, lap_m)[0] + OFF_M * off)
            if cost_m < least_m:
                best, least_m = tried, cost_m
    return best


def _lowered_by(
    player: PlayerBody, low: ContactCurves, usual: UpperBody, ways_m: FloatArray
) -> tuple[ContactCurves, UpperBody]:
    """Return N poses with the instrument lowered, moved from its place by vectors (N, 3) in metres in the still body's
    frame; ``low`` and ``usual`` are those of its usual place."""
    same = np.zeros(len(ways_m), np.intp)
    upper = usual[same]
    with_chest = quaternion.multiply(upper.trunk.chest, quaternion.conjugate(player.base.chest))
    moved_m = upper.carried.position_m + quaternion.rotate(with_chest, ways_m)
    return low[same], replace(upper, carried=replace(upper.carried, position_m=moved_m))


def _straps_m(player: PlayerBody, carried: InstrumentTransform, supports: Sequence[Support]) -> FloatArray:
    """Return vectors (S, 3) in metres from the body to the hooks of S straps with the instrument lowered as usual."""
    skeleton = player.skeleton
    left_m, right_m = (
        skeleton.offsets_m[skeleton.index(f"{side}Shoulder")] + skeleton.offsets_m[skeleton.index(f"{side}UpperArm")]
        for side in SIDES
    )
    size = 0.5 * float(np.linalg.norm(left_m - right_m)) / GROWN_UP_M
    tops_m = neck_m(skeleton, player.base) + size * _rows([FROM_NECK_M[one.kind] for one in supports])
    hooks_m = _rows([one.hook_m for one in supports])
    ways_m: FloatArray = carried.position_m + quaternion.rotate(carried.rotation, hooks_m) - tops_m
    return ways_m


def _rows(vectors: Sequence[Vector]) -> FloatArray:
    return np.array(vectors, np.float64).reshape(-1, 3)


def _moved_ahead(place: LoweredPlace, ahead_m: float, straps_m: FloatArray) -> LoweredPlace | None:
    """Return the place farther ahead, and higher by so much that straps (S, 3) become no longer; None beyond their
    reach."""
    _, high_m, out_m = straps_m.T
    left_sq = high_m**2 + out_m**2 - (out_m + ahead_m) ** 2
    if np.any(left_sq < 0.0):
        return None
    raised_m = float(np.max(-np.sqrt(left_sq) - high_m, initial=0.0))
    left_m, up_m, forward_m = place.offset_m
    return msgspec.structs.replace(place, offset_m=(left_m, up_m + raised_m, forward_m + ahead_m))


def _left(
    player: PlayerBody, shares: FloatArray, ranges: tuple[Vector, Vector, Vector], *, nods: bool = False
) -> Remaining | None:
    """Return depth and bend of N poses with the instrument held at given shares (N, 3) of its ranges of angles; with
    ``nods`` also in a large nod, for which less room is left."""
    added_rad = {}
    for name, values, (low, usual, high), sign in zip(
        ("pitch", "yaw", "roll"), shares.T, ranges, (-1.0, 1.0, 1.0), strict=True
    ):
        added_rad[name] = sign * np.deg2rad(np.where(values > 0.0, high - usual, usual - low) * values)
    # A hand that its control moves: near, and far; in nods hands as placed, and as they yield to each finger.
    moving = [hand.motion.control for hand in player.grip.hands if hand.motion is not None]
    usual = 1 + bool(moving)
    sways = _nods(player) if nods else []
    swaying, nodding = np.r_[np.zeros(usual), sways], np.r_[np.zeros(usual), np.ones(len(sways))]
    states, each = len(nodding), len(shares)
    still, in_nod, to_left = player.still.for_frames(states * each), np.repeat(nodding, each), np.repeat(swaying, each)
    forward_rad, left_rad = (
        {joint: rad + np.deg2rad(most_deg.get(joint, 0.0)) * share for joint, rad in bends.items()}
        for bends, most_deg, share in ((still.forward_rad, NOD_DEG, in_nod), (still.left_rad, SWAY_DEG, to_left))
    )
    held_rad = {name: np.tile(rad, states) for name, rad in added_rad.items()}
    cue_rad = -np.deg2rad(BELL_NODS_DEG) * in_nod
    still = replace(still, forward_rad=forward_rad, left_rad=left_rad, bell_cue_rad=cue_rad, bell_held_rad=held_rad)
    far = {control: np.repeat((np.arange(states) == 1).astype(np.float64), each) for control in moving}
    placed = yielding(player, states - yields(player), each) if nods else {}
    left = _remaining(player, ContactCurves(still, far, {}, np.zeros(states * each), placed))
    if left is None:
        return None
    hands_m = left.hands_m + in_nod * ((SWAY_M if player.place.seated else 0.0) - ROOM_M)
    depth_m = np.maximum(left.depth_m - in_nod * ROOM_M, hands_m)
    return Remaining(*(values.reshape(states, -1).max(axis=0) for values in (depth_m, left.bent_rad, hands_m)))


def _nods(player: PlayerBody) -> list[float]:
    """Return the sways to the left of the nods in which room is left: to both sides with hands as placed, and with each
    hand that yields to a finger to its own side; a standing player's hands have no lap below them."""
    own = [1.0 if hand.side == "left" else -1.0 for hand in player.grip.hands for _ in hand.leans]
    return [-1.0, 1.0, *own] if player.place.seated else [0.0, *[0.0] * len(own)]


def yields(player: PlayerBody) -> int:
    """Return the number of places to which hands yield for fingers."""
    return sum(len(hand.leans) for hand in player.grip.hands)


def yielding(player: PlayerBody, usual: int, each: int) -> dict[str, StationBlend]:
    """Return the hands' offsets, by `giving_for` a finger, in rows of frames: ``usual`` rows as placed, then one for
    each place that they yield to, of ``each`` frames."""
    leans = [lean for hand in player.grip.hands for lean in hand.leans]
    placed: dict[str, StationBlend] = {}
    for finger in sorted({finger for lean in leans for finger, _ in lean.places}):
        stations = [dict(lean.places).get(finger, 0) for lean in leans]
        there = np.repeat([*[0.0] * usual, *stations], each)
        placed[giving_for(finger)] = StationBlend(np.zeros(len(there)), there, (there > 0.0).astype(np.float64))
    return placed


def _remaining(player: PlayerBody, curves: ContactCurves, upper: UpperBody | None = None) -> Remaining | None:
    """Return depth and bend with all help; ``upper`` is the upper body where help does not move the trunk, as with the
    instrument lowered."""
    known = upper_body(player, curves) if upper is None else upper
    given = needed_by(player, curves, known)
    curves = replace(curves, body=body_with_help(player, curves.body, given))
    return remaining(player, curves, upper_body(player, curves) if upper is None and given.moves_trunk else known)


def _cost_m(left: Remaining, room_m: float) -> FloatArray:
    return np.maximum(left.depth_m + room_m, 0.0) + BENT_M_PER_RAD * left.bent_rad


def _shifted(range_deg: Vector, share: float) -> Vector:
    low, usual, high = range_deg
    return (low, usual + share * (high - usual if share > 0.0 else usual - low), high)
