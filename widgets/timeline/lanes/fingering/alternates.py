"""Row of chips with all fingerings of a note beside it."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QPoint, QSize, Qt
from PySide6.QtGui import QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QApplication, QFrame, QMenu, QPushButton

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.edit_names import edit_at_events, edit_of_notes
from app.editor.selection import EventKey
from app.editor.session import Session
from app.plan.model import FingeringEvent
from app.project.edit.events import corrections_of, give_back, pin_fingerings
from instrument_maps.fingering_words import fingering_words
from instrument_maps.model import Fingering, InstrumentMap
from widgets.common.clicks import on_click
from widgets.common.controls import named
from widgets.common.fingering_chip import FingeringChip
from widgets.common.fingering_tags import words_of_tags
from widgets.common.icons import icon
from widgets.common.instrument_name import language
from widgets.common.layouts import in_column, in_row
from widgets.common.plain import Label, verbatim
from widgets.timeline.lane import Lane


class Alternates(QFrame):
    """Popup with a row of chips, not modal, closed by a click elsewhere or by Escape."""

    def __init__(self, session: Session, lane: Lane) -> None:
        super().__init__(lane)
        self.setObjectName("alternates")
        self.setFrameShape(QFrame.Shape.StyledPanel)
        self.setAutoFillBackground(True)
        self._session = session
        self._lane = lane
        self.event_shown: FingeringEvent | None = None
        self.player_id = ""
        self._why = named(Label(parent=self), "why")
        self._row = in_row(margins=0, spacing=3)
        in_column(self._why, self._row, of=self, margins=4, spacing=3)
        self.hide()

    def choices(self, player_id: str, event: FingeringEvent) -> tuple[Fingering, ...]:
        """Every fingering of a note's pitch in the instrument's map, first choice first."""
        project = self._session.project
        notes = project.part(project.player(player_id)).notes
        note = next((note for note in notes if note.id == event.note_id), None)
        return () if note is None else self._instrument(player_id).offered_for(note.pitch, event.label)

    def _instrument(self, player_id: str) -> InstrumentMap:
        return self._session.performance.instrument(self._session.project.player(player_id))

    def note_text(self, fingering: Fingering) -> str:
        """Return the notes beside a fingering's label: deviation in cents, and tags."""
        parts = [f"{fingering.cents:+.0f} ¢".replace("-", "−")] if round(fingering.cents) else []
        return " · ".join([*parts, *words_of_tags(fingering.tags)])

    def is_pinned(self, player_id: str, event: FingeringEvent) -> bool:
        """True if the user chose the fingering of the event."""
        return bool(corrections_of(self._session.project, player_id, (event.id,)))

    def show_for(self, player_id: str, event: FingeringEvent, place: QPoint, why: str = "") -> None:
        """Show the chips of a note above a point of the window, with an explanation if given."""
        self._why.setText(why)
        self._why.setVisible(bool(why))
        while (item := self._row.takeAt(0)) is not None:
            if (widget := item.widget()) is not None:
                widget.hide()
                widget.deleteLater()
        self.event_shown, self.player_id = event, player_id
        pinned = self.is_pinned(player_id, event)
        instrument = self._instrument(player_id)
        for fingering in self.choices(player_id, event):
            now, note = fingering.label == event.label, self.note_text(fingering)
            chip = FingeringChip(self._session, instrument, fingering, note, self)
            chip.show_state(now, by_hand=now and pinned, outlined=now and not pinned)
            choice = self.tr("alternates.choice").format(rank=fingering.rank)
            chip.setToolTip(f"{chip.text()}\n{choice}")
            on_click(chip, self.choose, fingering.label)
            self._row.addWidget(chip)
            # In a visible row Qt would show it later and reserve no room until then.
            chip.show()
        if pinned:
            back = named(
                QPushButton(icon("reset", self._session.tokens), self.tr("alternates.generated"), self), "give_back"
            )
            back.setFlat(True)
            back.setMinimumHeight(LEAST_TARGET_PX)
            back.setIconSize(QSize(16, 16))
            back.setToolTip(self.tr("alternates.revert_tip"))
            on_click(back, self.give_back)
            self._row.addWidget(back)
            back.show()
        self._row.addStretch(1)
        window = self._lane.window()
        self.setParent(window)
        self.adjustSize()
        self.resize(self.sizeHint())
        x = min(max(place.x(), 2), max(window.width() - self.width() - 2, 2))
        y = place.y() - self.height() - 2
        self.move(x, y if y >= 0 else min(place.y() + self._lane.height() + 2, window.height() - self.height()))
        self.show()
        self.raise_()
        application = QApplication.instance()
        if application is not None:
            application.installEventFilter(self)

    def take_focus(self) -> None:
        """Give the chips the keyboard focus: Tab moves, Space selects."""
        chips = self.findChildren(FingeringChip)
        chosen = next((chip for chip in chips if chip.isChecked() and chip.isVisible()), None)
        if chosen is not None:
            chosen.setFocus(Qt.FocusReason.TabFocusReason)

    def choose(self, label: str) -> None:
        """Pin a fingering for the note, and for every other selected note that can be played with it."""
        if self.event_shown is None:
            return
        player_id, shown = self.player_id, self.event_shown.note_id
        self.hide()
        player = self._session.project.player(player_id)
        instrument = self._session.performance.instrument(player)
        selected = self._session.selection.notes | {shown}
        labels = {
            note.id: label
            for note in self._session.project.part(player).notes
            if note.id in selected and label in {item.label for item in instrument.fingerings_for(note.pitch)}
        }
        self._session.attempt(
            edit_of_notes(self._session.project, "edit.pin_fingerings", labels, (player_id,)),
            lambda project: pin_fingerings(project, player_id, labels),
        )

    def give_back(self) -> None:
        """Remove the pin, so that the fingering is generated."""
        if self.event_shown is None:
            return
        event_id, player_id = self.event_shown.id, self.player_id
        self.hide()
        self._session.attempt(
            edit_at_events(self._session, "edit.give_back", (EventKey(player_id, event_id),)),
            lambda project: give_back(project, player_id, (event_id,)),
        )

    def fill_menu(self, menu: QMenu, player_id: str, event: FingeringEvent) -> None:
        """Add the alternative fingerings of a note to a menu as entries that choose them."""
        instrument = self._instrument(player_id)
        for fingering in self.choices(player_id, event):
            note, words = self.note_text(fingering), fingering_words(instrument, fingering.label, language())
            entry = menu.addAction(verbatim(f"{words}   {note}" if note else words))
            entry.setCheckable(True)
            entry.setChecked(fingering.label == event.label)
            on_click(entry, self._choose_from_menu, player_id, event, fingering.label)

    def _choose_from_menu(self, player_id: str, event: FingeringEvent, label: str) -> None:
        self.player_id, self.event_shown = player_id, event
        self.choose(label)

    # Qt overrides

    def hideEvent(self, event: QEvent) -> None:
        application = QApplication.instance()
        if application is not None:
            application.removeEventFilter(self)
        if self.isAncestorOf(QApplication.focusWidget() or self._lane):
            self._lane.plot.setFocus()
        super().hideEvent(event)  # type: ignore[arg-type]

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QMouseEvent) and event.type() == QEvent.Type.MouseButtonPress:
            if not self.rect().contains(self.mapFromGlobal(event.globalPosition().toPoint())):
                self.hide()
        elif isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress and event.key() == Qt.Key.Key_Escape:
            self.hide()
            return True
        return super().eventFilter(watched, event)
