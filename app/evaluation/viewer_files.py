"""Reads viewers' files, with the key and the measures found beside them, and tabulates them."""

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
    """Results of the viewers' answers, with the measures and the key of the evaluation."""

    results: EvaluationResults
    measures: tuple[VariantMeasures, ...]
    key_file: Path


def gather(files: Sequence[Path], key_file: Path | None = None) -> Gathered:
    """Read and tabulate viewers' files.

    Parameters
    ----------
    files : sequence of Path
        Files, one for each viewer; at least one.
    key_file : Path, optional
        File of the key; None for the file beside the first viewer's file or in the folder above.

    Raises
    ------
    AppError
        No key was found, or a file is invalid or belongs to another evaluation.
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
