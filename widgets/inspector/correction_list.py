"""List of all manual changes of the selected players, each with position, generated value, and a button to revert."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QWidget

from app.editor.edit_names import edit_at
from app.editor.selection import EventKey, Selection
from app.editor.session import Session
from app.errors import Message
from app.plan.by_hand.corrections import Correction
from app.plan.by_hand.mark_corrections import OfMark, SetMark
from app.plan.model import Event, PlayerPlan
from app.project.edit import events as edit
from app.project.edit.corrections import take_back
from app.project.model import Project
from app.project.orphans import orphaned, reattached
from app.project.performers import Player
from widgets.common.controls import Button, Caption, PictureButton, Retranslated, named, wrapped
from widgets.common.layouts import in_column, in_row
from widgets.common.text import message_text
from widgets.inspector.generated_values import Generated
from widgets.inspector.rows import LineList, ListRow
from widgets.inspector.words import correction_title, event_text, mark_text

LATE_TICK = 2**62
_STRETCHES: Final = {
    "vary": "correction_list.regenerated",
    "additive": "correction_list.curve_up_to",
}
"""Texts of corrections without events, by tag."""


@dataclass(frozen=True)
class CorrectionRow:
    """A row of the list: a correction, its event or note in the plan, and the generated value."""

    player_id: str
    correction: Correction
    event: Event | None
    generated: Event | None
    orphan: bool


class CorrectionList(Retranslated, QWidget):
    """List of the corrections of the selected players; those whose note no longer exists come first."""

    def __init__(self, session: Session, generated: Generated, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._generated = session, generated
        self.list = named(LineList(session), "correction_list")
        self._empty = wrapped(Caption("correction_list.empty"))
        self._empty.setMargin(12)
        self._empty.setAlignment(Qt.AlignmentFlag.AlignTop)
        revert = ("correction_list.revert", self._revert_selected, "revert_selected")
        self._revert = PictureButton(session, "reset", *revert, "correction_list.revert_selected_tip")
        everything = ("correction_list.revert_all", self._revert_players, "revert_player")
        self._revert_all = PictureButton(session, "reset", *everything, "correction_list.revert_all_tip")
        self._attach = Button(
            "correction_list.re_attach_to_selected_note",
            self._reattach,
            "reattach",
            "correction_list.attach_tip",
        )
        buttons = in_row((self._revert, 1), (self._revert_all, 1), margins=6, spacing=4)
        attach = in_row(self._attach, margins=(6, 6, 6, 0))
        in_column((self.list, 1), (self._empty, 1), attach, buttons, of=self, margins=0, spacing=0)
        self.list.opened.connect(self._open)
        self.list.deleted.connect(self._revert_selected)
        self.list.selectionModel().selectionChanged.connect(self._show_buttons)
        generated.changed.connect(self.show_corrections)
        session.performance_changed.connect(self.show_corrections)
        session.players_changed.connect(self.show_corrections)
        session.selection_changed.connect(self._show_buttons)
        session.theme_changed.connect(self.show_corrections)
        self.retranslate()

    # Display

    def show_corrections(self) -> None:
        """Update the list of corrections, if it is visible."""
        if not self.isVisible():
            return
        project, plans = self._session.project, self._session.plans
        lost = {(orphan.player_id, orphan.correction) for orphan in orphaned(project)}
        places: list[CorrectionRow] = []
        for player_id in self._session.players:
            places += self._places(project.player(player_id), plans.get(player_id), lost)
        places.sort(key=lambda place: (not place.orphan, self._tick(place)))
        several = len(self._session.players) > 1
        self.list.lines.show_lines([self._line(place, several) for place in places])
        self.list.setVisible(bool(places))
        self._empty.setVisible(not places)
        self._show_buttons()

    def _places(
        self, player: Player, plan: PlayerPlan | None, lost: set[tuple[str, Correction]]
    ) -> list[CorrectionRow]:
        corrections = self._session.project.corrections.get(player.id, ())
        if not corrections:
            return []
        events = edit.events_of(plan) if plan is not None else {}
        bare = self._generated.plan(player.id)
        before = edit.events_of(bare) if bare is not None else {}
        known = edit.events_of(plan) if plan is not None else {}
        places = []
        for item in corrections:
            id, former = item.about, item.left_out or item.about
            orphan = (player.id, item) in lost or (
                plan is not None
                and hasattr(item, "event_id")
                and id not in known
                and former not in before
                and bare is not None
            )
            places.append(CorrectionRow(player.id, item, events.get(id), before.get(former), orphan))
        return places

    def _tick(self, place: CorrectionRow) -> int:
        event = place.event or place.generated
        if isinstance(place.correction, OfMark) and place.correction.note_id is not None:
            part = self._session.project.part(self._session.project.player(place.player_id))
            onsets = (note.onset_tick for note in part.notes if note.id == place.correction.note_id)
            return next(onsets, LATE_TICK)
        start: int | None = getattr(event if place.correction.has_event else place.correction, "start_tick", None)
        if start is not None:
            return start
        return LATE_TICK if event is None else round(self._session.project.score.tempo_map.ticks(event.start_s))

    def _line(self, place: CorrectionRow, several: bool) -> ListRow:
        score, player = self._session.project.score, self._session.project.player(place.player_id)
        title = correction_title(place.correction, player.instrument_id)
        if several:
            title = f"{player.name}: {title}"
        if place.orphan:
            detail = self.tr("correction_list.inactive_tip")
            return ListRow(place, title, "", detail, self._session.colour(player), "warning")
        tick = self._tick(place)
        where = score.metre_map.label(tick) if tick != LATE_TICK else ""
        if isinstance(place.correction, OfMark):
            detail = self._mark(place.correction, player)
        else:
            detail = self._change(place) if place.correction.has_event else self._stretch(place.correction)
        return ListRow(place, title, where, detail, self._session.colour(player), "by_hand")

    def _mark(self, item: OfMark, player: Player) -> str:
        """Return the description of a mark set by hand and of the score's mark that it replaces, or of a removed
        mark.
        """
        if not isinstance(item, SetMark):
            return self.tr("correction_list.mark_removed")
        project = self._session.project
        part = project.part(player)
        text = mark_text(project.score, part, item.mark)
        read = next((mark for mark in part.marks if mark.id == item.anchor), None)
        if read is not None:
            before = mark_text(project.score, part, read)
            return self.tr("correction_list.mark_instead").format(yours=text, before=before)
        return self.tr("correction_list.added_as" if text else "correction_list.added").format(yours=text)

    def _stretch(self, item: Correction) -> str:
        """Return a text about a correction's span: its end, and the number of its keys if it is a curve."""
        end = self._session.project.metre_map.label(getattr(item, "end_tick", LATE_TICK))
        detail = self.tr(_STRETCHES[item.tag]).format(end=end, count=len(getattr(item, "keys", ())))
        return detail if getattr(item, "enabled", True) else self.tr("correction_list.curve_off").format(detail=detail)

    def _change(self, place: CorrectionRow) -> str:
        """Return a text about a correction's present and generated event."""
        score = self._session.project.score
        instrument_id, events = (
            self._session.project.player(place.player_id).instrument_id,
            (place.event, place.generated),
        )
        now, before = (event_text(score, event, instrument_id, place.correction) for event in events)
        if place.generated is None:
            return self.tr("correction_list.added_as" if now else "correction_list.added").format(yours=now)
        reason: Message | None = getattr(place.generated, "reason", None)
        told = "" if reason is None else message_text(reason, self._session, place.player_id)
        detail = self.tr("correction_list.generated").format(before=before, reason=told)
        return self.tr("correction_list.yours").format(now=now, generated=detail) if now and now != before else detail

    def _show_buttons(self, *_: object) -> None:
        chosen = [key for key in self.list.selected_keys() if isinstance(key, CorrectionRow)]
        self._revert.setEnabled(bool(chosen))
        self._revert_all.setEnabled(bool(self.list.lines.lines))
        lost = [place for place in chosen if place.orphan]
        self._attach.setVisible(any(_place(line).orphan for line in self.list.lines.lines))
        self._attach.setEnabled(len(lost) == 1 and len(self._session.selection.notes) == 1)

    # Actions

    def _open(self, key: object) -> None:
        assert isinstance(key, CorrectionRow)
        item, event = key.correction, key.event or key.generated
        if item.event_kind in ("fingering", "embouchure"):
            self._session.select(Selection(notes=frozenset((item.anchor,))))
        elif not item.has_event:
            self._session.select(Selection(events=frozenset((EventKey(key.player_id, item.about),))))
            if (tick := self._tick(key)) != LATE_TICK:
                self._session.reveal(self._session.project.score.tempo_map.seconds(float(tick)))
        elif key.event is not None:
            self._session.select(Selection(events=frozenset((EventKey(key.player_id, key.event.id),))))
        if event is not None:
            self._session.reveal(event.start_s)

    def _revert_selected(self) -> None:
        chosen = [key for key in self.list.selected_keys() if isinstance(key, CorrectionRow)]
        if not chosen:
            return

        def reverted(project: Project) -> Project:
            for place in chosen:
                project = take_back(project, place.player_id, (place.correction,))
            return project

        places = [tick for tick in map(self._tick, chosen) if tick != LATE_TICK]
        players = {key.player_id for key in chosen}
        self._session.attempt(edit_at(self._session.project, "edit.give_back", len(chosen), players, places), reverted)

    def _revert_players(self) -> None:
        chosen = self._session.players
        names = ", ".join(self._session.project.player(player_id).name for player_id in chosen[:3])

        def reverted(project: Project) -> Project:
            for player_id in chosen:
                project = edit.give_back_player(project, player_id)
            return project

        self._session.attempt(Message("edit.give_back_player", {"player": names}), reverted)

    def _reattach(self) -> None:
        lost = [key for key in self.list.selected_keys() if isinstance(key, CorrectionRow) and key.orphan]
        notes = tuple(self._session.selection.notes)
        if len(lost) == 1 and len(notes) == 1:
            place = lost[0]
            self._session.attempt(
                Message("edit.reattach"),
                lambda project: reattached(project, place.player_id, place.correction, notes[0]),
            )

    # Texts

    def retranslate(self) -> None:
        self.show_corrections()

    # Qt overrides

    def showEvent(self, event: QEvent) -> None:
        self.show_corrections()


def _place(line: ListRow) -> CorrectionRow:
    assert isinstance(line.key, CorrectionRow)
    return line.key
