"""The editor's window with hostile files: the longest turn of its event loop, in CPU of the window's thread.

``python -m tests.bench.hostile.window``: speaks as `tests.fuzz.harness.child` does; ``cpu_s`` is the longest stall.
GL reaches no driver: where this runs the processor does the card's work.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, Final

from PySide6.QtCore import QObject, QTimer
from PySide6.QtWidgets import QApplication, QDialog, QDialogButtonBox

from app.editor.design_tokens import Tokens
from app.editor.questions import ReadAgain
from app.editor.session import Severity
from app.editor.settings import Settings
from app.editor.tasks import Tasks, ThreadTasks
from app.errors import AppError, Message
from app.project.autosave import Autosave
from app.project.importing import ImportRequest
from app.project.running_editors import Presence
from app.score.contents import PieceContents
from app.shell.app import Program, make_application
from app.shell.commands.exchange import reimport_from
from app.shell.garbage_collection import Garbage
from app.shell.questions import DialogQuestions
from tests.fuzz.harness.child import forget_peak, status_kb
from tests.fuzz.harness.readers import KINDS
from tests.gui.shell.conftest import Answers
from tests.support.restless import QUARTET
from widgets.common.actions import actions

PATIENCE_S: Final = 60.0
LOOK_S: Final = float(os.environ.get("SUISOU_LOOK_S", "1.5"))
"""Seconds for which the window is observed after each deed."""


AWAITED: Final = ("open", "save", "import", "reimport", "character", "plan")
EDITS: Final = ("timeline.fit", "notes.select_all", "notes.up", "edit.undo", "edit.redo")


class StallMeter(QObject):
    """Longest turn of the event loop, also inside dialogs."""

    def __init__(self) -> None:
        super().__init__()
        self.cpu_s = 0.0
        self._last_s = time.thread_time()
        self._timer = QTimer(self)
        self._timer.setInterval(2)
        self._timer.timeout.connect(self._beat)
        self._timer.start()

    def _beat(self) -> None:
        now_s = time.thread_time()
        self.cpu_s = max(self.cpu_s, now_s - self._last_s)
        self._last_s = now_s

    def begin(self) -> None:
        """Reset the measurement."""
        self.cpu_s, self._last_s = 0.0, time.thread_time()


class ImportAnswers(Answers):
    """Answers of a user who looks at the import dialog for a moment and accepts it."""

    def import_midi(
        self, contents: PieceContents, read_again: ReadAgain, tokens: Tokens, tasks: Tasks
    ) -> ImportRequest | None:
        """The real dialog."""
        timer = QTimer()
        timer.setInterval(300)
        timer.timeout.connect(self._agree)
        timer.start()
        try:
            return DialogQuestions().import_midi(contents, read_again, tokens, tasks)
        finally:
            timer.stop()

    @staticmethod
    def _agree() -> None:
        dialog = QApplication.activeModalWidget()
        buttons = dialog.findChild(QDialogButtonBox) if isinstance(dialog, QDialog) else None
        if buttons is not None:
            # Disabled until there is something to confirm.
            buttons.button(QDialogButtonBox.StandardButton.Ok).click()


class WatchedWindow:
    """An editor that opens each file of a list.

    Parameters
    ----------
    folder : Path
    """

    def __init__(self, folder: Path) -> None:
        self.application = make_application()
        self.garbage = Garbage()
        self.folder = folder
        settings = Settings(folder / "editor.toml")
        settings.language = "en"
        self.answers = ImportAnswers()
        self.answers.answer = "discard"
        self.program = Program(
            settings, questions=self.answers, autosave=Autosave(Presence(folder / "recovery")), audible=False
        )
        assert isinstance(self.program.tasks, ThreadTasks)
        self.tasks = self.program.tasks
        self.faults: list[BaseException] = []
        self.tasks.unexpected.connect(self.faults.append)
        sys.excepthook = lambda kind, error, trace: self.faults.append(error)
        self.notices: list[tuple[Message, Severity]] = []
        self.session = self.program.session
        self.session.noticed.connect(lambda message, severity: self.notices.append((message, severity)))
        self.tasks.failed.connect(lambda error: self.notices.append((error.message, Severity.ERROR)))
        self.meter = StallMeter()
        self.program.window.resize(1600, 1000)
        self.program.window.show()
        self.open_example()

    def open_example(self) -> None:
        """The quartet."""
        self.program.editor.files.open(QUARTET, ask=False)
        self.settle(lambda: self.program.editor.files.is_open)

    def settle(self, ready: Callable[[], bool] = lambda: True) -> None:
        """Wait until nothing is being read or planned, and a moment longer."""
        session, end_s = self.session, time.monotonic() + PATIENCE_S
        quiet_s = time.monotonic() + LOOK_S
        while time.monotonic() < min(quiet_s, end_s):
            self.application.processEvents()
            if not ready() or session.performance.project is not session.project or self._reads():
                quiet_s = time.monotonic() + LOOK_S
            time.sleep(0.001)

    def _reads(self) -> bool:
        return any(
            task.key in ("open", "save", "import", "reimport", "character", "plan") for task in self.tasks.running
        )

    def show(self, kind: str, path: Path) -> dict[str, Any]:
        """Open a file in every possible way."""
        self.notices.clear()
        self.faults.clear()
        forget_peak()
        self.meter.begin()
        began_s = time.perf_counter()
        try:
            for way in self._ways(kind, path):
                way()
                self.settle()
            for dialog in self.program.window.findChildren(QDialog):
                dialog.close()
            self.application.processEvents()
        except AppError as error:
            return self._reported("escaped", error)
        if self.faults:
            return self._reported("escaped", self.faults[0])
        errors = [message.id for message, severity in self.notices if severity is Severity.ERROR]
        return {
            "outcome": "refused" if errors else "accepted",
            "place": errors[0] if errors else "",
            "detail": f"{time.perf_counter() - began_s:.1f} s",
            "cpu_s": self.meter.cpu_s,
            "peak_mb": status_kb("VmHWM") / 1024,
        }

    def _trigger(self, action_id: str) -> None:
        self.program.editor.table.refresh()
        if actions(self.session)[action_id].isEnabled():
            actions(self.session)[action_id].trigger()

    def _reported(self, outcome: str, error: BaseException) -> dict[str, Any]:
        detail = "".join(traceback.format_exception(error))
        place = type(error).__name__
        return {"outcome": outcome, "place": place, "detail": detail, "cpu_s": self.meter.cpu_s, "peak_mb": 0.0}

    def _ways(self, kind: str, path: Path) -> tuple[Callable[[], None], ...]:
        files = self.program.editor.files
        # Saved elsewhere: nothing hostile is written over.
        self.answers.path = self.folder / "saved.suisou" if kind == "midi" else path
        if kind == "midi":
            return (
                lambda: files.open(path, ask=False),
                lambda: files.open(path, ask=True),
                *(partial(self._trigger, action_id) for action_id in EDITS),
                lambda: files.save(),
                lambda: reimport_from(self.program.editor, path),
            )
        if kind in ("gltf", "foreign_fbx"):
            return (partial(self._trigger, "file.add_character"),)
        return (lambda: files.open(path, ask=False),)


def main() -> None:
    """Serve until the input ends."""
    from vispy.gloo.gl import use_gl

    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    sys.stdin.readline()
    with tempfile.TemporaryDirectory() as name:
        editor = WatchedWindow(Path(name))
        use_gl("dummy")
        print(json.dumps({"base_mb": status_kb("VmRSS") / 1024}), file=answers, flush=True)
        for line in sys.stdin:
            kind, source = json.loads(line)
            path = Path(name) / f"hostile{KINDS[kind].suffix}"
            path.write_bytes(Path(source).read_bytes())
            print(json.dumps(editor.show(kind, path)), file=answers, flush=True)
            if kind in ("midi", "project"):
                editor.open_example()
        editor.program.end()


if __name__ == "__main__":
    main()
