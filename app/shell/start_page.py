"""The page shown while no project is open: new, open, recent files and example."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from PySide6.QtCore import QDateTime, QLocale, QSize, Qt
from PySide6.QtGui import QFontMetrics
from PySide6.QtWidgets import QFrame, QPushButton, QScrollArea, QVBoxLayout, QWidget

from app.editor.files import Files
from app.editor.session import Session
from app.editor.settings import Settings
from app.editor.translated import tr
from app.encoding import shown
from app.formats.other_computers import is_file, may_touch
from app.project.recovery import Recoverable
from widgets.common.actions import actions
from widgets.common.clicks import on_click
from widgets.common.controls import IconButton, Retranslated, named, sized, wrapped
from widgets.common.icons import icon
from widgets.common.layouts import STRETCH, in_column, in_row, panel
from widgets.common.plain import Label, verbatim

WIDTH_PX = 860
RECENT_PX, LEAST_FOLDER_PX = 360, 90
"""Width in pixels of a recent file's row, and the least width of the folder in it."""

_BEGIN = (
    ("file.open", "start_open", "start_page.open_midi_file_or_project", "open"),
    ("file.new", "start_new", "start_page.new_piece", "new"),
    ("help.first_steps", "start_first_steps", "start_page.first_steps", "help"),
    ("file.open_example", "start_example", "start_page.try_example_quartet", "players"),
    ("file.open_danced_example", "start_danced_example", "start_page.open_dancer_example", "pose"),
)
"""Buttons of the page: action, object name, text id and picture."""


class StartPage(Retranslated, QScrollArea):
    """The page shown while no project is open."""

    def __init__(self, session: Session, files: Files, settings: Settings) -> None:
        super().__init__()
        self.setObjectName("start_page")
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setWidgetResizable(True)
        self._session, self._files, self._settings = session, files, settings
        self._offers: tuple[Recoverable, ...] = ()
        self._title = self.texted(_label("start_title", 26), text="Suisou")
        self._about = self.texted(_label("start_about", 11), text="start_page.performance_of_wind_ensemble_from")
        self._recovery, self._recent = in_column(spacing=6), in_column(spacing=2)
        self._buttons = [_row_button(name) for _, name, _, _ in _BEGIN]
        for button, (action_id, *_) in zip(self._buttons, _BEGIN, strict=True):
            on_click(button, self._trigger, action_id)
        lesson_ids = (
            "start_page.1_open_midi_of_piece",
            "start_page.2_change_what_you_would",
            "start_page.export_step",
        )
        self._lessons = [
            self.texted(wrapped(_label(f"start_lesson_{number}", 9.5)), text=text_id)
            for number, text_id in enumerate(lesson_ids)
        ]
        self._begin_heading = self.texted(_label("start_begin", 10), text="start_page.begin")
        self._teaching_heading = self.texted(_label("start_teaching_heading", 10), text="start_page.how_it_works")
        self._recent_heading = self.texted(_label("start_recent", 10), text="start_page.recent_files")
        lessons = (self._teaching_heading, *self._lessons)
        begin = in_column(self._begin_heading, *self._buttons, 18, *lessons, STRETCH, spacing=6)
        recent = in_column(self._recent_heading, self._recent, STRETCH, spacing=2)
        sides = in_row((begin, 2), (recent, 3), spacing=40)
        parts = (self._title, self._about, 12, self._recovery, sides, STRETCH)
        column = panel(in_column(*parts, margins=(24, 40, 24, 24), spacing=10))
        column.setMaximumWidth(WIDTH_PX)
        self.setWidget(panel(in_row(STRETCH, (column, 6), STRETCH)))
        session.theme_changed.connect(self.retranslate)
        self.retranslate()

    def refresh(self) -> None:
        """Update the lists of recent files and unsaved work."""
        self._offers = ()
        self.retranslate()
        self._files.find_recoverable(self._offer)

    def _offer(self, items: tuple[Recoverable, ...]) -> None:
        self._offers = items
        self._fill_recovery()

    def retranslate(self) -> None:
        tokens = self._session.tokens
        dim = f"color: {tokens.text_dim};"
        self._about.setStyleSheet(dim)
        for heading in (self._begin_heading, self._teaching_heading, self._recent_heading):
            heading.setStyleSheet(f"{dim} font-weight: 600;")
        for button, (_, _, text_id, drawing) in zip(self._buttons, _BEGIN, strict=True):
            button.setText(f"  {self.tr(text_id)}")
            button.setIcon(icon(drawing, tokens))
        self._fill_recovery()
        self._fill_recent()

    def _fill_recovery(self) -> None:
        _clear(self._recovery)
        tokens = self._session.tokens
        for item in self._offers:
            card = named(QFrame(), "recovery")
            card.setStyleSheet(
                f"#recovery {{ background: {tokens.raised}; border: 1px solid {tokens.warning}; border-radius: 6px; }}"
            )
            reported = unsaved_work(item)
            if item.is_file_missing:
                reported = "\n".join((reported, self.tr("start_page.projects_file_no_longer_exists")))
            elif item.is_file_changed:
                reported = "\n".join((reported, self.tr("start_page.projects_file_has_changed_since")))
            go_on = named(QPushButton(self.tr("start_page.recover")), "recover")
            throw = named(QPushButton(self.tr("start_page.discard")), "discard")
            throw.setFlat(True)
            on_click(go_on, self._files.recover, item)
            on_click(throw, self._discard, item)
            in_row((wrapped(Label(reported)), 1), throw, go_on, of=card, margins=(12, 8, 8, 8))
            self._recovery.addWidget(card)
        if self._offers:
            self._recovery.addSpacing(14)

    def _fill_recent(self) -> None:
        _clear(self._recent)
        tokens = self._session.tokens
        paths = self._settings.recent
        if not paths:
            nothing = Label(self.tr("start_page.files_you_open_appear_here"))
            nothing.setStyleSheet(f"color: {tokens.text_dim};")
            self._recent.addWidget(nothing)
        for path in paths:
            self._recent.addWidget(self._recent_row(Path(path)))

    def _recent_row(self, path: Path) -> QWidget:
        tokens = self._session.tokens
        # Another computer is not accessed until the file is opened.
        there = is_file(path) or not may_touch(path)
        button = _row_button("recent_file")
        metrics = QFontMetrics(button.font())
        name = metrics.elidedText(shown(path.name), Qt.TextElideMode.ElideMiddle, RECENT_PX - LEAST_FOLDER_PX)
        room = RECENT_PX - metrics.horizontalAdvance(name)
        where = metrics.elidedText(shown(path.parent), Qt.TextElideMode.ElideMiddle, room)
        button.setText(verbatim(f"  {name}    {where if there else self.tr('start_page.not_found')}"))
        button.setIcon(icon("piece", tokens))
        button.setToolTip(shown(path))
        button.setEnabled(there)
        on_click(button, self._files.open, path)
        forget_tip = "start_page.remove_from_this_list"
        forget = IconButton(self._session, "close", forget_tip, partial(self._forget, str(path)), "forget_recent")
        forget.setFixedSize(26, 26)
        return panel(in_row((button, 1), forget, margins=0))

    def _forget(self, path: str) -> None:
        self._settings.remove_recent(path)
        self._fill_recent()

    def _discard(self, item: Recoverable) -> None:
        self._files.discard(item)
        self.refresh()

    def _trigger(self, action_id: str) -> None:
        actions(self._session)[action_id].trigger()


def unsaved_work(item: Recoverable) -> str:
    """Return the text of a link to unsaved work: its piece and time."""
    changed = QDateTime.fromSecsSinceEpoch(round(item.changed_s))
    when = QLocale().toString(changed, QLocale.FormatType.ShortFormat)
    return tr("start_page.unsaved_changes").format(name=item.name or tr("start_page.unsaved_piece"), when=when)


def _label(name: str, size_pt: float) -> Label:
    return sized(named(Label(), name), size_pt)


def _row_button(name: str) -> QPushButton:
    button = named(QPushButton(), name)
    button.setFlat(True)
    button.setIconSize(QSize(20, 20))
    button.setMinimumHeight(34)
    button.setStyleSheet("text-align: left;")
    return button


def _clear(layout: QVBoxLayout) -> None:
    while (item := layout.takeAt(0)) is not None:
        widget = item.widget()
        if widget is not None:
            widget.setParent(None)
            widget.deleteLater()
