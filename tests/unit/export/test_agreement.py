"""FBX, GLB and USD files of one player agree at every frame rate: names, frames, joints, morphs and
deformed surfaces.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.export.character import character_scene
from app.export.instrument import instrument_scene
from app.export.playback import ScenePlayback, Surface
from app.export.target import SkeletonChoice
from app.export.targets import target_skeleton
from app.formats.fbx.read import read_scene
from app.formats.fbx.write import write_scene
from app.formats.gltf.write import write_glb
from app.formats.scene import Scene
from app.formats.usd import write_usd
from app.formats.usd_package import usd_installed
from app.motion.model import Motion
from app.performance.bodies import character_of, model_of
from app.performance.ensemble import Performance
from app.performance.span import bars_span
from app.rig.characters.load_character import load_character
from tests.gui.conftest import quartet_project
from tests.support import readers
from tests.support.performed import player_motion
from tests.support.skinned import GlbFile, Shown, UsdFile
from tests.unit.formats import scenes

FOREIGN = Path(__file__).parents[2] / "data" / "characters"
RATES = [Fraction(24), Fraction(25), Fraction(30000, 1001), Fraction(30), Fraction(60)]
BARS = (2, 3)
WITHIN_CM = 0.01
WEIGHTS_WITHIN = 1e-5


@pytest.fixture(scope="module")
def performance() -> Performance:
    return Performance(quartet_project())


def _scenes(performance: Performance, fps: Fraction) -> dict[str, Scene]:
    player = performance.project.players[0]
    span = bars_span(performance, fps, BARS, performance.project.preroll_beats)
    motion = player_motion(performance, player, span)
    instrument = performance.instrument(player)
    return {
        "character": character_scene(character_of(player), motion, player.name, "Suisou"),
        "instrument": instrument_scene(instrument, model_of(instrument), motion, player.name, "Suisou"),
    }


def _shown_by_fbx(scene: Scene, frame: int) -> Shown:
    assert scene.clip is not None
    playback = ScenePlayback(scene, scene.clip)
    world = playback.world(frame, frame + 1)
    (mesh,) = scene.meshes
    points = Surface(playback, mesh, np.arange(len(mesh.vertices_cm))).positions_m(world, frame, frame + 1)[0] * 100
    assert mesh.face_materials is not None
    return Shown(
        100 * world[0, :, :3, 3],
        {name: float(curve[frame]) for name, curve in scene.clip.morph_weights.items()},
        {
            material.name: points[mesh.faces[mesh.face_materials == number].ravel()]
            for number, material in enumerate(mesh.materials)
        },
    )


def _compare(one: Shown, other: Shown) -> np.ndarray:
    """Greatest differences of joints and surfaces in cm, and of weights."""
    assert set(one.corners_cm) == set(other.corners_cm)
    surfaces = max(np.abs(points - other.corners_cm[name]).max() for name, points in one.corners_cm.items())
    names = set(one.weights) | set(other.weights)
    weights = max((abs(one.weights.get(name, 0.0) - other.weights.get(name, 0.0)) for name in names), default=0.0)
    return np.array([np.abs(one.joints_cm - other.joints_cm).max(), surfaces, weights])


@pytest.mark.parametrize(
    ("held", "fps"),
    # Rates are written alike for both; an instrument is small.
    [*(("instrument", fps) for fps in RATES), ("character", RATES[0]), ("character", RATES[2])],
    ids=lambda value: value if isinstance(value, str) else f"{float(value):.2f}",
)
def test_the_files_agree(performance: Performance, held: str, fps: Fraction, tmp_path: Path) -> None:
    scene = _scenes(performance, fps)[held]
    assert scene.clip is not None
    write_scene(tmp_path / "player.fbx", scene)
    write_glb(tmp_path / "player.glb", scene)
    fbx, glb = read_scene(tmp_path / "player.fbx"), GlbFile(tmp_path / "player.glb")
    assert fbx.clip is not None
    names = [bone.name for bone in fbx.bones]
    frames = fbx.clip.frames
    assert names == glb.names == [bone.name for bone in scene.bones]
    assert [bone.parent for bone in fbx.bones] == [glb.parents[joint] for joint in glb.joints]
    assert frames == glb.frames == scene.clip.frames
    assert fbx.clip.fps == fps
    np.testing.assert_array_equal(glb.times, (np.arange(frames) / float(fps)).astype(np.float32))
    others: dict[str, Callable[[int], Shown]] = {"GLB": glb.shown}
    if usd_installed():
        write_usd(tmp_path / "player.usdc", scene)
        usd = UsdFile(tmp_path / "player.usdc")
        assert usd.names == names
        assert usd.frames == frames
        assert usd.fps == float(fps)
        others["USD"] = usd.shown
    greatest = {name: np.zeros(3) for name in others}
    for frame in np.linspace(0, frames - 1, 6).astype(int).tolist():
        meant = _shown_by_fbx(fbx, frame)
        for name, shown in others.items():
            greatest[name] = np.maximum(greatest[name], _compare(meant, shown(frame)))
    for name, (joints_cm, surfaces_cm, weights) in greatest.items():
        print(
            f"\n{name} {held} at {float(fps):.2f}: joints {joints_cm * 1e4:.2f} um, "
            f"surfaces {surfaces_cm * 1e4:.2f} um, weights {weights:.1e}",
            file=sys.stderr,
        )
        assert max(joints_cm, surfaces_cm) < WITHIN_CM
        assert weights < WEIGHTS_WITHIN


@pytest.mark.skipif(not usd_installed(), reason="usd-core is not installed")
@pytest.mark.parametrize("choice", ["own", "ue5"])
@pytest.mark.parametrize("file", ["elder_vrm0.vrm", "child_mixamo.fbx", "woman_game_engine.glb"])
def test_characters_of_other_makers_agree_on_their_skeletons(file: str, choice: SkeletonChoice, tmp_path: Path) -> None:
    character = load_character(FOREIGN / file, "foreign")
    turns = scenes.rotations(5, 6, len(character.skeleton.names), 0.3).astype(np.float32)
    turns[:, 0] = [0, 0, 0, 1]
    hips_m = np.tile(np.float32(character.skeleton.offsets_m[character.skeleton.index("hips")]), (6, 1))
    known = {} if character.own is None else character.own.morphs
    morphs = {name: np.linspace(0, 1, 6, dtype=np.float32) for name in known}
    still = np.zeros((6, 3), np.float32), np.tile(np.float32([0, 0, 0, 1]), (6, 1))
    motion = Motion(Fraction(30), 0.0, turns, hips_m, morphs, {}, *still)
    scene = character_scene(character, motion, "take", "Suisou", target_skeleton(character, choice))
    write_glb(tmp_path / "player.glb", scene)
    write_usd(tmp_path / "player.usdc", scene)
    glb, usd = GlbFile(tmp_path / "player.glb"), UsdFile(tmp_path / "player.usdc")
    assert glb.names == usd.names == [bone.name for bone in scene.bones]
    for frame in (0, 5):
        joints_cm, surfaces_cm, weights = _compare(glb.shown(frame), usd.shown(frame))
        assert max(joints_cm, surfaces_cm) < WITHIN_CM
        assert weights < WEIGHTS_WITHIN


@pytest.mark.parametrize("fps", RATES, ids=lambda fps: f"{float(fps):.2f}")
def test_other_programs_readers_agree(performance: Performance, fps: Fraction, tmp_path: Path) -> None:
    scene = _scenes(performance, fps)["character"]
    frames = [0, 9, scene.clip.frames - 1]
    world_cm = 100 * ScenePlayback(scene, scene.clip).world(0, scene.clip.frames)[frames][..., :3, 3]
    names = [bone.name for bone in scene.bones]
    expected = readers.Expected(
        fps=fps,
        frames=scene.clip.frames,
        sampled=frames,
        joints_cm={name: world_cm[:, index] for index, name in enumerate(names)},
        parents={bone.name: names[bone.parent] if bone.parent >= 0 else None for bone in scene.bones},
        weights={name: np.asarray(curve)[frames] for name, curve in scene.clip.morph_weights.items()},
    )
    written = (
        (write_scene, "player.fbx", readers.QUICK_FBX),
        (write_glb, "player.glb", readers.QUICK_GLB),
        (write_usd, "player.usdc", readers.QUICK_USD if usd_installed() else ()),
    )
    for write, name, asked in written:
        if asked:
            write(tmp_path / name, scene)
            readers.judge(tmp_path / name, expected, asked, tolerance_cm=WITHIN_CM, weight_tolerance=WEIGHTS_WITHIN)
