"""Section of places on the stage: the top view, and the numbers of the active player."""

from __future__ import annotations

from PySide6.QtWidgets import QGridLayout, QWidget

from app.editor.edit_names import edit_of_players
from app.editor.session import Session
from app.errors import Message
from app.project.casting import StagePosition
from app.project.edit import players as edit
from app.project.edit.dancers import place_dancers
from widgets.common.controls import IconButton, Retranslated, named
from widgets.common.layouts import in_column
from widgets.common.section import Section
from widgets.players.place_numbers import place_sliders, shown_number, with_number
from widgets.players.stage import StageView


class StageSection(Retranslated, QWidget):
    """Section with the top view of the stage, and tools for the places of the selected players."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._section = Section(session, "players_stage", self)
        self.view = self.texted(named(StageView(session), "stage"), name="stage_section.stage_tip")
        self._snap = IconButton(session, "snap", "stage_section.snap_tip", self._set_snap, "stage_snap")
        arc_tip = "stage_section.automatic_arc_everyone_in_order"
        self._arc = IconButton(session, "stage", arc_tip, self._arrange, "stage_arc")
        self._snap.setCheckable(True)
        self._section.header.add_button(self._snap)
        self._section.header.add_button(self._arc)
        self._numbers = place_sliders(self, session, "stage")
        grid = QGridLayout()
        grid.setSpacing(4)
        for place, (name, number) in enumerate(self._numbers.items()):
            number.changed.connect(lambda value, token, name=name: self._set(name, value, token))
            number.released.connect(session.document.end_gesture)
            grid.addWidget(number, place // 2, place % 2, 1, 1 + place // 2)
        self._section.body.addWidget(self.view)
        self._section.body.addLayout(grid)
        in_column(self._section, of=self, margins=0)
        self.view.placed.connect(self._place)
        self.view.released.connect(session.document.end_gesture)
        self.view.chosen.connect(session.set_players)
        session.dancer_changed.connect(self.view.update)
        self.texted(self._section.header, words=("stage_section.stage",))
        self.retranslate()

    def show_places(self) -> None:
        """Show the places of all performers."""
        self.view.update()
        project = self._session.project
        stages = [project.player(player_id).stage for player_id in self._session.players]
        arc = {player.id: spot for player, spot in zip(project.players, edit.arc_of(project), strict=True)}
        for name, number in self._numbers.items():
            number.setEnabled(bool(stages))
            if stages:
                shown = [shown_number(stage, name) for stage in stages]
                usual = [shown_number(arc[player_id], name) for player_id in self._session.players]
                apart = any(abs(one - other) > 5e-3 for one, other in zip(shown, usual, strict=True))
                number.show_value(shown[0], mixed=len(set(shown)) > 1, default=usual[0], by_hand=apart)

    def _set_snap(self) -> None:
        self.view.snaps = self._snap.isChecked()

    def _name(self) -> Message:
        return edit_of_players(self._session.project, "edit.place_players", self._session.players)

    def _place(self, places: dict[str, StagePosition], token: object) -> None:
        dancers = [self._session.project.dancer(id) for id in places if id in self._session.project.dancer_ids]
        name = Message("edit.dancer_place", {"dancer": dancers[0].name}) if dancers else self._name()
        self._session.attempt(name, lambda project: place_dancers(edit.place(project, places), places), token)

    def _set(self, name: str, value: float, token: object | None) -> None:
        project = self._session.project
        places = {
            player_id: with_number(project.player(player_id).stage, name, value) for player_id in self._session.players
        }
        self._session.attempt(self._name(), lambda project: edit.place(project, places), token)

    def _arrange(self) -> None:
        self._session.attempt(Message("edit.arrange_players"), edit.arrange)

    def retranslate(self) -> None:
        self.view.update()
