"""Parameters of one or more selected players in foldable sections."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Final

import shiboken6
from PySide6.QtCore import QSize, Qt, QTimer, Signal
from PySide6.QtGui import QIcon, QImage, QPixmap, QShowEvent
from PySide6.QtWidgets import QGridLayout, QWidget

from app.editor.edit_names import edit_of_parameter, edit_of_players
from app.editor.session import Session
from app.errors import AppError, Message, Progress, StopRequested
from app.plan.parameters import Parameter, Value
from app.project.edit import players as edit
from app.project.edit.outfits import colour_outfit, give_outfit
from app.project.model import Project
from app.project.performers import Player
from app.rig.characters.character_library import characters, our_characters
from app.rig.people.wardrobe import Tint
from instrument_maps.library import library
from metadata.acting import AMOUNTS
from widgets.common.character_picture import portrait_of
from widgets.common.combo import Combo, Option
from widgets.common.controls import Caption, IconButton, Retranslated
from widgets.common.instrument_name import character_name, instrument_name
from widgets.common.layouts import in_column, in_row
from widgets.common.plain import Label
from widgets.common.section import Section
from widgets.common.swatch import ColourSwatch
from widgets.common.text import parameter_text
from widgets.players.acting import ActingRows
from widgets.players.body_dance import BodyDanceRows
from widgets.players.layer_switch import LayerSwitch
from widgets.players.outfit_rows import OutfitChooser, OutfitColours
from widgets.players.parameter_rows import ParameterChoice, ParameterSlider, rows_of

LABEL_PX = 88
PORTRAIT_PX = 28
PORTRAITS_AFTER_MS = 3000
_SECTIONS = ("motion", "acting", "breath", "face", "player")
"""Sections from top to bottom, the most used first."""
_FOLDED = frozenset({"acting"})
_POSTURE = "posture"
_TITLES: Final = (
    "parameter_sections.motion",
    "parameter_sections.acting",
    "parameter_sections.breath",
    "parameter_sections.face",
    "parameter_sections.player",
)
_LABELS: Final = {
    **{name: f"parameter_sections.{name}" for name in ("part", "instrument", "character", "colour")},
    "outfit": "outfit_rows.outfit",
}


class ParameterSections(Retranslated, QWidget):
    """Properties of the selected players: instrument and character, motion, breathing and playing.

    Signals
    -------
    dice_thrown()
        The user requests another seed.
    """

    dice_thrown = Signal()

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._sections = {name: Section(session, f"players_{name}", self, folded=name in _FOLDED) for name in _SECTIONS}
        self._sliders: dict[str, ParameterSlider] = {}
        self._choices: dict[str, ParameterChoice] = {}
        self._switches: list[LayerSwitch] = []
        self._body_dance = BodyDanceRows(session)
        self._acting = ActingRows(session)
        self._acting.shown.connect(self._show_acting)
        dice_tip = "parameter_sections.vary_seeds"
        self._dice = IconButton(session, "dice", dice_tip, self.dice_thrown.emit, "seed_dice")
        outer = in_column(of=self, margins=0, spacing=0)
        for section, text_id in zip(self._sections.values(), _TITLES, strict=True):
            self.texted(section.header, words=(text_id,))
            outer.addWidget(section)
        self._portraits: dict[str, QIcon] = {}
        self._asked = False
        self._make_player_rows()
        for name in _SECTIONS[:-1]:
            for parameter in rows_of(name):
                self._make_row(parameter)
        self.texted(self._colour, tip="parameter_sections.colour_tip")
        self.retranslate()
        session.instruments_changed.connect(self._instruments_changed)
        session.characters_changed.connect(self._characters_changed)

    # Construction

    def _make_player_rows(self) -> None:
        self._labels = {name: Caption(text_id) for name, text_id in _LABELS.items()}
        self._part, self._instrument, self._character = Combo(), Combo(), Combo()
        self._colour = ColourSwatch(self._session)
        self._outfit, self._outfit_colours = OutfitChooser("player"), OutfitColours(self._session, "player")
        controls: dict[str, QWidget] = {
            "part": self._part,
            "instrument": self._instrument,
            "character": self._character,
            "outfit": self._outfit,
            "colour": self._colour,
        }
        for name, control in controls.items():
            control.setObjectName(f"player_{name}")
            self._labels[name].setBuddy(control)
        rows: list[tuple[Label, QWidget]] = [(self._labels[name], control) for name, control in controls.items()]
        rows.insert(-1, (self._outfit_colours.caption, self._outfit_colours))
        choices = [self._make_choice(parameter) for parameter in rows_of("player")]
        rows[-1:-1] = [(choice.label, choice) for choice in choices]
        self._character.setIconSize(QSize(PORTRAIT_PX, PORTRAIT_PX))
        grid = QGridLayout()
        grid.setSpacing(4)
        grid.setColumnStretch(1, 1)
        for line, (label, control) in enumerate(rows):
            label.setMinimumWidth(LABEL_PX)
            grid.addWidget(label, line, 0)
            place = Qt.AlignmentFlag.AlignLeft if control is self._colour else Qt.AlignmentFlag(0)
            grid.addWidget(control, line, 1, place)
        self._sections["player"].body.addLayout(grid)
        self._part.chosen.connect(lambda id: self._assign("edit.player_part", part_id=id))
        self._instrument.chosen.connect(lambda id: self._assign("edit.player_instrument", instrument_id=id))
        self._character.chosen.connect(lambda id: self._change("edit.player_character", character_id=id))
        self._outfit.chosen.connect(self._wear)
        self._outfit_colours.chosen.connect(self._tint)
        self._colour.chosen.connect(lambda colour: self._change("edit.player_colour", colour=colour))

    def _make_row(self, parameter: Parameter) -> None:
        body = self._sections[parameter.section].body
        if parameter.choices:
            body.addLayout(self._make_choice(parameter).line())
        elif parameter.name == "choreography":
            body.addWidget(self._body_dance)
        elif parameter.name == "style":
            body.addWidget(self._acting)
        elif parameter.name == "habits":
            return  # contained in the rows of the style
        elif parameter.name == "seed":
            body.addLayout(in_row((self._make_slider(parameter), 1), self._dice, spacing=4))
        elif parameter.name in AMOUNTS:
            slider = self._make_slider(parameter)
            self._switches.append(LayerSwitch(self._session, parameter, slider))
            body.addLayout(in_row(self._switches[-1], (slider, 1), spacing=4))
        else:
            body.addWidget(self._make_slider(parameter))

    def _make_choice(self, parameter: Parameter) -> ParameterChoice:
        choice = self._choices[parameter.name] = ParameterChoice(parameter)
        self.texted(choice, tip=parameter.tip, options={str(value): word for value, word in parameter.choices})
        choice.chosen.connect(lambda id: self._set(parameter, choice.values[id]))
        return choice

    def _make_slider(self, parameter: Parameter) -> ParameterSlider:
        slider = self._sliders[parameter.name] = ParameterSlider(self._session, parameter)
        slider.changed.connect(lambda value, token: self._set(parameter, parameter.kind(value), token))
        slider.reset.connect(lambda _: self._reset(parameter))
        slider.released.connect(self._session.document.end_gesture)
        return slider

    # Display

    def show_players(self) -> None:
        """Show the parameters of the session's selected players."""
        project = self._session.project
        players = [project.player(player_id) for player_id in self._session.players]
        self.setEnabled(bool(players))
        self._part.set_options([Option(part.id, part.name) for part in project.score.parts])
        if not players:
            return
        self._part.show_option(_common(players, lambda player: player.part_id))
        self._instrument.show_option(_common(players, lambda player: player.instrument_id))
        self._character.show_option(_common(players, lambda player: player.character_id))
        self._outfit.show_worn(players)
        self._outfit_colours.show_worn(players)
        self._show_postures(players)
        for name, choice in self._choices.items():
            if name != _POSTURE:
                chosen = {str(getattr(player.parameters, name)) for player in players}
                choice.show_option(chosen.pop() if len(chosen) == 1 else None)
        self._colour.show_colours(tuple(dict.fromkeys(self._session.colour(player) for player in players)))
        self._body_dance.show_players(players)
        self._acting.show_players(players)
        for switch in self._switches:
            switch.show_players(players)
        casts = [edit.cast_parameters(project, player.id, edit.instrument_of(player)) for player in players]
        for name, slider in self._sliders.items():
            values = [float(getattr(player.parameters, name)) for player in players]
            defaults = [float(getattr(cast, name)) for cast in casts]
            slider.show_value(values[0], mixed=len(set(values)) > 1, default=defaults[0], by_hand=values != defaults)

    def _show_postures(self, players: list[Player]) -> None:
        """Offer the postures possible for all instruments, and explain why others are not."""
        posture, options = self._choices[_POSTURE], []
        reasons = {
            "standing": self.tr("parameter_sections.played_seated_only"),
            "seated": self.tr("parameter_sections.played_standing_only"),
        }
        for id, word in posture.parameter.choices:
            barred = [
                player.name for player in players if id not in edit.postures_of_musician(self._session.project, player)
            ]
            reason = reasons[str(id)].format(players=", ".join(barred)) if barred else ""
            options.append(Option(str(id), parameter_text(word), reason=reason))
        posture.set_options(options)
        posture.setToolTip("\n".join(option.reason for option in options if option.reason))
        posture.show_option(_common(players, edit.posture_of))

    # Editing

    def _apply(self, name: Message, change: Callable[[Project], Project], token: object | None = None) -> None:
        self._session.attempt(name, change, token, self)

    def _name(self, id: str) -> Message:
        return edit_of_players(self._session.project, id, self._session.players)

    def _change(self, name: str, **fields: object) -> None:
        chosen = self._session.players
        self._apply(self._name(name), lambda project: edit.change(project, chosen, **fields))

    def _wear(self, outfit: str) -> None:
        chosen = self._session.players
        self._apply(self._name("edit.player_outfit"), lambda project: give_outfit(project, chosen, outfit))

    def _tint(self, tint: Tint, colour: str) -> None:
        chosen = self._session.players
        self._apply(
            self._name("edit.player_outfit_colour"), lambda project: colour_outfit(project, chosen, tint, colour)
        )

    def _assign(self, name: str, **ids: str) -> None:
        chosen = self._session.players
        self._apply(self._name(name), lambda project: edit.assign(project, chosen, **ids))

    def _set(self, parameter: Parameter, value: Value, token: object | None = None) -> None:
        chosen = self._session.players
        self._apply(
            edit_of_parameter(self._session.project, parameter.name, chosen),
            lambda project: edit.set_parameters(project, chosen, **{parameter.name: value}),
            token,
        )

    def _reset(self, parameter: Parameter) -> None:
        chosen = self._session.players
        self._apply(
            edit_of_parameter(self._session.project, parameter.name, chosen),
            lambda project: edit.reset_parameters(project, chosen, (parameter.name,)),
        )

    # Portraits

    def _show_characters(self) -> None:
        options = [Option(id, character_name(id), self._portraits.get(id)) for id in characters()]
        self._character.set_options(options)

    def _characters_changed(self) -> None:
        self._portraits = {id: drawn for id, drawn in self._portraits.items() if id in our_characters()}
        self._show_characters()
        self.show_players()
        if self._asked:
            self._draw_portraits()

    def _draw_portraits(self) -> None:
        """Draw the portraits of all characters in the background, since each must be loaded."""
        if self._session.performance.project is not self._session.project:
            # The plans of a piece just opened come first.
            QTimer.singleShot(PORTRAITS_AFTER_MS, self, self._draw_portraits)
            return
        size_px = round(PORTRAIT_PX * self.devicePixelRatioF())

        def work(progress: Progress, stop_requested: StopRequested) -> dict[str, QImage]:
            drawn = {}
            for number, id in enumerate(characters()):
                if stop_requested():
                    break
                # A character that cannot be read has no portrait; the list of characters reports why.
                with suppress(AppError):
                    drawn[id] = portrait_of(id, size_px)
                progress((number + 1) / len(characters()))
            return drawn

        self._session.tasks.run(Message("work.portraits"), work, self._take_portraits, key="portraits")

    def _take_portraits(self, drawn: dict[str, QImage]) -> None:
        if not shiboken6.isValid(self):
            return
        for id, image in drawn.items():
            image = QImage(image)
            image.setDevicePixelRatio(self.devicePixelRatioF())
            self._portraits[id] = QIcon(QPixmap.fromImage(image))
        self._show_characters()
        self.show_players()

    # Texts

    def retranslate(self) -> None:
        self._show_instruments()
        self._show_characters()
        self.show_players()

    def _show_acting(self, note: str) -> None:
        """Show a text about style and habits in the header of their section, visible when it is folded."""
        self._sections["acting"].header.set_texts(self.tr("parameter_sections.acting"), note)

    def _show_instruments(self) -> None:
        self._instrument.set_options([Option(map.id, instrument_name(map)) for map in library().in_score_order])

    def _instruments_changed(self) -> None:
        self._show_instruments()
        self.show_players()

    # Qt overrides

    def showEvent(self, event: QShowEvent) -> None:
        if not self._asked:
            self._asked = True
            # The figures of the players come first.
            QTimer.singleShot(PORTRAITS_AFTER_MS, self, self._draw_portraits)


def _common(players: list[Player], value: Callable[[Player], str]) -> str | None:
    """Return the common value of all players; None if they differ."""
    values = {value(player) for player in players}
    return values.pop() if len(values) == 1 else None
