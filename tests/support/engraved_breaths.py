"""Lines of public-domain scores with the breath marks and phrase slurs that are engraved in them."""

from __future__ import annotations

import json
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import msgspec

from app.plan.generate import MonophonicPart
from app.plan.music.piece import Piece, line_times
from app.plan.parameters import PlayerParameters
from app.score.felt_beat import felt_beats
from app.score.metre_map import Metre, MetreMap
from instrument_maps.load import bundled_maps
from tests.support.plan import PlainClock, PlainNote, make_plans, time_frame

FILE = Path(__file__).parents[1] / "data" / "breaths" / "engraved.json"
TICKS = 480
SLUR = 12
"""Ticks by which a slurred note overlaps the next one."""


USUAL = PlayerParameters()


class Agreement(msgspec.Struct, frozen=True):
    """Agreement of the breaths of a line with the marks.

    Attributes
    ----------
    in_rests, at_marks, elsewhere : tuple of int
        Notes before which a breath is taken.
    missed : tuple of int
        Marks without a rest where none is.
    """

    voice: str
    in_rests: tuple[int, ...]
    at_marks: tuple[int, ...]
    elsewhere: tuple[int, ...]
    missed: tuple[int, ...]


@cache
def marked_lines() -> tuple[dict[str, Any], ...]:
    """All lines of a file with breath marks or phrase slurs."""
    return tuple(json.loads(FILE.read_text()))


def agreement(row: dict[str, Any], parameters: PlayerParameters = USUAL) -> Agreement:
    """Plan a line alone and compare its breaths with the marks."""
    slurred = set(row["slurred_to"])
    notes = tuple(
        PlainNote(f"1:{index + 1}", round(onset * TICKS), round(length * TICKS) + SLUR * (index + 1 in slurred), pitch)
        for index, (onset, length, pitch) in enumerate(row["notes"])
    )
    clock = PlainClock(((0, float(row["quarters_per_minute"])),))
    bar, pickup = TICKS * 4 * row["metre"][0] // row["metre"][1], round(row["pickup_quarters"] * TICKS)
    metre_map = MetreMap(TICKS, (Metre(pickup - bar if pickup else 0, *row["metre"]),))
    felt = felt_beats(clock, metre_map, metre_map.bars(-1 if pickup else 0, notes[-1].onset_tick + bar))
    piece = Piece(clock, msgspec.structs.replace(metre_map, felt=felt))
    line = MonophonicPart("1", notes, bundled_maps()[row["instrument"]], parameters)
    plan = make_plans(piece, (line,), time_frame((line,), clock))["1"]
    times = line_times(line, clock)
    number = {note.id: index for index, note in enumerate(notes)}
    breaths = sorted({number[event.id.split(":", 1)[1]] for event in plan.breaths if event.kind == "breath"} - {0})
    rests = {index for index in range(1, len(notes)) if times.silence_tick[index] >= TICKS // 4}
    marks = set(row["breaths_before"]) - rests
    return Agreement(
        row["voice"],
        tuple(index for index in breaths if index in rests),
        tuple(index for index in breaths if index in marks),
        tuple(index for index in breaths if index not in rests | marks),
        tuple(sorted(marks - set(breaths))),
    )


def share_at_phrase_ends(rows: Iterable[dict[str, Any]]) -> float:
    """Share of the breaths after the first that are in rests or at engraved marks."""
    found = [agreement(row) for row in rows]
    right = sum(len(one.in_rests) + len(one.at_marks) for one in found)
    return right / (right + sum(len(one.elsewhere) for one in found))


if __name__ == "__main__":
    for group in (False, True):
        totals = [0, 0, 0, 0]
        for row in marked_lines():
            if row["held_out"] == group:
                found = agreement(row)
                counts = [len(one) for one in (found.in_rests, found.at_marks, found.elsewhere, found.missed)]
                totals = [one + two for one, two in zip(totals, counts, strict=True)]

                def place(index: int, row: dict[str, Any] = row) -> str:
                    bar = 4 * row["metre"][0] / row["metre"][1]
                    onset = row["notes"][index][0] - row["pickup_quarters"]
                    return f"{int(onset // bar) + 1}:{onset % bar + 1:g}"

                print(
                    row["voice"],
                    counts,
                    "elsewhere",
                    *map(place, found.elsewhere),
                    "| at",
                    *map(place, found.at_marks),
                    "| missed",
                    *map(place, found.missed),
                )
        rests, marks, elsewhere, missed = totals
        print(
            "held out" if group else "tuned",
            totals,
            f"{(rests + marks) / (rests + marks + elsewhere):.0%} at phrase ends,",
            f"of the marks without a rest {marks / (marks + missed):.0%} are breathed at",
        )
