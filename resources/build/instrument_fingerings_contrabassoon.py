"""Prints the table of fingerings of the contrabassoon as its map holds it.

    python -m resources.build.instrument_fingerings_contrabassoon

Up to E 2 they are the bassoon's; from there to C 4 the bassoon's without its whisper key and half hole: the left index
finger is lifted instead, E flat 3 has a key of its own, and from A 3 a vent of the left thumb stays open. What lies
above follows one chart, as do the alternates of the lower notes (the map's ``sources`` name it).
"""

from __future__ import annotations

from resources.build.instrument_fingerings_bassoon import BOTH, LEFT, LOW, RIGHT
from resources.build.instrument_fingerings_bassoon import ROWS as BASSOON
from resources.build.instrument_fingerings_oboe import toml

LIFTED = f"L2 L3 {RIGHT}"
"""Instead of a half hole."""

ROWS: dict[int, tuple[str, tuple[tuple[str, str], ...]]] = {
    **{written: (BASSOON[written][0].replace("Lt_w ", ""), ()) for written in range(34, 41)},
    41: (LOW, ()),
    42: (f"{BOTH} Rt_fis", ((f"{BOTH} Rp_fis", "alternate"),)),
    43: (BOTH, ()),
    44: (f"{BOTH} Rp_gis", ()),
    45: (f"{LEFT} R1 R2", ()),
    46: (f"{LEFT} R1 R2 Rt_bes", ((f"{LEFT} R1 R2 Rr_bes", "trill"),)),
    47: (f"{LEFT} R1", ()),
    48: (LEFT, ()),
    49: (f"Lt_cis {LEFT}", ((f"Lt_cis {LEFT} R2 R3", "alternate"),)),
    50: ("L1 L2", (("L1 L2 R2 R3", "alternate"),)),
    51: ("L1 L2 Lr_es", (("L1 L2 Lr_es R2 R3", "alternate"),)),
    52: ("L1", (("L1 R2 R3", "alternate"),)),
    53: ("(open)", (("R2 R3", "alternate"),)),
    54: (f"{LIFTED} Rt_fis", ((f"{LIFTED} Rp_fis", "alternate"),)),
    55: (LIFTED, ((f"{LIFTED} Lp_es", "alternate"),)),
    56: (f"{LIFTED} Rp_gis", ((f"Lt_c2 {BOTH} Rp_gis", "alternate"),)),
    57: (f"Lt_c2 {LEFT} R1 R2", ()),
    58: (f"Lt_c2 {LEFT} R1 R2 Rt_bes", ()),
    59: (f"Lt_c2 {LEFT} R1", ()),
    60: (f"Lt_c2 {LEFT}", ()),
    61: (f"Lt_cis {LOW}", ()),
    62: (f"Lt_cis {BOTH}", ()),
    63: ("L2 Lt_d2 R1 R2 Rt_bes", ()),
    64: (f"L1 L3 Lp_es Lt_c2 {RIGHT}", ()),
    65: ("L1 L3 Lp_es Lt_d2 R1 R2", ()),
    66: (f"{LIFTED} Lt_d2 Rt_fis", ()),
    67: (f"{LIFTED} Lt_d2", ()),
    68: ("L2 L3 Lp_es Lt_cis R2 R3 Rt_bes", ()),
    69: (f"Lt_c2 Lt_cis {LEFT} R1 R2", ()),
    70: ("L1 L2 Lt_c2 R1 R2 Rp_f", ()),
    71: ("L1 L2 Lr_es Lt_c2 R1 R2 Rp_f", ()),
    72: ("L1 Lt_c2", ()),
}
"""Written pitch -> first choice, then alternates as (keys, tag)."""

if __name__ == "__main__":
    print("\n".join(toml(ROWS)))
