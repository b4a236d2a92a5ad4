"""Arrange the bundled example: four players out of Pezel's five-part sonata 21.

Source: J. Pezel, "Hora decima", sonata 21, engraved for the Mutopia project (public domain), as MIDI in
``tests/data/midi/ensemble/brass_quintet_pezel_sonata21.mid``. Run from anywhere::

    python -m resources.build.arrange_example

What the arrangement does (quarters are counted from the start of the source, metre 3/2):

- It takes the fugato, the homophonic middle part and the closing imitations: quarters 42 to 306.
- The two sopranos, in one track of the source, become the trumpets: where two notes sound the upper goes to the first
  trumpet, except where the lines cross; where one sounds, `SECOND_TRUMPET_ALONE` says whose entry it is.
- The first trombone plays the source's alto line, and in places the tenor's.
- The second trombone plays the bass; what lies below E2 an octave higher.
- It sounds a semitone higher, in F minor.
- A note of three quarters or more that another follows at once ends early, so that the player can breathe.
- Dynamics by section (echoes in the closing part), metre and contour; a broadening at the middle part and at the end.
- The score says with marks what the MIDI file says with lengths and velocities: dynamics where a section begins, points
  on the quarters that sound half as long, breath marks where a note ends early at the end of a phrase; and slurs, which
  MIDI cannot say, over pairs of eighths by step and over the dotted notes of the middle part.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import mido

from resources.build.example_scores import Heading, Line, Note, dynamic, score

SOURCE = Path(__file__).parents[2] / "tests/data/midi/ensemble/brass_quintet_pezel_sonata21.mid"
TARGET = Path(__file__).parents[1] / "examples/quartet.mid"
SCORE_TARGET = TARGET.with_suffix(".musicxml")

TITLE = "Sonata 21"
ABOUT = "Johann Pezel, Hora decima (1670), arranged for two trumpets and two trombones"
FIRST_QUARTER, LAST_QUARTER = 42.0, 306.0
TICKS_PER_QUARTER = 480
LOWEST_TROMBONE_PITCH = 40
# Leipzig's town pipers played about a semitone above today's pitch; and in F minor instead of E minor the second
# trombone's many E and B need no seventh position.
TRANSPOSITION_SEMITONES = 1

SECOND_TRUMPET_ALONE = ((76.0, 88.0), (108.0, 114.0), (128.0, 132.0), (210.0, 216.0), (268.0, 270.0))
TRUMPETS_CROSSED = ((216.0, 218.0), (268.0, 276.0))
# The first trombone plays the tenor here: a run while the alto rests, and the thirds of three closing chords.
TENOR_INSTEAD = ((54.0, 60.0), (156.0, 162.0), (228.0, 234.0), (300.0, 306.0))
LOWEST_TENOR_PITCH = 50

# (from quarter, loudness as velocity): the closing part answers its own phrases more softly.
SECTIONS = (
    (42.0, 84),
    (100.0, 92),
    (136.0, 98),
    (160.0, 70),
    (176.0, 94),
    (210.0, 64),
    (222.0, 76),
    (234.0, 88),
    (246.0, 66),
    (258.0, 84),
    (280.0, 104),
)
# (from quarter, quarters per minute); the last bars broaden quarter by quarter.
TEMPI = (
    (42.0, 156.0),
    (162.0, 160.0),
    (208.0, 150.0),
    (210.0, 184.0),
    (284.0, 176.0),
    (290.0, 168.0),
    (294.0, 160.0),
    (296.0, 148.0),
    (298.0, 132.0),
    (300.0, 112.0),
)


BREATHS = (147.0, 174.0, 186.0, 198.0, 294.0)
"""Ends of phrases between rests, where all players who end a note breathe."""
MIDDLE = (162.0, 206.0)
BAR = 6.0


class Sound(NamedTuple):
    """One note: onset and length in quarters, MIDI pitch."""

    onset: float
    pitch: int
    length: float


# Where both sopranos meet at one pitch, the source has a single note; the other player's is restored.
FIRST_TRUMPET_UNISONS = [Sound(218.0, 69, 0.5)]
SECOND_TRUMPET_UNISONS = [Sound(156.0, 64, 6.0), Sound(204.0, 67, 6.0)]


def sounds(track: mido.MidiTrack, ticks_per_quarter: int) -> list[Sound]:
    """The notes of one track, by onset and pitch."""
    tick = 0
    sounding: dict[int, list[int]] = {}
    found = []
    for message in track:
        tick += message.time
        if message.type == "note_on" and message.velocity:
            sounding.setdefault(message.note, []).append(tick)
        elif message.type in ("note_on", "note_off") and sounding.get(message.note):
            onset = sounding[message.note].pop(0)
            found.append(Sound(onset / ticks_per_quarter, message.note, (tick - onset) / ticks_per_quarter))
    return sorted(sound for sound in found if FIRST_QUARTER <= sound.onset < LAST_QUARTER)


def within(quarter: float, spans: tuple[tuple[float, float], ...]) -> bool:
    return any(first <= quarter < last for first, last in spans)


def trumpets(sopranos: list[Sound]) -> tuple[list[Sound], list[Sound]]:
    """Share the sopranos' track between two players."""
    first: list[Sound] = []
    second: list[Sound] = []
    for sound in sopranos:
        others = [
            other
            for other in sopranos
            if other is not sound
            and other.onset < sound.onset + sound.length
            and sound.onset < other.onset + other.length
        ]
        if others:
            upper = sound.pitch >= max(other.pitch for other in others)
            to_first = upper != within(sound.onset, TRUMPETS_CROSSED)
        else:
            to_first = not within(sound.onset, SECOND_TRUMPET_ALONE)
        (first if to_first else second).append(sound)
    return sorted(first + FIRST_TRUMPET_UNISONS), sorted(second + SECOND_TRUMPET_UNISONS)


def first_trombone(alto: list[Sound], low: list[Sound]) -> list[Sound]:
    """The alto line, or the tenor's in the passages of `TENOR_INSTEAD`."""
    tenor = [sound for sound in low if within(sound.onset, TENOR_INSTEAD) and sound.pitch >= LOWEST_TENOR_PITCH]
    return sorted([sound for sound in alto if not within(sound.onset, TENOR_INSTEAD)] + tenor)


def bass_line(track: list[Sound]) -> list[Sound]:
    """The lowest voice, with notes below the trombone's range an octave higher (the source doubles them there)."""
    line: list[Sound] = []
    for sound in track:
        if line and line[-1].onset + line[-1].length > sound.onset:
            continue  # another voice over a held bass
        octave = 12 if sound.pitch < LOWEST_TROMBONE_PITCH else 0
        line.append(sound._replace(pitch=sound.pitch + octave))
    return line


def breathing(line: list[Sound]) -> list[Sound]:
    """End long notes early if the next one follows immediately."""
    shaped = []
    for sound, following in zip(line, [*line[1:], None], strict=True):
        length = sound.length
        if following is not None:
            length = min(length, following.onset - sound.onset)
            if sound.onset + length == following.onset and length >= 3:
                length -= 1.0 if length >= 4 else 0.5
        shaped.append(sound._replace(length=length))
    return shaped


def velocity(sound: Sound, line: list[Sound]) -> int:
    """Loudness by section, accent by metre (3/2 from the first quarter), a little more towards the top of the line."""
    base = next(level for quarter, level in reversed(SECTIONS) if quarter <= sound.onset)
    place = (sound.onset - FIRST_QUARTER) % 6
    accent = 8 if place == 0 else 4 if place in (2, 4) else 0 if place == int(place) else -4
    pitches = [other.pitch for other in line]
    contour = round(10 * (sound.pitch - sum(pitches) / len(pitches)) / (max(pitches) - min(pitches)))
    return max(1, min(127, base + accent + contour))


def tick(quarter: float, start: float) -> int:
    return round((quarter - start) * TICKS_PER_QUARTER)


def _track(events: list[tuple[int, int, mido.Message | mido.MetaMessage]]) -> mido.MidiTrack:
    """Events at absolute ticks to a track; at one tick the smaller order goes first."""
    track = mido.MidiTrack()
    now = 0
    for at, _, message in sorted(events, key=lambda event: event[:2]):
        track.append(message.copy(time=at - now))
        now = at
    return track


def conductor(
    title: str, about: str, rights: str, metre: tuple[int, int], key: str, tempi: Iterable[tuple[int, float]]
) -> mido.MidiTrack:
    """Title, metre and key; tempi as (tick, quarters per minute)."""
    meta = mido.MetaMessage
    return _track(
        [
            (0, 0, meta("track_name", name=title)),
            (0, 1, meta("text", text=about)),
            (0, 2, meta("copyright", text=rights)),
            (0, 3, meta("time_signature", numerator=metre[0], denominator=metre[1], clocks_per_click=48)),
            (0, 4, meta("key_signature", key=key)),
            *((at, 5, meta("set_tempo", tempo=mido.bpm2tempo(bpm))) for at, bpm in tempi),
        ]
    )


def player(
    name: str, channel: int, program: int, notes: Iterable[tuple[float, float, int, int]], start: float = 0.0
) -> mido.MidiTrack:
    """One player's track from (onset, length, pitch, velocity), in quarters; ticks are counted from ``start``."""
    events: list[tuple[int, int, mido.Message | mido.MetaMessage]] = [
        (0, 0, mido.MetaMessage("track_name", name=name)),
        (0, 1, mido.Message("program_change", channel=channel, program=program)),
    ]
    for onset, length, pitch, loudness in notes:
        on = mido.Message("note_on", channel=channel, note=pitch, velocity=loudness)
        off = mido.Message("note_off", channel=channel, note=pitch, velocity=64)
        events += [(tick(onset, start), 3, on), (tick(onset + length, start), 2, off)]
    return _track(events)


def lines(source: mido.MidiFile) -> list[tuple[str, int, list[Sound]]]:
    """Name, program and notes of each player, out of the source's three tracks of players."""
    sopranos, alto, low = (sounds(track, source.ticks_per_beat) for track in source.tracks[1:])
    upper, lower = trumpets(sopranos)
    return [
        ("Trumpet 1", 56, upper),
        ("Trumpet 2", 56, lower),
        ("Trombone 1", 57, first_trombone(alto, low)),
        ("Trombone 2", 57, bass_line(low)),
    ]


def arrange(source: mido.MidiFile) -> mido.MidiFile:
    """The quartet."""
    tempi = [(tick(quarter, FIRST_QUARTER), bpm) for quarter, bpm in TEMPI]
    tracks = [conductor(TITLE, ABOUT, "Public domain", (3, 2), "Fm", tempi)]
    for channel, (name, program, line) in enumerate(lines(source)):
        shaped = breathing(line)
        notes = [(s.onset, s.length, s.pitch + TRANSPOSITION_SEMITONES, velocity(s, shaped)) for s in shaped]
        tracks.append(player(name, channel, program, notes, FIRST_QUARTER))
    return mido.MidiFile(type=1, ticks_per_beat=TICKS_PER_QUARTER, tracks=tracks)


def written(line: list[Sound]) -> tuple[Note, ...]:
    """Written notes of a player with points and breath marks."""
    notes = []
    for sound, following in zip(line, [*line[1:], None], strict=True):
        gap = BAR if following is None else following.onset - sound.onset
        level = next(level for quarter, level in reversed(SECTIONS) if quarter <= sound.onset)
        marks: tuple[str, ...] = ()
        length = min(sound.length, gap)
        if (length, gap) == (0.5, 1.0):
            length, marks = 1.0, ("staccato",)
        elif following is not None and length == gap and (length == BAR or following.onset in BREATHS):
            marks = ("breath-mark",)
        notes.append(Note(sound.onset - FIRST_QUARTER, length, sound.pitch + TRANSPOSITION_SEMITONES, level, marks))
    return tuple(notes)


def slurred(notes: tuple[Note, ...]) -> tuple[tuple[int, int], ...]:
    """Slurs over stepwise pairs of eighths, and over dotted notes with the following one in the middle part."""
    first, last = (quarter - FIRST_QUARTER for quarter in MIDDLE)
    return tuple(
        (place, place + 1)
        for place, (one, following) in enumerate(pairwise(notes))
        if one.end == following.onset
        and 1 <= abs(following.pitch - one.pitch) <= 2
        and (
            (one.length == following.length == 0.5 and one.onset % 1.0 == 0.0)
            or ((one.length, following.length) == (3.0, 1.0) and first <= one.onset < last)
        )
    )


def levels(notes: tuple[Note, ...]) -> tuple[tuple[float, int], ...]:
    """Dynamics of a player: at the first note on a beat of each section, where it is another one."""
    found: list[tuple[float, int]] = []
    for note in notes:
        if note.onset % 2.0 == 0.0 and (not found or dynamic(found[-1][1]) != dynamic(note.velocity)):
            found.append((note.onset, note.velocity))
    return tuple(found)


def arrange_score(source: mido.MidiFile) -> bytes:
    """The quartet as a score in MusicXML."""
    tempi = tuple((quarter - FIRST_QUARTER, bpm) for quarter, bpm in TEMPI)
    bars = round((LAST_QUARTER - FIRST_QUARTER) / BAR)
    heading = Heading(TITLE, "Johann Pezel", "Public domain", (3, 2), -4, tempi, bars)
    parts = []
    for name, program, line in lines(source):
        notes, high = written(line), program == 56
        sound, shift, clef = ("brass.trumpet", -2, "G2") if high else ("brass.trombone", 0, "F4")
        parts.append(Line(name, sound, program, notes, shift, clef, slurred(notes), levels(notes)))
    return score(heading, parts)


def main() -> None:
    """Write the example and print its length."""
    quartet = arrange(mido.MidiFile(SOURCE))
    quartet.save(TARGET)
    SCORE_TARGET.write_bytes(arrange_score(mido.MidiFile(SOURCE)))
    print(f"{TARGET.name}: {quartet.length:.1f} s")


if __name__ == "__main__":
    main()
