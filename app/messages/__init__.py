"""Texts of messages: the template of an id (`app.messages.wordings`) filled with a message's arguments."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from string import Formatter
from typing import Final

from app.encoding import shown
from app.errors import AppError, Message
from app.messages.details import detail_text
from app.messages.pitches import pitch_name
from app.messages.wordings import CORRECTION, wording
from app.messages.wordings import LANGUAGES as LANGUAGES
from app.messages.wordings import WORDINGS as WORDINGS

PITCHES: Final[dict[str, tuple[str, ...]]] = {
    "note.pitch_outside": ("pitch", "low", "high"),
    "fingering.out_of_range": ("low", "high", "played_pitch"),
    "note.place": ("pitch",),
    "gesture.bell_height": ("pitch", "mean_pitch"),
    "embouchure.register": ("pitch", "low", "high"),
    "embouchure.controller": ("pitch", "low", "high"),
    "expression.low_loud": ("pitch", "easy_low"),
    "score.outside_ranges": ("lowest", "highest"),
    "score.unknown_instrument": ("lowest", "highest"),
    "score.chosen_by_range_partly": ("pitch",),
    "score.looks_written": ("pitch",),
    "score.program_gives_way": ("pitch",),
    "score.read_as_written": ("pitch",),
    "score.solos": ("pitch",),
    "score.notes_left_out": ("pitch",),
    "score.stray_notes": ("pitch",),
    "score.slurred": ("pitch",),
    "score.unisons": ("pitch",),
    "score.key_switches": ("pitch",),
    "score.voices": ("pitch",),
    "score.doubling": ("pitch",),
    "midi.stuck_notes": ("pitch",),
}
"""Arguments of messages that are MIDI pitches and are displayed in the user's notation, by message id."""

TRANSPOSITION: Final = "transposition_semitones"
"""Name of the message argument with the written minus the sounding pitch of a player's instrument, in semitones."""

FINGERINGS: Final[dict[str, tuple[str, ...]]] = {
    **dict.fromkeys(("fingering.trill", "fingering.speed"), ("label", "first")),
    **dict.fromkeys(
        (
            "fingering.first_choice",
            "fingering.by_hand",
            "fingering.written",
            "fingering.starts_early",
            "contact.out_of_reach",
            "correction.no_such_fingering",
        ),
        ("label",),
    ),
}
"""Arguments of messages that are labels of fingerings, expressed in words by `instrument_maps.fingering_words`."""

DETAILS: Final = frozenset({"detail", "reason"})
"""Arguments whose texts are in `app.messages.details`."""

TEXTS: Final = frozenset({"mark", "parameter", "variant", "beside", "presentation", "aspect", "scale"})
"""Arguments that may be text ids."""


class _Filling(Formatter):
    def format_field(self, value: object, format_spec: str) -> str:
        if "|" not in format_spec:
            return shown(str(super().format_field(value, format_spec)))
        one, _, more = format_spec.partition("|")
        return one if value == 1 else more

    def vformat(self, format_string: str, args: Sequence[object], kwargs: Mapping[str, object]) -> str:
        text = value = ""
        for literal, field, spec, conversion in self.parse(format_string):
            text += _after(value, literal)
            value = ""
            if field is not None:
                found, _ = self.get_field(field, args, kwargs)
                value = self.format_field(self.convert_field(found, conversion), spec or "")
                text = _before(text, literal, value)
        return text


def _after(value: str, literal: str) -> str:
    """Return the template's text ``literal`` that follows a value, with a space between Japanese and Latin letters or
    digits and none within Japanese.
    """
    words = literal.removeprefix(" ")
    if _JAPANESE_START.match(words):
        if _LATIN_END.search(value):
            return f" {words}"
        if _JAPANESE_END.search(value.rstrip("）」")):
            return words
    return literal


def _before(text: str, literal: str, value: str) -> str:
    """Return the text so far followed by a value; spaces as in `_after`."""
    words = text.removesuffix(" ")
    if _JAPANESE_END.search(literal.removesuffix(" ")):
        if _LATIN_START.match(value):
            return f"{words} {value}"
        if _JAPANESE_START.match(value):
            return words + value
    return text + value


_KANA_OR_KANJI: Final = "[\u3005\u3041-\u3096\u30a1-\u30fa\u30fc\u4e00-\u9fff]"
_JAPANESE_START, _JAPANESE_END = re.compile(_KANA_OR_KANJI), re.compile(f"{_KANA_OR_KANJI}$")
_LATIN_START, _LATIN_END = re.compile("[A-Za-z0-9]"), re.compile("[A-Za-z0-9\u266d\u266f]$")
_FILLING = _Filling()


def filled(template: str, arguments: Mapping[str, object]) -> str:
    """Fill a template with arguments; ``{count:note|notes}`` becomes the first word if the count is 1, else the second.

    Languages without a plural omit such a field. Values in Japanese text are surrounded by spaces if Latin letters or
    digits meet Japanese, and by none otherwise, regardless of the template.
    """
    return _FILLING.vformat(template, (), arguments)


def text(message: Message, language: str = "en", named: Callable[[float], str] = pitch_name) -> str:
    """Return a message as a sentence in one of `LANGUAGES`; ``named`` returns names of pitches."""
    arguments = dict(message.arguments)
    for name in PITCHES.get(message.id, ()):
        arguments[name] = named(float(arguments[name]))
    for name in DETAILS & arguments.keys():
        arguments[name] = detail_text(str(arguments[name]), language)
    if (kind := f"{CORRECTION}{arguments.get('kind')}") in WORDINGS:
        arguments["kind"] = wording(kind, language)
    if "touch" in arguments:
        arguments["touch"] = touch_name(str(arguments["touch"]), language)
    if (side := f"body_side.{arguments.get('side')}") in WORDINGS:
        arguments["side"] = wording(side, language)
    if "fingers" in arguments:
        names = [_finger_name(finger, language) for finger in str(arguments["fingers"]).split()]
        arguments["fingers"] = ("、" if language == "ja" else ", ").join(names)
    if "why" in arguments:
        arguments["why"] = filled(wording(str(arguments["why"]), language), arguments)
    for name in (name for name in TEXTS & arguments.keys() if arguments[name] in WORDINGS):
        arguments[name] = wording(str(arguments[name]), language)
    return filled(wording(message.id, language), arguments)


def touch_name(part: str, language: str) -> str:
    """Return the words for a part of a hand such as ``left.index.side``; unknown names are returned unchanged."""
    side, _, rest = part.partition(".")
    name, _, place = rest.partition(".")
    ids = f"touch_side.{side}", f"touch_part.{name}", f"touch_place.{place or 'pad'}"
    if not WORDINGS.keys() >= set(ids):
        return part
    side, name, place = (wording(id, language) for id in ids)
    return place.format(f"{side}の{name}" if language == "ja" else f"{side} {name}")


def _finger_name(finger: str, language: str) -> str:
    """Return the words for a finger named as in instrument maps; unknown names are returned unchanged."""
    id = f"touch_part.{finger}"
    return wording(id, language) if id in WORDINGS else finger


def error_text(error: AppError) -> str:
    """Return the text of an error as an English sentence."""
    return text(error.message)
