"""Results of viewers with known opinions, and the texts about them."""

from __future__ import annotations

import random
import re
from collections.abc import Sequence

import msgspec
import pytest

from app.errors import FileError, Message
from app.evaluation.answers import Answer, ViewerFile
from app.evaluation.conclusions import conclude
from app.evaluation.key import ASPECTS, SCALES, Variant
from app.evaluation.results import Contrast, EvaluationResults, Question, tabulate
from app.evaluation.statistics import summary
from app.messages import LANGUAGES, text
from tests.support.viewers import TRUTH, answer_of, key_of, opinion, viewer_of, viewers

KEY = key_of()
FINGERS = Question("single", "fingers_arms", "synchrony")
BODY = Question("single", "body", "naturalness")
CODE = {(clip.variant, clip.excerpt): clip.code for clip in KEY.clips}


def contrast(results: EvaluationResults, question: Question, first: Variant, second: Variant) -> Contrast:
    [found] = [one for one in results.contrasts if (one.question, one.first, one.second) == (question, first, second)]
    return found


def ids(messages: Sequence[Message]) -> list[str]:
    return [message.id for message in messages]


def worded(results: EvaluationResults) -> list[str]:
    """All texts in both languages, checked for empty fields and "nan"."""
    said = conclude(results)
    found = [text(message, language) for language in LANGUAGES for message in (*said.may, *said.may_not)]
    assert not [sentence for sentence in found if re.search(r"[{}]|nan|None", sentence)]
    return found


@pytest.fixture(scope="module")
def many() -> EvaluationResults:
    return tabulate(KEY, viewers(KEY, 30, presentations=("single", "pair"), skips=0.05))


def test_known_opinions_are_recovered(many: EvaluationResults) -> None:
    missed = 0
    for score in many.scores:
        over, question = score.over_viewers, score.question
        assert over is not None
        truth = opinion(TRUTH, score.variant, question.aspect, question.scale, 1.5)
        # Answers end at 1 and 5, so that the mean of an opinion near an end is a little nearer to the middle.
        assert abs(over.mean - truth) < 0.4
        missed += not (over.low or 0.0) - 0.15 <= truth <= (over.high or 0.0) + 0.15
    assert missed <= 0.1 * len(many.scores)


def test_differences_are_shown_where_they_are(many: EvaluationResults) -> None:
    for presentation in ("single", "pair"):
        question = msgspec.structs.replace(FINGERS, presentation=presentation)
        late = contrast(many, question, "generated", "shifted")
        assert late.significant
        assert late.comparison.mean == pytest.approx(1.6, abs=0.4)
        assert late.comparison.effect == pytest.approx(1.0, abs=0.1)
    still = contrast(many, BODY, "generated", "still")
    assert still.significant
    assert still.difference == summary_of(still)
    assert still.corrected_p is not None
    assert still.comparison.p is not None
    assert still.corrected_p >= still.comparison.p


def summary_of(found: Contrast) -> object:
    """Summary of values, checked to have an interval around the reported mean."""
    spread = found.difference
    assert spread.low is not None
    assert spread.high is not None
    assert spread.low < found.comparison.mean < spread.high
    assert spread.viewers == found.comparison.viewers
    return spread


def test_without_a_difference_few_are_shown() -> None:
    """At most one family of six comparisons in twenty shows a difference by chance: 8 questions of 10 evaluations."""
    same: dict[Variant, float] = dict.fromkeys(TRUTH, 3.2)
    shown = set()
    for seed in range(10):
        results = tabulate(KEY, viewers(KEY, 16, seed=seed, truth=same, late=0.0))
        shown |= {(seed, one.question) for one in results.contrasts if one.significant}
    assert len(shown) <= 9


def test_the_control_is_noticed_or_not(many: EvaluationResults) -> None:
    assert [control.verdict for control in many.controls] == ["noticed", "noticed"]
    assert ids(conclude(many).may).count("results.control_noticed") == 2
    blind = tabulate(KEY, viewers(KEY, 20, late=-0.6))
    assert [control.verdict for control in blind.controls] == ["unnoticed"]
    assert "results.control_unnoticed" in ids(conclude(blind).may_not)
    assert any("did not notice 200 ms" in sentence for sentence in worded(blind))
    few = tabulate(KEY, viewers(KEY, 3, late=1.5))
    assert [control.verdict for control in few.controls] == ["unclear"]
    without = tabulate(key_of(("film", "generated")), viewers(key_of(("film", "generated")), 8))
    assert without.controls == ()
    assert "results.no_control" in ids(conclude(without).may_not)


def test_tired_viewers_are_found(many: EvaluationResults) -> None:
    tired = tabulate(KEY, viewers(KEY, 20, tires=1.5))
    [order] = tired.orders
    # Between the halves lies half of the way from the first answer to the last.
    assert order.later.mean == pytest.approx(-0.75, abs=0.25)
    assert "results.later" in ids(conclude(tired).may_not)


def test_the_order_of_the_files_changes_nothing() -> None:
    files = viewers(KEY, 9, presentations=("single", "pair"))
    shuffled = random.Random(3).sample(files, len(files))
    assert msgspec.json.encode(tabulate(KEY, files)) == msgspec.json.encode(tabulate(KEY, shuffled))


def test_agreement_is_by_clip() -> None:
    """Viewers who give each clip the same rating agree, however much clips differ and in whatever order
    they are shown.
    """
    opinions = {clip.code: 1 + index % 5 for index, clip in enumerate(KEY.clips)}

    def file(viewer: str, seed: int) -> ViewerFile:
        codes = random.Random(seed).sample(sorted(opinions), len(opinions))
        given = [
            answer_of(code, viewer=viewer, position=position, answer=opinions[code])
            for position, code in enumerate(codes, start=1)
        ]
        return viewer_of(given)

    [agreement] = tabulate(KEY, [file("a0000001", 1), file("a0000002", 2)]).agreements
    assert (agreement.question, agreement.clips, agreement.alpha) == (BODY, 12, 1.0)


def test_variants_are_compared_in_the_same_excerpts() -> None:
    """A viewer who could not judge one excerpt of a variant is compared in the other excerpts, since
    excerpts differ.
    """
    given = {("film", 1): 5, ("film", 2): 2, ("generated", 1): 4, ("generated", 2): None}
    answers = [
        answer_of(CODE[place], position=position, answer=answer)
        for position, (place, answer) in enumerate(given.items(), start=1)
    ]
    results = tabulate(KEY, [viewer_of(answers)])
    assert contrast(results, BODY, "film", "generated").comparison.mean == 1.0
    assert [(score.variant, score.answers, score.not_judged) for score in results.scores] == [
        ("film", 2, 0),
        ("generated", 1, 1),
    ]


def test_pairs_are_compared_side_by_side() -> None:
    def pair(position: int, **answers: int) -> list[Answer]:
        return [
            answer_of(CODE[variant, 1], position=position, presentation="pair", side=side, answer=answer)
            for side, (variant, answer) in zip(("left", "right"), answers.items(), strict=True)
        ]

    answers = [*pair(1, film=5, generated=4), *pair(2, generated=2, still=1)]
    results = tabulate(KEY, [viewer_of(answers)])
    question = msgspec.structs.replace(BODY, presentation="pair")
    assert {(one.first, one.second): one.comparison.mean for one in results.contrasts} == {
        ("film", "generated"): 1.0,
        ("generated", "still"): 1.0,
    }
    assert contrast(results, question, "film", "generated").comparison.p == 1.0


@pytest.mark.parametrize("count", [1, 2, 5])
def test_few_viewers_are_explained(count: int) -> None:
    results = tabulate(KEY, viewers(KEY, count))
    said = ids(conclude(results).may_not)
    assert "results.one_viewer" in said if count == 1 else "results.too_few" in said
    assert not any(one.significant for one in results.contrasts)
    assert worded(results)


def test_the_least_number_of_viewers_is_the_least() -> None:
    """One viewer fewer than the reported least number cannot show a difference."""
    results = tabulate(KEY, viewers(KEY, 2))
    [few] = [message for message in conclude(results).may_not if message.id == "results.too_few"]
    least = int(few.arguments["least"])
    assert few.arguments["comparisons"] == 6
    assert 6 * 2 ** (1 - least) < 0.05 <= 6 * 2 ** (2 - least)
    assert "results.too_few" not in ids(conclude(tabulate(KEY, viewers(KEY, least))).may_not)


def test_viewers_without_variety_and_without_answers() -> None:
    same = [
        answer_of(clip.code, position=position, aspect=aspect, scale=scale, answer=4)
        for position, clip in enumerate(KEY.clips, start=1)
        for aspect in ASPECTS
        for scale in SCALES
    ]
    none = [msgspec.structs.replace(answer, viewer="b0000001", answer=None) for answer in same[:5]]
    results = tabulate(KEY, [viewer_of(same, "a.csv"), viewer_of(none, "b.csv")])
    assert (results.unvaried, results.incomplete) == (("a0000001",), ("b0000001",))
    assert {"results.unvaried", "results.incomplete"} <= set(ids(conclude(results).may_not))
    assert [control.verdict for control in results.controls] == ["unnoticed"]
    assert worded(results)
    nothing = tabulate(KEY, [viewer_of(none)])
    assert all(score.over_viewers is None for score in nothing.scores)
    assert nothing.contrasts == ()
    assert worded(nothing)


def test_not_significant_is_not_said_to_be_equal() -> None:
    results = tabulate(KEY, viewers(KEY, 12, truth={**TRUTH, "film": TRUTH["generated"]}))
    said = {message.id: message for message in conclude(results).may_not}
    assert "do not show that two variants are equal" in text(said["results.not_equal"])
    assert 0.0 < float(said["results.film_open"].arguments["worse"]) < 1.0


@pytest.mark.parametrize(
    ("changes", "id"),
    [
        ({"evaluation": "deadbeef"}, "results.other_evaluation"),
        ({"clip": "c99"}, "results.unknown_clip"),
        ({"aspect": "mouth"}, "results.unasked"),
    ],
)
def test_a_file_that_does_not_fit_the_key(changes: dict[str, str], id: str) -> None:
    key = msgspec.structs.replace(KEY, aspects=("body",))
    with pytest.raises(FileError) as raised:
        tabulate(key, [viewer_of([answer_of(**changes)], "anna.csv")])
    assert raised.value.message.id == id
    assert "anna.csv" in text(raised.value.message)


def test_a_viewer_counts_once() -> None:
    with pytest.raises(FileError) as raised:
        tabulate(KEY, [viewer_of([answer_of()], "one.csv"), viewer_of([answer_of()], "two.csv")])
    assert raised.value.message.id == "results.same_viewer"
    assert {"one.csv", "two.csv"} == set(raised.value.message.arguments.values())


def test_results_are_about_viewers_means() -> None:
    """A viewer with many answers has no more weight than others."""
    often = [answer_of(CODE["film", excerpt], position=excerpt, answer=5) for excerpt in (1, 2, 3)]
    once = [answer_of(CODE["film", 1], viewer="b0000001", answer=1)]
    [score] = tabulate(KEY, [viewer_of(often), viewer_of(once)]).scores
    assert score.over_viewers == summary([5.0, 1.0])
