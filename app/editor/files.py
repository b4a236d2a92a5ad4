"""Files of the editor: opening, saving, autosave, recovery, recent files."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable
from importlib.resources import as_file, files
from pathlib import Path
from typing import Final

from PySide6.QtCore import QObject, Qt, QTimer, Signal

from app.editor.questions import Questions
from app.editor.session import Session, Severity
from app.editor.settings import Settings
from app.editor.translated import tr
from app.encoding import shown
from app.errors import AppError, Message, Progress, StopRequested, raise_if_stopped
from app.formats.other_computers import agree
from app.formats.video import SUFFIXES
from app.project import storage
from app.project.autosave import Autosave, AutosaveResult, Writing
from app.project.choreography_files import bundled_choreographies
from app.project.edit.dancers import add_dancer, change_dancers
from app.project.edit.piece import new_piece, relocate, set_audio, set_video
from app.project.importing import ImportRequest, import_project, usual_rows
from app.project.model import Project
from app.project.names import file_stem
from app.project.recovery import Recoverable, discard, load_work, never_saved, recoverable, recoverable_of
from app.project.salvage import salvaged
from app.project.undoable_document import Change
from app.rig.characters.character_library import reload_characters
from app.score.contents import PieceContents
from app.score.read import read_contents
from instrument_maps.library import all_maps, reload

AUDIO_SUFFIXES: Final = (".wav", ".flac", ".mp3", ".ogg", ".aif", ".aiff", ".m4a")
VIDEO_SUFFIXES: Final = SUFFIXES
EXAMPLE: Final = "quartet.mid"
DANCED_EXAMPLE: Final = "montuno.mid"
EXAMPLE_VARIATION: Final = 14
"""Seed of the example's dance, chosen for many different basic motions and a dancer who mostly faces the audience."""
MOST_SLEEP_S: Final = 60.0
"""Greatest interval in seconds between checks whether unsaved work must be autosaved."""

Then = Callable[[], None]


class Files(QObject):
    """Opens, saves and recovers the session's project, and knows its file.

    Parameters
    ----------
    autosave : Autosave or None
        Writes unsaved work to recovery files; None to write none.

    Signals
    -------
    changed()
        The file changed, was saved, or has unsaved changes.
    opened()
        A project was opened or closed.
    left()
        The open piece is about to be replaced, or was just saved, so that listeners can store the current view.
    found(Recoverable)
        Unsaved work was found for the opened file, or for a piece without a file.
    missing(Path)
        The recording of the opened project does not exist at its path.
    elsewhere(tuple of str)
        The opened project refers to these files on other computers, which are not read before `agree_to` is called.
    silent(Path)
        A MIDI file without players and dancers was opened.
    unsaveable(Message)
        A value of the project, named in the message, cannot be stored in a file.
    overtaken(Path, callable or None)
        The project was not saved, because another program has changed its file since it was opened; `save_over`
        overwrites it. The callable is the ``then`` of `save`.
    """

    changed = Signal()
    opened = Signal()
    left = Signal()
    found = Signal(object)
    missing = Signal(object)
    elsewhere = Signal(object)
    silent = Signal(object)
    unsaveable = Signal(object)
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
        self._base = ""
        """`storage.content_hash` of the file as this editor read or wrote it last; empty where it was not there."""
        self.is_open = False
        self.saved_s: float | None = None
        """Time of the last save or autosave, of `time.monotonic`."""
        self.autosaved = False
        """True if that was an autosave."""
        self.risk: Message | None = None
        """Reason for which unsaved work is in no file, not even in an autosave; None: it is, or is about to be."""
        self._warned: set[str] = set()
        """Ids of warnings about autosaves of the open project: each is shown once."""
        self._recovered: tuple[str, ...] = ()
        """Editors that are gone whose work this is."""
        session.changed.connect(self._project_changed)
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self.tick)

    @property
    def name(self) -> str:
        """Return the name of the project for the window title."""
        if self.path is not None:
            return shown(self.path.name)
        score, source = self.session.project.score, self.session.project.source
        if source:
            return shown(Path(source).stem)
        return score.title or tr("files.untitled")

    @property
    def stem(self) -> str:
        """Return the proposed file name of the project, without suffix."""
        return shown(self.path.stem) if self.path is not None else file_stem(self.name)

    @property
    def is_saved(self) -> bool:
        """Return whether the project can be closed without losing changes."""
        return not self.is_open or self.session.document.is_saved

    @property
    def folder(self) -> str:
        """Return the folder in which file dialogs start."""
        if self.path is not None:
            return str(self.path.parent)
        return self.settings.folder or str(Path.home())

    @property
    def recovery_stems(self) -> tuple[Path, ...]:
        """Return the paths, without suffix, of the recovery files of this project: those of this editor, and those of
        editors whose work was recovered.
        """
        if self.autosave is None:
            return ()
        presence = self.autosave.presence
        return tuple(presence.folder / token for token in (presence.token, *self._recovered))

    @property
    def unwritten(self) -> bool:
        """Return whether the project has changes that are neither saved nor autosaved."""
        project = self.session.project
        return not self.session.document.is_saved and (self.autosave is None or not self.autosave.has(project))

    # Opening and creating

    def begin(self) -> None:
        """Open a new, empty piece."""
        self.let_go(lambda: self._become(new_piece(), None))

    def open(self, path: Path, ask: bool = True, at_start: bool = False) -> None:
        """Open a project, MIDI file or score, replacing the current one; a recording or reference video is added to the
        open project.

        Parameters
        ----------
        ask : bool
            Whether to show the import dialog for a MIDI file or score.
        at_start : bool
            Whether the editor starts with this file. Then unsaved work without a file is searched too, since no start
            page has shown it.
        """
        agree(path)
        path = path.absolute()
        suffix = path.suffix.lower()
        if suffix in (*AUDIO_SUFFIXES, *VIDEO_SUFFIXES):
            if not self.is_open:
                self.session.notice(Message("open.audio_alone", {"file": path.name}), Severity.WARNING)
            elif suffix in AUDIO_SUFFIXES:
                self.add_audio(path)
            else:
                self.add_video(path)
            return
        if suffix == storage.SUFFIX:
            self.let_go(lambda: self._load(path, at_start))
        else:
            self.let_go(lambda: self._read(path, ask, at_start))

    def open_example(self) -> None:
        """Open the example project, a bundled quartet."""
        with as_file(files("resources") / "examples" / EXAMPLE) as path:
            self.open(path, ask=False)

    def open_danced_example(self) -> None:
        """Open the bundled piece with drums, with a dancer in the bundled choreography."""
        name = tr("action.dancer")

        def danced(project: Project) -> Project:
            result, dancer_id = add_dancer(project, bundled_choreographies()[0], name)
            return change_dancers(result, (dancer_id,), seed=EXAMPLE_VARIATION)

        with as_file(files("resources") / "examples" / DANCED_EXAMPLE) as path:
            example = path.absolute()
            self.let_go(lambda: self._read(example, False, arranged=danced))

    def add_audio(self, path: Path) -> None:
        """Use a recording as the audio of the piece."""
        agree(path)
        self.settings.folder = str(path.parent)
        self.session.attempt(Message("edit.set_audio"), lambda project: set_audio(project, path))

    def add_video(self, path: Path) -> None:
        """Use a reference video for the piece."""
        agree(path)
        self.settings.folder = str(path.parent)
        if self.session.video.placement == "hidden":
            self.session.video.set(placement="beside")
        self.session.attempt(Message("edit.set_video"), lambda project: set_video(project, path))

    def locate(self, missing: Path, path: Path | None) -> None:
        """Set the new path of a recording or reference video that was not found, keeping its offset; None
        removes it.
        """
        audio, video = self.session.project.audio, self.session.project.video
        is_audio = audio is not None and audio.path == os.fspath(missing)
        others = video is not None and video.path == os.fspath(missing)
        if path is not None:
            agree(path)
        kind = "audio" if is_audio and not others else "video"
        done = Message(f"edit.remove_{kind}" if path is None else f"edit.set_{kind}")
        self.session.attempt(done, lambda project: relocate(project, missing, path))

    def agree_to(self, paths: tuple[str, ...]) -> None:
        """Allow the open project to read these media files on other computers."""
        for path in paths:
            agree(path)
        self.session.media_agreed.emit()
        self.session.choreographies_changed.emit()
        self._report_missing()
        self._ask_about_files()

    def _report_missing(self) -> None:
        for problem in storage.missing(self.session.project):
            self.session.notice(problem, Severity.WARNING)

    def _ask_about_files(self) -> None:
        """Emit `elsewhere` if the project has files on other computers, or else `missing` if a media file is
        missing.
        """
        project = self.session.project
        paths, lost = storage.elsewhere(project), storage.missing_media(project)
        if paths:
            self.elsewhere.emit(paths)
        elif lost is not None:
            self.missing.emit(lost)

    def _load(self, path: Path, at_start: bool) -> None:
        presence = self.autosave.presence if self.autosave is not None else None

        def work(progress: Progress, stop_requested: StopRequested) -> Opened:
            _read_own()
            content = storage.read(path)
            project = storage.decode(content, Path(os.path.realpath(path)), str(path))
            items = recoverable_of(path, presence.folder, presence.token) if presence is not None else ()
            if presence is not None and not items and at_start:
                items = never_saved(presence.folder)
            return project, items[0] if items else None, storage.content_hash(content)

        def done(opened: Opened) -> None:
            project, item, base = opened
            self._become(project, path, base)
            if self.autosave is not None and self.autosave.is_shared:
                self.session.notice(Message("project.open_elsewhere", {"file": path.name}), Severity.WARNING)
            self._report_missing()
            if item is not None:
                self.found.emit(item)
            else:
                self._ask_about_files()

        self.session.tasks.run(Message("work.open"), work, done, self._failed(path), key="open")

    def _read(
        self,
        path: Path,
        ask: bool,
        at_start: bool = False,
        arranged: Callable[[Project], Project] = lambda project: project,
    ) -> None:
        source = str(path)
        folder = self.autosave.presence.folder if self.autosave is not None else None

        def read(progress: Progress, stop_requested: StopRequested) -> PieceContents:
            _read_own()
            return read_contents(path)

        def again(encoding: str | None) -> PieceContents:
            return read_contents(path, encoding=encoding)

        def ask_who(contents: PieceContents) -> None:
            session = self.session
            assignment = self.questions.import_midi(contents, again, session.tokens, session.tasks) if ask else None
            if ask and assignment is None:
                return
            called = tr("action.dancer")

            def build(progress: Progress, stop_requested: StopRequested) -> tuple[Project, tuple[Recoverable, ...]]:
                maps = all_maps()
                asked = assignment or ImportRequest(usual_rows(contents, maps))
                project = import_project(
                    *(asked.contents or contents, asked.rows, maps, source, stop_requested),
                    encoding=asked.encoding,
                    outfit=asked.outfit,
                )
                if asked.dances:
                    project, _ = add_dancer(project, bundled_choreographies()[0], called)
                items = never_saved(folder, path) if folder is not None else ()
                if folder is not None and not items and at_start:
                    items = never_saved(folder)
                return arranged(project), items

            self.session.tasks.run(Message("work.open"), build, done, self._failed(path), key="open")

        def done(opened: tuple[Project, tuple[Recoverable, ...]]) -> None:
            project, items = opened
            self._become(project, None)
            # The bundled example is not a file of the user: it is not listed as recent, and no files are written beside
            # it.
            if not path.is_relative_to(Path(str(files("resources")))):
                self.settings.folder = str(path.parent)
                self.settings.add_recent(path)
            for warning in project.score.warnings[:1]:
                self.session.notice(warning, Severity.WARNING)
            self.changed.emit()
            if items:
                self.found.emit(items[0])
            elif not project.players and not project.dancers:
                self.silent.emit(path)

        self.session.tasks.run(Message("work.open"), read, ask_who, self._failed(path), key="open")

    def _failed(self, path: Path) -> Callable[[AppError], None]:
        def failed(error: AppError) -> None:
            self.session.notice(error.message, Severity.ERROR)
            # Unlike `Path.exists`, this returns False for names that no file can have.
            if not os.path.exists(path):
                self.changed.emit()

        return failed

    def _become(
        self, project: Project, path: Path | None, base: str = "", recovered: Recoverable | None = None
    ) -> None:
        self.left.emit()
        self.path, self._base = path, base
        self._recovered = (recovered.token,) if recovered is not None and recovered.token else ()
        self.is_open = True
        self.saved_s = None
        self._warned.discard("autosave.elsewhere")
        if path is not None:
            self.settings.add_recent(path)
            self.settings.folder = str(path.parent)
        if recovered is None:
            self._begin_autosave()
        else:
            self._begin_autosave(recovered.facts, recovered.autosave)
        self.session.set_playhead(0.0)
        self.session.document.open(project)
        if recovered is not None:
            self.session.document.mark_unsaved()
            self._note_unsaved()
        self.opened.emit()
        self.changed.emit()

    # Closing

    def let_go(self, then: Then) -> None:
        """Run a function that closes the open project, after its changes are saved or discarded."""
        if self.is_saved:
            then()
            return
        answer = self.questions.unsaved(self.name)
        if answer == "discard":
            then()
        elif answer == "save":
            self.save(then)

    def close(self) -> None:
        """Close the project and show the start page."""
        self.let_go(self._close)

    def _close(self) -> None:
        self._become(new_piece(), None)
        self.is_open = False
        self.opened.emit()
        self.changed.emit()

    def end(self) -> None:
        """End autosaving when the editor closes, and delete the recovery file."""
        self.left.emit()
        self._timer.stop()
        if self.autosave is not None:
            self.autosave.closed()
            self.autosave = None

    # Saving

    def save(self, then: Then | None = None) -> None:
        """Save to the project's file; ask for a path for a new project, and do not overwrite changes by other programs.

        ``then`` is called after saving.
        """
        if self.path is None:
            self.save_as(then)
        else:
            self._save(self.path, then, over=(self._base, ""))

    def save_over(self, then: Then | None = None) -> None:
        """Save to the project's file, overwriting changes by other programs; ``then`` is called after saving."""
        if self.path is not None:
            self._save(self.path, then)

    def save_as(self, then: Then | None = None) -> None:
        """Ask for another file, save to it, and keep it as the project's file; ``then`` is called after saving."""
        proposal = str(Path(self.folder) / f"{self.stem}{storage.SUFFIX}")
        path = self.questions.save_file(
            tr("files.save_project"),
            proposal,
            tr("files.suisou_project").format(suffix=storage.SUFFIX),
            (storage.SUFFIX,),
        )
        if path is not None:
            self._save(path, then)

    def _save(self, path: Path, then: Then | None, over: tuple[str, ...] | None = None) -> None:
        """Save to a file; if ``over`` is given, only if the file's content hash is one of these."""
        project = self.session.project

        def work(progress: Progress, stop_requested: StopRequested) -> str | None:
            raise_if_stopped(stop_requested)
            if over is not None and storage.file_hash(path) not in over:
                return None
            return storage.save(project, path)

        def done(base: str | None) -> None:
            if base is None:
                self.overtaken.emit(path, then)
                return
            self.path, self._base = path, base
            self.session.document.mark_saved(project)
            self.settings.add_recent(path)
            self.settings.folder = str(path.parent)
            self.saved_s, self.autosaved = time.monotonic(), False
            self._warned.discard("autosave.elsewhere")
            self._begin_autosave()
            if not self.session.document.is_saved:
                self._note_unsaved()
            self.left.emit()
            self.changed.emit()
            if then is not None:
                then()

        def failed(error: AppError) -> None:
            self.session.notice(error.message, Severity.ERROR)
            if error.message.id == "project.cannot_save":
                self.unsaveable.emit(error.message)

        self.session.tasks.run(Message("work.save"), work, done, failed, key="save")

    @property
    def can_leave_out(self) -> bool:
        """Return whether the project could be saved after removing the values that cannot be stored."""
        return salvaged(self.session.project) is not None

    def leave_out(self) -> None:
        """Remove the values that cannot be saved, as an undoable edit; do nothing if that does not help."""
        rest = salvaged(self.session.project)
        if rest is not None:
            self.session.apply(Message("edit.leave_out"), rest.project)

    def _project_changed(self, change: Change) -> None:
        if not change.opened and self.is_open:
            if not self.session.document.is_saved:
                self._note_unsaved()
            elif self.autosave is not None and self.autosave.has_work:
                # Undo led back to the saved state.
                self._begin_autosave()
                if self.autosaved:
                    self.saved_s, self.autosaved = None, False
        self.changed.emit()

    # Autosave

    def _begin_autosave(self, former: storage.Autosaved | None = None, held: Path | None = None) -> None:
        """Start autosaving for the project just opened.

        Parameters
        ----------
        former : Autosaved, optional
            Recovery file of an ended editor that this project was recovered from.
        held : Path, optional
            Recovery file whose content equals the project.
        """
        self.risk = None
        self._timer.stop()
        self._report(lambda autosave: autosave.opened(self.path, self._base, former, held))

    def _note_unsaved(self) -> None:
        """Record that the project differs from its file."""
        if self.autosave is not None:
            self.autosave.changed(self.session.project, time.monotonic())
            self._schedule()

    def _schedule(self) -> None:
        """Start the timer for the next autosave; further changes do not delay it."""
        due_s = self.autosave.due_s if self.autosave is not None else None
        if due_s is None:
            self._timer.stop()
        elif not self._timer.isActive():
            self._timer.start(math.ceil(1000.0 * min(max(due_s - time.monotonic(), 0.0), MOST_SLEEP_S)))

    def tick(self) -> None:
        """Autosave if it is due."""
        if self.autosave is not None and self.is_open:
            writing = self.autosave.due(time.monotonic())
            if writing is not None:
                self._write(writing)
            self._schedule()

    def write_now(self) -> None:
        """Autosave immediately, because the program may end.

        Raises
        ------
        FileError
            If the recovery file cannot be written.
        """
        writing = self._taken()
        if writing is None or self.autosave is None:
            return
        try:
            written = writing.run()
        finally:
            self.autosave.ended(writing, time.monotonic())
        self.autosave.written(writing, written)

    def write_soon(self) -> None:
        """Autosave now, in the background."""
        writing = self._taken()
        if writing is not None:
            self._write(writing)

    def _taken(self) -> Writing | None:
        if self.autosave is None or not self.is_open or self.session.document.is_saved:
            return None
        now_s = time.monotonic()
        self.autosave.changed(self.session.project, now_s)
        return self.autosave.take(now_s)

    def _write(self, writing: Writing) -> None:
        def work(progress: Progress, stop_requested: StopRequested) -> AutosaveResult:
            return writing.run()

        def ended() -> None:
            if self.autosave is not None:
                self.autosave.ended(writing, time.monotonic())
                self._schedule()

        def done(written: AutosaveResult) -> None:
            if self.autosave is None:
                return
            self._report(lambda autosave: autosave.written(writing, written))
            self._schedule()
            if written.without is None:
                self._warned.discard("autosave.without")
            if self.autosave.has(writing.project):
                self.saved_s, self.autosaved, self.risk = time.monotonic(), True, None
                if written.warning is not None:
                    self.warn_once(written.warning)
                if written.without is not None and self.warn_once(written.without):
                    self.unsaveable.emit(written.without)
            self.changed.emit()

        def failed(error: AppError) -> None:
            if self.autosave is not None and self.autosave.is_current(writing):
                if self.risk is None:
                    self.session.notice(error.message, Severity.ERROR)
                self.risk = error.message
                self.changed.emit()

        self.session.tasks.run(Message("work.autosave"), work, done, failed, ended=ended)

    def warn_once(self, message: Message) -> bool:
        """Show a warning about autosaving once, and return whether it was shown now for the first time."""
        if message.id in self._warned:
            return False
        self._warned.add(message.id)
        self.session.notice(message, Severity.WARNING)
        return True

    def _report(self, say: Callable[[Autosave], None]) -> None:
        if self.autosave is None:
            return
        try:
            say(self.autosave)
        except AppError as error:
            self.warn_once(error.message)

    def find_recoverable(self, found: Callable[[tuple[Recoverable, ...]], None]) -> None:
        """Search in the background for unsaved work of ended editors, and call ``found`` with it."""
        if self.autosave is None:
            found(())
            return
        folder = self.autosave.presence.folder

        def work(progress: Progress, stop_requested: StopRequested) -> tuple[Recoverable, ...]:
            return recoverable(folder)

        self.session.tasks.run(Message("work.recoverable"), work, found, key="recoverable")

    def recover(self, item: Recoverable) -> None:
        """Open the unsaved work that was found after a crash, as the current project."""
        if item.document is not None:
            agree(item.document)

        def work(progress: Progress, stop_requested: StopRequested) -> tuple[Project, str]:
            _read_own()
            return load_work(item)

        def done(loaded: tuple[Project, str]) -> None:
            project, base = loaded
            self._become(project, item.document, base, item)
            if storage.elsewhere(project):
                self._ask_about_files()

        if self.autosave is not None:
            self.let_go(
                lambda: self.session.tasks.run(
                    Message("work.open"), work, done, self._failed(item.autosave), key="open"
                )
            )

    def discard(self, item: Recoverable) -> None:
        """Delete the unsaved work that was found after a crash."""
        try:
            discard(item)
        except AppError as error:
            self.session.notice(error.message, Severity.WARNING)
        self.changed.emit()
        if self.is_open and storage.elsewhere(self.session.project):
            self._ask_about_files()


Opened = tuple[Project, Recoverable | None, str]


def _read_own() -> None:
    """Load the user's instruments and characters before a piece is opened that may use them."""
    reload()
    reload_characters()
