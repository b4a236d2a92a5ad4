"""Prints the table of fingerings of the wind controller (Akai EWI, its own mode of fingering) as its map holds it.

    python -m resources.build.instrument_fingerings_ewi

There is no tube: every key raises or lowers by a half or a whole tone, some of them only with others (`sounding`), and
the left thumb's place between two rollers adds its octave. The rows of one octave are the chart of the mode (the map's
``sources`` name it), low B flat to the open C sharp; the same repeats in seven octaves. What lies in two octaves (C and
C sharp: low with the thumb higher, or high with it lower) is played as on a saxophone: the thumb moves between C sharp
and D.
"""

from __future__ import annotations

from resources.build.instrument_fingerings_oboe import toml

OCTAVES = 7
LOWEST_C = 24
"""The low C of the lowest octave; between the knurled rollers, the third and the fourth, it is C 3."""
LEFT, RIGHT = "L1 L2 L3", "R1 R2 R3"
BOTH = f"{LEFT} {RIGHT}"

CHART: dict[int, tuple[str, tuple[tuple[str, str], ...]]] = {
    -2: (f"{BOTH} Lp2 Rp2 Rp3", ()),
    -1: (f"{BOTH} Lp2 Rp3", ((f"{BOTH} Rp2 Rp3", "alternate"),)),
    0: (f"{BOTH} Rp3", ()),
    1: (f"{BOTH} Rp2", ()),
    2: (BOTH, ()),
    3: (f"{BOTH} Rp1", ()),
    4: (f"{LEFT} R1 R2", ()),
    5: (f"{LEFT} R1", ()),
    6: (f"{LEFT} R2", ((f"{LEFT} R1 Rp1", "trill"),)),
    7: (LEFT, ()),
    8: (f"{LEFT} Lp1", (("L1 L2 R2", "trill"),)),
    9: ("L1 L2", ()),
    10: ("L1 L2 Rs", (("L1 bis", "alternate"), ("L1 R1", "fast"))),
    11: ("L1", ()),
    12: ("L2", ()),
    13: ("(open)", ()),
}
"""Semitones over the octave's low C -> first choice, then alternates as (keys, tag)."""
FIRST_OF_OCTAVE = 2
"""From D the thumb is in the octave above, where there is one below."""


def sounding(keys: set[str]) -> int:
    """What keys sound, in semitones over the low C of the thumb's octave."""
    first, second, little = "L1" in keys, "L2" in keys, "Lp1" in keys
    steps = {
        "L1": -2, "L2": -2 if first else -1, "bis": 0 if first and second else -1, "L3": -2, "Lp1": 1, "Lp2": -1,
        "Rs": 0 if little else 1, "R1": -2 if "L3" in keys else -1, "R2": -1, "R3": -2, "Rp1": 1, "Rp2": -1, "Rp3": -2,
    }  # fmt: skip
    return 13 + sum(step for key, step in steps.items() if key in keys)


def rows() -> dict[int, tuple[str, tuple[tuple[str, str], ...]]]:
    """Concert pitch -> first choice, then alternates."""
    found: dict[int, list[tuple[str, str]]] = {}
    for octave in range(1, OCTAVES + 1):
        for semitones, (first, alternates) in CHART.items():
            away = octave > 1 and semitones < FIRST_OF_OCTAVE
            ways = [(first, "alternate" if away else ""), *(() if away else alternates)]
            place = found.setdefault(LOWEST_C + 12 * (octave - 1) + semitones, [])
            place += [(f"{keys.replace('(open)', '')} o{octave}".strip(), tag) for keys, tag in ways]
    ordered = {pitch: sorted(ways, key=lambda way: way[1] != "") for pitch, ways in sorted(found.items())}
    return {pitch: (ways[0][0], tuple(ways[1:])) for pitch, ways in ordered.items()}


if __name__ == "__main__":
    print("\n".join(toml(rows())))
