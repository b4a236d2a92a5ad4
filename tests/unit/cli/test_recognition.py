"""Recognition of a track's instrument by its name, program or notes, with whole files through ``suisou inspect``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import mido
import pytest

from app.cli import main
from app.project.model import map_choices
from app.score.read import read_midi
from instrument_maps.load import bundled_maps

# Instrument for each name once a map for it exists; names without one are listed with the reason.
# fmt: off
PLAYED_ON = {
    "trumpet_Bb": [
        "Trumpet", "trumpet 1", "Trumpet in Bb", "B♭ Trumpet", "Bb Trumpet 1", "Tpt.", "Tpt 2", "TPT1", "Tpt.1",
        "1st Trumpet", "Trumpet I", "Trumpets 1-2", "Trumpet 1,2", "Solo Trumpet", "Trompete", "Trompete in B",
        "1. Trompete", "Trompeten", "Trp.", "Trp. 2", "Trompette", "Trompette en Sib", "1ère Trompette", "Tr.",
        "Tromba", "Tromba in Si b", "Tromba I", "Trombe", "Trombe in Sib", "Tr.be", "Tbe.", "トランペット",
        "トランペット1", "トランペットⅠ", "第1トランペット", "ﾄﾗﾝﾍﾟｯﾄ", "Ｔｒｕｍｐｅｔ",
        "Muted Trumpet", "Trumpet (muted)",
        "Tpt_1", "trumpet-2", "MIDI Trumpet", "Bb-Trumpet", "Lead Trumpet", "Jazz Trumpet", "Natural trumpet",
        "Naturtrompete", "Baroque Trumpet", "Barocktrompete", "TRUMPET1", "Trumpet1", "trumpet1a", "Trpt 1",
        "Clarino I", "Clarini",
    ],
    "trumpet_C": ["Trumpet in C", "C Trumpet", "Trompette en ut 1", "Trompete in C", "C管トランペット"],
    "cornet_Bb": [
        "Cornet", "Cornet in Bb", "1st Cornet", "Solo Cornet", "Kornett", "Cornetta", "Cornet à pistons", "コルネット",
    ],
    "flugelhorn_Bb": [
        "Flugelhorn", "Flügelhorn", "Fluegelhorn", "Flug.", "Flgh.", "Bugle", "Flicorno soprano",
        "フリューゲルホルン", "フリューゲル",
    ],
    "trombone_tenor_F_attachment": [
        "Trombone", "Trombone 1", "Tenor Trombone", "Tbn.", "Tbn 1", "Tbn.1", "TBN1", "Trb.", "Trb 2", "Posaune",
        "1. Posaune", "Posaunen", "Pos.", "Tenorposaune", "Altposaune", "Alto Trombone", "Trombone alto",
        "Trombone ténor", "Tromboni", "Trombone tenore", "トロンボーン", "トロンボーン2", "第2トロンボーン",
        "テナートロンボーン", "ﾄﾛﾝﾎﾞｰﾝ", "Ｔｒｏｍｂｏｎｅ", "Sackbut", "Sackbut 1", "Saqueboute", "3rd Trombone",
        "Trombone III", "Trombones", "Tbn. 1 & 2", "Tb.",
    ],
    "trombone_bass_F_Gb": [
        "Bassposaune", "Bass Posaune", "Bass Trombone", "Bass Tbn.", "B.Tbn.", "B. Tbn", "Trombone basse",
        "Trombone basso", "バストロンボーン",
    ],
    "tuba_BBb": ["Tuba", "Tuben", "Basstuba", "チューバ"],
    "horn_double_F_Bb": [
        "Horn in F", "F Horn", "French Horn", "Hörner", "Cor", "Cor en Fa", "Corno", "Corni in F", "ホルン", "Horn 1",
        "Hn. 1", "Waldhorn",
    ],
    "euphonium_Bb_bassclef": ["Euphonium", "ユーフォニアム"],
    "euphonium_baritone_Bb_treble": ["Baritone (T.C.)", "Euphonium T.C."],
    "baritone_Bb": ["Baritone", "Bariton", "Tenorhorn"],
    "sousaphone_BBb": ["Sousaphone"],
    "flute": ["Flute", "Flöte", "Flûte", "Flauto", "フルート"],
    "piccolo": ["Piccolo"],
    "clarinet_Bb": ["Clarinet in Bb", "Klarinette in B", "Clarinette", "Clarinetto", "クラリネット"],
    "clarinet_A": ["Clarinet in A", "Klarinette in A", "Clarinette en la", "Clarinetto in La"],
    "clarinet_Eb": ["Clarinet in Eb", "Es-Klarinette", "Petite clarinette", "エスクラリネット"],
    "clarinet_bass_Bb": ["Bass Clarinet", "Bassklarinette"],
    "sax_soprano_Bb": ["Soprano Sax"],
    "sax_alto_Eb": ["Alto Sax", "Alto Sax.", "Altsaxophon", "アルトサックス"],
    "sax_baritone_Eb": ["Baritone Saxophone"],
    "oboe": ["Oboe", "Hautbois", "オーボエ"],
    "english_horn": ["English Horn", "Cor anglais", "Englischhorn"],
    "bassoon": ["Fagott", "Bassoon", "Basson", "Fagotto", "ファゴット"],
    "recorder_alto_F": ["Treble Recorder", "Altblockflöte"],
    "recorder_soprano_C": ["Descant Recorder", "ソプラノリコーダー"],
    "ewi": ["EWI"],
}
PLAYED_BY_NOBODY = [
    "Violin", "Violine I", "Violon", "Violino I", "バイオリン", "Viola", "Bratsche", "Cello",
    "Violoncello", "Kontrabass", "Contrebasse", "Piano", "Klavier",
    "ピアノ", "Organ", "Orgel", "Timpani", "Pauken", "Timbales", "Timpani in C-G",
    "ティンパニ", "Drums", "Schlagzeug", "Batterie", "ドラム",
    "Snare Drum", "Percussion", "Glockenspiel", "Harp", "Harfe",
    "Guitar", "Strings", "Choir", "Tenor Horn", "Alto Horn", "Vibraphone", "Xylophone", "Bass Drum",
    "Cymbals", "Cornetto", "Zink", "Harmonica", "Voice", "Bass Guitar", "Double Bass", "Synth Bass",
]
# fmt: on
NAMED = {name: map_id for map_id, names in PLAYED_ON.items() for name in names}
PLAIN = [name for name in NAMED if name.isascii()]
"""Names used in files of many tracks; each of the others has a file of its own, in which nothing else reveals the
encoding.
"""
AT_ONCE = 40
GUESSED = {
    *(f"score.{reason}" for reason in ("outside_ranges", "instrument_from_title", "chosen_by_ensemble")),
    *(f"score.chosen_by_range{how_far}" for how_far in ("", "_partly")),
}
"""Ids of messages about instruments that neither names nor programs determine."""


def encodings(name: str) -> list[str]:
    """Encodings in which sequencers write such a name."""
    if any("\u3040" <= character <= "\u9fff" or character > "\uff00" for character in name):
        return ["utf-8", "cp932"]
    return ["utf-8", *(["latin-1"] if not name.isascii() and all(ord(character) < 256 for character in name) else [])]


def track_of(
    name: bytes = b"",
    program: int | None = None,
    channel: int = 0,
    pitches: tuple[int, ...] = (60, 62, 64),
    instrument_name: bytes = b"",
) -> mido.MidiTrack:
    """Track with given notes."""
    track = mido.MidiTrack()
    if name:
        track.append(mido.MetaMessage("track_name", name=name.decode("latin-1")))
    if instrument_name:
        track.append(mido.MetaMessage("instrument_name", name=instrument_name.decode("latin-1")))
    if program is not None:
        track.append(mido.Message("program_change", program=program, channel=channel))
    for pitch in pitches:
        track.append(mido.Message("note_on", note=pitch, velocity=80, channel=channel))
        track.append(mido.Message("note_off", note=pitch, time=480, channel=channel))
    return track


def inspected(path: Path, capsys: pytest.CaptureFixture[str], *tracks: mido.MidiTrack) -> dict[str, Any]:
    """Report on a file with some tracks."""
    mido.MidiFile(type=1, tracks=[mido.MidiTrack(), *tracks], charset="latin-1").save(path)
    assert main(["inspect", str(path), "--json"]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    assert len(found["players"]) + len(found["unplayed"]) == len(tracks)
    return found


def easy(map_id: str) -> tuple[int, int, int]:
    """Pitches in the easy range of an instrument."""
    low = bundled_maps()[map_id].range.easy_low
    return low, low + 2, low + 4


def parts(path: Path, *tracks: mido.MidiTrack) -> list[tuple[str, str]]:
    """Names of a file's parts with their recognised instruments, without planning."""
    mido.MidiFile(type=1, tracks=[mido.MidiTrack(), *tracks], charset="latin-1").save(path)
    score = read_midi(path, maps=map_choices(bundled_maps().values()))
    assert not {warning.id for warning in score.warnings} & GUESSED
    return [(part.name, part.map_id) for part in score.parts]


@pytest.mark.parametrize("first", range(0, len(PLAIN), AT_ONCE))
def test_a_name_is_enough(first: int, tmp_path: Path) -> None:
    names = PLAIN[first : first + AT_ONCE]
    tracks = [track_of(name.encode(), program=0, pitches=easy(NAMED[name])) for name in names]
    assert parts(tmp_path / "all.mid", *tracks) == [(name, NAMED[name]) for name in names]


@pytest.mark.parametrize("name", [name for name in NAMED if not name.isascii()])
def test_a_name_alone_is_enough_in_any_encoding(name: str, tmp_path: Path) -> None:
    for encoding in encodings(name):
        track = track_of(name.encode(encoding), program=0, pitches=easy(NAMED[name]))
        assert parts(tmp_path / "one.mid", track) == [(name, NAMED[name])]


@pytest.mark.parametrize("name", ["Tpt 2", "1ère Trompette", "ﾄﾗﾝﾍﾟｯﾄ"])
def test_a_player_has_the_name_of_the_part(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for encoding in encodings(name):
        track = track_of(name.encode(encoding), program=0, pitches=easy("trumpet_Bb"))
        found = inspected(tmp_path / "one.mid", capsys, track)
        assert not any("cannot be determined" in warning for warning in found["warnings"])
        (player,) = found["players"]
        assert player["instrument"] == "trumpet_Bb"
        assert player["name"] == player["part"] == name


def test_what_has_no_map_is_listed_with_its_reason(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plain = [name for name in PLAYED_BY_NOBODY if name.isascii()]
    listed = inspected(tmp_path / "all.mid", capsys, *(track_of(name.encode()) for name in plain))["unplayed"]
    assert [part["name"] for part in listed] == plain
    for name in PLAYED_BY_NOBODY:
        if not name.isascii():
            for encoding in encodings(name):
                (part,) = inspected(tmp_path / "one.mid", capsys, track_of(name.encode(encoding)))["unplayed"]
                assert part["name"] == name
                listed.append(part)
    for part in listed:
        assert part["note_count"] == 3
        assert " " in part["reason"]


@pytest.mark.parametrize(
    ("name", "program", "channel", "family"),
    [
        ("", 56, 0, "trumpet"),
        ("", 59, 3, "trumpet"),
        ("", 57, 0, "trombone"),
        ("Track 2", 57, 15, "trombone"),
        ("Melodie", 56, 0, "trumpet"),
        ("Voice 1", 56, 0, "trumpet"),
        ("Stimme 2", 57, 0, "trombone"),
        ("Trumpet", 0, 0, "trumpet"),
        ("Trumpet", 57, 0, "trumpet"),
        ("Posaune", 56, 0, "trombone"),
        ("Trombone", None, 9, "trombone"),
        ("Violin", 56, 0, None),
        ("", 40, 5, None),
        ("", 0, 0, None),
        ("", 40, 0, None),
        ("", None, 9, None),
        ("", 56, 9, None),
        ("Voice", None, 0, None),
    ],
)
def test_a_name_beats_a_number_and_a_number_nothing(
    name: str, program: int | None, channel: int, family: str | None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = inspected(tmp_path / "one.mid", capsys, track_of(name.encode(), program, channel))
    if family is None:
        assert found["unplayed"]
    else:
        assert found["players"][0]["instrument"].startswith(family)
        assert found["warnings"] == []


@pytest.mark.parametrize(
    ("pitches", "family"),
    [
        ((55, 67, 79), ("trumpet", "clarinet", "sax")),
        ((38, 53, 70), ("trombone", "horn", "bassoon")),
        ((10, 11, 12), None),
        ((120, 121, 122), None),
    ],
)
def test_the_range_decides_where_nothing_else_does(
    pitches: tuple[int, ...], family: tuple[str, ...] | None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = inspected(tmp_path / "one.mid", capsys, track_of(b"Part", pitches=pitches))
    if family is None:
        assert "Part" in found["unplayed"][0]["name"]
    else:
        assert found["players"][0]["instrument"].startswith(family)
        assert "the instrument cannot be determined from name or program" in found["warnings"][0]


def test_the_instrument_name_helps_where_the_track_name_says_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = inspected(tmp_path / "one.mid", capsys, track_of(b"A", instrument_name="トロンボーン".encode("cp932")))
    assert found["players"][0]["instrument"].startswith("trombone")
    found = inspected(tmp_path / "one.mid", capsys, track_of(b"Violin", instrument_name=b"Trombone"))
    assert found["unplayed"]


@pytest.mark.parametrize(("name", "overlap", "players"), [("Trumpet", 0, 1), ("Score", 0, 1), ("Trumpet", 240, 2)])
def test_a_player_may_use_several_channels_in_turn(
    name: str, overlap: int, players: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # Notation programs write muted notes of a trumpet in a separate channel.
    track = mido.MidiTrack([mido.MetaMessage("track_name", name=name)])
    for channel, program in ((0, 56), (1, 59)):
        track.append(mido.Message("program_change", channel=channel, program=program))
        track.append(mido.Message("control_change", channel=channel, control=11, value=90 + channel))
    places = list(enumerate((0, 0, 1, 1, 0)))
    events = [(index * 480, 80, 65 + index, channel) for index, channel in places]
    events += [(index * 480 + 480 + overlap, 0, 65 + index, channel) for index, channel in places]
    tick = 0
    for at, velocity, pitch, channel in sorted(events):
        track.append(mido.Message("note_on", note=pitch, velocity=velocity, channel=channel, time=at - tick))
        tick = at
    path = tmp_path / "mute.mid"
    mido.MidiFile(type=1, tracks=[mido.MidiTrack(), track]).save(path)
    assert main(["inspect", str(path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert len(found["players"]) == players
    assert sorted(note["pitch"] for player in found["players"] for note in player["notes"]) == [65, 66, 67, 68, 69]


def test_an_unknown_name_is_listed_with_the_remedy_and_the_remedy_works(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "one.mid"
    (part,) = inspected(path, capsys, track_of(b"Zugpfeife"))["unplayed"]
    assert "cannot be determined" in part["reason"]
    assert main(["inspect", str(path), "--json", "--assign", "zug*=oboe"]) == 0
    (player,) = json.loads(capsys.readouterr().out)["players"]
    assert (player["name"], player["instrument"]) == ("Zugpfeife", "oboe")


def test_percussion_can_be_assigned_and_taken_back(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "one.mid"
    inspected(path, capsys, track_of(b"Zugpfeife"))
    assert main(["inspect", str(path), "--json", "--assign", "zug*=percussion"]) == 0
    found = json.loads(capsys.readouterr().out)
    (part,) = found["unplayed"]
    assert (found["players"], found["percussion_hits"]) == ([], part["note_count"])
    assert part["reason"] == "Zugpfeife is percussion"
    inspected(path, capsys, track_of(b"Drum Kit", channel=9))
    assert main(["inspect", str(path), "--json", "--assign", "drum*=oboe"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert ([player["instrument"] for player in found["players"]], found["percussion_hits"]) == (["oboe"], 0)


@pytest.mark.parametrize(
    ("assignment", "said"),
    [("Zugpfeife", "PART=INSTRUMENT"), ("Zugpfeife=zither", "zither"), ("Oboe=oboe", "'Oboe'"), ("=oboe", "PART=")],
)
def test_a_wrong_assignment_is_reported(
    assignment: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    inspected(tmp_path / "one.mid", capsys, track_of(b"Zugpfeife"))
    assert main(["inspect", str(tmp_path / "one.mid"), "--assign", assignment]) == 2
    assert said in capsys.readouterr().err


def test_how_notes_begin_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    track = mido.MidiTrack([mido.MetaMessage("track_name", name="Flute")])
    before = 0
    for pitch, length in ((72, 480), (74, 480), (76, 432), (77, 240), (79, 432)):
        track.append(mido.Message("note_on", note=pitch, velocity=80, time=before))
        track.append(mido.Message("note_off", note=pitch, time=length))
        before = 480 - length
    mido.MidiFile(type=1, tracks=[mido.MidiTrack(), track]).save(tmp_path / "one.mid")
    assert main(["inspect", str(tmp_path / "one.mid"), "--json"]) == 0
    notes = json.loads(capsys.readouterr().out)["players"][0]["notes"]
    assert [note["articulation"] for note in notes] == ["tongued", "slurred", "slurred", "staccato", "tongued"]
