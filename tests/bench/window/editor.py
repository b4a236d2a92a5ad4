"""The whole editor on fifty players and a hundred thousand notes, and what a frame of it costs the window's thread.

GL is not judged: where the bench runs, the processor does the card's work. Python's part of every GL command is done
and counted, but nothing reaches the driver (`still_gl`). What is left of it is Qt's own composing of the window, which
holds a GL widget: `floor_s` measures that by repainting a single point; frames are given without it.
"""

from __future__ import annotations

import resource
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from unittest.mock import patch

from PySide6.QtCore import QCoreApplication, QEventLoop
from PySide6.QtWidgets import QApplication
from vispy.gloo.gl import use_gl

from app.editor.freed_memory import share_memory
from app.editor.settings import Settings
from app.editor.tasks import ThreadTasks
from app.project import storage
from app.project.autosave import Autosave
from app.project.running_editors import Presence
from app.shell.app import Program
from app.shell.garbage_collection import Garbage
from tests.bench.performance.large import large_project
from tests.gui.shell.conftest import Answers
from tests.support.live import ready_spans
from widgets.timeline.panel import TimelinePanel
from widgets.viewport.canvas import Canvas
from widgets.viewport.panel import ViewportPanel

PATIENCE_S = 240.0
QUIET_S = 45.0
"""Seconds allowed for sound and motion computed in advance; afterwards the editor is used during the computation."""


@dataclass
class Turn:
    """One turn of the event loop, or several: CPU of the window's thread and wall time, seconds."""

    cpu_s: float = 0.0
    wall_s: float = 0.0
    drawing_s: float = 0.0
    """Processor time in seconds for drawing the players, or Python's part of it while GL is idle."""
    drawing_wall_s: float = 0.0
    """Wall time in seconds for drawing the players."""


@dataclass
class Stall:
    """The longest turn of the event loop in a phase, the drawing of the players aside."""

    cpu_s: float = 0.0
    wall_s: float = 0.0


@dataclass
class LargeEditor:
    """The editor as in use, with default settings and an empty recovery folder.

    Parameters
    ----------
    folder : Path
    """

    folder: Path
    stalls: dict[str, Stall] = field(default_factory=dict)
    seen: Turn = field(default_factory=Turn)
    """Times of the last awaited picture."""
    phase: str = "open"

    def __post_init__(self) -> None:
        application = QApplication.instance()
        assert isinstance(application, QApplication)
        self.application = application
        share_memory()
        settings = Settings(self.folder / "editor.toml")
        settings.language = "en"
        self._drawing_s = self._drawing_wall_s = 0.0
        self._awaited: tuple[str, Turn] | None = None
        self._time_drawing()
        self.program = Program(
            settings, questions=Answers(), autosave=Autosave(Presence(self.folder / "recovery")), audible=True
        )
        self.garbage = Garbage()
        self.session = self.program.session
        self.window = self.program.window
        self.window.resize(1600, 1000)
        self.window.show()

    def _time_drawing(self) -> None:
        draw = Canvas._draw

        def timed(canvas: Canvas, width: int, height: int) -> None:
            cpu_s, wall_s = time.thread_time(), time.perf_counter()
            draw(canvas, width, height)
            self._drawing_s += time.thread_time() - cpu_s
            self._drawing_wall_s += time.perf_counter() - wall_s
            self._drawn()

        self._timed = patch.object(Canvas, "_draw", timed)
        self._timed.start()

    def _drawn(self) -> None:
        if self._awaited is None:
            return
        # Before it is asked whether the picture is right, which takes some milliseconds with fifty players.
        cpu_s, wall_s = time.thread_time(), time.perf_counter()
        if self.is_right(self._awaited[0]):
            began = self._awaited[1]
            self.seen = Turn(
                cpu_s - began.cpu_s,
                wall_s - began.wall_s,
                self._drawing_s - began.drawing_s,
                self._drawing_wall_s - began.drawing_wall_s,
            )
            self._awaited = None

    def picture(self, player_id: str, act: Callable[[], None]) -> Turn:
        """Do something; until a picture is drawn with a player's newest pose at the playhead. Nothing is asked
        meanwhile, so that the measure costs nothing."""
        self._awaited = (
            player_id,
            Turn(time.thread_time(), time.perf_counter(), self._drawing_s, self._drawing_wall_s),
        )
        self.turn(act)
        self.until(lambda: self._awaited is None)
        return self.seen

    def close(self) -> None:
        """End the editor."""
        self._timed.stop()
        self.garbage.stop()
        self.program.end()
        self.window.hide()
        self.program.generator.deleteLater()
        self.program.editor.files.end()
        self.window.deleteLater()
        self.session.deleteLater()

    @property
    def timeline(self) -> TimelinePanel:
        """The timeline."""
        return self.window.timeline

    @property
    def viewport(self) -> ViewportPanel:
        """The viewport."""
        return self.window.viewport

    # Time

    def turn(self, act: Callable[[], None] = lambda: None) -> Turn:
        """Do something, and everything that follows at once from it."""
        drawn_s, drawn_wall_s = self._drawing_s, self._drawing_wall_s
        cpu_s, wall_s = time.thread_time(), time.perf_counter()
        act()
        self.application.processEvents()
        QCoreApplication.sendPostedEvents()
        self.application.processEvents(QEventLoop.ProcessEventsFlag.AllEvents)
        spent = Turn(time.thread_time() - cpu_s, time.perf_counter() - wall_s, self._drawing_s - drawn_s)
        stall = self.stalls.setdefault(self.phase, Stall())
        stall.cpu_s = max(stall.cpu_s, spent.cpu_s - spent.drawing_s)
        stall.wall_s = max(stall.wall_s, spent.wall_s - (self._drawing_wall_s - drawn_wall_s))
        return spent

    def until(self, ready: Callable[[], bool], most_s: float = PATIENCE_S) -> Turn:
        """Process events until a condition holds or the time is over."""
        whole, began_s = Turn(), time.perf_counter()
        while not ready() and time.perf_counter() - began_s < most_s:
            spent = self.turn()
            whole.cpu_s += spent.cpu_s
            whole.drawing_s += spent.drawing_s
            time.sleep(0.002)
        whole.wall_s = time.perf_counter() - began_s
        return whole

    def floor_s(self) -> float:
        """Return the cost of composing the window when only one point has changed: median CPU time, s."""
        label = self.window.status

        def point() -> None:
            label.update(0, 0, 1, 1)

        spent = sorted(self.turn(point).cpu_s for _ in range(31))
        return spent[15]

    # The piece

    def open(self) -> Iterator[tuple[str, float, float]]:
        """Open the large piece from a file: how far it is, with the CPU of the whole process and the wall time since
        it was asked for, seconds."""
        path, count = self.folder / "large.suisou", len(large_project().players)
        storage.save(large_project(), path)
        began_s, cpu_s = time.perf_counter(), time.process_time()

        def since(what: str, ready: Callable[[], bool]) -> tuple[str, float, float]:
            self.until(ready)
            return what, time.process_time() - cpu_s, time.perf_counter() - began_s

        self.program.editor.files.open(path, ask=False)
        yield since("the window shows the piece and reacts", lambda: len(self.session.project.players) == count)
        front = self.session.players[0]
        yield since(
            "the player in front plays in the viewport", lambda: not self.viewport.message() and self.is_right(front)
        )
        yield since(
            "everyone moves around the playhead",
            lambda: all(self._moves(player.id) for player in self.session.project.players),
        )
        yield since("plans are there", self.is_planned)
        yield since("everyone at the playhead does", lambda: self.program.generator.live.is_seen)

    def _moves(self, player_id: str) -> bool:
        return self.program.generator.live.pose(player_id, self.session.playhead_s) is not None

    def is_planned(self) -> bool:
        """Return whether the plans are those of the project."""
        return self.session.performance.project is self.session.project

    def is_right(self, player_id: str) -> bool:
        """Return whether the viewport has a player's newest pose at the playhead."""
        live, at_s = self.program.generator.live, self.session.playhead_s
        if live.performance.project is not self.session.project:
            return False
        if not any(start_s <= at_s < end_s for start_s, end_s in ready_spans(live, player_id)):
            return False
        scene = self.viewport.scene
        return scene.stage is not None and not scene.is_outdated(at_s)

    def rest(self, most_s: float = QUIET_S) -> str:
        """Wait up to a time until no background work is left; return the duration."""
        tasks, generator = self.program.tasks, self.program.generator
        assert isinstance(tasks, ThreadTasks)

        def is_quiet() -> bool:
            return not tasks.running and generator.ready_share >= 1.0

        waited = self.until(is_quiet, most_s)
        return f"{'quiet after' if is_quiet() else 'not quiet after'} {waited.wall_s:.0f} s"

    @contextmanager
    def still_gl(self) -> Iterator[None]:
        """Let no GL command reach the driver within a ``with`` block."""
        with patch("vispy.gloo.gl.dummy.DummyProxy.__call__", lambda *arguments: 0):
            use_gl("dummy")
            try:
                yield
            finally:
                use_gl("gl2")


def calibration_s() -> float:
    """CPU that this machine needs, now, for a fixed piece of interpreted work; not wall time, as it may be shared."""
    spent = []
    for _ in range(3):
        began_s, total = time.thread_time(), 0
        for number in range(300_000):
            total += number * number % 7
        spent.append(time.thread_time() - began_s)
    return min(spent)


def memory_mb() -> tuple[float, float]:
    """Memory of the process now and at its most, MB."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 2**20, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
