"""What instruments are called, in five languages."""

import tomllib

import pytest

from app.errors import MapError
from instrument_maps.library import all_maps
from instrument_maps.vocabulary import PATH, Instrument, Vocabulary, vocabulary

CALLED = {
    "trumpet": [
        "Trumpet",
        "trumpets",
        "TRUMPET 2",
        "B♭ Trumpet 1",
        "Bb Trumpet",
        "Tpt. 2",
        "Tpt2",
        "1st Tp",
        "2nd Trp.",
        "B-Trompete",
        "Trompeten in B",
        "Tromba in Sib",
        "Trombe",
        "Trumpet_1",
        "Solo-Trumpet",
        "トランペット",
        "1stトランペット",
        "第2トランペット",
        "ﾄﾗﾝﾍﾟｯﾄ1",
        "trumpetOne",
        "Ｔｒｕｍｐｅｔ",
    ],
    "trumpet_C": ["Trumpet in C", "Trompette en ut"],
    "recorder_alto": ["Alto Recorder", "Treble Recorder"],
    "cornet": ["Cornet", "Solo Cornet Bb", "Kornett 1", "Cornet à pistons", "Cornetta", "コルネット"],
    "cornett": ["Cornetto", "Cornett", "Zink", "Cornetti"],
    "flugelhorn": ["Flugelhorn", "Flügelhorn 2", "Fluegelhorn", "Bugle", "Flicorno", "フリューゲルホルン"],
    "horn": [
        "Horn",
        "French Horn 1",
        "Horn in F",
        "Hn. 3",
        "Corno I",
        "Corni in Mi♭",
        "Cors en fa",
        "Cor",
        "Hörner",
        "ホルン",
    ],
    "trombone": ["Trombone", "Tbn. 1", "Trb", "Tb.2", "Posaune 3", "Pos.", "Tenorposaune", "Tromboni", "トロンボーン"],
    "bass_trombone": [
        "Bass Trombone",
        "B. Tbn.",
        "Bassposaune",
        "Trombone basso",
        "Trombone basse",
        "バストロンボーン",
    ],
    "alto_trombone": ["Alto Trombone", "Altposaune"],
    "tuba": ["Tuba", "Tuben", "B♭ Tuba", "チューバ"],
    "euphonium": ["Euphonium", "Euph.", "ユーフォニアム"],
    "english_horn": ["Cor anglais", "English Horn", "Englischhorn", "Corno inglese", "Engl. Hn."],
    "basset_horn": ["Basset Horn", "Bassetthorn", "Corno di bassetto"],
    "flute": ["Flute", "Fl. 1", "Flöte", "Flûte traversière", "Flauto", "Große Flöte", "フルート"],
    "piccolo": ["Piccolo", "Flauto piccolo", "Petite flûte", "ピッコロ"],
    "recorder": ["Recorder", "Blockflöte", "Flûte à bec", "Flauto dolce"],
    "oboe": ["Oboe", "Hautbois 2", "Ob.", "オーボエ"],
    "bassoon": ["Bassoon", "Fagott", "Basson", "Fagotto", "Fg.", "ファゴット"],
    "contrabassoon": ["Contrabassoon", "Kontrafagott", "Contrebasson", "Controfagotto"],
    "clarinet": ["Clarinet in Bb", "B♭ Clarinet 3", "Cl.", "Klarinette", "Clarinette", "Clarinetto", "クラリネット"],
    "bass_clarinet": ["Bass Clarinet", "Bassklarinette", "Clarinette basse", "B. Cl.", "バスクラリネット"],
    "alto_saxophone": ["Alto Sax", "Alto Saxophone 1", "A. Sax", "Altsaxophon", "Saxophone alto", "アルトサックス"],
    "tenor_saxophone": ["Tenor Sax.", "T.Sax", "テナーサックス"],
    "timpani": ["Timpani", "Pauken", "Timbales", "ティンパニ"],
    "bass_drum": ["Bass Drum", "Große Trommel", "Grosse caisse", "Gran cassa"],
    "double_bass": ["Double Bass", "Contrabass", "Kontrabass", "Contrebasse"],
    "cello": ["Violoncello", "Cello", "Vc."],
}


@pytest.mark.parametrize(("instrument", "text"), [(key, text) for key, texts in CALLED.items() for text in texts])
def test_a_name_is_recognised(instrument: str, text: str) -> None:
    found = vocabulary().by_name(text)
    assert found is not None
    assert found.id == instrument


@pytest.mark.parametrize(
    "text",
    [
        "",
        "Alto",
        "Sopran",
        "Tenor",
        "Bass",
        "Soprano 1",
        "Melody",
        "Solo",
        "Track 3",
        "Cornwall",
        "Hornpipe",
        "Tubular",
        "1",
        "♭",
    ],
)
def test_voices_and_words_that_only_begin_like_an_instrument_are_none(text: str) -> None:
    assert vocabulary().by_name(text) is None


def test_general_midi_is_covered_once() -> None:
    table = tomllib.loads(PATH.read_text(encoding="utf-8"))
    programs = sorted(program for instrument in table["instruments"] for program in instrument.get("programs", []))
    assert programs == list(range(128))


@pytest.mark.parametrize(
    ("program", "instrument"),
    [
        (56, "trumpet"),
        (57, "trombone"),
        (58, "tuba"),
        (60, "horn"),
        (65, "alto_saxophone"),
        (71, "clarinet"),
        (73, "flute"),
        (0, "piano"),
    ],
)
def test_programs_count_from_zero(program: int, instrument: str) -> None:
    found = vocabulary().by_program(program)
    assert found is not None
    assert found.id == instrument


def test_what_the_bundled_maps_play_is_in_the_vocabulary_and_blown() -> None:
    known = vocabulary().instruments
    named = {id_ for instrument in all_maps().values() for id_ in (*instrument.plays, *instrument.substitutes_for)}
    assert named
    assert all(known[id_].kind == "wind" for id_ in named)


def test_a_name_that_belongs_to_two_is_refused() -> None:
    with pytest.raises(MapError, match="blow"):
        Vocabulary((Instrument("a", "wind", ("Blow",)), Instrument("b", "wind", ("blow!",))), "test.toml")
