"""Dancers in an Unreal project: files and description read back, dancers who cannot dance, all or nothing."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest

from app.choreography.performed.dancers import dancing_of
from app.errors import FileError
from app.export.playback import ScenePlayback
from app.export.unreal import run
from app.export.unreal.layout import layout_of
from app.export.unreal.project import UnrealProject
from app.export.unreal.run import plan_export
from app.formats.fbx.read import read_scene
from app.project.model import Project
from app.rig.skeleton import forward
from tests.unit.export.unreal.conftest import Export, quartet, renamed, request_of, tree_of, with_dancers

SOURCES = "SuisouSource/quartet"
BOTH = ("Trumpet 1", "Ana")


@pytest.fixture
def danced(tmp_path: Path) -> Project:
    return with_dancers(quartet(), tmp_path, "Ana", "Bo")


def read(unreal: UnrealProject, name: str) -> dict[str, Any]:
    content: dict[str, Any] = json.loads((unreal.folder / SOURCES / name).read_text(encoding="utf-8"))
    return content


def test_a_dancer_is_written_as_a_player_is(unreal: UnrealProject, export: Export, danced: Project) -> None:
    before = set(tree_of(unreal.folder))
    request = request_of(danced, BOTH)
    written = export(request)
    new = {name for name in set(tree_of(unreal.folder)) - before if name.startswith(SOURCES)}
    assert {path.as_posix() for path in written.plan.written if path.as_posix().startswith(SOURCES)} == new
    reported = read(unreal, "performance.json")
    assert [player["name"] for player in reported["players"]] == ["Trumpet 1"]
    (dancer,) = reported["dancers"]
    assert set(dancer) == {"name", "choreography", "character_id", "stage", "place", "character"}
    assert (dancer["name"], dancer["choreography"], dancer["character_id"]) == ("Ana", "steps", "woman_adult")
    assert (dancer["place"]["x_cm"], dancer["place"]["y_cm"]) == (-50.0, 200.0)
    assert dancer["place"]["yaw_deg"] == pytest.approx(-np.degrees(0.5), abs=1e-3)
    figure = dancer["character"]
    assert figure["mesh"] == "/Game/Suisou/quartet/Bodies/woman_adult/SK_woman_adult"
    assert figure["animation"] == "/Game/Suisou/quartet/Characters/Ana/A_Ana"
    assert figure["file"] == "Characters/SK_Ana.fbx"
    assert figure["file"] in reported["files"]
    report = read(unreal, "report.json")
    assert report["warnings"] == list(written.report.warnings)
    assert not any("dancer" in warning for warning in report["warnings"])
    assert report["dancers"][0]["files"] == {"character_fbx": figure["file"]}
    assert written.report.dancers[0].measures is not None
    assert written.report.dancers[0].measures.kept


def test_the_file_holds_the_dance(unreal: UnrealProject, export: Export, danced: Project) -> None:
    """Hips and feet are in every frame where the viewport's motion has them."""
    request = request_of(danced, ("Ana",), last_bar=3)
    export(request)
    (dancer,) = read(unreal, "performance.json")["dancers"]
    scene = read_scene(unreal.folder / SOURCES / dancer["character"]["file"])
    assert [bone.name for bone in scene.bones] == dancer["character"]["bones"]
    assert scene.clip is not None
    span = request.span
    assert scene.clip.frames == span.count
    assert {"eyeBlinkLeft", "eyeBlinkRight"} <= set(scene.clip.morph_weights)
    dancing = dancing_of(request.performance, danced.dancers[0])
    motion, skeleton = dancing.motion(span.fps, span.first, span.count), dancing.character.skeleton
    playback = ScenePlayback(scene, scene.clip)
    world_m = playback.world(0, span.count)[..., :3, 3]
    joints = [skeleton.index(name) for name in ("hips", "leftFoot", "rightFoot", "head")]
    expected_m = forward(skeleton, motion.rotations, motion.hips_m).positions_m
    found_m = world_m[:, [playback.bone_names.index(skeleton.names[joint]) for joint in joints]]
    assert np.abs(found_m - expected_m[:, joints]).max() < 1e-3
    # A dance, not a pose.
    assert np.ptp(found_m[:, 1], axis=0).max() > 0.05


def test_dancers_rename_no_player(tmp_path: Path) -> None:
    before = layout_of(renamed(quartet(), ["A", "A_trumpet_Bb", "B", "C"]), "x")
    after = layout_of(with_dancers(renamed(quartet(), ["A", "A_trumpet_Bb", "B", "C"]), tmp_path, "a", "é!"), "x")
    assert {id: after.characters[id] for id in before.characters} == before.characters
    assert after.instruments == before.instruments
    places = [*after.characters.values(), *after.instruments.values()]
    assert len({place.animation.casefold() for place in places}) == len(places) == 10
    # Body and bones alike, or they are another's.
    assert after.bodies == {id: id for id in (*(player.character_id for player in quartet().players), "woman_adult")}
    meshes = {after.body(one, added) for one in quartet().players for added in ((), ("hand_l_socket",))}
    assert len(meshes) == 2 * len({one.character_id for one in quartet().players})


def test_a_dancer_who_is_not_needed_any_more_goes(unreal: UnrealProject, export: Export, danced: Project) -> None:
    export(request_of(danced, ("Ana", "Bo")))
    written = export(request_of(danced, ("Ana",)))
    assert [path.name for path in written.plan.removed] == ["SK_Bo.fbx"]
    assert not (unreal.folder / SOURCES / "Characters/SK_Bo.fbx").exists()
    assert [dancer["name"] for dancer in read(unreal, "performance.json")["dancers"]] == ["Ana"]


def test_who_cannot_dance_is_named_and_stays_as_exported(
    unreal: UnrealProject, export: Export, danced: Project
) -> None:
    two = ("Ana", "Bo")
    export(request_of(danced, two))
    kept = (unreal.folder / SOURCES / "Characters/SK_Ana.fbx").read_bytes()
    gone = msgspec.structs.replace(danced.dancers[0], choreography=str(unreal.folder / "gone.choreography"))
    export(request_of(replace(danced, dancers=(gone, danced.dancers[1])), two, last_bar=2))
    reported = read(unreal, "performance.json")
    assert [dancer["name"] for dancer in reported["dancers"]] == ["Bo"]
    (left_out,) = reported["left_out"]
    assert left_out["name"] == "Ana"
    assert "gone.choreography" in left_out["reason"]
    assert left_out["assets"] == ["/Game/Suisou/quartet/Characters/Ana/A_Ana"]
    assert (unreal.folder / SOURCES / "Characters/SK_Ana.fbx").read_bytes() == kept
    # The file is still ours: the next export replaces it.
    export(request_of(danced, ("Ana",), last_bar=2))
    assert (unreal.folder / SOURCES / "Characters/SK_Ana.fbx").read_bytes() != kept


@pytest.mark.parametrize("stage", ["write_cast", "check_fbx"])
def test_a_fault_at_a_dancer_leaves_the_old_tree(
    unreal: UnrealProject, export: Export, danced: Project, monkeypatch: pytest.MonkeyPatch, stage: str
) -> None:
    export(request_of(danced, ("Bo",)))
    before = tree_of(unreal.folder)
    real = getattr(run, stage)

    def failing(*arguments: Any, **named: Any) -> Any:
        result = real(*arguments, **named)
        if stage == "write_cast" or arguments[0].name == "SK_Ana.fbx":
            raise FileError("unreal.file_wrong", file="SK_Ana.fbx", what="frames", found="1", requested="2")
        return result

    monkeypatch.setattr(run, stage, failing)
    with pytest.raises(FileError):
        export(request_of(danced, ("Bo", "Ana"), last_bar=2))
    assert tree_of(unreal.folder) == before


def test_an_artists_file_in_the_way_of_a_dancer_is_not_replaced(
    unreal: UnrealProject, export: Export, danced: Project
) -> None:
    theirs = unreal.folder / SOURCES / "Characters/SK_Ana.fbx"
    theirs.parent.mkdir(parents=True)
    theirs.write_bytes(b"mine")
    request = request_of(danced, ("Ana",))
    ids = (request.dancers[0].id,)
    for attempt in (
        lambda: plan_export(request.performance, ids, "quartet.mid", unreal),
        lambda: export(request),
    ):
        with pytest.raises(FileError) as caught:
            attempt()
        assert caught.value.message.id == "unreal.in_the_way"
    assert theirs.read_bytes() == b"mine"
