"""Dancers are chosen by the similarity of drums to their own, and all dancers if the drums are similar to none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from app.choreography.drums_of_dancers import CLEAR, drums_of, take_shares
from app.choreography.rhythm import SYMBOLS, Rhythm
from tests.support.dances import beaten

CLIPS = np.repeat([0, 1], 40)
DRUMS = drums_of(CLIPS, [(1, 1, 7)] * 40 + [(1, 1, 21)] * 40, 2)
BEATS = 32


def struck(between: Sequence[int]) -> Rhythm:
    """Drum on every beat, and sounds in turn after each."""
    plain = beaten(BEATS)
    after = np.resize(between, BEATS - 1)
    hits = np.concatenate([plain.beats_s, plain.beats_s[:-1] + 0.25])
    symbols = np.concatenate([np.ones(BEATS, np.int64), after])
    order = np.argsort(hits)
    return replace(plain, hits_s=hits[order], symbols=symbols[order], strengths=np.ones(len(order)))


def shares(rhythm: Rhythm) -> np.ndarray:
    return take_shares(DRUMS, rhythm, rhythm.beats_s, CLIPS, np.where(CLIPS == 0, 1.0, 3.0)).shares


@pytest.mark.parametrize(("sound", "own"), [(7, 0), (21, 1)])
def test_a_sound_between_beats_says_who_dances(sound: int, own: int) -> None:
    like, _ = DRUMS.likeness(struck([sound]))
    assert like.min() > 0.9
    assert shares(struck([sound]))[:, own].min() > 0.99


def test_drums_of_both_are_like_those_of_the_dancers_and_are_for_both() -> None:
    # All sounds are equally frequent; the hits determine whose motion is danced to them.
    like, unlike = DRUMS.likeness(struck([7, 21]))
    assert like.min() > 0.9
    assert np.ptp(unlike, axis=1).max() < 0.3


@pytest.mark.parametrize(("sound", "own"), [(7, 0), (21, 1)])
@pytest.mark.parametrize("unheard", [2, 40])
def test_unheard_drums_do_not_drown_a_sound_that_names_the_dancer(sound: int, own: int, unheard: int) -> None:
    between = struck([sound])
    music = replace(between, symbols=np.where(between.symbols == 1, unheard, between.symbols))
    assert DRUMS.likeness(music)[0].min() > 0.8
    assert shares(music)[:, own].min() > 0.99


def test_other_drums_let_everyone_dance_as_much_as_was_captured() -> None:
    plain = beaten(BEATS)
    heard = drums_of(CLIPS, [(1, 1, 7)] * 40 + [(1, 7, 7)] * 40, 2)
    # Nearer to the drums of the one than of the other, and like those of none.
    other = replace(plain, symbols=np.full(len(plain.symbols), 7))
    like, unlike = heard.likeness(other)
    assert like.max() < 0.01
    assert (unlike[:, 0] - unlike[:, 1]).min() > 0.5
    found = take_shares(heard, other, other.beats_s, CLIPS, np.where(CLIPS == 0, 1.0, 3.0)).shares
    assert found == pytest.approx(np.tile((0.25, 0.75), (BEATS, 1)), abs=0.02)


def test_sounds_that_none_heard_tell_nothing() -> None:
    plain = beaten(BEATS)
    unknown = replace(plain, symbols=np.full(len(plain.symbols), 40))
    assert DRUMS.likeness(unknown)[0].tolist() == [0.0] * BEATS
    assert shares(unknown) == pytest.approx(np.tile((0.25, 0.75), (BEATS, 1)))
    silent = drums_of(CLIPS, [()] * 80, 2)
    assert silent.shares.shape == (2, len(SYMBOLS))
    assert silent.likeness(plain)[0].tolist() == [0.0] * BEATS


def test_drums_count_against_motions_only_if_they_are_clearly_those_of_another_dancer() -> None:
    """Otherwise each dancer has turns, and no motion costs anything."""
    lasting, every = np.where(CLIPS == 0, 1.0, 3.0), slice(0, BEATS)
    plain = beaten(BEATS)
    for rhythm in (struck([7, 21]), replace(plain, symbols=np.full(len(plain.symbols), 40))):
        assert not take_shares(DRUMS, rhythm, rhythm.beats_s, CLIPS, lasting).against(every).any()
    against = take_shares(DRUMS, struck([7]), plain.beats_s, CLIPS, lasting).against(every)
    assert not against[:, CLIPS == 0].any()
    assert against[:, CLIPS == 1].min() > CLEAR
