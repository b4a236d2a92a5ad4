"""Dancers and their settings as texts of the command line: ``[NAME=]CHOREOGRAPHY`` and ``DANCER.setting=value``."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

from app.errors import UsageError
from app.plan.parameters import Parameter
from app.project.choreography_files import SUFFIX, bundled_choreographies, is_bundled_name
from app.project.edit.dancers import add_dancer, change_dancers, set_choreography
from app.project.model import DANCER_PARAMETERS, Project
from app.project.parameters import matching_players, parameter_names, setting_readings

USUAL_NAME: Final = "Dancer"
"""Name of a dancer without a typed one, in all languages: commands that select it work everywhere."""
SETTINGS: Final[Mapping[str, Parameter]] = {**DANCER_PARAMETERS, "mirrored": Parameter(name="mirrored", kind=bool)}
"""Settings of a dancer that are numbers or truth values."""
_CHOREOGRAPHY, _CHARACTER = "choreography", "character"


def setting_names() -> tuple[str, ...]:
    """Return the names of all settings of a dancer."""
    return (*SETTINGS, _CHOREOGRAPHY, _CHARACTER)


def with_dancers(project: Project, texts: Iterable[str]) -> Project:
    """Add dancers described by texts ``[NAME=]CHOREOGRAPHY``: a bundled name, or the path of a file.

    Raises
    ------
    AppError
        There is no such choreography, the name is empty, or there are too many dancers.
    """
    for text in texts:
        name, equals, choreography = text.partition("=")
        if not equals or _is_there(text.strip()):
            name, choreography = USUAL_NAME, text
        project, _ = add_dancer(project, _found(choreography.strip()), name)
    return project


def with_dancer_settings(
    project: Project, texts: Iterable[str], characters: Sequence[str]
) -> tuple[Project, tuple[str, ...]]:
    """Apply the settings that concern dancers, and return the project and the texts that concern players.

    Parameters
    ----------
    texts : iterable of str
        ``PERFORMER.setting=value``. The performer may be a pattern, which applies to all whom the setting fits.
    characters : sequence of str
        Ids of known characters.

    Raises
    ------
    UsageError
        No dancer has such a name, or the value is impossible.
    """
    players, dancers = [one.name for one in project.players], [one.name for one in project.dancers]
    rest = []
    for text in texts:
        read = next((one for one in setting_readings(text) if matching_players(one[0], [*players, *dancers])), None)
        if read is None or (read[1] not in setting_names() and matching_players(read[0], players)):
            rest.append(text)
            continue
        name, setting, value = read
        chosen = [project.dancers[index].id for index in matching_players(name, dancers)]
        if setting not in setting_names():
            raise UsageError("set.parameter_unknown", parameter=setting, possible=", ".join(setting_names()))
        if setting in parameter_names() and matching_players(name, players):
            rest.append(text)
        elif not chosen:
            raise UsageError("set.player_unknown", player=name, possible=", ".join(dancers) or "-")
        project = _set(project, chosen, setting, value, characters)
    return project, tuple(rest)


def _set(project: Project, dancer_ids: Sequence[str], setting: str, text: str, characters: Sequence[str]) -> Project:
    if not dancer_ids:
        return project
    if setting == _CHOREOGRAPHY:
        return set_choreography(project, dancer_ids, _found(text))
    value: Any = text
    if setting == _CHARACTER:
        if text not in characters:
            raise UsageError("set.value_invalid", parameter=setting, value=text, possible=", ".join(characters))
        return change_dancers(project, dancer_ids, character_id=value)
    parameter = SETTINGS[setting]
    try:
        value = parameter.read(text)
    except ValueError as error:
        raise UsageError("set.value_invalid", parameter=setting, value=text, possible=parameter.possible) from error
    return change_dancers(project, dancer_ids, **{setting: value})


def _is_there(choreography: str) -> bool:
    return choreography.casefold().endswith(SUFFIX) and os.path.isfile(choreography)


def _found(choreography: str) -> str:
    """Return a choreography that exists: a bundled name or the path of a file. Raises UsageError otherwise."""
    known = bundled_choreographies()
    if choreography in known or (not is_bundled_name(choreography) and _is_there(choreography)):
        return choreography
    raise UsageError("dancer.not_found", choreography=choreography, possible=", ".join((*known, f"*{SUFFIX}")))
