"""Viewers' files with the key and the measures that belong to them, found beside them and tabulated."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from app.errors import FileError
from app.evaluation.answers import read_answers
from app.evaluation.key import KEY_FILE, read_key
from app.evaluation.measures import MEASURES_FILE, VariantMeasures, read_measures
from app.evaluation.results import EvaluationResults, tabulate


@dataclass(frozen=True)
class Gathered:
    """Answers of viewers with the measures made without them, and the key of the clips."""

    results: EvaluationResults
    measures: tuple[VariantMeasures, ...]
    key_file: Path


def gather(files: Sequence[Path], key_file: Path | None = None) -> Gathered:
    """Read and tabulate.

    Parameters
    ----------
    files : sequence of Path
        One for each viewer; at least one.
    key_file : Path, optional
        The one beside the first file, or in the folder above, where None.

    Raises
    ------
    AppError
        Those of `app.evaluation.answers`, `results`, `key` and `measures`; ``results.no_key`` (file, name).
    """
    answers = [read_answers(path) for path in files]
    key_file = key_file or _key_of(files[0])
    results = tabulate(read_key(key_file), answers)
    measured = key_file.with_name(MEASURES_FILE)
    return Gathered(results, read_measures(measured) if os.path.isfile(measured) else (), key_file)


def _key_of(file: Path) -> Path:
    folder = file.absolute().parent
    for place in (folder, folder.parent):
        if os.path.isfile(place / KEY_FILE):
            return place / KEY_FILE
    raise FileError("results.no_key", file=str(file), name=KEY_FILE)
