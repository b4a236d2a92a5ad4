"""Textures and materials of a textured character, in a fake editor."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from app.formats.images import decoded
from app.formats.textures import texture_of
from tests.unit.resources.unreal.conftest import Editor, exported
from tests.unit.resources.unreal.test_bodies import cast
from tests.unit.resources.unreal.test_import import ROOT, description

BODY = "woman_adult"
MESH = f"{ROOT}/Bodies/{BODY}/SK_{BODY}"


@pytest.fixture(scope="module")
def textured_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("exported") / "Game"
    exported(folder, cast(BODY, BODY), ("Trumpet 1",), texture_px=512)
    return folder


@pytest.fixture
def shown(plugin: None, textured_folder: Path, tmp_path: Path) -> Editor:
    shutil.copytree(textured_folder, tmp_path / "Game")
    editor = Editor(tmp_path / "Game")
    editor.import_performance()
    return editor


def slots(editor: Editor) -> dict[str, Any]:
    mesh = editor.studio.assets[MESH]
    return {slot.material_slot_name: slot.material_interface for slot in mesh.materials}


def materials(editor: Editor) -> dict[str, Any]:
    return {one["asset"]: one for one in description(editor)["materials"]}


def test_files_are_listed_and_no_larger_than_asked_for(shown: Editor) -> None:
    listed = {one["file"] for one in description(shown)["textures"]}
    folder = shown.folder / "SuisouSource/quartet"
    assert listed == {f"Textures/{path.name}" for path in (folder / "Textures").iterdir()}
    assert listed <= set(json.loads((folder / "manifest.json").read_text())["files"])
    assert listed <= set(description(shown)["files"])
    sides = []
    for file in listed:
        pixels = decoded(texture_of(file, (folder / file).read_bytes()), 8192)
        assert pixels is not None
        sides.append(max(pixels.shape))
    assert max(sides) == 512


def test_textures_have_the_settings_of_their_kind(shown: Editor) -> None:
    kinds = set()
    for one in description(shown)["textures"]:
        asked = shown.studio.assets[one["asset"]]._properties
        kinds.add(one["kind"])
        assert asked["srgb"] == (one["kind"] == "color")
        assert asked["flip_green_channel"] == (one["kind"] == "normal")
        name = {"color": "TC_DEFAULT", "normal": "TC_NORMALMAP", "masks": "TC_MASKS"}[one["kind"]]
        assert asked["compression_settings"].name == name
    assert kinds == {"color", "normal", "masks"}


def test_cards_are_masked_and_seen_from_both_sides(shown: Editor) -> None:
    reported = description(shown)["players"][0]["character"]["materials"]
    there = slots(shown)
    assert set(reported) <= set(there)
    masked = 0
    for slot, path in reported.items():
        material, asked = there[slot], materials(shown)[path]
        assert material is shown.studio.assets[path]
        assert material._properties["used_with_skeletal_mesh"]
        if asked["alpha"] == "mask":
            masked += 1
            assert material._properties["blend_mode"].name == "BLEND_MASKED"
            assert material._properties["two_sided"] is True
            assert material._properties["opacity_mask_clip_value"] == pytest.approx(asked["cutoff"])
            node, _ = material._inputs["MP_OPACITY_MASK"]
            (color, output), (tint, factor) = node._inputs["A"], node._inputs["B"]
            assert (output, factor) == ("A", "A")
            assert color._properties["texture"] is shown.studio.assets[asked["color"]["texture"]]
            assert tint._properties["default_value"].a == pytest.approx(asked["base_color"][3])
    assert masked == 1, "hair, brows and lashes"


def test_the_skin_is_colour_normal_roughness_and_occlusion(shown: Editor) -> None:
    path = next(path for path, one in materials(shown).items() if one["normal"] and one["surface"])
    asked, material = materials(shown)[path], shown.studio.assets[path]
    assert {"MP_BASE_COLOR", "MP_NORMAL", "MP_ROUGHNESS", "MP_METALLIC"} <= set(material._inputs)
    samples = {
        node._properties["parameter_name"]: node
        for node in material._nodes
        if type(node).__name__ == "MaterialExpressionTextureSampleParameter2D"
    }
    for name, role in (("BaseColor", "color"), ("Normal", "normal"), ("ORM", "surface")):
        assert samples[name]._properties["texture"] is shown.studio.assets[asked[role]["texture"]]
        moved = (asked[role]["scale"], asked[role]["offset"]) != ([1.0, 1.0], [0.0, 0.0])
        assert ("" in samples[name]._inputs) == moved
    rough, output = material._inputs["MP_ROUGHNESS"][0]._inputs["A"]
    assert (rough, output) == (samples["ORM"], "G")


def test_an_update_makes_nothing_twice_and_leaves_what_the_artist_changed(shown: Editor) -> None:
    slot, path = next(iter(description(shown)["players"][0]["character"]["materials"].items()))
    mine = shown.studio.add("/Game/Mine/M_Skin", shown.unreal.Material())
    changed = shown.studio.assets[MESH].materials
    changed[0].material_interface = mine
    shown.studio.assets[MESH].materials = changed
    shown.studio.assets[path]._properties["two_sided"] = "as the artist likes it"
    before = dict(shown.studio.assets)
    count = len(shown.studio.imports)
    shown.update_performance()
    assert shown.studio.assets == before
    assert not [one for one in shown.studio.imports[count:] if "Textures" in one["destination_path"]]
    assert shown.studio.assets[path]._properties["two_sided"] == "as the artist likes it"
    assert {material._compiled for material in before.values() if getattr(material, "_nodes", ())} == {1}
    assert slots(shown)[changed[0].material_slot_name] is mine
    assert slot in slots(shown)


def test_pieces_share_their_textures_until_no_one_needs_them(shown: Editor) -> None:
    def textures() -> set[str]:
        return {path for path in shown.studio.assets if path.startswith("/Game/Suisou/Textures/")}

    before = textures()
    assert before == {one["asset"] for one in description(shown)["textures"]}
    exported(shown.folder, cast(BODY, BODY), ("Trumpet 1",), source="other.mid", texture_px=512)
    count, answers = len(shown.studio.imports), shown.unreal.AppReturnType
    shown.studio.answers = [answers.YES_ALL]
    shown.import_performance()
    assert textures() == before
    assert not [one for one in shown.studio.imports[count:] if "/Textures" in one["destination_path"]]
    for source, left in (("quartet.mid", before), ("other.mid", set())):
        exported(shown.folder, cast(BODY, BODY), ("Trumpet 1",), source=source, texture_px=0)
        shown.studio.answers = [answers.YES_ALL]
        shown.update_performance()
        assert textures() == left, source


def test_another_size_renames_nothing_and_none_takes_them_away(shown: Editor) -> None:
    before = dict(shown.studio.assets)
    project = cast(BODY, BODY)
    exported(shown.folder, project, ("Trumpet 1",), texture_px=1024)
    shown.update_performance()
    assert shown.studio.assets == before
    exported(shown.folder, project, ("Trumpet 1",), texture_px=0)
    assert not (shown.folder / "SuisouSource/quartet/Textures").exists()
    shown.update_performance()
    assert all("/Materials/" not in path and "/Textures/" not in path for path in shown.studio.assets)
    assert all(material._path == f"{ROOT}/Bodies/{BODY}/{slot}" for slot, material in slots(shown).items())


def test_pieces_that_share_a_texture_show_the_largest(shown: Editor) -> None:
    def imported(piece: str) -> set[str]:
        return {
            str(one["filename"])
            for one in shown.studio.imports[count:]
            if "/Textures" in one["destination_path"] and f"/{piece}/" in str(one["filename"]).replace("\\", "/")
        }

    answers = shown.unreal.AppReturnType
    assert all(one["px"] <= 512 for one in description(shown)["textures"])
    exported(shown.folder, cast(BODY, BODY), ("Trumpet 1",), source="large.mid", texture_px=1024)
    larger = {one["asset"]: one["file"] for one in description(shown, "large")["textures"] if one["px"] == 1024}
    assert larger
    count = len(shown.studio.imports)
    shown.studio.answers = [answers.YES_ALL]
    shown.import_performance()
    assert {Path(name).name for name in imported("large")} == {Path(name).name for name in larger.values()}
    # The smaller one comes last, and takes nothing away; it is said.
    count = len(shown.studio.imports)
    exported(shown.folder, cast(BODY, BODY), ("Trumpet 1",), texture_px=512, last_bar=2)
    shown.studio.answers = [answers.YES_ALL]
    said = shown.update_performance()
    assert not imported("quartet")
    assert f'as large as "large" has them, which shares them: {len(larger)}' in said
    # A file that is gone is no larger one.
    (shown.folder / "SuisouSource/large/performance.json").unlink()
    count = len(shown.studio.imports)
    shown.studio.answers = [answers.YES_ALL]
    assert "as large as" not in shown.update_performance()
    assert {Path(name).name for name in imported("quartet")} == {Path(name).name for name in larger.values()}
