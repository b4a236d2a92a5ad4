"""Commands of files: begin, open, save, close."""

from __future__ import annotations

from app.editor.files import AUDIO_SUFFIXES, MIDI_SUFFIXES
from app.editor.session import Session
from app.editor.translated import tr
from app.project.storage import SUFFIX
from app.shell.action import Action
from app.shell.editor import editor_of


def new_piece(session: Session) -> None:
    """Begin an empty piece."""
    editor_of(session).files.begin()


def open_file(session: Session) -> None:
    """Ask for a project or MIDI file and open it."""
    editor = editor_of(session)
    kinds = (
        (tr("files.projects_and_midi_files"), (SUFFIX, *MIDI_SUFFIXES)),
        (tr("files.all_files"), ("",)),
    )
    path = editor.questions.open_file(tr("files.open"), editor.files.folder, _filters(kinds))
    if path is not None:
        editor.files.open(path)


def import_midi(session: Session) -> None:
    """Ask for a MIDI file and who plays what in it."""
    editor = editor_of(session)
    kinds = ((tr("files.midi_files"), MIDI_SUFFIXES), (tr("files.all_files"), ("",)))
    path = editor.questions.open_file(tr("files.import_midi"), editor.files.folder, _filters(kinds))
    if path is not None:
        editor.files.open(path)


def add_audio(session: Session) -> None:
    """Ask for the recording that plays with the piece."""
    editor = editor_of(session)
    kinds = ((tr("files.sound_files"), AUDIO_SUFFIXES), (tr("files.all_files"), ("",)))
    path = editor.questions.open_file(tr("files.add_recording"), editor.files.folder, _filters(kinds))
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
    Action("file.new", new_piece, "File", "Ctrl+N", icon="new"),
    Action("file.open", open_file, "File", "Ctrl+O", icon="open"),
    Action("file.open_example", open_example, "File"),
    Action(
        "file.open_danced_example",
        open_danced_example,
        "File",
    ),
    Action(
        "file.save",
        save,
        "File",
        "Ctrl+S",
        enabled=_can_save,
        icon="save",
    ),
    Action("file.save_as", save_as, "File", "Ctrl+Shift+S", enabled=_is_open),
    Action("file.import_midi", import_midi, "File", icon="import"),
    Action(
        "file.add_audio",
        add_audio,
        "File",
        enabled=_is_open,
        icon="waveform",
    ),
    Action(
        "file.piece_settings",
        piece_settings,
        "File",
        "Alt+Return",
        enabled=_is_open,
        icon="piece",
    ),
    Action("file.close", close, "File", "Ctrl+W", enabled=_is_open),
    Action("file.quit", leave, "File", "Ctrl+Q"),
)
