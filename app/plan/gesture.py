"""Body motion as gestures: sway on the beat, weight shifts, the bell's height, the instrument lowered in long rests.

How to read the events: sway, weight_shift and bell_height each lie end to end, and an event's ``amount`` is where the
body goes: at the end of a sway (a half swing from beat to beat), and for as long as it lasts for the other two.
``lower_instrument`` spans from leaving the lips to being back at them; one that reaches beyond the time frame begins
(or stays) lowered. Sizes belong to the motion, which scales by the player's amplitude.

Everything random is drawn from player and score position (tick), so the same place repeats in every run, however the
rest of the piece is edited (Wanderley: players repeat the same bell movement at the same place).

Messages
--------
gesture.sway(beats, beat_s): "Half a swing in {beats} beats of {beat_s} s."
gesture.weight_shift(side): "A shift of weight to the {side} foot."
gesture.bell_height(pitch, mean_pitch): "The melody is around MIDI {pitch}; the line's mean is {mean_pitch}."
gesture.lower_instrument(rest_s): "{rest_s} s of rest: the instrument comes down and is up again before the entry."
gesture.lower_at_end(after_s): "{after_s} s after the last note the instrument comes down."
gesture.lower_at_start(rest_s): "The entry is {rest_s} s away: the instrument is still down."
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np

from app.errors import Message
from app.plan.line import LineTimes, Piece, Seeds
from app.plan.memo import Memo
from app.plan.model import BreathEvent, CueEvent, FloatArray, GestureEvent, Note, TimeFrame

SWING_S = 1.1
"""A body's half swing takes about this long, whatever the tempo: 1, 2, 4 or 8 beats of it."""
SHIFT_MEAN_S = 9.0
SHIFT_LEAST_S = 3.0
CONTOUR_SEMITONES = 10.0
"""This far above or below the line's mean the bell is as high or as low as it gets."""
CONTOUR_STEP = 0.12
"""Smaller differences of the bell's height are one gesture."""
LOWER_REST_S = 6.0
"""A shorter rest does not take the instrument off the lips."""
LOWER_S = 1.1
RAISE_S = 1.2
LOWERED_LEAST_S = 1.0
"""Coming down is not worth it for less."""
AFTER_NOTE_S = 0.5
BEFORE_BREATH_S = 0.2
_RESTING = 0.35
"""Size of the sway while not playing."""


def plan_gestures(
    notes: tuple[Note, ...],
    times: LineTimes,
    piece: Piece,
    frame: TimeFrame,
    breaths: tuple[BreathEvent, ...],
    cues: tuple[CueEvent, ...],
    seeds: Seeds,
    swing_at_s: float,
    memo: Memo,
) -> tuple[GestureEvent, ...]:
    """All gestures of one player, ordered by start.

    Parameters
    ----------
    seeds : Seeds
        The player's.
    swing_at_s : float
        Where the piece's tempo is taken to choose how many beats a swing has: the same for all players.
    memo : Memo
        Each kind is a step of its own: a pitch that changes moves the bell, and no swing.
    """
    kinds = (
        memo.step(
            "sways",
            lambda: tuple(sways(times, piece, frame, seeds, swing_at_s)),
            times.rhythm,
            piece,
            frame,
            seeds,
            swing_at_s,
        ),
        memo.step("weight shifts", lambda: tuple(weight_shifts(piece, frame, seeds)), piece, frame, seeds),
        memo.step("bell heights", lambda: tuple(bell_heights(notes, times, piece)), notes, times, piece),
        memo.step(
            "lowered",
            lambda: tuple(lowered_spans(notes, times, piece, frame, breaths, cues)),
            notes,
            times.rhythm,
            piece,
            frame,
            breaths,
            cues,
        ),
    )
    return memo.step("gestures", lambda: _in_order(*kinds), *kinds)


def _in_order(*kinds: tuple[GestureEvent, ...]) -> tuple[GestureEvent, ...]:
    return tuple(sorted(itertools.chain(*kinds), key=lambda event: (event.start_s, event.id)))


def sways(times: LineTimes, piece: Piece, frame: TimeFrame, seeds: Seeds, swing_at_s: float) -> list[GestureEvent]:
    """Half swings from beat to beat, left and right in turn, each of its own size; small where the player rests."""
    clock, beat = piece.clock, piece.beat_ticks
    at_tick = clock.ticks(swing_at_s)
    beat_s = clock.seconds(at_tick + beat) - clock.seconds(at_tick)
    beats = min((1, 2, 4, 8), key=lambda count: abs(np.log(count * beat_s / SWING_S)))
    if seeds.chance("swing") < 0.3 and beats * beat_s < 1.5 * SWING_S:
        # Some players take the tempo in longer swings than others.
        beats *= 2
    first_tick, last_tick = int(clock.ticks(frame.first_frame_s)), int(np.ceil(clock.ticks(frame.end_s)))
    margin = 2 * beats * beat
    every = piece.beats(first_tick - margin, last_tick + margin)
    # Counted from the piece's beginning, so that a longer pre-roll or a note added at the end changes nothing.
    phase = (int(np.searchsorted(every, 0)) + int(seeds.chance("phase") * beats)) % beats
    ticks = every[phase::beats]
    origin = int(np.searchsorted(ticks, 0))
    seconds = clock.seconds(ticks.astype(np.float64))
    playing = _sounding_share(times, seconds)
    flip = 1.0 if seeds.chance("side") < 0.5 else -1.0
    reason = Message("gesture.sway", {"beats": beats, "beat_s": round(beat_s, 3)})
    events = []
    for index in range(len(ticks) - 1):
        start_s, end_s = float(seconds[index]), float(seconds[index + 1])
        if end_s <= frame.first_frame_s or start_s >= frame.end_s:
            continue
        tick = int(ticks[index])
        side = flip if (index - origin) % 2 == 0 else -flip
        size = 0.3 + 0.7 * seeds.chance_at("sway", tick)
        if seeds.chance_at("sway held", tick) < 0.12:
            side, size = -side, 0.5 * size
        amount = side * size * (_RESTING + (1.0 - _RESTING) * float(playing[index]))
        events.append(
            GestureEvent(f"sway:@{tick}", "sway", tick, int(ticks[index + 1]), start_s, end_s, round(amount, 4), reason)
        )
    return events


def _sounding_share(times: LineTimes, edges_s: FloatArray) -> FloatArray:
    """Part of each span between neighbouring edges in which the line sounds."""
    if len(times.onset_s) == 0:
        return np.zeros(len(edges_s) - 1)
    sounded = np.concatenate(([0.0], np.cumsum(times.duration_s)))
    knots = np.stack((times.onset_s, times.played_end_s), axis=1).ravel()
    values = np.stack((sounded[:-1], sounded[1:]), axis=1).ravel()
    share: FloatArray = np.diff(np.interp(edges_s, knots, values)) / np.maximum(np.diff(edges_s), 1e-6)
    return np.clip(share, 0.0, 1.0)


def weight_shifts(piece: Piece, frame: TimeFrame, seeds: Seeds) -> list[GestureEvent]:
    """Shifts of weight at arbitrary times (T7), about every `SHIFT_MEAN_S`: bar by bar a player shifts or not."""
    clock = piece.clock
    first_tick, last_tick = int(clock.ticks(frame.first_frame_s)), int(np.ceil(clock.ticks(frame.end_s)))
    bars = piece.bars(first_tick, last_tick)
    edges = np.append(bars, last_tick)
    seconds = clock.seconds(edges.astype(np.float64))
    starts: list[tuple[int, float]] = []
    for index in range(len(bars)):
        tick, length_s = int(bars[index]), float(seconds[index + 1] - seconds[index])
        if seeds.chance_at("shift", tick) >= min(length_s / SHIFT_MEAN_S, 0.9):
            continue
        at = tick + int(seeds.chance_at("shift at", tick) * (int(edges[index + 1]) - tick))
        at_s = clock.seconds(float(at))
        if at_s >= frame.first_frame_s and (not starts or at_s - starts[-1][1] >= SHIFT_LEAST_S):
            starts.append((at, at_s))
    events = []
    for (tick, start_s), (end_tick, end_s) in zip(starts, [*starts, (last_tick, frame.end_s)][1:], strict=True):
        if end_s <= start_s:
            continue
        amount = 2.0 * seeds.chance_at("shift to", tick) - 1.0
        amount = float(np.copysign(0.25 + 0.75 * abs(amount), amount))
        reason = Message("gesture.weight_shift", {"side": "left" if amount > 0.0 else "right"})
        events.append(
            GestureEvent(
                f"weight_shift:@{tick}", "weight_shift", tick, end_tick, start_s, end_s, round(amount, 4), reason
            )
        )
    return events


def bell_heights(notes: tuple[Note, ...], times: LineTimes, piece: Piece) -> list[GestureEvent]:
    """The bell follows the melody: per felt beat the mean pitch (by sounding time) against the line's; beats at about
    the same height are one gesture, and a silence of a beat ends it."""
    if not notes:
        return []
    weight = np.maximum(times.duration_s, 1e-3)
    mean = float(np.average(times.pitch, weights=weight))
    beats = np.searchsorted(piece.beats(int(times.onset_tick[0]), int(times.onset_tick[-1])), times.onset_tick, "right")
    starts = np.flatnonzero(np.insert(np.diff(beats) > 0, 0, True))
    sums = np.add.reduceat(times.pitch * weight, starts) / np.add.reduceat(weight, starts)
    heights = np.clip((sums - mean) / CONTOUR_SEMITONES, -1.0, 1.0)
    ends = np.append(starts[1:], len(notes))
    groups: list[tuple[int, int, float, float]] = []
    for start, end, height, pitch in zip(starts.tolist(), ends.tolist(), heights.tolist(), sums.tolist(), strict=True):
        joined = groups and times.silence_tick[start] < piece.beat_ticks and abs(groups[-1][2] - height) < CONTOUR_STEP
        if joined:
            groups[-1] = (groups[-1][0], end, groups[-1][2], groups[-1][3])
        else:
            groups.append((start, end, height, pitch))
    return [
        GestureEvent(
            id=f"bell_height:{notes[start].id}",
            kind="bell_height",
            start_tick=int(times.onset_tick[start]),
            end_tick=int(times.played_end_tick[end - 1]),
            start_s=float(times.onset_s[start]),
            end_s=float(times.played_end_s[end - 1]),
            amount=round(height, 4),
            reason=Message("gesture.bell_height", {"pitch": round(pitch, 1), "mean_pitch": round(mean, 1)}),
        )
        for start, end, height, pitch in groups
    ]


def lowered_spans(
    notes: tuple[Note, ...],
    times: LineTimes,
    piece: Piece,
    frame: TimeFrame,
    breaths: tuple[BreathEvent, ...],
    cues: tuple[CueEvent, ...],
) -> list[GestureEvent]:
    """Where the instrument is off the lips: in rests long enough to lower it, rest it and raise it before anything that
    belongs to the entry (cue, preparation, breath) begins."""
    if not notes:
        return [_lowered("all", frame.first_frame_s - LOWER_S, frame.end_s + RAISE_S, piece, "gesture.lower_at_start",
                         {"rest_s": round(frame.end_s - frame.first_frame_s, 2)})]  # fmt: skip
    busy = [(event.start_s, event.end_s) for event in breaths] + [(event.start_s, event.end_s) for event in cues]
    events = []
    first_s = _free_until(busy, frame.first_frame_s, float(times.onset_s[0])) - BEFORE_BREATH_S
    if first_s - RAISE_S - LOWERED_LEAST_S >= frame.first_frame_s:
        rest_s = {"rest_s": round(float(times.onset_s[0]) - frame.first_frame_s, 2)}
        start_s = frame.first_frame_s - LOWER_S
        events.append(_lowered(notes[0].id, start_s, first_s, piece, "gesture.lower_at_start", rest_s))
    rests_s = times.onset_s[1:] - times.played_end_s[:-1]
    for index in np.flatnonzero(rests_s >= LOWER_REST_S).tolist():
        start_s = float(times.played_end_s[index]) + AFTER_NOTE_S
        end_s = _free_until(busy, start_s, float(times.onset_s[index + 1])) - BEFORE_BREATH_S
        if end_s - start_s >= LOWER_S + LOWERED_LEAST_S + RAISE_S:
            rest = {"rest_s": round(float(rests_s[index]), 2)}
            events.append(_lowered(notes[index + 1].id, start_s, end_s, piece, "gesture.lower_instrument", rest))
    start_s = float(times.played_end_s.max()) + AFTER_NOTE_S
    if start_s + LOWER_S <= frame.end_s and _free_until(busy, start_s, frame.end_s) >= frame.end_s:
        after = {"after_s": AFTER_NOTE_S}
        events.append(_lowered("end", start_s, frame.end_s + RAISE_S, piece, "gesture.lower_at_end", after))
    return events


def _free_until(busy: list[tuple[float, float]], start_s: float, end_s: float) -> float:
    """Start of the first event that ends after ``start_s`` and begins before ``end_s``, else ``end_s``."""
    return min((begin for begin, finish in busy if finish > start_s and begin < end_s), default=end_s)


def _lowered(
    name: str, start_s: float, end_s: float, piece: Piece, rule: str, arguments: Mapping[str, float]
) -> GestureEvent:
    return GestureEvent(
        id=f"lower_instrument:{name}",
        kind="lower_instrument",
        start_tick=round(piece.clock.ticks(start_s)),
        end_tick=round(piece.clock.ticks(end_s)),
        start_s=start_s,
        end_s=end_s,
        amount=1.0,
        reason=Message(rule, dict(arguments)),
    )
