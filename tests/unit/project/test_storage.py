"""Project files: format, refused content with messages, and saving that never loses the previous file."""

from __future__ import annotations

import json
import os
import shutil
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.encoding import shown
from app.errors import FileError, Message
from app.messages import error_text, text
from app.plan.by_hand.additive_curve import AdditiveCurve
from app.plan.by_hand.corrections import AddGesture, PlayStyle, SetCue
from app.plan.by_hand.mark_corrections import OfMark
from app.plan.parameters import PARAMETERS, PlayerParameters
from app.project.edit.dancers import set_body_dance
from app.project.edit.piece import set_audio
from app.project.migrations import CURRENT, MIGRATIONS, STRUCTURE, Raw, migrated
from app.project.model import Project
from app.project.recording import AudioTrack
from app.project.storage import (
    backup_path,
    decode,
    elsewhere,
    encode,
    is_project_file,
    load,
    missing,
    missing_media,
    save,
)
from app.rig.people.wardrobe import NO_CHOICE
from tests.unit.project.pieces import full_project, small_project

SAMPLES = Path(__file__).parents[2] / "data" / "projects"
VERSIONS = sorted(int(path.stem.removeprefix("version_")) for path in SAMPLES.glob("version_*.suisou"))


def changed(project: Project, **fields: object) -> bytes:
    """Bytes of a file with some values replaced by key path."""
    whole = json.loads(encode(project, Path("/music/piece.suisou")))
    for path, value in fields.items():
        place = whole
        *keys, last = path.split("__")
        for key in keys:
            place = place[int(key) if key.isdigit() else key]
        place[last] = value
    return json.dumps(whole).encode()


def refused(content: bytes) -> Message:
    with pytest.raises(FileError) as raised:
        decode(content, Path("/music/piece.suisou"))
    error_text(raised.value)
    return raised.value.message


def test_everything_comes_back(tmp_path: Path) -> None:
    project = full_project(str(tmp_path / "media"))
    save(project, tmp_path / "work.suisou")
    assert load(tmp_path / "work.suisou") == project


def test_a_note_drawn_here_that_the_file_has_too_is_remembered_as_read(tmp_path: Path) -> None:
    project = full_project(str(tmp_path / "media"))
    part = project.score.parts[0]
    drawn = msgspec.structs.replace(part.notes[0], id="n:1")
    score = msgspec.structs.replace(
        project.score, parts=(msgspec.structs.replace(part, notes=(drawn, *part.notes)), *project.score.parts[1:])
    )
    read_notes = {**project.read_notes, part.id: {note.id: note for note in score.parts[0].notes}}
    project = replace(project, score=score, read_notes=read_notes)
    save(project, tmp_path / "work.suisou")
    assert load(tmp_path / "work.suisou") == project


def test_the_file_is_readable_and_the_same_every_time(tmp_path: Path) -> None:
    save(full_project(str(tmp_path)), tmp_path / "one.suisou")
    save(load(tmp_path / "one.suisou"), tmp_path / "two.suisou")
    content = (tmp_path / "one.suisou").read_text(encoding="utf-8")
    assert content == (tmp_path / "two.suisou").read_text(encoding="utf-8")
    lines = content.splitlines()
    assert lines[:2] == ["{", f'  "schema_version": {CURRENT},']
    assert '          {"id": "1:1", "onset_tick": 0, "duration_tick": 480, "pitch": 60, "velocity": 80},' in lines
    assert '  "fps": "30000/1001",' in lines
    assert "録音.wav" in content


@pytest.mark.parametrize("version", VERSIONS)
def test_every_version_that_ever_was_can_be_read(version: int) -> None:
    path = SAMPLES / f"version_{version}.suisou"
    assert json.loads(path.read_bytes())["schema_version"] == version
    expected = full_project(str(SAMPLES))
    # What the MIDI file held is kept from version 2 on, how its parts were transposed from 3 on, takes from 4 on, its
    # markers from 5 on, how much air is used up before a breath and where unplayed parts sound from 6 on, what
    # percussion strikes and dancers from 7 on, what players dance and dancers weigh from 8 on, additive curves and how
    # they act from 10 on, whom a cue brings in, regions of a style and a conductor from 11 on,
    # beats pinned to the recording, what following it was not sure of and a reference video from 12 on, what was
    # decided at the import, and controllers and timing of the MIDI file from 14 on, marks from 15 on, how much a dancer
    # hears of the melody from 16 on, outfits from 17 on: before, none had to be.
    if version < 17:
        players, dancers = (
            tuple(msgspec.structs.replace(one, outfit=NO_CHOICE) for one in ones)
            for ones in (expected.players, expected.dancers)
        )
        expected = replace(expected, players=players, dancers=dancers)
    if version < 16:
        usual_melody = (msgspec.structs.replace(dancer, melody=0.5) for dancer in expected.dancers)
        expected = replace(expected, dancers=tuple(usual_melody))
    if version < 15:
        plain = (msgspec.structs.replace(part, marks=(), source="sound") for part in expected.score.parts)
        expected = replace(expected, score=msgspec.structs.replace(expected.score, parts=tuple(plain)))
        corrections = {
            player: tuple(item for item in items if not isinstance(item, OfMark))
            for player, items in expected.corrections.items()
        }
        expected = replace(expected, corrections=corrections)
    if version < 3:
        parts = tuple(msgspec.structs.replace(part, transposed_semitones=0) for part in expected.score.parts)
        expected = replace(expected, score=msgspec.structs.replace(expected.score, parts=parts))
    if version < 5:
        expected = replace(expected, score=msgspec.structs.replace(expected.score, markers=()))
    if version < 6:
        players = tuple(
            msgspec.structs.replace(player, parameters=msgspec.structs.replace(player.parameters, breath_need=0.0))
            for player in expected.players
        )
        unplayed = tuple(msgspec.structs.replace(part, sounding=()) for part in expected.score.unplayed)
        score = msgspec.structs.replace(expected.score, unplayed=unplayed)
        expected = replace(expected, players=players, score=score)
    if version < 7:
        score = msgspec.structs.replace(expected.score, percussion=())
        expected = replace(expected, score=score, dancers=(), dance_corrections={})
    if version < 8:
        before = {"circular_breathing": False, "choreography": "", "dance_amount": 0.5, "dance_variation": 0}
        players = tuple(
            msgspec.structs.replace(player, parameters=msgspec.structs.replace(player.parameters, **before))
            for player in expected.players
        )
        dancers = tuple(msgspec.structs.replace(dancer, weight=0.0) for dancer in expected.dancers)
        expected = replace(expected, players=players, dancers=dancers)
    if version < 10:
        usual = PlayerParameters()
        before = {name: getattr(usual, name) for name, one in PARAMETERS.items() if one.since == 10}
        players = tuple(
            msgspec.structs.replace(player, parameters=msgspec.structs.replace(player.parameters, **before))
            for player in expected.players
        )
        corrections = {
            player: tuple(
                item
                for item in items
                if not isinstance(item, AdditiveCurve) and not (isinstance(item, AddGesture) and item.kind == "named")
            )
            for player, items in expected.corrections.items()
        }
        expected = replace(expected, players=players, corrections=corrections, section_intensity=1.0)
    if version < 11:
        corrections = {
            player: tuple(
                msgspec.structs.replace(item, takers=None) if isinstance(item, SetCue) else item
                for item in items
                if not isinstance(item, PlayStyle)
            )
            for player, items in expected.corrections.items()
        }
        expected = replace(expected, corrections=corrections, conductor=None)
    if version < 12 and expected.audio is not None:
        audio = msgspec.structs.replace(expected.audio, pins=(), doubts=())
        expected = replace(expected, audio=audio, video=None)
    if version < 14:
        expected = replace(expected, read_timing=None, imported=None)
        expected = replace(expected, read_curves={"1.1.1": expected.score.parts[0].curves})
    later = {name: {} for name, first in (("read_notes", 2), ("read_curves", 2), ("takes", 4)) if version < first}
    assert load(path) == replace(expected, **later)


def test_the_present_version_is_written_as_its_sample_says() -> None:
    # Changing a file's content requires a migration and a sample; old samples stay unchanged. New parameters
    # alone require none: their file is the newest sample with them.
    path = SAMPLES / f"version_{VERSIONS[-1]}.suisou"
    content = encode(load(path), path)
    assert json.loads(content) == migrated(json.loads(path.read_bytes()), VERSIONS[-1])
    assert VERSIONS[-1] < CURRENT or content == path.read_bytes()


def test_migrations_follow_one_another() -> None:
    def first(raw: Raw) -> Raw:
        return {**raw, "steps": [*raw.get("steps", []), "1 to 2"]}

    def second(raw: Raw) -> Raw:
        return {**raw, "steps": [*raw["steps"], "2 to 3"]}

    chain = {2: first, 3: second}
    old = {"schema_version": 1, "title": "x"}
    new = migrated(old, 1, chain)
    assert new == {"schema_version": 3, "title": "x", "steps": ["1 to 2", "2 to 3"]}
    assert old == {"schema_version": 1, "title": "x"}
    assert migrated({"schema_version": 2, "steps": []}, 2, chain)["steps"] == ["2 to 3"]
    assert migrated(new, 3, chain) is new
    assert {1, *STRUCTURE} <= set(VERSIONS)
    assert list(MIGRATIONS) == list(range(2, CURRENT + 1))


def test_a_newer_file_is_refused_by_its_version_alone() -> None:
    message = refused(json.dumps({"schema_version": CURRENT + 1, "everything": "else"}).encode())
    assert message.id == "project.newer"
    assert message.arguments["version"] == CURRENT + 1


@pytest.mark.parametrize(
    ("path", "value", "place"),
    [
        ("score__parts__0__notes__1__pitch", 128, "score.parts[0].notes[1].pitch"),
        ("score__parts__0__notes__1__pitch", "c", "score.parts[0].notes[1].pitch"),
        ("score__parts__0__notes__1__pitch", 60.5, "score.parts[0].notes[1].pitch"),
        ("score__parts__0__notes__1__velocity", 0, "score.parts[0].notes[1].velocity"),
        ("score__parts__0__notes__1__duration_tick", 0, "score.parts[0].notes[1].duration_tick"),
        ("score__parts__0__notes__1__onset_tick", -1, "score.parts[0].notes[1].onset_tick"),
        ("score__parts__0__notes__1__onset_tick", 2**40, "score.parts[0].notes[1].onset_tick"),
        ("score__parts__0__notes__1__onset_tick", 5000, "score.parts[0].notes[2].onset_tick"),
        ("score__parts__1__notes__0__id", "1:1", "score.parts[1].notes[0].id"),
        ("score__parts__1__id", "1.1.1", "score.parts[1].id"),
        ("score__parts__0__curves__0__ticks", [0, 240, 240], "score.parts[0].curves[0].ticks[2]"),
        ("score__parts__0__curves__0__values", [0, 0.5], "score.parts[0].curves[0].values"),
        ("score__parts__0__curves__0__values", [0, 0.5, 1.5], "score.parts[0].curves[0].values[2]"),
        ("score__tempo_map__changes__0__tick", 5, "score.tempo_map.changes[0].tick"),
        ("score__tempo_map__changes__1__tick", 0, "score.tempo_map.changes[1].tick"),
        ("score__tempo_map__changes__1__microseconds_per_quarter", 0, "score.tempo_map.changes[1].microseconds_per_"),
        ("score__tempo_map__ticks_per_quarter", 96, "score.tempo_map.ticks_per_quarter"),
        ("score__ticks_per_quarter", 0, "score.ticks_per_quarter"),
        ("score__metres__0__denominator", 0, "score.metres[0].denominator"),
        ("score__pickup_ticks", 100, "score.pickup_ticks"),
        ("players__0__part_id", "9.9.9", "players[0].part_id"),
        ("players__1__id", "1.1.1", "players[1].id"),
        ("players__1__name", "TROMPETE: 1/2", "players[1].name"),
        ("players__0__parameters__amplitude", 1.5, "players[0].parameters.amplitude"),
        ("players__0__parameters__posture", "lying", "players[0].parameters.posture"),
        ("players__0__parameters__charisma", 1.0, "players[0].parameters"),
        ("players__0__colour", "red", "players[0].colour"),
        ("players__0__stage__x_m", 1e9, "players[0].stage.x_m"),
        ("corrections__1.1.1__0__correction", "levitate", "corrections['1.1.1'][0]"),
        ("corrections__1.1.1__2__depth", "deep", "corrections['1.1.1'][2].depth"),
        ("corrections__1.1.1__2__depth", 1e300, "corrections['1.1.1'][2].depth"),
        ("corrections__unknown", [{"correction": "set_cue", "note_id": "1:1"}], "corrections['unknown']"),
        ("expressions__0__weights__browDownLeft", 1.5, "expressions[0].weights"),
        ("expressions__0__weights__moustache", 0.5, "expressions[0].weights.moustache"),
        ("score__percussion__1__tick", -1, "score.percussion[1].tick"),
        ("score__percussion__1__tick", 481, "score.percussion[2].tick"),
        ("score__percussion__1__pitch", 128, "score.percussion[1].pitch"),
        ("score__percussion__1__velocity", 0, "score.percussion[1].velocity"),
        ("score__percussion__1__sound", "snare", "score.percussion[1].sound"),
        ("dancers__0__id", "1.1.1", "dancers[0].id"),
        ("dancers__1__id", "dancer:1", "dancers[1].id"),
        ("dancers__0__name", "CON", "dancers[0].name"),
        ("dancers__1__choreography", "../salsa", "dancers[1].choreography"),
        ("dancers__1__choreography", "", "dancers[1].choreography"),
        ("dancers__1__choreography", "salsa.choreography\0", "dancers[1].choreography"),
        ("dancers__1__choreography", "../../etc/passwd", "dancers[1].choreography"),
        ("dancers__1__stage__z_m", 1e9, "dancers[1].stage.z_m"),
        ("dancers__1__size", 2.0, "dancers[1].size"),
        ("dancers__1__delay_beats", -1.0, "dancers[1].delay_beats"),
        ("dancers__1__source", -2, "dancers[1].source"),
        ("dancers__1__seed", -1, "dancers[1].seed"),
        ("dancers__1__colour", "red", "dancers[1].colour"),
        ("dancers__1__instrument_id", "flute", "dancers[1].instrument_id"),
        ("dance_corrections__dancer:1__1__end_tick", 0, "dance_corrections['dancer:1'][1].end_tick"),
        ("dance_corrections__dancer:1__0__state", -1, "dance_corrections['dancer:1'][0].state"),
        ("dance_corrections__dancer:1__2__segment", "x", "dance_corrections['dancer:1'][2].segment"),
        ("dance_corrections__dancer:1__2__correction", "fly", "dance_corrections['dancer:1'][2]"),
        ("dance_corrections__x", [{"correction": "pin_state", "tick": 0, "state": 0}], "dance_corrections['x']"),
        ("fps", "0", "fps"),
        ("fps", "60/0", "fps"),
        ("fps", "1000", "fps"),
        ("fps", 60, "fps"),
        ("audio__offset_s", 1e9, "audio.offset_s"),
        ("audio__path", "", "audio.path"),
        ("seed", -1, "seed"),
        ("future", 1, "$"),
        ("score__future", 1, "score.future"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named_by_its_place(path: str, value: object, place: str) -> None:
    message = refused(changed(full_project(), **{path: value}))
    assert message.id == "project.invalid"
    assert str(message.arguments["place"]).startswith(place)
    assert message.arguments["file"] == "/music/piece.suisou"


@pytest.mark.parametrize(
    ("path", "value"),
    [("players__0__stage__x_m", 1e9), ("corrections__1.1.1__2__depth", 1e300), ("takes__1.1.1__takes__0__id", "x")],
)
def test_whose_value_is_wrong_is_named(path: str, value: object) -> None:
    project = full_project()
    name = project.players[0].name
    assert str(refused(changed(project, dancers__0__size=9.0)).arguments["detail"]).endswith("(dancer '踊り手')")
    assert f"(player {name!r}" in str(refused(changed(project, **{path: value})).arguments["detail"])


def test_which_correction_is_wrong_is_named_by_kind_and_bar() -> None:
    project = full_project()
    name = project.players[0].name
    detail = refused(changed(project, **{"corrections__1.1.1__2__depth": 1e300})).arguments["detail"]
    assert str(detail).endswith(f"(player {name!r}, bar 1, set_breath)")


def test_more_bars_than_any_piece_has_are_refused() -> None:
    project = small_project()
    content = changed(
        project, score__ticks_per_quarter=1, score__tempo_map__ticks_per_quarter=1, score__metres=[
            {"tick": 0, "numerator": 1, "denominator": 64}
        ], score__parts__0__notes__3__onset_tick=2**30
    )  # fmt: skip
    arguments = refused(content).arguments
    assert arguments["place"] == "score.parts"
    percussion = [{"tick": 2**31 - 1, "pitch": 36, "velocity": 1}]
    assert refused(changed(project, score__percussion=percussion)).arguments["place"] == "score.parts"
    assert "200000 bars" in str(arguments["detail"])


def test_names_are_only_data(tmp_path: Path) -> None:
    project = small_project()
    evil = "../../../../tmp/evil\u202etxt"
    players = (msgspec.structs.replace(project.players[0], name=evil), project.players[1])
    (tmp_path / "work").mkdir()
    save(replace(project, players=players), tmp_path / "work" / "piece.suisou")
    assert load(tmp_path / "work" / "piece.suisou").players[0].name == evil
    assert [path.name for path in tmp_path.rglob("*")] == ["work", "piece.suisou"]


def test_media_move_with_the_folder(tmp_path: Path) -> None:
    first = tmp_path / "first"
    (first / "audio").mkdir(parents=True)
    (first / "audio" / "take.wav").touch()
    save(set_audio(small_project(), first / "audio" / "take.wav"), first / "piece.suisou")
    assert '"path": "audio/take.wav"' in (first / "piece.suisou").read_text()
    assert missing_media(load(first / "piece.suisou")) is None
    shutil.move(first, tmp_path / "second")
    moved = load(tmp_path / "second" / "piece.suisou")
    assert moved.audio.path == str(tmp_path / "second" / "audio" / "take.wav")
    assert missing_media(moved) is None
    (tmp_path / "second" / "audio" / "take.wav").unlink()
    assert missing_media(moved) == tmp_path / "second" / "audio" / "take.wav"
    # A file saved elsewhere still finds it.
    save(moved, tmp_path / "elsewhere.suisou")
    assert load(tmp_path / "elsewhere.suisou").audio == moved.audio


def test_what_players_dance_moves_with_the_folder_and_bundled_names_stay(tmp_path: Path) -> None:
    first = tmp_path / "first"
    (first / "dances").mkdir(parents=True)
    (first / "dances" / "tango.choreography").touch()
    project = set_body_dance(small_project(), ("1.1.1",), first / "dances" / "tango.choreography")
    save(set_body_dance(project, ("2.1.1",), "not_bundled"), first / "piece.suisou")
    assert '"choreography": "dances/tango.choreography"' in (first / "piece.suisou").read_text()
    shutil.move(first, tmp_path / "second")
    moved = load(tmp_path / "second" / "piece.suisou")
    assert [player.parameters.choreography for player in moved.players] == [
        str(tmp_path / "second" / "dances" / "tango.choreography"), "not_bundled",
    ]  # fmt: skip
    assert [message.id for message in missing(moved)] == ["project.choreography_missing"]
    (tmp_path / "second" / "dances" / "tango.choreography").unlink()
    assert "project.choreography_file_missing" in [message.id for message in missing(moved)]


def test_choreographies_move_with_the_folder_and_bundled_names_stay(tmp_path: Path) -> None:
    first = tmp_path / "first"
    (first / "dances").mkdir(parents=True)
    (first / "dances" / "salsa.choreography").touch()
    project = replace(full_project(str(first)), players=(), corrections={}, takes={})
    save(project, first / "piece.suisou")
    assert '"choreography": "dances/salsa.choreography"' in (first / "piece.suisou").read_text()
    assert '"choreography": "not_bundled"' in (first / "piece.suisou").read_text()
    shutil.move(first, tmp_path / "second")
    moved = load(tmp_path / "second" / "piece.suisou")
    assert moved.dancers[0].choreography == str(tmp_path / "second" / "dances" / "salsa.choreography")
    assert moved.dancers[1] == project.dancers[1]
    assert "project.choreography_file_missing" not in [message.id for message in missing(moved)]


@pytest.mark.parametrize("path", ["C:\\Music\\take.wav", "\\\\server\\share\\take.wav", "/nowhere/at/all/take.wav"])
def test_paths_of_other_systems_stay_what_they_are(tmp_path: Path, path: str) -> None:
    project = replace(small_project(), audio=AudioTrack(path))
    save(project, tmp_path / "piece.suisou")
    assert load(tmp_path / "piece.suisou") == project
    # A file on another computer is not accessed before the user agrees.
    assert missing_media(project) == (None if elsewhere(project) else Path(path))


def test_what_is_not_installed_stays_and_is_reported() -> None:
    project = full_project()
    back = decode(encode(project, Path("/music/a.suisou")), Path("/music/a.suisou"))
    assert back == project
    found = missing(back)
    assert [message.id.removeprefix("project.") for message in found] == [
        "choreography_file_missing", "instrument_missing", "character_missing", "choreography_file_missing",
        "choreography_file_missing", "character_missing", "choreography_missing", *2 * ["outfit_missing"],
    ]  # fmt: skip
    assert "not_installed" in text(found[1])
    assert "/music/dances/salsa.choreography" in text(found[3])
    assert "not_bundled" in text(found[6])
    assert missing(small_project()) == ()


def test_remarks_of_another_version_are_kept_in_words_we_have() -> None:
    content = changed(
        full_project(),
        score__warnings=[
            {"id": "midi.of_tomorrow", "arguments": {"x": 1}},
            {"id": "midi.patterns", "arguments": {}},
            {"id": "midi.patterns", "arguments": {"patterns": 2}},
        ],
    )
    warnings = decode(content, Path("/music/a.suisou")).score.warnings
    assert [message.id for message in warnings] == ["project.unknown_remark", "project.unknown_remark", "midi.patterns"]
    assert "midi.of_tomorrow" in text(warnings[0])


@pytest.mark.parametrize("beat", [2, 2.5])
def test_remarks_that_counted_bars_and_beats_have_their_position(beat: float) -> None:
    arguments = {"part": "Horn", "voices": 2, "count": 3, "bar": 12, "beat": beat, "pitch": 60}
    content = changed(full_project(), score__warnings=[{"id": "score.voices", "arguments": arguments}])
    (warning,) = decode(content, Path("/music/a.suisou")).score.warnings
    assert (warning.id, warning.arguments["place"]) == ("score.voices", "12.2")
    assert "the first at 12.2 (C4)" in text(warning)


def test_the_version_before_stays_beside(tmp_path: Path) -> None:
    path = tmp_path / "piece.suisou"
    first, second, third = (replace(small_project(), seed=seed) for seed in (1, 2, 3))
    save(first, path)
    assert not backup_path(path).exists()
    save(second, path)
    save(third, path)
    assert load(path) == third
    assert load(backup_path(path)) == second
    assert sorted(file.name for file in tmp_path.iterdir()) == ["piece.suisou", "piece.suisou.bak"]


def test_a_save_that_fails_costs_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "piece.suisou"
    save(small_project(), path)
    before = path.read_bytes()

    def full(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(FileError) as raised:
        save(replace(small_project(), seed=9), path)
    assert raised.value.message.id == "file.cannot_write"
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_where_a_file_has_one_name_only_the_backup_is_a_copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def unsupported(source: object, target: object) -> None:
        raise OSError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", unsupported)
    path = tmp_path / "piece.suisou"
    save(replace(small_project(), seed=1), path)
    save(replace(small_project(), seed=2), path)
    assert load(backup_path(path)).seed == 1
    assert load(path).seed == 2


def test_a_write_protected_file_is_respected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "piece.suisou"
    save(small_project(), path)
    # The tests may run as someone whom no protection stops.
    monkeypatch.setattr(os, "access", lambda file, mode: False)
    with pytest.raises(FileError, match=r"project\.read_only"):
        save(small_project(), path)


def test_what_could_not_be_read_again_is_not_written(tmp_path: Path) -> None:
    path = tmp_path / "piece.suisou"
    save(small_project(), path)
    before = path.read_bytes()
    with pytest.raises(FileError) as raised:
        save(replace(small_project(), preroll_beats=float("nan")), path)
    assert raised.value.message.arguments["place"] == "preroll_beats"
    with pytest.raises(FileError, match=r"project\.cannot_save"):
        save(replace(small_project(), score=msgspec.structs.replace(small_project().score, title="\udcff")), path)
    with pytest.raises(FileError, match=r"project\.cannot_save"):
        save(replace(small_project(), source="/music/\0.mid"), path)
    assert path.read_bytes() == before


def test_numbers_of_calculations_are_numbers(tmp_path: Path) -> None:
    project = replace(small_project(), seed=np.int64(4), preroll_beats=np.float64(2.5), fps=Fraction(25))
    save(project, tmp_path / "piece.suisou")
    back = load(tmp_path / "piece.suisou")
    assert (type(back.seed), type(back.preroll_beats)) == (int, float)
    assert back == project


@pytest.mark.parametrize("name", ["missing.suisou", "folder", "bad\0name"])
def test_what_cannot_be_opened_is_named(tmp_path: Path, name: str) -> None:
    (tmp_path / "folder").mkdir()
    with pytest.raises(FileError) as raised:
        load(tmp_path / name)
    assert raised.value.message.arguments["file"] == shown(tmp_path / name)


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    save(small_project(), tmp_path / "real" / "piece.suisou")
    (tmp_path / "link.suisou").symlink_to(tmp_path / "real" / "piece.suisou")
    save(replace(small_project(), seed=5), tmp_path / "link.suisou")
    assert (tmp_path / "link.suisou").is_symlink()
    assert load(tmp_path / "real" / "piece.suisou").seed == 5
    assert (tmp_path / "real" / "piece.suisou.bak").exists()


def test_which_files_are_projects() -> None:
    for name in ("a.suisou", "A.SUISOU", "a.suisou.bak", "a.suisou.autosave", "曲.suisou"):
        assert is_project_file(Path(name)), name
    for name in ("a.mid", "suisou", "a.suisou.mid", "a.bak"):
        assert not is_project_file(Path(name)), name
