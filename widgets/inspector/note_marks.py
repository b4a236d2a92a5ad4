"""Marks of the selected notes with their origins, and the tonguing of the first note."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Final, NamedTuple

from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QWidget

from app.editor.edit_names import edit_of_notes
from app.editor.session import Session
from app.errors import Message
from app.plan.model import PlayerPlan
from app.project.edit.corrections import take_back
from app.project.edit.marks import Origin, corrections_at, marks_at, player_marks, remove_marks, set_marks
from app.project.performers import Player
from app.score.marks import MARK, MARK_KINDS, WRITABLE, Mark
from app.score.model import Note
from widgets.common.chip import Chip
from widgets.common.clicks import on_click
from widgets.common.controls import Caption, IconButton, Retranslated, named, wrapped
from widgets.common.event_names import mark_name
from widgets.common.flow import FlowLayout
from widgets.common.layouts import in_column, in_row, panel
from widgets.common.menus import offer_actions
from widgets.common.plain import Label
from widgets.common.text import message_text
from widgets.inspector.by_hand import ByHandLine
from widgets.inspector.words import mark_text

MENU: Final = (*(f"marks.{kind}" for kind in WRITABLE), "", "marks.dynamic")
"""Actions of the menu that adds marks."""


class _Alike(NamedTuple):
    """Marks of one kind and text at the selected notes.

    Attributes
    ----------
    is_everywhere : bool
        Whether all selected notes have it.
    """

    marks: tuple[Mark, ...]
    origins: frozenset[Origin]
    is_everywhere: bool


class NoteMarks(Retranslated, QWidget):
    """Shows, adds and removes marks of the selected notes."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._shown: tuple[Player, tuple[Note, ...]] | None = None
        self._kinds: Mapping[tuple[str, str], _Alike] = {}
        self._chips = FlowLayout()
        self._chip_of: dict[tuple[str, str], Chip] = {}
        self._title, self._tongued = Caption("note_marks.marks"), wrapped(named(Label(), "note_tongue"))
        self._add = IconButton(session, "add", "note_marks.add_mark", self._offer, "add_mark")
        self._by_hand = named(ByHandLine(session), "marks_by_hand")
        self._by_hand.reverted.connect(self._revert)
        head = in_row((self._title, 1), self._add, margins=0, spacing=4)
        chips = named(panel(self._chips), "mark_chips")
        in_column(head, chips, self._by_hand, self._tongued, of=self, margins=(0, 4, 0, 0), spacing=4)
        session.theme_changed.connect(self._apply_theme)
        self._apply_theme()

    def show_marks(self, player: Player, notes: tuple[Note, ...], plan: PlayerPlan) -> None:
        """Show the marks of a player's notes, in order."""
        self._shown = player, notes
        project = self._session.project
        part = project.part(player)
        origins = player_marks(project, player.id)
        order = {note.id: place for place, note in enumerate(part.notes)}
        self._kinds = _alike(marks_at(origins, notes, order), origins, notes)
        for key in self._chip_of.keys() - self._kinds.keys():
            self._chip_of[key].hide()
        for key, alike in self._kinds.items():
            kind, text = key
            until = mark_text(project.score, part, alike.marks[0]) if len(alike.marks) == 1 and not text else ""
            chip = self._chip(key)
            chip.show_text(text or mark_name(kind), until)
            chip.show()
            chip.show_state(alike.is_everywhere, "hand" in alike.origins, outlined="score" in alike.origins)
            chip.setToolTip("\n".join(self.tr(f"note_marks.origin.{origin}") for origin in sorted(alike.origins)))
        self._show_by_hand(player, notes, order)
        reasons = {event.note_id: event.reason for event in plan.tongues}
        reason = reasons.get(notes[0].id)
        slurred = self.tr("note_marks.slurred_to")
        told = slurred if reason is None else message_text(reason, self._session, player.id)
        self._tongued.setText(self.tr("note_marks.tongue").format(reason=told))

    def _chip(self, key: tuple[str, str]) -> Chip:
        """Return the chip for a kind and text of marks; unused chips are hidden and reused, so that the keyboard focus
        stays.
        """
        chip = self._chip_of.get(key)
        if chip is None:
            chip = self._chip_of[key] = named(Chip(self._session, ""), f"mark_{key[0]}")
            on_click(chip, self._toggle, key)
            self._chips.addWidget(chip)
        return chip

    def _show_by_hand(self, player: Player, notes: tuple[Note, ...], order: Mapping[str, int]) -> None:
        project = self._session.project
        if not corrections_at(project, player.id, {note.id for note in notes}):
            self._by_hand.hide()
            return
        read = marks_at(project.part(player).marks, notes, order)
        now = marks_at(player_marks(project, player.id), notes, order)
        self._by_hand.show_values(_named(read), _named(now) or self.tr("note_marks.none"))

    def _offer(self) -> None:
        at = self._add.mapToGlobal(QPoint(0, self._add.height()))
        offer_actions(self._session, MENU, self, "marks_menu", at)

    def _toggle(self, key: tuple[str, str]) -> None:
        """Remove a mark if all selected notes have it; otherwise add it to the others."""
        if self._shown is None:
            return
        (player, notes), alike = self._shown, self._kinds[key]
        name = key[1] or f"{MARK}.{key[0]}"
        if alike.is_everywhere:
            self._session.attempt(
                Message("edit.remove_mark", {"mark": name}),
                lambda project: remove_marks(project, player.id, alike.marks),
            )
            return
        marks = [Mark(key[0], note.id, text=key[1]) for note in notes]
        self._session.attempt(
            Message("edit.add_mark", {"mark": name}), lambda project: set_marks(project, player.id, marks)
        )

    def _revert(self) -> None:
        if self._shown is None:
            return
        player, ids = self._shown[0], {note.id for note in self._shown[1]}
        self._session.attempt(
            edit_of_notes(self._session.project, "edit.give_back", ids, (player.id,)),
            lambda project: take_back(project, player.id, corrections_at(project, player.id, ids)),
        )

    def _apply_theme(self) -> None:
        for label in (self._title, self._tongued):
            label.setStyleSheet(f"color: {self._session.tokens.text_dim};")


def _alike(
    marks: Collection[Mark], origins: Mapping[Mark, Origin], notes: tuple[Note, ...]
) -> dict[tuple[str, str], _Alike]:
    """Return the marks grouped by kind and text, with their origin."""
    groups: dict[tuple[str, str], list[Mark]] = {}
    for mark in marks:
        groups.setdefault((mark.kind, mark.text), []).append(mark)
    found = {}
    for key, group in groups.items():
        single = MARK_KINDS[key[0]].anchor == "note"
        everywhere = not single or {mark.note_id for mark in group} >= {note.id for note in notes}
        found[key] = _Alike(tuple(group), frozenset(origins[mark] for mark in group), everywhere)
    return found


def _named(marks: Collection[Mark]) -> str:
    """Return the names of musical marks, each once, separated by commas."""
    return ", ".join(dict.fromkeys(mark.text if mark.kind == "dynamic" else mark_name(mark.kind) for mark in marks))
