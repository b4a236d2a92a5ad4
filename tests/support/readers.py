"""Check of an animation file by other programs' readers: `judge` runs `check_animation_file.py` in this folder. The
environment locates the readers: ``CHECK_ANIM_PYTHONS`` (interpreters, separated by colons) and
``CHECK_ANIM_NODE_MODULES``, as set by ``./test``. Fast readers are development dependencies and run in every test; slow
ones run in tests marked ``readers``.

Where the readers live is reported by the environment: ``CHECK_ANIM_PYTHONS`` (interpreters, separated by colons) and
``CHECK_ANIM_NODE_MODULES``, as ``./test`` sets them. The quick ones come with the development dependencies and are
asked in every run; the slow ones in tests marked ``readers``.
"""

from __future__ import annotations

import contextlib
import functools
import importlib.util
import io
import json
import os
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

import numpy as np

from app.arrays import AnyFloatArray
from tests.support import check_animation_file

QUICK_FBX = ("structure", "ufbx")
SLOW_FBX = ("fbxsdk", "blender", "assimp", "three", "pufbx")
QUICK_BVH = ("bvhio",)
SLOW_BVH = ("blender", "assimp", "three", "bvh", "pybvh")
QUICK_GLB = ("gltf",)
SLOW_GLB = ("gltfvalid", "three", "blender", "assimp")
QUICK_USD = ("usd",)

_MODULES = {"ufbx": "ufbx", "pufbx": "pufbx", "blender": "bpy", "bvhio": "bvhio", "bvh": "bvh", "pybvh": "pybvh",
            "usd": "pxr"}  # fmt: skip
_NODE_MODULES = {"fbxsdk": "fbx2gltf", "three": "three", "gltfvalid": "gltf-validator"}

# FBX2glTF samples at these rates only, so at others it cannot say how many frames there are.
_SDK_RATES = (24, 30, 60)
# The others count keys, at least where the format has no rate.
_KNOW_RATE = ("structure", "ufbx", "fbxsdk", "usd")


@dataclass(frozen=True)
class Expected:
    """Content that the readers should find.

    Attributes
    ----------
    fps : Fraction
    frames : int
        Length of the whole clip.
    sampled : sequence of int
        Frames at which the positions and weights are given.
    joints_cm : mapping of str to ndarray, shape (len(sampled), 3)
        World positions, all joints of the file.
    parents : mapping of str to str or None
    weights : mapping of str to ndarray, shape (len(sampled),)
    every_key : bool
        Whether every frame has a key: some readers find the rate by counting the keys.
    """

    fps: Fraction
    frames: int
    sampled: Sequence[int]
    joints_cm: Mapping[str, AnyFloatArray]
    parents: Mapping[str, str | None]
    weights: Mapping[str, AnyFloatArray] = field(default_factory=dict)
    every_key: bool = True


@functools.cache
def installed(reader: str) -> bool:
    """Return whether a reader is available."""
    if reader in ("structure", "gltf"):  # built in
        return True
    if reader == "assimp":
        return shutil.which("assimp") is not None
    if reader in _NODE_MODULES:
        folder = os.environ.get("CHECK_ANIM_NODE_MODULES", "")
        return shutil.which("node") is not None and (Path(folder) / _NODE_MODULES[reader]).is_dir()
    module = _MODULES[reader]
    if importlib.util.find_spec(module) is not None:
        return True
    code = f"import importlib.util as u, sys; sys.exit(u.find_spec({module!r}) is None)"
    pythons = [python for python in os.environ.get("CHECK_ANIM_PYTHONS", "").split(":") if Path(python).is_file()]
    return any(subprocess.run([python, "-c", code], check=False).returncode == 0 for python in pythons)


def judge(
    path: Path,
    expected: Expected,
    readers: Sequence[str],
    *,
    tolerance_cm: float = 0.01,
    weight_tolerance: float = 1e-4,
) -> None:
    """Let readers load a file and compare their results with the expected content.

    Raises
    ------
    AssertionError
        With the tool's whole report, if a reader fails, is missing, or finds other bones, parents, frames, rate,
        positions or weights than expected.
    """
    request, answer = path.with_suffix(".expected.json"), path.with_suffix(".readers.json")
    request.write_text(
        json.dumps(
            {
                "fps": float(expected.fps),
                "frames": list(expected.sampled),
                "joints": {name: np.asarray(values).tolist() for name, values in expected.joints_cm.items()},
                "weights": {name: np.asarray(values).tolist() for name, values in expected.weights.items()},
            }
        )
    )
    names = ",".join(readers)
    arguments = [str(path), "--expected", str(request), "--json", str(answer), "--readers", names, "--require", names]
    arguments += ["--tol", str(tolerance_cm), "--wtol", str(weight_tolerance)]
    # The tool itself runs here, so that it finds the interpreters once; each reader has a process of its own.
    with contextlib.redirect_stdout(io.StringIO()) as said:
        status = check_animation_file.main(arguments)
    report = said.getvalue()
    assert status == 0, report
    results = json.loads(answer.read_text())["readers"]
    for reader in readers:
        problems = _differences(reader, results[reader], expected)
        assert not problems, f"{reader}: {'; '.join(problems)}\n{report}"


def _differences(reader: str, found: dict[str, object], expected: Expected) -> list[str]:
    """Differences that the tool does not check: hierarchy, number of frames and rate, as far as the reader reports
    them.
    """
    problems = []
    parents = found["parent"]
    assert isinstance(parents, dict)
    if reader not in ("pybvh", "gltfvalid"):  # give no hierarchy
        wrong = [
            name
            for name, parent in expected.parents.items()
            if name not in parents or (parents[name] != parent and (parent or parents[name] in expected.parents))
        ]
        if reader == "three":  # it copies a bone for every mesh that uses it, and hangs each copy into the next
            wrong = [name for name in wrong if parents.get(name) != name]
        if wrong:
            problems.append(f"other parents of {', '.join(wrong[:5])}")
    if reader == "fbxsdk" and expected.fps not in _SDK_RATES:
        return problems
    fps, duration = found["fps"], found["duration"]
    if (
        (expected.every_key or reader in _KNOW_RATE)
        and isinstance(fps, float)
        and abs(fps - float(expected.fps)) > 1e-4 * fps
    ):
        problems.append(f"{fps} frames/s, not {float(expected.fps)}")
    if isinstance(duration, float):
        frames = duration * float(expected.fps) + 1
        if abs(frames - expected.frames) > 1e-2:
            problems.append(f"{frames} frames, not {expected.frames}")
    return problems
