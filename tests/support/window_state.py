"""State of the editor by subject, for finding what a click changed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, TypeVar, cast

from PySide6.QtWidgets import (
    QApplication,
    QComboBox,
    QDialog,
    QLineEdit,
    QMenu,
    QMenuBar,
    QTabWidget,
    QToolButton,
    QWidget,
)

from app.shell.app import Program
from tests.support.tasks import ImmediateTasks
from tests.support.windows import child
from widgets.common.actions import actions
from widgets.common.section import Section
from widgets.players.stage import StageView

if TYPE_CHECKING:
    from tests.gui.shell.conftest import Answers

State = Mapping[str, object]
W = TypeVar("W", bound=QWidget)


def _dialogs() -> frozenset[str]:
    return frozenset(
        widget.objectName()
        for widget in QApplication.topLevelWidgets()
        if isinstance(widget, QDialog) and widget.isVisible()
    )


def _popup() -> object:
    popup = QApplication.activePopupWidget()
    if popup is None or isinstance(popup.parent(), QMenu | QMenuBar):
        return None
    return popup.objectName() or type(popup).__name__


class Widgets:
    """Widgets in a window by kind, collected in one pass, since each pass costs as much as a click.

    Parameters
    ----------
    window : QWidget
    """

    def __init__(self, window: QWidget) -> None:
        self._all = [(type(widget), widget) for widget in window.findChildren(QWidget)]
        self._classes = {its_class for its_class, _ in self._all}

    def __getitem__(self, kind: type[W]) -> list[W]:
        classes = {its_class for its_class in self._classes if issubclass(its_class, kind)}
        return cast(list[W], [widget for its_class, widget in self._all if its_class in classes])


class Watcher:
    """Reads the state of an editor.

    Parameters
    ----------
    program : Program
    answers : Answers
        Its files and questions.
    """

    def __init__(self, program: Program, answers: Answers) -> None:
        self._program, self._answers = program, answers
        session = program.session
        stage = child(program.window, StageView)
        both = child(program.window, QToolButton, "expression_both")
        self._stage, self._both = stage, both
        self._told = dict.fromkeys(("copied", "dollied", "framed", "notice", "sought", "turned", "viewed"), 0)
        for name, signal in (
            ("framed", session.viewport.framed),
            ("viewed", session.viewport.viewed),
            ("turned", session.viewport.turned),
            ("dollied", session.viewport.dollied),
            ("notice", session.noticed),
            ("copied", QApplication.clipboard().dataChanged),
            ("sought", session.playhead_changed),
        ):
            signal.connect(lambda *_, name=name: self._count(name))

    def _count(self, name: str) -> None:
        self._told[name] += 1

    def state(self) -> State:
        """Current state of the editor; documents are represented by their identity."""
        program, session = self._program, self._program.session
        window, timeline = program.window, program.window.timeline
        widgets = Widgets(window)
        listening, recording, video = session.listening, session.recording, session.video
        return {
            "project": session.project,
            "file": (program.editor.files.is_open, program.editor.files.path),
            "asked": tuple(self._answers.asked),
            "selection": session.selection,
            "players": session.players,
            "dancer": session.dancer.id if session.dancer else "",
            "playhead": session.playhead_s,
            "sought": self._told["sought"],
            "playing": session.playing,
            "take": listening.take,
            "loop": session.loop_s,
            "grid": session.grid,
            "theme": session.tokens.name,
            "language": actions(session)["file.save"].text(),
            "time": session.time_display,
            "pitch": (
                session.pitch_display.written,
                session.pitch_display.middle_c_octave,
                session.pitch_display.names,
            ),
            "follow": session.follow,
            "preview": session.preview_morphs,
            "sound": (
                listening.speed,
                listening.click,
                listening.percussion,
                listening.scrub_sound,
                listening.source,
                listening.volume,
            ),
            "recording": (recording.armed, recording.punch, recording.count_in_bars, recording.running),
            "streaming": session.streaming.on,
            "video": (video.placement, video.opacity),
            "view": (session.viewport.view, self._told["viewed"]),
            "camera_follows": session.viewport.camera_follows,
            "shown": tuple(
                session.viewport.shows(what) for what in ("wireframe", "skeleton", "contacts", "names", "props")
            ),
            "posing": session.viewport.posing,
            "framed": self._told["framed"],
            "turned": self._told["turned"],
            "dollied": self._told["dollied"],
            "notice": self._told["notice"],
            "dialog": _dialogs(),
            "popup": _popup(),
            "panels": tuple((name, not dock.isHidden(), dock.isFloating()) for name, dock in window.docks.items()),
            "workspace": window.workspaces.current,
            "full_screen": window.is_full_screen,
            "page": (window.start_page.isVisible(), window.banner.isVisible()),
            "palette": window.palette_popup.isVisible(),
            "status": window.status.notice_text,
            "lanes": repr(timeline.lane_layout.state),
            "axis": (timeline.axis.start_s, timeline.axis.span_s, timeline.roll.row_px),
            "tool": timeline.tool,
            "ghosts": timeline.ghosts,
            "quantise": timeline.quantise.isVisible(),
            "folded": (tuple(section.header.is_open for section in widgets[Section]), dict(session.folded)),
            "grouped": session.groups_players,
            "typing": tuple(sorted(field.objectName() for field in widgets[QLineEdit] if field.isVisible())),
            "snap": self._stage.snaps,
            "both": self._both.isChecked(),
            "tab": tuple(tabs.currentIndex() for tabs in widgets[QTabWidget]),
            "choices": tuple((box.objectName(), box.currentIndex()) for box in widgets[QComboBox]),
            "work": len(program.tasks.names) if isinstance(program.tasks, ImmediateTasks) else 0,
            "copied": self._told["copied"],
        }


def changed(before: State, after: State) -> frozenset[str]:
    """Subjects that differ; the project is compared by identity."""
    return frozenset(
        name
        for name in before
        if (before[name] is not after[name] if name == "project" else before[name] != after[name])
    )


def names_of(widgets: Sequence[QWidget]) -> dict[str, QWidget]:
    """Unique names of all widgets: the object name, preceded by those of named parents if several widgets share it.
    Widgets without a name are numbered.

    Widgets without an own name are numbered.
    """
    paths = [_path(widget) for widget in widgets]
    lengths = [1] * len(paths)
    while True:
        names = ["/".join(path[-length:]) for path, length in zip(paths, lengths, strict=True)]
        often = Counter(names)
        longer = [
            min(length + 1, len(path)) if often[name] > 1 else length
            for path, length, name in zip(paths, lengths, names, strict=True)
        ]
        if longer == lengths:
            break
        lengths = longer
    found: dict[str, QWidget] = {}
    for name, widget in zip(names, widgets, strict=True):
        number = 1
        while (numbered := name if number == 1 else f"{name}#{number}") in found:
            number += 1
        found[numbered] = widget
    return found


def _path(widget: QWidget) -> list[str]:
    path = [widget.objectName() or type(widget).__name__]
    above = widget.parentWidget()
    while above is not None:
        if above.objectName() and not above.objectName().startswith("qt_"):
            path.insert(0, above.objectName())
        above = above.parentWidget()
    return path
