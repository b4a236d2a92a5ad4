"""Opening a MIDI file without playable parts shows a message."""

from __future__ import annotations

from pathlib import Path

import mido
import pytest
from PySide6.QtWidgets import QLabel, QPushButton

from app.shell.app import Program
from tests.gui.shell.conftest import Answers


def written(folder: Path, name: str, *tracks: list[mido.Message | mido.MetaMessage]) -> Path:
    path = folder / name
    mido.MidiFile(tracks=[mido.MidiTrack(track) for track in tracks]).save(path)
    return path


def banner(program: Program) -> tuple[str, list[QPushButton]]:
    """Text and buttons of the banner."""
    assert program.window.banner.isVisible()
    text = program.window.banner.findChild(QLabel, "banner_text")
    assert isinstance(text, QLabel)
    buttons = [
        button
        for button in program.window.banner.findChildren(QPushButton)
        if button.objectName().startswith("banner_answer") and button.isVisible()
    ]
    return text.text().replace("\u200b", ""), buttons


@pytest.mark.parametrize(
    ("language", "reported"),
    [
        (
            "en",
            [
                "empty.mid has no players.",
                "The file has 2 tracks and no notes",
                "Track 1 (Horn) has no notes and 1 other event",
            ],
        ),
        (
            "ja",
            ["empty.mid には奏者がいません。", "音符がありません（2 トラック）", "トラック 1（Horn）には音符がなく"],
        ),
    ],
)
def test_of_a_file_without_notes_every_track_is_named(
    empty: Program, tmp_path: Path, language: str, reported: list[str]
) -> None:
    named = [mido.MetaMessage("track_name", name="Horn"), mido.Message("control_change", control=7, value=100)]
    empty.editor.speak(language)
    empty.editor.files.open(written(tmp_path, "empty.mid", named, []), ask=False)
    text, answers = banner(empty)
    assert all(part in text for part in reported), text
    assert len(answers) == 1


def test_of_a_file_without_winds_the_reasons_are_given_and_the_tracks_are_offered(
    empty: Program, answers: Answers, tmp_path: Path
) -> None:
    hit = [mido.Message("note_on", channel=9, note=36), mido.Message("note_off", channel=9, note=36, time=240)]
    empty.editor.files.open(
        written(tmp_path, "drums.mid", [mido.MetaMessage("track_name", name="Kit"), *hit]), ask=False
    )
    text, buttons = banner(empty)
    assert text.splitlines()[0] == "drums.mid has no players."
    assert "Kit" in text
    assert "percussion" in text
    buttons[0].click()
    assert answers.asked == ["import"]


def test_of_a_file_that_is_played_nothing_is_said(program: Program) -> None:
    assert not program.window.banner.isVisible()
