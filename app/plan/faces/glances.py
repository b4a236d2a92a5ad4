"""Glances: at the player who cues an entry, at the players who are cued, and away from the music while not playing.

Players of an entry look at the cueing player from before the preparatory motion to the entry; the cueing player looks
at them before it. Directions come from the places on the stage. An eye turns `EYES_RAD` at most; the head turns for the
rest, or the eye's corner suffices.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final

import msgspec

from app.plan.model import ABOUT, AUDIENCE, FAR_M, CueEvent, GestureEvent, GlanceEvent
from app.plan.music.piece import Seeds
from app.plan.music.spans import Spans
from app.plan.rules import lowered_spans_s
from metadata.gestures import GazeTrack

EYES_RAD: Final = math.radians(35.0)
PLAYING_HEAD: Final = 0.3
"""Share of a glance that the head takes while the instrument is at the lips; the eyes take the rest."""
FREE_HEAD: Final = 0.65
"""Share of a glance that the head takes while the instrument is not at the lips."""
MOST_RAD: Final = 1.1
"""Greatest sideways angle of a glance in radians."""
MOST_UP_RAD: Final = 0.35
LEVEL_RAD: Final = 0.02
"""Downward angle in radians of looks at objects of unknown height."""
AUDIENCE_M: Final = 6.0
OWN_HANDS_M: Final = 0.45
NEAREST_M: Final = 0.5
"""Least distance between two players."""
TO_GIVER_S: Final = (0.25, 0.6)
"""Range of the time before a cue begins at which players look at its giver; see `STAYS_S`."""
STAYS_S: Final = (0.05, 0.35)
"""Range of the seconds after the entry for which players continue to look at the giver of a cue."""
TO_TAKERS_S: Final = (1.0, 1.6)
"""Range of the time before a cue at which its giver looks at the others; see `LOOK_S`."""
LOOK_S: Final = (0.6, 0.95)
"""Range of the duration in seconds of the cue giver's look at the others."""
LEAST_S: Final = 0.5
"""Shortest glance in seconds."""
SIDE_RAD: Final = (0.5, 1.0)


class StagePlace(msgspec.Struct, frozen=True):
    """Position of a player on stage in metres, the audience towards +Z; the turn is from +Z towards +X in radians,
    ``eyes_m`` the height of the eyes above the floor."""

    x_m: float
    z_m: float
    turn_rad: float
    eyes_m: float = 0.0


def glances_of(
    player_id: str,
    cues: Sequence[CueEvent],
    gestures: Sequence[GestureEvent],
    places: Mapping[str, StagePlace],
    seeds: Seeds,
    up: tuple[GlanceEvent, ...] = (),
) -> tuple[GlanceEvent, ...]:
    """All glances of a player, in order and without overlaps.

    Parameters
    ----------
    cues : sequence of CueEvent
        Of all players.
    gestures : sequence of GestureEvent
        The player's gestures, corrections applied.
    places : mapping of str to StagePlace
        Place of every player and of the conductor, by id; a look is planned only if both the player and its target have
        one.
    up : tuple of GlanceEvent
        Looks up to the conductor while playing (`app.plan.faces.looks_at_conductor`).
    """
    found: list[GlanceEvent] = []
    for cue in cues:
        if cue.player_id == player_id:
            found += _to_takers(cue, places, seeds)
        elif player_id in cue.takers:
            found += _to_giver(cue, player_id, places, seeds)
    for event in gestures:
        if event.part == "glance":
            found += _about(event, seeds)
        elif event.part == "audience" and player_id in places:
            yaw_rad = _wrapped(-places[player_id].turn_rad)
            found.append(_glance(f"glance:{event.id}", AUDIENCE, event.start_s, event.end_s, yaw_rad, AUDIENCE_M))
        elif event.gesture is not None and event.gesture.gaze is not None and event.amount > 0.0:
            found.append(_at_own_hands(event, event.gesture.gaze))
    taken = Spans((one.start_s, one.end_s) for one in found)
    # Looking up from the music is omitted during a planned glance.
    found += [one for one in up if not taken.meet(one.start_s, one.end_s)]
    lowered = Spans(lowered_spans_s(gestures))
    return tuple(_in_turn([_turned(one, lowered) for one in found]))


def _to_giver(cue: CueEvent, player_id: str, places: Mapping[str, StagePlace], seeds: Seeds) -> list[GlanceEvent]:
    if player_id not in places or cue.player_id not in places:
        return []
    before_s = _between(TO_GIVER_S, seeds.chance_at("glance before", cue.end_tick))
    after_s = _between(STAYS_S, seeds.chance_at("glance after", cue.end_tick))
    name, span_s = f"glance:{cue.id}", (cue.start_s - before_s, cue.downbeat_s + after_s)
    return [glance_at(name, cue.player_id, span_s, places[player_id], places[cue.player_id])]


def _to_takers(cue: CueEvent, places: Mapping[str, StagePlace], seeds: Seeds) -> list[GlanceEvent]:
    """Plan the looks of the cueing player at one or two of the cued players, the nearest first; the player looks back
    at the music for the entry.
    """
    if cue.player_id not in places:
        return []
    own = places[cue.player_id]
    others = sorted(
        (math.hypot(places[one].x_m - own.x_m, places[one].z_m - own.z_m), one) for one in cue.takers if one in places
    )
    found = []
    at_s = cue.start_s - _between(TO_TAKERS_S, seeds.chance_at("glance round", cue.end_tick))
    for number, (_, other) in enumerate(others[:2]):
        lasts_s = _between(LOOK_S, seeds.chance_at(f"glance {number}", cue.end_tick))
        name = f"glance:{cue.id}:{number}"
        found.append(glance_at(name, other, (at_s, at_s + lasts_s), own, places[other]))
        at_s += lasts_s
    return found


def _about(event: GestureEvent, seeds: Seeds) -> list[GlanceEvent]:
    """Plan two glances for a gesture of looking around: to one side, then less far to the other."""
    side = 1.0 if seeds.chance_at("look side", event.start_tick) < 0.5 else -1.0
    turn_s = event.start_s + (0.5 + 0.2 * seeds.chance_at("look turn", event.start_tick)) * (
        event.end_s - event.start_s
    )
    wide = _between(SIDE_RAD, seeds.chance_at("look wide", event.start_tick)) * event.amount
    back = (0.3 + 0.5 * seeds.chance_at("look back", event.start_tick)) * wide
    return [
        _glance(f"glance:{event.id}:0", ABOUT, event.start_s, turn_s, side * wide),
        _glance(f"glance:{event.id}:1", ABOUT, turn_s, event.end_s, -side * back),
    ]


def _at_own_hands(event: GestureEvent, gaze: GazeTrack) -> GlanceEvent:
    """Return the glance at the player's own hands that belongs to a gesture."""
    length_s = event.end_s - event.start_s
    return GlanceEvent(
        f"glance:{event.id}",
        ABOUT,
        event.start_s + gaze.start * length_s,
        event.start_s + gaze.end * length_s,
        math.radians(gaze.left_deg),
        -math.radians(gaze.up_deg),
        FREE_HEAD,
        OWN_HANDS_M,
    )


def bearing_rad(own: StagePlace, other: StagePlace) -> float:
    """Return the direction of another player relative to the player's facing, in radians; left is positive."""
    across_m, ahead_m = other.x_m - own.x_m, other.z_m - own.z_m
    if across_m == 0.0 and ahead_m == 0.0:
        return 0.0
    return _wrapped(math.atan2(across_m, ahead_m) - own.turn_rad)


def pitch_rad(own: StagePlace, other: StagePlace) -> float:
    """Return the pitch in radians of a look at another player's eyes; down is positive."""
    return round(min(max(math.atan2(own.eyes_m - other.eyes_m, _apart_m(own, other)), -MOST_UP_RAD), MOST_UP_RAD), 4)


def glance_at(name: str, at: str, span_s: tuple[float, float], own: StagePlace, other: StagePlace) -> GlanceEvent:
    """Plan a glance during ``span_s`` from a player's place on stage at the eyes of someone at ``other``."""
    pitch = pitch_rad(own, other)
    away_m = round(_apart_m(own, other) / math.cos(pitch), 3)
    return GlanceEvent(name, at, *span_s, bearing_rad(own, other), pitch, PLAYING_HEAD, away_m)


def _apart_m(own: StagePlace, other: StagePlace) -> float:
    return max(math.hypot(other.x_m - own.x_m, other.z_m - own.z_m), NEAREST_M)


def _wrapped(angle_rad: float) -> float:
    return math.remainder(angle_rad, 2.0 * math.pi)


def _glance(name: str, at: str, start_s: float, end_s: float, yaw_rad: float, away_m: float = FAR_M) -> GlanceEvent:
    return GlanceEvent(name, at, start_s, end_s, yaw_rad, LEVEL_RAD, PLAYING_HEAD, away_m)


def _turned(glance: GlanceEvent, lowered: Spans) -> GlanceEvent:
    """Return the glance with the head's share of its turn filled in, limited to the range of eyes and head; ``lowered``
    are the spans in which the instrument is off the lips, so that the head can turn further.
    """
    free = lowered.hold(glance.start_s - 0.5, glance.end_s + 0.5)
    share = FREE_HEAD if free else PLAYING_HEAD
    most_rad = min(EYES_RAD / (1.0 - share), MOST_RAD)
    yaw_rad = min(max(glance.yaw_rad, -most_rad), most_rad)
    return msgspec.structs.replace(glance, yaw_rad=round(yaw_rad, 4), head_share=share)


def _in_turn(glances: list[GlanceEvent]) -> list[GlanceEvent]:
    """Shorten overlapping glances so that each ends where the next begins, and drop those that become too short."""
    ordered = sorted(glances, key=lambda one: (one.start_s, one.id))
    kept: list[GlanceEvent] = []
    for glance in ordered:
        while kept and kept[-1].end_s > glance.start_s:
            last = kept.pop()
            if glance.start_s - last.start_s >= LEAST_S:
                kept.append(msgspec.structs.replace(last, end_s=glance.start_s))
                break
        kept.append(glance)
    return [one for one in kept if one.end_s - one.start_s >= LEAST_S]


def _between(bounds: tuple[float, float], share: float) -> float:
    return bounds[0] + (bounds[1] - bounds[0]) * share
