"""Places on the stage: the top view, and the numbers of the player in front."""

from __future__ import annotations

import math

import msgspec
from PySide6.QtCore import QEvent
from PySide6.QtWidgets import QGridLayout, QToolButton, QVBoxLayout, QWidget

from app.errors import Message
from app.project.casting import StagePosition
from app.project.edit import players as edit
from app.project.edit.dancers import place_dancers
from widgets.common.icons import icon
from widgets.common.number_slider import NumberSlider
from widgets.common.section import Section
from widgets.common.session import Session
from widgets.players.stage import FARTHEST_M, StageView


class StageSection(QWidget):
    """The stage from above with its tools; edits the places of the selected players."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._section = Section(session, "players_stage", self)
        self.view = StageView(session)
        self.view.setObjectName("stage")
        self._snap, self._arc = QToolButton(), QToolButton()
        self._snap.setObjectName("stage_snap")
        self._arc.setObjectName("stage_arc")
        self._snap.setCheckable(True)
        self._snap.toggled.connect(self._set_snap)
        self._arc.clicked.connect(self._arrange)
        self._section.header.add_button(self._snap)
        self._section.header.add_button(self._arc)
        self._numbers = {
            name: NumberSlider(session, -reach, reach, decimals=decimals, step=step, slides=slides)
            for name, reach, decimals, step, slides in (
                ("x_m", FARTHEST_M, 2, 0.05, False),
                ("z_m", FARTHEST_M, 2, 0.05, False),
                ("turn_rad", 180.0, 0, 5.0, True),
            )
        }
        grid = QGridLayout()
        grid.setSpacing(4)
        for place, (name, number) in enumerate(self._numbers.items()):
            number.setObjectName(f"stage_{name}")
            number.changed.connect(lambda value, token, name=name: self._set(name, value, token))
            number.released.connect(session.document.end_gesture)
            grid.addWidget(number, place // 2, place % 2, 1, 1 + place // 2)
        self._section.body.addWidget(self.view)
        self._section.body.addLayout(grid)
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.addWidget(self._section)
        self.view.placed.connect(self._place)
        self.view.released.connect(session.document.end_gesture)
        self.view.chosen.connect(session.set_players)
        session.theme_changed.connect(self._dress)
        session.dancer_changed.connect(self.view.update)
        self._dress()
        self.retranslate()

    def show_places(self) -> None:
        """Show where everybody stands."""
        self.view.update()
        project = self._session.project
        stages = [project.player(player_id).stage for player_id in self._session.players]
        arc = {player.id: spot for player, spot in zip(project.players, edit.arc_of(project), strict=True)}
        for name, number in self._numbers.items():
            number.setEnabled(bool(stages))
            if stages:
                shown = [_shown(stage, name) for stage in stages]
                usual = [_shown(arc[player_id], name) for player_id in self._session.players]
                apart = any(abs(one - other) > 5e-3 for one, other in zip(shown, usual, strict=True))
                number.show_value(shown[0], mixed=len(set(shown)) > 1, default=usual[0], by_hand=apart)

    def _set_snap(self, snaps: bool) -> None:
        self.view.snaps = snaps

    def _name(self) -> Message:
        return Message("edit.place_players", {"count": len(self._session.players)})

    def _place(self, places: dict[str, StagePosition], token: object) -> None:
        dancers = [self._session.project.dancer(id) for id in places if id in self._session.project.dancer_ids]
        name = Message("edit.dancer_place", {"dancer": dancers[0].name}) if dancers else self._name()
        self._session.attempt(name, lambda project: place_dancers(edit.place(project, places), places), token)

    def _set(self, name: str, value: float, token: object | None) -> None:
        wanted = math.radians(value) if name == "turn_rad" else value
        project = self._session.project
        places = {
            player_id: msgspec.structs.replace(project.player(player_id).stage, **{name: wanted})
            for player_id in self._session.players
        }
        self._session.attempt(self._name(), lambda project: edit.place(project, places), token)

    def _arrange(self) -> None:
        self._session.attempt(Message("edit.arrange_players"), edit.arrange)

    def _dress(self) -> None:
        self._snap.setIcon(icon("snap", self._session.tokens))
        self._arc.setIcon(icon("stage", self._session.tokens))

    def retranslate(self) -> None:
        """Set every text in the language of the editor."""
        self._section.header.set_texts(self.tr("Stage"))
        self._snap.setToolTip(self.tr("Snap to 0.1 m and 5° (Alt: the other way round)"))
        self._arc.setToolTip(self.tr("Automatic arc: everyone in order, open to the audience"))
        self.view.setAccessibleName(self.tr("Stage from above"))
        metres = self.tr("m", "metres")
        tips = {
            "x_m": (self.tr("X"), metres, self.tr("To the right as the audience sees it, from the middle")),
            "z_m": (self.tr("Z"), metres, self.tr("Towards the audience, from the middle")),
            "turn_rad": (
                self.tr("Turn"),
                "°",
                self.tr("0 faces the audience, positive turns to the right as the audience sees it"),
            ),
        }
        for name, (label, unit, tip) in tips.items():
            self._numbers[name].set_texts(label, unit, tip)
        self.view.update()

    # Qt's own names

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


def _shown(stage: StagePosition, name: str) -> float:
    """A number of a place as it is shown: metres or degrees."""
    return round(math.degrees(stage.turn_rad)) + 0.0 if name == "turn_rad" else float(getattr(stage, name))
