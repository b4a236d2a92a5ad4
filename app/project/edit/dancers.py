"""Edits of dancers: choreography, place, name and other settings."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

import msgspec

from app.chance import next_seed
from app.encoding import shown
from app.errors import AppError, Message
from app.project import limits
from app.project.casting import DANCER_ROOM_M, ELBOW_M, StagePosition
from app.project.choreography_files import is_bundled_name, is_choreography
from app.project.edit.players import free_name, instrument_of, moved_before, set_parameters, visible_name
from app.project.footprint import footprint
from app.project.ids import fresh_dancer_ids
from app.project.model import DANCER_PARAMETERS, Project
from app.project.performers import Dancer
from app.rig.characters.character_library import our_characters

MOST_IN_ROW: Final = 5
HIDES_M: Final = 0.6
"""Distance in metres sideways within which a dancer hides a player behind from the audience."""


def add_dancer(project: Project, choreography: str | os.PathLike[str], name: str) -> tuple[Project, str]:
    """Add a dancer at a free place in front of the players, with the least used bundled character; returns the project
    and the dancer's id.

    Parameters
    ----------
    choreography : str or path
        A ``.choreography`` file, or the name of a bundled choreography.
    name : str
        Name; a number is added if another performer has it.

    Raises
    ------
    AppError
        The name is empty, there are too many dancers, or the choreography is invalid.
    """
    [dancer_id] = fresh_dancer_ids(project)
    dancer = Dancer(
        id=dancer_id,
        name=free_name(visible_name(name), project.performer_names()),
        choreography=checked_choreography(choreography),
        character_id=_seldom_seen(project),
        stage=StagePosition(0.0, 0.0, 0.0),
    )
    return _with_more(project, [dancer]), dancer_id


def remove_dancers(project: Project, dancer_ids: Collection[str]) -> Project:
    """Remove dancers with their corrections and ignored problems."""
    kept = tuple(dancer for dancer in project.dancers if dancer.id not in dancer_ids)
    if len(kept) == len(project.dancers):
        return project
    corrections = {id: items for id, items in project.dance_corrections.items() if id not in dancer_ids}
    ignored = {id: items for id, items in project.ignored_problems.items() if id not in dancer_ids}
    return replace(project, dancers=kept, dance_corrections=corrections, ignored_problems=ignored)


def duplicate_dancers(project: Project, dancer_ids: Collection[str]) -> tuple[Project, tuple[str, ...]]:
    """Copy dancers with their corrections and seed, so that the copies dance in unison; each is listed after its
    original. Return the project and the new ids.
    """
    originals = [dancer for dancer in project.dancers if dancer.id in dancer_ids]
    new_ids = fresh_dancer_ids(project, len(originals))
    names = project.performer_names()
    copies: dict[str, Dancer] = {}
    corrections = dict(project.dance_corrections)
    for dancer, new_id in zip(originals, new_ids, strict=True):
        names.append(free_name(dancer.name, names))
        copies[dancer.id] = msgspec.structs.replace(dancer, id=new_id, name=names[-1], colour="")
        if dancer.id in corrections:
            corrections[new_id] = corrections[dancer.id]
    result = _with_more(replace(project, dance_corrections=corrections), list(copies.values()))
    order: list[Dancer] = []
    for dancer in project.dancers:
        order.append(result.dancer(dancer.id))
        if dancer.id in copies:
            order.append(result.dancer(copies[dancer.id].id))
    return _with_dancers(result, order), new_ids


def rename_dancer(project: Project, dancer_id: str, name: str) -> Project:
    """Rename a dancer; a number is added if another performer has the name. Raises AppError for an empty name."""
    called = free_name(visible_name(name), project.performer_names(but=dancer_id))
    return _changed(project, (dancer_id,), {"name": called})


def change_dancers(project: Project, dancer_ids: Collection[str], **fields: Any) -> Project:
    """Set fields of `Dancer` (``character_id``, ``delay_beats``, ``mirrored`` ...) for several dancers; numbers are
    clipped. See `rename_dancer`, `set_choreography` and `place_dancers` for the others.
    """
    held = {
        name: DANCER_PARAMETERS[name].held(value) if name in DANCER_PARAMETERS else value
        for name, value in fields.items()
    }
    return _changed(project, dancer_ids, held)


def dancer_edit(field: str, dancer: str) -> Message:
    """Return the name, for the undo history, of a change of a dancer's field."""
    if field in DANCER_PARAMETERS:
        return Message("edit.dancer_parameter", {"parameter": DANCER_PARAMETERS[field].label, "dancer": dancer})
    return Message(f"edit.dancer_{field}", {"dancer": dancer})


def set_choreography(project: Project, dancer_ids: Collection[str], choreography: str | os.PathLike[str]) -> Project:
    """Change the choreography of dancers. Corrections stay; their indices then refer to its motions and segments.
    Raises AppError for an invalid choreography.
    """
    return _changed(project, dancer_ids, {"choreography": checked_choreography(choreography)})


def place_dancers(project: Project, places: Mapping[str, StagePosition]) -> Project:
    """Set the positions on stage of dancers, by dancer id."""
    return _with_dancers(
        project,
        (msgspec.structs.replace(dancer, stage=places.get(dancer.id, dancer.stage)) for dancer in project.dancers),
    )


def move_dancers(project: Project, dancer_ids: Collection[str], before: int) -> Project:
    """Move dancers in the list, keeping their order, before index ``before``; stage places do not change."""
    return _with_dancers(project, moved_before(project.dancers, dancer_ids, before))


def free_places(project: Project, count: int) -> tuple[StagePosition, ...]:
    """Return free places for ``count`` more dancers in front of the players, facing the audience, in rows filled from
    the middle; the first row is the one that hides fewer players.
    """
    taken = [dancer.stage for dancer in project.dancers]
    found: list[StagePosition] = []
    places = _rows(_front_m(project), _hidden(project, 1) < _hidden(project, 0))
    while len(found) < count:
        place = next(places)
        if all(math.hypot(place.x_m - one.x_m, place.z_m - one.z_m) > DANCER_ROOM_M - 1e-6 for one in taken):
            found.append(place)
    return tuple(found)


def _front_m(project: Project) -> float:
    """Return the z coordinate in metres of the first row of dancers, in front of the players' instruments."""
    reaches_m = (
        player.stage.z_m + max(room.left_m, room.right_m, room.ahead_m, ELBOW_M)
        for player in project.players
        for room in [footprint(instrument_of(player))]
    )
    return round(max((reach_m + DANCER_ROOM_M for reach_m in reaches_m), default=0.0), 3)


def _hidden(project: Project, shifted: int) -> int:
    """Return the number of players whom dancers in a first row would hide, shifted by half a place or not (0 or 1)."""
    row_m = [_sideways_m(place, shifted) for place in range(MOST_IN_ROW - shifted)]
    return sum(any(abs(player.stage.x_m - x_m) < HIDES_M for x_m in row_m) for player in project.players)


def _rows(front_m: float, first_shifted: bool) -> Iterator[StagePosition]:
    """Yield possible places of dancers row by row towards the audience, from the middle to both sides, in a staggered
    grid whose first row is shifted by half a place or not. At the edge of the stage they continue in the last row.
    """
    row = 0
    while True:
        z_m = min(front_m + row * DANCER_ROOM_M, limits.STAGE_M[1])
        wide = z_m == limits.STAGE_M[1]
        shifted = int((row + first_shifted) % 2 == 1 and not wide)
        for place in range(int(limits.STAGE_M[1] / DANCER_ROOM_M) if wide else MOST_IN_ROW - shifted):
            yield StagePosition(_sideways_m(place, shifted), round(z_m, 3), 0.0)
        row += 1


def _sideways_m(place: int, shifted: int) -> float:
    """Return the x coordinate in metres of a place of a row, counted from the middle, shifted by half a place or not (0
    or 1).
    """
    x_m = ((place + 1 - shifted) // 2 + 0.5 * shifted) * DANCER_ROOM_M * (1.0 if place % 2 else -1.0)
    return round(x_m, 3) + 0.0


def _with_more(project: Project, dancers: Sequence[Dancer]) -> Project:
    if len(project.dancers) + len(dancers) > limits.MOST_DANCERS:
        raise AppError("dancer.too_many", most=limits.MOST_DANCERS)
    places = free_places(project, len(dancers))
    placed = (msgspec.structs.replace(dancer, stage=place) for dancer, place in zip(dancers, places, strict=True))
    return _with_dancers(project, (*project.dancers, *placed))


def _with_dancers(project: Project, dancers: Iterable[Dancer]) -> Project:
    new = tuple(dancers)
    return project if new == project.dancers else replace(project, dancers=new)


def _changed(project: Project, dancer_ids: Collection[str], fields: Mapping[str, Any]) -> Project:
    return _with_dancers(
        project,
        (
            msgspec.structs.replace(dancer, **fields) if dancer.id in dancer_ids else dancer
            for dancer in project.dancers
        ),
    )


def checked_choreography(choreography: str | os.PathLike[str]) -> str:
    """Return a choreography in stored form: a bundled name, or the absolute path of a file. Raises AppError if it is
    invalid.
    """
    text = os.fspath(choreography)
    if is_bundled_name(text):
        return text
    path = os.path.abspath(text)  # noqa: PTH100 - a symbolic link is what the user chose
    if not is_choreography(path) or len(path) > limits.MOST_TEXT:
        raise AppError("dancer.no_choreography", file=shown(text))
    return path


def _seldom_seen(project: Project) -> str:
    seen = Counter(player.character_id for player in project.players)
    seen.update(dancer.character_id for dancer in project.dancers)
    return min(our_characters(), key=lambda id: seen[id])


def set_body_dance(project: Project, player_ids: Collection[str], choreography: str | os.PathLike[str]) -> Project:
    """Set the choreography that players' bodies dance while they play: a bundled name or a file. Empty for the
    generated motion only.

    Raises
    ------
    AppError
        The choreography is invalid.
    """
    chosen = checked_choreography(choreography) if os.fspath(choreography) else ""
    return set_parameters(project, player_ids, choreography=chosen)


def vary_body_dances(project: Project, player_ids: Collection[str]) -> Project:
    """Give each of these players a different dance to the same music."""
    for player in project.players:
        if player.id in player_ids:
            # 0 would select the player's usual dance.
            variation = next_seed(player.id, player.parameters.dance_variation) or 1
            project = set_parameters(project, (player.id,), dance_variation=variation)
    return project
