"""Beside an unreadable piece or a player who was not exported, the others are imported and the problem is reported."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.support.bad_players import own_folders, with_character
from tests.unit.export.unreal.conftest import quartet
from tests.unit.resources.unreal.conftest import Editor, exported

ROOT = "/Game/Suisou/quartet"


def copy_piece(editor: Editor, name: str) -> Path:
    """Copy the quartet under another name and return its description."""
    sources = editor.folder / "SuisouSource"
    shutil.copytree(sources / "quartet", sources / name)
    for path in sources.joinpath(name, "Audio").iterdir():
        path.rename(path.with_name(f"S_{name}.wav"))
    path = sources / name / "performance.json"
    path.write_text(path.read_text(encoding="utf-8").replace("quartet", name), encoding="utf-8")
    return path


def changed(change: Callable[[dict[str, Any]], None]) -> Callable[[Path], None]:
    def damage(path: Path) -> None:
        content = json.loads(path.read_text(encoding="utf-8"))
        change(content)
        path.write_text(json.dumps(content), encoding="utf-8")

    return damage


def replaced(data: bytes) -> Callable[[Path], object]:
    return lambda path: path.write_bytes(data)


DAMAGE: dict[str, Callable[[Path], None]] = {
    "empty": replaced(b""),
    "not_text": replaced(b"\xff\xfe\x00"),
    "deep": replaced(b"[" * 200_000),
    "newer": changed(lambda content: content.update(schema=99)),
    "huge_number": changed(lambda content: content["sound"].update(offset_s=10**400)),
    "not_a_number": changed(lambda content: content["players"][0]["place"].update(x_cm=float("nan"))),
    "infinite": changed(lambda content: content["sound"].update(duration_s=float("inf"))),
    "list_for_a_table": changed(lambda content: content.update(rate=[24, 1])),
    "assets_elsewhere": changed(
        lambda content: content.update(left_out=[{"name": "x", "reason": "y", "assets": ["/Game/Mine/SK_x"]}])
    ),
}


def test_those_that_cannot_be_read_are_named_and_the_others_are_imported(editor: Editor) -> None:
    for name, damage in DAMAGE.items():
        damage(copy_piece(editor, name))
    for choose, done in ((editor.import_performance, "is imported"), (editor.update_performance, "is up to date")):
        assert done in choose()
        reported = editor.studio.dialogs[-2]
        assert "everything else can" in reported
        assert [name for name in DAMAGE if f"/{name}/performance.json" not in reported] == []
    assert editor.pieces() == {"quartet"}
    assert editor.studio.errors == []


def test_one_whose_files_were_changed_does_not_keep_the_next_one_out(editor: Editor) -> None:
    copy_piece(editor, "adagio")
    next(editor.folder.glob("SuisouSource/adagio/Characters/*.fbx")).write_bytes(b"half of it")
    editor.studio.answers = [editor.unreal.AppReturnType.YES_ALL]
    assert "is imported" in editor.import_performance()
    assert any("is not what Suisou exported" in reported for reported in editor.studio.dialogs)
    assert f"{ROOT}/LS_quartet" in editor.studio.assets


def test_cancel_ends_them_all(editor: Editor) -> None:
    copy_piece(editor, "adagio")
    editor.studio.answers = [editor.unreal.AppReturnType.YES_ALL]
    editor.studio.cancel_after = 4
    assert "Cancelled" in editor.import_performance()
    assert sum("Cancelled" in reported for reported in editor.studio.dialogs) == 1


def bindings(editor: Editor) -> dict[str, Any]:
    return {binding._display_name: binding for binding in editor.sequence()._bindings}


def test_who_is_left_out_of_a_later_export_stays_as_imported(
    editor: Editor, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    editor.import_performance()
    before = {path: id(asset) for path, asset in editor.studio.assets.items() if "/Trumpet_1" in path}
    trumpet = bindings(editor)["Trumpet 1"]
    sources = editor.folder / "SuisouSource" / "quartet"
    kept = (sources / "Characters" / "SK_Trumpet_1.fbx").read_bytes()

    project, own = quartet(), own_folders(tmp_path, monkeypatch)
    exported(editor.folder, with_character(project, 0, own.add_character(b"damaged")))
    content = json.loads((sources / "performance.json").read_text("utf-8"))
    assert [player["name"] for player in content["players"]] == ["Trombone 1"]
    (left_out,) = content["left_out"]
    assert left_out["name"] == "Trumpet 1"
    assert "mori.glb" in left_out["reason"]
    assert (sources / "Characters" / "SK_Trumpet_1.fbx").read_bytes() == kept
    # Players excluded from the request are removed, as usual.
    assert not (sources / "Characters" / "SK_Trumpet_2.fbx").exists()

    reported = editor.update_performance()
    assert all(words in reported for words in ("Excluded", "Trumpet 1", "mori.glb"))
    assert {path: id(asset) for path, asset in editor.studio.assets.items() if "/Trumpet_1" in path} == before
    assert bindings(editor)["Trumpet 1"] is trumpet
    assert "Trumpet 2" not in bindings(editor)
    # Remaining files still belong to the program, and the next export replaces them.
    exported(editor.folder, project, ("Trumpet 1",))
    assert (sources / "Characters" / "SK_Trumpet_1.fbx").read_bytes() != kept
