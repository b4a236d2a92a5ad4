"""Errors are reported in a dialog before anything is changed."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.unit.resources.unreal.conftest import Editor

ROOT = "/Game/Suisou/quartet"
SOURCES = "SuisouSource/quartet"


def damage_json(change: Callable[[dict[str, Any]], None]) -> Callable[[Editor], None]:
    def damage(editor: Editor) -> None:
        path = editor.folder / SOURCES / "performance.json"
        content = json.loads(path.read_text(encoding="utf-8"))
        change(content)
        path.write_text(json.dumps(content), encoding="utf-8")

    return damage


def write(name: str, content: bytes) -> Callable[[Editor], object]:
    return lambda editor: (editor.folder / SOURCES / name).write_bytes(content)


def without(name: str) -> Callable[[Editor], None]:
    def damage(editor: Editor) -> None:
        owner, _, function = name.partition(".")
        if function:
            bases = getattr(editor.unreal, owner).__mro__
            delattr(next(base for base in bases if function in vars(base)), function)
        else:
            delattr(editor.unreal, owner)

    return damage


def somebody_elses(editor: Editor) -> None:
    editor.studio.add(f"{ROOT}/Characters/Trumpet_1/A_Trumpet_1", editor.unreal.AnimSequence())


def player(field: str, value: object) -> Callable[[dict[str, Any]], None]:
    return lambda content: content["players"][0]["character"].__setitem__(field, value)


@pytest.mark.parametrize(
    ("damage", "reported"),
    [
        (lambda editor: shutil.rmtree(editor.folder / "SuisouSource"), "There is no performance in"),
        (write("performance.json", b"{"), "cannot be read"),
        (write("performance.json", b"[]"), "cannot be read"),
        (damage_json(lambda content: content.pop("rate")), "'rate'"),
        (damage_json(lambda content: content.update(schema=7)), "newer Suisou"),
        (damage_json(lambda content: content.update(frames=0)), "cannot be read"),
        (damage_json(lambda content: content.update(content="/Game/Other")), "cannot be read"),
        (damage_json(player("mesh", "/Game/Mine/SK_Trumpet_1")), "cannot be read"),
        (damage_json(player("mesh", "/Game/Suisou/quartet/../../x/SK_y")), "cannot be read"),
        (damage_json(player("file", "../../secret.fbx")), "cannot be read"),
        (damage_json(player("animation", f"{ROOT}/Characters/Trumpet_2/A_Trumpet_2")), "cannot be read"),
        (lambda editor: (editor.folder / SOURCES / "Audio/S_quartet.wav").unlink(), "S_quartet.wav is not there"),
        (write("Characters/SK_Trumpet_1.fbx", b"half of it"), "is not what Suisou exported"),
        (somebody_elses, "was not made by Suisou"),
        (without("MovieSceneScriptingDoubleChannel"), '"SequencerScripting" is off'),
        (without("EditorAssetLibrary"), '"EditorScriptingUtilities" is off'),
        (without("LevelSequenceFactoryNew"), '"LevelSequenceEditor" is off'),
        (without("LevelSequence.add_track"), "LevelSequence.add_track"),
        (without("FbxFactory"), "which lacks FbxFactory"),
    ],
)
def test_it_is_reported_and_nothing_is_changed(editor: Editor, damage: Callable[[Editor], None], reported: str) -> None:
    damage(editor)
    before = dict(editor.studio.assets)
    assert reported in editor.import_performance()
    assert editor.studio.assets == before
    assert editor.studio.imports == []


def test_import_and_update_know_what_is_there(editor: Editor) -> None:
    assert "Choose Import Performance first" in editor.update_performance()
    editor.import_performance()
    assert "imported already: " in editor.import_performance()


def test_what_unreal_does_not_import_is_reported(editor: Editor) -> None:
    refused = f"{ROOT}/Instruments/Trumpet_1_trumpet_Bb/SK_Trumpet_1_trumpet_Bb"
    editor.studio.refuse_import.add(refused)
    reported = editor.import_performance()
    assert refused in reported
    assert "Output Log" in reported
    assert f"{ROOT}/LS_quartet" not in editor.studio.assets
    # Finished steps are kept, and the next import continues.
    editor.studio.refuse_import.clear()
    assert "is imported" in editor.import_performance()


def test_what_unreal_does_not_update_is_reported(editor: Editor) -> None:
    editor.import_performance()
    refused = f"{ROOT}/Characters/Trombone_1/A_Trombone_1"
    editor.studio.refuse_import.add(refused)
    assert refused in editor.update_performance()


def test_a_length_that_is_not_the_files_is_reported(editor: Editor) -> None:
    editor.studio.lost_keys = 1
    reported = editor.import_performance()
    assert "is imported" in reported
    assert reported.count("compare it with the sound") == 8


def test_what_cannot_be_removed_is_reported(editor: Editor) -> None:
    editor.import_performance()
    stuck = f"{ROOT}/Instruments/Trumpet_1_trumpet_Bb/A_Trumpet_1_trumpet_Bb"
    editor.studio.metadata[stuck.replace("/A_", "/SKEL_")]["SuisouBones"] = "of before"
    editor.studio.undeletable.add(stuck)
    assert stuck in editor.update_performance()


def test_a_locked_sequence_is_reported(editor: Editor) -> None:
    editor.import_performance()
    editor.sequence()._read_only = True
    asked = len(editor.studio.imports)
    assert "locked" in editor.update_performance()
    assert len(editor.studio.imports) == asked


def test_it_is_cancelled(editor: Editor) -> None:
    editor.studio.cancel_after = 4
    assert "Cancelled" in editor.import_performance()
    assert f"{ROOT}/LS_quartet" not in editor.studio.assets
    editor.studio.cancel_after = None
    assert "is imported" in editor.import_performance()


def test_a_fault_of_ours_is_a_dialog_too(editor: Editor, monkeypatch: pytest.MonkeyPatch) -> None:
    from suisou_import import sequence

    monkeypatch.setattr(sequence, "build", lambda *arguments: 1 / 0)
    exec(editor.studio.commands["Import Performance"], {})
    assert "ZeroDivisionError" in editor.studio.dialogs[-1]
    assert "Traceback" in str(editor.studio.errors)


@pytest.mark.parametrize(
    ("answers", "imported"),
    [(["YES", "NO"], {"one"}), (["NO", "YES"], {"two"}), (["YES_ALL"], {"one", "two"}), (["NO_ALL"], set()),
     (["YES", "CANCEL"], set())],
)  # fmt: skip
def test_several_are_asked_for(editor: Editor, answers: list[str], imported: set[str]) -> None:
    sources = editor.folder / "SuisouSource"
    for name in ("one", "two"):
        shutil.copytree(sources / "quartet", sources / name)
        for path in sources.joinpath(name, "Audio").iterdir():
            path.rename(path.with_name(f"S_{name}.wav"))
        path = sources / name / "performance.json"
        path.write_text(path.read_text(encoding="utf-8").replace("quartet", name), encoding="utf-8")
    shutil.rmtree(sources / "quartet")
    editor.studio.answers = [getattr(editor.unreal.AppReturnType, answer) for answer in answers]
    exec(editor.studio.commands["Import Performance"], {})
    assert editor.pieces() == imported
    assert not editor.studio.errors


def test_without_an_editor_there_is_no_menu(plugin: None, tmp_path: Path) -> None:
    editor = Editor(tmp_path)
    editor.studio.commands.clear()
    editor.studio.has_editor = False
    editor.start()
    assert editor.studio.commands == {}


def test_in_japanese(editor: Editor) -> None:
    japanese = Editor(editor.folder, "ja-JP")
    assert set(japanese.studio.commands) == {"演奏をインポート", "演奏を更新"}
    assert "インポートしました" in japanese.choose("演奏をインポート")
    assert [mark.label for mark in japanese.sequence()._marks] == ["第 1 小節", "第 2 小節"]
