"""Settings are restored with their types in the next run, whatever the file contains."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path

import pytest
from PySide6.QtCore import QByteArray

from app.editor.settings import MOST_RECENT, Settings
from app.errors import Message
from app.messages import text


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("language", "ja"),
        ("theme", "light"),
        ("written_pitch", True),
        ("middle_c_octave", 3),
        ("pitch_names", "german"),
        ("time_display", "frames"),
        ("volume", 0.35),
        ("click", True),
        ("percussion", False),
        ("scrub_sound", False),
        ("source", "both"),
        ("folded", {"a": True, "b c": False}),
        ("folder", "/a b/ü,日本語"),
        ("folder", os.fsdecode(b"/a/\x83e\x83X%41")),
        ("export_folder", "C:\\out"),
        ("geometry", QByteArray(b"\x00\x01\xff")),
        ("workspace", "record"),
    ],
)
def test_values_come_back(tmp_path: Path, name: str, value: object) -> None:
    path = tmp_path / "deep" / "editor.toml"
    first = Settings(path)
    default = getattr(first, name)
    assert default != value
    setattr(first, name, value)
    first.sync()
    again = getattr(Settings(path), name)
    assert again == value
    assert type(again) is type(default)


def test_syllables_of_an_earlier_version_are_kept(tmp_path: Path) -> None:
    path = tmp_path / "editor.toml"
    path.write_text("[pitch]\nsyllables = true\nwritten = true\n")
    settings = Settings(path)
    assert (settings.pitch_names, settings.written_pitch, settings.problems) == ("syllables", True, ())
    settings.middle_c_octave = 3
    settings.sync()
    assert Settings(path).pitch_names == "syllables"


def test_values_that_are_not_possible_are_named_and_the_others_hold(tmp_path: Path) -> None:
    path = tmp_path / "editor.toml"
    content = (
        "[interface]\ntheme = 'light'\nfolded = 'all'\n"
        "[pitch]\nmiddle_c_octave = 5\nwritten = 'yes'\n[sound]\nvolume = 3.0\n"
        "[midi]\ncount_in_bars = -1\n[stream]\nport = 99999999\n[window]\ngeometry = 5\n[files]\nrecent = 'x'\n"
    )
    path.write_text(content)
    settings = Settings(path)
    assert (settings.theme, settings.middle_c_octave, settings.written_pitch) == ("light", 4, False)
    assert (settings.volume, settings.count_in_bars, settings.stream_port) == (0.8, 1, 0)
    assert (settings.recent, settings.folded, settings.geometry) == ((), {}, QByteArray())
    assert {problem.arguments["place"] for problem in settings.problems} == {
        *("interface.folded", "pitch.middle_c_octave", "pitch.written", "sound.volume"),
        *("midi.count_in_bars", "stream.port", "window.geometry", "files.recent"),
    }
    assert all(str(path) in text(problem) for problem in settings.problems)
    # A value written by the user stays until it is chosen again.
    settings.volume = 0.5
    settings.sync()
    written = tomllib.loads(path.read_text())
    assert written["sound"] == {"volume": 0.5}
    assert written["pitch"] == {"middle_c_octave": 5, "written": "yes"}


@pytest.mark.parametrize(
    "content", [b"[midi]\ncount_in_bars = inf", b"[midi]\ncount_in_bars = 1" + b"0" * 5000, b"\xff", b"[a"]
)
def test_a_file_that_cannot_be_read_is_named_and_left_as_it_is(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "editor.toml"
    path.write_bytes(content)
    settings = Settings(path)
    reported: list[Message] = []
    settings.failed.connect(reported.append)
    assert settings.count_in_bars == 1
    assert [problem.arguments["file"] for problem in settings.problems] == [str(path)] * 2
    settings.theme = "light"
    settings.sync()
    assert settings.theme == "light"
    assert path.read_bytes() == content
    # It was reported before.
    assert reported == []
    # Values chosen meanwhile are kept as soon as the file is valid again.
    path.write_text("[interface]\nlanguage = 'ja'\n")
    settings.sync()
    again = Settings(path)
    assert (again.theme, again.language, again.problems) == ("light", "ja", ())


def test_a_file_that_cannot_be_written_is_reported_once(tmp_path: Path) -> None:
    settings = Settings(tmp_path / "config" / "editor.toml")
    (tmp_path / "config").touch()
    reported: list[Message] = []
    settings.failed.connect(reported.append)
    for theme in ("light", "dark", "light"):
        settings.theme = theme
        settings.sync()
    assert settings.theme == "light"
    assert [message.id for message in reported] == ["file.cannot_read", "settings.set_aside"]


def test_two_editors_keep_what_the_other_chose(tmp_path: Path) -> None:
    path = tmp_path / "editor.toml"
    first, second = Settings(path), Settings(path)
    first.theme = "light"
    second.language = "ja"
    second.set_shortcut("file.save", "F2")
    first.sync()
    second.sync()
    again = Settings(path)
    assert (again.theme, again.language, again.shortcut("file.save")) == ("light", "ja", "F2")


def test_recent_files_are_the_newest_first_and_each_once(tmp_path: Path) -> None:
    settings = Settings(tmp_path / "editor.toml")
    odd = os.fsdecode(bytes(tmp_path / "7") + b"\xff.suisou")
    for number in range(MOST_RECENT + 3):
        settings.add_recent(tmp_path / f"{number}.suisou")
    settings.add_recent(Path(odd))
    settings.add_recent(tmp_path / "7.suisou")
    settings.sync()
    recent = Settings(tmp_path / "editor.toml").recent
    assert len(recent) == MOST_RECENT
    assert recent[:2] == (str(tmp_path / "7.suisou"), odd)
    assert len(set(recent)) == MOST_RECENT
    settings.remove_recent(recent[0])
    assert recent[0] not in settings.recent


def test_shortcuts_of_ones_own(tmp_path: Path) -> None:
    settings = Settings(tmp_path / "editor.toml")
    assert settings.shortcut("file.save") is None
    settings.set_shortcut("file.save", "Ctrl+Alt+S;F2")
    settings.set_shortcut("file.open", "")
    settings.sync()
    again = Settings(tmp_path / "editor.toml")
    assert again.shortcut("file.save") == "Ctrl+Alt+S;F2"
    assert again.shortcut("file.open") == ""
    again.set_shortcut("file.save", None)
    assert again.shortcut("file.save") is None


def test_what_is_remembered_of_devices(tmp_path: Path) -> None:
    settings = Settings(tmp_path / "editor.toml")
    port = 'EWI "5000" [x].y = \x7f:1'
    settings.set_midi_device(port, "breath", "cc2")
    settings.set_midi_device(port, "bite", "none")
    settings.set_midi_device("", "bite", "none")
    settings.sync()
    again = Settings(tmp_path / "editor.toml")
    assert [again.midi_device(name, "breath") for name in (port, "", "other")] == ["cc2", "", ""]
    assert again.midi_device(port, "bite") == "none"
