"""Table of a MIDI file's tracks with the choices for each."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from functools import partial
from typing import Final, get_args

import msgspec
from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QHeaderView,
    QLineEdit,
    QTableWidget,
)

from app.editor.design_tokens import Tokens
from app.messages.pitches import pitch_name
from app.project.importing import (
    ImportPreview,
    ImportRow,
    automatic,
)
from app.rig.characters.character_library import characters
from app.score.assignments import PERCUSSION, PartAssignment
from app.score.contents import PieceContents
from app.score.parts import stream_name
from app.score.take_tracks import TakeReason, take_reason
from app.score.track_instrument import use_of
from instrument_maps.model import InstrumentMap
from instrument_maps.score_order import in_score_order
from widgets.common.controls import Retranslated, named
from widgets.common.instrument_name import character_name, instrument_name
from widgets.common.plain import ComboBox, Label
from widgets.dialogs.import_cells import InstrumentCell, Tick, centred, option_box
from widgets.dialogs.notes_preview import ROW_PX, NotesPreview

_USE, _NAME, _PREVIEW, _NOTES, _SPLIT, _INSTRUMENT, _PITCHES, _CHARACTER, _CLEAN = range(9)
_COLUMNS: Final = tuple(
    f"import_dialog.{column}"
    for column in (
        *("play", "name", "notes", "number_range", "notes_together"),
        *("instrument", "pitches", "character", "clean_take"),
    )
)
_TAKES: Final[Mapping[TakeReason, str]] = {
    reason: f"import_dialog.take_{reason}" for reason in get_args(TakeReason) if reason
}
"""Text ids of the reasons why a track looks like a take; each mentions the cleaning."""
_INSTRUMENT_LETTERS = 31
"""Greatest width of the column of instruments in letters, so that the longest names leave space for the notes."""
_ROWS_AT_ONCE, _ROWS_LATER = 14, 4
"""Number of rows made before the first display, and in each later turn of the event loop."""


class ImportTable(Retranslated, QTableWidget):
    """A row with choices for every track or part of several tracks.

    Attributes
    ----------
    contents : PieceContents
        The file.
    rows : tuple of ImportRow
        Rows in their present state.
    outcome : ImportPreview or None
        Consequences of the latest rows for which they are known.

    Signals
    -------
    edited()
        The user changed a row.
    """

    edited = Signal()

    def __init__(self, contents: PieceContents, maps: Mapping[str, InstrumentMap], tokens: Tokens) -> None:
        super().__init__(0, len(_COLUMNS))
        self.setObjectName("import_tracks")
        self._maps, self._tokens = maps, tokens
        self.rows: tuple[ImportRow, ...] = ()
        self.outcome: ImportPreview | None = None
        self._filled = 0
        """Number of rows that have their widgets."""
        self._filling = QTimer(self, interval=0)
        self._filling.timeout.connect(lambda: self._fill_more(_ROWS_LATER))
        self.read(contents)
        self.texted(self, columns=_COLUMNS)
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(ROW_PX)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setShowGrid(False)
        header = self.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(_PREVIEW, QHeaderView.ResizeMode.Stretch)
        header.setMinimumSectionSize(40)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)

    def read(self, contents: PieceContents) -> None:
        """Show another file; channels with percussion or sound effects are marked by default."""
        self.contents = contents
        self.end_tick = max((max(channel.end_ticks) for channel in contents.channels), default=1)
        uses = [use_of(channel) for channel in contents.channels]
        self._rhythm, self._effects = (
            frozenset(place for place, use in enumerate(uses) if use == one) for one in ("rhythm", "effect")
        )

    def fill(self) -> None:
        """Build the table's rows from the import rows."""
        self.setRowCount(0)
        self.setRowCount(len(self.rows))
        self._filled = 0
        # Cleaning is offered only if a track looks like a recorded take.
        self.setColumnHidden(_CLEAN, not any(map(self._take_reason, self.rows)))
        self._instruments = [(instrument_name(table), table.id) for table in in_score_order(self._maps.values())]
        self._characters = [(character_name(id_), id_) for id_ in characters()]
        self._fill_more(_ROWS_AT_ONCE)

    def show_outcome(self, outcome: ImportPreview) -> None:
        """Display in each row the instrument that results from the import choices."""
        self.outcome = outcome
        for place in range(self._filled):
            self._show_instruments(place)

    def selected(self) -> list[int]:
        return sorted({index.row() for index in self.selectionModel().selectedRows()})

    def asks(self, row: ImportRow) -> bool:
        """Return whether the instrument of a row is unknown, so that the user must choose one."""
        return self.outcome is not None and row.assignment.map_id is None and not self._played_on(row.assignment)

    def is_percussion(self, row: ImportRow) -> bool:
        chosen = row.assignment.map_id
        return chosen == PERCUSSION or (chosen is None and self._rhythm.issuperset(row.assignment.channels))

    def name_of(self, row: ImportRow) -> str:
        names = Counter(stream_name(self.contents.channels[channel]) for channel in row.assignment.channels)
        return " + ".join(name if count == 1 else f"{name} ×{count}" for name, count in names.items())

    def _fill_more(self, count: int) -> None:
        """Make the widgets of the next ``count`` rows, and later those of the remaining rows."""
        end = min(self._filled + count, len(self.rows))
        for place in range(self._filled, end):
            self._fill_row(place, self.rows[place])
        if self._filled == 0 or end == len(self.rows):
            # Set again, so that the table measures columns whose widgets were added later.
            self.horizontalHeader().setSectionResizeMode(_PREVIEW, QHeaderView.ResizeMode.Stretch)
        self._filled = end
        if end < len(self.rows):
            self._filling.start()
        else:
            self._filling.stop()

    def _fill_row(self, place: int, row: ImportRow) -> None:
        use = named(Tick(), f"play_{place}")
        use.setChecked(row.requested)
        use.toggled.connect(lambda requested: self._request(place, requested))
        self.setCellWidget(place, _USE, centred(use))

        name = named(QLineEdit(row.assignment.name or self.name_of(row)), f"name_{place}")
        name.setMinimumWidth(130)
        name.textEdited.connect(lambda text: self._assignment(place, name=text.strip()))
        self.setCellWidget(place, _NAME, name)

        channels = [self.contents.channels[channel] for channel in row.assignment.channels]
        self.setCellWidget(place, _PREVIEW, NotesPreview(channels, self.end_tick, self._tokens))
        count = Label(
            self.tr("import_dialog.notes_to").format(
                count=sum(len(channel.pitches) for channel in channels),
                low=pitch_name(min(min(channel.pitches) for channel in channels)),
                high=pitch_name(max(max(channel.pitches) for channel in channels)),
            )
        )
        count.setContentsMargins(6, 0, 6, 0)
        self.setCellWidget(place, _NOTES, count)

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
        if not self._rhythm.issuperset(assignment.channels):
            instruments.append((self.tr("import_dialog.percussion_for_dancers"), PERCUSSION))
        instrument = option_box(f"instrument_{place}", instruments, assignment.map_id)
        instrument.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        instrument.setMinimumContentsLength(_INSTRUMENT_LETTERS)
        self.setCellWidget(place, _INSTRUMENT, InstrumentCell(instrument))
        instrument.currentIndexChanged.connect(lambda: self._choose(place, instrument.currentData()))
        instrument.currentTextChanged.connect(lambda text: instrument.setToolTip(self._tip(place) or text))

        kinds = ((self.tr("import_dialog.sounding"), False), (self.tr("import_dialog.written"), True))
        pitches = self._choice(place, _PITCHES, "pitches", kinds, assignment.written)
        pitches.setToolTip(self.tr("import_dialog.pitches_tip"))
        pitches.currentIndexChanged.connect(lambda: self._assignment(place, written=bool(pitches.currentData())))

        figures = ((usual, None), *self._characters)
        character = self._choice(place, _CHARACTER, "character", figures, row.character_id)
        character.currentIndexChanged.connect(lambda: self._set(place, character_id=character.currentData()))
        reason = self._take_reason(row)
        if reason:
            clean = named(Tick(), f"clean_{place}")
            clean.setChecked(assignment.clean)
            clean.setToolTip(self.tr(_TAKES[reason]))
            clean.toggled.connect(lambda clean: self._assignment(place, clean=clean))
            self.setCellWidget(place, _CLEAN, centred(clean))
        self._enable(place)
        self._show_instruments(place)

    def _take_reason(self, row: ImportRow) -> TakeReason:
        """Return the reason why all tracks of a row look like recorded takes; empty if one does not."""
        own = (self.contents.channels[channel] for channel in row.assignment.channels)
        reasons = [take_reason(channel, self.contents.tempo_map) for channel in own]
        return reasons[0] if all(reasons) else ""

    def _choice(
        self, place: int, column: int, name: str, options: Iterable[tuple[str, object]], chosen: object
    ) -> ComboBox:
        """Return a combo box as a table cell, with the chosen option selected, or the first if it is missing."""
        box = option_box(f"{name}_{place}", options, chosen)
        self.setCellWidget(place, column, box)
        return box

    def _played_on(self, assignment: PartAssignment) -> list[InstrumentMap]:
        """Return the instruments that would play a row; empty while unknown."""
        return [] if self.outcome is None else [self._maps[id_] for id_ in self.outcome.instruments_of(assignment)]

    def _can_choose(self, row: ImportRow) -> bool:
        """Return whether the user can choose an instrument for a row that is not played."""
        return row.assignment.map_id == PERCUSSION or self.asks(row)

    def _show_instruments(self, place: int) -> None:
        """Show the instruments that name, program and range suggest for a row, and whether its pitches may be written
        ones.
        """
        row = self.rows[place]
        cell, pitches = self.cellWidget(place, _INSTRUMENT), self.cellWidget(place, _PITCHES)
        assert isinstance(cell, InstrumentCell)
        assert pitches is not None
        instrument = cell.whole
        self._show_players(place, cell)
        names = dict.fromkeys(map(instrument_name, self._played_on(automatic(row.assignment))))
        if names:
            instrument.setItemText(0, self.tr("import_dialog.automatic_2").format(name=" + ".join(names)))
        elif self._rhythm.issuperset(row.assignment.channels):
            instrument.setItemText(0, self.tr("import_dialog.percussion_for_dancers"))
        elif self._effects.issuperset(row.assignment.channels):
            instrument.setItemText(0, self.tr("import_dialog.sound_effect"))
        elif self.outcome is not None and not row.assignment.map_id:
            instrument.setItemText(0, self.tr("import_dialog.choose_instrument"))
        tip = self._tip(place)
        instrument.setToolTip(tip or instrument.currentText())
        for column in (_USE, _PREVIEW, _NOTES):
            widget = self.cellWidget(place, column)
            if widget is not None:
                widget.setToolTip(tip)
        instrument.setEnabled(row.requested or self._can_choose(row))
        # Concert and written pitch differ only for transposing instruments.
        transposes = any(table.transposition_semitones for table in self._played_on(row.assignment))
        pitches.setEnabled(row.requested and transposes)

    def _show_players(self, place: int, cell: InstrumentCell) -> None:
        """Show a choice of instrument for each player of a row."""
        row = self.rows[place]
        assignment = row.assignment
        players = len(self._played_on(assignment)) if row.requested else 0
        alone = [instrument_name(table) for table in self._played_on(automatic(assignment))]
        chosen = None if assignment.map_id is None else self._maps.get(assignment.map_id)
        whole = None if chosen is None else instrument_name(chosen)
        if players < 2:
            players = 0
        if players != len(cell.boxes):
            own = [*assignment.voice_maps, *[None] * players]
            boxes = []
            for voice in range(players):
                options = [(self.tr("import_dialog.automatic"), None), *self._instruments]
                box = option_box(f"instrument_{place}_{voice}", options, own[voice])
                box.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
                box.setToolTip(self.tr("import_dialog.player_tip"))
                box.currentIndexChanged.connect(partial(self._choose_for_player, place, voice, box))
                boxes.append((self.tr("import_dialog.player").format(number=voice + 1), box))
            cell.show_players(boxes)
            self.setRowHeight(place, max(ROW_PX, cell.sizeHint().height()))
        for voice, box in enumerate(cell.boxes):
            # A player without a choice of its own has the instrument of the part.
            name = whole or (alone[voice] if voice < len(alone) else "")
            if name:
                box.setItemText(0, self.tr("import_dialog.automatic_2").format(name=name))

    def _choose_for_player(self, place: int, voice: int, box: ComboBox, index: int) -> None:
        chosen = [*self.rows[place].assignment.voice_maps]
        chosen += [None] * (voice + 1 - len(chosen))
        chosen[voice] = box.itemData(index)
        while chosen and chosen[-1] is None:
            chosen.pop()
        self._assignment(place, voice_maps=tuple(chosen))

    def _tip(self, place: int) -> str:
        """Return the tool tip of a row; empty for most rows."""
        row = self.rows[place]
        if self.is_percussion(row):
            return self.tr("import_dialog.percussion_track_no_player_plays")
        if row.assignment.map_id is None and self._effects.issuperset(row.assignment.channels):
            return self.tr("import_dialog.sound_effects_explanation")
        return ""

    def _choose(self, place: int, map_id: str | None) -> None:
        """Set the instrument of a row, so that the row is played; None for percussion, which is not played."""
        row = self.rows[place]
        asked, was_percussion = self.asks(row), row.assignment.map_id == PERCUSSION
        self._assignment(place, map_id=map_id)
        tick = self.cellWidget(place, _USE)
        box = tick.findChild(QCheckBox) if tick is not None else None
        if box is None:
            return
        if map_id == PERCUSSION:
            box.setChecked(False)
        elif (asked and map_id is not None) or (was_percussion and self._played_on(self.rows[place].assignment)):
            box.setChecked(True)

    def _request(self, place: int, requested: bool) -> None:
        """Set whether a row is played; a row marked as percussion is then no longer so marked."""
        self._set(place, requested=requested)
        cell = self.cellWidget(place, _INSTRUMENT)
        if requested and self.rows[place].assignment.map_id == PERCUSSION and isinstance(cell, InstrumentCell):
            cell.whole.setCurrentIndex(0)

    def _assignment(self, place: int, **changes: object) -> None:
        self._set(place, assignment=msgspec.structs.replace(self.rows[place].assignment, **changes))

    def _set(self, place: int, **changes: object) -> None:
        changed = msgspec.structs.replace(self.rows[place], **changes)
        self.rows = (*self.rows[:place], changed, *self.rows[place + 1 :])
        self._enable(place)
        self.edited.emit()

    def _enable(self, place: int) -> None:
        row = self.rows[place]
        for column in (_NAME, _PREVIEW, _NOTES, _SPLIT, _INSTRUMENT, _CHARACTER, _CLEAN):
            widget = self.cellWidget(place, column)
            if widget is not None:
                # If nothing names the instrument, the user must choose it.
                widget.setEnabled(row.requested or (column == _INSTRUMENT and self._can_choose(row)))
