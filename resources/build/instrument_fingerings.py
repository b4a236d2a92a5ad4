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

import itertools
import math
import sys
from collections.abc import Sequence
from functools import partial as partial_of
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
    36: "T6", 37: "T5", 38: "T4", 39: "T3", 40: "T2", 41: "6", 42: "5", 43: "4", 44: "3", 45: "2", 46: "1", 47: "T2",
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
        # two and three valves where none or one serve, and 123 above the staff, are what no one takes
        others = [label for label in others if abs(found[label]) <= 60]
        for rank, label in enumerate((first, *others), start=1):
            tags = _tags(rank, label, first)
            controls = {f"valve_{valve}": 1.0 for valve in label if valve != "0"}
            rows.append(
                {
                    "written_pitch": written,
                    "rank": rank,
                    "label": label,
                    "controls": controls,
                    "cents": round(found[label]),
                    "correction": trumpet_correction(label),
                    "tags": tags,
                }
            )
    return rows


def _tags(rank: int, label: str, first: str) -> list[str]:
    """What a fingering with valves is for; hardly anybody takes one with more valves than the first choice."""
    valves, fewest = (sum(sign in "12345" for sign in one) for one in (label, first))
    if valves > fewest:
        return ["rare"]
    return [] if rank == 1 else ["trill"] if rank == 2 else ["fast"]


class Side(NamedTuple):
    """The slide with some of the triggers worked.

    ``sign`` is their labels, ``tubes`` what each lowers the tube by when alone, ``places`` how many positions the slide
    has, ``partials`` the harmonics in use: above the sixth the valve tubes are stuffy and no one plays them there.
    """

    sign: str
    triggers: tuple[str, ...]
    tubes: tuple[int, ...]
    places: int
    partials: range

    @property
    def semitones(self) -> int:
        """What the valves lower the tube by, by name: a ninth semitone of both together is lost, they give a D."""
        return min(sum(self.tubes), 8)


TENOR_SIDES = (
    Side("", (), (), 7, range(2, HIGHEST_PARTIAL + 1)),
    Side("T", ("trigger",), (TRIGGER_SEMITONES,), 6, range(2, 7)),
)
BASS_SIDES = (
    Side("", (), (), 7, range(1, HIGHEST_PARTIAL + 1)),
    Side("T", ("trigger",), (TRIGGER_SEMITONES,), 6, range(2, 7)),
    Side("G", ("second_trigger",), (4,), 6, range(2, 5)),
    # both: F and G flat tubing together make the D tube
    Side("TG", ("trigger", "second_trigger"), (TRIGGER_SEMITONES, 4), 5, range(2, 4)),
)


def trombone(
    first_choices: dict[int, str] = TROMBONE_FIRST, sides: Sequence[Side] = TENOR_SIDES
) -> list[dict[str, object]]:
    """Rows of a trombone, concert pitch and rank ascending; without arguments of the tenor with F attachment."""
    rows: list[dict[str, object]] = []
    for written, first in first_choices.items():
        found: dict[str, dict[str, object]] = {}
        for side in sides:
            closed_m = TROMBONE_TUBE_M * (1 + sum(2 ** (steps / 12) - 1 for steps in side.tubes))
            for position in range(1, side.places + 1):
                label = f"{side.sign}{position}"
                for partial in side.partials:
                    semitones, deviation = partial_cents(partial)
                    if partial == 11 or 34 - side.semitones + semitones - (position - 1) != written:
                        continue
                    requested_m = TROMBONE_TUBE_M * 2 ** ((34 + semitones + deviation / 100 - written) / 12)
                    place_m = min(max((requested_m - closed_m) / 2, 0.0), SLIDE_TRAVEL_M)
                    cents = 1200 * math.log2(requested_m / (closed_m + 2 * place_m))
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
                    "tags": tags + (_reasons(row, label, written, found) if rank > 1 else []),
                }
            )
    return rows


TRIGGER_TRILLS = {(55, "T6")}
"""Written pitch and place that a trill of the trigger alone reaches: F 3 in the sixth place, G 3 with the trigger."""
FARTHEST_WITH_TRIGGER, FARTHEST_WITHOUT = 3, 5
"""A trigger is taken near, and where the slide alone would be far out."""


def _reasons(row: dict[str, object], label: str, written: int, found: dict[str, dict[str, object]]) -> list[str]:
    """Why a player would take an alternate; "rare" where hardly anybody does."""
    if (written, label) in TRIGGER_TRILLS:
        return ["trill"]
    rare = row["partial"] == 7
    if row["side"].sign:
        near = any(place.isdigit() and int(place) <= FARTHEST_WITHOUT for place in found)
        rare = near or int(label[-1]) > FARTHEST_WITH_TRIGGER
    return ["alternate", *(["rare"] if rare else [])]


def unfamiliar(row: dict[str, object]) -> float:
    """Rank alternates: far places, the trigger high up and the seventh partial are rare."""
    cost = float(row["place"]) * 10 + abs(float(row["cents"])) / 10
    cost += 3 * (row["partial"] == 7)
    if row["side"].sign:
        cost += {2: 0.5, 3: 1.0, 4: 3.0}.get(int(row["partial"]), 8.0)
        cost += 2.0 * (row["side"].sign != "T")
    return cost


class Valves(NamedTuple):
    """A brass instrument with valves, in the pitches its player reads.

    ``fundamental`` is the written pitch of the open tube's first harmonic. ``semitones`` says by sign of the label what
    each valve or lever lowers the tube by when it is alone; ``compensator`` is the valve with which the others lengthen
    the tube in proportion: it sends the air through them once more, or to tubes of their own (a double horn). ``first``
    gives the published first choices; other combinations of at most ``most`` valves follow. ``open_side``
    gives those of a double horn's longer side where the first choice is on the other one.
    """

    fundamental: int
    semitones: dict[str, int]
    first: dict[int, str]
    compensator: str = ""
    most: int = 3
    open_side: dict[int, str] = {}
    partials: range = range(2, HIGHEST_PARTIAL + 1)


def valved(instrument: Valves) -> list[dict[str, object]]:
    """Rows of an instrument with valves, written pitch and rank ascending."""
    signs = list(instrument.semitones)
    sets = [pick for count in range(instrument.most + 1) for pick in itertools.combinations(signs, count)]
    labels = {_label(pick): pick for pick in sets} | {label: _signs(label) for label in instrument.first.values()}
    rows: list[dict[str, object]] = []
    for written, first in sorted(instrument.first.items()):
        found: dict[str, tuple[float, int]] = {}
        kept = (first, instrument.open_side.get(written))
        for label, pick in labels.items():
            ratio = _ratio(instrument, pick)
            lower = sum(instrument.semitones[sign] for sign in pick)
            for partial in instrument.partials:
                cents = 100 * (instrument.fundamental + 12 * math.log2(partial / ratio) - written)
                near = abs(instrument.fundamental + 12 * math.log2(partial) - lower - written) < 0.5
                usable = near and partial not in SKIPPED_PARTIALS and partial not in (13, 14)
                if abs(cents) <= (MOST_OFF_CENTS if label in kept else 40) and (usable or label in kept):
                    found[label] = min(found.get(label, (1e9, 0)), (cents, partial), key=lambda one: abs(one[0]))
        if first not in found:
            raise ValueError(f"written {written}: {first} is no harmonic of its tube")
        others = sorted((label for label in found if label != first), key=lambda label: _rarity(found[label][0], label))
        for rank, label in enumerate((first, *others[:MOST_ALTERNATES]), start=1):
            tags = _tags(rank, label, first)
            if rank > 1 and instrument.compensator == "T" and found[label][1] == 5 and "T" in label:
                tags = ["rare"]
            rows.append({"written_pitch": written, "rank": rank, "label": label, "controls": {}, "correction": {},
                         "cents": round(found[label][0]), "tags": tags})  # fmt: skip
    return rows


MOST_ALTERNATES = 4
MOST_OFF_CENTS = 180
"""A first choice may be so far off where a sum of valves is short, all four without a compensator: slides are drawn."""


def _label(pick: tuple[str, ...]) -> str:
    """Levers before valves; a lever alone or nothing shows the open valves."""
    text = "".join(sorted(pick, key=lambda sign: (sign.isdigit(), sign)))
    return text if any(sign.isdigit() for sign in text) else f"{text}0"


def _signs(label: str) -> tuple[str, ...]:
    return tuple(sign for sign in label if sign != "0")


def _ratio(instrument: Valves, pick: tuple[str, ...]) -> float:
    """How many times the open tube's length a combination is."""
    shares = {sign: 2 ** (instrument.semitones[sign] / 12) - 1 for sign in pick}
    again = shares.pop(instrument.compensator, 0.0)
    return (1 + again) * (1 + sum(shares.values()))


def _rarity(cents: float, label: str) -> float:
    """Players take what is in tune and has few valves."""
    return abs(cents) + 12 * len(_signs(label))


def _shifted(first: dict[int, str], semitones: int) -> dict[int, str]:
    return {written + semitones: label for written, label in first.items()}


HORN_F_FIRST = {
    42: "123", 43: "13", 44: "23", 45: "12", 46: "1", 47: "2", 48: "0", 49: "123", 50: "13", 51: "23", 52: "12",
    53: "1", 54: "2", 55: "0", 56: "23", 57: "12", 58: "1", 59: "2", 60: "0", 61: "12", 62: "1", 63: "2", 64: "0",
    65: "1", 66: "2", 67: "0", 68: "23", 69: "12", 70: "1", 71: "2", 72: "0", 73: "2", 74: "0", 75: "2", 76: "0",
    77: "1", 78: "2", 79: "0", 80: "23", 81: "12", 82: "1", 83: "2", 84: "0",
}  # fmt: skip
"""From written F 3 the chart; below, the same valves on the second harmonic."""
HORN_DOUBLE_FIRST = {
    **{written: label for written, label in HORN_F_FIRST.items() if written < 68},
    49: "T23", 50: "T3",
    68: "T23", 69: "T12", 70: "T1", 71: "T2", 72: "T0", 73: "T23", 74: "T12", 75: "T1", 76: "T2", 77: "T0", 78: "T2",
    79: "T0", 80: "T23", 81: "T12", 82: "T1", 83: "T2", 84: "T0",
}  # fmt: skip
"""The F side up to written G 4, then the B flat side; that too for the low notes that are too sharp with 13 and 123."""
TUBA_FIRST = {
    23: "1234", 24: "134", 25: "234", 26: "124", 27: "14", 28: "24", 29: "4", 30: "23", 31: "12", 32: "1", 33: "2",
    34: "0", 35: "24", 36: "4", 37: "23", 38: "12", 39: "1", 40: "2", 41: "0", 42: "23", 43: "12", 44: "1", 45: "2",
    46: "0", 47: "12", 48: "1", 49: "2", 50: "0", 51: "1", 52: "2", 53: "0", 54: "23", 55: "12", 56: "1", 57: "2",
    58: "0",
}  # fmt: skip
"""On BB flat: of the chart's unordered fingerings that with the fourth valve for 13 and 123, else the simplest."""
BARITONE_FIRST = {
    40: "123", 41: "13", **{written + 12: label for written, label in TUBA_FIRST.items() if written >= 30},
} | {47: "123", 48: "13"}  # fmt: skip
SOUSAPHONE_FIRST = {**_shifted(BARITONE_FIRST, -12)}
EUPHONIUM_FIRST = {written + 12: label for written, label in TUBA_FIRST.items()}
FOUR = {"1": 2, "2": 1, "3": 3, "4": 5}
FIVE = {**FOUR, "5": 4}
TUBA_FIVE_FIRST = {**TUBA_FIRST, 23: "1345", 24: "345", 25: "245", 26: "45", 27: "235"}
"""Without a compensator the fifth valve, of two whole tones, takes the place of sums that are too sharp."""
HORN_PARTIALS = range(2, 17)
VALVED = {
    "horn_F_single": (Valves(36, VALVE_SEMITONES, HORN_F_FIRST, partials=HORN_PARTIALS), 7),
    "horn_double_F_Bb": (
        Valves(
            36,
            {**VALVE_SEMITONES, "T": -5},
            HORN_DOUBLE_FIRST,
            compensator="T",
            partials=HORN_PARTIALS,
            open_side={49: HORN_F_FIRST[49]},
        ),
        7,
    ),
    "euphonium_Bb_bassclef": (Valves(34, FOUR, EUPHONIUM_FIRST, compensator="4"), 0),
    "euphonium_baritone_Bb_treble": (Valves(48, FOUR, _shifted(EUPHONIUM_FIRST, 14), compensator="4"), 14),
    "baritone_Bb": (Valves(48, VALVE_SEMITONES, _shifted(BARITONE_FIRST, 14)), 14),
    "tuba_BBb": (Valves(22, FOUR, TUBA_FIRST, compensator="4"), 0),
    "sousaphone_BBb": (Valves(22, VALVE_SEMITONES, SOUSAPHONE_FIRST), 0),
    "tuba_CC": (Valves(24, FIVE, _shifted(TUBA_FIVE_FIRST, 2)), 0),
    "tuba_Eb": (Valves(27, FOUR, _shifted(TUBA_FIRST, 5), compensator="4"), 0),
    "tuba_F": (Valves(29, FIVE, _shifted(TUBA_FIVE_FIRST, 7)), 0),
}


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
    tables = {
        "trumpet_Bb": (trumpet, 2),
        "trombone_tenor_F_attachment": (trombone, 0),
        "trombone_bass_F_Gb": (partial_of(trombone, BASS_TROMBONE_FIRST, BASS_SIDES), 0),
    } | {name: (partial_of(valved, instrument), shift) for name, (instrument, shift) in VALVED.items()}
    for name in sys.argv[1:] or tables:
        rows, shift = tables[name]
        print(f"# {name}\n{as_toml(rows(), shift)}")
