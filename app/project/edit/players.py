"""Edits of players: adding and removing, parts, parameters and places."""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final, TypeVar

import msgspec

from app.chance import chance, next_seed
from app.errors import AppError, MapError
from app.plan.parameters import PARAMETERS, PlayerParameters, Value
from app.project import limits
from app.project.anchors import moved_correction
from app.project.band_in_title import years_in_title
from app.project.casting import (
    DANCER_ROOM_M,
    SPACING_M,
    StagePosition,
    amplitude,
    player_seed,
    stage_seats,
    usual_posture,
)
from app.project.character_choice import newcomers_character
from app.project.doubling import TOGETHER_S, promote_remaining, together_s
from app.project.footprint import footprint, together
from app.project.ids import MADE_PART, fresh_note_ids, fresh_part_ids, fresh_player_ids
from app.project.model import Project
from app.project.names import clean_name
from app.project.performers import Dancer, Player
from app.project.usual_outfits import common_outfit
from app.score.channel_sound import DRUM_CHANNEL
from app.score.instrument_choice import require_map
from app.score.marks import renamed_marks
from app.score.model import Part
from instrument_maps.library import all_maps, find_map
from instrument_maps.map_table import Posture
from instrument_maps.model import InstrumentMap
from metadata.acting import as_text, names_in
from metadata.library import HABITS

P = TypeVar("P", bound=Player | Dancer)

HABIT_CHANCES: Final = (0.7, 0.3)
"""Probabilities of a first and a second habit in the widest random variation of players."""


def cast_parameters(project: Project, player_id: str, instrument: InstrumentMap | None = None) -> PlayerParameters:
    """Return the initial parameters of a player; with an instrument, in a posture in which it can be played."""
    usual = usual_posture(len(project.bodies))
    return PlayerParameters(
        amplitude=amplitude(project.seed, player_id),
        seed=player_seed(project.seed, player_id),
        posture=usual if instrument is None else instrument.hold.possible(usual),
    )


def instrument_of(player: Player) -> InstrumentMap | None:
    """Return the instrument map of a player; None if it is missing or cannot be read."""
    try:
        return find_map(player.instrument_id)
    except MapError:
        return None


def postures_of(player: Player) -> tuple[Posture, ...]:
    """Return the postures in which a player's instrument can be played; both if it has no map."""
    instrument = instrument_of(player)
    return ("standing", "seated") if instrument is None else instrument.hold.postures


def posture_of(player: Player) -> Posture:
    """Return the posture of a player: as set, or the only one in which the instrument can be played."""
    instrument = instrument_of(player)
    return player.parameters.posture if instrument is None else instrument.hold.possible(player.parameters.posture)


def change(project: Project, player_ids: Collection[str], **fields: object) -> Project:
    """Set fields of `Player` (``instrument_id``, ``muted`` ...) for several players; see `rename` for names.

    Character and outfit are changed for all players of the same musician.

    Raises
    ------
    AppError
        A musician would have instruments that cannot be played in one posture.
    """
    if {"character_id", "outfit"} & fields.keys():
        player_ids = {*player_ids, *musicians_of(project, player_ids)}
    result = _each(project, player_ids, lambda player: msgspec.structs.replace(player, **fields))
    return _in_one_posture(result, player_ids) if "instrument_id" in fields else result


def _in_one_posture(project: Project, player_ids: Collection[str]) -> Project:
    """Set the musicians of some players to a posture in which all their instruments can be played."""
    for musician_id in sorted(musicians_of(project, player_ids)):
        first, *others = project.played_by(project.player(musician_id))
        for other in others:
            if not set(postures_of(first)) & set(postures_of(other)):
                raise AppError("doubling.posture", player=other.name, other=first.name)
        possible = postures_of_musician(project, first)
        if others and first.parameters.posture not in possible:
            project = set_parameters(project, (musician_id,), posture=possible[0])
    return project


def rename(project: Project, player_id: str, name: str) -> Project:
    """Rename a player; a number is added if the name is taken. Raises AppError for an empty name."""
    return change(project, (player_id,), name=free_name(visible_name(name), project.performer_names(but=player_id)))


def set_parameters(project: Project, player_ids: Collection[str], **values: Value) -> Project:
    """Set parameters of several players' musicians; numbers are clipped to their bounds."""
    held = {name: PARAMETERS[name].held(value) for name, value in values.items()}
    return _each(project, musicians_of(project, player_ids), lambda player: _with_parameters(player, held))


def reset_parameters(project: Project, player_ids: Collection[str], names: Collection[str] | None = None) -> Project:
    """Reset parameters of the players' musicians to their initial values; all parameters if no names are given."""

    def reset(player: Player) -> Player:
        cast = cast_parameters(project, player.id, instrument_of(player))
        possible = postures_of_musician(project, player)
        if cast.posture not in possible:
            cast = msgspec.structs.replace(cast, posture=possible[0])
        requested = cast.__struct_fields__ if names is None else names
        return _with_parameters(player, {name: getattr(cast, name) for name in requested})

    return _each(project, musicians_of(project, player_ids), reset)


def randomise(project: Project, player_ids: Collection[str], spread: float) -> Project:
    """Make players differ from each other: parameters vary randomly around their present mean, and each player gets
    habits and a seed of its own.

    Parameters
    ----------
    spread : float
        Amount of variation, from 0 (all equal) to 1 (as different as is sensible).
    """
    player_ids = musicians_of(project, player_ids)
    chosen = [player for player in project.bodies if player.id in player_ids]
    if not chosen:
        return project
    # The current seeds determine the next ones: the same ensemble gives the same result, and pressing again another.
    roll = sum(player.parameters.seed for player in chosen) % 2**63
    values: dict[str, dict[str, Value]] = {player.id: {} for player in chosen}
    for name, parameter in PARAMETERS.items():
        if not parameter.spread:
            continue
        middle = sum(getattr(player.parameters, name) for player in chosen) / len(chosen)
        steps = [2.0 * chance("randomise", name, roll, player.id) - 1.0 for player in chosen]
        mean = sum(steps) / len(steps) if len(steps) > 1 else 0.0
        for player, step in zip(chosen, steps, strict=True):
            value = middle + spread * parameter.spread * (step - mean)
            values[player.id][name] = round(parameter.held(value), 2)
    for player in chosen:
        if spread:
            values[player.id]["habits"] = _thrown_habits(player.id, roll, spread)
        values[player.id]["seed"] = next_seed(player.id, roll)
        project = set_parameters(project, (player.id,), **values[player.id])
    return project


def _thrown_habits(player_id: str, roll: int, spread: float) -> str:
    """Return up to two habits chosen at random for a player, as text; more often for a larger ``spread``.

    ``roll`` is the seed of the choice.
    """
    known = sorted(HABITS.now().items)
    found = [
        known[int(chance("habit", str(number), roll, player_id) * len(known))]
        for number, most in enumerate(HABIT_CHANCES)
        if known and chance("has habit", str(number), roll, player_id) < most * spread
    ]
    return as_text(tuple(found))


def set_habit(project: Project, player_ids: Collection[str], habit: str, has: bool) -> Project:
    """Give players a habit or take it from them; other habits stay."""

    def changed(player: Player) -> Player:
        others = [name for name in names_in(player.parameters.habits) if name != habit]
        return _with_parameters(player, {"habits": as_text((*others, *((habit,) if has else ())))})

    return _each(project, musicians_of(project, player_ids), changed)


def show_layer(project: Project, player_ids: Collection[str], amount: str, shown: bool) -> Project:
    """Enable or disable a layer of players; its amount and other layers stay."""

    def changed(player: Player) -> Player:
        others = [name for name in names_in(player.parameters.layers_off) if name != amount]
        return _with_parameters(player, {"layers_off": as_text((*others, *(() if shown else (amount,))))})

    return _each(project, musicians_of(project, player_ids), changed)


def place(project: Project, places: Mapping[str, StagePosition]) -> Project:
    """Set the positions on stage of the musicians who play the given players' parts, by player id."""
    places = {project.musician(player).id: places[player.id] for player in project.players if player.id in places}
    return _each(project, places, lambda player: msgspec.structs.replace(player, stage=places[player.id]))


def arc_of(project: Project) -> tuple[StagePosition, ...]:
    """Return the places of the usual seating, in the order of the players."""
    rooms = [together(footprint(instrument_of(one)) for one in project.played_by(body)) for body in project.bodies]
    seats = dict(zip((body.id for body in project.bodies), stage_seats(rooms), strict=True))
    return tuple(seats[project.musician(player).id] for player in project.players)


def arrange(project: Project) -> Project:
    """Place everyone in the usual seating: an arc for a few players, rows for many."""
    return place(project, {player.id: spot for player, spot in zip(project.players, arc_of(project), strict=True)})


def add_player(
    project: Project, instrument: InstrumentMap, maps: Mapping[str, InstrumentMap], name: str
) -> tuple[Project, str]:
    """Add a player with a new empty part; returns the project and the player's id.

    Parameters
    ----------
    maps : mapping of str to InstrumentMap
        Instrument maps of all players, by id.
    name : str
        Name; a number is added if it is taken.
    """
    [player_id], [part_id] = fresh_player_ids(project), fresh_part_ids(project)
    called = free_name(clean_name(name) or instrument.name.en, project.performer_names())
    parts = project.score.parts
    part = Part(
        id=part_id,
        name=called,
        track=max((part.track for part in parts), default=-1) + 1,
        voice=0,
        channel=free_channel(parts),
        program=next((part.program for part in parts if part.map_id == instrument.id), None),
        instrument=instrument.plays[0] if instrument.plays else None,
        map_id=instrument.id,
        notes=(),
    )
    playing = [maps[player.instrument_id] for player in project.players if player.instrument_id in maps]
    player = newcomer(project, player_id, part, called, [*playing, instrument])
    score = msgspec.structs.replace(project.score, parts=(*parts, part))
    return with_newcomers(replace(project, score=score), (player,)), player_id


def duplicate_players(project: Project, player_ids: Sequence[str]) -> tuple[Project, tuple[str, ...]]:
    """Copy players with their part and corrections but new seeds, each behind its original. Returns the project and the
    new ids."""
    originals = [player for player in project.players if player.id in player_ids]
    new_ids = fresh_player_ids(project, len(originals))
    part_ids = fresh_part_ids(project, len(originals))
    note_ids = iter(fresh_note_ids(project, sum(len(project.part(player).notes) for player in originals)))
    ids = dict(zip((player.id for player in originals), new_ids, strict=True))
    names = project.performer_names()
    copies: dict[str, Player] = {}
    parts: list[Part] = []
    corrections = dict(project.corrections)
    for player, new_id, part_id in zip(originals, new_ids, part_ids, strict=True):
        name = free_name(player.name, names)
        names.append(name)
        parameters = msgspec.structs.replace(player.parameters, seed=player_seed(project.seed, new_id), cue_leader=None)
        copies[player.id] = msgspec.structs.replace(
            player,
            id=new_id,
            name=name,
            part_id=part_id,
            colour="",
            soloed=False,
            parameters=parameters,
            doubles=ids.get(player.doubles, ""),
        )
        part = project.part(player)
        notes = tuple(msgspec.structs.replace(note, id=next(note_ids)) for note in part.notes)
        copied = {one.id: other.id for one, other in zip(part.notes, notes, strict=True)}
        marks = renamed_marks(part.marks, copied)
        parts.append(msgspec.structs.replace(part, id=part_id, name=name, notes=notes, marks=marks))
        if player.id in corrections:
            corrections[new_id] = tuple(moved_correction(correction, copied) for correction in corrections[player.id])
    score = msgspec.structs.replace(project.score, parts=(*project.score.parts, *parts))
    result = with_newcomers(replace(project, score=score, corrections=corrections), tuple(copies.values()))
    order: list[Player] = []
    for player in result.players[: len(project.players)]:
        order.append(player)
        if player.id in copies:
            order.append(result.player(copies[player.id].id))
    on_arc = _on_arc(result)
    result = _with_players(result, order)
    return (arrange(result) if on_arc else result), new_ids


def assign(
    project: Project, player_ids: Collection[str], part_id: str | None = None, instrument_id: str | None = None
) -> Project:
    """Assign players another part or another instrument. Corrections stay; those about notes of the previous part have
    no effect until it is assigned again. An empty part without a player is removed.

    Raises
    ------
    AppError
        There is no such part or instrument.
    """
    if part_id is not None and part_id not in {part.id for part in project.score.parts}:
        raise AppError("player.no_part", part=part_id)
    if instrument_id is not None:
        require_map(instrument_id, all_maps())
    given = {"part_id": part_id, "instrument_id": instrument_id}
    result = change(project, player_ids, **{name: id for name, id in given.items() if id is not None})
    played = {player.part_id for player in result.players}
    former = {player.part_id for player in project.players} - played
    parts = tuple(part for part in result.score.parts if part.notes or part.id not in former)
    if len(parts) == len(result.score.parts):
        return result
    return replace(result, score=msgspec.structs.replace(result.score, parts=parts))


def newcomer(
    project: Project, player_id: str, part: Part, name: str, playing: Sequence[InstrumentMap], doubles: str = ""
) -> Player:
    """Return a new player for a part, cast as in a new piece.

    ``playing`` has the instrument maps of all players, the new one's last; ``doubles`` is the player whose body also
    plays this part, if any.
    """
    there = [(player.character_id, player.stage) for player in project.bodies]
    return Player(
        id=player_id,
        name=name,
        part_id=part.id,
        instrument_id=require_map(part.map_id, [instrument.id for instrument in playing]),
        character_id=newcomers_character(playing[-1], there, years_in_title(project.score.title)),
        parameters=cast_parameters(project, player_id, playing[-1]),
        stage=StagePosition(0.0, 0.0, 0.0),
        doubles=doubles,
        outfit=common_outfit(project),
    )


def remove_players(project: Project, player_ids: Collection[str]) -> Project:
    """Remove players and their corrections. A part from the MIDI file then stays in the score without a player; empty
    parts and parts made in the editor are removed. If a musician's first player is removed, the next one becomes the
    first.
    """
    on_arc = _on_arc(project)
    kept = promote_remaining(player for player in project.players if player.id not in player_ids)
    played = {player.part_id for player in kept}
    left = {player.part_id for player in project.players if player.id in player_ids} - played
    parts = tuple(
        part
        for part in project.score.parts
        if part.id not in left or (part.notes and not part.id.startswith(MADE_PART))
    )
    result = replace(
        project,
        players=kept,
        corrections={id: items for id, items in project.corrections.items() if id not in player_ids},
        takes={id: recorded for id, recorded in project.takes.items() if id not in player_ids},
        ignored_problems={id: items for id, items in project.ignored_problems.items() if id not in player_ids},
    )
    if len(parts) < len(project.score.parts):
        result = replace(result, score=msgspec.structs.replace(project.score, parts=parts))
    return arrange(result) if on_arc else result


def move_players(project: Project, player_ids: Collection[str], before: int) -> Project:
    """Move players in the list, keeping their order, before index ``before``; the stage arc follows the new order."""
    on_arc = _on_arc(project)
    result = _with_players(project, moved_before(project.players, player_ids, before))
    return arrange(result) if on_arc and result is not project else result


def order_players(project: Project, player_ids: Sequence[str]) -> Project:
    """Reorder some players among the list places they occupy; the stage arc follows the new order."""
    on_arc, own = _on_arc(project), iter(player_ids)
    players = (project.player(next(own)) if player.id in player_ids else player for player in project.players)
    result = _with_players(project, players)
    return arrange(result) if on_arc and result is not project else result


def _with_players(project: Project, players: Iterable[Player]) -> Project:
    new = tuple(players)
    return project if new == project.players else replace(project, players=new)


def _each(project: Project, player_ids: Container[str], edit: Callable[[Player], Player]) -> Project:
    """Return the project with ``edit`` applied to the given players; an unchanged player stays the same object."""
    edited = {player.id: edit(player) for player in project.players if player.id in player_ids}
    return _with_players(
        project,
        (player if edited.get(player.id, player) == player else edited[player.id] for player in project.players),
    )


def _with_parameters(player: Player, values: Mapping[str, Value]) -> Player:
    return msgspec.structs.replace(player, parameters=msgspec.structs.replace(player.parameters, **values))


def moved_before(performers: Sequence[P], ids: Container[str], before: int) -> list[P]:
    """Return the performers with those of the given ids moved, in their order, before index ``before``."""
    ahead = [one for one in performers[:before] if one.id not in ids]
    behind = [one for one in performers[before:] if one.id not in ids]
    return [*ahead, *(one for one in performers if one.id in ids), *behind]


def visible_name(name: str) -> str:
    """Return a cleaned name. Raises AppError if it is empty."""
    requested = clean_name(name)[: limits.MOST_NAME]
    if not requested:
        raise AppError("player.no_name")
    return requested


def musicians_of(project: Project, player_ids: Collection[str]) -> frozenset[str]:
    """Return the ids of the musicians who play the parts of the given players."""
    return frozenset(project.musician(player).id for player in project.players if player.id in player_ids)


def postures_of_musician(project: Project, player: Player) -> tuple[Posture, ...]:
    """Return the postures in which a musician can play all their instruments; if there is none, those of the first
    instrument.
    """
    played = [postures_of(one) for one in project.played_by(player)]
    return tuple(one for one in played[0] if all(one in postures for postures in played)) or played[0]


def join(project: Project, player_id: str, musician_id: str) -> Project:
    """Make one musician of two: the musician ``musician_id`` also plays the instrument of ``player_id``, and everything
    that player's body has played.

    Raises
    ------
    AppError
        The instruments cannot be played in one posture, or sound at the same time (see `app.project.doubling`).
    """
    joining, musician = project.player(player_id), project.musician(project.player(musician_id))
    coming = project.played_by(joining) if project.musician(joining) is joining else (joining,)
    if project.musician(joining) is musician:
        return project
    for other in project.played_by(musician):
        for player in coming:
            if not set(postures_of(other)) & set(postures_of(player)):
                raise AppError("doubling.posture", player=player.name, other=other.name)
            clock = project.score.tempo_map
            seconds = together_s([project.part(other).notes], project.part(player).notes, clock)
            if seconds > TOGETHER_S:
                raise AppError("doubling.together", player=player.name, other=other.name, seconds=round(seconds, 1))
    on_arc, ids = _on_arc(project), {player.id for player in coming}
    result = _each(project, ids, lambda player: msgspec.structs.replace(player, doubles=musician.id))
    possible = postures_of_musician(result, result.player(musician.id))
    if musician.parameters.posture not in possible:
        result = set_parameters(result, (musician.id,), posture=possible[0])
    return arrange(result) if on_arc else result


def separate(project: Project, player_ids: Collection[str]) -> Project:
    """Give doubling players a body and place of their own; the character stays."""
    apart = [player for player in project.players if player.id in player_ids and player.doubles]
    on_arc, order = _on_arc(project), [player.id for player in project.players]
    alone = tuple(
        _with_parameters(msgspec.structs.replace(player, doubles=""), {"seed": player_seed(project.seed, player.id)})
        for player in apart
    )
    if not alone:
        return project
    gone = {player.id for player in alone}
    left = replace(project, players=tuple(player for player in project.players if player.id not in gone))
    there = with_newcomers(left, alone)
    result = _with_players(there, [there.player(id) for id in order])
    return arrange(result) if on_arc else result


def with_newcomers(project: Project, newcomers: tuple[Player, ...]) -> Project:
    """Add players for existing parts: on the usual arc if all others are there, else to the right of all other
    performers.
    """
    if len(project.players) + len(newcomers) > limits.MOST_PLAYERS:
        raise AppError("player.too_many", most=limits.MOST_PLAYERS)
    on_arc = _on_arc(project)
    middle_m = sum(player.stage.z_m for player in project.players) / max(len(project.players), 1)
    beside = (dancer.stage for dancer in project.dancers if abs(dancer.stage.z_m - middle_m) < DANCER_ROOM_M)
    there = (*(player.stage for player in project.players), *beside)
    right_m = max((stage.x_m for stage in there), default=-SPACING_M)
    placed = [
        msgspec.structs.replace(player, stage=StagePosition(round(right_m + number * SPACING_M, 3), middle_m, 0.0))
        for number, player in enumerate(sorted(newcomers, key=lambda player: bool(player.doubles)), 1)
    ]
    by_id = {player.id: player for player in placed}
    placed = [by_id[player.id] for player in newcomers]
    result = replace(project, players=(*project.players, *placed))
    return arrange(result) if on_arc else result


def _on_arc(project: Project) -> bool:
    """Return whether all players are at their usual places."""
    return tuple(player.stage for player in project.players) == arc_of(project)


def free_name(requested: str, taken: Iterable[str]) -> str:
    """Return the name, with the next free number added if it is taken."""
    keys = {name.casefold() for name in taken}
    if requested.casefold() not in keys:
        return requested
    stem, _, last = requested.rpartition(" ")
    base = stem if stem and last.isdecimal() else requested
    number = 2
    while f"{base} {number}".casefold() in keys:
        number += 1
    return f"{base} {number}"


def free_channel(parts: Sequence[Part]) -> int:
    """Return a MIDI channel that no part uses, other than the percussion channel; 0 if all are used."""
    used = {part.channel for part in parts}
    return next((channel for channel in range(16) if channel != DRUM_CHANNEL and channel not in used), 0)
