"""Dancers of a formation share what the formation defines, and do not collide."""

from __future__ import annotations

import itertools
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from app.choreography.body import SEGMENTS
from app.choreography.dance import Dance, Manner
from app.choreography.formation import APART_M, CANON_BEATS, FORMATIONS, Formation, dance_together, roles
from app.choreography.generate import Choreographer
from tests.support.dances import beaten, model

BEAT_S = 0.5


@cache
def danced(formation: Formation) -> tuple[Dance, ...]:
    cast = roles(formation, 3, Manner(seed=4), 2)
    return dance_together(Choreographer(model()), beaten(48, BEAT_S), cast, Fraction(60))


def placed_m(formation: Formation) -> list[np.ndarray]:
    """Path of the hips of each dancer relative to the dancer's place."""
    return [
        dance.clip.hips_m - (role.x_m, 0.0, 0.0)
        for dance, role in zip(danced(formation), roles(formation, 3, Manner(seed=4), 2), strict=True)
    ]


@pytest.mark.parametrize("formation", FORMATIONS)
def test_all_are_of_one_length_and_apart(formation: Formation) -> None:
    dances = danced(formation)
    assert len({len(dance.clip) for dance in dances}) == 1
    assert [role.x_m for role in roles(formation, 3, Manner(), 2)] == [-APART_M[formation], 0.0, APART_M[formation]]
    for one, other in itertools.pairwise(dances):
        assert np.linalg.norm((one.clip.hips_m - other.clip.hips_m)[:, [0, 2]], axis=1).min() > 0.8
    for dance in dances:
        for stand in dance.standing:
            assert np.abs(np.subtract(stand.place_m, dance.clip.hips_m[stand.start])[[0, 2]]).max() < 0.8


def test_unison_is_the_same_dance_and_a_mirror_its_mirror_image() -> None:
    one, other, third = placed_m("unison")
    assert other == pytest.approx(one)
    one, other, third = placed_m("mirror")
    assert other == pytest.approx(one * (-1.0, 1.0, 1.0))
    assert third == pytest.approx(one)


def test_in_canon_each_is_a_bar_behind() -> None:
    one, other, _ = placed_m("canon")
    late = round(CANON_BEATS * BEAT_S * 60)
    # The first is already on the way when the music begins, so that its place is a little beside the other's.
    assert other[late + 60 : 1200] == pytest.approx(one[60 : 1200 - late], abs=0.01)
    turns = [dance.clip.rotations for dance in danced("canon")]
    trunk = [SEGMENTS.index(name) for name in ("spine", "chest", "head", "leftUpperArm", "rightUpperArm")]
    assert turns[1][late + 60 : 1200, trunk] == pytest.approx(turns[0][60 : 1200 - late, trunk], abs=1e-6)


def test_individuals_dance_their_own() -> None:
    chosen = [[step.segment for step in dance.steps] for dance in danced("individual")]
    assert chosen[0] != chosen[1] != chosen[2] != chosen[0]
    assert danced("individual")[0].steps == danced("unison")[0].steps
    assert len({role.manner for role in roles("individual", 8, Manner(), 3)}) == 8
