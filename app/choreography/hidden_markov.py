"""The hidden Markov model of basic motions: probabilities by counting.

Source: K. Kameda, I. Watanabe, M. Yamamoto, "Music Driven Computer Animation Based On HMM": during learning the states
are visible, so that transition, emission and initial probabilities are counted (`app.choreography.sequence` solves).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.arrays import FloatArray, IntArray
from app.choreography.rhythm import SYMBOLS


def count(
    states: Sequence[IntArray], symbols_per_segment: Sequence[Sequence[IntArray]], n_states: int, *, smoothing: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Count the transition, emission and initial probabilities of a hidden Markov model in state sequences.

    Parameters
    ----------
    states : sequence of (S,) int
        State of each segment in time order, by clip; a clip may be empty. Transitions between clips are not counted.
    symbols_per_segment : sequence of sequences of (H,) int
        Percussion symbols during each segment, by clip; a segment may have none, or a symbol several times.
    smoothing : float
        Number of observations added to every distribution, divided equally among its outcomes (additive smoothing), so
        that its weight is independent of the numbers of states and symbols. Greater than 0, so that unseen outcomes
        stay possible, and a state without successors has a uniform row.

    Returns
    -------
    transition : (n_states, n_states) float64
        Probability of each state after each state.
    emission : (n_states, 47) float64
        Probability of each symbol in each state.
    initial : (n_states,) float64
        Probability of each state at the beginning of a clip.

    Raises
    ------
    ValueError
        `smoothing` is not greater than 0, or the two sequences differ in their number of clips or segments.
    """
    if not smoothing > 0.0:
        raise ValueError(f"smoothing must be greater than 0: {smoothing}")
    transitions = np.zeros((n_states, n_states))
    emissions = np.zeros((n_states, len(SYMBOLS)))
    starts = np.zeros(n_states)
    for clip_states, clip_symbols in zip(states, symbols_per_segment, strict=True):
        np.add.at(transitions, (clip_states[:-1], clip_states[1:]), 1.0)
        np.add.at(starts, clip_states[:1], 1.0)
        for state, symbols in zip(clip_states, clip_symbols, strict=True):
            np.add.at(emissions[state], symbols, 1.0)
    return _smoothed(transitions, smoothing), _smoothed(emissions, smoothing), _smoothed(starts, smoothing)


def _smoothed(counts: FloatArray, smoothing: float) -> FloatArray:
    with_added = counts + smoothing / counts.shape[-1]
    return np.asarray(with_added / with_added.sum(axis=-1, keepdims=True))
