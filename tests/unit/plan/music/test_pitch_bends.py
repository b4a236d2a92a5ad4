"""Scoops and falls, distinguished from vibrato and a detuned channel."""

from __future__ import annotations

import numpy as np
import pytest

from app.plan.music.piece import ControllerSteps
from app.plan.music.pitch_bends import bends, written_bends
from app.score.marks import Mark
from app.score.model import Note
from app.score.tempo import TempoMap

NOTE = Note("1:1", 480, 480, 67, 80)


def steps(*rows: tuple[int, float]) -> ControllerSteps:
    ticks, values = zip(*rows, strict=True)
    return ControllerSteps(np.array(ticks, float), np.array(values, float))


VIBRATO = [(480 + 10 * k, 0.2 * float(np.sin(k))) for k in range(48)]


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ([(0, 0.0), (470, -0.6), (520, -0.3), (560, 0.0)], ("scoop",)),
        ([(480, -0.6), (520, -0.3), (560, 0.0)], ("scoop",)),
        ([(480, 0.5), (540, 0.0)], ("plop",)),
        ([(0, 0.0), (800, -0.2), (850, -0.6), (900, -1.0), (960, 0.0)], ("fall",)),
        ([(0, 0.0), (800, 0.2), (900, 1.0), (960, 0.0)], ("doit",)),
        ([(470, -0.6), (540, 0.0), (900, -1.0), (960, 0.0)], ("scoop", "fall")),
        # A slide through the note from its own pitch away, and one that arrives there.
        ([(480, 0.0), (600, 0.0), *((600 + 10 * k, -0.05 * k) for k in range(1, 36))], ("fall",)),
        ([(480 + 10 * k, 0.05 * k - 1.75) for k in range(36)], ("scoop",)),
        # A channel that is tuned elsewhere is not bent; a vibrato comes back; another note's fall is not this one's.
        ([(0, -0.5)], ()),
        (VIBRATO, ()),
        ([(100, -0.8), (470, 0.0), (960, -0.9)], ()),
    ],
)
def test_bends_into_and_out_of_a_note(rows: list[tuple[int, float]], expected: tuple[str, ...]) -> None:
    assert bends([NOTE], steps(*rows)) == [expected]


def test_a_bend_counts_until_the_next_note_begins() -> None:
    following = Note("1:2", 900, 480, 69, 80)
    curve = steps((0, 0.0), (890, 0.0), (900, -0.9), (1000, 0.0))
    assert bends([NOTE, following], curve) == [(), ("scoop",)]
    assert bends([NOTE, following], None) == [(), ()]


def test_a_mark_whose_note_is_gone_bends_nothing() -> None:
    fall = (Mark("fall", "1:9"),)
    assert written_bends((), fall, TempoMap(480)) is None
    alone = written_bends((NOTE,), fall, TempoMap(480))
    assert alone is not None
    assert not alone.values.any()
