"""Exports into an Unreal project: resulting files after repeated exports and after failures."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
import soundfile

from app.cli import main
from app.errors import Cancelled, FileError
from app.export.unreal import run
from app.export.unreal.description import place_of
from app.export.unreal.manifest import encode_manifest, own_file
from app.export.unreal.project import UnrealProject, find_project
from app.export.unreal.run import export_into, plan_export
from app.formats.fbx.read import read_scene
from app.formats.texture_files import TEXTURES_FOLDER
from app.messages import text
from app.performance.ensemble import Performance
from app.project.casting import StagePosition
from tests.unit.export.unreal.conftest import (
    QUARTET,
    Export,
    quartet,
    renamed,
    request_of,
    tree_of,
    with_recording,
)

SOURCES = "SuisouSource/quartet/"
THEIRS = {
    "Game.uproject",
    "Content/Suisou/quartet/BP_Mine.uasset",
    "Plugins/Other/Other.uplugin",
    "SuisouSource/notes.txt",
    "SuisouSource/quartet/Audio/mine.wav",
}
OURS = {
    SOURCES + name
    for name in (
        "performance.json",
        "report.json",
        "manifest.json",
        "Audio/S_quartet.wav",
        "Characters/SK_Trumpet_1.fbx",
        "Instruments/SK_Trumpet_1_trumpet_Bb.fbx",
    )
}


def description(unreal: UnrealProject, piece: str = "quartet") -> dict[str, Any]:
    content: dict[str, Any] = json.loads(
        (unreal.folder / "SuisouSource" / piece / "performance.json").read_text(encoding="utf-8")
    )
    return content


def without_plugin(tree: dict[str, bytes]) -> dict[str, bytes]:
    """Return a tree also without textures, whose names follow from their content."""
    others = ("Plugins/Suisou/", "SuisouSource/quartet/Textures/")
    return {name: data for name, data in tree.items() if not name.startswith(others)}


def test_what_is_there_and_what_it_says(unreal: UnrealProject, export: Export) -> None:
    theirs = tree_of(unreal.folder)
    request = request_of(quartet())
    written = export(request)
    assert written.plan.plugin
    tree = tree_of(unreal.folder)
    assert set(without_plugin(tree)) == OURS | THEIRS
    assert {name: tree[name] for name in THEIRS} == theirs
    assert {path.as_posix() for path in written.plan.written} == set(tree) - THEIRS
    reported = description(unreal)
    assert (reported["schema"], reported["frames"], reported["rate"]) == (
        6,
        request.span.count,
        {"numerator": 12, "denominator": 1},
    )
    (player,) = reported["players"]
    body = player["character_id"]
    assert player["character"]["mesh"] == f"/Game/Suisou/quartet/Bodies/{body}/SK_{body}"
    assert player["character"]["animation"] == "/Game/Suisou/quartet/Characters/Trumpet_1/A_Trumpet_1"
    assert player["instrument"]["animation"] == (
        "/Game/Suisou/quartet/Instruments/Trumpet_1_trumpet_Bb/A_Trumpet_1_trumpet_Bb"
    )
    for figure in (player["character"], player["instrument"]):
        scene = read_scene(unreal.folder / SOURCES / figure["file"])
        assert [bone.name for bone in scene.bones] == figure["bones"]
        assert scene.clip.frames == reported["frames"]
    assert [bar["number"] for bar in reported["bars"]] == [1]
    # Position of frame 0 in the whole piece.
    first_s = request.performance.time_frame.first_frame_s + reported["first_frame"] / 12
    assert reported["first_frame_s"] == pytest.approx(first_s)
    assert (reported["first_frame"], reported["bars"][0]["frame"]) == (request.span.first, 0)
    score = request.performance.project.score
    assert reported["bars"][0]["s"] == pytest.approx(
        score.tempo_map.seconds(float(score.metre_map.tick_of_bar(1))) - request.span.first_frame_s, abs=1e-6
    )
    images = {one["file"] for one in reported["textures"]}
    figures = {player["character"]["file"], player["instrument"]["file"]}
    assert set(reported["files"]) == {"Audio/S_quartet.wav", *figures, *images}
    report = json.loads((unreal.folder / SOURCES / "report.json").read_text(encoding="utf-8"))
    assert set(report["players"][0]["files"].values()) == figures
    assert set(report["textures"]) == images != set()


def test_the_synthesisers_sound_begins_with_frame_0(exported: UnrealProject) -> None:
    request = request_of(quartet())
    samples, rate_hz = soundfile.read(exported.folder / SOURCES / "Audio/S_quartet.wav")
    info = soundfile.info(exported.folder / SOURCES / "Audio/S_quartet.wav")
    assert (info.format, info.subtype, rate_hz) == ("WAV", "PCM_16", 48_000)
    assert len(samples) == round(48_000 * request.span.count / 12)
    assert description(exported)["sound"]["offset_s"] == 0.0
    # Silence until the first note of the piece.
    onset_s = min(part.notes[0].onset_tick for part in request.performance.project.score.parts)
    first = (request.performance.piece.clock.seconds(float(onset_s)) - request.span.first_frame_s) * 48_000
    audible = np.flatnonzero(np.abs(samples).max(axis=1) > 1e-3)
    assert 0 <= audible[0] - first < 0.1 * 48_000


def test_the_recording_sounds_at_its_offset(unreal: UnrealProject, export: Export, tmp_path: Path) -> None:
    click = np.zeros(44_100, np.float32)
    click[4410] = 0.9
    soundfile.write(tmp_path / "take.flac", click, 44_100)
    request = request_of(with_recording(quartet(), tmp_path / "take.flac", 0.25))
    export(request)
    samples, _ = soundfile.read(unreal.folder / SOURCES / "Audio/S_quartet.wav")
    assert description(unreal)["sound"]["source"] == "recording"
    expected = (0.25 + 0.1 - request.span.first_frame_s) * 48_000
    assert abs(np.abs(samples[:, 0]).argmax() - expected) < 3


def test_three_exports_leave_the_same_tree(exported: UnrealProject, export: Export) -> None:
    request = request_of(quartet())
    tree = tree_of(exported.folder)
    for _ in range(2):
        written = export(request)
        assert not written.plan.removed
    assert tree_of(exported.folder) == tree
    replaced = {path.as_posix(): b"" for path in written.plan.replaced}
    assert set(without_plugin(replaced)) == OURS


def test_what_is_not_needed_any_more_goes(unreal: UnrealProject, export: Export) -> None:
    export(request_of(quartet(), ("Trumpet 1", "Trumpet 2")))
    longer = request_of(quartet(), ("Trumpet 2",), last_bar=2)
    written = export(longer)
    figures = {path.name for path in written.plan.removed if path.parent.name != TEXTURES_FOLDER}
    assert figures == {"SK_Trumpet_1.fbx", "SK_Trumpet_1_trumpet_Bb.fbx"}
    ours = {name.replace("Trumpet_1", "Trumpet_2") for name in OURS}
    assert set(without_plugin(tree_of(unreal.folder))) == ours | THEIRS
    assert description(unreal)["frames"] == longer.span.count
    # Removing a player does not rename the others, and adding it again restores the names.
    export(request_of(quartet(), ("Trumpet 1",)))
    assert set(without_plugin(tree_of(unreal.folder))) == OURS | THEIRS


def test_a_leftover_that_a_user_changed_stays_and_is_reported(unreal: UnrealProject, export: Export) -> None:
    export(request_of(quartet(), ("Trumpet 1", "Trumpet 2")))
    changed = unreal.folder / SOURCES / "Characters/SK_Trumpet_1.fbx"
    changed.write_bytes(b"retouched")
    written = export(request_of(quartet(), ("Trumpet 2",)))
    assert changed.read_bytes() == b"retouched"
    (message,) = written.plan.kept
    assert str(changed) in text(message)
    # The file belongs to the artist from now on.
    assert not export(request_of(quartet(), ("Trumpet 2",))).plan.kept
    assert changed.read_bytes() == b"retouched"
    with pytest.raises(FileError) as caught:
        export(request_of(quartet(), ("Trumpet 1",)))
    assert caught.value.message.id == "unreal.in_the_way"


@pytest.mark.parametrize(
    ("name", "id"),
    [
        ("SuisouSource/quartet/Characters/SK_Trumpet_1.fbx", "unreal.changed"),
        ("SuisouSource/quartet/Characters/SK_Trumpet_2.fbx", "unreal.in_the_way"),
        ("SuisouSource/quartet/manifest.json", "unreal.manifest"),
    ],
)
def test_what_is_the_artists_is_not_replaced(exported: UnrealProject, export: Export, name: str, id: str) -> None:
    (exported.folder / name).write_bytes(b"mine")
    before = tree_of(exported.folder)
    with pytest.raises(FileError) as caught:
        export(request_of(quartet(), ("Trumpet 1", "Trumpet 2")))
    assert caught.value.message.id == id
    assert Path(str(caught.value.message.arguments["file"])) == exported.folder / name
    assert text(caught.value.message)
    assert tree_of(exported.folder) == before


def test_a_write_protected_file_is_reported_although_it_could_be_replaced(
    exported: UnrealProject, export: Export, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = tree_of(exported.folder)
    protected = exported.folder / SOURCES / "Audio/S_quartet.wav"
    # The user who runs the tests may have all permissions.
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != protected)
    with pytest.raises(FileError) as caught:
        export(request_of(quartet(), last_bar=2))
    assert caught.value.message.id == "unreal.locked"
    assert str(protected) in text(caught.value.message)
    assert tree_of(exported.folder) == before


def test_a_manifest_that_leads_elsewhere_is_damaged(exported: UnrealProject, export: Export) -> None:
    path = exported.folder / SOURCES / "manifest.json"
    manifest = json.loads(path.read_text())
    for name in ("../notes.txt", "/etc/passwd", "C:/x", "a\\..\\..\\b"):
        manifest["files"] = {name: {"bytes": 4, "sha256": "0" * 64}}
        path.write_text(json.dumps(manifest))
        with pytest.raises(FileError) as caught:
            export(request_of(quartet()))
        assert caught.value.message.id == "unreal.manifest"


def test_version_control_may_change_line_ends(exported: UnrealProject, export: Export) -> None:
    path = exported.folder / SOURCES / "performance.json"
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    export(request_of(quartet()))
    assert b"\r\n" not in path.read_bytes()


HOSTILE = ["'; import os; os.abort() #", "../../../outside", "x" * 300, "🎺"]
PIECES = [
    '"quoted\'s".mid',
    "../../escape.mid",
    "CON.mid",
    f"{'長' * 300}.mid",
    "🎺🎷.mid",
    "nul",
    ".mid",
    "a\nb\\c.mid",
]


@pytest.mark.parametrize("source", PIECES)
def test_a_hostile_name_is_harmless(unreal: UnrealProject, export: Export, source: str) -> None:
    outside = {path for path in unreal.folder.parent.rglob("*") if unreal.folder not in path.parents}
    export(request_of(renamed(quartet(), HOSTILE), (HOSTILE[0],), source))
    assert {path for path in unreal.folder.parent.rglob("*") if unreal.folder not in path.parents} == outside
    new = set(tree_of(unreal.folder)) - THEIRS
    assert all(name.isascii() and not set(name) & set("'\"\\ :;#()") for name in new)
    assert all(len(name) < 120 for name in new)
    (piece,) = {name.split("/")[1] for name in new if name.startswith("SuisouSource/")} - {"notes.txt"}
    reported = description(unreal, piece)
    assert reported["players"][0]["name"] == HOSTILE[0]
    assert reported["players"][0]["character"]["mesh"].startswith(f"/Game/Suisou/{piece}/Bodies/")


def test_names_do_not_depend_on_who_is_exported() -> None:
    from app.export.unreal.layout import layout_of

    alike = layout_of(renamed(quartet(), ["Solo", "solo", "SOLO!", "So lo"]), "x")
    names = [place.animation for places in (alike.characters, alike.instruments) for place in places.values()]
    assert len({name.casefold() for name in names}) == 8
    assert len({place.mesh.casefold() for place in alike.instruments.values()}) == 4
    # The name of one player equals that of another with the instrument appended.
    clash = layout_of(renamed(quartet(), ["A", "A_trumpet_Bb", "B", "C"]), "x")
    files = [place.file.name for places in (clash.characters, clash.instruments) for place in places.values()]
    assert len({name.casefold() for name in files}) == 8


@pytest.mark.parametrize("stage", ["write_cast", "write_sound", "check_fbx", "encode_description"])
def test_an_error_in_the_middle_leaves_the_old_tree(
    exported: UnrealProject, export: Export, monkeypatch: pytest.MonkeyPatch, stage: str
) -> None:
    before = tree_of(exported.folder)
    real = getattr(run, stage)

    def failing(*arguments: object, **named: object) -> None:
        real(*arguments, **named)
        raise KeyboardInterrupt

    monkeypatch.setattr(run, stage, failing)
    with pytest.raises(KeyboardInterrupt):
        export(request_of(quartet(), ("Trumpet 2",), last_bar=2))
    assert tree_of(exported.folder) == before


def test_it_is_cancelled(unreal: UnrealProject) -> None:
    before = tree_of(unreal.folder)
    shares: list[float] = []
    with pytest.raises(Cancelled):
        export_into(
            request_of(quartet()),
            unreal,
            text,
            lambda: bool(shares) and shares[-1] > 0.9,
            lambda share, label: shares.append(share),
        )
    assert shares == sorted(shares)
    assert tree_of(unreal.folder) == before


def test_a_wrong_file_never_takes_its_place(
    unreal: UnrealProject, export: Export, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The wrong file has half the size, as with a wrong unit."""
    from app.formats.fbx import write as fbx

    real = fbx.write_scenes

    def halved(path: Path, scenes: Any) -> None:
        (scene,) = scenes
        meshes = tuple(replace(mesh, vertices_cm=mesh.vertices_cm * 0.5) for mesh in scene.meshes)
        real(path, (replace(scene, meshes=meshes),))

    monkeypatch.setattr(fbx, "write_scenes", halved)
    before = tree_of(unreal.folder)
    with pytest.raises(FileError) as caught:
        export(request_of(quartet()))
    assert caught.value.message.id == "unreal.file_wrong"
    assert "corner" in text(caught.value.message)
    assert tree_of(unreal.folder) == before


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize("ending", [signal.SIGTERM, signal.SIGKILL])
def test_a_killed_export_leaves_the_old_tree(exported: UnrealProject, export: Export, ending: signal.Signals) -> None:
    request = request_of(quartet())
    before = tree_of(exported.folder)
    command = [sys.executable, "-m", "app", "export", str(QUARTET), "--unreal", str(exported.folder)]
    process = subprocess.Popen(command, cwd=QUARTET.parents[2], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 600
    while not list(exported.folder.rglob("draft/**/*.fbx")):
        assert time.monotonic() < deadline
        time.sleep(0.05)
    process.send_signal(ending)
    assert process.wait(60) != 0
    after = {name: data for name, data in tree_of(exported.folder).items() if ".partial/" not in name}
    assert after == before
    export(request)
    assert tree_of(exported.folder) == before


def test_the_plug_in_is_put_there_once(exported: UnrealProject, export: Export) -> None:
    assert not export(request_of(quartet())).plan.plugin


def plugin_of_before(place: Path, version: int) -> None:
    """Plug-in as left by an export of another version."""
    files = {"Suisou.uplugin": json.dumps({"CreatedBy": "Suisou", "Version": version}), "Content/Python/old.py": "1\n"}
    for name, content in files.items():
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_text(content)
    own = {name: own_file(place / name) for name in files}
    (place / "manifest.json").write_bytes(encode_manifest(own, "Suisou of before"))


@pytest.mark.parametrize("version", [0, 1, 2])
def test_an_older_plug_in_is_replaced(unreal: UnrealProject, export: Export, version: int) -> None:
    place = unreal.folder / "Plugins" / "Suisou"
    plugin_of_before(place, version)
    (place / "Content/Python/mine.py").write_text("mine")
    assert export(request_of(quartet())).plan.plugin
    assert not (place / "Content/Python/old.py").exists()
    assert (place / "Content/Python/mine.py").read_text() == "mine"
    assert (place / "Content/Python/init_unreal.py").exists()


def test_a_newer_plug_in_stays(unreal: UnrealProject, export: Export) -> None:
    place = unreal.folder / "Plugins" / "Suisou"
    plugin_of_before(place, 1000)
    before = tree_of(place)
    assert not export(request_of(quartet())).plan.plugin
    assert tree_of(place) == before


def test_another_ones_plug_in_is_reported(unreal: UnrealProject, export: Export) -> None:
    place = unreal.folder / "Plugins" / "Suisou"
    place.mkdir()
    (place / "Suisou.uplugin").write_text('{"CreatedBy": "another user", "Version": 1}')
    before = tree_of(unreal.folder)
    with pytest.raises(FileError) as caught:
        export(request_of(quartet()))
    assert caught.value.message.id == "unreal.plugin_foreign"
    assert tree_of(unreal.folder) == before


def test_a_name_that_differs_in_case_is_the_same_piece(exported: UnrealProject) -> None:
    plan = plan_export(request_of(quartet()).performance, (), "QUARTET.mid", exported)
    assert plan.layout.piece == "quartet"


def test_the_same_music_under_another_name_is_remarked(exported: UnrealProject) -> None:
    performance = request_of(quartet()).performance
    renamed = plan_export(performance, (), "quartet final.mid", exported)
    (remark,) = renamed.remarks
    assert (remark.id, remark.arguments) == (
        "unreal.second_performance",
        {"piece": renamed.layout.piece, "earlier": "quartet"},
    )
    other = replace(
        performance.project, players=(msgspec.structs.replace(performance.project.players[0], name="Solo"),)
    )
    assert plan_export(Performance(other), (), "solo.mid", exported).remarks == ()


@pytest.mark.parametrize(
    ("bars", "remark"),
    [((1, 1), None), (None, "export.bars_before"), ((1, 2), "export.other_bars_before")],
    ids=["the same bars", "all", "others"],
)
def test_other_bars_than_before_are_remarked(
    exported: UnrealProject, bars: tuple[int, int] | None, remark: str | None
) -> None:
    plan = plan_export(request_of(quartet()).performance, (), "quartet.mid", exported, bars=bars)
    assert [message.id for message in plan.remarks] == ([] if remark is None else [remark])


def test_places_as_unreal_has_them() -> None:
    """+X of the project is Unreal's X and +Z its Y; a rotation from +Z towards +X is from Y towards X, a
    negative yaw.
    """
    place = place_of(StagePosition(1.0, -2.0, np.pi / 2))
    assert (place.x_cm, place.y_cm, place.z_cm, place.yaw_deg) == (100.0, -200.0, 0.0, -90.0)


def test_the_command_line(unreal: UnrealProject, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["export", str(QUARTET), "--unreal", str(unreal.file), "--fps", "12", "--player", "Trumpet 1"]
    bars = ["--from-bar", "1", "--to-bar", "1"]
    assert main([*arguments, *bars]) == 0
    reported = capsys.readouterr().out
    for name in OURS:
        assert name.rsplit("/", 1)[-1] in reported
    assert "Unreal Engine 5.6" in reported
    assert "skeleton: Unreal Engine 5's mannequin (--skeleton own" in reported
    assert description(unreal)["players"][0]["character"]["bones"][:2] == ["root", "pelvis"]
    assert main([*arguments, *bars]) == 0
    assert "S_quartet.wav (replaced)" in capsys.readouterr().out
    assert main([*arguments, "--format", "fbx"]) == 2
    assert "--format" in capsys.readouterr().err
    assert main(["export", str(QUARTET), "--unreal", str(unreal.folder / "no.uproject")]) == 1
    assert "no.uproject" in capsys.readouterr().err
    assert main([*arguments, "--to", "x"]) == 2
    assert "--to" in capsys.readouterr().err
    assert find_project(unreal.folder).engine == "5.6"


@pytest.mark.skipif(os.name != "posix", reason="links need a privilege elsewhere")
@pytest.mark.parametrize(
    "place", ["SuisouSource", "SuisouSource/quartet", "SuisouSource/quartet/Characters", "Plugins"]
)
def test_nothing_is_written_through_a_link_out_of_the_project(
    unreal: UnrealProject, export: Export, tmp_path: Path, place: str
) -> None:
    outside, link = tmp_path / "home", unreal.folder / place
    outside.mkdir()
    if link.is_dir():
        shutil.rmtree(link)
    link.symlink_to(outside, target_is_directory=True)
    request = request_of(quartet())
    for attempt in (
        lambda: plan_export(request.performance, (request.players[0].id,), "quartet.mid", unreal),
        lambda: export(request),
    ):
        with pytest.raises(FileError) as caught:
            attempt()
        assert caught.value.message.id == "tree.leads_outside"
        assert caught.value.message.arguments["file"] == str(link)
    assert list(outside.iterdir()) == []


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes with names")
def test_a_manifest_that_is_no_file_is_named(unreal: UnrealProject, export: Export) -> None:
    """Reading a pipe would wait forever."""
    os.mkfifo(unreal.folder / "SuisouSource/quartet/manifest.json")
    with pytest.raises(FileError) as caught:
        export(request_of(quartet()))
    assert caught.value.message.id == "unreal.manifest"
