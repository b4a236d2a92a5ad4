"""The bar above the ruler: tools, active player, and display of other players' notes."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QActionGroup, QColor, QIcon, QPalette, QPixmap, QResizeEvent
from PySide6.QtWidgets import QButtonGroup, QHBoxLayout, QMenu, QSizePolicy, QToolButton, QWidget

from app.editor.session import Session
from app.editor.timeline_view import Ghosts, Tool
from app.project.undoable_document import Change
from widgets.common.actions import with_keys
from widgets.common.controls import Retranslated, named
from widgets.common.icons import icon
from widgets.common.plain import ComboBox, Label
from widgets.timeline.roll.piano_roll import PianoRoll

ICONS = {Tool.SELECT: "pointer", Tool.DRAW: "pencil", Tool.ERASE: "eraser", Tool.SPLIT: "split"}
TOOL_TIPS = {
    Tool.SELECT: "tool_bar.select_click_drag_frame_drag",
    Tool.DRAW: "tool_bar.draw_drag_out_new_note",
    Tool.ERASE: "tool_bar.erase_drag_over_notes",
    Tool.SPLIT: "tool_bar.split_click_where_note_shall",
}
MODES = {
    Ghosts.GHOSTS: "tool_bar.ghost_notes",
    Ghosts.SELECTED: "tool_bar.selected_as_ghosts",
    Ghosts.ALL: "tool_bar.all_players",
    Ghosts.ALONE: "tool_bar.only_this_player",
}
GHOST_ICONS = {Ghosts.GHOSTS: "ghosts", Ghosts.SELECTED: "ghosts", Ghosts.ALL: "players", Ghosts.ALONE: "player"}
BUTTON_PX = 26
READOUT_PX = 160
"""Width in pixels for the description of the object under the mouse."""
SWATCH_PX = 12


class ToolBar(Retranslated, QWidget):
    """Bar with the piano roll's tools, the active player, and the display of other players' notes."""

    def __init__(self, session: Session, roll: PianoRoll, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("timeline_tools")
        self.setAutoFillBackground(True)
        self._session = session
        self._roll = roll
        row = QHBoxLayout(self)
        row.setContentsMargins(4, 2, 4, 2)
        row.setSpacing(2)
        self.tools: dict[Tool, QToolButton] = {}
        self._shrinking: list[QToolButton] = []
        """Buttons that are their picture only where there is no room for texts, in this order."""
        group = QButtonGroup(self)
        for tool in Tool:
            button = self._button(f"tool_{tool.value}")
            button.setCheckable(True)
            text_id = TOOL_TIPS[tool]
            self.texted(button, tip=with_keys(session, f"notes.tool_{tool.value}", text_id), name=text_id)
            group.addButton(button)
            self.tools[tool] = button
            row.addWidget(button)
        group.buttonClicked.connect(self._choose_tool)
        row.addSpacing(8)
        self.player_box = self.texted(named(ComboBox(self), "front_player"), tip="tool_bar.active_player_tip")
        self.player_box.setSizePolicy(QSizePolicy.Policy.Maximum, QSizePolicy.Policy.Fixed)
        self.player_box.setMinimumWidth(150)
        self.player_box.setMaximumWidth(280)
        self.player_box.setIconSize(QSize(SWATCH_PX, SWATCH_PX))
        self.player_box.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.player_box.activated.connect(self._choose_player)
        row.addWidget(self.player_box)
        self.ghosts_button = self.texted(self._button("ghosts_mode"), tip="tool_bar.how_other_players_notes_are")
        self.ghosts_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.ghosts_button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.ghosts_button.setMaximumWidth(16777215)
        menu = QMenu(self.ghosts_button)
        self.ghosts_button.setMenu(menu)
        self._modes = {mode: self.texted(menu.addAction(""), text=text_id) for mode, text_id in MODES.items()}
        modes = QActionGroup(self)
        for mode, action in self._modes.items():
            action.setCheckable(True)
            action.setData(mode)
            modes.addAction(action)
        modes.triggered.connect(lambda action: self._choose_ghosts(action.data()))
        row.addWidget(self.ghosts_button)
        row.addStretch(1)
        self.readout = named(Label(parent=self), "readout")
        self.readout.setForegroundRole(QPalette.ColorRole.PlaceholderText)
        row.addWidget(self.readout)
        roll.reported.connect(self.report)
        session.selection_changed.connect(self._count)
        session.changed.connect(self._session_changed)
        session.players_changed.connect(self._fill_players)
        session.theme_changed.connect(self._theme_set)
        self._theme_set()
        self.retranslate()
        self.show_state()

    def show_lanes_and_zoom(self, lanes: QToolButton, *zoom: QToolButton) -> None:
        """Add the lanes' menu button next to the button for other players' notes, and the zoom buttons at the right."""
        row = self.layout()
        assert isinstance(row, QHBoxLayout)
        row.insertWidget(row.indexOf(self.ghosts_button) + 1, lanes)
        self._shrinking = [lanes, self.ghosts_button]
        for button in zoom:
            row.addWidget(button)

    def _button(self, name: str) -> QToolButton:
        button = named(QToolButton(self), name)
        button.setAutoRaise(True)
        button.setMinimumSize(QSize(BUTTON_PX, BUTTON_PX))
        return button

    def retranslate(self) -> None:
        self._fill_players()
        self.show_state()
        self._count()

    def show_state(self) -> None:
        """Update the buttons to the current tool and display of other players' notes."""
        self.tools[self._roll.tool].setChecked(True)
        mode = self._roll.ghosts_mode
        self._modes[mode].setChecked(True)
        self.ghosts_button.setText(self._modes[mode].text())
        self.ghosts_button.setIcon(icon(GHOST_ICONS[mode], self._session.tokens))
        self._fit_texts()

    def report(self, text: str) -> None:
        """Show a text about the object under the mouse; if it is empty, the number of selected objects."""
        if text:
            self.readout.setText(text)
        else:
            self._count()

    def _count(self) -> None:
        count = len(self._session.selection.notes)
        self.readout.setText(self.tr("tool_bar.selected_notes").format(count=count) if count else "")

    def _choose_tool(self, button: QToolButton) -> None:
        view = self._session.timeline_view
        if view is not None:
            view.set_tool(next(tool for tool, each in self.tools.items() if each is button))

    def _choose_ghosts(self, mode: Ghosts) -> None:
        self._roll.set_ghosts(mode)
        self.show_state()

    def _choose_player(self, index: int) -> None:
        self._session.set_players((self.player_box.itemData(index),))
        # The arrow keys act on notes again.
        timeline = self.parentWidget()
        if timeline is not None:
            timeline.setFocus()

    def _session_changed(self, change: Change) -> None:
        if change.opened or change.before.players is not change.after.players:
            self._fill_players()

    def _fill_players(self) -> None:
        self.player_box.clear()
        for player in self._session.project.players:
            swatch = QPixmap(SWATCH_PX, SWATCH_PX)
            swatch.fill(QColor(self._session.colour(player)))
            self.player_box.addItem(QIcon(swatch), player.name, player.id)
        front = self._session.player
        self.player_box.setCurrentIndex(self.player_box.findData(front.id) if front is not None else -1)
        self.player_box.setEnabled(front is not None)

    def _theme_set(self) -> None:
        tokens = self._session.tokens
        for tool, button in self.tools.items():
            button.setIcon(icon(ICONS[tool], tokens))
        palette = self.palette()
        palette.setColor(QPalette.ColorRole.Window, QColor(tokens.surface))
        self.setPalette(palette)
        self._fill_players()
        self.show_state()

    def _fit_texts(self) -> None:
        """Show the texts of as many buttons as fit; the others show only icons."""
        row = self.layout()
        if row is None:
            return
        for style in (Qt.ToolButtonStyle.ToolButtonTextBesideIcon, Qt.ToolButtonStyle.ToolButtonIconOnly):
            for button in self._shrinking:
                row.invalidate()
                needed = row.sizeHint().width() + max(READOUT_PX - self.readout.sizeHint().width(), 0)
                if style is Qt.ToolButtonStyle.ToolButtonTextBesideIcon or needed > self.width():
                    button.setToolButtonStyle(style)

    # Qt overrides

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit_texts()
