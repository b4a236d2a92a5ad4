"""The whole editor with a prepared session, for tests of actions."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
import pytest
import soundfile
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog, QLineEdit

from app.editor.design_tokens import DARK
from app.editor.selection import EventKey, Selection
from app.errors import Message
from app.plan.model import PlayerPlan
from app.project.edit.piece import set_audio, set_video
from app.project.edit.takes import add_takes, comp_whole
from app.project.model import Project
from app.project.performers import Player
from app.project.snap_grid import Grid
from app.score.model import Note, PercussionHit
from app.shell.app import Program
from tests.gui.conftest import QUARTET
from tests.support.films import written
from tests.support.takes import take_of
from widgets.common.actions import actions
from widgets.timeline.panel import TimelinePanel
from widgets.viewport.panel import ViewportPanel

if TYPE_CHECKING:
    from tests.gui.shell.conftest import Answers


class Desk:
    """The editor, the project before the action, and abbreviations for its content."""

    def __init__(self, program: Program, answers: Answers, folder: Path, patch: pytest.MonkeyPatch) -> None:
        self.program = program
        self.patch = patch
        self.session = program.session
        self.answers = answers
        self.folder = folder
        self.before: Project = self.session.project
        self.seen: dict[str, Any] = {}

    @property
    def project(self) -> Project:
        return self.session.project

    @property
    def player(self) -> Player:
        assert self.session.player is not None
        return self.session.player

    @property
    def plan(self) -> PlayerPlan:
        return self.session.performance.plan(self.player)

    @property
    def timeline(self) -> TimelinePanel:
        return self.program.window.timeline

    @property
    def viewport(self) -> ViewportPanel:
        return self.program.window.viewport

    def notes(self, project: Project | None = None) -> tuple[Note, ...]:
        """Notes of the player who was selected first before the action."""
        held = self.project if project is None else project
        return held.part(held.players[0]).notes

    def chosen(self) -> list[tuple[Note, Note | None]]:
        """Each selected note before the action with the same note after it (None if removed)."""
        after = {note.id: note for note in self.notes()}
        ids = self.seen["notes"]
        assert isinstance(ids, frozenset)
        return [(note, after.get(note.id)) for note in self.notes(self.before) if note.id in ids]

    def made(self, kind: type) -> list[object]:
        """Corrections of a kind that were added by the action."""
        old = self.before.corrections.get(self.before.players[0].id, ())
        return [
            item
            for item in self.project.corrections.get(self.before.players[0].id, ())
            if isinstance(item, kind) and item not in old
        ]

    def dialog(self, name: str) -> bool:
        """Return whether a dialog is open, and close it."""
        found = [
            widget for widget in QApplication.topLevelWidgets() if isinstance(widget, QDialog) and widget.isVisible()
        ]
        names = [widget.objectName() for widget in found]
        for widget in found:
            widget.close()
        return names == [name]

    def menu(self, *entries: str) -> bool:
        """Return whether a menu with these entries is open, and close it."""
        popup = QApplication.activePopupWidget()
        if popup is None:
            return False
        names = [action.objectName() for action in popup.actions()]
        popup.close()
        return set(entries) <= set(names)

    def settle(self) -> None:
        """Process deferred work of the window."""
        for _ in range(3):
            QApplication.processEvents()


Deed = Callable[[Desk], object]


def onset_s(desk: Desk, index: int) -> float:
    return desk.project.score.tempo_map.seconds(float(desk.notes()[index].onset_tick))


def dancing(desk: Desk) -> None:
    actions(desk.session)["dancers.add"].trigger()


def has_recording(desk: Desk) -> None:
    path = desk.folder / "tone.wav"
    if not path.exists():
        tone = 0.1 * np.sin(np.arange(22_050) * 0.1)
        soundfile.write(path, tone, 22_050)
    desk.session.attempt(Message("edit.set_audio"), lambda project: set_audio(project, path))


def has_video(desk: Desk) -> None:
    path = desk.folder / "film.mp4"
    if not path.exists():
        sound = 0.1 * np.sin(np.arange(48_000) * 0.1)
        written(path, Fraction(8), 8, np.stack([sound, sound], axis=1).astype(np.float32))
    desk.session.attempt(Message("edit.set_video"), lambda project: set_video(project, path))


def a_breath(desk: Desk) -> None:
    desk.session.select(Selection(events=frozenset({EventKey(desk.player.id, desk.plan.breaths[1].id)})))


def recorded(take_id: str, span: tuple[int, int] | None = None, alone: bool = False) -> Deed:
    """Record two takes, a second and a third above the part, and select one; optionally remove the other players."""

    def ready(desk: Desk) -> None:
        clock, player = desk.project.score.tempo_map, desk.player
        made = []
        for higher in (2, 4):
            # Each note is tongued: the breath falls before the next.
            notes = [
                (
                    clock.seconds(float(note.onset_tick)),
                    clock.seconds(note.onset_tick + 0.8 * note.duration_tick),
                    note.pitch + higher,
                    0.6,
                )
                for note in desk.notes()
            ]
            made.append(take_of(notes, tempo_map=clock))
        desk.session.attempt(Message("edit.comp_before"), lambda project: add_takes(project, player.id, made)[0])
        if alone:
            score = desk.project.score
            parts = tuple(
                part if part.id == player.part_id else msgspec.structs.replace(part, notes=()) for part in score.parts
            )
            score = msgspec.structs.replace(score, parts=parts)
            desk.session.apply(Message("edit.comp_before"), dataclasses.replace(desk.project, score=score))
        desk.session.select(Selection(span=span, take=take_id))

    return ready


def recorded_and_taken(desk: Desk) -> None:
    recorded("take:1")(desk)
    desk.session.attempt(
        Message("edit.comp_whole", {"take": "1"}), lambda project: comp_whole(project, desk.player.id, "take:1")
    )


def has_percussion(desk: Desk) -> None:
    score = msgspec.structs.replace(desk.project.score, percussion=(PercussionHit(0, 36, 90),))
    desk.session.attempt(Message("edit.piece_settings"), lambda project: dataclasses.replace(project, score=score))


def quieten(desk: Desk, looks: bool = True) -> None:
    """Stop the sound, close menus and dialogs and restore the initial view; language and theme only if ``looks`` is
    true.
    """
    program, session = desk.program, desk.session
    if session.playback is not None:
        session.playback.stop()
    program.window.set_full_screen(False)
    while (popup := QApplication.activePopupWidget()) is not None:
        popup.close()
    for widget in QApplication.topLevelWidgets():
        if isinstance(widget, QDialog) and widget.isVisible():
            widget.close()
    field = QApplication.focusWidget()
    if isinstance(field, QLineEdit):
        # Cancel any text being typed.
        QTest.keyClick(field, Qt.Key.Key_Escape)
    if looks:
        program.editor.speak("en")
        session.set_tokens(DARK)
    session.pitch_display.set(written=False, middle_c_octave=4, names="letters")
    session.set_time_display("bars")
    session.listening.set(source="recording", speed=1.0, percussion=True)
    session.viewport.set_posing(False)
    session.set_grid(Grid())
    session.set_loop(None)
    desk.answers.answer, desk.answers.path = "discard", None
    for dock in program.window.docks.values():
        dock.show()
    desk.answers.asked.clear()


def afresh(desk: Desk, opened: Project | None) -> Project:
    """Restore the initial state with some notes selected."""
    program, session = desk.program, desk.session
    quieten(desk)
    if session.project is not opened and session.document.done and session.document.done[0].before is opened:
        while session.document.undo() is not None:
            pass
    if opened is None or session.project is not opened or program.editor.files.path is not None:
        program.editor.files.open(QUARTET, ask=False)
    session.document._undone.clear()
    desk.answers.asked.clear()
    desk.seen.clear()
    session.set_players((session.project.players[0].id,))
    session.set_loop(None)
    notes = desk.notes()
    session.select(Selection(frozenset(note.id for note in notes[3:6])))
    session.set_playhead(onset_s(desk, 3))
    desk.seen["notes"] = session.selection.notes
    desk.settle()
    return session.project
