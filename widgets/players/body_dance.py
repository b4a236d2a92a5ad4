"""What the bodies of the selected players dance while they play."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path

from PySide6.QtCore import QEvent
from PySide6.QtWidgets import QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from app.choreography.library import bundled_choreographies
from app.choreography.model_file import SUFFIX
from app.encoding import shown
from app.errors import Message
from app.project.edit import body_dance as edit
from app.project.edit.players import reset_parameters, set_parameters
from app.project.model import Player, Project
from widgets.common.combo import Combo, Option
from widgets.common.icons import icon
from widgets.common.number_slider import NumberSlider
from widgets.common.paths import ask_for_file
from widgets.common.plain import Label
from widgets.common.session import Session

_GENERATED = ""
_FROM_FILE = "\0file"
"""Of the options: no name of a choreography."""
_AMOUNT, _VARIATION = "dance_amount", "dance_variation"


class BodyDanceRows(QWidget):
    """Generated or a choreography, how much of it, and which of its dances; the latter two while there is one.

    Parameters
    ----------
    session : Session
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._label, self._choreography = Label(), Combo()
        self._choreography.setObjectName("parameter_choreography")
        self._label.setBuddy(self._choreography)
        self._sliders = {
            _AMOUNT: NumberSlider(session, 0.0, 1.0, step=0.05),
            _VARIATION: NumberSlider(session, 0.0, float(2**31 - 1), decimals=0, step=1.0, slides=False),
        }
        self._dice = QToolButton()
        self._dice.setObjectName("dance_dice")
        self._build()
        self._choreography.chosen.connect(self._choose)
        self._dice.clicked.connect(self._vary)
        for name, slider in self._sliders.items():
            slider.changed.connect(lambda value, token, name=name: self._set(name, value, token))
            slider.reset.connect(lambda _, name=name: self._reset(name))
            slider.released.connect(session.document.end_gesture)
        session.theme_changed.connect(self._apply_theme)
        self._apply_theme()
        self.retranslate()

    def _build(self) -> None:
        choice = QHBoxLayout()
        choice.setSpacing(4)
        choice.addWidget(self._label)
        choice.addWidget(self._choreography, 1)
        variation = QHBoxLayout()
        variation.setSpacing(4)
        variation.addWidget(self._sliders[_VARIATION], 1)
        variation.addWidget(self._dice)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.addLayout(choice)
        rows.addWidget(self._sliders[_AMOUNT])
        rows.addLayout(variation)
        for name, slider in self._sliders.items():
            slider.setObjectName(f"parameter_{name}")

    # Showing

    def show_players(self, players: Sequence[Player]) -> None:
        """Show what these players dance, of whom there is at least one."""
        dances = list(dict.fromkeys(player.parameters.choreography for player in players))
        options = [Option(_GENERATED, self.tr("Generated"))]
        options += [Option(name, name) for name in bundled_choreographies()]
        known = {option.id for option in options}
        options += [Option(path, shown(Path(path).stem)) for path in dances if path not in known]
        self._choreography.set_options([*options, Option(_FROM_FILE, self.tr("From File …"))])
        self._show_choreography(dances)
        for widget in (*self._sliders.values(), self._dice):
            widget.setVisible(any(dances))
        for name, slider in self._sliders.items():
            values = [float(getattr(player.parameters, name)) for player in players]
            default = 0.5 if name == _AMOUNT else 0.0
            changed = name == _AMOUNT and any(value != default for value in values)
            slider.show_value(values[0], mixed=len(set(values)) > 1, default=default, by_hand=changed)

    def _show_choreography(self, dances: Sequence[str]) -> None:
        self._choreography.show_option(dances[0] if len(dances) == 1 else None)
        told = [self.tr("How hips, trunk and head move while playing; hands, lips and feet keep their places")]
        self._choreography.setToolTip("\n".join([*told, *(shown(path) for path in dances if path)]))

    # Editing

    def _choose(self, id: str) -> None:
        choreography: str | os.PathLike[str] | None = id
        if id == _FROM_FILE:
            source = self._session.project.source
            kind = self.tr("Choreographies")
            start = Path(source).parent if source else None
            choreography = ask_for_file(self, self.tr("Choreography"), start, f"{kind} (*{SUFFIX})")
        chosen = self._session.players
        if choreography is not None:
            self._edit("choreography", lambda project: edit.set_body_dance(project, chosen, choreography))
        if id == _FROM_FILE:
            # Also where none was chosen, or it was refused: the list does not stay at the question.
            players = [self._session.project.player(player_id) for player_id in chosen]
            self._show_choreography(list(dict.fromkeys(player.parameters.choreography for player in players)))

    def _set(self, name: str, value: float, token: object) -> None:
        chosen, number = self._session.players, int(value) if name == _VARIATION else float(value)
        self._edit(name, lambda project: set_parameters(project, chosen, **{name: number}), token)

    def _reset(self, name: str) -> None:
        chosen = self._session.players
        self._edit(name, lambda project: reset_parameters(project, chosen, (name,)))

    def _vary(self) -> None:
        chosen = self._session.players
        self._edit(_VARIATION, lambda project: edit.vary_body_dances(project, chosen))

    def _edit(self, name: str, change: Callable[[Project], Project], token: object | None = None) -> None:
        named = Message(f"edit.parameter_{name}", {"count": len(self._session.players)})
        self._session.attempt(named, change, token, self)

    # Words and pictures

    def _apply_theme(self) -> None:
        self._dice.setIcon(icon("dice", self._session.tokens))

    def retranslate(self) -> None:
        """Set every text in the language of the editor; what is shown of players follows with `show_players`."""
        self._label.setText(self.tr("Body motion"))
        self._dice.setToolTip(self.tr("Another dance for each"))
        words = {
            _AMOUNT: (
                self.tr("Dance amount"),
                self.tr("How much of the dance: 0 none, 1 as much as a player can do; it takes the place of the sway"),
            ),
            _VARIATION: (
                self.tr("Variation"),
                self.tr("0: a dance of the player's own; who has the same other number moves in unison, dancers too"),
            ),
        }
        for name, (label, tip) in words.items():
            self._sliders[name].set_texts(label, "", tip)

    # Qt's own names

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)
