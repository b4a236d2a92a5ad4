"""Loudness from controllers, compared with a sum over every tick."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.performance.loudness import note_levels, note_loudness, note_marks, sounding_curve, unaccented, velocities_of
from app.plan.music.dynamics_from_velocities import read_velocities
from app.score.marks import Mark
from app.score.model import ControllerCurve, CurveKind, Note, Part


def part(notes: list[tuple[int, int]], *curves: ControllerCurve) -> Part:
    made = tuple(Note(f"1:{n}", onset, length, 60, 80) for n, (onset, length) in enumerate(notes, 1))
    return Part("1.1.1", "x", 0, 0, 0, None, None, "m", made, curves)


@given(st.lists(st.tuples(st.integers(1, 40), st.floats(0, 1)), min_size=1, max_size=8))
def test_the_mean_is_the_mean_over_ticks(steps: list[tuple[int, float]]) -> None:
    ticks = np.cumsum([gap for gap, _ in steps])
    values = [value for _, value in steps]
    made = part([(0, 50), (60, 90)], ControllerCurve("breath", tuple(ticks.tolist()), tuple(values)))
    each = [values[max(int(np.searchsorted(ticks, tick, side="right")) - 1, 0)] for tick in range(150)]
    means = (float(np.mean(each[0:50])), float(np.mean(each[60:150])))
    # A note that was not blown has the loudness of its velocity: with one velocity throughout, mezzoforte.
    expected = tuple(mean if mean > 2 / 127 else 0.63 for mean in means)
    silent = len(set(each)) == 1 or max(means) == 0.0
    assert note_loudness(made) == pytest.approx((0.63, 0.63) if silent else expected)


def test_a_level_that_is_set_once_says_nothing() -> None:
    assert note_loudness(part([(0, 10)], ControllerCurve("volume", (0,), (0.8,)))) == (0.63,)
    assert note_loudness(part([(100, 10)], ControllerCurve("volume", (0, 50), (0.1, 0.8)))) == (0.63,)
    assert note_loudness(part([])) == ()


def test_a_velocity_that_never_changes_leaves_the_dynamics_to_a_drawn_curve() -> None:
    notes = tuple(Note(f"1:{n}", 10 * n, 10, 60, 49) for n in range(10))
    swelling = ControllerCurve("expression", tuple(range(0, 100, 10)), (0.4,) * 5 + (0.8,) * 5)
    made = Part("1.1.1", "x", 0, 0, 0, None, None, "m", notes, (swelling,))
    assert note_loudness(made) == pytest.approx((0.4,) * 5 + (0.8,) * 5)
    assert note_marks(made) == ("p",) * 5 + ("f",) * 5


@pytest.mark.parametrize("kind", ["breath", "expression"])
@pytest.mark.parametrize("level", [0.5, 0.8])
def test_a_curve_that_only_shapes_notes_leaves_the_level_to_the_velocities(kind: CurveKind, level: float) -> None:
    """Every note swells and every other one is slightly louder; this is no forte, however high the curve is."""
    curve = ControllerCurve(
        kind, tuple(range(0, 400, 5)), (level - 0.05, level + 0.05, level - 0.07, level + 0.03) * 20
    )
    made = part([(10 * n, 10) for n in range(40)], curve)
    assert note_marks(made) == ("mf",) * 40
    assert np.ptp(note_loudness(made)) == pytest.approx(0.02)


def test_breath_speaks_before_volume() -> None:
    breath = ControllerCurve("breath", (0, 10), (0.2, 0.6))
    volume = ControllerCurve("volume", (0, 5), (1.0, 0.9))
    assert note_loudness(part([(0, 20)], volume, breath)) == pytest.approx((0.4,))


def test_expression_scales_what_the_velocities_say() -> None:
    """A line that is forte by its velocities remains forte if its expression varies around the usual level."""
    velocities = [64] * 10 + [112] * 10
    notes = tuple(Note(f"1:{n}", 10 * n, 10, 60, velocity) for n, velocity in enumerate(velocities))
    swelling = ControllerCurve("expression", tuple(range(0, 200, 5)), (0.53, 0.73) * 20)
    made = Part("1.1.1", "x", 0, 0, 0, None, None, "m", notes, (swelling,))
    assert note_loudness(made) == pytest.approx(tuple(velocity / 127 for velocity in velocities))


def test_what_was_not_blown_sounds_by_its_velocity_and_the_rest_as_it_was_blown() -> None:
    breath = ControllerCurve("breath", (0, 10, 20, 45, 60), (0.4, 0.6, 0.0, 0.01, 0.5))
    made = part([(0, 20), (20, 10), (30, 10), (40, 10), (60, 10)], breath)
    sounding = sounding_curve(made)
    ticks, values = np.array(sounding.ticks), np.array(sounding.values)
    each = [values[max(int(np.searchsorted(ticks, tick, side="right")) - 1, 0)] for tick in range(70)]
    assert each == [0.4] * 10 + [0.6] * 10 + [0.63] * 30 + [0.01] * 10 + [0.5] * 10
    assert note_loudness(made) == pytest.approx((0.5, 0.63, 0.63, 0.63, 0.5))
    blown = part([(0, 20), (60, 10)], breath)
    assert sounding_curve(blown) is breath


def test_the_levels_that_a_program_wrote_are_known_and_those_of_a_curve_or_a_hand_are_not() -> None:
    """MuseScore's piano is 49, its forte 96 and an accent on piano 58."""
    velocities = [49] * 12 + [96] * 3 + [49] * 6 + [58] + [49] * 6
    notes = tuple(Note(f"1:{n}", 10 * n, 10, 60, velocity) for n, velocity in enumerate(velocities))
    made = Part("1.1.1", "x", 0, 0, 0, None, None, "m", notes, ())
    piano, forte = 49 / 127, 96 / 127
    assert note_levels(made) == pytest.approx([piano] * 12 + [forte] * 3 + [piano] * 13)
    assert note_levels(part([(0, 10)] * 3, ControllerCurve("breath", (0, 10), (0.2, 0.6)))) == ()
    chance = np.random.default_rng(1)
    struck = tuple(Note(f"1:{n}", 10 * n, 10, 60, int(chance.integers(50, 100))) for n in range(60))
    assert note_levels(Part("1.1.1", "x", 0, 0, 0, None, None, "m", struck, ())) == ()


@pytest.mark.parametrize(("kind", "velocity"), [("accent", 96), ("marcato", 104)])
def test_accents_in_a_row_of_a_score_are_no_dynamic(kind: str, velocity: int) -> None:
    """A passage without a dynamic is followed by a forte."""
    velocities = [80] * 8 + [velocity] * 4 + [80] * 12 + [96] * 24
    notes = tuple(Note(f"1:{n}", 10 * n, 10, 60, struck) for n, struck in enumerate(velocities))
    marks = tuple(Mark(kind, f"1:{n}") for n in range(8, 12))
    written = Part("1.1.1", "x", 0, 0, 0, None, None, "m", notes, (), marks=marks, source="score")
    heard = Part("1.1.1", "x", 0, 0, 0, None, None, "m", notes, ())
    assert note_marks(heard, read_velocities([velocities_of(heard)]))[8:12] == ("f",) * 4, "a sound says no more"
    assert note_marks(written, read_velocities([unaccented(written)]))[:24] == ("mf",) * 24
