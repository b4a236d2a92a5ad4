"""Small synthetic maps with the key positions of woodwinds that require choices, without files. Fingerings are those of
method books, reduced to the notes that the tests need; written and sounding pitches are equal.

Fingerings are those of method books, reduced to the notes that the tests need; pitches are written as they sound.
"""

from __future__ import annotations

import random
from typing import Any

from instrument_maps.model import Control, Fingering, InstrumentMap, InstrumentName, Range
from tests.support.plan import FRAME

Row = tuple[int, str] | tuple[int, str, str]
"""Pitch, labels of the controls, and optionally tags; the first row of a pitch is the first choice."""


def made(
    id: str, keys: dict[str, str], rows: list[Row], *, levers: str = "", breaks: tuple[int, ...] = (), **more: Any
) -> InstrumentMap:
    """Make a map from ``keys`` (finger by label) and ``rows``; ``levers`` are the labels of levers."""
    controls = tuple(
        Control(label, "lever" if label in levers.split() else "key", "pitch", finger, label=label)
        for label, finger in keys.items()
    )
    ranks: dict[int, int] = {}
    fingerings = []
    for pitch, label, *tags in rows:
        ranks[pitch] = ranks.get(pitch, 0) + 1
        held = {name: 1.0 for name in label.split() if name in keys}
        fingerings.append(Fingering(pitch, ranks[pitch], label, held, tags=tuple(tags[0].split()) if tags else ()))
    low, high = min(ranks), max(ranks)
    return InstrumentMap(
        id=id, name=InstrumentName(id, id), short_name=id, plays=(), transposition_semitones=0,
        range=Range(low, high, low, high),
        controls=controls, fingerings=tuple(sorted(fingerings, key=lambda one: (one.written_pitch, one.rank))),
        breaks=breaks, **FRAME, **more,
    )  # fmt: skip


HOLES = {
    "T": "left.thumb", "L1": "left.index", "L2": "left.middle", "L3": "left.ring",
    "R1": "right.index", "R2": "right.middle", "R3": "right.ring",
}  # fmt: skip


def clarinet() -> InstrumentMap:
    """Clarinet with the keys that both little fingers have, throat notes and the break."""
    keys = HOLES | {
        "R": "left.thumb", "A": "left.index", "Gs": "left.index",
        "LE": "left.little", "LF": "left.little", "LFs": "left.little",
        "RE": "right.little", "RF": "right.little", "RFs": "right.little", "RGs": "right.little",
        "sb": "right.index", "sl": "right.ring",
    }  # fmt: skip
    low, six = "T L1 L2 L3 R1 R2 R3", "R T L1 L2 L3 R1 R2 R3"
    rows: list[Row] = [
        (52, f"{low} LE"), (52, f"{low} RE", "alternate"), (53, f"{low} RF"), (53, f"{low} LF", "alternate"),
        (54, f"{low} LFs"), (54, f"{low} RFs", "alternate"), (55, low), (56, f"{low} RGs"),
        (57, "T L1 L2 L3 R1 R2"), (58, "T L1 L2 L3 R1"), (59, "T L1 L2 L3 R2"), (59, "T L1 L2 L3 R1 sl", "trill"),
        (60, "T L1 L2 L3"), (61, "T L1 L2 L3 sb", "alternate"), (62, "T L1 L2"), (63, "T L1 L2 sb"), (64, "T L1"),
        (65, "T"), (66, "L1"), (66, "T sb", "trill"), (67, "(open)"), (68, "Gs"), (69, "A"),
        (69, "A R1 R2 R3", "held"), (70, "A R"), (70, "A R R1 R2 R3", "held"), (70, "A sb", "trill"),
        (71, f"{six} LE"), (71, f"{six} RE", "alternate"), (72, f"{six} RF"), (72, f"{six} LF", "alternate"),
        (73, f"{six} LFs"), (73, f"{six} RFs", "alternate"), (74, six), (75, f"{six} RGs"),
        (76, "R T L1 L2 L3 R1 R2"), (77, "R T L1 L2 L3 R1"), (78, "R T L1 L2 L3 R2"), (79, "R T L1 L2 L3"),
        (80, "R T L1 L2 L3 sb"), (81, "R T L1 L2"), (82, "R T L1 L2 sb"),
    ]  # fmt: skip
    return made("clarinet", keys, rows, breaks=(71,))


def oboe() -> InstrumentMap:
    """Oboe from C to B flat with three fingerings of F."""
    keys = HOLES | {
        "F": "right.ring", "Eb": "right.little", "C": "right.little", "Cs": "right.little", "LF": "left.little",
        "Gs": "left.little", "LEb": "left.little",
    }  # fmt: skip
    left, all_ = "L1 L2 L3", "L1 L2 L3 R1 R2 R3"
    rows: list[Row] = [
        (60, f"{all_} C"), (61, f"{all_} Cs"), (62, all_), (63, f"{all_} Eb"), (63, f"{all_} LEb", "alternate"),
        (64, f"{left} R1 R2"), (65, f"{left} R1 R2 F"), (65, f"{left} R1 R2 LF", "alternate"),
        (65, f"{left} R1 R3", "forked"), (66, f"{left} R1"), (67, left), (68, f"{left} Gs"), (69, "L1 L2"),
        (70, "L1 L2 R1"),
    ]  # fmt: skip
    return made("oboe", keys, rows)


def saxophone() -> InstrumentMap:
    """Saxophone with the B flats (side, bis, one and one), the F sharps, and the high F with palm keys or front key."""
    keys = HOLES | {
        "8": "left.thumb", "bis": "left.index", "sB": "right.index", "sF": "right.ring", "f": "left.index",
        "pD": "left.index", "pE": "left.middle", "pF": "left.ring", "gs": "left.little", "Eb": "right.little",
    }  # fmt: skip
    del keys["T"]
    rows: list[Row] = [
        (62, "L1 L2 L3 R1 R2 R3"), (63, "L1 L2 L3 R1 R2 R3 Eb"), (64, "L1 L2 L3 R1 R2"), (65, "L1 L2 L3 R1"),
        (66, "L1 L2 L3 R2"), (66, "L1 L2 L3 R1 sF", "alternate"), (67, "L1 L2 L3"), (68, "L1 L2 L3 gs"), (69, "L1 L2"),
        (70, "L1 L2 sB"), (70, "L1 bis", "alternate"), (70, "L1 R1", "alternate"), (71, "L1"), (72, "L2"),
        (73, "(open)"), (74, "8 L1 L2 L3 R1 R2 R3"),
        (75, "8 L1 L2 L3 R1 R2 R3 Eb"), (76, "8 L1 L2 L3 R1 R2"), (77, "8 L1 L2 L3 R1"), (78, "8 L1 L2 L3 R2"),
        (79, "8 L1 L2 L3"), (80, "8 L1 L2 L3 gs"), (81, "8 L1 L2"), (82, "8 L1 L2 sB"), (82, "8 L1 bis", "alternate"),
        (83, "8 L1"), (84, "8 L2"), (85, "8"), (86, "8 pD"), (87, "8 pD pE"), (88, "8 pD pE pF"),
        (88, "8 L2 f", "alternate"),
    ]  # fmt: skip
    return made("saxophone", keys, rows, breaks=(74,))


def double_horn() -> InstrumentMap:
    """Double horn with the F side below written A flat and the B flat side from there on."""
    keys = {"T": "left.thumb", "1": "left.index", "2": "left.middle", "3": "left.ring"}
    sides = {
        60: ("", "T 1 3"), 61: ("1 2 3", "T 2 3"), 62: ("1 3", "T 1 2"), 63: ("2 3", "T 1"), 64: ("1 2", "T 2"),
        65: ("1", "T 1"), 66: ("2", "T 2"), 67: ("", "T"),
        68: ("T 2 3", "2 3"), 69: ("T 1 2", "1 2"), 70: ("T 1", "1"), 71: ("T 2", "2"), 72: ("T", ""),
        73: ("T 2 3", "1 2"), 74: ("T 1 2", "1"), 75: ("T 1", "2"), 76: ("T 2", ""), 77: ("T", "1"),
    }  # fmt: skip
    rows: list[Row] = []
    for pitch, (first, other) in sides.items():
        rows += [(pitch, first or "0"), (pitch, other or "0", "alternate")]
    return made("double_horn", keys, rows, levers="T 1 2 3")


def many_keys() -> InstrumentMap:
    """Instrument with twenty-five keys and eight random fingerings of every note, more than any real woodwind."""
    chance = random.Random(4)
    movers = ("left.little", "right.little", "left.index", "right.index", "left.thumb")
    keys = HOLES | {f"k{number}": chance.choice(movers) for number in range(18)}
    rows: list[Row] = []
    for pitch in range(50, 92):
        labels = {" ".join(sorted(chance.sample(sorted(keys), chance.randint(1, 9)))) for _ in range(8)}
        rows += [(pitch, label, chance.choice(("alternate", "trill", "fast", "forked"))) for label in sorted(labels)]
    return made("many_keys", keys, rows, breaks=(71,))
