"""A small evaluation without drawn players: its clips are a few plain pictures."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np

from app.evaluation.design import Order, codes, orders, pairs_of
from app.evaluation.key import VERSION, EvaluationClip, EvaluationKey, Variant
from app.evaluation.page import PAGE_FILE, page
from app.export.video import side_by_side, video_into

VARIANTS: tuple[Variant, ...] = ("film", "generated", "shifted")
TITLE = "</script><script>alert(1)</script> & <b>\"film\"</b> 'C:\\n' 組曲\u2028"


def small_evaluation(folder: Path, title: str = TITLE) -> tuple[EvaluationKey, tuple[Order, ...]]:
    """Write a page of three variants in one excerpt, and two pairs."""
    drawn = codes(len(VARIANTS), 5)
    clips = tuple(
        EvaluationClip(code, variant, 1, 0.0, 0.6, "ensemble") for code, variant in zip(drawn, VARIANTS, strict=True)
    )
    key = EvaluationKey("suisou-evaluation", VERSION, "a1234567", title, 5, clips, ("fingers_arms", "ensemble"))
    made = folder / "clips"
    made.mkdir()
    for number, name in enumerate([*drawn, "practice"]):
        _clip(made / f"{name}.mp4", number)
    pairs = pairs_of([(clip.code, clip.variant, clip.excerpt) for clip in clips])
    for left, right in pairs:
        side_by_side(made / f"{left}-{right}.mp4", made / f"{left}.mp4", made / f"{right}.mp4")
    table = orders(drawn, pairs)
    (folder / PAGE_FILE).write_bytes(page(key, table, made))
    return key, table


def _clip(path: Path, number: int) -> None:
    sound = 0.05 * np.sin(np.arange(28_800) / (8.0 + number))
    with video_into(path, (160, 90), Fraction(10), np.stack([sound, sound], axis=1).astype(np.float32)) as film:
        for frame in range(6):
            picture = np.full((90, 160, 3), 40 * number, np.uint8)
            picture[20:70, 20 * frame : 20 * frame + 20] = 255
            film.write(picture)
