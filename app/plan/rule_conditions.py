"""Conditions of rules (`metadata.rules`): the notes that meet them, and to what degree."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.errors import Argument, Message
from app.plan.lips.embouchure import efforts_of
from app.plan.model import EmbouchureEvent
from app.plan.music.dynamics import Dynamics
from app.plan.music.piece import LineTimes, Piece, Seeds
from instrument_maps.model import InstrumentMap
from metadata.gestures import Gesture
from metadata.model import Expression
from metadata.rules import Growth, Rule, When

HEIGHT_SEMITONES: Final = 12.0
"""Semitones above its threshold at which the condition has its greatest value."""
MOST_ACCENT: Final = 0.3
DEPTH_SEMITONES: Final = 6.0
"""Semitones below its threshold at which the condition has its greatest value."""


@dataclass(frozen=True, eq=False)
class Facts:
    """Properties of N notes of a part to which conditions of rules refer, as arrays (N,)."""

    loudness: FloatArray
    pitch: FloatArray
    lasts_s: FloatArray
    rest_s: FloatArray
    rest_after_s: FloatArray
    above_easy: FloatArray
    below_easy: FloatArray
    accents: FloatArray
    leap: FloatArray
    played_s: FloatArray
    effort: FloatArray
    places: Mapping[str, BoolArray]


def facts_of(
    times: LineTimes,
    piece: Piece,
    instrument: InstrumentMap,
    dynamics: Dynamics,
    embouchures: tuple[EmbouchureEvent, ...] = (),
) -> Facts:
    """Return the facts about notes that rules use. The silences before the first and after the last note are
    infinite.
    """
    rests_s = np.maximum(times.onset_s[1:] - times.played_end_s[:-1], 0.0)
    pitch = times.pitch.astype(np.float64)
    apart = times.silence_tick >= piece.beat_ticks_at(times.onset_tick)
    starts = np.flatnonzero(apart | (np.arange(len(pitch)) == 0))
    ends = np.zeros(len(pitch), bool)
    ends[starts[1:] - 1] = True
    ends[-1:] = True
    climax = np.zeros(len(pitch), bool)
    weight = pitch / 12.0 + 2.0 * times.loudness
    for first, end in pairwise([*starts.tolist(), len(pitch)]):
        if end - first > 2:
            climax[first + int(np.argmax(weight[first:end]))] = True
    number = np.arange(len(pitch))
    return Facts(
        loudness=times.loudness,
        pitch=pitch,
        lasts_s=times.duration_s,
        rest_s=np.concatenate(([np.inf], rests_s)),
        rest_after_s=np.concatenate((rests_s, [np.inf])),
        above_easy=pitch - instrument.range.easy_high,
        below_easy=instrument.range.easy_low - pitch,
        accents=dynamics.accents,
        leap=np.concatenate(([0.0], np.diff(pitch))),
        played_s=np.cumsum(times.duration_s),
        effort=efforts_of(embouchures) if embouchures else np.zeros(len(pitch)),
        places={
            "first": number == 0,
            "after_rest": apart & (number > 0),
            "climax": climax,
            "phrase_end": ends,
            "before_rest": ends & (number < len(pitch) - 1),
            "last": number == len(pitch) - 1,
        },
    )


def matches(when: When, facts: Facts) -> BoolArray:
    """Mask (N,) of notes that meet all conditions of a rule except style, habits and chance."""
    loudness, count = facts.loudness, len(facts.loudness)
    least = (
        (when.loudness_above, loudness),
        (when.semitones_above_easy, facts.above_easy),
        (when.semitones_below_easy, facts.below_easy),
        (when.longer_s, facts.lasts_s),
        (when.rest_longer_s, facts.rest_s),
        (when.rest_after_longer_s, facts.rest_after_s),
        (when.played_longer_s, facts.played_s),
        (when.accent, facts.accents),
        (when.leap_up, facts.leap),
        (when.leap_down, -facts.leap),
        (when.effort_above, facts.effort),
    )
    most = ((when.loudness_below, loudness), (when.shorter_s, facts.lasts_s))
    found = np.ones(count, bool)
    for bound, values in least:
        if bound is not None:
            found &= values >= bound
    for bound, values in most:
        if bound is not None:
            found &= values <= bound
    if when.place:
        found &= np.logical_or.reduce([facts.places[place] for place in when.place])
    return found


def concerns(when: When, styles: Collection[str], habits: Sequence[str]) -> bool:
    """Return whether a rule applies to a player with these styles and habits."""
    if when.styles and set(when.styles).isdisjoint(styles):
        return False
    if when.not_styles and set(styles) <= set(when.not_styles):
        return False
    return not when.habits or not set(when.habits).isdisjoint(habits)


def unknown_in(rule: Rule, faces: Mapping[str, Expression], gestures: Mapping[str, Gesture]) -> Message | None:
    """Return the reason why a rule refers to an unknown expression or gesture; None if all are known."""
    for kind, name, known in (("expression", rule.do.expression, faces), ("gesture", rule.do.gesture, gestures)):
        if name and name not in known:
            said: dict[str, Argument] = {"rule": rule.name, "name": name, "known": ", ".join(sorted(known))}
            return Message(f"rule.unknown_{kind}", said)
    return None


def by_chance(rule: Rule, ticks: IntArray, seeds: Seeds) -> BoolArray:
    """Mask (N,) of the ticks at which chance lets a rule take effect."""
    if rule.when.chance >= 1.0:
        return np.ones(len(ticks), bool)
    return seeds.chances_at(f"rule {rule.name}", ticks) < rule.when.chance


def growth_of(rule: Rule, facts: Facts) -> FloatArray:
    """Strength (N,) of a rule: `Do.grows_from` where the condition is just met, 1 where it is met fully."""
    grows = rule.do.growth
    if not grows:
        return np.ones(len(facts.lasts_s))
    shares = [np.clip(_share(one, rule.when, facts), 0.0, 1.0) for one in grows]
    share = shares[0]
    for other in shares[1:]:
        share = share * other
    if len(shares) == 2:
        share = np.sqrt(share)
    elif len(shares) > 2:
        share = share ** (1.0 / len(shares))
    grown: FloatArray = rule.do.grows_from + (1.0 - rule.do.grows_from) * share
    # If one of several conditions is only just met, nothing remains.
    return np.where(share > 0.0, grown, rule.do.grows_from if len(shares) == 1 else 0.0)


def _share(grows: Growth, when: When, facts: Facts) -> FloatArray:
    """Degree (N,) to which notes exceed a condition of a rule: 0 where it is just met, 1 where it is met fully; may be
    outside that range.
    """
    if grows == "loudness":
        least = when.loudness_above or 0.0
        return (facts.loudness - least) / max(1.0 - least, 1e-6)
    if grows == "height":
        return (facts.above_easy - (when.semitones_above_easy or 0.0)) / HEIGHT_SEMITONES
    if grows == "depth":
        return (facts.below_easy - (when.semitones_below_easy or 0.0)) / DEPTH_SEMITONES
    if grows == "length":
        longer_s = max(when.longer_s or 0.0, 1e-3)
        return (facts.lasts_s - longer_s) / (2.0 * longer_s)
    if grows == "effort":
        least = when.effort_above or 0.0
        return (facts.effort - least) / max(1.0 - least, 1e-6)
    return facts.accents / MOST_ACCENT
