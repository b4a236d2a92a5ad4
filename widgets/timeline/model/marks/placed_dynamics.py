"""Positions of dynamics and hairpins in their lane: letters at their ticks, wedges that leave space for letters."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

import numpy as np

from app.arrays import FloatArray
from app.plan.music.written_dynamics import holding_row
from app.score.marks import MARK_KINDS, SFORZANDI
from app.score.tempo import TempoMap
from widgets.timeline.model.geometry import TimeSpans
from widgets.timeline.model.lane_mouse import PixelRect
from widgets.timeline.model.marks.mark_drag import Zone
from widgets.timeline.model.marks.mark_table import MarkList
from widgets.timeline.model.visible_time import Scale

GAP_PX: Final = 4.0
LEAST_HAIRPIN_PX = 5.0
LEAST_MARK_PX = 4.0
"""Least space in pixels for each mark; with less, none is drawn."""
EDGE_PX = 6.0
BEHIND_PX = 80.0
"""Distance in pixels before the plot from which letters may still reach into it."""


class TimedMarks:
    """The marks anchored to ticks, ordered by time.

    Attributes
    ----------
    numbers : list of int
        Their indices in `MarkList.marks`.
    spans : TimeSpans
        Their time spans.
    last_tick : int or None
        End tick of a part read from sound, in which a dynamic visibly replaces the heard loudness until the next mark
        or the end. None for a part of a score.
    """

    def __init__(self, of_player: MarkList, tempo: TempoMap, last_tick: int | None = None) -> None:
        self.of_player, self.tempo, self.last_tick = of_player, tempo, last_tick
        marks = of_player.marks
        self.numbers = sorted(
            of_player.at_ticks.tolist(),
            key=lambda number: (marks[number].tick, MARK_KINDS[marks[number].kind].anchor == "span"),
        )
        ticks: FloatArray = np.array([float(marks[number].tick) for number in self.numbers])
        ends = np.array(
            [float(marks[number].end_tick or held) for number, held in zip(self.numbers, self._held(), strict=True)]
        )
        self.spans = TimeSpans(tempo.seconds(ticks), tempo.seconds(np.maximum(ticks, ends)))

    def _held(self) -> list[int]:
        """Return for each mark the tick until which it is in effect if it is a dynamic without an end; 0 for other
        marks.
        """
        marks = [self.of_player.marks[number] for number in self.numbers]
        if self.last_tick is None:
            return [0] * len(marks)
        starts = [*(mark.tick for mark in marks if mark.text not in SFORZANDI), self.last_tick]
        return [
            starts[min(bisect_right(starts, mark.tick, hi=len(starts) - 1), len(starts) - 1)]
            if holding_row(mark) is not None
            else 0
            for mark in marks
        ]


class PlacedDynamic(NamedTuple):
    """A dynamic or hairpin in pixels.

    Attributes
    ----------
    mark : int
        Index in `MarkList.marks`.
    box : PixelRect
        Rectangle of the wedge or the letters.
    end_px : float or None
        x position of a dynamic's explicit end; else None.
    is_hairpin : bool
        Whether it is a hairpin rather than a dynamic.
    holds_px : float or None
        For a dynamic without an end in a part read from sound: position of the next mark or the end of the part.
    """

    mark: int
    box: PixelRect
    end_px: float | None
    is_hairpin: bool
    holds_px: float | None = None

    def zone_at(self, x_px: float, y_px: float) -> Zone | None:
        """Return the part of the mark under the mouse, if any."""
        reach = self.box if self.end_px is None else self.box._replace(right=max(self.end_px, self.box.right))
        if not reach.contains(x_px, y_px, slack_px=EDGE_PX if self.is_hairpin else 2.0):
            return None
        if self.end_px is not None and abs(x_px - self.end_px) <= EDGE_PX:
            return "last"
        if self.is_hairpin:
            edge = min(EDGE_PX, reach.width / 3)
            if x_px >= reach.right - edge:
                return "last"
            if x_px <= reach.left + edge:
                return "first"
        return "whole" if self.is_hairpin or x_px <= self.box.right + 2.0 else None


def placed_dynamics(
    timed: TimedMarks,
    scale: Scale,
    span_s: tuple[float, float],
    band: tuple[float, float],
    width_of: Callable[[str], float],
    kept: frozenset[int] = frozenset(),
) -> Sequence[PlacedDynamic]:
    """Return the visible marks with their positions.

    Parameters
    ----------
    span_s : (float, float)
        Start and end time in seconds.
    band : (float, float)
        Top and bottom of the letters, pixels.
    width_of : callable
        Returns the width of a text in pixels.
    kept : frozenset of int
        Indices of marks that are drawn even if they overlap others.
    """
    marks = timed.of_player.marks
    start_s, end_s = span_s
    shown = timed.spans.between(start_s - BEHIND_PX / scale.px_per_s, end_s).tolist()
    if len(shown) * LEAST_MARK_PX > (end_s - start_s) * scale.px_per_s:
        shown = [place for place in shown if timed.numbers[place] in kept]
    starts, ends = scale.x_px(timed.spans.start_s[shown]).tolist(), scale.x_px(timed.spans.end_s[shown]).tolist()
    letters: list[PlacedDynamic] = []
    for place, left, end in zip(shown, starts, ends, strict=True):
        number = timed.numbers[place]
        mark = marks[number]
        if MARK_KINDS[mark.kind].anchor == "span":
            continue
        crowded = bool(letters) and left < letters[-1].box.right
        if crowded and mark.tick == marks[letters[-1].mark].tick:
            # Marks at one tick are placed side by side.
            left, crowded = letters[-1].box.right + GAP_PX, False
        if not crowded or number in kept:
            box = PixelRect(left, band[0], left + width_of(mark.text), band[1])
            ends_px = (end, None) if mark.end_tick else (None, end if end > left else None)
            letters.append(PlacedDynamic(number, box, ends_px[0], False, ends_px[1]))
    lefts = np.array([item.box.left for item in letters])
    found = list(letters)
    middle, half = (band[0] + band[1]) / 2, (band[1] - band[0]) * 0.27
    for place, left, right in zip(shown, starts, ends, strict=True):
        number = timed.numbers[place]
        if MARK_KINDS[marks[number].kind].anchor != "span":
            continue
        # Letters at its beginning push the hairpin to the right, letters at its end cut it short.
        before = int(np.searchsorted(lefts, left + 1.0)) - 1
        if before >= 0 and letters[before].box.right + GAP_PX > left:
            left = letters[before].box.right + GAP_PX
        if before + 1 < len(letters):
            right = min(right, letters[before + 1].box.left - GAP_PX)
        if right - left >= LEAST_HAIRPIN_PX or number in kept:
            right = max(right, left + LEAST_HAIRPIN_PX)
            found.append(PlacedDynamic(number, PixelRect(left, middle - half, right, middle + half), None, True))
    return found
