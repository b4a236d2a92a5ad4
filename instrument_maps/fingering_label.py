"""The short form of a fingering: what it says of the controls, and the other way round.

Of valves and levers it is their signs put together (``"13"``, ``"T12"``, ``"0"`` for no valve, ``"T0"``); of keys and
holes their signs sorted, one space between (``"L1 L2 R1"``, ``"(open)"`` for none). A slide's place is not in it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from instrument_maps.model import Control

OPEN = "(open)"
NONE = "0"
HALF = "h"
"""After the sign of a hole that is half closed."""
WORDS = frozenset({"key", "hole"})
"""Kinds of controls whose signs are words."""


def says_words(controls: Iterable[Control]) -> bool:
    """Return whether an instrument's labels are words with spaces between: it has keys or holes."""
    return any(control.kind in WORDS for control in controls if control.role == "pitch")


def controls_of(label: str, controls: Iterable[Control]) -> dict[str, float] | None:
    """Return the values a label says, by name of control; None where it does not (a slide, an unknown sign)."""
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
    """Return the label of keys and holes for values by name of control."""
    signs = []
    for control in controls:
        value = values.get(control.name, control.rest_value)
        if control.role == "pitch" and value > 0.0:
            half = control.half_value is not None and value < 1.0
            signs.append(f"{control.label}{HALF}" if half else control.label)
    return " ".join(sorted(signs)) or OPEN
