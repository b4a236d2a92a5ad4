"""Labels of the ruler: times in seconds or frames, bar numbers, marks of tempo and metre."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol

import numpy as np

from app.errors import Message
from app.project.edit import tempo as tempo_edit
from app.project.model import Project
from app.score.model import Score
from widgets.timeline.model.lane_mouse import PixelRect
from widgets.timeline.model.lines import Lines
from widgets.timeline.model.visible_time import Scale, VisibleSpan

LEAST_LABEL_PX = 64.0
STEPS_S = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0)
STEPS_FRAMES = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000, 100000)

Labels = list[tuple[float, str]]
"""Pairs of a time in seconds and its label."""


def bar_labels(score: Score, lines: Lines) -> Labels:
    """Return the numbers of the labelled bars at their times. Bars before the piece have lines, but no numbers."""
    first = 0 if score.pickup_ticks else 1
    return [
        (seconds, str(bar) if bar >= first else "")
        for bar, seconds in zip(lines.bars, lines.bar_s.tolist(), strict=True)
    ]


def frame_labels(axis: VisibleSpan, fps: Fraction) -> Labels:
    """Return round frame numbers at their times, as dense as legible; frame 0 is at second 0."""
    step = next(
        (step for step in STEPS_FRAMES if step / float(fps) * axis.px_per_s >= LEAST_LABEL_PX), STEPS_FRAMES[-1]
    )
    first, last = int(axis.start_s * fps // step), int(axis.end_s * fps // step) + 1
    return [(float(Fraction(number * step) / fps), str(number * step)) for number in range(first, last + 1)]


def clock_labels(axis: VisibleSpan) -> Labels:
    """Return round times in minutes and seconds at their positions, as dense as legible."""
    step_s = next((step for step in STEPS_S if step * axis.px_per_s >= LEAST_LABEL_PX), STEPS_S[-1])
    first, last = int(axis.start_s // step_s), int(axis.end_s // step_s) + 1
    decimals = 0 if step_s >= 1 else 1 if step_s >= 0.1 else 2
    return [(number * step_s, clock(number * step_s, decimals)) for number in range(first, last + 1)]


def clock(seconds: float, decimals: int) -> str:
    """Return seconds as minutes and seconds, such as ``-0:02.5``."""
    scaled = round(abs(seconds) * 10**decimals)
    whole, fraction = divmod(scaled, 10**decimals)
    sign = "-" if seconds < 0 and scaled else ""
    tail = f".{fraction:0{decimals}d}" if decimals else ""
    hours, minutes = divmod(whole // 60, 60)
    head = f"{hours}:{minutes:02d}" if hours else str(minutes)
    return f"{sign}{head}:{whole % 60:02d}{tail}"


class Metrics(Protocol):
    """Widths of texts in a font; a protocol, since font metrics are Qt's and this package is independent of Qt."""

    def horizontalAdvance(self, text: str, /) -> float: ...


@dataclass(frozen=True)
class RulerMark:
    """A mark of tempo (``"tempo"``) or metre (``"metre"``), and its rectangle on the ruler."""

    kind: str
    tick: int
    text: str
    box: PixelRect


def lay_marks(
    score: Score, axis: Scale, metrics: Metrics, left_px: float, right_px: float, height_px: float
) -> list[RulerMark]:
    """Place the marks of tempo and metre on the ruler without overlaps; where there is no space for both, the metre is
    shown. The mark in effect at the left edge stays visible.

    Parameters
    ----------
    axis : Scale
        Scale whose pixels count from ``left_px``.
    left_px, right_px : float
        Visible range in pixels.
    """
    metres, bpm = score.metres, score.tempo_map.bpm
    texts: dict[str, Callable[[int], str]] = {
        "metre": lambda index: f"{metres[index].numerator}/{metres[index].denominator}",
        "tempo": lambda index: f"♩={bpm[index][1]:.4g}",
    }
    held: dict[str, tuple[int, str]] = {}
    inside: list[tuple[int, int, float, str, int]] = []
    # A file can have tens of thousands: outside the view only the last mark before the left edge is examined.
    ticks_of = {"metre": [metre.tick for metre in metres], "tempo": [tick for tick, _ in bpm]}
    for order, (kind, ticks) in enumerate(ticks_of.items()):
        x_px = left_px + axis.x_px(score.tempo_map.seconds(np.array(ticks, np.float64)))
        first, end = int(x_px.searchsorted(left_px)), int(x_px.searchsorted(right_px, side="right"))
        if first:
            held[kind] = ticks[first - 1], texts[kind](first - 1)
        shown = range(first, end)
        inside += [
            (ticks[index], order, x, kind, index) for index, x in zip(shown, x_px[first:end].tolist(), strict=True)
        ]
    inside.sort()
    room_px = inside[0][2] if inside else right_px
    marks: list[RulerMark] = []
    free_px = left_px

    def put(x: float, kind: str, tick: int, text: str) -> float:
        width = metrics.horizontalAdvance(text) + 12.0
        marks.append(RulerMark(kind, tick, text, PixelRect(x, 1.0, x + width, height_px - 2.0)))
        return x + width + 2.0

    for kind in ("metre", "tempo"):
        if kind in held and free_px + metrics.horizontalAdvance(held[kind][1]) + 12.0 <= room_px:
            free_px = put(free_px, kind, *held[kind])
    for tick, _, x, kind, index in inside:
        beside = bool(marks) and marks[-1].tick == tick
        if x >= free_px - 1 or beside:
            free_px = put(max(x, free_px), kind, tick, texts[kind](index))
    return marks


def mark_text(score: Score, kind: str, tick: int) -> str:
    """Return the tempo or metre in effect at a tick, as the text that the user edits."""
    if kind == "tempo":
        return f"{next(bpm for at, bpm in reversed(score.tempo_map.bpm) if at <= tick):.6g}"
    metre = score.metre_map.metre_at(tick)
    return f"{metre.numerator}/{metre.denominator}"


def typed(kind: str, tick: int, text: str) -> tuple[Message, Callable[[Project], Project]]:
    """Return an edit that sets the tempo or metre at a tick as typed, and its name for undo; the edit raises an error
    for invalid text.
    """
    if kind == "tempo":
        try:
            bpm = float(text.replace(",", "."))
        except ValueError:
            bpm = 0.0
        return Message("edit.set_tempo"), lambda project: tempo_edit.set_tempo(project, tick, bpm)
    above, _, below = text.partition("/")
    numbers = (int(above), int(below)) if above.strip().isdecimal() and below.strip().isdecimal() else (0, 0)
    return Message("edit.set_metre"), lambda project: tempo_edit.set_metre(project, tick, *numbers)


def removal(kind: str, tick: int) -> tuple[Message, Callable[[Project], Project]]:
    """Return the name (for undo) and the edit that removes the tempo or metre mark at a tick."""
    if kind == "tempo":
        return Message("edit.remove_tempo"), lambda project: tempo_edit.remove_tempo(project, tick)
    return Message("edit.remove_metre"), lambda project: tempo_edit.remove_metre(project, tick)
