"""Choice of the map for a part: keys and sizes of an instrument, names in five languages, the title."""

from __future__ import annotations

import msgspec
import pytest

from app.score.instrument_choice import MapChoice
from app.score.model import Score
from instrument_maps.instrument_names import vocabulary
from tests.unit.score.midi_bytes import END, chunk, header, meta, note, score_of


def choice(map_id: str, plays: str, low: int, high: int, *substitutes: str) -> MapChoice:
    return MapChoice(map_id, (plays,), substitutes, low, high)


# Sounding ranges according to method books; the maps of a wind band, each assigned to the instrument of its name.
BAND = (
    choice("bassoon", "bassoon", 34, 75),
    choice("clarinet_A", "clarinet_A", 49, 93),
    choice("clarinet_Bb", "clarinet", 50, 94),
    choice("clarinet_Eb", "clarinet_Eb", 55, 99),
    choice("clarinet_bass_Bb", "bass_clarinet", 38, 79),
    choice("contrabassoon", "contrabassoon", 22, 53),
    choice("cornet_Bb", "cornet", 52, 82),
    choice("english_horn", "english_horn", 52, 81),
    choice("euphonium_Bb_bassclef", "euphonium", 34, 77),
    choice("euphonium_baritone_Bb_treble", "euphonium_baritone_Bb_treble", 34, 77),
    choice("ewi", "ewi", 21, 108),
    choice("flugelhorn_Bb", "flugelhorn", 52, 82),
    choice("flute", "flute", 59, 98),
    choice("horn_F_single", "horn_F_single", 35, 77),
    choice("horn_double_F_Bb", "horn", 31, 77),
    choice("oboe", "oboe", 58, 93),
    choice("piccolo", "piccolo", 74, 108),
    choice("recorder_alto_F", "recorder_alto", 65, 91),
    choice("recorder_soprano_C", "recorder_soprano", 72, 98),
    choice("sax_alto_Eb", "alto_saxophone", 49, 81),
    choice("sax_baritone_Eb", "baritone_saxophone", 36, 69),
    choice("sax_soprano_Bb", "soprano_saxophone", 56, 88),
    choice("sax_tenor_Bb", "tenor_saxophone", 44, 76),
    choice("trombone_bass_F_Gb", "bass_trombone", 28, 67),
    choice("trombone_tenor_F_attachment", "trombone", 36, 72),
    choice("trumpet_Bb", "trumpet", 52, 82),
    choice("trumpet_C", "trumpet_C", 54, 84),
    choice("tuba_BBb", "tuba", 22, 58),
    choice("tuba_CC", "tuba_CC", 24, 60),
    choice("tuba_Eb", "tuba_Eb", 27, 65),
    choice("tuba_F", "tuba_F", 29, 67),
)


def score(
    *tracks: tuple[str, tuple[int, ...]],
    title: str = "",
    stem: str = "piece",
    maps: tuple[MapChoice, ...] = BAND,
    program: int = -1,
) -> Score:
    """File of named tracks with these notes."""
    chunks = [chunk(b"MTrk", meta(3, title.encode()) + END)]
    for channel, (name, pitches) in enumerate(tracks):
        events = meta(3, name.encode())
        if program >= 0:
            events += bytes([0, 0xC0 | channel, program])
        events += b"".join(note(pitch, channel=channel) for pitch in pitches)
        chunks.append(chunk(b"MTrk", events + END))
    return score_of(header(1, len(chunks)) + b"".join(chunks), maps=maps, stem=stem)


NAMED = {
    "trumpet_Bb": [
        "Trumpet",
        "Trumpet in Bb 1",
        "Trompete in B",
        "Trompette en Sib 2",
        "Tromba in Sib",
        "トランペット1",
    ],
    "trumpet_C": [
        "Trumpet in C",
        "Trumpet in C 2",
        "C Trumpet 1",
        "Trompete in C",
        "Trompette en ut",
        "C管トランペット",
    ],
    "clarinet_Bb": ["Clarinet in Bb 1", "B♭ Clarinet 3", "Klarinette in B", "Clarinette en Sib", "Clarinetto in Sib"],
    "clarinet_A": [
        "Clarinet in A",
        "Clarinet in A 2",
        "Klarinette in A",
        "Clarinette en la",
        "Clarinetto in La",
        "A管クラリネット",
    ],
    "clarinet_Eb": ["Clarinet in Eb", "E♭ Clarinet", "Petite clarinette", "Es-Klarinette", "エスクラリネット"],
    "clarinet_bass_Bb": ["Bass Clarinet", "Bassklarinette", "Clarinette basse", "Clarone", "バスクラリネット"],
    "horn_double_F_Bb": ["Horn in F 1", "French Horn", "Horn in Es", "Cor en fa 2", "Corno in Fa", "ホルン3"],
    "horn_F_single": ["Single Horn in F", "シングルホルン"],
    "sax_alto_Eb": ["Alto Sax.", "Altsaxophon", "Saxophone alto", "Sassofono contralto", "アルトサックス"],
    "bassoon": ["Bassoon", "Fagott 2", "Basson", "Fagotto", "ファゴット"],
    "contrabassoon": ["Contrabassoon", "Kontrafagott", "Contrebasson", "コントラファゴット"],
    "euphonium_Bb_bassclef": ["Euphonium", "Eufonio", "ユーフォニアム"],
    "euphonium_baritone_Bb_treble": ["Euphonium T.C.", "Baritone (T.C.)"],
    "tuba_CC": ["Tuba in C", "CC Tuba"],
    "tuba_F": ["F Tuba", "Tuba in F"],
    "tuba_Eb": ["E♭ Bass", "Tuba in Es"],
    "ewi": ["EWI", "Wind Controller", "ウインドシンセ"],
    "recorder_soprano_C": ["Soprano Recorder", "Sopranblockflöte", "ソプラノリコーダー"],
    "recorder_alto_F": ["Treble Recorder", "Altblockflöte", "Flûte à bec alto", "アルトリコーダー"],
    "english_horn": ["Englischhorn", "Cor anglais", "Corno inglese", "コールアングレ"],
}


@pytest.mark.parametrize(("map_id", "name"), [(id, name) for id, names in NAMED.items() for name in names])
def test_a_name_with_its_key_goes_to_that_map(map_id: str, name: str) -> None:
    low, high = next((one.concert_low, one.concert_high) for one in BAND if one.map_id == map_id)
    middle = (low + high) // 2
    read = score((name, (middle, middle + 2)))
    assert [part.map_id for part in read.parts] == [map_id]
    assert read.warnings == ()


@pytest.mark.parametrize(
    ("name", "pitches", "map_id"),
    [
        ("Tuba", (30, 45), "tuba_BBb"),
        ("Tuba", (41, 60), "tuba_F"),  # Too high for the BBb tuba: the one that has it most comfortably.
        ("Tuba", (31,) * 60 + (46,) * 38 + (60, 62), "tuba_Eb"),  # Two notes above the BBb tuba's top.
        ("Tuba", (24,) * 60 + (46,) * 38 + (60, 62), "tuba_BBb"),  # No other key has them all.
        ("Trumpet", (60,) * 99 + (84,), "trumpet_Bb"),  # No one takes another trumpet for one note of a hundred.
        ("Recorder", (65, 84), "recorder_alto_F"),
        ("Recorder", (74, 96), "recorder_soprano_C"),
        ("Sax", (50, 80), "sax_alto_Eb"),
        ("Sax", (38, 60), "sax_baritone_Eb"),
        ("Clarinet", (52, 80), "clarinet_Bb"),
        ("Trombone", (36, 60), "trombone_tenor_F_attachment"),
        ("Trombone", (29, 60), "trombone_bass_F_Gb"),
    ],
)
def test_of_the_sorts_of_an_instrument_the_range_decides_where_its_own_map_does_not_fit(
    name: str, pitches: tuple[int, ...], map_id: str
) -> None:
    read = score((name, pitches))
    assert [part.map_id for part in read.parts] == [map_id]
    said = ["score.size_by_range"] if map_id == "trombone_bass_F_Gb" else []
    assert [warning.id for warning in read.warnings] == said


LINE = (60, 62, 64, 65, 67, 69, 70, 72, 74, 75, 77, 79, 77, 75, 74, 72, 70, 68, 66, 64, 62, 60, 58, 55)


@pytest.mark.parametrize(
    ("more", "map_id"),
    [
        ((), "clarinet_Bb"),
        ((45, 46, 47), "clarinet_Bb"),  # Below both: no reason for the other one.
        ((40,) * 30, "clarinet_Bb"),
        ((45, 49, 49), "clarinet_Bb"),  # The other one has not all of them either.
        ((49, 49, 49, 49), "clarinet_A"),
    ],
)
def test_notes_that_no_clarinet_reaches_choose_no_other_clarinet(more: tuple[int, ...], map_id: str) -> None:
    read = score(("Clarinet", (*LINE, *more)), program=71)
    assert [part.map_id for part in read.parts] == [map_id]
    said = [warning for warning in read.warnings if warning.id == "score.size_by_range"]
    assert [warning.arguments["map"] for warning in said] == (["clarinet_A"] if map_id == "clarinet_A" else [])
    assert all(warning.arguments["instrument"] == "Clarinet" for warning in said)


def test_a_key_without_a_map_of_its_own_is_played_by_the_usual_one_and_said_so() -> None:
    maps = tuple(one for one in BAND if one.map_id not in ("clarinet_A", "clarinet_Eb"))
    read = score(("Clarinet in A", (60, 70)), maps=maps)
    assert [part.map_id for part in read.parts] == ["clarinet_Bb"]
    assert [warning.id for warning in read.warnings] == ["score.substituted"]
    assert read.warnings[0].arguments["instrument"] == "A Clarinet"


def test_a_track_without_any_name_is_what_the_title_names() -> None:
    sax = score(("", (59, 80)), title="solo_altosax_bach")
    assert [(part.map_id, part.instrument, part.name) for part in sax.parts] == [
        ("sax_alto_Eb", "alto_saxophone", "Alto Saxophone")
    ]
    assert [warning.id for warning in sax.warnings] == ["score.instrument_from_title"]
    duo = score(("", (60, 86)), ("", (36, 62)), title="oboe_bassoon_devienne_sonata2")
    assert [part.map_id for part in duo.parts] == ["oboe", "bassoon"]
    mixed = score(("Sopran", (65, 81)), ("Alt", (62, 77)), ("Tenor", (45, 62)), title="cornets and trombones")
    assert [part.map_id for part in mixed.parts] == ["cornet_Bb", "cornet_Bb", "trombone_tenor_F_attachment"]


@pytest.mark.parametrize("stem", ["solo_altosax_bach", "brass quintet", "トランペット", "percussion", "01 - Tuba"])
def test_what_the_file_is_called_changes_nothing(stem: str) -> None:
    tracks = (("", (59, 80)), ("Sopran", (65, 81)), ("Track 3", (36, 62)))
    read, renamed = score(*tracks), score(*tracks, stem=stem)
    assert (read.title, renamed.title) == ("piece", stem)
    assert msgspec.structs.replace(renamed, title=read.title) == read


def test_the_title_is_ignored_where_a_track_says_something_or_does_not_fit() -> None:
    assert [part.map_id for part in score(("Oboe", (60, 70)), title="trumpet").parts] == ["oboe"]
    (part,) = score(("", (36, 50)), title="trumpet tune").parts
    assert (part.map_id == "trumpet_Bb", part.instrument) == (False, None)
    # Abbreviations mean nothing in a title.
    assert score(("", (60, 70)), title="tr ob fl").warnings[0].id == "score.chosen_by_range"


def test_a_wide_or_rare_instrument_is_given_to_no_one_by_range_alone() -> None:
    for pitches in ((36, 96), (60, 70), (30, 40), (80, 96)):
        for part in score(("", pitches)).parts:
            assert part.map_id not in ("ewi", "piccolo", "clarinet_A", "tuba_CC", "contrabassoon", "trumpet_C")


def test_a_section_is_divided_among_its_own() -> None:
    families = {"trumpet_Bb", "cornet_Bb", "horn_double_F_Bb", "trombone_tenor_F_attachment", "tuba_BBb"}
    families |= {"euphonium_Bb_bassclef"}
    for pitches in ((70, 80), (55, 65), (45, 55), (30, 40)):
        assert {part.map_id for part in score(("Brass", pitches)).parts} <= families
        assert not {part.map_id for part in score(("Woodwinds", pitches)).parts} & families
        assert {part.map_id for part in score(("Sopran", pitches), title="brass quintet").parts} <= families


def test_every_instrument_has_a_japanese_name() -> None:
    names = {one.japanese for one in vocabulary().instruments.values()}
    without_kana = {name for name in names if not any("ぁ" <= letter <= "ヺ" for letter in name)}
    assert without_kana == {
        "尺八",
        "金管楽器",
        "木管楽器",
        "管楽器",
        "民族管楽器",
        "弦楽",
        "小物打楽器",
        "撥弦楽器",
        "効果音",
        "歌手",
    }


def test_every_wind_sits_somewhere_and_every_sort_is_of_something() -> None:
    words = vocabulary()
    for instrument in words.instruments.values():
        if instrument.kind == "wind" and not instrument.any_pitch:
            assert instrument.family, instrument.id
        if instrument.sort_of:
            assert words.is_sort(instrument.id, instrument.sort_of)
