"""The editor started from the command line in a separate process."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtGui import QImage

from tests.gui.conftest import QUARTET

ROOT = Path(__file__).parents[3]


def suisou(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run the program; empty variables are unset."""
    variables = {name: value for name, value in {**os.environ, **environment}.items() if value}
    return subprocess.run(
        [sys.executable, "-m", "app", *arguments],
        cwd=ROOT,
        env=variables,
        capture_output=True,
        text=True,
        check=False,
        timeout=900,
    )


def pixels(image: QImage) -> np.ndarray:
    image = image.convertToFormat(QImage.Format.Format_RGB888)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    # A copy: the rows are the picture's own memory.
    return rows[:, : image.width() * 3].reshape(image.height(), image.width(), 3).copy()


def test_a_picture_of_the_window(tmp_path: Path) -> None:
    target = tmp_path / "window.png"
    done = suisou(
        *("edit", str(QUARTET), "--screenshot", str(target), "--time", "12", "--size", "1280x800"),
        *("--theme", "light", "--language", "ja"),
        XDG_CONFIG_HOME=str(tmp_path / "config"),
    )
    assert (done.returncode, done.stderr) == (0, "")
    image = QImage(str(target))
    assert (image.width(), image.height()) == (1280, 800)
    shown = pixels(image)
    # The players are seen in the middle: many colours where a floor alone has few.
    middle = shown[120:460, 300:960].reshape(-1, 3)
    assert len(np.unique(middle // 16, axis=0)) > 60
    assert shown[2, 640].mean() > 200, "the theme is light"
    # No file of the user is read or written.
    assert not (tmp_path / "config").exists()


def test_a_file_that_cannot_be_read_is_reported(tmp_path: Path) -> None:
    broken = tmp_path / "broken.mid"
    broken.write_bytes(b"no music")
    done = suisou("edit", str(broken), "--screenshot", str(tmp_path / "window.png"))
    assert done.returncode == 1
    assert "is not a MIDI file" in done.stderr
    assert not (tmp_path / "window.png").exists()


def test_another_ending_than_a_pictures_is_refused_with_those_that_are_possible(tmp_path: Path) -> None:
    done = suisou("edit", "--screenshot", str(tmp_path / "window.abc"))
    assert done.returncode == 2
    assert "window.abc" in done.stderr
    assert ".png, .jpg" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("arguments", [(), ("edit",), ("piece.suisou",), ("PIECE.MID",)])
def test_without_a_display_it_says_so(arguments: tuple[str, ...]) -> None:
    done = suisou(*arguments, DISPLAY="", WAYLAND_DISPLAY="", QT_QPA_PLATFORM="")
    assert done.returncode == 3
    assert "needs a display" in done.stderr
    assert "Traceback" not in done.stderr
