"""Readers of the program's own file formats other than projects: evaluations, export notes of a folder, cuts."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any


def keyframes(path: Path, folder: Path) -> None:
    """Motion of one player from elsewhere."""
    from app.evaluation.keyframes import read_keyframes

    performance = _performance()
    read_keyframes(performance, path, [performance.project.players[0].id])


@cache
def _performance() -> Any:
    from app.performance.ensemble import Performance
    from tests.fuzz.harness.costly_projects import base

    return Performance(base())


def evaluation_key(path: Path, folder: Path) -> None:
    """Read a key of an evaluation and work out its results with the answers of one viewer."""
    from app.evaluation.key import KEY_FILE
    from tests.fuzz.harness.own_files import answers

    (folder / KEY_FILE).write_bytes(path.read_bytes())
    _results(answers()[0], folder)


def answers(path: Path, folder: Path) -> None:
    """Read a viewer's answers and work out the results with them."""
    from app.evaluation.key import KEY_FILE
    from tests.fuzz.harness.own_files import evaluation_key

    (folder / KEY_FILE).write_bytes(evaluation_key()[0])
    _results(path.read_bytes(), folder)


def _results(content: bytes, folder: Path) -> None:
    from app.evaluation.report import write_results
    from app.evaluation.viewer_files import gather

    file = folder / "answers.csv"
    file.write_bytes(content)
    gathered = gather([file])
    write_results(gathered.results, gathered.measures, folder / "results")


def exported(path: Path, folder: Path) -> None:
    """Read notes about earlier exports; damaged ones are set aside."""
    from app.cli.batch import NOTES, _read_notes

    (folder / NOTES).write_bytes(path.read_bytes())
    _read_notes(folder / NOTES)


def cuts(path: Path, folder: Path) -> None:
    """Times at which a motion is cut."""
    from app.choreography.cuts_by_hand import read_times

    read_times(path)
