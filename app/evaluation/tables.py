"""Results as tables of texts in a language, for the terminal, Markdown and CSV."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import msgspec

from app.errors import Message
from app.evaluation.conclusions import p_text, said_of
from app.evaluation.key import Variant
from app.evaluation.measures import VariantMeasures, Visible
from app.evaluation.results import EvaluationResults, Question
from app.messages import WORDINGS, text

NONE = "-"
"""Text of an empty cell."""
QUESTION: Final = ("presentation", "aspect", "scale")
"""Columns that describe the question."""


class ResultTable(msgspec.Struct, frozen=True):
    """A table of evaluation results: title and note, the heads of columns, and rows of text."""

    title: str
    note: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    names: int
    """Number of columns with names at the left; the others contain numbers."""


def tables(results: EvaluationResults, measures: Sequence[VariantMeasures], language: str) -> list[ResultTable]:
    """Return all tables of an evaluation; the measures only if there are any."""
    found = [_scores(results, language), _contrasts(results, language), _agreements(results, language)]
    return [*found, *([measures_table(measures, language)] if measures else [])]


def variant_name(variant: Variant, language: str) -> str:
    """Return the name of a variant for readers, in ``language``."""
    return text(Message(f"results.variant_{variant}"), language)


def _table(
    title: tuple[str, str],
    names: tuple[str, ...],
    numbers: tuple[str, ...],
    rows: Sequence[tuple[str, ...]],
    language: str,
) -> ResultTable:
    def word(id: str) -> str:
        return text(Message(f"results.{id}"), language)

    name, note = map(word, title)
    return ResultTable(name, note, tuple(map(word, names + numbers)), tuple(rows), len(names))


def _asked(question: Question, language: str) -> tuple[str, str, str]:
    place = 0 if language == "en" else 1
    said = [WORDINGS[str(id)][place] for id in said_of(question).values()]
    return said[0], said[1], said[2]


def _scores(results: EvaluationResults, language: str) -> ResultTable:
    rows = []
    for score in results.scores:
        over = score.over_viewers
        spread = (None, None, None) if over is None else (over.mean, over.median, over.deviation)
        rows.append(
            (
                *_asked(score.question, language),
                variant_name(score.variant, language),
                str(0 if over is None else over.viewers),
                str(score.answers),
                str(score.not_judged),
                *(_number(value) for value in spread),
                NONE if over is None else _interval(over.low, over.high),
            )
        )
    head = ("viewers_head", "answers_head", "not_judged_head", "mean", "median", "deviation", "interval")
    return _table(("scores", "scores_note"), (*QUESTION, "variant"), head, rows, language)


def _contrasts(results: EvaluationResults, language: str) -> ResultTable:
    rows = []
    for contrast in results.contrasts:
        comparison, spread = contrast.comparison, contrast.difference
        pair = f"{variant_name(contrast.first, language)} − {variant_name(contrast.second, language)}"
        rows.append(
            (
                *_asked(contrast.question, language),
                pair,
                str(comparison.viewers),
                f"{comparison.mean:+.2f}",
                _interval(spread.low, spread.high, signed=True),
                _p(comparison.p),
                _p(contrast.corrected_p) + ("*" if contrast.significant else ""),
                _number(comparison.effect, signed=True),
            )
        )
    head = ("viewers_head", "difference", "interval", "p", "corrected", "effect")
    return _table(("contrasts", "contrasts_note"), (*QUESTION, "compared"), head, rows, language)


def _agreements(results: EvaluationResults, language: str) -> ResultTable:
    rows = [
        (*_asked(one.question, language), str(one.clips), _number(one.alpha, signed=True)) for one in results.agreements
    ]
    return _table(("agreements", "agreements_note"), QUESTION, ("clips", "alpha"), rows, language)


def measures_table(measures: Sequence[VariantMeasures], language: str) -> ResultTable:
    """Return the table of measures with a row for every player of every variant."""
    rows = []
    for variant in measures:
        for player in variant.players:
            lag, breath = player.lag, player.breath
            rows.append(
                (
                    variant_name(variant.variant, language),
                    player.player,
                    _number(lag.median_ms, 0, signed=True),
                    _percent(lag.detectable),
                    _percent(lag.unacceptable),
                    _number(player.head_mm_s, 1),
                    _visible(breath.shoulders_mm, 1.0, 1),
                    _visible(breath.mouth, 100.0, 0),
                    _percent(player.contact),
                )
            )
    head = ("lag", "detected", "unaccepted", "head", "shoulders", "mouth_opens", "contact")
    return _table(("measures", "measures_note"), ("variant", "player"), head, rows, language)


def _number(value: float | None, digits: int = 2, signed: bool = False) -> str:
    if value is None:
        return NONE
    # Adding 0.0 turns -0.0 into 0.0.
    rounded = round(value, digits) + 0.0
    return f"{rounded:+.{digits}f}" if signed else f"{rounded:.{digits}f}"


def _percent(share: float | None) -> str:
    return NONE if share is None else f"{100.0 * share:.1f}"


def _visible(found: Visible, factor: float, digits: int) -> str:
    both = (found.at_breaths, found.between)
    return " / ".join(NONE if value is None else f"{factor * value:.{digits}f}" for value in both)


def _interval(low: float | None, high: float | None, signed: bool = False) -> str:
    if low is None or high is None:
        return NONE
    return f"{_number(low, signed=signed)} … {_number(high, signed=signed)}"


def _p(p: float | None) -> str:
    return NONE if p is None else p_text(p).removeprefix("p ").removeprefix("= ")
