"""Pose corrections: bell, head, elbows and trunk, within the limits of a body."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from app.errors import Argument, Message
from app.plan.by_hand.corrections import BY_HAND, Correction, PoseCorrection
from app.plan.events_by_hand import PoseEvent, PoseTarget
from app.plan.model import Planned, Problem
from app.plan.parameters import PlayerParameters
from app.score.tempo import TempoMap
from instrument_maps.model import InstrumentMap
from metadata.load import load_body
from metadata.model import Body

TRUNK_SHARES = {"spine": 0.40, "chest": 0.35, "upperChest": 0.25}
NECK_SHARES = {"neck": 0.45, "head": 0.55}

BELL_UP = {"bell": 0.30, "neck": 0.45, "trunk": 0.25}
"""Shares of bell, neck and trunk in a rise of the bell; they sum to 1."""
BELL_LEFT = {"bell": 0.4, "neck": 0.4, "trunk": 0.2}
"""Shares of bell, neck and trunk in a sideways rotation of the bell; they sum to 1."""

BELL_ROOM = 0.36
"""Share of a carriage's vertical range that the user may use in addition to the melody's: the more an instrument
rotates about the rim, the farther the rim is off the upper lip during breaths.
"""

HANDS_FOLLOW_DEG: dict[PoseTarget, dict[str, tuple[float, float]]] = {
    "head": {"up_deg": (-25.0, 12.0), "left_deg": (-22.0, 16.0), "roll_deg": (-20.0, 15.0)},
    "torso": {"up_deg": (-45.0, 20.0), "left_deg": (-25.0, 20.0), "roll_deg": (-10.0, 20.0)},
}
"""Ranges in degrees of head and trunk rotation that both hands were measured to follow with the instrument, also at the
farthest position of a slide, which makes left and right differ.
"""
ELBOW_DEG = (-25.0, 45.0)
"""Range in degrees of an elbow's rotation outwards about the line from shoulder to wrist."""
GENTLE_RAD_S2 = 40.0
"""Greatest acceleration in rad/s2 of a pose's fades, however short they are set."""
LEAST_FADE_S = 0.15
REPORTED_DEG = 1.0
"""Excess in degrees over the body's limits above which an angle is reported."""

MINIMUM_JERK_PEAK = 10.0 / math.sqrt(3.0)
"""Peak acceleration of a minimum-jerk move over 1 in 1 s."""


def plan_poses(
    corrections: tuple[Correction, ...], instrument: InstrumentMap, parameters: PlayerParameters, clock: TempoMap
) -> Planned[PoseEvent]:
    """Events of the pose corrections, ordered by start, and a problem for each that exceeds a body's limits."""
    events: list[PoseEvent] = []
    problems: list[Problem] = []
    body = load_body()
    for item in corrections:
        if not isinstance(item, PoseCorrection):
            continue
        start_s, end_s = clock.seconds(float(item.start_tick)), clock.seconds(float(item.end_tick))
        held: dict[str, float] = {}
        for angle, (low, high) in pose_limits(item.target, instrument, parameters, body).items():
            asked = float(getattr(item, angle))
            held[angle] = min(max(asked, low), high)
            if abs(asked - held[angle]) > REPORTED_DEG:
                arguments: dict[str, Argument] = {
                    "target": item.target,
                    "angle": angle.removesuffix("_deg"),
                    "asked_deg": round(asked, 1),
                    "most_deg": round(held[angle], 1),
                }
                problems.append(Problem(Message("pose.beyond_reach", arguments), None, start_s, end_s))
        least_s = _least_fade_s(*held.values())
        fade_in_s = start_s - clock.seconds(float(item.start_tick - item.fade_in_ticks))
        fade_out_s = clock.seconds(float(item.end_tick + item.fade_out_ticks)) - end_s
        events.append(
            PoseEvent(
                id=f"pose:{item.name}",
                target=item.target,
                start_tick=item.start_tick,
                end_tick=item.end_tick,
                start_s=start_s,
                end_s=end_s,
                up_deg=held["up_deg"],
                left_deg=held.get("left_deg", 0.0),
                roll_deg=held.get("roll_deg", 0.0),
                fade_in_s=max(fade_in_s, least_s),
                fade_out_s=max(fade_out_s, least_s),
                reason=BY_HAND,
            )
        )
    return Planned(tuple(sorted(events, key=lambda event: (event.start_s, event.id))), tuple(problems))


def pose_limits(
    target: PoseTarget, instrument: InstrumentMap, parameters: PlayerParameters, body: Body
) -> dict[str, tuple[float, float]]:
    """Lowest and highest offset in degrees for every angle of a target, by field name of `PoseCorrection`."""
    if target in ("left_elbow", "right_elbow"):
        return {"up_deg": ELBOW_DEG}
    carriage = instrument.hold.carriage(parameters.posture)
    posture = body.turned_to(
        instrument.hold.possible(parameters.posture),
        pitch_down_deg=carriage.pitch_down_deg[1],
        head_left_deg=carriage.head_left_deg,
        head_lean_left_deg=carriage.head_lean_left_deg,
        trunk_left_deg=carriage.trunk_left_deg,
    )
    limits, still = body.limits, posture.spine_deg
    leaning, turned = posture.spine_left_deg, posture.spine_turn_deg
    shares = NECK_SHARES if target in ("head", "bell") else TRUNK_SHARES
    flexion: list[tuple[float, ...]] = []
    sideways: list[tuple[float, ...]] = []
    twist: list[tuple[float, ...]] = []
    for joint, share in shares.items():
        low, high = limits[joint].flexion_deg
        flexion.append(((still.get(joint, 0.0) - high) / share, (still.get(joint, 0.0) - low) / share))
        sideways.append(tuple((limit - leaning.get(joint, 0.0)) / share for limit in limits[joint].sideways_deg))
        twist.append(tuple((limit - turned.get(joint, 0.0)) / share for limit in limits[joint].twist_deg))
    if target != "bell":
        ranges = {"up_deg": flexion, "left_deg": twist, "roll_deg": sideways}
        own = HANDS_FOLLOW_DEG[target]
        return {angle: _narrowest((*rows, own[angle])) for angle, rows in ranges.items()}
    low, usual, high = carriage.pitch_down_deg
    share = BELL_ROOM / BELL_UP["bell"]
    up = (-share * (high - usual), share * (usual - low))
    low, usual, high = carriage.yaw_left_deg
    left = ((low - usual) / BELL_LEFT["bell"], (high - usual) / BELL_LEFT["bell"])
    low, usual, high = carriage.roll_left_deg
    return {"up_deg": up, "left_deg": left, "roll_deg": (low - usual, high - usual)}


def _narrowest(ranges: Sequence[tuple[float, ...]]) -> tuple[float, float]:
    return max(item[0] for item in ranges), min(item[1] for item in ranges)


def _least_fade_s(*angles_deg: float) -> float:
    largest = max(abs(float(np.deg2rad(angle))) for angle in angles_deg)
    return max(LEAST_FADE_S, math.sqrt(MINIMUM_JERK_PEAK * largest / GENTLE_RAD_S2))
