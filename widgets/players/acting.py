"""Choice of the style and the habits of the selected players."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from app.editor.edit_names import edit_of_parameter
from app.editor.session import Session
from app.plan.parameters import PARAMETERS
from app.project.edit.players import set_habit, set_parameters
from app.project.performers import Player
from metadata.acting import names_in
from metadata.library import HABITS, STYLES
from widgets.common.chip import Chip
from widgets.common.clicks import on_switch
from widgets.common.combo import Combo, Option
from widgets.common.controls import Caption, Retranslated, named
from widgets.common.event_names import habit_name, style_name
from widgets.common.flow import FlowLayout
from widgets.common.instrument_name import language
from widgets.common.layouts import in_column, in_row
from widgets.common.text import parameter_text

_STYLE, _HABITS = PARAMETERS["style"], PARAMETERS["habits"]


class ActingRows(Retranslated, QWidget):
    """List of styles, and a switch for every habit.

    Signals
    -------
    shown(str)
        Short text about the players' style and habits, for the section's header; empty if the players differ.
    """

    shown = Signal(str)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._players: tuple[Player, ...] = ()
        self._style = named(Combo(), f"parameter_{_STYLE.name}")
        self._habits = self.texted(named(QWidget(), f"parameter_{_HABITS.name}"), tip=_HABITS.tip)
        self._flow = FlowLayout(self._habits)
        self._chips: dict[str, Chip] = {}
        choice = in_row(Caption(_STYLE.label, self._style), (self._style, 1), spacing=4)
        in_column(choice, Caption(_HABITS.label), self._habits, of=self, margins=0, spacing=4)
        self._style.chosen.connect(self._choose)
        session.metadata_changed.connect(self._show)
        self.retranslate()

    def show_players(self, players: Sequence[Player]) -> None:
        """Show the style and habits of one or more players."""
        self._players = tuple(players)
        self._show()

    def _show(self) -> None:
        known = STYLES.now().items
        styles = list(dict.fromkeys(player.parameters.style for player in self._players))
        names = sorted(known, key=lambda name: (name != _STYLE.default, style_name(name)))
        self._style.set_options([Option(name, style_name(name)) for name in (*names, *set(styles) - set(known))])
        self._style.show_option(styles[0] if len(styles) == 1 else None)
        said = [parameter_text(_STYLE.tip)]
        if len(styles) == 1 and styles[0] in known:
            said.append(known[styles[0]].description.in_language(language()))
        self._style.setToolTip("\n".join(said))
        had = [names_in(player.parameters.habits) for player in self._players]
        self._show_habits(had)
        common = set(had[0]).intersection(*had[1:]) if had else set()
        alike = len(styles) == 1 and all(set(each) == common for each in had)
        more = f" +{len(common)}" if common else ""
        self.shown.emit(style_name(styles[0]) + more if alike else "")

    def _show_habits(self, had: Sequence[Sequence[str]]) -> None:
        known = HABITS.now().items
        names = sorted({*known, *(name for each in had for name in each)})
        if list(self._chips) != names:
            self._flow.clear()
            self._chips = {name: self._chip(name) for name in names}
        for name, chip in self._chips.items():
            chip.setText(habit_name(name))
            chip.setAccessibleName(chip.text())
            count = sum(name in each for each in had)
            chip.setChecked(bool(had) and count == len(had))
            tip = known[name].description.in_language(language()) if name in known else ""
            some = self.tr("acting_rows.players_with_habit").format(count=count) if 0 < count < len(had) else ""
            chip.setToolTip("\n".join(filter(None, (tip, some))))

    def _chip(self, name: str) -> Chip:
        chip = named(Chip(self._session, habit_name(name), parent=self._habits), f"habit_{name}")
        on_switch(chip, lambda on: self._switch(name, on))
        self._flow.addWidget(chip)
        chip.show()
        return chip

    # Editing

    def _choose(self, style: str) -> None:
        chosen = self._session.players
        edit = edit_of_parameter(self._session.project, _STYLE.name, chosen)
        self._session.attempt(edit, lambda project: set_parameters(project, chosen, style=style), None, self)

    def _switch(self, habit: str, has: bool) -> None:
        chosen = self._session.players
        edit = edit_of_parameter(self._session.project, _HABITS.name, chosen)
        self._session.attempt(edit, lambda project: set_habit(project, chosen, habit, has), None, self)

    # Texts

    def retranslate(self) -> None:
        self._show()
