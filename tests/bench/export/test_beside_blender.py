"""Time of a complete export with judged contacts, compared with Blender's export of as many frames to FBX alone."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
TOOL = ROOT / "tests" / "support" / "blender_reference.py"
MIDI = ROOT / "tests" / "data" / "midi" / "ensemble"
BONES, FPS = 60, 60


@pytest.mark.bench
@pytest.mark.parametrize(
    "piece", [ROOT / "resources" / "examples" / "quartet.mid", MIDI / "solo_horn_mozart_k447_mv1.mid"]
)
def test_a_whole_export_is_faster_than_blenders_fbx(piece: Path, tmp_path: Path) -> None:
    python = os.environ.get("SUISOU_BLENDER_PYTHON", "")
    if not Path(python).is_file() or subprocess.run([python, "-c", "import bpy"], check=False).returncode:
        pytest.skip("no Blender to compare with: SUISOU_BLENDER_PYTHON names no interpreter that has bpy")
    times_s = []
    for number in range(3):
        out = tmp_path / f"out {number}"
        start_s = time.perf_counter()
        command = [sys.executable, "-m", "app", "export", str(piece), "--to", str(out)]
        subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
        times_s.append(time.perf_counter() - start_s)
    ours_s, report = min(times_s), json.loads((out / "report.json").read_text(encoding="utf-8"))
    frames = report["frames"] * len(report["players"])
    command = [python, str(TOOL), str(tmp_path), str(frames), str(FPS), str(BONES), "fbx"]
    subprocess.run(command, check=True, capture_output=True)
    theirs_s = json.loads((tmp_path / "report.json").read_text())["fbx_s"]
    print(
        f"\n{piece.stem}: {frames} frames of players exported in {ours_s:.1f} s, {frames / FPS / ours_s:.0f} times real"
        f" time; Blender writes as many of FBX in {theirs_s:.1f} s, {theirs_s / ours_s:.1f} times as long",
        file=sys.stderr,
    )
    assert theirs_s / ours_s >= 4.0
