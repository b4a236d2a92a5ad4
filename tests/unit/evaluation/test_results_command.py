"""``suisou evaluate results`` and ``suisou evaluate measures``."""

from __future__ import annotations

import shutil
from importlib.resources import as_file, files
from pathlib import Path

import pytest

from app.cli import main
from app.cli.status import BAD_INPUT, BAD_USE, DONE
from app.evaluation.key import write_key
from app.evaluation.measures import write_measures
from tests.support.viewers import key_of, viewers, write_viewers
from tests.unit.evaluation.test_report import MEASURES

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def answers(tmp_path: Path) -> list[str]:
    """Files of eight viewers in a folder beside the key."""
    folder = tmp_path / "answers"
    folder.mkdir()
    key = key_of()
    write_key(key, tmp_path / "key.json")
    return [str(path) for path in write_viewers(viewers(key, 8), folder)]


def test_results_are_printed_and_written(answers: list[str], tmp_path: Path, capsys: Captured) -> None:
    write_measures(MEASURES, tmp_path / "measures.json")
    assert main(["evaluate", "results", *answers, "--to", str(tmp_path / "results")]) == DONE
    out, err = capsys.readouterr()
    assert err == ""
    for expected in ("Scores", "Comparisons", "Agreement of viewers", "Measures without viewers", "Trumpet 1"):
        assert f"\n{expected}" in out or f"  {expected}" in out
    assert "What may not be concluded:\n- With 8 viewers only large differences show" in out
    assert "results.md, results.svg, results_ja.md, results_ja.svg, results.csv, results.json" in out
    assert (tmp_path / "results" / "results_ja.md").is_file()


def test_nothing_is_written_unless_requested(answers: list[str], tmp_path: Path) -> None:
    before = sorted(tmp_path.rglob("*"))
    assert main(["evaluate", "results", *answers]) == DONE
    assert sorted(tmp_path.rglob("*")) == before


def test_the_key_is_found_or_asked_for(answers: list[str], tmp_path: Path, capsys: Captured) -> None:
    shutil.move(tmp_path / "key.json", tmp_path / "elsewhere.json")
    assert main(["evaluate", "results", *answers]) == BAD_INPUT
    assert "name it with --key" in capsys.readouterr().err
    assert main(["evaluate", "results", *answers, "--key", str(tmp_path / "elsewhere.json")]) == DONE
    shutil.move(tmp_path / "elsewhere.json", tmp_path / "answers" / "key.json")
    assert main(["evaluate", "results", *answers]) == DONE


def test_errors_name_file_and_line(answers: list[str], capsys: Captured) -> None:
    path = Path(answers[3])
    path.write_bytes(path.read_bytes().replace(b",body,naturalness,", b",body,naturalness,9", 1))
    assert main(["evaluate", "results", *answers]) == BAD_INPUT
    _, err = capsys.readouterr()
    assert f"{path}, line" in err
    assert "answer is '9" in err
    assert err.count("\n") == 1
    assert main(["evaluate", "results", answers[0], answers[0]]) == BAD_INPUT
    assert "of the same viewer" in capsys.readouterr().err
    assert main(["evaluate", "results", "nowhere.csv"]) == BAD_INPUT
    assert "nowhere.csv cannot be read" in capsys.readouterr().err
    assert main(["evaluate", "results", answers[0], "--key", str(path)]) == BAD_INPUT
    assert "is not the key of an evaluation" in capsys.readouterr().err
    assert main(["evaluate", "results"]) == BAD_USE


def test_measures_of_a_piece(capsys: Captured) -> None:
    with as_file(files("resources") / "examples" / "quartet.mid") as path:
        assert main(["evaluate", "measures", str(path)]) == DONE
    out, _ = capsys.readouterr()
    lines = out.splitlines()
    assert lines[0] == "Measures without viewers"
    assert [line.split()[0] for line in lines[2:6]] == ["generated"] * 4
    assert lines[-1].startswith("(Lag: action seen minus note heard")
