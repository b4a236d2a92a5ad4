"""The import of a MIDI file: which of its tracks are played, by how many, on what and as whom.

What comes of the choices is worked out beside the window: a file can ask for minutes of it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from threading import Event
from typing import Final, NamedTuple

import msgspec
from PySide6.QtCore import QPoint, QSize, Qt, QTimer
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QDialog,
    QHeaderView,
    QLineEdit,
    QListWidget,
    QTableWidget,
    QWidget,
)

from app.editor.questions import ReadAgain
from app.editor.tasks import Progress, StopRequested, Tasks
from app.editor.tokens import LEAST_TARGET_PX, Tokens
from app.errors import AppError, Message
from app.messages.pitches import pitch_name
from app.project.choreography_files import bundled_choreographies
from app.project.importing import (
    ImportPreview,
    ImportRequest,
    ImportRow,
    automatic,
    carried_over,
    merged,
    outcome_of,
    separated,
    usual_rows,
)
from app.rig.characters.character_library import characters
from app.score.choose import use_of
from app.score.contents import PieceContents
from app.score.model import UnplayedPart
from app.score.parts import PERCUSSION, PartAssignment, stream_name
from app.score.take_tracks import TakeReason, take_reason
from instrument_maps.model import InstrumentMap
from instrument_maps.score_order import in_score_order
from widgets.common.controls import Button, Caption, Check, OkCancel, Retranslated, named
from widgets.common.instrument_name import character_name, instrument_name
from widgets.common.layouts import STRETCH, begin_with_size, in_column, in_row, panel
from widgets.common.plain import ComboBox, Label
from widgets.common.text import message_text, sentence
from widgets.dialogs.encoding_choice import EncodingChoice
from widgets.dialogs.notes_preview import ROW_PX, NotesPreview

_USE, _NAME, _PREVIEW, _NOTES, _SPLIT, _INSTRUMENT, _PITCHES, _CHARACTER, _CLEAN = range(9)
_SIZE = QSize(1280, 580)
_TAKES: Final[Mapping[TakeReason, str]] = {
    "recorded": "import_dialog.take_recorded",
    "name": "import_dialog.take_name",
    "breath": "import_dialog.take_breath",
}
"""Why a track looks like a take, and what cleaning it does."""
_TITLE_PX = 600
_INSTRUMENT_LETTERS = 31
"""Width of the column of instruments: the longest names would leave the notes no room."""
_ROWS_AT_ONCE, _ROWS_LATER = 14, 4
"""Rows that are made before anything is shown, and of the others in each turn of the event loop."""
_SLOW_MS = 300
"""After this long the dialog says that it is working."""


class _ReadAgain(NamedTuple):
    """A file with its texts in another encoding, and what comes of the choices made for it."""

    encoding: str | None
    contents: PieceContents
    usual: tuple[ImportRow, ...]
    rows: tuple[ImportRow, ...]
    outcome: ImportPreview


class ImportDialog(Retranslated, QDialog):
    """Asks how a MIDI file becomes players; sensible without touching it.

    Parameters
    ----------
    maps : mapping of str to InstrumentMap
        Every installed instrument by id.
    tasks : Tasks
        Where what comes of the choices is worked out.
    read_again : callable, optional
        Reads the file with its texts in another encoding; without it none can be chosen.
    """

    def __init__(
        self,
        contents: PieceContents,
        maps: Mapping[str, InstrumentMap],
        tokens: Tokens,
        tasks: Tasks,
        parent: QWidget | None = None,
        read_again: ReadAgain | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("import_midi")
        self._contents, self._maps, self._tokens, self._tasks = contents, maps, tokens, tasks
        self._read_again = read_again
        self._encoding: str | None = None
        self._usual: tuple[ImportRow, ...] = ()
        """The rows by default."""
        self._rows: tuple[ImportRow, ...] = ()
        self._outcome: ImportPreview | None = None
        """Of the newest rows for which it is known."""
        self._closing = Event()
        self._slow = QTimer(self, singleShot=True, interval=_SLOW_MS)
        self._slow.timeout.connect(self._show_slow)
        self._filled = 0
        """So many rows of the table have their widgets."""
        self._filling = QTimer(self, interval=0)
        self._filling.timeout.connect(lambda: self._fill_more(_ROWS_LATER))
        self._end_tick = max((max(stream.end_ticks) for stream in contents.streams), default=1)

        self._heading = named(Label(), "heading")
        self._table = self.texted(
            named(QTableWidget(0, 9), "import_tracks"),
            columns=(
                "import_dialog.play",
                "import_dialog.name",
                "import_dialog.notes",
                "import_dialog.number_range",
                "import_dialog.notes_together",
                "import_dialog.instrument",
                "import_dialog.pitches",
                "import_dialog.character",
                "import_dialog.clean_take",
            ),
        )
        self._table.verticalHeader().hide()
        self._table.verticalHeader().setDefaultSectionSize(ROW_PX)
        self._table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self._table.setShowGrid(False)
        header = self._table.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(_PREVIEW, QHeaderView.ResizeMode.Stretch)
        header.setMinimumSectionSize(40)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self._merge = Button(
            "import_dialog.merge_into_one_part", self.merge_selected, "merge", "import_dialog.make_one_part_of_selected"
        )
        self._separate = Button(
            "import_dialog.take_apart", self.separate_selected, "separate", "import_dialog.make_part_of_each_merged"
        )
        self._find_percussion()
        self._dancer = self.texted(
            named(Check("import_dialog.add_dancer"), "import_dancer"),
            tip="import_dialog.dancer_who_moves_to_percussion",
        )
        self._encodings = EncodingChoice()
        self._encoding_title = Caption("import_dialog.encoding", self._encodings)
        self._encodings.chosen.connect(self._choose_encoding)
        for widget in (self._encoding_title, self._encodings):
            widget.setVisible(read_again is not None)
        self._summary = named(Label(), "import_summary")
        self._warning_title = Label()
        self._warnings = named(QListWidget(), "import_warnings")
        self._warnings.setWordWrap(True)
        self._warnings.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self._warnings.setMaximumHeight(110)
        self._buttons = OkCancel("import_dialog.import", "import_dialog.cancel")
        self._buttons.accepted.connect(self.accept)
        self._buttons.rejected.connect(self.reject)

        heading = in_row((self._heading, 1), self._encoding_title, self._encodings)
        tools = in_row(self._merge, self._separate, 12, self._dancer, STRETCH, self._summary)
        in_column(heading, (self._table, 1), tools, self._warning_title, self._warnings, self._buttons, of=self)
        self._table.itemSelectionChanged.connect(self._show_tools)
        # Rows are there once it is known what the file says.
        self._encodings.setEnabled(False)
        self.texted(self, title="import_dialog.import_midi")
        self.retranslate()
        begin_with_size(self, _SIZE)
        self._work_out(None)

    @property
    def rows(self) -> tuple[ImportRow, ...]:
        """What is requested so far; empty until it is known what the file says."""
        return self._rows

    @property
    def assignment(self) -> ImportRequest:
        """Rows, whether a dancer comes with them, and the encoding of the file's texts."""
        return ImportRequest(self._rows, self._dancer.isChecked(), self._contents, self._encoding)

    def merge_selected(self) -> None:
        """Make one part of the selected tracks."""
        places = self._selected()
        if len(places) > 1:
            self._rows = merged(self._rows, places)
            self._fill()
            self._table.selectRow(min(places))
            self._work_out(self._rows)

    def separate_selected(self) -> None:
        """Take the selected part apart into its tracks."""
        for place in reversed(self._selected()):
            if len(self._rows[place].assignment.streams) > 1:
                self._rows = separated(self._rows, place)
        self._fill()
        self._work_out(self._rows)

    def retranslate(self) -> None:
        contents = self._contents
        length_s, metrics = contents.tempo_map.seconds(float(self._end_tick)), self._heading.fontMetrics()
        self._heading.setText(
            self.tr("import_dialog.text").format(
                title=metrics.elidedText(contents.title, Qt.TextElideMode.ElideRight, _TITLE_PX),
                minutes=int(length_s) // 60,
                seconds=int(length_s) % 60,
                tempo=round(contents.tempo_map.bpm[0][1], 1),
                metre=f"{contents.metres[0].numerator}/{contents.metres[0].denominator}",
            )
        )
        self._fill()

    def _choose_encoding(self, encoding: str | None) -> None:
        """Read the file's texts again."""
        read_again, maps, closing = self._read_again, self._maps, self._closing
        contents, rows, usual = self._contents, self._rows, self._usual
        if read_again is None:
            return

        def work(progress: Progress, stop_requested: StopRequested) -> _ReadAgain:
            again = read_again(encoding)
            usual_again = usual_rows(again, maps)
            carried = carried_over(rows, usual, contents, again, usual_again)
            outcome = outcome_of(again, carried, maps, None, lambda: stop_requested() or closing.is_set())
            return _ReadAgain(encoding, again, usual_again, carried, outcome)

        def failed(error: AppError) -> None:
            self._encodings.show_encoding(self._encoding)
            self._summary.setText(message_text(error.message))

        # What is chosen meanwhile would be of rows that are no longer there.
        self._table.setEnabled(False)
        self._slow.start()
        self._tasks.run(
            Message("work.open"),
            work,
            self._take_again,
            failed,
            key="import",
            ended=lambda: self._table.setEnabled(True),
        )

    def _take_again(self, read: _ReadAgain) -> None:
        if self._closing.is_set():
            return
        self._slow.stop()
        self._encodings.show_encoding(read.encoding)
        self._encoding, self._contents, self._usual = read.encoding, read.contents, read.usual
        self._rows, self._outcome = read.rows, read.outcome
        self._find_percussion()
        self.retranslate()

    def _find_percussion(self) -> None:
        """Find the streams that are percussion, or sound effects, if no one says otherwise."""
        uses = [use_of(stream) for stream in self._contents.streams]
        self._rhythm, self._effects = (
            frozenset(place for place, use in enumerate(uses) if use == one) for one in ("rhythm", "effect")
        )

    def _selected(self) -> list[int]:
        return sorted({index.row() for index in self._table.selectionModel().selectedRows()})

    def _fill(self) -> None:
        self._table.setRowCount(0)
        self._table.setRowCount(len(self._rows))
        self._filled = 0
        # Only where a track looks like a take is there something to clean.
        self._table.setColumnHidden(_CLEAN, not any(map(self._take_reason, self._rows)))
        self._instruments = [(instrument_name(table), table.id) for table in in_score_order(self._maps.values())]
        self._characters = [(character_name(id_), id_) for id_ in characters()]
        self._fill_more(_ROWS_AT_ONCE)
        self._show_tools()
        self._show_outcome()

    def _fill_more(self, count: int) -> None:
        """Make the widgets of some more rows, and of the others when the window has time."""
        end = min(self._filled + count, len(self._rows))
        for place in range(self._filled, end):
            self._fill_row(place, self._rows[place])
        if self._filled == 0 or end == len(self._rows):
            # Said again, the table measures its columns again: Qt does not do so for widgets that come later.
            self._table.horizontalHeader().setSectionResizeMode(_PREVIEW, QHeaderView.ResizeMode.Stretch)
        self._filled = end
        if end < len(self._rows):
            self._filling.start()
        else:
            self._filling.stop()

    def _work_out(self, rows: tuple[ImportRow, ...] | None) -> None:
        """Find out what comes of these rows, or of the usual ones."""
        contents, maps, before, closing = self._contents, self._maps, self._outcome, self._closing

        def work(progress: Progress, stop_requested: StopRequested) -> tuple[tuple[ImportRow, ...], ImportPreview]:
            asked = usual_rows(contents, maps) if rows is None else rows
            return asked, outcome_of(contents, asked, maps, before, lambda: stop_requested() or closing.is_set())

        self._slow.start()
        self._tasks.run(Message("work.open"), work, self._worked_out, key="import")

    def _worked_out(self, found: tuple[tuple[ImportRow, ...], ImportPreview]) -> None:
        rows, outcome = found
        first = self._outcome is None
        if self._closing.is_set() or not (first or rows is self._rows):
            return
        self._slow.stop()
        self._outcome = outcome
        if first:
            self._rows = self._usual = rows
            self._encodings.setEnabled(True)
            self._fill()
            return
        for place in range(self._filled):
            self._show_instruments(place)
        self._show_outcome()

    def _show_slow(self) -> None:
        self._summary.setText(self.tr("import_dialog.finding_out_who_plays_what"))

    def _fill_row(self, place: int, row: ImportRow) -> None:
        use = named(_Tick(), f"play_{place}")
        use.setChecked(row.requested)
        use.toggled.connect(lambda requested: self._request(place, requested))
        self._table.setCellWidget(place, _USE, _centred(use))

        name = named(QLineEdit(row.assignment.name or self._name(row)), f"name_{place}")
        name.setMinimumWidth(130)
        name.textEdited.connect(lambda text: self._assignment(place, name=text.strip()))
        self._table.setCellWidget(place, _NAME, name)

        streams = [self._contents.streams[stream] for stream in row.assignment.streams]
        self._table.setCellWidget(place, _PREVIEW, NotesPreview(streams, self._end_tick, self._tokens))
        count = Label(
            self.tr("import_dialog.notes_to").format(
                count=sum(len(stream.pitches) for stream in streams),
                low=pitch_name(min(min(stream.pitches) for stream in streams)),
                high=pitch_name(max(max(stream.pitches) for stream in streams)),
            )
        )
        count.setContentsMargins(6, 0, 6, 0)
        self._table.setCellWidget(place, _NOTES, count)

        usual, assignment = self.tr("import_dialog.automatic"), row.assignment
        splits = (
            (usual, "sustained"),
            (self.tr("import_dialog.share_among_players"), "every"),
            (self.tr("import_dialog.one_player"), "never"),
        )
        split = self._choice(place, _SPLIT, "split", splits, assignment.split)
        split.setToolTip(self.tr("import_dialog.automatic_another_player_for_notes"))
        split.currentIndexChanged.connect(lambda: self._assignment(place, split=split.currentData()))

        instruments = [(usual, None), *self._instruments]
        if not self._rhythm.issuperset(assignment.streams):
            instruments.append((self.tr("import_dialog.percussion_for_dancers"), PERCUSSION))
        instrument = self._choice(place, _INSTRUMENT, "instrument", instruments, assignment.map_id)
        instrument.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        instrument.setMinimumContentsLength(_INSTRUMENT_LETTERS)
        instrument.currentIndexChanged.connect(lambda: self._choose(place, instrument.currentData()))
        instrument.currentTextChanged.connect(lambda text: instrument.setToolTip(self._tip(place) or text))

        kinds = ((self.tr("import_dialog.sounding"), False), (self.tr("import_dialog.written"), True))
        pitches = self._choice(place, _PITCHES, "pitches", kinds, assignment.written)
        pitches.setToolTip(self.tr("import_dialog.which_pitches_file_has_of"))
        pitches.currentIndexChanged.connect(lambda: self._assignment(place, written=bool(pitches.currentData())))

        figures = ((usual, None), *self._characters)
        character = self._choice(place, _CHARACTER, "character", figures, row.character_id)
        character.currentIndexChanged.connect(lambda: self._set(place, character_id=character.currentData()))
        reason = self._take_reason(row)
        if reason:
            clean = named(_Tick(), f"clean_{place}")
            clean.setChecked(assignment.clean)
            clean.setToolTip(self.tr(_TAKES[reason]))
            clean.toggled.connect(lambda clean: self._assignment(place, clean=clean))
            self._table.setCellWidget(place, _CLEAN, _centred(clean))
        self._enable(place)
        self._show_instruments(place)

    def _take_reason(self, row: ImportRow) -> TakeReason:
        """Why a row's tracks are taken for takes; empty where one of them is none."""
        own = (self._contents.streams[stream] for stream in row.assignment.streams)
        reasons = [take_reason(stream, self._contents.tempo_map) for stream in own]
        return reasons[0] if all(reasons) else ""

    def _choice(
        self, place: int, column: int, name: str, options: Iterable[tuple[str, object]], chosen: object
    ) -> ComboBox:
        """A cell with options by their texts; the first where what is chosen is not among them."""
        box = named(ComboBox(), f"{name}_{place}")
        for text, value in options:
            box.addItem(text, value)
        box.setCurrentIndex(max(box.findData(chosen), 0))
        self._table.setCellWidget(place, column, box)
        return box

    def _played_on(self, assignment: PartAssignment) -> list[InstrumentMap]:
        """What a row is played on, were it requested; nothing where that is not known yet."""
        return [] if self._outcome is None else [self._maps[id_] for id_ in self._outcome.instruments_of(assignment)]

    def _can_choose(self, row: ImportRow) -> bool:
        """Return whether a row that is not requested has an instrument to choose."""
        return row.assignment.map_id == PERCUSSION or self._asks(row)

    def _asks(self, row: ImportRow) -> bool:
        """Whether nothing says what plays a row."""
        return self._outcome is not None and row.assignment.map_id is None and not self._played_on(row.assignment)

    def _show_instruments(self, place: int) -> None:
        """Say which instruments a row's names, programs and ranges choose, and whether its pitches can be written."""
        row = self._rows[place]
        instrument, pitches = self._table.cellWidget(place, _INSTRUMENT), self._table.cellWidget(place, _PITCHES)
        assert isinstance(instrument, ComboBox)
        assert pitches is not None
        names = dict.fromkeys(map(instrument_name, self._played_on(automatic(row.assignment))))
        if names:
            instrument.setItemText(0, self.tr("import_dialog.automatic_2").format(name=" + ".join(names)))
        elif self._rhythm.issuperset(row.assignment.streams):
            instrument.setItemText(0, self.tr("import_dialog.percussion_for_dancers"))
        elif self._effects.issuperset(row.assignment.streams):
            instrument.setItemText(0, self.tr("import_dialog.sound_effect"))
        elif self._outcome is not None and not row.assignment.map_id:
            instrument.setItemText(0, self.tr("import_dialog.choose_instrument"))
        tip = self._tip(place)
        instrument.setToolTip(tip or instrument.currentText())
        for column in (_USE, _PREVIEW, _NOTES):
            widget = self._table.cellWidget(place, column)
            if widget is not None:
                widget.setToolTip(tip)
        instrument.setEnabled(row.requested or self._can_choose(row))
        # Only there is a difference.
        transposes = any(table.transposition_semitones for table in self._played_on(row.assignment))
        pitches.setEnabled(row.requested and transposes)

    def _is_percussion(self, row: ImportRow) -> bool:
        chosen = row.assignment.map_id
        return chosen == PERCUSSION or (chosen is None and self._rhythm.issuperset(row.assignment.streams))

    def _tip(self, place: int) -> str:
        """What there is to know of a row; empty for most."""
        row = self._rows[place]
        if self._is_percussion(row):
            return self.tr("import_dialog.percussion_track_no_player_plays")
        if row.assignment.map_id is None and self._effects.issuperset(row.assignment.streams):
            return self.tr("import_dialog.sound_effects_no_player_plays")
        return ""

    def _name(self, row: ImportRow) -> str:
        names = Counter(stream_name(self._contents.streams[stream]) for stream in row.assignment.streams)
        return " + ".join(name if count == 1 else f"{name} ×{count}" for name, count in names.items())

    def _choose(self, place: int, map_id: str | None) -> None:
        """Take an instrument for a row; one that was asked for is what lets it be played. No one plays percussion."""
        row = self._rows[place]
        asked, was_percussion = self._asks(row), row.assignment.map_id == PERCUSSION
        self._assignment(place, map_id=map_id)
        tick = self._table.cellWidget(place, _USE)
        box = tick.findChild(QCheckBox) if tick is not None else None
        if box is None:
            return
        if map_id == PERCUSSION:
            box.setChecked(False)
        elif (asked and map_id is not None) or (was_percussion and self._played_on(self._rows[place].assignment)):
            box.setChecked(True)

    def _request(self, place: int, requested: bool) -> None:
        """Have a row played, or not; what is percussion by choice is no longer."""
        self._set(place, requested=requested)
        instrument = self._table.cellWidget(place, _INSTRUMENT)
        if requested and self._rows[place].assignment.map_id == PERCUSSION and isinstance(instrument, ComboBox):
            instrument.setCurrentIndex(0)

    def _assignment(self, place: int, **changes: object) -> None:
        self._set(place, assignment=msgspec.structs.replace(self._rows[place].assignment, **changes))

    def _set(self, place: int, **changes: object) -> None:
        changed = msgspec.structs.replace(self._rows[place], **changes)
        self._rows = (*self._rows[:place], changed, *self._rows[place + 1 :])
        self._enable(place)
        self._work_out(self._rows)

    def _enable(self, place: int) -> None:
        row = self._rows[place]
        for column in (_NAME, _PREVIEW, _NOTES, _SPLIT, _INSTRUMENT, _CHARACTER, _CLEAN):
            widget = self._table.cellWidget(place, column)
            if widget is not None:
                # Where nothing says what the instrument is, it is asked for.
                widget.setEnabled(row.requested or (column == _INSTRUMENT and self._can_choose(row)))

    def _show_tools(self) -> None:
        places = self._selected()
        self._merge.setEnabled(len(places) > 1)
        self._separate.setEnabled(any(len(self._rows[place].assignment.streams) > 1 for place in places))

    def _show_outcome(self) -> None:
        """Say what will come of it: the reader's warnings where nothing was changed, the players in any case."""
        outcome = self._outcome
        asking = [row for row in self._rows if row.requested and self._asks(row)]
        self._buttons.ok.setEnabled(outcome is not None and not asking)
        self._dancer.setVisible(any(map(self._is_percussion, self._rows)) and bool(bundled_choreographies()))
        self._warnings.clear()
        if outcome is not None:
            if asking:
                self._summary.setText(self.tr("import_dialog.choose_instrument_for").format(name=self._name(asking[0])))
            elif outcome.players:
                self._summary.setText(self.tr("import_dialog.players").format(count=outcome.players))
            elif self._rows:
                self._summary.setText(self.tr("import_dialog.no_tracks_selected"))
            else:
                self._summary.setText(self.tr("import_dialog.no_notes_to_import"))
            self._warnings.addItems([sentence(message) for message in outcome.warnings])
            self._warnings.addItems([self._unplayed(part) for part in outcome.unplayed])
        self._warning_title.setText(self.tr("import_dialog.what_reader_noticed"))
        self._warning_title.setVisible(self._warnings.count() > 0)
        self._warnings.setVisible(self._warnings.count() > 0)

    def _unplayed(self, part: UnplayedPart) -> str:
        """Why a part is not played, and that it is for dancers where it is."""
        reason = message_text(part.reason)
        percussion = {
            stream_name(self._contents.streams[stream])
            for row in self._rows
            if self._is_percussion(row)
            for stream in row.assignment.streams
        }
        if part.reason.id == "score.percussion" and part.name in percussion:
            return self.tr("import_dialog.is_not_played_dancers_dance").format(name=part.name, reason=reason)
        return self.tr("import_dialog.is_not_played").format(name=part.name, reason=reason)

    def sizeHint(self) -> QSize:
        return _SIZE

    def done(self, result: int) -> None:
        self._closing.set()
        super().done(result)


class _Tick(QCheckBox):
    """A box without a word: all of it can be clicked, not the small square alone."""

    def __init__(self) -> None:
        super().__init__()
        self.setMinimumSize(LEAST_TARGET_PX, LEAST_TARGET_PX)

    def hitButton(self, pos: QPoint) -> bool:
        return self.rect().contains(pos)


def _centred(widget: QWidget) -> QWidget:
    return panel(in_row((widget, 0, Qt.AlignmentFlag.AlignCenter), margins=(8, 0, 8, 0)))
