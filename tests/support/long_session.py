"""A long session of the editor: piece after piece, with changes of panels, languages and themes, and a measurement of
memory and objects after each round. ``python -m tests.support.long_session ROUNDS`` runs it and prints the measurements
of each round.

``python -m tests.support.long_session ROUNDS`` runs it for long, and prints what each round left.
"""

from __future__ import annotations

import ctypes
import gc
import multiprocessing
import os
import resource
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QEvent, QObject, QTimer
from PySide6.QtWidgets import QApplication, QWidget

from app.editor.settings import Settings
from app.editor.tasks import ThreadTasks
from app.project.autosave import Autosave
from app.project.running_editors import Presence
from app.project.storage import save
from app.shell.app import Program, make_application
from app.shell.commands.exchange import reimport_from
from app.shell.garbage_collection import Garbage
from tests.bench.performance.large import large_project
from tests.support.windows import LOOK_AGAIN_MS, child, pause
from widgets.common.actions import actions
from widgets.dialogs.reimport_midi import ReimportDialog

QUARTET = Path(__file__).parents[2] / "resources" / "examples" / "quartet.mid"
OURS = ("app.", "widgets.")
OTHERS = ("pyqtgraph.", "vispy.")
_PAGE = resource.getpagesize()


@dataclass(frozen=True)
class Footprint:
    """Memory and objects of the process.

    Attributes
    ----------
    memory_mb : float
        Resident, once the allocator has returned what is free.
    threads, files, processes, widgets, objects : int
        Python's threads, open file descriptors, child processes, widgets, all objects of Qt below the application and
        its windows.
    timers : Counter
        Active timers of Qt, by their parent's class and their interval.
    values : Counter
        Python's objects of our classes and of the drawing libraries, by class.
    widgets_by_class : Counter
    """

    memory_mb: float
    threads: int
    files: int
    processes: int
    timers: Counter[str]
    widgets: int
    objects: int
    values: Counter[str]
    widgets_by_class: Counter[str]

    def __str__(self) -> str:
        return (
            f"{self.memory_mb:7.1f} MB, {self.threads} threads, {self.files} files, {self.processes} processes, "
            f"timers {dict(self.timers)}, {self.widgets} widgets, {self.objects} objects, {self.values.total()} values"
        )


def footprint() -> Footprint:
    """Measure memory and objects of the process after freeing everything that can be freed."""
    for _ in range(3):
        QCoreApplication.processEvents()
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete.value)
        # Objects exempted by the editor count too.
        gc.unfreeze()
        gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    application = QApplication.instance()
    assert isinstance(application, QApplication)
    found: dict[int, QObject] = {}
    # Objects with parents are found below their topmost parent.
    for top in (application, *(widget for widget in QApplication.allWidgets() if widget.parent() is None)):
        for each in (top, *top.findChildren(QObject)):
            found[id(each)] = each
    values: Counter[str] = Counter()
    for each in gc.get_objects():
        module = str(getattr(type(each), "__module__", ""))
        if module.startswith((*OURS, *OTHERS)):
            values[f"{module}.{type(each).__qualname__}"] += 1
    return Footprint(
        memory_mb=int(Path("/proc/self/statm").read_text().split()[1]) * _PAGE / 2**20,
        threads=threading.active_count(),
        files=sum(1 for _ in Path("/proc/self/fd").iterdir()),
        processes=len(multiprocessing.active_children()) + len(_children()),
        timers=Counter(
            f"{type(each.parent()).__name__} {each.interval()} ms"
            for each in found.values()
            if isinstance(each, QTimer) and each.isActive()
        ),
        widgets=len(QApplication.allWidgets()),
        objects=len(found),
        values=values,
        widgets_by_class=Counter(type(widget).__name__ for widget in QApplication.allWidgets()),
    )


def _children() -> list[str]:
    return Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()


class LongDay:
    """A user who repeats all activities in rounds.

    Parameters
    ----------
    program : Program
    pieces : sequence of Path
        Opened in turn, in each round.
    """

    def __init__(self, program: Program, *pieces: Path) -> None:
        self.program, self.session, self.pieces = program, program.session, pieces

    def round(self) -> None:
        """Open, view, play, edit and close every piece once."""
        window = self.program.window
        for path in self.pieces:
            self.program.editor.files.open(path, ask=False)
            self.until(lambda: self.program.editor.files.is_open)
            self.until(lambda: self.session.performance.project is self.session.project)
            self.dress()
            self.move_panels()
            self.fill_screen()
            window.showMinimized()
            self.wait(0.05)
            window.showNormal()
            self.play()
            self.edit()
            self.open_dialogs()
            self.read_again()
            self.program.editor.files.close()
            self.until(lambda: not self.program.editor.files.is_open)
        # Without a piece the plans are empty, and motion of the former piece is released.
        self.until(lambda: self.program.generator.ready_share >= 1.0 and self.program.generator.up_to_date)
        tasks = self.program.tasks
        assert isinstance(tasks, ThreadTasks)
        self.until(lambda: tasks.is_idle)
        self.wait(0.3)

    def dress(self) -> None:
        """Change theme and language, and change them back."""
        for action_id in ("theme.light", "language.ja", "theme.dark", "language.en"):
            self.trigger(action_id)
            self.wait(0.02)

    def move_panels(self) -> None:
        """Float, dock, close and show every panel."""
        for name, dock in self.program.window.docks.items():
            dock.setFloating(True)
            self.wait(0.02)
            dock.setFloating(False)
            dock.close()
            self.trigger(f"panel.{name}")
            self.wait(0.02)
        self.trigger("workspace.reset")

    def fill_screen(self) -> None:
        """Show the viewport in full screen with every view, and restore the window."""
        self.trigger("application.full_screen")
        for view in ("ensemble", "hands", "mouth", "front"):
            self.trigger(f"viewport.{view}")
            self.wait(0.05)
        self.trigger("application.full_screen")

    def play(self) -> None:
        """Play for a second."""
        self.session.set_playhead(2.0)
        for source in ("synthesiser", "recording"):
            self.session.listening.set(source=source)
            self.session.set_playing(True)
            self.wait(0.3)
            self.session.set_playing(False)

    def edit(self) -> None:
        """Raise a note and lower it again."""
        self.trigger("notes.select_all")
        self.trigger("notes.up")
        self.trigger("edit.undo")
        self.wait(0.05)

    def read_again(self) -> None:
        """Open the dialog with the changes of another MIDI file, and cancel it."""
        window = self.program.window
        reimport_from(self.program.editor, QUARTET)
        self.until(lambda: window.findChild(ReimportDialog) is not None)
        child(window, ReimportDialog).reject()

    def open_dialogs(self) -> None:
        """Open every non-modal dialog and close it immediately."""
        for action_id in (
            *("application.palette", "application.preferences", "application.shortcuts", "application.about"),
            *("export.files", "export.playblast"),
        ):
            before = set(QApplication.topLevelWidgets())
            self.trigger(action_id)
            self.wait(0.02)
            for widget in QApplication.topLevelWidgets():
                if widget not in before and widget.isVisible():
                    widget.close()
            palette = self.program.window.findChild(QWidget, "palette")
            if palette is not None:
                palette.hide()

    def trigger(self, action_id: str) -> None:
        """Trigger an action if it is enabled."""
        self.program.editor.table.refresh()
        if actions(self.session)[action_id].isEnabled():
            actions(self.session)[action_id].trigger()

    def wait(self, seconds: float) -> None:
        """Process events for a time."""
        pause(round(1000 * seconds))

    def until(self, ready: Callable[[], bool], most_s: float = 60.0) -> None:
        """Process events until a condition holds."""
        end_s = time.monotonic() + most_s
        while not ready():
            if time.monotonic() > end_s:
                raise TimeoutError("the editor does not get there")
            pause(LOOK_AGAIN_MS)


def larger_piece(folder: Path, players: int, notes: int) -> Path:
    """Write a synthetic project to a file."""
    path = folder / f"{players} players.suisou"
    save(large_project(players, notes), path)
    return path


def long_run(rounds: int, players: int = 20, notes: int = 500) -> None:
    """Print the measurements of each round and finally the growth."""
    make_application()
    garbage = Garbage()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        settings = Settings(folder / "editor.toml")
        settings.language = "en"
        program = Program(settings, autosave=Autosave(Presence(folder / "recovery")))
        program.window.resize(960, 640)
        program.window.show()
        day = LongDay(program, QUARTET, larger_piece(folder, players, notes))
        marks: list[Footprint] = []
        for number in range(rounds):
            start_s = time.monotonic()
            day.round()
            marks.append(footprint())
            print(f"{number:3}: {marks[-1]}  ({time.monotonic() - start_s:.1f} s)", flush=True)
            if number >= 2:
                grown = marks[-1].values - marks[-2].values + (marks[-1].widgets_by_class - marks[-2].widgets_by_class)
                print("     ", dict(grown.most_common(14)), flush=True)
        program.end()
        garbage.stop()
        program.window.hide()


if __name__ == "__main__":
    long_run(int(sys.argv[1]), *(int(argument) for argument in sys.argv[2:4]))
