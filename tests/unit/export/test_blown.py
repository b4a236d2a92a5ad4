"""A take as a MIDI file is exported and read back: the exported motion shows the blown breaths."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from app.cli import main
from app.formats.fbx.read import read_scene
from app.score.model import Score
from app.score.write import write_midi
from tests.support.blown import TEMPO, Blow, breath_curve, take, vibrato_curve

LIPS_MM = 2.0
SWELL = Blow(0.99, 4.0, lambda s: 0.25 + 0.7 * np.minimum(s / 3.0, 1.0))
VIBRATO_HZ = 5.5


def test_cheeks_breath_vibrato_and_rim_are_in_the_file(tmp_path: Path) -> None:
    curves = (
        breath_curve([SWELL, Blow(4.0, 4.6), Blow(5.0, 7.6)]),
        vibrato_curve(5.4, 7.6, 0.15, VIBRATO_HZ),
    )
    part = take([(1.0, 4.0, 65), (4.0, 5.0, 67), (5.0, 7.6, 69)], *curves)
    source, folder = tmp_path / "take.mid", tmp_path / "out"
    write_midi(Score("Take", 480, TEMPO, parts=(part,)), source)
    assert main(["export", str(source), "--to", str(folder), "--fps", "60", "--format", "fbx"]) == 0
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    clip = read_scene(folder / "Trumpet.fbx").clip
    times_s = report["first_frame_s"] + np.arange(clip.frames) / 60

    def between(morph: str, start_s: float, end_s: float) -> np.ndarray:
        return np.asarray(clip.morph_weights[morph])[(times_s >= start_s) & (times_s < end_s)]

    asked = SWELL.dynamics(times_s[(times_s >= 1.3) & (times_s < 3.9)] - SWELL.start_s)
    assert np.corrcoef(asked, between("cheekPuff", 1.3, 3.9))[0, 1] > 0.97
    assert between("jawOpen", 4.6, 5.0).max() > between("jawOpen", 2.0, 4.4).max() + 0.05
    lips = between("mouthPressLeft", 5.6, 7.5)
    spectrum = np.abs(np.fft.rfft((lips - lips.mean()) * np.hanning(len(lips))))
    assert np.fft.rfftfreq(len(lips), 1 / 60)[spectrum[2:].argmax() + 2] == pytest.approx(VIBRATO_HZ, abs=0.5)
    measures = report["players"][0]["measures"]
    assert measures["lips"]["frames"] > 300
    assert measures["lips"]["max_mm"] <= LIPS_MM
