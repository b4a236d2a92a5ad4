"""Dance of the selected players' bodies while they play."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path

from PySide6.QtWidgets import QWidget

from app.editor.edit_names import edit_of_parameter
from app.editor.session import Session
from app.editor.translated import tr
from app.encoding import shown
from app.plan.parameters import PARAMETERS
from app.project.choreography_files import SUFFIX, bundled_choreographies
from app.project.edit.dancers import set_body_dance, vary_body_dances
from app.project.edit.players import reset_parameters, set_parameters
from app.project.model import Project
from app.project.performers import Player
from widgets.common.combo import Combo, Option
from widgets.common.controls import Caption, IconButton, Retranslated, named
from widgets.common.layouts import in_column, in_row
from widgets.common.paths import ask_for_file
from widgets.players.parameter_rows import ParameterSlider, rows_of

_GENERATED = ""
_FROM_FILE = "\0file"
"""Value of the option that opens a file; no choreography has this name."""
_DANCED = PARAMETERS["choreography"]
_VARIATION = "dance_variation"


class BodyDanceRows(Retranslated, QWidget):
    """Choice between generated motion and a choreography, with the dance's amount and variation."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._dances: list[str] = []
        """Those of the players that are shown."""
        self._choreography = named(Combo(), "parameter_choreography")
        self._sliders = {one.name: ParameterSlider(session, one) for one in rows_of("dance")}
        self._dice = IconButton(session, "dice", "body_dance_rows.vary_each", self._vary, "dance_dice")
        self._build()
        self._choreography.chosen.connect(self._choose)
        for name, slider in self._sliders.items():
            slider.changed.connect(lambda value, token, name=name: self._set(name, value, token))
            slider.reset.connect(lambda _, name=name: self._reset(name))
            slider.released.connect(session.document.end_gesture)
        self.retranslate()

    def _build(self) -> None:
        choice = in_row(Caption(_DANCED.label, self._choreography), (self._choreography, 1), spacing=4)
        variation = in_row((self._sliders[_VARIATION], 1), self._dice, spacing=4)
        others = (slider for name, slider in self._sliders.items() if name != _VARIATION)
        in_column(choice, *others, variation, of=self, margins=0)

    # Display

    def show_players(self, players: Sequence[Player]) -> None:
        """Show the dance of one or more players."""
        dances = self._dances = list(dict.fromkeys(player.parameters.choreography for player in players))
        self.retranslate()
        for widget in (*self._sliders.values(), self._dice):
            widget.setVisible(any(dances))
        for name, slider in self._sliders.items():
            values = [float(getattr(player.parameters, name)) for player in players]
            default = float(slider.parameter.default)
            changed = not slider.parameter.is_own and any(value != default for value in values)
            slider.show_value(values[0], mixed=len(set(values)) > 1, default=default, by_hand=changed)

    def retranslate(self) -> None:
        options = [Option(_GENERATED, self.tr("body_dance_rows.generated"))]
        options += [Option(name, name) for name in bundled_choreographies()]
        known = {option.id for option in options}
        options += [Option(path, shown(Path(path).stem)) for path in self._dances if path not in known]
        self._choreography.set_options([*options, Option(_FROM_FILE, self.tr("body_dance_rows.from_file"))])
        self._show_choreography(self._dances)

    def _show_choreography(self, dances: Sequence[str]) -> None:
        self._choreography.show_option(dances[0] if len(dances) == 1 else None)
        self._choreography.setToolTip("\n".join([tr(_DANCED.tip), *(shown(path) for path in dances if path)]))

    # Editing

    def _choose(self, id: str) -> None:
        choreography: str | os.PathLike[str] | None = id
        if id == _FROM_FILE:
            source = self._session.project.source
            kind = self.tr("body_dance_rows.choreographies")
            start = Path(source).parent if source else None
            choreography = ask_for_file(self, self.tr("body_dance_rows.choreography"), start, f"{kind} (*{SUFFIX})")
        chosen = self._session.players
        if choreography is not None:
            self._edit(_DANCED.name, lambda project: set_body_dance(project, chosen, choreography))
        if id == _FROM_FILE:
            # Also if no file was chosen or it was refused: the list must not stay at the question.
            players = [self._session.project.player(player_id) for player_id in chosen]
            self._show_choreography(list(dict.fromkeys(player.parameters.choreography for player in players)))

    def _set(self, name: str, value: float, token: object) -> None:
        chosen, number = self._session.players, PARAMETERS[name].kind(value)
        self._edit(name, lambda project: set_parameters(project, chosen, **{name: number}), token)

    def _reset(self, name: str) -> None:
        chosen = self._session.players
        self._edit(name, lambda project: reset_parameters(project, chosen, (name,)))

    def _vary(self) -> None:
        chosen = self._session.players
        self._edit(_VARIATION, lambda project: vary_body_dances(project, chosen))

    def _edit(self, name: str, change: Callable[[Project], Project], token: object | None = None) -> None:
        self._session.attempt(
            edit_of_parameter(self._session.project, name, self._session.players), change, token, self
        )
