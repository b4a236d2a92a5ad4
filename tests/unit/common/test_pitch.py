"""Names of pitches."""

from __future__ import annotations

from typing import get_args

import pytest

from app.editor.session import PitchDisplay
from app.messages.pitches import PitchNames, pitch_name, spelled
from app.shell.language import TEXTS
from widgets.common.pitch import pitch_from, pitch_text


@pytest.mark.parametrize(
    ("pitch", "octave", "name"),
    [(60, 4, "C4"), (60, 3, "C3"), (59, 4, "B3"), (0, 4, "C-1"), (127, 4, "G9"), (70, 4, "B♭4"), (66, 4, "F♯4")],
)
def test_a_pitch_has_its_usual_name(pitch: int, octave: int, name: str) -> None:
    assert pitch_name(pitch, octave) == name


def test_names_rise_without_gaps() -> None:
    assert len({pitch_name(pitch) for pitch in range(128)}) == 128


def test_syllables() -> None:
    assert pitch_name(70, 4, spelled(("ド", "レ", "ミ", "ファ", "ソ", "ラ", "シ"))) == "シ♭4"


@pytest.mark.parametrize(
    ("text", "letters", "german"),
    [
        ("B3", 59, 58), ("H3", 59, 59), ("b♭3", 58, 58), ("Es4", 63, 63), ("es 4", 63, 63), ("As4", 68, 68),
        ("fis4", 66, 66), ("Gis4", 68, 68), ("Des4", 61, 61), ("His3", 60, 60), ("Ces4", 59, 59), ("E♭4", 63, 63),
        ("C#4", 61, 61), ("シ♭3", 58, 58), ("A4", 69, 69), ("61", 61, 61), ("X4", None, None), ("B", None, None),
    ],
)  # fmt: skip
def test_a_typed_pitch_is_understood(
    text: str, letters: int | None, german: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("widgets.common.pitch.tr", lambda id: TEXTS[id][1])
    display = PitchDisplay()
    assert pitch_from(display, text) == letters
    display.set(names="german")
    assert pitch_from(display, text) == german


@pytest.mark.parametrize("names", get_args(PitchNames))
def test_every_shown_name_is_read_back(names: PitchNames, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("widgets.common.pitch.tr", lambda id: TEXTS[id][0])
    display = PitchDisplay()
    display.set(names=names)
    assert [pitch_from(display, pitch_text(display, pitch)) for pitch in range(128)] == [*range(128)]


def test_written_pitch_is_shown_where_it_is_requested(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("widgets.common.pitch.tr", lambda id: TEXTS[id][0])
    display = PitchDisplay()
    assert pitch_text(display, 70, 2) == "B♭4"
    display.set(written=True, middle_c_octave=3)
    assert pitch_text(display, 70, 2) == "C4"
    display.set(names="syllables")
    assert pitch_text(display, 70, 2) == "Do4"
