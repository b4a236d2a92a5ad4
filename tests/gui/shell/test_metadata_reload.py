"""The editor applies a user's table as soon as its file is saved, and keeps the last valid one."""

from __future__ import annotations

from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.project.edit.players import set_parameters
from app.shell.app import Program
from metadata.library import FOLDERS

STYLE = 'name = "mine"\ntitle = { en = "Mine" }\nvariation = 0.0\n[factors]\nsway = 0.5\n'
RULES = """name = "mine"
description = ""

[[rules]]
name = "first_note"
when = { place = ["first"] }
do = { gesture = "shrug" }
"""


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for folder in FOLDERS:
        (tmp_path / folder.name).mkdir()
        monkeypatch.setenv(folder.variable, str(tmp_path / folder.name))
        monkeypatch.setattr(folder, "last", None)
    return tmp_path


def test_a_saved_table_is_played_at_once(folders: Path, program: Program, qtbot: QtBot) -> None:
    session = program.session
    first = session.project.players[0]
    session.document.open(set_parameters(session.project, (first.id,), style="mine"))
    qtbot.waitUntil(lambda: session.performance.project is session.project and session.performance.planned)
    said = [problem.message.id for problem in session.problems(first.id)]
    assert "project.style_missing" in said
    (folders / "styles" / "mine.toml").write_text(STYLE, encoding="utf-8")

    def sway() -> float:
        return session.performance.parameters(session.project.players[0]).sway

    qtbot.waitUntil(lambda: sway() == 0.5 * first.parameters.sway)
    qtbot.waitUntil(lambda: "project.style_missing" not in [one.message.id for one in session.problems(first.id)])

    def named() -> list[str]:
        return [event.id for event in session.performance.plans[first.id].gestures if ":first_note:" in event.id]

    assert not named()
    (folders / "rules" / "mine.toml").write_text(RULES, encoding="utf-8")
    qtbot.waitUntil(lambda: session.performance.planned and len(named()) == 1)
    noticed: list[tuple[str, str]] = []
    session.noticed.connect(lambda message, _: noticed.append((message.id, str(message.arguments.get("file")))))
    (folders / "rules" / "mine.toml").write_text(RULES + "oops", encoding="utf-8")
    qtbot.waitUntil(lambda: ("table.syntax", "rules/mine.toml") in noticed)
    assert len(named()) == 1, "the last good version stays"
    assert program.generator.up_to_date
