"""Reduced keys: playback of exported files at every frame compared with the same motion with all keys."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.cli import main
from app.export.joint_playback import JointPlayback
from app.export.key_reduction_landmarks import SkinnedMarks, part_marks
from app.export.playback import ScenePlayback, Surface
from app.export.reduced_keys import INSTRUMENT_MM, PLACE_MM, ROTATION_DEG, WEIGHT, reduced
from app.export.scene_keys import keyed_character, keyed_instrument
from app.export.target import TargetSkeleton
from app.export.targets import target_skeleton
from app.formats.fbx.decode import read_elements
from app.formats.fbx.read import read_scene
from app.formats.fbx.write import write_scene
from app.formats.gltf.animation import sampled
from app.formats.gltf.read import read_glb
from app.formats.gltf.write import write_glb
from app.formats.keys import Keys
from app.formats.scene import Scene
from app.formats.usd import write_usd
from app.formats.usd_package import usd_installed
from app.performance.bodies import character_of, model_of
from app.performance.ensemble import Performance
from app.performance.span import bars_span
from app.rig.model import Character
from tests.gui.conftest import quartet_project
from tests.support import readers
from tests.support.performed import player_motion
from tests.unit.formats import scenes

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
FPS = Fraction(60)
FBX_STEADY_DEG = 0.001
"""Error in degrees that the file may add, since an axis that changes by less gets one key."""


@pytest.fixture(scope="module")
def character() -> Character:
    return character_of(quartet_project().players[0])


@pytest.fixture(scope="module")
def target(character: Character) -> TargetSkeleton:
    return target_skeleton(character, "own")


@pytest.fixture(scope="module")
def every(character: Character, target: TargetSkeleton) -> dict[str, Scene]:
    """A trumpeter with trumpet, for a few bars that begin with a rest and a breath."""
    from app.export.character import character_scene
    from app.export.instrument import instrument_scene

    performance = Performance(quartet_project())
    player = performance.project.players[0]
    span = bars_span(performance, FPS, (1, 4), performance.project.preroll_beats)
    motion, instrument = player_motion(performance, player, span), performance.instrument(player)
    return {
        "character": character_scene(character, motion, "player", "Suisou", target),
        "instrument": instrument_scene(instrument, model_of(instrument), motion, "horn", "Suisou"),
    }


@pytest.fixture(scope="module")
def few(every: dict[str, Scene], character: Character, target: TargetSkeleton) -> dict[str, Scene]:
    formats = frozenset(("fbx", "glb", "usd"))
    return {
        "character": keyed_character(every["character"], "reduced", formats, character, target),
        "instrument": keyed_instrument(every["instrument"], "reduced", formats),
    }


def _angles_deg(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    sides = np.minimum(np.linalg.norm(one - other, axis=-1), np.linalg.norm(one + other, axis=-1))
    return np.degrees(4.0 * np.arcsin(np.minimum(sides / 2.0, 1.0)))


def _judge(found: Scene, meant: Scene, most_mm: float) -> None:
    """Compare every bone, joint, vertex group and weight of a file with the motion at every frame."""
    assert found.clip is not None
    frames = meant.clip.frames
    assert found.clip.frames == frames
    shown, asked = ScenePlayback(found, found.clip), ScenePlayback(meant, meant.clip)
    off = _angles_deg(shown.rotations(0, frames), asked.rotations(0, frames))
    assert off.max() <= ROTATION_DEG + 3 * FBX_STEADY_DEG
    places_mm = 1000.0 * np.linalg.norm(shown.translations_m(0, frames) - asked.translations_m(0, frames), axis=-1)
    assert places_mm.max() <= most_mm + 1e-3
    joints_mm = 1000.0 * np.linalg.norm((shown.world(0, frames) - asked.world(0, frames))[..., :3, 3], axis=-1)
    assert joints_mm.max() <= most_mm + 1e-3
    for name, weights in meant.clip.morph_weights.items():
        assert np.abs(found.clip.morph_weights[name] - weights).max() <= WEIGHT + 1e-6


def _landmarks_mm(scene: Scene, character: Character, target: TargetSkeleton, played: Scene) -> dict[str, np.ndarray]:
    """Error in millimetres of every landmark in each frame, measured by skinning the vertices."""
    assert played.clip is not None
    frames, result, found = scene.clip.frames, {}, []
    for one in (scene, played):
        playback = ScenePlayback(one, one.clip)
        joints, world = JointPlayback(playback, target, character), playback.world(0, frames)
        found.append(
            {
                name: Surface(playback, *joints.surface(mark)).positions_m(world, 0, frames).mean(axis=1)
                for name, mark in character.landmarks.items()
                if not name.endswith(".hand")
            }
        )
    for name, places_m in found[0].items():
        result[name] = 1000.0 * np.linalg.norm(places_m - found[1][name], axis=-1)
    return result


def _curve_keys(path: Path) -> list[tuple[int, bool]]:
    """Number of keys of every curve of an FBX file, and whether all are equal."""
    objects = read_elements(path.read_bytes(), path.name).child("Objects")
    assert objects is not None
    values = [curve.child("KeyValueFloat") for curve in objects.children or () if curve.name == "AnimationCurve"]
    rows = [np.asarray(one.properties[0]) for one in values if one is not None]
    return [(len(row), bool((row == row[0]).all())) for row in rows]


def test_an_fbx_character_plays_within_the_bounds_with_a_fraction_of_the_keys(
    every: dict[str, Scene], few: dict[str, Scene], character: Character, target: TargetSkeleton, tmp_path: Path
) -> None:
    meant = every["character"]
    write_scene(tmp_path / "player.fbx", few["character"])
    found = read_scene(tmp_path / "player.fbx")
    _judge(found, meant, PLACE_MM)
    off_mm = _landmarks_mm(meant, character, target, found)
    assert {"right.index.pad", "lips.upper", "left.foot.sole"} <= off_mm.keys()
    worst = max(off_mm, key=lambda name: float(off_mm[name].max()))
    assert off_mm[worst].max() <= PLACE_MM + 1e-2, worst
    assert off_mm[worst].max() > 0.2 * PLACE_MM, "as few keys as the bound allows"
    names, keys = [bone.name for bone in meant.bones], few["character"].clip.keys
    arms = [names.index(f"{side}{part}") for side in ("left", "right") for part in ("UpperArm", "LowerArm", "Hand")]
    assert np.mean([len(keys.bones[bone]) for bone in arms]) < 4.0 * meant.clip.frames / FPS, (
        "an animator can edit them"
    )
    curves = _curve_keys(tmp_path / "player.fbx")
    assert sum(count for count, _ in curves) < 0.15 * meant.clip.frames * len(curves)
    assert all(count == 1 for count, alike in curves if alike)
    assert any(count == 1 for count, _ in curves)


def test_an_fbx_instrument_plays_within_the_bounds_and_its_valves_reach_their_places(
    every: dict[str, Scene], few: dict[str, Scene], tmp_path: Path
) -> None:
    meant = every["instrument"]
    write_scene(tmp_path / "horn.fbx", few["instrument"])
    found = read_scene(tmp_path / "horn.fbx")
    _judge(found, meant, INSTRUMENT_MM)
    assert found.clip is not None
    frames = meant.clip.frames
    for mesh, played in zip(meant.meshes, found.meshes, strict=True):
        vertices = np.arange(len(mesh.vertices_cm))[::7]
        one, other = ScenePlayback(meant, meant.clip), ScenePlayback(found, found.clip)
        for first in range(0, frames, 64):
            last = min(first + 64, frames)
            asked = Surface(one, mesh, vertices).positions_m(one.world(first, last), first, last)
            shown = Surface(other, played, vertices).positions_m(other.world(first, last), first, last)
            assert 1000.0 * np.linalg.norm(shown - asked, axis=-1).max() <= INSTRUMENT_MM + 1e-3
    curves = _curve_keys(tmp_path / "horn.fbx")
    assert all(count == 1 for count, alike in curves if alike)


def test_arms_of_a_player_have_few_keys(few: dict[str, Scene]) -> None:
    """Keys a second; with keys added at every violation, instead of chosen again, they were 3.3 and 55."""
    scene = few["character"]
    assert scene.clip is not None
    assert scene.clip.keys is not None
    length_s = scene.clip.frames / float(FPS)
    counts = {bone.name: len(keys) / length_s for bone, keys in zip(scene.bones, scene.clip.keys.bones, strict=True)}
    assert np.mean([counts[f"{side}{part}Arm"] for side in ("left", "right") for part in ("Upper", "Lower")]) < 3.0
    assert sum(counts.values()) < 52.5


@pytest.mark.parametrize("held", ["character", "instrument"])
def test_a_glb_plays_within_the_bounds(
    every: dict[str, Scene], few: dict[str, Scene], held: str, tmp_path: Path
) -> None:
    """Its samplers are interpolated according to the specification."""
    meant = every[held]
    assert meant.clip is not None
    write_glb(tmp_path / "player.glb", few[held])
    model = read_glb(tmp_path / "player.glb", animated=True)
    (animation,) = model.animations
    times_s = np.arange(meant.clip.frames) / float(FPS)
    rotations = np.tile([bone.rotation_xyzw for bone in meant.bones], (meant.clip.frames, 1, 1)).astype(float)
    places = {}
    for channel in animation.channels:
        bone = [one.name for one in meant.bones].index(model.nodes[channel.node].name)
        if channel.path == "rotation":
            rotations[:, bone] = sampled(channel, times_s)
        else:
            places[bone] = 100.0 * sampled(channel, times_s)
    clip = replace(meant.clip, rotations_xyzw=rotations, translations_cm=places)
    _judge(replace(meant, clip=clip), meant, PLACE_MM if held == "character" else INSTRUMENT_MM)


@pytest.mark.parametrize("held", ["character", "instrument"])
def test_other_programs_play_all_formats_within_the_bounds(
    every: dict[str, Scene], few: dict[str, Scene], held: str, tmp_path: Path
) -> None:
    """Frames between keys: in FBX by ufbx, in GLB and USD by independent evaluators."""
    clip = every[held].clip
    expected = _expected(every[held], list(range(0, clip.frames, 11)))
    written: list[tuple[Any, str, tuple[str, ...]]] = [
        (write_scene, "player.fbx", readers.QUICK_FBX),
        (write_glb, "player.glb", readers.QUICK_GLB),
    ]
    if usd_installed():
        written.append((write_usd, "player.usdc", readers.QUICK_USD))
    for write, name, asked in written:
        write(tmp_path / name, few[held])
        readers.judge(tmp_path / name, expected, asked, tolerance_cm=0.0501, weight_tolerance=WEIGHT + 1e-4)


def _expected(scene: Scene, sampled: list[int] | None = None) -> readers.Expected:
    """Values that every reader should find, with all keys."""
    assert scene.clip is not None
    clip = scene.clip
    sampled = list(range(clip.frames)) if sampled is None else sampled
    world_cm = 100.0 * ScenePlayback(scene, clip).world(0, clip.frames)[sampled][..., :3, 3]
    names = [bone.name for bone in scene.bones]
    return readers.Expected(
        fps=clip.fps,
        frames=clip.frames,
        sampled=sampled,
        joints_cm={name: world_cm[:, index] for index, name in enumerate(names)},
        parents={bone.name: names[bone.parent] if bone.parent >= 0 else None for bone in scene.bones},
        weights={name: np.asarray(weights)[sampled] for name, weights in clip.morph_weights.items()},
        every_key=False,
    )


# ------------------------------------------------------------------------------- small scenes, every reader


def _smooth(scene: Scene, frames: int = 90) -> Scene:
    """Scene that moves slowly enough for reduced keys, with a rest in the middle."""
    assert scene.clip is not None
    clip = scene.clip
    at = np.concatenate([np.linspace(0, 12, frames // 3), np.full(frames // 3, 12), np.linspace(12, 24, frames // 3)])
    low, high, share = np.floor(at).astype(int), np.ceil(at).astype(int), (at % 1.0)
    rotations = np.asarray(clip.rotations_xyzw, float)
    first, last = rotations[low], rotations[high]
    last = np.where(np.einsum("fji,fji->fj", first, last)[..., None] < 0, -last, last)
    turned = first + (last - first) * share[:, None, None]
    turned /= np.linalg.norm(turned, axis=-1, keepdims=True)

    def between(values: np.ndarray) -> np.ndarray:
        rows = share.reshape(-1, *[1] * (values.ndim - 1))
        return np.asarray(values[low] * (1 - rows) + values[high] * rows)

    places = {bone: between(np.asarray(values)) for bone, values in clip.translations_cm.items()}
    weights = {name: between(np.asarray(values)) for name, values in clip.morph_weights.items()}
    return replace(
        scene,
        clip=replace(clip, frames=len(at), rotations_xyzw=turned, translations_cm=places, morph_weights=weights),
    )


def _few(scene: Scene, keys: str = "reduced") -> Scene:
    assert scene.clip is not None
    return reduced(scene, part_marks(ScenePlayback(scene, scene.clip)), PLACE_MM, True, curved=keys == "reduced")


@pytest.mark.parametrize("amplitude_rad", [0.6, 4.0], ids=["calm", "through gimbal lock"])
def test_violent_rotations_stay_within_the_bounds(amplitude_rad: float, tmp_path: Path) -> None:
    meant = scenes.character(FPS, frames=120, amplitude_rad=amplitude_rad)
    if amplitude_rad < 1.0:
        meant = _smooth(meant)
    write_scene(tmp_path / "player.fbx", _few(meant))
    _judge(read_scene(tmp_path / "player.fbx"), meant, PLACE_MM)


CURVED_READERS = {".fbx": ("fbxsdk", "ufbx", "pufbx"), ".glb": ("gltfvalid", "three")}
"""Readers that interpolate cubic keys; Blender and assimp only read their values, and so does three.js in FBX."""


@pytest.mark.readers
@pytest.mark.parametrize("make", [scenes.character, scenes.instrument])
@pytest.mark.parametrize("suffix", [".fbx", ".glb"])
@pytest.mark.parametrize("keys", ["reduced", "linear"])
def test_slow_readers_play_within_the_bounds(keys: str, make: Any, suffix: str, tmp_path: Path) -> None:
    meant = _smooth(make(FPS))
    path = tmp_path / f"scene{suffix}"
    (write_scene if suffix == ".fbx" else write_glb)(path, _few(meant, keys))
    everyone = readers.SLOW_FBX if suffix == ".fbx" else readers.SLOW_GLB
    asked = [one for one in (CURVED_READERS[suffix] if keys == "reduced" else everyone) if readers.installed(one)]
    if not asked:
        pytest.skip("no slow reader is installed")
    readers.judge(path, _expected(meant), asked, tolerance_cm=0.055, weight_tolerance=WEIGHT + 1e-3)


def test_what_never_moves_keeps_the_length_of_the_clip(tmp_path: Path) -> None:
    scene = scenes.character(FPS)
    still = np.repeat(scene.clip.rotations_xyzw[:1], 49, axis=0)
    places = {bone: np.repeat(values[:1], 49, axis=0) for bone, values in scene.clip.translations_cm.items()}
    weights = {name: np.full(49, 0.25) for name in scene.clip.morph_weights}
    scene = replace(
        scene,
        clip=replace(scene.clip, rotations_xyzw=still, translations_cm=places, morph_weights=weights),
    )
    few = _few(scene)
    assert [len(keys) for keys in few.clip.keys.bones] == [2] + [1] * (len(scene.bones) - 1)
    assert few.clip.keys.pose.tolist() == [0, 48]
    assert all(len(keys) == 1 for keys in few.clip.keys.morphs.values())
    write_scene(tmp_path / "still.fbx", few)
    _judge(read_scene(tmp_path / "still.fbx"), scene, PLACE_MM)
    readers.judge(tmp_path / "still.fbx", _expected(scene), readers.QUICK_FBX)


def test_a_chain_whose_bones_are_each_within_their_bound_is_tightened_for_what_hangs_on_its_end() -> None:
    """Ten bones of 20 cm with errors in the same direction, which add up at the end."""
    from app.formats.scene import Bone, Clip

    count, frames = 10, 480
    bones = tuple(
        Bone(f"bone{n}", n - 1, np.array([0.0, 20.0 if n else 0.0, 0.0]), np.array([0.0, 0.0, 0.0, 1.0]))
        for n in range(count)
    )
    angle = 0.05 * np.sin(0.02 * np.arange(frames))
    turns = np.zeros((frames, count, 4))
    turns[..., 2], turns[..., 3] = np.sin(angle / 2)[:, None], np.cos(angle / 2)[:, None]
    scene = Scene(bones, (), Clip("wave", FPS, frames, turns))
    few = _few(scene, "linear").clip
    kept = few.keys.bones
    played = np.stack(
        [np.interp(np.arange(frames), kept[bone], np.degrees(angle)[kept[bone]]) for bone in range(count)], axis=1
    )
    headings = np.radians(np.cumsum(played, axis=1))
    meant = np.cumsum(np.tile(angle[:, None], (1, count)), axis=1)

    def tip(directions: np.ndarray) -> np.ndarray:
        return 200.0 * np.stack([-np.sin(directions[:, :-1]), np.cos(directions[:, :-1])]).sum(axis=-1)

    off_mm = np.linalg.norm(tip(headings) - tip(meant), axis=0)
    assert off_mm.max() <= PLACE_MM + 1e-3
    assert max(map(len, kept)) < 0.6 * frames


def test_marks_are_where_skinning_takes_the_landmarks(
    every: dict[str, Scene], character: Character, target: TargetSkeleton
) -> None:
    """The points with bounded error equal means over skinned vertices, with morphs and several bones."""
    from app.export.key_reduction_landmarks import character_marks
    from app.export.keyed_motion import KeyedMotion

    scene = every["character"]
    assert scene.clip is not None
    playback = ScenePlayback(scene, scene.clip)
    joints = JointPlayback(playback, target, character)
    marks: SkinnedMarks = character_marks(joints, character)
    clip = replace(scene.clip, keys=Keys(tuple(np.zeros(1, int) for _ in scene.bones)))
    motion = KeyedMotion(scene, clip, marks, PLACE_MM / 1000.0)
    frames = np.array([0, 100, 101, scene.clip.frames - 1])
    found = motion.places_of_marks(*motion.meant(frames))
    world = playback.world(0, scene.clip.frames)
    np.testing.assert_allclose(found[: len(scene.bones)].swapaxes(0, 1), world[frames][..., :3, 3], atol=1e-5)
    meshes: dict[int, list[str]] = {}
    for name in sorted(character.landmarks):
        meshes.setdefault(id(joints.surface(character.landmarks[name])[0]), []).append(name)
    names = [name for group in meshes.values() for name in group]
    for number, name in enumerate(names, len(scene.bones)):
        surface = Surface(playback, *joints.surface(character.landmarks[name]))
        meant = surface.positions_m(world, 0, scene.clip.frames).mean(axis=1)[frames]
        np.testing.assert_allclose(found[number], meant, atol=1e-5, err_msg=name)


# ------------------------------------------------------------------------------------------------- the command


def test_the_command_reports_what_it_left_out_and_judges_what_the_files_play(tmp_path: Path) -> None:
    arguments = ["--fps", "60", "--from-bar", "2", "--to-bar", "3", "--player", "Trumpet 1", "--format", "fbx"]
    reports: dict[str, Any] = {}
    for keys in ("every", "reduced"):
        folder = tmp_path / keys
        assert main(["export", str(QUARTET), "--to", str(folder), *arguments, "--keys", keys]) == 0
        reports[keys] = json.loads((folder / "report.json").read_text(encoding="utf-8"))
        assert reports[keys]["keys"] == keys
    (every,), (few,) = reports["every"]["players"], reports["reduced"]["players"]
    assert every["keys"]["written"] == every["keys"]["every"] == few["keys"]["every"]
    assert few["keys"]["written"] < 0.2 * few["keys"]["every"]
    # Each key of a rotation or place is on three curves, but for axes that never change.
    written = [row for name in few["files"].values() for row in _curve_keys(tmp_path / "reduced" / name)]
    assert sum(count for count, _ in written) <= 3 * few["keys"]["written"]
    assert every["measures"]["lips"] != few["measures"]["lips"], "the files' own curves are judged"
    controls = few["measures"]["controls"].values()
    assert all(one["right"] == one["judged"] and not one["held_wrong"] for one in controls)
    for name, spread in few["measures"]["contacts"].items():
        assert spread["max_mm"] <= every["measures"]["contacts"][name]["max_mm"] + PLACE_MM + INSTRUMENT_MM + 0.01


@pytest.mark.parametrize(
    ("arguments", "says"),
    [(("--format", "bvh"), "fbx, glb, usd"), (("--unreal", "nowhere"), "every frame")],
    ids=["bvh alone", "unreal"],
)
def test_where_keys_cannot_be_reduced_it_says_so(
    arguments: tuple[str, ...], says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    to = () if "--unreal" in arguments else ("--to", str(tmp_path / "out"))
    assert main(["export", str(QUARTET), *to, *arguments, "--keys", "reduced"]) == 2
    assert says in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
