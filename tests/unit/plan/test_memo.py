"""Steps are done again only when their inputs changed."""

from __future__ import annotations

from app.plan.memo import Memo


def test_a_step_with_equal_inputs_is_taken_over_to_the_object() -> None:
    done: list[str] = []

    def make(value: int) -> tuple[int, ...]:
        done.append("made")
        return (value, value)

    first = Memo()
    made = first.step("pair", lambda: make(2), 2, "x")
    second = Memo(first)
    assert second.step("pair", lambda: make(2), 2, "x") is made
    assert done == ["made"]
    third = Memo(second)
    assert third.step("pair", lambda: make(3), 3, "x") == (3, 3)
    assert done == ["made", "made"]


def test_a_result_that_turns_out_equal_stays_the_same_object() -> None:
    first = Memo()
    made = first.step("sign", lambda: ("plus",), 2)
    assert Memo(first).step("sign", lambda: ("plus",), 5) is made


def test_runs_do_not_hold_one_another() -> None:
    first = Memo()
    first.step("a", lambda: 1)
    second = Memo(first)
    second.close()
    assert second.step("a", lambda: 2) == 2
