"""Comparison of the program's MusicXML reader with two others, music21 and partitura, each in a separate Python.
`./test` installs a Python with both readers and names it in `SUISOU_NOTATION_PYTHON`. The comparison covers onsets,
ends (so that ties are joined), sounding pitches, slurs, and the order in which measures are played. Onsets are those of
the written score, each measure once; repeats show in the order of measures.

`./test` sets the Python with both readers up and names it in `SUISOU_NOTATION_PYTHON`. Compared are onsets, ends (so
that ties are joined), sounding pitches, slurs, and the order in which measures are played. Onsets are those of the
score as it is written, each measure once: the order says the rest.
"""

from __future__ import annotations

import json
import math
import os
import subprocess
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import accumulate
from pathlib import Path
from typing import Any, Final, NamedTuple

from app.score.musicxml.bars import measure_lengths
from app.score.musicxml.container import read_document
from app.score.musicxml.notes import read_measures, ticks_per_quarter
from app.score.musicxml.parts import written_parts
from app.score.musicxml.played import played_part
from app.score.musicxml.repeats_and_jumps import playing_order
from app.score.musicxml.written import Bar, Place

ROOT: Final = Path(__file__).parents[2]
DATA: Final = ROOT / "tests/data/musicxml"
EXAMPLES: Final = ROOT / "resources/examples"
READERS: Final = ("music21", "partitura")
NEAR: Final = 0.02
"""Tolerance in quarters, since some readers round tuplets."""


class Read(NamedTuple):
    """Result of a reader, with times in quarters.

    Attributes
    ----------
    notes : list of (onset, pitch, end)
    slurs : list of (onset, onset)
        Of the first and the last note.
    order : list of int, or str
        Places of measures as they are played; why there is none.
    error : str
        Why nothing was read.
    """

    notes: list[tuple[float, ...]]
    slurs: list[tuple[float, ...]]
    order: list[int] | str
    error: str = ""


def ours(path: Path) -> Read:
    """Read a score with the program's reader."""
    root, _ = read_document(path)
    place = Place(str(path))
    quarter = ticks_per_quarter(root)
    bars: list[Bar] = []
    parts = [read_measures(part, bars, quarter, place)[0] for part in written_parts(root, place)]
    measure_lengths(bars, parts, quarter)
    starts = list(accumulate((bar.length for bar in bars), initial=0))[:-1]
    notes: list[tuple[float, ...]] = []
    slurs: set[tuple[float, ...]] = set()
    for measures in parts:
        played = played_part(measures, [[start] for start in starts])
        notes += [
            (note.onset / quarter, note.tone.pitch, note.end / quarter)
            for note in played.notes
            if not note.chord.grace and not note.tone.struck
        ]
        slurs |= {
            (first.onset / quarter, last.onset / quarter)
            for first, last in played.slurs
            if not first.chord.grace and not last.chord.grace
        }
    return Read(sorted(notes), sorted(slurs), list(playing_order(bars, str(path)).measures))


def python_of_readers() -> str:
    """Path of the Python with both readers; empty if there is none."""
    return os.environ.get("SUISOU_NOTATION_PYTHON", "")


@cache
def corpus() -> Path:
    """Folder of music21's package, which contains scores from many programs."""
    code = "import importlib.util as u; print(u.find_spec('music21').submodule_search_locations[0])"
    found = subprocess.run([python_of_readers(), "-c", code], capture_output=True, text=True, check=True)
    return Path(found.stdout.strip())


def others(reader: str, paths: Sequence[Path]) -> Iterator[Read]:
    """Yield another reader's result for each of some files."""
    command = [python_of_readers(), str(Path(__file__).with_name("notation_readers.py")), reader, *map(str, paths)]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    rows: list[dict[str, Any]] = [json.loads(line) for line in found.stdout.splitlines()]
    assert [row["file"] for row in rows] == [str(path) for path in paths], found.stderr[-2000:]
    for row in rows:
        yield Read(
            # Quarter tones are played at the nearest semitone.
            sorted((onset, math.floor(pitch + 0.5), end) for onset, end, pitch in row.get("notes", ())),
            sorted({tuple(slur) for slur in row.get("slurs", ())}),
            row.get("order", []),
            row.get("error", ""),
        )


def differences(own: Read, other: Read) -> set[str]:
    """Kinds of contents that two readers read differently: "error", "notes", "ends", "slurs", "order"."""
    if other.error:
        return {"error"}
    found = set()
    if not _near([note[:2] for note in own.notes], [note[:2] for note in other.notes]):
        found.add("notes")
    elif not _near(own.notes, other.notes):
        found.add("ends")
    if not _near(own.slurs, other.slurs):
        found.add("slurs")
    if own.order != other.order:
        found.add("order")
    return found


def _near(rows: Sequence[tuple[float, ...]], others: Sequence[tuple[float, ...]]) -> bool:
    """Return whether rows are equal except for rounding."""
    # Sorted by rounded values, so that differently rounded values keep their order.
    mine, theirs = (sorted(each, key=lambda row: [round(value * 8) for value in row]) for each in (rows, others))
    return len(mine) == len(theirs) and all(
        abs(one - other) < NEAR
        for row, own in zip(mine, theirs, strict=True)
        for one, other in zip(row, own, strict=True)
    )
