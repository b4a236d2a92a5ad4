"""Names of instruments in many languages."""

import tomllib
import unicodedata
from pathlib import Path

import pytest

from app.errors import MapError
from instrument_maps.instrument_names import PATH, Vocabulary, vocabulary
from instrument_maps.instruments import Instrument, VocabularyTable
from instrument_maps.library import all_maps

DATA = Path(__file__).parents[2] / "data"


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
    assert found.id == instrument


def test_what_the_bundled_maps_play_is_in_the_vocabulary_and_blown() -> None:
    known = vocabulary().instruments
    named = {id_ for instrument in all_maps().values() for id_ in (*instrument.plays, *instrument.substitutes_for)}
    assert named
    assert all(known[id_].kind == "wind" for id_ in named)


def test_a_name_that_belongs_to_two_is_refused() -> None:
    both = Instrument("a", "wind", ("Blow",)), Instrument("b", "wind", ("blow!",))
    with pytest.raises(MapError, match="blow"):
        Vocabulary(VocabularyTable(instruments=both), "test.toml")


@pytest.mark.parametrize(
    ("id_", "names"),
    [
        ("trumpet", "小号|第一小号|小號2|降B调小号|트럼펫 1|제2트럼펫|Труба|Трубы|1-я труба|партия трубы"),
        ("horn", "圆号|法國號|F调圆号|호른 1,2|Валторна|Валторны 1, 2|ВАЛТОРНА"),
        ("trombone", "长号|伸縮號|트롬본|Тромбон|Тромбоны"),
        ("bass_trombone", "低音长号|베이스 트롬본|Бас-тромбон"),
        ("euphonium", "上低音號|次中音号|유포니움|Эуфониум"),
        ("flute", "长笛|第二长笛|플루트|플룻 2|Флейта I|Флейты"),
        ("oboe", "双簧管|雙簧管|오보에|Гобои"),
        ("clarinet", "单簧管|豎笛|降B单簧管|클라리넷|Кларнет in B|Кларнет си-бемоль"),
        ("clarinet_A", "A调单簧管|Кларнет in A"),
        ("bass_clarinet", "低音單簧管|베이스클라리넷|Бас-кларнет"),
        ("bassoon", "巴松|大管|바순|Фагот"),
        ("alto_saxophone", "中音萨克斯管|薩克斯風 中音|알토 색소폰|Саксофон-альт|альтсаксофон"),
        ("tenor_saxophone", "次中音薩克斯|테너색소폰|Теноровый саксофон"),
        ("english_horn", "英国管|잉글리시 호른|Английский рожок"),
        ("drums", "架子鼓|드럼|Ударные"),
        ("cello", "大提琴|첼로|Виолончель"),
        ("ewi", "电吹管|EWI4000s|YDS-120|WX-7|WX11|Roland AE-30|Aerophone GO|re.corder|ECORDER|Sylphyo Link|NuRAD"),
    ],
)
def test_names_in_chinese_korean_and_russian_and_of_wind_controllers(id_: str, names: str) -> None:
    found = {name: vocabulary().by_name(name) for name in names.split("|")}
    assert {name: one.id if one else None for name, one in found.items()} == dict.fromkeys(found, id_)


NAMES = {
    line.partition(": ")[0]: line.partition(": ")[2].split(" | ")
    for line in (DATA / "instrument_names.txt").read_text(encoding="utf-8").splitlines()
    if not line.startswith("#")
}


@pytest.mark.parametrize("id_", NAMES)
def test_names_as_notation_programs_have_them_in_many_languages(id_: str) -> None:
    for name in NAMES[id_]:
        spoken = [name, f"{name} 1", f"2. {name}", name.upper(), name.lower()]
        if max(name) < "\u0370" and not {*"äæ"} & {*name.lower()}:
            spoken.append(unmarked(name))
        for text in spoken:
            found = vocabulary().by_name(text)
            assert found is not None, text
            assert found.id == id_ or id_ == found.kind == "percussion", (text, found.id)


def unmarked(name: str) -> str:
    """Name without accents, as typed without them."""
    letters = unicodedata.normalize("NFD", name.translate(str.maketrans("łŁøØı", "lLoOi")))
    return "".join(letter for letter in letters if not unicodedata.combining(letter))


def test_every_instrument_with_a_map_has_names_in_many_languages() -> None:
    played = {id_ for instrument in all_maps().values() for id_ in instrument.plays}
    assert played - NAMES.keys() == {"euphonium_baritone_Bb_treble"}


def test_what_is_easy_on_an_instrument_is_what_its_map_says() -> None:
    """Compared at sounding pitch."""
    for instrument, compass in vocabulary().ranges.items():
        assert compass.low <= compass.easy_low < compass.easy_high <= compass.high
        for one in all_maps().values():
            if one.plays[0] == instrument:
                assert (compass.easy_low, compass.easy_high) == (one.range.easy_low, one.range.easy_high), instrument
