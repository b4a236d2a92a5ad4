"""Draws the picture of ``docs/into-unreal.md``: the export dialog before it exports into an Unreal project again.

Run from the repository: ``python -m tests.support.unreal_pictures``; needs a display (without a screen:
``xvfb-run -a -s "-screen 0 2560x1600x24"``). Arguments: a folder, a language and a theme (``docs/pictures en dark`` if
left out). In another folder the dialog is drawn before the first export and after it too.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
from pathlib import Path
from typing import Final

from PySide6.QtCore import QEventLoop, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QComboBox, QPushButton, QSpinBox

from app.editor.settings import Settings
from app.project.autosave import Autosave
from app.project.running_editors import Presence
from app.shell.app import Program, make_application
from app.shell.commands.exchange import export_files
from tests.support.windows import child
from widgets.dialogs.export_files import ExportDialog

ROOT: Final = Path(__file__).parents[2]
PIECE: Final = ROOT / "resources" / "examples" / "quartet.mid"
PICTURES: Final = ROOT / "docs" / "pictures"
SIZE: Final = (1000, 660)


class Artist:
    """User who exports the quartet into a project."""

    def __init__(self, folder: Path, language: str, theme: str) -> None:
        self.application = make_application()
        settings = Settings(folder / "editor.toml")
        settings.language, settings.theme = language, theme
        settings.export_into = "unreal"
        # A relative path, so that the picture shows no real folders.
        os.chdir(folder)
        project = Path("Concert", "Concert.uproject")
        project.parent.mkdir(exist_ok=True)
        project.write_text(json.dumps({"FileVersion": 3, "EngineAssociation": "5.6"}))
        settings.unreal_project = str(project)
        self.program = Program(settings, autosave=Autosave(Presence(folder / "recovery")))
        self.program.window.show()
        self.program.editor.files.open(PIECE, ask=False)
        self.live(lambda: self.program.editor.files.is_open)
        export_files(self.program.editor)
        found = child(self.program.window, ExportDialog)
        self.dialog = found
        self.dialog.resize(*SIZE)
        bars, last = (
            self.dialog.findChild(QComboBox, "export_range"),
            self.dialog.findChild(QSpinBox, "export_last_bar"),
        )
        assert last is not None
        bars.setCurrentIndex(1)
        last.setValue(2)

    def live(self, until: object, most_s: float = 240.0) -> None:
        """Process events until a condition holds."""
        end_s = time.monotonic() + most_s
        assert callable(until)
        while not until():
            assert time.monotonic() < end_s
            self.application.processEvents(QEventLoop.ProcessEventsFlag.AllEvents, 50)
        self.application.processEvents()

    def export(self) -> None:
        """Export and wait until it is finished."""
        start = child(self.dialog, QPushButton, "export_start")
        QTest.mouseClick(start, Qt.MouseButton.LeftButton)
        self.live(start.isEnabled)

    def look(self, path: Path) -> None:
        """Write a picture of the dialog."""
        self.application.processEvents()
        self.dialog.grab().save(str(path))


def main(folder: str = str(PICTURES), language: str = "en", theme: str = "dark") -> None:
    """Draw the pictures."""
    target = Path(folder).resolve()
    with tempfile.TemporaryDirectory() as work:
        artist = Artist(Path(work), language, theme)
        if target != PICTURES:
            artist.look(target / f"first_{language}_{theme}.png")
        artist.export()
        if target != PICTURES:
            artist.look(target / f"done_{language}_{theme}.png")
        artist.dialog._players.item(3).setCheckState(Qt.CheckState.Unchecked)
        suffix = "" if language == "en" else f"_{language}"
        again = f"export-unreal{suffix}.png" if target == PICTURES else f"again_{language}_{theme}.png"
        artist.look(target / again)
        artist.dialog.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
