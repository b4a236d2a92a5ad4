"""Who plays a track, by its name, its number or its notes: whole files through ``suisou inspect``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import mido
import pytest

from app.cli import main

# fmt: off
TRUMPET = [
    "Trumpet", "trumpet 1", "Trumpet in Bb", "B♭ Trumpet", "Bb Trumpet 1", "Trumpet in C", "C Trumpet",
    "Tpt.", "Tpt 2", "TPT1", "Tpt.1", "1st Trumpet", "Trumpet I", "Trumpets 1-2", "Trumpet 1,2",
    "Solo Trumpet", "Trompete", "Trompete in B", "1. Trompete", "Trompeten", "Trp.", "Trp. 2", "Trompette",
    "Trompette en Sib", "1ère Trompette", "Tr.", "Tromba", "Tromba in Si b", "Tromba I", "Trombe",
    "Trombe in Sib", "Tr.be", "Tbe.",
    "トランペット", "トランペット1", "トランペットⅠ", "第1トランペット", "ﾄﾗﾝﾍﾟｯﾄ", "Ｔｒｕｍｐｅｔ",
    "Cornet", "Cornet in Bb", "1st Cornet", "Solo Cornet", "Kornett", "Cornetta", "Cornet à pistons",
    "コルネット", "Flugelhorn", "Flügelhorn", "Fluegelhorn", "Flug.", "Flgh.", "Bugle", "Flicorno soprano",
    "フリューゲルホルン", "フリューゲル", "Muted Trumpet", "Trumpet (muted)", "Tpt_1", "trumpet-2", "MIDI Trumpet",
    "Bb-Trumpet", "Lead Trumpet", "Jazz Trumpet", "Natural trumpet", "Naturtrompete", "Baroque Trumpet",
    "Barocktrompete", "TRUMPET1", "Trumpet1", "trumpet1a", "Trpt 1", "Clarino I", "Clarini",
]
TROMBONE = [
    "Trombone", "Trombone 1", "Tenor Trombone", "Tbn.", "Tbn 1", "Tbn.1", "TBN1", "Trb.", "Trb 2", "Posaune",
    "1. Posaune", "Posaunen", "Pos.", "Tenorposaune", "Bassposaune", "Bass Posaune", "Bass Trombone",
    "Bass Tbn.", "B.Tbn.", "B. Tbn", "Altposaune", "Alto Trombone", "Trombone alto", "Trombone basse",
    "Trombone basso", "Trombone ténor", "Tromboni", "Trombone tenore",
    "トロンボーン", "トロンボーン2", "第2トロンボーン",
    "テナートロンボーン", "バストロンボーン", "ﾄﾛﾝﾎﾞｰﾝ",
    "Ｔｒｏｍｂｏｎｅ", "Sackbut", "Sackbut 1", "Saqueboute", "3rd Trombone",
    "Trombone III", "Trombones", "Tbn. 1 & 2", "Tb.", "Trombone (Bass)",
]
NOBODY_YET = [
    "Tuba", "Tuben", "Basstuba", "チューバ", "Horn in F", "F Horn", "French Horn", "Hörner", "Cor", "Cor en Fa",
    "Corno", "Corni in F", "ホルン", "Horn 1", "Hn. 1", "Euphonium", "ユーフォニアム", "Baritone", "Baritone (T.C.)",
    "Flute", "Flöte", "Flûte", "Flauto", "フルート", "Clarinet in Bb", "Klarinette in B", "Clarinette",
    "Clarinetto", "クラリネット", "Alto Sax", "Altsaxophon", "アルトサックス", "Oboe", "Hautbois", "オーボエ", "Fagott",
    "Bassoon", "Basson", "Fagotto", "ファゴット", "Violin", "Violine I", "Violon", "Violino I", "バイオリン", "Viola",
    "Bratsche", "Cello", "Violoncello", "Kontrabass", "Contrebasse", "Piano", "Klavier", "ピアノ", "Organ",
    "Orgel", "Timpani", "Pauken", "Timbales", "Timpani in C-G", "ティンパニ", "Drums", "Schlagzeug", "Batterie",
    "ドラム", "Snare Drum", "Percussion", "Glockenspiel", "Harp", "Harfe", "Guitar", "Strings", "Choir",
    "English Horn", "Cor anglais", "Englischhorn", "Piccolo", "Soprano Sax", "Tenorhorn", "Tenor Horn",
    "Alto Horn", "Sousaphone", "Vibraphone", "Xylophone", "Bass Drum", "Cymbals", "Recorder", "Blockflöte",
    "Bass Clarinet", "Bassklarinette", "Cornetto", "Zink", "Baritone Saxophone", "Bariton", "Waldhorn",
    "Harmonica", "Voice", "Bass Guitar", "Double Bass", "Synth Bass",
]
# fmt: on


def encodings(name: str) -> list[str]:
    """Those that sequencers write such a name in."""
    if any("\u3040" <= character <= "\u9fff" or character > "\uff00" for character in name):
        return ["utf-8", "cp932"]
    return ["utf-8", *(["latin-1"] if not name.isascii() and all(ord(character) < 256 for character in name) else [])]


def inspected(
    path: Path,
    capsys: pytest.CaptureFixture[str],
    name: bytes = b"",
    program: int | None = None,
    channel: int = 0,
    pitches: tuple[int, ...] = (60, 62, 64),
    instrument_name: bytes = b"",
) -> dict[str, Any]:
    """One track of those notes, inspected."""
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
    mido.MidiFile(type=1, tracks=[mido.MidiTrack(), track], charset="latin-1").save(path)
    assert main(["inspect", str(path), "--json"]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    assert len(found["players"]) + len(found["unplayed"]) == 1
    return found


@pytest.mark.parametrize(
    ("name", "family"), [(name, "trumpet") for name in TRUMPET] + [(name, "trombone") for name in TROMBONE]
)
def test_a_name_is_enough(name: str, family: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for encoding in encodings(name):
        found = inspected(tmp_path / "one.mid", capsys, name.encode(encoding), program=0)
        (player,) = found["players"]
        assert player["instrument"].startswith(family)
        assert player["name"] == player["part"] == name
        assert not any("neither" in warning for warning in found["warnings"])


@pytest.mark.parametrize("name", NOBODY_YET)
def test_what_has_no_map_is_listed_with_its_reason(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for encoding in encodings(name):
        (part,) = inspected(tmp_path / "one.mid", capsys, name.encode(encoding))["unplayed"]
        assert part["name"] == name
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
        ("Flute", 56, 0, None),
        ("", 60, 0, None),
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
    found = inspected(tmp_path / "one.mid", capsys, name.encode(), program, channel)
    if family is None:
        assert found["unplayed"]
    else:
        assert found["players"][0]["instrument"].startswith(family)
        assert found["warnings"] == []


@pytest.mark.parametrize(
    ("pitches", "family"),
    [((80, 84, 86), "trumpet"), ((38, 41, 45), "trombone"), ((20, 21, 22), None), ((100, 101, 102), None)],
)
def test_the_range_decides_where_nothing_else_does(
    pitches: tuple[int, ...], family: str | None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = inspected(tmp_path / "one.mid", capsys, b"Part", pitches=pitches)
    if family is None:
        assert "Part" in found["unplayed"][0]["name"]
    else:
        assert found["players"][0]["instrument"].startswith(family)
        assert "neither its name nor its program" in found["warnings"][0]


def test_the_instrument_name_helps_where_the_track_name_says_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = inspected(tmp_path / "one.mid", capsys, b"A", instrument_name="トロンボーン".encode("cp932"))
    assert found["players"][0]["instrument"].startswith("trombone")
    found = inspected(tmp_path / "one.mid", capsys, b"Flute", instrument_name=b"Trombone")
    assert found["unplayed"]


@pytest.mark.parametrize(("name", "overlap", "players"), [("Trumpet", 0, 1), ("Score", 0, 2), ("Trumpet", 240, 4)])
def test_a_player_may_use_several_channels_in_turn(
    name: str, overlap: int, players: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # As notation programs write a trumpet that puts in a mute: the muted notes have a channel of their own.
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
