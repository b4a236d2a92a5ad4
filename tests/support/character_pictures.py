"""Draws the pictures of ``docs/bring-your-own-character.md``: a foreign character brought, corrected and played.

Run from the repository: ``python -m tests.support.character_pictures FOLDER [LANGUAGE:THEME ...]``; needs a display
(without a screen: ``xvfb-run -a -s "-screen 0 2560x1600x24"``). The user's own characters are not touched.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

from PIL import Image
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialogButtonBox, QWidget

from app.editor.settings import Settings
from app.editor.tasks import ThreadTasks
from app.rig.characters.character_library import FOLDER_VARIABLE, character_library
from app.shell.app import Program, make_application
from app.shell.characters import bring_character
from tests.support.windows import child
from widgets.common.actions import actions
from widgets.dialogs.character import CharacterDialog
from widgets.dialogs.characters import CharactersDialog

ROOT: Final = Path(__file__).parents[2]
FOREIGN: Final = ROOT / "tests" / "data" / "characters"
HOLD_S: Final = 400.0
"""Longest time in seconds for fitting the grip of a new body on a slow machine."""


class Studio:
    """The editor with the example open."""

    def __init__(self, application: QApplication, folder: Path, language: str, theme: str) -> None:
        self.application = application
        settings = Settings(folder / "editor.toml")
        settings.language, settings.theme = language, theme
        self.program = Program(settings, audible=False)
        self.window = self.program.window
        self.window.resize(1500, 900)
        self.window.show()
        self.program.editor.files.open(ROOT / "resources" / "examples" / "quartet.mid", ask=False)
        self.wait(60.0, lambda: self.program.editor.files.is_open and self.program.generator.up_to_date)

    def wait(self, most_s: float, until: Callable[[], bool] = lambda: False) -> None:
        """Process events until a condition holds."""
        end_s = time.monotonic() + most_s
        while not until() and time.monotonic() < end_s:
            self.application.processEvents()
            time.sleep(0.005)

    @property
    def working(self) -> bool:
        """Return whether a background task is running."""
        tasks = self.program.tasks
        return isinstance(tasks, ThreadTasks) and bool(tasks.running)

    def bring(self, name: str) -> CharacterDialog:
        """Open a character's file and return the dialog once it is drawn."""
        self.wait(5.0, lambda: self.window.findChild(CharacterDialog) is None)
        bring_character(self.program.editor, FOREIGN / name)
        self.wait(30.0, lambda: self.window.findChild(CharacterDialog) is not None)
        dialog = self.window.findChild(CharacterDialog)
        assert isinstance(dialog, CharacterDialog)
        self.settle()
        return dialog

    def settle(self) -> None:
        """Wait until pictures are drawn."""
        self.wait(0.5)
        self.wait(60.0, lambda: not self.working)
        self.wait(0.3)

    def end(self) -> None:
        """Close the editor."""
        self.program.end()
        self.window.hide()
        self.window.deleteLater()
        self.wait(0.3)


def save(widget: QWidget, path: Path) -> None:
    """Save a picture of a widget at a size suitable for the repository."""
    shot = widget.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    picture = Image.frombuffer(
        "RGB", (shot.width(), shot.height()), bytes(shot.constBits()), "raw", "RGB", shot.bytesPerLine(), 1
    )
    picture.save(path, optimize=True)


def keep(studio: Studio, dialog: CharacterDialog) -> None:
    """Save a character and assign it to the first selected player."""
    dialog.give.setChecked(True)
    box = child(dialog, QDialogButtonBox)
    QTest.mouseClick(box.button(QDialogButtonBox.StandardButton.Ok), Qt.MouseButton.LeftButton)
    studio.wait(30.0, lambda: bool(character_library().own))


def draw(target: Path, language: str, theme: str) -> None:
    """Draw all pictures in one language and theme."""
    application = QApplication.instance()
    assert isinstance(application, QApplication)
    suffix = "" if language == "en" else f"_{language}"
    with tempfile.TemporaryDirectory() as folder:
        os.environ[FOLDER_VARIABLE] = str(Path(folder) / "characters")
        studio = Studio(application, Path(folder), language, theme)
        mittens = studio.bring("man_cmu.fbx")
        mittens.choose("leftIndexProximal")
        studio.settle()
        save(mittens, target / f"character-mittens{suffix}.png")
        mittens.reject()
        dialog = studio.bring("toddler_vrm1.vrm")
        dialog.choose("leftThumbProximal")
        studio.settle()
        save(dialog, target / f"character-body{suffix}.png")
        dialog.tabs.setCurrentIndex(1)
        dialog.faces.choose("eyeBlinkLeft")
        studio.settle()
        save(dialog, target / f"character-face{suffix}.png")
        dialog.reject()
        child = studio.bring("child_mixamo.fbx")
        keep(studio, child)
        program = studio.program
        studio.wait(HOLD_S, lambda: program.generator.up_to_date and not studio.working)
        note = program.session.project.part(program.session.project.players[0]).notes[2]
        time_s = program.session.project.score.tempo_map.seconds(note.onset_tick) + 0.1
        program.session.set_playhead(time_s)
        program.session.reveal(time_s)
        own = program.session.project.players[0].id
        studio.wait(120.0, lambda: program.generator.live.pose(own, time_s) is not None)
        program.session.viewport.set_view("front")
        studio.wait(60.0, lambda: program.generator.ready_share >= 1.0)
        studio.settle()
        studio.wait(2.0)
        save(studio.window, target / f"character-plays{suffix}.png")
        actions(program.session)["application.characters"].trigger()
        studio.settle()
        shelf = studio.window.findChild(CharactersDialog)
        assert isinstance(shelf, CharactersDialog)
        save(shelf, target / f"characters{suffix}.png")
        studio.end()


if __name__ == "__main__":
    make_application()
    chosen = sys.argv[2:] or ["en:dark"]
    for assignment in chosen:
        draw(Path(sys.argv[1]), *assignment.split(":"))
