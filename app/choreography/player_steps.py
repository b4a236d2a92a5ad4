"""Steps in place of a dancing player: a dancer's steps, each moved to the nearest beat, around the player's place.

A dancer's feet land when captured, and move as far as the dance does. For a player, each landing is moved to the
nearest place of the beat; of two at one place the longer step is used; and a foot is placed relative to its usual place
under the body as in the dance, scaled down. The shortest steps of a dance become taps of toes or lifts of heels. Where
a dancer stands while music sounds, heels or toes mark the beats.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.arrays import BoolArray, FloatArray
from app.chance import chance
from app.choreography.dance import Dance
from app.choreography.features import facing
from app.choreography.foot_plants import FootPlant
from app.choreography.rhythm import Rhythm
from app.motion.gestures.danced_feet import MOVE_KINDS, DancedFeet, MoveKind
from app.rig import quaternion

QUICK_S, SLOW_S = 0.40, 0.78
"""Lengths of beats in seconds: below the first, steps are on every other beat; above the second, also between beats."""
BETWEEN: Final = 0.25
"""Share of a beat by which a beat must be farther from a landing than the place between beats for the latter to be
used.
"""
LATE: Final = 0.9
"""Share of the way to the next place within which the later of two landings at one place is moved there."""
AIR_S: Final = 0.42
"""Longest time of a foot in the air."""
AIR_SHARE: Final = 0.85
"""Longest time in the air relative to the time since the other foot landed."""
LEAST_AIR_S: Final = 0.22
"""Shortest time in the air in seconds."""
SAME_FOOT_S: Final = 0.55
"""Least time in seconds between two landings of a foot; an earlier step is taken by the other foot."""
MOST_LEAD: Final = 2
"""Number of steps that a foot may have made more than the other one; further ones are taken by the other foot."""
HEEL_S: Final = 0.5
"""Longest time in seconds for which heel or toes are raised."""
LIFT_SHARE: Final = 0.75
"""Time for which a foot is lifted, relative to a beat."""
TOES_CHANCE: Final = 0.4
"""Probability that toes instead of heels mark a phrase's beats without steps, with heels for a seated player."""
PHRASE_BEATS: Final = 8
LIGHT_SHARE: Final = 0.45
"""Share of the landings of a dance, those after the shortest ways, that become taps of toes or lifts of heels."""
LIGHT_HEEL: Final = 0.85
"""Size of a light landing's lift of a heel: between steps the knee has little time."""
TAPS_CHANCE: Final = 0.65
"""Probability that toes instead of heels mark a phrase's light landings."""
IN_FRONT_M: Final = 0.055
"""Distance in metres by which a foot that taps is ahead of the other one; the ankle of the rear foot is bent
already.
"""
USUAL: Final = 0.9
"""Share of the steps within `AHEAD_M` and `OUT_M` after scaling."""
AHEAD_M, BACK_M, OUT_M, IN_M = 0.11, 0.0, 0.08, 0.03
"""Greatest distances of a foot in metres: forward, back (with its heel down under a bent knee), outwards, and towards
the other foot.
"""
SPREAD: Final = 0.35
"""Exponent of a place's relative distance for compressing distances."""
LEAST_SIZE: Final = 0.65
"""Size of the shortest step relative to a usual one."""
MIDDLE_S: Final = 0.6
"""Standard deviation in seconds of the window over the hips' path that defines a foot's usual place."""
HEARD_S: Final = 2.0
"""Time in seconds around a beat within which something must sound for it to be marked."""


@dataclass(frozen=True)
class _Touchdown:
    """A landing of a dancer's foot (0: left): time in seconds, position relative to the foot's usual place in metres
    (left, forward), and length of the step.
    """

    foot: int
    time_s: float
    place_m: tuple[float, float]
    way_m: float

    def other(self) -> _Touchdown:
        """Return the same landing with left and right exchanged."""
        return _Touchdown(1 - self.foot, self.time_s, (-self.place_m[0], self.place_m[1]), self.way_m)


@dataclass(frozen=True)
class _Row:
    foot: int
    kind: MoveKind
    start_s: float
    lands_s: float
    size: float
    place_m: tuple[float, float]


def danced_feet(dance: Dance, rhythm: Rhythm, seed: int, scale: float) -> DancedFeet:
    """Convert the steps of a dance to movements of the feet of a player who dances in place.

    Parameters
    ----------
    seed : int
        Seed of the variation, which selects heels or toes.
    scale : float
        Length of the player's legs relative to an adult's.
    """
    places_s, strong = _places(rhythm)
    if len(places_s) < 2 or not dance.steps:
        return DancedFeet.none()
    danced_s = dance.steps[0].start_s, dance.steps[-1].end_s
    marked = strong & _heard(places_s, rhythm)
    stepped = _stepped(_touchdowns(dance), places_s, strong, marked, danced_s, rhythm, seed)
    rows = _with_marks(stepped, places_s, marked, danced_s, rhythm, seed)
    if not rows:
        return DancedFeet.none()
    toes, heel = MOVE_KINDS.index("toes"), MOVE_KINDS.index("heel")
    heels = [chance("seated feet", seed, _phrase(row.lands_s, rhythm)) < TOES_CHANCE for row in rows]
    return DancedFeet(
        sides=np.array([row.foot for row in rows], np.int64),
        kinds=np.array([MOVE_KINDS.index(row.kind) for row in rows], np.int64),
        seated=np.array([heel if lifts else toes for lifts in heels], np.int64),
        start_s=np.array([row.start_s for row in rows]),
        lands_s=np.array([row.lands_s for row in rows]),
        size=np.array([row.size for row in rows]),
        place_m=scale * np.array([row.place_m for row in rows]),
    )


def _phrase(time_s: float, rhythm: Rhythm) -> int:
    return int(np.searchsorted(rhythm.beats_s, time_s - 1e-6)) // PHRASE_BEATS


def _places(rhythm: Rhythm) -> tuple[FloatArray, BoolArray]:
    """Times (N,) in seconds at which a step may land: beats and the middles between them; and a mask (N,)
    of the beats.
    """
    beats_s = rhythm.beats_s
    if len(beats_s) < 3:
        return beats_s, np.ones(len(beats_s), bool)
    apart_s = float(np.median(np.diff(beats_s)))
    if apart_s < QUICK_S:
        beats_s = beats_s[rhythm.bar_beats % 2 == 0]
    if apart_s <= SLOW_S:
        return beats_s, np.ones(len(beats_s), bool)
    between_s = 0.5 * (beats_s[1:] + beats_s[:-1])
    places_s = np.concatenate([beats_s, between_s])
    order = np.argsort(places_s)
    return places_s[order], (np.arange(len(places_s)) < len(beats_s))[order]


def _heard(places_s: FloatArray, rhythm: Rhythm) -> BoolArray:
    """Mask (N,) of the times at which a drum or note of the rhythm sounds within `HEARD_S`."""
    if not len(rhythm.hits_s):
        return np.zeros(len(places_s), bool)
    low, high = (np.searchsorted(rhythm.hits_s, places_s + way) for way in (-HEARD_S, HEARD_S))
    return np.asarray(high > low)


def _touchdowns(dance: Dance) -> list[_Touchdown]:
    """Collect the landings of a dance in order, with positions relative to the middle of the hips' path."""
    clip, fps = dance.clip, float(dance.clip.fps)
    middle_m = gaussian_filter1d(clip.hips_m, MIDDLE_S * fps, axis=0, mode="nearest")
    back = quaternion.conjugate(facing(clip))
    found: list[_Touchdown] = []
    for foot in range(2):
        own = [stand for stand in dance.standing if stand.foot == foot]
        seen_m = [_seen_m(stand, middle_m, back) for stand in own]
        if len(own) < 2:
            continue
        usual_m = np.median(seen_m, axis=0)
        for before, stand, place_m in zip(own, own[1:], seen_m[1:], strict=False):
            left_m, ahead_m = (place_m - usual_m).tolist()
            way_m = float(np.linalg.norm(np.subtract(stand.place_m, before.place_m)))
            found.append(_Touchdown(foot, dance.first_s + stand.start / fps, (left_m, ahead_m), way_m))
    return sorted(found, key=lambda one: (one.time_s, one.foot))


def _seen_m(stand: FootPlant, middle_m: FloatArray, back: FloatArray) -> FloatArray:
    """Position (2,) of a planted foot relative to the body, in metres to the left and forward."""
    frame = min((stand.start + stand.stop) // 2, len(middle_m) - 1)
    seen = quaternion.rotate(back[frame], np.array(stand.place_m) - middle_m[frame])
    return seen[[0, 2]]


def _stepped(
    touchdowns: list[_Touchdown],
    places_s: FloatArray,
    strong: BoolArray,
    marked: BoolArray,
    danced_s: tuple[float, float],
    rhythm: Rhythm,
    seed: int,
) -> list[_Row]:
    """Move the landings of a dance to beats and half beats, one foot at a time; light ones become taps or lifts of a
    foot that stays.
    """
    chosen: dict[int, _Touchdown] = {}
    for one in touchdowns:
        place = _nearest(one.time_s, places_s, strong)
        there = chosen.get(place)
        if there is not None and there.foot != one.foot and _is_late(one.time_s, place, places_s):
            place, there = place + 1, None
        if danced_s[0] <= places_s[place] <= danced_s[1] and (there is None or one.way_m > there.way_m):
            chosen[place] = one
    if not chosen:
        return []
    steps = [chosen[place] for place in sorted(chosen)]
    usual_m = float(np.median([step.way_m for step in steps])) or 1.0
    light_m = float(np.quantile([step.way_m for step in steps], LIGHT_SHARE))
    lifted_s = min(HEEL_S, LIFT_SHARE * float(np.median(np.diff(places_s))))
    far_m = np.quantile(np.abs([step.place_m for step in steps]), USUAL, axis=0)
    rows: list[_Row] = []
    last_s = {0: -np.inf, 1: -np.inf}
    made = [0, 0]
    for place, step in zip(sorted(chosen), steps, strict=True):
        lands_s = float(places_s[place])
        light = step.way_m <= light_m and marked[place] and rows and rows[-1].kind == "step"
        if light and lands_s - max(last_s.values()) > lifted_s:
            taps = chance("light steps", seed, _phrase(lands_s, rhythm)) < TAPS_CHANCE
            _mark(rows, step.foot, (lands_s - lifted_s, lands_s), taps=taps)
            last_s[rows[-1].foot] = lands_s
            continue
        if lands_s - last_s[step.foot] < SAME_FOOT_S or made[step.foot] - made[1 - step.foot] >= MOST_LEAD:
            step = step.other()
        air_s = min(AIR_S, AIR_SHARE * (lands_s - max(last_s.values())))
        ahead = made[step.foot] - made[1 - step.foot] >= MOST_LEAD
        if ahead or air_s < LEAST_AIR_S or lands_s - last_s[step.foot] < SAME_FOOT_S:
            continue
        size = (LEAST_SIZE + (1.0 - LEAST_SIZE) * min(1.0, step.way_m / usual_m)) * min(1.0, (air_s / AIR_S) ** 2)
        rows.append(_Row(step.foot, "step", lands_s - air_s, lands_s, size, _near(step, far_m)))
        last_s[step.foot] = lands_s
        made[step.foot] += 1
    return rows


def _mark(rows: list[_Row], foot: int, span_s: tuple[float, float], *, taps: bool) -> None:
    """Append a tap of the front foot's toes, for which the last step lands farther ahead or back, or a lift of a foot's
    heel.
    """
    step = rows[-1]
    if taps:
        other_m = _place_m(rows, 1 - step.foot)[1]
        leads = other_m <= AHEAD_M - IN_FRONT_M
        ahead_m = max(step.place_m[1], other_m + IN_FRONT_M) if leads else min(step.place_m[1], other_m - IN_FRONT_M)
        rows[-1] = replace(step, place_m=(step.place_m[0], min(ahead_m, AHEAD_M)))
        foot = step.foot if leads else 1 - step.foot
    kind: MoveKind = "toes" if taps else "heel"
    rows.append(_Row(foot, kind, *span_s, 1.0 if taps else LIGHT_HEEL, _place_m(rows, foot)))


def _place_m(rows: list[_Row], foot: int) -> tuple[float, float]:
    """Position of a foot (left, forward) in metres after the last of some moves."""
    return next((row.place_m for row in reversed(rows) if row.foot == foot), (0.0, 0.0))


def _front(rows: list[_Row]) -> int:
    """Index of the foot that is in front after some moves; players stand with the left one a little ahead."""
    return int(_place_m(rows, 1)[1] - _place_m(rows, 0)[1] > IN_FRONT_M)


def _nearest(time_s: float, places_s: FloatArray, strong: BoolArray) -> int:
    """Index of the place (beat or half beat) that suits the time of a landing best; places between beats count as
    farther away.
    """
    off_s = np.abs(places_s - time_s)
    beat_s = float(np.median(np.diff(places_s[strong])))
    return int((off_s + np.where(strong, 0.0, BETWEEN * beat_s)).argmin())


def _is_late(time_s: float, place: int, places_s: FloatArray) -> bool:
    """Return whether a landing is so long after its place that the next place would suit it equally well."""
    if place + 1 == len(places_s):
        return False
    return bool(places_s[place + 1] - time_s < LATE * (places_s[place + 1] - places_s[place]))


def _near(step: _Touchdown, far_m: FloatArray) -> tuple[float, float]:
    """Position of a foot (left, forward) in metres for a player who dances in place: as in the dance, scaled down, and
    never in front of the other foot.

    Most steps of a dance are short; these are scaled down less, so that they stay visible.
    """
    most_m = np.minimum((OUT_M, AHEAD_M), far_m)
    shares = np.minimum(1.0, np.abs(step.place_m) / np.maximum(far_m, 1e-6)) ** SPREAD
    left_m, ahead_m = (most_m * np.sign(step.place_m) * shares).tolist()
    out_m = left_m if step.foot == 0 else -left_m
    out_m = float(np.clip(out_m, -IN_M, OUT_M))
    return (out_m if step.foot == 0 else -out_m), float(np.clip(ahead_m, -BACK_M, AHEAD_M))


def _with_marks(
    stepped: list[_Row],
    places_s: FloatArray,
    marked: BoolArray,
    danced_s: tuple[float, float],
    rhythm: Rhythm,
    seed: int,
) -> list[_Row]:
    """Add taps of heels and toes to the steps, at some of the beats that have no step."""
    rows, lands_s = list(stepped), np.array([row.lands_s for row in stepped])
    apart_s = float(np.median(np.diff(rhythm.beats_s)))
    last_phrase, foot = -1, 0
    made = {"heel": [0, 0], "toes": [0, 0]}
    for place, time_s in enumerate(places_s.tolist()):
        if not marked[place] or not danced_s[0] <= time_s <= danced_s[1]:
            continue
        near = np.searchsorted(lands_s, time_s - 1e-6)
        before_s = time_s - float(lands_s[near - 1]) if near else np.inf
        after_s = float(lands_s[near]) - time_s if near < len(lands_s) else np.inf
        # The foot has no time to lift if the previous landing is too near.
        if min(before_s, after_s) < 0.99 * apart_s:
            continue
        phrase = _phrase(time_s, rhythm)
        kind: MoveKind = "toes" if chance("marked beats", seed, phrase) < TOES_CHANCE else "heel"
        own = made[kind]
        if phrase != last_phrase:
            first = int(chance("marking foot", seed, phrase) < 0.5)
            last_phrase, foot = phrase, first if own[0] == own[1] else int(own[1] < own[0])
        elif kind == "heel" or own[foot] - own[1 - foot] >= MOST_LEAD:
            foot = 1 - foot
        up_s = min(HEEL_S, LIFT_SHARE * apart_s)
        leads = _front(stepped[:near])
        if after_s < 1.5 * apart_s:
            # The other foot is about to step, so this one marks the beat.
            foot = 1 - stepped[near].foot
            kind = kind if foot == leads else "heel"
        elif kind == "toes":
            foot = leads
        place_m = _place_m(stepped[:near], foot)
        rows.append(_Row(foot, kind, time_s - up_s, time_s, 1.0, place_m))
        made[kind][foot] += 1
    return sorted(rows, key=lambda row: row.lands_s)
