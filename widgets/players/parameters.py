"""The parameters of the selected players, in parts that fold; several players at once."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

import shiboken6
from PySide6.QtCore import QEvent, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QIcon, QImage, QPixmap, QShowEvent
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from app.errors import AppError, Message
from app.project.edit import players as edit
from app.project.model import Player, Project
from app.rig.character_library import bundled_characters, characters
from instrument_maps.library import all_maps
from widgets.common.combo import Combo, Option
from widgets.common.icons import icon
from widgets.common.instrument_name import character_name, instrument_name
from widgets.common.number_slider import NumberSlider
from widgets.common.plain import Label
from widgets.common.section import Section
from widgets.common.session import Session
from widgets.common.swatch import ColourSwatch
from widgets.common.tasks import Progress, StopWanted
from widgets.players.body_dance import BodyDanceRows
from widgets.players.portrait import portrait_of

LABEL_PX = 88
PORTRAIT_PX = 28
PORTRAITS_AFTER_MS = 3000
_LEADER = {"auto": None, "yes": True, "no": False}
_CIRCULAR = {"no": False, "yes": True}


@dataclass(frozen=True)
class _Slider:
    """A parameter as a control: its bounds, and the part of them that the control fills."""

    name: str
    section: str
    maximum: float
    fills: float
    step: float
    minimum: float = 0.0
    decimals: int = 2


_SLIDERS = (
    _Slider("amplitude", "motion", 1.0, 1.0, 0.05),
    _Slider("sway", "motion", 2.0, 2.0, 0.05),
    _Slider("weight_shift", "motion", 2.0, 2.0, 0.05),
    _Slider("bell_height", "motion", 2.0, 2.0, 0.05),
    _Slider("breath_min_beats", "breath", 64.0, 4.0, 0.25),
    _Slider("breath_last_beat_beats", "breath", 64.0, 8.0, 0.25),
    _Slider("breath_prepare_beats", "breath", 64.0, 8.0, 0.25),
    _Slider("breath_need", "breath", 1.0, 1.0, 0.05),
    _Slider("lung_s", "breath", 60.0, 20.0, 0.5, minimum=1.0, decimals=1),
    _Slider("embouchure_tension", "face", 2.0, 2.0, 0.05),
)
_SECTIONS = ("motion", "breath", "face", "player")
"""What is changed most stands first."""
_LARGEST_SEED = 2**31 - 1


class ParameterSections(QWidget):
    """Who the selected players are, and how they move, breathe and play.

    Signals
    -------
    dice_thrown()
        The person wants another seed.
    """

    dice_thrown = Signal()

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._sections = {name: Section(session, f"players_{name}", self) for name in _SECTIONS}
        self._sliders: dict[str, NumberSlider] = {}
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.setSpacing(0)
        for section in self._sections.values():
            outer.addWidget(section)
        self._portraits: dict[str, QIcon] = {}
        self._asked = False
        self._make_player_rows()
        for row in _SLIDERS:
            self._make_slider(row)
        self._make_circular_breathing()
        self._body_dance = BodyDanceRows(session)
        self._sections["motion"].body.addWidget(self._body_dance)
        self._make_seed()
        self.retranslate()
        session.theme_changed.connect(self._dress)
        session.instruments_changed.connect(self._instruments_changed)
        session.characters_changed.connect(self._characters_changed)
        self._dress()

    # Building

    def _make_player_rows(self) -> None:
        self._labels = {name: Label() for name in ("part", "instrument", "character", "posture", "leader", "colour")}
        self._part, self._instrument, self._character = Combo(), Combo(), Combo()
        self._posture, self._leader = Combo(), Combo()
        self._colour = ColourSwatch(self._session)
        controls: dict[str, QWidget] = {
            "part": self._part,
            "instrument": self._instrument,
            "character": self._character,
            "posture": self._posture,
            "leader": self._leader,
            "colour": self._colour,
        }
        self._character.setIconSize(QSize(PORTRAIT_PX, PORTRAIT_PX))
        grid = QGridLayout()
        grid.setSpacing(4)
        grid.setColumnStretch(1, 1)
        for line, (name, control) in enumerate(controls.items()):
            control.setObjectName(f"player_{name}")
            self._labels[name].setMinimumWidth(LABEL_PX)
            self._labels[name].setBuddy(control)
            grid.addWidget(self._labels[name], line, 0)
            place = Qt.AlignmentFlag.AlignLeft if control is self._colour else Qt.AlignmentFlag(0)
            grid.addWidget(control, line, 1, place)
        self._sections["player"].body.addLayout(grid)
        self._part.chosen.connect(lambda id: self._change("edit.player_part", part_id=id))
        self._instrument.chosen.connect(lambda id: self._change("edit.player_instrument", instrument_id=id))
        self._character.chosen.connect(lambda id: self._change("edit.player_character", character_id=id))
        self._colour.chosen.connect(lambda colour: self._change("edit.player_colour", colour=colour))
        self._posture.chosen.connect(lambda posture: self._set("posture", posture))
        self._leader.chosen.connect(lambda choice: self._set("cue_leader", _LEADER[choice]))

    def _make_slider(self, row: _Slider) -> None:
        slider = NumberSlider(
            self._session,
            row.minimum,
            row.maximum,
            step=row.step,
            decimals=row.decimals,
            fills=(row.minimum if row.minimum < 0 else 0.0, row.fills),
        )
        slider.setObjectName(f"parameter_{row.name}")
        slider.changed.connect(lambda value, token, name=row.name: self._set(name, value, token))
        slider.reset.connect(lambda _, name=row.name: self._reset(name))
        slider.released.connect(self._session.document.end_gesture)
        self._sliders[row.name] = slider
        self._sections[row.section].body.addWidget(slider)

    def _make_circular_breathing(self) -> None:
        self._circular_label, self._circular = Label(), Combo()
        self._circular.setObjectName("parameter_circular_breathing")
        self._circular_label.setBuddy(self._circular)
        self._circular.chosen.connect(lambda choice: self._set("circular_breathing", _CIRCULAR[choice]))
        line = QHBoxLayout()
        line.setSpacing(4)
        line.addWidget(self._circular_label)
        line.addWidget(self._circular, 1)
        self._sections["breath"].body.addLayout(line)

    def _make_seed(self) -> None:
        seed = NumberSlider(self._session, 0.0, float(_LARGEST_SEED), decimals=0, step=1.0, slides=False)
        seed.setObjectName("parameter_seed")
        seed.changed.connect(lambda value, token: self._set("seed", int(value), token))
        seed.reset.connect(lambda _: self._reset("seed"))
        seed.released.connect(self._session.document.end_gesture)
        self._sliders["seed"] = seed
        self._dice = QToolButton()
        self._dice.setObjectName("seed_dice")
        self._dice.clicked.connect(self.dice_thrown)
        line = QHBoxLayout()
        line.setSpacing(4)
        line.addWidget(seed, 1)
        line.addWidget(self._dice)
        self._sections["motion"].body.addLayout(line)

    def _dress(self) -> None:
        self._dice.setIcon(icon("dice", self._session.tokens))

    # Showing

    def show_players(self) -> None:
        """Show the parameters of the players that the session has selected."""
        project = self._session.project
        players = [project.player(player_id) for player_id in self._session.players]
        self.setEnabled(bool(players))
        self._part.set_options([Option(part.id, part.name) for part in project.score.parts])
        if not players:
            return
        self._part.show_option(_common(players, lambda player: player.part_id))
        self._instrument.show_option(_common(players, lambda player: player.instrument_id))
        self._character.show_option(_common(players, lambda player: player.character_id))
        self._show_postures(players)
        self._leader.show_option(_common(players, lambda player: _leader_id(player.parameters.cue_leader)))
        self._circular.show_option(
            _common(players, lambda player: "yes" if player.parameters.circular_breathing else "no")
        )
        self._colour.show_colours(tuple(dict.fromkeys(self._session.colour(player) for player in players)))
        self._body_dance.show_players(players)
        casts = [edit.cast_parameters(project, player.id, edit.instrument_of(player)) for player in players]
        for name, slider in self._sliders.items():
            values = [float(getattr(player.parameters, name)) for player in players]
            defaults = [float(getattr(cast, name)) for cast in casts]
            slider.show_value(values[0], mixed=len(set(values)) > 1, default=defaults[0], by_hand=values != defaults)

    def _show_postures(self, players: list[Player]) -> None:
        """Offer what all instruments are played in, and say of the others why not."""
        options = []
        for id, text, reason in (
            ("standing", self.tr("Standing"), self.tr("Played seated only: {players}")),
            ("seated", self.tr("Seated"), self.tr("Played standing only: {players}")),
        ):
            barred = [
                player.name for player in players if id not in edit.postures_of_person(self._session.project, player)
            ]
            options.append(Option(id, text, reason=reason.format(players=", ".join(barred)) if barred else ""))
        self._posture.set_options(options)
        self._posture.setToolTip("\n".join(option.reason for option in options if option.reason))
        self._posture.show_option(_common(players, edit.posture_of))

    # Editing

    def _apply(self, name: Message, change: Callable[[Project], Project], token: object | None = None) -> None:
        self._session.attempt(name, change, token, self)

    def _name(self, id: str) -> Message:
        return Message(id, {"count": len(self._session.players)})

    def _change(self, name: str, **fields: object) -> None:
        chosen = self._session.players
        self._apply(self._name(name), lambda project: edit.change(project, chosen, **fields))

    def _set(self, parameter: str, value: str | float | int | bool | None, token: object | None = None) -> None:
        chosen = self._session.players
        self._apply(
            self._name(f"edit.parameter_{parameter}"),
            lambda project: edit.set_parameters(project, chosen, **{parameter: value}),
            token,
        )

    def _reset(self, parameter: str) -> None:
        chosen = self._session.players
        self._apply(
            self._name(f"edit.parameter_{parameter}"),
            lambda project: edit.reset_parameters(project, chosen, (parameter,)),
        )

    # Portraits

    def _show_characters(self) -> None:
        options = [Option(id, character_name(id), self._portraits.get(id)) for id in characters()]
        self._character.set_options(options)

    def _characters_changed(self) -> None:
        self._portraits = {id: drawn for id, drawn in self._portraits.items() if id in bundled_characters()}
        self._show_characters()
        self.show_players()
        if self._asked:
            self._draw_portraits()

    def _draw_portraits(self) -> None:
        """Beside the window: every body is looked at closely once."""
        size_px = round(PORTRAIT_PX * self.devicePixelRatioF())

        def work(progress: Progress, stop_wanted: StopWanted) -> dict[str, QImage]:
            drawn = {}
            for number, id in enumerate(characters()):
                if stop_wanted():
                    break
                # Who cannot be opened has no picture; why is told where the characters are.
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

    # Words

    def retranslate(self) -> None:
        """Set every text in the language of the editor."""
        titles = (self.tr("Motion"), self.tr("Breath"), self.tr("Face"), self.tr("Player"))
        for section, title in zip(self._sections.values(), titles, strict=True):
            section.header.set_texts(title)
        texts = {
            "part": self.tr("Part"),
            "instrument": self.tr("Instrument"),
            "character": self.tr("Character"),
            "posture": self.tr("Posture"),
            "leader": self.tr("Gives cues"),
            "colour": self.tr("Colour"),
        }
        for name, text in texts.items():
            self._labels[name].setText(text)
        self._show_instruments()
        self._show_characters()
        self._leader.set_options(
            [
                Option("auto", self.tr("Automatic")),
                Option("yes", self.tr("Yes")),
                Option("no", self.tr("Never")),
            ]
        )
        self._circular_label.setText(self.tr("Circular breathing"))
        self._circular.set_options([Option("no", self.tr("No")), Option("yes", self.tr("Yes"))])
        self._circular.setToolTip(
            self.tr("Breathes in through the nose while playing, and never stops the line for a catch breath")
        )
        self._colour.setToolTip(self.tr("Colour of the player in the timeline and on the stage"))
        self._dice.setToolTip(self.tr("Another seed for each"))
        self._retranslate_sliders()
        self.show_players()

    def _show_instruments(self) -> None:
        self._instrument.set_options([Option(map.id, instrument_name(map)) for map in all_maps().values()])

    def _instruments_changed(self) -> None:
        self._show_instruments()
        self.show_players()

    def _retranslate_sliders(self) -> None:
        beats, seconds = self.tr("beats"), self.tr("s", "seconds")
        words = {
            "amplitude": (
                self.tr("Amplitude"), "", self.tr("How much the player moves: 0 still, 0.5 natural, 1 a lot"),
            ),
            "sway": (self.tr("Sway"), "×", self.tr("Swaying with the beat, times the natural amount")),
            "weight_shift": (self.tr("Weight shift"), "×", self.tr("From foot to foot, times the natural amount")),
            "bell_height": (
                self.tr("Bell height"), "×", self.tr("The bell follows the melody, times the natural amount"),
            ),
            "seed": (self.tr("Seed"), "", self.tr("Another seed is another performance of the same plan")),
            "breath_min_beats": (
                self.tr("Breathes in rests from"), beats, self.tr("In a shorter rest the player does not breathe"),
            ),
            "breath_last_beat_beats": (
                self.tr("On the last beat from"), beats,
                self.tr("In a rest from this length on, the breath takes its last beat; in a shorter one all of it"),
            ),
            "breath_prepare_beats": (
                self.tr("Prepared from"), beats,
                self.tr("In a rest from this length on, the player gets ready, then breathes on the last beat"),
            ),
            "breath_need": (
                self.tr("Air spent first"), "",
                self.tr(
                    "Part of the lungs that is used up before the player breathes in a rest too short to prepare in: "
                    "0 every such rest, 1 only with empty lungs"
                ),
            ),
            "lung_s": (
                self.tr("A full lung lasts"),
                seconds,
                self.tr(
                    "On a usual instrument; longer or shorter on one that takes less or more air. "
                    "Longer phrases get a catch breath"
                ),
            ),
            "embouchure_tension": (
                self.tr("Embouchure tension"), "×", self.tr("How tight the lips look, times the natural amount"),
            ),
        }  # fmt: skip
        for name, (label, unit, tip) in words.items():
            self._sliders[name].set_texts(label, unit, tip)

    # Qt's own names

    def showEvent(self, event: QShowEvent) -> None:
        if not self._asked:
            self._asked = True
            # The players themselves come first.
            QTimer.singleShot(PORTRAITS_AFTER_MS, self, self._draw_portraits)

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


def _common(players: list[Player], value: Callable[[Player], str]) -> str | None:
    """What all have in common; None where they differ."""
    values = {value(player) for player in players}
    return values.pop() if len(values) == 1 else None


def _leader_id(leads: bool | None) -> str:
    return next(id for id, value in _LEADER.items() if value is leads)
