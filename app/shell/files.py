"""The file side of the editor: what is open, opening, saving, unsaved work, autosave, recovery, recent files."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from importlib.resources import as_file, files
from pathlib import Path
from typing import Final

from PySide6.QtCore import QCoreApplication, QObject, QTimer, Signal

from app.errors import AppError, Cancelled, Message
from app.project import storage
from app.project.autosave import Autosave, Writing
from app.project.document import Change
from app.project.edit.piece import new_piece, set_audio, set_offset
from app.project.importing import import_project, usual_rows
from app.project.model import Project
from app.project.recovery import Recoverable, discard, recover, recoverable, recoverable_of
from app.score.read import MidiContents, read_contents
from app.shell.questions import Questions
from app.shell.settings import Settings
from instrument_maps.library import all_maps
from widgets.common.session import Session, Severity

MIDI_SUFFIXES: Final = (".mid", ".midi", ".smf", ".kar", ".rmi")
AUDIO_SUFFIXES: Final = (".wav", ".flac", ".mp3", ".ogg", ".aif", ".aiff")
EXAMPLE: Final = "quartet.mid"
TICK_MS: Final = 1000

Then = Callable[[], None]


class Files(QObject):
    """What file the session's project lives in.

    Parameters
    ----------
    session : Session
    settings : Settings
    questions : Questions
    autosave : Autosave or None
        None: unsaved work is not written down by itself.

    Signals
    -------
    changed()
        Another file, saved, or no longer saved.
    opened()
        A project is open that was not, or none is any more.
    found(Recoverable)
        There is newer unsaved work on the file that was just opened.
    missing(Path)
        The recording of the project that was just opened is not where it was.
    overtaken(Path, Then or None)
        The project was not saved: somebody else wrote its file since it was opened. `save_over` would replace that.
    """

    changed = Signal()
    opened = Signal()
    found = Signal(object)
    missing = Signal(object)
    overtaken = Signal(object, object)

    def __init__(
        self, session: Session, settings: Settings, questions: Questions, autosave: Autosave | None = None
    ) -> None:
        super().__init__(session)
        self.session = session
        self.settings = settings
        self.questions = questions
        self.autosave = autosave
        self.path: Path | None = None
        self._stamp: Stamp | None = None
        """Of the file as this editor read or wrote it last."""
        self.is_open = False
        self.saved_s: float | None = None
        """When the project, or unsaved work on it, was written last; of `time.monotonic`."""
        self.autosaved = False
        """Whether that was an autosave."""
        self._recovered: tuple[str, ...] = ()
        """Editors that are gone whose work this is."""
        session.changed.connect(self._project_changed)
        self._timer = QTimer(self)
        self._timer.setInterval(TICK_MS)
        self._timer.timeout.connect(self.tick)
        if autosave is not None:
            self._timer.start()

    @property
    def name(self) -> str:
        """What the project is called in the title."""
        if self.path is not None:
            return self.path.name
        score, source = self.session.project.score, self.session.project.source
        if source:
            return Path(source).stem
        return score.title or QCoreApplication.translate("Files", "Untitled")

    @property
    def is_saved(self) -> bool:
        """Whether nothing would be lost by closing."""
        return not self.is_open or self.session.document.is_saved

    @property
    def folder(self) -> str:
        """Where file dialogs begin."""
        if self.path is not None:
            return str(self.path.parent)
        return self.settings.folder or str(Path.home())

    @property
    def recovery_stems(self) -> tuple[Path, ...]:
        """What unsaved work on this project is called in the folder of unsaved work, without a suffix: this editor's,
        and that of editors whose work was taken over."""
        if self.autosave is None:
            return ()
        presence = self.autosave.presence
        return tuple(presence.folder / token for token in (presence.token, *self._recovered))

    @property
    def unwritten(self) -> bool:
        """Whether the project as it is is in no file, not even in that of unsaved work."""
        project = self.session.project
        return not self.session.document.is_saved and (self.autosave is None or not self.autosave.has(project))

    # Opening

    def begin(self) -> None:
        """A new, empty piece."""
        self.let_go(lambda: self._become(new_piece(), None))

    def open(self, path: Path, ask: bool = True) -> None:
        """Open a project or a MIDI file in place of what is open; a recording is added to it.

        Parameters
        ----------
        ask : bool
            Whether the import of a MIDI file asks who plays what.
        """
        path = path.absolute()
        suffix = path.suffix.lower()
        if suffix in AUDIO_SUFFIXES:
            if self.is_open:
                self.add_audio(path)
            else:
                self.session.notice(Message("open.audio_alone", {"file": path.name}), Severity.WARNING)
            return
        if suffix == storage.SUFFIX:
            self.let_go(lambda: self._load(path))
        else:
            self.let_go(lambda: self._read(path, ask))

    def open_example(self) -> None:
        """The bundled quartet."""
        with as_file(files("resources") / "examples" / EXAMPLE) as path:
            self.open(path, ask=False)

    def add_audio(self, path: Path) -> None:
        """Hear the piece with this recording."""
        self.settings.folder = str(path.parent)
        self.session.attempt(Message("edit.set_audio"), lambda project: set_audio(project, path))

    def replace_audio(self, path: Path) -> None:
        """The recording lies here now; its offset stays."""

        def replaced(project: Project) -> Project:
            offset_s = project.audio.offset_s if project.audio is not None else 0.0
            return set_offset(set_audio(project, path), offset_s)

        self.session.attempt(Message("edit.set_audio"), replaced)

    def _load(self, path: Path) -> None:
        folder = self.autosave.presence.folder if self.autosave is not None else None

        def work(progress: Callable[[float], None], stop_wanted: Callable[[], bool]) -> Opened:
            stamp = stamp_of(path)
            project = storage.load(path)
            return project, recoverable_of(path, folder) if folder is not None else None, stamp

        def done(opened: Opened) -> None:
            project, item, stamp = opened
            self._become(project, path)
            self._stamp = stamp
            if self.autosave is not None and self.autosave.is_shared:
                self.session.notice(Message("project.open_elsewhere", {"file": path.name}), Severity.WARNING)
            for problem in storage.missing(project):
                self.session.notice(problem, Severity.WARNING)
            lost = storage.missing_media(project)
            if item is not None:
                self.found.emit(item)
            elif lost is not None:
                self.missing.emit(lost)

        self.session.tasks.run(Message("work.open"), work, done, self._failed(path), key="open")

    def _read(self, path: Path, ask: bool) -> None:
        source = str(path)

        def work(progress: Callable[[float], None], stop_wanted: Callable[[], bool]) -> Read:
            contents = read_contents(path)
            if ask:
                return contents, None
            maps = all_maps()
            return contents, import_project(contents, usual_rows(contents, maps), maps, source)

        def done(read: Read) -> None:
            contents, project = read
            if project is None:
                project = self.questions.import_midi(contents, source, self.session.tokens)
            if project is None:
                return
            self._become(project, None)
            self.settings.folder = str(path.parent)
            # The bundled example is offered by itself; it is no file of this person's.
            if not path.is_relative_to(Path(str(files("resources")))):
                self.settings.add_recent(path)
            for warning in project.score.warnings[:1]:
                self.session.notice(warning, Severity.WARNING)
            self.changed.emit()

        self.session.tasks.run(Message("work.open"), work, done, self._failed(path), key="open")

    def _failed(self, path: Path) -> Callable[[AppError], None]:
        def failed(error: AppError) -> None:
            self.session.notice(error.message, Severity.ERROR)
            # Unlike `Path.exists`, it is no error where the name cannot be any file's.
            if not os.path.exists(path):  # noqa: PTH110
                self.changed.emit()

        return failed

    def _become(self, project: Project, path: Path | None, saved: bool = True, recovered: str = "") -> None:
        self.path = path
        self._recovered = (recovered,) if recovered else ()
        self._stamp = stamp_of(path) if path is not None else None
        self.is_open = True
        self.saved_s = None
        if path is not None:
            self.settings.add_recent(path)
            self.settings.folder = str(path.parent)
        if self.autosave is not None and saved:
            self._tell(lambda autosave: autosave.opened(path))
        self.session.set_playhead(0.0)
        self.session.document.open(project)
        if not saved:
            self.session.document.mark_unsaved()
        self.opened.emit()
        self.changed.emit()

    # Letting go

    def let_go(self, then: Then) -> None:
        """Do something that takes the open project away, once its changes are saved or given up."""
        if self.is_saved:
            then()
            return
        answer = self.questions.unsaved(self.name)
        if answer == "discard":
            self._give_up()
            then()
        elif answer == "save":
            self.save(then)

    def _give_up(self) -> None:
        if self.autosave is not None:
            self._tell(lambda autosave: autosave.opened(None))

    def close(self) -> None:
        """Back to the start page."""
        self.let_go(self._close)

    def _close(self) -> None:
        self._become(new_piece(), None)
        self.is_open = False
        self.opened.emit()
        self.changed.emit()

    def end(self) -> None:
        """The editor ends: nothing is left to recover."""
        self._timer.stop()
        if self.autosave is not None:
            self.autosave.closed()
            self.autosave = None

    # Saving

    def save(self, then: Then | None = None) -> None:
        """Save to the project's file; one without a file is asked where, and work of others is not written over."""
        if self.path is None:
            self.save_as(then)
            return
        found = stamp_of(self.path)
        if found is not None and found != self._stamp:
            self.overtaken.emit(self.path, then)
        else:
            self._save(self.path, then)

    def save_over(self, then: Then | None = None) -> None:
        """Save to the project's file, whoever wrote it last."""
        if self.path is not None:
            self._save(self.path, then)

    def save_as(self, then: Then | None = None) -> None:
        """Save to another file, which is the project's from now on."""
        proposal = str(Path(self.folder) / f"{Path(self.name).stem}{storage.SUFFIX}")
        path = self.questions.save_file(
            QCoreApplication.translate("Files", "Save project"),
            proposal,
            QCoreApplication.translate("Files", "Suisou project (*{suffix})").format(suffix=storage.SUFFIX),
            (storage.SUFFIX,),
        )
        if path is not None:
            self._save(path, then)

    def _save(self, path: Path, then: Then | None) -> None:
        project = self.session.project

        def work(progress: Callable[[float], None], stop_wanted: Callable[[], bool]) -> Stamp | None:
            if stop_wanted():
                raise Cancelled("work.stopped")
            storage.save(project, path)
            return stamp_of(path)

        def done(stamp: Stamp | None) -> None:
            self.path, self._stamp = path, stamp
            self.session.document.mark_saved(project)
            self.settings.add_recent(path)
            self.settings.folder = str(path.parent)
            self.saved_s, self.autosaved = time.monotonic(), False
            if self.autosave is not None:
                self._tell(lambda autosave: autosave.saved(path))
                if not self.session.document.is_saved:
                    self.autosave.changed(self.session.project, time.monotonic())
            self.changed.emit()
            if then is not None:
                then()

        self.session.tasks.run(Message("work.save"), work, done, key="save")

    def _project_changed(self, change: Change) -> None:
        if not change.opened and self.autosave is not None and not self.session.document.is_saved:
            self.autosave.changed(change.after, time.monotonic())
        self.changed.emit()

    # Unsaved work

    def tick(self) -> None:
        """Write unsaved work down when it is due; asked every second."""
        if self.autosave is not None and self.is_open:
            writing = self.autosave.due(time.monotonic())
            if writing is not None:
                self._write(writing)

    def write_now(self) -> None:
        """Write unsaved work down here and now: the program may not live on."""
        if self.autosave is None or not self.is_open:
            return
        if not self.session.document.is_saved:
            self.autosave.changed(self.session.project, time.monotonic())
        writing = self.autosave.take()
        if writing is not None:
            writing.run()
            self.autosave.written(writing)

    def write_soon(self) -> None:
        """Write unsaved work down now, beside the window."""
        if self.autosave is None or not self.is_open or self.session.document.is_saved:
            return
        self.autosave.changed(self.session.project, time.monotonic())
        writing = self.autosave.take()
        if writing is not None:
            self._write(writing)

    def _write(self, writing: Writing) -> None:
        def work(progress: Callable[[float], None], stop_wanted: Callable[[], bool]) -> None:
            writing.run()

        def done(nothing: None) -> None:
            if self.autosave is None:
                return
            self._tell(lambda autosave: autosave.written(writing))
            self.saved_s, self.autosaved = time.monotonic(), True
            self.changed.emit()

        def failed(error: AppError) -> None:
            if self.autosave is not None:
                self.autosave.failed(writing, time.monotonic())
            self.session.notice(error.message, Severity.WARNING)

        self.session.tasks.run(Message("work.autosave"), work, done, failed)

    def _tell(self, say: Callable[[Autosave], None]) -> None:
        if self.autosave is None:
            return
        try:
            say(self.autosave)
        except AppError as error:
            self.session.notice(error.message, Severity.WARNING)

    def recoverable(self) -> tuple[Recoverable, ...]:
        """What editors that are gone left behind."""
        return recoverable(self.autosave.presence.folder) if self.autosave is not None else ()

    def recover(self, item: Recoverable) -> None:
        """Go on with unsaved work."""
        autosave = self.autosave
        if autosave is None:
            return

        def go_on() -> None:
            try:
                project = recover(item, autosave)
            except AppError as error:
                self.session.notice(error.message, Severity.ERROR)
                return
            self._become(project, item.document, saved=False, recovered=item.token)

        self.let_go(go_on)

    def discard(self, item: Recoverable) -> None:
        """Throw unsaved work away."""
        if self.autosave is not None:
            discard(item, self.autosave.presence.folder)
        self.changed.emit()


def stamp_of(path: Path) -> Stamp | None:
    """By what a file that was written since is known; None: it is not there."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size


Stamp = tuple[int, int]
Opened = tuple[Project, Recoverable | None, Stamp | None]
Read = tuple[MidiContents, Project | None]
