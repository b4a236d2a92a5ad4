"""The ranked fingerings of all pitches of a part, as arrays for the search."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.plan.fingering.finger_travel import FingerPlaces, finger_places
from instrument_maps.model import Control, Fingering, InstrumentMap

# Costs of alternate fingerings, in units of one rank.
RANK_COST = 1.0
MOST_RANKS = 3
"""Greatest rank that adds cost: woodwinds have many alternates, whose order matters little."""
CENTS_PER_UNIT = 20.0
"""Cents by which an alternate is less in tune than the first choice per unit of cost, on a fully audible note: about
the difference that listeners notice in a melody.
"""
FULLY_AUDIBLE_S = 0.25
"""Length in seconds of a note with fully audible intonation; shorter ones have a proportionally lower cost."""
FORKED_COST = 0.5
"""Cost of a forked fingering, whose sound is covered, in addition to its rank."""
IN_PLACE_COST = {"trill": 0.5, "fast": 0.5, "forte": 0.5, "piano": 0.5, "chromatic": -0.5, "attack": -4.0}
"""Costs of fingerings for trills, fast passages, chromatic runs, attacks, loud or soft notes where they apply,
regardless of rank; see `OUT_OF_PLACE_COST`.
"""
HELD_COST = 0.1
"""Cost of an unneeded key that stays down (tag "held"), regardless of rank."""
RARE_COST = 10.0
"""Cost of a fingering that players hardly ever use (tag "rare"), in addition to its rank."""


@dataclass(frozen=True)
class FingeringTable:
    """Ranked fingerings of the P pitches of a part, padded to K per pitch.

    Attributes
    ----------
    values : (P, K, C) float64
        Value of each of the C controls that determine the pitch (`pitch_controls`).
    cost : (P, K) float64
        Cost of each fingering by its rank.
    cents : (P, K) float64
        Deviation of each fingering's intonation, in cents.
    valid : (P, K) bool
        Mask of fingerings that the search may choose; obsolete ones are left to corrections.
    meant_for : dict of str to (P, K) bool
        Masks of fingerings meant for trills, and for fast, loud or soft notes.
    register : (P,) int64
        Number of register breaks below the pitch.
    rare : (P, K) bool
        Mask of fingerings that are hardly ever used.
    beside : (P, K) bool
        Mask of fingerings that keep a lever turned for neighbouring notes.
    levers : (P, K) int64
        Levers turned by each fingering, as bits.
    leaves_down : bool
        Whether any fingering of the instrument leaves down a key that its note does not need (tag "held").
    places : FingerPlaces
        Place of every finger in each fingering.
    """

    choices: tuple[tuple[Fingering, ...], ...]
    values: FloatArray
    cost: FloatArray
    cents: FloatArray
    valid: BoolArray
    meant_for: dict[str, BoolArray]
    register: IntArray
    rare: BoolArray
    beside: BoolArray
    levers: IntArray
    leaves_down: bool
    places: FingerPlaces


def pitch_controls(instrument: InstrumentMap) -> tuple[Control, ...]:
    """The controls that determine the pitch (valves, keys, slide), by which a fingering is described."""
    return tuple(control for control in instrument.controls if control.role == "pitch")


def table_of(pitches: tuple[int, ...], instrument: InstrumentMap) -> FingeringTable:
    """Build the fingering table of an instrument for these concert pitches, in the given order."""
    choices = tuple(instrument.fingerings_for(pitch) for pitch in pitches)
    controls = pitch_controls(instrument)
    shape = (len(choices), max((len(ranked) for ranked in choices), default=1))
    values = np.zeros((*shape, len(controls)))
    cost, cents, valid = np.zeros(shape), np.zeros(shape), np.zeros(shape, dtype=bool)
    rare, beside, levers = np.zeros(shape, dtype=bool), np.zeros(shape, dtype=bool), np.zeros(shape, dtype=np.int64)
    turned = {item.name: 1 << place for place, item in enumerate(controls) if item.kind == "lever"}
    meant_for: dict[str, BoolArray] = {}
    for row, ranked in enumerate(choices):
        for column, fingering in enumerate(ranked):
            values[row, column] = [fingering.controls.get(item.name, item.rest_value) for item in controls]
            forked = FORKED_COST if fingering.rank > 1 and "forked" in fingering.tags else 0.0
            rare[row, column] = fingering.rank > 1 and "rare" in fingering.tags
            cost[row, column] = RANK_COST * min(fingering.rank - 1, MOST_RANKS) + forked + RARE_COST * rare[row, column]
            if fingering.rank > 1 and "held" in fingering.tags:
                cost[row, column] = HELD_COST
            beside[row, column] = fingering.rank > 1 and "beside" in fingering.tags
            if turned:
                levers[row, column] = sum(
                    turned.get(name, 0) for name, value in fingering.controls.items() if value > 0
                )
            cents[row, column] = fingering.cents
            valid[row, column] = not fingering.is_obsolete
            for tag in IN_PLACE_COST:
                if fingering.rank > 1 and tag in fingering.tags:
                    meant_for.setdefault(tag, np.zeros(shape, dtype=bool))[row, column] = True
    written = np.array([ranked[0].written_pitch for ranked in choices], dtype=np.int64)
    register = np.searchsorted(np.sort(np.array(instrument.breaks, dtype=np.int64)), written, side="right")
    places = finger_places(choices, shape, controls, instrument.contacts)
    leaves_down = any("held" in fingering.tags for fingering in instrument.fingerings)
    return FingeringTable(
        choices,
        values,
        cost,
        cents,
        valid,
        meant_for,
        register.astype(np.int64),
        rare,
        beside,
        levers,
        leaves_down,
        places,
    )
