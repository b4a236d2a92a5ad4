"""Size and position of every kind of mark relative to its note, as in engraving."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Literal, NamedTuple

Place = Literal["stack", "end", "after", "before", "next"]


class MarkLook(NamedTuple):
    """Size and position of a kind of mark.

    Attributes
    ----------
    order : int
        Order from the note outwards among stacked marks.
    width, height : float
        In units of `PlacedMarks.unit_px`; for text, the height of a text line is used instead.
    place : {"stack", "end", "after", "before", "next"}
        Above the note's start; above its end; a line after the note; a line leading to it; a line to the next note.
    under_slur : bool
        Whether a slur passes above it.
    is_text : bool
        Whether the mark's own text is drawn.
    """

    order: int
    width: float
    height: float
    place: Place = "stack"
    under_slur: bool = False
    is_text: bool = False


LOOKS: Final[Mapping[str, MarkLook]] = {
    "staccato": MarkLook(0, 0.9, 0.9, under_slur=True),
    "staccatissimo": MarkLook(0, 0.9, 1.6, under_slur=True),
    "double_tongue": MarkLook(1, 1.9, 0.8, under_slur=True),
    "triple_tongue": MarkLook(1, 2.9, 0.8, under_slur=True),
    "tenuto": MarkLook(2, 2.0, 0.5, under_slur=True),
    "accent": MarkLook(3, 2.2, 1.5),
    "marcato": MarkLook(4, 1.7, 1.9),
    "tremolo": MarkLook(5, 1.9, 2.1),
    "flutter_tongue": MarkLook(5, 1.9, 2.1),
    "grace": MarkLook(6, 1.9, 2.8),
    "stopped": MarkLook(7, 1.7, 1.7),
    "open": MarkLook(7, 1.5, 1.5),
    "fingering": MarkLook(8, 2.0, 0.0, is_text=True),
    "position": MarkLook(8, 2.0, 0.0, is_text=True),
    "mordent": MarkLook(9, 3.0, 1.4),
    "turn": MarkLook(9, 2.9, 1.5),
    "trill": MarkLook(9, 2.6, 2.2),
    "fermata": MarkLook(10, 3.2, 1.9),
    "breath": MarkLook(0, 1.1, 1.9, "end"),
    "caesura": MarkLook(0, 2.1, 2.3, "end"),
    "fall": MarkLook(0, 3.0, 2.4, "after"),
    "doit": MarkLook(0, 3.0, 2.4, "after"),
    "scoop": MarkLook(0, 2.4, 2.0, "before"),
    "plop": MarkLook(0, 2.4, 2.4, "before"),
    "glissando": MarkLook(0, 0.0, 0.0, "next"),
}
"""Looks of the kinds anchored to one note, or to the notes of a written-out ornament."""
