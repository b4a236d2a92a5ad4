"""A played file has the same players as the engraved one; key switches, and names of sections with numbers."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from app.errors import Message
from app.messages import text
from app.project.model import map_choices
from app.score.assignments import PartAssignment
from app.score.contents import assigned_score
from app.score.model import Score
from app.score.read import read_contents, read_midi
from app.score.track_instrument import players_named
from instrument_maps.load import bundled_maps
from tests.support.played import Manner, played
from tests.unit.score.midi_bytes import END, TROMBONE, TRUMPET, chunk, header, meta, note, score_of
from tests.unit.score.titled import titled, titled_copy

MIDI = Path(__file__).parents[2] / "data" / "midi" / "ensemble"
MAPS = map_choices(bundled_maps().values())
# The thresholds were chosen on the files at even places of the folder; those at odd places were kept out of it.
TUNED = ["brass_quartet_lutkin_2tpt_tbn_tuba", "reed_trio_mozart_k229_mv1", "trombone_quartet_bach_air"]
KEPT_OUT = ["brass_quintet_pezel_sonata21", "cornets_sackbuts_speer_sonata", "trumpet_duet_bach_minuet"]


def players(score: Score) -> Counter[str]:
    return Counter(part.map_id for part in score.parts)


def strays(score: Score) -> int:
    return sum(part.note_count for part in score.unplayed if part.reason.id == "score.stray_notes")


@pytest.mark.parametrize("stem", [*TUNED, *KEPT_OUT])
def test_a_played_file_has_the_players_of_the_engraved_one(stem: str, tmp_path: Path) -> None:
    engraved = read_midi(titled_copy(MIDI / f"{stem}.mid", tmp_path), maps=MAPS)
    path = tmp_path / "played.mid"
    path.write_bytes(titled(played(MIDI / f"{stem}.mid", seed=1), stem.replace("_", " ")))
    live = read_midi(path, maps=MAPS)
    assert players(live) == players(engraved)
    # Nothing but key switches is left out of a line, and every slur stays one.
    assert strays(live) <= strays(engraved) + 0.005 * sum(len(part.notes) for part in engraved.parts)
    read = [pitch for stream in read_contents(MIDI / f"{stem}.mid").channels for pitch in stream.pitches]
    lowest, highest = min(read), max(read)
    assert all(lowest <= one.pitch <= highest + 2 for part in live.parts for one in part.notes)


def test_a_quintet_in_three_tracks_is_five_players(tmp_path: Path) -> None:
    score = read_midi(titled_copy(MIDI / "brass_quintet_pezel_sonata21.mid", tmp_path), maps=MAPS)
    assert len(score.parts) == 5


@pytest.mark.parametrize(
    ("name", "count"),
    [
        ("Horn 1.2", 2),
        ("Horn 1 & 2", 2),
        ("Hörner I/II", 2),
        ("Clarinet 1, 2", 2),
        ("Trombones 1-3", 3),
        ("1st and 2nd Trumpet", 2),
        ("Cor III+IV", 2),
        ("Trompete 1. und 2.", 2),
        ("クラリネット1・2", 2),
        ("Flute a2", 2),
        ("Trumpet", 1),
        ("Trumpet 2", 1),
        ("Clarinet in A 2", 1),
        ("Trumpet in B♭ 1", 1),
        ("Horn in F", 1),
        ("Saxophone I", 1),
        ("Violin I", 1),
    ],
)
def test_a_name_may_count_its_players(name: str, count: int) -> None:
    assert players_named(name) == count


def named(name: str, events: bytes, maps: tuple = (TRUMPET, TROMBONE)) -> Score:  # type: ignore[type-arg]
    return score_of(
        header(1, 2) + chunk(b"MTrk", END) + chunk(b"MTrk", meta(3, name.encode()) + events + END), maps=maps
    )


def test_what_two_players_on_a_staff_have_alone_is_played_by_both() -> None:
    chord = bytes([0, 0x90, 67, 64, 0, 0x90, 72, 64, 48, 0x80, 67, 0, 0, 0x80, 72, 0])
    score = named("Trumpet 1.2", b"".join(note(pitch) for pitch in (60, 62, 64, 65)) + chord)
    assert [[one.pitch for one in part.notes] for part in score.parts] == [[60, 62, 64, 65, 72], [60, 62, 64, 65, 67]]
    assert len({one.id for part in score.parts for one in part.notes}) == 10
    (warning,) = score.warnings
    assert warning.id == "score.voices"
    assert warning.arguments == {"part": "Trumpet 1.2", "voices": 2, "count": 2, "place": "1.3.000", "pitch": 67}


def switch(pitch: int) -> bytes:
    """Short note just before the next one."""
    return note(pitch, ticks=6)


def test_key_switches_are_left_out_and_reported() -> None:
    music = b"".join(note(pitch) for pitch in (60, 62, 64))
    score = named("Trumpet", (switch(24) + music + switch(26) + music) * 2)
    (part,) = score.parts
    assert [one.pitch for one in part.notes] == [60, 62, 64] * 4
    (silent,) = score.unplayed
    warning = silent.reason
    assert (score.warnings, warning.id, silent.note_count) == ((), "score.key_switches", 4)
    assert warning.arguments == {"part": "Trumpet", "count": 4, "place": "1.1.000", "pitch": 24}
    assert "at 1.1.000 (C1)" in text(warning)


def test_a_key_switch_that_is_held_below_the_music_is_no_player() -> None:
    music = bytes([0, 0x90, 24, 90]) + b"".join(note(pitch) for pitch in (60, 62, 64, 65)) + bytes([0, 0x80, 24, 0])
    (part,) = named("Trumpet", music * 4).parts
    assert {one.pitch for one in part.notes} == {60, 62, 64, 65}


def test_low_notes_that_are_music_stay() -> None:
    # Long, alone, or near enough to the range: wrong perhaps, but played.
    slow = note(30, ticks=120) + b"".join(note(pitch) for pitch in (60, 62, 64))
    (part,) = named("Trumpet", slow * 3).parts
    assert [one.pitch for one in part.notes] == [30, 60, 62, 64] * 3
    (part,) = named("Trumpet", (switch(49) + note(60) + note(62)) * 3).parts
    assert [one.pitch for one in part.notes] == [49, 60, 62] * 3


@pytest.mark.parametrize("name", ["Zugpfeife", "Lead", "Take 3", "旋律"])
@pytest.mark.parametrize("program", [b"", bytes([0, 0xC0, 0])])
def test_an_unknown_name_is_asked_about(name: str, program: bytes) -> None:
    """Also with program 0 (piano), which many programs write by default."""
    score = named(name, program + note(60) + note(62))
    assert score.parts == ()
    assert [(part.name, part.reason.id) for part in score.unplayed] == [(name, "score.unknown_instrument")]


@pytest.mark.parametrize("name", ["", "Track 1", "Piano", "ピアノ", "钢琴"])
def test_a_piano_that_is_called_nothing_else_is_one(name: str) -> None:
    (part,) = named(name, bytes([0, 0xC0, 0]) + note(60) + note(62)).unplayed
    assert part.reason == Message("score.not_wind", {"instrument": "Piano"})


@pytest.mark.parametrize(
    "name", ["", "Track 1", "MIDI 03", "Part", "トラック 2", "Untitled", "音轨 1", "Дорожка 2", "트랙 1"]
)
def test_where_no_one_named_a_track_its_range_chooses_and_says_so(name: str) -> None:
    score = named(name, note(60) + note(62))
    assert [warning.id for warning in score.warnings] == ["score.chosen_by_range"]


def test_who_says_what_an_unknown_name_is_gets_it(tmp_path: Path) -> None:
    path = tmp_path / "piece.mid"
    track = meta(3, b"Zugpfeife") + note(60) + note(62)
    path.write_bytes(header(1, 2) + chunk(b"MTrk", END) + chunk(b"MTrk", track + END))
    contents = read_contents(path)
    (part,) = assigned_score(contents, [PartAssignment((0,), "trumpet")], (TRUMPET, TROMBONE)).parts
    assert (part.map_id, part.name) == ("trumpet", "Zugpfeife")
    # Ticked but not answered, it still waits.
    assert assigned_score(contents, [PartAssignment((0,))], (TRUMPET, TROMBONE)).parts == ()


def test_a_few_low_notes_do_not_change_a_named_instrument() -> None:
    low = tuple(choice for choice in MAPS if choice.map_id.startswith("trumpet"))
    (part,) = named("Trumpet", b"".join(note(60) for _ in range(30)) + note(53) + note(88) + note(89), low).parts
    assert part.map_id == "trumpet_Bb"


@pytest.mark.parametrize(
    "manner",
    [
        # Two notes beside each other may be early and late: overlaps of 5 to 75 ms.
        Manner(overlap_s=(0.005, 0.045), early_or_late_s=0.015, graced=0.0, key_switches=False, rubato=0.1),
        Manner(slurred=0.0, early_or_late_s=0.015, graced=0.3, key_switches=False),
    ],
    ids=["overlaps, tempo ramps", "grace notes"],
)
def test_what_is_usual_in_played_files_warns_of_nothing(manner: Manner, tmp_path: Path) -> None:
    path = tmp_path / "piece.mid"
    source = MIDI / "solo_trumpet_bach_bist_du_bei_mir.mid"
    path.write_bytes(titled(played(source, 3, manner), "Trumpet solo"))
    score = read_midi(path, maps=MAPS)
    assert {warning.id for warning in score.warnings} <= {"score.instrument_from_title"}
    assert (score.unplayed, len(score.parts)) == ((), 1)
    assert len(score.tempo_map.changes) > 20
