"""Fingering charts as in method books: a column of holes at the fingers' home positions, the left hand above the right,
with other keys beside it. Positions missing in the map follow from the fingers.

The unit of length is the distance of adjacent holes in the column.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

from app.identity_cache import IdentityCache
from instrument_maps.model import Control, InstrumentMap

HOLE: Final = 0.9
"""Diameter of a hole, relative to the distance of holes."""
PAD: Final = (0.94, 0.56)
"""Width and height of a key, relative to the distance of holes."""
COLUMN: Final = 0.6
"""Greatest sideways distance of a column's hole from its centre, relative to the distance of holes."""
_BESIDE: Final = 1.15
_LINE: Final = ("index", "middle", "ring")
_DOWN: Final = {"thumb": 0.6, "middle": 1.0, "ring": 2.0, "little": 2.65}
_TOPS: Final = {"left": 0.0, "right": 3.4}
_OPEN, _HALF, _CLOSED = "○", "◐", "●"


@dataclass(frozen=True)
class ChartedKey:
    """A hole or key with its position in the chart.

    Attributes
    ----------
    x, y : float
        Centre in the chart's units, to the right and down from its top left corner.
    """

    control: Control
    x: float
    y: float
    is_round: bool
    sign: str

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the key in the chart's units."""
        return (HOLE, HOLE) if self.is_round else PAD

    def overlaps(self, other: ChartedKey) -> bool:
        """Return whether the key's rectangle overlaps that of another key in the chart."""
        (wide, tall), (other_wide, other_tall) = self.size, other.size
        apart = abs(self.x - other.x) * 2.0, abs(self.y - other.y) * 2.0
        return apart[0] < wide + other_wide and apart[1] < tall + other_tall

    @property
    def in_column(self) -> bool:
        """True if it is a hole in the column of home positions."""
        return self.is_round and abs(self.x) < COLUMN

    @property
    def is_always_shown(self) -> bool:
        """True if the key is drawn even when it is not pressed: the holes of the column and the thumb hole are, other
        keys are not.
        """
        return self.in_column or (self.is_round and self.control.finger.endswith(".thumb"))


@dataclass(frozen=True)
class KeyChart:
    """Fingering chart of an instrument: its holes and keys, in the order in which labels name them."""

    keys: tuple[ChartedKey, ...]

    @cached_property
    def column(self) -> tuple[ChartedKey, ...]:
        """The holes in the chart's column, from top to bottom."""
        return tuple(sorted((key for key in self.keys if key.in_column), key=lambda key: key.y))

    @cached_property
    def top(self) -> float:
        """Return the topmost extent of the chart in its units; 0, or less if keys are above the column."""
        return min((key.y - key.size[1] / 2.0 for key in self.keys), default=0.0)

    @cached_property
    def bottom(self) -> float:
        """Lowest extent of the chart in its units."""
        return max((key.y + key.size[1] / 2.0 for key in self.keys), default=1.0)

    @cached_property
    def between_hands(self) -> float | None:
        """Return the height of the line between the left hand's and the right hand's holes; None if one hand has no
        hole in the column.
        """
        left = [key.y for key in self.column if key.control.finger.startswith("left.")]
        right = [key.y for key in self.column if key.control.finger.startswith("right.")]
        return (max(left) + min(right)) / 2.0 if left and right else None

    def in_signs(self, values: Mapping[str, float]) -> str:
        """Return a fingering as a line of signs: ``"●●● ●○○ E♭"``, with the keys beside the column by their
        signs.
        """
        hands = ("".join(_hole(key, values) for key in self.column if key.control.finger.startswith(hand))
                 for hand in _TOPS)  # fmt: skip
        others = [key for key in self.keys if not key.in_column and values.get(key.control.name, 0.0) > 0.0]
        return " ".join(filter(None, (*hands, *(key.sign for key in others))))


def is_half(control: Control, value: float) -> bool:
    """Return whether a value means that a control's hole is half closed."""
    return control.half_value is not None and 0.0 < value < 1.0


def key_chart(instrument: InstrumentMap) -> KeyChart:
    """The chart of an instrument with keys or holes."""
    return _charts.step(_chart, instrument)


_charts: IdentityCache[KeyChart] = IdentityCache(16)


def _hole(key: ChartedKey, values: Mapping[str, float]) -> str:
    value = values.get(key.control.name, 0.0)
    return _HALF if is_half(key.control, value) else _CLOSED if value > 0.0 else _OPEN


def _chart(instrument: InstrumentMap) -> KeyChart:
    said = {row.name: row for row in instrument.chart}
    pitch = {one.name: one for one in instrument.controls if one.role == "pitch" and one.kind != "slide"}
    names = tuple(dict.fromkeys((*(name for name in said if name in pitch), *pitch)))
    homes = _homes(instrument)
    placed: dict[str, ChartedKey] = {}
    # Positions given by the map or by the fingers are fixed; the others find room beside them.
    for name in sorted(names, key=lambda name: (name not in said or said[name].at is None, name not in homes)):
        control, row = pitch[name], said.get(name)
        sign = (row.sign if row is not None else "") or control.label
        if row is not None and row.at is not None:
            placed[name] = ChartedKey(control, *row.at, row.round, sign)
        else:
            key = ChartedKey(control, *_usual_place(control, name in homes), name in homes, sign)
            while any(key.overlaps(other) for other in placed.values()):
                key = replace(key, x=key.x + (-1.0 if key.x < 0.0 else 1.0))
            placed[name] = key
    return KeyChart(tuple(placed[name] for name in names))


def _homes(instrument: InstrumentMap) -> frozenset[str]:
    """Return the names of the controls at the fingers' home: the first control that each finger works according to its
    contacts.
    """
    found: dict[str, str] = {}
    fingers = {control.name: control.finger for control in instrument.controls}
    for contact in instrument.contacts:
        if contact.control is not None:
            found.setdefault(fingers.get(contact.control, ""), contact.control)
    return frozenset(name for finger, name in found.items() if finger.partition(".")[2] in _LINE)


def _usual_place(control: Control, home: bool) -> tuple[float, float]:
    """Default position x, y of a key in the chart: in the column if the finger has its home there, else beside it; keys
    of thumbs are at the left.
    """
    hand, _, finger = control.finger.partition(".")
    side = 0.0 if home else -_BESIDE if finger == "thumb" else _BESIDE
    return side, _TOPS.get(hand, 0.0) + _DOWN.get(finger, 0.0)
