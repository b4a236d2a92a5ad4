"""Steps are done again only when their inputs changed."""

from __future__ import annotations

import pytest

from app.plan.memo import Memo

DONE: list[object] = []


def pair(value: int, name: str) -> tuple[int, int]:
    DONE.append((value, name))
    return value, value


def sign(value: int) -> tuple[bool, ...]:
    return (value > 0, value < 0)


def doubled(memo: Memo, value: int) -> tuple[int, int]:
    return memo.step("inner", pair, value, "inner")


def outer(memo: Memo, values: tuple[int, int]) -> tuple[int, int]:
    return memo.step("inner", pair, values[0], "inner")[0], values[1]


def counted(before: tuple[int, ...] | None, value: int) -> tuple[int, ...]:
    DONE.append(before)
    return (value,)


@pytest.fixture(autouse=True)
def nothing_done() -> None:
    DONE.clear()


def test_a_step_with_equal_inputs_is_taken_over_to_the_object() -> None:
    first = Memo()
    made = first.step("pair", pair, 1000, "x")
    second = Memo(first)
    assert second.step("pair", pair, 999 + 1, "x") is made
    assert DONE == [(1000, "x")]
    third = Memo(second)
    assert third.step("pair", pair, 3, "x") == (3, 3)
    assert third.step("pair of another", pair, 1000, "x") == made
    assert DONE == [(1000, "x"), (3, "x"), (1000, "x")]


def test_a_result_that_turns_out_equal_stays_the_same_object() -> None:
    first = Memo()
    made = first.step("sign", sign, 2)
    assert Memo(first).step("sign", sign, 5) is made


def test_a_step_may_have_steps_of_its_own_and_see_what_it_made_before() -> None:
    first = Memo()
    made = first.nested("outer", doubled, 4), first.revised("counted", counted, 4)
    second = Memo(first)
    assert (second.nested("outer", doubled, 4), second.revised("counted", counted, 4)) == made
    assert DONE == [(4, "inner"), None]
    second.revised("counted", counted, 5)
    assert DONE == [(4, "inner"), None, (4,)]


def test_steps_of_a_step_that_was_taken_over_are_known_in_the_run_after() -> None:
    first = Memo()
    first.nested("outer", outer, (4, 1))
    second = Memo(first)
    second.nested("outer", outer, (4, 1))
    second.close()
    DONE.clear()
    third = Memo(second)
    assert third.nested("outer", outer, (4, 2)) == (4, 2)
    assert DONE == []


def test_a_function_that_reads_more_than_its_inputs_is_refused() -> None:
    more = 3
    with pytest.raises(TypeError, match="reads more"):
        Memo().step("sum", lambda value: value + more, 2)


def test_runs_do_not_hold_one_another() -> None:
    first = Memo()
    first.step("a", sign, 1)
    second = Memo(first)
    second.close()
    assert second.step("a", sign, -1) == (False, True)
    assert second._before == {}


def outermost(memo: Memo, value: int, name: str) -> tuple[tuple[int, int], str]:
    return memo.nested("outer", doubled, value), name


def test_steps_within_a_step_that_was_taken_over_are_known_in_the_run_after() -> None:
    first = Memo()
    made = first.nested("outermost", outermost, 1000, "a")
    second = Memo(first)
    assert second.nested("outermost", outermost, 1000, "a") is made
    third = Memo(second)
    again, _ = third.nested("outermost", outermost, 1000, "b")
    assert again is made[0]
    assert DONE == [(1000, "inner")]
