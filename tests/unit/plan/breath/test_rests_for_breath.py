"""Selection of rests for breaths by their seconds, the playing before them and the air left."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.messages import LANGUAGES, text
from app.plan.breath.rests_for_breath import breathed_in, rest_needs
from app.plan.generate import MonophonicPart
from app.plan.model import PlayerPlan
from app.plan.music.piece import line_times
from app.plan.music.rests import rest_ticks
from app.plan.parameters import PlayerParameters
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from tests.support.plan import PlainClock, PlainNote, line_of, make_plans, piece_of, time_frame, valves

Q = 480
LUNG_S = 9.0


def line(*pairs: tuple[float, float]) -> tuple[PlainNote, ...]:
    """Notes with the rests after them in quarters."""
    at, rows = 0.0, []
    for length, rest in pairs:
        rows.append((round(at * Q), round(length * Q), 65))
        at += length + rest
    return line_of(*rows)


def planned(
    notes: tuple[PlainNote, ...], bpm: float, instrument: InstrumentMap | None = None, **parameters: float
) -> PlayerPlan:
    clock = PlainClock(((0, bpm),))
    part = MonophonicPart("p", notes, valves() if instrument is None else instrument, PlayerParameters(**parameters))
    return make_plans(piece_of(clock), (part,), time_frame((part,), clock))["p"]


def breathed(plan: PlayerPlan) -> list[int]:
    """Numbers of the notes preceded by a breath, after the first."""
    return [int(event.id.split(":")[-1]) for event in plan.breaths if event.kind == "breath"][1:]


def is_enough(rest_s: float, played_s: float, spent: float, need: float) -> bool:
    """Decide about one rest by the specified rules without arrays."""

    def scaled(figure: float, most: float) -> float:
        return figure * need / 0.35 if need <= 0.35 else figure + (most - figure) * (need - 0.35) / 0.65

    if rest_s >= 1.5:
        return True
    if played_s < min(need / 0.35, 1.0) * (1.0 if rest_s >= 0.5 else 1.5):
        return False
    if rest_s >= 0.75:
        return played_s >= scaled(1.0, LUNG_S) or spent >= scaled(0.2, 1.0)
    if rest_s >= 0.5:
        return played_s >= scaled(2.5, LUNG_S) or spent >= scaled(0.2, 1.0)
    if rest_s >= 0.3:
        middle = (rest_s - 0.3) / 0.2
        return played_s >= scaled(5.0, LUNG_S) * (1 - middle) + scaled(3.5, LUNG_S) * middle or spent >= (
            scaled(0.4, 1.0) * (1 - middle) + scaled(0.35, 1.0) * middle
        )
    return need < 0.35 and spent >= scaled(1.0, 1.0)


# Odd lengths: no sum of them lies on a threshold.
_lengths = st.sampled_from([0.11, 0.31, 0.77, 1.03, 1.93, 4.07])
_rests = st.sampled_from([0.13, 0.29, 0.31, 0.41, 0.49, 0.51, 0.63, 0.74, 0.76, 1.21, 1.49, 1.51, 3.0])


@given(
    st.lists(st.tuples(_lengths, _rests), min_size=1, max_size=12),
    st.sampled_from([0.0, 0.1, 0.35, 0.36, 0.6, 0.97]),
    st.sampled_from([0.7, 1.0, 1.9]),
)
def test_rests_are_decided_one_after_another(pairs: list[tuple[float, float]], need: float, rate: float) -> None:
    """``rate``: how much more air than at mezzoforte is used."""
    lengths, rests = (np.array(column) for column in zip(*pairs, strict=True))
    refill = np.minimum(rests / 0.5, 1.0)
    played_s = np.concatenate(([0.0], np.cumsum(lengths)))
    # The rest after a note is that before the next: the first note has none.
    found = breathed_in(
        np.append(rate * played_s, rate * (played_s[-1] + 1.0)),
        np.append(played_s, played_s[-1] + 1.0),
        LUNG_S,
        np.insert(refill, 0, 0.0),
        rest_needs(np.insert(rests, 0, 0.0), need, LUNG_S),
    )
    level, since_s = 0.5, 0.0
    expected = []
    for length, rest in pairs:
        since_s += length
        level = max(level - rate * length / LUNG_S, 0.0)
        if is_enough(rest, since_s, 1.0 - level, need):
            expected.append(True)
            level, since_s = min(level + min(rest / 0.5, 1.0), 1.0), 0.0
        else:
            expected.append(False)
    assert found.breathed.tolist() == [False, *expected]


@given(st.floats(0.0, 3.0), st.floats(0.0, 1.0), st.floats(0.01, 1.0))
def test_longer_rests_never_need_more_and_a_greater_need_never_less(rest_s: float, need: float, more: float) -> None:
    rests = np.array([rest_s, rest_s + more])
    for shorter, longer in rest_needs(rests, need, LUNG_S):
        assert longer <= shorter + 1e-9
    less, greater = (rest_needs(rests, one, LUNG_S) for one in (need, min(need + more, 1.0)))
    for one, other in zip(less, greater, strict=True):
        assert np.all(one <= other + 1e-9)


@pytest.mark.parametrize(
    ("rest_s", "played_s", "expected"),
    [
        (2.0, 0.2, True),
        (1.5, 0.2, True),
        (1.4, 0.9, False),
        (1.4, 1.0, True),
        (0.75, 1.0, True),
        (0.74, 1.5, False),
        (0.74, 2.0, True),  # more than a fifth of the lungs
        (0.5, 1.9, True),
        (0.5, 1.7, False),
        (0.4, 3.0, False),
        (0.4, 3.5, True),
        (0.25, 5.0, False),
    ],
)
def test_the_list_of_the_defaults(rest_s: float, played_s: float, expected: bool) -> None:
    """At 60, a quarter is a second; since `breath_min_beats` excludes rests below half a beat, the tempo is 120."""
    notes = line((2 * played_s, 2 * rest_s), (1, 0))
    assert breathed(planned(notes, 120.0)) == ([2] if expected else [])


def test_adagio_rests_of_two_seconds_are_all_breathed_in() -> None:
    """Seven quarter rests at 30 among long and short notes, one immediately after another."""
    notes = line((2, 1), (0.5, 0), (0.5, 0), (1, 1), (1, 1), (0.25, 1), (0.25, 1), (4, 1), (1, 1), (2, 0))
    assert breathed(planned(notes, 30.0)) == [2, 5, 6, 7, 8, 9, 10]


GROWING = [0.25, 0.5, 0.75, 1.0, 1.5, 2.0]


def test_rests_of_a_quarter_beat_to_two_beats() -> None:
    """Two beats at 96 before each rest: 1.25 s of playing."""
    notes = line(*((2, rest) for rest in GROWING), (2, 0))
    trumpet = bundled_maps()["trumpet_Bb"]
    assert [GROWING[number - 2] for number in breathed(planned(notes, 96.0, trumpet))] == [0.75, 1.5, 2.0]
    assert [GROWING[number - 2] for number in breathed(planned(notes, 96.0, trumpet, breath_need=0.0))] == GROWING[1:]


@pytest.mark.parametrize("bpm", [60.0, 90.0, 140.0, 200.0])
def test_without_need_every_rest_of_the_thesis_is_breathed_in(bpm: float) -> None:
    rests = [0.5, 2.0, 0.75, 1.0, 0.5, 1.5, 0.45, 3.0, 0.5]
    lengths = [1.0, 0.5, 0.25, 0.5, 2.0, 0.25, 1.0, 0.75, 1.5]
    notes = line(*zip(lengths, rests, strict=True), (1, 0))
    plan = planned(notes, bpm, breath_need=0.0)
    assert breathed(plan) == [2, 3, 4, 5, 6, 7, 9, 10]
    kinds = {event.id.removeprefix("breath:"): event.reason.id for event in plan.breaths if event.kind == "breath"}
    expected = {
        0.5: "rest_whole",
        0.75: "rest_whole",
        1.0: "last_beat",
        1.5: "last_beat",
        2.0: "prepared",
        3.0: "prepared",
    }
    for index, rest in enumerate(rests, 2):
        assert kinds.get(f"1:{index}") == (f"breath.{expected[rest]}" if rest in expected else None)


@pytest.mark.parametrize("need", [0.0, 0.35])
def test_a_staccato_run_is_no_row_of_breaths(need: float) -> None:
    notes = line(*[(0.5, 0.5)] * 16, (1, 0))
    assert breathed(planned(notes, 100.0, breath_need=need)) == []


def test_only_long_rests_are_breathed_in_while_there_is_air() -> None:
    notes = line((4, 1), (2, 0.75), (1, 1.5), (0.5, 2), (4, 1.4), (1, 0))
    assert breathed(planned(notes, 60.0, breath_need=1.0)) == [4, 5]


def test_a_rest_that_is_not_used_shows_no_preparation() -> None:
    """Rests of two beats at 160 are 0.75 s; before the second one there was half a second of playing."""
    notes = line((4, 2), (1.25, 2), (4, 2), (1, 0))
    plan = planned(notes, 160.0)
    assert breathed(plan) == [2, 4]
    assert [event.id for event in plan.breaths if event.kind == "preparation"][1:] == [
        "preparation:1:2",
        "preparation:1:4",
    ]


def test_a_rest_caught_for_want_of_air_keeps_its_preparation() -> None:
    """Half a second of playing, two beats of rest that require a second of it, and then more than the air left."""
    notes = line((16, 2), (1, 2), (23, 2), (1, 0))
    plan = planned(notes, 160.0, breath_need=1.0)
    caught = [event for event in plan.breaths if event.reason.arguments.get("why") == "breath.why_short"]
    assert caught
    prepared = {event.id.removeprefix("preparation:") for event in plan.breaths if event.kind == "preparation"}
    assert {event.id.removeprefix("breath:") for event in caught} <= prepared


def test_a_slow_rest_of_few_beats_counts() -> None:
    """An eighth at 40 is 0.75 s, but less than the player's minimum in beats."""
    notes = line((3, 0.5), (1, 0))
    assert breathed(planned(notes, 40.0, breath_min_beats=1.0)) == [2]
    assert breathed(planned(notes, 44.0, breath_min_beats=1.0)) == []


def test_a_ritardando_makes_no_rest_longer() -> None:
    """Half a beat at 100 is 0.3 s; at half the tempo it would be 0.6 s."""
    notes = line(*[(1.5, 0), (1.5, 1)] * 16, (1.5, 0), (1.5, 0.5), (1, 0.5), (2, 0))
    part, clock = MonophonicPart("p", notes, valves()), PlainClock(((0, 100.0), (64 * Q, 50.0)))
    slowing = make_plans(piece_of(clock), (part,), time_frame((part,), clock))["p"]
    usual = breathed(planned(notes, 100.0))
    assert usual == breathed(slowing)
    assert len(usual) == 16


def test_every_reason_is_true_and_readable() -> None:
    notes = line((2, 2), (2, 1), (4, 0.75), (1, 0.6), (2, 0.6), (1, 0))
    for need, bpm in itertools.product((0.0, 0.2, 0.35, 0.8), (50.0, 80.0, 120.0)):
        for event in planned(notes, bpm, breath_need=need).breaths:
            said = [text(event.reason, language) for language in LANGUAGES]
            assert not any("{" in one or "breath." in one for one in said)
            arguments = event.reason.arguments
            if event.kind == "breath" and event.reason.id != "breath.first" and "catch" not in event.reason.id:
                assert arguments["rest_s"] == pytest.approx(float(arguments["rest_beats"]) * 60.0 / bpm, abs=0.01)
                if arguments["why"] == "breath.why_played":
                    assert arguments["played_s"] >= arguments["enough_s"]
                if arguments["why"] == "breath.why_air":
                    assert arguments["spent"] >= arguments["share"]


def test_playing_is_reported_since_the_last_breath_in_a_rest() -> None:
    """Catch breaths are planned after the rest was chosen; the reason for the rest must not contradict them."""
    plan = planned(line(*[(2, 0)] * 15, (1, 1), (2, 0)), 60.0)
    *_, catch, rest = [event for event in plan.breaths if event.kind == "breath"]
    assert (catch.reason.id, rest.reason.id) == ("breath.catch", "breath.last_beat")
    assert rest.reason.arguments["played_s"] == 31.0
    english, japanese = (text(rest.reason, language) for language in ("en", "ja"))
    assert "31 s were played since the last breath in a rest (at least 1 s)" in english
    assert "休符で吸ってから 31 秒" in japanese


def test_one_beat_is_no_beats() -> None:
    """Singular in every number of a reason: of the rest itself and of the thresholds."""
    plan = planned(line((2, 1), (2, 0.5), (2, 2), (2, 0)), 60.0)
    english = [text(event.reason, "en") for event in plan.breaths]
    assert any("rest of 1 beat (1 s)" in one for one in english)
    assert any("rest of 0.5 beats (0.5 s)" in one for one in english)
    assert any("shorter than 1 beat:" in one for one in english)
    assert any("rest of 2 beats (2 s)" in one for one in english)
    assert not any(" 1 beats" in one for one in english)


def test_small_lungs_make_no_one_gasp_after_every_note() -> None:
    """A tuba at fortissimo uses a quarter of the lungs per second."""
    tuba = bundled_maps()["tuba_BBb"]
    notes = tuple(
        PlainNote(note.id, note.onset_tick, note.duration_tick, 41, 112) for note in line(*[(1, 0.4)] * 12, (1, 0))
    )
    times = line_times(MonophonicPart("p", notes, tuba), PlainClock(((0, 60.0),)))
    assert rest_ticks(times, np.full(13, Q))[1:].tolist() == [round(0.4 * Q)] * 12
    found = breathed(planned(notes, 60.0, tuba, breath_min_beats=0.25))
    assert found
    assert all(later - earlier >= 2 for earlier, later in itertools.pairwise([1, *found]))
