"""Learn Choreography: pairs of motion and music become a ``.choreography`` file."""

from __future__ import annotations

import os
import threading
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import msgspec
from PySide6.QtCore import QEvent, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QCloseEvent, QColor, QDragEnterEvent, QDropEvent, QKeyEvent
from PySide6.QtWidgets import (
    QDialog,
    QFormLayout,
    QHBoxLayout,
    QHeaderView,
    QProgressBar,
    QPushButton,
    QSpinBox,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.choreography.cuts_by_hand import Cuts
from app.choreography.learn import Pair, analyse, learn, summary
from app.choreography.model import ChoreographyModel
from app.choreography.model_file import SUFFIX, write_model
from app.choreography.music_offset import CONFIDENT
from app.choreography.read_pair import CREDITS_SUFFIX, read_pair
from app.editor.session import Session
from app.editor.tasks import Progress, StopRequested
from app.encoding import shown
from app.errors import AppError, Cancelled, Message
from widgets.common.paths import PathEdit, ask_for_files, ask_where_to_save, dropped_paths
from widgets.common.plain import Label
from widgets.common.text import message_text, sentence
from widgets.dialogs.automatic_number import TEXT_MARGIN_PX, AutomaticNumber
from widgets.dialogs.cut_panel import CutHistory, CutPanel
from widgets.dialogs.learn_draft import MIDI_SUFFIXES, MOTION_SUFFIXES, Found, PairDraft, with_files
from widgets.dialogs.learn_pair import PairForm, file_name

MOST_STATES: Final = 1000
MOST_SEED: Final = 2**31 - 1
_COLUMNS: Final = ("motion", "music", "length", "segments", "states", "offset", "confidence")
_POLL_MS: Final = 100
_FORM_PX: Final = 420
_SIZE: Final = QSize(1180, 840)
_LEAST_PX: Final = 900
_FRAME: Final = QSize(40, 80)
"""What a window's frame and the desktop's bars take of the screen."""
_RIGHT: Final = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


@dataclass(eq=False)
class _Row:
    """A pair of the list.

    Attributes
    ----------
    draft : PairDraft
    found : Found
    history : CutHistory
        Of the cuts of the draft.
    reading : int
        Number of the reading whose result is awaited; 0: none.
    states : int or None
        Basic motions of it in what was learned last, from what the list says now.
    """

    draft: PairDraft
    found: Found = field(default_factory=Found)
    history: CutHistory = field(default_factory=CutHistory)
    reading: int = 0
    states: int | None = None


@dataclass(frozen=True, eq=False)
class _Read:
    """What came of reading a pair's files."""

    number: int
    found: Found


@dataclass(frozen=True, eq=False)
class _Learned:
    path: Path
    model: ChoreographyModel
    rows: tuple[_Row, ...]


class LearnDialog(QDialog):
    """Learns a choreography. Not modal.

    Signals
    -------
    used(Path)
        The user assigns it to a dancer.

    Parameters
    ----------
    session : Session
    folder : Path
        Where files are looked for, and where the choreography is saved unless the user says otherwise.
    parent : QWidget, optional
    """

    used = Signal(object)

    def __init__(self, session: Session, folder: Path, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("learn_choreography")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setAcceptDrops(True)
        self._session, self._folder = session, folder
        self._rows: list[_Row] = []
        self._readings = 0
        self._stop = threading.Event()
        self._shares: list[float] = [0.0]
        """How far the learning is; its thread writes it."""
        self._running = False
        self._result: _Learned | None = None
        self._failure: Message | None = None
        self._unknown: tuple[Path, ...] = ()

        self.list = QTreeWidget()
        self.form, self.cuts = PairForm(), CutPanel(session)
        self._add, self._remove = QPushButton(), QPushButton()
        self._states = AutomaticNumber("learn_states", 1, MOST_STATES, step=1, decimals=0)
        self._seed = QSpinBox()
        self._file, self._choose = PathEdit(folder / f"choreography{SUFFIX}"), QPushButton()
        self._state, self._progress = Label(), QProgressBar()
        self._use, self._learn, self._close = QPushButton(), QPushButton(), QPushButton()
        self._labels = {name: Label() for name in ("states", "seed", "file")}
        self._timer = QTimer(self, interval=_POLL_MS)
        self._build()
        self._connect()
        self.retranslate()
        self.setMinimumWidth(_LEAST_PX)
        self.resize(_SIZE.boundedTo(self.screen().availableSize() - _FRAME))

    def _build(self) -> None:
        named: dict[QWidget, str] = {self.list: "pairs", self._add: "add", self._remove: "remove", self._seed: "seed"}
        named |= {self._file: "file", self._choose: "file_choose", self._state: "state", self._use: "use"}
        named |= {self._learn: "start", self._close: "close", self._progress: "progress"}
        for widget, name in named.items():
            widget.setObjectName(f"learn_{name}")
            if isinstance(widget, QPushButton):
                widget.setAutoDefault(False)
        self.list.setColumnCount(len(_COLUMNS))
        self.list.setRootIsDecorated(False)
        self.list.setUniformRowHeights(True)
        header = self.list.header()
        header.setStretchLastSection(False)
        for column in range(2, len(_COLUMNS)):
            self.list.headerItem().setTextAlignment(column, _RIGHT)
        for column in range(len(_COLUMNS)):
            stretches = column < 2
            mode = QHeaderView.ResizeMode.Stretch if stretches else QHeaderView.ResizeMode.ResizeToContents
            header.setSectionResizeMode(column, mode)
        self._seed.setRange(0, MOST_SEED)
        self._seed.lineEdit().setTextMargins(TEXT_MARGIN_PX, 0, 0, 0)
        # Files that are dropped are the dialog's, not text of a field.
        for edit in (self._file, self._seed.lineEdit()):
            edit.setAcceptDrops(False)
        self._state.setWordWrap(True)
        self._state.setMinimumHeight(40)
        self._progress.setRange(0, 1000)
        self._progress.hide()
        self._use.hide()

        tools = QHBoxLayout()
        tools.addWidget(self._add)
        tools.addWidget(self._remove)
        tools.addStretch(1)
        left = QVBoxLayout()
        left.addWidget(self.list, 1)
        left.addLayout(tools)
        self._top = QWidget()
        top = QHBoxLayout(self._top)
        top.setContentsMargins(0, 0, 0, 0)
        top.setSpacing(14)
        top.addLayout(left, 1)
        top.addWidget(self.form)
        self.form.setFixedWidth(_FORM_PX)
        numbers = QHBoxLayout()
        numbers.addWidget(self._states)
        numbers.addSpacing(14)
        numbers.addWidget(self._labels["seed"])
        numbers.addWidget(self._seed)
        numbers.addStretch(1)
        file = QHBoxLayout()
        file.addWidget(self._file, 1)
        file.addWidget(self._choose)
        whole = QFormLayout()
        whole.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        whole.addRow(self._labels["states"], numbers)
        whole.addRow(self._labels["file"], file)
        for name, widget in {"states": self._states, "seed": self._seed, "file": self._file}.items():
            self._labels[name].setBuddy(widget)
        bottom = QHBoxLayout()
        bottom.addWidget(self._progress, 20)
        bottom.addStretch(1)
        for button in (self._use, self._learn, self._close):
            bottom.addWidget(button)
        page = QVBoxLayout(self)
        page.setContentsMargins(14, 14, 14, 14)
        page.setSpacing(10)
        page.addWidget(self._top, 2)
        page.addWidget(self.cuts, 3)
        page.addLayout(whole)
        page.addWidget(self._state)
        page.addLayout(bottom)

    def _connect(self) -> None:
        session = self._session
        self._add.clicked.connect(self._ask_for_files)
        self._remove.clicked.connect(self._remove_pair)
        self.list.currentItemChanged.connect(lambda *_: self._show_pair())
        self.form.changed.connect(self._change_pair)
        self.cuts.changed.connect(self._set_cuts)
        self._states.changed.connect(self._edited)
        self._seed.valueChanged.connect(lambda _: self._edited())
        self._file.textChanged.connect(lambda _: self._edited())
        self._choose.clicked.connect(self._ask_where)
        self._learn.clicked.connect(self.start)
        self._close.clicked.connect(self._close_or_cancel)
        self._use.clicked.connect(self._use_it)
        self._timer.timeout.connect(self._show_progress)
        # A method: a function would outlive the dialog.
        session.changed.connect(self._show_use)
        session.dancer_changed.connect(self._show_use)
        session.theme_changed.connect(self._show_list)

    # Pairs

    @property
    def drafts(self) -> tuple[PairDraft, ...]:
        """What is filled in of the pairs."""
        return tuple(row.draft for row in self._rows)

    @property
    def _row(self) -> _Row | None:
        """The selected pair."""
        item = self.list.currentItem()
        at = -1 if item is None else self.list.indexOfTopLevelItem(item)
        return self._rows[at] if 0 <= at < len(self._rows) else None

    def add_files(self, paths: list[Path]) -> None:
        """Add motions, pieces and credits, as pairs; see `with_files`."""
        drafts, unknown = with_files(self.drafts, paths)
        before = len(self._rows)
        self._rows += [_Row(PairDraft()) for _ in drafts[before:]]
        for row, draft in zip(self._rows, drafts, strict=True):
            if draft != row.draft:
                row.draft = draft
                self._read(row)
        self._edited(unknown)
        if len(self._rows) > before or self._row is None:
            self._select(before if len(self._rows) > before else 0)

    def _ask_for_files(self) -> None:
        suffixes = (*MOTION_SUFFIXES, *MIDI_SUFFIXES, CREDITS_SUFFIX)
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
            if (draft.motion, draft.fps) != (before.motion, before.fps):
                # Its frames are others.
                draft, row.history = msgspec.structs.replace(draft, cuts=None), CutHistory()
            row.draft = draft
            if draft.files != before.files:
                self._read(row)
            self._edited()

    def _set_cuts(self, cuts: Cuts | None) -> None:
        row = self._row
        if row is not None:
            row.draft = msgspec.structs.replace(row.draft, cuts=cuts)
            self._edited()

    def _read(self, row: _Row) -> None:
        """Read the files of a pair beside the window; what was found before is of others."""
        self._readings += 1
        draft, number = row.draft, self._readings
        row.found, row.reading = Found(), 0
        if draft.motion is None or draft.music is None:
            return
        row.reading = number
        motion, music = draft.motion, draft.music

        def work(progress: Progress, stop_requested: StopRequested) -> _Read:
            try:
                read = read_pair(motion, music, fps=draft.fps, credits=draft.credits)
                return _Read(number, Found(read, analyse(read.pair)))
            except Cancelled:
                raise
            except AppError as error:
                return _Read(number, Found(error=error.message))

        self._session.tasks.run(Message("work.read_motion", {"file": motion.name}), work, self._was_read)

    def _was_read(self, result: _Read) -> None:
        for row in self._rows:
            if row.reading == result.number:
                row.reading, row.found = 0, result.found
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
        """Learn from the pairs."""
        path = self._target
        if self._running or path is None or self._missing():
            return
        pairs = [pair for row in self._rows if (pair := _pair(row)) is not None]
        rows = tuple(self._rows)
        states, seed = self._states.value, self._seed.value()
        self._stop, self._shares = threading.Event(), [0.0]
        self._running, self._result, self._failure = True, None, None
        # The thread gets what it needs, not the dialog.
        stop, shares = self._stop, self._shares

        def work(progress: Progress, stop_requested: StopRequested) -> _Learned:
            def went(share: float, label: str) -> None:
                if stop.is_set() or stop_requested():
                    raise Cancelled("work.stopped")
                shares[0] = share
                progress(share)

            whole = None if states is None else round(states)
            model = learn(pairs, states=whole, seed=seed, name=shown(path.stem), progress=went)
            went(1.0, "")
            write_model(path, model)
            return _Learned(path, model, rows)

        self._timer.start()
        self._show_all()
        self._session.tasks.run(
            Message("work.learn", {"file": path.name}), work, self._done, self._failed, ended=self._ended
        )

    def _ended(self) -> None:
        self._running = False
        self._timer.stop()
        if self._stop.is_set():
            self._failure = Message("work.stopped")
        self._show_all()

    def _done(self, result: _Learned) -> None:
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
        """What is to be done before anything can be learned; empty: nothing."""
        if not self._rows:
            return self.tr("learn_dialog.add_motion_files_and_midi")
        for at, row in enumerate(self._rows):
            if row.draft.motion is None:
                return self.tr("learn_dialog.pair_choose_its_motion").format(n=at + 1)
            if row.draft.music is None:
                return self.tr("learn_dialog.pair_choose_its_music").format(n=at + 1)
            if row.found.error is not None:
                return self.tr("learn_dialog.pair").format(n=at + 1, error=message_text(row.found.error))
        if any(row.reading for row in self._rows):
            return self.tr("learn_dialog.reading_files")
        if self._target is None:
            return self.tr("learn_dialog.choose_where_to_save_choreography")
        return ""

    def _ask_where(self) -> None:
        proposal = self._target or self._folder / f"choreography{SUFFIX}"
        kinds = f"{self.tr('learn_dialog.choreographies')} (*{SUFFIX})"
        path = ask_where_to_save(self, self.tr("learn_dialog.save_choreography"), proposal, kinds)
        if path is not None:
            self._file.set_path(_with_suffix(path))

    def _close_or_cancel(self) -> None:
        if self._running:
            self._stop.set()
        else:
            self.close()

    # Showing

    def _edited(self, unknown: tuple[Path, ...] = ()) -> None:
        """What was learned is not of this any more; these files were added and are of no kind that is."""
        self._result, self._failure, self._unknown = None, None, unknown
        for row in self._rows:
            row.states = None
        self._show_all()

    def _show_all(self) -> None:
        for widget in (self.list, self._add, self._states, self._seed, self._file, self._choose):
            widget.setEnabled(not self._running)
        self._progress.setVisible(self._running)
        self._close.setText(self.tr("learn_dialog.cancel") if self._running else self.tr("learn_dialog.close"))
        self._show_list()
        self._show_pair()
        self._show_state()
        self._show_progress()

    def _show_list(self) -> None:
        tokens = self._session.tokens
        self.list.blockSignals(True)
        while self.list.topLevelItemCount() > len(self._rows):
            self.list.takeTopLevelItem(self.list.topLevelItemCount() - 1)
        while self.list.topLevelItemCount() < len(self._rows):
            self.list.addTopLevelItem(QTreeWidgetItem())
        for at, row in enumerate(self._rows):
            item = self.list.topLevelItem(at)
            assert item is not None, "one for each pair"
            for column, text in enumerate(_cells(row)):
                item.setText(column, text)
                if column > 1:
                    item.setTextAlignment(column, _RIGHT)
            wrong = row.found.error is not None
            doubtful = row.draft.offset_s is None and _confidence(row) < CONFIDENT
            for column, name in enumerate(_COLUMNS):
                colour = tokens.error if wrong else tokens.text
                if name in ("offset", "confidence") and doubtful:
                    colour = tokens.warning
                item.setForeground(column, QColor(colour))
                path = getattr(row.draft, name, None)
                item.setToolTip(column, shown(str(path)) if isinstance(path, Path) else "")
        self.list.blockSignals(False)
        self._remove.setEnabled(self._row is not None and not self._running)

    def _show_pair(self) -> None:
        row = self._row
        for widget in (self.form, self.cuts):
            widget.setEnabled(row is not None and not self._running)
        self._remove.setEnabled(row is not None and not self._running)
        if row is None:
            self.form.show_pair(PairDraft(), Found(), busy=False)
            self.cuts.show_pair(PairDraft(), Found(), CutHistory())
        else:
            self.form.show_pair(row.draft, row.found, bool(row.reading))
            self.cuts.show_pair(row.draft, row.found, row.history)

    def _show_state(self) -> None:
        missing, path, result = self._missing(), self._target, self._result
        self._learn.setEnabled(not missing and not self._running)
        if self._running:
            text = ""
        elif self._failure is not None:
            text = sentence(self._failure)
        elif result is not None:
            text = message_text(summary(result.model, result.path))
        elif self._unknown:
            names = ", ".join(shown(path.name) for path in self._unknown)
            text = "\n".join(
                filter(None, (self.tr("learn_dialog.neither_motion_nor_midi").format(files=names), missing))
            )
        elif missing:
            text = missing
        elif path is not None and os.path.isfile(path):
            text = self.tr("learn_dialog.this_file_is_there_and")
        else:
            text = ""
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

    def _show_progress(self) -> None:
        self._progress.setValue(round(1000 * self._shares[0]))

    def retranslate(self) -> None:
        """Set every text in the language of the editor."""
        self.setWindowTitle(self.tr("learn_dialog.learn_choreography"))
        texts = {
            "motion": self.tr("learn_dialog.motion"),
            "music": self.tr("learn_dialog.music"),
            "length": self.tr("learn_dialog.seconds"),
            "segments": self.tr("learn_dialog.segments"),
            "states": self.tr("learn_dialog.states"),
            "offset": self.tr("learn_dialog.offset_s"),
            "confidence": self.tr("learn_dialog.confidence"),
        }
        self.list.setHeaderLabels([texts[name] for name in _COLUMNS])
        self.list.setAccessibleName(self.tr("learn_dialog.pairs_of_motion_and_music"))
        self._add.setText(self.tr("learn_dialog.add"))
        self._remove.setText(self.tr("learn_dialog.remove"))
        self._labels["states"].setText(self.tr("learn_dialog.states"))
        self._labels["seed"].setText(self.tr("learn_dialog.seed"))
        self._labels["file"].setText(self.tr("learn_dialog.save_to"))
        self._states.check.setText(self.tr("learn_dialog.automatic"))
        self._states.setToolTip(self.tr("learn_dialog.number_of_basic_motions_automatic"))
        self._seed.setToolTip(self.tr("learn_dialog.of_classification_same_pairs_and"))
        self._choose.setText(self.tr("learn_dialog.choose"))
        self._learn.setText(self.tr("learn_dialog.learn"))
        self._show_all()

    # Qt's own names

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Delete and self.list.hasFocus():
            self._remove_pair()
        elif event.key() == Qt.Key.Key_Escape:
            self._close_or_cancel()
        else:
            super().keyPressEvent(event)

    def closeEvent(self, event: QCloseEvent) -> None:
        if self._running:
            self._stop.set()
            event.ignore()
            return
        super().closeEvent(event)

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


def _pair(row: _Row) -> Pair | None:
    """What is learned from, as it is filled in; None before the files are read."""
    read = row.found.read
    if read is None:
        return None
    offset_s = row.draft.offset_s
    # Typed is a time of the file, of which the clip may be a later part.
    of_clip_s = None if offset_s is None else offset_s - read.motion.start_s
    return replace(read.pair, offset_s=of_clip_s, cuts=row.draft.cuts)


def _confidence(row: _Row) -> float:
    return 1.0 if row.found.analysis is None else row.found.analysis.offset.confidence


def _cells(row: _Row) -> tuple[str, ...]:
    """The texts of a row, by `_COLUMNS`."""
    read, analysis, draft = row.found.read, row.found.analysis, row.draft
    names = file_name(draft.motion), file_name(draft.music)
    if read is None or analysis is None:
        return *names, *("…" if row.reading else "–" for _ in _COLUMNS[2:])
    found_s = analysis.offset.offset_s + read.motion.start_s
    return (
        *names,
        f"{analysis.clip.length_s:.1f}",
        str(len(analysis.segmentation.cuts if draft.cuts is None else draft.cuts)),
        "–" if row.states is None else str(row.states),
        f"{found_s if draft.offset_s is None else draft.offset_s:.2f}",
        f"{analysis.offset.confidence:.2f}" if draft.offset_s is None else "–",
    )
