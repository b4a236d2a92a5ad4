"""Commands that exchange files with other programs: a changed MIDI file in; a MIDI file, players and films
out."""

from __future__ import annotations

import os
from pathlib import Path

from PySide6.QtCore import Qt

from app.editor.files import MIDI_SUFFIXES
from app.editor.session import Session, Severity
from app.editor.tasks import Progress, StopRequested
from app.editor.translated import tr
from app.encoding import shown
from app.errors import AppError, Message
from app.project.midi_out import export_midi as write_piece
from app.project.model import Player, Project, map_choices
from app.project.reimport import Reimport, reimport
from app.score.read import read_midi
from app.shell.action import Action
from app.shell.editor import editor_of
from app.version import program_version
from instrument_maps.library import all_maps
from widgets.common.text import message_text, note_text
from widgets.inspector.words import correction_title


def read_again(session: Session) -> None:
    """Read the project's MIDI file once more; one that is not there any more is asked for."""
    source = Path(session.project.source) if session.project.source else None
    if source is not None and os.path.isfile(source):
        reimport_from(session, source)
    else:
        read_another(session)


def read_another(session: Session) -> None:
    """Ask for a newer version of the piece's MIDI file and take it in."""
    editor = editor_of(session)
    kinds = f"{tr('files.midi_files')} ({' '.join(f'*{suffix}' for suffix in MIDI_SUFFIXES)})"
    path = editor.questions.open_file(tr("files.re_import_midi"), editor.files.folder, kinds)
    if path is not None:
        reimport_from(session, path)


def reimport_from(session: Session, path: Path) -> None:
    """Show what a MIDI file changes in the piece, and change it if the user agrees."""
    project = session.project

    def work(progress: Progress, stop_requested: StopRequested) -> Reimport:
        maps = all_maps()
        score = read_midi(path, maps=map_choices(maps.values()))
        return reimport(project, score, maps, str(path))

    def done(outcome: Reimport) -> None:
        if session.project is not project:
            # Edited meanwhile: what was worked out is of another piece.
            reimport_from(session, path)
            return
        window = editor_of(session).window
        from widgets.dialogs.reimport_midi import ReimportDialog

        dialog = ReimportDialog(
            project,
            outcome,
            shown(path.name),
            correction_title,
            lambda part_id, note: note_text(session, note, _who_plays(project, part_id)),
            session.tokens,
            window,
        )
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.accepted.connect(lambda: _take(session, project, outcome))
        dialog.open()

    def failed(error: AppError) -> None:
        session.notice(error.message, Severity.ERROR)

    session.tasks.run(Message("work.reimport"), work, done, failed, key="reimport")


def _who_plays(project: Project, part_id: str) -> Player | None:
    return next((player for player in project.players if player.part_id == part_id), None)


def _take(session: Session, before: Project, outcome: Reimport) -> None:
    if session.project is before:
        session.apply(Message("edit.reimport"), outcome.project)
        session.notice(
            Message("reimport.done", {"kept": sum(part.kept for part in outcome.parts), "lost": len(outcome.orphans)})
        )


def export_midi(session: Session) -> None:
    """Ask for a file, and write the piece to it as MIDI."""
    editor = editor_of(session)
    proposal = Path(editor.files.folder) / f"{editor.files.stem}.mid"
    kinds = f"{tr('files.midi_files')} (*.mid)"
    target = editor.questions.save_file(tr("files.export_midi"), str(proposal), kinds, MIDI_SUFFIXES)
    if target is None:
        return
    project = session.project

    def work(progress: Progress, stop_requested: StopRequested) -> tuple[Message, ...]:
        return write_piece(project, target, all_maps())

    def done(warnings: tuple[Message, ...]) -> None:
        if warnings:
            first = message_text(warnings[0], session)
            reported = Message("midi.written_but", {"file": target.name, "first": first, "count": len(warnings)})
            session.notice(reported, Severity.WARNING)
        else:
            session.notice(Message("midi.written", {"file": target.name, "count": len(project.score.parts)}))

    def failed(error: AppError) -> None:
        session.notice(error.message, Severity.ERROR)

    session.tasks.run(Message("work.export_midi"), work, done, failed, key="export_midi")


def export_files(session: Session) -> None:
    """Ask what to export, and write it."""
    editor = editor_of(session)
    folder = editor.settings.export_folder or str(Path(editor.files.folder) / "export")
    from widgets.dialogs.export_files import ExportDialog  # it brings all formats with it

    unreal = editor.settings.unreal_project
    dialog = ExportDialog(
        session,
        Path(folder),
        editor.files.name,
        f"Suisou {program_version()}",
        editor.window,
        Path(unreal) if unreal else None,
        "unreal" if unreal and editor.settings.export_into == "unreal" else "folder",
    )

    def remember(destination: str, place: Path) -> None:
        editor.settings.export_into = destination
        if destination == "unreal":
            editor.settings.unreal_project = str(place)
        else:
            editor.settings.export_folder = str(place)

    dialog.exported.connect(remember)
    dialog.show()


def playblast(session: Session) -> None:
    """Ask for a film of the viewport, and make it."""
    editor = editor_of(session)
    path = Path(editor.files.folder) / f"{editor.files.stem}.mp4"
    project = session.project
    from app.audio.mix import mixdown
    from widgets.dialogs.playblast import PlayblastDialog

    dialog = PlayblastDialog(
        session,
        editor.window.viewport.render_image,
        lambda start_s, end_s, rate: mixdown(project, start_s, end_s, rate),
        path,
        editor.window,
    )
    dialog.show()


def _can_export(session: Session) -> bool:
    return bool(session.project.players) and editor_of(session).files.is_open


def _can_film(session: Session) -> bool:
    return _can_export(session) and editor_of(session).window.viewport.has_gl


def _is_open(session: Session) -> bool:
    return editor_of(session).files.is_open


ACTIONS: tuple[Action, ...] = (
    Action(
        "file.reimport",
        read_again,
        "File",
        "Ctrl+Shift+I",
        enabled=_is_open,
    ),
    Action(
        "file.reimport_other",
        read_another,
        "File",
        enabled=_is_open,
    ),
    Action(
        "file.export_midi",
        export_midi,
        "File",
        enabled=_can_export,
    ),
    Action(
        "export.files",
        export_files,
        "Export",
        "Ctrl+E",
        enabled=_can_export,
        icon="export",
    ),
    Action(
        "export.playblast",
        playblast,
        "Export",
        "Ctrl+Shift+E",
        enabled=_can_film,
        icon="film",
    ),
)
