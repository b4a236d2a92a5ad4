"""Commands for files: new, open, save and close."""

from __future__ import annotations

from app.editor.files import AUDIO_SUFFIXES, VIDEO_SUFFIXES
from app.editor.translated import tr
from app.project.storage import SUFFIX
from app.score.suffixes import MIDI, MUSIC, NOTATION
from app.shell.editor import Editor, EditorAction, is_open


def open_file(editor: Editor) -> None:
    """Ask for a project, a MIDI file or a score and open it."""
    kinds = (
        (tr("files.projects_and_music"), (SUFFIX, *MUSIC)),
        (tr("files.midi_files"), MIDI),
        (tr("files.scores"), NOTATION),
        (tr("files.all_files"), ("",)),
    )
    path = editor.questions.open_file(tr("files.open"), editor.files.folder, _filters(kinds))
    if path is not None:
        editor.files.open(path)


def import_midi(editor: Editor) -> None:
    """Ask for a MIDI file or a score and for the instruments of its parts, and open it."""
    kinds = (
        (tr("files.music"), MUSIC),
        (tr("files.midi_files"), MIDI),
        (tr("files.scores"), NOTATION),
        (tr("files.all_files"), ("",)),
    )
    path = editor.questions.open_file(tr("files.import_midi"), editor.files.folder, _filters(kinds))
    if path is not None:
        editor.files.open(path)


def add_audio(editor: Editor) -> None:
    """Ask for a recording that replaces the synthesiser."""
    kinds = (
        (tr("files.sound_files"), AUDIO_SUFFIXES),
        (tr("files.video_files"), VIDEO_SUFFIXES),
        (tr("files.all_files"), ("",)),
    )
    path = editor.questions.open_file(tr("files.add_recording"), editor.files.folder, _filters(kinds))
    if path is not None:
        editor.files.add_audio(path)


def add_video(editor: Editor) -> None:
    """Ask for a reference video of the performance."""
    kinds = ((tr("files.video_files"), VIDEO_SUFFIXES), (tr("files.all_files"), ("",)))
    path = editor.questions.open_file(tr("files.add_video"), editor.files.folder, _filters(kinds))
    if path is not None:
        editor.files.add_video(path)


def piece_settings(editor: Editor) -> None:
    """Open the dialog of the piece's title, frame rate, pre-roll, felt beat and seed."""
    from widgets.dialogs.piece_settings import PieceSettingsDialog

    PieceSettingsDialog(editor.session, editor.window).open()


def _can_save(editor: Editor) -> bool:
    files = editor.files
    return files.is_open and (files.path is None or not editor.session.document.is_saved)


def _filters(kinds: tuple[tuple[str, tuple[str, ...]], ...]) -> str:
    return ";;".join(f"{name} ({' '.join(f'*{suffix}' for suffix in suffixes)})" for name, suffixes in kinds)


ACTIONS: tuple[EditorAction, ...] = (
    EditorAction("file.new", lambda editor: editor.files.begin(), "file", "Ctrl+N", icon="new"),
    EditorAction("file.open", open_file, "file", "Ctrl+O", icon="open"),
    EditorAction("file.open_example", lambda editor: editor.files.open_example(), "file"),
    EditorAction("file.open_danced_example", lambda editor: editor.files.open_danced_example(), "file"),
    EditorAction("file.save", lambda editor: editor.files.save(), "file", "Ctrl+S", enabled=_can_save, icon="save"),
    EditorAction("file.save_as", lambda editor: editor.files.save_as(), "file", "Ctrl+Shift+S", enabled=is_open),
    EditorAction("file.import_midi", import_midi, "file", icon="import"),
    EditorAction("file.add_audio", add_audio, "file", enabled=is_open, icon="waveform"),
    EditorAction("file.add_video", add_video, "file", enabled=is_open, icon="film"),
    EditorAction("file.piece_settings", piece_settings, "file", "Alt+Return", enabled=is_open, icon="piece"),
    EditorAction("file.close", lambda editor: editor.files.close(), "file", "Ctrl+W", enabled=is_open),
    EditorAction("file.quit", lambda editor: editor.window.close(), "file", "Ctrl+Q"),
)
