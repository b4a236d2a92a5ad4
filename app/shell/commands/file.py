"""Commands of files: begin, open, save, close."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

from app.project.storage import SUFFIX
from app.shell.action import QT_TRANSLATE_NOOP, Action
from app.shell.editor import editor_of
from app.shell.files import AUDIO_SUFFIXES, MIDI_SUFFIXES
from widgets.common.session import Session


def new_piece(session: Session) -> None:
    """Begin an empty piece."""
    editor_of(session).files.begin()


def open_file(session: Session) -> None:
    """Ask for a project or MIDI file and open it."""
    editor = editor_of(session)
    translate = QCoreApplication.translate
    kinds = (
        (translate("Files", "Projects and MIDI files"), (SUFFIX, *MIDI_SUFFIXES)),
        (translate("Files", "All files"), ("",)),
    )
    path = editor.questions.open_file(translate("Files", "Open"), editor.files.folder, _filters(kinds))
    if path is not None:
        editor.files.open(path)


def import_midi(session: Session) -> None:
    """Ask for a MIDI file and who plays what in it."""
    editor = editor_of(session)
    translate = QCoreApplication.translate
    kinds = ((translate("Files", "MIDI files"), MIDI_SUFFIXES), (translate("Files", "All files"), ("",)))
    path = editor.questions.open_file(translate("Files", "Import MIDI"), editor.files.folder, _filters(kinds))
    if path is not None:
        editor.files.open(path)


def add_audio(session: Session) -> None:
    """Ask for the recording that the piece is heard with."""
    editor = editor_of(session)
    translate = QCoreApplication.translate
    kinds = ((translate("Files", "Sound files"), AUDIO_SUFFIXES), (translate("Files", "All files"), ("",)))
    path = editor.questions.open_file(translate("Files", "Add recording"), editor.files.folder, _filters(kinds))
    if path is not None:
        editor.files.add_audio(path)


def open_example(session: Session) -> None:
    """Open the bundled quartet."""
    editor_of(session).files.open_example()


def open_danced_example(session: Session) -> None:
    """Open the bundled piece with a dancer."""
    editor_of(session).files.open_danced_example()


def save(session: Session) -> None:
    """Save the project."""
    editor_of(session).files.save()


def save_as(session: Session) -> None:
    """Save the project to another file."""
    editor_of(session).files.save_as()


def piece_settings(session: Session) -> None:
    """Show title, frame rate, pre-roll, felt beat and seed of the piece."""
    from widgets.dialogs.piece_settings import PieceSettingsDialog

    PieceSettingsDialog(session, editor_of(session).window).open()


def close(session: Session) -> None:
    """Close the project."""
    editor_of(session).files.close()


def leave(session: Session) -> None:
    """End the editor."""
    editor_of(session).window.close()


def _is_open(session: Session) -> bool:
    return editor_of(session).files.is_open


def _can_save(session: Session) -> bool:
    files = editor_of(session).files
    return files.is_open and (files.path is None or not session.document.is_saved)


def _filters(kinds: tuple[tuple[str, tuple[str, ...]], ...]) -> str:
    return ";;".join(f"{name} ({' '.join(f'*{suffix}' for suffix in suffixes)})" for name, suffixes in kinds)


ACTIONS: tuple[Action, ...] = (
    Action("file.new", QT_TRANSLATE_NOOP("Action", "New Piece"), new_piece, "File", "Ctrl+N", icon="new"),
    Action("file.open", QT_TRANSLATE_NOOP("Action", "Open..."), open_file, "File", "Ctrl+O", icon="open"),
    Action("file.open_example", QT_TRANSLATE_NOOP("Action", "Open the Example Quartet"), open_example, "File"),
    Action(
        "file.open_danced_example",
        QT_TRANSLATE_NOOP("Action", "Open the Example with a Dancer"),
        open_danced_example,
        "File",
    ),
    Action(
        "file.save",
        QT_TRANSLATE_NOOP("Action", "Save"),
        save,
        "File",
        "Ctrl+S",
        enabled=_can_save,
        icon="save",
    ),
    Action(
        "file.save_as", QT_TRANSLATE_NOOP("Action", "Save As..."), save_as, "File", "Ctrl+Shift+S", enabled=_is_open
    ),
    Action("file.import_midi", QT_TRANSLATE_NOOP("Action", "Import MIDI..."), import_midi, "File", icon="import"),
    Action(
        "file.add_audio",
        QT_TRANSLATE_NOOP("Action", "Add Recording..."),
        add_audio,
        "File",
        enabled=_is_open,
        icon="waveform",
    ),
    Action(
        "file.piece_settings",
        QT_TRANSLATE_NOOP("Action", "Piece Settings..."),
        piece_settings,
        "File",
        "Alt+Return",
        enabled=_is_open,
        icon="piece",
    ),
    Action("file.close", QT_TRANSLATE_NOOP("Action", "Close Project"), close, "File", "Ctrl+W", enabled=_is_open),
    Action("file.quit", QT_TRANSLATE_NOOP("Action", "Quit"), leave, "File", "Ctrl+Q"),
)
