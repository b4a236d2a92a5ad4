"""Played tracks with their instrument maps, and the reasons for others not being played."""

from __future__ import annotations

import pytest

from app.score.instrument_choice import MapChoice
from app.score.model import Score
from tests.unit.score.midi_bytes import END, MAPS, TROMBONE, TRUMPET, chunk, header, ids, meta, note, score_of


def one_part(
    *pitches: int,
    name: str = "",
    instrument: str = "",
    program: int | None = None,
    channel: int = 0,
    maps: tuple[MapChoice, ...] = MAPS,
) -> Score:
    """Score with one track of players."""
    events = meta(3, name.encode()) + meta(4, instrument.encode())
    if program is not None:
        events += bytes([0, 0xC0 | channel, program])
    events += b"".join(note(pitch, channel=channel) for pitch in pitches)
    return score_of(header(1, 2) + chunk(b"MTrk", END) + chunk(b"MTrk", events + END), maps=maps)


@pytest.mark.parametrize(
    ("options", "map_id", "instrument"),
    [
        ({"name": "Trompete"}, "trumpet", "trumpet"),
        ({"name": "Solo", "instrument": "Posaune"}, "trombone", "trombone"),
        ({"program": 56}, "trumpet", "trumpet"),
        ({"program": 59}, "trumpet", "trumpet"),
        ({"program": 57}, "trombone", "trombone"),
        ({"name": "Trombone", "program": 0}, "trombone", "trombone"),
        ({"name": "Trumpet", "channel": 9}, "trumpet", "trumpet"),
    ],
)
def test_names_and_programs_tell(options: dict[str, object], map_id: str, instrument: str) -> None:
    score = one_part(60, 62, **options)
    (part,) = score.parts
    assert (part.map_id, part.instrument) == (map_id, instrument)
    assert score.warnings == ()


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({"program": 58}, "score.no_map"),
        ({"name": "Horn in F"}, "score.no_map"),
        ({"program": 0}, "score.not_wind"),
        ({"name": "Violine"}, "score.not_wind"),
        ({"name": "Pauken"}, "score.percussion"),
        ({"channel": 9}, "score.percussion"),
        ({"channel": 9, "program": 56}, "score.percussion"),
        ({"program": 47}, "score.percussion"),
    ],
)
def test_what_is_not_played_is_listed_with_its_reason(options: dict[str, object], reason: str) -> None:
    score = one_part(60, 62, 64, **options)
    assert score.parts == ()
    (left,) = score.unplayed
    assert (left.reason.id, left.note_count) == (reason, 3)
    assert left.name


@pytest.mark.parametrize(
    ("options", "instrument"),
    [
        ({"name": "和太鼓"}, "和太鼓"),
        ({"name": "Shime Taiko 2"}, "Shime Taiko 2"),
        ({"name": "三味線"}, "三味線"),
        ({"name": "Solo", "instrument": "Erhu"}, "Erhu"),
        ({"name": "Klavier"}, "Piano"),
        ({"name": "Track 4", "program": 116}, "Auxiliary Percussion"),
        ({"program": 105}, "Plucked Instrument"),
        ({"program": 0}, "Piano"),
    ],
)
def test_what_is_not_played_is_called_as_the_score_calls_it(options: dict[str, object], instrument: str) -> None:
    score = one_part(60, 62, 64, **options)
    assert [part.reason.arguments.get("instrument") for part in score.unplayed] == [instrument]


def test_an_instrument_without_a_map_is_played_by_a_substitute_with_a_warning() -> None:
    score = one_part(60, 62, name="Kornett")
    (part,) = score.parts
    assert (part.map_id, part.instrument, part.name) == ("trumpet", "cornet", "Kornett")
    (warning,) = score.warnings
    assert (warning.id, warning.arguments["map"]) == ("score.substituted", "trumpet")


def test_an_own_map_goes_before_a_substitute() -> None:
    cornet = MapChoice("cornet", ("cornet",), (), 52, 82)
    score = one_part(60, 62, name="Cornet", maps=(*MAPS, cornet))
    assert (score.parts[0].map_id, score.warnings) == ("cornet", ())


@pytest.mark.parametrize(
    ("pitches", "map_id"),
    [
        ((40, 50), "trombone"),
        ((70, 80), "trumpet"),
        ((52, 66), "trombone"),
        ((57, 74), "trumpet"),
        ((36, 70), "trombone"),
    ],
)
def test_a_part_that_says_nothing_goes_to_the_map_whose_range_fits(pitches: tuple[int, ...], map_id: str) -> None:
    score = one_part(*pitches)
    assert (score.parts[0].map_id, score.parts[0].instrument) == (map_id, None)
    assert ids(score) == ["score.chosen_by_range"]


def test_a_range_that_fits_mostly_is_said_so_and_one_that_does_not_is_refused() -> None:
    mostly = one_part(80, 81, 82, 83)
    assert mostly.parts[0].map_id == "trumpet"
    assert mostly.warnings[0].arguments == {
        "part": "Trumpet",
        "map": "trumpet",
        "outside": 1,
        "total": 4,
        "count": 1,
        "place": "1.2.048",
        "pitch": 83,
    }
    refused = one_part(82, 83, 84, 85)
    assert refused.parts == ()
    assert refused.unplayed[0].reason.id == "score.outside_ranges"
    assert one_part(60, maps=()).unplayed[0].reason.id == "score.outside_ranges"


def test_a_brass_section_is_divided_by_range() -> None:
    events = bytes([0, 0xC0, 61]) + b"".join(bytes([0, 0x90, pitch, 64]) for pitch in (74, 65, 48)) + meta(1, b"", 96)
    score = score_of(header() + chunk(b"MTrk", events + END))
    assert [(part.map_id, part.voice, part.name) for part in score.parts] == [
        ("trumpet", 0, "Brass"),
        ("trumpet", 1, "Brass"),
        ("trombone", 2, "Brass"),
    ]
    assert [part.id for part in score.parts] == ["1.1.1", "1.1.2", "1.1.3"]
    assert "score.voices" in ids(score)


def test_a_part_without_name_is_called_after_its_instrument() -> None:
    assert one_part(60, program=56).parts[0].name == "Trumpet"
    assert one_part(60, instrument="tromba").parts[0].name == "tromba"
    assert one_part(45, maps=(TRUMPET, TROMBONE)).parts[0].name == "Trombone"


CLARINET = MapChoice("clarinet", ("clarinet",), (), 50, 70, transposition_semitones=2)


def test_a_part_beyond_its_range_that_fits_as_written_is_read_and_said_so() -> None:
    score = one_part(52, 60, 72, name="Clarinet", maps=(CLARINET,))
    assert [note.pitch for note in score.parts[0].notes] == [50, 58, 70]
    (warning,) = score.warnings
    assert warning.id == "score.read_as_written"
    assert warning.arguments == {
        "part": "Clarinet",
        "map": "clarinet",
        "outside": 1,
        "total": 3,
        "count": 1,
        "place": "1.2.000",
        "pitch": 72,
    }
    # Beyond both, or within as it sounds: nothing is known.
    assert one_part(51, 60, 72, name="Clarinet", maps=(CLARINET,)).warnings == ()
    assert one_part(52, 60, 70, name="Clarinet", maps=(CLARINET,)).warnings == ()
    # A single wrong note in a long part is ignored.
    assert one_part(*[60] * 120, 72, name="Clarinet", maps=(CLARINET,)).warnings == ()
