"""Joints of captured clips of various makers have the same positions as in bvhio and Blender."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.arrays import FloatArray
from app.formats.bvh.read import read_bvh
from tests.support.dance_measures import SHARED

FRAMES = 8
CLIPS = sorted((SHARED / "mocap").glob("*.bvh"))
_BLENDER = """
import json, sys
import bpy
for path in sys.argv[1:]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_anim.bvh(filepath=path, axis_forward="Y", axis_up="Z", rotate_mode="NATIVE", update_scene_fps=False)
    figure = bpy.context.object
    places = []
    for frame in range(1, %d + 1):
        bpy.context.scene.frame_set(frame)
        places.append({bone.name: list(figure.matrix_world @ bone.head) for bone in figure.pose.bones})
    print("PLACES", json.dumps(places))
"""


def shortened(clip: Path, folder: Path) -> Path:
    """Some frames of a clip, spread over all of it."""
    text = clip.read_text(encoding="latin-1")
    head, motion = text.split("MOTION")
    lines = [line for line in motion.splitlines() if line.strip()]
    rows = lines[2:]
    chosen = [rows[at] for at in np.linspace(0, len(rows) - 1, FRAMES).astype(int)]
    path = folder / clip.name
    path.write_text("\n".join([head + "MOTION", f"Frames: {FRAMES}", lines[1], *chosen, ""]), encoding="latin-1")
    return path


def places(path: Path) -> list[dict[str, FloatArray]]:
    """Positions of every joint in each frame as read by the program, calculated with scipy's rotations."""
    clip = read_bvh(path)
    found = []
    for frame in range(FRAMES):
        turns: list[Rotation] = []
        here: list[FloatArray] = []
        for joint, parent in enumerate(clip.parents):
            own = Rotation.from_quat(clip.rotations_xyzw[frame, joint])
            if parent < 0:
                turns.append(own)
                here.append(np.array(clip.root_translation_cm[frame], np.float64))
                continue
            way = clip.translations_cm[joint][frame] if joint in clip.translations_cm else clip.offsets_cm[joint]
            turns.append(turns[parent] * own)
            here.append(here[parent] + turns[parent].apply(way))
        found.append(dict(zip(clip.names, here, strict=True)))
    return found


@pytest.mark.filterwarnings("ignore:Importing PyGLM:PendingDeprecationWarning")
@pytest.mark.parametrize("clip", CLIPS, ids=lambda clip: clip.stem)
def test_bvhio_has_every_joint_where_we_have_it(clip: Path, tmp_path: Path) -> None:
    import bvhio  # warns at its first import

    path = shortened(clip, tmp_path)
    root = bvhio.readAsHierarchy(str(path))
    for frame, ours in enumerate(places(path)):
        root.loadPose(frame)
        theirs = {joint.Name: np.array(joint.PositionWorld, np.float64) for joint, _, _ in root.layout()}
        size = max(np.ptp(np.array(list(ours.values())), axis=0))
        for name, place in ours.items():
            assert np.linalg.norm(place - theirs[name]) < 1e-5 * size, (frame, name)


@pytest.mark.readers
@pytest.mark.skipif(not CLIPS, reason="no clips")
def test_blender_has_every_joint_where_we_have_it(tmp_path: Path) -> None:
    python = os.environ.get("SUISOU_BLENDER_PYTHON", "")
    if not Path(python).is_file():
        pytest.skip("no Blender: SUISOU_BLENDER_PYTHON names no interpreter that has bpy")
    paths = [shortened(clip, tmp_path) for clip in CLIPS]
    code = _BLENDER % FRAMES
    answer = subprocess.run([python, "-c", code, *map(str, paths)], capture_output=True, text=True, check=True).stdout
    answers = [json.loads(line[7:]) for line in answer.splitlines() if line.startswith("PLACES ")]
    assert len(answers) == len(paths)
    for path, theirs in zip(paths, answers, strict=True):
        for frame, ours in enumerate(places(path)):
            size = max(np.ptp(np.array(list(ours.values())), axis=0))
            for name, place in ours.items():
                assert np.linalg.norm(place - theirs[frame][name]) < 1e-4 * size, (path.name, frame, name)
