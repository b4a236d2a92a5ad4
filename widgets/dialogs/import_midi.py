"""Import dialog of a MIDI file: the tracks to play, number of players, instruments and characters.

Consequences of the choices are computed in the background, since a file may take minutes.
"""

from __future__ import annotations

from collections.abc import Mapping
from threading import Event
from typing import NamedTuple

from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QListWidget,
    QWidget,
)

from app.editor.design_tokens import Tokens
from app.editor.questions import ReadAgain
from app.editor.tasks import Tasks
from app.errors import AppError, Message, Progress, StopRequested
from app.project.choreography_files import bundled_choreographies
from app.project.importing import (
    ImportPreview,
    ImportRequest,
    ImportRow,
    carried_over,
    merged,
    outcome_of,
    separated,
    usual_rows,
)
from app.score.contents import PieceContents
from app.score.model import UnplayedPart
from app.score.parts import stream_name
from instrument_maps.model import InstrumentMap
from widgets.common.combo import Combo, Option
from widgets.common.controls import Button, Caption, Check, OkCancel, Retranslated, named
from widgets.common.help import with_help
from widgets.common.instrument_name import outfit_names
from widgets.common.layouts import STRETCH, begin_with_size, in_column, in_row
from widgets.common.plain import Label
from widgets.common.text import message_text, sentence
from widgets.dialogs.encoding_choice import EncodingChoice
from widgets.dialogs.import_table import ImportTable

_SIZE = QSize(1280, 580)
_TITLE_PX = 600
_SLOW_MS = 300
_OUTFIT_LETTERS = 20
_BY_PIECE = "\0by_piece"
"""Value of the option that leaves the outfits to the piece; no outfit has this id."""
"""After this long the dialog says that it is working."""


class _ReadAgain(NamedTuple):
    """A MIDI file read again with another text encoding, and the resulting rows of the import."""

    encoding: str | None
    contents: PieceContents
    usual: tuple[ImportRow, ...]
    rows: tuple[ImportRow, ...]
    outcome: ImportPreview


class ImportDialog(Retranslated, QDialog):
    """Choice of players for a MIDI file, with useful defaults.

    Parameters
    ----------
    maps : mapping of str to InstrumentMap
        All installed instruments by id.
    tasks : Tasks
        Background tasks for computing the consequences.
    read_again : callable, optional
        Function that reads the file with another encoding; without it the encoding cannot be chosen.
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
        self._maps, self._tasks = maps, tasks
        self._read_again = read_again
        self._encoding: str | None = None
        self._usual: tuple[ImportRow, ...] = ()
        """The rows by default."""
        self._closing = Event()
        self._slow = QTimer(self, singleShot=True, interval=_SLOW_MS)
        self._slow.timeout.connect(self._show_slow)
        self._heading = named(Label(), "heading")
        self._table = ImportTable(contents, maps, tokens)
        self._table.edited.connect(lambda: self._work_out(self._table.rows))
        self._merge = Button(
            "import_dialog.merge_into_one_part", self.merge_selected, "merge", "import_dialog.make_one_part_of_selected"
        )
        self._separate = Button(
            "import_dialog.take_apart", self.separate_selected, "separate", "import_dialog.split_merged_tip"
        )
        self._dancer = self.texted(
            named(Check("import_dialog.add_dancer"), "import_dancer"),
            tip="import_dialog.dancer_who_moves_to_percussion",
        )
        self._outfit = named(Combo(), "import_outfit")
        self._outfit.setMinimumContentsLength(_OUTFIT_LETTERS)
        self._outfit_title = Caption("import_dialog.outfit", self._outfit)
        self.texted(self._outfit, tip="import_dialog.outfit_tip")
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
        tools = in_row(
            *(self._merge, self._separate, 12, self._dancer, 12, self._outfit_title, self._outfit),
            *(STRETCH, self._summary),
        )
        in_column(
            heading, (self._table, 1), tools, self._warning_title, self._warnings, with_help(self._buttons), of=self
        )
        self._table.itemSelectionChanged.connect(self._show_tools)
        # Rows are added when the content of the file is known.
        self._encodings.setEnabled(False)
        self.texted(self, title="import_dialog.import_midi")
        self.retranslate()
        begin_with_size(self, _SIZE)
        self._work_out(None)

    @property
    def rows(self) -> tuple[ImportRow, ...]:
        """The import rows with the user's choices; empty until the file has been read."""
        return self._table.rows

    @property
    def assignment(self) -> ImportRequest:
        """The result: rows, whether to add a dancer, encoding, and outfit of all players."""
        table, chosen = self._table, self._outfit.shown
        outfit = None if chosen == _BY_PIECE else chosen
        return ImportRequest(table.rows, self._dancer.isChecked(), table.contents, self._encoding, outfit)

    def merge_selected(self) -> None:
        """Merge the selected tracks into one part."""
        places = self._table.selected()
        if len(places) > 1:
            self._table.rows = merged(self._table.rows, places)
            self._fill()
            self._table.selectRow(min(places))
            self._work_out(self._table.rows)

    def separate_selected(self) -> None:
        """Split the selected part into its tracks."""
        for place in reversed(self._table.selected()):
            if len(self._table.rows[place].assignment.channels) > 1:
                self._table.rows = separated(self._table.rows, place)
        self._fill()
        self._work_out(self._table.rows)

    def retranslate(self) -> None:
        contents = self._table.contents
        length_s, metrics = contents.tempo_map.seconds(float(self._table.end_tick)), self._heading.fontMetrics()
        self._heading.setText(
            self.tr("import_dialog.text").format(
                title=metrics.elidedText(contents.title, Qt.TextElideMode.ElideRight, _TITLE_PX),
                minutes=int(length_s) // 60,
                seconds=int(length_s) % 60,
                tempo=round(contents.tempo_map.bpm[0][1], 1),
                metre=f"{contents.metres[0].numerator}/{contents.metres[0].denominator}",
            )
        )
        outfits = {_BY_PIECE: self.tr("import_dialog.by_piece"), **outfit_names()}
        self._outfit.set_options([Option(id, name) for id, name in outfits.items()])
        if self._outfit.shown is None:
            self._outfit.show_option(_BY_PIECE)
        self._fill()

    def _choose_encoding(self, encoding: str | None) -> None:
        """Read the MIDI file again with its texts in another encoding (None: guessed), keeping the decisions."""
        read_again, maps, closing = self._read_again, self._maps, self._closing
        contents, rows, usual = self._table.contents, self._table.rows, self._usual
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

        # Choices made meanwhile would belong to rows that are removed.
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
        self._encoding, self._usual = read.encoding, read.usual
        self._table.read(read.contents)
        self._table.rows, self._table.outcome = read.rows, read.outcome
        self.retranslate()

    def _work_out(self, rows: tuple[ImportRow, ...] | None) -> None:
        """Compute the resulting players of the given rows, or of the default ones, in the background."""
        contents, maps, before, closing = self._table.contents, self._maps, self._table.outcome, self._closing

        def work(progress: Progress, stop_requested: StopRequested) -> tuple[tuple[ImportRow, ...], ImportPreview]:
            asked = usual_rows(contents, maps) if rows is None else rows
            return asked, outcome_of(contents, asked, maps, before, lambda: stop_requested() or closing.is_set())

        self._slow.start()
        self._tasks.run(Message("work.open"), work, self._worked_out, key="import")

    def _worked_out(self, found: tuple[tuple[ImportRow, ...], ImportPreview]) -> None:
        rows, outcome = found
        first = self._table.outcome is None
        if self._closing.is_set() or not (first or rows is self._table.rows):
            return
        self._slow.stop()
        if first:
            self._table.outcome = outcome
            self._table.rows = self._usual = rows
            self._encodings.setEnabled(True)
            self._fill()
            return
        self._table.show_outcome(outcome)
        self._show_outcome()

    def _show_slow(self) -> None:
        self._summary.setText(self.tr("import_dialog.assigning"))

    def _fill(self) -> None:
        self._table.fill()
        self._show_tools()
        self._show_outcome()

    def _show_tools(self) -> None:
        places = self._table.selected()
        self._merge.setEnabled(len(places) > 1)
        self._separate.setEnabled(any(len(self._table.rows[place].assignment.channels) > 1 for place in places))

    def _show_outcome(self) -> None:
        """Show the resulting players, and the reader's warnings if the user has changed nothing."""
        outcome = self._table.outcome
        asking = [row for row in self._table.rows if row.requested and self._table.asks(row)]
        self._buttons.ok.setEnabled(outcome is not None and not asking)
        self._dancer.setVisible(
            any(map(self._table.is_percussion, self._table.rows)) and bool(bundled_choreographies())
        )
        self._warnings.clear()
        if outcome is not None:
            if asking:
                self._summary.setText(
                    self.tr("import_dialog.choose_instrument_for").format(name=self._table.name_of(asking[0]))
                )
            elif outcome.players:
                self._summary.setText(self.tr("import_dialog.players").format(count=outcome.players))
            elif self._table.rows:
                self._summary.setText(self.tr("import_dialog.no_tracks_selected"))
            else:
                self._summary.setText(self.tr("import_dialog.no_notes_to_import"))
            self._warnings.addItems([sentence(message) for message in outcome.warnings])
            self._warnings.addItems([self._unplayed(part) for part in outcome.unplayed])
        self._warning_title.setText(self.tr("import_dialog.warnings"))
        self._warning_title.setVisible(self._warnings.count() > 0)
        self._warnings.setVisible(self._warnings.count() > 0)

    def _unplayed(self, part: UnplayedPart) -> str:
        """Return the reason why a part is not played, or a text that only dancers use it."""
        reason = message_text(part.reason)
        if part.is_of_played_part:
            return self.tr("import_dialog.excluded_part").format(name=part.name, reason=reason)
        percussion = {
            stream_name(self._table.contents.channels[channel])
            for row in self._table.rows
            if self._table.is_percussion(row)
            for channel in row.assignment.channels
        }
        if part.reason.id == "score.percussion" and part.name in percussion:
            return self.tr("import_dialog.is_not_played_dancers_dance").format(name=part.name, reason=reason)
        return self.tr("import_dialog.is_not_played").format(name=part.name, reason=reason)

    def sizeHint(self) -> QSize:
        return _SIZE

    def done(self, result: int) -> None:
        self._closing.set()
        super().done(result)
