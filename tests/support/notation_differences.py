"""Scores that music21 or partitura read differently from the program, and the reason why the program's reading is
correct. The format is that of the MusicXML reference (w3.org/2021/06/musicxml40); `tests.support.notation` compares.

The format is that of the MusicXML reference (w3.org/2021/06/musicxml40); `tests.support.notation` compares.
"""

from __future__ import annotations

from typing import Final

OCTAVES: Final = "<octave-change> is added to <chromatic>; partitura leaves it out"
QUARTER_TONES: Final = "ours is the nearest semitone; partitura drops the fraction, or knows no quarter tones"
PERCUSSION: Final = "partitura fails where a part without pitches has several notes at once"
TIMES: Final = "the attribute `times` says how often a section is played; partitura knows two times alone"
NO_FORWARD: Final = (
    "a backward repeat without a forward one leads to the end of the section before, as players read it and as "
    "partitura does; music21 goes back to the beginning of the piece"
)
NOT_ENDED: Final = (
    "a forward repeat that nothing ends repeats nothing; partitura ends it at the last bar, music21 fails"
)
NONSENSE: Final = "the endings make no sense, as the file itself says: ours plays every bar and ends; the others fail"
WORDS: Final = "words say `da capo`; partitura and music21 follow only some of them"
SOUNDS: Final = "the sounds `tocoda`, `dalsegno` and `coda` say the order; partitura reads words alone"
APART: Final = (
    "one part is shorter or longer than the others in a bar, a slip of the engraver: all parts begin the next bar "
    "together; the others let each part go on by itself"
)
CUES: Final = "<cue> notes are not played; both others count them"
TIES: Final = "music21 joins tied chords by their first notes, and notes of one pitch in two voices, wrongly"
LOST: Final = "the slur is in the file; music21 loses it where it goes to another voice or staff"
CHORDS: Final = "<chord/> joins a note to the one before, whatever stands between; music21 begins another chord"
OPEN_TIES: Final = "a tie that nothing ends is none; music21 joins what follows"
SLASHES: Final = "noteheads that are slashes say a rhythm without pitches; both others read the line they stand on"
FULL_REST: Final = "a rest is a rest; music21 sees the note that was left out"
FAILS: Final = "the other reader fails, ours does not"
EMPTY_NUMBER: Final = "the ending has no number: it is the first one"
LONGER: Final = "music21 makes a bar longer than its notes are; partitura reads it as we do"

KNOWN: Final[dict[str, dict[str, tuple[str, str]]]] = {
    "01d-Pitches-Microtones.xml": {"partitura": ("notes", QUARTER_TONES)},
    "01f-Pitches-EditorialMicrotoneAccidentals.xml": {"partitura": ("error", QUARTER_TONES)},
    "02e-Rests-NoType.xml": {"music21": ("notes", FULL_REST)},
    "21f-Chord-ElementInBetween.xml": {"music21": ("notes", CHORDS)},
    "22a-Noteheads.xml": {"music21": ("notes", SLASHES), "partitura": ("notes", SLASHES)},
    "22c-Noteheads-Chords.xml": {"music21": ("notes", SLASHES), "partitura": ("notes", SLASHES)},
    "32ab-Notations3.xml": {"partitura": ("error", FAILS)},
    "33i-Ties-NotEnded.xml": {"music21": ("notes", OPEN_TIES)},
    "41c-StaffGroups.xml": {"partitura": ("notes", OCTAVES)},
    "45a-SimpleRepeat.xml": {"partitura": ("order", TIMES)},
    "45c-RepeatMultipleTimes.xml": {"music21": ("order", NO_FORWARD), "partitura": ("order", TIMES)},
    "45d-Repeats-Nested-Alternatives.xml": {"music21": ("order", NONSENSE), "partitura": ("order", NONSENSE)},
    "45e-Repeats-Nested-Alternatives.xml": {
        "music21": ("order", "an ending 1 without an ending 2 is left out the second time"),
        "partitura": ("order", "an ending 1 without an ending 2 is left out the second time"),
    },
    "45f-Repeats-InvalidEndings.xml": {"music21": ("order", NONSENSE), "partitura": ("order", NONSENSE)},
    "45g-Repeats-NotEnded.xml": {"music21": ("order", NOT_ENDED), "partitura": ("order", NOT_ENDED)},
    "72b-TransposingInstruments-Full.xml": {"partitura": ("notes", OCTAVES)},
    "schoenberg/opus19/movement6.mxl": {"music21": ("notes", TIES)},
    "schoenberg/opus19/movement2.mxl": {"music21": ("slurs", LOST)},
    "haydn/opus1no1/movement4.mxl": {
        "music21": ("notes order slurs", f"{APART}; {WORDS}"),
        "partitura": ("notes order slurs", f"{APART}; {WORDS}"),
    },
    "haydn/opus1no1/movement2.mxl": {"music21": ("notes slurs", APART), "partitura": ("notes slurs", APART)},
    "haydn/opus1no1/movement5.mxl": {"music21": ("notes slurs", LONGER)},
    "haydn/opus74no1/movement3.mxl": {
        "music21": ("notes order slurs", f"{APART}; {EMPTY_NUMBER}"),
        "partitura": ("notes order slurs", f"{APART}; {EMPTY_NUMBER}"),
    },
    "mozart/k80/movement1.mxl": {"music21": ("order", NO_FORWARD)},
    "mozart/k80/movement3.mxl": {"music21": ("order", NO_FORWARD), "partitura": ("order", WORDS)},
    "mozart/k80/movement4.mxl": {
        "music21": ("notes order slurs", f"{APART}; {NO_FORWARD}"),
        "partitura": ("notes order slurs", f"{APART}; {WORDS}"),
    },
    "mozart/k155/movement2.mxl": {"music21": ("slurs", LOST)},
    "mozart/k155/movement3.mxl": {"music21": ("notes slurs", LONGER)},
    "mozart/k156/movement2.mxl": {"music21": ("order slurs", f"{NO_FORWARD}; {LOST}")},
    "mozart/k156/movement3.mxl": {
        "music21": ("notes order slurs", f"{APART}; {WORDS}"),
        "partitura": ("notes order slurs", f"{APART}; {WORDS}"),
    },
    "mozart/k458/movement2.mxl": {"music21": ("order", EMPTY_NUMBER), "partitura": ("order", EMPTY_NUMBER)},
    "schumann_robert/opus48no2.mxl": {"music21": ("notes", CUES), "partitura": ("notes", CUES)},
    "trecento/PMFC_13_01-Kyrie-Summe-Clementissime.mxl": {"partitura": ("order", TIMES)},
    "bach/bwv846.mxl": {"music21": ("notes", TIES)},
    "bach/bwv248.9-1.mxl": {"music21": ("notes", TIES)},
    "montuno.musicxml": {"partitura": ("error", PERCUSSION)},
    "OSMD_function_Test_Repeat.musicxml": {"music21": ("order", NOT_ENDED), "partitura": ("order", NOT_ENDED)},
    "test_slur_across_staves_left_to_right_hand.musicxml": {"music21": ("slurs", LOST)},
    "test_staverepetitions_coda_etc.musicxml": {"partitura": ("order", SOUNDS)},
}


def known(path: str, reader: str) -> tuple[set[str], str]:
    """Kinds of contents that a reader is known to read differently in a file, and the reason."""
    own = next((found for name, found in KNOWN.items() if path.endswith(name)), {})
    facts, reason = own.get(reader, ("", ""))
    return set(facts.split()), reason
