"""State and texts of the rows in the dialog that learns a choreography."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import msgspec
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QTreeWidgetItem

from app.choreography.learn import Pair, require_usable
from app.choreography.music_offset import offset_doubt
from app.editor.design_tokens import Tokens
from app.editor.translated import tr
from app.encoding import shown
from app.errors import Message, UsageError
from widgets.common.controls import ColumnList
from widgets.common.text import message_text
from widgets.dialogs.character_draft import DraftHistory
from widgets.dialogs.choreography.cut_panel import CutHistory
from widgets.dialogs.choreography.learn_draft import (
    PairContents,
    PairDraft,
    is_offset_outside,
    offset_range_s,
    offset_s_of,
)
from widgets.dialogs.choreography.learn_pair import file_name

_RIGHT: Final = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
COLUMNS: Final = {
    "motion": "learn_dialog.motion",
    "music": "learn_dialog.music",
    "length": "learn_dialog.seconds",
    "segments": "learn_dialog.segments",
    "states": "learn_dialog.states",
    "offset": "learn_dialog.offset_s",
    "confidence": "learn_dialog.confidence",
}
"""Columns of the list with the text ids of their headings."""


@dataclass(eq=False)
class PairRow:
    """State of a pair in the list.

    Attributes
    ----------
    history : CutHistory
        Undo history of the cuts.
    bones : DraftHistory
        Undo history of bone corrections.
    cut_clip : tuple of float and int, or None
        Start and length of the clip to which the cuts belong, see `take_contents`.
    reading : int
        Number that identifies the current reading of files; 0 for none.
    states : int or None
        Number of basic motions learned from the pair in its present state.
    judged : tuple or None
        State of the pair for which `why_unusable` was found last, and its answer.
    """

    draft: PairDraft
    found: PairContents = field(default_factory=PairContents)
    history: CutHistory = field(default_factory=CutHistory)
    bones: DraftHistory = field(default_factory=DraftHistory.empty)
    cut_clip: tuple[float, int] | None = None
    reading: int = 0
    states: int | None = None
    judged: tuple[tuple[object, ...], Message | None] | None = None


@dataclass(frozen=True, eq=False)
class PairRead:
    """Result of reading a pair's files, with the number of the reading."""

    number: int
    found: PairContents


def take_contents(row: PairRow, found: PairContents) -> None:
    """Store the contents read for a pair; the user's cuts stay if the clip has the same frames as before."""
    row.reading, row.found = 0, found
    if found.read is not None and found.analysis is not None:
        clip = (found.read.motion.start_s, len(found.analysis.clip))
        if row.cut_clip not in (None, clip):
            row.draft, row.history = msgspec.structs.replace(row.draft, cuts=None), CutHistory()
        row.cut_clip = clip


def training_pair(row: PairRow) -> Pair | None:
    """Return the data of a pair for learning; None before its files are read."""
    read = row.found.read
    if read is None:
        return None
    offset_s = row.draft.offset_s
    # The typed time refers to the file, of which the clip may be a later part.
    of_clip_s = None if offset_s is None else offset_s - read.motion.start_s
    return replace(read.pair, offset_s=of_clip_s, cuts=row.draft.cuts)


def why_unusable(row: PairRow) -> Message | None:
    """Return the reason why nothing can be learned from a pair: its files, or a motion without cuts or music; None for
    a usable pair and before its files are read.
    """
    read, analysis = row.found.read, row.found.analysis
    if read is None or analysis is None:
        return row.found.error
    key = (row.found, row.draft.offset_s, row.draft.cuts)
    if row.judged is None or row.judged[0] != key:
        cuts = analysis.segmentation.cuts if row.draft.cuts is None else row.draft.cuts
        offset_s = offset_s_of(row.draft, row.found) - read.motion.start_s
        row.judged = key, _unusable(replace(read.pair, offset_s=offset_s, cuts=tuple(cuts)))
    return row.judged[1]


def _unusable(pair: Pair) -> Message | None:
    try:
        require_usable(pair)
    except UsageError as error:
        return error.message
    return None


def doubt_of(row: PairRow) -> Message | None:
    """Return a message that the automatic offset of a pair may be wrong; None if it is reliable or typed, and before it
    is computed.
    """
    if row.found.analysis is None or row.draft.offset_s is not None:
        return None
    return offset_doubt(offset_s_of(row.draft, row.found), row.found.analysis.offset.confidence)


def row_texts(row: PairRow) -> tuple[str, ...]:
    """Return the texts of a row for the columns `COLUMNS`."""
    read, analysis, draft = row.found.read, row.found.analysis, row.draft
    names = file_name(draft.motion), file_name(draft.music)
    if read is None or analysis is None:
        return *names, *("…" if row.reading else "–" for _ in range(2, len(COLUMNS)))
    return (
        *names,
        f"{analysis.clip.length_s:.1f}",
        str(len(analysis.segmentation.cuts if draft.cuts is None else draft.cuts)),
        "–" if row.states is None else str(row.states),
        f"{offset_s_of(draft, row.found):.2f}",
        "–" if draft.offset_s is not None else _confidence_text(analysis.offset.confidence, doubt_of(row)),
    )


def _confidence_text(confidence: float, doubt: Message | None) -> str:
    return f"{confidence:.2f}" if doubt is None else tr("learn_dialog.unsure").format(confidence=f"{confidence:.2f}")


def missing_text(rows: Sequence[PairRow]) -> str:
    """Return the text of what must be done before learning; empty if nothing."""
    if not rows:
        return tr("learn_dialog.no_pairs_hint")
    for at, row in enumerate(rows):
        if row.draft.motion is None:
            return tr("learn_dialog.motion_missing").format(n=at + 1)
        if row.draft.music is None:
            return tr("learn_dialog.music_missing").format(n=at + 1)
        bounds = offset_range_s(row.found)
        if bounds is not None and is_offset_outside(row.draft, row.found):
            least, most = (f"{bound_s:.3f}" for bound_s in bounds)
            return tr("learn_dialog.pair_offset_outside").format(n=at + 1, least=least, most=most)
        error = why_unusable(row)
        if error is not None and all(why_unusable(other) is not None for other in rows):
            return tr("learn_dialog.pair").format(n=at + 1, error=message_text(error))
    if any(row.reading for row in rows):
        return tr("learn_dialog.reading_files")
    return ""


def doubts_text(rows: Sequence[PairRow]) -> str:
    """Return a text that names the pairs that are used although their offset may be wrong; empty if there is none."""
    doubtful = [at + 1 for at, row in enumerate(rows) if doubt_of(row) is not None and why_unusable(row) is None]
    pairs = ", ".join(map(str, doubtful))
    return tr("learn_dialog.unsure_pairs").format(pairs=pairs) if doubtful else ""


def left_out_text(rows: Sequence[PairRow]) -> str:
    """Return the text of the pairs that are not used, with reasons, one per line."""
    texts = [
        tr("learn_dialog.pair_left_out").format(n=at + 1, error=message_text(error))
        for at, row in enumerate(rows)
        if (error := why_unusable(row)) is not None
    ]
    return "\n".join(texts)


class PairList(ColumnList):
    """List of pairs with their files and contents."""

    def __init__(self) -> None:
        super().__init__("learn_pairs", *COLUMNS.values(), stretches=(0, 1))
        for column in range(2, len(COLUMNS)):
            self.headerItem().setTextAlignment(column, _RIGHT)

    def show_rows(self, rows: Sequence[PairRow], tokens: Tokens) -> None:
        """Show pairs of motion and music, each as a row; ``tokens`` has the theme's colours."""
        self.blockSignals(True)
        while self.topLevelItemCount() > len(rows):
            self.takeTopLevelItem(self.topLevelItemCount() - 1)
        while self.topLevelItemCount() < len(rows):
            self.addTopLevelItem(QTreeWidgetItem())
        for at, row in enumerate(rows):
            item = self.topLevelItem(at)
            assert item is not None, "one for each pair"
            for column, text in enumerate(row_texts(row)):
                item.setText(column, text)
                if column > 1:
                    item.setTextAlignment(column, _RIGHT)
            wrong = why_unusable(row) is not None
            doubt = doubt_of(row)
            for column, name in enumerate(COLUMNS):
                colour = tokens.error if wrong else tokens.text
                path = getattr(row.draft, name, None)
                tip = shown(str(path)) if isinstance(path, Path) else ""
                if name in ("offset", "confidence") and doubt is not None:
                    colour, tip = tokens.warning, message_text(doubt)
                item.setForeground(column, QColor(colour))
                item.setToolTip(column, tip)
        self.blockSignals(False)
