"""Derives the tables of fingerings of brass instruments from acoustics and a published first choice.

Every combination of valves (or place of the slide) whose tube has a harmonic near the note is a candidate;
the first choices come from a published chart (the map's ``sources`` name it), alternates
follow by how far they are out of tune and how unusual they are. ``python -m resources.build.instrument_fingerings``
prints the tables as the maps hold them; the maps are the truth, and a musician may edit them.

Facts used: the sharpness of valve sums follows from their lengths (1: two semitones, 2: one, 3: three, each
right when alone); the deviation of a harmonic n from equal temperament is 1200 log2(n) less the nearest
semitone, which real bells keep within a few cents up to the twelfth.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

NAMES = ("C", "C sharp", "D", "E flat", "E", "F", "F sharp", "G", "A flat", "A", "B flat", "B")

TRUMPET_FIRST = {
    # written pitch -> valves, from the lowest note; above written C6 the usual extension of the chart
    54: "123", 55: "13", 56: "23", 57: "12", 58: "1", 59: "2", 60: "0", 61: "123", 62: "13", 63: "23", 64: "12",
    65: "1", 66: "2", 67: "0", 68: "23", 69: "12", 70: "1", 71: "2", 72: "0", 73: "12", 74: "1", 75: "2", 76: "0",
    77: "1", 78: "2", 79: "0", 80: "23", 81: "12", 82: "1", 83: "2", 84: "0", 85: "2", 86: "1", 87: "2", 88: "0",
    89: "1",
}  # fmt: skip
TROMBONE_FIRST = {
    36: "T6", 37: "T5", 38: "T4", 39: "T3", 40: "7", 41: "6", 42: "5", 43: "4", 44: "3", 45: "2", 46: "1", 47: "7",
    48: "6", 49: "5", 50: "4", 51: "3", 52: "2", 53: "1", 54: "5", 55: "4", 56: "3", 57: "2", 58: "1", 59: "4",
    60: "3", 61: "2", 62: "1", 63: "3", 64: "2", 65: "1", 66: "3", 67: "2", 68: "3", 69: "2", 70: "1", 71: "2",
    72: "1", 73: "2", 74: "1", 75: "3", 76: "2", 77: "1",
}  # fmt: skip

BASS_TROMBONE_FIRST = {
    29: "6", 30: "5", 31: "4", 32: "3", 33: "2", 34: "1", 35: "TG4", 36: "T6",
    **{pitch: place for pitch, place in TROMBONE_FIRST.items() if 36 < pitch < 75},
}  # fmt: skip
"""The pedal tones, B 1 with both valves, then as on the tenor."""

VALVE_SEMITONES = {"1": 2, "2": 1, "3": 3}
COMBINATIONS = ("0", "2", "1", "12", "3", "23", "13", "123")
THIRD_SLIDE_TRAVEL_M = 0.035
FIRST_SLIDE_TRAVEL_M = 0.020
TRUMPET_TUBE_M = 1.48

TROMBONE_TUBE_M = 2.76
SLIDE_TRAVEL_M = 0.62
TRIGGER_SEMITONES = 5
HIGHEST_PARTIAL = 12
SKIPPED_PARTIALS = (7, 11)


def partial_cents(partial: int) -> tuple[int, float]:
    """Semitones of a harmonic above the fundamental, and its deviation from them in cents."""
    exact = 12 * math.log2(partial)
    semitones = round(exact)
    return semitones, 100 * (exact - semitones)


def valve_sharpness_cents(label: str) -> float:
    """How much sharper valves together are than the sum of their semitones."""
    used = [VALVE_SEMITONES[valve] for valve in label if valve != "0"]
    longer = 1 + sum(2 ** (semitones / 12) - 1 for semitones in used)
    return 100 * sum(used) - 1200 * math.log2(longer)


def trumpet_correction(label: str) -> dict[str, float]:
    """Places of the intonation slides that make a valve sum as long as its semitones ask for."""
    slide = {"12": ("first_slide", FIRST_SLIDE_TRAVEL_M), "13": ("third_slide", THIRD_SLIDE_TRAVEL_M)}
    slide["123"] = slide["13"]
    if label not in slide:
        return {}
    used = [VALVE_SEMITONES[valve] for valve in label]
    missing_m = TRUMPET_TUBE_M * (2 ** (sum(used) / 12) - 1 - sum(2 ** (semitones / 12) - 1 for semitones in used))
    name, travel_m = slide[label]
    return {name: round(min(1.0, missing_m / 2 / travel_m), 3)}


def trumpet() -> list[dict[str, object]]:
    """Rows of the B flat trumpet, written pitch and rank ascending."""
    rows: list[dict[str, object]] = []
    for written, first in TRUMPET_FIRST.items():
        found: dict[str, float] = {}
        for label in COMBINATIONS:
            lowered = sum(VALVE_SEMITONES[valve] for valve in label if valve != "0")
            for partial in range(2, HIGHEST_PARTIAL + 1):
                semitones, deviation = partial_cents(partial)
                if partial not in SKIPPED_PARTIALS and 48 + semitones - lowered == written:
                    cents = deviation + valve_sharpness_cents(label)
                    if label not in found or abs(cents) < abs(found[label]):
                        found[label] = cents
        if first not in found:
            raise ValueError(f"written {written}: {first} is no harmonic of its tube")
        others = sorted(
            (label for label in found if label != first), key=lambda label: abs(found[label]) + 12 * len(label)
        )
        # two and three valves where none or one serve, and 123 above the staff, are what nobody takes
        others = [label for label in others if abs(found[label]) <= 60]
        for rank, label in enumerate((first, *others), start=1):
            controls = {f"valve_{valve}": 1.0 for valve in label if valve != "0"}
            rows.append(
                {
                    "written_pitch": written,
                    "rank": rank,
                    "label": label,
                    "controls": controls,
                    "cents": round(found[label]),
                    "correction": trumpet_correction(label),
                    "tags": [] if rank == 1 else ["trill"] if rank == 2 else ["fast"],
                }
            )
    return rows


def slide_place_m(tube_m: float, semitones: float) -> float:
    """How far the slide is out to lower a tube by so many semitones."""
    return tube_m * (2 ** (semitones / 12) - 1) / 2


class Side(NamedTuple):
    """The slide with some of the triggers worked.

    ``sign`` is their labels, ``semitones`` what they lower the tube by, ``places`` how many positions its slide has,
    ``partials`` the harmonics in use: above the sixth the valve tubes are stuffy and nobody plays them there.
    """

    sign: str
    triggers: tuple[str, ...]
    semitones: int
    places: int
    partials: range


TENOR_SIDES = (
    Side("", (), 0, 7, range(2, HIGHEST_PARTIAL + 1)),
    Side("T", ("trigger",), TRIGGER_SEMITONES, 6, range(2, 7)),
)
BASS_SIDES = (
    Side("", (), 0, 7, range(1, HIGHEST_PARTIAL + 1)),
    Side("T", ("trigger",), TRIGGER_SEMITONES, 6, range(2, 7)),
    Side("G", ("second_trigger",), 4, 6, range(2, 5)),
    # both: F and G flat tubing together make the D tube
    Side("TG", ("trigger", "second_trigger"), 8, 5, range(2, 4)),
)


def trombone(
    first_choices: dict[int, str] = TROMBONE_FIRST, sides: Sequence[Side] = TENOR_SIDES
) -> list[dict[str, object]]:
    """Rows of a trombone, concert pitch and rank ascending; without arguments of the tenor with F attachment."""
    rows: list[dict[str, object]] = []
    for written, first in first_choices.items():
        found: dict[str, dict[str, object]] = {}
        for side in sides:
            tube_m = TROMBONE_TUBE_M * 2 ** (side.semitones / 12)
            for position in range(1, side.places + 1):
                label = f"{side.sign}{position}"
                for partial in side.partials:
                    semitones, deviation = partial_cents(partial)
                    if partial == 11 or 34 - side.semitones + semitones - (position - 1) != written:
                        continue
                    lowered = (position - 1) + deviation / 100
                    place_m = min(max(slide_place_m(tube_m, lowered), 0.0), SLIDE_TRAVEL_M)
                    reached = 12 * math.log2(1 + 2 * place_m / tube_m)
                    cents = 100 * (lowered - reached)
                    if abs(cents) > 25:
                        continue
                    found[label] = {"place": place_m, "cents": cents, "partial": partial, "side": side}
        if first not in found:
            raise ValueError(f"concert {written}: {first} is not in tune anywhere")
        others = sorted((label for label in found if label != first), key=lambda label: unfamiliar(found[label]))
        for rank, label in enumerate((first, *others), start=1):
            row = found[label]
            controls = {"slide": round(float(row["place"]) / SLIDE_TRAVEL_M, 4)}
            if controls["slide"] == 0:
                controls = {}
            controls |= dict.fromkeys(row["side"].triggers, 1.0)
            tags = ["raised"] if row["partial"] in (5, 7, 10) and label not in ("1", "T1") else []
            rows.append(
                {
                    "written_pitch": written,
                    "rank": rank,
                    "label": label,
                    "controls": controls,
                    "cents": round(float(row["cents"])),
                    "correction": {},
                    "tags": tags + (["alternate"] if rank > 1 else []),
                }
            )
    return rows


def unfamiliar(row: dict[str, object]) -> float:
    """Rank alternates: far places, the trigger high up and the seventh partial are rare."""
    cost = float(row["place"]) * 10 + abs(float(row["cents"])) / 10
    cost += 3 * (row["partial"] == 7)
    if row["side"].sign:
        cost += {2: 0.5, 3: 1.0, 4: 3.0}.get(int(row["partial"]), 8.0)
        cost += 2.0 * (row["side"].sign != "T")
    return cost


def as_toml(rows: list[dict[str, object]], transposition: int) -> str:
    """The ``fingerings`` array, one line each, with the note's names as comments."""
    lines = ["fingerings = ["]
    last = None
    for row in rows:
        written = int(row["written_pitch"])
        if written != last:
            concert = written - transposition
            name = f"{NAMES[written % 12]} {written // 12 - 1}"
            heard = "" if not transposition else f", sounds {NAMES[concert % 12]} {concert // 12 - 1} ({concert})"
            lines.append(f"  # {name}{heard}")
            last = written
        parts = [f"written_pitch = {written}", f"rank = {row['rank']}", f'label = "{row["label"]}"']
        for key in ("controls", "correction"):
            if row[key]:
                parts.append(f"{key} = {{ {', '.join(f'{name} = {value}' for name, value in row[key].items())} }}")
        parts.append(f"cents = {row['cents']}")
        if row["tags"]:
            parts.append("tags = [" + ", ".join(f'"{tag}"' for tag in row["tags"]) + "]")
        lines.append(f"  {{ {', '.join(parts)} }},")
    return "\n".join([*lines, "]"])


if __name__ == "__main__":
    print(as_toml(trumpet(), 2))
    print(as_toml(trombone(), 0))
    print(as_toml(trombone(BASS_TROMBONE_FIRST, BASS_SIDES), 0))
