"""Results written to a folder: text and picture in both languages, tables for a spreadsheet, and everything as JSON."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import msgspec

from app.errors import Message
from app.evaluation.conclusions import conclude
from app.evaluation.measures import VariantMeasures
from app.evaluation.plot import plot
from app.evaluation.results import EvaluationResults
from app.evaluation.tables import ResultTable, tables
from app.formats.atomic import atomic_write
from app.formats.files import cannot_write
from app.messages import LANGUAGES, text

VERSION: Final = 1
_STEM: Final = "results"
_SCORES: Final = (
    *("presentation", "aspect", "scale", "variant", "viewers", "answers", "not_judged"),
    *("mean", "median", "deviation", "low", "high"),
)


class _File(msgspec.Struct, frozen=True):
    format: str
    version: int
    results: EvaluationResults
    may_be_concluded: tuple[str, ...]
    may_not_be_concluded: tuple[str, ...]
    measures: tuple[VariantMeasures, ...]


def write_results(results: EvaluationResults, measures: Sequence[VariantMeasures], folder: Path) -> list[Path]:
    """Write results.md, .svg (Japanese: results_ja), .csv and .json into a folder, creating it if necessary.

    Equal results give equal bytes.

    Raises
    ------
    FileError
        A file cannot be written.
    """
    contents = {}
    for language in LANGUAGES:
        stem = _STEM if language == "en" else f"{_STEM}_{language}"
        contents[f"{stem}.md"] = markdown(results, measures, language, f"{stem}.svg").encode()
        contents[f"{stem}.svg"] = plot(results, language).encode()
    contents[f"{_STEM}.csv"] = _scores(results)
    contents[f"{_STEM}.json"] = _json(results, measures)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(folder, error) from error
    for name, content in contents.items():
        with atomic_write(folder / name) as stream:
            stream.write(content)
    return [folder / name for name in contents]


def markdown(results: EvaluationResults, measures: Sequence[VariantMeasures], language: str, picture: str) -> str:
    """Return the report in a language: conclusions, plot and tables."""
    conclusions = conclude(results)
    title = text(Message("results.title", {"piece": results.piece}), language)
    parts = [f"# {_plain(title)}", ""]
    for heading, said in (("results.may", conclusions.may), ("results.may_not", conclusions.may_not)):
        parts += [f"## {text(Message(heading), language)}", ""]
        parts += [*(f"- {_plain(text(message, language))}" for message in said), ""]
    parts += [f"![{text(Message('results.plot'), language)}]({picture})", ""]
    for table in tables(results, measures, language):
        parts += [f"## {table.title}", "", *_table(table), "", table.note, ""]
    return "\n".join(parts)


def _table(table: ResultTable) -> list[str]:
    marks = ["---"] * table.names + ["---:"] * (len(table.head) - table.names)
    return [f"| {' | '.join(map(_plain, row))} |" for row in (table.head, marks, *table.rows)]


def _plain(words: str) -> str:
    """Escape characters with a meaning in Markdown, for names of pieces and players."""
    return "".join(f"\\{character}" if character in "\\|*_`<>[]#" else character for character in words)


def _scores(results: EvaluationResults) -> bytes:
    """Return scores as CSV for spreadsheets, with a byte order mark and plain numbers."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\r\n")
    writer.writerow(_SCORES)
    for score in results.scores:
        over, question = score.over_viewers, score.question
        spread = (0,) if over is None else (over.viewers,)
        numbers = [None] * 5 if over is None else [over.mean, over.median, over.deviation, over.low, over.high]
        writer.writerow(
            [
                *(question.presentation, question.aspect, question.scale, score.variant, *spread),
                *(score.answers, score.not_judged),
                *("" if value is None else f"{value:.4f}" for value in numbers),
            ]
        )
    return ("\ufeff" + stream.getvalue()).encode()


def _json(results: EvaluationResults, measures: Sequence[VariantMeasures]) -> bytes:
    conclusions = conclude(results)
    may, may_not = (tuple(text(message) for message in said) for said in (conclusions.may, conclusions.may_not))
    file = _File("suisou-evaluation-results", VERSION, results, may, may_not, tuple(measures))
    return msgspec.json.format(msgspec.json.encode(file), indent=1) + b"\n"
