"""Fingerings in words: players' names of keys and holes in both languages, from the maps."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import groupby
from typing import Final

from app.errors import Argument, Message
from app.messages import FINGERINGS, text
from instrument_maps.fingering_label import controls_of, says_words
from instrument_maps.model import InstrumentMap

_NUMBERED: Final = re.compile(r"(.*?)(\d+)")
_AND: Final = " + "
_SAME: Final = "·"
"""Separator of the numbers of adjacent controls with one name: ``"L1·2·3"``."""


def key_name(instrument: InstrumentMap, control: str, language: str) -> str:
    """Return the name of a control for players; without one in the map, its sign or its internal name in words."""
    for key in instrument.chart:
        if key.name == control:
            return key.ja if language == "ja" else key.en
    signs = (one.label for one in instrument.controls if one.name == control)
    return next(signs, "") or control.replace("_", " ")


def pressed_names(instrument: InstrumentMap, values: Mapping[str, float], language: str) -> list[str]:
    """Return the names of all closed or pressed controls in the order of the chart: ``["thumb hole", "L1·2"]``,
    ``["open"]``.

    Parameters
    ----------
    values : mapping
        Values 0..1 by control; missing ones are at rest.
    language : str
        ``"en"`` or ``"ja"``.
    """
    half = {control.name for control in instrument.controls if control.half_value is not None}
    pitch = [control.name for control in instrument.controls if control.role == "pitch"]
    charted = [key.name for key in instrument.chart if key.name in pitch]
    names = []
    for name in dict.fromkeys((*charted, *pitch)):
        value = values.get(name, 0.0)
        if value > 0.0:
            own = key_name(instrument, name, language)
            is_half = name in half and value < 1.0
            names.append(text(Message("fingering_words.half", {"key": own}), language) if is_half else own)
    return _joined(names) or [text(Message("fingering_words.open"), language)]


def fingering_words(instrument: InstrumentMap, label: str, language: str) -> str:
    """Return a label of keys and holes in words, ``"thumb hole + L1·2 + E♭ key"``; labels of valves and slides and
    unknown ones are unchanged.
    """
    values = controls_of(label, instrument.controls) if says_words(instrument.controls) else None
    return label if values is None else _AND.join(pressed_names(instrument, values, language))


def in_words(message: Message, instrument: InstrumentMap | None, language: str) -> Message:
    """Replace fingerings and controls in a message by words for players."""
    if instrument is None:
        return message
    named: dict[str, Argument] = {
        name: fingering_words(instrument, str(message.arguments[name]), language)
        for name in FINGERINGS.get(message.id, ())
    }
    if "control" in message.arguments:
        named["control"] = key_name(instrument, str(message.arguments["control"]), language)
    return Message(message.id, {**message.arguments, **named}) if named else message


def _joined(names: list[str]) -> list[str]:
    """Join adjacent names that differ only in their number, as "L1·2" for "L1" and "L2"."""
    joined: list[str] = []
    for stem, run in groupby(names, lambda name: found[1] if (found := _NUMBERED.fullmatch(name)) else ""):
        own = list(run)
        joined += [stem + _SAME.join(name[len(stem) :] for name in own)] if stem else own
    return joined
