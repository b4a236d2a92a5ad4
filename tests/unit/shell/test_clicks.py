"""Clicks are connected only by `widgets.common.clicks`, whose slots are typed."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import app.shell
import widgets

ROOT = Path(widgets.__path__[0]).parent
MODULES = sorted(path for room in (app.shell, widgets) for path in Path(room.__path__[0]).rglob("*.py"))
CLICKS = frozenset(("clicked", "triggered"))
NO_BUTTON = frozenset(
    (
        ("app/shell/palette.py", "self.list.clicked"),
        ("widgets/inspector/rows.py", "self.clicked"),
        ("widgets/timeline/ruler/ruler_unit.py", "group.triggered"),
        ("widgets/timeline/tool_bar.py", "modes.triggered"),
    )
)
"""Signals of lists and groups with the same name as buttons' signals, which always pass an index or action."""


PICTURES = ("icon", "_spot")
"""Functions that make the picture of an entry."""


def connected_elsewhere(name: str, text: str) -> list[str]:
    """Find the places of a module that connect a click to a slot whose type is not checked."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Attribute) and node.attr in CLICKS:
            if (name, ast.unparse(node)) not in NO_BUTTON:
                found.append(f"{name}:{node.lineno} {ast.unparse(node)}")
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "addAction":
            texts = node.args[1:] if ast.unparse(node.args[0]).split("(")[0] in PICTURES else node.args
            if len(texts) > 1 or node.keywords:
                found.append(f"{name}:{node.lineno} {ast.unparse(node)}")
    return found


def test_clicks_are_connected_in_one_place() -> None:
    found = [
        place
        for path in MODULES
        if path.name != "clicks.py"
        for place in connected_elsewhere(path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8"))
    ]
    assert found == [], "use on_click or on_switch of widgets.common.clicks"


@pytest.mark.parametrize(
    "line",
    [
        "row.triggered.connect(partial(session.viewport.show, what))",
        "button.clicked.connect(lambda: run())",
        "for signal in (button.clicked, box.toggled): signal.connect(run)",
        "menu.addAction('Reset', self.reset)",
        "menu.addAction(icon('eye', tokens), 'Reset', self.reset)",
    ],
)
def test_the_rule_finds_other_ways(line: str) -> None:
    assert len(connected_elsewhere("module.py", line)) == 1
