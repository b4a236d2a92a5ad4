"""Edits of a table of fingerings, and the file that stores only the changes."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from app.errors import MapError, UsageError
from instrument_maps import fingering_table as edit
from instrument_maps.load import bundled_maps, load_map
from tests.support.pipe import add

TRUMPET = bundled_maps()["trumpet_Bb"]
TROMBONE = bundled_maps()["trombone_tenor_F_attachment"]
D5 = 74


def labels(table: edit.Table, written: int) -> list[str]:
    own = edit.of_pitch(table, written)
    assert [one.rank for one in own] == list(range(1, len(own) + 1))
    return [one.label for one in own]


def test_labels_are_read_as_they_are_typed(tmp_path: Path) -> None:
    assert edit.read_label(TRUMPET, " 1 3 ") == ("13", {"valve_1": 1.0, "valve_3": 1.0})
    assert edit.read_label(TRUMPET, "0") == edit.read_label(TRUMPET, "") == ("0", {})
    assert edit.read_label(TROMBONE, "t1")[0] == "T1"
    label, values = edit.read_label(TROMBONE, "4")
    assert label == "4"
    assert values["slide"] == pytest.approx(0.424, abs=0.02)
    pipe = load_map(add(tmp_path))
    assert edit.read_label(pipe, "r1 t L2 l1h")[0] == "L1h L2 R1 T"
    assert edit.read_label(pipe, "open") == ("(open)", {})
    for instrument, text, id in (
        (TRUMPET, "14", "fingering.unknown_sign"),
        (pipe, "L1 X", "fingering.unknown_sign"),
        (TROMBONE, "9", "fingering.unknown_place"),
    ):
        with pytest.raises(UsageError) as caught:
            edit.read_label(instrument, text)
        assert caught.value.message.id == id


def test_what_is_pressed_next_is_in_the_label(tmp_path: Path) -> None:
    open_valves = next(one for one in TRUMPET.fingerings if one.label == "0")
    assert edit.pressed_label(TRUMPET, open_valves, "valve_2") == "2"
    second = next(one for one in TRUMPET.fingerings if one.label == "12")
    assert edit.pressed_label(TRUMPET, second, "valve_2") == "1"
    first = next(one for one in TRUMPET.fingerings if one.label == "1")
    assert edit.pressed_label(TRUMPET, first, "valve_1") == "0"
    # The slide stays where it is.
    place = next(one for one in TROMBONE.fingerings if one.label == "6")
    trigger = next(control.name for control in TROMBONE.controls if control.label == "T")
    assert edit.pressed_label(TROMBONE, place, trigger) == "T6"
    # A hole: open, closed, half open.
    pipe = load_map(add(tmp_path))
    closed = next(one for one in pipe.fingerings if "L1" in one.label.split())
    hole = next(control.name for control in pipe.controls if control.label == "L1")
    assert "L1h" in edit.pressed_label(pipe, closed, hole).split()


def test_ranks_follow_what_is_moved_added_and_removed() -> None:
    table = TRUMPET.fingerings
    before = labels(table, D5)
    more = edit.added(TRUMPET, table, D5, "123")
    assert labels(more, D5) == [*before, "123"]
    first = edit.moved(more, D5, len(before) + 1, -len(before))
    assert labels(first, D5) == ["123", *before]
    assert labels(edit.removed(first, D5, 1), D5) == before
    assert edit.moved(table, D5, 1, -1) is table
    assert edit.reverted(first, table, D5) == table
    assert edit.problems_of(TRUMPET, edit.moved(table, D5, 1, 1)) == ()
    with pytest.raises(UsageError, match="twice"):
        edit.added(TRUMPET, table, D5, before[0])
    lone = next(one.written_pitch for one in table if len(edit.of_pitch(table, one.written_pitch)) == 1)
    with pytest.raises(UsageError, match="last"):
        edit.removed(table, lone, 1)


def test_what_sounds_wrong_is_a_problem_at_once() -> None:
    table = edit.with_label(TRUMPET, TRUMPET.fingerings, 60, 1, "2")
    assert any("harmonic" in detail for _, detail in edit.problems_of(TRUMPET, table))
    assert edit.problems_of(TRUMPET, edit.with_cents(TRUMPET.fingerings, 60, 1, 900.0))


def test_only_what_changed_is_written(tmp_path: Path) -> None:
    table = edit.with_tags(edit.moved(TRUMPET.fingerings, D5, 1, 1), D5, 1, ("fast", "fast", " "))
    path = edit.save_own(TRUMPET, table, tmp_path / "new" / "folder")
    said = tomllib.loads(path.read_text("utf-8"))
    assert set(said) == {"extends", "id", "fingerings"}
    assert {row["written_pitch"] for row in said["fingerings"]} == {D5}
    assert all("controls" not in row for row in said["fingerings"])
    assert load_map(path).fingerings == table
    # A change back to the bundled map's value leaves no difference to store.
    assert edit.base_table(TRUMPET, path) == TRUMPET.fingerings
    assert edit.save_own(load_map(path), TRUMPET.fingerings, path.parent) is None
    assert not path.exists()


def test_a_slides_places_are_written_out(tmp_path: Path) -> None:
    table = edit.moved(TROMBONE.fingerings, 53, 1, 2)
    path = edit.save_own(TROMBONE, table, tmp_path)
    assert path is not None
    assert load_map(path).fingerings == table


OWN = """# Mine, with [brackets] in a comment.
extends = "trumpet_Bb"
id = "trumpet_Bb"
short_name = "My ] Tpt."   # a bracket in a text

fingerings = [  # what I play
  { written_pitch = 76, rank = 1, label = "12" },  # ] not the end
  { written_pitch = 76, rank = 2, label = "0", tags = ["alternate"] },
]

# How I hold it.
[name]
en = "Mine"
ja = "私の"
"""


def test_the_other_lines_of_a_users_file_stay(tmp_path: Path) -> None:
    path = tmp_path / "trumpet_Bb.toml"
    path.write_text(OWN, "utf-8")
    mine = load_map(path)
    table = edit.moved(mine.fingerings, D5, 1, 1)
    assert edit.save_own(mine, table, tmp_path) == path
    text = path.read_text("utf-8")
    for line in (
        "# Mine, with [brackets] in a comment.",
        'short_name = "My ] Tpt."   # a bracket in a text',
        "# How I hold it.",
        'ja = "私の"',
    ):
        assert line in text
    now = load_map(path)
    assert (now.fingerings, now.short_name, now.name.en) == (table, "My ] Tpt.", "Mine")
    assert edit.save_own(now, edit.base_table(now, path), tmp_path) == path
    assert load_map(path).fingerings == TRUMPET.fingerings
    assert "fingerings" not in tomllib.loads(path.read_text("utf-8"))


def test_a_file_that_says_it_in_another_way_is_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "trumpet_Bb.toml"
    text = 'extends = "trumpet_Bb"\nid = "trumpet_Bb"\n\n[[fingerings]]\nwritten_pitch = 76\nrank = 1\nlabel = "12"\n'
    path.write_text(text, "utf-8")
    mine = load_map(path)
    with pytest.raises(MapError) as caught:
        edit.save_own(mine, edit.moved(mine.fingerings, D5, 1, 1), tmp_path)
    assert caught.value.message.id == "map.not_rewritten"
    assert path.read_text("utf-8") == text


def test_a_file_that_was_broken_meanwhile_is_reported_and_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "trumpet_Bb.toml"
    text = 'extends = "trumpet_Bb"\nid = "trumpet_Bb\n'
    path.write_text(text, "utf-8")
    with pytest.raises(MapError) as caught:
        edit.save_own(TRUMPET, edit.moved(TRUMPET.fingerings, D5, 1, 1), tmp_path)
    assert caught.value.message.id == "table.syntax"
    assert caught.value.message.arguments["line"] == 2
    assert path.read_text("utf-8") == text


def test_a_map_that_stands_alone_keeps_all_its_fingerings(tmp_path: Path) -> None:
    path = add(tmp_path)
    pipe = load_map(path)
    table = edit.added(pipe, pipe.fingerings, 72, "L1 L2 T")
    assert edit.save_own(pipe, table, tmp_path) == path
    assert load_map(path).fingerings == table
    assert load_map(path).contacts == pipe.contacts
