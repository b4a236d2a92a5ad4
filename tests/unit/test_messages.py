"""Every message id in the program has an English template for its arguments, and no template is unused."""

from __future__ import annotations

import ast
import re
import string
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from app.errors import Message
from app.messages import LANGUAGES, WORDINGS, filled, text, touch_name
from app.plan.parameters import PARAMETERS
from app.project.model import DANCER_PARAMETERS
from instrument_maps.model import PARTS

ROOT = Path(__file__).parents[2]
FOLDERS = ("app", "widgets", "instrument_maps", "metadata")
SOURCES = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.py"))
ID = re.compile(r"[a-z][a-z0-9_]*(\.[a-z][a-z0-9_]*)+")


@cache
def nodes(path: Path) -> tuple[ast.Call | ast.Constant, ...]:
    """Return the calls and constants of a file, which is parsed once."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return tuple(node for node in ast.walk(tree) if isinstance(node, ast.Call | ast.Constant))


def calls(path: Path) -> Iterator[tuple[ast.Call, str, set[str] | None]]:
    """Calls that make a message or one of the program's errors with a literal id: call, id, names of the arguments,
    which are None if not all are written in the call.

    The names are None where the arguments are not all written out at the call.
    """
    for node in nodes(path):
        if not isinstance(node, ast.Call) or not node.args:
            continue
        function = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        first = node.args[0]
        if not isinstance(first, ast.Constant) or not isinstance(first.value, str) or not ID.fullmatch(first.value):
            continue
        if function == "Message":
            yield node, first.value, message_arguments(node)
        elif function.endswith("Error") or function == "Cancelled" or (function == "said" and "cli" in path.parts):
            names = {keyword.arg for keyword in node.keywords}
            yield node, first.value, None if None in names else {str(name) for name in names}


def message_arguments(node: ast.Call) -> set[str] | None:
    arguments = node.args[1] if len(node.args) > 1 else None
    if arguments is None:
        return None if node.keywords else set()
    if not isinstance(arguments, ast.Dict) or not all(isinstance(key, ast.Constant) for key in arguments.keys):
        return None
    return {str(key.value) for key in arguments.keys if isinstance(key, ast.Constant)}


@cache
def found() -> list[tuple[str, ast.Call, str, set[str] | None]]:
    """Such calls in every file."""
    return [(path.relative_to(ROOT).as_posix(), *call) for path in SOURCES for call in calls(path)]


def strings(*folders: str) -> set[str]:
    """Every text constant of the program."""
    return {
        node.value
        for path in SOURCES
        if path.relative_to(ROOT).parts[0] in folders
        for node in nodes(path)
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    }


def action_ids() -> set[str]:
    """Return the ids of rows in the tables of actions: they look like ids of messages but are none."""
    ids = set()
    shell = ROOT / "app" / "shell"
    for path in (*(shell / "commands").glob("*.py"), *shell.glob("*/actions.py")):
        for node in nodes(path):
            if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Name) or not node.args:
                continue
            if node.func.id not in ("Message", "AppError"):
                first = node.args[0]
                parts = first.values if isinstance(first, ast.JoinedStr) else [first]
                ids |= {part.value for part in parts if isinstance(part, ast.Constant) and isinstance(part.value, str)}
    return ids


def step_paths() -> set[str]:
    """Return the paths of attributes in tables of steps, which look like ids."""
    tables = [
        node
        for path in SOURCES
        for node in nodes(path)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "StepTable"
    ]
    values = [keyword.value for table in tables for keyword in table.keywords]
    return {value.value for value in values if isinstance(value, ast.Constant) and isinstance(value.value, str)}


ROOMS = {id.split(".")[0] for id in WORDINGS}


def fields(template: str) -> set[str]:
    return {name for _, name, _, _ in string.Formatter().parse(template) if name is not None}


def test_messages_are_found_at_all() -> None:
    assert len({id for _, _, id, _ in found()}) > 40


def test_every_id_has_a_template() -> None:
    """Ids may also be passed to other functions, so every string that looks like an id is checked."""
    handed_on = {
        string
        for string in strings("app", "widgets") - action_ids() - step_paths()
        if ID.fullmatch(string) and string.split(".")[0] in ROOMS and not string.endswith("_")
    }
    assert sorted(({id for _, _, id, _ in found()} | handed_on) - WORDINGS.keys()) == []


def test_no_template_is_left_over() -> None:
    # A reader of bytes puts its room before the word, f"fbx.{word}"; an edit of many names begins them all alike,
    # f"edit.parameter_{name}".
    begun = tuple(string for string in strings("app", "widgets") if ID.fullmatch(string) and string.endswith("_"))
    parameters = (*PARAMETERS.values(), *DANCER_PARAMETERS.values())
    written = strings(*FOLDERS) | {word for parameter in parameters for word in parameter.words}
    left_over = [
        id
        for id in WORDINGS
        if id not in written and id.split(".", 1)[1] not in written and not (begun and id.startswith(begun))
    ]
    assert left_over == []


def test_the_arguments_fill_the_templates() -> None:
    missing = [
        f"{path}:{call.lineno} {id}: {sorted(fields(WORDINGS[id][0]) - names)}"
        for path, call, id, names in found()
        if names is not None and id in WORDINGS and not fields(WORDINGS[id][0]) <= names
    ]
    assert missing == []


def test_no_template_counts_bars_and_beats_by_itself() -> None:
    """A position is formatted by the score's metre map as 12.1.096 and passed as a whole."""
    assert [id for id, wording in WORDINGS.items() if fields(wording[0]) & {"bar", "beat", "tick_in_bar"}] == []


@pytest.mark.parametrize(
    ("count", "reported"),
    [(0, "Move 0 Notes (I)"), (1, "Move 1 Note (I)"), (2, "Move 2 Notes (I)"), (21, "Move 21 Notes (I)")],
)
def test_one_is_not_many(count: int, reported: str) -> None:
    assert text(Message("edit.move_notes", {"count": count, "of": "I"})) == reported


def test_no_template_counts_one_of_many() -> None:
    """No message has a plural with the number one, such as "1 notes"."""
    for id, (template, _) in WORDINGS.items():
        if "count" in fields(template):
            arguments = dict.fromkeys(fields(template), 2) | {"count": 1}
            assert not re.search(r"\b1 (?!ms\b)\w+s\b", text(Message(id, arguments))), id


def test_every_part_that_touches_has_a_name_in_both_languages() -> None:
    for language in LANGUAGES:
        names = [touch_name(part, language) for part in sorted(PARTS)]
        assert len(set(names)) == len(PARTS)
        assert not any("." in name for name in names)
    message = Message("contact.grip_off", {"touch": "left.index.side_proximal", "gap_mm": 3})
    assert text(message).startswith("the side of the proximal phalanx of the left index finger")
    assert "左手の人差し指の基節の側面" in text(message, "ja")
    assert touch_name("left.paw", "en") == "left.paw"


@pytest.mark.parametrize(
    ("template", "value", "filled_in"),
    [
        ("{mark}を追加", "強弱記号 mf", "強弱記号 mf を追加"),
        ("{mark}を追加", "スラー", "スラーを追加"),
        ("{player} を追加", "フルート", "フルートを追加"),
        ("{player} を追加", "Trumpet 1", "Trumpet 1 を追加"),
        ("合図で{player}を入らせる", "Oboe", "合図で Oboe を入らせる"),
        ("第 {bar} 小節", "5", "第 5 小節"),
        ("（{pitch}）", "B♭", "（B♭）"),
        ("{a} {b}", "笛", "笛 笛"),
        ("{a} を持つ", "トランペット（B♭管）", "トランペット（B♭管）を持つ"),
        ("Add {player} now", "笛", "Add 笛 now"),
        ("{note}の音", "B♭", "B♭ の音"),
    ],
)
def test_what_is_filled_into_japanese_is_spaced_alike(template: str, value: str, filled_in: str) -> None:
    fields = dict.fromkeys(("mark", "player", "bar", "pitch", "a", "b", "note"), value)
    assert filled(template, fields) == filled_in
