"""The inspector panel: selection with reasons; problems, manual changes and history."""

from __future__ import annotations

from contextlib import suppress

import msgspec
from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QScrollArea, QSplitter, QTabWidget, QWidget

from app.editor.session import Session
from app.errors import FileError
from app.formats.json_data import decode_json
from app.plan.event_id import EventId
from app.project.undoable_document import Change
from widgets.common.controls import Retranslated, named, wrapped
from widgets.common.layouts import STRETCH, in_column, panel
from widgets.common.plain import Label
from widgets.inspector.correction_list import CorrectionList
from widgets.inspector.event_section import EventSection
from widgets.inspector.expression_maker import ExpressionMaker
from widgets.inspector.generated_values import Generated
from widgets.inspector.history_list import HistoryList
from widgets.inspector.note_section import NoteSection
from widgets.inspector.problem_list import ProblemList
from widgets.inspector.take_section import TakeSection

MOST_COUNTED = 999
LISTS_SHARE = 0.55
WHOLE = 1000
"""Total of the splitter's sizes, which are shares of its height."""
TAB_EDGE_PX = 2
LEAST_LISTS_PX = 60
"""Least height of the lists with their tabs."""
USUAL_LISTS_PX = 120
"""Least height of the lists with their tabs, until the user drags the divider."""


class _State(msgspec.Struct, frozen=True):
    lists_share: float
    tab: int
    kept: bool = False


class InspectorPanel(Retranslated, QWidget):
    """Panel with the selected notes and events above, and lists of problems, manual changes and history below."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("inspector")
        self._session = session
        self._generated = Generated(session)
        self._notes = NoteSection(session, self._generated)
        self._events = EventSection(session, self._generated)
        self._take = TakeSection(session)
        self._maker = ExpressionMaker(session)
        self._empty = wrapped(Label())
        self._empty.setMargin(16)
        self._problems = ProblemList(session)
        self._corrections = CorrectionList(session, self._generated)
        self._history = HistoryList(session)
        self._problem_count = 0
        self._tabs = named(QTabWidget(), "inspector_tabs")
        self._build()
        session.selection_changed.connect(self.show_selection)
        session.performance_changed.connect(self._planned)
        session.problems_changed.connect(self.show_selection)
        session.players_changed.connect(self.show_selection)
        session.changed.connect(self._changed)
        session.grid_changed.connect(self.show_selection)
        session.pitch_display.changed.connect(self.show_selection)
        session.theme_changed.connect(self._apply_theme)
        self._generated.changed.connect(self.show_selection)
        self._problems.counted.connect(self._count_problems)
        self._maker.folded.connect(self.show_selection)
        self._apply_theme()
        self.retranslate()
        self._problems.show_problems()

    def _build(self) -> None:
        sections = (self._notes, self._events, self._take, self._empty, self._maker)
        scroll = QScrollArea()
        scroll.setWidgetResizable(True)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        scroll.setWidget(panel(in_column(*sections, STRETCH, margins=0, spacing=0)))
        pages = {"problems": self._problems, "corrections": self._corrections, "history": self._history}
        for name, page in pages.items():
            self._tabs.addTab(named(page, f"{name}_tab"), "")
        self._tabs.setDocumentMode(True)
        self._tabs.setUsesScrollButtons(True)
        self._tabs.setMinimumHeight(LEAST_LISTS_PX)
        self._problems.listed.connect(self._fit_lists)
        self._notes.diagram_placed.connect(self._fit_lists)
        self._splitter = QSplitter(Qt.Orientation.Vertical)
        self._splitter.addWidget(scroll)
        self._splitter.addWidget(self._tabs)
        self._splitter.setChildrenCollapsible(False)
        self._splitter.splitterMoved.connect(self._divided_by_hand)
        self.divide(LISTS_SHARE)
        in_column(self._splitter, of=self, margins=0)

    def divide(self, lists_share: float, tab: int = 0, kept: bool = False) -> None:
        """Set the lists' share of the panel's height, and the current tab.

        Parameters
        ----------
        lists_share : float
            Greatest share of the lists, 0..1; less if all problems fit into less, or if a note's fingering needs the
            space.
        tab : int
            Index of the tab.
        kept : bool
            Whether the lists keep this share even for few problems, as after the user dragged the divider.
        """
        self._lists_share, self._kept = min(max(lists_share, 0.0), 1.0), kept
        self._diagram_px = 0
        lists = round(self._lists_share * WHOLE)
        self._splitter.setStretchFactor(0, WHOLE - lists)
        self._splitter.setStretchFactor(1, lists)
        self._splitter.setSizes([WHOLE - lists, lists])
        self._tabs.setCurrentIndex(tab)
        self._fit_lists()

    def _divided_by_hand(self) -> None:
        above, below = self._splitter.sizes()
        self._lists_share, self._kept = below / max(above + below, 1), True

    def _fit_lists(self) -> None:
        """Fit the lists to the problems, so that the selection gets the remaining space and a fingering stays visible.
        All lists have the same height, so that the tabs do not move.
        """
        if self._kept or not self.isVisible():
            return
        whole_px = sum(self._splitter.sizes())
        tabs_px = self._tabs.tabBar().sizeHint().height() + TAB_EDGE_PX
        # Keeps its height, so that it does not jump when the selection changes.
        self._diagram_px = max(self._diagram_px, self._notes.diagram_bottom_px)
        lists_px = min(round(self._lists_share * whole_px), self._problems.height_px() + tabs_px)
        least_px = max(self._problems.height_px(1) + tabs_px, USUAL_LISTS_PX)
        lists_px = max(min(lists_px, whole_px - self._diagram_px), least_px)
        if lists_px != self._splitter.sizes()[1]:
            self._splitter.setSizes([whole_px - lists_px, lists_px])

    def save_state(self) -> str:
        """Return the lists' share of the height and the current tab as text."""
        state = _State(self._lists_share, self._tabs.currentIndex(), self._kept)
        return msgspec.json.encode(state).decode()

    def restore_state(self, state: str) -> None:
        """Restore the layout of the panel from the text that `save_state` returned; any other text is ignored."""
        with suppress(FileError):
            saved = decode_json(state.encode("utf-8", "replace"), _State, "")
            self.divide(saved.lists_share, saved.tab, saved.kept)

    def show_selection(self) -> None:
        """Show the selected notes and events, or the selected take."""
        notes, events, take = self._notes.show_notes(), self._events.show_events(), self._take.show_take()
        self._empty.setVisible(not notes and not events and not take and not self._maker.is_open)
        varied = any(EventId.parse(key.event_id).kind == "vary" for key in self._session.selection.events)
        performed, click = "inspector_panel.regenerated_bars_hint", "inspector_panel.nothing_selected_hint"
        self._empty.setText(self.tr(performed if varied else click))

    def _changed(self, change: Change) -> None:
        if change.before.score.parts is not change.after.score.parts or change.opened:
            self.show_selection()
        elif change.before.takes is not change.after.takes:
            self._take.show_take()
        if change.before.corrections is not change.after.corrections or change.opened:
            self._show_tab_texts()

    def _planned(self) -> None:
        self.show_selection()
        self._show_tab_texts()

    def _count_problems(self, count: int) -> None:
        if count != self._problem_count:
            self._problem_count = count
            self._show_tab_texts()

    def _show_tab_texts(self) -> None:
        by_hand = sum(len(items) for items in self._session.project.corrections.values())
        problems = self._problem_count
        texts = (
            self.tr("inspector_panel.problems").format(count=_short(problems))
            if problems
            else self.tr("inspector_panel.problems_2"),
            self.tr("inspector_panel.by_hand").format(count=_short(by_hand))
            if by_hand
            else self.tr("inspector_panel.corrections"),
            self.tr("inspector_panel.history"),
        )
        for number, text in enumerate(texts):
            self._tabs.setTabText(number, text)

    def _apply_theme(self) -> None:
        self._empty.setStyleSheet(f"color: {self._session.tokens.text_dim};")

    def retranslate(self) -> None:
        self._show_tab_texts()
        self.show_selection()

    # Qt overrides

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit_lists()


def _short(count: int) -> str:
    return str(count) if count <= MOST_COUNTED else f"{MOST_COUNTED}+"
