"""The editor as a program: the Qt application, its assembled parts, and screenshots of its window."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from PySide6.QtCore import QBuffer, QCoreApplication, QEventLoop, QIODevice, QObject, Qt, QTimer
from PySide6.QtGui import QGuiApplication, QImage, QImageWriter
from PySide6.QtWidgets import QApplication

from app.audio.playback import Playback
from app.editor.files import Files
from app.editor.freed_memory import share_memory
from app.editor.generator import Generator
from app.editor.library_watch import watch_characters, watch_instruments, watch_metadata
from app.editor.problems import follow_selection, forget_problems
from app.editor.questions import Questions
from app.editor.recorder import Recorder
from app.editor.session import Session, Severity
from app.editor.settings import Settings, settings_path
from app.editor.sound import EditorSound
from app.editor.streamer import Streamer
from app.editor.tasks import Tasks, ThreadTasks
from app.editor.video import ReferenceVideo
from app.errors import AppError, Message, UsageError
from app.formats.atomic import atomic_write
from app.formats.temporary_folders import scratch_folder
from app.project.autosave import Autosave
from app.project.camera_bookmarks import VIEWS
from app.project.edit.piece import new_piece
from app.project.recovery import recovery_folder
from app.project.running_editors import Presence
from app.rig.characters.character_library import begin_characters
from app.shell.action_rows import rows
from app.shell.actions import ActionTable
from app.shell.camera_and_view_per_piece import PieceViews
from app.shell.commands import characters, record
from app.shell.commands.help import help_about
from app.shell.crash_handler import CrashHandler, log_path
from app.shell.editor import Editor
from app.shell.garbage_collection import Garbage
from app.shell.keyboard_buttons import KeyboardButtons
from app.shell.language import Language
from app.shell.questions import DialogQuestions
from app.shell.selection_camera import SelectionCamera
from app.shell.theme import apply_theme, unstyled
from app.shell.window import Window
from instrument_maps.library import begin
from metadata.library import begin_metadata
from widgets.common.actions import actions
from widgets.common.font import apply_font

STOP_S = 3.0
"""Seconds that workers get to stop when the editor ends."""
READY_S = 20.0
"""Seconds that a screenshot waits for complete motion and an idle status line; it is taken anyway afterwards."""
PICTURE_S = 60.0
"""Longest wait in seconds of a screenshot for plans and motion."""


@dataclass(frozen=True)
class LaunchOptions:
    """Command-line options of the editor.

    Attributes
    ----------
    screenshot : Path or None
        Path of a screenshot: draw the window once, write it and exit.
    view, language, theme : str
        Names of view, language and theme; empty to use those in the user's settings.
    size : (int, int)
        Size of the screenshot in device-independent pixels.
    """

    file: Path | None = None
    screenshot: Path | None = None
    time_s: float = 0.0
    view: str = ""
    language: str = ""
    theme: str = ""
    size: tuple[int, int] = (1600, 1000)


def make_application() -> QApplication:
    """Return a new Qt application, made after setting the attributes that must precede it."""
    # The viewport keeps its context when it is docked or floated only if contexts are shared.
    QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_ShareOpenGLContexts)
    QGuiApplication.setHighDpiScaleFactorRoundingPolicy(Qt.HighDpiScaleFactorRoundingPolicy.PassThrough)
    QCoreApplication.setApplicationName("suisou")
    QGuiApplication.setApplicationDisplayName("Suisou")
    application = QApplication(["suisou"])
    apply_font(application)
    return application


class Program(QObject):
    """All parts of a running editor.

    Parameters
    ----------
    audible : bool
        Whether sound can be played.
    playback : Playback, optional
        Playback to use; by default one that plays on the system's audio device.
    recorder : callable, optional
        Function that makes the recorder of MIDI; by default the one for the system's MIDI devices.
    """

    def __init__(
        self,
        settings: Settings,
        tasks: Tasks | None = None,
        questions: Questions | None = None,
        autosave: Autosave | None = None,
        audible: bool = True,
        playback: Playback | None = None,
        recorder: Callable[[Session, Files, Settings, EditorSound], Recorder] | None = None,
    ) -> None:
        super().__init__()
        # The user's own characters are read in the background, however long that takes.
        begin()
        begin_characters()
        begin_metadata()
        application = QApplication.instance()
        assert isinstance(application, QApplication)
        self._application = application
        self.tasks: Tasks = ThreadTasks() if tasks is None else tasks
        self.session = Session(new_piece(), self.tasks)
        settings.failed.connect(self._warn)
        for problem in settings.problems:
            QTimer.singleShot(0, self, partial(self._warn, problem))
        asked = DialogQuestions() if questions is None else questions
        language = Language()
        language.set(settings.language)
        language.changed.connect(self.session.language_changed)
        settings.hold(self.session)
        files = Files(self.session, settings, asked, autosave)
        self.session.theme_changed.connect(self._apply_theme)
        self._apply_theme()
        self.generator = Generator(self.session, self.tasks)
        # Kept alive as children of the session.
        sound = EditorSound(self.session, playback, audible)
        video = ReferenceVideo(self.session)
        follow_selection(self.session)
        forget_problems(self.session)
        watch_instruments(self.session)
        watch_characters(self.session)
        watch_metadata(self.session)
        self.recorder = (Recorder if recorder is None else recorder)(self.session, files, settings, sound)
        streamer = Streamer(self.session, settings, self.generator.live)
        table = ActionTable(self.session, settings, rows())
        with unstyled(application):
            self.window = Window(self.session, files, settings, asked, table, self.generator)
        SelectionCamera(self.session)
        PieceViews(self.session, files, settings, self.window.timeline, self.window.workspaces)
        self.editor = Editor(
            self.session, settings, language, asked, files, sound, self.recorder, streamer, video, table, self.window
        )
        table.begin(self.editor)
        self.window.character_dropped.connect(partial(characters.bring, self.editor))
        self.window.help_requested.connect(partial(help_about, self.editor))
        self.recorder.device_missing.connect(partial(record.devices, self.editor))
        KeyboardButtons(application, self)

    def _warn(self, message: Message) -> None:
        self.session.notice(message, Severity.WARNING)

    def _apply_theme(self) -> None:
        apply_theme(self._application, self.session.tokens)

    def end(self) -> None:
        """Stop all background work (video, recorder, threads) before the program ends."""
        self.editor.video.close()
        self.recorder.close()
        self.editor.streamer.close()
        self.generator.close()
        if isinstance(self.tasks, ThreadTasks):
            self.tasks.cancel_all(STOP_S)


def _clean_up() -> None:
    """Delete the temporary files left by editors that were killed."""
    # Exporting is not needed for the first picture.
    from app.export.tree import clean_up

    clean_up()


def run(start: LaunchOptions) -> int:
    """Run the editor until it is closed, and return the exit status."""
    if start.screenshot is not None:
        return picture(start, start.screenshot)
    share_memory()
    application = make_application()
    garbage = Garbage()
    settings = Settings(settings_path())
    presence = Presence(recovery_folder())
    program = Program(settings, autosave=Autosave(presence))
    if isinstance(program.tasks, ThreadTasks):
        program.tasks.failed.connect(lambda error: program.session.notice(error.message, Severity.ERROR))
        program.tasks.cancelled.connect(
            lambda name: program.session.notice(Message("work.cancelled", {**name.arguments, "work": name.id}))
        )
    faults = CrashHandler(program.session, program.editor.files.write_now, log_path())
    faults.install()
    if isinstance(program.tasks, ThreadTasks):
        program.tasks.unexpected.connect(faults.report)
    _end_on_signal(application)
    if start.theme or start.language:
        _assignment(program, start)
    program.window.show()
    QTimer.singleShot(0, program.recorder, program.recorder.begin_where_remembered)
    if presence.refusal is not None:
        program.editor.files.warn_once(presence.refusal.message)
    program.tasks.run(Message("work.clean_up"), lambda progress, stop_requested: _clean_up(), lambda nothing: None)
    if start.file is not None:
        program.editor.files.open(start.file, ask=False, at_start=True)
    try:
        status = application.exec()
        # Does nothing after the window was closed; a signal ends the program with unsaved work.
        program.editor.files.write_now()
        return status
    finally:
        program.end()
        garbage.stop()
        settings.sync()


def _assignment(program: Program, start: LaunchOptions) -> None:
    if start.theme:
        actions(program.session)[f"theme.{start.theme}"].trigger()
    if start.language:
        program.editor.speak(start.language)


def _end_on_signal(application: QApplication) -> None:
    """Make Ctrl-C in the terminal end the editor like closing its window; unsaved work stays recoverable."""

    def stop(number: int, frame: object) -> None:
        application.exit(128 + number)

    for name in (signal.SIGINT, signal.SIGTERM):
        signal.signal(name, stop)
    # Python handles signals only while it runs, so a timer wakes it regularly.
    timer = QTimer(application)
    timer.timeout.connect(lambda: None)
    timer.start(250)


def picture(start: LaunchOptions, target: Path) -> int:
    """Draw the editor's window once, independent of the user's settings, write it to an image file, and return the exit
    status.

    Raises
    ------
    UsageError
        If the target's suffix is not that of a kind of picture.
    """
    application = make_application()
    if target.suffix[1:].lower() not in {bytes(kind.data()).decode() for kind in QImageWriter.supportedImageFormats()}:
        raise UsageError("picture.screenshot_ending", file=str(target))
    stopped = threading.Event()
    signal.signal(signal.SIGINT, lambda number, frame: stopped.set())

    def wait(ready: Callable[[], bool], most_s: float = PICTURE_S) -> None:
        end_s = time.monotonic() + most_s
        while not ready() and time.monotonic() < end_s:
            if stopped.is_set():
                raise KeyboardInterrupt
            application.processEvents(QEventLoop.ProcessEventsFlag.AllEvents, 50)
            time.sleep(0.005)

    garbage = Garbage()
    with scratch_folder() as folder:
        settings = Settings(folder / "editor.toml")
        settings.language = start.language or "en"
        settings.theme = start.theme or "dark"
        program = Program(settings, audible=False)
        failure: list[AppError] = []
        if isinstance(program.tasks, ThreadTasks):
            program.tasks.failed.connect(failure.append)
        program.session.noticed.connect(
            lambda message, severity: (
                failure.append(AppError(message.id, **message.arguments)) if severity is Severity.ERROR else None
            )
        )
        window = program.window
        window.setAttribute(Qt.WidgetAttribute.WA_DontShowOnScreen, False)
        window.resize(*start.size)
        window.show()
        window.resize(*start.size)
        window.reset_workspace()
        try:
            if start.file is not None:
                program.editor.files.open(start.file, ask=False)
                wait(lambda: program.editor.files.is_open or bool(failure))
                if failure:
                    raise failure[0]
                wait(lambda: program.session.performance.project is program.session.project)
                if start.view in VIEWS:
                    program.session.viewport.set_view(start.view)
                program.session.set_playhead(start.time_s)
                program.session.reveal(start.time_s)
                wait(lambda: _moves(program, start.time_s) and not _working(program))
                wait(lambda: program.generator.ready_share >= 1.0, READY_S)
                window.reset_workspace()
            # Camera movements and late layouts need this time.
            wait(lambda: False, 1.2)
            wait(lambda: not _working(program), READY_S)
            image = window.grab().toImage()
            _write_picture(image, target)
        finally:
            program.end()
            garbage.stop()
            window.hide()
    return 0


def _moves(program: Program, time_s: float) -> bool:
    """Return whether the poses of all players at a time are computed, or their computation has failed."""
    live = program.generator.live
    return all(
        live.pose(player.id, time_s) is not None or live.error(player.id) is not None
        for player in program.session.project.players
    )


def _working(program: Program) -> bool:
    return isinstance(program.tasks, ThreadTasks) and bool(program.tasks.running)


def _write_picture(image: QImage, target: Path) -> None:
    """Write a picture in the format given by the file's suffix.

    Raises FileError, and UsageError for a kind of picture that cannot be this large.
    """
    data = QBuffer()
    data.open(QIODevice.OpenModeFlag.WriteOnly)
    if not image.save(data, target.suffix[1:]):  # type: ignore[call-overload]
        raise UsageError("picture.screenshot_ending", file=str(target))
    with atomic_write(target) as stream:
        stream.write(data.data().data())
