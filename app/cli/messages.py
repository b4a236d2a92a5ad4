"""English wording of every message of the program: id -> template, filled with the message's arguments."""

from __future__ import annotations

from typing import Final

from app.errors import AppError, Message

TEMPLATES: Final[dict[str, str]] = {
    # What a person asked for
    "set.syntax": "--set {text}: expected PLAYER.parameter=value",
    "set.player_unknown": "--set: there is no player {player!r}; there are: {possible}",
    "set.parameter_unknown": "--set: there is no parameter {parameter!r}; there are: {possible}",
    "set.value_invalid": "--set: {parameter} cannot be {value!r}; possible: {possible}",
    "player.unknown": "there is no player {player!r}; there are: {possible}",
}


def text(message: Message) -> str:
    """The message as an English sentence."""
    return TEMPLATES[message.id].format(**message.arguments)


def error_text(error: AppError) -> str:
    """What went wrong, as an English sentence."""
    return text(error.message)
