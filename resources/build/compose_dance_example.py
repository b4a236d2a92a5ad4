"""Compose the bundled example with a dancer: "Montuno", a short piece of our own for brass quartet and drums.

Run from anywhere::

    python -m resources.build.compose_dance_example

It is in 2/2 at 92 half notes a minute, in C minor, 24 bars in about half a minute: two bars of bass and drums; a tune
of the first trumpet, joined by the second in thirds; the trombone's answer; the brass together; two bars of ending on
the clave. The rhythms are those of the style in general: the son clave (two strokes in one bar, three in the next), a
bass that comes before the bar (tumbao), a figure between the beats (guajeo). Nothing is quoted.

The drums use the sounds of a drum kit, which the bundled choreography was trained on; the clave is struck on the rim.
Onsets and lengths are in quarters, bars are counted from 0, pitches are MIDI's.

The score in MusicXML has the same notes and, as marks, what MIDI cannot say: slurs over what goes by step in the tune
and in the answer, points on the chords behind the answer, accents on the strokes of the clave in the riff, and wedges
on the last chords.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Final, NamedTuple

import mido

from resources.build.arrange_example import TICKS_PER_QUARTER, conductor, player
from resources.build.example_scores import Heading, Line, Note, dynamic, score, stepwise

TARGET: Final = Path(__file__).parents[1] / "examples/montuno.mid"
SCORE_TARGET: Final = TARGET.with_suffix(".musicxml")

QUARTERS_PER_MINUTE: Final = 184.0
BAR: Final = 4.0
BARS: Final = 24
INTRODUCTION, TUNE, ANSWER, TOGETHER, ENDING = 0, 2, 10, 14, 22
"""First bar of each part of the piece."""
BEHIND: Final = 70
"""Velocity of chords accompanying a tune."""

KICK, RIM, SNARE, CLOSED_HAT, PEDAL_HAT, HIGH_TOM, LOW_TOM, CRASH, BELL = 36, 37, 38, 42, 44, 50, 45, 49, 53
DRUM_NAMES: Final = {
    KICK: "Bass Drum",
    RIM: "Side Stick",
    SNARE: "Snare Drum",
    CLOSED_HAT: "Closed Hi-Hat",
    PEDAL_HAT: "Pedal Hi-Hat",
    HIGH_TOM: "High Tom",
    LOW_TOM: "Low Tom",
    CRASH: "Crash Cymbal",
    BELL: "Ride Bell",
}
DRUMS: Final = 9
"""The channel of percussion, counted from 0."""

CLAVE: Final = ((1.0, 2.0), (0.0, 1.5, 3.0))
"""Strokes of the clave in quarters, in bars of even and of odd number."""
BELOW: Final = {0: 5, 2: 3, 3: 3, 5: 3, 7: 4, 8: 3, 10: 3, 11: 4}
"""By the pitch class of an upper voice, how many semitones lower the second one goes: thirds within C minor, a fourth
below the tonic."""

# Chord by bar: root and fifth of the bass, and the notes of the trombone's figure.
C_MINOR, F_MINOR, A_FLAT, B_FLAT, G_SEVENTH = "Cm", "Fm", "Ab", "Bb", "G7"
BASS: Final = {C_MINOR: (36, 43), F_MINOR: (41, 36), A_FLAT: (44, 39), B_FLAT: (34, 41), G_SEVENTH: (43, 38)}
FIGURE: Final = {
    C_MINOR: (63, 60, 55, 60),
    F_MINOR: (60, 56, 53, 56),
    A_FLAT: (63, 60, 56, 60),
    B_FLAT: (62, 58, 53, 58),
    G_SEVENTH: (59, 62, 53, 55),
}
HARMONY: Final = (
    *(C_MINOR, C_MINOR),
    *(C_MINOR, F_MINOR, G_SEVENTH, C_MINOR, C_MINOR, A_FLAT, G_SEVENTH, C_MINOR),
    *(C_MINOR, B_FLAT, A_FLAT, G_SEVENTH),
    *(C_MINOR, F_MINOR, G_SEVENTH, C_MINOR, C_MINOR, F_MINOR, G_SEVENTH, C_MINOR),
    *(C_MINOR, C_MINOR),
)


class Sound(NamedTuple):
    """One note: onset and length in quarters, MIDI pitch, loudness as velocity."""

    onset: float
    length: float
    pitch: int
    velocity: int


# (onset in the phrase, length, pitch)
Phrase = Sequence[tuple[float, float, int]]

FIRST_PHRASE: Phrase = (
    *((1.0, 0.5, 67), (1.5, 0.5, 72), (2.0, 1.0, 75), (3.0, 0.5, 74), (3.5, 1.0, 72)),
    *((5.0, 0.5, 68), (5.5, 0.5, 72), (6.0, 1.5, 77)),
    *((8.0, 0.5, 74), (8.5, 0.5, 75), (9.0, 0.5, 74), (9.5, 1.0, 71), (10.5, 0.5, 67), (11.0, 0.5, 71)),
    *((11.5, 0.5, 74), (12.0, 1.5, 72)),
)
SECOND_PHRASE: Phrase = (
    *((0.0, 0.5, 72), (0.5, 0.5, 75), (1.0, 1.0, 79), (2.0, 0.5, 77), (2.5, 0.5, 75), (3.0, 0.5, 77)),
    *((3.5, 1.0, 79), (4.5, 1.0, 80), (5.5, 0.5, 79), (6.0, 0.5, 75), (6.5, 1.0, 72)),
    *((8.0, 0.5, 74), (8.5, 0.5, 77), (9.0, 0.5, 75), (9.5, 0.5, 74), (10.0, 0.5, 71), (10.5, 0.5, 74)),
    *((11.0, 0.5, 71), (11.5, 0.5, 67), (12.0, 1.0, 72)),
)
REPLY: Phrase = ((13.5, 0.5, 63), (14.0, 0.5, 67), (14.5, 1.0, 70))
"""Notes of the second trumpet at the end of the first phrase."""
TROMBONE_ANSWER: Phrase = (
    *((0.0, 1.5, 60), (1.5, 0.5, 62), (2.0, 1.5, 63)),
    *((4.0, 1.5, 62), (5.5, 0.5, 58), (6.0, 1.5, 53)),
    *((8.0, 1.5, 60), (9.5, 0.5, 58), (10.0, 1.0, 56), (11.0, 0.5, 63)),
    *((12.0, 1.0, 62), (13.0, 1.5, 59), (14.5, 1.0, 55)),
)
RIFF: Phrase = (
    *((0.5, 0.5, 72), (1.0, 0.5, 75), (1.5, 0.5, 77), (2.5, 1.0, 79)),
    *((4.5, 0.5, 77), (5.5, 0.5, 75), (6.0, 0.5, 72), (7.0, 0.5, 68)),
    *((8.5, 0.5, 71), (9.0, 0.5, 74), (9.5, 0.5, 77), (10.5, 1.0, 80)),
    *((12.5, 0.5, 79), (13.5, 0.5, 77), (14.0, 0.5, 74), (15.0, 0.5, 72)),
)
LAST_CHORDS: Final = ((0.0, 0.5), (1.5, 0.5), (3.0, 0.5), (5.0, 0.5), (6.0, 1.0))
"""Onsets and lengths in quarters from the ending's first bar."""


def placed(line: Phrase, bar: int, velocity: int, lower: int = 0) -> list[Sound]:
    """Line from a bar on, lowered by semitones; notes on the clave are slightly louder."""
    return [
        Sound(bar * BAR + onset, length, pitch - lower, velocity + (6 if on_clave(bar * BAR + onset) else 0))
        for onset, length, pitch in line
    ]


def on_clave(quarter: float) -> bool:
    return quarter % BAR in CLAVE[int(quarter // BAR) % 2]


def second_below(line: Phrase) -> Phrase:
    """The second voice below a line."""
    return tuple((onset, length, pitch - BELOW[pitch % 12]) for onset, length, pitch in line)


def first_trumpet() -> list[Sound]:
    """The tune, short chords behind the trombone, the riff twice, the ending."""
    sounds = placed(FIRST_PHRASE, TUNE, 88) + placed(SECOND_PHRASE, TUNE + 4, 94)
    sounds += chords_behind(72, BEHIND)
    sounds += placed(RIFF, TOGETHER, 98) + placed(RIFF, TOGETHER + 4, 106)
    return sounds + ending((72, 74, 75, 79, 72))


def second_trumpet() -> list[Sound]:
    """Silent in the first phrase but for a reply; thirds below the first trumpet from then on."""
    sounds = placed(REPLY, TUNE, 82) + placed(second_below(SECOND_PHRASE), TUNE + 4, 86)
    sounds += chords_behind(67, BEHIND - 4)
    sounds += placed(second_below(RIFF), TOGETHER, 92) + placed(second_below(RIFF), TOGETHER + 4, 100)
    return sounds + ending((67, 71, 72, 75, 67))


def trombone() -> list[Sound]:
    """The figure between the beats, the answer, the riff an octave below the first trumpet, the ending. Where the riff
    is too quick for the slide, a note is left out."""
    riff = [note for note in RIFF if note[0] != 9.0]
    sounds = [
        Sound(bar * BAR + onset, 0.5, pitch, 78)
        for bar in range(TUNE, ANSWER)
        for onset, pitch in zip((0.5, 1.5, 2.5, 3.5), FIGURE[HARMONY[bar]], strict=True)
    ]
    sounds += placed(TROMBONE_ANSWER, ANSWER, 98)
    sounds += placed(riff, TOGETHER, 90, lower=12) + placed(riff, TOGETHER + 4, 98, lower=12)
    return sounds + ending((63, 59, 60, 60, 63))


def tuba() -> list[Sound]:
    """The fifth on the second half of the second quarter, the next bar's root on the fourth, held over the bar line."""
    sounds = [Sound(0.0, 1.0, BASS[HARMONY[0]][0], 92)]
    for bar in range(ENDING):
        root, fifth = BASS[HARMONY[min(bar + 1, BARS - 1)]][0], BASS[HARMONY[bar]][1]
        loud = 96 if bar >= TOGETHER else 88
        sounds.append(Sound(bar * BAR + 1.5, 1.0, fifth, loud - 4))
        if bar + 1 < ENDING:
            sounds.append(Sound(bar * BAR + 3.0, 1.5, root, loud))
    return sounds + ending((36, 43, 36, 43, 36))


def chords_behind(upper: int, velocity: int) -> list[Sound]:
    """Short notes on the clave, behind the trombone: the note of each chord that is nearest below a pitch."""
    notes = {C_MINOR: (0, 3, 7), B_FLAT: (10, 2, 5), A_FLAT: (8, 0, 3), G_SEVENTH: (7, 11, 2)}
    sounds = []
    for bar in range(ANSWER, TOGETHER):
        pitch = next(pitch for pitch in range(upper, upper - 12, -1) if pitch % 12 in notes[HARMONY[bar]])
        sounds += [Sound(bar * BAR + onset, 0.5, pitch, velocity) for onset in CLAVE[bar % 2]]
    return sounds


def ending(pitches: Sequence[int]) -> list[Sound]:
    """One player's notes of the last chords."""
    return [
        Sound(ENDING * BAR + onset, length, pitch, 112)
        for (onset, length), pitch in zip(LAST_CHORDS, pitches, strict=True)
    ]


def drums() -> list[Sound]:
    """Clave, bell, hats and bass drum throughout; a roll on the toms before a new part; the last chords."""
    sounds = []
    for bar in range(ENDING):
        at = bar * BAR
        sounds += [Sound(at + onset, 0.25, RIM, 100) for onset in CLAVE[bar % 2]]
        sounds += [Sound(at + onset, 0.25, KICK, 84 if onset == 1.5 else 96) for onset in (1.5, 3.0)]
        sounds += [Sound(at + onset, 0.25, PEDAL_HAT, 70) for onset in (0.0, 2.0)]
        if bar >= TOGETHER:
            sounds += [Sound(at + onset, 0.25, BELL, 96 if onset % 2.0 == 0.0 else 76) for onset in range(4)]
        else:
            sounds += [Sound(at + 0.5 * step, 0.25, CLOSED_HAT, 72 if step % 2 else 56) for step in range(8)]
        if bar + 1 in (TUNE, ANSWER, TOGETHER, ENDING):
            toms = (HIGH_TOM, HIGH_TOM, LOW_TOM, LOW_TOM)
            sounds += [Sound(at + 2.0 + 0.5 * step, 0.25, tom, 90 + 6 * step) for step, tom in enumerate(toms)]
        if bar in (TUNE, ANSWER, TOGETHER):
            sounds.append(Sound(at, 0.5, CRASH, 100))
    for onset, _ in LAST_CHORDS:
        sounds += [Sound(ENDING * BAR + onset, 0.25, drum, 112) for drum in (KICK, SNARE)]
    sounds.append(Sound(ENDING * BAR + LAST_CHORDS[-1][0], 1.0, CRASH, 112))
    return sounds


def compose() -> mido.MidiFile:
    """The piece."""
    about = "A short piece for brass quartet, drums and a dancer"
    tracks = [
        conductor("Montuno", about, "CC0 1.0", (2, 2), "Cm", [(0, QUARTERS_PER_MINUTE)]),
        player("Trumpet 1", 0, 56, sorted(first_trumpet())),
        player("Trumpet 2", 1, 56, sorted(second_trumpet())),
        player("Trombone", 2, 57, sorted(trombone())),
        player("Tuba", 3, 58, sorted(tuba())),
        player("Drums", DRUMS, 0, sorted(drums())),
    ]
    return mido.MidiFile(type=1, ticks_per_beat=TICKS_PER_QUARTER, tracks=tracks)


def noted(sounds: Sequence[Sound]) -> tuple[Note, ...]:
    """Written notes of a player with points, accents and wedges."""
    return tuple(
        Note(sound.onset, sound.length, sound.pitch, sound.velocity, _marks(sound)) for sound in sorted(sounds)
    )


def _marks(sound: Sound) -> tuple[str, ...]:
    bar = int(sound.onset // BAR)
    if bar >= ENDING:
        return ("strong-accent",)
    if bar >= TOGETHER and on_clave(sound.onset):
        return ("accent",)
    return ("staccato",) if ANSWER <= bar < TOGETHER and sound.length == 0.5 and sound.velocity <= BEHIND else ()


def part(name: str, id: str, program: int, sounds: Sequence[Sound], shift: int = 0, clef: str = "G2") -> Line:
    """The part of a wind player, with its dynamics: the velocity of most notes of each section."""
    notes = noted(sounds)
    levels: list[tuple[float, int]] = []
    for first, last in pairwise((INTRODUCTION, TUNE, TUNE + 4, ANSWER, TOGETHER, TOGETHER + 4, ENDING, BARS)):
        own = [note for note in notes if first * BAR <= note.onset < last * BAR]
        usual = min((note.velocity for note in own), default=0)
        if own and (not levels or dynamic(levels[-1][1]) != dynamic(usual)):
            levels.append((own[0].onset, usual))
    slurs = stepwise(notes, TUNE * BAR, TOGETHER * BAR)
    return Line(name, id, program, notes, shift, clef, slurs, tuple(levels))


def compose_score() -> bytes:
    """The piece as a score in MusicXML."""
    heading = Heading("Montuno", "Suisou", "CC0 1.0", (2, 2), -3, ((0.0, QUARTERS_PER_MINUTE),), BARS)
    struck = tuple(Note(*sound[:4]) for sound in sorted(drums()))
    lines = [
        part("Trumpet 1", "brass.trumpet", 56, first_trumpet(), -2),
        part("Trumpet 2", "brass.trumpet", 56, second_trumpet(), -2),
        part("Trombone", "brass.trombone", 57, trombone(), clef="F4"),
        part("Tuba", "brass.tuba", 58, tuba(), clef="F4"),
        Line("Drums", "", 0, struck, levels=((0.0, 90),), drums=DRUM_NAMES),
    ]
    return score(heading, lines)


def main() -> None:
    """Write the example and print its length."""
    piece = compose()
    piece.save(TARGET)
    SCORE_TARGET.write_bytes(compose_score())
    print(f"{TARGET.name}: {piece.length:.1f} s")


if __name__ == "__main__":
    main()
