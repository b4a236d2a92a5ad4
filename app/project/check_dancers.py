"""Checks dancers and corrections of their dances."""

from __future__ import annotations

from collections.abc import Iterator

from app.project import limits
from app.project.choreography_files import SUFFIX, is_choreography
from app.project.dance_corrections import DanceCorrection, ForbidState, PinState
from app.project.model import DANCER_PARAMETERS, Project
from app.project.performers import Dancer
from app.project.value_checks import (
    Fault,
    about,
    faults_of_bounds,
    id_faults,
    look_faults,
    path_faults,
    text_faults,
    unique,
)


def dancer_faults(project: Project) -> Iterator[Fault]:
    """Yield key path and description of every fault in a project's dancers."""
    dancers, players = project.dancers, project.players
    if len(dancers) > limits.MOST_DANCERS:
        yield "dancers", f"at most {limits.MOST_DANCERS}"
    yield from unique("dancers", (dancer.id for dancer in dancers), taken=(player.id for player in players))
    names = (dancer.name.casefold() for dancer in dancers)
    yield from unique("dancers", names, "name", taken=(player.name.casefold() for player in players))
    for index, dancer in enumerate(dancers):
        yield from about(dancer, _one_dancer_faults(dancer, f"dancers[{index}]"))
    known = {dancer.id: dancer for dancer in dancers}
    for id, corrections in project.dance_corrections.items():
        if id not in known:
            yield f"dance_corrections[{id!r}]", "there is no dancer of this id"
        for index, correction in enumerate(corrections):
            found = _dance_correction_faults(correction, f"dance_corrections[{id!r}][{index}]")
            yield from about(known.get(id), found)


def _one_dancer_faults(dancer: Dancer, place: str) -> Iterator[Fault]:
    yield from id_faults(f"{place}.id", dancer.id)
    yield from id_faults(f"{place}.character_id", dancer.character_id)
    yield from text_faults(f"{place}.name", dancer.name)
    yield from path_faults(f"{place}.choreography", dancer.choreography)
    if not is_choreography(dancer.choreography):
        yield f"{place}.choreography", f"must be the path of a {SUFFIX} file or the name of a bundled choreography"
    yield from look_faults(dancer, place)
    for name, parameter in DANCER_PARAMETERS.items():
        if parameter.bounds is not None:
            yield from faults_of_bounds(f"{place}.{name}", getattr(dancer, name), parameter.bounds)


def _dance_correction_faults(correction: DanceCorrection, place: str) -> Iterator[Fault]:
    ticks = (-limits.LAST_TICK, limits.LAST_TICK)
    if isinstance(correction, ForbidState):
        yield from faults_of_bounds(f"{place}.start_tick", correction.start_tick, ticks)
        yield from faults_of_bounds(
            f"{place}.end_tick", correction.end_tick, (correction.start_tick + 1, limits.LAST_TICK)
        )
    else:
        yield from faults_of_bounds(f"{place}.tick", correction.tick, ticks)
    if isinstance(correction, PinState | ForbidState):
        yield from faults_of_bounds(f"{place}.state", correction.state, limits.CHOREOGRAPHY_INDEX)
    else:
        yield from faults_of_bounds(f"{place}.segment", correction.segment, limits.CHOREOGRAPHY_INDEX)
