"""FBX and BVH against Blender's exporters in one run: the like skeleton, mesh, shapes and 3,600 frames at 60 frames/s.

Blender is the module ``bpy`` in the interpreter that ``SUISOU_BLENDER_PYTHON`` names, as ``./test`` sets it up.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.formats.bvh.clip import BvhClip
from app.formats.bvh.write import write_bvh
from app.formats.fbx.write import write_scene
from app.formats.gltf.write import write_glb
from app.formats.scene import Bone, Clip, Material, MorphTarget, Scene, SkinnedMesh
from app.formats.usd import write_usd
from app.formats.usd_package import usd_installed

BONES, FRAMES, FPS = 60, 3_600, 60
TOOL = Path(__file__).parent.parent / "support" / "blender_reference.py"
RUNS = 5


def _scene() -> Scene:
    """Return the scene that `blender_reference.py` makes too: a box on every bone, two shapes on one box, turning
    bones, two that move."""
    parents = [-1] + [0 if number % 4 == 0 else number - 1 for number in range(1, BONES)]
    offsets = np.random.default_rng(1).normal(scale=10, size=(BONES, 3))
    seconds = np.arange(FRAMES)[:, None] / FPS
    phases = np.arange(BONES)[None]
    turns = np.stack([0.17 * np.sin(2 * seconds + phases), 0.08 * np.sin(3 * seconds + 0.5 * phases),
                      0.12 * np.sin(1.3 * seconds + 0.3 * phases)], axis=-1)  # fmt: skip
    rotations = Rotation.from_euler("xyz", turns.reshape(-1, 3)).as_quat().reshape(FRAMES, BONES, 4)
    moves = 10 * np.sin(seconds * [1, 2, 3])
    binds = np.tile(np.eye(4), (BONES, 1, 1))
    for bone, parent in enumerate(parents):
        binds[bone, :3, 3] = offsets[bone] + (binds[parent, :3, 3] if parent >= 0 else 0)
    corners = np.stack(np.meshgrid([-1.5, 1.5], [-1.5, 1.5], [-1.5, 1.5], indexing="ij"), axis=-1).reshape(-1, 3)
    sides = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    shape = np.tile([0.0, -5.0, 0.0], (8, 1))
    mesh = SkinnedMesh(
        "Body",
        (binds[:, None, :3, 3] + corners).reshape(-1, 3),
        (8 * np.arange(BONES)[:, None, None] + sides).reshape(-1, 4),
        np.tile(corners / np.linalg.norm(corners, axis=1, keepdims=True), (BONES, 1)),
        np.zeros((8 * BONES, 2)),
        (Material("M_Body", (0.8, 0.8, 0.8, 1.0)),),
        None,
        np.repeat(np.arange(BONES), 8)[:, None],
        np.ones((8 * BONES, 1)),
        binds,
        tuple(MorphTarget(name, np.arange(40, 48), shape) for name in ("jawOpen", "browInnerUp")),
    )
    weights = {"jawOpen": 0.5 - 0.5 * np.cos(3 * seconds[:, 0]), "browInnerUp": 0.5 + 0.4 * np.sin(2 * seconds[:, 0])}
    bones = tuple(
        Bone(f"bone_{number:02d}", parent, offsets[number], np.array([0.0, 0.0, 0.0, 1.0]))
        for number, parent in enumerate(parents)
    )
    clip = Clip("Take", Fraction(FPS), FRAMES, rotations.astype(np.float32), {0: moves, 1: moves}, weights)
    return Scene(bones, (mesh,), clip)


def _median_s(run: Callable[[], None]) -> float:
    times = []
    for _ in range(RUNS):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


@pytest.fixture(scope="module")
def blender(tmp_path_factory: pytest.TempPathFactory) -> dict[str, float]:
    """Return the times (s) of Blender's exporters for a like scene."""
    python = os.environ.get("SUISOU_BLENDER_PYTHON", "")
    if not Path(python).is_file() or subprocess.run([python, "-c", "import bpy"], check=False).returncode:
        pytest.skip("no Blender to compare with: SUISOU_BLENDER_PYTHON names no interpreter that has bpy")
    folder = tmp_path_factory.mktemp("blender")
    command = [python, str(TOOL), str(folder), str(FRAMES), str(FPS), str(BONES), "both"]
    subprocess.run(command, check=True, capture_output=True)
    report: dict[str, float] = json.loads((folder / "report.json").read_text())
    return report


def _say(what: str, ours_s: float, theirs_s: float, ours: Path, their_bytes: float) -> None:
    print(
        f"\n{what}: {ours_s:.3f} s, Blender {theirs_s:.2f} s: {theirs_s / ours_s:.0f} times faster;"
        f" {ours.stat().st_size / 1e6:.1f} MB, Blender {their_bytes / 1e6:.1f} MB",
        file=sys.stderr,
    )


@pytest.mark.bench
def test_fbx_is_ten_times_faster_than_blender(blender: dict[str, float], tmp_path: Path) -> None:
    scene, path = _scene(), tmp_path / "ours.fbx"
    ours = _median_s(lambda: write_scene(path, scene))
    _say("FBX", ours, blender["fbx_s"], path, blender["fbx_bytes"])
    assert blender["fbx_s"] / ours >= 10


@pytest.mark.bench
def test_bvh_is_five_times_faster_than_blender(blender: dict[str, float], tmp_path: Path) -> None:
    scene, path = _scene(), tmp_path / "ours.bvh"
    assert scene.clip is not None
    clip = scene.clip
    parents = tuple(bone.parent for bone in scene.bones)
    offsets = np.array([bone.translation_cm for bone in scene.bones])
    ends = {joint: np.array([0.0, 2.0, 0.0]) for joint in set(range(BONES)) - set(parents)}
    names = tuple(bone.name for bone in scene.bones)
    given = BvhClip(names, parents, offsets, ends, clip.fps, clip.translations_cm[0], clip.rotations_xyzw)
    ours = _median_s(lambda: write_bvh(path, given))
    _say("BVH", ours, blender["bvh_s"], path, blender["bvh_bytes"])
    assert blender["bvh_s"] / ours >= 5


@pytest.mark.bench
def test_glb_takes_no_longer_than_fbx(tmp_path: Path) -> None:
    scene, fbx, glb = _scene(), tmp_path / "ours.fbx", tmp_path / "ours.glb"
    fbx_s = _median_s(lambda: write_scene(fbx, scene))
    glb_s = _median_s(lambda: write_glb(glb, scene))
    print(
        f"\nGLB: {glb_s:.3f} s, {glb.stat().st_size / 1e6:.1f} MB;"
        f" FBX: {fbx_s:.3f} s, {fbx.stat().st_size / 1e6:.1f} MB",
        file=sys.stderr,
    )
    assert glb_s < fbx_s


@pytest.mark.bench
def test_usd_takes_at_most_five_times_as_long_as_fbx(tmp_path: Path) -> None:
    if not usd_installed():
        pytest.skip("usd-core is not installed")
    scene, fbx, usd = _scene(), tmp_path / "ours.fbx", tmp_path / "ours.usdc"
    fbx_s = _median_s(lambda: write_scene(fbx, scene))
    usd_s = _median_s(lambda: write_usd(usd, scene))
    print(f"\nUSD: {usd_s:.3f} s, {usd.stat().st_size / 1e6:.1f} MB; FBX: {fbx_s:.3f} s", file=sys.stderr)
    assert usd_s < 5 * fbx_s
