"""Dialog "Learn Choreography", which learns a ``.choreography`` file from pairs of motion and music."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

import msgspec
from PySide6.QtCore import QSize, Qt, QTimer, Signal
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QKeyEvent
from PySide6.QtWidgets import QPushButton, QSpinBox, QTabWidget, QWidget

from app.audio.output import open_output
from app.audio.playback import Playback
from app.choreography.cuts_by_hand import Cuts
from app.choreography.learn import summary
from app.choreography.read_pair import CREDITS_SUFFIX
from app.editor.session import Session
from app.encoding import shown
from app.errors import AppError, Message
from app.project.choreography_files import SUFFIX
from app.rig.motion_file import SUFFIXES as MOTION_SUFFIXES
from app.score.suffixes import MUSIC
from widgets.common.clicks import on_click
from widgets.common.controls import Button, Caption, named, selectable
from widgets.common.help import HelpButton
from widgets.common.layouts import STRETCH, Scrolled, begin_with_size, in_column, in_form, in_row, panel
from widgets.common.paths import PathEdit, ask_for_files, ask_where_to_save, dropped_paths
from widgets.common.plain import Label
from widgets.common.text import message_text, sentence
from widgets.dialogs.automatic_number import TEXT_MARGIN_PX, AutomaticNumber
from widgets.dialogs.character_draft import DraftHistory
from widgets.dialogs.choreography.body_panel import BodyPanel
from widgets.dialogs.choreography.cut_panel import CutHistory, CutPanel
from widgets.dialogs.choreography.learn_draft import PairContents, PairDraft, with_files
from widgets.dialogs.choreography.learn_pair import PairForm
from widgets.dialogs.choreography.learn_rows import (
    PairList,
    PairRead,
    PairRow,
    doubts_text,
    left_out_text,
    missing_text,
    take_contents,
)
from widgets.dialogs.choreography.learn_work import LearnedChoreography, learning, reading
from widgets.dialogs.progress_dialog import WorkingDialog

MOST_STATES: Final = 1000
MOST_SEED: Final = 2**31 - 1
_POLL_MS: Final = 100
_FORM_PX: Final = 420
_STATE_PX: Final = 52
"""Height in pixels of three lines."""
_SIZE: Final = QSize(1180, 840)
_LEAST_PX: Final = 900


class LearnDialog(WorkingDialog):
    """Dialog that learns a choreography; not modal.

    Signals
    -------
    used(Path)
        The user assigns the learned file to a dancer.

    Parameters
    ----------
    folder : Path
        Initial folder for files, and default folder of the choreography.
    playback : Playback, optional
        Player for the music of a pair; if None and sound is available, a new one.
    """

    used = Signal(object)

    def __init__(
        self, session: Session, folder: Path, parent: QWidget | None = None, playback: Playback | None = None
    ) -> None:
        super().__init__("learn_choreography", "learn", parent)
        self.setAcceptDrops(True)
        self._session, self._folder = session, folder
        self._rows: list[PairRow] = []
        self._readings = 0
        self._share: list[float] = [0.0]
        """Share of the learning that is done; written by its thread."""
        self._result: LearnedChoreography | None = None
        self._failure: Message | None = None
        self._unknown: tuple[Path, ...] = ()

        self.list = self.texted(PairList(), name="learn_dialog.pairs_of_motion_and_music")
        # If the piece has no sound, as in a picture made without a window, the pair plays silently in time.
        playback = playback or Playback(open_output if session.playback is not None else lambda: None)
        self.form, self.cuts = PairForm(), CutPanel(session, playback)
        self.body, self.tabs = BodyPanel(session), named(QTabWidget(), "learn_tabs")
        self._add = Button("learn_dialog.add", self._ask_for_files, "learn_add")
        self._remove = Button("learn_dialog.remove", self._remove_pair, "learn_remove")
        self._states = self.texted(
            AutomaticNumber("learn_states", 1, MOST_STATES, step=1, decimals=0),
            tip="learn_dialog.states_tip",
        )
        self._seed = self.texted(named(QSpinBox(), "learn_seed"), tip="learn_dialog.seed_tip")
        self._file = named(PathEdit(folder / f"choreography{SUFFIX}"), "learn_file")
        self._choose = Button("learn_dialog.choose", self._ask_where, "learn_file_choose")
        self._state = selectable(named(Label(), "learn_state"))
        self._use = named(QPushButton(), "learn_use")
        self._learn = Button("learn_dialog.learn", self.start, "learn_start")
        self.fields = (self.list, self._add, self._states, self._seed, self._file, self._choose)
        self._timer = QTimer(self, interval=_POLL_MS)
        self._build()
        self._connect()
        self.texted(self, title="learn_dialog.learn_choreography")
        self.texted(self._states.check, text="learn_dialog.automatic")
        self.retranslate()
        self.setMinimumWidth(_LEAST_PX)
        begin_with_size(self, _SIZE)

    def _build(self) -> None:
        for button in (self._use, self._close):
            button.setAutoDefault(False)
        self._seed.setRange(0, MOST_SEED)
        self._seed.lineEdit().setTextMargins(TEXT_MARGIN_PX, 0, 0, 0)
        # Dropped files belong to the dialog and are not text for a field.
        for edit in (self._file, self._seed.lineEdit()):
            edit.setAcceptDrops(False)
        self._state.setWordWrap(True)
        self._state.setMinimumHeight(_STATE_PX)
        self._use.hide()

        tools = in_row(self._add, self._remove, STRETCH)
        left = in_column((self.list, 1), tools)
        self._top = panel(in_row((left, 1), self.form, margins=0, spacing=14))
        self.form.setFixedWidth(_FORM_PX)
        numbers = in_row(self._states, 14, Caption("learn_dialog.seed", self._seed), self._seed, STRETCH)
        file = in_row((self._file, 1), self._choose)
        form = in_form({"learn_dialog.states": numbers, "learn_dialog.save_to": file})
        bottom = in_row(
            HelpButton(),
            (in_column(self._under_way, self._progress, spacing=2), 20),
            STRETCH,
            self._use,
            self._learn,
            self._close,
        )
        self.tabs.addTab(panel(in_column((self.cuts, 1), margins=(0, 8, 0, 0))), "")
        self.tabs.addTab(panel(in_column((self.body, 1), margins=(0, 8, 0, 0))), "")
        self.texted(self.tabs, tabs=("body_panel.cuts", "body_panel.body"))
        choices = in_column((self._top, 2), (self.tabs, 3), form, self._state, spacing=10)
        in_column((Scrolled(choices, shrinks=True), 1), bottom, of=self, margins=8, spacing=10)

    def _connect(self) -> None:
        session = self._session
        self.list.currentItemChanged.connect(lambda *_: self._show_pair())
        self.form.changed.connect(self._change_pair)
        self.cuts.changed.connect(self._set_cuts)
        self.body.changed.connect(self._correct_bones)
        self._states.changed.connect(self._edited)
        self._seed.valueChanged.connect(lambda _: self._edited())
        self._file.textChanged.connect(lambda _: self._edited())
        on_click(self._use, self._use_it)
        self._timer.timeout.connect(lambda: self._show_share(self._share[0]))
        # A method, because a function would keep the dialog alive.
        session.changed.connect(self._show_use)
        session.dancer_changed.connect(self._show_use)
        session.theme_changed.connect(self._show_list)

    # Pairs

    @property
    def drafts(self) -> tuple[PairDraft, ...]:
        """The user's entries for all pairs of motion and music to learn from."""
        return tuple(row.draft for row in self._rows)

    @property
    def _row(self) -> PairRow | None:
        """The row of the selected pair; None if none is."""
        item = self.list.currentItem()
        at = -1 if item is None else self.list.indexOfTopLevelItem(item)
        return self._rows[at] if 0 <= at < len(self._rows) else None

    def add_files(self, paths: list[Path]) -> None:
        """Add motions, pieces and credits, as pairs; see `with_files`."""
        drafts, unknown = with_files(self.drafts, paths)
        before = len(self._rows)
        self._rows += [PairRow(PairDraft()) for _ in drafts[before:]]
        for row, draft in zip(self._rows, drafts, strict=True):
            if draft != row.draft:
                row.draft = draft
                self._read(row)
        self._edited(unknown)
        if len(self._rows) > before or self._row is None:
            self._select(before if len(self._rows) > before else 0)

    def _ask_for_files(self) -> None:
        suffixes = (*MOTION_SUFFIXES, *MUSIC, CREDITS_SUFFIX)
        filters = f"{self.tr('learn_dialog.motion_and_midi_files')} ({' '.join(f'*{suffix}' for suffix in suffixes)})"
        paths = ask_for_files(self, self.tr("learn_dialog.add_motion_and_music"), self._folder, filters)
        if paths:
            self._folder = paths[0].parent
            self.add_files(paths)

    def _remove_pair(self) -> None:
        row = self._row
        if row is not None and not self._running:
            at = self._rows.index(row)
            self._rows.remove(row)
            self._edited()
            self._select(min(at, len(self._rows) - 1))

    def _change_pair(self, draft: PairDraft) -> None:
        row = self._row
        if row is not None:
            before = row.draft
            if draft.motion != before.motion:
                draft = msgspec.structs.replace(draft, figure="")
            if (draft.motion, draft.figure, draft.fps) != (before.motion, before.figure, before.fps):
                # The number of frames has changed.
                draft, row.history = msgspec.structs.replace(draft, cuts=None), CutHistory()
                row.cut_clip = None
            if (draft.motion, draft.figure) != (before.motion, before.figure):
                # The bones have changed too.
                draft, row.bones = msgspec.structs.replace(draft, joints={}), DraftHistory.empty()
            row.draft = draft
            if draft.files != before.files:
                self._read(row)
            self._edited()

    def _set_cuts(self, cuts: Cuts | None) -> None:
        row = self._row
        if row is not None:
            row.draft = msgspec.structs.replace(row.draft, cuts=cuts)
            self._edited()

    def _correct_bones(self) -> None:
        row = self._row
        if row is not None:
            row.draft = msgspec.structs.replace(row.draft, joints=row.bones.now.joints)
            skeleton = row.found.skeleton
            self._read(row)
            if row.reading:
                # The bones to choose from are kept.
                row.found = PairContents(skeleton=skeleton)
            self._edited()

    def _read(self, row: PairRow) -> None:
        """Read the files of a pair in the background, discarding earlier results."""
        self._readings += 1
        draft, number = row.draft, self._readings
        row.found, row.reading = PairContents(), 0
        if draft.motion is None or draft.music is None:
            return
        row.reading = number
        work = reading(number, draft.motion, draft.music, draft)
        self._session.tasks.run(Message("work.read_motion", {"file": draft.motion.name}), work, self._was_read)

    def _was_read(self, result: PairRead) -> None:
        for row in self._rows:
            if row.reading == result.number:
                take_contents(row, result.found)
                self._show_list()
                self._show_state()
                if row is self._row:
                    self._show_pair()

    def _select(self, at: int) -> None:
        item = self.list.topLevelItem(at)
        if item is not None:
            self.list.setCurrentItem(item)
        self._show_pair()

    # Learning

    def start(self) -> None:
        """Start learning a choreography from the listed pairs."""
        path = self._target
        if self._running or path is None or self._missing():
            return
        self._result, self._failure = None, None
        self._set_running(True)
        # The thread receives only what it needs, not the dialog.
        self._share = [0.0]
        states = None if self._states.value is None else round(self._states.value)
        work = learning(path, tuple(self._rows), states, self._seed.value(), self._stop, self._share)
        self._timer.start()
        self._session.tasks.run(
            Message("work.learn", {"file": path.name}), work, self._done, self._failed, ended=self._ended, writes=True
        )

    def _ended(self) -> None:
        self._timer.stop()
        if self._stop.is_set():
            self._failure = Message("work.stopped")
        self._set_running(False)

    def _done(self, result: LearnedChoreography) -> None:
        self._result = result
        for at, row in enumerate(result.rows):
            row.states = len({one.state for one in result.model.segments if one.clip == at})
        self._show_all()
        self._session.choreographies_changed.emit()

    def _failed(self, error: AppError) -> None:
        self._failure = error.message
        self._show_state()

    def _use_it(self) -> None:
        if self._result is not None:
            self.used.emit(self._result.path)

    @property
    def _target(self) -> Path | None:
        path = self._file.path
        return _with_suffix(path) if path is not None and path.name else None

    def _missing(self) -> str:
        """Return the text of what must be done before learning; empty if nothing."""
        nowhere = "" if self._target is not None else self.tr("learn_dialog.choose_where_to_save_choreography")
        return missing_text(self._rows) or nowhere

    def _ask_where(self) -> None:
        proposal = self._target or self._folder / f"choreography{SUFFIX}"
        kinds = f"{self.tr('learn_dialog.choreographies')} (*{SUFFIX})"
        path = ask_where_to_save(self, self.tr("learn_dialog.save_choreography"), proposal, kinds)
        if path is not None:
            self._file.set_path(_with_suffix(path))

    # Display

    def _edited(self, unknown: tuple[Path, ...] = ()) -> None:
        """Discard a learned result, which is outdated; ``unknown`` are added files of unsupported kinds."""
        self._result, self._failure, self._unknown = None, None, unknown
        for row in self._rows:
            row.states = None
        self._show_all()

    def _show_all(self) -> None:
        self._show_list()
        self._show_pair()
        self._show_state()

    def _show_list(self) -> None:
        self.list.show_rows(self._rows, self._session.tokens)
        self._remove.setEnabled(self._row is not None and not self._running)

    def _show_pair(self) -> None:
        row = self._row
        for widget in (self.form, self.tabs):
            widget.setEnabled(row is not None and not self._running)
        self._remove.setEnabled(row is not None and not self._running)
        if row is None:
            self.form.show_pair(PairDraft(), PairContents(), busy=False)
            self.cuts.show_pair(PairDraft(), PairContents(), CutHistory())
            self.body.show_pair(PairContents(), DraftHistory.empty())
        else:
            self.form.show_pair(row.draft, row.found, bool(row.reading))
            self.cuts.show_pair(row.draft, row.found, row.history)
            if row.found is not self.body.found and row.found.error is not None and row.found.skeleton is not None:
                # The bones must be corrected first.
                self.tabs.setCurrentIndex(1)
            self.body.show_pair(row.found, row.bones)

    def _show_state(self) -> None:
        missing, path, result = self._missing(), self._target, self._result
        self._learn.setEnabled(not missing and not self._running)
        if self._running:
            text = ""
        elif self._failure is not None:
            text = sentence(self._failure)
        elif result is not None:
            done, *learned = map(message_text, (summary(result.model, result.path), *result.pairing))
            text = "\n".join(filter(None, (done, doubts_text(self._rows), *learned, left_out_text(self._rows))))
        elif self._unknown:
            names = ", ".join(shown(path.name) for path in self._unknown)
            text = "\n".join(filter(None, (self.tr("learn_dialog.unknown_files").format(files=names), missing)))
        elif missing:
            text = missing
        else:
            replaces = path is not None and os.path.isfile(path)
            text = self.tr("learn_dialog.replaces_file") if replaces else ""
            text = "\n".join(filter(None, (left_out_text(self._rows), text)))
        self._state.setText(text)
        self._show_use()

    def _show_use(self, *_changes: object) -> None:
        dancer = self._session.dancer
        self._use.setVisible(self._result is not None)
        self._use.setText(
            self.tr("learn_dialog.add_dancer_with_it")
            if dancer is None
            else self.tr("learn_dialog.use_for").format(dancer=dancer.name.replace("&", "&&"))
        )

    def retranslate(self) -> None:
        super().retranslate()
        self._show_all()

    # Qt overrides

    def done(self, result: int) -> None:
        self.cuts.player.close_down()
        super().done(result)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Delete and self.list.hasFocus():
            self._remove_pair()
        else:
            super().keyPressEvent(event)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if not self._running and dropped_paths(event):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        paths = dropped_paths(event)
        if paths and not self._running:
            event.acceptProposedAction()
            self.add_files(paths)


def _with_suffix(path: Path) -> Path:
    return path if path.suffix.lower() == SUFFIX else path.with_name(f"{path.name}{SUFFIX}")
