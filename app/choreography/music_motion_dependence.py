"""Test of a learned choreography: can its motion be predicted from its music?

Two thirds of the motions of each source are learned from; of the last third it is asked how much surer the sounds make
which basic motion is danced, in bits a motion, beyond how often its dancer dances each. The same is asked with the
music of each source parted into stretches, which are put in another order: a pairing that tells something tells more
than nearly all of these (P. Good, "Permutation, Parametric and Bootstrap Tests of Hypotheses", 3rd ed. 2005; stretches,
for sounds that follow one another are alike by themselves). Copies of a motion are all learned from, or all held out.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.hit_log_odds import OF_ALL
from app.choreography.model import ChoreographyModel
from app.choreography.near_copies import groups_of_copies
from app.choreography.rhythm import SYMBOLS
from app.errors import Message

LEARNED: Final = 2.0 / 3.0
ORDERS: Final = 199
"""Number of permutations of the music that are tried."""
TELLS: Final = 0.05
"""Largest share of the other orders that inform as much, for music that informs about the motion."""
LEAST_BITS: Final = 0.05
"""Fewer bits a motion are none: they are shown in tenths."""
STRETCH: Final = (3, 7)
"""Fewest and most motions whose music stays together."""
LEAST: Final = 20
"""Fewest motions of which anything can be said."""
TRUSTED_BITS: Final = 0.5
"""Bits a motion from which on sounds are trusted wholly."""
TRUSTS: Final = (0.0, 0.06, 0.12, 0.25, 0.5, 1.0)
"""Weights of the sounds that are tried on a part of what is learned from: hits are not independent of one another."""


@dataclass(frozen=True)
class Pairing:
    """Information of the music about the motion.

    Attributes
    ----------
    bits : float
        A motion, of those held out; below 0 where the sounds mislead.
    chance : float
        Share of the other orders of the music that tell as much.
    """

    bits: float
    chance: float

    @property
    def tells(self) -> bool:
        """Return whether the music informs about the motion as other music would not."""
        return self.bits >= LEAST_BITS and self.chance <= TELLS


def pairing_of(model: ChoreographyModel, seed: int = 0) -> Pairing | None:
    """Judge the pairing of a model's sources; None where the model does not say what sounded, or is too short."""
    sounds = np.zeros((len(model.segments), len(SYMBOLS)))
    for at, one in enumerate(model.segments):
        np.add.at(sounds[at], list(one.sounds), 1.0)
    test = _Test(model)
    if not sounds.any() or not test.is_long_enough:
        return None
    random = np.random.default_rng(seed)
    bits = test.bits(sounds)
    others = [test.bits(sounds[test.other_order(random)]) for _ in range(ORDERS)]
    as_much = sum(other >= bits - 1e-9 for other in others)
    return Pairing(bits, (1 + as_much) / (1 + ORDERS))


def trust_in(model: ChoreographyModel) -> float:
    """Return how far a dance follows what is struck during single motions, 0 to 1.

    0 where the test finds no information in it; 1 from `TRUSTED_BITS` on, or where the model is too small for the test.
    """
    found = pairing_of(model)
    if found is None:
        return 1.0
    return min(1.0, found.bits / TRUSTED_BITS) if found.tells else 0.0


def report(model: ChoreographyModel) -> Message:
    """Report whether a model's music informs about its motion."""
    found = pairing_of(model)
    return Message("learn.pairing_unknown", {"least": LEAST}) if found is None else verdict(found)


def verdict(found: Pairing) -> Message:
    """Return what the bits and their chance say together."""
    if found.bits < LEAST_BITS:
        # Whatever other music predicts: this one predicts nothing.
        return Message("learn.pairing_predicts_nothing", {})
    id_ = "learn.pairing_tells" if found.tells else "learn.pairing_tells_nothing"
    return Message(id_, {"bits": found.bits, "chance": found.chance})


def _earliest(groups: IntArray, places: FloatArray) -> FloatArray:
    """(S,) the least place of each group."""
    least = np.full(groups.max(initial=0) + 1, np.inf)
    np.minimum.at(least, groups, places)
    return np.asarray(least[groups])


class _Test:
    """Motions of a model, parted into those that are learned from and those held out."""

    def __init__(self, model: ChoreographyModel) -> None:
        self._states = np.array([one.state for one in model.segments], np.int64)
        self._clips = np.array([one.clip for one in model.segments], np.int64)
        self._shape = (len(model.clips), model.states)
        places = np.zeros(len(self._states))
        for clip in range(len(model.clips)):
            own = np.flatnonzero(self._clips == clip)
            places[own] = np.arange(len(own)) / max(len(own), 1)
        groups, sounded = groups_of_copies(model), np.zeros((len(self._states), len(SYMBOLS)))
        for at, one in enumerate(model.segments):
            np.add.at(sounded[at], list(one.sounds), 1.0)
        # What is copied with its sounds counts once; other copies are on the side of the first third and second.
        once = np.zeros(len(places), bool)
        once[np.unique(np.column_stack([groups, sounded]), axis=0, return_index=True)[1]] = True
        places = np.where(once, _earliest(groups, places), np.nan)
        learned = places < LEARNED
        # Half of what is learned from says how far the other half's sounds can be trusted.
        half = places < LEARNED / 2.0
        self._parts = (np.flatnonzero(half), np.flatnonzero(learned & ~half))
        self._learned, self._held_out = np.flatnonzero(learned), np.flatnonzero(once & ~learned)

    @property
    def is_long_enough(self) -> bool:
        """Return whether there are motions in each part, and more than one order of their music."""
        used = len(self._learned) + len(self._held_out)
        return used >= LEAST and min(map(len, (*self._parts, self._held_out))) > 0

    def bits(self, sounds: FloatArray) -> float:
        """Bits per motion by which these sounds (S, 47) predict the motions held out."""
        tried = self._told(*self._parts, sounds, TRUSTS)
        trust = TRUSTS[max(1, int(tried.argmax()))]
        return float(self._told(self._learned, self._held_out, sounds, (trust,))[0])

    def other_order(self, random: np.random.Generator) -> IntArray:
        """(S,) numbers of motions whose music each motion has, stretches of each source in an order by chance."""
        order = np.empty(len(self._states), np.int64)
        for clip in range(self._shape[0]):
            own = np.flatnonzero(self._clips == clip)
            ends = np.cumsum(random.integers(STRETCH[0], STRETCH[1] + 1, 1 + len(own) // STRETCH[0]))
            # Round the end to the start, so that no stretch begins where the source does.
            stretches = np.split(np.roll(own, int(random.integers(max(len(own), 1)))), ends[ends < len(own)])
            order[own] = np.concatenate([stretches[at] for at in random.permutation(len(stretches))])
        return order

    def _told(self, learned: IntArray, asked: IntArray, sounds: FloatArray, trusts: tuple[float, ...]) -> FloatArray:
        """(T,) bits per motion by which sounds predict the motions asked for, at each trust in them."""
        counts = np.zeros((*self._shape, len(SYMBOLS)))
        np.add.at(counts, (self._clips[learned], self._states[learned]), sounds[learned])
        of_all = counts.sum(axis=0) + 1.0 / len(SYMBOLS)
        own = counts + OF_ALL * of_all / of_all.sum(axis=-1, keepdims=True)
        log_emission = np.log(own / own.sum(axis=-1, keepdims=True))
        often = np.zeros(self._shape)
        np.add.at(often, (self._clips[learned], self._states[learned]), 1.0)
        often += 1.0 / self._shape[1]
        clips, states, every = self._clips[asked], self._states[asked], np.arange(len(asked))
        log_often = np.log(often / often.sum(axis=-1, keepdims=True))[clips]
        heard = np.einsum("ao,ako->ak", sounds[asked], log_emission[clips])
        told = []
        for trust in trusts:
            both = log_often + trust * heard
            surest = both.max(axis=1, keepdims=True)
            log_sum = np.log(np.exp(both - surest).sum(axis=1)) + surest[:, 0]
            told.append((both[every, states] - log_sum - log_often[every, states]).mean() / np.log(2.0))
        return np.array(told)
