"""Motion files that pose players: exported ones read back, edited ones, and unusable ones."""

from __future__ import annotations

import shutil
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.errors import FileError
from app.evaluation.excerpts import Excerpt
from app.evaluation.keyframes import holds_motion, read_keyframes
from app.export.bvh_clip import scene_bvh
from app.export.character import character_scene
from app.export.humanoid import humanoid_scene, humanoid_target
from app.export.target import normalised_target
from app.formats.bvh.read import read_bvh
from app.formats.bvh.write import write_bvh
from app.formats.gltf.vrma import write_vrma
from app.motion.model import Motion
from app.performance.cast import performer_of
from app.performance.chunks import Pose
from app.performance.ensemble import Performance
from app.performance.motion import player_motion
from app.performance.span import cut_span
from app.rig import quaternion
from tests.unit.viewport.poses import quartet

FPS, FROM_S, LENGTH_S = Fraction(12), 1.0, 2.0


@pytest.fixture(scope="module")
def performance() -> Performance:
    return Performance(quartet())


def motion_of(performance: Performance, name: str) -> Motion:
    player = next(player for player in performance.project.players if player.name == name)
    span = cut_span(performance.time_frame, FPS, FROM_S, FROM_S + LENGTH_S)
    return player_motion(performance, performer_of(performance, player), span)


@pytest.fixture(scope="module")
def exported(performance: Performance, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two players as exported by `suisou export`."""
    folder = tmp_path_factory.mktemp("exported")
    for name in ("Trumpet 1", "Trombone 1"):
        export_bvh(performance, name, folder)
    return folder


def export_bvh(performance: Performance, name: str, folder: Path) -> None:
    """Write some seconds of a player as in `suisou export`, with the parts of the report that are read."""
    player = next(player for player in performance.project.players if player.name == name)
    character, motion = performer_of(performance, player).character, motion_of(performance, name)
    scene = character_scene(character, motion, name, "test", normalised_target(character.skeleton), ())
    write_bvh(folder / f"{name}.bvh", scene_bvh(scene))
    (folder / "report.json").write_text(f'{{"first_frame_s": {motion.first_frame_s}, "frames": 24}}')


def apart_rad(one: np.ndarray, other: np.ndarray) -> float:
    turns = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(one), other))
    return float(np.linalg.norm(turns, axis=-1).max())


def player_id(performance: Performance, name: str) -> str:
    return next(player.id for player in performance.project.players if player.name == name)


def test_an_exported_file_is_seen_as_it_was_and_goes_where_it_is_moved(
    performance: Performance, exported: Path, tmp_path: Path
) -> None:
    trumpet, motion = player_id(performance, "Trumpet 1"), motion_of(performance, "Trumpet 1")
    clip = read_bvh(exported / "Trumpet 1.bvh")
    moved = tmp_path / "Trumpet 1.bvh"
    write_bvh(moved, replace(clip, root_translation_cm=clip.root_translation_cm + np.array([10.0, 0.0, 0.0])))
    seen = read_keyframes(performance, exported, [trumpet])
    aside = read_keyframes(performance, moved, [trumpet], offset_s=motion.first_frame_s + 0.5)
    assert seen.covered_s == pytest.approx((FROM_S, FROM_S + LENGTH_S), abs=0.1)
    for frame in (0, 7, 12):
        time_s, pose = motion.first_frame_s + frame / float(FPS), Pose.of(motion, frame)
        same = seen.posed(trumpet, time_s, pose)
        assert apart_rad(same.rotations, pose.rotations) < 1e-3
        assert same.hips_m == pytest.approx(pose.hips_m, abs=1e-5)
        assert same.instrument_position_m == pytest.approx(pose.instrument_position_m, abs=1e-4)
        assert same.morphs == pose.morphs
        later = aside.posed(trumpet, time_s + 0.5, pose)
        assert later.hips_m - pose.hips_m == pytest.approx((0.1, 0.0, 0.0), abs=1e-5)
        assert later.instrument_position_m - pose.instrument_position_m == pytest.approx((0.1, 0.0, 0.0), abs=1e-4)
    between = seen.posed(trumpet, motion.first_frame_s + 2.5 / float(FPS), Pose.of(motion, 2))
    assert between.hips_m == pytest.approx((motion.hips_m[2] + motion.hips_m[3]) / 2, abs=1e-5)
    other = Pose.of(motion_of(performance, "Trumpet 2"), 0)
    assert seen.posed(player_id(performance, "Trumpet 2"), FROM_S, other) is other


def test_a_vrm_animation_is_seen_as_it_was_with_the_eyes_of_the_performance(
    performance: Performance, tmp_path: Path
) -> None:
    player = next(player for player in performance.project.players if player.name == "Trumpet 1")
    character, motion = performer_of(performance, player).character, motion_of(performance, "Trumpet 1")
    scene = humanoid_scene(character, motion, "Trumpet 1", "test", humanoid_target(character))
    write_vrma(tmp_path / "Trumpet 1.vrma", scene)
    seen = read_keyframes(performance, tmp_path / "Trumpet 1.vrma", [player.id], offset_s=motion.first_frame_s)
    for frame in (0, 7, 12):
        time_s, pose = motion.first_frame_s + frame / float(FPS), Pose.of(motion, frame)
        same = seen.posed(player.id, time_s, pose)
        assert apart_rad(same.rotations, pose.rotations) < 1e-3
        assert same.hips_m == pytest.approx(pose.hips_m, abs=1e-5)
        assert same.instrument_position_m == pytest.approx(pose.instrument_position_m, abs=1e-4)


def test_bones_that_another_program_turned_upright_are_turned_back(
    performance: Performance, exported: Path, tmp_path: Path
) -> None:
    """Blender writes BVH with Z up."""
    clip = read_bvh(exported / "Trumpet 1.bvh")
    quarter = np.array([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])
    write_bvh(
        tmp_path / "Trumpet 1.bvh",
        replace(
            clip,
            offsets_cm=quaternion.rotate(quarter, clip.offsets_cm),
            root_translation_cm=quaternion.rotate(quarter, clip.root_translation_cm),
            rotations_xyzw=quaternion.multiply(
                quarter, quaternion.multiply(clip.rotations_xyzw, quaternion.conjugate(quarter))
            ),
        ),
    )
    trumpet = player_id(performance, "Trumpet 1")
    found, seen = (read_keyframes(performance, folder, [trumpet]).players[trumpet] for folder in (tmp_path, exported))
    assert found.hips_m == pytest.approx(seen.hips_m, abs=1e-5)
    assert apart_rad(found.rotations, seen.rotations) < 1e-4


@pytest.mark.parametrize(
    ("change", "error"),
    [
        (("JOINT spine\n", "JOINT Bip01\n"), "keyframes_bones"),
        (("JOINT", "JOINT own"), "keyframes_skeleton"),
        (("ROOT hips", "ROOT pelvis"), "keyframes_skeleton"),
    ],
)
def test_a_file_of_another_skeleton_is_refused(
    performance: Performance, exported: Path, tmp_path: Path, change: tuple[str, str], error: str
) -> None:
    text = (exported / "Trumpet 1.bvh").read_text()
    (tmp_path / "Trumpet 1.bvh").write_text(text.replace(*change))
    with pytest.raises(FileError, match=error):
        read_keyframes(performance, tmp_path / "Trumpet 1.bvh", [player_id(performance, "Trumpet 1")])


def test_files_that_are_not_the_players_are_refused(performance: Performance, exported: Path, tmp_path: Path) -> None:
    trumpet = player_id(performance, "Trumpet 1")
    shutil.copy(exported / "Trombone 1.bvh", tmp_path / "Trumpet 1.bvh")
    with pytest.raises(FileError, match="keyframes_body"):
        read_keyframes(performance, tmp_path, [trumpet])
    with pytest.raises(FileError, match="keyframes_lacking") as raised:
        read_keyframes(performance, exported)
    assert raised.value.message.arguments["player"] == "Trumpet 2"
    shutil.copy(exported / "Trumpet 1.bvh", tmp_path / "take.bvh")
    with pytest.raises(FileError, match="keyframes_player"):
        read_keyframes(performance, tmp_path / "take.bvh")
    found = read_keyframes(performance, tmp_path / "take.bvh", [trumpet], 0.0)
    assert list(found.players) == [trumpet]
    with pytest.raises(FileError, match="not_covered"):
        found.require_covered(Excerpt(1.5, 2.5))
    (tmp_path / "report.json").write_text("{}")
    with pytest.raises(FileError, match="keyframes_report"):
        read_keyframes(performance, tmp_path / "take.bvh", [trumpet])


def test_a_file_of_an_earlier_export_keeps_its_place(performance: Performance, exported: Path, tmp_path: Path) -> None:
    trumpet = next(player.id for player in performance.project.players if player.name == "Trumpet 1")
    shutil.copy(exported / "Trumpet 1.bvh", tmp_path)
    (tmp_path / "report.json").write_text(
        '{"first_frame_s": 20.0, "earlier": [{"bars": [9, 11], "first_frame_s": 0.5, "files": ["trumpet 1.BVH"]}]}'
    )
    assert read_keyframes(performance, tmp_path, [trumpet]).covered_s[0] == 0.5
    assert read_keyframes(performance, tmp_path, [trumpet], 3.0).covered_s[0] == 3.0


def test_videos_are_no_motion(tmp_path: Path) -> None:
    assert not holds_motion(tmp_path / "film.mp4")
    assert holds_motion(tmp_path / "Take.BVH")
    assert holds_motion(tmp_path)
