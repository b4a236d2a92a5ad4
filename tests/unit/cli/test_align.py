"""``suisou align``: a piece with the tempo of a recording."""

from __future__ import annotations

from importlib.resources import as_file, files
from pathlib import Path

import numpy as np
import pytest
import soundfile

from app.audio.track import RATE_HZ
from app.cli import main
from app.cli.status import BAD_INPUT, BAD_USE, DONE
from app.project.edit.pins import pin_beat, recording_second
from app.project.model import map_choices
from app.project.storage import load, save
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.unit.audio.test_follow import recorded, truth


@pytest.fixture(scope="module")
def quartet() -> Path:
    """The bundled example."""
    with as_file(files("resources") / "examples" / "quartet.mid") as path:
        return path


@pytest.fixture(scope="module")
def concert(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Recording of the quartet with a varying tempo, beginning at 3 s, with other sound before and after."""
    path = tmp_path_factory.mktemp("sound") / "concert.flac"
    silence = np.zeros((3 * RATE_HZ, 2))
    soundfile.write(path, np.concatenate([silence, np.clip(recorded(), -1.0, 1.0)]), RATE_HZ)
    return path


def errors_s(path: Path, begins_s: float) -> np.ndarray:
    """Errors in seconds of the notes of an aligned file whose tick 0 is at a given time of the recording."""
    score = load(path).score if path.suffix == ".suisou" else read_midi(path, maps=map_choices(bundled_maps().values()))
    notes = np.array([note.onset_tick for part in score.parts for note in part.notes], np.float64)
    true_s = truth().score.tempo_map.seconds(notes * truth().score.ticks_per_quarter / score.ticks_per_quarter)
    return np.abs(score.tempo_map.seconds(notes) + begins_s - 3.0 - true_s)


def test_a_project_plays_with_the_recording(
    quartet: Path, concert: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "concert.suisou"
    assert main(["align", str(quartet), str(concert), "--from", "1.5", "--to", str(target)]) == DONE
    audio = load(target).audio
    assert Path(audio.path) == concert
    assert audio.offset_s == pytest.approx(-3.0, abs=0.03)
    assert np.percentile(errors_s(target, -audio.offset_s), 90) < 0.05
    said = capsys.readouterr().out
    assert said.startswith(f"{target}: ")
    assert "confidence 9" in said


def test_a_midi_file_has_its_tempo(quartet: Path, concert: Path, tmp_path: Path) -> None:
    target = tmp_path / "concert.mid"
    assert main(["align", str(quartet), str(concert), "--to", str(target)]) == DONE
    steps = errors_s(target, 3.0)
    assert np.percentile(np.abs(steps - np.median(steps)), 90) < 0.05


def test_dynamics_and_stems_become_curves(
    quartet: Path, concert: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    swelling = np.concatenate([np.zeros((3 * RATE_HZ, 2)), np.clip(recorded(), -1.0, 1.0)])
    swelling *= np.linspace(0.1, 1.0, len(swelling))[:, None]
    soundfile.write(tmp_path / "second.flac", swelling, RATE_HZ)
    target = tmp_path / "concert.suisou"
    stem = f"2={tmp_path / 'second.flac'}"
    assert main(["align", str(quartet), str(concert), "--from", "1", "--stems", stem, "--to", str(target)]) == DONE
    project = load(target)
    curves = [next(curve for curve in part.curves if curve.kind == "breath") for part in project.score.parts]
    halves = [np.array(curve.values)[np.array(curve.ticks) > project.score.end_tick / 2].mean() for curve in curves]
    firsts = [np.array(curve.values)[np.array(curve.ticks) < project.score.end_tick / 2].mean() for curve in curves]
    assert halves[1] - firsts[1] > 0.1
    assert halves[1] - firsts[1] > halves[0] - firsts[0] + 0.05
    capsys.readouterr()
    assert main(["align", str(quartet), str(concert), "--stems", "Anna=x.wav", "--to", str(target)]) == BAD_USE
    assert "no player Anna" in capsys.readouterr().err


def test_single_notes_move_where_they_are_clear(quartet: Path, concert: Path, tmp_path: Path) -> None:
    target = tmp_path / "concert.suisou"
    assert main(["align", str(quartet), str(concert), "--notes", "--to", str(target)]) == DONE
    project = load(target)
    assert project.audio is not None
    by_id = {note.id: note.onset_tick for part in truth().score.parts for note in part.notes}
    notes = [note for part in project.score.parts for note in part.notes]
    true_s = truth().score.tempo_map.seconds(np.array([by_id[note.id] for note in notes], np.float64))
    found_s = project.score.tempo_map.seconds(np.array([note.onset_tick for note in notes], np.float64))
    sizes_s = np.abs(found_s - project.audio.offset_s - 3.0 - true_s)
    assert sum(note.onset_tick != by_id[note.id] for note in notes) > 50
    assert np.median(sizes_s) < 0.015
    assert np.percentile(sizes_s, 95) < 0.05


def test_pinned_beats_stay_where_they_are(quartet: Path, concert: Path, tmp_path: Path) -> None:
    target, again = tmp_path / "concert.suisou", tmp_path / "again.suisou"
    assert main(["align", str(quartet), str(concert), "--to", str(target)]) == DONE
    project = load(target)
    tick = int(project.metre_map.tick_of_bar(9))
    at_s = recording_second(project, tick) + 0.1
    save(pin_beat(project, tick, at_s), target)
    assert main(["align", str(target), str(concert), "--from", "2", "--to", str(again)]) == DONE
    assert recording_second(load(again), tick) == pytest.approx(at_s, abs=2e-3)
    assert load(again).audio.pins == load(target).audio.pins


@pytest.mark.parametrize(
    ("arguments", "status", "says"),
    [
        (("--to", "out.wav"), BAD_USE, "neither a project"),
        (("--to", "out.suisou", "--from", "900"), BAD_USE, "between --from and --until"),
        (("--to", "none/out.suisou"), BAD_INPUT, "cannot be written"),
    ],
)
def test_what_cannot_be_is_reported_and_nothing_is_written(
    quartet: Path,
    concert: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: tuple[str, ...],
    status: int,
    says: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["align", str(quartet), str(concert), *arguments]) == status
    assert says in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_other_files_are_refused(
    quartet: Path, concert: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    noise = np.random.default_rng(1).normal(scale=0.1, size=(20 * RATE_HZ, 2))
    soundfile.write(tmp_path / "rain.wav", noise, RATE_HZ)
    (tmp_path / "text.wav").write_text("no sound")
    for recording, says in (("rain.wav", "not recognised"), ("text.wav", "text.wav"), ("none.wav", "none.wav")):
        arguments = ["align", str(quartet), str(tmp_path / recording), "--to", str(tmp_path / "out.suisou")]
        assert main(arguments) == BAD_INPUT
        assert says in capsys.readouterr().err
    assert not (tmp_path / "out.suisou").exists()
    assert main(["align", str(concert), str(concert), "--to", str(tmp_path / "out.suisou")]) == BAD_INPUT
