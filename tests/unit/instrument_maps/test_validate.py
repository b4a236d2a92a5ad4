"""The loader refuses invalid maps with the exact place; the bundled maps are valid."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.errors import FileError, MapError
from instrument_maps import load
from instrument_maps.library import find_map
from instrument_maps.load import bundled_maps, check_map, load_map, model_path, named_map, parse_map

pytestmark = pytest.mark.slow

BUNDLED = sorted(path for path in load.FOLDER.glob("*.toml") if path.name not in load.NOT_MAPS)
TRUMPET = (load.FOLDER / "trumpet_Bb.toml").read_text("utf-8")
TROMBONE = (load.FOLDER / "trombone_tenor_F_attachment.toml").read_text("utf-8")


def refused(text: str, name: str = "trumpet_Bb.toml") -> dict[str, object]:
    with pytest.raises(MapError) as caught:
        parse_map(text, name)
    return {"id": caught.value.message.id, **caught.value.message.arguments}


@pytest.mark.parametrize("path", BUNDLED, ids=lambda path: path.stem)
def test_bundled_maps_have_no_problem(path: Path) -> None:
    assert check_map(path) == ()


def test_bundled_maps_by_id() -> None:
    assert list(bundled_maps()) == [path.stem for path in BUNDLED]
    assert all(find_map(id) is instrument for id, instrument in bundled_maps().items())
    assert all(model_path(instrument).is_file() for instrument in bundled_maps().values())


def test_unknown_map_is_named() -> None:
    with pytest.raises(MapError) as caught:
        find_map("serpent")
    assert caught.value.message.id == "map.unknown"
    assert caught.value.message.arguments == {"id": "serpent"}


@pytest.mark.parametrize(
    ("text", "line", "column"),
    [
        ('id = "a"\nname = {\n', 2, 9),
        ("schema_version = 1\nid = \n", 2, 6),
        ('a = 1\nb = "open', 2, 10),
        ("x = 1\nx = 2\n", 2, 6),
    ],
)
def test_syntax_errors_name_the_line(text: str, line: int, column: int) -> None:
    found = refused(text)
    assert found["id"] == "table.syntax"
    assert found["file"] == "trumpet_Bb.toml"
    assert found["line"] == line


def test_unreadable_files_are_our_errors(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"file\.cannot_read"):
        load_map(tmp_path / "none.toml")
    (tmp_path / "latin.toml").write_bytes(b'id = "\xe9"\n')
    assert [message.id for message in check_map(tmp_path / "latin.toml")] == ["table.not_utf8"]


@pytest.mark.parametrize(
    ("old", "new", "path", "detail"),
    [
        ('finger = "right.middle"', 'finger = "right.midle"', "controls[1].finger", "'right.midle' is not a finger"),
        ("schema_version = 1", "schema_version = 2", "schema_version", "2 is not 1"),
        ('id = "trumpet_Bb"', 'id = "../trumpet"', "id", "'../trumpet' is not a plain name"),
        ('en = "Trumpet in B♭"', f'en = "{"t" * 201}"', "name.en", "is longer than 200 characters"),
        (
            'label = "123", controls',
            'label = "12", controls',
            "fingerings[0].label",
            "does not name what the controls say",
        ),
        ('label = "0"', 'label = "9"', None, "'9' does not name what the controls say, '0'"),
        (
            "written_pitch = 54, rank",
            "written_pitch = 53, rank",
            "fingerings[0].controls",
            "written pitch 53 is no harmonic",
        ),
        ("travel_m = 0.0165", "travel_m = -0.0165", "controls[0].motion.travel_m", "-0.0165 m is not a travel"),
        ("axis = [0.0, -1.0, 0.0]", "axis = [0.0, -2.0, 0.0]", "controls[0].motion.axis", "has the length 2"),
        ('node = "valve_3"', 'node = "valve_2"', "controls[2].node", "'valve_2' is used twice"),
        ('used_with = ["12"]', 'used_with = ["21"]', "controls[3].used_with[0]", "no fingering is labelled '21'"),
        ('part = "right.ring.pad"', 'part = "right.toe.pad"', "contacts[2].part", "'right.toe.pad' is not a part of a"),
        ('plays = ["trumpet"]', 'plays = ["trumpett0"]', "plays[0]", "'trumpett0' is not in the vocabulary"),
        ("low = 52", "low = 51", "fingerings", "written pitch 53 (concert 51) has none"),
        ("high = 87 ", "high = 86 ", None, "is not in the range"),
        ("high = 87 ", "high = 128 ", "range", "high <= 127"),
        ('label = "123", controls = { valve_1', 'label = "123", controls = { valve_9', None, "valve_9"),
        ('rank = 2, label = "3"', 'rank = 4, label = "3"', "fingerings", "do not count from 1 without gaps"),
        (
            "pitch_down_deg = [-5.0, 8.0",
            "pitch_down_deg = [15.0, 8.0",
            "hold.standing.pitch_down_deg",
            "[lowest, usual",
        ),
        ("semitones = { valve_1", "semitones = { valve_7", "acoustics.semitones.valve_7", "no control named 'valve_7'"),
        ('kind = "cup"', 'kind = "cop"', "embouchure.kind", "Invalid enum value 'cop'"),
        ('kind = "cup"', 'kind = "cup"\nlips_appart_m = 0.0', "embouchure", "lips_appart_m"),
        ("travel_m = 0.0165", "travel = 0.0165", "controls[0].motion", "travel"),
        ("travel_m = 0.0165", 'travel_m = "far"', "controls[0].motion.travel_m", "Expected `float | null`, got `str`"),
        ("rank = 1, label", "rank = 1.5, label", "fingerings[0].rank", "Expected `int`, got `float`"),
        ('shape = "cylinder"', 'shape = "egg"', "proxy[", "Invalid value 'egg'"),
        ("[hold]", "[hold]\nsize_range = [0.8, 0.9]", "hold.size_range", "smallest <= 1 <= largest"),
        ("schema_version = 1", "schema_version = 1\nsize = 0.8", "size", "as large as its model"),
        ('grip = "firm"', 'grip = "guide"', "contacts[0].grip", "'guide' is for"),
    ],
)
def test_refusals_name_the_key_path(old: str, new: str, path: str | None, detail: str) -> None:
    assert old in TRUMPET
    text = TRUMPET.replace(old, new, 1)
    found = refused(text)
    assert found["id"] == "table.invalid"
    assert path is None or str(found["place"]).startswith(path)
    assert detail in f"{found['place']} {found['detail']}"


def test_a_map_may_be_checked_under_any_name_but_is_found_by_its_own(tmp_path: Path) -> None:
    copy = tmp_path / "draft.toml"
    copy.write_text(TRUMPET, "utf-8")
    assert check_map(copy) == ()
    assert load_map(copy).id == "trumpet_Bb"
    with pytest.raises(MapError) as caught:
        named_map(copy)
    assert caught.value.message.arguments["place"] == "id"


def test_check_finds_every_problem_at_once(tmp_path: Path) -> None:
    file = tmp_path / "trumpet_Bb.toml"
    text = TRUMPET.replace('finger = "right.index"', 'finger = "right.indx"', 1)
    text = text.replace('model = "trumpet_Bb.glb"', 'model = "trombone_tenor_F_attachment.glb"')
    file.write_text(text.replace("low = 52", "low = 51"), "utf-8")
    paths = [str(message.arguments["place"]) for message in check_map(file)]
    assert "controls[0].finger" in paths
    assert "fingerings" in paths
    # the trombone has no valves: the nodes are missed
    assert {f"controls[{k}].node" for k in range(5)} <= set(paths)


def test_missing_and_broken_models_are_problems_of_the_map(tmp_path: Path) -> None:
    file = tmp_path / "trumpet_Bb.toml"
    file.write_text(TRUMPET.replace('model = "trumpet_Bb.glb"', 'model = "none.glb"'), "utf-8")
    assert [message.arguments["place"] for message in check_map(file)] == ["model"]
    (tmp_path / "none.glb").write_bytes(b"glTF" + bytes(40))
    assert [message.arguments["place"] for message in check_map(file)] == ["model"]


def problem_of(text: str, name: str) -> MapError | None:
    try:
        parse_map(text, name)
    except MapError as error:
        return error
    return None


def test_an_unhurried_slide_is_not_faster_than_a_hurried_one() -> None:
    text = TROMBONE.replace("unhurried_speed_m_s = 0.9", "unhurried_speed_m_s = 2.6")
    assert "unhurried_speed_m_s" in str(refused(text, "trombone_tenor_F_attachment.toml"))


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.data())
def test_no_damage_escapes_as_another_error(data: st.DataObject) -> None:
    source, name = data.draw(st.sampled_from([(TRUMPET, "trumpet_Bb.toml"), (TROMBONE, "x.toml")]))
    start = data.draw(st.integers(0, 9000))
    end = start + data.draw(st.integers(0, 60))
    insert = data.draw(st.text(st.sampled_from('"[]{}=,.#\n -1aé\x00'), max_size=8))
    text = source[:start] + insert + source[end:]
    problem = problem_of(text, name)
    assert problem is None or problem.message.id in {"table.syntax", "table.invalid"}
    assert problem is None or problem.message.arguments["file"] == name
