"""Finger movement from one fingering to another: lifts, presses, rolls, changes of key.

A finger's place is the set of controls it holds; all pairs of fingerings of two pitches are compared at once.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from instrument_maps.hold import Contact
from instrument_maps.model import Control, Fingering

_DOWN = 0.5
"""Share of its travel above which a control counts as held; below it a hole is half closed."""

_SIDE = re.compile(r"\.(index|middle|ring|little)\.(side|pad_proximal)")
"""Parts of a finger other than the tip, except for the thumb, which touches with its side anyway."""

LEVER_COST = 0.5
"""Cost of a thumb that moves its lever while fingers move."""
FINGER_WEIGHT = {"thumb": 1.25, "little": 1.25, "ring": 1.1}
"""Weights of slow fingers' moves in a hurry; other fingers have 1."""
CONTRARY_COST = 0.5
"""Cost of one finger rising while another one falls, which is harder than parallel motion."""
KEY_TO_KEY_COST = {"little": 4.0, "ring": 3.0}
KEY_TO_KEY_USUAL_COST = 1.5
"""Cost of a finger that changes directly from one key to another, which smears the notes; greatest for the little
finger.
"""


@dataclass(frozen=True)
class Ways:
    """Finger movements from each of the K fingerings of one pitch to each of the K fingerings of the next, for U pairs
    of pitches; each array (U, K, K) float64.

    Attributes
    ----------
    moves
        Number of fingers that move.
    weighted
        The same number, with thumb levers and contrary motion (fingers up and down together) counted more.
    key_to_key
        Cost of the fingers that go from one key to another.
    apart
        Number of fingers that go from one key to another.
    rolls
        Number of fingers that roll onto a further key, or off it.
    levers
        Number of thumb levers that are turned.
    turns
        Number of hands in which one finger goes to or leaves a key with its side while others move.
    together
        1 where a thumb lever is turned while fingers move, else 0.
    """

    moves: FloatArray
    weighted: FloatArray
    key_to_key: FloatArray
    apart: FloatArray
    rolls: FloatArray
    levers: FloatArray
    turns: FloatArray
    together: FloatArray


@dataclass(frozen=True)
class FingerPlaces:
    """Controls under each of F fingers in each of the K fingerings of P pitches, as bit masks of controls.

    Attributes
    ----------
    holds, half : (F, P, K) int64
        Controls that each finger holds fully, and half.
    levers : int
        Mask of the controls that are thumb levers.
    aside : int
        Mask of the controls worked with the side of a finger, for which the hand turns.
    hands : tuple of list of int
        For each hand the rows (first axis) of its fingers.
    weight, key_to_key : (F, 1, 1, 1) float64
        Weight of a finger's move in a hurry, and cost of its move between keys.
    """

    holds: IntArray
    half: IntArray
    levers: int
    aside: int
    hands: tuple[list[int], ...]
    weight: FloatArray
    key_to_key: FloatArray

    def between(self, before: IntArray, after: IntArray) -> Ways:
        """Return the movements of fingers from each fingering of the pitches ``before`` to each fingering of the
        pitches ``after``; both arrays (U,) have rows of pitches in the table.
        """
        a, b = self.holds[:, before, :, None], self.holds[:, after, None, :]
        whole = self.holds | self.half
        whole_a, whole_b = whole[:, before, :, None], whole[:, after, None, :]
        # If half-holed keys differ, so do the fully pressed keys or the set of all pressed keys.
        moved = (a != b) | (whole_a != whole_b)
        busy = moved & (whole_a != 0) & (whole_b != 0)
        apart = busy & ((whole_a & whole_b) == 0)
        up, down = (whole_a & ~whole_b) != 0, (whole_b & ~whole_a) != 0
        moves, jumps = _count(moved), _count(apart)
        weighted = (moved * self.weight).sum(axis=0)
        levers = np.zeros_like(moves)
        if self.levers:
            lever = moved & (((a ^ b) & self.levers) != 0)
            levers = _count(lever)
            weighted += (lever * (LEVER_COST - self.weight)).sum(axis=0)
            up, down = up & ~lever, down & ~lever
        turns = np.zeros_like(moves)
        if self.aside:
            turning = moved & (((a ^ b) & self.aside) != 0)
            for hand in self.hands:
                turns += turning[hand].any(axis=0) & (moved[hand] & ~turning[hand]).any(axis=0)
        weighted += CONTRARY_COST * (up.any(axis=0) & down.any(axis=0))
        return Ways(
            moves=moves,
            weighted=weighted,
            key_to_key=(apart * self.key_to_key).sum(axis=0),
            apart=jumps,
            rolls=_count(busy) - jumps,
            levers=levers,
            turns=turns,
            together=((levers > 0.0) & (moves > levers)).astype(np.float64),
        )


def _count(fingers: BoolArray) -> FloatArray:
    """Return the sum (U, K, K) of a mask over its first axis, the fingers; computed with small integers, which is
    several times as fast."""
    return np.asarray(fingers.view(np.int8).sum(axis=0, dtype=np.int8), np.float64)


def finger_places(
    choices: Sequence[Sequence[Fingering]],
    shape: tuple[int, int],
    controls: Sequence[Control],
    contacts: Sequence[Contact],
) -> FingerPlaces:
    """Find the controls that each finger holds in the fingerings of every pitch, padded to ``shape`` (P pitches, K
    fingerings); slides are ignored."""
    names = sorted(
        {control.finger for control in controls}
        | {finger for ranked in choices for fingering in ranked for finger in fingering.fingers.values()}
    )
    bits = {control.name: 1 << place for place, control in enumerate(controls)}
    holds = {name: np.zeros(shape, dtype=np.int64) for name in names}
    half = {name: np.zeros(shape, dtype=np.int64) for name in names}
    worked = {control.name: control for control in controls if control.kind != "slide"}
    at_rest = {name: control.rest_value for name, control in worked.items() if control.rest_value > 0.0}
    for row, ranked in enumerate(choices):
        for column, fingering in enumerate(ranked):
            values = {**at_rest, **fingering.controls} if at_rest else fingering.controls
            for name, value in values.items():
                if value <= 0.0 or name not in worked:
                    continue
                finger = fingering.fingers.get(name, worked[name].finger)
                chosen = holds if value > _DOWN else half
                chosen[finger][row, column] |= bits[name]
    # A finger works a lever like any valve.
    levers = sum(bits[item.name] for item in controls if item.kind == "lever" and item.finger.endswith(".thumb"))
    beside = {contact.control for contact in contacts if _SIDE.search(contact.part)}
    aside = sum(bits[item.name] for item in controls if item.name in beside)
    used = [name for name in names if holds[name].any() or half[name].any()]
    kinds = [name.split(".")[1] for name in used]
    return FingerPlaces(
        np.array([holds[name] for name in used], dtype=np.int64).reshape(len(used), *shape),
        np.array([half[name] for name in used], dtype=np.int64).reshape(len(used), *shape),
        levers,
        aside,
        tuple([row for row, name in enumerate(used) if name.startswith(hand)] for hand in ("left.", "right.")),
        np.array([FINGER_WEIGHT.get(kind, 1.0) for kind in kinds]).reshape(-1, 1, 1, 1),
        np.array([KEY_TO_KEY_COST.get(kind, KEY_TO_KEY_USUAL_COST) for kind in kinds]).reshape(-1, 1, 1, 1),
    )
