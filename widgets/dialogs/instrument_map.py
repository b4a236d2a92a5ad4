"""Dialog with the instruments and their fingerings: an editable table beside the diagram.

Bundled maps stay unchanged: a change creates a map of the user that extends the bundled one.
"""

from __future__ import annotations

from collections.abc import Callable

import msgspec
from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QSize, Qt, Signal
from PySide6.QtGui import QCloseEvent, QColor, QIcon, QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCompleter,
    QDialog,
    QGridLayout,
    QHeaderView,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QSplitter,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableWidget,
    QTableWidgetItem,
    QWidget,
)

from app.editor.session import Session, Severity
from app.errors import AppError
from app.messages.pitches import pitch_name
from instrument_maps import fingering_table as edit
from instrument_maps.fingering_words import fingering_words
from instrument_maps.library import library
from instrument_maps.model import Fingering, InstrumentMap
from widgets.common.controls import Button, Caption, Retranslated, named, wrapped
from widgets.common.fingering_diagram import FingeringDiagram
from widgets.common.fingering_tags import tag_words, tags_of_text, words_of_tags
from widgets.common.help import HelpButton
from widgets.common.icons import icon
from widgets.common.instrument_name import instrument_name, language
from widgets.common.layouts import STRETCH, begin_with_size, in_column, in_row, panel
from widgets.common.paths import show_folder
from widgets.common.pitch import pitch_names
from widgets.common.plain import Label, Role, ask
from widgets.common.text import message_text
from widgets.dialogs.fingering_draft import FingeringDraft, base_of

WRITTEN, SOUNDS, RANK, LABEL, CENTS, TAGS = range(6)
MOST_WRONG = 6
"""Greatest number of faulty files reported together."""
_PLACE = Qt.ItemDataRole.UserRole
_SIZE = QSize(1180, 740)


class InstrumentsDialog(Retranslated, QDialog):
    """Shows facts and fingerings of all instruments, and edits the fingerings."""

    saved = Signal(str)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("instruments")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session = session
        self._drafts: dict[str, FingeringDraft] = {}
        self._filling = False
        self._list = named(QListWidget(), "instruments_list")
        self._wrong, self._facts = (
            wrapped(named(Label(), "instruments_wrong")),
            wrapped(named(Label(), "instruments_facts")),
        )
        self._file, self._problem = wrapped(Label()), wrapped(named(Label(), "instruments_problem"))
        self._title, self._id = named(Label(), "instruments_title"), Label()
        self._title.setStyleSheet("font-weight: bold;")
        self._table = self.texted(
            named(QTableWidget(0, 6), "instruments_fingerings"),
            columns=(
                "instruments_dialog.written",
                "instruments_dialog.sounds",
                "instruments_dialog.choice",
                "instruments_dialog.fingering",
                "instruments_dialog.cents",
                "instruments_dialog.for",
            ),
        )
        self._diagram = named(FingeringDiagram(session), "instruments_diagram")
        self._diagram.set_editable(True)
        self._hint = wrapped(Caption("instruments_dialog.chart_tip"))
        self._does: dict[str, tuple[str, Callable[[], object]]] = {
            "up": ("instruments_dialog.higher_choice", lambda: self._move(-1)),
            "down": ("instruments_dialog.lower_choice", lambda: self._move(1)),
            "add": ("instruments_dialog.add_alternate", self._add),
            "remove": ("instruments_dialog.remove", self._remove),
            "revert": ("instruments_dialog.revert_this_note", self._revert),
            "revert_all": ("instruments_dialog.revert_all_notes", self._revert_all),
            "undo": ("instruments_dialog.undo", lambda: self._step(-1)),
            "redo": ("instruments_dialog.redo", lambda: self._step(1)),
            "folder": ("instruments_dialog.show_my_folder", self._open_folder),
            "save": ("instruments_dialog.save_own", self.save),
            "close": ("instruments_dialog.close", self.close),
        }
        """The text and the work of each button."""
        self._buttons = {
            name: Button(text_id, run, f"instruments_{name}") for name, (text_id, run) in self._does.items()
        }
        self._build()
        self._connect()
        self.texted(self, title="instruments_dialog.instruments")
        self.retranslate()
        front = session.player
        self._fill_list(front.instrument_id if front is not None else "")
        begin_with_size(self, _SIZE)

    # Construction

    def _build(self) -> None:
        for label in (self._wrong, self._file):
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        table = self._table
        table.verticalHeader().hide()
        table.setShowGrid(False)
        table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        triggers = QAbstractItemView.EditTrigger
        table.setEditTriggers(triggers.DoubleClicked | triggers.EditKeyPressed | triggers.AnyKeyPressed)
        table.setItemDelegate(_Completing(self._choices, table))
        header = table.horizontalHeader()
        self._fit_columns(QHeaderView.ResizeMode.ResizeToContents)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        edits = QGridLayout()
        for place, name in enumerate(("up", "down", "add", "remove", "revert", "revert_all", "undo", "redo")):
            edits.addWidget(self._buttons[name], place // 2, place % 2)
        side = in_column(self._diagram, self._hint, edits, self._problem, STRETCH, margins=(8, 0, 0, 0))
        work = _split(table, panel(side), (560, 320), stretches=0)
        heading = in_row(self._title, (self._id, 1), spacing=12)
        right = in_column(self._wrong, heading, self._facts, self._file, (work, 1), margins=(8, 0, 0, 0))
        everything = _split(self._list, panel(right), (230, 900), stretches=1)
        foot = in_row(HelpButton(), self._buttons["folder"], STRETCH, self._buttons["save"], self._buttons["close"])
        in_column((everything, 1), foot, of=self)

    def _connect(self) -> None:
        standard = QKeySequence.StandardKey
        for keys, name in ((standard.Undo, "undo"), (standard.Redo, "redo"), (standard.Save, "save")):
            QShortcut(QKeySequence(keys), self).activated.connect(self._does[name][1])
        for text, name in (("Alt+Up", "up"), ("Alt+Down", "down")):
            QShortcut(QKeySequence(text), self).activated.connect(self._does[name][1])
        self._list.currentRowChanged.connect(lambda _: self._show())
        self._table.itemSelectionChanged.connect(self._show_row)
        self._table.itemChanged.connect(self._edited)
        self._diagram.pressed.connect(self._toggle)
        self._session.instruments_changed.connect(self._library_changed)
        self._session.pitch_display.changed.connect(self._show)
        self._session.theme_changed.connect(self._show)

    # Instruments

    def _fill_list(self, chosen: str) -> None:
        self._list.blockSignals(True)
        self._list.clear()
        for instrument in library().in_score_order:
            item = QListWidgetItem(instrument_name(instrument))
            item.setData(_PLACE, instrument.id)
            self._list.addItem(item)
        self._list.blockSignals(False)
        places = [self._list.item(row).data(_PLACE) for row in range(self._list.count())]
        self._list.setCurrentRow(places.index(chosen) if chosen in places else 0)
        self._show()

    def choose(self, id: str) -> None:
        """Select an instrument in the list and display its table of fingerings."""
        self._fill_list(id)

    @property
    def draft(self) -> FingeringDraft | None:
        """The edited fingering table of the selected instrument; None if none is selected."""
        item = self._list.currentItem()
        return None if item is None else self._draft_of(str(item.data(_PLACE)))

    def _draft_of(self, id: str) -> FingeringDraft | None:
        known = self._drafts.get(id)
        if known is not None:
            return known
        instrument = library().maps.get(id)
        if instrument is None:
            return None
        self._drafts[id] = FingeringDraft(instrument, base_of(instrument), [instrument.fingerings])
        return self._drafts[id]

    def _library_changed(self) -> None:
        """Display changed files of the library, except for tables that are being edited."""
        now, shown = library(), self.draft
        for id, draft in list(self._drafts.items()):
            instrument = now.maps.get(id)
            if instrument is None or (draft.is_saved and draft.table != instrument.fingerings):
                del self._drafts[id]
            else:
                draft.instrument, draft.base = instrument, base_of(instrument)
        self._fill_list(shown.instrument.id if shown is not None else "")

    # Display

    def _show(self) -> None:
        draft = self.draft
        if draft is None:
            return
        own = library().own.get(draft.instrument.id)
        self._title.setText(instrument_name(draft.instrument))
        self._id.setText(draft.instrument.id)
        self._facts.setText(self._facts_of(draft.instrument))
        self._file.setText(
            self.tr("instruments_dialog.your_own_version").format(file=str(own))
            if own is not None
            else self.tr("instruments_dialog.bundled")
        )
        self._show_wrong()
        self._fill_table(draft)
        self._show_state()

    def _show_wrong(self) -> None:
        """Show the errors in files of the user that cannot be used, which may have no row in the list."""
        reported = [problem for problems in library().problems.values() for problem in problems]
        lines = [self.tr("instruments_dialog.files_with_errors")]
        lines += [message_text(problem, self._session) for problem in reported[:MOST_WRONG]]
        if len(reported) > MOST_WRONG:
            lines.append(self.tr("instruments_dialog.and_more").format(count=len(reported) - MOST_WRONG))
        self._wrong.setText("\n".join(lines))
        self._wrong.setStyleSheet(f"color: {self._session.tokens.error};")
        self._wrong.setVisible(bool(reported))

    def _facts_of(self, instrument: InstrumentMap) -> str:
        low, high, shift = instrument.range.low, instrument.range.high, instrument.transposition_semitones
        pitch = self._name
        facts = [self.tr("instruments_dialog.sounds_to").format(low=pitch(low), high=pitch(high))]
        if shift:
            written = self.tr("instruments_dialog.written_to_semitones")
            facts.append(written.format(low=pitch(low + shift), high=pitch(high + shift), semitones=f"{shift:+d}"))
        kinds = {
            "cup": self.tr("instruments_dialog.cup_mouthpiece"),
            "single_reed": self.tr("instruments_dialog.single_reed"),
            "double_reed": self.tr("instruments_dialog.double_reed"),
            "air_jet": self.tr("instruments_dialog.lip_plate"),
            "fipple": self.tr("instruments_dialog.beak"),
        }
        clefs = {
            "treble": self.tr("instruments_dialog.treble_clef"),
            "bass": self.tr("instruments_dialog.bass_clef"),
            "alto": self.tr("instruments_dialog.alto_clef"),
            "tenor": self.tr("instruments_dialog.tenor_clef"),
        }
        postures = {"standing": self.tr("instruments_dialog.standing"), "seated": self.tr("instruments_dialog.seated")}
        facts += [clefs[instrument.clef], kinds[instrument.embouchure.kind]]
        facts.append(" / ".join(postures[posture] for posture in instrument.hold.postures))
        air = instrument.air
        if air is not None:
            facts.append(self.tr("instruments_dialog.breath_lasts_to_s").format(soft=air.piano_s, loud=air.forte_s))
        facts.append(self.tr("instruments_dialog.model").format(file=instrument.model))
        return " · ".join(facts)

    def _name(self, pitch: int) -> str:
        display = self._session.pitch_display
        return pitch_name(pitch, display.middle_c_octave, pitch_names(display))

    def _fill_table(self, draft: FingeringDraft, chosen: tuple[int, int] | None = None) -> None:
        chosen = chosen or self._chosen()
        self._filling = True
        self._table.setUpdatesEnabled(False)
        # Otherwise each new cell would make Qt measure all columns again.
        self._fit_columns(QHeaderView.ResizeMode.Fixed)
        self._table.setRowCount(len(draft.table))
        shift = draft.instrument.transposition_semitones
        mark = QColor(self._session.tokens.by_hand)
        base = {(one.written_pitch, one.rank): one for one in draft.base}
        for row, one in enumerate(draft.table):
            first = one.rank == 1
            texts = (
                self._name(one.written_pitch) if first else "",
                self._name(one.written_pitch - shift) if first else "",
                str(one.rank),
                one.label,
                f"{one.cents:g}" if one.cents else "",
                ", ".join(words_of_tags(one.tags)),
            )
            for column, text in enumerate(texts):
                item = QTableWidgetItem(text)
                item.setData(_PLACE, (one.written_pitch, one.rank))
                if column < LABEL:
                    item.setFlags(item.flags() & ~Qt.ItemFlag.ItemIsEditable)
                if column == LABEL:
                    item.setToolTip(fingering_words(draft.instrument, one.label, language()))
                if base and base.get((one.written_pitch, one.rank)) != one:
                    item.setForeground(mark)
                self._table.setItem(row, column, item)
        self._fit_columns(QHeaderView.ResizeMode.ResizeToContents)
        self._table.setUpdatesEnabled(True)
        places = [(one.written_pitch, one.rank) for one in draft.table]
        at = places.index(chosen) if chosen in places else 0
        self._filling = False
        self._table.setCurrentCell(at, LABEL)
        self._show_row()

    def _fit_columns(self, mode: QHeaderView.ResizeMode) -> None:
        """Set the resize mode of all columns except the one that takes the remaining width."""
        header = self._table.horizontalHeader()
        header.setSectionResizeMode(mode)
        header.setSectionResizeMode(LABEL, QHeaderView.ResizeMode.Stretch)

    def _chosen(self) -> tuple[int, int] | None:
        """Return written pitch and rank of the fingering selected in the table; None if no row is selected."""
        item = self._table.item(self._table.currentRow(), LABEL)
        return None if item is None else tuple(item.data(_PLACE))

    def _fingering(self) -> Fingering | None:
        draft, row = self.draft, self._table.currentRow()
        return draft.table[row] if draft is not None and 0 <= row < len(draft.table) else None

    def _show_row(self) -> None:
        draft, one = self.draft, self._fingering()
        if self._filling or draft is None or one is None:
            return
        self._diagram.show_fingering(draft.instrument, one.controls)
        self._show_state()

    def _show_state(self) -> None:
        """Update buttons, problems and the marks of unsaved instruments."""
        draft, one = self.draft, self._fingering()
        if draft is None:
            return
        own = edit.of_pitch(draft.table, one.written_pitch) if one is not None else ()
        wrong = draft.problems
        enabled = {
            "up": one is not None and one.rank > 1,
            "down": one is not None and one.rank < len(own),
            "remove": len(own) > 1,
            "revert": one is not None and own != edit.of_pitch(draft.base, one.written_pitch) != (),
            "revert_all": bool(draft.base) and draft.table != draft.base,
            "undo": draft.at > 0,
            "redo": draft.at < len(draft.states) - 1,
            "save": not draft.is_saved and not wrong,
        }
        for name, is_enabled in enabled.items():
            self._buttons[name].setEnabled(is_enabled)
        self._report("\n".join(f"{_named(path, draft.table, self._name)}: {detail}" for path, detail in wrong[:3]))
        faulty = {path.stem for path in library().problems}
        for row in range(self._list.count()):
            item = self._list.item(row)
            id = str(item.data(_PLACE))
            known, is_own = self._drafts.get(id), id in library().own
            instrument = library().maps[id]
            unsaved = known is not None and not known.is_saved
            item.setText(f"{instrument_name(instrument)}{' •' if unsaved else ''}")
            tokens = self._session.tokens
            item.setIcon(icon("error", tokens, tokens.error) if id in faulty else QIcon())
            item.setForeground(QColor(tokens.by_hand if is_own or unsaved else tokens.text))

    def _report(self, text: str) -> None:
        self._problem.setStyleSheet(f"color: {self._session.tokens.error};")
        self._problem.setText(text)

    def _choices(self, column: int) -> list[str]:
        """Return the completions offered for a cell of a column."""
        draft = self.draft
        if draft is None:
            return []
        if column == LABEL:
            return list(dict.fromkeys(one.label for one in draft.instrument.fingerings))
        return list(tag_words().values()) if column == TAGS else []

    # Editing

    def _do(self, change: Callable[[FingeringDraft], edit.Table], chosen: tuple[int, int] | None = None) -> bool:
        """Apply a change to the table as one undo step, and return whether it is valid; errors are shown next to the
        table.
        """
        draft = self.draft
        if draft is None:
            return False
        try:
            table = change(draft)
        except AppError as error:
            self._fill_table(draft)
            self._report(message_text(error.message, self._session))
            return False
        if table != draft.table:
            del draft.states[draft.at + 1 :]
            draft.states.append(table)
            draft.at += 1
        self._fill_table(draft, chosen)
        self._show_state()
        return True

    def _edited(self, item: QTableWidgetItem) -> None:
        if self._filling:
            return
        (written, rank), text, column = item.data(_PLACE), item.text(), item.column()
        if column == LABEL:
            self._do(lambda draft: edit.with_label(draft.instrument, draft.table, written, rank, text))
        elif column == CENTS:
            self._do(lambda draft: edit.with_cents(draft.table, written, rank, self._number(text)))
        elif column == TAGS:
            self._do(lambda draft: edit.with_tags(draft.table, written, rank, tags_of_text(text)))

    def _number(self, text: str) -> float:
        """Return the number in a text. Raises UsageError if it is invalid."""
        return edit.read_cents(text)

    def _move(self, by: int) -> None:
        one = self._fingering()
        if one is not None:
            written, rank = one.written_pitch, one.rank
            self._do(lambda draft: edit.moved(draft.table, written, rank, by), (written, rank + by))

    def _add(self) -> None:
        """Add an alternate fingering, starting with the first one that the note lacks, and edit its label."""
        one, draft = self._fingering(), self.draft
        if one is None or draft is None:
            return
        label, written = edit.free_label(draft.instrument, draft.table, one.written_pitch), one.written_pitch
        if label is None:
            self._report(self.tr("instruments_dialog.all_fingerings_there"))
            return
        place = (written, len(edit.of_pitch(draft.table, written)) + 1)
        if self._do(lambda draft: edit.added(draft.instrument, draft.table, written, label), place):
            self._table.setFocus(Qt.FocusReason.OtherFocusReason)
            item = self._table.currentItem()
            if item is not None:
                self._table.editItem(item)

    def _remove(self) -> None:
        one = self._fingering()
        if one is not None:
            written, rank = one.written_pitch, one.rank
            self._do(lambda draft: edit.removed(draft.table, written, rank), (written, max(rank - 1, 1)))

    def _revert(self) -> None:
        one = self._fingering()
        if one is not None:
            written = one.written_pitch
            self._do(lambda draft: edit.reverted(draft.table, draft.base, written), (written, 1))

    def _revert_all(self) -> None:
        self._do(lambda draft: draft.base)

    def _toggle(self, name: str) -> None:
        """Change the state of a key clicked in the diagram: up, down, or half down if possible."""
        draft, one = self.draft, self._fingering()
        if draft is None or one is None:
            return
        label = edit.pressed_label(draft.instrument, one, name)
        written, rank = one.written_pitch, one.rank
        self._do(lambda draft: edit.with_label(draft.instrument, draft.table, written, rank, label))

    def _step(self, by: int) -> None:
        draft = self.draft
        if draft is not None and 0 <= draft.at + by < len(draft.states):
            draft.at += by
            self._fill_table(draft)
            self._show_state()

    # Files

    def save(self) -> bool:
        """Save the displayed instrument's table as the user's own, and return whether it is saved."""
        draft = self.draft
        if draft is None or draft.is_saved:
            return True
        try:
            edit.save_own(draft.instrument, draft.table, library().folder)
        except AppError as error:
            self._report(message_text(error.message, self._session))
            self._session.notice(error.message, Severity.ERROR)
            return False
        # The folder watch reads the file later; the new content is known already.
        draft.instrument = msgspec.structs.replace(draft.instrument, fingerings=draft.table)
        self._session.instruments_saved.emit()
        self.saved.emit(draft.instrument.id)
        self._show()
        return True

    def _open_folder(self) -> None:
        folder = library().folder
        folder.mkdir(parents=True, exist_ok=True)
        show_folder(folder)

    # Texts

    def retranslate(self) -> None:
        if self._list.count():
            self._show()

    # Qt overrides

    def sizeHint(self) -> QSize:
        return _SIZE

    def reject(self) -> None:
        """Close the dialog on Escape as by its button, with the question about unsaved changes."""
        self.close()

    def closeEvent(self, event: QCloseEvent) -> None:
        unsaved = [draft for draft in self._drafts.values() if not draft.is_saved]
        if unsaved:
            answer = self.ask(len(unsaved))
            if answer == "cancel" or (answer == "save" and not self._save_all(unsaved)):
                event.ignore()
                return
        # Qt's implementation would call `reject`, which closes the dialog.
        event.accept()

    def ask(self, count: int) -> str:
        """Ask about unsaved changes of ``count`` instruments: ``"save"``, ``"discard"`` or ``"cancel"``."""
        role = ask(
            self,
            "instruments_unsaved",
            self.tr("instruments_dialog.instruments"),
            self.tr("instruments_dialog.instruments_with_fingerings_that_are").format(count=count),
            "",
            {
                self.tr("instruments_dialog.save"): Role.AcceptRole,
                self.tr("instruments_dialog.discard"): Role.DestructiveRole,
                self.tr("instruments_dialog.cancel"): Role.RejectRole,
            },
            usual=Role.AcceptRole,
        )
        return "save" if role == Role.AcceptRole else "discard" if role == Role.DestructiveRole else "cancel"

    def _save_all(self, drafts: list[FingeringDraft]) -> bool:
        for draft in drafts:
            self.choose(draft.instrument.id)
            if not self.save():
                return False
        return True


class _Completing(QStyledItemDelegate):
    """Completes typed text from the instrument's other fingerings."""

    def __init__(self, choices: Callable[[int], list[str]], parent: QWidget) -> None:
        super().__init__(parent)
        self._choices = choices

    def createEditor(
        self, parent: QWidget, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> QWidget:
        """Return a line edit that completes the typed text from the choices of the cell's column."""
        line = QLineEdit(parent)
        completer = QCompleter(self._choices(index.column()), line)
        completer.setCaseSensitivity(Qt.CaseSensitivity.CaseInsensitive)
        completer.setFilterMode(Qt.MatchFlag.MatchContains)
        line.setCompleter(completer)
        return line


def _named(path: str, table: edit.Table, name: Callable[[int], str]) -> str:
    """Return the key path of a problem with the note's name instead of a row number."""
    head, bracket, rest = path.partition("[")
    row, _, key = rest.partition("]")
    if head == "fingerings" and bracket and row.isdigit() and int(row) < len(table):
        one = table[int(row)]
        return f"{name(one.written_pitch)} ({one.label}){key and ' '}{key.lstrip('.')}"
    return path


def _split(left: QWidget, right: QWidget, sizes_px: tuple[int, int], stretches: int) -> QSplitter:
    """Return a splitter with two widgets side by side; ``stretches`` is the index of the one that takes the remaining
    width.
    """
    splitter = QSplitter()
    splitter.addWidget(left)
    splitter.addWidget(right)
    splitter.setStretchFactor(stretches, 1)
    splitter.setSizes(sizes_px)
    splitter.setChildrenCollapsible(False)
    return splitter
