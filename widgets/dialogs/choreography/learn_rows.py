"""The pairs of the dialog that learns a choreography: what is known of each, and the texts of its row."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Final

from app.choreography.learn import Pair
from widgets.dialogs.choreography.cut_panel import CutHistory
from widgets.dialogs.choreography.learn_draft import PairContents, PairDraft
from widgets.dialogs.choreography.learn_pair import file_name

COLUMNS: Final = {
    "motion": "learn_dialog.motion",
    "music": "learn_dialog.music",
    "length": "learn_dialog.seconds",
    "segments": "learn_dialog.segments",
    "states": "learn_dialog.states",
    "offset": "learn_dialog.offset_s",
    "confidence": "learn_dialog.confidence",
}
"""The list's columns, and the ids of their headings."""


@dataclass(eq=False)
class PairRow:
    """A pair of the list.

    Attributes
    ----------
    history : CutHistory
        Of the cuts of the draft.
    reading : int
        Number of the reading whose result is awaited; 0: none.
    states : int or None
        Basic motions of it in what was learned last, from what the list says now.
    """

    draft: PairDraft
    found: PairContents = field(default_factory=PairContents)
    history: CutHistory = field(default_factory=CutHistory)
    reading: int = 0
    states: int | None = None


@dataclass(frozen=True, eq=False)
class PairRead:
    """What came of reading a pair's files."""

    number: int
    found: PairContents


def training_pair(row: PairRow) -> Pair | None:
    """What is learned from, as it is filled in; None before the files are read."""
    read = row.found.read
    if read is None:
        return None
    offset_s = row.draft.offset_s
    # Typed is a time of the file, of which the clip may be a later part.
    of_clip_s = None if offset_s is None else offset_s - read.motion.start_s
    return replace(read.pair, offset_s=of_clip_s, cuts=row.draft.cuts)


def offset_confidence(row: PairRow) -> float:
    return 1.0 if row.found.analysis is None else row.found.analysis.offset.confidence


def row_texts(row: PairRow) -> tuple[str, ...]:
    """The texts of a row, by `COLUMNS`."""
    read, analysis, draft = row.found.read, row.found.analysis, row.draft
    names = file_name(draft.motion), file_name(draft.music)
    if read is None or analysis is None:
        return *names, *("…" if row.reading else "–" for _ in range(2, len(COLUMNS)))
    found_s = analysis.offset.offset_s + read.motion.start_s
    return (
        *names,
        f"{analysis.clip.length_s:.1f}",
        str(len(analysis.segmentation.cuts if draft.cuts is None else draft.cuts)),
        "–" if row.states is None else str(row.states),
        f"{found_s if draft.offset_s is None else draft.offset_s:.2f}",
        f"{analysis.offset.confidence:.2f}" if draft.offset_s is None else "–",
    )
