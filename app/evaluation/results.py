"""Tables of all viewers' answers: scores of every variant, comparisons, agreement, and the control's result.

Answers about single clips and about pairs are different questions and never pooled. Every value is first averaged for
each viewer; statistics are over viewers.
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final, Literal, get_args

import msgspec

from app.errors import FileError
from app.evaluation.answers import Answer, ViewerFile
from app.evaluation.key import SCALES, VARIANTS, Aspect, EvaluationClip, EvaluationKey, Presentation, Scale, Variant
from app.evaluation.statistics import (
    SIGNIFICANT,
    Comparison,
    Summary,
    compared,
    holm,
    lower_p,
    ordinal_alpha,
    summary,
)

PRESENTATIONS: Final[tuple[Presentation, ...]] = get_args(Presentation)


class Question(msgspec.Struct, frozen=True):
    """A question about the variants: presentation (single clips or pairs), aspect and scale."""

    presentation: Presentation
    aspect: Aspect
    scale: Scale


class VariantScore(msgspec.Struct, frozen=True):
    """Viewers' judgements of one variant for one question: number of answers, number of "cannot judge", and
    ``over_viewers``, the summary of the viewers' means (None if no viewer judged).
    """

    question: Question
    variant: Variant
    answers: int
    not_judged: int
    over_viewers: Summary | None


class Contrast(msgspec.Struct, frozen=True):
    """Comparison of two variants judged by the same viewers.

    Attributes
    ----------
    comparison : Comparison
        Test of the difference, first minus second variant: between clips shown side by side for pairs, else between
        clips of the same excerpt.
    difference : Summary
        Summary of the same differences.
    corrected_p : float or None
        Probability corrected by Holm's method for all comparisons of this question.
    """

    question: Question
    first: Variant
    second: Variant
    comparison: Comparison
    difference: Summary
    corrected_p: float | None

    @property
    def significant(self) -> bool:
        """True if the corrected probability is below `SIGNIFICANT`."""
        return self.corrected_p is not None and self.corrected_p < SIGNIFICANT


class Agreement(msgspec.Struct, frozen=True):
    """Agreement of the viewers for one question, as Krippendorff's alpha (ordinal); None if it is undefined."""

    question: Question
    clips: int
    alpha: float | None


Verdict = Literal["noticed", "unclear", "unnoticed", "unjudged"]


class ManipulationCheck(msgspec.Struct, frozen=True):
    """Test of whether viewers notice the deliberate flaw: fingers 200 ms late must be judged as less in time.

    Attributes
    ----------
    verdict : str
        ``noticed``: lower, one-sided p below `SIGNIFICANT`; ``unclear``: lower, but not significantly; ``unnoticed``:
        not lower; ``unjudged``: both were judged by no viewer.
    """

    presentation: Presentation
    viewers: int
    difference: float | None
    p: float | None
    verdict: Verdict


class OrderEffect(msgspec.Struct, frozen=True):
    """Effect of tiredness or practice: change of the answers in the second half of a session that variants and
    questions do not explain.
    """

    presentation: Presentation
    later: Summary


class EvaluationResults(msgspec.Struct, frozen=True):
    """All results of an evaluation.

    Attributes
    ----------
    viewers : tuple of str
        Ids of the viewers, sorted.
    incomplete : tuple of str
        Viewers with fewer answers than others.
    unvaried : tuple of str
        Viewers with the same answer to every question.
    """

    evaluation: str
    piece: str
    viewers: tuple[str, ...]
    incomplete: tuple[str, ...]
    unvaried: tuple[str, ...]
    answers: int
    not_judged: int
    scores: tuple[VariantScore, ...]
    contrasts: tuple[Contrast, ...]
    agreements: tuple[Agreement, ...]
    controls: tuple[ManipulationCheck, ...]
    orders: tuple[OrderEffect, ...]


class _Rating(msgspec.Struct, frozen=True):
    viewer: str
    clip: EvaluationClip
    answer: Answer
    beside: str
    """Code of the other clip of a pair."""

    @property
    def value(self) -> int:
        return self.answer.answer or 0

    @property
    def place(self) -> tuple[object, ...]:
        """Key that the ratings of two variants must share to be compared: the position of the pair of clips in the
        form, or for clips rated one by one their excerpt, camera view and player."""
        if self.answer.presentation == "pair":
            return (self.answer.position,)
        return self.clip.excerpt, self.clip.view, self.clip.player


def tabulate(key: EvaluationKey, files: Sequence[ViewerFile]) -> EvaluationResults:
    """Compute all results from the files of all viewers, independent of their order.

    Raises
    ------
    FileError
        A file does not belong to the key, or answers repeat or are invalid.
    """
    _check(key, files)
    files = sorted(files, key=lambda file: file.viewer)
    clips = {clip.code: clip for clip in key.clips}
    everything = [answer for file in files for answer in file.answers]
    given = list(_ratings(files, clips))
    by_question: dict[Question, list[_Rating]] = {question: [] for question in _questions(key, everything)}
    for rating in given:
        by_question[_question(rating.answer)].append(rating)
    most = max((len(file.answers) for file in files), default=0)
    return EvaluationResults(
        evaluation=key.evaluation,
        piece=key.piece,
        viewers=tuple(file.viewer for file in files),
        incomplete=tuple(file.viewer for file in files if len(file.answers) < most),
        unvaried=tuple(file.viewer for file in files if _is_unvaried(file)),
        answers=len(given),
        not_judged=len(everything) - len(given),
        scores=tuple(_scores(by_question, everything, clips)),
        contrasts=tuple(itertools.chain.from_iterable(_contrasts(*item) for item in by_question.items())),
        agreements=tuple(_agreement(*item) for item in by_question.items()),
        controls=tuple(_controls(key, by_question)),
        orders=tuple(_orders(given)),
    )


def _check(key: EvaluationKey, files: Sequence[ViewerFile]) -> None:
    codes = {clip.code for clip in key.clips}
    seen: dict[str, Path] = {}
    for file in files:
        name = str(file.path)
        if file.evaluation != key.evaluation:
            raise FileError("results.other_evaluation", file=name, found=file.evaluation, expected=key.evaluation)
        if file.viewer in seen:
            raise FileError("results.same_viewer", file=name, other=str(seen[file.viewer]))
        seen[file.viewer] = file.path
        for answer, line in zip(file.answers, file.lines, strict=True):
            if answer.clip not in codes:
                raise FileError("results.unknown_clip", file=name, line=line, code=answer.clip)
            if answer.aspect not in key.aspects:
                raise FileError("results.unasked", file=name, line=line, aspect=answer.aspect)


def _question(answer: Answer) -> Question:
    return Question(answer.presentation, answer.aspect, answer.scale)


def _questions(key: EvaluationKey, answers: Sequence[Answer]) -> Iterator[Question]:
    """Yield the questions that any viewer answered, in the order of the tables."""
    asked = {_question(answer) for answer in answers}
    for presentation, aspect, scale in itertools.product(PRESENTATIONS, key.aspects, SCALES):
        question = Question(presentation, aspect, scale)
        if question in asked:
            yield question


def _is_unvaried(file: ViewerFile) -> bool:
    values = [answer.answer for answer in file.answers if answer.answer is not None]
    return len(values) > 1 and len(set(values)) == 1


def _ratings(files: Sequence[ViewerFile], clips: dict[str, EvaluationClip]) -> Iterator[_Rating]:
    for file in files:
        shown: dict[tuple[int, str], set[str]] = defaultdict(set)
        for answer in file.answers:
            shown[answer.position, answer.presentation].add(answer.clip)
        for answer in file.answers:
            if answer.answer is not None:
                others = shown[answer.position, answer.presentation] - {answer.clip}
                yield _Rating(file.viewer, clips[answer.clip], answer, min(others, default=""))


def _scores(
    by_question: dict[Question, list[_Rating]], everything: Sequence[Answer], clips: dict[str, EvaluationClip]
) -> Iterator[VariantScore]:
    skipped: dict[tuple[Question, Variant], int] = defaultdict(int)
    for answer in everything:
        skipped[_question(answer), clips[answer.clip].variant] += answer.answer is None
    for question, ratings in by_question.items():
        for variant in VARIANTS:
            own = [rating for rating in ratings if rating.clip.variant == variant]
            if own or (question, variant) in skipped:
                means = list(_means(own).values())
                yield VariantScore(question, variant, len(own), skipped[question, variant], summary(means))


def _means(ratings: Sequence[_Rating]) -> dict[str, float]:
    """Return the mean rating by viewer."""
    values: dict[str, list[int]] = defaultdict(list)
    for rating in ratings:
        values[rating.viewer].append(rating.value)
    return {viewer: sum(own) / len(own) for viewer, own in values.items()}


def _contrasts(question: Question, ratings: Sequence[_Rating]) -> list[Contrast]:
    found = []
    for first, second in itertools.combinations(VARIANTS, 2):
        differences = _differences(ratings, first, second)
        comparison, spread = compared(differences), summary(differences)
        if comparison is not None and spread is not None:
            found.append(Contrast(question, first, second, comparison, spread, None))
    tested = [one for one in found if one.comparison.p is not None]
    corrected = iter(holm([one.comparison.p for one in tested if one.comparison.p is not None]))
    return [
        one if one.comparison.p is None else msgspec.structs.replace(one, corrected_p=next(corrected)) for one in found
    ]


def _differences(ratings: Sequence[_Rating], first: Variant, second: Variant) -> list[float]:
    """For each viewer the mean difference between two variants, over the excerpts or pairs for which the viewer judged
    both.
    """
    values: dict[str, dict[tuple[object, ...], dict[str, list[int]]]] = defaultdict(lambda: defaultdict(dict))
    for rating in ratings:
        if rating.clip.variant in (first, second):
            values[rating.viewer][rating.place].setdefault(rating.clip.variant, []).append(rating.value)
    found = []
    for places in values.values():
        both = [
            sum(judged[first]) / len(judged[first]) - sum(judged[second]) / len(judged[second])
            for judged in places.values()
            if len(judged) == 2
        ]
        if both:
            found.append(sum(both) / len(both))
    return found


def _agreement(question: Question, ratings: Sequence[_Rating]) -> Agreement:
    """Compute the agreement of viewers on clips. In pairs a clip is distinguished by the clip beside it; only a
    viewer's first answer counts.
    """
    units: dict[object, dict[str, int]] = defaultdict(dict)
    for rating in sorted(ratings, key=lambda rating: (rating.viewer, rating.answer.position, rating.answer.side)):
        units[rating.clip.code, rating.beside].setdefault(rating.viewer, rating.value)
    alpha = ordinal_alpha({unit: list(given.values()) for unit, given in units.items()})
    return Agreement(question, sum(len(given) > 1 for given in units.values()), alpha)


def _controls(key: EvaluationKey, by_question: dict[Question, list[_Rating]]) -> Iterator[ManipulationCheck]:
    if not {"generated", "shifted"} <= {clip.variant for clip in key.clips}:
        return
    for presentation in PRESENTATIONS:
        ratings = by_question.get(Question(presentation, "fingers_arms", "synchrony"))
        if ratings is not None:
            differences = _differences(ratings, "shifted", "generated")
            yield _control(presentation, differences)


def _control(presentation: Presentation, differences: Sequence[float]) -> ManipulationCheck:
    if not differences:
        return ManipulationCheck(presentation, 0, None, None, "unjudged")
    mean, p = sum(differences) / len(differences), lower_p(differences)
    verdict: Verdict = "unnoticed"
    if mean < 0.0:
        verdict = "noticed" if p is not None and p < SIGNIFICANT else "unclear"
    return ManipulationCheck(presentation, len(differences), mean, p, verdict)


def _orders(ratings: Sequence[_Rating]) -> Iterator[OrderEffect]:
    """Yield for each viewer the mean of the answers in the second half of the session minus that in the first half."""
    cells: dict[object, list[int]] = defaultdict(list)
    for rating in ratings:
        cells[_question(rating.answer), rating.clip.variant].append(rating.value)
    usual = {cell: sum(values) / len(values) for cell, values in cells.items()}
    for presentation in PRESENTATIONS:
        left: dict[str, list[tuple[int, float]]] = defaultdict(list)
        for rating in ratings:
            if rating.answer.presentation == presentation:
                rest = rating.value - usual[_question(rating.answer), rating.clip.variant]
                left[rating.viewer].append((rating.answer.position, rest))
        later = []
        for own in left.values():
            positions = sorted({position for position, _ in own})
            middle = positions[len(positions) // 2]
            halves = [[rest for at, rest in own if (at >= middle) is half] for half in (False, True)]
            if all(halves):
                later.append(sum(halves[1]) / len(halves[1]) - sum(halves[0]) / len(halves[0]))
        found = summary(later)
        if found is not None:
            yield OrderEffect(presentation, found)
