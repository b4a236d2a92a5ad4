"""The grid that edits snap to: lines at a musical distance, counted from each bar line."""

from __future__ import annotations

from fractions import Fraction

import msgspec

from app.score.metre_map import MetreMap


class Grid(msgspec.Struct, frozen=True):
    """Step of the grid.

    Attributes
    ----------
    quarters : Fraction
        Length of a step in quarters: 1/4 is a sixteenth, 1/3 an eighth triplet.
    enabled : bool
        Whether edits snap to the grid.
    """

    quarters: Fraction = Fraction(1, 4)
    enabled: bool = True

    def step_ticks(self, metre_map: MetreMap) -> Fraction:
        """Return the exact length of a step in ticks; one tick if the grid is off."""
        return self.quarters * metre_map.ticks_per_quarter if self.enabled else Fraction(1)

    def snap(self, metre_map: MetreMap, tick: float) -> int:
        """Return the tick of the nearest grid line; bar lines are grid lines too."""
        if not self.enabled:
            return round(tick)
        start, following = metre_map.span_of_bar(metre_map.bar_of_tick(round(tick)))
        step = self.step_ticks(metre_map)
        below = start + step * ((Fraction(tick) - start) // step)
        lines = (round(below), min(round(below + step), following))
        return min(lines, key=lambda line: (abs(line - tick), line))
