"""Slurred notes according to the habit of the line."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from app.plan.music.piece import slurs_next


def slurred(gates: Sequence[float], note_ticks: int = 480) -> list[bool]:
    """Return for each of some consecutive notes, which sound for a share of the time to the next one, whether it is
    slurred.
    """
    onsets = np.arange(len(gates)) * note_ticks
    found = slurs_next(onsets, onsets + np.rint(np.array(gates) * note_ticks).astype(np.int64))
    return [bool(one) for one in found[:-1]]


@pytest.mark.parametrize("gate", [1.0, 0.98, 0.95, 0.9, 0.5])
def test_one_gate_for_everything_says_nothing(gate: float) -> None:
    assert not any(slurred([gate] * 16))


@pytest.mark.parametrize("detached", [0.95, 0.9, 0.82])
@pytest.mark.parametrize("touching", [1.0, 0.98])
def test_a_line_that_mixes_them_slurs_what_touches(detached: float, touching: float) -> None:
    gates = [touching, touching, detached, touching, detached, detached, touching, detached]
    assert slurred(gates) == [gate == touching for gate in gates[:-1]]


def test_an_overlap_is_a_slur_in_any_line() -> None:
    assert slurred([1.0, 1.1, 1.0, 1.0]) == [False, True, False]
    assert slurred([0.9, 1.05, 0.9, 0.9]) == [False, True, False]


def test_staccato_and_rests_do_not_make_slurs_of_the_other_notes() -> None:
    assert not any(slurred([1.0, 0.5, 1.0, 0.5, 1.0, 0.75, 1.0, 1.0]))
