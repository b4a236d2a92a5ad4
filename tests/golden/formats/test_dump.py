"""The text of a small FBX file, so that every change to what is written shows in a review.

Written anew by ``SUISOU_WRITE_GOLDEN=1 ./test tests/golden/formats``; read the difference before it is committed.
"""

from __future__ import annotations

import os
from fractions import Fraction
from pathlib import Path

import numpy as np

from app.formats.fbx.decode import read_elements
from app.formats.scene import Bone, Clip, Material, MorphTarget, Scene, SkinnedMesh
from tests.support.encoded import encode_scene
from tests.support.fbx_dump import text

GOLDEN = Path(__file__).with_name("scene.txt")


def _scene() -> Scene:
    """Exact numbers only, so that no computer's arithmetic shows."""
    identity = np.array([0.0, 0.0, 0.0, 1.0])
    bones = (Bone("root", -1, np.zeros(3), identity), Bone("slide", 0, np.array([0.0, 0.0, 20.0]), identity))
    binds = np.tile(np.eye(4), (2, 1, 1))
    binds[1, 2, 3] = 20.0
    brass = Material("Brass", (0.75, 0.5, 0.25, 1.0), 0.5, 0.5)
    glass = Material("Glass", (0.0, 0.5, 1.0, 0.5), 0.0, 1.0)
    mesh = SkinnedMesh(
        "Brass",
        np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 20]]),
        np.array([[0, 1, 2], [0, 2, 3]]),
        np.array([[0.0, 0, 1], [0, 0, 1], [0, 0, 1], [1, 0, 0]]),
        np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]]),
        (brass, glass),
        np.array([0, 1]),
        np.array([[0, 1], [0, 1], [0, 1], [1, 0]]),
        np.array([[1.0, 0.0], [0.5, 0.5], [0.5, 0.5], [1.0, 0.0]]),
        binds,
        (MorphTarget("jawOpen", np.array([1, 3]), np.array([[0.0, 1, 0], [0, 0, 1]])),),
    )
    clip = Clip(
        "Performance",
        Fraction(30000, 1001),
        3,
        np.tile(identity, (3, 2, 1)),
        {1: np.array([[0.0, 0, 20], [0, 0, 30], [0, 0, 40]])},
        {"jawOpen": np.array([0.0, 0.5, 1.0])},
    )
    return Scene(bones, (mesh,), clip, "Suisou")


def test_the_text_of_a_file_is_what_it_was() -> None:
    found = text(read_elements(encode_scene(_scene()), "scene.fbx"))
    if os.environ.get("SUISOU_WRITE_GOLDEN"):
        GOLDEN.write_text(found, encoding="utf-8")
    assert found == GOLDEN.read_text(encoding="utf-8")
