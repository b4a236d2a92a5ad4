"""Section with the selected notes: pitch and time, fingering with reason, embouchure, and problems."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtWidgets import QGridLayout, QWidget

from app.editor.edit_names import edit_of_notes
from app.editor.session import Session
from app.plan.by_hand.corrections import PinFingering, SetEmbouchure
from app.plan.model import FingeringEvent, PlayerPlan
from app.project.edit import events as edit_events
from app.project.edit import notes as edit_notes
from app.project.edit.players import instrument_of
from app.project.model import Project
from instrument_maps.fingering_label import says_words
from instrument_maps.fingering_words import fingering_words
from instrument_maps.model import Fingering, InstrumentMap
from widgets.common.clicks import on_click
from widgets.common.controls import Caption, Retranslated, named
from widgets.common.fingering_chip import FingeringChip
from widgets.common.fingering_diagram import FingeringDiagram
from widgets.common.flow import FlowLayout
from widgets.common.instrument_name import language
from widgets.common.layouts import in_column, panel
from widgets.common.number_slider import NumberSlider
from widgets.common.pitch import pitch_from, pitch_text
from widgets.common.plain import Label
from widgets.common.section import Section
from widgets.common.text import message_text, sentence
from widgets.inspector.by_hand import ByHandLine
from widgets.inspector.generated_values import Generated
from widgets.inspector.inspected_selection import NoteFinder, SelectedNotes, embouchure_of, fingering_of, selected_notes
from widgets.inspector.note_marks import NoteMarks

LATEST_TICK = float(2**31 - 1)
EMBOUCHURE = ("tension", "effort", "air")
_WORDS: Final = {
    "pitch": ("note_section.pitch", "", "note_section.name_or_midi_number_several"),
    "onset": ("note_section.bar", "", "note_section.bar_beat_ticks_several_notes"),
    "length": ("note_section.length", "note_section.beats", "note_section.in_beats_of_metre"),
    "velocity": ("note_section.velocity", "", "note_section.velocity_tip"),
    "tension": ("note_section.tension", "", "note_section.lips_tip"),
    "effort": ("note_section.effort", "", "note_section.effort_tip"),
    "air": ("note_section.air", "", "note_section.air_flow_tip"),
}
"""Text ids of label, unit and tool tip of each number."""


class NoteSection(Retranslated, QWidget):
    """Shows and edits the selected notes.

    Signals
    -------
    diagram_placed()
        Position or size of the fingering diagram has changed.
    """

    diagram_placed = Signal()

    def __init__(self, session: Session, generated: Generated, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._generated = session, generated
        self._finder = NoteFinder()
        self._shown: SelectedNotes | None = None
        self._section = Section(session, "inspector_note", self)
        self._numbers = {
            "pitch": NumberSlider(session, 0, 127, decimals=0, step=1, slides=False, resets=False),
            "onset": NumberSlider(session, 0, LATEST_TICK, decimals=0, step=30, slides=False, resets=False),
            "length": NumberSlider(session, 0.001, 100_000, decimals=3, step=0.125, slides=False, resets=False),
            "velocity": NumberSlider(session, 1, 127, decimals=0, step=1, resets=False),
        }
        self._lips = {name: named(NumberSlider(session, 0, 1, step=0.05), f"embouchure_{name}") for name in EMBOUCHURE}
        for name, number in (self._numbers | self._lips).items():
            self.texted(number, words=_WORDS[name])
        self._diagram = self.texted(
            named(FingeringDiagram(session), "fingering_diagram"), name="note_section.fingering_diagram"
        )
        self._chips = FlowLayout()
        self._chips_shown: tuple[object, ...] = ()
        self._chip_of: dict[str, FingeringChip] = {}
        self._fingering_title, self._lips_title = Caption("note_section.fingering"), Caption("note_section.embouchure")
        self._why, self._problems = Label(), Label()
        self._fingering_by_hand = named(ByHandLine(session), "fingering_by_hand")
        self._lips_by_hand = named(ByHandLine(session), "embouchure_by_hand")
        self._marks = named(NoteMarks(session), "note_marks")
        self._build()
        self._connect()
        self.retranslate()

    def _build(self) -> None:
        grid = QGridLayout()
        grid.setSpacing(4)
        for number, (name, slider) in enumerate(self._numbers.items()):
            grid.addWidget(named(slider, f"note_{name}"), number // 2, number % 2)
        body = self._section.body
        body.addLayout(grid)
        self._chips_box = named(panel(self._chips), "fingering_chips")
        fingering = (self._fingering_title, self._diagram, self._chips_box, self._fingering_by_hand, self._why)
        self._fingering = panel(in_column(*fingering, margins=(0, 4, 0, 0), spacing=4))
        body.addWidget(self._fingering)
        body.addWidget(self._marks)
        lips = (self._lips_title, *self._lips.values(), self._lips_by_hand)
        self._lips_box = panel(in_column(*lips, margins=(0, 4, 0, 0), spacing=4))
        body.addWidget(self._lips_box)
        body.addWidget(self._problems)
        for label in (self._why, self._problems):
            label.setWordWrap(True)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        in_column(self._section, of=self, margins=0)

    def _connect(self) -> None:
        document = self._session.document
        self._diagram.placed.connect(self.diagram_placed)
        for slider in (*self._numbers.values(), *self._lips.values()):
            slider.released.connect(document.end_gesture)
        self._numbers["pitch"].changed.connect(self._set_pitch)
        self._numbers["pitch"].set_wording(self._pitch_text, self._pitch_from)
        self._numbers["onset"].changed.connect(self._set_onset)
        self._numbers["onset"].show_as_place()
        self._numbers["length"].changed.connect(self._set_length)
        self._numbers["velocity"].changed.connect(self._set_velocity)
        for name, slider in self._lips.items():
            slider.changed.connect(lambda value, token, name=name: self._set_lips(name, value, token))
            slider.reset.connect(lambda _, name=name: self._without(SetEmbouchure, name))
        self._fingering_by_hand.reverted.connect(lambda: self._without(PinFingering))
        self._lips_by_hand.reverted.connect(lambda: self._without(SetEmbouchure))
        self._session.theme_changed.connect(self._apply_theme)
        self._apply_theme()

    # Display

    @property
    def diagram_bottom_px(self) -> int:
        """Return the distance in pixels from the top of the section to the end of the fingering diagram; 0 without
        one.
        """
        end = QPoint(0, self._diagram.height() + 4)
        return self._diagram.mapTo(self, end).y() if self._diagram.isVisible() else 0

    def show_notes(self) -> bool:
        """Show the selected notes, and return whether there are any."""
        self._shown = selected_notes(self._session, self._finder)
        self.setVisible(self._shown is not None)
        if self._shown is None:
            return False
        self._show_numbers(self._shown)
        self._show_plan(self._shown)
        return True

    def _show_numbers(self, shown: SelectedNotes) -> None:
        note, notes, score = shown.note, shown.notes, self._session.project.score
        several = len(shown.note_ids)
        title = self.tr("note_section.note") if several == 1 else self.tr("note_section.notes").format(count=several)
        owner = shown.player.name if shown.player is not None else ""
        self._section.header.set_texts(title, owner)
        grid = self._session.grid.step_ticks(score.metre_map)
        self._numbers["onset"].set_step(float(grid) if grid > 1 else 1.0)
        beat = score.metre_map.beat_length(note.onset_tick)
        values = {
            "pitch": (float(note.pitch), {one.pitch for one in notes}),
            "onset": (float(note.onset_tick), {one.onset_tick for one in notes}),
            "length": (note.duration_tick / beat, {one.duration_tick for one in notes}),
            "velocity": (float(note.velocity), {one.velocity for one in notes}),
        }
        for name, (value, among) in values.items():
            mixed = len(among) > 1 and name not in ("pitch", "onset")
            self._numbers[name].show_value(value, mixed=mixed, by_hand=False)

    def _show_plan(self, shown: SelectedNotes) -> None:
        player = shown.player
        plan = self._session.plans.get(player.id) if player is not None else None
        instrument = instrument_of(player) if player is not None else None
        there = plan is not None and player is not None and instrument is not None
        self._fingering.setVisible(there)
        self._lips_box.setVisible(there)
        self._marks.setVisible(there)
        if plan is None or player is None or instrument is None:
            self._problems.setVisible(False)
            return
        bare = self._generated.plan(player.id)
        self._show_fingering(shown, plan, bare, instrument)
        self._marks.show_marks(player, shown.notes, plan)
        self._show_lips(shown, plan, bare)
        own_ids = frozenset(shown.own_ids)
        reported = [problem for problem in self._session.problems(player.id) if problem.note_id in own_ids]
        words = (sentence(problem.message, self._session, player.id) for problem in reported[:5])
        self._problems.setText("\n".join(f"⚠ {text}" for text in words))
        self._problems.setVisible(bool(reported))

    def _show_fingering(
        self, shown: SelectedNotes, plan: PlayerPlan, bare: PlayerPlan | None, instrument: InstrumentMap
    ) -> None:
        event = fingering_of(plan, shown.note.id)
        self._fingering.setVisible(event is not None)
        if event is None:
            return
        made = fingering_of(bare, shown.note.id) if bare is not None else None
        same_pitch = len({note.pitch for note in shown.notes}) == 1
        offered = instrument.offered_for(shown.note.pitch, event.label) if same_pitch else ()
        self._make_chips(instrument, offered, event, made)
        self._chips_box.setVisible(same_pitch)
        self._diagram.show_fingering(instrument, event.controls)
        pinned = self._pin_label(shown)
        text_id, reason = "note_section.why", event.reason
        if pinned is not None and made is not None:
            text_id, reason = "note_section.generator", made.reason
        self._why.setText(self.tr(text_id).format(reason=message_text(reason, self._session, plan.player_id)))
        if pinned is not None:
            self._fingering_by_hand.show_values(
                None if made is None else _spaced(made.label, instrument), _spaced(pinned, instrument)
            )
        else:
            self._fingering_by_hand.hide()

    def _make_chips(
        self,
        instrument: InstrumentMap,
        fingerings: tuple[Fingering, ...],
        event: FingeringEvent,
        made: FingeringEvent | None,
    ) -> None:
        shown = (instrument.id, *((fingering.label, fingering.cents) for fingering in fingerings))
        if shown != self._chips_shown:
            # Chips are reused, so that the focus stays.
            self._chips_shown = shown
            self._chips.clear()
            self._chip_of = {
                one.label: FingeringChip(self._session, instrument, one, _cents_text(one.cents)) for one in fingerings
            }
            for label, chip in self._chip_of.items():
                on_click(chip, self._pin, label)
                self._chips.addWidget(chip)
        for fingering in fingerings:
            chosen = fingering.label == event.label
            chip = self._chip_of[fingering.label]
            words = fingering_words(instrument, fingering.label, language())
            chip.show_text(words, _cents_text(fingering.cents))
            generated = made is not None and fingering.label == made.label
            chip.show_state(chosen, chosen and event.corrected, outlined=generated)
            chip.setToolTip(chip.tip(generated))

    def _show_lips(self, shown: SelectedNotes, plan: PlayerPlan, bare: PlayerPlan | None) -> None:
        ids = frozenset(shown.own_ids)
        events = [event for event in plan.embouchures if event.note_id in ids]
        self._lips_box.setVisible(bool(events))
        if not events:
            return
        first = next((event for event in events if event.note_id == shown.note.id), events[0])
        made = embouchure_of(bare, first.note_id) if bare is not None else None
        item = self._lips_correction(shown)
        for name, slider in self._lips.items():
            shown_as = round(getattr(first, name), 4)
            slider.show_value(
                getattr(first, name),
                mixed=any(round(getattr(event, name), 4) != shown_as for event in events),
                default=getattr(made or first, name),
                by_hand=item is not None and getattr(item, name) is not None,
            )
        if item is None:
            self._lips_by_hand.hide()
            return
        changed = [name for name in EMBOUCHURE if getattr(item, name) is not None]
        yours = " ".join(f"{getattr(first, name):.2f}" for name in changed)
        self._lips_by_hand.show_values(
            None if made is None else " ".join(f"{getattr(made, name):.2f}" for name in changed), yours
        )

    def _corrections(self, shown: SelectedNotes) -> tuple[object, ...]:
        return () if shown.player is None else self._session.project.corrections.get(shown.player.id, ())

    def _pin_label(self, shown: SelectedNotes) -> str | None:
        """Return the label of the fingering that is pinned to the displayed note, or else to another selected one; None
        if none is.

        The instrument may lack a fingering of that label.
        """
        ids = frozenset(shown.own_ids)
        pins = {
            item.note_id: item.label
            for item in self._corrections(shown)
            if isinstance(item, PinFingering) and item.note_id in ids
        }
        return pins.get(shown.note.id, next(iter(pins.values()), None))

    def _lips_correction(self, shown: SelectedNotes) -> SetEmbouchure | None:
        ids = frozenset(shown.own_ids)
        found = [item for item in self._corrections(shown) if isinstance(item, SetEmbouchure) and item.note_id in ids]
        return next((item for item in found if item.note_id == shown.note.id), found[0] if found else None)

    # Texts of numbers

    def _transposition(self) -> int:
        player = self._shown.player if self._shown is not None else None
        instrument = instrument_of(player) if player is not None else None
        return instrument.transposition_semitones if instrument is not None else 0

    def _pitch_text(self, value: float) -> str:
        return pitch_text(self._session.pitch_display, round(value), self._transposition())

    def _pitch_from(self, text: str) -> float | None:
        pitch = pitch_from(self._session.pitch_display, text, self._transposition())
        return None if pitch is None else float(pitch)

    # Editing

    def _edit(
        self, name: str, change: Callable[[Project, SelectedNotes], Project], token: object | None = None
    ) -> None:
        """Edit the displayed notes by a function as one undoable step named by the text id ``name``; steps with the
        same ``token`` are merged."""
        shown = self._shown
        if shown is None:
            return
        named = edit_of_notes(self._session.project, name, shown.note_ids)
        if not self._session.attempt(named, lambda project: change(project, shown), token):
            self.show_notes()

    def _edit_own(
        self, name: str, change: Callable[[Project, str, tuple[str, ...]], Project], token: object | None = None
    ) -> None:
        """Edit the displayed notes of one player by a function that gets the player's id and the notes' ids; see
        `_edit`.
        """
        if self._shown is None or self._shown.player is None:
            return
        player_id, ids = self._shown.player.id, self._shown.own_ids
        named = edit_of_notes(self._session.project, name, ids, (player_id,))
        if not self._session.attempt(named, lambda project: change(project, player_id, ids), token):
            self.show_notes()

    def _set_pitch(self, value: float, token: object | None) -> None:
        self._edit(
            "edit.transpose_notes",
            lambda project, shown: edit_notes.move(project, shown.note_ids, 0, round(value) - shown.note.pitch),
            token,
        )

    def _set_onset(self, value: float, token: object | None) -> None:
        self._edit(
            "edit.move_notes",
            lambda project, shown: edit_notes.move(project, shown.note_ids, round(value) - shown.note.onset_tick, 0),
            token,
        )

    def _set_length(self, value: float, token: object | None) -> None:
        def resized(project: Project, shown: SelectedNotes) -> Project:
            ticks = max(round(value * project.score.metre_map.beat_length(shown.note.onset_tick)), 1)
            for note in shown.notes:
                project = edit_notes.resize(project, (note.id,), ticks - note.duration_tick)
            return project

        self._edit("edit.resize_notes", resized, token)

    def _set_velocity(self, value: float, token: object | None) -> None:
        self._edit(
            "edit.change_velocity",
            lambda project, shown: edit_notes.set_velocity(project, shown.note_ids, round(value)),
            token,
        )

    def _pin(self, label: str) -> None:
        self._edit_own(
            "edit.pin_fingerings",
            lambda project, player_id, ids: edit_events.pin_fingerings(project, player_id, dict.fromkeys(ids, label)),
        )

    def _set_lips(self, name: str, value: float, token: object | None) -> None:
        self._edit_own(
            "edit.set_embouchure",
            lambda project, player_id, ids: edit_events.set_embouchure(project, player_id, ids, **{name: value}),
            token,
        )

    def _without(self, kind: type[PinFingering] | type[SetEmbouchure], field: str | None = None) -> None:
        """Remove corrections of a kind from the displayed notes; with ``field`` only one of their values."""
        self._edit_own(
            "edit.give_back",
            lambda project, player_id, ids: edit_events.forget(project, player_id, kind, frozenset(ids), field),
        )

    # Texts and pictures

    def _apply_theme(self) -> None:
        tokens = self._session.tokens
        self._problems.setStyleSheet(f"color: {tokens.warning};")
        for label in (self._why, self._fingering_title, self._lips_title):
            label.setStyleSheet(f"color: {tokens.text_dim};")

    def retranslate(self) -> None:
        self.show_notes()


def _cents_text(cents: float) -> str:
    """Return ``"+12¢"``; empty if a fingering is in tune."""
    return f"{cents:+.0f}¢".replace("-", "−") if round(cents) else ""


def _spaced(label: str, instrument: InstrumentMap) -> str:
    """Return a fingering's label as text: ``"13"`` as ``"1·3"`` for valves; keys and holes in words."""
    signs = {control.label for control in instrument.controls if control.label}
    if not says_words(instrument.controls) and len(label) > 1 and all(sign in signs for sign in label):
        return "·".join(label)
    return fingering_words(instrument, label, language())
