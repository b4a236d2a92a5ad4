"""The questionnaire in a real browser, answered by keyboard only."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.evaluation.answers import read_answers
from app.evaluation.page import PAGE_FILE
from app.messages import LANGUAGES, WORDINGS
from tests.support.browser import Page, browser_command, opened, wait_until
from tests.unit.evaluation.made import TITLE, small_evaluation

FOCUSED = "document.activeElement.id"


def press_until_focused(page: Page, id: str) -> None:
    for _ in range(12):
        if page.value(FOCUSED) == id:
            return
        page.press("Tab")
    raise AssertionError(f"{id} is not reached with Tab")


def fits(page: Page) -> bool:
    """Return whether the page needs no horizontal scrolling."""
    return bool(page.value("document.documentElement.scrollWidth <= window.innerWidth"))


def watch(page: Page) -> None:
    """Play the clip with the focused button, and wait for the questions."""
    page.wait_for(f"{FOCUSED} === 'play'")
    assert page.value("document.querySelectorAll('fieldset').length") == 0
    page.press("1")
    assert page.value("document.querySelectorAll(':checked').length") == 0
    page.press("Enter")
    page.wait_for("document.querySelectorAll('fieldset').length")


def answer(page: Page, first: int) -> list[str]:
    """Answer every question with the digits 0 to 5 in turn; return the pressed digits."""
    count = page.value("document.querySelectorAll('fieldset').length")
    pressed = [str((first + number) % 6) for number in range(count)]
    for key in pressed:
        page.press(key)
    page.wait_for(f"{FOCUSED} === 'next'")
    return pressed


@pytest.mark.readers
@pytest.mark.parametrize(("width", "language"), [(1280, "en"), (375, "ja")])
def test_it_is_answered_by_keyboard(width: int, language: str, tmp_path: Path) -> None:
    if browser_command() is None:
        pytest.skip("no Chromium")
    key, table = small_evaluation(tmp_path)
    place = list(LANGUAGES).index(language)
    with opened(tmp_path, language) as page:
        page.resize(width, 740)
        page.load((tmp_path / PAGE_FILE).as_uri() + "#2")
        assert page.value("document.documentElement.lang") == language
        assert page.value("document.querySelector('h1').textContent") == WORDINGS["evaluate.page_welcome"][place]
        assert TITLE in page.value("document.querySelector('h1 + p').textContent")
        assert fits(page)
        press_until_focused(page, "consent")
        page.press(" ")
        press_until_focused(page, "begin")
        page.press("Enter")
        watch(page)
        answer(page, 3)
        page.press("Enter")
        pressed = []
        for number, shown in enumerate(table[1]):
            watch(page)
            assert fits(page)
            pressed.append(answer(page, number))
            if number in (1, len(table[1]) - 1):
                page.reload()
                # Earlier progress and answers are restored; only the continue button has to be reached.
                page.wait_for("document.querySelectorAll('fieldset').length")
                checked = page.value("[...document.querySelectorAll(':checked')].map((input) => input.value || '0')")
                assert checked == pressed[-1]
                page.value("document.getElementById('next').focus()")
            assert len(shown.right) == (3 if page.value("document.querySelectorAll('canvas').length") else 0)
            page.press("Enter")
        page.wait_for(f"{FOCUSED} === 'save'")
        assert fits(page)
        page.press("Enter")
        (file,) = wait_until(lambda: list(tmp_path.glob("answers-*.csv")), "the file")
        assert page.troubles() == []
    found = read_answers(file)
    rows = [
        (position, "pair" if shown.right else "single", side, code, aspect, scale)
        for position, shown in enumerate(table[1], start=1)
        for side, code in ((("left", shown.left), ("right", shown.right)) if shown.right else (("", shown.left),))
        for aspect in key.aspects
        for scale in ("naturalness", "synchrony")
    ]
    said = [(one.position, one.presentation, one.side, one.clip, one.aspect, one.scale) for one in found.answers]
    assert said == rows
    assert {one.evaluation for one in found.answers} == {key.evaluation}
    assert {one.language for one in found.answers} == {language}
    # On the page a pair's two answers to a question follow one another.
    for position in range(1, len(table[1]) + 1):
        given = ["0" if one.answer is None else str(one.answer) for one in found.answers if one.position == position]
        assert sorted(given) == sorted(pressed[position - 1])
    assert all(one.seconds >= 0.5 for one in found.answers)
