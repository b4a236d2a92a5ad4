"""Prints the table of fingerings of the oboe as its map holds it; the English horn reads the same.

    python -m resources.build.instrument_fingerings_oboe

The rows are the one public chart there is (the map's ``sources`` name it) as it stands, with what three texts on the
choice of F add; a test compares them. Left out: what needs keys that the model has not (the chart's Lm_b, and the G
sharp key of the right index, Ri_gis, for which the left little finger has the same cup), and what has the second octave
key without the first plate.
"""

from __future__ import annotations

NAMES = ("C", "C sharp", "D", "E flat", "E", "F", "F sharp", "G", "A flat", "A", "B flat", "B")

LEFT, RIGHT, HALF = "L1 L2 L3", "R1 R2 R3", "L1h L2 L3"
BOTH = f"{LEFT} {RIGHT}"

ROWS: dict[int, tuple[str, tuple[tuple[str, str], ...]]] = {
    58: (f"{BOTH} Lp_bes Rp_c", ()),
    59: (f"{BOTH} Lp_b Rp_c", ()),
    60: (f"{BOTH} Rp_c", ()),
    61: (f"{BOTH} Rp_cis", ()),
    62: (BOTH, ()),
    63: (f"{BOTH} Rp_ees", ((f"{BOTH} Lp_ees", "alternate"),)),
    64: (f"{LEFT} R1 R2", ((f"{LEFT} R1 R2 Lp_gis", "held"), (f"{LEFT} R1 R2 Rp_ees", "trill"))),
    65: (
        f"{LEFT} R1 R2 Rr_f",
        ((f"{LEFT} R1 R2 Lp_f", "alternate"), (f"{LEFT} R1 R3", "forked"), (f"{LEFT} R1 R3 Rp_ees", "trill")),
    ),
    66: (f"{LEFT} R1", ((f"{LEFT} R1 Lp_gis", "held"),)),
    67: (LEFT, ((f"{LEFT} Lp_b", "piano"),)),
    68: (f"{LEFT} Lp_gis", ()),
    69: ("L1 L2", (("L1 L2 Lp_gis", "held"),)),
    70: ("L1 L2 R1", ((f"L1 L2 {RIGHT}", "alternate"), ("L1 L2 R1 Lp_gis", "held"))),
    71: ("L1", ()),
    72: ("L1 R1", ()),
    73: (f"{HALF} {RIGHT} Rp_cis", (("R1", "trill"), ("L3 R2 R3 oct1", "alternate"), ("L1 Rm_cis", "trill"))),
    74: (f"{HALF} {RIGHT}", ((f"L2 L3 {RIGHT}", "alternate"), ("L1 R1 Lr_d", "trill"))),
    75: (f"{HALF} {RIGHT} Rp_ees", ((f"{HALF} {RIGHT} Lp_ees", "alternate"),)),
    76: (
        f"{LEFT} R1 R2 oct1",
        ((f"{LEFT} R1 R2 Lp_gis oct1", "held"), ("L1h L2 L3 R1 R2", "trill"), ("L1h L2 L3 R1 R2 Rp_ees", "trill")),
    ),
    77: (
        f"{LEFT} R1 R2 Rr_f oct1",
        (
            (f"{LEFT} R1 R2 Lp_f oct1", "alternate"),
            (f"{LEFT} R1 R3 oct1", "forked"),
            ("L1h L2 L3 R1 R3 Rp_ees", "trill"),
        ),
    ),
    78: (f"{LEFT} R1 oct1", ((f"{LEFT} R1 Lp_gis oct1", "held"),)),
    79: (f"{LEFT} oct1", ((f"{LEFT} Lp_b oct1", "piano"),)),
    80: (f"{LEFT} Lp_gis oct1", ()),
    81: (
        "L1 L2 oct2",
        (
            (f"{BOTH} oct2", "piano"),
            ("L1 L2 Lp_gis oct2", "held"),
            ("L1 L2 oct1", "trill"),
            ("L1 L2 Lp_gis oct1", "trill"),
        ),
    ),
    82: ("L1 L2 R1 oct2", (("L1 L3 oct2", "forked"),)),
    83: ("L1 oct2", ((f"L1 L3 {RIGHT} oct2", "piano"),)),
    84: ("L1 R1 oct2", (("L2 L3 R1 R2", "alternate"),)),
    85: ("L2 L3 R1 Rp_c", ()),
    86: (f"{HALF} Rp_c", (("L2 L3", "trill"),)),
    87: (f"{HALF} Lp_b R2 R3", ((f"{HALF} oct1", "fast"),)),
    88: (f"{HALF} Lp_gis R2 R3 Rp_ees oct1", (("L1h L2 oct1", "fast"),)),
    89: ("L1h L2 Lp_gis R3 Rp_ees oct1", (("L1h L2 Lp_gis oct1", "fast"),)),
    90: ("L1 L2 R1 R2 Rr_f oct1", ()),
    91: ("L1 L3 R1 oct1", (("L1h L2 R1 oct1", "alternate"),)),
    92: ("L1 R1 oct1", ()),
    93: ("R1 oct1", ()),
}
"""Written pitch -> first choice, then alternates as (keys, tag)."""


def label(keys: str) -> str:
    """The label of a fingering: its signs sorted."""
    return " ".join(sorted(keys.split()))


def toml(rows: dict[int, tuple[str, tuple[tuple[str, str], ...]]]) -> list[str]:
    """Lines of a map."""
    lines = []
    for written, (first, alternates) in rows.items():
        lines.append(f"  # {NAMES[written % 12]} {written // 12 - 1}")
        for rank, (keys, tags) in enumerate([(first, ""), *alternates], start=1):
            more = f", tags = [{', '.join(f'{chr(34)}{tag}{chr(34)}' for tag in tags.split())}]" if tags else ""
            lines.append(f'  {{ written_pitch = {written}, rank = {rank}, label = "{label(keys)}"{more} }},')
    return lines


if __name__ == "__main__":
    print("\n".join(toml(ROWS)))
