"""Where a player looks, and when the eyelids close.

The eyes rest on the music most of the time, go up at a cue and wander in rests. Saccades last about 50 ms, fixations
one to three seconds; the lids close every few seconds, more often at rest than in a phrase, and not on an entry
(people blink about 17 times a minute at rest, and much less at a visual task: Bentivoglio et al. 1997).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.motion.curve import Curve, Envelopes, moves
from app.motion.seed import generator
from app.plan.model import PlayerPlan

SACCADE_S = 0.05
HEAD_TURN_S = 0.45
BLINK_DOWN_S, BLINK_SHUT_S, BLINK_UP_S = 0.08, 0.03, 0.16
ENTRY_GUARD_S = 0.20
REST_S = 1.0

MUSIC_PITCH_RAD = 0.20
"""The music on its stand lies about 12 degrees below the line of sight."""


@dataclass(frozen=True)
class Gaze:
    """Direction of the eyes in the world, and the lids.

    Attributes
    ----------
    yaw_rad, pitch_rad : Curve
        Left and down are positive.
    head_yaw_rad, head_pitch_rad : Curve
        What the head follows of it, slowly.
    blinks : Envelopes
        Closed at 1.
    """

    yaw_rad: Curve
    pitch_rad: Curve
    head_yaw_rad: Curve
    head_pitch_rad: Curve
    blinks: Envelopes


def plan_gaze(plan: PlayerPlan, seed: int) -> Gaze:
    """Fixations and blinks of a whole performance, seeded by the player."""
    targets = _fixations(plan, generator(plan.player_id, seed, "gaze"))
    return Gaze(
        yaw_rad=moves([(t, t + SACCADE_S, yaw) for t, yaw, _, _ in targets]),
        pitch_rad=moves([(t, t + SACCADE_S, pitch) for t, _, pitch, _ in targets], MUSIC_PITCH_RAD),
        head_yaw_rad=moves([(t, t + HEAD_TURN_S, share * yaw) for t, yaw, _, share in targets]),
        head_pitch_rad=moves(
            [(t, t + HEAD_TURN_S, 0.25 * share * (pitch - MUSIC_PITCH_RAD)) for t, _, pitch, share in targets]
        ),
        blinks=_blinks(plan, generator(plan.player_id, seed, "blink")),
    )


def _fixations(plan: PlayerPlan, random: np.random.Generator) -> list[tuple[float, float, float, float]]:
    """Rows of (start_s, yaw_rad, pitch_rad, share the head follows), at least `HEAD_TURN_S` apart."""
    rests = _rests(plan)
    up = [(cue.start_s, cue.end_s) for cue in plan.cues]
    side = 1.0 if random.random() < 0.5 else -1.0
    rows: list[tuple[float, float, float, float]] = []
    time_s = plan.time_frame.first_frame_s + random.uniform(0.1, 0.6)
    while time_s < plan.time_frame.end_s:
        length_s = float(random.uniform(0.9, 3.0))
        yaw, pitch = random.normal(0.0, 0.035), MUSIC_PITCH_RAD + random.normal(0.0, 0.03)
        wander = random.random()
        share = 0.3
        if any(start_s - 0.3 <= time_s < end_s for start_s, end_s in up):
            yaw, pitch, share = side * 0.22 + random.normal(0.0, 0.05), 0.0, 0.35
        elif any(start_s <= time_s < end_s for start_s, end_s in rests):
            share = 0.6
            if wander < 0.5:
                yaw, pitch = random.normal(0.0, 0.25), random.normal(0.03, 0.04)
        elif wander < 0.12:
            yaw, pitch = random.normal(0.0, 0.12), 0.02
        rows.append((time_s, float(np.clip(yaw, -0.5, 0.5)), float(np.clip(pitch, -0.15, 0.4)), share))
        following = [start_s for start_s, _ in up if time_s + HEAD_TURN_S < start_s - 0.2 < time_s + length_s]
        time_s = min([time_s + length_s, *(start_s - 0.2 for start_s in following)])
    return rows


def _blinks(plan: PlayerPlan, random: np.random.Generator) -> Envelopes:
    rests = _rests(plan)
    entries = np.array([end_s for _, end_s in rests])
    rows: list[tuple[float, float, float, float, float]] = []
    time_s = plan.time_frame.first_frame_s + random.uniform(0.3, 2.0)
    while time_s < plan.time_frame.end_s:
        shut_s = time_s + BLINK_DOWN_S
        open_s = shut_s + BLINK_SHUT_S + BLINK_UP_S
        near = entries[(entries > time_s - ENTRY_GUARD_S) & (entries < open_s + ENTRY_GUARD_S)]
        if len(near):
            time_s = float(near.max()) + ENTRY_GUARD_S + random.uniform(0.1, 0.8)
            continue
        rows.append((time_s, shut_s, shut_s + BLINK_SHUT_S, open_s, 1.0))
        resting = any(start_s <= time_s < end_s for start_s, end_s in rests)
        time_s = open_s + float(np.clip(random.lognormal(np.log(2.4 if resting else 4.2), 0.5), 0.5, 12.0))
    return Envelopes.of(rows)


def _rests(plan: PlayerPlan) -> list[tuple[float, float]]:
    """Spans of at least `REST_S` without a note, the first ending at the first entry."""
    spans: list[tuple[float, float]] = []
    silent_from_s = plan.time_frame.first_frame_s
    for event in plan.fingerings:
        if event.start_s - silent_from_s >= REST_S:
            spans.append((silent_from_s, event.start_s))
        silent_from_s = event.end_s
    spans.append((silent_from_s, plan.time_frame.end_s))
    return spans
