"""Files as notation programs write them, and the players a musician reads in them."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.project.model import map_choices
from app.score.model import Score
from app.score.mutes import is_muted
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.unit.score.midi_bytes import END, chunk, header, note, score_of

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
    tracks = [
        b"".join(
            (
                bytes([0, 0xC0 | channel, program]) if program is not None else b"",
                *(note(pitch, channel=channel) for pitch in line(*one)),
            )
        )
        for channel, one in enumerate(lines)
    ]
    data = header(1, len(tracks)) + b"".join(chunk(b"MTrk", events + END) for events in tracks)
    found = [part.map_id for part in score_of(data, maps=CHOICES).parts]
    assert len(found) == len(lines)
    assert all(one.startswith(asked) for one, asked in zip(found, maps.split(), strict=True)), found


def line(median: int, half: int) -> list[int]:
    """Pitches up and down about a median."""
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
