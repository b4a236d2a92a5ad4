"""Draws the loops of the READMEs into docs/pictures/: the editor in each language while a quartet plays, and a band on
its stage.

Run from the repository: ``python -m resources.build.build_loops``; without a screen, under
``xvfb-run -a -s "-screen 0 1920x1200x24"``.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Final

from PIL import Image
from PySide6.QtCore import QEventLoop, Qt
from PySide6.QtWidgets import QApplication

from app.editor.settings import Settings
from app.messages import LANGUAGES
from app.shell.app import Program, make_application
from widgets.timeline.zoom_and_scroll import TimeAxis

ROOT: Final = Path(__file__).parents[2]
TARGET: Final = ROOT / "docs" / "pictures"
FPS: Final = 12
LENGTH_S: Final = 5.0
QUALITY: Final = 62

QUARTET: Final = ROOT / "resources" / "examples" / "quartet.mid"
WINDOW_PX: Final = (960, 760)
TIMELINE_PX: Final = 330
START_S: Final = 23.2
BEFORE_S, AFTER_S = 1.6, 3.4
"""Seconds visible in the timeline before and after the playhead."""
EDITOR_BOX: Final = (0, 66, 960, 706)
"""Part of the window that is kept, in pixels: viewport and timeline."""
EDITOR_SIZE: Final = (800, 533)

BAND: Final = ROOT / "tests" / "data" / "midi" / "ensemble" / "concert_band_hall_tenth_regiment_march.mid"
BAND_BARS: Final = (12, 17)
BAND_BOX: Final = (70, 150, 1230, 537)
BAND_SIZE: Final = (800, 267)

MOST_WAIT_S: Final = 120.0


def wait(application: QApplication, ready: Callable[[], bool], most_s: float = MOST_WAIT_S) -> None:
    """Let the editor work until a condition holds."""
    end_s = time.monotonic() + most_s
    while not ready() and time.monotonic() < end_s:
        application.processEvents(QEventLoop.ProcessEventsFlag.AllEvents, 50)
        time.sleep(0.005)


def editor_frames(application: QApplication, folder: Path, language: str) -> Iterator[Image.Image]:
    """Pictures of viewport and timeline in a language while the notes pass."""
    settings = Settings(folder / "editor.toml")
    settings.language, settings.theme = language, "dark"
    program = Program(settings, audible=False)
    window, session = program.window, program.session
    try:
        window.resize(*WINDOW_PX)
        window.show()
        window.resize(*WINDOW_PX)
        program.editor.files.open(QUARTET, ask=False)
        wait(application, lambda: program.editor.files.is_open)
        wait(application, lambda: session.performance.project is session.project)
        session.viewport.set_view("hands")
        session.set_playhead(START_S)
        window.reset_workspace()
        for name in ("players", "inspector"):
            window.docks[name].setVisible(False)
        window.docks["timeline"].setVisible(True)
        window.resizeDocks([window.docks["timeline"]], [TIMELINE_PX], Qt.Orientation.Vertical)
        wait(application, lambda: program.generator.ready_share >= 1.0)
        # The camera's flight to the hands.
        wait(application, lambda: False, 2.0)
        axis = window.findChild(TimeAxis)
        for at in range(round(LENGTH_S * FPS)):
            time_s = START_S + at / FPS
            session.set_playhead(time_s)
            axis.show(time_s - BEFORE_S, time_s + AFTER_S)
            wait(application, lambda: False, 0.15)
            file = folder / "frame.png"
            window.grab().toImage().save(str(file))
            with Image.open(file) as image:
                yield image.convert("RGB").crop(EDITOR_BOX).resize(EDITOR_SIZE, Image.Resampling.LANCZOS)
    finally:
        program.end()
        window.hide()


def band_frames(folder: Path) -> Iterator[Image.Image]:
    """Pictures of all performers on the stage."""
    first, last = BAND_BARS
    command = [
        sys.executable,
        "-m",
        "app",
        "film",
        str(BAND),
        "--to",
        str(folder),
        "--view",
        "ensemble",
        "--fps",
        str(FPS),
    ]
    subprocess.run([*command, "--from-bar", str(first), "--to-bar", str(last)], cwd=ROOT, check=True)
    for file in sorted(folder.glob("*.png"))[: round(LENGTH_S * FPS)]:
        with Image.open(file) as image:
            yield image.convert("RGB").crop(BAND_BOX).resize(BAND_SIZE, Image.Resampling.LANCZOS)


def write(name: str, frames: Sequence[Image.Image]) -> None:
    """Write an animated WebP that repeats forever."""
    path = TARGET / f"{name}.webp"
    frames[0].save(
        path, save_all=True, append_images=frames[1:], duration=round(1000 / FPS), loop=0, quality=QUALITY, method=6
    )
    print(f"{path.relative_to(ROOT)}: {len(frames)} frames, {path.stat().st_size // 1024} KB")


def main() -> None:
    """Draw and write all."""
    with tempfile.TemporaryDirectory() as folder:
        write("band", [*band_frames(Path(folder))])
    application = make_application()
    for language in LANGUAGES:
        suffix = "" if language == "en" else f"_{language}"
        with tempfile.TemporaryDirectory() as folder:
            write(f"playing{suffix}", [*editor_frames(application, Path(folder), language)])


if __name__ == "__main__":
    main()
