"""Acting of a piece, separate from its notes: saved to a file, loaded into a piece, and compared.

A TOML file with the section's intensity; for each player, by name, the style, habits, amounts and disabled layers, and
corrections of gestures, expressions and poses anchored in ticks; and the piece's own expressions.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, NamedTuple

import msgspec

from app.errors import MapError, Message
from app.formats.atomic import atomic_write
from app.formats.toml import header, read_toml, shaped, toml
from app.plan.by_hand.additive_curve import AdditiveCurve
from app.plan.by_hand.corrections import Correction
from app.plan.event_id import EventId
from app.plan.kinds import BREATH_KINDS
from app.project import limits
from app.project.check import expression_faults, require_sound
from app.project.check_corrections import correction_faults
from app.project.edit.players import set_parameters
from app.project.model import Project
from app.project.parameters import is_possible, range_text
from app.project.value_checks import Fault, faults_of_bounds, text_faults, unique
from app.score.marks import MARK
from metadata.acting import AMOUNTS
from metadata.model import Expression

VERSION: Final = 2
SUFFIX: Final = ".toml"
PARAMETER_NAMES: Final = ("amplitude", "style", "habits", "layers_off", *AMOUNTS)
"""Parameters of a player that concern acting."""
_NOT_ACTING: Final = frozenset({*BREATH_KINDS, "cue", "fingering", "embouchure", MARK})
"""Kinds of events that concern playing instead of acting."""


class PlayerMetadata(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Acting parameters and corrections of a player in a metadata file."""

    parameters: dict[str, Any] = {}
    corrections: tuple[Correction, ...] = ()


class PieceMetadata(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Metadata of a piece: its acting without its notes.

    Attributes
    ----------
    ticks_per_quarter : int
        Resolution of the corrections' ticks.
    players : dict of str to PlayerMetadata
        Data of players by name.
    """

    version: int
    ticks_per_quarter: int
    section_intensity: float = 1.0
    players: dict[str, PlayerMetadata] = {}
    expressions: tuple[Expression, ...] = ()


class LoadedPiece(NamedTuple):
    """A project after loading metadata, with the entries that could not be applied."""

    project: Project
    problems: tuple[Message, ...]


class MetadataDifference(NamedTuple):
    """A difference between the metadata of two pieces; the text of a side is empty if it has no such entry."""

    place: str
    one: str
    other: str


def is_acting(correction: Correction) -> bool:
    """Return whether a correction is about gestures, expressions or poses."""
    return EventId.parse(correction.about).kind not in _NOT_ACTING


def metadata_of(project: Project) -> PieceMetadata:
    """Return the present metadata of a piece. A musician with several instruments occurs once, as the player with the
    body.
    """
    players = {}
    for player in project.players:
        parameters = {}
        if project.musician(player) is player:
            parameters = {name: getattr(player.parameters, name) for name in PARAMETER_NAMES}
        corrections = tuple(filter(is_acting, project.corrections.get(player.id, ())))
        players[player.name] = PlayerMetadata(parameters, corrections)
    score = project.score
    return PieceMetadata(VERSION, score.ticks_per_quarter, project.section_intensity, players, project.expressions)


def with_metadata(project: Project, metadata: PieceMetadata) -> LoadedPiece:
    """Replace the metadata of a piece; players that are not named keep theirs.

    Raises
    ------
    UsageError
        The result could not be saved, for example because a tick is too large in the piece's resolution.
    """
    before = project
    by_name = {player.name.casefold(): player for player in project.players}
    corrections = dict(project.corrections)
    lost = []
    for name, said in metadata.players.items():
        player = by_name.get(name.casefold())
        if player is None:
            lost.append(name)
            continue
        if said.parameters and project.musician(player) is player:
            project = set_parameters(project, (player.id,), **said.parameters)
        scale = project.score.ticks_per_quarter / metadata.ticks_per_quarter
        corrections[player.id] = _merged(corrections.get(player.id, ()), said.corrections, scale)
    kept = {id: items for id, items in corrections.items() if items}
    project = replace(
        project, corrections=kept, section_intensity=metadata.section_intensity, expressions=metadata.expressions
    )
    require_sound(project, before)
    known = ", ".join(player.name for player in project.players)
    problems = (Message("metadata.no_player", {"players": ", ".join(lost), "known": known}),) if lost else ()
    return LoadedPiece(project, problems)


def _merged(before: tuple[Correction, ...], said: tuple[Correction, ...], scale: float) -> tuple[Correction, ...]:
    others = tuple(correction for correction in before if not is_acting(correction))
    if scale == 1.0:
        return others + said
    scaled = msgspec.convert(_scaled(msgspec.to_builtins(said), scale), tuple[Correction, ...])
    return others + tuple(_with_distinct_keys(item) if isinstance(item, AdditiveCurve) else item for item in scaled)


def _with_distinct_keys(curve: AdditiveCurve) -> AdditiveCurve:
    """Return the curve with only the last of several keys that fall on one tick at a coarser resolution."""
    keys = {key.tick: key for key in curve.keys}
    return curve if len(keys) == len(curve.keys) else msgspec.structs.replace(curve, keys=tuple(keys.values()))


def _scaled(value: Any, scale: float, key: str = "") -> Any:
    """Return a copy of stored metadata with all ticks multiplied by ``scale``, for another division of the quarter
    note."""
    if isinstance(value, Mapping):
        return {name: _scaled(item, scale, name) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [_scaled(item, scale, key) for item in value]
    if isinstance(value, int) and key.endswith(("tick", "ticks")) and not isinstance(value, bool):
        return round(value * scale)
    return value


def differences(one: PieceMetadata, other: PieceMetadata) -> tuple[MetadataDifference, ...]:
    """Return the differences between the metadata of two pieces, each with its place and both values as text."""
    mine, theirs = dict(_flat(_table(one), "")), dict(_flat(_table(other), ""))
    return tuple(
        MetadataDifference(place, mine.get(place, ""), theirs.get(place, ""))
        for place in sorted({*mine, *theirs})
        if mine.get(place, "") != theirs.get(place, "")
    )


def _flat(value: Any, place: str) -> Iterator[tuple[str, str]]:
    if isinstance(value, Mapping) and value:
        for key, item in value.items():
            yield from _flat(item, f"{place}.{key}" if place else str(key))
    elif isinstance(value, list | tuple):
        for item in value:
            # An added entry is identified by its name, regardless of its position.
            if isinstance(item, Mapping):
                named = (str(item[key]) for key in ("correction", "name", "event_id") if key in item)
                yield from _flat(item, f"{place}[{' '.join(named)}]")
            else:
                yield f"{place}[{item}]", str(item)
    else:
        yield place, str(value)


def save_metadata(metadata: PieceMetadata, path: Path) -> None:
    """Write metadata to a file. Raises FileError."""
    with atomic_write(path) as stream:
        stream.write(_text(_table(metadata)).encode())


def _text(table: dict[str, Any]) -> str:
    """Return the text of the file: every correction and expression is a separate table, so that programs compare files
    well.
    """
    text = toml({key: value for key, value in table.items() if key not in ("players", "expressions")})
    for name, player in table["players"].items():
        above = ("players", name)
        text += toml({"parameters": player["parameters"]}, above) if player["parameters"] else ""
        for correction in player["corrections"]:
            text += f"\n[{header((*above, 'corrections'), many=True)}]\n{toml(correction)}"
    for expression in table["expressions"]:
        text += f"\n[{header(('expressions',), many=True)}]\n{toml(expression, ('expressions',))}"
    return text


def _table(metadata: PieceMetadata) -> dict[str, Any]:
    table: dict[str, Any] = _without_none(msgspec.to_builtins(metadata))
    return table


def _without_none(value: Any) -> Any:
    """Return a copy of a table without None values, which TOML cannot express."""
    if isinstance(value, Mapping):
        return {key: _without_none(item) for key, item in value.items() if item is not None}
    return [_without_none(item) for item in value] if isinstance(value, list | tuple) else value


def load_metadata(path: Path) -> PieceMetadata:
    """Read and check metadata from a file. Raises FileError, MapError."""
    table = read_toml(path, path.name)
    version = table.get("version")
    if isinstance(version, int) and version > VERSION:
        raise MapError("metadata.newer", file=path.name, version=version, known=VERSION)
    players = table.get("players", {})
    metadata = shaped({**table, "players": {}}, PieceMetadata, path.name)
    if not isinstance(players, dict):
        raise MapError("table.invalid", file=path.name, place="players", detail="must be a table")
    named = {name: _player(name, player, path.name) for name, player in players.items()}
    metadata = msgspec.structs.replace(metadata, players=named)
    for place, detail in _faults(metadata):
        raise MapError("table.invalid", file=path.name, place=place, detail=detail)
    return metadata


def _player(name: str, table: object, file: str) -> PlayerMetadata:
    """Return a player's data from a table; errors name the player."""
    try:
        return shaped(table, PlayerMetadata, file)
    except MapError as error:
        said = error.message.arguments
        place = f"players.{name}.{said['place']}"
        raise MapError("table.invalid", file=file, place=place, detail=said["detail"]) from error


def _faults(metadata: PieceMetadata) -> Iterator[Fault]:
    yield from faults_of_bounds("ticks_per_quarter", metadata.ticks_per_quarter, limits.TICKS_PER_QUARTER)
    yield from faults_of_bounds("section_intensity", metadata.section_intensity, limits.SECTION_INTENSITY)
    for name, player in metadata.players.items():
        yield from text_faults(f"players.{name}", name)
        for parameter, value in player.parameters.items():
            place = f"players.{name}.parameters.{parameter}"
            if parameter not in PARAMETER_NAMES:
                yield place, f"must be one of {', '.join(PARAMETER_NAMES)}"
            elif not is_possible(parameter, value):
                yield place, f"possible: {range_text(parameter)}"
        for index, correction in enumerate(player.corrections):
            place = f"players.{name}.corrections[{index}]"
            if not is_acting(correction):
                yield place, f"{correction.tag!r} is not about acting"
            yield from correction_faults(correction, place)
    yield from unique("expressions", (expression.name for expression in metadata.expressions), "name")
    for index, expression in enumerate(metadata.expressions):
        yield from expression_faults(expression, f"expressions[{index}]")
