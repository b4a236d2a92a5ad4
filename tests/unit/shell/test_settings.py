"""What is chosen is there in the next run, with its type."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QByteArray

from app.shell.settings import MOST_RECENT, Settings


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("language", "ja"),
        ("theme", "light"),
        ("written_pitch", True),
        ("middle_c_octave", 3),
        ("syllables", True),
        ("time_display", "frames"),
        ("volume", 0.35),
        ("click", True),
        ("scrub_sound", False),
        ("source", "both"),
        ("folder", "/a b/ü,日本語"),
        ("export_folder", "C:\\out"),
        ("geometry", QByteArray(b"\x00\x01\xff")),
        ("layout", QByteArray(b"\x80\x00")),
    ],
)
def test_values_come_back(tmp_path: Path, name: str, value: object) -> None:
    path = tmp_path / "deep" / "editor.ini"
    first = Settings(path)
    default = getattr(first, name)
    assert default != value
    setattr(first, name, value)
    first.sync()
    again = getattr(Settings(path), name)
    assert again == value
    assert type(again) is type(default)


def test_a_damaged_file_is_as_if_it_were_not_there(tmp_path: Path) -> None:
    path = tmp_path / "editor.ini"
    path.write_text(
        "[pitch]\nmiddle_c_octave=many\nwritten=@Invalid()\n[window]\ngeometry=5\n[recent]\nsize=x\n[sound]\nvolume=loud\n"
    )
    settings = Settings(path)
    assert settings.middle_c_octave == 4
    assert settings.written_pitch is False
    assert settings.recent == ()
    assert settings.volume == 0.8


def test_recent_files_are_the_newest_first_and_each_once(tmp_path: Path) -> None:
    settings = Settings(tmp_path / "editor.ini")
    for number in range(MOST_RECENT + 3):
        settings.add_recent(tmp_path / f"{number}.suisou")
    settings.add_recent(tmp_path / "7.suisou")
    settings.sync()
    recent = Settings(tmp_path / "editor.ini").recent
    assert len(recent) == MOST_RECENT
    assert recent[0] == str(tmp_path / "7.suisou")
    assert len(set(recent)) == MOST_RECENT
    settings.remove_recent(recent[0])
    assert recent[0] not in settings.recent


def test_shortcuts_of_ones_own(tmp_path: Path) -> None:
    settings = Settings(tmp_path / "editor.ini")
    assert settings.shortcut("file.save") is None
    settings.set_shortcut("file.save", "Ctrl+Alt+S;F2")
    settings.set_shortcut("file.open", "")
    settings.sync()
    again = Settings(tmp_path / "editor.ini")
    assert again.shortcut("file.save") == "Ctrl+Alt+S;F2"
    assert again.shortcut("file.open") == ""
    again.set_shortcut("file.save", None)
    assert again.shortcut("file.save") is None
