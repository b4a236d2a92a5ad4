"""Dancers' files, read back: bones, standing feet, the report, and BVH read as another maker's motion."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.choreography.model_file import write_model
from app.choreography.performed.dancers import dancing_of
from app.choreography.read_motion import read_motion
from app.choreography.soles_on_floor import SINKS_M
from app.export.dancers import measure_dancer
from app.export.report import Report
from app.export.request import ExportRequest
from app.export.run import export
from app.export.targets import target_skeleton
from app.formats.fbx.read import read_scene, read_scenes
from app.messages import text
from app.performance.ensemble import Performance
from app.performance.span import cut_span, whole_span
from app.project.casting import StagePosition
from app.project.model import Project
from app.project.performers import Dancer
from tests.support.dances import model
from tests.support.skinned import GlbFile
from tests.unit.choreography.performed.test_dancers import played

FPS = Fraction(60)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Report, Path, Project]:
    folder = tmp_path_factory.mktemp("dancers")
    write_model(folder / "steps.choreography", model())
    dances = str(folder / "steps.choreography")
    dancers = (
        Dancer("dancer:1", "Dancer: 1/2", dances, "woman_adult", StagePosition(0.0, 2.0, 0.0)),
        Dancer("dancer:2", "Removed", str(folder / "gone.choreography"), "man_adult", StagePosition(1.0, 2.0, 0.0)),
    )
    project = replace(played(), dancers=dancers)
    performance = Performance(project)
    span = whole_span(performance.time_frame, FPS)
    formats = frozenset(("fbx", "bvh"))
    request = ExportRequest(
        performance, (), folder / "out", formats, span, None, "piece.mid", "test", dancers=dancers, stage=True
    )
    return export(replace(request, stage=True), text), folder / "out", project


def test_who_can_dance_is_written_and_the_other_named(written: tuple[Report, Path, Project]) -> None:
    report, folder, _ = written
    assert [one.name for one in report.dancers] == ["Dancer: 1/2"]
    assert [one.player for one in report.left_out] == ["Removed"]
    files = report.dancers[0].files
    assert set(files) == {"character_fbx", "character_bvh"}
    written_files = sorted(path.name for path in folder.iterdir() if path.is_file())
    assert written_files == sorted([*files.values(), "piece_stage.fbx", "report.json"])
    assert report.file_count == 4 + len(report.textures)
    assert [figure.node for figure in report.stage.figures] == ["Dancer_ 1_2"]
    (scene,) = read_scenes(folder / "piece_stage.fbx")
    np.testing.assert_allclose(scene.place.matrix[:3, 3], (0.0, 0.0, 200.0))
    reported = json.loads((folder / "report.json").read_text())
    assert reported["dancers"][0]["stage"] == {"x_m": 0.0, "z_m": 2.0, "turn_deg": 0.0}
    assert reported["dancers"][0]["choreography"] == "steps"


def test_bones_keep_their_length_and_feet_stand(written: tuple[Report, Path, Project]) -> None:
    measures = written[0].dancers[0].measures
    assert measures.standing_s > 5.0
    assert measures.kept
    # A foot that touches the floor rolls on: .9 mm a frame where it brushes it for four frames only.
    assert measures.slide_mm_s < 1.5
    assert measures.slide_most_mm_s < 60.0
    assert measures.below_mm < 2.0


def test_a_foot_that_sinks_into_the_floor_is_measured_whichever_it_is(written: tuple[Report, Path, Project]) -> None:
    report, folder, project = written
    dancing = dancing_of(Performance(project), project.dancers[0])
    scene, target = (
        read_scene(folder / report.dancers[0].files["character_fbx"]),
        target_skeleton(dancing.character, "suisou"),
    )
    assert scene.clip is not None
    span = whole_span(Performance(project).time_frame, FPS)
    standing = dancing.standing(FPS, span.first, span.count)
    for foot, side in enumerate(("left", "right")):
        # Three centimetres down its leg, in one frame.
        bone = next(number for number, bone in enumerate(scene.bones) if bone.name == f"{side}Foot")
        sunk_cm = np.tile(scene.bones[bone].translation_cm, (scene.clip.frames, 1))
        sunk_cm[np.flatnonzero(standing[:, foot])[0], 1] -= 3.0
        clip = replace(scene.clip, translations_cm={**scene.clip.translations_cm, bone: sunk_cm})
        measures = measure_dancer(replace(scene, clip=clip), dancing.character, target, standing)
        assert measures.below_mm == pytest.approx(30.0, abs=5.0), side
        assert measures.bones_mm == pytest.approx(30.0, abs=1.0)


def test_the_bvh_file_moves_as_the_dance_does(written: tuple[Report, Path, Project]) -> None:
    report, folder, project = written
    performance = Performance(project)
    dancing = dancing_of(performance, project.dancers[0])
    read = read_motion(folder / report.dancers[0].files["character_bvh"]).clip
    dance = dancing.dance(FPS).clip
    assert len(read) == len(dance) == report.frames
    # Arms of the capture and of the file go the same ways: directions of upper arms in the world.
    ours, theirs = dance.world(), read.world()
    for joint, nxt in ((5, 6), (8, 9)):
        ways = [world.positions_m[:, nxt] - world.positions_m[:, joint] for world in (ours, theirs)]
        one, other = (way / np.linalg.norm(way, axis=1, keepdims=True) for way in ways)
        assert np.einsum("fi,fi->f", one, other).min() > 0.97


def test_a_dancer_who_was_moved_and_renamed_is_written_as_now(
    written: tuple[Report, Path, Project], tmp_path: Path
) -> None:
    """Dances are cached independently of the dancer's place and name."""
    _, _, project = written
    now = msgspec.structs.replace(project.dancers[0], name="Now", stage=StagePosition(-2.0, 4.0, 0.0))
    performance = Performance(replace(project, dancers=(now,)))
    span = whole_span(performance.time_frame, FPS)
    request = ExportRequest(
        performance, (), tmp_path / "out", frozenset(("bvh",)), span, None, "piece.mid", "test", dancers=(now,)
    )
    [reported] = export(request, text).dancers
    assert (reported.name, reported.stage.x_m, reported.stage.z_m) == ("Now", -2.0, 4.0)
    assert (tmp_path / "out" / "Now.bvh").is_file()


def test_no_sole_of_a_written_file_sinks_into_the_floor_while_a_foot_rolls(tmp_path: Path) -> None:
    """Around the ball the skin moves with the foot and the toes in parts; vertices are those of a reader of its own."""
    dancer = Dancer("dancer:1", "One", "salsa", "woman_adult", StagePosition(0.0, 2.0, 0.0), seed=1)
    performance = Performance(replace(played(), dancers=(dancer,)))
    span = cut_span(performance.time_frame, Fraction(30), 6.0, 8.0)
    export(
        ExportRequest(
            performance, (), tmp_path, frozenset(("glb",)), span, None, "piece.mid", "test", dancers=(dancer,)
        ),
        text,
    )
    file = GlbFile(tmp_path / "One.glb")
    shown = [file.shown(frame) for frame in range(file.frames)]
    lowest_mm = 10.0 * np.array([min(corners[:, 1].min() for corners in one.corners_cm.values()) for one in shown])
    toes, foot = (file.names.index(f"left{part}") for part in ("Toes", "Foot"))
    assert len(lowest_mm) == 60
    assert lowest_mm.min() > -1000.0 * SINKS_M - 0.2
    # It does roll: the ankle is raised over the ball.
    assert max(one.joints_cm[foot, 1] - one.joints_cm[toes, 1] for one in shown) > 9.0
