"""A restless person at the whole editor: nothing fails, Qt complains of nothing, nothing by hand is lost."""

from __future__ import annotations

from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from tests.gui.shell.conftest import Answers, Program, Start, answers, program, settings, start
from tests.support.restless import Restless

__all__ = ["Answers", "Program", "Start", "answers", "program", "settings", "start"]

STEPS = 75


@pytest.mark.parametrize("seed", [5, 6])
def test_whatever_is_clicked_and_pressed(
    program: Program, answers: Answers, qtbot: QtBot, tmp_path: Path, seed: int
) -> None:
    answers.answer = "discard"
    answers.path = tmp_path / "work.suisou"
    person = Restless(program, seed)
    with qtbot.captureExceptions() as caught:
        for _ in range(STEPS):
            person.step()
            assert not caught, (person.deeds[-5:], caught)
        person.judge(tmp_path)
    assert not caught, (person.deeds[-5:], caught)
