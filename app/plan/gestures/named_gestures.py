"""Fits gestures defined in tables (`metadata.gestures`) to one body with one instrument."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import NamedTuple

import msgspec
import numpy as np

from app.errors import Message
from app.plan.by_hand.pose_corrections import GENTLE_RAD_S2, pose_limits
from app.plan.gestures.possible_gestures import LoweredSpans, impossible, may_start
from app.plan.kinds import GESTURE_KINDS, answered_by
from app.plan.model import GestureEvent, Problem
from app.plan.music.piece import LineTimes
from app.plan.music.spans import Spans
from app.plan.parameters import PlayerParameters
from instrument_maps.model import InstrumentMap
from metadata.gestures import AngleKey, AngleTrack, Gesture, HandTrack
from metadata.load import load_body


class Defined(NamedTuple):
    """Gesture events with their definitions fitted to the player, and problems with those that do not fit."""

    gestures: tuple[GestureEvent, ...]
    problems: tuple[Problem, ...]


def with_definitions(
    events: tuple[GestureEvent, ...],
    definitions: Mapping[str, Gesture],
    instrument: InstrumentMap,
    parameters: PlayerParameters,
    times: LineTimes,
    lowered: tuple[tuple[float, float], ...],
) -> Defined:
    """Attach to the events of kind ``"named"`` their gesture, fitted to body and instrument; returns the same tuple if
    there are none. Unknown gestures have no effect; a gesture placed by hand at an unsuitable time is kept and
    reported.
    """
    tracked = answered_by("tracks")
    if all(event.kind not in tracked for event in events):
        return Defined(events, ())
    result: list[GestureEvent] = []
    problems: list[Problem] = []
    limits: dict[str, dict[str, tuple[float, float]]] = {}
    down = LoweredSpans(lowered)
    busy_s = -np.inf
    for event in events:
        definition = definitions.get(event.name)
        if event.kind not in tracked:
            result.append(event)
            continue
        if definition is None:
            said = Message("gesture.unknown", {"name": event.name, "known": ", ".join(sorted(definitions))})
            problems.append(Problem(said, None, event.start_s, event.end_s))
            continue
        if not limits:
            body = load_body()
            limits = {
                track: pose_limits(track, instrument, parameters, body)
                for track in ("bell", "head", "left_elbow", "right_elbow", "torso")
            }
        wrong = None
        if not may_start(definition, event.start_s, event.end_s, times, down):
            wrong = Message("gesture.not_here", {"name": event.name, "start": definition.may_start})
        elif definition.needs_lowered:
            wrong = impossible(definition, instrument)
            if wrong is None and event.start_s < busy_s:
                wrong = Message("gesture.hand_busy", {"name": event.name})
        if wrong is not None:
            problems.append(Problem(wrong, None, event.start_s, event.end_s))
        made = fitted(definition, event.end_s - event.start_s, limits)
        if definition.needs_lowered and wrong is not None:
            made = msgspec.structs.replace(made, hand=None, raised=())
        elif definition.needs_lowered:
            busy_s = event.end_s
            made = _in_hand(made, instrument)
        result.append(msgspec.structs.replace(event, gesture=made))
    return Defined(tuple(result), tuple(problems))


def fitted(gesture: Gesture, length_s: float, limits: Mapping[str, Mapping[str, tuple[float, float]]]) -> Gesture:
    """Adapt a gesture to the range of the instrument and the speed of a body: it becomes smaller if it would be too
    fast for ``length_s``.

    Parameters
    ----------
    limits : mapping of target to mapping of angle to (low, high)
        Degrees, as of `app.plan.by_hand.pose_corrections.pose_limits`.
    """
    largest = max(gesture.amplitude[2], 1.0)
    tracks = []
    for track in gesture.tracks:
        low, high = limits[track.target].get(f"{track.turn}_deg", (0.0, 0.0))
        share = 1.0
        for key in track.keys:
            room = high if key.deg > 0.0 else -low
            if largest * abs(key.deg) > room:
                share = min(share, room / (largest * abs(key.deg)))
        quickest = np.deg2rad(largest * _acceleration_deg(track)) / (length_s * length_s)
        share = min(share, GENTLE_RAD_S2 / max(float(quickest), 1e-9))
        tracks.append(track if share == 1.0 else _scaled(track, share))
    return msgspec.structs.replace(gesture, tracks=tuple(tracks))


def _in_hand(gesture: Gesture, instrument: InstrumentMap) -> Gesture:
    """Return the gesture for an instrument: the hand that moves is the one that can leave the instrument."""
    if gesture.hand is None:
        return gesture
    return msgspec.structs.replace(gesture, hand=HandTrack(gesture.hand.keys, instrument.hold.leaving_hand or "free"))


def without_idle_hands(events: tuple[GestureEvent, ...]) -> tuple[GestureEvent, ...]:
    """Remove the generated small gestures of hands at rest (looking around, settling the grip) while a gesture from the
    tables takes a hand off the instrument; returns the same tuple if there are no such gestures.
    """
    away = [(one.start_s, one.end_s) for one in events if one.gesture is not None and one.gesture.needs_lowered]
    if not away:
        return events
    busy = Spans(away)
    return tuple(
        event
        for event in events
        if event.corrected or not GESTURE_KINDS[event.kind].idle or not busy.meet(event.start_s, event.end_s)
    )


@lru_cache(maxsize=256)
def _acceleration_deg(track: AngleTrack) -> float:
    """Approximate largest acceleration of an angle's keys, in degrees per square second if the gesture lasts one
    second.
    """
    at, deg = np.array([key.at for key in track.keys]), np.array([key.deg for key in track.keys])
    slopes = np.array([abs(key.slope or 0.0) for key in track.keys])
    length = np.diff(at)
    moved = 10.0 / np.sqrt(3.0) * np.abs(np.diff(deg)) / (length * length)
    # Upper bound of a tangent's contribution, from the second derivative of the quintic.
    bent = 10.0 * (slopes[1:] + slopes[:-1]) / length
    return float((moved + bent).max())


def _scaled(track: AngleTrack, share: float) -> AngleTrack:
    keys = tuple(
        AngleKey(key.at, share * key.deg, None if key.slope is None else share * key.slope) for key in track.keys
    )
    return AngleTrack(track.target, track.turn, keys)
