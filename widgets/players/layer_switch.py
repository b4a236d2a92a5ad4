"""Check box that shows or hides a motion layer of the selected players, beside its amount."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QCheckBox, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.edit_names import edit_of_players
from app.editor.session import Session
from app.editor.translated import tr
from app.plan.parameters import Parameter
from app.project.edit.players import show_layer
from app.project.performers import Player
from metadata.acting import names_in
from widgets.common.clicks import on_click
from widgets.common.controls import Retranslated


class LayerSwitch(Retranslated, QCheckBox):
    """A check box; partially checked if only some of the players show the layer.

    Parameters
    ----------
    amount : Parameter
        Parameter with the amount of the layer.
    slider : QWidget
        Control of the amount, disabled if no player shows the layer.
    """

    def __init__(self, session: Session, amount: Parameter, slider: QWidget) -> None:
        super().__init__()
        self._session, self._amount, self._slider = session, amount, slider
        self.setObjectName(f"layer_{amount.name}")
        self.setMinimumSize(LEAST_TARGET_PX, LEAST_TARGET_PX)
        on_click(self, self._switch)
        self.texted(self, explained=lambda: tr("layer_switch.show_layer").format(layer=tr(amount.label)))

    def show_players(self, players: Sequence[Player]) -> None:
        """Show whether one or more players show the layer."""
        shown = {self._amount.name not in names_in(player.parameters.layers_off) for player in players}
        states = {True: Qt.CheckState.Checked, False: Qt.CheckState.Unchecked}
        self.setCheckState(states[shown.pop()] if len(shown) == 1 else Qt.CheckState.PartiallyChecked)
        self._slider.setEnabled(self.checkState() != Qt.CheckState.Unchecked)

    def nextCheckState(self) -> None:
        """Check the box on a click if it is partially checked; otherwise toggle it."""
        self.setChecked(self.checkState() != Qt.CheckState.Checked)

    def _switch(self) -> None:
        chosen, name, shown = self._session.players, self._amount.name, self.isChecked()
        id = "edit.show_layer" if shown else "edit.hide_layer"
        edit = edit_of_players(self._session.project, id, chosen, parameter=self._amount.label)
        self._session.attempt(edit, lambda project: show_layer(project, chosen, name, shown), None, self)
