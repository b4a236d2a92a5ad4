"""Prints the table of fingerings of the bassoon as its map holds it; the contrabassoon's begins the same.

    python -m resources.build.instrument_fingerings_bassoon

No public chart of the bassoon is at hand as data. Up to D 4 the rows are the fingerings on which methods and charts for
the Heckel system agree (each hole and key lowers by its step, the register above repeats the one below); from E flat 4
they are cross fingerings of higher harmonics, of which every player has his own: one that is in use is given.
"""

from __future__ import annotations

from resources.build.instrument_fingerings_oboe import toml

LEFT, RIGHT, HALF = "L1 L2 L3", "R1 R2 R3", "L1h L2 L3"
BOTH, LOW = f"{LEFT} {RIGHT}", f"{LEFT} {RIGHT} Rp_f"

ROWS: dict[int, tuple[str, tuple[tuple[str, str], ...]]] = {
    34: (f"Lt_bes Lt_b Lt_c Lt_d Rt_e {LOW}", ()),
    35: (f"Lt_b Lt_c Lt_d Rt_e {LOW}", ()),
    36: (f"Lt_c Lt_d Rt_e {LOW}", ()),
    37: (f"Lt_c Lt_d Lp_des Rt_e {LOW}", ()),
    38: (f"Lt_d Rt_e {LOW}", ()),
    39: (f"Lt_w Lp_es Rt_e {LOW}", ()),
    40: (f"Lt_w Rt_e {LOW}", ()),
    41: (f"Lt_w {LOW}", ()),
    42: (f"Lt_w {BOTH} Rt_fis", ((f"Lt_w {BOTH} Rp_fis", "alternate"),)),
    43: (f"Lt_w {BOTH}", ()),
    44: (f"Lt_w {BOTH} Rp_gis", ((f"Lt_w {BOTH} Rt_gis", "alternate"),)),
    45: (f"Lt_w {LEFT} R1 R2", ((f"Lt_w {LEFT} R1 R2 Rp_gis", "trill"),)),
    46: (f"Lt_w {LEFT} R1 R2 Rt_bes", ()),
    47: (f"Lt_w {LEFT} R1", ((f"Lt_w {LEFT} R1 Rt_bes", "trill"),)),
    48: (f"Lt_w {LEFT}", ((f"Lt_w {LEFT} Rt_bes", "trill"),)),
    49: (f"Lt_cis Lt_w {LEFT}", ((f"Lt_cis {LEFT}", "alternate"),)),
    50: ("Lt_w L1 L2", (("Lt_cis Lt_w L1 L2", "trill"),)),
    51: ("Lt_w L1 L3", ()),
    52: ("Lt_w L1", ()),
    53: ("Lt_w", ()),
    54: (f"Lt_w {HALF} {RIGHT} Rt_fis", ((f"Lt_w {HALF} {RIGHT} Rp_fis", "alternate"),)),
    55: (f"Lt_w {HALF} {RIGHT}", ()),
    56: (f"Lt_w {HALF} {RIGHT} Rp_gis", ((f"Lt_w {HALF} {RIGHT} Rt_gis", "alternate"),)),
    57: (f"{LEFT} R1 R2", ((f"Lt_a {LEFT} R1 R2", "attack"),)),
    58: (f"{LEFT} R1 R2 Rt_bes", ((f"Lt_a {LEFT} R1 R2 Rt_bes", "attack"),)),
    59: (f"{LEFT} R1", ((f"Lt_c2 {LEFT} R1", "attack"), (f"{LEFT} R1 Rt_bes", "trill"))),
    60: (LEFT, ((f"Lt_c2 {LEFT}", "attack"), (f"{LEFT} Rt_bes", "trill"))),
    61: (f"Lt_cis {LEFT}", ()),
    62: ("L1 L2", (("Lt_d2 L1 L2", "attack"), ("Lt_cis L1 L2", "trill"))),
    63: ("L1 L3 R1 R2 R3", ()),
    64: ("L1 L3 Lp_es R1 R2 R3 Rt_bes", ()),
    65: ("L1 L3 Lp_es R1 R2 Rt_bes", ()),
    66: ("L2 L3 Lp_es R1 R2 Rp_f", ()),
    67: ("L2 L3 Lp_es R1 Rp_f", ()),
    68: ("L2 L3 Lp_es Rp_f", ()),
    69: (f"{HALF} R2 R3 Rp_f", ()),
    70: (f"Lt_a {LEFT} R2 Rp_f", ()),
    71: ("Lt_c2 L1 L2 R1 Rp_f", ()),
    72: ("Lt_c2 L1 L2 R1", ()),
    73: ("Lt_c2 L1 L3 R2 Rt_bes", ()),
    74: ("Lt_d2 L2 L3 R1 R2 Rt_bes", ()),
}
"""Written pitch -> first choice, then alternates as (keys, tag)."""

if __name__ == "__main__":
    print("\n".join(toml(ROWS)))
