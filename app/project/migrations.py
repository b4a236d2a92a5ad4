"""Project files of older versions, brought up to the present one, one version at a time.

A migration is a pure function on the file's decoded JSON; the first takes version 1 to 2, the next 2 to 3 and so on.
Whoever changes what a file holds adds one here, and a sample of the old version to ``tests/data/projects``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final, TypeAlias

Raw: TypeAlias = dict[str, Any]
"""A project file as decoded JSON."""
Migration: TypeAlias = Callable[[Raw], Raw]

VERSION_KEY: Final = "schema_version"


def _with_read_notes(raw: Raw) -> Raw:
    """1 to 2: what the MIDI file held is kept; of an older file nobody knows."""
    return {**raw, "edited_notes": {}}


def _with_transpositions(raw: Raw) -> Raw:
    """2 to 3: how a part that the file has in written pitches was transposed; nobody could say so before."""
    parts = [{**part, "transposed_semitones": 0} for part in raw["score"]["parts"]]
    return {**raw, "score": {**raw["score"], "parts": parts}}


def _with_takes(raw: Raw) -> Raw:
    """3 to 4: takes are kept."""
    return {**raw, "takes": {}}


def _with_markers(raw: Raw) -> Raw:
    """4 to 5: the markers of the MIDI file are kept; a piece that was read before has them when it is read again."""
    return {**raw, "score": {**raw["score"], "markers": []}}


def _with_breath_need(raw: Raw) -> Raw:
    """5 to 6: rests are breathed in as air is needed; before, players breathed in every rest. Where unplayed parts
    sound is kept; a piece that was read before has it when it is read again."""
    unplayed = [{**part, "sounding": []} for part in raw["score"]["unplayed"]]
    players = [{**player, "parameters": {**player["parameters"], "breath_need": 0.0}} for player in raw["players"]]
    return {**raw, "players": players, "score": {**raw["score"], "unplayed": unplayed}}


def _with_dancers(raw: Raw) -> Raw:
    """6 to 7: there are dancers. What percussion strikes is kept; a piece that was read before has it when it is read
    again."""
    return {**raw, "dancers": [], "dance_corrections": {}, "score": {**raw["score"], "percussion": []}}


def _with_body_dances(raw: Raw) -> Raw:
    """7 to 8: players may dance while they play; before, nobody did. Dancers have a weight; they danced as captured."""
    still = {"choreography": "", "dance_amount": 0.5, "dance_variation": 0}
    players = [{**player, "parameters": {**player["parameters"], **still}} for player in raw["players"]]
    dancers = [{**dancer, "weight": 0.0} for dancer in raw["dancers"]]
    return {**raw, "players": players, "dancers": dancers}


def _with_doublings(raw: Raw) -> Raw:
    """8 to 9: a player may share the body of another; before, everybody had one of their own."""
    return {**raw, "players": [{**player, "doubles": ""} for player in raw["players"]]}


MIGRATIONS: Final[tuple[Migration, ...]] = (
    _with_read_notes,
    _with_transpositions,
    _with_takes,
    _with_markers,
    _with_breath_need,
    _with_dancers,
    _with_body_dances,
    _with_doublings,
)
"""In order."""

CURRENT: Final = len(MIGRATIONS) + 1
"""The version that is written."""


def migrated(raw: Raw, version: int, migrations: Sequence[Migration] = MIGRATIONS) -> Raw:
    """The file's content as the present version has it; what is given stays as it is.

    Parameters
    ----------
    version : int
        Of ``raw``, from 1 to ``len(migrations) + 1``.

    Raises
    ------
    KeyError, TypeError, ValueError, IndexError, AttributeError
        The content is not what its version says.
    """
    for number, migration in enumerate(migrations[version - 1 :], version + 1):
        raw = {**migration(raw), VERSION_KEY: number}
    return raw
