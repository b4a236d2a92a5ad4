"""Prints the tables of fingerings of flute and piccolo, and of the recorders, as their maps hold them.

    python -m resources.build.instrument_fingerings_flute

The rows of the flute are a judgement over three public charts (the map's ``sources`` name them), made by hand: what a
method book teaches first, then what a chart names as well and players use; a test compares the first choices with the
charts' majority and lists every exception. Left out: what charts mark as contemporary technique and what asks one
finger for two places at once. The recorders have one chart, the modern baroque (English) fingering of school
instruments. The charts say nothing of intonation: ``cents`` are 0.
"""

from __future__ import annotations

NAMES = ("C", "C sharp", "D", "E flat", "E", "F", "F sharp", "G", "A flat", "A", "B flat", "B")

LEFT, RIGHT = "L1 L2 L3", "R1 R2 R3"
BOTH = f"T {LEFT} {RIGHT}"
ROWS_OF = dict[int, tuple[str, tuple[tuple[str, str], ...]]]


def _octave(low: int) -> ROWS_OF:
    """From E to C sharp: the same in the first octave and the second."""
    return {
        low: (f"Eb T {LEFT} R1 R2", ((f"Eb TBb {LEFT} R1 R2", "held"),)),
        low + 1: (f"Eb T {LEFT} R1", ((f"Eb TBb {LEFT} R1", "held"), (f"Eb T {LEFT} R1 R3", "trill"))),
        low + 2: (f"Eb T {LEFT} R3", ((f"Eb T {LEFT} R2", "fast trill"), (f"Eb TBb {LEFT} R3", "held"))),
        low + 3: (f"Eb T {LEFT}", ((f"Eb TBb {LEFT}", "held"),)),
        low + 4: (f"Eb G# T {LEFT}", ((f"Eb G# TBb {LEFT}", "held"),)),
        low + 5: ("Eb T L1 L2", (("Eb TBb L1 L2", "held"), ("Eb G# T L1 L2", "held"), ("Eb T L1 L2 R1", "trill"))),
        low + 6: ("Eb L1 TBb", (("Eb T L1 R1", "alternate"), ("Eb L1 T trA#", "trill"), ("Eb G# L1 TBb", "trill"))),
        low + 7: ("Eb T L1", ()),
        low + 8: ("Eb L1", (("Eb L1 R1", "trill"),)),
        low + 9: ("Eb", ()),
    }


# Written pitch -> first choice, then alternates as (keys, tag). T is the thumb's B key, TBb its B flat key.
FLUTE: ROWS_OF = {
    60: (f"C {BOTH}", ((f"C TBb {LEFT} {RIGHT}", "held"),)),
    61: (f"C# {BOTH}", ((f"C# TBb {LEFT} {RIGHT}", "held"),)),
    62: (BOTH, ((f"TBb {LEFT} {RIGHT}", "held"),)),
    63: (f"Eb {BOTH}", ((f"Eb TBb {LEFT} {RIGHT}", "held"),)),
    **_octave(64),
    74: (
        f"T L2 L3 {RIGHT}",
        ((f"TBb L2 L3 {RIGHT}", "held"), ("Eb L1 tr1", "trill"), ("Eb tr1", "trill"), (BOTH, "trill")),
    ),
    75: (f"Eb T L2 L3 {RIGHT}", ((f"Eb TBb L2 L3 {RIGHT}", "held"), ("Eb tr2", "trill"))),
    **_octave(76),
    76: (f"Eb T {LEFT} R1 R2", ((f"Eb TBb {LEFT} R1 R2", "held"), ("Eb T L2 L3 R1 R2", "trill"))),
    77: (
        f"Eb T {LEFT} R1",
        ((f"Eb TBb {LEFT} R1", "held"), (f"Eb T {LEFT} R1 R3", "trill"), ("Eb T L2 L3 R1", "trill")),
    ),
    86: ("Eb T L2 L3", (("Eb L1 tr1", "trill"), ("Eb tr1", "trill"))),
    87: (f"Eb G# {BOTH}", (("Eb L2 L3 T tr2", "trill"), ("Eb tr2", "trill"))),
    88: (
        "Eb T L1 L2 R1 R2",
        (("T L1 L2 R1 R2", "piano"), (f"Eb G# T {LEFT} R1 R2", "trill"), ("Eb T L2 L3 tr1 tr2", "trill")),
    ),
    89: ("Eb T L1 L3 R1", ()),
    90: ("Eb T L1 L3 R3", (("Eb T L1 L3 R2", "fast"),)),
    91: (f"Eb {LEFT}", (("Eb L1 L3 R1", "trill"), ("Eb L1 L3 R3", "trill"))),
    92: ("Eb G# L2 L3", (("Eb G# L2 L3 R2 R3", "piano"),)),
    93: ("Eb T L2 R1", ()),
    94: ("T R1 tr1", (("Eb T R1 tr1", "alternate"),)),
    95: ("T L1 L3 tr2", (("Eb T L1 L3 tr2", "alternate"),)),
    96: (f"G# {LEFT} R1", ((f"Eb G# {LEFT} R1", "alternate"), (f"C G# {LEFT} R1", "alternate"))),
    97: ("C G# L2 R1", (("G# L2 R1", "alternate"),)),
    98: ("C L3 R1 R2 T", (("Eb L3 R1 R2 T", "alternate"),)),
}

# The piccolo has no foot: what closes its keys is left away.
PICCOLO: ROWS_OF = {96: (f"G# {LEFT} R1", ((f"Eb G# {LEFT} R1", "alternate"),))}
PICCOLO_HIGHEST = 96

# Written for the soprano; the alto reads a fourth higher (and sounds as written). Pinched or half closed: h.
RECORDER: ROWS_OF = {
    60: ("lt l1 l2 l3 r1 r2 r3 r4", ()),
    61: ("lt l1 l2 l3 r1 r2 r3 r4h", ()),
    62: ("lt l1 l2 l3 r1 r2 r3", ()),
    63: ("lt l1 l2 l3 r1 r2 r3h", ()),
    64: ("lt l1 l2 l3 r1 r2", ()),
    65: ("lt l1 l2 l3 r1 r3 r4", ()),
    66: ("lt l1 l2 l3 r2 r3", ()),
    67: ("lt l1 l2 l3", ()),
    68: ("lt l1 l2 r1 r2 r3h", (("lt l1 l2 r1 r2", "alternate"),)),
    69: ("lt l1 l2", ()),
    70: ("lt l1 l3 r1", (("lt l1 l3 r1 r2", "alternate"),)),
    71: ("lt l1", (("lt l2 l3", "trill"),)),
    72: ("lt l2", ()),
    73: ("l1 l2", (("l2 l3", "alternate"),)),
    74: ("l2", ()),
    75: ("l2 l3 r1 r2 r3", ()),
    76: ("lth l1 l2 l3 r1 r2", ()),
    77: ("lth l1 l2 l3 r1 r3", ()),
    78: ("lth l1 l2 l3 r2", ()),
    79: ("lth l1 l2 l3", ()),
    80: ("lth l1 l2 r1", ()),
    81: ("lth l1 l2", ()),
    82: ("lth l1 l2 r2 r3 r4h", (("lth l1 l2 r2 r3", "alternate"),)),
    83: ("lth l1 l2 r1 r2", ()),
    84: ("lth l1 r1 r2", ()),
}


ALTO_ABOVE_SOPRANO = 5


def label(keys: str) -> str:
    """The label of a fingering: its signs sorted."""
    return " ".join(sorted(keys.split()))


def rows(table: ROWS_OF, written: int) -> list[tuple[str, tuple[str, ...]]]:
    """Labels and tags of a note, first choice first."""
    first, alternates = table[written]
    return [(label(first), ()), *((label(keys), tuple(tag.split())) for keys, tag in alternates)]


def toml(written: int, found: list[tuple[str, tuple[str, ...]]]) -> list[str]:
    """Lines of the map."""
    lines = [f"  # {NAMES[written % 12]} {written // 12 - 1}"]
    for rank, (keys, tags) in enumerate(found, start=1):
        more = f", tags = [{', '.join(f'{chr(34)}{tag}{chr(34)}' for tag in tags)}]" if tags else ""
        lines.append(f'  {{ written_pitch = {written}, rank = {rank}, label = "{keys}"{more} }},')
    return lines


def main() -> None:
    """Print the tables."""
    alto = {written + ALTO_ABOVE_SOPRANO: row for written, row in RECORDER.items()}
    for name, table in (
        ("flute", FLUTE),
        ("piccolo: where it differs", PICCOLO),
        ("recorder_soprano_C", RECORDER),
        ("recorder_alto_F", alto),
    ):
        print(f"# {name}")
        for written in table:
            print("\n".join(toml(written, rows(table, written))))


if __name__ == "__main__":
    main()
