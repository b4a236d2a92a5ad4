"""The user's own characters: added, read again, invalid, removed; names that would be paths."""

import shutil
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.errors import FileError, MapError, UsageError
from app.formats.fbx.foreign import read_foreign_fbx
from app.formats.fbx.foreign_textures import FbxTextures
from app.formats.fbx.write import write_scene
from app.rig.characters import character_library
from app.rig.characters.character_library import (
    FOLDER_VARIABLE,
    LEAST_M,
    MOST_M,
    CharacterEntry,
    add_character,
    bundled_characters,
    character_named,
    character_problems,
    character_revision,
    characters,
    our_characters,
    read_entry,
    reload_characters,
    remove_character,
    write_entry,
)
from app.rig.characters.character_library import (
    character_library as library,
)
from tests.support.textured import textured_scene

OURS = bundled_characters()["woman_adult"]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    own = tmp_path / "characters"
    monkeypatch.setenv(FOLDER_VARIABLE, str(own))
    monkeypatch.setattr(character_library.LIBRARY, "last", None)
    monkeypatch.setattr(character_library, "_good", {})
    return own


def test_a_folder_that_is_not_there_holds_no_one(folder: Path) -> None:
    assert characters() == dict(our_characters())
    assert not folder.exists()


def test_who_is_added_can_play_under_an_id_of_its_own(folder: Path) -> None:
    first = add_character(OURS, "Ms. Müller / ../..", joints={}, morphs={"jawOpen": {"jawOpen": 0.5}})
    second = add_character(OURS, "Ms. Müller / ../..")
    assert first == "ms_m_ller"
    assert second == "ms_m_ller_2"
    assert list(characters()) == [*our_characters(), first, second]
    assert sorted(path.name for path in folder.iterdir()) == [
        f"{id}{suffix}" for id in (first, second) for suffix in (".glb", ".toml")
    ]
    entry = library().own[first]
    assert entry.title == "Ms. Müller / ../.."
    assert entry.morphs == {"jawOpen": {"jawOpen": 0.5}}
    character = character_named(first)
    assert character.id == first
    assert character is character_named(first)
    remove_character(first)
    assert list(characters()) == [*our_characters(), second]
    with pytest.raises(UsageError):
        character_named(first)
    with pytest.raises(UsageError):
        remove_character("woman_adult")
    assert OURS.is_file()


def test_images_beside_an_fbx_file_are_kept_with_it(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_scene(tmp_path / "card.fbx", textured_scene())
    monkeypatch.setattr(character_library, "load_character", lambda *_: None)
    id = add_character(tmp_path / "card.fbx", "Card")
    shutil.rmtree(tmp_path / "Textures")
    content = read_foreign_fbx(folder / f"{id}.fbx")
    textures = FbxTextures(folder / f"{id}.fbx", content).material(content.meshes[0].materials[0]).textures
    assert textures.color is not None
    assert textures.normal is not None
    remove_character(id)
    assert not [*folder.iterdir()]


def test_content_decides_the_suffix_that_a_character_is_kept_with(folder: Path, tmp_path: Path) -> None:
    for suffix, kept in ((".fbx", ".glb"), (".gltf", ".glb"), (".VRM", ".vrm"), (".bin", ".glb")):
        shutil.copy(OURS, tmp_path / f"figure{suffix}")
        id = add_character(tmp_path / f"figure{suffix}", "Figure")
        assert (folder / f"{id}{kept}").is_file()
        assert character_named(id).id == id


def test_a_long_title_is_cut_when_written_and_refused_when_read(folder: Path) -> None:
    added = add_character(OURS, "Ms. Mori\n" + "m" * 20_000)
    assert library().own[added].title == "Ms. Mori " + "m" * 190 + "…"
    (folder / "other.toml").write_text(f'file = "{added}.glb"\ntitle = "{"m" * 201}"\n')
    assert reload_characters().problems[folder / "other.toml"][0].arguments["place"] == "title"


def test_who_cannot_play_is_not_added(folder: Path, tmp_path: Path) -> None:
    broken = tmp_path / "broken.vrm"
    broken.write_bytes(OURS.read_bytes()[:5000])
    with pytest.raises(FileError):
        add_character(broken)
    assert not folder.exists()


def test_the_last_good_version_stays_and_what_is_wrong_is_reported(folder: Path) -> None:
    id = add_character(OURS, "one")
    good = character_named(id)
    assert not character_problems()
    whole = (folder / "one.toml").read_text()
    (folder / "one.toml").write_text("file = 3\n")
    assert reload_characters().problems.keys() == {folder / "one.toml"}
    assert character_named(id) is good
    (folder / "one.toml").write_text(whole)
    (folder / "one.glb").write_bytes(b"glTF")
    reload_characters()
    assert character_named(id) is good
    assert character_problems().keys() == {id}
    assert character_revision(id) > 0
    (folder / "one.glb").unlink()
    assert [problem.id for (problem,) in reload_characters().problems.values()] == ["character.file_missing"]
    assert character_named(id) is good


def test_another_file_under_the_same_id_is_another_character(folder: Path) -> None:
    id = add_character(OURS, "one")
    before, revision = character_named(id), character_revision(id)
    shutil.copy(bundled_characters()["man_adult"], folder / "one.glb")
    reload_characters()
    assert character_named(id) is not before
    assert character_revision(id) == revision + 1
    assert reload_characters() is library()
    write_entry(id, CharacterEntry("one.glb", "Other"))
    assert character_revision(id) == revision + 2


def test_a_file_with_a_name_in_capitals_is_read_again_too(folder: Path) -> None:
    folder.mkdir()
    shutil.copy(OURS, folder / "ONE.GLB")
    (folder / "one.toml").write_text('file = "ONE.GLB"\n')
    reload_characters()
    shutil.copy(bundled_characters()["man_adult"], folder / "ONE.GLB")
    reload_characters()
    assert character_revision("one") == 1


def test_no_one_takes_the_place_of_one_of_ours(folder: Path) -> None:
    folder.mkdir()
    shutil.copy(OURS, folder / "other.glb")
    (folder / "man_adult.toml").write_text('file = "other.glb"\n')
    reload_characters()
    assert characters() == dict(our_characters())
    assert [problem.id for problem in character_problems().values()] == ["character.taken"]


@pytest.mark.parametrize(
    "name",
    ["../x.vrm", "a/b.glb", "a\\b.glb", "C:x.glb", "/etc/x.fbx", ".x.glb", "x.exe", "", "..", "x\0.glb", "con:.vrm"],
)
def test_a_name_in_a_file_never_leads_out_of_the_folder(folder: Path, name: str) -> None:
    folder.mkdir()
    path = folder / "one.toml"
    write_entry("one", CharacterEntry(name))
    with pytest.raises(MapError):
        read_entry(path)


@given(st.text(max_size=80))
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_title_becomes_an_id_that_any_system_takes_as_a_name(folder: Path, title: str) -> None:
    folder.mkdir(exist_ok=True)
    id = character_library._free_id(title, folder)
    assert id.isascii()
    assert id.replace("_", "").isalnum()
    assert len(id) <= 70
    assert id not in ("con", "nul", "com1", *characters())


@given(
    st.builds(
        CharacterEntry,
        st.just("x.vrm"),
        st.text(st.characters(exclude_categories=["Cs"]), max_size=20),
        st.dictionaries(
            st.text(st.characters(exclude_categories=["Cs"]), max_size=8),
            st.text(st.characters(exclude_categories=["Cs"]), max_size=8),
            max_size=3,
        ),
        st.dictionaries(
            st.text(st.characters(exclude_categories=["Cs"]), max_size=8),
            st.dictionaries(
                st.text(st.characters(exclude_categories=["Cs"]), max_size=8), st.floats(-1, 1), min_size=1, max_size=3
            ),
            max_size=3,
        ),
        st.just(0.0) | st.floats(LEAST_M, MOST_M),
    )
)
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_what_is_written_is_what_is_read(folder: Path, entry: CharacterEntry) -> None:
    folder.mkdir(exist_ok=True)
    write_entry("one", entry)
    assert read_entry(folder / "one.toml") == entry


def test_a_file_that_another_character_is_made_of_stays(folder: Path) -> None:
    first = add_character(OURS)
    path = library().sources[first].path
    (folder / "twin.toml").write_text(f'file = "{path.name}"\n', encoding="utf-8")
    reload_characters()
    remove_character(first)
    assert path.is_file()
    remove_character("twin")
    assert not path.exists()
