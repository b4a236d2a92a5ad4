"""Prints the tables of fingerings of the clarinets as their maps hold them.

    python -m resources.build.instrument_fingerings_clarinet

The rows are a judgement over four public charts (the map's ``sources`` name them), made by hand: what a method book
teaches first, then what the charts name as well and a player uses; a test compares the first choices with the charts'
majority and lists every exception. Left out: what the charts mark as contemporary technique, what asks one finger for
two places at once (G sharp key with the first hole), and the errors the charts' list names. The charts say nothing of
intonation: ``cents`` are 0.
"""

from __future__ import annotations

NAMES = ("C", "C sharp", "D", "E flat", "E", "F", "F sharp", "G", "A flat", "A", "B flat", "B")

LEFT, RIGHT = "L1 L2 L3", "R1 R2 R3"
BOTH = f"{LEFT} {RIGHT}"

# Written pitch -> first choice, then alternates as (keys, tag). T is the thumb's hole, R the register key.
ROWS: dict[int, tuple[str, tuple[tuple[str, str], ...]]] = {
    52: (
        f"T {BOTH} LE",
        ((f"T {BOTH} RE", "alternate"), (f"T {BOTH} LE RF", "held"), (f"T {BOTH} LF# RE", "held")),
    ),
    53: (f"T {BOTH} RF", ((f"T {BOTH} LF", "alternate"), (f"T {BOTH} LF# RF", "trill"))),
    54: (f"T {BOTH} LF#", ((f"T {BOTH} RF#", "alternate"),)),
    55: (f"T {BOTH}", ()),
    56: (f"T {BOTH} RG#", ((f"T {BOTH} LF# RG#", "trill"),)),
    57: (f"T {LEFT} R1 R2", ((f"T {LEFT} R1 R2 RG#", "trill"),)),
    58: (f"T {LEFT} R1", ((f"T {LEFT} R1 RG#", "trill"),)),
    59: (f"T {LEFT} R2", ((f"T {LEFT} R1 RB", "trill chromatic"),)),
    60: (f"T {LEFT}", ()),
    61: (f"T {LEFT} LC#", ()),
    62: ("T L1 L2", (("T L1 L2 LC#", "trill"),)),
    63: ("T L1 L2 S4", (("T L1 L2 LEb", "alternate"), ("T L1 R1", "forked"))),
    64: ("T L1", ()),
    65: ("T", (("T S4", "held"),)),
    66: ("L1", (("T S3 S4", "trill chromatic"),)),
    67: ("(open)", (("R2 R3 RF", "held"),)),
    68: ("G#", (("G# R2 R3 RF", "held"),)),
    69: ("A", (("A R2 R3 RF", "held"),)),
    70: ("A R", (("A S2", "trill"), ("A R L3 R3 RF", "alternate"), ("A R R2 R3 RF", "held"))),
    71: (
        f"T R {BOTH} LE",
        (
            (f"T R {BOTH} RE", "alternate"),
            ("A S1", "trill"),
            (f"T R {BOTH} LE RF", "held"),
            (f"T R {BOTH} LF# RE", "held"),
        ),
    ),
    72: (f"T R {BOTH} RF", ((f"T R {BOTH} LF", "alternate"), ("A R S1 S2", "trill"), (f"T R {BOTH} LF# RF", "trill"))),
    73: (f"T R {BOTH} LF#", ((f"T R {BOTH} RF#", "alternate"),)),
    74: (f"T R {BOTH}", ()),
    75: (f"T R {BOTH} RG#", ((f"T R {BOTH} LF# RG#", "trill"),)),
    76: (f"T R {LEFT} R1 R2", ((f"T R {LEFT} R1 R2 RG#", "trill"),)),
    77: (f"T R {LEFT} R1", ((f"T R {LEFT} R1 RG#", "trill"),)),
    78: (f"T R {LEFT} R2", ((f"T R {LEFT} R1 RB", "trill chromatic"),)),
    79: (f"T R {LEFT}", ()),
    80: (f"T R {LEFT} LC#", (("T R L1 L2 R1 R2", "forked"),)),
    81: ("T R L1 L2", (("T R L1 L2 LC#", "trill"),)),
    82: ("T R L1 L2 S4", (("T R L1 L2 LEb", "alternate"), ("T R L1 R1", "forked"))),
    # The last is C sharp 6, once listed here by mistake; projects of that time may hold it.
    83: ("T R L1", ((f"T R L2 L3 {RIGHT} LF#", "alternate"), ("T R S3 S4", "obsolete"))),
    84: ("T R", ((f"T R L2 L3 {RIGHT}", "alternate"), ("T R S4", "held"))),
    85: ("T R L2 L3 R1 R2", (("T R S3 S4", "trill"),)),
    86: ("T R L2 L3 R1 RG#", (("T R S2", "trill"),)),
    87: ("T R L2 L3 R1 RB RG#", (("T R L2 L3 R3 RG#", "forked"), ("T R L2 L3 R2 RG#", "forked"))),
    88: ("T R L2 L3 RG#", ((f"R {LEFT} RG#", "alternate"),)),
    89: ("T R L2 L3 LC# RG#", ((f"T R {BOTH} LC#", "forte"),)),
    90: ("T R L2 RG#", ((f"T R L1 L2 {RIGHT} RG#", "alternate"), (f"T R L2 L3 {RIGHT} RG#", "alternate"))),
    91: ("T R L2 R1 R2 RG#", (("T R L1 R1 R2 RG#", "alternate"),)),
    92: ("T R L2 L3 LF# R1 R3", ((f"T R L2 L3 LF# {RIGHT}", "alternate"),)),
    93: ("T R L2 L3 RF", (("T R L2 L3 LF#", "alternate"),)),
    94: ("G# T R L2 L3 LC# RG#", ()),
    95: ("T R L1 L2 R1 R2", (("T R L1 L2 R1 R2 RF#", "alternate"),)),
    96: ("T R L1 R1 RF", (("T R L1 R1 RG#", "alternate"),)),
}

BASS_LOWEST = 51
BASS_HIGHEST = 91
HALF_FROM = 85
"""From here the bass clarinet opens the small hole in the first plate instead of the whole hole."""


def label(keys: str) -> str:
    """The label of a fingering: its signs sorted."""
    return " ".join(sorted(keys.split()))


def rows(written: int) -> list[tuple[str, tuple[str, ...]]]:
    """Labels and tags of a note of the B flat clarinet, first choice first."""
    first, alternates = ROWS[written]
    return [(label(first), ()), *((label(keys), tuple(tag.split())) for keys, tag in alternates)]


def bass_rows(written: int) -> list[tuple[str, tuple[str, ...]]]:
    """The same for the bass clarinet, of the notes that differ from the B flat clarinet's."""
    if written == BASS_LOWEST:
        return [(label(f"T {BOTH} REb"), ())]
    if written < HALF_FROM:
        return []
    found = []
    for keys, tags in rows(written):
        signs = keys.split()
        if "L1" not in signs and "L2" in signs and "T" in signs:
            found.append((label(f"L1h {keys}"), tags))
    return found or rows(written)


def toml(written: int, found: list[tuple[str, tuple[str, ...]]]) -> list[str]:
    """Lines of the map."""
    name = f"{NAMES[written % 12]} {written // 12 - 1}"
    lines = [f"  # {name}"]
    for rank, (keys, tags) in enumerate(found, start=1):
        more = f", tags = [{', '.join(f'{chr(34)}{tag}{chr(34)}' for tag in tags)}]" if tags else ""
        lines.append(f'  {{ written_pitch = {written}, rank = {rank}, label = "{keys}"{more} }},')
    return lines


def main() -> None:
    """Print both tables."""
    print("# clarinet_Bb")
    for written in ROWS:
        print("\n".join(toml(written, rows(written))))
    print("# clarinet_bass_Bb: where it differs")
    for written in range(BASS_LOWEST, BASS_HIGHEST + 1):
        found = bass_rows(written)
        if found:
            print("\n".join(toml(written, found)))


if __name__ == "__main__":
    main()
