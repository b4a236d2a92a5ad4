"""The players' panel: players, parameters and places."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QContextMenuEvent, QResizeEvent
from PySide6.QtWidgets import QLineEdit, QScrollArea, QSplitter, QWidget

from app.editor.edit_names import edit_of_parameter
from app.editor.player_marks import PlayerMark, mark_players
from app.editor.session import Session
from app.errors import Message
from app.optional_features import modules
from app.project.edit import players as edit
from app.project.edit.generation import vary_players
from app.project.player_sections import are_worth_grouping, sections
from app.project.undoable_document import Change
from instrument_maps.library import all_maps, library
from widgets.common.clicks import on_click
from widgets.common.controls import Caption, IconButton, PictureButton, Retranslated, named, wrapped
from widgets.common.instrument_name import family_name, instrument_name
from widgets.common.layouts import STRETCH, in_column, in_row, panel
from widgets.common.menus import offer_actions, passing_menu
from widgets.common.number_slider import NumberSlider
from widgets.common.plain import Label, verbatim
from widgets.common.section import Section
from widgets.common.text import sentence
from widgets.players.parameters import ParameterSections
from widgets.players.performer_edits import (
    add_player,
    duplicate_players,
    randomise_players,
    remove_players,
    reset_players,
)
from widgets.players.player_list import PlayerList
from widgets.players.player_rows import PlayerRow, Row, SectionRow
from widgets.players.preset_section import PresetSection
from widgets.players.stage_section import StageSection

MENU = (
    "dancers.add",
    "players.rename",
    "players.duplicate",
    "players.join",
    "players.separate",
    "players.remove",
    "",
    "players.mute",
    "players.solo",
    "players.mute_section",
    "players.solo_section",
    "players.posture",
    "players.reset",
    "",
    "players.select_section",
    "players.select_all",
    "players.randomise",
    "players.dress_everyone",
    "players.arrange",
    "",
    "players.grouped",
    "players.fold_sections",
)
"""Action ids of the context menu; an empty one is a separator."""
LEAST_LIST_PX = 130
SEARCHED_FROM = 9
"""Number of players from which the list has a search field."""
LIST_SHARE = 0.5
"""Largest share of the list in the panel's height, so that parameters have room."""


class PlayersPanel(Retranslated, QWidget):
    """The list of players, and the parameters of the selected ones."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("players")
        self._session = session
        duplicate, remove = partial(duplicate_players, session), partial(remove_players, session)
        self._tools = {
            "add": self._tool("add", "players_panel.add_player", self._offer_instruments),
            "duplicate": self._tool("duplicate", "players_panel.duplicate_same_part", duplicate),
            "remove": self._tool("delete", "players_panel.remove_selected_players", remove),
        }
        self.list = named(PlayerList(session), "player_list")
        self.search = self.texted(
            named(QLineEdit(), "players_search"), placeholder="players_panel.search", tip="players_panel.search_tip"
        )
        self.search.setClearButtonEnabled(True)
        self._empty = wrapped(Caption("players_panel.no_players_yet_add_player"))
        self._empty.setContentsMargins(12, 4, 12, 4)
        self._parameters = ParameterSections(session)
        self._stage = StageSection(session)
        self._presets = PresetSection(session)
        self.sections: dict[str, Any] = {
            feature.id: module.SECTION(session) for feature, module in modules("players_section")
        }
        """Sections that features add below, by their ids."""
        self._variety = Section(session, "players_variety")
        self._spread = self.texted(
            named(NumberSlider(session, 0.0, 1.0, default=session.variety, step=0.05), "spread"),
            words=("players_panel.spread", "", "players_panel.difference_tip"),
        )
        throw = (
            "players_panel.randomise",
            partial(randomise_players, session),
            "randomise",
            "players_panel.randomise_tip",
        )
        self._throw = PictureButton(session, "dice", *throw)
        reset = ("players_panel.reset", partial(reset_players, session), "reset_parameters")
        self._reset = PictureButton(session, "reset", *reset, "players_panel.return_all_parameters_of_selected")
        self._build()
        self._connect()
        self.retranslate()

    # Construction

    def _tool(self, picture: str, tip_id: str, run: Callable[[], object]) -> IconButton:
        name = "remove" if picture == "delete" else picture
        return IconButton(self._session, picture, tip_id, run, f"players_{name}_button")

    def _build(self) -> None:
        self._count = Label()
        bar = in_row((self._count, 1), *self._tools.values(), margins=(6, 4, 4, 4), spacing=2)
        upper = panel(in_column(bar, self.search, (self.list, 1), (self._empty, 1), margins=0, spacing=0))
        buttons = in_row((self._throw, 1), (self._reset, 1), spacing=4)
        self._variety.body.addWidget(self._spread)
        self._variety.body.addLayout(buttons)
        parts = (self._parameters, self._stage, self._variety, self._presets, *self.sections.values())
        lower = panel(in_column(*parts, STRETCH, margins=0, spacing=0))
        scroll = QScrollArea()
        scroll.setWidgetResizable(True)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setWidget(lower)
        self._scroll = scroll
        scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._divided = False
        self._splitter = QSplitter(Qt.Orientation.Vertical)
        self._splitter.addWidget(upper)
        self._splitter.addWidget(scroll)
        self._splitter.setStretchFactor(1, 1)
        self._splitter.setChildrenCollapsible(False)
        self._splitter.splitterMoved.connect(self._splitter_moved)
        in_column(self._splitter, of=self, margins=0)

    def _connect(self) -> None:
        session = self._session
        session.changed.connect(self._changed)
        session.performance_changed.connect(self._show_list)
        session.problems_changed.connect(self._show_list)
        session.players_changed.connect(self._players_changed)
        session.theme_changed.connect(self._show_list)
        session.folded_changed.connect(self._show_list)
        session.groups_players_changed.connect(self._show_list)
        for section in self.sections.values():
            section.sought.connect(partial(self._scroll_to, section))
        self.list.chosen.connect(session.set_players)
        self.search.textChanged.connect(self.list.search)
        self.search.returnPressed.connect(self._select_found)
        self.list.mute_clicked.connect(partial(self._toggle, "muted"))
        self.list.arm_clicked.connect(self._arm)
        self.list.solo_clicked.connect(partial(self._toggle, "soloed"))
        self.list.folded.connect(self._fold)
        self.list.moved.connect(self._move)
        self.list.ordered.connect(self._order)
        self.list.rows.renamed.connect(self._rename)
        self._parameters.dice_thrown.connect(self._reseed)
        self._spread.changed.connect(self._set_spread)

    # Display

    def _splitter_moved(self) -> None:
        self._divided = True

    def divide(self, upper_px: int | None = None) -> None:
        """Set the height of the list in pixels; None for the height that it needs."""
        self._divided = upper_px is not None
        if upper_px is not None:
            self._splitter.setSizes([upper_px, max(self._splitter.height() - upper_px, 1)])
        self._divide()

    def save_state(self) -> str:
        """Return the list's height set by the user as text; empty if not set."""
        return str(self._splitter.sizes()[0]) if self._divided else ""

    def restore_state(self, state: str) -> None:
        """Restore the division of the panel from the text that `save_state` returned; any other text is ignored."""
        if not state or (state.isascii() and state.isdecimal() and len(state) < 6):
            self.divide(int(state) if state else None)

    def _divide(self) -> None:
        """Give the list the height that its rows need, up to about half of the panel, unless the user has moved the
        divider.
        """
        height = self._splitter.height()
        if self._divided or not height:
            return
        tools_px = self._tools["add"].sizeHint().height() + 14
        if self._empty.isVisibleTo(self):
            # The whole text must be visible.
            upper = self._empty.heightForWidth(self.width()) + tools_px
        else:
            upper = min(max(self.list.height_of_rows() + tools_px, LEAST_LIST_PX), round(LIST_SHARE * height))
            # The search field adds to the height, so that the rows do not lose any.
            upper += self.search.sizeHint().height() if self.search.isVisibleTo(self) else 0
        self._splitter.setSizes([upper, height - upper])

    def _changed(self, change: Change) -> None:
        before, after = change.before, change.after
        if before.players is not after.players or before.score.parts is not after.score.parts or change.opened:
            self._show_all()
        elif before.dancers is not after.dancers:
            self._stage.show_places()

    def _players_changed(self) -> None:
        self.list.show_selection()
        self._parameters.show_players()
        self._stage.show_places()
        self._show_buttons()

    def _show_all(self) -> None:
        self._show_list()
        self._parameters.show_players()
        self._stage.show_places()
        self._show_buttons()

    def _show_list(self) -> None:
        project, performance = self._session.project, self._session.performance
        first = min(
            (plan.cues[0] for plan in self._session.plans.values() if plan.cues),
            key=lambda cue: cue.start_s,
            default=None,
        )
        leader = first.player_id if first is not None else None
        maps = all_maps()
        rows = []
        for player in project.players:
            instrument, unseen = maps.get(player.instrument_id), performance.unseen.get(player.id)
            played = instrument_name(instrument) if instrument is not None else player.instrument_id
            musician = project.musician(player)
            if musician is not player:
                played = self.tr("players_panel.played_by").format(instrument=played, name=musician.name)
            rows.append(
                PlayerRow(
                    player,
                    self._session.colour(player),
                    played,
                    len(self._session.problems(player.id)),
                    player.id == leader,
                    "" if unseen is None else sentence(unseen, self._session, player.id),
                )
            )
        if len(rows) < SEARCHED_FROM:
            self.search.clear()
        self.search.setVisible(len(rows) >= SEARCHED_FROM)
        self.list.show_rows(self._by_section(rows))
        self.list.setVisible(bool(rows))
        self._empty.setVisible(not rows)
        self._divide()

    def _by_section(self, rows: list[PlayerRow]) -> list[Row]:
        """Return the rows with players under the headers of their sections, if this is switched on and useful."""
        session = self._session
        if not (session.groups_players and are_worth_grouping(session.project)):
            return list(rows)
        by_id, result = {row.id: row for row in rows}, list[Row]()
        for section in sections(session.project):
            own = tuple(by_id[id] for id in section.player_ids)
            folded = session.folded.get(section.fold_name, False)
            result += [SectionRow(section.fold_name, family_name(section.family), own, folded), *own]
        return result

    def _select_found(self) -> None:
        """Select all players that the search shows."""
        if self.list.found:
            self._session.set_players(self.list.found)

    def _show_buttons(self) -> None:
        chosen, everyone = self._session.players, self._session.project.players
        musicians = len(self._session.project.bodies)
        self._count.setText(
            self.tr("players_panel.of_selected").format(chosen=len(chosen), count=len(everyone))
            if len(chosen) > 1
            else self.tr("players_panel.players").format(count=musicians)
        )
        for name in ("duplicate", "remove"):
            self._tools[name].setEnabled(bool(chosen))
        self._throw.setEnabled(bool(everyone))
        self._reset.setEnabled(bool(chosen))
        whom = self.tr("players_panel.selected_players") if len(chosen) > 1 else self.tr("players_panel.all_players")
        self._variety.header.set_texts(self.tr("players_panel.variety"), whom)

    def _scroll_to(self, section: QWidget) -> None:
        """Scroll until a section is visible, after its height has changed."""
        QTimer.singleShot(0, self, lambda: self._scroll.verticalScrollBar().setValue(section.y()))

    # Editing

    def _rename(self, player_id: str, name: str) -> None:
        before = self._session.project.player(player_id).name
        self._session.attempt(
            Message("edit.rename_player", {"player": before}), lambda project: edit.rename(project, player_id, name)
        )

    def _toggle(self, field: PlayerMark, player_ids: tuple[str, ...]) -> None:
        """Mute or solo the given players: those of a section, or one player together with all selected ones if it is
        selected.
        """
        session = self._session
        chosen = session.players if len(player_ids) == 1 and player_ids[0] in session.players else player_ids
        on = not all(getattr(session.project.player(player_id), field) for player_id in player_ids)
        mark_players(session, field, on, chosen)

    def _fold(self, section_names: tuple[str, ...], folded: bool) -> None:
        for name in section_names:
            self._session.set_folded(name, folded)

    def _arm(self, player_id: str) -> None:
        recording = self._session.recording
        recording.set(armed="" if recording.armed == player_id else player_id)

    def _move(self, player_ids: tuple[str, ...], before: int) -> None:
        self._session.attempt(
            Message("edit.move_players"), lambda project: edit.move_players(project, player_ids, before)
        )

    def _order(self, player_ids: tuple[str, ...]) -> None:
        self._session.attempt(Message("edit.move_players"), lambda project: edit.order_players(project, player_ids))

    def _offer_instruments(self) -> None:
        menu = passing_menu(self, "instrument_menu")
        for instrument in library().in_score_order:
            action = menu.addAction(verbatim(instrument_name(instrument)))
            on_click(action, self.add, instrument.id)
        button = self._tools["add"]
        menu.popup(button.mapToGlobal(button.rect().bottomLeft()))

    def add(self, instrument_id: str) -> None:
        """Add a player with an instrument, and make it active."""
        add_player(self._session, instrument_id)

    def _reseed(self) -> None:
        chosen = self._session.players
        name = edit_of_parameter(self._session.project, "seed", chosen)
        self._session.attempt(name, lambda project: vary_players(project, chosen))

    def _set_spread(self, value: float, token: object) -> None:
        self._session.variety = value

    # Texts

    def retranslate(self) -> None:
        self._spread.show_value(self._session.variety)
        self._show_all()

    # Qt overrides

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._divide()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        inside = self.list.rect().contains(self.list.mapFromGlobal(event.globalPos()))
        if inside:
            offer_actions(self._session, MENU, self, "players_menu", event.globalPos())
