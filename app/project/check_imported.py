"""Checks the stored decisions of an import."""

from __future__ import annotations

from collections.abc import Iterator

from app.encoding import is_encoding
from app.project import limits
from app.project.import_decisions import MOST_ROWS, ImportDecisions, RowDecision, TrackMark
from app.project.melody_likeness import SKETCH, SKETCH_BITS
from app.project.value_checks import Fault, faults_of_bounds, id_faults, text_faults
from app.score.model import MOST_VOICES


def import_faults(imported: ImportDecisions) -> Iterator[Fault]:
    """Yield key path and description of every fault in stored import decisions."""
    if imported.encoding is not None and not is_encoding(imported.encoding):
        yield "encoding", "must be the name of a text encoding"
    if len(imported.rows) > MOST_ROWS:
        yield "rows", f"at most {MOST_ROWS}"
    tracks = sum(len(row.tracks) for row in imported.rows)
    if tracks > MOST_ROWS:
        yield "rows", f"at most {MOST_ROWS} tracks"
    for index, row in enumerate(imported.rows):
        yield from _row_faults(row, f"rows[{index}]")


def _row_faults(row: RowDecision, place: str) -> Iterator[Fault]:
    if not row.tracks:
        yield f"{place}.tracks", "must not be empty"
    if len(row.voice_maps) > MOST_VOICES:
        yield f"{place}.voice_maps", f"at most {MOST_VOICES}"
    ids = {f"voice_maps[{voice}]": map_id for voice, map_id in enumerate(row.voice_maps)}
    for field, value in ({"map_id": row.map_id, "character_id": row.character_id} | ids).items():
        if value is not None:
            yield from id_faults(f"{place}.{field}", value)
    yield from text_faults(f"{place}.name", row.name)
    for index, mark in enumerate(row.tracks):
        yield from _mark_faults(mark, f"{place}.tracks[{index}]")


def _mark_faults(mark: TrackMark, place: str) -> Iterator[Fault]:
    for field in ("track", "change"):
        yield from faults_of_bounds(f"{place}.{field}", getattr(mark, field), (0, limits.LAST_TICK))
    yield from faults_of_bounds(f"{place}.channel", mark.channel, (0, 15))
    if mark.program is not None:
        yield from faults_of_bounds(f"{place}.program", mark.program, (0, 127))
    for field in ("name", "instrument_name", "called"):
        yield from text_faults(f"{place}.{field}", getattr(mark, field))
    if len(mark.reported) > limits.MOST_ID:
        yield f"{place}.reported", f"at most {limits.MOST_ID}"
    for index, instrument in enumerate(mark.reported):
        yield from id_faults(f"{place}.reported[{index}]", instrument)
    if len(mark.melody) > SKETCH:
        yield f"{place}.melody", f"at most {SKETCH} numbers"
    for index, number in enumerate(mark.melody):
        yield from faults_of_bounds(f"{place}.melody[{index}]", number, (0, 2**SKETCH_BITS - 1))
