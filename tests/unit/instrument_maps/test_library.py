"""The user's own instruments: found, combined with the bundled ones, read again, with the last valid version kept."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

import instrument_maps.library as module
from app.errors import MapError
from instrument_maps.library import FOLDER_VARIABLE, LIBRARY, all_maps, find_map, library, model_path, own_folder
from instrument_maps.load import MODELS, bundled_maps

CHANGED = 'extends = "trumpet_Bb"\nid = "trumpet_Bb"\nshort_name = "Mine"\n'
NEW = 'extends = "trumpet_Bb"\nid = "pocket_trumpet"\nname = { en = "Pocket trumpet", ja = "ポケットトランペット" }\n'


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    own = tmp_path / "own"
    own.mkdir()
    monkeypatch.setenv(FOLDER_VARIABLE, str(own))
    monkeypatch.setattr(module.LIBRARY, "last", None)
    return own


def write(path: Path, text: str) -> None:
    """Write a file with another time of modification than before."""
    before = path.stat().st_mtime_ns if path.exists() else 0
    path.write_text(text, "utf-8")
    os.utime(path, ns=(before + 10**9, before + 10**9))


def test_a_folder_that_is_not_there_holds_nothing(tmp_path: Path) -> None:
    found = LIBRARY.read(tmp_path / "none")
    assert dict(found.maps) == dict(bundled_maps())
    assert (found.own, found.problems) == ({}, {})


def test_own_maps_are_found_and_win(folder: Path) -> None:
    assert own_folder() == folder
    write(folder / "trumpet_Bb.toml", CHANGED)
    write(folder / "pocket_trumpet.toml", NEW)
    assert find_map("trumpet_Bb").short_name == "Mine"
    assert find_map("pocket_trumpet").name.en == "Pocket trumpet"
    assert list(all_maps()) == sorted({*bundled_maps(), "pocket_trumpet"})
    assert find_map("pocket_trumpet").fingerings == bundled_maps()["trumpet_Bb"].fingerings
    # The bundled maps are unchanged, and the bundled model is used if there is none beside the map.
    assert bundled_maps()["trumpet_Bb"].short_name != "Mine"
    assert model_path(find_map("trumpet_Bb")) == MODELS / "trumpet_Bb.glb"
    with pytest.raises(MapError) as caught:
        find_map("serpent")
    assert caught.value.message.id == "map.unknown"


def test_only_what_changed_is_another_object(folder: Path) -> None:
    write(folder / "trumpet_Bb.toml", CHANGED)
    write(folder / "pocket_trumpet.toml", NEW)
    first = library()
    assert module.reload() is first
    write(folder / "pocket_trumpet.toml", NEW + 'short_name = "Pkt."\n')
    second = module.reload()
    assert second.maps["trumpet_Bb"] is first.maps["trumpet_Bb"]
    assert second.maps["pocket_trumpet"].short_name == "Pkt."
    assert second.revisions == {"pocket_trumpet": 1}
    (folder / "trumpet_Bb.toml").unlink()
    third = module.reload()
    assert third.maps["trumpet_Bb"] is bundled_maps()["trumpet_Bb"]
    assert third.revisions == {"pocket_trumpet": 1, "trumpet_Bb": 1}


@pytest.mark.parametrize(
    ("text", "id", "place"),
    [
        ('extends = "trumpet_Bb"\nid = \n', "table.syntax", ("line", 2)),
        (CHANGED + "transposition_semitones = 90\n", "table.invalid", ("place", "transposition_semitones")),
        (CHANGED + 'nonsense = "x"\n', "table.invalid", ("place", "(top level)")),
        (CHANGED + 'model = "nothing.glb"\n', "table.invalid", ("place", "model")),
        (CHANGED.replace('id = "trumpet_Bb"', 'id = "other"'), "table.invalid", ("place", "id")),
    ],
)
def test_what_is_wrong_is_reported_exactly_and_the_last_good_version_stays(
    folder: Path, text: str, id: str, place: tuple[str, object]
) -> None:
    path = folder / "trumpet_Bb.toml"
    write(path, CHANGED)
    good = library()
    write(path, text)
    now = module.reload()
    (problem, *_) = now.problems[path]
    assert (problem.id, problem.arguments["file"], problem.arguments[place[0]]) == (id, str(path), place[1])
    assert now.maps["trumpet_Bb"] is good.maps["trumpet_Bb"]
    assert now.revisions == {}
    write(path, CHANGED)
    healed = module.reload()
    assert healed.problems == {}
    assert healed.maps["trumpet_Bb"] is good.maps["trumpet_Bb"]


def test_a_map_that_was_never_good_leaves_the_bundled_one(folder: Path) -> None:
    write(folder / "trumpet_Bb.toml", "id = ")
    write(folder / "kazoo.toml", 'id = "kazoo"')
    found = library()
    assert found.maps["trumpet_Bb"] is bundled_maps()["trumpet_Bb"]
    assert "kazoo" not in found.maps
    assert set(found.problems) == {folder / "trumpet_Bb.toml", folder / "kazoo.toml"}


def test_a_model_beside_the_map_is_taken_and_another_one_is_another_instrument(folder: Path) -> None:
    write(folder / "pocket_trumpet.toml", NEW)
    shutil.copy(MODELS / "trumpet_Bb.glb", folder / "trumpet_Bb.glb")
    first = library()
    assert first.model_path(first.maps["pocket_trumpet"]) == folder / "trumpet_Bb.glb"
    assert first.model_path(first.maps["trumpet_Bb"]) == MODELS / "trumpet_Bb.glb"
    os.utime(folder / "trumpet_Bb.glb", ns=(10**9, 10**9))
    second = module.reload()
    assert second.maps["pocket_trumpet"] == first.maps["pocket_trumpet"]
    assert second.maps["pocket_trumpet"] is not first.maps["pocket_trumpet"]
    assert second.maps["trumpet_Bb"] is first.maps["trumpet_Bb"]


def test_own_maps_may_extend_one_another_and_the_bundled_one_of_their_name(folder: Path) -> None:
    write(folder / "trumpet_Bb.toml", CHANGED)
    write(folder / "pocket_trumpet.toml", NEW)
    assert find_map("pocket_trumpet").short_name == "Mine"  # What lies beside it goes before the bundled one.
    write(folder / "trumpet_Bb.toml", CHANGED.replace('extends = "trumpet_Bb"', 'extends = "pocket_trumpet"'))
    problems = module.reload().problems
    assert [message.arguments["place"] for (message, *_) in problems.values()] == ["extends", "extends"]
