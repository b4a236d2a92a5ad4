"""A dance to a piece in which each drum belongs to one basic motion."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from app.choreography.dance import Manner
from app.choreography.generate import Choreographer
from app.choreography.model import ChoreographyModel
from app.choreography.model_file import read_model
from app.choreography.rhythm import SYMBOLS, Rhythm

SALSA = Path(__file__).parents[3] / "resources" / "choreographies" / "salsa.choreography"
BEATS, BEAT_S = 64, 0.55


def with_one_drum_per_motion(model: ChoreographyModel) -> ChoreographyModel:
    """Model as if learned from two strokes of one drum during each motion."""
    segments = tuple(replace(one, sounds=(3 * one.state,) * 2, melody=()) for one in model.segments)
    counts = np.ones((model.states, len(SYMBOLS))) / len(SYMBOLS)
    for one in segments:
        np.add.at(counts[one.state], list(one.sounds), 1.0)
    return replace(model, segments=segments, emission=counts / counts.sum(axis=1, keepdims=True))


def struck(states: np.ndarray, parts: int = 2, beat_s: float = BEAT_S) -> Rhythm:
    """The drum of a motion on each beat, and between beats as often as they have parts."""
    hits_s = beat_s / parts * np.arange(parts * BEATS)
    beats_s = beat_s * np.arange(BEATS + 1)
    symbols = 3 * np.repeat(states, parts)
    return Rhythm(beats_s, np.arange(BEATS + 1) % 4, hits_s, symbols, np.ones(len(hits_s)), derived=False)


def test_three_of_four_strokes_of_a_drum_sound_during_its_motion() -> None:
    """Each drum is struck for two beats at a time; motions must also fit together, so that not every stroke is met."""
    model = with_one_drum_per_motion(read_model(SALSA))
    choreographer = Choreographer(model)
    shares = []
    for seed in range(3):
        asked = np.repeat(np.random.default_rng(seed).integers(0, model.states, BEATS // 2), 2)
        music = struck(asked)
        steps = choreographer.steps(music, Manner(seed=seed))
        during = np.searchsorted([one.end_s for one in steps], music.hits_s, side="right")
        states = np.array([one.state for one in steps])[np.minimum(during, len(steps) - 1)]
        shares.append(np.mean(states == np.repeat(asked, 2)))
    assert np.mean(shares) >= 0.75


def test_motions_between_sparse_strokes_are_those_of_the_drum() -> None:
    """A drum is struck every 0.75 s for six beats: also steps without a stroke are of its motion, not any that fits."""
    model = with_one_drum_per_motion(read_model(SALSA))
    choreographer = Choreographer(model)
    shares = []
    for seed in range(2):
        asked = np.repeat(np.random.default_rng(seed).integers(0, model.states, BEATS // 6 + 1), 6)[:BEATS]
        steps = choreographer.steps(struck(asked, parts=1, beat_s=0.75), Manner(seed=seed))
        danced = [(one.state, int(one.accent_s / 0.75 + 1e-6)) for one in steps if one.accent_s >= 0.0]
        shares.append(np.mean([state == asked[beat] for state, beat in danced if beat < BEATS]))
    assert np.mean(shares) >= 0.85


def test_an_unheard_drum_neither_adds_to_nor_ends_the_others() -> None:
    hearing = Choreographer(with_one_drum_per_motion(read_model(SALSA))).hearing
    music = struck(np.zeros(BEATS, np.int64), parts=1)
    hits_s = np.concatenate([music.hits_s, music.hits_s + 0.5 * BEAT_S])
    order = np.argsort(hits_s)
    symbols = np.concatenate([music.symbols, np.full(BEATS, 46)])[order]
    more = replace(music, hits_s=hits_s[order], symbols=symbols, strengths=np.ones(len(hits_s)))
    alone, both = hearing.hits(music, 0.0), hearing.hits(more, 0.0)
    assert np.array_equal(alone.times_s, both.times_s)
    assert np.array_equal(alone.summed, both.summed)
