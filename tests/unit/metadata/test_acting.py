"""Bundled styles, habits, gestures and rules are valid, and an invalid one is refused with its exact place."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from app.errors import MapError
from app.plan.acting import LAYERS, Acting
from app.plan.parameters import PARAMETERS
from metadata.acting import AMOUNTS, SECTION_PLAYER, Factors, as_text, names_in, read_habit, read_style
from metadata.gestures import read_gesture
from metadata.library import FOLDERS, READERS, metadata_library
from metadata.rules import When, read_rules
from metadata.tables import ROOT, Title

STYLE = 'name = "mine"\ntitle = { en = "Mine" }\ndescription = { en = "" }\n'
HABIT = STYLE + "[factors]\nsway = 2.0\n"
GESTURE = """name = "mine"
title = { en = "Mine", ja = "自分の" }
length_s = 1.0

[[tracks]]
target = "head"
turn = "up"
keys = [{ at = 0.0, deg = 0.0 }, { at = 0.5, deg = 10.0 }, { at = 1.0, deg = 0.0 }]
"""
RULES = """name = "mine"
description = ""

[[rules]]
name = "loud"
when = { loudness_above = 0.8 }
do = { expression = "strained", grows_with = "loudness" }
"""


def test_the_bundled_ones_are_sound_and_a_section_player_changes_nothing() -> None:
    library = metadata_library()
    assert {"reserved", "soloist", "section_player", "marching_band", "jazz", "student"} <= set(library.styles.items)
    assert {"nodder", "swayer", "stone_face", "tapper"} <= set(library.habits.items)
    for kind in ("styles", "habits", "gestures", "rules"):
        assert list((ROOT / kind).glob("*.toml")), kind
    assert library.styles.items[SECTION_PLAYER].factors == Factors()
    assert library.styles.items[SECTION_PLAYER].variation == 0.2
    assert PARAMETERS["style"].default == SECTION_PLAYER
    for table in (*library.styles.items.values(), *library.habits.items.values(), *library.gestures.items.values()):
        assert table.title.en  # type: ignore[attr-defined]
        assert table.title.ja  # type: ignore[attr-defined]
        assert table.description.en  # type: ignore[attr-defined]
        assert table.description.ja  # type: ignore[attr-defined]


def test_rules_name_what_there_is() -> None:
    library = metadata_library()
    for rule in library.all_rules:
        assert not rule.do.expression or rule.do.expression in library.expressions_by_name
        assert not rule.do.gesture or rule.do.gesture in library.gestures.items
        assert set(rule.when.styles) <= set(library.styles.items)
        assert set(rule.when.habits) <= set(library.habits.items)


def test_every_amount_is_a_parameter_and_decides_a_layer() -> None:
    assert set(AMOUNTS) <= set(PARAMETERS)
    assert {LAYERS.get(name, name) for name in AMOUNTS} == set(Acting.__struct_fields__)


def test_habits_as_a_text() -> None:
    assert names_in(" tapper, nodder,,tapper ") == ("nodder", "tapper")
    assert names_in("") == ()
    assert as_text(("tapper", "nodder", "tapper")) == "nodder,tapper"


def test_a_title_without_japanese_is_the_english_one() -> None:
    assert Title("Mine").in_language("ja") == "Mine"
    assert Title("Mine", "自分の").in_language("ja") == "自分の"
    assert Title("Mine", "自分の").in_language("en") == "Mine"


@pytest.mark.parametrize(
    ("read", "text", "wrong", "instead", "place", "detail"),
    [
        (read_style, STYLE, '"mine"', '"yours"', "name", "not the file's name"),
        (read_style, STYLE, 'en = "Mine"', 'en = " "', "title.en", "name on one line"),
        (read_style, STYLE, 'description = { en = "" }', 'variation = 0.7', "variation", "<= 0.5"),
        (read_style, STYLE + "[factors]\nsway = 1.0\n", "sway = 1.0", "sway = -1.0", "factors.sway", ">= 0.0"),
        (read_style, STYLE + "[factors]\nsway = 1.0\n", "sway = 1.0", "swai = 1.0", "factors", "swai"),
        (read_habit, HABIT, "sway = 2.0", "sway = 1.0", "factors", "other than 1"),
        (read_gesture, GESTURE, '"up"', '"down"', "tracks[0].turn", "down"),
        (read_gesture, GESTURE, '"head"', '"left_elbow"', None, ""),
        (read_gesture, GESTURE, "deg = 10.0", "deg = 100.0", "tracks[0].keys[1].deg", "45"),
        (read_gesture, GESTURE, "at = 1.0, deg = 0.0", "at = 1.0, deg = 1.0", "tracks[0].keys[2].deg", "must be 0"),
        (read_gesture, GESTURE, "at = 0.0", "at = 0.1", "tracks[0].keys[0].at", "must be 0"),
        (read_gesture, GESTURE, "at = 0.5", "at = 0.0", "tracks[0].keys[1].at", "after the key before"),
        (read_gesture, GESTURE, "length_s = 1.0", "length_s = 0.1", "length_s", "0.3"),
        (read_gesture, GESTURE, "length_s = 1.0", "length_s = 1.0\namplitude = [1, 0.5, 1]", "amplitude", "not fall"),
        (read_rules, RULES, '"loud"', '"so loud"', "rules[0].name", "underscores"),
        (read_rules, RULES, "loudness_above", "loudness", "rules[0].when", "loudness"),
        (read_rules, RULES, "loudness_above = 0.8", "loudness_above = 1.8", "rules[0].when.loudness_above", "1.0"),
        (read_rules, RULES, "loudness_above = 0.8", "accent = 0.1", "rules[0].do.grows_with", "when.loudness_above"),
        (read_rules, RULES, "{ loudness_above = 0.8 }", "{}", "rules[0].do.grows_with", "loudness_above"),
        (read_rules, RULES, 'expression = "strained"', 'strength = 1.0', "rules[0].do", "expression or a gesture"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_reported_with_file_and_key(
    tmp_path: Path, read: Callable[[Path], object], text: str, wrong: str, instead: str, place: str | None, detail: str
) -> None:
    path = tmp_path / "things" / "mine.toml"
    path.parent.mkdir()
    path.write_text(text, encoding="utf-8")
    read(path)
    assert text.count(wrong) >= 1
    path.write_text(text.replace(wrong, instead), encoding="utf-8")
    if place is None:
        read(path)
        return
    with pytest.raises(MapError) as raised:
        read(path)
    said = raised.value.message
    assert said.id == "table.invalid"
    assert (said.arguments["file"], said.arguments["place"]) == ("things/mine.toml", place)
    assert detail in str(said.arguments["detail"])


def test_a_syntax_error_has_line_and_column(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(STYLE + "[factors\n", encoding="utf-8")
    with pytest.raises(MapError) as raised:
        read_style(path)
    assert raised.value.message.id == "table.syntax"
    assert raised.value.message.arguments["line"] == 4


def test_the_users_own_win_over_ours_and_come_back_when_they_go(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for folder in FOLDERS:
        monkeypatch.setenv(folder.variable, str(tmp_path / folder.name))
        monkeypatch.setattr(folder, "last", None)
    ours = metadata_library()
    (tmp_path / "styles").mkdir()
    mine = tmp_path / "styles" / "jazz.toml"
    mine.write_text(STYLE.replace('"mine"', '"jazz"') + "[factors]\nsway = 2.0\n", encoding="utf-8")
    from metadata.library import reload_metadata

    own = reload_metadata()
    assert not own.is_still(ours)
    assert own.habits is ours.habits
    assert own.styles.items["jazz"].factors.sway == 2.0
    mine.write_text("name = 1\n", encoding="utf-8")
    broken = reload_metadata()
    assert broken.styles.items["jazz"].factors.sway == 2.0, "the last good version stays"
    assert [path.name for path in broken.problems] == ["jazz.toml"]
    mine.unlink()
    assert reload_metadata().styles.items["jazz"] == ours.styles.items["jazz"]
    (tmp_path / "rules").mkdir()
    rules = tmp_path / "rules" / "zz.toml"
    rules.write_text(RULES.replace('"mine"', '"zz"').replace('"loud"', '"soloist_end"'), encoding="utf-8")
    ruled = {rule.name: rule for rule in reload_metadata().all_rules}
    assert ruled["soloist_end"].when.loudness_above == 0.8
    assert len(ruled) == len(ours.all_rules)


def test_the_users_expressions_are_called_as_they_say(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from metadata.library import EXPRESSIONS

    monkeypatch.setenv(EXPRESSIONS.variable, str(tmp_path))
    monkeypatch.setattr(EXPRESSIONS, "last", None)
    text = (ROOT / "expressions" / "smile.toml").read_text(encoding="utf-8")
    (tmp_path / "strained.toml").write_text(text.replace('"smile"', '"Big grin"'), encoding="utf-8")
    found = metadata_library().expressions_by_name
    assert "Big grin" in found
    assert found["strained"].name == "strained"


def test_the_guides_examples_are_sound(tmp_path: Path) -> None:
    guide = (ROOT.parent / "docs" / "metadata.md").read_text(encoding="utf-8")
    found = re.findall(r"`(\w+)/(\w+)\.toml`\n.*?```toml\n(.*?)```", guide, re.DOTALL)
    assert sorted(folder for folder, _, _ in found) == ["expressions", "gestures", "rules", "styles"]
    for folder, name, text in found:
        path = tmp_path / folder / f"{name}.toml"
        path.parent.mkdir()
        path.write_text(text, encoding="utf-8")
        READERS[folder](path)
    said = {field for field in When.__struct_fields__ if f"`{field}`" in guide}
    assert said == set(When.__struct_fields__), "the guide has every condition"
    acting = (ROOT.parent / "docs" / "acting.md").read_text(encoding="utf-8")
    assert all(f"`{name}`" in acting for name in AMOUNTS)
