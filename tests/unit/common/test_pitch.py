"""Names of pitches."""

from __future__ import annotations

import pytest

from app.editor.session import PitchDisplay
from app.messages.pitches import pitch_name
from app.shell.language import TEXTS
from widgets.common.pitch import pitch_text


@pytest.mark.parametrize(
    ("pitch", "octave", "name"),
    [(60, 4, "C4"), (60, 3, "C3"), (59, 4, "B3"), (0, 4, "C-1"), (127, 4, "G9"), (70, 4, "B♭4"), (66, 4, "F♯4")],
)
def test_a_pitch_has_its_usual_name(pitch: int, octave: int, name: str) -> None:
    assert pitch_name(pitch, octave) == name


def test_names_rise_without_gaps() -> None:
    assert len({pitch_name(pitch) for pitch in range(128)}) == 128


def test_syllables() -> None:
    assert pitch_name(70, 4, ("ド", "レ", "ミ", "ファ", "ソ", "ラ", "シ")) == "シ♭4"


def test_written_pitch_is_shown_where_it_is_requested(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("widgets.common.pitch.tr", lambda id: TEXTS[id][0])
    display = PitchDisplay()
    assert pitch_text(display, 70, 2) == "B♭4"
    display.set(written=True, middle_c_octave=3)
    assert pitch_text(display, 70, 2) == "C4"
    display.set(syllables=True)
    assert pitch_text(display, 70, 2) == "Do4"
