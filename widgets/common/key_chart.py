"""Places of an instrument's keys and holes in a drawn fingering: a row for each hand, the left above the right.

Nothing but the controls says what is drawn: the place where a finger is at home is a large circle in playing order, its
other keys are small beside it; thumbs are at the left of their row, little fingers at the right.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QRectF

from instrument_maps.model import Control, InstrumentMap

HOME_PX = 26.0
KEY_PX = 17.0
GAP_PX = 4.0
GUTTER_PX = 20.0
MARGIN_PX = 8.0
LEAST_KEY_PX = 22.0
_IN_A_COLUMN = 3
_LINE = ("index", "middle", "ring")
_FINGERS = ("thumb", *_LINE, "little", "hand")
_HANDS = ("left", "right")


@dataclass(frozen=True)
class Cell:
    """A key or hole in its place.

    Attributes
    ----------
    home : bool
        Drawn as a circle: where its finger is at home.
    """

    control: Control
    box: QRectF
    home: bool


@dataclass(frozen=True)
class Chart:
    """All cells, the top of each hand's row with its height, and the height of all."""

    cells: tuple[Cell, ...]
    rows: tuple[tuple[str, float, float], ...]
    height: float

    def at(self, x: float, y: float) -> Control | None:
        """The control drawn at a place, if any."""
        return next((cell.control for cell in self.cells if cell.box.adjusted(-2, -2, 2, 2).contains(x, y)), None)


def chart(instrument: InstrumentMap, width: float, advance: Callable[[str], float]) -> Chart:
    """Lay the pitch controls out.

    Parameters
    ----------
    width : float
        Of the picture; too many keys for it are drawn narrower, never under one another.
    advance : callable
        Width of a text in the keys' font.
    """
    controls = [control for control in instrument.controls if control.role == "pitch" and control.kind != "slide"]
    homes = _homes(instrument)
    hands = {
        hand: blocks
        for hand in _HANDS
        if (blocks := _blocks([one for one in controls if one.finger.startswith(f"{hand}.")], homes, advance))
    }
    # The fingers of both hands stand under one another.
    widths = {
        finger: max(blocks[finger].width for blocks in hands.values() if finger in blocks)
        for finger in _FINGERS
        if any(finger in blocks for blocks in hands.values())
    }
    free = width - GUTTER_PX - 2 * MARGIN_PX
    scale = min(1.0, free / max(sum(widths.values()), 1.0))
    cells: list[Cell] = []
    rows: list[tuple[str, float, float]] = []
    top = MARGIN_PX
    for hand, blocks in hands.items():
        tall = max(block.height for block in blocks.values())
        left = GUTTER_PX + MARGIN_PX + max(free - sum(widths.values()) * scale, 0.0) / 2.0
        for finger, wide in widths.items():
            block = blocks.get(finger)
            if block is not None:
                # Places where fingers are at home stand in one line; the other keys beside them.
                down = 0.0 if block.cells[0].home else max((tall - block.height) / 2.0, 0.0)
                across = left + (wide - block.width) * scale / 2.0
                cells += [_placed(cell, across, top + down, scale) for cell in block.cells]
            left += wide * scale
        rows.append((hand, top, tall))
        top += tall + 2.5 * GAP_PX
    return Chart(tuple(cells), tuple(rows), top + MARGIN_PX - 2.5 * GAP_PX)


def _placed(cell: Cell, left: float, top: float, scale: float) -> Cell:
    box, wide = cell.box, cell.box.width()
    if cell.home:
        return Cell(cell.control, QRectF(left + box.center().x() * scale - wide / 2.0, top, wide, box.height()), True)
    return Cell(cell.control, QRectF(left + box.x() * scale, top + box.y(), wide * scale, box.height()), False)


@dataclass(frozen=True)
class _Block:
    """The keys of one finger, from its own top left corner; the place where it is at home is the first."""

    cells: tuple[Cell, ...]
    width: float
    height: float


def _homes(instrument: InstrumentMap) -> frozenset[str]:
    """The controls at which the fingers of the line are at home: the first that a contact of theirs works."""
    found: dict[str, str] = {}
    fingers = {control.name: control.finger for control in instrument.controls}
    for contact in instrument.contacts:
        if contact.control is not None:
            found.setdefault(fingers.get(contact.control, ""), contact.control)
    return frozenset(name for finger, name in found.items() if finger.partition(".")[2] in _LINE)


def _blocks(own: list[Control], homes: frozenset[str], advance: Callable[[str], float]) -> dict[str, _Block]:
    by_finger: dict[str, list[Control]] = {}
    for control in own:
        by_finger.setdefault(control.finger.partition(".")[2], []).append(control)
    blocks = {}
    for finger in _FINGERS:
        if finger in by_finger:
            home = [control for control in by_finger[finger] if control.name in homes]
            others = [control for control in by_finger[finger] if control.name not in homes]
            blocks[finger] = _block(home, others, advance, beside=finger not in _LINE)
    return blocks


def _block(home: list[Control], others: list[Control], advance: Callable[[str], float], beside: bool) -> _Block:
    """A finger's place with its other keys under it; thumb and little finger have columns of keys."""
    wide = max([LEAST_KEY_PX, *(advance(control.label) + 8.0 for control in others)])
    step = KEY_PX + GAP_PX / 2
    rows = _IN_A_COLUMN if beside and len(others) > 4 else 2
    columns = -(-len(others) // rows)
    below = HOME_PX + GAP_PX if home else 0.0
    across = max(columns * (wide + GAP_PX / 2), HOME_PX if home else 0.0)
    cells = [Cell(one, QRectF((across - HOME_PX) / 2.0, 0.0, HOME_PX, HOME_PX), True) for one in home]
    start = (across - columns * (wide + GAP_PX / 2) + GAP_PX / 2) / 2.0
    for number, one in enumerate(others):
        column, row = divmod(number, rows)
        cells.append(Cell(one, QRectF(start + column * (wide + GAP_PX / 2), below + row * step, wide, KEY_PX), False))
    height = below + (min(len(others), rows) * step - GAP_PX / 2 if others else -GAP_PX)
    return _Block(tuple(cells), across + 2 * GAP_PX, max(height, HOME_PX if home else KEY_PX))
