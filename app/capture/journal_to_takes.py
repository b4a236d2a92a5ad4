"""Conversion of a journal to takes of a project."""

from __future__ import annotations

from collections.abc import Collection
from itertools import count

from app.capture.journal import Journal
from app.capture.loop_passes import passes
from app.score.take import Cleaning, ControllerMapping, Take
from app.score.tempo import TempoMap


def takes_of(
    journal: Journal,
    tempo_map: TempoMap,
    mapping: ControllerMapping,
    name: str,
    start_s: float | None = None,
    taken: Collection[str] = (),
) -> tuple[Take, ...]:
    """Return a take for every pass of the loop in which a note was played, in order; the project assigns the ids.

    Parameters
    ----------
    tempo_map : TempoMap
        Tempo map of the playback.
    mapping : ControllerMapping
        Controllers of the device for breath and bite.
    name : str
        Template of the take's name, with ``{number}``.
    start_s : float, optional
        Requested start of the recording: notes played during the count-in before it are kept in the take, which begins
        there. By default the first known moment.
    taken : collection of str
        Names of existing takes, after whose numbers numbering continues.
    """
    result: list[Take] = []
    numbers = (number for number in count(len(taken) + 1) if name.format(number=number) not in taken)
    syncs = {number: [point for point in journal.syncs if point.pass_ == number] for number in _numbers(journal)}
    for played in passes(journal):
        if not any(message[0] >> 4 == 0x9 and message[2] for message in played.messages):
            continue
        points = syncs[played.number]
        first_us, last_us = round(points[0].position_s * 1e6), round(points[-1].position_s * 1e6)
        if start_s is not None and not result:
            first_us = round(start_s * 1e6)
        result.append(
            Take(
                id="",
                name=name.format(number=next(numbers)),
                colour="",
                device=journal.header.port,
                recorded=journal.header.started,
                mapping=mapping,
                cleaning=Cleaning(),
                tempo_map=tempo_map,
                start_us=first_us,
                end_us=max(last_us, first_us, *played.times_us[-1:]),
                times_us=played.times_us,
                messages=tuple(message.hex() for message in played.messages),
            )
        )
    return tuple(result)


def _numbers(journal: Journal) -> set[int]:
    return {point.pass_ for point in journal.syncs}
