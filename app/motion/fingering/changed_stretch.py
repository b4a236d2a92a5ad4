"""Updates curves after an edit: recomputed around it, reused elsewhere.

In a long silence all controls are at rest and all fingers at home, so the notes between two such silences can be
computed separately.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.motion.curves.curve import Curve
from app.plan.model import FingeringEvent
from app.score.metre_map import FeltBeats, beat_ticks_at

APART_S = 3.0
"""Gap in seconds between notes, at a beat, beyond which their finger motions are independent; returning and approaching
take less.
"""


@dataclass(frozen=True)
class ChangedStretch:
    """Notes ``first`` .. ``last - 1`` of a part around an edit, with the silences next to them.

    Attributes
    ----------
    start_s, end_s : float
        Middle of the silences; infinite at the ends of the part.
    """

    first: int
    last: int
    start_s: float
    end_s: float

    def notes(self, fingerings: Sequence[FingeringEvent]) -> Sequence[FingeringEvent]:
        """The fingerings of the stretch, plus one note on either side."""
        return fingerings[max(self.first - 1, 0) : self.last + 1]


def changed_stretch(
    before: Sequence[FingeringEvent], after: Sequence[FingeringEvent], felt_beats: FeltBeats
) -> ChangedStretch | None:
    """The shortest stretch with all differences between two versions of a part; None if it is the whole part."""
    most = min(len(before), len(after))
    head = _alike(before[:most], after[:most])
    tail = _alike(before[head:][::-1], after[head:][::-1])
    # The notes on both sides of a silence must be unchanged.
    first = next((index for index in range(head - 1, 0, -1) if _apart(after, index, felt_beats)), 0)
    count = len(after)
    last = next((index for index in range(count - tail + 1, count) if _apart(after, index, felt_beats)), count)
    if first == 0 and last == count:
        return None
    return ChangedStretch(
        first,
        last,
        0.5 * (after[first - 1].end_s + after[first].start_s) if first else -np.inf,
        0.5 * (after[last - 1].end_s + after[last].start_s) if last < count else np.inf,
    )


def _alike(before: Sequence[FingeringEvent], after: Sequence[FingeringEvent]) -> int:
    """Number of notes at the start of two versions of a part that are equal in both."""
    pairs = enumerate(zip(before, after, strict=False))
    differ = (index for index, (one, other) in pairs if one is not other and one != other)
    return next(differ, min(len(before), len(after)))


def _apart(fingerings: Sequence[FingeringEvent], index: int, felt_beats: FeltBeats) -> bool:
    before, after = fingerings[index - 1], fingerings[index]
    beat_ticks = int(beat_ticks_at(felt_beats, np.array(after.start_tick)))
    return after.start_s - before.end_s >= APART_S and after.start_tick - before.end_tick >= beat_ticks


def spliced(
    before: Mapping[str, Curve], within: Mapping[str, Curve], stretch: ChangedStretch
) -> dict[str, Curve] | None:
    """Insert the curves of a recomputed stretch (`ChangedStretch.notes`) into those of the previous version; None if
    they do not fit together.
    """
    if before.keys() != within.keys():
        return None
    result = {}
    for name, curve in within.items():
        joined = _spliced(before[name], curve, stretch)
        if joined is None:
            return None
        result[name] = joined
    return result


def _spliced(before: Curve, within: Curve, stretch: ChangedStretch) -> Curve | None:
    ahead, behind = before.end_s <= stretch.start_s, before.start_s >= stretch.end_s
    own = (within.start_s >= stretch.start_s) & (within.end_s <= stretch.end_s)
    if _crossed(before, stretch) or _crossed(within, stretch) or before.initial != within.initial:
        return None
    pieces = ((before, ahead), (within, own), (before, behind))
    start_s, end_s, low, high = (
        np.concatenate([getattr(curve, name)[rows] for curve, rows in pieces])
        for name in ("start_s", "end_s", "before", "after")
    )
    if (low != np.concatenate(([before.initial], high[:-1]))[: len(low)]).any():
        return None
    return Curve(start_s, end_s, low, high, before.initial)


def _crossed(curve: Curve, stretch: ChangedStretch) -> bool:
    """Return whether a curve is moving at either boundary of a stretch, so that it cannot be cut there."""
    return any(bool(((curve.start_s < at_s) & (at_s < curve.end_s)).any()) for at_s in (stretch.start_s, stretch.end_s))
