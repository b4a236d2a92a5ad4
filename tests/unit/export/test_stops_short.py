"""Small bodies with long slides: in the exported files the hand holds the slide in every frame, however far out."""

from __future__ import annotations

from pathlib import Path

import mido
import msgspec
import pytest

from app.cli import main
from app.export.report import Report
from instrument_maps.load import bundled_maps

TROMBONES = ("trombone_tenor_F_attachment", "trombone_bass_F_Gb")
BEAT_TICKS = 480


def every_place(instrument_id: str, path: Path) -> None:
    """The lowest two octaves upwards at 120, with all positions, the farthest ones with and without attachments."""
    file = mido.MidiFile(ticks_per_beat=BEAT_TICKS)
    track = mido.MidiTrack([mido.MetaMessage("set_tempo", tempo=500_000)])
    low = bundled_maps()[instrument_id].range.low
    for pitch in range(low, low + 24):
        track.append(mido.Message("note_on", note=pitch, velocity=80, time=2 * BEAT_TICKS if pitch == low else 0))
        track.append(mido.Message("note_off", note=pitch, velocity=0, time=BEAT_TICKS // 2))
    file.tracks.append(track)
    file.save(path)


@pytest.mark.parametrize("posture", ["seated", "standing"])
@pytest.mark.parametrize("instrument_id", TROMBONES)
def test_the_small_body_keeps_its_slide_in_hand(instrument_id: str, posture: str, tmp_path: Path) -> None:
    every_place(instrument_id, tmp_path / "scale.mid")
    settings = {"instrument": instrument_id, "posture": posture, "character": "woman_adult"}
    sets = [word for name, value in settings.items() for word in ("--set", f"*.{name}={value}")]
    folder = tmp_path / "out"
    assert (
        main(["export", str(tmp_path / "scale.mid"), "--to", str(folder), "--fps", "60", "--format", "fbx", *sets]) == 0
    )
    report = msgspec.json.decode((folder / "report.json").read_bytes(), type=Report)
    measures = report.players[0].measures
    assert measures is not None
    on_slide = [spread for name, spread in measures.contacts.items() if name.endswith("on slide")]
    assert len(on_slide) >= 3
    for spread in [*on_slide, measures.penetration, measures.bones, measures.lips]:
        assert spread.frames > 0
        assert spread.max_mm <= spread.bound_mm
    assert max(spread.max_mm for spread in on_slide) <= 2.0
    assert measures.acceleration.beyond == 0
    slide = measures.controls["slide"]
    assert slide.stopped_short > 0
    assert slide.right + slide.stopped_short == slide.judged
    assert slide.held_wrong == 0
    assert slide.held_stopped_short > 0
    assert 10.0 < slide.most_short_mm < 130.0
