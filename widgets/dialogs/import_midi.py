"""The import of a MIDI file: which of its tracks are played, by how many, on what and as whom."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec
from PySide6.QtCore import QEvent, QPoint, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPaintEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QHeaderView,
    QLineEdit,
    QListWidget,
    QPushButton,
    QTableWidget,
    QVBoxLayout,
    QWidget,
)

from app.project.importing import ImportRow, import_project, merged, score_of_rows, separated, usual_rows
from app.project.model import Project
from app.rig.character_library import characters
from app.score.model import Note
from app.score.parts import stream_name
from app.score.read import MidiContents
from instrument_maps.model import InstrumentMap
from widgets.common.instrument_name import character_name, instrument_name
from widgets.common.pitch import pitch_name
from widgets.common.plain import ComboBox, Label
from widgets.common.text import message_text
from widgets.common.tokens import LEAST_TARGET_PX, Tokens

_USE, _NAME, _PREVIEW, _NOTES, _SPLIT, _INSTRUMENT, _PITCHES, _CHARACTER = range(8)
_ROW_PX = 40
_SIZE = QSize(1280, 580)
_TITLE_PX = 600
_INSTRUMENT_LETTERS = 31
"""Width of the column of instruments: the longest names would leave the notes no room."""


class ImportDialog(QDialog):
    """Asks how a MIDI file becomes players; sensible without touching it.

    Parameters
    ----------
    contents : MidiContents
    maps : mapping of str to InstrumentMap
        Every installed instrument by id.
    source : str
        Absolute path of the file.
    tokens : Tokens
    parent : QWidget, optional
    """

    def __init__(
        self,
        contents: MidiContents,
        maps: Mapping[str, InstrumentMap],
        source: str,
        tokens: Tokens,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("import_midi")
        self._contents, self._maps, self._source, self._tokens = contents, maps, source, tokens
        self._rows = usual_rows(contents, maps)
        self._notes = [sorted(stream.notes(), key=lambda note: note.onset_tick) for stream in contents.streams]
        self._end_tick = max((max(stream.end_ticks) for stream in contents.streams), default=1)

        self._heading = Label()
        self._heading.setObjectName("heading")
        self._table = QTableWidget(0, 8)
        self._table.setObjectName("import_tracks")
        self._table.verticalHeader().hide()
        self._table.verticalHeader().setDefaultSectionSize(_ROW_PX)
        self._table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self._table.setShowGrid(False)
        header = self._table.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(_PREVIEW, QHeaderView.ResizeMode.Stretch)
        header.setMinimumSectionSize(40)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self._merge = QPushButton()
        self._merge.setObjectName("merge")
        self._merge.setAutoDefault(False)
        self._merge.clicked.connect(self.merge_selected)
        self._separate = QPushButton()
        self._separate.setObjectName("separate")
        self._separate.setAutoDefault(False)
        self._separate.clicked.connect(self.separate_selected)
        self._summary = Label()
        self._summary.setObjectName("import_summary")
        self._warning_title = Label()
        self._warnings = QListWidget()
        self._warnings.setObjectName("import_warnings")
        self._warnings.setWordWrap(True)
        self._warnings.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self._warnings.setMaximumHeight(110)
        self._buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel, Qt.Orientation.Horizontal
        )
        for button in self._buttons.buttons():
            button.setIcon(QIcon())
        self._buttons.accepted.connect(self.accept)
        self._buttons.rejected.connect(self.reject)

        tools = QHBoxLayout()
        tools.addWidget(self._merge)
        tools.addWidget(self._separate)
        tools.addStretch()
        tools.addWidget(self._summary)
        layout = QVBoxLayout(self)
        layout.addWidget(self._heading)
        layout.addWidget(self._table, 1)
        layout.addLayout(tools)
        layout.addWidget(self._warning_title)
        layout.addWidget(self._warnings)
        layout.addWidget(self._buttons)
        self._table.itemSelectionChanged.connect(self._show_tools)
        self.retranslate()
        self.resize(_SIZE.boundedTo(self.screen().availableSize()))

    @property
    def rows(self) -> tuple[ImportRow, ...]:
        """What is wanted so far."""
        return self._rows

    def project(self) -> Project:
        """The project as it is wanted."""
        return import_project(self._contents, self._rows, self._maps, self._source)

    def merge_selected(self) -> None:
        """Make one part of the selected tracks."""
        places = self._selected()
        if len(places) > 1:
            self._rows = merged(self._rows, places)
            self._fill()
            self._table.selectRow(min(places))

    def separate_selected(self) -> None:
        """Take the selected part apart into its tracks."""
        for place in reversed(self._selected()):
            if len(self._rows[place].wish.streams) > 1:
                self._rows = separated(self._rows, place)
        self._fill()

    def retranslate(self) -> None:
        """Set every text anew."""
        self.setWindowTitle(self.tr("Import MIDI"))
        contents = self._contents
        length_s, metrics = contents.tempo_map.seconds(float(self._end_tick)), self._heading.fontMetrics()
        self._heading.setText(
            self.tr("{title} · {minutes}:{seconds:02d} · ♩= {tempo:g} · {metre}").format(
                title=metrics.elidedText(contents.title, Qt.TextElideMode.ElideRight, _TITLE_PX),
                minutes=int(length_s) // 60,
                seconds=int(length_s) % 60,
                tempo=round(contents.tempo_map.bpm[0][1], 1),
                metre=f"{contents.metres[0].numerator}/{contents.metres[0].denominator}",
            )
        )
        self._table.setHorizontalHeaderLabels(
            [
                self.tr("Play"),
                self.tr("Name"),
                self.tr("Notes"),
                self.tr("Number, range"),
                self.tr("Notes together"),
                self.tr("Instrument"),
                self.tr("Pitches"),
                self.tr("Character"),
            ]
        )
        self._merge.setText(self.tr("Merge into one part"))
        self._merge.setToolTip(self.tr("Make one part of the selected tracks"))
        self._separate.setText(self.tr("Take apart"))
        self._separate.setToolTip(self.tr("Make a part of each merged track again"))
        self._buttons.button(QDialogButtonBox.StandardButton.Ok).setText(self.tr("Import"))
        self._buttons.button(QDialogButtonBox.StandardButton.Cancel).setText(self.tr("Cancel"))
        self._fill()

    def _selected(self) -> list[int]:
        return sorted({index.row() for index in self._table.selectionModel().selectedRows()})

    def _fill(self) -> None:
        self._table.setRowCount(0)
        self._table.setRowCount(len(self._rows))
        for place, row in enumerate(self._rows):
            self._fill_row(place, row)
        self._show_tools()
        self._show_outcome()

    def _fill_row(self, place: int, row: ImportRow) -> None:
        use = _Tick()
        use.setObjectName(f"play_{place}")
        use.setChecked(row.wanted)
        use.toggled.connect(lambda wanted: self._set(place, wanted=wanted))
        self._table.setCellWidget(place, _USE, _centred(use))

        name = QLineEdit(row.wish.name or self._name(row))
        name.setObjectName(f"name_{place}")
        name.setMinimumWidth(130)
        name.textEdited.connect(lambda text: self._wish(place, name=text.strip()))
        self._table.setCellWidget(place, _NAME, name)

        notes = [note for stream in row.wish.streams for note in self._notes[stream]]
        self._table.setCellWidget(place, _PREVIEW, NotesPreview(notes, self._end_tick, self._tokens))
        low, high = min(note.pitch for note in notes), max(note.pitch for note in notes)
        count = Label(
            self.tr("Notes: {count}\n{low} to {high}").format(
                count=len(notes), low=pitch_name(low), high=pitch_name(high)
            )
        )
        count.setContentsMargins(6, 0, 6, 0)
        self._table.setCellWidget(place, _NOTES, count)

        split = ComboBox()
        split.setObjectName(f"split_{place}")
        split.addItem(self.tr("Share among players"), True)
        split.addItem(self.tr("One player"), False)
        split.setCurrentIndex(0 if row.wish.split else 1)
        split.currentIndexChanged.connect(lambda _, box=split: self._wish(place, split=bool(box.currentData())))
        self._table.setCellWidget(place, _SPLIT, split)

        instrument = ComboBox()
        instrument.setObjectName(f"instrument_{place}")
        instrument.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        instrument.setMinimumContentsLength(_INSTRUMENT_LETTERS)
        instrument.addItem(self.tr("Automatic: {name}").format(name=self._automatic(row)), None)
        for id_, table in self._maps.items():
            instrument.addItem(instrument_name(table), id_)
        instrument.setCurrentIndex(max(instrument.findData(row.wish.map_id), 0))
        instrument.currentIndexChanged.connect(lambda _, box=instrument: self._wish(place, map_id=box.currentData()))
        instrument.setToolTip(instrument.currentText())
        instrument.currentTextChanged.connect(instrument.setToolTip)
        self._table.setCellWidget(place, _INSTRUMENT, instrument)

        pitches = ComboBox()
        pitches.setObjectName(f"pitches_{place}")
        pitches.addItem(self.tr("Sounding"), False)
        pitches.addItem(self.tr("Written"), True)
        pitches.setCurrentIndex(1 if row.wish.written else 0)
        pitches.currentIndexChanged.connect(lambda _, box=pitches: self._wish(place, written=bool(box.currentData())))
        pitches.setToolTip(
            self.tr("Which pitches the file has of an instrument whose part is not written as it sounds")
        )
        self._table.setCellWidget(place, _PITCHES, pitches)

        character = ComboBox()
        character.setObjectName(f"character_{place}")
        character.addItem(self.tr("Automatic"), None)
        for id_ in characters():
            character.addItem(character_name(id_), id_)
        character.setCurrentIndex(max(character.findData(row.character_id), 0))
        character.currentIndexChanged.connect(lambda _, box=character: self._set(place, character_id=box.currentData()))
        self._table.setCellWidget(place, _CHARACTER, character)
        self._enable(place)

    def _automatic(self, row: ImportRow) -> str:
        """The instruments that the file's names, programs and ranges choose."""
        wish = msgspec.structs.replace(row.wish, map_id=None)
        used = self._instruments(msgspec.structs.replace(row, wish=wish))
        return " + ".join(dict.fromkeys(map(instrument_name, used)))

    def _instruments(self, row: ImportRow) -> list[InstrumentMap]:
        """What a row is played on, were it wanted."""
        wanted = msgspec.structs.replace(row, wanted=True)
        return [self._maps[part.map_id] for part in score_of_rows(self._contents, [wanted], self._maps).parts]

    def _name(self, row: ImportRow) -> str:
        return " + ".join(stream_name(self._contents.streams[stream]) for stream in row.wish.streams)

    def _wish(self, place: int, **changes: object) -> None:
        self._set(place, wish=msgspec.structs.replace(self._rows[place].wish, **changes))

    def _set(self, place: int, **changes: object) -> None:
        changed = msgspec.structs.replace(self._rows[place], **changes)
        self._rows = (*self._rows[:place], changed, *self._rows[place + 1 :])
        self._enable(place)
        self._show_outcome()

    def _enable(self, place: int) -> None:
        for column in (_NAME, _PREVIEW, _NOTES, _SPLIT, _INSTRUMENT, _CHARACTER):
            widget = self._table.cellWidget(place, column)
            if widget is not None:
                widget.setEnabled(self._rows[place].wanted)
        pitches = self._table.cellWidget(place, _PITCHES)
        if pitches is not None:
            # Only there is a difference.
            used = self._instruments(self._rows[place])
            transposes = any(instrument.transposition_semitones for instrument in used)
            pitches.setEnabled(self._rows[place].wanted and transposes)

    def _show_tools(self) -> None:
        places = self._selected()
        self._merge.setEnabled(len(places) > 1)
        self._separate.setEnabled(any(len(self._rows[place].wish.streams) > 1 for place in places))

    def _show_outcome(self) -> None:
        """Say what will come of it: the reader's warnings where nothing was changed, the players in any case."""
        score = score_of_rows(self._contents, self._rows, self._maps)
        self._summary.setText(
            self.tr("Players: {count}").format(count=len(score.parts))
            if score.parts
            else self.tr("Nobody plays: tick a track, or import an empty stage")
        )
        self._warnings.clear()
        for message in score.warnings:
            self._warnings.addItem(message_text(message))
        for part in score.unplayed:
            self._warnings.addItem(
                self.tr("{name} is not played: {reason}").format(name=part.name, reason=message_text(part.reason))
            )
        self._warning_title.setText(self.tr("What the reader noticed"))
        self._warning_title.setVisible(self._warnings.count() > 0)
        self._warnings.setVisible(self._warnings.count() > 0)

    def sizeHint(self) -> QSize:
        return _SIZE

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


class NotesPreview(QWidget):
    """A track's notes over the whole piece, as a small piano roll."""

    def __init__(self, notes: list[Note], end_tick: int, tokens: Tokens) -> None:
        super().__init__()
        self._notes, self._end_tick, self._tokens = notes, max(end_tick, 1), tokens
        self.setMinimumHeight(_ROW_PX - 8)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        area = QRectF(self.rect()).adjusted(2, 5, -2, -5)
        painter.fillRect(self.rect().adjusted(0, 2, 0, -2), QColor(self._tokens.sunken))
        low = min(note.pitch for note in self._notes)
        span = max(max(note.pitch for note in self._notes) - low, 11) + 1
        height = area.height() / span
        colour = QColor(self._tokens.accent if self.isEnabled() else self._tokens.text_dim)
        for note in self._notes:
            left = area.left() + area.width() * note.onset_tick / self._end_tick
            width = max(area.width() * note.duration_tick / self._end_tick, 1.0)
            top = area.bottom() - (note.pitch - low + 1) * height
            painter.fillRect(QRectF(left, top, width, max(height, 1.5)), colour)


class _Tick(QCheckBox):
    """A box without a word: all of it can be clicked, not the small square alone."""

    def __init__(self) -> None:
        super().__init__()
        self.setMinimumSize(LEAST_TARGET_PX, LEAST_TARGET_PX)

    def hitButton(self, pos: QPoint) -> bool:
        return self.rect().contains(pos)


def _centred(widget: QWidget) -> QWidget:
    holder = QWidget()
    layout = QHBoxLayout(holder)
    layout.setContentsMargins(8, 0, 8, 0)
    layout.addWidget(widget, 0, Qt.AlignmentFlag.AlignCenter)
    return holder
