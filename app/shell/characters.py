"""The dialogs for adding a character of the user's own from a file, changing and removing it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Final

import msgspec

from app.editor.edit_names import edit_of_players
from app.editor.session import Session, Severity
from app.editor.translated import tr
from app.encoding import shown
from app.errors import AppError, Message, Progress, StopRequested, shortened
from app.project.edit.players import change
from app.rig.characters.character_library import (
    MOST_TITLE,
    CharacterEntry,
    add_character,
    add_person,
    character_library,
    remove_character,
    write_entry,
)
from app.rig.characters.figure_build import has_odd_height
from app.rig.characters.load_character import read_character
from app.rig.characters.read_figure import SUFFIXES
from app.rig.figure import Figure
from app.rig.people.person import Person
from app.shell.editor import Editor
from widgets.common.instrument_name import character_name
from widgets.dialogs.character import CharacterDialog
from widgets.dialogs.character_draft import CharacterDraft, found_by_itself
from widgets.dialogs.characters import CharactersDialog
from widgets.dialogs.person import PersonDialog

PERSON_M: Final = 1.7
"""Height in metres that is proposed for a figure whose own height is impossible for a person."""


def show_characters(editor: Editor) -> None:
    """Open the list of the user's own characters, or bring the open list to the front."""

    def make() -> CharactersDialog:
        dialog = CharactersDialog(editor.session, editor.window)
        dialog.add_asked.connect(lambda: ask_for_character(editor))
        dialog.make_asked.connect(lambda: make_person(editor))
        dialog.edit_asked.connect(lambda id: edit_character(editor, id))
        dialog.remove_asked.connect(lambda id: remove(editor, id))
        dialog.dropped.connect(lambda path: bring_character(editor, path))
        return dialog

    editor.show_once(CharactersDialog, make)


def ask_for_character(editor: Editor) -> None:
    """Ask for the file of a character, and add it to the user's characters."""
    name = tr("files.characters")
    kinds = f"{name} ({' '.join(f'*{suffix}' for suffix in SUFFIXES)})"
    path = editor.questions.open_file(tr("files.add_character"), editor.files.folder, kinds)
    if path is not None:
        editor.settings.folder = str(path.parent)
        bring_character(editor, path)


def bring_character(editor: Editor, path: Path) -> None:
    """Read a character's file in the background, then open the dialog that assigns its joints and shapes."""
    session = editor.session

    def done(figure: Figure) -> None:
        height_m = PERSON_M if has_odd_height(figure) else 0.0
        draft = replace(found_by_itself(figure, _title(path)), height_m=height_m)
        dialog = _dialog(editor, path, figure, draft, give=True)
        dialog.agreed.connect(lambda draft, give: _keep(editor, path, draft, give))

    _read(session, path, done)


def edit_character(editor: Editor, id: str) -> None:
    """Open the dialog that changes the settings of one of the user's own characters."""
    source = character_library().sources.get(id)
    if source is None or source.entry is None:
        return
    entry, path = source.entry, source.path
    if entry.person is not None:
        _person_dialog(
            editor, entry.title or id, entry.person, lambda title, person: _change_person(editor, id, title, person)
        )
        return

    def done(figure: Figure) -> None:
        draft = CharacterDraft(entry.title or id, entry.joints, entry.morphs, entry.height_m, tuple(entry.hidden))
        dialog = _dialog(editor, path, figure, draft, give=False)
        dialog.agreed.connect(lambda draft, give: _change(editor, id, entry, draft))

    _read(editor.session, path, done)


def make_person(editor: Editor) -> None:
    """Open the dialog in which a new person is made by sliders from a person bundled with the program."""

    def keep(title: str, person: Person) -> None:
        try:
            add_person(person, title)
        except AppError as error:
            editor.session.notice(error.message, Severity.ERROR)
        else:
            editor.session.notice(Message("character.added", {"name": title}))
        editor.session.characters_saved.emit()

    _person_dialog(editor, "", None, keep)


def _person_dialog(editor: Editor, title: str, person: Person | None, agreed: Callable[[str, Person], None]) -> None:
    dialog = PersonDialog(editor.session, title, person, editor.window)
    dialog.agreed.connect(agreed)
    dialog.open()


def _change_person(editor: Editor, id: str, title: str, person: Person) -> None:
    try:
        write_entry(id, CharacterEntry(title=shortened(" ".join(title.split()), MOST_TITLE), person=person))
    except AppError as error:
        editor.session.notice(error.message, Severity.ERROR)
    editor.session.characters_saved.emit()


def remove(editor: Editor, id: str) -> None:
    """Remove one of the user's own characters after a confirmation."""
    session = editor.session
    project = session.project
    used = [player.name for player in project.players if player.character_id == id]
    used += [dancer.name for dancer in project.dancers if dancer.character_id == id]
    if not editor.questions.remove_character(character_name(id), tuple(used)):
        return
    try:
        remove_character(id)
    except AppError as error:
        session.notice(error.message, Severity.ERROR)
    session.characters_saved.emit()


def _read(session: Session, path: Path, done: Callable[[Figure], None]) -> None:
    def work(progress: Progress, stop_requested: StopRequested) -> Figure:
        # Turned to face forward, as when playing.
        return read_character(path).figure

    def failed(error: AppError) -> None:
        session.notice(error.message, Severity.ERROR)

    session.tasks.run(Message("work.character", {"file": path.name}), work, done, failed, key="character")


def _dialog(editor: Editor, path: Path, figure: Figure, draft: CharacterDraft, give: bool) -> CharacterDialog:
    session = editor.session
    names = [player.name for player in session.project.players if player.id in session.players]
    offered = ", ".join(names) if give and editor.files.is_open else ""
    dialog = CharacterDialog(session, path, figure, draft, offered, editor.window)
    dialog.open()
    return dialog


def _keep(editor: Editor, path: Path, draft: CharacterDraft, give: bool) -> None:
    """Copy a character's file into the user's folder of characters, and give the character to the selected players if
    requested.
    """
    session = editor.session
    chosen = session.players

    def work(progress: Progress, stop_requested: StopRequested) -> str:
        return add_character(path, draft.title, draft.joints, draft.morphs, draft.height_m, draft.hidden)

    def done(id: str) -> None:
        session.characters_saved.emit()
        known = {player.id for player in session.project.players}
        players = [player for player in chosen if player in known]
        if give and players:
            session.attempt(
                edit_of_players(session.project, "edit.player_character", players),
                lambda project: change(project, players, character_id=id),
            )
        else:
            session.notice(Message("character.added", {"name": draft.title}))

    def failed(error: AppError) -> None:
        session.notice(error.message, Severity.ERROR)

    session.tasks.run(
        Message("work.character_add", {"name": draft.title}), work, done, failed, key="character_add", writes=True
    )


def _change(editor: Editor, id: str, entry: CharacterEntry, draft: CharacterDraft) -> None:
    """Store the changed title, joints, morphs, height and hidden meshes of the user's character ``id``."""
    morphs = {face: dict(parts) for face, parts in draft.morphs.items()}
    title = shortened(" ".join(draft.title.split()), MOST_TITLE)
    now = msgspec.structs.replace(
        entry, title=title, joints=dict(draft.joints), morphs=morphs, height_m=draft.height_m, hidden=list(draft.hidden)
    )
    if now == entry:
        return
    try:
        write_entry(id, now)
    except AppError as error:
        editor.session.notice(error.message, Severity.ERROR)
    editor.session.characters_saved.emit()


def _title(path: Path) -> str:
    stem = shown(path.stem)
    return stem.replace("_", " ").strip() or stem
