"""Measure how often and where players breathe: ``python -m tests.support.breath_measures FOLDER...`` prints tables.
Half of the files, chosen by a hash of their names, are held out from tuning.

Half of the files, chosen by a hash of their names, are held out: nothing is tuned on them.
"""

from __future__ import annotations

import hashlib
import itertools
import sys
import time
from collections import defaultdict
from pathlib import Path

import msgspec
import numpy as np

from app.arrays import IntArray
from app.performance.ensemble import Performance
from app.plan.model import PlayerPlan
from app.plan.music.piece import MonophonicPart, line_times
from app.project.model import map_choices, project_from_score
from app.score.read import read_midi
from instrument_maps.load import bundled_maps

SHORT_S = 1.5
"""Seconds of playing since the previous breath below which a breath is superfluous, unless a long rest causes it."""
GASP_S = 0.2
"""Seconds below which a breath is impossibly short."""


class Measures(msgspec.Struct, frozen=True):
    """Breaths of one player.

    Attributes
    ----------
    instrument : str
    breaths : int
        Those after the first.
    short : int
        After less than `SHORT_S` of sounding notes since the breath before ...
    short_in_rest : int
        ... of which this many stand in rests of two felt beats and more, where every player breathes.
    in_slur : int
        Between notes that overlap or touch with no silence where the track tongues elsewhere by a gap.
    gasps : int
        Shorter than `GASP_S`.
    dropped : int
        For which notes are left out.
    active_s : float
        Time between the first onset and the last end, without rests of more than 4 s.
    """

    instrument: str
    breaths: int
    short: int
    short_in_rest: int
    in_slur: int
    gasps: int
    dropped: int
    active_s: float


def is_held_out(name: str) -> bool:
    """Return whether a file is excluded from tuning."""
    return hashlib.sha256(name.encode()).digest()[0] % 2 == 1


def performance_of(path: Path) -> Performance:
    """Import a MIDI file with default settings."""
    maps = bundled_maps()
    return Performance(project_from_score(read_midi(path, maps=map_choices(maps.values())), maps))


def measures(performance: Performance, line: MonophonicPart, plan: PlayerPlan) -> Measures:
    """Count one player's breaths by their places."""
    times = line_times(line, performance.piece.clock)
    index_of = {note.id: index for index, note in enumerate(line.notes)}
    breaths = [event for event in plan.breaths if event.kind == "breath"]
    places = sorted((event.start_s, index_of[event.id.split(":", 1)[1]], event) for event in breaths)
    before_s = np.concatenate(([0.0], np.cumsum(times.duration_s)))
    long_rest = {event.id.split(":", 1)[1] for event in plan.breaths if event.kind == "preparation"}
    short = in_rest = in_slur = 0
    for (_, earlier, _), (start_s, here, _) in itertools.pairwise(places):
        cut_s = max(float(times.played_end_s[here - 1]) - start_s, 0.0)
        played_s = float(before_s[here] - before_s[earlier]) - cut_s
        in_slur += bool(times.slurs_next[here - 1])
        if played_s < SHORT_S:
            short += 1
            in_rest += line.notes[here].id in long_rest
    gasps = sum(event.end_s - event.start_s < GASP_S - 1e-6 for _, _, event in places[1:])
    dropped = sum("dropped" in event.reason.id for _, _, event in places)
    rests_s = np.maximum(times.onset_s[1:] - times.played_end_s[:-1], 0.0)
    active_s = float(times.played_end_s[-1] - times.onset_s[0] - rests_s[rests_s > 4.0].sum())
    return Measures(line.instrument_map.id, len(places) - 1, short, in_rest, in_slur, gasps, dropped, active_s)


def main(folders: list[str]) -> None:
    """Print the tables."""
    rows: dict[str, list[Measures]] = {}
    for path in sorted(path for folder in folders for path in Path(folder).glob("*.mid")):
        start = time.perf_counter()
        performance = performance_of(path)
        rows[path.name] = [
            measures(performance, line, performance.plans[line.player_id]) for line in performance.parts if line.notes
        ]
        print(f"{path.name}: {time.perf_counter() - start:.1f} s", file=sys.stderr)
    print(f"{'file':48} {'':5} breaths short in-long-rest slur gasps dropped")
    for group in ("tuned", "held out"):
        total = np.zeros(6, int)
        for name, found in rows.items():
            if is_held_out(name) == (group == "held out"):
                sums = np.array(
                    [[m.breaths, m.short, m.short_in_rest, m.in_slur, m.gasps, m.dropped] for m in found]
                ).sum(axis=0)
                total += sums
                print(f"{name[:48]:48} {group[:5]} {_figures(sums)}")
        print(f"{group + ' in all':48} {'':5} {_figures(total)}")
    by_instrument = defaultdict[str, list[Measures]](list)
    for found in rows.values():
        for one in found:
            by_instrument[one.instrument].append(one)
    print("breaths a minute by instrument: mean, least, most")
    for name, found in sorted(by_instrument.items()):
        each = [60.0 * one.breaths / one.active_s for one in found if one.active_s > 20.0]
        if each:
            print(f"{name:32} {np.mean(each):6.1f} {min(each):6.1f} {max(each):6.1f}  ({len(each)} players)")


def _figures(sums: IntArray) -> str:
    return "".join(f"{value:{width}}" for value, width in zip(sums, (7, 6, 13, 5, 6, 8), strict=True))


if __name__ == "__main__":
    main(sys.argv[1:])
