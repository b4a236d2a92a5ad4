"""Tables that ``suisou inspect`` prints as text."""

from __future__ import annotations

from collections import Counter
from typing import Any

from app.cli.speech import said, spoken
from app.cli.summary import columns, heads, look_at
from app.performance.fact_sources import FACTS
from app.plan.kinds import BREATH_KINDS

Table = dict[str, Any]
FIRST, FIRST_WORDS = 10, 2
"""Number of fingerings shown for each player, and number shown if labels have several words."""


def tables(file: str, found: Table) -> list[str]:
    """Return the report as text: one line per player, then notes that are not played, and warnings."""
    lines = [
        said(
            "inspect.piece",
            file=file,
            duration_s=found["duration_s"],
            count=len(found["players"]),
            ticks=found["ticks_per_beat"],
            tempo=_tempo(found["tempo"]),
        )
    ]
    if found["players"]:
        lines += ["", *columns([heads("inspect.heads"), *(_row(player) for player in found["players"])])]
        sources = map(_sources_row, found["players"])
        lines += ["", *columns([heads("inspect.source_heads"), *sources], of_numbers=False)]
        people = map(_person_row, found["players"])
        lines += ["", *columns([heads("inspect.person_heads"), *people], of_numbers=False)]
    if found["dancers"]:
        titles = heads("inspect.dancer_heads")
        rows = (
            (one["name"], one["choreography"], one["character"], f"{one['x_m']:.2f}", f"{one['z_m']:.2f}")
            for one in found["dancers"]
        )
        lines += ["", *columns([titles, *rows])]
    if found["left_out"]:
        lines += [
            "",
            said("export_report.excluded"),
            *(f"  {one['player']}: {one['reason']}" for one in found["left_out"]),
        ]
    if found["unplayed"]:
        lines += ["", said("export_report.not_played")]
        lines += [
            f"  {said('export_report.part', name=part['name'], count=part['note_count'], reason=part['reason'])}"
            for part in found["unplayed"]
        ]
    return [*lines, *look_at(found["warnings"], found["ignored_problems"])]


def _tempo(tempos: list[Table]) -> str:
    values = [tempo["bpm"] for tempo in tempos]
    if len(values) <= 1:
        return f"{values[0]:.4g}" if values else "120"
    return said("inspect.tempo_range", slowest=f"{min(values):.4g}", fastest=f"{max(values):.4g}", count=len(values))


def _row(player: Table) -> tuple[str, ...]:
    pitches = [note["pitch"] for note in player["notes"]]
    semitones = player["transposition_semitones"]
    span = "-".join(spoken().pitch(pitch, semitones) for pitch in (min(pitches), max(pitches))) if pitches else "-"
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
    """Return a table row for a player: the name, and how many facts come from each source, the most common first."""
    facts = ([note["sources"][fact] for note in player["notes"]] for fact in FACTS)
    breaths = [breath["source"] for breath in player["breaths"] if BREATH_KINDS[breath["kind"]].draws_air]
    counts = (Counter(sources).most_common() for sources in (*facts, breaths))
    return player["name"], *(
        ", ".join(f"{said(f'fact_source.{source}')} {count}" for source, count in found) or "-" for found in counts
    )


def _person_row(player: Table) -> tuple[str, str, str]:
    """Return a table row for a player: the name, the character and its outfit."""
    title, id = player["character_title"], player["character"]
    colours = ", ".join(player["outfit_colours"].values())
    outfit = player["outfit"] or "-"
    return player["name"], f"{title} ({id})" if title else id, f"{outfit} ({colours})" if colours else outfit


def _fingerings(labels: list[str]) -> str:
    """Return fingering labels as one text; only the first few, with commas, if a label has several words."""
    if not any(" " in label for label in labels):
        return " ".join(labels)
    return ", ".join(labels[:FIRST_WORDS])
