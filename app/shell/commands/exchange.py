"""Commands that exchange data with other programs: re-importing MIDI, and exporting MIDI, animation files, films and a
live stream of poses.
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt

from app.editor.exported_bars import ExportedBars
from app.editor.session import Session, Severity
from app.editor.translated import tr
from app.encoding import shown
from app.errors import AppError, Argument, Message, Progress, StopRequested
from app.formats.other_computers import is_file
from app.project.edit.players import remove_players
from app.project.midi_out import export_midi as write_piece
from app.project.model import Project
from app.project.part_changes import PartChanges, changes_by_part
from app.project.reimport import Reimport, reimported
from app.score import suffixes
from app.shell.action import Action
from app.shell.editor import Editor, EditorAction, is_open
from app.version import program_version
from instrument_maps.library import all_maps
from widgets.common.text import message_text
from widgets.inspector.words import correction_title


def read_again(editor: Editor) -> None:
    """Read the project's MIDI file or score again, asking where the file is if it is missing."""
    source = editor.session.project.source
    if source and is_file(source):
        reimport_from(editor, Path(source))
    else:
        name = shown(Path(source).name) if source else ""
        _ask_for_version(editor, tr("files.source_not_found").format(file=name) if name else _usual_title())


def read_another(editor: Editor) -> None:
    """Ask for a newer version of the piece's MIDI file or score, and show its changes for applying them to
    the piece.
    """
    _ask_for_version(editor, _usual_title())


def _usual_title() -> str:
    return tr("files.re_import_midi")


def _ask_for_version(editor: Editor, title: str) -> None:
    kinds = f"{tr('files.music')} ({' '.join(f'*{suffix}' for suffix in suffixes.MUSIC)})"
    path = editor.questions.open_file(title, editor.files.folder, kinds)
    if path is not None:
        reimport_from(editor, path)


def reimport_from(editor: Editor, path: Path) -> None:
    """Show the changes that a MIDI file or a score makes to the piece, and apply them if the user agrees."""
    session = editor.session
    project = session.project

    def work(progress: Progress, stop_requested: StopRequested) -> tuple[Reimport, PartChanges]:
        outcome = reimported(project, path, all_maps(), progress, stop_requested)
        progress(0.95)
        return outcome, changes_by_part(project.score, outcome.project.score)

    def done(found: tuple[Reimport, PartChanges]) -> None:
        outcome, changes = found
        if session.project is not project:
            # The piece was edited meanwhile, so the result does not apply any more.
            reimport_from(editor, path)
            return
        from widgets.dialogs.reimport_midi import ReimportDialog

        dialog = ReimportDialog(session, outcome, shown(path.name), correction_title, changes, editor.window)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.accepted.connect(lambda: _take_of_others(session, project, outcome, dialog.kept, dialog.removed))
        dialog.open()

    def failed(error: AppError) -> None:
        session.notice(error.message, Severity.ERROR)

    session.tasks.run(Message("work.reimport"), work, done, failed, key="reimport")


def _take_of_others(
    session: Session, before: Project, outcome: Reimport, kept: frozenset[str], removed: tuple[str, ...]
) -> None:
    """Apply a re-imported MIDI file or score except for the parts that the user keeps unchanged.

    This is done in the background, since a large piece takes seconds.

    Parameters
    ----------
    kept : frozenset of str
        Ids of the parts that stay as they are.
    removed : tuple of str
        Ids of the players to remove.
    """
    if not kept:
        _take(session, before, outcome, removed)
        return
    session.tasks.run(
        Message("work.reimport"),
        lambda progress, stop_requested: outcome.keeping(kept),
        lambda taken: _take(session, before, taken, removed),
        key="reimport",
    )


def _take(session: Session, before: Project, outcome: Reimport, removed: tuple[str, ...]) -> None:
    project = remove_players(outcome.project, removed) if removed else outcome.project
    if session.project is before and session.apply(Message("edit.reimport"), project):
        session.notice(
            Message("reimport.done", {"kept": sum(part.kept for part in outcome.parts), "lost": len(outcome.orphans)})
        )


def export_midi(editor: Editor) -> None:
    """Ask for a file name, and write the piece as MIDI."""
    session = editor.session
    proposal = Path(editor.files.folder) / f"{editor.files.stem}.mid"
    kinds = f"{tr('files.midi_files')} (*.mid)"
    target = editor.questions.save_file(tr("files.export_midi"), str(proposal), kinds, suffixes.MIDI)
    if target is None:
        return
    project = session.project

    def work(progress: Progress, stop_requested: StopRequested) -> tuple[Message, ...]:
        return write_piece(project, target, all_maps())

    def done(warnings: tuple[Message, ...]) -> None:
        # The path lets the list of notices show the file in its folder.
        written: dict[str, Argument] = {"file": target.name, "path": str(target)}
        if warnings:
            first = message_text(warnings[0], session)
            reported = Message("midi.written_but", {**written, "first": first, "count": len(warnings)})
            session.notice(reported, Severity.WARNING)
        else:
            session.notice(Message("midi.written", {**written, "count": len(project.score.parts)}))

    def failed(error: AppError) -> None:
        session.notice(error.message, Severity.ERROR)

    session.tasks.run(Message("work.export_midi"), work, done, failed, key="export_midi", writes=True)


def export_files(editor: Editor) -> None:
    """Open the dialog for exporting animation files, and start the export when it is confirmed."""
    folder = editor.settings.export_folder or str(Path(editor.files.folder) / "export")
    from widgets.dialogs.export_files import ExportDialog  # imports all file formats

    unreal = editor.settings.unreal_project
    piece = editor.session.project.source or str(editor.files.path)
    dialog = ExportDialog(
        editor.session,
        Path(folder),
        editor.files.name,
        f"Suisou {program_version()}",
        editor.window,
        unreal=Path(unreal) if unreal else None,
        destination="unreal" if unreal and editor.settings.export_into == "unreal" else "folder",
        keys=editor.settings.export_keys,
        texture_px=editor.settings.export_texture_px,
        levels=editor.settings.export_levels,
        before=editor.exported_bars.get(piece, ExportedBars()),
    )

    def remember(destination: str, place: Path) -> None:
        editor.exported_bars[piece] = dialog.chosen_bars
        editor.settings.export_into = destination
        editor.settings.export_texture_px = dialog.texture_px
        editor.settings.export_levels = dialog.levels
        if destination == "folder":
            editor.settings.export_keys = dialog.keys
        if destination == "unreal":
            editor.settings.unreal_project = str(place)
        else:
            editor.settings.export_folder = str(place)

    dialog.exported.connect(remember)
    dialog.show()


def playblast(editor: Editor) -> None:
    """Open the dialog that makes a film of the viewport."""
    session = editor.session
    path = Path(editor.files.folder) / f"{editor.files.stem}.mp4"
    project = session.project
    from app.audio.mix import mixdown
    from widgets.dialogs.playblast import PlayblastDialog

    dialog = PlayblastDialog(
        session,
        editor.window.viewport.film,
        lambda start_s, end_s, rate: mixdown(project, start_s, end_s, rate),
        path,
        editor.window,
    )
    dialog.show()


def can_draw(editor: Editor) -> bool:
    """Return whether the project has players to be shown in a film."""
    return _can_export(editor) and editor.window.viewport.has_gl


def _can_export(editor: Editor) -> bool:
    return bool(editor.session.project.players) and editor.files.is_open


def toggle_stream(session: Session, on: bool = True) -> None:
    """Switch the live stream of poses to other programs on or off."""
    session.streaming.set(on=not session.streaming.on)


def stream_settings(editor: Editor) -> None:
    """Open the dialog of the live stream, or bring it to the front."""
    from widgets.dialogs.stream import StreamDialog

    editor.show_once(StreamDialog, lambda: StreamDialog(editor.session, editor.window))


ACTIONS: tuple[Action | EditorAction, ...] = (
    EditorAction("file.reimport", read_again, "file", "Ctrl+Shift+I", enabled=is_open),
    EditorAction("file.reimport_other", read_another, "file", enabled=is_open),
    EditorAction("file.export_midi", export_midi, "file", enabled=_can_export),
    EditorAction("export.files", export_files, "export", "Ctrl+E", enabled=_can_export, icon="export"),
    EditorAction(
        "export.playblast",
        playblast,
        "export",
        "Ctrl+Shift+E",
        enabled=can_draw,
        icon="film",
    ),
    Action(
        "stream.toggle",
        toggle_stream,
        "export",
        "Ctrl+Alt+L",
        enabled=lambda session: bool(session.project.performers),
        checked=lambda session: session.streaming.on,
        icon="stream",
    ),
    EditorAction("stream.settings", stream_settings, "export", icon="settings"),
)
