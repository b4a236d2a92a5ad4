"""Files from notation programs, with the players that a musician would recognise."""

from __future__ import annotations

import itertools
import random
from pathlib import Path

import pytest

from app.project.model import map_choices
from app.score.model import Score
from app.score.mutes import is_muted
from app.score.read import read_midi
from app.score.solos import words_of_players
from instrument_maps.load import bundled_maps
from tests.unit.score.midi_bytes import END, chunk, header, meta, note, score_of

CASES = Path(__file__, "../../../data/import_cases").resolve()
CHOICES = map_choices(bundled_maps().values())


def read(stem: str) -> Score:
    (file,) = CASES.glob(f"{stem}_*.mid")
    return read_midi(file, maps=CHOICES)


@pytest.mark.parametrize(
    ("stem", "maps"),
    [
        ("09", ["trumpet_Bb"]),
        ("10", ["sax_soprano_Bb", "sax_alto_Eb", "sax_tenor_Bb", "sax_baritone_Eb"]),
        ("12", ["horn_double_F_Bb", "horn_double_F_Bb"]),
        ("13", ["horn_double_F_Bb"]),
        ("14", ["flute", "oboe", "clarinet_Bb", "horn_double_F_Bb", "bassoon"]),
        ("25", ["clarinet_A"]),
        ("27", ["tuba_Eb"]),
        ("28", ["horn_double_F_Bb", "horn_double_F_Bb"]),
    ],
)
def test_every_track_gets_the_players_it_is_for(stem: str, maps: list[str]) -> None:
    assert [part.map_id for part in read(stem).parts] == maps


def test_open_and_muted_channels_of_a_staff_are_one_player_who_uses_a_mute() -> None:
    (part,) = read("09").parts
    assert sum(is_muted(part.muted, note.onset_tick) for note in part.notes) == 16
    assert len(part.notes) == 48


def test_a_program_that_cannot_play_the_part_gives_way_and_says_so() -> None:
    score = read("12")
    (said,) = [warning for warning in score.warnings if warning.id == "score.program_gives_way"]
    assert said.arguments["instrument"] == "English Horn"
    assert said.arguments["map"] == "horn_double_F_Bb"
    # An English horn goes down to E 3.
    assert said.arguments["outside"] == sum(note.pitch < 52 for part in score.parts for note in part.notes) > 0
    assert score.unplayed == ()


def test_a_known_ensemble_is_reported_for_each_of_its_parts() -> None:
    reported = [warning for warning in read("14").warnings if warning.id == "score.chosen_by_ensemble"]
    assert [warning.arguments["map"] for warning in reported] == [part.map_id for part in read("14").parts]


@pytest.mark.parametrize(
    ("lines", "maps"),
    [
        # Median, and half the compass about it, of each staff from the top.
        (((70, 8), (66, 8), (60, 8), (52, 8), (41, 9)), "trumpet_ trumpet_ horn_ trombone_tenor tuba_"),
        (((78, 9), (72, 9), (67, 10), (58, 9), (50, 10)), "flute oboe clarinet_ horn_ bassoon"),
        (((71, 9), (65, 9), (58, 9), (49, 9)), "sax_soprano sax_alto sax_tenor sax_baritone"),
        (((69, 8), (60, 9), (51, 9)), "trumpet_ horn_ trombone_tenor"),
        (((72, 9), (66, 10), (52, 10)), "oboe clarinet_ bassoon"),
        (((70, 8), (65, 8), (61, 8), (55, 8), (51, 9), (43, 8)), "clarinet_ clarinet_ horn_ horn_ bassoon bassoon"),
    ],
)
@pytest.mark.parametrize("program", [None, 0])
def test_ensembles_without_names_get_their_usual_instruments(
    lines: tuple[tuple[int, int], ...], maps: str, program: int | None
) -> None:
    data = unnamed([line(*one) for one in lines], program)
    found = [part.map_id for part in score_of(data, maps=CHOICES).parts]
    assert len(found) == len(lines)
    assert all(one.startswith(asked) for one, asked in zip(found, maps.split(), strict=True)), found


def unnamed(lines: list[list[int]], program: int | None) -> bytes:
    """File with a track of even notes for each line, without names."""
    tracks = []
    for channel, pitches in enumerate(lines):
        chosen = bytes([0, 0xC0 | channel, program]) if program is not None else b""
        tracks.append(chosen + b"".join(note(pitch, channel=channel) for pitch in pitches))
    return header(1, len(tracks)) + b"".join(chunk(b"MTrk", events + END) for events in tracks)


COMPASSES = {
    # Good compasses according to orchestration books, at sounding pitch.
    "sax_soprano": (60, 82), "sax_alto": (52, 78), "sax_tenor": (46, 72), "sax_baritone": (38, 62),
    "clarinet_": (53, 82), "clarinet_bass": (40, 65), "trumpet_": (58, 80), "trombone_tenor": (45, 67),
    "trombone_bass": (35, 60), "horn_": (48, 74), "tuba_": (31, 52), "flute": (62, 91), "oboe": (60, 84),
    "bassoon": (38, 65),
}  # fmt: skip


ENSEMBLES = (
    "sax_soprano sax_alto sax_tenor sax_baritone",
    "sax_soprano sax_alto sax_alto sax_tenor sax_baritone",
    "trumpet_ trumpet_ trombone_tenor trombone_tenor",
    "trumpet_ trumpet_ trombone_tenor tuba_",
    "trumpet_ trumpet_ horn_ trombone_tenor tuba_",
    "clarinet_ clarinet_ clarinet_",
    "clarinet_ clarinet_ clarinet_ clarinet_bass",
    "clarinet_ clarinet_ clarinet_ clarinet_",
    "trombone_tenor trombone_tenor trombone_tenor trombone_bass",
    "horn_ horn_ horn_ horn_",
    "flute oboe clarinet_ horn_ bassoon",
    "flute flute flute",
)


def test_lines_that_use_the_whole_compass_are_known_by_it() -> None:
    tracks = []
    for parts, seed in itertools.product(ENSEMBLES, range(4)):
        by_chance, lines = random.Random(f"{parts}{seed}"), []
        for part in parts.split():
            low, high = COMPASSES[part]
            pitches = [(low + high) // 2]
            for place in range(1, 64):
                step = by_chance.choice((-4, -3, -2, -2, -1, 1, 2, 2, 3, 5))
                pitches.append({20: low, 42: high}.get(place, min(max(pitches[-1] + step, low), high)))
            lines.append(pitches)
        found = [part.map_id for part in score_of(unnamed(lines, None), maps=CHOICES).parts]
        tracks += [(asked, one) for asked, one in zip(parts.split(), found, strict=True)]
    wrong = [(asked, one) for asked, one in tracks if not one.startswith(asked)]
    assert len(wrong) <= 0.02 * len(tracks), wrong


def test_chords_in_one_of_several_unnamed_tracks_of_pianos_leave_them_pianos() -> None:
    """Three lines with the default program are an ensemble of winds; with chords, the program is meant as piano."""
    lines = [line(70, 8), line(60, 9), line(51, 9)]
    assert len(score_of(unnamed(lines, 0), maps=CHOICES).parts) == 3
    chords = bytes([0, 0xC3, 0]) + b"".join(
        bytes([0, 0x93, 48, 80, 0, 0x93, 52, 80, 0, 0x93, 55, 80, 96, 0x83, 48, 0, 0, 0x83, 52, 0, 0, 0x83, 55, 0])
        for _ in range(24)
    )
    data = unnamed(lines, 0)
    data = header(1, 4) + data[len(header(1, 3)) :] + chunk(b"MTrk", chords + END)
    read = score_of(data, maps=CHOICES)
    assert read.parts == ()
    assert {part.reason.id for part in read.unplayed} == {"score.not_wind"}


def line(median: int, half: int) -> list[int]:
    """Pitches up and down around a median."""
    return [
        median,
        median + half // 2,
        median + half,
        median + 2,
        median,
        median - 2,
        median - half,
        median - half // 2,
    ] * 3


def test_a_program_stays_where_a_tenth_of_the_notes_is_not_beyond_its_range() -> None:
    low = next(choice.concert_low for choice in CHOICES if choice.map_id == "english_horn")
    events = bytes([0, 0xC0, 69]) + b"".join(map(note, [60, 62, 64] * 10 + [low - 1]))
    score = score_of(header(1, 2) + chunk(b"MTrk", END) + chunk(b"MTrk", events + END), maps=CHOICES)
    assert [part.map_id for part in score.parts] == ["english_horn"]
    assert score.warnings == ()


@pytest.mark.parametrize("stem", ["a woodwind quintet", "Brass Quintet", "トランペット", "01"])
@pytest.mark.parametrize("file", sorted(CASES.glob("*.mid")), ids=lambda file: file.stem[:2])
def test_what_a_file_is_called_decides_nothing(file: Path, stem: str, tmp_path: Path) -> None:
    copy = tmp_path / f"{stem}.mid"
    copy.write_bytes(file.read_bytes())
    before, now = read_midi(file, maps=CHOICES), read_midi(copy, maps=CHOICES)
    assert (now.parts, now.unplayed, now.warnings) == (before.parts, before.unplayed, before.warnings)


def test_the_second_horn_rests_in_a_solo() -> None:
    score = read("28")
    first, second = score.parts
    from_solo = 12 * score.ticks_per_quarter
    assert [note.onset_tick for note in second.notes if note.onset_tick >= from_solo] == []
    assert [note.onset_tick for note in first.notes if note.onset_tick >= from_solo] != []
    assert [note.onset_tick for note in second.notes] == [
        note.onset_tick for note in first.notes if note.onset_tick < from_solo
    ]


@pytest.mark.parametrize(
    ("text", "player"),
    [
        *[(text, 1) for text in ("1. Solo", "Solo", "1.", "I. Solo", "Solo I", "1st only", "1er", "1°", "(1. solo)")],
        *[(text, 2) for text in ("2.", "II. solo", "2nd only", "Solo 2", "2. ソロ")],
        *[(text, 0) for text in ("a2", "a 2", "à 2", "zu 2", "unis.", "tutti", "div.", "Soli", "1.2.", "both")],
    ],
)
def test_words_over_a_staff_say_who_plays(text: str, player: int) -> None:
    assert words_of_players([(96, text)]) == ((96, player),)


@pytest.mark.parametrize("text", ["1", "A", "rit.", "2x", "solo voice enters", "Allegro", "dolce", "12.", "a tempo"])
def test_other_words_say_nothing_about_players(text: str) -> None:
    assert words_of_players([(96, text)]) == ()


def test_the_second_player_has_a_solo_until_notes_sound_together() -> None:
    chords = b"".join(bytes([0, 0x90, 67, 64, 0, 0x90, 60, 64, 48, 0x80, 67, 0, 0, 0x80, 60, 0]) for _ in range(8))
    events = meta(3, b"Horns 1.2") + bytes([0, 0xC0, 60]) + chords + meta(1, b"2. Solo")
    events += b"".join(map(note, (64, 65, 67, 69))) + chords + b"".join(map(note, (64, 62, 60, 62)))
    score = score_of(header(1, 2) + chunk(b"MTrk", END) + chunk(b"MTrk", events + END), maps=CHOICES)
    first, second = ([note.onset_tick // 48 for note in part.notes] for part in score.parts)
    assert first == [*range(8), *range(12, 24)]
    assert second == [*range(24)]
