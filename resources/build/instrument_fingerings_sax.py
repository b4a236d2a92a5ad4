"""Prints the tables of fingerings of the saxophones as their maps hold them.

    python -m resources.build.instrument_fingerings_sax

The rows are a judgement over three public charts (the map's ``sources`` name them), made by hand: what a method book
teaches first, then what the charts name as well and a player uses; a test compares the first choices with the charts'
majority. Left out: the errors the charts' list names, and what asks one finger for two places at once (palm D with the
first pearl). High F sharp and the front E and F sharp are what makers of instruments with these keys print. The charts
say nothing of intonation: ``cents`` are 0.
"""

from __future__ import annotations

NAMES = ("C", "C sharp", "D", "E flat", "E", "F", "F sharp", "G", "A flat", "A", "B flat", "B")
LEFT, RIGHT = "1L 2L 3L", "1R 2R 3R"
BOTH = f"{LEFT} {RIGHT}"
LOWEST = 57
"""Of the baritone; the others begin a semitone above."""

# Written pitch -> first choice, then alternates as (keys, tag).
ROWS: dict[int, tuple[str, tuple[tuple[str, str], ...]]] = {
    57: (f"{BOTH} la lbb lc", ()),
    58: (f"{BOTH} lbb lc", ()),
    59: (f"{BOTH} lb lc", ()),
    60: (f"{BOTH} lc", ()),
    61: (f"{BOTH} cs lc", ()),
    62: (BOTH, ((f"{BOTH} gs", "held"), (f"{BOTH} cs", "trill"))),
    63: (f"{BOTH} leb", ()),
    64: (f"{LEFT} 1R 2R", ((f"{LEFT} 1R 2R gs", "held"), (f"{LEFT} 1R 2R leb", "trill"))),
    65: (f"{LEFT} 1R", ((f"{LEFT} 1R gs", "held"), (f"{LEFT} 1R leb", "trill"))),
    66: (f"{LEFT} 2R", ((f"{LEFT} 1R afs", "trill chromatic"), (f"{LEFT} 2R gs", "held"))),
    67: (LEFT, ()),
    68: (f"{LEFT} gs", ()),
    69: ("1L 2L", (("1L 2L gs", "held"),)),
    70: (
        "1L 2L sbb",
        (("1L 1R", "alternate"), ("1L bbb", "fast trill"), ("1L 2L gs sbb", "trill")),
    ),
    71: ("1L", ()),
    72: ("2L", (("1L sc", "trill chromatic"), ("1L bbb sc", "trill"))),
    73: ("(open)", ()),
    74: (f"{BOTH} oct", (("pd", "trill"), ("2L pd", "trill"), (f"{BOTH} gs oct", "held"))),
    75: (f"{BOTH} leb oct", (("se", "trill"),)),
    76: (
        f"{LEFT} 1R 2R oct",
        ((f"{LEFT} 1R 2R gs oct", "held"), ("2L pd peb se", "trill"), (f"{LEFT} 1R 2R leb oct", "trill")),
    ),
    77: (f"{LEFT} 1R oct", ((f"{LEFT} 1R gs oct", "held"), (f"{LEFT} 1R leb oct", "trill"))),
    78: (f"{LEFT} 2R oct", ((f"{LEFT} 1R afs oct", "trill chromatic"), (f"{LEFT} 2R gs oct", "held"))),
    79: (f"{LEFT} oct", ()),
    80: (f"{LEFT} gs oct", ()),
    81: ("1L 2L oct", (("1L 2L gs oct", "held"),)),
    82: (
        "1L 2L oct sbb",
        (
            ("1L 1R oct", "alternate"),
            ("1L bbb oct", "fast trill"),
            ("1L 2L gs oct sbb", "trill"),
        ),
    ),
    83: ("1L oct", ()),
    84: ("2L oct", (("1L oct sc", "trill chromatic"), ("1L bbb oct sc", "trill"))),
    85: ("oct", ()),
    86: ("oct pd", (("2L oct pd", "trill"),)),
    87: ("oct pd peb", ()),
    88: ("oct pd peb se", (("2L 3L ff oct", "fast"),)),
    89: ("oct pd peb pf se", (("2L ff oct", "fast"),)),
    90: ("hfs oct pd peb pf se", (("2L ff oct sbb", "alternate"),)),
}


def label(keys: str) -> str:
    """The label of a fingering: its signs sorted."""
    return " ".join(sorted(keys.split()))


def rows(written: int) -> list[tuple[str, tuple[str, ...]]]:
    """Labels and tags of a note, first choice first."""
    first, alternates = ROWS[written]
    return [(label(first), ()), *((label(keys), tuple(tag.split())) for keys, tag in alternates)]


def toml(written: int) -> list[str]:
    """Lines of the map."""
    lines = [f"  # {NAMES[written % 12]} {written // 12 - 1}"]
    for rank, (keys, tags) in enumerate(rows(written), start=1):
        more = f", tags = [{', '.join(f'{chr(34)}{tag}{chr(34)}' for tag in tags)}]" if tags else ""
        lines.append(f'  {{ written_pitch = {written}, rank = {rank}, label = "{keys}"{more} }},')
    return lines


def main() -> None:
    """Print the table."""
    for written in ROWS:
        print("\n".join(toml(written)))


if __name__ == "__main__":
    main()
