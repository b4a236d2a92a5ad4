"""Steps are connected by names, and repeated only if their inputs have changed."""

from __future__ import annotations

import itertools
import weakref
from functools import partial
from graphlib import CycleError

import numpy as np
import pytest

from app.arrays import IntArray
from app.steps import StepRuns, StepTable, reading

DONE: list[str] = []


def made_pair(value: int) -> tuple[int, int]:
    DONE.append("pair")
    return value, value


def made_sign(pair: tuple[int, int]) -> tuple[bool, ...]:
    DONE.append("sign")
    return (pair[0] > 0, pair[0] < 0)


def made_text(sign: tuple[bool, ...], *, name: str) -> str:
    DONE.append("text")
    return f"{name}: {sign}"


def made_count(value: int, before: tuple[int, ...] | None) -> tuple[int, ...]:
    return (value, *(before or ()))


def made_sum(values: IntArray) -> int:
    DONE.append("sum")
    return int(values.sum())


def in_a_circle(text: str) -> int:
    return len(text)


def of_anything(*values: int) -> int:
    return len(values)


STEPS = StepTable(pair=made_pair, sign=made_sign, text=made_text, count=made_count)


@pytest.fixture(autouse=True)
def nothing_done() -> None:
    DONE.clear()


def test_only_what_is_read_is_done_and_only_once() -> None:
    assert STEPS.given == {"value", "name"}
    made = STEPS.begin(value=2, name="x")
    assert DONE == []
    assert made.of(made_sign) == (True, False)
    assert made["sign"] is made.of(made_sign)
    assert DONE == ["pair", "sign"]


def test_a_step_whose_inputs_are_equal_is_taken_over_to_the_object() -> None:
    first = STEPS.begin(value=1000, name="x")
    text = first.of(made_text)
    DONE.clear()
    second = STEPS.begin(first, value=999 + 1, name="x")
    assert second.of(made_text) is text
    assert DONE == []


def test_a_result_that_turns_out_equal_ends_the_change() -> None:
    first = STEPS.begin(value=2, name="x")
    text = first.of(made_text)
    DONE.clear()
    second = STEPS.begin(first, value=5, name="x")
    assert second.of(made_text) is text
    assert DONE == ["pair", "sign"]
    assert STEPS.begin(second, value=5, name="y").of(made_text) != text


def test_a_step_may_see_what_it_made_before() -> None:
    first = STEPS.begin(value=1, name="x")
    assert first.of(made_count) == (1,)
    second = STEPS.begin(first, value=2, name="x")
    assert second.of(made_count) == (2, 1)
    assert STEPS.begin(second, value=2, name="z").of(made_count) == (2, 1)


def test_what_a_run_did_not_ask_for_is_done_by_the_next() -> None:
    first = STEPS.begin(value=1, name="x")
    first.of(made_pair)
    second = STEPS.begin(first, value=1, name="x")
    assert second.of(made_text) == "x: (True, False)"
    assert DONE == ["pair", "sign", "text"]


def test_runs_do_not_hold_one_another() -> None:
    first = STEPS.begin(value=1, name="x")
    first.of(made_text)
    second = STEPS.begin(first, value=1, name="y")
    second.of(made_sign)
    second.close()
    DONE.clear()
    second.of(made_text)
    assert DONE == ["text"]


def test_runs_go_on_from_those_of_the_same_table_about_the_same() -> None:
    others = StepTable(pair=made_pair)
    former = StepRuns()
    for table, about in ((STEPS, "a"), (STEPS, "b"), (others, "a")):
        former.begin(table, about, value=1, name="x")["pair"]
    DONE.clear()
    runs = StepRuns(former)
    assert runs.begin(STEPS, "a", value=1, name="x")["pair"] is former.of(STEPS, "a")["pair"]
    assert runs.begin(others, "a", value=1)["pair"] is former.of(others, "a")["pair"]
    assert DONE == []
    runs.begin(STEPS, "c", value=1, name="x")["pair"]
    assert DONE == ["pair"]
    with pytest.raises(KeyError):
        runs.of(STEPS, "b")
    begun = runs.begin(STEPS, "a", value=2, name="x")
    assert runs.of(STEPS, "a") is begun


def test_runs_that_are_closed_do_not_hold_their_former() -> None:
    former = StepRuns()
    pair = weakref.ref(former.begin(STEPS, value=1, name="x"))
    runs = StepRuns(former)
    runs.begin(STEPS, value=2, name="x")["pair"]
    del former
    assert pair() is not None
    runs.close()
    assert pair() is None


def test_steps_that_cannot_be_wired_are_refused() -> None:
    with pytest.raises(CycleError):
        StepTable(pair=made_pair, sign=made_sign, text=made_text, value=in_a_circle)
    with pytest.raises(TypeError, match="without names"):
        StepTable(count=of_anything)
    more = 3
    with pytest.raises(TypeError, match="reads more"):
        StepTable(total=lambda value: value + more)
    with pytest.raises(TypeError, match="name"):
        STEPS.begin(value=3)


def made_share(value: int, parts: int = 4) -> float:
    return value / parts


def test_a_parameter_with_a_default_keeps_it() -> None:
    assert StepTable(share=made_share).begin(value=2)["share"] == 0.5
    assert StepTable(share=partial(made_share, parts=8)).begin(value=2)["share"] == 0.25


def test_a_parameter_may_read_what_is_called_otherwise() -> None:
    steps = StepTable(pair=made_pair, half=reading(made_share, value="width"))
    assert steps.given == {"value", "width"}
    assert steps.begin(value=1, width=2, unread=3)["half"] == 0.5
    with pytest.raises(TypeError, match="made_share has no"):
        reading(made_share, height="width")


def test_a_path_is_an_attribute_of_a_result() -> None:
    steps = StepTable(pair=made_pair, sign=made_sign, turn="number.imag", share=reading(made_share, value="turn"))
    assert steps.given == {"value", "number"}
    first = steps.begin(value=1, number=2 + 8j)
    assert first["share"] == 2.0
    assert steps.begin(first, value=1, number=3 + 8j)["turn"] == 8.0
    with pytest.raises(CycleError):
        StepTable(pair=made_pair, value="pair.real")


def test_a_parameter_may_read_several() -> None:
    steps = StepTable(pair=made_pair, sign=made_sign, both=reading(joined, parts=("pair", "sign")))
    first = steps.begin(value=2)
    both = first["both"]
    assert both == (2, 2, True, False)
    assert steps.begin(first, value=1 + 1)["both"] is both


def joined(parts: tuple[tuple[int, ...], ...]) -> tuple[int, ...]:
    return tuple(itertools.chain(*parts))


def test_a_run_of_equal_values_has_all_results_of_the_one_before() -> None:
    first = STEPS.begin(value=1, name="x")
    text = first.of(made_text)
    second = STEPS.begin(first, value=1, name="x")
    second.close()
    assert second.of(made_text) is text


def test_arrays_are_compared_as_wholes() -> None:
    steps = StepTable(sum=made_sum)
    made = steps.begin(values=np.arange(4))
    assert made.of(made_sum) == 6
    for values, again in ((np.arange(4), False), (np.arange(5), True), (np.array([0, 1, 2, 3, 9]), True)):
        DONE.clear()
        made = steps.begin(made, values=values)
        assert made.of(made_sum) == values.sum()
        assert len(DONE) == again
