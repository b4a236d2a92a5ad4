"""Conversion between labels (short forms of fingerings) and values of controls.

The label of valves and levers is their signs joined (``"13"``, ``"T12"``, ``"0"`` for no valve, ``"T0"``); that of keys
and holes their sorted signs with spaces (``"L1 L2 R1"``, ``"(open)"`` for none). A slide's position is not included.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from instrument_maps.model import Control, Fingering

OPEN = "(open)"
NONE = "0"
HALF = "h"
"""Suffix of the sign of a half-closed hole."""
WORDS = frozenset({"key", "hole"})
"""Kinds of controls whose signs are words."""

_BETWEEN: Final = re.compile(r"[\s\-\u2013\u2014+,./|&()]+")
"""Signs and spaces between the signs of a fingering."""
_ACCIDENTALS: Final = str.maketrans("", "", "#b\u266d\u266e\u266f")
"""Accidentals of a slide position slightly higher or lower than usual."""
_ROMAN: Final = {"i": "1", "ii": "2", "iii": "3", "iv": "4", "v": "5", "vi": "6", "vii": "7"}
_OPEN_SIGNS: Final = str.maketrans("o\u25cb\u25ef", "000")
_FIRST_LEVER: Final = "vf"
"""Letters for the first valve of a slide in addition to its sign: "V1" in German parts, "F1"."""


def says_words(controls: Iterable[Control]) -> bool:
    """Return whether an instrument's labels are words with spaces, that is, whether it has keys or holes."""
    return any(control.kind in WORDS for control in controls if control.role == "pitch")


def controls_of(label: str, controls: Iterable[Control]) -> dict[str, float] | None:
    """Convert a label to control values 0..1 by control name; None if it is incomplete (as for a slide) or has an
    unknown sign.
    """
    pitch = [control for control in controls if control.role == "pitch"]
    if any(control.kind == "slide" for control in pitch):
        return None
    words = says_words(pitch)
    if words and label == OPEN:
        return {}
    by_label = {control.label: control for control in pitch if control.label}
    halves = {f"{sign}{HALF}": control for sign, control in by_label.items() if control.half_value is not None}
    values: dict[str, float] = {}
    for sign in label.split() if words else label.replace(NONE, ""):
        if sign in by_label:
            values[by_label[sign].name] = 1.0
        elif sign in halves:
            values[halves[sign].name] = halves[sign].half_value or 0.0
        else:
            return None
    return values


def words_of(values: Mapping[str, float], controls: Iterable[Control]) -> str:
    """Convert control values to the label of an instrument with keys and holes."""
    signs = []
    for control in controls:
        value = values.get(control.name, control.rest_value)
        if control.role == "pitch" and value > 0.0:
            half = control.half_value is not None and value < 1.0
            signs.append(f"{control.label}{HALF}" if half else control.label)
    return " ".join(sorted(signs)) or OPEN


def written_choice(text: str, choices: Sequence[Fingering], controls: Iterable[Control]) -> int | None:
    """Find the fingering that a composer wrote as ``text``: its index among a note's ``choices``, or None.

    Valves may be separated by signs (``"1-2"``, ``"1+2"``); a lever may be omitted if no other fingering of the note
    has these valves. A slide's position may be a Roman number and have an accidental (``"b4"``).
    """
    pitch = [control for control in controls if control.role == "pitch"]
    parts = [part for part in _BETWEEN.split(text.casefold()) if part]
    if not parts:
        return None
    if says_words(pitch):
        words = sorted(parts)
        return _only(place for place, one in enumerate(choices) if sorted(_words(one.label)) == words)
    signs = "".join(parts)
    if any(control.kind == "slide" for control in pitch):
        signs = _ROMAN.get(signs, signs.translate(_ACCIDENTALS))
        lever = next((control.label.casefold() for control in pitch if control.kind == "lever" and control.label), "")
        if lever and signs[:1] in _FIRST_LEVER and signs[1:]:
            signs = lever + signs[1:]
    written = _signs(signs.translate(_OPEN_SIGNS))
    found = _only(place for place, one in enumerate(choices) if _signs(one.label.casefold()) == written)
    if found is not None or not all(sign.isdigit() for sign in written):
        return found
    alike = (
        place
        for place, one in enumerate(choices)
        if not one.is_obsolete and [sign for sign in _signs(one.label) if sign.isdigit()] == written
    )
    return _only(alike)


def _only(places: Iterable[int]) -> int | None:
    """Return the single index if there is exactly one, else None."""
    found = list(places)
    return found[0] if len(found) == 1 else None


def _words(label: str) -> list[str]:
    """Split a label of keys and holes into its signs, at spaces and the separators `_BETWEEN`."""
    return [part for part in _BETWEEN.split(label.casefold()) if part]


def _signs(label: str) -> list[str]:
    """Split a label of valves and levers into its signs, in order; "0" has none."""
    return sorted(label.replace(NONE, ""))
