"""Gaze of a player, and the head motion that follows it.

The eyes read the music line by line, leave it for planned glances and cues, wander in rests and occasionally while
playing, and look at the audience at the end. Saccades last 50 ms or more (Bahill et al. 1975); the head follows larger
ones about 100 ms later and more slowly. Random values depend on places in time, so an edit only changes what is near.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray
from app.motion.curves.curve import Curve, Envelopes, moves_to
from app.motion.curves.seeded_chance import generator
from app.motion.curves.spline import Spline
from app.motion.faces.blinks import BLINK_DOWN_S, BLINK_SHUT_S, BLINK_UP_S, ENTRY_GUARD_S, blinks_of
from app.motion.faces.silences import Silences, holds, overlaps
from app.plan.model import ABOUT, FAR_M, PlayerPlan, only
from app.plan.styles import share_at
from app.steps import StepTable, reading

__all__ = ["BLINK_DOWN_S", "BLINK_SHUT_S", "BLINK_UP_S", "ENTRY_GUARD_S", "Gaze", "GazeFrames", "Watching", "plan_gaze"]

SACCADE_S = 0.05
SACCADE_BASE_S, SACCADE_S_RAD = 0.035, 0.12
"""Duration of a saccade: a base in seconds, and seconds for each radian."""
HEAD_TURN_S = 0.45
HEAD_LAG_S: Final = 0.18
"""Delay in seconds of the head's curve; due to the curve's rounding it begins about 80 ms after the eyes."""
HEAD_STEP_S: Final = 0.05
MOST_YAW_RAD, MOST_UP_RAD, MOST_DOWN_RAD = 0.5, 0.15, 0.4
MUSIC_PITCH_RAD, MUSIC_M = 0.20, 0.65
"""Downward angle to the music in radians (about 12 degrees) and its distance from the eyes in metres."""
LINE_RAD, SYSTEM_RAD, SYSTEMS = 0.075, 0.018, 6
"""Half the width of a line of music and the angle between lines in radians, and the number of lines on a page."""
LINE_S = (5.0, 8.0)
"""Range of the seconds in which a line is read."""
FIXATION_S: Final = 0.65
LOOK_S: Final = 1.9
"""Longest look away from the music, in seconds."""
UP_IN_PHRASE, ABOUT_IN_REST = 0.10, 0.5
"""Probabilities of a look up while playing, and of a look around in a rest."""
BACK_S: Final = 0.8
"""Seconds before an entry at which the eyes are on the music again."""
CUE_LEAD_S, CUE_BACK_BEATS = 0.3, 0.6
ASIDE_RAD: Final = 0.22
AUDIENCE_S: Final = 0.9
"""Seconds after the last note at which the eyes look up to the audience."""
CLOSE_S: Final = 0.14
"""Shortest fixation, in seconds."""
PLAYING_SHARE, RESTING_SHARE, READING_SHARE = 0.35, 0.6, 0.25
"""Shares of the gaze's rotation that the head follows while playing, resting and reading."""
HEAD_TURNS = 0.5
"""Share of the allowed rotation that the head makes with a look (`app.motion.gestures.body_layers`)."""
EYES_RAD: Final = 0.52
"""Greatest rotation of the eyes in the head in radians; the head turns for the remainder."""
PLAYING_TURN_RAD, FREE_TURN_RAD, LOW_ENOUGH = 0.2, 2.0, 0.7
"""Allowed rotation of the head in radians with the instrument at the lips and with it lowered, and the share of
lowering from which the second value applies.
"""


@dataclass(frozen=True)
class GazeFrames:
    """Direction of the eyes and position of the lids at F frames; fields as in `Gaze`, each (F,)."""

    yaw_rad: FloatArray
    pitch_rad: FloatArray
    near_per_m: FloatArray
    own: FloatArray
    head_yaw_rad: FloatArray
    head_pitch_rad: FloatArray
    left_lid: FloatArray
    right_lid: FloatArray


def with_instrument(look: GazeFrames, lowered: FloatArray) -> GazeFrames:
    """Reduce the head's part of each look while the instrument is at the lips, since the hands cannot follow far; the
    eyes turn more instead, as far as they can.

    Parameters
    ----------
    lowered : (F,) float64
        0 with the instrument at the lips, 1 with it lowered.
    """
    free = np.clip((lowered - LOW_ENOUGH) / (1.0 - LOW_ENOUGH), 0.0, 1.0)
    most_rad = PLAYING_TURN_RAD + FREE_TURN_RAD * free * free * (3.0 - 2.0 * free)
    turned_rad = most_rad * np.tanh(look.head_yaw_rad / most_rad)
    eyes_rad = np.clip(look.yaw_rad - HEAD_TURNS * turned_rad, -EYES_RAD, EYES_RAD)
    return replace(look, head_yaw_rad=turned_rad, yaw_rad=eyes_rad + HEAD_TURNS * turned_rad)


@dataclass(frozen=True)
class Gaze:
    """Direction of the eyes in the world, and closure of the lids.

    Attributes
    ----------
    yaw_rad, pitch_rad : Curve
        Direction; left and down are positive.
    near_per_m : Curve
        Reciprocal of the target's distance.
    own : Curve
        Reference of the directions: 1: eyes and head in the posture; 0: above the feet and level, like stage places.
    head : Spline
        Yaw and pitch that the head follows.
    left_lid, right_lid : Envelopes
        1 is closed.
    """

    yaw_rad: Curve
    pitch_rad: Curve
    near_per_m: Curve
    own: Curve
    head: Spline
    left_lid: Envelopes
    right_lid: Envelopes

    def sample(self, times_s: FloatArray) -> GazeFrames:
        """Return the direction of eyes and lids at ascending times (F,)."""
        head_yaw_rad, head_pitch_rad = self.head.sample(times_s)
        turned_rad = HEAD_TURNS * head_yaw_rad
        return GazeFrames(
            yaw_rad=np.clip(self.yaw_rad.sample(times_s), turned_rad - EYES_RAD, turned_rad + EYES_RAD),
            pitch_rad=self.pitch_rad.sample(times_s),
            near_per_m=self.near_per_m.sample(times_s),
            own=self.own.sample(times_s),
            head_yaw_rad=head_yaw_rad,
            head_pitch_rad=head_pitch_rad,
            left_lid=self.left_lid.sample(times_s),
            right_lid=self.right_lid.sample(times_s),
        )


class Watching(NamedTuple):
    """Settings of a player's gaze that are not part of the plan.

    Attributes
    ----------
    seed : int
        Seed of random choices.
    gaze, blink : float
        Frequency of looks away from the music, and of blinks; 1 is usual.
    """

    seed: int = 0
    gaze: float = 1.0
    blink: float = 1.0


def plan_gaze(plan: PlayerPlan, watching: Watching, silences: Silences) -> Gaze:
    """Plan the directions of the eyes and the blinks of a whole performance; chance is determined by the
    player's seed.
    """
    at_s, looks = _fixations(plan, silences, watching)
    yaw, pitch = looks.yaw, looks.pitch
    far = np.hypot(np.diff(yaw, prepend=yaw[:1]), np.diff(pitch, prepend=pitch[:1]))
    until_s = np.minimum(
        at_s + np.maximum(SACCADE_BASE_S + SACCADE_S_RAD * far, SACCADE_S), np.append(at_s[1:], np.inf)
    )
    left_lid, right_lid = blinks_of(plan, silences, watching.seed, watching.blink)
    return Gaze(
        yaw_rad=moves_to(at_s, until_s, yaw),
        pitch_rad=moves_to(at_s, until_s, pitch, MUSIC_PITCH_RAD),
        near_per_m=moves_to(at_s, until_s, looks.near, 1.0 / MUSIC_M),
        own=moves_to(at_s, until_s, looks.own, 1.0),
        head=_head(plan, at_s, looks.share * yaw, 0.25 * looks.share * (pitch - MUSIC_PITCH_RAD)),
        left_lid=left_lid,
        right_lid=right_lid,
    )


class _Fixed(NamedTuple):
    """The K directions in which the eyes look one after another, each (K,): direction and nearness as in `Gaze`, and
    the share of the turn that the head follows.
    """

    yaw: FloatArray
    pitch: FloatArray
    share: FloatArray
    near: FloatArray
    own: FloatArray


class _Looks(NamedTuple):
    """The K looks away from the music: spans (K, 2) in seconds in order, and their directions."""

    spans_s: FloatArray
    at: _Fixed


def _looks(
    spans_s: FloatArray,
    yaw: FloatArray,
    pitch: FloatArray,
    share: FloatArray | float,
    near: FloatArray | float = 1.0 / FAR_M,
    own: FloatArray | float = 1.0,
) -> _Looks:
    return _Looks(spans_s, _Fixed(yaw, pitch, *(np.broadcast_to(one, len(yaw)) for one in (share, near, own))))


def _fixations(plan: PlayerPlan, silences: Silences, watching: Watching) -> tuple[FloatArray, _Fixed]:
    """Return the times (K,) at which the gaze moves to a new target, and those targets."""
    random, frame = _random(plan, watching, "reads"), plan.time_frame
    line_s, side = float(random.uniform(*LINE_S)), 1.0 if random.random() < 0.5 else -1.0
    layers = [
        _about(plan, silences, watching),
        _audience(plan, silences, watching),
        _cues(plan, side),
        _glances(plan),
    ]
    reads = int(np.ceil((frame.end_s - frame.first_frame_s) / FIXATION_S))
    chances = random.random((reads, 3))
    read_s = frame.first_frame_s + (np.arange(reads) + 0.15 + 0.7 * chances[:, 0]) * FIXATION_S
    turns_s = np.sort(np.concatenate([layer.spans_s.ravel() for layer in layers]))
    turns_s = turns_s[(turns_s >= frame.first_frame_s) & (turns_s < frame.end_s)]
    near = holds(np.stack((turns_s - CLOSE_S, turns_s + CLOSE_S), axis=1), read_s)
    at_s = np.concatenate((read_s[~near], turns_s))
    jitter = np.concatenate((chances[~near, 1:], np.full((len(turns_s), 2), 0.5)))
    order = np.argsort(at_s, kind="stable")
    at_s, jitter = at_s[order], jitter[order]
    # If two glances are too close together the earlier one is dropped: the eyes stay a moment longer.
    wide = np.append(np.diff(at_s) >= CLOSE_S, np.ones(min(len(at_s), 1), dtype=bool))
    at_s, jitter = at_s[wide], jitter[wide]
    line, along = np.divmod((at_s - frame.first_frame_s) / line_s, 1.0)
    yaw = LINE_RAD * (1.0 - 2.0 * along) + 0.03 * (jitter[:, 0] - 0.5)
    pitch = MUSIC_PITCH_RAD + SYSTEM_RAD * (line % SYSTEMS - 0.5 * (SYSTEMS - 1)) + 0.012 * (jitter[:, 1] - 0.5)
    found = _looks(np.empty((0, 2)), yaw, pitch, READING_SHARE, 1.0 / MUSIC_M).at
    for layer in layers:
        if len(layer.spans_s):
            number = np.maximum(np.searchsorted(layer.spans_s[:, 0], at_s, side="right") - 1, 0)
            here = (at_s >= layer.spans_s[number, 0]) & (at_s < layer.spans_s[number, 1])
            found = _Fixed(*(np.where(here, new[number], old) for new, old in zip(layer.at, found, strict=True)))
    return at_s, found


def _random(plan: PlayerPlan, watching: Watching, purpose: str) -> np.random.Generator:
    # A generator for each purpose: a longer piece draws more numbers without changing the existing ones.
    return generator(plan.player_id, watching.seed, "gaze", purpose)


def _about(plan: PlayerPlan, silences: Silences, watching: Watching) -> _Looks:
    """Plan looks around in rests, and occasional looks up while playing."""
    frame = plan.time_frame
    slots = int(np.ceil((frame.end_s - frame.first_frame_s) / LOOK_S))
    chances = _random(plan, watching, "about").random((slots, 3))
    wide, up = (_random(plan, watching, "where").normal(0.0, 1.0, (slots, 2)) * (0.25, 0.04) + (0.0, 0.03)).T
    start_s = frame.first_frame_s + (np.arange(slots) + 0.4 * chances[:, 0]) * LOOK_S
    resting = holds(silences.rests_s, start_s)
    end_s = start_s + np.where(resting, LOOK_S * (0.35 + 0.2 * chances[:, 1]), 0.5 + 0.3 * chances[:, 1])
    ready_s = np.append(silences.entries_s - BACK_S, np.inf)
    end_s = np.where(resting, np.minimum(end_s, ready_s[np.searchsorted(silences.entries_s, start_s, "right")]), end_s)
    gaze = watching.gaze * share_at(plan.styles, "gaze", start_s)
    kept = chances[:, 2] < gaze * np.where(resting, ABOUT_IN_REST, UP_IN_PHRASE)
    # Hands and eyes are busy while the instrument is lowered or raised.
    kept &= (end_s - start_s > 2.0 * CLOSE_S) & ~overlaps(silences.carried_s, start_s, end_s + HEAD_TURN_S)
    yaw = np.clip(np.where(resting, wide, 0.4 * wide), -MOST_YAW_RAD, MOST_YAW_RAD)
    pitch = np.clip(up, -MOST_UP_RAD, MOST_DOWN_RAD)
    share = np.where(resting, RESTING_SHARE, PLAYING_SHARE)
    return _looks(np.stack((start_s, end_s), axis=1)[kept], yaw[kept], pitch[kept], share[kept])


def _audience(plan: PlayerPlan, silences: Silences, watching: Watching) -> _Looks:
    """Plan the gaze after the end: on the music during the last note, then to several places in the audience."""
    chances = _random(plan, watching, "audience").normal(0.0, 1.0, (4, 2))
    last_s = float(silences.ends_s[-1]) if len(silences.ends_s) else np.inf
    at_s = last_s + np.array([-0.3, AUDIENCE_S, AUDIENCE_S + 1.7, AUDIENCE_S + 3.9, np.inf])
    yaw = np.append([0.0], 0.10 * chances[1:, 0])
    pitch = np.append([MUSIC_PITCH_RAD - 0.02], -0.02 + 0.015 * chances[1:, 1])
    return _looks(np.stack((at_s[:-1], at_s[1:]), axis=1), yaw, pitch, RESTING_SHARE)


def _cues(plan: PlayerPlan, side: float) -> _Looks:
    """Plan looks up from the music while the player gives a cue, and back for the entry; the targets are those of the
    plan (`_glances`).
    """
    spans_s = [(cue.start_s - CUE_LEAD_S, cue.end_s - CUE_BACK_BEATS * cue.beat_s) for cue in plan.cues]
    rows = np.array(spans_s).reshape(-1, 2)
    return _looks(rows, np.full(len(rows), side * ASIDE_RAD), np.zeros(len(rows)), PLAYING_SHARE)


def _glances(plan: PlayerPlan) -> _Looks:
    rows = np.array(
        [
            (
                *(one.start_s, one.end_s, one.yaw_rad, one.pitch_rad, one.head_share / HEAD_TURNS),
                *(1.0 / one.away_m, float(one.at == ABOUT)),
            )
            for one in plan.glances
        ]
    ).reshape(-1, 7)
    return _looks(rows[:, :2], *rows[:, 2:].T)


def _head(plan: PlayerPlan, at_s: FloatArray, yaw: FloatArray, pitch: FloatArray) -> Spline:
    """Curve of the head's turn, delayed and slow, that follows the eyes to the directions ``yaw`` and ``pitch`` (K,)
    they take at the times ``at_s``.
    """
    first = int(np.floor(plan.time_frame.first_frame_s / HEAD_STEP_S)) - 1
    count = int(np.ceil(plan.time_frame.end_s / HEAD_STEP_S)) + 2 - first
    grid_s = (first + np.arange(count)) * HEAD_STEP_S
    held = np.searchsorted(at_s, grid_s - HEAD_LAG_S, side="right")
    steps = round(0.5 * HEAD_TURN_S / HEAD_STEP_S)
    rows = []
    for values in (yaw, pitch):
        # Integers in millionths, so that their mean does not depend on the order of summation.
        whole = np.rint(1e6 * np.append(0.0, values)[held]).astype(np.int64)
        for _ in range(2):
            total = np.concatenate(([0], np.cumsum(np.concatenate((np.full(steps, whole[0]), whole)))))
            whole = (total[steps + 1 :] - total[: -steps - 1]) // (steps + 1)
        rows.append(whole)
    return Spline(first, HEAD_STEP_S, np.stack(rows).astype(np.int32), 1e6)


GAZE: Final = StepTable(
    silences=Silences.of,
    plan_of_looks=partial(only, fields=("breaths", "cues", "glances", "styles")),
    gaze=reading(plan_gaze, plan="plan_of_looks"),
)
"""Steps that compute a gaze from the plan and `Watching`; it depends on the times of notes but not on their pitches."""
