"""Positions of marks in the plot's pixels: glyphs stacked on notes, slurs that avoid obstacles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from widgets.timeline.model.lane_mouse import PixelRect
from widgets.timeline.model.marks.mark_looks import LOOKS
from widgets.timeline.model.marks.mark_table import MarkTable
from widgets.timeline.model.roll.shown_notes import boxes
from widgets.timeline.model.visible_time import Scale

LEAST_ROW_PX = 2.5
LEAST_GLYPH_PX, LEAST_SLUR_PX = 5.0, 12.0
"""Least sizes in pixels below which glyphs and slurs are not drawn, since they would be illegible."""
LEAST_UNIT_PX, MOST_UNIT_PX = 3.8, 5.5
UNITS_A_ROW = 0.42
BEHIND_PX = 240.0
"""Distance in pixels before the plot from which marks may still reach into it."""
GAP_PX = 2.0
INSET, MOST_INSET_PX = 0.3, 8.0
"""Distance of a slur's ends from the outer ends of its notes: share of the notes' width, and greatest distance in
pixels.
"""
WARNING_PX = 9.0
"""Height in pixels of a warning on a note, below its marks."""
STEEPNESS = 0.18
"""Distance of a slur's control points from its ends, relative to its width."""
LEAST_LIFT_PX, USUAL_LIFT_PX, MOST_LIFT_PX = 4.0, 13.0, 40.0
STEEP_PX = 24.0
"""Difference in pixels from which a slur crossing its first or last note begins or ends at that note's other corner."""
TURNS = 4
"""Number of iterations after which slurs avoid nearly all obstacles."""
BELOW_COSTS_PX = 10.0
"""Additional height in pixels above which a slur is drawn below its notes."""
END_PX = 7.0
"""Distance in pixels within which an end of a slur is hit."""
NEAR_PX = 4.0
"""Vertical distance in pixels within which a slur is hit."""

_T: Final = np.linspace(0.0, 1.0, 65)
_ALONG: Final = 3 * (1 - _T) ** 2 * _T * STEEPNESS + 3 * (1 - _T) * _T**2 * (1 - STEEPNESS) + _T**3
_HEIGHT: Final = 4 * _T * (1 - _T)


def arc_height(share: FloatArray) -> FloatArray:
    """Return the relative height (N,), 0..1, of a slur's arc at shares (N,), 0..1, of its width."""
    height: FloatArray = np.interp(share, _ALONG, _HEIGHT)
    return height


class Arcs(NamedTuple):
    """Slurs in pixels, arrays (N,).

    Attributes
    ----------
    mark : array
        Indices in `MarkList.marks`.
    x0, y0, x1, y1 : array
        Left and right ends.
    lift : array
        Height in the middle above the line from end to end; negative below the notes.
    is_bracket : array
        Whether it is a straight bracket, over notes that are tongued separately.
    """

    mark: IntArray
    x0: FloatArray
    y0: FloatArray
    x1: FloatArray
    y1: FloatArray
    lift: FloatArray
    is_bracket: BoolArray

    def y_at(self, arc: IntArray, x: FloatArray) -> FloatArray:
        """Return the heights (N,) in pixels at positions ``x`` (N,) of the slurs or brackets with the indices ``arc``
        (N,).
        """
        x0, x1, y0, y1 = self.x0[arc], self.x1[arc], self.y0[arc], self.y1[arc]
        share = np.clip((x - x0) / np.maximum(x1 - x0, 1e-6), 0.0, 1.0)
        rise = np.where(self.is_bracket[arc], 1.0, arc_height(share))
        y: FloatArray = y0 + (y1 - y0) * share - self.lift[arc] * rise
        return y


class Glyphs(NamedTuple):
    """Marks at notes in pixels, arrays (N,).

    Attributes
    ----------
    mark : array
        Indices in `MarkList.marks`.
    x, y : array
        Middle of the glyph's lower edge; for a line its start, or its end if it leads to a note.
    x_end, y_end : array
        End of a trill's line or a glissando.
    """

    mark: IntArray
    x: FloatArray
    y: FloatArray
    x_end: FloatArray
    y_end: FloatArray


class PlacedMarks(NamedTuple):
    """The musical marks of a player with their positions in the visible section of the plot."""

    table: MarkTable
    unit_px: float
    line_px: float
    glyphs: Glyphs
    arcs: Arcs

    def box_of_glyph(self, place: int) -> PixelRect:
        """Return the rectangle in pixels of the glyph with the index ``place`` in `glyphs`, for hits by the mouse."""
        mark = self.table.of_player.marks[int(self.glyphs.mark[place])]
        look, unit = LOOKS[mark.kind], self.unit_px
        x, y, x_end, y_end = (float(column[place]) for column in self.glyphs[1:])
        if look.place == "next":
            return PixelRect(x, min(y, y_end) - 3.0, max(x_end, x + 4.0), max(y, y_end) + 3.0)
        width, height = look.width * unit, look.height * unit
        if look.place in ("after", "before"):
            left = x if look.place == "after" else x - width
            above = mark.kind in ("doit", "plop")
            return PixelRect(left, y - height if above else y, left + width, y if above else y + height)
        if look.is_text:
            width, height = max(width, 0.62 * self.line_px * len(mark.text)), self.line_px
        right = max(x + width / 2, x_end) if mark.kind == "trill" else x + width / 2
        return PixelRect(x - width / 2, y - height, right, y)

    def glyph_at(self, x_px: float, y_px: float) -> int | None:
        """Return the index of the mark whose glyph is at a point."""
        glyphs = self.glyphs
        near = np.flatnonzero((glyphs.x - x_px < 40.0) & (np.fmax(glyphs.x, glyphs.x_end) - x_px > -40.0))
        for place in near[::-1].tolist():
            left, top, right, bottom = self.box_of_glyph(place)
            if left - 2.0 <= x_px <= right + 2.0 and top - 1.0 <= y_px <= bottom + 1.0:
                return int(glyphs.mark[place])
        return None

    def arc_end_at(self, x_px: float, y_px: float) -> tuple[int, bool] | None:
        """Return the index of the slur with an end at a point, and whether it is the first end."""
        arcs = self.arcs
        found = []
        for is_first, x, y in ((True, arcs.x0, arcs.y0), (False, arcs.x1, arcs.y1)):
            away = np.hypot(x - x_px, y - y_px)
            if len(away) and away.min() <= END_PX:
                found.append((float(away.min()), int(arcs.mark[away.argmin()]), is_first))
        return min(found)[1:] if found else None

    def arc_at(self, x_px: float, y_px: float) -> int | None:
        """Return the index of the slur at a point."""
        arcs = self.arcs
        over = np.flatnonzero((arcs.x0 - 2.0 <= x_px) & (x_px <= arcs.x1 + 2.0))
        if not len(over):
            return None
        away = np.abs(arcs.y_at(over, np.full(len(over), x_px)) - y_px)
        return int(arcs.mark[over[away.argmin()]]) if away.min() <= NEAR_PX else None

    def place_of(self, mark: int) -> tuple[float, float] | None:
        """Return a point in pixels at which a click hits the mark; None if it is not drawn."""
        at = np.flatnonzero(self.glyphs.mark == mark)
        if len(at):
            left, top, right, bottom = self.box_of_glyph(int(at[0]))
            return (left + right) / 2, (top + bottom) / 2
        at = np.flatnonzero(self.arcs.mark == mark)
        if not len(at):
            return None
        x = (self.arcs.x0[at] + self.arcs.x1[at]) / 2
        return float(x[0]), float(self.arcs.y_at(at, x)[0])


class MarkRoom(NamedTuple):
    """The section of the plot for placing marks.

    Attributes
    ----------
    axis : Scale
        Horizontal scale.
    width_px, height_px : float
        Size of the plot.
    row_px, line_px : float
        Height of the row of a pitch, and of a line of text.
    highest : float
        Pitch at the upper edge of the plot.
    start_s, end_s : float
        Start and end of the drawn time span in seconds.
    below_px : float
        Height in pixels below each note that its fingering takes.
    warned : sequence of int
        Indices of the notes with a warning.
    """

    axis: Scale
    width_px: float
    height_px: float
    row_px: float
    line_px: float
    highest: float
    start_s: float
    end_s: float
    below_px: float = 0.0
    warned: Sequence[int] = ()


def placed_marks(table: MarkTable, room: MarkRoom) -> PlacedMarks | None:
    """Return the marks of a section of the plot with positions; None if there are none or they would be too small."""
    if not table.of_player.marks or room.row_px < LEAST_ROW_PX:
        return None
    behind_s = BEHIND_PX / room.axis.px_per_s
    shown = table.notes.visible(room.start_s - behind_s, room.end_s)
    at = table.at_notes
    low, high = np.searchsorted(at.note, (shown.start, shown.stop)).tolist()
    if (high - low) * LEAST_GLYPH_PX > room.width_px:
        low = high
    arcs = table.spans.between(room.start_s, room.end_s)
    if len(arcs) * LEAST_SLUR_PX > room.width_px:
        arcs = arcs[:0]
    if low == high and not len(arcs):
        return None
    ends = [shown.start, shown.stop]
    if len(arcs):
        ends = [min(ends[0], int(table.slurs.first[arcs[0]])), max(ends[1], int(table.slurs.last[arcs].max()) + 1)]
    return _Placing(table, room, ends[0], min(ends[1] + 1, len(table.notes))).placed(slice(low, high), arcs)


class _Placing:
    """Computes marks' positions at the notes with the indices ``first`` to ``end`` (excluded)."""

    def __init__(self, table: MarkTable, room: MarkRoom, first: int, end: int) -> None:
        self.table, self.room, self.first = table, room, first
        self.unit = min(max(room.row_px * UNITS_A_ROW, LEAST_UNIT_PX), MOST_UNIT_PX)
        rows: IntArray = np.arange(first, end)
        self.left, top, self.width, self.height = boxes(table.notes, rows, room.axis, room.highest, room.row_px)
        self.bottom = top + self.height
        warned = [place - first for place in room.warned if first <= place < end]
        self.stack_y = top - GAP_PX
        self.stack_y[warned] -= WARNING_PX
        self.inner_y = self.stack_y - table.under_slurs[rows] * self.unit
        self.outer_y = self.inner_y.copy()

    def placed(self, glyphs: slice, arcs: IntArray) -> PlacedMarks:
        """Return the positions of the glyphs and arcs with the given indices, for drawing."""
        placed_arcs = self._arcs(arcs)
        return PlacedMarks(self.table, self.unit, self.room.line_px, self._glyphs(glyphs), placed_arcs)

    def _arcs(self, chosen: IntArray) -> Arcs:
        slurs = self.table.slurs
        mark, first, last = slurs.mark[chosen], slurs.first[chosen] - self.first, slurs.last[chosen] - self.first
        left, width = self.left, self.width
        inset = np.minimum(width * INSET, MOST_INSET_PX)
        x0 = left[first] + np.where(slurs.chained_first[chosen], width[first] / 2 + 1.5, inset[first])
        x1 = left[last] + np.where(slurs.chained_last[chosen], width[last] / 2 - 1.5, width[last] - inset[last])
        away: FloatArray = (0.5 + 1.3 * slurs.inner[chosen].astype(np.float64)) * self.unit + 1.0
        kinds = [self.table.of_player.marks[number].kind for number in mark.tolist()]
        is_bracket = np.fromiter((kind != "slur" for kind in kinds), np.bool_, len(kinds))
        arcs = Arcs(mark, x0, x0, x1, x1, np.zeros(len(mark)), is_bracket)
        if not len(mark):
            return arcs
        over, edges = _Over(first, last), (left, left + width)
        above = over.cleared(self.inner_y, edges, (x0, x1), away, is_bracket)
        below = over.cleared(-(self.bottom + self.room.below_px), edges, (x0, x1), away, is_bracket)
        # Above the plot it would be invisible.
        over_top = np.maximum(above.lift - np.minimum(above.y0, above.y1), 0.0)
        lowest = below.lift - np.minimum(below.y0, below.y1)
        under_bottom = np.maximum(lowest - self.room.height_px, 0.0)
        is_below = below.cost + under_bottom + BELOW_COSTS_PX < above.cost + over_top
        arcs = arcs._replace(
            x0=np.where(is_below, below.x0, above.x0),
            y0=np.where(is_below, -below.y0, above.y0),
            x1=np.where(is_below, below.x1, above.x1),
            y1=np.where(is_below, -below.y1, above.y1),
            lift=np.where(is_below, -below.lift, above.lift),
        )
        # Marks above slurs are above these too.
        owner, note = over.owner[~is_below[over.owner]], over.note[~is_below[over.owner]]
        np.minimum.at(self.outer_y, note, arcs.y_at(owner, self._glyph_x(note)) - 1.0)
        return arcs

    def _glyph_x(self, note: IntArray) -> FloatArray:
        """Return the x positions of glyphs on notes, near the note's start."""
        x: FloatArray = self.left[note] + np.minimum(self.width[note] / 2, 1.6 * self.unit)
        return x

    def _glyphs(self, chosen: slice) -> Glyphs:
        table, unit = self.table, self.unit
        at = table.at_notes
        mark, note, last = at.mark[chosen], at.note[chosen] - self.first, at.last[chosen] - self.first
        x = self._glyph_x(note)
        x_end, y_end = self.left[last] + self.width[last], np.full(len(mark), np.nan)
        for place in np.flatnonzero(last > note).tolist():
            # Above all notes of the written-out ornament.
            self.outer_y[note[place]] = self.outer_y[note[place] : last[place] + 1].min()
        base = np.where(at.is_outer[chosen], self.outer_y[note], self.stack_y[note])
        y = base - at.units[chosen] * unit - at.lines[chosen] * self.room.line_px
        for place in np.flatnonzero(~at.is_stacked[chosen]).tolist():
            where, its = LOOKS[table.of_player.marks[int(mark[place])].kind].place, int(note[place])
            right, middle = self.left[its] + self.width[its], self.bottom[its] - self.height[its] / 2
            x[place] = self.left[its] - 1.0 if where == "before" else right + (0.0 if where == "end" else 1.0)
            if where == "end":
                short = self.width[its] < 6 * unit
                y[place] = (self.inner_y if short else self.stack_y)[its] - GAP_PX
                continue
            y[place] = middle
            if where == "next":
                following = min(its + 1, len(self.left) - 1)
                x_end[place] = max(self.left[following] - 1.0, right)
                y_end[place] = self.bottom[following] - self.height[following] / 2
        return Glyphs(mark, x, y, x_end, y_end)


class _Cleared(NamedTuple):
    """Slurs raised to clear the notes below: heights of their ends and middles, and difference from the usual shape, in
    pixels.
    """

    x0: FloatArray
    y0: FloatArray
    x1: FloatArray
    y1: FloatArray
    lift: FloatArray
    cost: FloatArray


class _Over:
    """Pairs of slurs and notes below them.

    Attributes
    ----------
    owner, note : array (M,)
        Index of the slur and index of the note in each pair.
    """

    def __init__(self, first: IntArray, last: IntArray) -> None:
        self._first, self._last = first, last
        counts = last - first + 1
        self._starts = np.cumsum(counts) - counts
        self.owner: IntArray = np.repeat(np.arange(len(first)), counts)
        self.note: IntArray = first[self.owner] + np.arange(len(self.owner)) - self._starts[self.owner]

    def cleared(
        self, top: FloatArray, edges: tuple[FloatArray, FloatArray], ends: tuple[FloatArray, FloatArray],
        away: FloatArray, is_straight: BoolArray,
    ) -> _Cleared:  # fmt: skip
        """Return the slurs raised so that they keep a distance ``away`` from the notes.

        Parameters
        ----------
        edges : two arrays (N,)
            Left and right ends of the notes.
        ends : two arrays (N,)
            Start and end positions of the slurs.
        """
        owner, note = self.owner, self.note
        left, right = edges
        x0, x1 = ends
        y0, y1 = top[self._first] - away, top[self._last] - away
        # A steep slur begins or ends at the corner of its note that it would cross.
        slope = (y1 - y0) / np.maximum(x1 - x0, 1.0)
        far0, far1 = right[self._first] - 1.5, left[self._last] + 1.5
        x0 = np.where(slope * (far0 - x0) > STEEP_PX, far0, x0)
        x1 = np.where(slope * (far1 - x1) > STEEP_PX, far1, x1)
        width = np.maximum(x1 - x0, 1.0)
        share = np.concatenate([np.clip((x[note] - x0[owner]) / width[owner], 0.0, 1.0) for x in edges])
        order = np.argsort(np.concatenate([owner, owner]), kind="stable")
        share, both = share[order], np.repeat(owner, 2)
        aim = np.concatenate([top[note], top[note]])[order] - away[both]
        rise = np.where(is_straight[both], 1.0, arc_height(share))
        usual = np.where(is_straight, 0.0, np.clip(0.1 * width + 2.0, LEAST_LIFT_PX, USUAL_LIFT_PX))
        most = np.minimum(0.4 * width + LEAST_LIFT_PX, MOST_LIFT_PX)
        starts, cost = 2 * self._starts, np.zeros(len(y0))
        gap = y0[both] + (y1 - y0)[both] * share - aim
        lift = np.clip(np.maximum.reduceat(gap / np.maximum(rise, 0.3), starts), usual, np.maximum(most, usual))
        cost += lift - usual
        for _ in range(TURNS):
            # If something is still in the way, the ends are raised off their notes, the nearer one more.
            rest = y0[both] + (y1 - y0)[both] * share - lift[both] * rise - aim
            worst = np.maximum.reduceat(rest, starts)
            _, at = np.unique(both[rest == worst[both]], return_index=True)
            at = np.flatnonzero(rest == worst[both])[at]
            t, more = share[at], np.maximum(worst, 0.0)
            squares = (1 - t) ** 2 + t**2
            y0, y1 = y0 - more * (1 - t) / squares, y1 - more * t / squares
            cost += more
        return _Cleared(x0, y0, x1, y1, lift, cost)
