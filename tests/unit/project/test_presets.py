"""The user's presets and expressions, with any names and any other files in the folder."""

from __future__ import annotations

import tomllib
from pathlib import Path

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.errors import AppError, UsageError
from app.formats.toml import toml
from app.messages import text
from app.plan.parameters import PlayerParameters
from app.project import presets
from app.project.edit.players import set_parameters
from metadata.load import read_expression
from tests.unit.project.pieces import ANGRY, small_project

LIVELY = PlayerParameters(amplitude=0.9, sway=1.7, posture="seated", seed=5, cue_leader=True)


def test_there_and_back(tmp_path: Path) -> None:
    folder = tmp_path / "config" / "presets"
    assert presets.presets(folder).items == {}
    preset = presets.preset_of(LIVELY, " Lively\n")
    presets.save_preset(folder, preset)
    found = presets.presets(folder)
    assert found.items == {"Lively": preset}
    assert found.problems == ()
    # Parameters that distinguish players are not part of presets.
    assert preset.parameters.keys().isdisjoint({"seed", "cue_leader"})
    project = set_parameters(small_project(), ["1.1.1", "2.1.1"], **preset.parameters)
    assert {(one.parameters.amplitude, one.parameters.posture) for one in project.players} == {(0.9, "seated")}
    presets.delete_preset(folder, "Lively")
    assert list(folder.iterdir()) == []
    with pytest.raises(UsageError):
        presets.delete_preset(folder, "Lively")


@pytest.mark.parametrize("choreography", ["salsa", "/dances/tango.choreography", "/dances/\udcff.choreography", ""])
def test_what_is_danced_is_shared_and_the_variation_is_not(tmp_path: Path, choreography: str) -> None:
    preset = presets.preset_of(PlayerParameters(choreography=choreography, dance_variation=3), "Dances")
    assert "dance_variation" not in preset.parameters
    presets.save_preset(tmp_path, preset)
    assert presets.presets(tmp_path).items["Dances"].parameters["choreography"] == choreography


def test_a_preset_whose_choreography_can_be_none_is_refused(tmp_path: Path) -> None:
    presets.save_preset(tmp_path, presets.preset_of(LIVELY, "Dances"))
    [path] = tmp_path.iterdir()
    path.write_text(path.read_text().replace('choreography = ""', 'choreography = "../tango.choreography"'))
    found = presets.presets(tmp_path)
    assert not found.items
    assert [problem.id for problem in found.problems] == ["table.invalid"]


def test_only_some_parameters(tmp_path: Path) -> None:
    preset = presets.Preset("breath", {"lung_s": LIVELY.lung_s, "breath_min_beats": LIVELY.breath_min_beats})
    presets.save_preset(tmp_path, preset)
    assert presets.presets(tmp_path).items["breath"] == preset


@pytest.mark.parametrize(
    "name", ["../../evil", "con", "a/b", 'say "hi"\\', "[table]", "#", "小さく", ".hidden", "🎺", "a\x7fb"]
)
def test_names_are_data_and_never_paths(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "presets"
    preset = presets.preset_of(LIVELY, name)
    presets.save_preset(folder, preset)
    presets.save_expression(tmp_path / "faces", msgspec.structs.replace(ANGRY, name=name))
    assert list(presets.presets(folder).items) == [preset.name]
    assert list(presets.expressions(tmp_path / "faces").items) == [preset.name]
    assert {path.name for path in tmp_path.iterdir()} == {"presets", "faces"}
    assert len(list(folder.iterdir())) == 1


def test_names_whose_files_would_be_one(tmp_path: Path) -> None:
    for name in ("a:b", "a/b", "A?B", "a:b"):
        presets.save_preset(tmp_path, presets.preset_of(LIVELY, name))
    assert set(presets.presets(tmp_path).items) == {"a:b", "a/b", "A?B"}
    assert len(list(tmp_path.iterdir())) == 3


def test_a_name_must_be_seen() -> None:
    with pytest.raises(UsageError):
        presets.preset_of(LIVELY, " \u0000 ")


@pytest.mark.parametrize(
    "content",
    [
        b"", b"name =", b'name = ""', b'name = "a\\nb"', b'name = "x"\nsway = 99.0', b'name = "x"\nsway = "a"',
        b'name = "x"\nseed = 1', b'name = "x"\nmagic = 1', b'name = "x"\nposture = "lying"', b"\xff\xfe", b"name = 5",
        b"a" * 100, b"x = " + b"[" * 5000,
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_file_is_reported_and_the_others_are_there(tmp_path: Path, content: bytes) -> None:
    presets.save_preset(tmp_path, presets.preset_of(LIVELY, "good"))
    (tmp_path / "bad.toml").write_bytes(content)
    found = presets.presets(tmp_path)
    assert list(found.items) == ["good"]
    assert [message.arguments["file"] for message in found.problems] == ["bad.toml"]
    assert all(text(message) for message in found.problems)


def test_expressions_are_metadata(tmp_path: Path) -> None:
    presets.save_expression(tmp_path, ANGRY)
    # The same form as the bundled ones.
    assert read_expression(tmp_path / "angry.toml") == ANGRY
    changed = msgspec.structs.replace(ANGRY, weights={"jawOpen": 0.25})
    presets.save_expression(tmp_path, changed)
    assert presets.expressions(tmp_path).items == {"angry": changed}
    (tmp_path / "bad.toml").write_text('name = "bad"\nweights = 3\n')
    assert len(presets.expressions(tmp_path).problems) == 1
    presets.delete_expression(tmp_path, "angry")
    assert presets.expressions(tmp_path).items == {}
    for wrong in ({"name": ""}, {"weights": {"x": 1.0}}):
        with pytest.raises(AppError):
            presets.save_expression(tmp_path, msgspec.structs.replace(ANGRY, **wrong))


def test_a_folder_that_cannot_be_used(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(AppError, match=r"file\.cannot_write"):
        presets.save_preset(tmp_path / "file" / "presets", presets.preset_of(LIVELY, "x"))
    assert presets.presets(tmp_path / "file").items == {}


@given(
    st.dictionaries(
        st.text(st.characters(exclude_categories=["Cs"]), min_size=1),
        st.text(st.characters(exclude_categories=["Cs"])) | st.integers(-(2**63), 2**63 - 1) | st.booleans()
        | st.floats(allow_nan=False, allow_infinity=False),
        max_size=5,
    )
)  # fmt: skip
@settings(max_examples=200, deadline=None)
def test_tables_are_toml(table: dict[str, object]) -> None:
    assert tomllib.loads(toml({"plain": 1, "more": table})) == {"plain": 1, "more": table}
    assert tomllib.loads(toml(table)) == table
