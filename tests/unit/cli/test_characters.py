"""`suisou characters`: printed reports of figures, corrections, adding."""

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.cli import main
from app.cli.characters import joints_of, morphs_of
from app.errors import MapError, UsageError
from app.rig.characters import character_library, figure_build, load_character
from app.rig.characters.character_library import FOLDER_VARIABLE, characters
from app.rig.characters.joint_mapping import JointMapping, map_joints
from app.rig.figure import Figure
from app.rig.people.looks_by_age import colors_by_age
from instrument_maps.library import find_map, model_path
from tests.support.wardrobe import wardrobe_in, write_outfit

DATA = Path(__file__).parents[2] / "data" / "characters"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    own = tmp_path / "characters"
    monkeypatch.setenv(FOLDER_VARIABLE, str(own))
    monkeypatch.setattr(character_library.LIBRARY, "last", None)
    return own


@pytest.mark.parametrize(
    "name", ["child_mixamo.fbx", "elder_vrm0.vrm", "toddler_vrm1.vrm", "woman_game_engine.glb", "man_cmu.fbx"]
)
def test_a_figure_that_we_did_not_make_can_play(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["characters", "check", str(DATA / name), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["plays"]
    assert not found["required_joints"]
    assert {"hips", "head", "leftHand", "rightFoot"} <= set(found["joints"])
    assert main(["characters", "check", str(DATA / name)]) == 0
    printed = capsys.readouterr().out
    for bone in found["joints"].values():
        assert bone in printed
    assert ("none of the shapes (52) is made by a morph" in printed) == (not found["morphs"])


def test_what_lacks_a_joint_cannot_play_and_says_which(capsys: pytest.CaptureFixture[str]) -> None:
    file = str(DATA / "child_mixamo.fbx")
    assert main(["characters", "check", file, "--joint", "leftHand="]) == 1
    assert "leftHand" in capsys.readouterr().out.splitlines()[-1]
    assert main(["characters", "add", file, "--joint", "leftHand="]) == 1
    assert main(["characters", "check", file, "--joint", "leftHand=no such bone"]) == 1
    assert "no such bone" in capsys.readouterr().err


def test_a_correction_is_kept_with_the_character(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = str(DATA / "toddler_vrm1.vrm")
    given = ["--name", "The Baby", "--joint", "leftEye=", "--morph", "jawOpen=Fcl_MTH_A:0.5+Fcl_MTH_O:0.25"]
    assert main(["characters", "add", file, *given]) == 0
    assert capsys.readouterr().out.strip() == "the_baby"
    assert "the_baby" in characters()
    entry = character_library.character_library().own["the_baby"]
    assert entry.joints == {"leftEye": ""}
    assert entry.morphs == {"jawOpen": {"Fcl_MTH_A": 0.5, "Fcl_MTH_O": 0.25}}
    character = character_library.character_named("the_baby")
    assert character.own.bone_of_joint[character.skeleton.index("leftEye")] == -1
    assert character.own.morphs["jawOpen"] == {"Fcl_MTH_A": 0.5, "Fcl_MTH_O": 0.25}
    assert main(["characters"]) == 0
    printed = capsys.readouterr().out
    assert "the_baby*" in printed
    assert "The Baby" in printed
    assert str(folder) in printed
    assert main(["characters", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [row["id"] for row in found["characters"] if row["own"]] == ["the_baby"]


def test_outfits_are_listed_with_their_colours_and_unknown_ones_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_outfit(tmp_path / "test_suit.glb")
    with wardrobe_in(tmp_path):
        assert main(["characters", "--json"]) == 0
        (suit,) = json.loads(capsys.readouterr().out)["outfits"]
        assert (suit["id"], suit["title"], [*suit["colours"]]) == ("test_suit", "Test suit", ["main", "second"])
        assert main(["characters"]) == 0
        assert f"test_suit                  Test suit (main {suit['colours']['main']}" in capsys.readouterr().out
        quartet = str(Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid")
        assert main(["inspect", quartet, "--no-contacts", "--outfit", "sailor"]) == 2
        assert "own, test_suit" in capsys.readouterr().err
        assert main(["inspect", quartet, "--no-contacts", "--outfit", "*1=test_suit,#8a1b2c"]) == 0


def test_what_is_odd_in_a_file_is_said_when_it_is_added(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(figure_build, "TALLEST_M", 1.2)
    file = str(DATA / "woman_game_engine.glb")
    assert main(["characters", "add", file, "--name", "tall"]) == 0
    assert "is 1.53" in capsys.readouterr().err
    assert main(["characters", "add", file, "--name", "as told", "--height", "1.1"]) == 0
    assert capsys.readouterr().err == ""


def test_joints_in_doubt_are_said_when_a_character_is_added(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def doubting(figure: Figure, requested: Mapping[str, str] | None = None) -> JointMapping:
        return replace(map_joints(figure, requested), doubtful=("leftHand",))

    monkeypatch.setattr(load_character, "map_joints", doubting)
    assert main(["characters", "add", str(DATA / "woman_game_engine.glb"), "--name", "guessed"]) == 0
    assert "joints in doubt: leftHand (hand_l);" in capsys.readouterr().err


def test_of_a_refused_figure_found_by_shape_no_joint_is_listed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    guessed = JointMapping("", {"hips": 0, "spine": 1}, ("head",), ("hips", "spine"))
    monkeypatch.setattr(load_character, "map_joints", lambda figure, requested: guessed)
    file = str(DATA / "woman_game_engine.glb")
    assert main(["characters", "check", file, "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert (found["joints"], found["doubtful_joints"], found["missing_joints"]) == ({}, [], [])
    assert "leftHand" in found["required_joints"]
    assert main(["characters", "check", file]) == 1
    assert "by shape" not in capsys.readouterr().out


def test_a_person_is_made_and_ours_are_named(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = ["--like", "cast_thomas", "--height", "1.71", "--age", "40", "--weight", "70"]
    assert main(["characters", "make", "Tom", *given]) == 0
    assert capsys.readouterr().out.strip() == "tom"
    person = character_library.character_library().own["tom"].person
    assert person is not None
    assert (person.phenotype.height_m, person.phenotype.weight, person.phenotype.muscle) == (1.71, 0.7, 0.55)
    assert main(["characters", "--json"]) == 0
    rows = {row["id"]: row for row in json.loads(capsys.readouterr().out)["characters"]}
    assert (rows["tom"]["title"], rows["cast_thomas"]["title"]) == ("Tom", "Thomas")
    assert (rows["tom"]["names"], rows["cast_thomas"]["names"]) == ({}, {"en": "Thomas", "ja": "トーマス"})
    assert all(row["title"] and len(row["names"]) == 2 for row in rows.values() if not row["own"])
    assert main(["characters"]) == 0
    assert "Hina / 陽菜" in capsys.readouterr().out
    assert main(["characters", "make", "Tom", "--like", "tom"]) == 2


def test_a_person_s_hair_follows_the_age_or_is_kept(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, further in (("Old", []), ("Dyed", ["--keep-looks"])):
        assert main(["characters", "make", name, "--like", "cast_thomas", "--age", "80", *further]) == 0
    old, dyed = (character_library.character_library().own[id].person for id in ("old", "dyed"))
    assert old is not None
    assert dyed is not None
    assert colors_by_age(dyed)["hair"] == dyed.colors["hair"] == old.colors["hair"]
    assert min(colors_by_age(old)["hair"]) > 0.35


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["--like", "child_nia", "--age", "30"], "--age: an age in years from 11 to 15 for people like child_nia"),
        (["--like", "cast_thomas", "--age", "7"], "--age: an age in years from 15 to 90 for people like cast_thomas"),
        (["--like", "cast_aiko", "--height", "1.35"], "--height: a height in metres from 1.4 to 2.1"),
    ],
)
def test_measures_are_refused_in_the_units_and_the_range_of_the_person(
    folder: Path, given: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["characters", "make", "Tom", *given]) == 2
    assert said in capsys.readouterr().err
    assert list(folder.glob("*.toml")) == []


def test_instruments_that_a_made_person_is_too_small_for_are_named(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.performance.bodies.strained_on", lambda character, person: ("flute", "oboe"))
    assert main(["characters", "make", "Kid", "--like", "child_nia"]) == 0
    printed = capsys.readouterr()
    assert printed.out.strip() == "kid"
    assert printed.err.strip().endswith("wrists of this body would bend too far with: Flute, Oboe")


def test_a_mesh_without_a_skeleton_is_refused_with_a_remedy(capsys: pytest.CaptureFixture[str]) -> None:
    """A list of every joint that is missing would not help."""
    file = str(model_path(find_map("flute")))
    assert main(["characters", "check", file]) == 1
    printed = capsys.readouterr().out
    assert "Rig it first" in printed
    assert "leftHand" not in printed
    assert main(["characters", "add", file]) == 1
    assert "rig it first" in capsys.readouterr().err


def test_a_file_that_is_no_figure_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "x.vrm").write_bytes(b"glTF")
    assert main(["characters", "check", str(tmp_path / "x.vrm")]) == 1
    assert "x.vrm" in capsys.readouterr().err
    assert main(["characters", "add", str(tmp_path / "absent.fbx")]) == 1


def test_corrections_are_read() -> None:
    assert joints_of(["leftHand=Wrist=L", "jaw="]) == {"leftHand": "Wrist=L", "jaw": ""}
    assert morphs_of(["jawOpen=a:b:0.5+c", "tongueOut="]) == {"jawOpen": {"a:b": 0.5, "c": 1.0}, "tongueOut": {}}
    for wrong in ("leftHand", "=x"):
        with pytest.raises(UsageError):
            joints_of([wrong])
    with pytest.raises(UsageError):
        morphs_of(["jawOpen=a:b"])


def test_a_character_is_as_tall_as_requested(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = str(DATA / "child_mixamo.fbx")
    assert main(["characters", "check", file, "--json"]) == 0
    own_m = json.loads(capsys.readouterr().out)["height_m"]
    assert main(["characters", "check", file, "--height", "2", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["height_m"] == pytest.approx(2.0)
    for title, height in (("small", []), ("tall", ["--height", str(2.0 * own_m)])):
        assert main(["characters", "add", file, "--name", title, *height]) == 0
    assert (folder / "tall.toml").read_text().count("height_m") == 1
    assert "height_m" not in (folder / "small.toml").read_text()
    small, tall = (character_library.character_named(id) for id in ("small", "tall"))
    np.testing.assert_allclose(tall.skeleton.offsets_m, 2.0 * small.skeleton.offsets_m, atol=1e-4)
    assert small.own is not None
    assert tall.own is not None
    np.testing.assert_allclose(tall.own.figure.translations_m, 2.0 * small.own.figure.translations_m, atol=1e-4)


@pytest.mark.parametrize("height", ["0", "0.1", "170", "nan", "tall"])
def test_a_height_that_nobody_has_is_refused(height: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["characters", "check", str(DATA / "child_mixamo.fbx"), "--height", height]) == 2
    assert "--height" in capsys.readouterr().err


def test_an_odd_height_in_a_description_is_reported(folder: Path) -> None:
    folder.mkdir()
    (folder / "one.fbx").write_bytes((DATA / "child_mixamo.fbx").read_bytes())
    (folder / "one.toml").write_text('file = "one.fbx"\nheight_m = -2.0\n')
    with pytest.raises(MapError, match="height_m"):
        character_library.read_entry(folder / "one.toml")
