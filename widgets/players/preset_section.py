"""Presets: parameters the user keeps under a name, for this and other projects."""

from __future__ import annotations

from PySide6.QtWidgets import QHBoxLayout, QLineEdit, QToolButton, QWidget

from app.errors import AppError, Message
from app.project import presets
from app.project.edit import players as edit
from widgets.common.combo import Combo, Option
from widgets.common.controls import Retranslated, named
from widgets.common.icons import icon
from widgets.common.layouts import in_column
from widgets.common.section import Section
from widgets.common.session import Session, Severity

_TOOLS = (("apply", "check"), ("save", "save"), ("delete", "delete"))


class PresetSection(Retranslated, QWidget):
    """Apply a preset to the selected players, save theirs, delete one."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._found: dict[str, presets.Preset] = {}
        self._section = Section(session, "players_presets", self, folded=True)
        self._choice = named(Combo(), "preset_choice")
        self._name = named(QLineEdit(), "preset_name")
        self._tools = {name: QToolButton() for name, _ in _TOOLS}
        for name, button in self._tools.items():
            button.setObjectName(f"preset_{name}")
        for line in ((self._choice, ("apply", "delete")), (self._name, ("save",))):
            row = QHBoxLayout()
            row.setSpacing(2)
            row.addWidget(line[0], 1)
            for name in line[1]:
                row.addWidget(self._tools[name])
            self._section.body.addLayout(row)
        in_column(self._section, of=self, margins=0)
        self._section.header.toggled.connect(lambda is_open: self.show_presets() if is_open else None)
        self._choice.chosen.connect(lambda _: self._show_buttons())
        self._name.textChanged.connect(lambda _: self._show_buttons())
        self._name.returnPressed.connect(self._save)
        self._tools["apply"].clicked.connect(self._apply)
        self._tools["save"].clicked.connect(self._save)
        self._tools["delete"].clicked.connect(self._delete)
        session.players_changed.connect(self._show_buttons)
        session.theme_changed.connect(self._apply_theme)
        self._apply_theme()
        self.retranslate()
        if self._section.is_open:
            self.show_presets()

    def show_presets(self) -> None:
        """Read the folder anew and show what is there."""
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
                Message("edit.apply_preset", {"preset": preset.name, "count": len(chosen)}),
                lambda project: edit.set_parameters(project, chosen, **preset.parameters),
            )

    def _save(self) -> None:
        """Keep the parameters of the player in front."""
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

    def _apply_theme(self) -> None:
        for name, drawing in _TOOLS:
            self._tools[name].setIcon(icon(drawing, self._session.tokens))

    def retranslate(self) -> None:
        """Set every text in the language of the editor."""
        self._section.header.set_texts(self.tr("preset_section.presets"))
        self._choice.setPlaceholderText(self.tr("preset_section.no_presets_yet"))
        self._name.setPlaceholderText(self.tr("preset_section.name_for_new_preset"))
        self._tools["apply"].setToolTip(self.tr("preset_section.apply_to_selected_players"))
        self._tools["save"].setToolTip(self.tr("preset_section.save_parameters_of_player_in"))
        self._tools["delete"].setToolTip(self.tr("preset_section.delete_this_preset_from_your"))
        self._show_buttons()
