"""Written files have the intended content according to other programs' readers."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.formats.bvh.clip import BvhClip
from app.formats.bvh.write import write_bvh
from app.formats.fbx.write import write_scene
from app.formats.gltf.write import write_glb
from app.formats.scene import Scene
from app.formats.usd import write_usd
from tests.support.readers import (
    QUICK_BVH,
    QUICK_FBX,
    QUICK_GLB,
    QUICK_USD,
    SLOW_BVH,
    SLOW_FBX,
    SLOW_GLB,
    Expected,
    installed,
    judge,
)
from tests.unit.formats import scenes

pytestmark = pytest.mark.slow

RATES = [Fraction(24), Fraction(25), Fraction(30000, 1001), Fraction(30), Fraction(60)]
ODD_RATES = [Fraction(24000, 1001), Fraction(50), Fraction(60000, 1001), Fraction(120), Fraction(37, 2)]


def _rate_name(fps: Fraction) -> str:
    return f"{float(fps):.2f}"


def _needed(reader: str) -> None:
    if not installed(reader):
        pytest.skip(f"the reader {reader} is not installed")


@pytest.mark.parametrize("fps", RATES + ODD_RATES, ids=_rate_name)
def test_fbx_character_by_quick_readers(fps: Fraction, tmp_path: Path) -> None:
    scene = scenes.character(fps)
    write_scene(tmp_path / "player.fbx", scene)
    judge(tmp_path / "player.fbx", scenes.expected(scene), QUICK_FBX)


def test_fbx_instrument_by_quick_readers(tmp_path: Path) -> None:
    scene = scenes.instrument(Fraction(60))
    write_scene(tmp_path / "instrument.fbx", scene)
    judge(tmp_path / "instrument.fbx", scenes.expected(scene), QUICK_FBX)


@pytest.mark.readers
@pytest.mark.parametrize("fps", RATES, ids=_rate_name)
@pytest.mark.parametrize("reader", SLOW_FBX)
def test_fbx_character_by(reader: str, fps: Fraction, tmp_path: Path) -> None:
    _needed(reader)
    scene = scenes.character(fps)
    write_scene(tmp_path / "player.fbx", scene)
    judge(tmp_path / "player.fbx", scenes.expected(scene), [reader])


@pytest.mark.readers
@pytest.mark.parametrize("reader", SLOW_FBX)
def test_fbx_instrument_by(reader: str, tmp_path: Path) -> None:
    _needed(reader)
    scene = scenes.instrument(Fraction(30))
    write_scene(tmp_path / "instrument.fbx", scene)
    judge(tmp_path / "instrument.fbx", scenes.expected(scene), [reader])


@pytest.mark.readers
@pytest.mark.parametrize("reader", QUICK_FBX + SLOW_FBX)
def test_fbx_violent_rotations_by(reader: str, tmp_path: Path) -> None:
    """Rotations through gimbal lock and beyond half turns, where continuous angles leave the usual range."""
    _needed(reader)
    scene = scenes.character(Fraction(60), frames=120, amplitude_rad=4.0)
    write_scene(tmp_path / "player.fbx", scene)
    judge(tmp_path / "player.fbx", scenes.expected(scene), [reader])


_BLENDER_PLAIN_IMPORT = """
import sys, bpy
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.fbx(filepath=sys.argv[1], anim_offset=0.0)
armature = next(o for o in bpy.data.objects if o.type == 'ARMATURE')
bpy.context.scene.frame_set(int(sys.argv[2]))
for bone in armature.pose.bones:
    x, y, z = 100 * (armature.matrix_world @ bone.matrix).translation
    print('JOINT', bone.name, x, z, -y)
"""


@pytest.mark.readers
@pytest.mark.parametrize("make", [scenes.character, scenes.instrument])
def test_blender_keeps_the_places_of_moving_bones_without_any_repair(make: object, tmp_path: Path) -> None:
    """Blender's importer discards the location keys of bones that look connected to a parent; so none may look so."""
    _needed("blender")
    scene = make(Fraction(60))
    write_scene(tmp_path / "scene.fbx", scene)
    requested = scenes.expected(scene)
    frame = requested.sampled[3]
    pythons = [os.environ.get("SUISOU_BLENDER_PYTHON", ""), *os.environ.get("CHECK_ANIM_PYTHONS", "").split(":")]
    answers = [
        subprocess.run(
            [python, "-c", _BLENDER_PLAIN_IMPORT, str(tmp_path / "scene.fbx"), str(frame)],
            capture_output=True, text=True, check=False,
        ).stdout
        for python in dict.fromkeys(pythons) if Path(python).is_file()
    ]  # fmt: skip
    found = [line.split()[1:] for answer in answers for line in answer.splitlines() if line.startswith("JOINT")]
    assert len(found) >= len(scene.bones)
    for name, *place in found:
        np.testing.assert_allclose([float(v) for v in place], requested.joints_cm[name][3], atol=0.01, err_msg=name)


# -------------------------------------------------------------------------------------------------------------- BVH


def _write_bvh(path: Path, fps: Fraction) -> Expected:
    """The character's motion from the hips downwards, in BVH's form: offsets, and one moving root."""
    scene = scenes.character(fps)
    assert scene.clip is not None
    names = tuple(bone.name for bone in scene.bones)
    parents = tuple(bone.parent for bone in scene.bones)
    offsets = np.array([bone.translation_cm for bone in scene.bones])
    ends = {joint: np.array([0.0, 2.0, 1.0]) for joint in set(range(len(names))) - set(parents)}
    root = scene.clip.translations_cm[0] + [0, 95, 0]
    orders = tuple(bone.order for bone in scene.bones)
    write_bvh(path, BvhClip(names, parents, offsets, ends, fps, root, scene.clip.rotations_xyzw, orders=orders))
    clip = replace(scene.clip, translations_cm={0: root}, morph_weights={})
    return scenes.expected(replace(scene, clip=clip))


@pytest.mark.parametrize("fps", RATES + ODD_RATES, ids=_rate_name)
def test_bvh_by_quick_readers(fps: Fraction, tmp_path: Path) -> None:
    requested = _write_bvh(tmp_path / "player.bvh", fps)
    judge(tmp_path / "player.bvh", requested, QUICK_BVH)


@pytest.mark.readers
@pytest.mark.parametrize("fps", RATES, ids=_rate_name)
@pytest.mark.parametrize("reader", SLOW_BVH)
def test_bvh_by(reader: str, fps: Fraction, tmp_path: Path) -> None:
    _needed(reader)
    requested = _write_bvh(tmp_path / "player.bvh", fps)
    judge(tmp_path / "player.bvh", requested, [reader])


# -------------------------------------------------------------------------------------------------------------- GLB


@pytest.mark.parametrize("make", [scenes.character, scenes.instrument])
@pytest.mark.parametrize("fps", RATES + ODD_RATES, ids=_rate_name)
def test_glb_by_quick_readers(make: Callable[[Fraction], Scene], fps: Fraction, tmp_path: Path) -> None:
    scene = make(fps)
    write_glb(tmp_path / "scene.glb", scene)
    judge(tmp_path / "scene.glb", scenes.expected(scene), QUICK_GLB)


@pytest.mark.readers
@pytest.mark.parametrize("make", [scenes.character, scenes.instrument])
@pytest.mark.parametrize("fps", RATES, ids=_rate_name)
@pytest.mark.parametrize("reader", SLOW_GLB)
def test_glb_by(reader: str, fps: Fraction, make: Callable[[Fraction], Scene], tmp_path: Path) -> None:
    """The format's official validator finds no error, and other programs find the same motion."""
    _needed(reader)
    scene = make(fps)
    write_glb(tmp_path / "scene.glb", scene)
    judge(tmp_path / "scene.glb", scenes.expected(scene), [reader])


# -------------------------------------------------------------------------------------------------------------- USD


@pytest.mark.parametrize("make", [scenes.character, scenes.instrument])
@pytest.mark.parametrize("fps", RATES + ODD_RATES, ids=_rate_name)
def test_usd_by_quick_readers(make: Callable[[Fraction], Scene], fps: Fraction, tmp_path: Path) -> None:
    for reader in QUICK_USD:
        _needed(reader)
    scene = make(fps)
    write_usd(tmp_path / "scene.usdc", scene)
    judge(tmp_path / "scene.usdc", scenes.expected(scene), QUICK_USD)
