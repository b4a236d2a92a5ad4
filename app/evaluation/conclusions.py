"""Conclusions that the results support, and warnings about those that they do not support, as messages."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator
from typing import Final

import msgspec

from app.errors import Argument, Message
from app.evaluation.key import STEPS, Presentation, Variant
from app.evaluation.results import EvaluationResults, ManipulationCheck, Question
from app.evaluation.statistics import SIGNIFICANT, smallest_p

ENOUGH_VIEWERS: Final = 15
"""Least number of viewers recommended by ITU-R BT.500."""
RELIABLE_ALPHA: Final = 0.667
"""Value of alpha below which Krippendorff advises against conclusions."""


class Conclusions(msgspec.Struct, frozen=True):
    """Conclusions and warnings of an evaluation as messages, in the order of the report."""

    may: tuple[Message, ...]
    may_not: tuple[Message, ...]


def conclude(results: EvaluationResults) -> Conclusions:
    """Draw the conclusions from the results of an evaluation, and add warnings."""
    return Conclusions(tuple(_may(results)), tuple(_may_not(results)))


def p_text(p: float) -> str:
    """Format a p value as text for a report."""
    return "p < 0.001" if p < 0.001 else f"p = {p:.3f}"


def said_of(question: Question) -> dict[str, Argument]:
    """Return the arguments that describe a question in messages: presentation, aspect and scale."""
    return {
        "presentation": f"results.presentation_{question.presentation}",
        "aspect": f"results.aspect_{question.aspect}",
        "scale": f"results.scale_{question.scale}",
    }


def _may(results: EvaluationResults) -> Iterator[Message]:
    counts: dict[str, Argument] = {"answers": results.answers, "not_judged": results.not_judged}
    yield Message("results.answered", {"viewers": len(results.viewers), **counts})
    for control in results.controls:
        if control.verdict == "noticed":
            yield _of_control(control)
    yield from _better(results)


def _may_not(results: EvaluationResults) -> Iterator[Message]:
    yield from _viewers(results)
    for control in results.controls:
        if control.verdict != "noticed":
            yield _of_control(control)
    if not results.controls:
        yield Message("results.no_control")
    yield from _open(results)
    yield from _agreement(results)
    yield from _orders(results)
    if len({score.question.presentation for score in results.scores}) > 1:
        yield Message("results.not_pooled")
    if results.incomplete:
        yield Message("results.incomplete", _listed(results.incomplete))
    if results.unvaried:
        yield Message("results.unvaried", _listed(results.unvaried))
    yield Message("results.scope")


def _shown(steps: float) -> float:
    """Round a value in steps of the scale to the precision of the report; never "-0"."""
    return round(steps, 2) + 0.0


def _listed(ids: tuple[str, ...]) -> dict[str, Argument]:
    return {"count": len(ids), "ids": ", ".join(ids)}


def _of_control(control: ManipulationCheck) -> Message:
    presentation = f"results.presentation_{control.presentation}"
    if control.difference is None:
        return Message("results.control_unjudged", {"presentation": presentation})
    found: dict[str, Argument] = {
        "presentation": presentation,
        "difference": _shown(control.difference),
        "p": p_text(1.0 if control.p is None else control.p),
        "viewers": control.viewers,
    }
    if control.verdict == "noticed":
        return Message("results.control_noticed", found)
    if control.verdict == "unclear":
        return Message("results.control_unclear", found)
    return Message("results.control_unnoticed", found)


def _better(results: EvaluationResults) -> Iterator[Message]:
    """Yield a message for each variant that was judged better than another one, with the number of questions."""
    total: dict[tuple[Presentation, frozenset[Variant]], int] = defaultdict(int)
    found: dict[tuple[Presentation, Variant, Variant], list[float]] = defaultdict(list)
    for contrast in results.contrasts:
        presentation, mean = contrast.question.presentation, contrast.comparison.mean
        total[presentation, frozenset((contrast.first, contrast.second))] += 1
        if contrast.significant:
            order = (contrast.first, contrast.second) if mean > 0.0 else (contrast.second, contrast.first)
            found[presentation, *order].append(abs(mean))
    for (presentation, better, worse), means in found.items():
        said: dict[str, Argument] = {
            "presentation": f"results.presentation_{presentation}",
            "variant": f"results.variant_{better}",
            "beside": f"results.variant_{worse}",
            "count": len(means),
            "total": total[presentation, frozenset((better, worse))],
        }
        yield Message("results.better", {**said, "most": max(means)})
    if not found:
        yield Message("results.none_better")


def _viewers(results: EvaluationResults) -> Iterator[Message]:
    """Yield a warning if there are too few viewers."""
    viewers = len(results.viewers)
    if viewers == 1:
        yield Message("results.one_viewer")
        return
    counts: dict[Question, int] = {}
    for contrast in results.contrasts:
        counts[contrast.question] = counts.get(contrast.question, 0) + 1
    # Holm's correction is smallest for the question with the fewest comparisons.
    comparisons = min(counts.values(), default=1)
    least_p = min(1.0, comparisons * smallest_p(viewers))
    if least_p >= SIGNIFICANT:
        least = 2 + math.floor(math.log2(comparisons / SIGNIFICANT))
        said: dict[str, Argument] = {"viewers": viewers, "p": p_text(least_p)}
        yield Message("results.too_few", {**said, "comparisons": comparisons, "least": least})
    elif viewers < ENOUGH_VIEWERS:
        yield Message("results.few", {"viewers": viewers})


def _open(results: EvaluationResults) -> Iterator[Message]:
    """Yield a reminder that differences which are not significant may still exist."""
    tested = [contrast for contrast in results.contrasts if contrast.comparison.viewers > 1]
    unshown = [contrast for contrast in tested if not contrast.significant]
    if unshown:
        yield Message("results.not_equal", {"count": len(unshown), "total": len(tested)})
    of_film = [one for one in unshown if (one.first, one.second) == ("film", "generated")]
    if of_film:
        widest = max(of_film, key=lambda one: one.difference.high or 0.0)
        worse = min(max(widest.difference.high or 0.0, 0.0), float(STEPS - 1))
        yield Message("results.film_open", {**said_of(widest.question), "count": len(of_film), "worse": worse})
    if tested:
        yield Message("results.intervals")
    questions = len({contrast.question for contrast in tested})
    if questions > 1:
        yield Message("results.uncorrected", {"questions": questions})


def _agreement(results: EvaluationResults) -> Iterator[Message]:
    known = [one.alpha for one in results.agreements if one.alpha is not None]
    low = sum(alpha < RELIABLE_ALPHA for alpha in known)
    if low:
        yield Message("results.disagree", {"count": low, "total": len(known)})


def _orders(results: EvaluationResults) -> Iterator[Message]:
    for order in results.orders:
        presentation, later = f"results.presentation_{order.presentation}", order.later
        if later.low is None or later.high is None:
            continue
        if later.low > 0.0 or later.high < 0.0:
            span: dict[str, Argument] = {"difference": later.mean, "low": _shown(later.low), "high": _shown(later.high)}
            yield Message("results.later", {"presentation": presentation, **span})
        else:
            yield Message("results.order_open", {"presentation": presentation})
