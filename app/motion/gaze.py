"""Where a player looks, and when the eyelids close.

The eyes rest on the music most of the time, go up at a cue and wander in rests. Saccades last about 50 ms, fixations
one to three seconds; the lids close every few seconds, more often at rest than in a phrase, and not on an entry
(people blink about 17 times a minute at rest, and much less at a visual task: Bentivoglio et al. 1997).
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from app.motion.curve import Curve, Envelopes, FloatArray, moves
from app.motion.glances import with_glances
from app.motion.seed import generator
from app.plan.model import PlayerPlan

SACCADE_S = 0.05
HEAD_TURN_S = 0.45
HEAD_TURNS = 0.5
"""The head makes so much of the turn that a fixation lets it follow (`app.motion.body`)."""
BLINK_DOWN_S, BLINK_SHUT_S, BLINK_UP_S = 0.08, 0.03, 0.16
ENTRY_GUARD_S = 0.20
REST_S = 1.0

MUSIC_PITCH_RAD = 0.20
"""The music on its stand lies about 12 degrees below the line of sight."""


@dataclass(frozen=True)
class Look:
    """Eyes and lids at some frames: members as of `Gaze`, each (F,) float64."""

    yaw_rad: FloatArray
    pitch_rad: FloatArray
    head_yaw_rad: FloatArray
    head_pitch_rad: FloatArray
    blinks: FloatArray


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

    def sample(self, times_s: FloatArray) -> Look:
        """Where the eyes look at ascending times."""
        return Look(
            yaw_rad=self.yaw_rad.sample(times_s),
            pitch_rad=self.pitch_rad.sample(times_s),
            head_yaw_rad=self.head_yaw_rad.sample(times_s),
            head_pitch_rad=self.head_pitch_rad.sample(times_s),
            blinks=self.blinks.sample(times_s),
        )


def plan_gaze(plan: PlayerPlan, seed: int) -> Gaze:
    """Fixations and blinks of a whole performance, seeded by the player."""
    fixations = _fixations(plan, generator(plan.player_id, seed, "gaze"))
    targets = with_glances(fixations, plan.glances, HEAD_TURN_S, HEAD_TURNS)
    return Gaze(
        yaw_rad=moves([(t, t + SACCADE_S, yaw) for t, yaw, _, _ in targets]),
        pitch_rad=moves([(t, t + SACCADE_S, pitch) for t, _, pitch, _ in targets], MUSIC_PITCH_RAD),
        head_yaw_rad=moves([(t, t + HEAD_TURN_S, share * yaw) for t, yaw, _, share in targets]),
        head_pitch_rad=moves(
            [(t, t + HEAD_TURN_S, 0.25 * share * (pitch - MUSIC_PITCH_RAD)) for t, _, pitch, share in targets]
        ),
        blinks=_blinks(plan, generator(plan.player_id, seed, "blink")),
    )


def looks_alike(plan: PlayerPlan, other: PlayerPlan) -> bool:
    """Whether the gaze of two plans of a player is the same: notes matter only where they leave rests."""
    same = plan.cues == other.cues and plan.glances == other.glances and plan.time_frame == other.time_frame
    return same and _rests(plan) == _rests(other)


def _fixations(plan: PlayerPlan, random: np.random.Generator) -> list[tuple[float, float, float, float]]:
    """Rows of (start_s, yaw_rad, pitch_rad, share the head follows), at least `HEAD_TURN_S` apart."""
    rests = _Spans(_rests(plan))
    cues = sorted((cue.start_s, cue.end_s) for cue in plan.cues)
    up, ups_s = _Spans([(start_s - 0.3, end_s) for start_s, end_s in cues]), [start_s - 0.2 for start_s, _ in cues]
    side = 1.0 if random.random() < 0.5 else -1.0
    rows: list[tuple[float, float, float, float]] = []
    time_s = plan.time_frame.first_frame_s + random.uniform(0.1, 0.6)
    while time_s < plan.time_frame.end_s:
        length_s = float(random.uniform(0.9, 3.0))
        yaw, pitch = random.normal(0.0, 0.035), MUSIC_PITCH_RAD + random.normal(0.0, 0.03)
        wander = random.random()
        share = 0.3
        if up.hold(time_s):
            yaw, pitch, share = side * 0.22 + random.normal(0.0, 0.05), 0.0, 0.35
        elif rests.hold(time_s):
            share = 0.6
            if wander < 0.5:
                yaw, pitch = random.normal(0.0, 0.25), random.normal(0.03, 0.04)
        elif wander < 0.12:
            yaw, pitch = random.normal(0.0, 0.12), 0.02
        rows.append((time_s, min(max(float(yaw), -0.5), 0.5), min(max(float(pitch), -0.15), 0.4), share))
        # The eyes go up in time for a cue, unless the head has only just turned.
        following = bisect_right(ups_s, time_s + HEAD_TURN_S)
        time_s = min(time_s + length_s, ups_s[following] if following < len(ups_s) else np.inf)
    return rows


def _blinks(plan: PlayerPlan, random: np.random.Generator) -> Envelopes:
    spans = _rests(plan)
    rests, entries_s = _Spans(spans), [end_s for _, end_s in spans]
    rows: list[tuple[float, float, float, float, float]] = []
    time_s = plan.time_frame.first_frame_s + random.uniform(0.3, 2.0)
    while time_s < plan.time_frame.end_s:
        shut_s = time_s + BLINK_DOWN_S
        open_s = shut_s + BLINK_SHUT_S + BLINK_UP_S
        last = bisect_left(entries_s, open_s + ENTRY_GUARD_S) - 1
        if last >= 0 and entries_s[last] > time_s - ENTRY_GUARD_S:
            time_s = entries_s[last] + ENTRY_GUARD_S + random.uniform(0.1, 0.8)
            continue
        rows.append((time_s, shut_s, shut_s + BLINK_SHUT_S, open_s, 1.0))
        pause_s = random.lognormal(np.log(2.4 if rests.hold(time_s) else 4.2), 0.5)
        time_s = open_s + min(max(pause_s, 0.5), 12.0)
    return Envelopes.of(rows)


class _Spans:
    """Spans in order of their starts, asked whether one of them holds a time."""

    def __init__(self, spans: Sequence[tuple[float, float]]) -> None:
        self._starts = [start for start, _ in spans]
        self._ends = list(accumulate((end for _, end in spans), max))

    def hold(self, time_s: float) -> bool:
        """Whether any begins at or before the time and ends after it."""
        index = bisect_right(self._starts, time_s) - 1
        return index >= 0 and self._ends[index] > time_s


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
