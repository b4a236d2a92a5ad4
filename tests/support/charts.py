"""Public fingering charts as tables: first choices and alternates for each note."""

from __future__ import annotations

import csv
from collections import defaultdict
from functools import cached_property
from pathlib import Path
from typing import TypeAlias

FOLDER = Path(__file__).parents[1] / "data" / "fingerings"

ByChart: TypeAlias = dict[str, dict[str, int]]
"""Rank by chart and by fingering: 1 for the first choice, 2 to 100 for alternates, 0 without an order."""


class Charts:
    """Charts of one instrument, without contemporary techniques."""

    def __init__(self, name: str) -> None:
        self.path = FOLDER / f"{name}.csv"

    @cached_property
    def notes(self) -> dict[int, ByChart]:
        """Fingerings by written pitch."""
        found: dict[int, ByChart] = defaultdict(lambda: defaultdict(dict))
        with self.path.open(encoding="utf-8") as file:
            for row in csv.DictReader(file):
                found[int(row["written_pitch"])][row["fingering"]][row["source"]] = int(row["rank"])
        return found

    def majority(self, written: int) -> str | None:
        """Return the fingering that most charts give first; None if two are equally frequent."""
        votes = {label: sum(rank == 1 for rank in by.values()) for label, by in self.notes[written].items()}
        most = max(votes.values())
        first = [label for label, count in votes.items() if count == most]
        return first[0] if len(first) == 1 else None
