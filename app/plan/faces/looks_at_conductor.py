"""Looks from the music up to the conductor while playing.

Looks at cues are planned by `app.plan.faces.glances`. In addition players look up when they need the beat: while the
tempo changes, in the last chord until its release, as phrases begin, and occasionally before a bar. In fast runs they
keep reading.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.plan.faces.glances import StagePlace, glance_at
from app.plan.model import CONDUCTOR, GlanceEvent, TimeFrame
from app.plan.music.piece import LineTimes, NoteTimes, Piece, Seeds
from app.plan.music.spans import Spans

CHANGING: Final = 0.03
"""Relative difference of a beat's length from the previous one above which it belongs to a change of tempo."""
CHANGE_S: Final = (0.45, 0.55)
"""Ranges in seconds of the time before such a beat, and after it, in which players look up."""
LAST_S: Final = (0.9, 0.25)
"""Seconds before the last note, and after its end, in which players look up."""
PHRASE_CHANCE: Final = 0.5
PHRASE_S: Final = (0.55, 0.2)
PHRASE_REST_S: Final = 0.3
BAR_EVERY_S: Final = 7.0
"""Mean seconds between a player's looks up before bar lines."""
NEAR_S: Final = 2.0
"""Greatest distance in seconds of a bar line from played notes for a look up; long rests have other looks."""
LONGEST_BAR_S: Final = 8.0
BAR_S: Final = (0.5, 0.18)
QUICK_S: Final = 0.2
"""Seconds between onsets below which a player is too busy reading to look up."""
LEAST_APART_S: Final = 1.4
LONGEST_S: Final = 3.5
PAGE_S: Final = 0.7
"""Least seconds of reading between two looks up."""


def looks_up(
    *,
    player_id: str,
    times: LineTimes,
    piece: Piece,
    frame: TimeFrame,
    last_s: float,
    places: Mapping[str, StagePlace],
    amount: float,
    seeds: Seeds,
) -> tuple[GlanceEvent, ...]:
    """Looks of a player at the conductor, in order and not overlapping; empty without a conductor.

    Parameters
    ----------
    last_s : float
        End of the last note of all players.
    amount : float
        Frequency of looks away from the music, 1 is usual.
    """
    if CONDUCTOR not in places or player_id not in places or not len(times.onset_s):
        return ()
    own, there = places[player_id], places[CONDUCTOR]
    if amount <= 0.0:
        return ()
    spans = _certain(times, piece, last_s)
    taken = Spans(spans)
    free_s = -np.inf
    for start_s, end_s in _by_chance(times.rhythm, piece, amount, seeds):
        near = taken.meet(start_s - LEAST_APART_S, end_s + LEAST_APART_S)
        if not near and start_s >= free_s:
            spans.append((start_s, end_s))
            free_s = end_s + LEAST_APART_S
    spans = [(start_s, end_s) for start_s, end_s in spans if frame.first_frame_s <= start_s and end_s <= frame.end_s]
    return tuple(
        glance_at(f"glance:conductor:{round(piece.clock.ticks(span_s[0]))}", CONDUCTOR, span_s, own, there)
        for span_s in sorted(spans)
    )


def _certain(times: LineTimes, piece: Piece, last_s: float) -> list[tuple[float, float]]:
    """Spans (start, end) in seconds of looks at the conductor that always happen: at tempo changes and the last note.
    Close ones are merged, up to a largest length."""
    asked: list[tuple[float, float]] = []
    beats = piece.metre_map.felt_between(int(times.onset_tick[0]), int(times.onset_tick[-1]) + 1)
    if len(beats) > 2:
        beats_s = piece.clock.seconds(beats.astype(np.float64))
        lasts = np.diff(beats_s) / np.maximum(np.diff(beats), 1)
        changes = np.flatnonzero(np.abs(np.diff(np.log(np.maximum(lasts, 1e-12)))) >= CHANGING) + 1
        asked += [(at_s - CHANGE_S[0], at_s + CHANGE_S[1]) for at_s in beats_s[changes].tolist()]
    ends_s = float(times.played_end_s[-1])
    if ends_s > last_s - 1.0:
        asked.append((float(times.onset_s[-1]) - LAST_S[0], ends_s + LAST_S[1]))
    found: list[tuple[float, float]] = []
    for start_s, end_s in asked:
        if not found or start_s > found[-1][1] + LEAST_APART_S:
            found.append((start_s, end_s))
        elif found[-1][1] - found[-1][0] < LONGEST_S:
            found[-1] = (found[-1][0], max(end_s, found[-1][1]))
        elif start_s > found[-1][1]:
            # A glance at the page, then up again.
            found.append((max(start_s, found[-1][1] + PAGE_S), max(end_s, found[-1][1] + PAGE_S + CHANGE_S[1])))
    return found


def _by_chance(times: NoteTimes, piece: Piece, amount: float, seeds: Seeds) -> list[tuple[float, float]]:
    """Return the spans in seconds of looks at the conductor drawn by chance: at beginnings of phrases, and now and then
    before a bar."""
    rests_s = times.onset_s[1:] - times.played_end_s[:-1]
    starts = np.flatnonzero(np.concatenate(([False], rests_s >= PHRASE_REST_S)))
    starts = starts[seeds.chances_at("up at phrase", times.onset_tick[starts]) < PHRASE_CHANCE * amount]
    spans = [(at_s - PHRASE_S[0], at_s + PHRASE_S[1]) for at_s in times.onset_s[starts].tolist()]
    bars, bars_s = _bars(times, piece)
    if len(bars) > 1:
        chances = np.minimum(np.append(np.diff(bars_s), 0.0), LONGEST_BAR_S) / BAR_EVERY_S * amount
        # Players read ahead, so the difficulty of the coming notes keeps the eyes on the page.
        place = np.minimum(np.searchsorted(times.onset_s, bars_s), len(times.onset_s) - 1)
        around = np.stack([np.clip(place + step, 0, len(times.onset_s) - 1) for step in (-1, 0, 1)])
        lasts = times.onset_s[np.minimum(around + 1, len(times.onset_s) - 1)] - times.onset_s[around]
        quick = np.any((lasts < QUICK_S) & (around < len(times.onset_s) - 1), axis=0)
        chosen = (seeds.chances_at("up at bar", bars) < chances) & ~quick
        spans += [(at_s - BAR_S[0], at_s + BAR_S[1]) for at_s in bars_s[chosen].tolist()]
    return sorted(spans)


def _bars(times: NoteTimes, piece: Piece) -> tuple[IntArray, FloatArray]:
    """Ticks and seconds (N,) of the N bar lines near played notes; of bar lines close together only one is used."""
    bars = piece.bars(int(times.onset_tick[0]), int(times.onset_tick[-1]) + 1)
    bars_s: FloatArray = piece.clock.seconds(bars.astype(np.float64))
    following = np.minimum(np.searchsorted(times.onset_s, bars_s), len(times.onset_s) - 1)
    before = np.maximum(following - 1, 0)
    near = (times.onset_s[following] - bars_s <= NEAR_S) & (bars_s - times.played_end_s[before] <= NEAR_S)
    bars, bars_s = bars[near], bars_s[near]
    _, first = np.unique(np.floor(bars_s / LEAST_APART_S), return_index=True)
    return bars[first], bars_s[first]
