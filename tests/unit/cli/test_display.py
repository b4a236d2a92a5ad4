"""Detection of a display."""

from __future__ import annotations

import shlex
import socket
import tempfile
from pathlib import Path

import pytest

from app.__main__ import run
from app.cli import parser
from app.cli.display import why_no_display
from app.cli.status import BAD_USE, NO_DISPLAY


def test_no_variable_no_display() -> None:
    assert "neither DISPLAY nor WAYLAND_DISPLAY" in (why_no_display({}, "linux") or "")


def test_other_systems_need_no_variable() -> None:
    assert why_no_display({}, "win32") is None
    assert why_no_display({}, "darwin") is None


def test_platforms_without_a_display_are_let_through() -> None:
    assert why_no_display({"QT_QPA_PLATFORM": "offscreen"}, "linux") is None
    assert why_no_display({"QT_QPA_PLATFORM": "vnc:size=800x600"}, "linux") is None
    assert why_no_display({"QT_QPA_PLATFORM": "xcb"}, "linux") is not None


def test_a_display_where_no_one_answers() -> None:
    assert "none answers at :7177" in (why_no_display({"DISPLAY": ":7177"}, "linux") or "")
    assert "none answers" in (why_no_display({"WAYLAND_DISPLAY": "wayland-7177"}, "linux") or "")


def test_a_display_that_answers() -> None:
    with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_UNIX) as server:
        server.bind(str(Path(folder) / "wayland-0"))
        server.listen()
        assert why_no_display({"WAYLAND_DISPLAY": "wayland-0", "XDG_RUNTIME_DIR": folder}, "linux") is None
    with socket.create_server(("127.0.0.1", 0)) as server:
        number = server.getsockname()[1] - 6000
        assert why_no_display({"DISPLAY": f"127.0.0.1:{number}.0"}, "linux") is None


def test_without_a_file_and_a_display_the_example_is_offered(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("app.cli.display.why_no_display", lambda: "no display here")
    assert run([]) == NO_DISPLAY
    reason, hint = capsys.readouterr().err.splitlines()
    assert reason == "suisou: no display here"
    program, *arguments = shlex.split(hint.partition("quartet: ")[2])
    # The suggested command can be typed as it is.
    assert program == "suisou"
    parsed = parser().parse_args(arguments)
    assert parsed.file.is_file()
    assert run(["edit", "mine.mid"]) == NO_DISPLAY
    assert capsys.readouterr().err == "suisou: no display here\n"


def test_a_file_that_is_no_piece_is_refused_by_its_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["song.wav"]) == BAD_USE
    assert "song.wav is neither a command nor a project, MIDI file or score" in capsys.readouterr().err
