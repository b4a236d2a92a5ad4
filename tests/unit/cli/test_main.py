"""The commands as users experience them: output, exit status, and no traceback in any case."""

from __future__ import annotations

import json
import math
import os
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mido
import pytest

from app.cli import main
from instrument_maps.load import bundled_maps

ROOT = Path(__file__).parents[3]
MIDI = ROOT / "tests" / "data" / "midi"
QUARTET = ROOT / "resources" / "examples" / "quartet.mid"
LUTKIN = MIDI / "ensemble" / "brass_quartet_lutkin_2tpt_tbn_tuba.mid"
WITH_VIOLA = MIDI / "ensemble" / "flute_oboe_viola_holst_terzetto_mv2_CCBY4.mid"

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    def call(*arguments: str | Path) -> tuple[int, str, str]:
        capsys.readouterr()
        status = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        assert "Traceback" not in captured.err
        return status, captured.out, captured.err

    return call


def suisou(*arguments: str | Path, **options: Any) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [sys.executable, "-m", "app", *map(str, arguments)], cwd=ROOT, capture_output=True, check=False, **options
    )


def named_piece(path: Path, *names: str) -> Path:
    """Piece with two bars of trumpet for every name."""
    file = mido.MidiFile(type=1, ticks_per_beat=480, charset="utf-8")
    for number, name in enumerate(names):
        track = mido.MidiTrack()
        track.append(mido.MetaMessage("track_name", name=name))
        track.append(mido.Message("program_change", program=56, channel=number))
        for pitch in (70, 72, 74, 75):
            track.append(mido.Message("note_on", note=pitch, velocity=80, channel=number))
            track.append(mido.Message("note_off", note=pitch, time=480, channel=number))
        file.tracks.append(track)
    file.save(path)
    return path


def test_help_and_version(run: Run) -> None:
    assert run()[0] == 0
    status, out, _ = run("--help")
    assert status == 0
    assert all(command in out for command in ("inspect", "export", "instruments", "--version"))
    for command in ("inspect", "export", "instruments"):
        assert run(command, "--help")[0] == 0
    status, out, _ = run("--version")
    assert status == 0
    assert out.startswith("suisou ")


@pytest.mark.parametrize(
    "arguments",
    [
        ["dance"],
        ["inspect"],
        ["export", QUARTET],
        ["export", QUARTET, "--to", "x", "--fps", "fast"],
        ["export", QUARTET, "--to", "x", "--format", "obj"],
        ["export", QUARTET, "--to", "x", "--format", "fbx,obj"],
        ["export", QUARTET, "--to", "x", "--format", ""],
        ["export", QUARTET, "--to", "x", "--from-bar", "0.5"],
        ["export", QUARTET, "--to", "x", "--from-bar", "9", "--to-bar", "3"],
        ["export", QUARTET, "--to", "x", "--from-bar", "99999"],
        ["export", QUARTET, "--to", "x", "--player", "unknown"],
        ["inspect", QUARTET, "--set", "x"],
        ["inspect", QUARTET, "--set", "unknown.amplitude=1"],
        ["inspect", QUARTET, "--set", "*.amplitude=7"],
        ["inspect", QUARTET, "--set", "*.volume=7"],
        ["inspect", QUARTET, "--preroll", "-3"],
        ["inspect", QUARTET, "--felt-beat", "0"],
        ["inspect", QUARTET, "--felt-beat", "3/0"],
        ["inspect", QUARTET, "--felt-beat", "nan"],
        ["export", QUARTET, "--to", "x", "--felt-beat", "fast"],
        ["inspect", QUARTET, "--set", "Trumpet 1.lung_s=0"],
        ["inspect", QUARTET, "--set", "Trumpet 1.instrument=kazoo"],
        ["inspect", QUARTET, "--set", "Trumpet 9.amplitude=0.1"],
        ["inspect", QUARTET, "--set", ".=."],
        ["inspect", QUARTET, "--seed", "x"],
        ["inspect", QUARTET, "--encoding", "klingon"],
        ["inspect", QUARTET, "--encoding", "base64"],
    ],
)
def test_bad_use_ends_with_2(run: Run, arguments: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    status, out, err = run(*arguments)
    assert status == 2
    assert out == ""
    assert err.strip()
    assert list(tmp_path.iterdir()) == []


def test_the_felt_beat_counts_in_pre_roll_cue_and_breaths(run: Run) -> None:
    quarters = json.loads(run("inspect", LUTKIN, "--json", "--no-contacts")[1])
    halves = json.loads(run("inspect", LUTKIN, "--json", "--no-contacts", "--felt-beat", "2")[1])
    beat_s = 60.0 / quarters["tempo"][0]["bpm"]
    first_s = min(note["onset_s"] for player in quarters["players"] for note in player["notes"])
    # A bar of four, or as many beats as give time to come up from rest.
    for found, felt_s in ((quarters, beat_s), (halves, 2 * beat_s)):
        beats = max(4, math.ceil(3.0 / felt_s))
        assert found["preroll_beats"] == beats
        assert found["first_frame_s"] == pytest.approx(first_s - beats * felt_s)
    given = json.loads(run("inspect", LUTKIN, "--json", "--no-contacts", "--felt-beat", "2", "--preroll", "5")[1])
    assert given["preroll_beats"] == 5.0
    for found, beats in ((quarters, 1), (halves, 2)):
        (cue,) = [
            cue for player in found["players"] for cue in player["cues"] if cue["end_s"] == pytest.approx(first_s)
        ]
        # The preparatory beat is as long as the following one; this file has a tempo change at every quarter.
        assert cue["beat_s"] == pytest.approx(sum(60.0 / row["bpm"] for row in found["tempo"][:beats]))
        breaths = [player["breaths"][1] for player in found["players"]]
        assert all(breath["end_beat"] - breath["start_beat"] == pytest.approx(beats) for breath in breaths)


def test_an_unknown_player_is_reported_who_there_is(run: Run) -> None:
    names = [player["name"] for player in json.loads(run("inspect", QUARTET, "--json", "--no-contacts")[1])["players"]]
    assert len(names) == 4
    _, _, err = run("inspect", QUARTET, "--set", "unknown.amplitude=1")
    assert all(name in err for name in names)


def test_inspect_lists_the_markers(run: Run, tmp_path: Path) -> None:
    file = mido.MidiFile(QUARTET)
    file.tracks.append(mido.MidiTrack([mido.MetaMessage("marker", text="A", time=file.ticks_per_beat)]))
    file.save(tmp_path / "marked.mid")
    found = json.loads(run("inspect", str(tmp_path / "marked.mid"), "--json", "--no-contacts")[1])
    beat_s = 60.0 / found["tempo"][0]["bpm"]
    assert found["markers"] == [{"tick": file.ticks_per_beat, "s": pytest.approx(beat_s), "text": "A"}]


def test_inspect_has_exactly_these_keys(run: Run) -> None:
    status, out, _ = run("inspect", QUARTET, "--json", "--fps", "24")
    assert status == 0
    found = json.loads(out)
    assert set(found) == {
        "duration_s", "ticks_per_beat", "tempo", "tempo_source", "markers", "percussion_hits", "first_frame_s",
        "warnings", "unplayed", "left_out", "players", "dancers", "title", "fps", "fps_exact", "preroll_beats",
        "felt_beat_quarters", "seed", "section_intensity", "conductor", "ignored_problems",
    }  # fmt: skip
    assert set(found["tempo"][0]) == {"tick", "bpm"}
    for player in found["players"]:
        assert set(player) == {
            "name",
            "instrument",
            "transposition_semitones",
            "part",
            "musician",
            "character",
            "character_title",
            "outfit",
            "outfit_colours",
            "source",
            "notes",
            "breaths",
            "cues",
            "gestures",
            "expressions",
        }
        assert player["notes"]
        for note in player["notes"]:
            assert set(note) == {
                "id", "onset_tick", "duration_tick", "onset_s", "duration_s", "pitch", "velocity", "fingering",
                "fingering_keys", "controls", "articulation", "tongue", "tongue_reason", "bend", "loudness", "dynamic",
                "muted", "sources",
            }  # fmt: skip
            assert all(0.0 <= value <= 1.0 for value in (*note["controls"].values(), note["loudness"]))
            assert note["articulation"] in ("tongued", "slurred", "staccato", "accent", "marcato", "tenuto")
        for expression in player["expressions"]:
            assert set(expression) == {
                "expression", "start_s", "end_s", "start_beat", "end_beat", "strength", "fade_in_s", "fade_out_s",
                "reason",
            }  # fmt: skip
        for breath in player["breaths"]:
            assert {"kind", "start_s", "end_s", "start_beat", "end_beat"} <= set(breath)
            assert breath["kind"] in ("preparation", "breath")
            assert breath["start_s"] < breath["end_s"]
            assert breath["start_beat"] < breath["end_beat"]
    assert found["first_frame_s"] <= -2.0
    assert [len(player["cues"]) > 0 for player in found["players"]].count(True) >= 1


def test_inspect_lists_articulation_bends_and_dynamics(run: Run, tmp_path: Path) -> None:
    track = mido.MidiTrack([mido.MetaMessage("track_name", name="Trumpet")])
    # One tongued note, one slurred to the next, one staccato, and a soft one that fades.
    for pitch, velocity, lasts, pause in (
        (67, 96, 440, 40), (69, 96, 480, 0), (67, 96, 440, 40), (69, 96, 200, 280), (67, 33, 400, 0),
    ):  # fmt: skip
        track.append(mido.Message("note_on", note=pitch, velocity=velocity))
        track.append(mido.Message("pitchwheel", pitch=-8192 if velocity == 33 else 0, time=lasts - 60))
        track.append(mido.Message("note_off", note=pitch, time=60))
        track.append(mido.Message("pitchwheel", pitch=0, time=pause))
    path = tmp_path / "piece.mid"
    mido.MidiFile(tracks=[track]).save(path)
    (player,) = json.loads(run("inspect", path, "--json")[1])["players"]
    notes = player["notes"]
    assert [note["articulation"] for note in notes] == ["tongued", "tongued", "slurred", "staccato", "tongued"]
    assert [note["bend"] for note in notes] == [[], [], [], [], ["fall"]]
    assert [note["dynamic"] for note in notes] == ["f", "f", "f", "f", "pp"]


def test_reasons_name_notes_by_bar_and_beat(run: Run, tmp_path: Path) -> None:
    names = mido.MetaMessage("track_name", name="Trumpet"), mido.MetaMessage("time_signature", numerator=4)
    track = mido.MidiTrack(names)
    for place in range(64):
        track.append(mido.Message("note_on", note=67 + place % 3, velocity=90))
        track.append(mido.Message("note_off", note=67 + place % 3, time=480))
    path = tmp_path / "piece.mid"
    mido.MidiFile(tracks=[track]).save(path)
    (player,) = json.loads(run("inspect", path, "--json", "--no-contacts")[1])["players"]
    catches = [breath for breath in player["breaths"] if breath["reason"].startswith("catch breath")]
    assert catches
    for breath in catches:
        bar, beat = divmod(round(breath["end_beat"]) - 1, 4)
        assert f"({bar + 1}.{beat + 1}.000)" in breath["reason"]


def test_seconds_follow_the_tempo_that_mido_reads(run: Run) -> None:
    found = json.loads(run("inspect", LUTKIN, "--json", "--no-contacts")[1])
    assert found["ticks_per_beat"] == mido.MidiFile(LUTKIN).ticks_per_beat
    onsets = {round(note["onset_s"], 6) for player in found["players"] for note in player["notes"]}
    time_s, truth = 0.0, set()
    for message in mido.MidiFile(LUTKIN):
        time_s += message.time
        if message.type == "note_on" and message.velocity:
            truth.add(round(time_s, 6))
    assert all(min(abs(onset - other) for other in truth) < 1e-5 for onset in onsets)


def test_what_no_one_plays_is_listed(run: Run) -> None:
    organ = LUTKIN.with_name("trumpet_organ_brown_wedding_CCBY4.mid")
    found = json.loads(run("inspect", organ, "--json", "--no-contacts")[1])
    assert len(found["players"]) == 1
    assert [set(part) for part in found["unplayed"]] == [{"name", "reason", "note_count"}] * 2
    assert all(part["note_count"] > 0 and part["reason"] for part in found["unplayed"])


def test_settings_change_the_plan(run: Run) -> None:
    plain = json.loads(run("inspect", QUARTET, "--json", "--fps", "24")[1])
    same = json.loads(run("inspect", QUARTET, "--json", "--fps", "24")[1])
    assert plain == same
    changed = json.loads(run("inspect", QUARTET, "--json", "--no-contacts", "--set", "*.breath_min_beats=3")[1])
    assert [p["notes"] for p in changed["players"]] == [p["notes"] for p in plain["players"]]
    assert [p["breaths"] for p in changed["players"]] != [p["breaths"] for p in plain["players"]]
    name = plain["players"][0]["name"]
    swap = f"{name}.instrument=trombone_tenor_F_attachment"
    swapped = json.loads(run("inspect", QUARTET, "--json", "--no-contacts", "--set", swap)[1])
    assert swapped["players"][0]["instrument"] == "trombone_tenor_F_attachment"
    assert {note["fingering"][-1] for note in swapped["players"][0]["notes"]} <= set("1234567")


def test_the_table_for_people(run: Run) -> None:
    status, out, _ = run("inspect", LUTKIN, "--fps", "24")
    assert status == 0
    assert "trumpet" in out.lower()
    status, out, _ = run("inspect", WITH_VIOLA, "--no-contacts")
    assert status == 0
    assert "not played" in out


@pytest.mark.parametrize("path", sorted((MIDI / "corrupt").glob("*.mid")), ids=lambda path: path.stem)
@pytest.mark.parametrize("command", ["inspect", "export"])
def test_corrupt_files_end_in_a_sentence(run: Run, path: Path, command: str, tmp_path: Path) -> None:
    options = ["--to", tmp_path / "out", "--fps", "24"] if command == "export" else ["--json"]
    status, out, err = run(command, path, *options)
    if status == 0:
        assert command == "export" or json.loads(out)["warnings"]
    else:
        assert status == 1
        assert len(err.strip().splitlines()) == 1
        assert path.name in err
        assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("path", sorted((MIDI / "awkward").glob("*.mid")), ids=lambda path: path.stem)
def test_awkward_files_open(run: Run, path: Path) -> None:
    # All motion of ten minutes of an orchestra is not what is asked for here.
    long = path.stat().st_size > 20_000
    status, out, err = run("inspect", path, "--json", *(["--no-contacts"] if long else ["--fps", "24"]))
    assert status == 0
    # Only the parts without an instrument are listed.
    assert all("for example: suisou inspect" in line for line in err.splitlines())
    json.loads(out)


@pytest.mark.parametrize("what", ["missing", "folder", "text"])
def test_what_is_no_midi_file(run: Run, what: str, tmp_path: Path) -> None:
    path = tmp_path / "thing.mid"
    if what == "folder":
        path.mkdir()
    elif what == "text":
        path.write_text("hello")
    status, _, err = run("inspect", path)
    assert status == 1
    assert err.count("thing.mid") == 1


def test_a_piece_of_months_is_refused(run: Run, tmp_path: Path) -> None:
    """Four wrong bytes in a delta time suffice for such a length."""
    file = mido.MidiFile(ticks_per_beat=24)
    track = mido.MidiTrack([mido.Message("program_change", program=56)])
    for wait in (0, 0xFFFFFFF):
        track.append(mido.Message("note_on", note=70, velocity=80, time=wait))
        track.append(mido.Message("note_off", note=70, time=480))
    file.tracks.append(track)
    file.save(tmp_path / "long.mid")
    for command in (["inspect", "--json"], ["export", "--to", str(tmp_path / "out")]):
        status, out, err = run(command[0], tmp_path / "long.mid", *command[1:])
        assert status == 1
        assert out == ""
        assert "hours" in err
        assert err.count("long.mid") == 1
    assert not (tmp_path / "out").exists()


def test_names_from_a_file_stay_names(run: Run, tmp_path: Path) -> None:
    names = ["../../evil", "CON", "Trumpet 🎺", "Trumpet 🎺", "a/b\\c:d", ""]
    piece = named_piece(tmp_path / "piece.mid", *names)
    status, out, _ = run("inspect", piece, "--json", "--no-contacts")
    assert status == 0
    found = [player["name"] for player in json.loads(out)["players"]]
    assert len({name.casefold() for name in found}) == len(names)
    assert {"../../evil", "CON", "Trumpet 🎺 1", "Trumpet 🎺 2"} <= set(found)


def test_pipes_get_utf8_whatever_the_system_says(tmp_path: Path) -> None:
    piece = named_piece(tmp_path / "piece.mid", "トランペット 🎺")
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "LC_ALL": "C"}
    done = suisou("inspect", piece, "--json", env=environment)
    assert done.returncode == 0
    assert json.loads(done.stdout.decode("utf-8"))["players"][0]["name"] == "トランペット 🎺"


def test_a_reader_that_leaves_early_is_no_error() -> None:
    command = f'"{sys.executable}" -m app inspect "{QUARTET}" --json | head -c 100; exit ${{PIPESTATUS[0]}}'
    done = subprocess.run(["bash", "-c", command], cwd=ROOT, capture_output=True, check=False)
    assert done.returncode == 0
    assert done.stderr == b""


def test_instruments_are_listed_and_checked(run: Run, tmp_path: Path) -> None:
    status, out, _ = run("instruments")
    assert status == 0
    rows = {words[0]: line for line in out.splitlines() if (words := line.split())}
    # Valves by their labels; slides have none.
    assert rows["trumpet_Bb"].endswith("  1, 2, 3, first_slide, third_slide")
    good = ROOT / "instrument_maps" / "trumpet_Bb.toml"
    assert run("instruments", "check", good)[0] == 0
    broken = tmp_path / "trumpet_Bb.toml"
    broken.write_text(good.read_text(encoding="utf-8").replace("schema_version = 1", "schema_version = "), "utf-8")
    status, out, err = run("instruments", "check", broken)
    assert status == 1
    assert "line" in out
    assert "is invalid" in err
    broken.write_text(good.read_text(encoding="utf-8") + '\nnonsense = "x"\n', "utf-8")
    status, out, _ = run("instruments", "check", broken)
    assert status == 1
    assert "nonsense" in out
    assert run("instruments", "check", tmp_path / "absent.toml")[0] == 1


def test_no_more_is_loaded_than_is_needed() -> None:
    code = (
        "import sys; from app.cli import main; main(['--help']); "
        "print([name for name in ('numpy', 'mido', 'app.cli.options') if name in sys.modules]); "
        "main(['instruments']); "
        "print([name for name in sys.modules if 'Qt' in name or 'PySide' in name])"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, check=True)
    assert done.stdout.decode().splitlines().count("[]") == 2


def test_a_scale_has_every_note_of_the_range_with_its_first_choice(run: Run) -> None:
    for instrument in bundled_maps().values():
        status, out, _ = run("instruments", "scale", instrument.id, "--first")
        assert status == 0
        head, *rows = out.splitlines()
        assert head.split()[:6] == ["sounds", "written", "rank", "fingering", "cents", "for"]
        assert head.split()[6:] in ([], ["keys"])
        assert len(rows) == instrument.range.high - instrument.range.low + 1
        at = head.index("fingering")
        for pitch, row in zip(range(instrument.range.low, instrument.range.high + 1), rows, strict=True):
            assert row[at:].startswith(instrument.fingerings_for(pitch)[0].label)
    assert len(run("instruments", "scale", "trumpet_Bb")[1].splitlines()) > 1 + 36
    status, out, err = run("instruments", "scale", "serpent")
    assert (status, out) == (1, "")
    assert "serpent" in err


@pytest.mark.parametrize(
    ("bars", "reported"),
    [
        (["--from-bar", "99"], "bar 99 does not exist; the piece has bars 1 to 44"),
        (["--to-bar", "0"], "bar 0 does not exist; the piece has bars 1 to 44"),
        (["--from-bar", "9", "--to-bar", "3"], "the first bar (9) is after the last bar (3)"),
        (
            ["--to-bar", "3", "--lead-in", "2"],
            "--lead-in shows beats before --from-bar, which is not given; "
            "--preroll sets the beats before the first note",
        ),
    ],
)
def test_bars_that_cannot_be_are_named(bars: list[str], reported: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", str(QUARTET), "--to", "x", "--player", "Trumpet 1", *bars]) == 2
    assert capsys.readouterr().err == f"suisou: {reported}\n"


def test_what_is_wrong_elsewhere_is_not_blamed_on_the_file(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unknown(*arguments: object, **options: object) -> None:
        raise socket.gaierror(socket.EAI_NONAME, "no such name")

    monkeypatch.setattr("socket.getaddrinfo", unknown)
    assert main(["stream", str(QUARTET), "--host", "nowhere.invalid"]) != 0
    assert capsys.readouterr().err.startswith("suisou: computer 'nowhere.invalid'")
    assert main(["export", str(tmp_path), "--to", str(tmp_path / "out")]) != 0
    assert capsys.readouterr().err.startswith("suisou: there is no piece in ")
