"""Migration of project files of older versions to the current one, version by version.

A migration is a pure function on the decoded JSON; the first one converts version 1 to 2. To change the format, add a
migration to `STRUCTURE` and a sample file to ``tests/data/projects``; a new parameter only needs its first version in
its declaration.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final, TypeAlias

from app.plan.parameters import PARAMETERS
from app.project.model import DANCER_PARAMETERS

Raw: TypeAlias = dict[str, Any]
"""A project file as decoded JSON."""
Migration: TypeAlias = Callable[[Raw], Raw]

VERSION_KEY: Final = "schema_version"


def _with_transpositions(raw: Raw) -> Raw:
    """Migrate version 2 to 3: parts store the transposition that was applied if the file has written pitches; 0 in
    older files.
    """
    parts = [{**part, "transposed_semitones": 0} for part in raw["score"]["parts"]]
    return {**raw, "score": {**raw["score"], "parts": parts}}


def _with_unplayed_sounding(raw: Raw) -> Raw:
    """Migrate version 5 to 6: unplayed parts store the spans in which they sound; empty until the MIDI file is read
    again.
    """
    unplayed = [{**part, "sounding": []} for part in raw["score"]["unplayed"]]
    return {**raw, "score": {**raw["score"], "unplayed": unplayed}}


def _with_dancers(raw: Raw) -> Raw:
    """Migrate version 6 to 7: dancers and percussion hits are stored; the hits are empty until the MIDI file is read
    again.
    """
    return {**raw, "dancers": [], "dance_corrections": {}, "score": {**raw["score"], "percussion": []}}


def _with_section_intensity(raw: Raw) -> Raw:
    """Migrate version 9 to 10: a factor for everyone's acting is stored, 1 in older files. Added gestures may be named
    ones.
    """
    corrections = {
        player: [{**item, "gesture": ""} if item["correction"] == "add_gesture" else item for item in items]
        for player, items in raw["corrections"].items()
    }
    return {**raw, "section_intensity": 1.0, "corrections": corrections}


def _with_takers(raw: Raw) -> Raw:
    """Migrate version 10 to 11: a cue may list the players it brings in, style spans and a conductor may exist. In
    older files a cue brings in all who enter, and players give all entries.
    """
    corrections = {
        player: [{**item, "takers": None} if item["correction"] == "set_cue" else item for item in items]
        for player, items in raw["corrections"].items()
    }
    return {**raw, "corrections": corrections, "conductor": None}


def _with_video_and_pins(raw: Raw) -> Raw:
    """Migrate version 11 to 12: a reference video may exist; the recording may have pinned beats and doubtful bars."""
    audio = raw["audio"]
    return {**raw, "video": None, "audio": None if audio is None else {**audio, "pins": [], "doubts": []}}


def _with_parameters(raw: Raw, version: int) -> Raw:
    """Add parameters of players and dancers introduced in a version."""
    of_players, of_dancers = (
        {name: parameter.in_older_files for name, parameter in table.items() if parameter.since == version}
        for table in (PARAMETERS, DANCER_PARAMETERS)
    )
    if of_players:
        players = [{**player, "parameters": {**player["parameters"], **of_players}} for player in raw["players"]]
        raw = {**raw, "players": players}
    return {**raw, "dancers": [{**dancer, **of_dancers} for dancer in raw["dancers"]]} if of_dancers else raw


def _with_stopped(raw: Raw) -> Raw:
    """Migrate version 14 to 15: parts store hand-stopped spans and marks, empty until the MIDI file is read again;
    corrections may set marks. Older imports neither interpret words such as "solo" nor clean takes.
    """
    parts = [{**part, "stopped": [], "marks": [], "source": "sound"} for part in raw["score"]["parts"]]
    imported = raw["imported"]
    if imported is not None:
        new = {"solos": False, "clean": False, "voice_maps": []}
        imported = {**imported, "rows": [{**row, **new} for row in imported["rows"]]}
    return {**raw, "score": {**raw["score"], "parts": parts}, "imported": imported}


def _with_outfits(raw: Raw) -> Raw:
    """Migrate version 16 to 17: players and dancers may have an outfit; in older files they wear their own clothes."""
    return {
        **raw,
        "players": [{**player, "outfit": {}} for player in raw["players"]],
        "dancers": [{**dancer, "outfit": {}} for dancer in raw["dancers"]],
    }


STRUCTURE: Final[Mapping[int, Migration]] = {
    # Original notes of the MIDI file are stored since version 3; in an older project they are unknown.
    2: lambda raw: {**raw, "edited_notes": {}},
    3: _with_transpositions,
    4: lambda raw: {**raw, "takes": {}},
    # Markers of the MIDI file are stored; an older project gets them when the file is read again.
    5: lambda raw: {**raw, "score": {**raw["score"], "markers": []}},
    6: _with_unplayed_sounding,
    7: _with_dancers,
    # A player may share the body of another; before, each player had its own.
    9: lambda raw: {**raw, "players": [{**player, "doubles": ""} for player in raw["players"]]},
    # Corrections may contain curves drawn by the animator; an older project has none.
    10: _with_section_intensity,
    11: _with_takers,
    12: _with_video_and_pins,
    # Decisions of the import, controllers and timing of the MIDI file are stored; for an older project they are derived
    # from its parts when the file is read again.
    14: lambda raw: {**raw, "imported": None, "edited_curves": {}, "read_timing": None},
    15: _with_stopped,
    17: _with_outfits,
}
"""Functions that convert a project file, by the version that they produce. New parameters state the version since which
they exist.
"""


def _migration(version: int) -> Migration:
    def migration(raw: Raw) -> Raw:
        structure = STRUCTURE.get(version)
        return _with_parameters(raw if structure is None else structure(raw), version)

    return migration


CURRENT: Final = max(
    *STRUCTURE, *(parameter.since for table in (PARAMETERS, DANCER_PARAMETERS) for parameter in table.values())
)
"""Version of the project format that is written."""
MIGRATIONS: Final = {version: _migration(version) for version in range(2, CURRENT + 1)}


def migrated(raw: Raw, version: int, migrations: Mapping[int, Migration] = MIGRATIONS) -> Raw:
    """Return the content migrated to the current version; the argument is not modified.

    Parameters
    ----------
    version : int
        Version of ``raw``, from 1 to the last one the migrations support.

    Raises
    ------
    KeyError, TypeError, ValueError, IndexError, AttributeError
        The content does not match its version.
    """
    for number in range(version + 1, max(migrations) + 1):
        raw = {**migrations[number](raw), VERSION_KEY: number}
    return raw
