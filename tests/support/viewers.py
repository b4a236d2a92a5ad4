"""Synthetic viewers with known opinions: evaluations with known results."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from pathlib import Path

from app.evaluation.answers import Answer, ViewerFile, encode_answers
from app.evaluation.key import ASPECTS, SCALES, Aspect, EvaluationClip, EvaluationKey, Presentation, Scale, Variant

EVALUATION = "c0ffee01"
TRUTH: Mapping[Variant, float] = {"film": 4.2, "generated": 3.6, "still": 2.4, "shifted": 3.5}
"""Mean opinion of each variant, without a viewer's individual taste."""


def key_of(
    variants: Sequence[Variant] = ("film", "generated", "still", "shifted"), excerpts: int = 3, piece: str = "Air"
) -> EvaluationKey:
    """Key of an evaluation with random codes."""
    clips = [(variant, excerpt) for excerpt in range(1, excerpts + 1) for variant in variants]
    random.Random(5).shuffle(clips)
    return EvaluationKey(
        format="suisou-evaluation",
        version=1,
        evaluation=EVALUATION,
        piece=piece,
        seed=5,
        clips=tuple(
            EvaluationClip(f"c{index:02}", variant, excerpt, 8.0 * excerpt, 8.0 * excerpt + 8.0, "ensemble")
            for index, (variant, excerpt) in enumerate(clips, start=1)
        ),
    )


def answer_of(clip: str = "c01", **changes: object) -> Answer:
    """An answer with default values except for those given."""
    values: dict[str, object] = {
        "evaluation": EVALUATION,
        "viewer": "a0000001",
        "language": "en",
        "position": 1,
        "presentation": "single",
        "side": "",
        "clip": clip,
        "aspect": "body",
        "scale": "naturalness",
        "answer": 3,
        "seconds": 9.5,
    }
    return Answer(**(values | changes))


def viewer_of(answers: Sequence[Answer], name: str = "answers.csv") -> ViewerFile:
    """Viewer file with these answers."""
    return ViewerFile(Path(name), tuple(answers), tuple(range(2, len(answers) + 2)))


def opinion(truth: Mapping[Variant, float], variant: Variant, aspect: Aspect, scale: Scale, late: float) -> float:
    """Mean rating of viewers; late fingers lower only the rating of the fingers' synchrony."""
    lost = late if (variant, aspect, scale) == ("shifted", "fingers_arms", "synchrony") else 0.0
    return truth[variant] - lost


def viewers(
    key: EvaluationKey,
    count: int,
    seed: int = 1,
    truth: Mapping[Variant, float] = TRUTH,
    late: float = 1.5,
    tires: float = 0.0,
    presentations: Sequence[Presentation] = ("single",),
    skips: float = 0.0,
) -> list[ViewerFile]:
    """Synthetic viewers, each with a random order of clips.

    Parameters
    ----------
    truth : mapping
        Mean opinion by variant.
    late : float
        How much worse late fingers are judged.
    tires : float
        How much lower the last answer is than the first.
    skips : float
        0..1 of the answers that are "cannot judge".
    """
    return [
        _viewer(key, index, random.Random(f"{seed}:{index}"), truth, late, tires, presentations, skips)
        for index in range(count)
    ]


def _viewer(
    key: EvaluationKey,
    index: int,
    by_chance: random.Random,
    truth: Mapping[Variant, float],
    late: float,
    tires: float,
    presentations: Sequence[Presentation],
    skips: float,
) -> ViewerFile:
    taste = by_chance.gauss(0.0, 0.4)
    shown: list[tuple[Presentation, tuple[EvaluationClip, ...]]] = []
    if "single" in presentations:
        shown += [("single", (clip,)) for clip in by_chance.sample(key.clips, len(key.clips))]
    if "pair" in presentations:
        ours = {clip.excerpt: clip for clip in key.clips if clip.variant == "generated"}
        others = [clip for clip in key.clips if clip.variant != "generated"]
        for clip in by_chance.sample(others, len(others)):
            pair = [clip, ours[clip.excerpt]]
            by_chance.shuffle(pair)
            shown.append(("pair", tuple(pair)))
    answers = []
    for position, (presentation, clips) in enumerate(shown, start=1):
        for place, clip in enumerate(clips):
            for aspect in ASPECTS:
                for scale in SCALES:
                    felt = opinion(truth, clip.variant, aspect, scale, late) + taste + by_chance.gauss(0.0, 0.7)
                    felt -= tires * (position - 1) / max(len(shown) - 1, 1)
                    skipped = by_chance.random() < skips
                    answers.append(
                        answer_of(
                            clip.code,
                            viewer=f"a{index:07x}",
                            language=("en", "ja")[index % 2],
                            position=position,
                            presentation=presentation,
                            side="" if presentation == "single" else ("left", "right")[place],
                            aspect=aspect,
                            scale=scale,
                            answer=None if skipped else min(5, max(1, round(felt))),
                            seconds=round(by_chance.uniform(8.0, 30.0), 1),
                        )
                    )
    return viewer_of(answers, f"answers-{index}.csv")


def write_viewers(files: Sequence[ViewerFile], folder: Path) -> list[Path]:
    """Write files like the evaluation page."""
    for file in files:
        (folder / file.path).write_bytes(encode_answers(file.answers))
    return [folder / file.path for file in files]
