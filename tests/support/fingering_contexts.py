"""Short phrases, trills and tremolos with the fingerings that a teacher accepts, and how many of them are planned so.

The table is ``tests/data/fingerings/contexts.csv``; ``contexts_sources.csv`` beside it says what each source is.
An answer is a list of conditions, ``WHERE=ACCEPTED|ACCEPTED; WHERE=...``, all of which must hold; whole lists may
be joined by `` or ``. WHERE is a written pitch (every note of that pitch) or ``@3`` (the third note). ACCEPTED is a
label, or signs that must be in it (``+T``) and must not (``-R1``).

Run as a program, it prints the table of right answers by family: ``python -m tests.support.fingering_contexts``.
"""

from __future__ import annotations

import argparse
import csv
import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from app.plan.fingering.fingerings import plan_fingerings
from app.plan.generate import MonophonicPart
from app.plan.music.piece import line_times
from instrument_maps.load import bundled_maps
from tests.support.plan import PlainClock, line_of

TABLE = Path(__file__).parents[1] / "data" / "fingerings" / "contexts.csv"
SOURCES = TABLE.with_name("contexts_sources.csv")
TICKS_PER_QUARTER = 480
BPM = 120.0
STEPS = {"C": 0, "D": 2, "E": 4, "F": 5, "G": 7, "A": 9, "B": 11}
FAMILIES = {
    "trumpets": ("trumpet_Bb", "trumpet_C", "cornet_Bb", "flugelhorn_Bb"),
    "horns": ("horn_double_F_Bb", "horn_F_single"),
    "trombones": ("trombone_tenor_F_attachment", "trombone_bass_F_Gb"),
    "euphoniums": ("euphonium_Bb_bassclef", "euphonium_baritone_Bb_treble", "baritone_Bb"),
    "tubas": ("tuba_BBb", "tuba_CC", "tuba_Eb", "tuba_F", "sousaphone_BBb"),
    "clarinets": ("clarinet_Bb", "clarinet_A", "clarinet_Eb", "clarinet_bass_Bb"),
    "saxophones": ("sax_soprano_Bb", "sax_alto_Eb", "sax_tenor_Bb", "sax_baritone_Eb"),
    "flutes": ("flute", "piccolo"),
    "oboes": ("oboe", "english_horn"),
    "bassoons": ("bassoon", "contrabassoon"),
    "recorders": ("recorder_soprano_C", "recorder_alto_F"),
}


@dataclass(frozen=True)
class Context:
    """A row of the table: ``pitches`` are written MIDI numbers, ``quarters`` is the length of every note."""

    map: str
    name: str
    notes: tuple[str, ...]
    quarters: float
    gate: float
    answer: str
    source: str
    held_out: bool

    @property
    def family(self) -> str:
        """Family of the row's instrument."""
        return next(name for name, maps in FAMILIES.items() if self.map in maps)


@cache
def contexts() -> tuple[Context, ...]:
    """All rows of the table."""
    with TABLE.open(encoding="utf-8", newline="") as stream:
        return tuple(
            Context(
                row["map"],
                row["context"],
                tuple(row["written_pitches"].split()),
                float(row["note_quarters"]),
                float(row["gate"]),
                row["answer"],
                row["source"],
                row["held_out"] == "yes",
            )
            for row in csv.DictReader(stream)
        )


def written_pitch(name: str) -> int:
    """The MIDI number of a pitch such as ``F#4`` or ``Bb3``."""
    found = re.fullmatch(r"([A-G])(#?)(b?)(-?\d)", name)
    assert found is not None, name
    return STEPS[found[1]] + len(found[2]) - len(found[3]) + 12 * (int(found[4]) + 1)


def planned_labels(context: Context) -> tuple[str, ...]:
    """Labels of the planned fingerings for the notes of a row."""
    instrument = bundled_maps()[context.map]
    step_tick = context.quarters * TICKS_PER_QUARTER
    notes = line_of(
        *(
            (
                round(place * step_tick),
                round(step_tick * context.gate),
                written_pitch(name) - instrument.transposition_semitones,
            )
            for place, name in enumerate(context.notes)
        )
    )
    times = line_times(MonophonicPart("p", notes, instrument), PlainClock(((0, BPM),)))
    return tuple(event.label for event in plan_fingerings(notes, times, instrument, {})[0])


def is_right(context: Context, labels: tuple[str, ...]) -> bool:
    """Return whether labels satisfy one of the answer's lists of conditions."""
    return any(
        all(_holds(condition, context, labels) for condition in conditions.split(";"))
        for conditions in context.answer.split(" or ")
    )


def _holds(condition: str, context: Context, labels: tuple[str, ...]) -> bool:
    where, accepted = (part.strip() for part in condition.split("=", 1))
    if where.startswith("@"):
        places = [int(where[1:]) - 1]
    else:
        places = [place for place, name in enumerate(context.notes) if name == where]
        assert places, (context, where)
    return all(any(_fits(one, labels[place]) for one in accepted.split("|")) for place in places)


def _fits(accepted: str, label: str) -> bool:
    words = accepted.split()
    if not words[0].startswith(("+", "-")):
        return accepted == label
    signs = set(label.split())
    return all((word[1:] in signs) == (word[0] == "+") for word in words)


def right_of(chosen: Iterable[Context]) -> dict[str, tuple[int, int]]:
    """Number of correct rows and number of all rows by family."""
    result: dict[str, tuple[int, int]] = {}
    for context in chosen:
        right, total = result.get(context.family, (0, 0))
        result[context.family] = (right + is_right(context, planned_labels(context)), total + 1)
    return result


def main() -> None:
    """Print the table; with ``--wrong`` also the wrong rows that are not held out."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--wrong", action="store_true", help="list the wrong contexts that are not held out")
    parser.add_argument("--family", choices=FAMILIES, help="only this family")
    parser.add_argument("--held-out", action="store_true", help="count the held out contexts too")
    arguments = parser.parse_args()
    every = [one for one in contexts() if arguments.family in (None, one.family)]
    for held_out in (False, True) if arguments.held_out else (False,):
        counts = right_of(one for one in every if one.held_out == held_out)
        print("held out" if held_out else "tuned")
        for family, (right, total) in counts.items():
            print(f"  {family:12} {right:3} of {total:3}")
        right, total = (sum(column) for column in zip(*counts.values(), strict=True))
        print(f"  {'all':12} {right:3} of {total:3}  {100.0 * right / total:.1f} %")
    if arguments.wrong:
        for context in every:
            labels = planned_labels(context)
            if not context.held_out and not is_right(context, labels):
                shown = list(dict.fromkeys(zip(context.notes, labels, strict=True)))
                print(f"{context.map} | {context.name} | {' ; '.join('='.join(one) for one in shown)}")
                print(f"    expected {context.answer}")


if __name__ == "__main__":
    main()
