"""Depths of arms in a trunk, with spheres of known depth."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from app.export.arm_depths import ArmDepth, arm_depth
from app.export.joint_playback import JointPlayback
from app.export.playback import ScenePlayback
from app.formats.scene import Bone, Clip, Material, Scene, SkinnedMesh
from app.rig import quaternion

TRUNK_M, ARM_M = 0.2, 0.02
BONES = ("hips", "upperChest", "leftLowerArm", "leftHand", "rightLowerArm", "rightHand")
PARENTS = (-1, 0, 1, 2, 1, 4)
FRAMES = 61


def sphere(radius_m: float, rings: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices in metres, and triangles counter-clockwise from outside."""
    polar, around = np.meshgrid(np.linspace(0.0, np.pi, rings + 1), np.arange(2 * rings) * np.pi / rings, indexing="ij")
    places = np.stack([np.sin(polar) * np.cos(around), np.cos(polar), np.sin(polar) * np.sin(around)], axis=-1)
    ring, step = np.meshgrid(np.arange(rings), np.arange(2 * rings), indexing="ij")
    here, beside = ring * 2 * rings + step, ring * 2 * rings + (step + 1) % (2 * rings)
    below, across = here + 2 * rings, beside + 2 * rings
    faces = np.concatenate([np.stack([here, beside, below], -1), np.stack([beside, across, below], -1)]).reshape(-1, 3)
    return radius_m * places.reshape(-1, 3), faces


def mesh(name: str, bone: int, places_m: np.ndarray, faces: np.ndarray, binds: np.ndarray) -> SkinnedMesh:
    vertices_cm = 100.0 * places_m + binds[bone, :3, 3]
    return SkinnedMesh(
        name, vertices_cm, faces, np.zeros_like(vertices_cm), None, (Material(name, (1.0, 1.0, 1.0, 1.0)),), None,
        np.full((len(places_m), 1), bone), np.ones((len(places_m), 1)), binds,
    )  # fmt: skip


def sheet(at_m: float, normal: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices in metres, and triangles of a square trim before the trunk that faces forwards (1) or backwards (-1)."""
    x, y = np.meshgrid(np.linspace(-0.15, 0.15, 13), np.linspace(-0.15, 0.15, 13))
    places = np.stack([x.ravel(), y.ravel(), np.full(x.size, at_m)], axis=1)
    row, column = np.meshgrid(np.arange(12), np.arange(12), indexing="ij")
    here = (13 * row + column).ravel()
    faces = np.concatenate([np.stack([here, here + 1, here + 14], -1), np.stack([here, here + 14, here + 13], -1)])
    return places, faces if normal > 0.0 else faces[:, ::-1]


def judged(left_m: np.ndarray, open_below: bool = False, trim: tuple[np.ndarray, np.ndarray] | None = None) -> ArmDepth:
    """Depth of a left forearm that is a small sphere at positions (F, 3) relative to the trunk's centre; with a
    ``trim`` of the trunk's material."""
    offsets_cm = np.array([[0, 100, 0], [0, 30, 0], [80, 0, 0], [10, 0, 0], [-80, 0, 0], [-10, 0, 0]], np.float64)
    binds = np.tile(np.eye(4), (len(BONES), 1, 1))
    for bone, parent in enumerate(PARENTS):
        binds[bone, :3, 3] = offsets_cm[bone] + (binds[parent, :3, 3] if parent >= 0 else 0.0)
    places_m, faces = sphere(TRUNK_M, 48)
    if open_below:
        faces = faces[(places_m[faces][:, :, 1] > -0.1).all(axis=1)]
    if trim is not None:
        faces = np.concatenate([faces, trim[1] + len(places_m)])
        places_m = np.concatenate([places_m, trim[0]])
    small_m, small = sphere(ARM_M, 12)
    meshes = (mesh("shirt", 1, places_m, faces, binds), mesh("sleeve", 2, small_m, small, binds))
    bones = tuple(
        Bone(name, parent, offset, quaternion.IDENTITY)
        for name, parent, offset in zip(BONES, PARENTS, offsets_cm, strict=True)
    )
    still = np.tile(quaternion.IDENTITY, (len(left_m), len(BONES), 1))
    clip = Clip("a", Fraction(30), len(left_m), still, {2: 100.0 * left_m})
    playback = ScenePlayback(Scene(bones, meshes, clip), clip)
    names = dict(enumerate(BONES))
    joints = SimpleNamespace(
        playback=playback,
        joint_names=names,
        bone=lambda *some: next(BONES.index(name) for name in some if name in BONES),
    )
    return arm_depth(cast(JointPlayback, joints))


@pytest.mark.parametrize("deepest_m", [0.005, 0.03, 0.06])
def test_the_greatest_depth_is_found_with_its_side_and_frame(deepest_m: float) -> None:
    """A forearm moves in from the side, is deepest in the middle and moves out."""
    away_m = TRUNK_M + ARM_M - deepest_m + 0.3 * np.abs(np.linspace(-1.0, 1.0, FRAMES))
    found = judged(np.stack([away_m, np.full(FRAMES, 0.01), np.full(FRAMES, 0.02)], axis=1))
    own_m = np.linalg.norm([away_m.min(), 0.01, 0.02])
    assert found.side == "left"
    assert found.frame == FRAMES // 2
    assert found.depth_mm == pytest.approx(1000.0 * (TRUNK_M + ARM_M - own_m), abs=1.0)
    assert found.kept == (found.depth_mm <= 10.0)


def test_an_arm_that_only_passes_by_is_not_inside() -> None:
    way = np.stack([np.full(FRAMES, TRUNK_M + ARM_M + 0.002), np.linspace(-0.5, 0.5, FRAMES), np.zeros(FRAMES)], axis=1)
    assert judged(way) == ArmDepth()


def test_below_an_open_hem_is_outside() -> None:
    """The nearest vertex is at the hem, whose normal does not determine the side of a point below."""
    way = np.tile([0.02, -0.16, 0.0], (FRAMES, 1))
    assert judged(way).depth_mm > 20.0
    assert judged(way, open_below=True) == ArmDepth()


@pytest.mark.parametrize("normal", [1.0, -1.0], ids=["outwards", "inwards"])
def test_an_open_trim_has_no_inside(normal: float) -> None:
    """The trim hangs 8 cm before the trunk, of whose material it is; the arm is between them, and nearer to it."""
    way = np.tile([0.0, 0.0, TRUNK_M + 0.05], (FRAMES, 1))
    assert judged(way, trim=sheet(TRUNK_M + 0.08, normal)) == ArmDepth()
    before = np.tile([0.0, 0.0, TRUNK_M + 0.11], (FRAMES, 1))
    assert judged(before, trim=sheet(TRUNK_M + 0.08, normal)) == ArmDepth()


def test_depths_below_an_open_trim_are_those_of_the_trunk() -> None:
    way = np.tile([0.0, 0.0, TRUNK_M + ARM_M - 0.03], (FRAMES, 1))
    found = judged(way, trim=sheet(TRUNK_M + 0.002, -1.0))
    assert found.depth_mm == pytest.approx(30.0, abs=1.5)


def belt(at_m: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices in metres, and triangles of a closed bar before the trunk, 4 cm thick and 4.4 cm high, without vertices
    between its edges."""
    across_m = np.linspace(-0.1, 0.1, 11)
    ring = [(-0.022, 0.0), (-0.022, 0.04), (0.022, 0.04), (0.022, 0.0)]
    places = np.array([[x, y, at_m + z] for x in across_m for y, z in ring])
    quads = [
        (4 * k + c, 4 * k + (c + 1) % 4, 4 * k + 4 + (c + 1) % 4, 4 * k + 4 + c) for k in range(10) for c in range(4)
    ]
    quads += [(3, 2, 1, 0), (40, 41, 42, 43)]
    return places, np.array([[a, b, c] for a, b, c in ((q[0], q[k], q[k + 1]) for q in quads for k in (1, 2))])[:, ::-1]


def test_the_depth_below_large_triangles_is_that_from_their_middle() -> None:
    """The corners of a belt's front are farther away than the front."""
    way = np.tile([0.0, 0.0, 0.28 + 0.04 + ARM_M - 0.005], (FRAMES, 1))
    assert judged(way, trim=belt(0.28)).depth_mm == pytest.approx(5.0, abs=0.7)
