"""Texts of messages and other values in the user's language."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

from app.editor.session import Session
from app.editor.translated import tr
from app.errors import Argument, Message
from app.messages import DETAILS, PITCHES, TEXTS, WORDINGS, filled
from app.messages.details import detail_text
from app.messages.pitches import pitch_name
from app.messages.wordings import CORRECTION, CORRECTIONS
from app.plan.by_hand.additive_curve import CHANNELS
from app.plan.kinds import GESTURE_KINDS
from app.plan.problem_lines import NOTES, note_of, note_place
from app.project.performers import Player
from app.score.model import Note
from instrument_maps.fingering_words import in_words
from instrument_maps.instrument_names import vocabulary
from instrument_maps.library import all_maps
from instrument_maps.model import PARTS, InstrumentMap
from widgets.common.channel_names import channel_name
from widgets.common.event_names import expression_name, gesture_name, kind_name, pose_name, style_name
from widgets.common.field_names import field_name
from widgets.common.instrument_name import instrument_name, language
from widgets.common.pitch import pitch_text


def message_text(message: Message, session: Session | None = None, player_id: str | None = None) -> str:
    """Return a message as a sentence in the editor's language.

    Parameters
    ----------
    session : Session or None
        Session for notes by pitch and position, and fingerings in words; without it notes are given by id and
        fingerings by label.
    player_id : str or None
        Player of the message; None for the active player.
    """
    template = tr(message.id)
    if session is not None:
        message = in_words(message, _instrument(_player(session, player_id)), language())
    arguments = {name: _reported(message, name, session, player_id) for name in message.arguments}
    if session is None:
        named = PITCHES.get(message.id, ())
        arguments |= {name: pitch_name(float(message.arguments[name])) for name in named}
    return filled(template, arguments)


def sentence(message: Message, session: Session | None = None, player_id: str | None = None) -> str:
    """Return a message as a separate sentence with a capital letter, unless it begins with a name."""
    text = message_text(message, session, player_id)
    return text if WORDINGS[message.id][0].startswith("{") else text[:1].upper() + text[1:]


def note_text(session: Session, note: Note, player: Player | None) -> str:
    """Return a note's pitch, bar and beat as text; ``player`` gives the instrument for written pitches."""
    place = note_place(session.project.score, note)
    return tr(place.id).format(**{**place.arguments, "pitch": player_pitch(session, note.pitch, player)})


def _reported(message: Message, name: str, session: Session | None, player_id: str | None) -> Argument:
    value = message.arguments[name]
    if session is not None:
        player = _player(session, player_id)
        if name in PITCHES.get(message.id, ()):
            return player_pitch(session, float(value), player)
        if name in NOTES and isinstance(value, str):
            return _anchor(session, value, player, is_anchor=name == "anchor")
    if name in TEXTS:
        return parameter_text(str(value))
    if name == "event":
        return kind_name(str(value))
    if name in ("work", "why") and value in WORDINGS:
        its_own = {other: given for other, given in message.arguments.items() if other != name}
        return message_text(Message(str(value), its_own), session, player_id).rstrip("…")
    if name in _NAMES:
        return _NAMES[name](str(value))
    if name in DETAILS:
        return detail_text(str(value), language(), _label)
    if name == "place" and message.id in _STORED:
        return field_name(str(value))
    words = _WORDS.get(name)
    return words().get(str(value), str(value).replace("_", " ")) if words is not None else value


def _player(session: Session, player_id: str | None) -> Player | None:
    players = session.project.players
    return next((player for player in players if player.id == player_id), None) if player_id else session.player


def _instrument(player: Player | None) -> InstrumentMap | None:
    return all_maps().get(player.instrument_id) if player is not None else None


def player_pitch(session: Session, pitch: float, player: Player | None) -> str:
    """Return the name of a sounding pitch in the user's notation for a player."""
    instrument = _instrument(player)
    semitones = instrument.transposition_semitones if instrument is not None else 0
    return pitch_text(session.pitch_display, round(pitch), semitones)


def _anchor(session: Session, id: str, player: Player | None, is_anchor: bool) -> str:
    """Return an anchor as text: a note id as a note, an event id as kind and place, other names unchanged. A note id
    without a note becomes "deleted note" if ``is_anchor``.
    """
    note = note_of(session.project.score, id, player.part_id if player is not None else None)
    if note is not None:
        return note_text(session, note, player)
    if is_anchor and _NOTE_ID.fullmatch(id):
        return tr("word.deleted_note")
    kind, colon, rest = id.partition(":")
    if not colon or kind_name(kind) == kind:
        return id
    note = note_of(session.project.score, rest, player.part_id if player is not None else None)
    place = rest
    if note is not None:
        place = note_text(session, note, player)
    elif rest.startswith("@") and rest[1:].lstrip("-").isdecimal():
        place = session.project.score.metre_map.label(int(rest[1:]))
    return f"{kind_name(kind)} {place}"


def _gesture(name: str) -> str:
    """Return the translated name of a gesture kind, or the title of a gesture from a table."""
    return tr(f"action.gesture.{name}") if name in GESTURE_KINDS else gesture_name(name)


_NAMES: Mapping[str, Callable[[str], str]] = {
    "gesture": _gesture,
    "expression": expression_name,
    "style": style_name,
}
"""Functions that name an argument, by the argument's name."""
_STORED = frozenset({"project.cannot_save", "project.not_storable", "autosave.without"})
"""Ids of messages about a value of the open project, whose key path is replaced by a name."""
_NOTE_ID = re.compile(r"\d+:\d+")


def _label(kind: str, name: str) -> str:
    """Return the subject of a correction as text: the translated name of a channel, pose, style, gesture or expression.

    Names made by the user stay.
    """
    if kind == "additive":
        return channel_name(name)
    if kind == "pose":
        return pose_name(name)
    if kind == "play_style":
        return style_name(name)
    return gesture_name(name) if "gesture" in kind else expression_name(name)


def _targets() -> dict[str, str]:
    return {name: pose_name(name).lower() for name in ("bell", "head", "left_elbow", "right_elbow", "torso")}


def _touches() -> dict[str, str]:
    """Return the translated names of the parts of a hand, in which the side of a finger that touches is left out."""
    templates = {
        "thumb": tr("word.thumb"),
        "index": tr("word.index_finger"),
        "middle": tr("word.middle_finger"),
        "ring": tr("word.ring_finger"),
        "little": tr("word.little_finger"),
        "palm": tr("word.palm"),
        "thumb_web": tr("word.web_of_thumb"),
    }
    sides = _WORDS["side"]()
    return {part: templates[part.split(".")[1]].format(side=sides[part.split(".")[0]]) for part in PARTS}


def parameter_text(text_id: str) -> str:
    """Return a text of a parameter (`app.plan.parameters`) in the editor's language; empty if there is none."""
    return tr(text_id) if text_id else ""


def _instruments() -> dict[str, str]:
    """Return the names of instruments by map id and by their names in messages."""
    return vocabulary().names_in(language()) | _WORDS["map"]()


_WORDS: Mapping[str, Callable[[], dict[str, str]]] = {
    "kind": lambda: {tag: tr(f"{CORRECTION}{tag}") for tag in CORRECTIONS},
    "target": _targets,
    "side": lambda: {"left": tr("word.left"), "right": tr("word.right")},
    "touch": _touches,
    "moved": lambda: {channel: channel_name(channel) for channel in CHANNELS},
    "map": lambda: {id: instrument_name(instrument) for id, instrument in all_maps().items()},
    **dict.fromkeys(("instrument", "said", "played"), _instruments),
    "angle": lambda: {"up": tr("word.up_and_down"), "left": tr("word.to_side"), "roll": tr("word.leaning")},
    "leader_reason": lambda: {"chosen": tr("word.chosen_as_leader"), "melody": tr("word.leads_melody")},
}
"""Functions that return words by value, for arguments with few possible values."""
