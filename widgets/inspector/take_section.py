"""Section with the selected take: name, time of recording, and conversion to notes."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

import msgspec
from PySide6.QtCore import QSize
from PySide6.QtWidgets import QLineEdit, QToolButton, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.grids import GRIDS
from app.editor.session import Session
from app.errors import Message
from app.project.edit.placed_takes import take_cleaned
from app.project.edit.takes import colour_take, rename_take, set_cleaning
from app.project.limits import CLEANING
from app.project.performers import Player
from app.score.take import Cleaning, Take
from widgets.common.actions import actions
from widgets.common.combo import Combo, Option
from widgets.common.controls import Button, Retranslated, named, wrapped
from widgets.common.layouts import STRETCH, in_column, in_row
from widgets.common.number_slider import NumberSlider
from widgets.common.plain import Label
from widgets.common.section import Section
from widgets.common.swatch import ColourSwatch
from widgets.common.take_times import when_text

BUTTONS: Final = ("takes.listen", "takes.listen_alone", "takes.whole", "takes.remove")


@dataclass(frozen=True)
class _Number:
    """Settings of a slider for one number of the cleaning: ``scale`` is the factor from the value to the displayed
    number.
    """

    field: str
    scale: float
    most: float
    step: float
    text_id: str
    tip_id: str


NUMBERS: Final = (
    _Number(
        "ghost_s",
        1000.0,
        300.0,
        5.0,
        "take_section.ghost_notes_shorter_than",
        "take_section.least_note_tip",
    ),
    _Number(
        "ghost_loudness", 100.0, 100.0, 1.0, "take_section.and_softer_than", "take_section.soft_breath_stays_below_this"
    ),
    _Number(
        "double_s",
        1000.0,
        100.0,
        5.0,
        "take_section.doubled_notes_within",
        "take_section.merge_repeats_tip",
    ),
    _Number(
        "overlap_s",
        1000.0,
        100.0,
        5.0,
        "take_section.most_legato_overlap",
        "take_section.note_that_sounds_longer_into",
    ),
    _Number("quantise", 100.0, 100.0, 5.0, "take_section.quantise", "take_section.quantise_strength_tip"),
    _Number("align", 100.0, 100.0, 5.0, "take_section.draw_to_score", "take_section.align_strength_tip"),
)


class TakeSection(Retranslated, QWidget):
    """Shows and edits the selected take of the active player."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._player: Player | None = None
        self._take: Take | None = None
        self._section = Section(session, "inspector_take", self)
        self._cleaning = Section(session, "inspector_cleaning", self)
        self._name = self.texted(named(QLineEdit(), "take_name"), name="take_section.name_of_take")
        self._swatch = self.texted(
            named(ColourSwatch(session), "take_swatch"),
            name="take_section.colour_of_take",
            tip="take_section.colour_of_take",
        )
        self._about, self._counts = wrapped(Label()), wrapped(Label())
        self._buttons = {id: QToolButton() for id in BUTTONS}
        self._sliders: dict[str, NumberSlider] = {}
        self._grid = self.texted(
            named(Combo(), "take_grid_quarters"),
            name="take_section.grid_of_quantising",
            tip="take_section.grid_of_quantising",
        )
        usual_tip, beats_tip = "take_section.clean_this_take_as_every", "take_section.for_take_without_click_piece"
        self._usual = Button("take_section.as_usual", self._clean_as_usual, "take_usual", usual_tip)
        self._beats = Button("take_section.find_beats", self._find_beats, "take_beats", beats_tip)
        self._build()
        self._connect()
        self.texted(self._cleaning.header, words=("take_section.cleaning",))
        self.retranslate()
        self.hide()

    def _build(self) -> None:
        line = in_row((self._name, 1), self._swatch, spacing=4)
        for id, button in self._buttons.items():
            button.setObjectName(id.replace(".", "_"))
            button.setMinimumSize(QSize(LEAST_TARGET_PX + 2, LEAST_TARGET_PX + 2))
            button.setAutoRaise(True)
        buttons = in_row(*self._buttons.values(), STRETCH, spacing=2)
        body = self._section.body
        body.addLayout(line)
        body.addWidget(self._about)
        body.addLayout(buttons)
        body = self._cleaning.body
        body.addWidget(self._counts)
        for number in NUMBERS:
            low, high = CLEANING[number.field]
            usual = getattr(Cleaning(), number.field) * number.scale
            slider = named(
                NumberSlider(
                    self._session,
                    low * number.scale,
                    high * number.scale,
                    default=usual,
                    step=number.step,
                    decimals=0,
                    fills=(0.0, number.most),
                ),
                f"take_{number.field}",
            )
            unit = "take_section.milliseconds" if number.field.endswith("_s") else "%"
            self._sliders[number.field] = self.texted(slider, words=(number.text_id, unit, number.tip_id))
            body.addWidget(slider)
            if number.field == "quantise":
                body.addWidget(self._grid)
        below = in_row(self._usual, self._beats, spacing=4)
        body.addLayout(below)
        in_column(self._section, self._cleaning, of=self, margins=0, spacing=0)

    def _connect(self) -> None:
        session = self._session
        self._name.editingFinished.connect(self._rename)
        self._swatch.chosen.connect(self._colour)
        for number in NUMBERS:
            slider = self._sliders[number.field]
            slider.changed.connect(
                lambda value, token, number=number: self._clean(token, **{number.field: value / number.scale})
            )
            slider.released.connect(session.document.end_gesture)
        self._grid.chosen.connect(lambda id: self._clean(None, grid_quarters=float(Fraction(id))))
        session.theme_changed.connect(self._apply_theme)
        self._apply_theme()

    def _clean_as_usual(self) -> None:
        actions(self._session)["takes.usual_cleaning"].trigger()

    def _find_beats(self) -> None:
        actions(self._session)["takes.find_beats"].trigger()

    # Display

    def show_take(self) -> bool:
        """Show the selected take, and return whether there is one."""
        player, take_id = self._session.player, self._session.selection.take
        recorded = self._session.project.takes.get(player.id) if player is not None and take_id else None
        takes = recorded.takes if recorded is not None else ()
        self._player, self._take = player, next((take for take in takes if take.id == take_id), None)
        self.setVisible(self._take is not None)
        if self._take is None or player is None or recorded is None:
            return False
        take = self._take
        self._section.header.set_texts(self.tr("take_section.take"), player.name)
        if not self._name.hasFocus() or not self._name.isModified():
            self._name.setText(take.name)
        self._swatch.show_colours((take.colour or self._session.colour(player),))
        self._about.setText(self._about_text(take))
        table = actions(self._session)
        for id, button in self._buttons.items():
            action = table.get(id)
            if action is not None and button.defaultAction() is not action:
                button.setDefaultAction(action)
        self._show_cleaning(take, has_score=bool(recorded.before_notes))
        return True

    def _about_text(self, take: Take) -> str:
        seconds = (take.end_us - take.start_us) / 1e6
        lasts = self.tr("take_section.s_events").format(seconds=seconds, count=len(take.times_us))
        return " · ".join(text for text in (when_text(take.recorded), take.device, lasts) if text)

    def _show_cleaning(self, take: Take, has_score: bool) -> None:
        cleaning = take.cleaning
        for number in NUMBERS:
            self._sliders[number.field].show_value(getattr(cleaning, number.field) * number.scale)
        self._sliders["align"].setEnabled(has_score or cleaning.align > 0.0)
        quarters = Fraction(cleaning.grid_quarters).limit_denominator(960)
        options = [Option(str(step), name) for name, step in GRIDS.items()]
        if quarters not in GRIDS.values():
            options.append(Option(str(quarters), self.tr("take_section.quarters").format(count=quarters)))
        self._grid.set_options(options)
        self._grid.show_option(str(quarters))
        self._grid.setEnabled(cleaning.quantise > 0.0)
        self._usual.setEnabled(cleaning != Cleaning())
        self._counts.setText(self._counts_text())

    def _counts_text(self) -> str:
        """Return a text with the number of omitted notes for each reason."""
        assert self._player is not None
        assert self._take is not None
        clean = take_cleaned(self._session.project, self._player.id, self._take.id)
        found: Counter[str] = Counter(fault for fault in clean.faults if fault)
        kept = len(clean.faults) - sum(found.values())
        names = {
            "ghost": self.tr("take_section.ghost_notes"),
            "silent": self.tr("take_section.inaudible"),
            "slip": self.tr("take_section.late_fingers"),
            "double": self.tr("take_section.struck_twice"),
        }
        left_out = [text.format(count=found[fault]) for fault, text in names.items() if fault in found]
        if not left_out:
            return self.tr("take_section.no_notes_excluded").format(count=kept)
        faults = self.tr("take_section.list_separator").join(left_out)
        return self.tr("take_section.notes_excluded").format(count=kept, faults=faults)

    # Edits

    def _rename(self) -> None:
        if self._take is None or self._player is None or self._name.text() == self._take.name:
            return
        self._name.setModified(False)
        player_id, take_id, name = self._player.id, self._take.id, self._name.text()
        self._session.attempt(
            Message("edit.rename_take", {"take": name}), lambda project: rename_take(project, player_id, take_id, name)
        )
        self.show_take()

    def _colour(self, colour: str) -> None:
        if self._take is None or self._player is None:
            return
        player_id, take_id = self._player.id, self._take.id
        self._session.attempt(
            Message("edit.colour_take", {"take": self._take.name}),
            lambda project: colour_take(project, player_id, take_id, colour),
        )

    def _clean(self, token: object | None, **fields: float) -> None:
        if self._take is None or self._player is None:
            return
        player_id, take_id = self._player.id, self._take.id
        cleaning = msgspec.structs.replace(self._take.cleaning, **fields)
        self._session.attempt(
            Message("edit.clean_take", {"take": self._take.name}),
            lambda project: set_cleaning(project, player_id, take_id, cleaning),
            token,
        )

    def _apply_theme(self) -> None:
        for label in (self._about, self._counts):
            label.setStyleSheet(f"color: {self._session.tokens.text_dim};")

    def retranslate(self) -> None:
        self.show_take()
