"""Section of presets: named parameters that the user stores for all projects."""

from __future__ import annotations

from PySide6.QtWidgets import QLineEdit, QWidget

from app.editor.edit_names import edit_of_players
from app.editor.session import Session, Severity
from app.errors import AppError, Message
from app.project import presets
from app.project.edit import players as edit
from widgets.common.combo import Combo, Option
from widgets.common.controls import IconButton, Retranslated, named
from widgets.common.layouts import in_column, in_row
from widgets.common.section import Section


class PresetSection(Retranslated, QWidget):
    """Section that applies a preset to the selected players, and saves and deletes presets."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._found: dict[str, presets.Preset] = {}
        self._section = Section(session, "players_presets", self, folded=True)
        self._choice = self.texted(named(Combo(), "preset_choice"), placeholder="preset_section.no_presets_yet")
        self._name = self.texted(named(QLineEdit(), "preset_name"), placeholder="preset_section.name_for_new_preset")
        self._tools = {
            "apply": IconButton(
                session, "check", "preset_section.apply_to_selected_players", self._apply, "preset_apply"
            ),
            "save": IconButton(
                session, "save", "preset_section.save_parameters_of_player_in", self._save, "preset_save"
            ),
            "delete": IconButton(
                session, "delete", "preset_section.delete_this_preset_from_your", self._delete, "preset_delete"
            ),
        }
        chosen = in_row((self._choice, 1), self._tools["apply"], self._tools["delete"], spacing=2)
        self._section.body.addLayout(chosen)
        self._section.body.addLayout(in_row((self._name, 1), self._tools["save"], spacing=2))
        in_column(self._section, of=self, margins=0)
        self._section.header.toggled.connect(lambda is_open: self.show_presets() if is_open else None)
        self._choice.chosen.connect(lambda _: self._show_buttons())
        self._name.textChanged.connect(lambda _: self._show_buttons())
        self._name.returnPressed.connect(self._save)
        session.players_changed.connect(self._show_buttons)
        self.texted(self._section.header, words=("preset_section.presets",))
        self.retranslate()
        if self._section.is_open:
            self.show_presets()

    def show_presets(self) -> None:
        """Read the folder of presets again, and show it."""
        found = presets.presets(presets.preset_folder())
        self._found = dict(found.items)
        for problem in found.problems:
            self._session.notice(problem, Severity.WARNING)
        self._choice.set_options([Option(name, name) for name in self._found])
        if self._choice.shown is None and self._found:
            self._choice.show_option(next(iter(self._found)))
        self._show_buttons()

    def _show_buttons(self) -> None:
        chosen, players = self._choice.shown is not None, bool(self._session.players)
        self._tools["apply"].setEnabled(chosen and players)
        self._tools["delete"].setEnabled(chosen)
        self._tools["save"].setEnabled(players and bool(self._name.text().strip()))

    def _apply(self) -> None:
        preset = self._found.get(self._choice.shown or "")
        chosen = self._session.players
        if preset is not None and chosen:
            self._session.attempt(
                edit_of_players(self._session.project, "edit.apply_preset", chosen, preset=preset.name),
                lambda project: edit.set_parameters(project, chosen, **preset.parameters),
            )

    def _save(self) -> None:
        """Save the parameters of the active player as a preset."""
        front = self._session.player
        if front is None or not self._name.text().strip():
            return
        try:
            preset = presets.preset_of(front.parameters, self._name.text())
            presets.save_preset(presets.preset_folder(), preset)
        except AppError as error:
            self._session.notice(error.message, Severity.ERROR)
            return
        self._name.clear()
        self.show_presets()
        self._choice.show_option(preset.name)
        self._show_buttons()
        self._session.notice(Message("preset.saved", {"name": preset.name}))

    def _delete(self) -> None:
        name = self._choice.shown
        if name is None:
            return
        try:
            presets.delete_preset(presets.preset_folder(), name)
        except AppError as error:
            self._session.notice(error.message, Severity.ERROR)
        self.show_presets()

    def retranslate(self) -> None:
        self._show_buttons()
