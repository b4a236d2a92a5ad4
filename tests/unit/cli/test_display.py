"""Whether there is a display."""

from __future__ import annotations

import socket
import tempfile
from pathlib import Path

from app.cli.display import why_no_display


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
