"""Notes of a score: onsets, lengths and sounding pitches, and their marks."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from app.errors import FileError
from app.score.contents import PieceContents
from app.score.track_channel import TrackChannel
from tests.unit.score.musicxml.documents import (
    ATTRIBUTES,
    articulation,
    direction,
    document,
    dynamic,
    listed,
    note,
    part,
    read,
    score,
    slur,
    words,
)

Q = 480


def rows(contents: PieceContents, place: int = 0) -> list[tuple[float, float, int]]:
    """Onset and end in quarters and pitch of the notes of a stream."""
    stream = contents.channels[place]
    quarter = contents.tempo_map.ticks_per_quarter
    return [
        (onset / quarter, end / quarter, pitch)
        for onset, end, pitch in zip(stream.onset_ticks, stream.end_ticks, stream.pitches, strict=True)
    ]


def marks(stream: TrackChannel) -> list[tuple[object, ...]]:
    """Kinds of marks, indices of their notes, and their texts."""
    found: list[tuple[object, ...]] = []
    for mark in stream.marks:
        ids = [int(id.partition(":")[2]) for id in (mark.note_id, mark.last_note_id) if id]
        ticks = [] if ids else [mark.tick, mark.end_tick] if mark.end_tick else [mark.tick]
        found.append((mark.kind, *ids, *ticks, *filter(None, (mark.text,))))
    return found


def test_voices_chords_rests_and_ties(tmp_path: Path) -> None:
    first = (
        note("C4", 4)
        + note("E4", 4, before="<chord/>")
        + note("r", 4)
        + note("G4", 8, '<tie type="start"/>')
        + "<backup><duration>16</duration></backup><forward><duration>8</duration></forward>"
        + note("C3", 8, voice=2)
    )
    contents = read(tmp_path, document(first, note("G4", 4, '<tie type="stop"/>') + note("G4", 12)))
    assert rows(contents) == [(0, 1, 60), (0, 1, 64), (2, 4, 48), (2, 5, 67), (5, 8, 67)]
    assert contents.channels[0].numbers == [1, 2, 3, 4, 5]
    assert contents.channels[0].source == "score"


def test_tuplets_and_changed_divisions_are_exact(tmp_path: Path) -> None:
    triplet = "".join(note(name, 8) for name in ("C4", "D4", "E4"))
    finer = "<attributes><divisions>12</divisions></attributes>"
    contents = read(tmp_path, document(finer + triplet + note("F4", 24)))
    assert [row[0] for row in rows(contents)] == pytest.approx([0, 2 / 3, 4 / 3, 2])


def test_pitches_sound_as_the_part_is_transposed_from_there_on(tmp_path: Path) -> None:
    """A clarinettist changes from B flat to A clarinet."""
    down = "<attributes><transpose><diatonic>-1</diatonic><chromatic>-2</chromatic></transpose></attributes>"
    more = "<attributes><transpose><chromatic>-3</chromatic><octave-change>-1</octave-change></transpose></attributes>"
    contents = read(tmp_path, document(down + note("C5", 16), more + note("C5", 16)))
    assert [pitch for _, _, pitch in rows(contents)] == [70, 57]


def test_marks_are_at_their_notes_and_a_breath_after_a_rest_at_the_note_before(tmp_path: Path) -> None:
    technical = "<technical><fingering>1</fingering><fingering>2</fingering><double-tongue/></technical>"
    first = (
        note("C4", 4, notations=slur("start") + articulation("accent"))
        + note("D4", 4, notations=slur("stop") + articulation("breath-mark"))
        + note("E4", 4, notations=technical)
        + note("r", 4, notations=articulation("breath-mark"))
    )
    second = note("F4", 8, notations=articulation("staccato") + "<fermata/>") + note(
        "G4", 8, notations=articulation("doit")
    )
    (stream,) = read(tmp_path, document(first, second)).channels
    assert sorted(marks(stream), key=str) == sorted(
        [
            ("slur", 1, 2),
            ("accent", 1),
            ("breath", 2),
            ("fingering", 3, "1-2"),
            ("double_tongue", 3),
            ("breath", 3),
            ("staccato", 4),
            ("fermata", 4),
            ("doit", 5),
        ],
        key=str,
    )


def test_nested_slurs_of_one_number_and_slurs_across_voices(tmp_path: Path) -> None:
    """The outer slur of number 1 ends after the inner one; that of number 2 begins in voice 1 and ends in voice 2."""
    first = (
        note("C5", 4, notations=slur("start"))
        + note("D5", 4, notations=slur("start"))
        + note("E5", 4, notations=slur("stop"))
        + note("F5", 4, notations=slur("stop") + slur("start", 2))
        + "<backup><duration>4</duration></backup>"
        + note("A4", 4, voice=2)
    )
    second = (
        note("r", 16) + "<backup><duration>16</duration></backup>" + note("G4", 16, notations=slur("stop", 2), voice=2)
    )
    (stream,) = read(tmp_path, document(first, second)).channels
    # Notes are numbered by onset, then pitch: A4 comes before F5.
    assert [mark for mark in marks(stream) if mark[0] == "slur"] == [("slur", 1, 5), ("slur", 2, 3), ("slur", 5, 6)]


def test_numbers_of_slurs_go_by_the_order_of_the_file(tmp_path: Path) -> None:
    """The second slur of number 1 begins before the first one ends, but behind it in the file. A slur from a note to
    itself, which is drawn to nowhere, is none."""
    first = note("C4", 16, notations=slur("start"), voice=2)
    upper = note("C5", 8, notations=slur("start", 3) + slur("stop", 3)) + note("D5", 8, notations=slur("stop"))
    lower = note("D4", 4, voice=2) + note("E4", 12, notations=slur("start"), voice=2)
    last = note("F4", 16, notations=slur("stop"), voice=2)
    text = document(first, upper + "<backup><duration>16</duration></backup>" + lower, last)
    (stream,) = read(tmp_path, text).channels
    slurred = [[stream.pitches[number - 1] for number in mark[1:]] for mark in marks(stream) if mark[0] == "slur"]
    assert slurred == [[60, 74], [64, 65]]


def test_divisions_behind_the_notes_that_they_are_of(tmp_path: Path) -> None:
    """Noteflight writes divisions after the notes of the first measure."""
    text = document(note("C4", 8) + note("D4", 8) + ATTRIBUTES, attributes="")
    assert [row[:2] for row in rows(read(tmp_path, text))] == [(0, 2), (2, 4)]


def test_a_slur_that_ends_on_a_tied_note_ends_with_it(tmp_path: Path) -> None:
    tied = note("D4", 4, '<tie type="start"/>') + note("D4", 8, '<tie type="stop"/>', notations=slur("stop"))
    (stream,) = read(tmp_path, document(note("C4", 4, notations=slur("start")) + tied)).channels
    assert marks(stream) == [("slur", 1, 2)]
    assert stream.end_ticks == [Q, 4 * Q]


def test_grace_notes_come_before_their_note(tmp_path: Path) -> None:
    first = note("C4", 8) + note("B3", before="<grace/>") + note("D4", before="<grace/>") + note("C4", 8)
    contents = read(tmp_path, document(first))
    assert [pitch for _, _, pitch in rows(contents)] == [60, 59, 62, 60]
    onsets = [onset for onset, _, _ in rows(contents)]
    assert onsets[0] == 0
    assert onsets[3] == 2
    assert 1 < onsets[1] < onsets[2] < 2
    assert rows(contents)[0][1] == onsets[1]
    assert [mark[:2] for mark in marks(contents.channels[0])] == [("grace", 2), ("grace", 3)]


def test_a_grace_note_before_everything_takes_its_time_from_its_note(tmp_path: Path) -> None:
    contents = read(tmp_path, document(note("B3", before="<grace/>") + note("C4", 16)))
    (grace, main) = rows(contents)
    assert (grace[0], grace[2], main[1]) == (0, 59, 4)
    assert 0 < grace[1] == main[0] < 2


@pytest.mark.parametrize(
    ("ornament", "mark", "pitches"),
    [
        ("trill-mark", "trill", {67, 69}),
        ("mordent", "mordent", {67, 65}),
        ("inverted-mordent", "mordent", {67, 69}),
        ("turn", "turn", {69, 67, 65}),
        ("delayed-turn", "turn", {67, 69, 65}),
    ],
)
def test_ornaments_are_written_out_in_the_key_and_keep_their_mark(
    tmp_path: Path, ornament: str, mark: str, pitches: set[int]
) -> None:
    """In F major, the neighbours of G are A and F."""
    flat = "<attributes><key><fifths>-1</fifths></key></attributes>"
    contents = read(
        tmp_path, document(flat + note("G4", 8, notations=f"<ornaments><{ornament}/></ornaments>") + note("C4", 8))
    )
    own = [row for row in rows(contents) if row[0] < 2]
    assert {pitch for _, _, pitch in own} == pitches
    assert own[0][0] == 0
    assert own[-1][1:] == (2, 67 if mark != "turn" or ornament == "turn" else own[-1][2])
    assert all(one[1] == other[0] for one, other in pairwise(own))
    assert [row[:3] for row in marks(contents.channels[0])] == [(mark, 1, len(own))]


def test_the_neighbour_of_a_trill_is_in_the_key(tmp_path: Path) -> None:
    flat = "<attributes><key><fifths>-1</fifths></key></attributes>"
    trill = "<ornaments><trill-mark/></ornaments>"
    contents = read(tmp_path, document(flat + note("A4", 16, notations=trill)))
    assert {pitch for _, _, pitch in rows(contents)} == {69, 70}
    raised = "<ornaments><trill-mark/><accidental-mark>natural</accidental-mark></ornaments>"
    contents = read(tmp_path, document(flat + note("G4", 16, notations=raised)))
    assert {pitch for _, _, pitch in rows(contents)} == {67, 69}


def fingered(*signs: str) -> str:
    return f"<technical>{''.join(f'<fingering{sign}</fingering>' for sign in signs)}</technical>"


def test_each_note_of_a_chord_has_its_fingering_and_alternates_are_left_out(tmp_path: Path) -> None:
    chord = (
        note("E4", 4, notations=fingered(">1", ">2", ' alternate="yes">3'))
        + note("G4", 4, before="<chord/>", notations=fingered(">0"))
        + note("A4", 8, notations=f"{fingered('>12')}<ornaments><tremolo>1</tremolo></ornaments>")
    )
    stream = read(tmp_path, document(chord)).channels[0]
    found = [mark for mark in marks(stream) if mark[0] == "fingering"]
    assert found == [("fingering", 1, "1-2"), ("fingering", 2, "0"), ("fingering", 3, 6, "12")]


def test_tremolos(tmp_path: Path) -> None:
    single = "<ornaments><tremolo type='single'>{}</tremolo></ornaments>"
    first = note("C4", 4, notations=single.format(2)) + note("D4", 4, notations=single.format(3)) + note("r", 8)
    contents = read(tmp_path, document(first))
    assert rows(contents) == [(place / 4, (place + 1) / 4, 60) for place in range(4)] + [(1, 2, 62)]
    assert ("flutter_tongue", 5) in marks(contents.channels[0])
    double = "<ornaments><tremolo type='{}'>2</tremolo></ornaments>"
    pair = note("C4", 8, notations=double.format("start")) + note("E4", 8, notations=double.format("stop"))
    assert [row[2] for row in rows(read(tmp_path, document(pair)))] == [60, 64] * 8


def test_dynamics_hairpins_and_accents(tmp_path: Path) -> None:
    first = (
        dynamic("p") + note("C4", 4) + note("C4", 4, notations=articulation("accent")) + dynamic("sfz") + note("C4", 8)
    )
    second = direction('<wedge type="crescendo"/>') + note("C4", 8) + note("C4", 8) + direction('<wedge type="stop"/>')
    third = dynamic("f") + note("C4", 16)
    (stream,) = read(tmp_path, document(first, second, third)).channels
    assert stream.velocities == [49, 59, 112, 49, 72, 96]
    assert [mark for mark in marks(stream) if mark[0] in ("dynamic", "crescendo")] == [
        ("dynamic", 0, "p"),
        ("dynamic", 2 * Q, "sfz"),
        ("dynamic", 8 * Q, "f"),
        ("crescendo", 4 * Q, 8 * Q),
    ]


def test_mutes_by_words_sounds_and_signs(tmp_path: Path) -> None:
    play = "<sound><play><mute>{}</mute></play></sound>"
    bars = (
        note("C4", 16),
        words("con sord.") + note("C4", 16),
        words("senza sord.") + note("C4", 16),
        play.format("harmon-no-stem") + note("C4", 16),
        play.format("off") + note("C4", 8) + note("C4", 8, notations="<technical><stopped/></technical>"),
    )
    (stream,) = read(tmp_path, document(*bars)).channels
    assert stream.muted == ((4 * Q, 8 * Q), (12 * Q, 16 * Q), (18 * Q, 20 * Q))
    assert stream.mute_kinds == ((12 * Q, "harmon"),)
    assert stream.stopped == ((18 * Q, 20 * Q),)


def test_an_open_sign_ends_what_a_hand_stops(tmp_path: Path) -> None:
    sign = "<technical><open/></technical>"
    stopped = words("gestopft") + note("C4", 8) + note("D4", 4, notations=sign) + note("E4", 4)
    muted = words("con sord.") + note("C4", 8) + note("D4", 4, notations=sign) + note("E4", 4)
    stream = read(tmp_path, document(stopped, words("offen") + muted, name="Horn in F")).channels[0]
    assert stream.stopped == ((0, 2 * Q),)
    assert stream.muted == ((0, 2 * Q), (4 * Q, 6 * Q), (7 * Q, 8 * Q))


def test_words_have_the_tongue_flutter_until_others_end_it(tmp_path: Path) -> None:
    first = words("flz.") + note("C4", 4) + note("D4", 4) + words("ord.") + note("E4", 8)
    second = note("C4", 4) + words("flutter-tongue") + note("D4", 4) + note("E4", 8)
    stream = read(tmp_path, document(first, second)).channels[0]
    assert [mark for mark in marks(stream) if mark[0] == "flutter_tongue"] == [
        ("flutter_tongue", 1),
        ("flutter_tongue", 2),
        ("flutter_tongue", 5),
    ]


def test_a_sound_beats_a_name_which_says_size_and_key(tmp_path: Path) -> None:
    def played_on(sound: str, name: str, chromatic: int) -> str:
        said = f"<instrument-name>x</instrument-name><instrument-sound>{sound}</instrument-sound>"
        inside = f'<score-instrument id="I">{said}</score-instrument>'
        shift = f"<attributes><transpose><chromatic>{chromatic}</chromatic></transpose></attributes>"
        (stream,) = read(tmp_path, document(shift + note("C5", 16), name=name, inside=inside)).channels
        return stream.played_on

    assert played_on("brass.trombone", "Melody", 0) == "trombone"
    assert played_on("wind.reed.clarinet", "Klarinette 1", -3) == "clarinet_A"
    assert played_on("wind.reed.clarinet.bflat", "Clarinet", -2) == "clarinet"
    assert played_on("brass.trombone", "Bass Trombone", 0) == "bass_trombone"
    assert played_on("brass.tuba", "Flute", 0) == "tuba"
    # Programs write a piano for any instrument.
    assert played_on("keyboard.piano", "Flute", 0) == ""


def test_a_change_to_the_piccolo_is_a_stream_of_its_own(tmp_path: Path) -> None:
    contents = read(
        tmp_path,
        document(note("C5", 16), words("to Picc.") + note("C6", 16), words("to Fl.") + note("C5", 16), name="Flute"),
    )
    assert [(stream.played_on, stream.change, stream.numbers) for stream in contents.channels] == [
        ("", 0, [1, 3]),
        ("piccolo", 1, [2]),
    ]


def test_notes_that_name_their_instrument_need_no_words(tmp_path: Path) -> None:
    """The program wrote "to Picc." early, and nothing at the return to the flute."""
    inside = "".join(
        f'<score-instrument id="I{n}"><instrument-name>{name}</instrument-name>'
        f"<instrument-sound>wind.flutes.flute{more}</instrument-sound></score-instrument>"
        for n, name, more in ((1, "Flute", ""), (2, "Piccolo", ".piccolo"))
    )
    first, second = '<instrument id="I1"/>', '<instrument id="I2"/>'
    bars = (
        words("to Picc.") + note("C5", 16, first),
        "<attributes><transpose><chromatic>0</chromatic><octave-change>1</octave-change></transpose></attributes>"
        + note("C5", 16, second),
        "<attributes><transpose><chromatic>0</chromatic></transpose></attributes>" + note("C5", 16, first),
    )
    contents = read(tmp_path, document(*bars, name="Flute", inside=inside))
    assert [(stream.played_on, stream.numbers, stream.pitches) for stream in contents.channels] == [
        ("flute", [1, 3], [72, 72]),
        ("piccolo", [2], [84]),
    ]


def test_percussion_without_pitches(tmp_path: Path) -> None:
    inside = "".join(
        f'<score-instrument id="I{n}"><instrument-name>{name}</instrument-name>{sound}</score-instrument>'
        for n, name, sound in (
            (1, "Bass Drum", ""),
            (2, "x", "<instrument-sound>metal.cymbal.crash</instrument-sound>"),
            (3, "y", ""),
        )
    )
    inside += (
        '<midi-instrument id="I3"><midi-channel>10</midi-channel><midi-unpitched>55</midi-unpitched></midi-instrument>'
    )
    bar = "".join(note("x", 4, f'<instrument id="I{n}"/>') for n in (1, 2, 3)) + note("r", 4)
    (stream,) = read(tmp_path, document(bar, name="Drums", inside=inside)).channels
    assert (stream.use, stream.pitches) == ("rhythm", [36, 49, 54])


def test_cue_notes_are_left_out_and_time_goes_on(tmp_path: Path) -> None:
    contents = read(tmp_path, document(note("C4", 8, before="<cue/>") + note("D4", 8)))
    assert rows(contents) == [(2, 4, 62)]


def test_who_plays_and_rehearsal_marks(tmp_path: Path) -> None:
    contents = read(
        tmp_path,
        document(
            words("1. Solo") + note("C4", 16), direction("<rehearsal>A</rehearsal>") + words("a2") + note("C4", 16)
        ),
    )
    assert contents.channels[0].solos == ((0, 1), (4 * Q, 0))
    assert [(marker.tick, marker.text) for marker in contents.markers] == [(4 * Q, "A")]


def test_a_value_that_makes_no_sense_is_refused_with_its_place(tmp_path: Path) -> None:
    text = document(note("C4", 16), note("C4", 16).replace("<duration>16<", "<duration>many<"))
    with pytest.raises(FileError) as raised:
        read(tmp_path, text)
    assert raised.value.message.id == "musicxml.bad_value"
    arguments = raised.value.message.arguments
    assert (arguments["part"], arguments["measure"], arguments["element"], arguments["value"]) == (
        "Trumpet in Bb",
        "2",
        "duration",
        "many",
    )


def test_a_section_is_not_played_a_million_times(tmp_path: Path) -> None:
    again = '<barline location="right"><repeat direction="backward" times="1000000"/></barline>'
    with pytest.raises(FileError) as raised:
        read(tmp_path, document(note("C4", 16) + again))
    assert raised.value.message.id == "musicxml.bad_value"
    assert raised.value.message.arguments["value"] == "1000000"


def test_parts_in_the_order_of_the_list(tmp_path: Path) -> None:
    contents = read(
        tmp_path,
        score(listed("P1", "Flute"), listed("P2", "Tuba"), part("P2", note("C2", 16)), part("P1", note("C5", 16))),
    )
    assert [(stream.track, stream.name, stream.pitches) for stream in contents.channels] == [
        (0, "Flute", [72]),
        (1, "Tuba", [36]),
    ]


def test_a_plus_as_words_stops_a_note_and_all_as_far_as_an_o(tmp_path: Path) -> None:
    bars = (
        words("+") + note("C4", 8) + note("D4", 8),
        words("+") + note("C4", 8) + note("D4", 4) + words("o") + note("E4", 4),
    )
    (stream,) = read(tmp_path, document(*bars, name="Horn in F")).channels
    assert stream.stopped == ((0, 2 * Q), (4 * Q, 7 * Q))
    assert read(tmp_path, document(*bars, name="Trombone")).channels[0].muted == stream.stopped
    assert read(tmp_path, document(*bars, name="Flute")).channels[0].muted == ()
