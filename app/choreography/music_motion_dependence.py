"""Test of a learned choreography: can its motion be predicted from its music?

Two thirds of the motions of each source are learned from. For the last third, the test measures the information that
sounds give about the basic motion, in bits per motion, beyond how often its dancer dances each. The same is measured
with the music of each source divided into sections in another order: a meaningful pairing gives more information than
nearly all of these (P. Good, "Permutation, Parametric and Bootstrap Tests of Hypotheses", 3rd ed. 2005; sections, since
consecutive sounds are similar). Copies of a take count once (`app.choreography.held_out`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.held_out import evidence_of, sounds_of
from app.choreography.hit_log_odds import OF_ALL
from app.choreography.model import ChoreographyModel
from app.choreography.rhythm import SYMBOLS
from app.errors import Message

LEARNED: Final = 2.0 / 3.0
ORDERS: Final = 199
"""Number of tried permutations of the music."""
TELLS: Final = 0.05
"""Largest share of permutations with as much information for a meaningful pairing."""
LEAST_BITS: Final = 0.05
"""Least information in bits per motion that counts, since tenths are displayed."""
STRETCH: Final = (3, 7)
"""Least and greatest number of motions in a section."""
LEAST: Final = 20
"""Least number of motions for the test."""
TRUSTED_BITS: Final = 0.5
"""Information in bits per motion at which sounds have their usual weight; it is proportional to the information."""
MOST_TRUST: Final = 4.0
"""Greatest weight, so that sounds which leave no doubt about the motion outweigh joins that fit less well."""
TRUSTS: Final = (0.0, 0.06, 0.12, 0.25, 0.5, 1.0)
"""Weights of the sounds tried on a part of the learning material, since hits are not independent."""


@dataclass(frozen=True)
class Pairing:
    """Information that music gives about the motion.

    Attributes
    ----------
    bits : float
        Bits per held-out motion; below 0 if sounds mislead.
    most_bits : float
        Bits per held-out motion of music that leaves no doubt about the motion: how unexpected the motions are by how
        often their dancer dances each.
    chance : float
        Share of permutations of the music with as much information.
    """

    bits: float
    most_bits: float
    chance: float

    @property
    def tells(self) -> bool:
        """True if the music gives significant information about the motion."""
        return self.bits >= LEAST_BITS and self.chance <= TELLS


def pairing_of(model: ChoreographyModel, seed: int = 0) -> Pairing | None:
    """Test whether the music of a model gives information about its motion; None if it has no sounds or is
    too short.
    """
    sounds, test = sounds_of(model), _Test(model)
    if not sounds.any() or not test.is_long_enough:
        return None
    random = np.random.default_rng(seed)
    bits = test.bits(sounds)
    others = [test.bits(sounds[test.other_order(random)]) for _ in range(ORDERS)]
    as_much = sum(other >= bits - 1e-9 for other in others)
    return Pairing(bits, test.most_bits(), (1 + as_much) / (1 + ORDERS))


def trust_in(model: ChoreographyModel) -> float:
    """Return the weight, 0..`MOST_TRUST`, that the sounds of single motions get when a dance is generated.

    0 if the test finds no information; 1 at `TRUSTED_BITS`, or if the model is too small for the test.
    """
    found = pairing_of(model)
    if found is None:
        return 1.0
    return min(MOST_TRUST, found.bits / TRUSTED_BITS) if found.tells else 0.0


def report(model: ChoreographyModel) -> Message:
    """Return a message about whether a model's music informs about its motion."""
    found = pairing_of(model)
    return Message("learn.pairing_unknown", {"least": LEAST}) if found is None else verdict(found)


def verdict(found: Pairing) -> Message:
    """Return a message about the measured information in bits, and its significance."""
    if found.bits < LEAST_BITS:
        # Whatever other music predicts: this one predicts nothing.
        return Message("learn.pairing_predicts_nothing", {"most": found.most_bits})
    id_ = "learn.pairing_tells" if found.tells else "learn.pairing_tells_nothing"
    return Message(id_, {"bits": found.bits, "most": found.most_bits, "chance": found.chance})


class _Test:
    """Motions of a model, divided into those that are learned from and those that are held out for the test."""

    def __init__(self, model: ChoreographyModel) -> None:
        found = evidence_of(model)
        self._states = np.array([one.state for one in model.segments], np.int64)
        self._clips, self._takes = np.array([one.clip for one in model.segments], np.int64), found.takes
        self._shape = (len(model.clips), model.states)
        # One half of the learned motions shows how reliably sounds predict the other half.
        self._parts = (found.within(0.0, LEARNED / 2.0), found.within(LEARNED / 2.0, LEARNED))
        self._learned, self._held_out = found.within(0.0, LEARNED), found.within(LEARNED, np.inf)

    @property
    def is_long_enough(self) -> bool:
        """Return whether both parts contain enough motions, and their music allows several permutations."""
        used = len(self._learned) + len(self._held_out)
        return used >= LEAST and min(map(len, (*self._parts, self._held_out))) > 0

    def bits(self, sounds: FloatArray) -> float:
        """Information in bits per held-out motion that the sounds (S, 47) during all S motions give."""
        tried = self._told(*self._parts, sounds, TRUSTS)
        trust = TRUSTS[max(1, int(tried.argmax()))]
        return float(self._told(self._learned, self._held_out, sounds, (trust,))[0])

    def most_bits(self) -> float:
        """Information in bits per held-out motion that sounds could give at most."""
        log_often = self._log_often(self._learned)[self._takes[self._held_out], self._states[self._held_out]]
        return float(-log_often.mean() / np.log(2.0))

    def other_order(self, random: np.random.Generator) -> IntArray:
        """Permute the music of the motions at random by sections of each source: for each of S motions the index (S,)
        of the motion whose music it gets.
        """
        order = np.empty(len(self._states), np.int64)
        for clip in range(self._shape[0]):
            own = np.flatnonzero(self._clips == clip)
            ends = np.cumsum(random.integers(STRETCH[0], STRETCH[1] + 1, 1 + len(own) // STRETCH[0]))
            # Rotated from the end to the start, so that no stretch begins where the source begins.
            stretches = np.split(np.roll(own, int(random.integers(max(len(own), 1)))), ends[ends < len(own)])
            order[own] = np.concatenate([stretches[at] for at in random.permutation(len(stretches))])
        return order

    def _told(self, learned: IntArray, asked: IntArray, sounds: FloatArray, trusts: tuple[float, ...]) -> FloatArray:
        """Information in bits per motion that sounds give about the motions ``asked``, after learning from ``learned``,
        at each of T levels of trust (T,).
        """
        counts = np.zeros((*self._shape, len(SYMBOLS)))
        np.add.at(counts, (self._takes[learned], self._states[learned]), sounds[learned])
        of_all = counts.sum(axis=0) + 1.0 / len(SYMBOLS)
        own = counts + OF_ALL * of_all / of_all.sum(axis=-1, keepdims=True)
        log_emission = np.log(own / own.sum(axis=-1, keepdims=True))
        takes, states, every = self._takes[asked], self._states[asked], np.arange(len(asked))
        log_often = self._log_often(learned)[takes]
        heard = np.einsum("ao,ako->ak", sounds[asked], log_emission[takes])
        told = []
        for trust in trusts:
            both = log_often + trust * heard
            surest = both.max(axis=1, keepdims=True)
            log_sum = np.log(np.exp(both - surest).sum(axis=1)) + surest[:, 0]
            told.append((both[every, states] - log_sum - log_often[every, states]).mean() / np.log(2.0))
        return np.array(told)

    def _log_often(self, learned: IntArray) -> FloatArray:
        """Logarithm (K, N) of how often each of K takes' dancers dances each of N basic motions in ``learned``."""
        often = np.zeros(self._shape)
        np.add.at(often, (self._takes[learned], self._states[learned]), 1.0)
        often += 1.0 / self._shape[1]
        return np.asarray(np.log(often / often.sum(axis=-1, keepdims=True)))
