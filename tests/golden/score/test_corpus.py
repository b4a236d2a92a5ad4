"""Music from public editions: the score contains what is in the files according to their sources and mido."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import mido
import pytest

from app.project.importing import import_project, usual_rows
from app.project.model import map_choices
from app.project.storage import decode, encode
from app.score.model import Note, Score
from app.score.read import read_contents, read_midi
from instrument_maps.load import bundled_maps
from resources.build import arrange_example, compose_dance_example
from tests.unit.score.midi_bytes import MAPS
from tests.unit.score.titled import titled_copy

DATA = Path(__file__).parents[2] / "data/midi"
QUARTET = Path(__file__).parents[3] / "resources/examples/quartet.mid"
MONTUNO = QUARTET.with_name("montuno.mid")
READABLE = sorted([*(DATA / "ensemble").glob("*.mid"), *(DATA / "awkward").glob("*.mid")])


def score_of(name: str) -> Score:
    return read_midi(DATA / "ensemble" / f"{name}.mid", maps=MAPS)


def players(score: Score) -> list[tuple[str, str, int]]:
    return [(part.name, part.map_id, len(part.notes)) for part in score.parts]


def notes_of_file(score: Score) -> list[Note]:
    """Notes of the players, with one copy of notes that several play in unison."""
    notes = [note for part in score.parts for note in part.notes]
    return [note for note in notes if int(note.id.split(":")[1]) < 10_000_000]


@pytest.mark.parametrize("path", READABLE, ids=lambda path: path.stem)
def test_every_file_opens_and_no_note_is_lost(path: Path) -> None:
    score = read_midi(path, maps=MAPS)
    try:
        file = mido.MidiFile(path, clip=True)
    except (OSError, EOFError, mido.KeySignatureError):
        return  # what mido refuses is judged by the next test
    onsets: Counter[int] = Counter()
    unplayed = sum(part.note_count for part in score.unplayed)
    tracks = file.tracks
    for track in tracks:
        tick = 0
        for message in track:
            tick += message.time
            if message.type == "note_on" and message.velocity:
                onsets[message.note] += 1
    played = Counter(note.pitch for note in notes_of_file(score))
    assert sum(played.values()) + unplayed == sum(onsets.values())
    assert not played - onsets


@pytest.mark.parametrize("path", [*READABLE, QUARTET], ids=lambda path: path.stem)
def test_a_project_that_was_saved_and_loaded_is_saved_as_the_same_bytes(path: Path) -> None:
    maps, file = bundled_maps(), Path("/music/piece.suisou")
    contents = read_contents(path)
    content = encode(import_project(contents, usual_rows(contents, maps), maps, str(path)), file)
    assert encode(decode(content, file), file) == content


@pytest.mark.parametrize(
    ("path", "notes"),
    [
        ("awkward/keysig_9sharps_beethoven_coriolan.mid", 8525),
        ("ensemble/reed_trio_mozart_k229_mv1.mid", 532),
        ("awkward/test-non-midi-track.mid", 8),
        ("awkward/test-running-status-sysex.mid", 8),
        ("corrupt/test-illegal-message-all.mid", 8),
        ("corrupt/test-illegal-message-f4.mid", 8),
        ("corrupt/test-corrupt-file-missing-byte.mid", 8),
        ("corrupt/MIDIBadTrackLength.mid", 4),
        ("corrupt/MIDIBadHeaderLength.mid", 4),
    ],
)
def test_what_mido_refuses_opens_with_all_its_notes(path: str, notes: int) -> None:
    score = read_midi(DATA / path, maps=MAPS)
    assert len(notes_of_file(score)) + sum(part.note_count for part in score.unplayed) == notes


@pytest.mark.parametrize("name", ["brass_quartet_lutkin_2tpt_tbn_tuba", "trombone_quartet_bach_air"])
def test_the_length_is_what_mido_computes(name: str) -> None:
    score = score_of(name)
    assert score.tempo_map.seconds(score.end_tick) == pytest.approx(
        mido.MidiFile(DATA / "ensemble" / f"{name}.mid").length, abs=1e-6
    )


def test_the_lutkin_quartet_waits_for_a_tuba() -> None:
    score = score_of("brass_quartet_lutkin_2tpt_tbn_tuba")
    assert players(score) == [("trumpet", "trumpet", 82), ("trumpet", "trumpet", 81), ("trombone", "trombone", 88)]
    assert [(part.name, part.reason.id, part.note_count) for part in score.unplayed] == [("tuba", "score.no_map", 91)]
    assert len(score.tempo_map.changes) > 50
    assert score.warnings == ()


def test_pezel_five_part_sonata_in_three_tracks(tmp_path: Path) -> None:
    score = read_midi(titled_copy(DATA / "ensemble" / "brass_quintet_pezel_sonata21.mid", tmp_path), maps=MAPS)
    by_name = Counter((part.name, part.map_id) for part in score.parts)
    # Two sopranos, one tenor, two basses: that the lower doubles some cadences in octaves makes no sixth.
    assert by_name == {("Sopran", "trumpet"): 2, ("Tenor", "trombone"): 1, ("Bass", "trombone"): 2}
    means = [sum(note.pitch for note in part.notes) / len(part.notes) for part in score.parts if part.name == "Bass"]
    assert means == sorted(means, reverse=True)


def test_the_subject_of_the_fugato_stays_with_one_player(tmp_path: Path) -> None:
    # Bar 8: a line alone in the sopranos' track, leaping a fourth and a fifth; bar 14 the answer, before a chord above.
    score = read_midi(titled_copy(DATA / "ensemble" / "brass_quintet_pezel_sonata21.mid", tmp_path), maps=MAPS)
    for bar, subject in ((8, [67, 66, 67, 69, 69, 71, 64, 66, 64, 64, 63]), (14, [66, 64, 66, 67, 67, 69, 62])):
        first, last = score.metre_map.tick_of_bar(bar), score.metre_map.tick_of_bar(bar + (2 if bar == 8 else 1))
        lines = [
            [note.pitch for note in part.notes if first <= note.onset_tick < last]
            for part in score.parts
            if part.name == "Sopran"
        ]
        assert subject in lines
        assert [] in lines


def test_programs_of_the_band_are_kept_by_track_though_channels_are_shared() -> None:
    score = score_of("concert_band_hall_tenth_regiment_march")
    assert Counter(part.map_id for part in score.parts) == {"trumpet": 6, "trombone": 4}
    channels = Counter(part.channel for part in score.parts)
    assert channels[14] == 1
    assert all(part.program == (56 if part.map_id == "trumpet" else 57) for part in score.parts)
    left = Counter(part.reason.arguments["instrument"] for part in score.unplayed)
    assert left == {
        "Flute": 2, "Oboe": 1, "Bassoon": 1, "Clarinet": 5, "Alto Saxophone": 1, "Tenor Saxophone": 1,
        "Baritone Saxophone": 1, "Horn": 4, "Tuba": 1, "Drums": 1, "Glockenspiel": 1, "Timpani": 1,
    }  # fmt: skip


def test_speer_names_voices_only_so_the_title_and_ranges_decide() -> None:
    score = score_of("cornets_sackbuts_speer_sonata")
    assert [(part.name, part.map_id) for part in score.parts] == [
        ("Sopran", "trumpet"),
        ("Alt", "trumpet"),
        ("Tenoro", "trombone"),
        ("Tenoru", "trombone"),
        ("Tenoru", "trombone"),
    ]
    assert sum(warning.id == "score.instrument_from_title" for warning in score.warnings) == 4  # one for each track


def test_the_bundled_quartet_is_what_its_script_makes(tmp_path: Path) -> None:
    arrange_example.arrange(mido.MidiFile(arrange_example.SOURCE)).save(tmp_path / "quartet.mid")
    assert (tmp_path / "quartet.mid").read_bytes() == QUARTET.read_bytes()


@pytest.mark.parametrize(
    ("midi", "made"),
    [
        (QUARTET, lambda: arrange_example.arrange_score(mido.MidiFile(arrange_example.SOURCE))),
        (MONTUNO, compose_dance_example.compose_score),
    ],
)
def test_the_bundled_scores_are_what_their_scripts_make_and_have_the_notes_of_the_midi_files(
    midi: Path, made: Callable[[], bytes]
) -> None:
    path = midi.with_suffix(".musicxml")
    assert path.read_bytes() == made()
    score, sound = read_contents(path), read_contents(midi)
    assert (score.title, score.metres, score.warnings) == (sound.title, sound.metres, ())
    # A MIDI file has whole microseconds.
    assert [change.tick for change in score.tempo_map.changes] == [change.tick for change in sound.tempo_map.changes]
    for one, other in zip(score.tempo_map.changes, sound.tempo_map.changes, strict=True):
        assert one.microseconds_per_quarter == pytest.approx(other.microseconds_per_quarter, abs=0.5)
    for written, heard in zip(score.channels, sound.channels, strict=True):
        assert written.name == heard.name
        notes = list(zip(written.onset_ticks, written.pitches, written.end_ticks, strict=True))
        played = list(zip(heard.onset_ticks, heard.pitches, heard.end_ticks, strict=True))
        assert sorted(note[:2] for note in notes) == sorted(note[:2] for note in played)
        if written.use == "rhythm":
            continue
        # The MIDI file ends long notes early, for breaths; points and wedges shorten what it plays in full.
        quarter = score.tempo_map.ticks_per_quarter
        short = {mark.note_id for mark in written.marks if mark.kind in ("staccato", "marcato") and mark.note_id}
        for number, (onset, _, end), (_, _, heard_end) in zip(written.numbers, notes, played, strict=True):
            if f"{written.track + 1}:{number}" in short:
                assert end <= heard_end
            else:
                assert end - heard_end in (0, quarter // 2, quarter), onset


def test_the_bundled_piece_with_a_dancer(tmp_path: Path) -> None:
    compose_dance_example.compose().save(tmp_path / "montuno.mid")
    assert (tmp_path / "montuno.mid").read_bytes() == MONTUNO.read_bytes()
    score = read_midi(MONTUNO, maps=map_choices(bundled_maps().values()))
    assert [(part.name, part.map_id) for part in score.parts] == [
        ("Trumpet 1", "trumpet_Bb"),
        ("Trumpet 2", "trumpet_Bb"),
        ("Trombone", "trombone_tenor_F_attachment"),
        ("Tuba", "tuba_BBb"),
    ]
    assert score.warnings == ()
    assert [part.name for part in score.unplayed] == ["Drums"]
    assert len(score.percussion) == score.unplayed[0].note_count > 300
    assert score.tempo_map.seconds(score.end_tick) < 40
    for part in score.parts:
        assert all(one.end_tick <= other.onset_tick for one, other in itertools.pairwise(part.notes)), part.name


def test_the_bundled_quartet() -> None:
    score = read_midi(QUARTET, maps=MAPS)
    assert [(part.name, part.map_id) for part in score.parts] == [
        ("Trumpet 1", "trumpet"),
        ("Trumpet 2", "trumpet"),
        ("Trombone 1", "trombone"),
        ("Trombone 2", "trombone"),
    ]
    assert (score.warnings, score.unplayed) == ((), ())
    assert 60 <= score.tempo_map.seconds(score.end_tick) <= 100
    for part in score.parts:
        low, high = (52, 82) if part.map_id == "trumpet" else (40, 70)
        assert all(low <= note.pitch <= high for note in part.notes)
        gaps = [b.onset_tick - a.end_tick for a, b in zip(part.notes, part.notes[1:], strict=False)]
        assert min(gaps) >= 0
        assert len({note.velocity for note in part.notes}) > 10
    assert len(score.tempo_map.changes) > 5


WINDS = {
    "brass_quartet_lutkin_2tpt_tbn_tuba": ["trumpet_Bb", "trumpet_Bb", "trombone_tenor_F_attachment", "tuba_"],
    "concert_band_hall_tenth_regiment_march": [
        *["flute"] * 2, "oboe", "bassoon", *["clarinet_Bb"] * 5, "sax_alto_Eb", "sax_tenor_Bb", "sax_baritone_Eb",
        *["trumpet_Bb"] * 6, *["horn_double_F_Bb"] * 4, *["trombone_tenor_F_attachment"] * 4, "tuba_BBb",
    ],
    "cornets_sackbuts_speer_sonata": ["cornet_Bb"] * 2 + ["trombone_tenor_F_attachment"] * 3,
    "flute_oboe_viola_holst_terzetto_mv2_CCBY4": ["flute", "oboe"],
    "oboe_bassoon_devienne_sonata2": ["oboe", "bassoon"],
    "orch_brandenburg2_mv1_trumpet_recorder_oboe": ["trumpet_Bb", "flute", "oboe"],
    "recorder_duet_telemann_mv2": ["recorder_alto_F"] * 2,
    "reed_trio_mozart_k229_mv1": ["oboe", "clarinet_Bb", "bassoon"],
    "solo_altosax_bach_partita_allemande": ["sax_alto_Eb"],
    "solo_cornet_arban_first_study10": ["cornet_Bb"],
    "solo_flute_bach_partita_corrente": ["flute"],
    "solo_horn_mozart_k447_mv1": ["horn_double_F_Bb"],
    "solo_trumpet_bach_bist_du_bei_mir": ["trumpet_Bb"],
    "trombone_quartet_bach_air": [*["trombone_tenor_F_attachment"] * 3, "trombone_bass_F_Gb"],
    "trumpet_duet_bach_minuet": ["trumpet_Bb"] * 2,
    "trumpet_organ_brown_wedding_CCBY4": ["trumpet_Bb"],
}  # fmt: skip
"""Wind players of each file in order, according to its title and score."""


@pytest.mark.parametrize(("name", "expected"), WINDS.items(), ids=WINDS)
def test_every_wind_of_the_ensembles_finds_its_instrument(name: str, expected: list[str], tmp_path: Path) -> None:
    own = map_choices(bundled_maps().values())
    missing = {map_id for map_id in expected if not any(choice.map_id.startswith(map_id) for choice in own)}
    score = read_midi(titled_copy(DATA / "ensemble" / f"{name}.mid", tmp_path), maps=own)
    found = [part.map_id for part in score.parts]
    if missing:
        # Parts of an instrument without a map are listed, or played by another instrument with a warning.
        known = [map_id for map_id in expected if map_id not in missing]
        assert not Counter(known) - Counter(found)
        return
    assert all(one.startswith(requested) for one, requested in zip(found, expected, strict=True))
    assert {part.reason.id for part in score.unplayed} <= {"score.percussion", "score.not_wind", "score.stray_notes"}
    assert not [warning for warning in score.warnings if warning.id == "score.substituted"]
