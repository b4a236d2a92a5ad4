"""Parsing and checking of ``PLAYER.parameter=value`` settings for one or several players."""

from __future__ import annotations

import fnmatch
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

import msgspec

from app.errors import UsageError
from app.plan.parameters import AUTOMATIC, PARAMETERS, PlayerParameters, Value
from app.project import limits
from app.project.choreography_files import SUFFIX, bundled_choreographies, is_choreography
from metadata.acting import as_text, names_in
from metadata.library import HABITS, STYLES

_CASTING: Final = ("instrument", "character")
_DANCED: Final = "choreography"
_GENERATED: Final = "none"
"""Value of a choreography that means generated motion, and of habits that means none."""
_STYLE, _HABITS = "style", "habits"


class ParameterSetting(msgspec.Struct, frozen=True):
    """A value set for a parameter of the player with an index; ``value`` has the parameter's type."""

    player: int
    parameter: str
    value: Value


def parameter_names() -> tuple[str, ...]:
    """Names of all parameters that can be set, in a fixed order."""
    return (*PARAMETERS, *_CASTING)


def matching_players(requested: str, names: Sequence[str]) -> tuple[int, ...]:
    """Return the indices of the players that match a name or pattern (``*``, ``?``, ``[...]``), ignoring case.

    An exact name matches only that player, even if it is also a pattern.
    """
    key = requested.strip().casefold()
    exact = tuple(index for index, name in enumerate(names) if name.casefold() == key)
    if exact:
        return exact
    return tuple(index for index, name in enumerate(names) if fnmatch.fnmatchcase(name.casefold(), key))


def select_players(requested: Iterable[str], names: Sequence[str]) -> tuple[int, ...]:
    """Return the indices of the named players in score order; of all players if none are named.

    Raises
    ------
    UsageError
        A name or pattern matches no player.
    """
    chosen: set[int] = set()
    asked = False
    for name in requested:
        asked = True
        found = matching_players(name, names)
        if not found:
            raise UsageError("player.unknown", player=name, possible=", ".join(names) or "-")
        chosen.update(found)
    return tuple(sorted(chosen)) if asked else tuple(range(len(names)))


def parse_settings(
    texts: Iterable[str], names: Sequence[str], instruments: Iterable[str], characters: Iterable[str]
) -> tuple[ParameterSetting, ...]:
    """Parse ``PLAYER.parameter=value`` texts; of several for the same parameter the last one is used.

    Parameters
    ----------
    texts : iterable of str
        Texts from the user. The player may be a pattern: ``*.amplitude=0``.
    names : sequence of str
        Names of the players, which may contain dots and equals signs; a text is split so that the name matches a
        player.
    instruments, characters : iterable of str
        Allowed ids for ``instrument`` and ``character``.

    Raises
    ------
    UsageError
        A text is malformed, or its player, parameter or value is unknown.
    """
    choices = {"instrument": tuple(instruments), "character": tuple(characters)}
    settings: dict[tuple[int, str], ParameterSetting] = {}
    for text in texts:
        players, parameter, value_text = _split(text, names)
        value = _value(parameter, value_text, choices)
        for player in players:
            settings[player, parameter] = ParameterSetting(player, parameter, value)
    return tuple(settings.values())


def is_possible(parameter: str, value: object) -> bool:
    """Return whether a value is allowed for a player's parameter."""
    if parameter == _DANCED and isinstance(value, str) and value:
        return is_choreography(value) and len(value) <= limits.MOST_TEXT
    if parameter in (_STYLE, _HABITS):
        # A value not installed here may be installed on another computer.
        return isinstance(value, str) and value.isprintable() and len(value) <= limits.MOST_NAME
    return PARAMETERS[parameter].allows(value)


def with_settings(parameters: PlayerParameters, settings: Iterable[ParameterSetting]) -> PlayerParameters:
    """Return the parameters with those settings applied that are among their fields."""
    changes = {setting.parameter: setting.value for setting in settings if setting.parameter in PARAMETERS}
    return msgspec.structs.replace(parameters, **changes)


def setting_readings(text: str) -> list[tuple[str, str, str]]:
    """Return the possible readings of a setting such as ``Flute.amplitude=0.5``, one for every place of ``.word=``: the
    performer, the parameter and the value. Raises UsageError if there is none.
    """
    readings = [
        (text[: seam.start()], seam.group(1).strip(), text[seam.end() :].strip())
        for seam in re.finditer(r"\.\s*(\w+)\s*=", text)
        if text[: seam.start()].strip()
    ]
    if not readings:
        raise UsageError("set.syntax", text=text)
    return readings


def _split(text: str, names: Sequence[str]) -> tuple[tuple[int, ...], str, str]:
    """Split a setting into indices of players, parameter and value."""
    readings = setting_readings(text)
    for player, parameter, value in readings:
        found = matching_players(player, names)
        if found:
            if parameter not in parameter_names():
                raise UsageError("set.parameter_unknown", parameter=parameter, possible=", ".join(parameter_names()))
            return found, parameter, value
    raise UsageError("set.player_unknown", player=readings[0][0], possible=", ".join(names) or "-")


def _value(parameter: str, text: str, choices: Mapping[str, tuple[str, ...]]) -> Value:
    if parameter in choices:
        possible = (*choices[parameter], AUTOMATIC)
        if text not in possible:
            raise UsageError("set.value_invalid", parameter=parameter, value=text, possible=", ".join(possible))
        return None if text == AUTOMATIC else text
    if parameter == _DANCED:
        return _choreography(text)
    if parameter in (_STYLE, _HABITS):
        return _known(parameter, text)
    try:
        return PARAMETERS[parameter].read(text)
    except ValueError as error:
        raise UsageError(
            "set.value_invalid", parameter=parameter, value=text, possible=range_text(parameter)
        ) from error


def _choreography(text: str) -> str:
    """Return a choreography from a text: a bundled name, or else a path."""
    if text.casefold() in ("", _GENERATED, AUTOMATIC):
        return ""
    known = bundled_choreographies()
    if text in known:
        return text
    path = os.path.abspath(text)  # noqa: PTH100 - a symbolic link is what the user chose
    if not text.casefold().endswith(SUFFIX) or not is_possible(_DANCED, path):
        raise UsageError("set.value_invalid", parameter=_DANCED, value=text, possible=range_text(_DANCED))
    return path


def _known(parameter: str, text: str) -> str:
    """Return the text of a style, or of comma-separated habits, if all are available. Raises UsageError otherwise."""
    if parameter == _HABITS and text.casefold() in (_GENERATED, AUTOMATIC):
        return ""
    known = STYLES.now().items if parameter == _STYLE else HABITS.now().items
    named = (text,) if parameter == _STYLE else names_in(text)
    if not all(name in known for name in named):
        raise UsageError("set.value_invalid", parameter=parameter, value=text, possible=range_text(parameter))
    return text if parameter == _STYLE else as_text(named)


def range_text(parameter: str) -> str:
    """Return the range of a parameter as a text for a message: numbers and words only."""
    if parameter == _DANCED:
        return ", ".join((_GENERATED, *bundled_choreographies(), f"*{SUFFIX}"))
    if parameter == _STYLE:
        return ", ".join(sorted(STYLES.now().items))
    if parameter == _HABITS:
        return ", ".join((_GENERATED, *sorted(HABITS.now().items)))
    return PARAMETERS[parameter].possible
