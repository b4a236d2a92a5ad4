"""Players' names of keys in both languages, and fingerings in these words."""

from __future__ import annotations

import re
from collections import defaultdict
from string import Formatter

import msgspec
import pytest

from app.errors import Message
from app.messages import FINGERINGS, WORDINGS, text
from app.plan.model import Problem
from app.plan.problem_lines import problem_lines
from app.score.model import Score
from app.score.tempo import TempoMap
from instrument_maps.fingering_label import says_words
from instrument_maps.fingering_words import fingering_words, in_words, key_name
from instrument_maps.load import bundled_maps, parse_map
from instrument_maps.model import ChartKey, InstrumentMap
from instrument_maps.validate import problems

MAPS = [pytest.param(instrument, id=id) for id, instrument in bundled_maps().items()]
CLARINET = bundled_maps()["clarinet_Bb"]
_JAPANESE = re.compile("[぀-ヿ一-鿿]")
SAXOPHONE = bundled_maps()["sax_alto_Eb"]


@pytest.mark.parametrize("instrument", MAPS)
def test_every_control_has_a_name_of_its_own_in_both_languages(instrument: InstrumentMap) -> None:
    controls = [control.name for control in instrument.controls]
    assert sorted(key.name for key in instrument.chart) == sorted(controls)
    for language in ("en", "ja"):
        names = [key_name(instrument, name, language) for name in controls]
        assert len(set(names)) == len(names)
        assert all(bool(_JAPANESE.search(name)) == (language == "ja") for name in names)
        # No word is the map's own sign, since L1 and R2 are used by players.
        signs = {control.label for control in instrument.controls} - {f"{hand}{n}" for hand in "LR" for n in range(10)}
        assert not signs & set(names)


@pytest.mark.parametrize("instrument", MAPS)
def test_two_ways_to_play_a_note_are_two_in_words_as_well(instrument: InstrumentMap) -> None:
    for language in ("en", "ja"):
        words = defaultdict(list)
        for fingering in instrument.fingerings:
            words[fingering.written_pitch].append(fingering_words(instrument, fingering.label, language))
        assert all(len(set(own)) == len(own) for own in words.values())


@pytest.mark.parametrize(
    ("id", "label", "english", "japanese"),
    [
        ("clarinet_Bb", "L1 L2 L3 R T", "thumb hole + register key + L1·2·3", "親指の穴 + レジスターキー + 左1·2·3"),
        ("clarinet_Bb", "R S3 S4", "register key + side key 3·4", "レジスターキー + サイドキー 3·4"),
        ("clarinet_Bb", "(open)", "open", "開放"),
        ("sax_alto_Eb", "hfs oct pd peb", "octave key + palm D key + palm E♭ key + high F♯ key",
         "オクターブキー + パーム D キー + パーム E♭ キー + ハイ F♯ キー"),
        ("recorder_soprano_C", "l1 l2 lth", "thumb hole half open + hole 1·2", "裏穴（半開） + 穴 1·2"),
        ("bassoon", "L1 Lt_w", "whisper key + L1", "ウィスパーキー + 左1"),
        ("ewi", "L1 Rp3 o4", "L1 + low C key + octave roller 4", "左1 + 低音 C キー + オクターブローラー 4"),
        ("trumpet_Bb", "13", "13", "13"),
        ("trombone_tenor_F_attachment", "T3", "T3", "T3"),
        ("clarinet_Bb", "not a sign of it", "not a sign of it", "not a sign of it"),
    ],
)  # fmt: skip
def test_a_fingering_in_words(id: str, label: str, english: str, japanese: str) -> None:
    instrument = bundled_maps()[id]
    assert fingering_words(instrument, label, "en") == english
    assert fingering_words(instrument, label, "ja") == japanese


PUBLISHED = {
    # The Woodwind Fingering Guide (wfg.woodwind.org); keys of the clarinet's little fingers by the notes of both
    # registers (central-gakki.jp and method books), trill keys of the flute after R. Dick, The Other Flute.
    "clarinet_Bb": ({"register", "A", "G♯", "E♭/B♭", "C♯/G♯", "F♯/C♯", "E/B", "F/C", "B/F♯", "A♭/E♭"}, {"F/C キー"}),
    "flute": (
        {"G♯", "E♭", "low C♯", "low C", "D trill", "D♯ trill", "thumb B♭"},
        {"ブリチアルディキー", "D♯ トリルキー"},
    ),
    "oboe": (
        {"octave", "G♯", "low B", "low B♭", "left E♭", "left F", "F key", "E♭", "low C♯", "low C"},
        {"オクターブキー"},
    ),
    "bassoon": ({"whisper", "C♯", "low D", "low C", "low B", "low B♭", "flick", "pancake"}, {"ウィスパーキー"}),
    "sax_alto_Eb": ({"octave", "palm D", "palm E♭", "palm F", "front F", "bis", "side C", "side B♭"}, {"低音 C キー"}),
    "recorder_alto_F": ({"thumb hole", *(f"hole {number}" for number in range(1, 8))}, {"裏穴", "穴 7"}),
}
"""Names in published tables, and Japanese ones, of parts of a key's name."""


@pytest.mark.parametrize("id", PUBLISHED)
def test_keys_have_the_names_of_published_charts(id: str) -> None:
    chart = bundled_maps()[id].chart
    english, japanese = PUBLISHED[id]
    assert all(any(name in key.en for key in chart) for name in english)
    assert all(any(name in key.ja for key in chart) for name in japanese)


def test_messages_say_keys_by_their_names() -> None:
    message = Message("fingering.trill", {"label": "1L oct sc", "first": "2L oct", "time_ms": 90})
    said = text(in_words(message, SAXOPHONE, "en"))
    assert said.startswith("octave key + L1 + side C key instead of octave key + L2: ")
    assert "サイド C キー" in text(in_words(message, SAXOPHONE, "ja"), "ja")
    reach = Message("contact.out_of_reach", {"label": "pf", "control": "key_palm_F", "gap_mm": 5})
    assert text(in_words(reach, SAXOPHONE, "en")).startswith("palm F key is out of reach for this player: palm F key")
    # Without an instrument nothing is known, and the score's text is quoted unchanged.
    assert in_words(message, None, "en") == message
    quoted = Message("fingering.not_in_map", {"label": "oct", "note": "1:1"})
    assert in_words(quoted, SAXOPHONE, "en") == quoted


def test_lines_of_a_report_say_keys_by_their_names() -> None:
    score = Score("Piece", 480, TempoMap(480))
    early = Message("fingering.starts_early", {"label": "oct sc", "needed_ms": 80, "available_ms": 60, "note": "1:1"})
    for language, name in (("en", "side C key"), ("ja", "サイド C キー")):
        (line,) = problem_lines(
            [Problem(early, None, 0.0, 1.0)],
            score,
            lambda message, language=language: text(message, language),
            instrument=SAXOPHONE,
        )
        assert name in line


def test_every_message_with_fingerings_has_them() -> None:
    for id, names in FINGERINGS.items():
        fields = {field for _, field, _, _ in Formatter().parse(WORDINGS[id][0])}
        assert set(names) <= fields, id


def test_a_map_without_names_says_its_signs() -> None:
    bare = msgspec.structs.replace(CLARINET, chart=())
    assert says_words(bare.controls)
    assert fingering_words(bare, "L1 L2 T", "ja") == "T + L1·2"
    assert key_name(bare, "key_R", "en") == "R"
    assert key_name(bare, "no_such_key", "en") == "no such key"


def test_names_that_are_used_twice_or_name_nothing_are_reported() -> None:
    rows = (
        ChartKey("hole_T", "thumb", "親指"),
        ChartKey("key_R", "thumb", " ", "too long", (99.0, 0.0)),
        ChartKey("x", "y", "z"),
    )
    found = dict(problems(msgspec.structs.replace(CLARINET, chart=rows)))
    assert found == {
        "chart[1].en": "'thumb' is used twice",
        "chart[1].ja": "is empty",
        "chart[1].sign": "is longer than 4 characters",
        "chart[1].at": "99 is not between -12 and 12",
        "chart[2].name": "there is no control named 'x'",
    }


def test_names_go_with_what_extends_and_leave_with_a_control() -> None:
    oboe, horn = bundled_maps()["oboe"], bundled_maps()["english_horn"]
    assert {key.name for key in oboe.chart} - {key.name for key in horn.chart} == {"key_B_flat"}
    own = 'extends = "trumpet_Bb"\nid = "mine"\nchart = [{ name = "valve_2", en = "second", ja = "2 番" }]\n'
    mine = parse_map(own, "mine.toml")
    assert [key.en for key in mine.chart[:3]] == ["valve 1", "second", "valve 3"]
