"""Music that predicts the motion is distinguished from unrelated music."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.choreography.dancers_told_apart import reports, share_told_apart
from app.choreography.model import ChoreographyModel
from app.choreography.music_motion_dependence import (
    MOST_TRUST,
    TRUSTED_BITS,
    Pairing,
    pairing_of,
    report,
    trust_in,
    verdict,
)
from app.messages import text
from tests.support.dances import model


def sounding(seed: int, certain: float, states: int = 4) -> ChoreographyModel:
    """Model in which each motion has the sound of its state with a given probability, otherwise a random one."""
    random = np.random.default_rng(seed)
    made = model(beats=60, states=states, seed=seed)
    sounds = ((one.state if random.uniform() < certain else int(random.integers(states)), 40) for one in made.segments)
    segments = (replace(one, sounds=own) for one, own in zip(made.segments, sounds, strict=True))
    return replace(made, segments=tuple(segments))


def judged(made: ChoreographyModel) -> Pairing:
    found = pairing_of(made)
    assert found is not None
    return found


def test_a_sound_for_each_kind_of_motion_tells_which_it_is() -> None:
    found = judged(sounding(1, 1.0))
    # Four kinds, danced equally often, are two bits.
    assert found.bits == pytest.approx(2.0, abs=0.35)
    assert found.tells
    half = judged(sounding(1, 0.6))
    assert 0.1 < half.bits < found.bits
    assert half.tells
    assert report(sounding(1, 1.0)).id == "learn.pairing_tells"


def test_music_by_chance_tells_nothing() -> None:
    found = [judged(sounding(seed, 0.0)) for seed in range(100, 108)]
    assert np.mean([one.bits for one in found]) < 0.05
    assert sum(one.tells for one in found) <= 1
    assert np.mean([one.chance for one in found]) == pytest.approx(0.5, abs=0.25)


def test_drums_that_only_name_the_source_tell_nothing_of_its_motions() -> None:
    made = sounding(3, 0.0)
    segments = tuple(replace(one, sounds=(20 + one.clip,) * 4) for one in made.segments)
    found = judged(replace(made, segments=segments))
    assert found.bits == pytest.approx(0.0, abs=0.02)
    assert not found.tells


def test_what_cannot_be_judged_is_said() -> None:
    silent = model()
    assert pairing_of(silent) is None
    few = sounding(1, 1.0)
    short = replace(few, segments=few.segments[:12])
    assert pairing_of(short) is None
    assert report(short).id == "learn.pairing_unknown"


def test_a_dance_follows_sounds_as_far_as_they_tell() -> None:
    assert judged(sounding(1, 1.0)).bits > MOST_TRUST * TRUSTED_BITS
    assert trust_in(sounding(1, 1.0)) == MOST_TRUST
    assert [trust_in(sounding(seed, 0.0)) for seed in range(100, 108)].count(0.0) >= 7
    barely = sounding(1, 0.5)
    assert 0.0 < judged(barely).bits < 0.5
    assert 0.0 < trust_in(barely) < 1.0
    # A few motions are no evidence against the sounds.
    assert trust_in(replace(barely, segments=barely.segments[:12])) == 1.0


def copied(made: ChoreographyModel, late: int) -> ChoreographyModel:
    """Model in which every take occurs again, without its first motions and with the same sounds."""
    segments = list(made.segments)
    for clip in range(len(made.clips)):
        own = [one for one in made.segments if one.clip == clip][late:]
        segments += [replace(one, clip=len(made.clips) + clip) for one in own]
    return replace(made, segments=tuple(segments), clips=made.clips * 2, sources=made.sources * 2)


def test_takes_that_are_added_again_tell_no_more() -> None:
    """Copies of learned motions that begin later do not count as new evidence."""
    for seed in (100, 101, 102):
        once = judged(sounding(seed, 0.0))
        again = judged(copied(sounding(seed, 0.0), 30))
        assert not again.tells
        assert again.bits == pytest.approx(once.bits, abs=0.1)


def test_the_verdict_and_its_bits_agree() -> None:
    """Fewer bits than are displayed count as none, however few other orders of the music predict more."""
    for bits, chance, id_ in (
        (-0.2, 0.03, "learn.pairing_predicts_nothing"),
        (0.04, 0.01, "learn.pairing_predicts_nothing"),
        (0.3, 0.2, "learn.pairing_tells_nothing"),
        (0.3, 0.04, "learn.pairing_tells"),
    ):
        found = Pairing(bits, 2.0, chance)
        said = verdict(found)
        assert said.id == id_
        assert found.tells is (id_ == "learn.pairing_tells")
        for language, most in (("en", "of at most 2.0 bits"), ("ja", "上限 2.0 ビット")):
            assert "-0." not in text(said, language)
            assert most in text(said, language)


def test_the_most_bits_are_those_of_sounds_that_leave_no_doubt() -> None:
    """The ceiling is how unexpected the held-out motions are: two bits for four kinds danced equally often."""
    found = judged(sounding(1, 1.0))
    assert found.most_bits == pytest.approx(2.0, abs=0.35)
    assert 0.9 * found.most_bits < found.bits <= found.most_bits
    for seed in range(100, 104):
        by_chance = judged(sounding(seed, 0.0))
        assert by_chance.bits < 0.2 < by_chance.most_bits
    made = sounding(1, 1.0)
    rare = tuple(replace(one, state=int(one.state == 3), sounds=(int(one.state == 3),)) for one in made.segments)
    assert judged(replace(made, segments=rare)).most_bits < 1.2


def test_the_same_model_is_judged_the_same() -> None:
    assert judged(sounding(5, 0.3)) == judged(sounding(5, 0.3))


def drummed(alike: bool) -> ChoreographyModel:
    """Two dancers whose motions have no sounds of their own, to different drums or to the same."""
    made = sounding(3, 0.0)
    sounds = ((20, 21) if alike or not one.clip else (30, 21) for one in made.segments)
    return replace(
        made, segments=tuple(replace(one, sounds=own) for one, own in zip(made.segments, sounds, strict=True))
    )


def test_drums_that_name_the_dancer_are_said_to_do_so() -> None:
    """Drums may reveal the dancer but not the motion; both facts are reported, in both languages."""
    assert share_told_apart(drummed(alike=False)) == 1.0
    said = reports(drummed(alike=False))
    assert [one.id for one in said] == ["learn.pairing_predicts_nothing", "learn.dancers_told_apart"]
    assert said[1].arguments == {"share": 100, "chance": 50}
    assert all("100 %" in text(said[1], language) for language in ("en", "ja"))


def test_drums_that_are_alike_name_no_dancer() -> None:
    assert share_told_apart(drummed(alike=True)) == 0.5
    assert reports(drummed(alike=True))[1].id == "learn.dancers_alike"


def test_one_dancer_is_told_apart_from_no_other() -> None:
    made = sounding(1, 1.0)
    alone = replace(made, segments=tuple(one for one in made.segments if not one.clip), clips=made.clips[:1])
    assert share_told_apart(alone) is None
    assert [one.id for one in reports(alone)] == ["learn.pairing_tells"]
