"""Comparison of the plans of a played file and its engraved one: players, fingerings and breaths.

    python -m tests.support.played_measures FOLDER [SEED]

prints a row for every MIDI file of a folder. A note of the one file is that of the other by track, pitch and its turn
among the notes of this pitch. A breath is the same if it comes before the same note. No player breathes within a slur:
breaths of the engraved file before notes that the played version slurs to are counted too, and the share of the others.
"""

from __future__ import annotations

import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from app.performance.ensemble import Performance
from app.plan.music.piece import slurs_next
from app.project.model import map_choices, project_from_score
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.support.played import Manner, played

MANNER: Final = Manner(
    overlap_s=(0.020, 0.060),
    early_or_late_s=0.015,
    graced=0.0,
    key_switches=False,
    controllers=(11,),
    rubato=0.0,
    arched=None,
)
_Key = tuple[int, int, int]


class Planned(NamedTuple):
    """Plan of a file, indexed by its notes.

    Attributes
    ----------
    players : Counter
        Of (track, instrument map).
    fingerings : dict
    breaths : set
        The notes before which someone breathes in, after the first of each player.
    warnings : Counter
        By message id.
    slurred_to : set
        Notes to which the note before is slurred.
    """

    players: Counter[tuple[int, str]]
    fingerings: dict[_Key, str]
    breaths: set[_Key]
    warnings: Counter[str]
    slurred_to: set[_Key]


def planned(path: Path) -> Planned:
    """Plan a file."""
    maps = bundled_maps()
    score = read_midi(path, maps=map_choices(maps.values()))
    performance = Performance(project_from_score(score, maps))
    rows, breaths, slurred_to, own = [], set(), set(), {}
    for player in performance.project.players:
        part = performance.project.part(player)
        plan = performance.plan(player)
        labels = {event.note_id: event.label for event in plan.fingerings}
        breaths |= {event.id.removeprefix("breath:") for event in plan.breaths if event.kind == "breath"}
        breaths -= {note.id for note in part.notes[:1]}
        ends = np.array([(note.onset_tick, note.onset_tick + note.duration_tick) for note in part.notes], np.int64)
        slurred = slurs_next(*ends.reshape(-1, 2).T).tolist()
        slurred_to |= {note.id for note, is_slurred in zip(part.notes[1:], slurred, strict=False) if is_slurred}
        rows += [
            (part.track, note.pitch, note.onset_tick, note.id, labels[note.id])
            for note in part.notes
            if note.id in labels
        ]
    turns: Counter[tuple[int, int]] = Counter()
    fingerings = {}
    for track, pitch, _, id_, label in sorted(rows):
        key = track, pitch, turns[track, pitch]
        turns[track, pitch] += 1
        own[id_], fingerings[key] = key, label
    players = Counter((part.track, part.map_id) for part in score.parts)
    warnings = Counter(warning.id for warning in score.warnings)
    breaths, slurred_to = ({own[id_] for id_ in ids if id_ in own} for ids in (breaths, slurred_to))
    return Planned(players, fingerings, breaths, warnings, slurred_to)


def main(folder: Path, seed: int) -> None:
    """Print the table."""
    print(
        "file, players engraved, played, same; notes, same fingering %; breaths engraved, played, "
        "at the same note %, slurred to, of the others %"
    )
    total = [0] * 9
    for path in sorted(folder.glob("*.mid")):
        engraved = planned(path)
        with tempfile.TemporaryDirectory() as temporary:
            copy = Path(temporary) / path.name
            copy.write_bytes(played(path, seed, MANNER))
            again = planned(copy)
        same = sum(again.fingerings.get(key) == label for key, label in engraved.fingerings.items())
        common = len(engraved.breaths & again.breaths)
        figures = [
            engraved.players.total(), again.players.total(), (engraved.players & again.players).total(),
            len(engraved.fingerings), same, len(engraved.breaths), len(again.breaths), common,
            len(engraved.breaths & again.slurred_to),
        ]  # fmt: skip
        total = [one + other for one, other in zip(total, figures, strict=True)]
        print(_row(path.stem, figures), dict(again.warnings - engraved.warnings) or "", flush=True)
    print(_row("all", total))


def _row(name: str, figures: list[int]) -> str:
    before, after, both, notes, same, engraved, found, common, slurred = figures
    return (
        f"{name[:40]:40} {before:3} {after:3} {both:3}; {notes:6} {100 * same / max(notes, 1):6.2f}; "
        f"{engraved:5} {found:5} {100 * common / max(engraved, 1):6.1f} {slurred:5} "
        f"{100 * common / max(engraved - slurred, 1):6.1f}"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0)
