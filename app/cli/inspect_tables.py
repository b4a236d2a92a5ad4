"""Tables that ``suisou inspect`` prints for people."""

from __future__ import annotations

from collections import Counter
from typing import Any

from app.cli.summary import columns, look_at
from app.messages import filled
from app.messages.pitches import pitch_name
from app.performance.fact_sources import FACTS
from app.plan.kinds import BREATH_KINDS

Table = dict[str, Any]
FIRST, FIRST_WORDS = 10, 2
"""Number of fingerings shown of each player, and of words."""


def tables(file: str, found: Table) -> list[str]:
    """The report for people: one line per player, then what is not played and what to look at."""
    lines = [
        f"{file}: {found['duration_s']:.2f} s, {_counted(len(found['players']), 'player')}, "
        f"{found['ticks_per_beat']} ticks per quarter, tempo {_tempo(found['tempo'])}"
    ]
    if found["players"]:
        head = ("player", "instrument", "notes", "range", "breaths", "cues", "first fingerings")
        lines += ["", *columns([head, *(_row(player) for player in found["players"])])]
        lines += ["", *columns([("from", *FACTS, "breath"), *map(_sources_row, found["players"])], of_numbers=False)]
    if found["dancers"]:
        titles = ("dancer", "choreography", "character", "x m", "z m")
        rows = (
            (one["name"], one["choreography"], one["character"], f"{one['x_m']:.2f}", f"{one['z_m']:.2f}")
            for one in found["dancers"]
        )
        lines += ["", *columns([titles, *rows])]
    if found["left_out"]:
        lines += ["", "excluded:", *(f"  {one['player']}: {one['reason']}" for one in found["left_out"])]
    if found["unplayed"]:
        lines += ["", "not played:"]
        lines += [
            f"  {part['name']} ({_counted(part['note_count'], 'note')}): {part['reason']}" for part in found["unplayed"]
        ]
    return [*lines, *look_at(found["warnings"], found["ignored_problems"])]


def _tempo(tempos: list[Table]) -> str:
    values = [tempo["bpm"] for tempo in tempos]
    if len(values) <= 1:
        return f"{values[0]:.4g}" if values else "120"
    return f"{min(values):.4g} to {max(values):.4g} ({_counted(len(values), 'change')})"


def _row(player: Table) -> tuple[str, ...]:
    pitches = [note["pitch"] for note in player["notes"]]
    span = f"{pitch_name(min(pitches))}-{pitch_name(max(pitches))}" if pitches else "-"
    breaths = sum(BREATH_KINDS[breath["kind"]].draws_air for breath in player["breaths"])
    return (
        player["name"],
        player["instrument"],
        str(len(pitches)),
        span,
        str(breaths),
        str(len(player["cues"])),
        _fingerings([note["fingering_keys"] for note in player["notes"][:FIRST]]),
    )


def _sources_row(player: Table) -> tuple[str, ...]:
    """The number of facts by what they are from, the most common first."""
    facts = ([note["sources"][fact] for note in player["notes"]] for fact in FACTS)
    breaths = [breath["source"] for breath in player["breaths"] if BREATH_KINDS[breath["kind"]].draws_air]
    counts = (Counter(sources).most_common() for sources in (*facts, breaths))
    return player["name"], *(", ".join(f"{source} {count}" for source, count in found) or "-" for found in counts)


def _fingerings(labels: list[str]) -> str:
    """Labels of several words are distinguished by a comma, and are fewer."""
    if not any(" " in label for label in labels):
        return " ".join(labels)
    return ", ".join(labels[:FIRST_WORDS])


def _counted(count: int, what: str) -> str:
    return filled(f"{{count}} {{count:{what}|{what}s}}", {"count": count})
