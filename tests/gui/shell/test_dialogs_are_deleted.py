"""A closed dialog leaves no widgets behind, however it was opened and closed."""

from __future__ import annotations

import importlib
import pkgutil
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication, QDialog, QMessageBox

import app.shell
import widgets.dialogs
from app.errors import Message
from app.rig.characters.read_figure import read_figure
from app.score.read import read_contents
from app.shell import characters, questions
from app.shell.app import Program
from app.shell.commands.exchange import reimport_from
from app.shell.commands.record import latency as show_latency
from app.shell.licences_dialog import LicencesDialog
from app.shell.questions import DialogQuestions
from tests.gui.conftest import QUARTET, delete_now
from tests.gui.shell.conftest import trigger
from tests.support.studio import Studio
from tests.unit.cli.test_main import ROOT
from widgets.common.actions import actions
from widgets.dialogs.character_draft import CharacterDraft
from widgets.dialogs.follow_recording import FollowRecordingDialog
from widgets.dialogs.instrument_map import InstrumentsDialog
from widgets.dialogs.metadata_differences import MetadataDifferencesDialog

FIGURE = ROOT / "tests" / "data" / "characters" / "toddler_vrm1.vrm"

Open = Callable[[Program], object]


def command(action_id: str) -> Open:
    return lambda program: trigger(program, action_id)


def ask_about_instruments(program: Program) -> None:
    """Open a question within a persistent dialog; the question is deleted first."""
    dialog = program.window.findChild(InstrumentsDialog) or InstrumentsDialog(program.session, program.window)
    dialog.ask(1)


def show_choreography(program: Program) -> None:
    if not program.session.project.dancers:
        trigger(program, "dancers.add")
    trigger(program, "dancers.choreography")


OPENED: dict[str, Open] = {
    "HelpWindow": command("help.guides"),
    "AboutDialog": command("application.about"),
    "LicencesDialog": lambda program: LicencesDialog(program.window).open(),
    "MetadataDifferencesDialog": lambda program: MetadataDifferencesDialog((), "x", program.window).open(),
    "RulesDialog": command("file.rules"),
    "FollowRecordingDialog": lambda program: FollowRecordingDialog(program.session, program.window).open(),
    "PieceSettingsDialog": command("file.piece_settings"),
    "PreferencesDialog": command("application.preferences"),
    "InstrumentsDialog": command("application.instruments"),
    "CharactersDialog": command("application.characters"),
    "CharacterDialog": lambda program: characters._dialog(
        program.editor, FIGURE, read_figure(FIGURE), CharacterDraft("x"), give=True
    ),
    "PersonDialog": lambda program: characters.make_person(program.editor),
    "ExportDialog": command("export.files"),
    "PlayblastDialog": command("export.playblast"),
    "EvaluationDialog": command("file.evaluation"),
    "EvaluationResultsDialog": command("file.evaluation_results"),
    "ChoreographyDialog": show_choreography,
    "LearnDialog": command("dancers.learn"),
    "StreamDialog": lambda program: actions(program.session)["stream.settings"].trigger(),
    "MidiDevicesDialog": command("record.devices"),
    "LatencyDialog": lambda program: show_latency(program.editor),
    "ReimportDialog": lambda program: reimport_from(program.editor, QUARTET),
    "ImportDialog": lambda program: DialogQuestions().import_midi(
        read_contents(QUARTET),
        lambda encoding: read_contents(QUARTET, encoding=encoding),
        program.session.tokens,
        program.session.tasks,
    ),
    "MessageBox of unsaved changes": lambda program: DialogQuestions().unsaved("x"),
    "MessageBox of a character": lambda program: DialogQuestions().remove_character("x", ("y",)),
    "MessageBox of work": lambda program: DialogQuestions().stop_writing((Message("work.export"),)),
    "MessageBox of a file": lambda program: questions._may_replace("x", Path("y")),
    "MessageBox of instruments": ask_about_instruments,
}


def kinds(base: type[QDialog]) -> set[type[QDialog]]:
    """Return the classes derived from a class that have no subclasses themselves."""
    below = base.__subclasses__()
    return set().union(*map(kinds, below)) if below else {base}


def test_no_dialog_is_missing_here() -> None:
    for package in (widgets.dialogs, app.shell):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            importlib.import_module(module.name)
    ours = {
        each.__name__
        for each in kinds(QDialog)
        if each.__module__.startswith(("app.", "widgets.")) and not issubclass(each, QMessageBox)
    }
    assert ours == {name for name in OPENED if " " not in name}


def widgets_now() -> Counter[str]:
    delete_now()
    return Counter(type(widget).__name__ for widget in QApplication.allWidgets())


def shut(way: str) -> set[str]:
    """Close every dialog and return their classes."""
    seen = set()
    for widget in QApplication.topLevelWidgets():
        if isinstance(widget, QDialog) and widget.isVisible():
            seen.add(type(widget).__name__)
            getattr(widget, way)()
    return seen


@pytest.mark.drawn
def test_nothing_is_left(studio: Studio) -> None:
    program = studio.program
    program.editor.files.open(QUARTET, ask=False)
    left = {}
    for name, show in OPENED.items():
        seen: set[str] = set()
        counts = []
        # The first time fills caches.
        for way in ("reject", "close"):
            # A dialog that blocks is closed while it waits.
            QTimer.singleShot(0, lambda way=way, seen=seen: seen.update(shut(way)))
            show(program)
            QApplication.processEvents()
            seen.update(shut(way))
            counts.append(widgets_now())
        assert name.split()[0] in seen
        if grown := counts[-1] - counts[0]:
            left[name] = dict(grown)
    assert left == {}
