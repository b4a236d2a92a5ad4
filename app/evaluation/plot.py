"""Plot of the scores as SVG: a panel for every aspect and scale, a row for every variant, means with intervals."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final
from xml.sax.saxutils import escape

from app.errors import Message, shortened
from app.evaluation.key import ASPECTS, SCALES, STEPS, VARIANTS, Presentation
from app.evaluation.results import PRESENTATIONS, EvaluationResults, Question, VariantScore
from app.evaluation.tables import variant_name
from app.messages import text

_FIELD: Final = 300.0
_NAMES: Final = 150.0
_ROW: Final = 26.0
_HEAD: Final = 34.0
_GAP: Final = 28.0
_EDGE: Final = 24.0
_INK: Final[dict[Presentation, str]] = {"single": "#1b6ca8", "pair": "#c2571a"}
"""Colours of the plot; single clips and pairs also differ in lightness and shape."""


def plot(results: EvaluationResults, language: str) -> str:
    """Return a diagram of the evaluation's results as an SVG document, with texts in a language."""
    questions = {score.question for score in results.scores}
    aspects = [aspect for aspect in ASPECTS if any(question.aspect == aspect for question in questions)]
    scales = [scale for scale in SCALES if any(question.scale == scale for question in questions)]
    variants = [variant for variant in VARIANTS if any(score.variant == variant for score in results.scores)]
    presentations = [one for one in PRESENTATIONS if any(question.presentation == one for question in questions)]
    by_place = {(score.question, score.variant): score for score in results.scores}
    high = _HEAD + _ROW * len(variants) + _GAP
    width = 2.0 * _EDGE + _NAMES + len(scales) * (_FIELD + _GAP)
    height = 3.0 * _EDGE + _HEAD + len(aspects) * high
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" width="{width:.0f}" '
        f'height="{height:.0f}" font-family="Noto Sans CJK JP, Noto Sans, Yu Gothic, Hiragino Sans, sans-serif" '
        'font-size="13">',
        f'<rect width="{width:.0f}" height="{height:.0f}" fill="#ffffff"/>',
        _text(
            _EDGE,
            _EDGE + 8.0,
            text(Message("results.title", {"piece": shortened(results.piece, 50)}), language),
            'font-size="17"',
        ),
        _text(_EDGE, _EDGE + 28.0, text(Message("results.plot"), language), 'fill="#555555"'),
        *_legend(presentations, width, language),
    ]
    for row, aspect in enumerate(aspects):
        top = 2.0 * _EDGE + _HEAD + row * high
        for line, variant in enumerate(variants):
            y = top + _HEAD + (line + 0.5) * _ROW
            name = variant_name(variant, language)
            parts.append(_text(_EDGE + _NAMES - 10.0, y + 4.5, name, 'text-anchor="end"'))
        for column, scale in enumerate(scales):
            left = _EDGE + _NAMES + column * (_FIELD + _GAP)
            names = (Message(f"results.aspect_{aspect}"), Message(f"results.scale_{scale}"))
            title = " – ".join(text(name, language) for name in names)
            parts.append(_text(left, top + 14.0, title, 'font-weight="bold"'))
            parts += _axes(left, top + _HEAD, _ROW * len(variants))
            for line, variant in enumerate(variants):
                for place, presentation in enumerate(presentations):
                    score = by_place.get((Question(presentation, aspect, scale), variant))
                    offset = (place - 0.5 * (len(presentations) - 1)) * 9.0
                    parts += _mark(score, presentation, left, top + _HEAD + (line + 0.5) * _ROW + offset)
    return "\n".join([*parts, "</svg>"]) + "\n"


def _x(left: float, value: float) -> float:
    """Return the horizontal position of a score, limited to the panel."""
    inside = min(max(value, 1.0), float(STEPS))
    return left + 8.0 + (inside - 1.0) / (STEPS - 1) * (_FIELD - 16.0)


def _axes(left: float, top: float, high: float) -> Iterator[str]:
    yield f'<rect x="{left:.1f}" y="{top:.1f}" width="{_FIELD:.1f}" height="{high:.1f}" fill="#f5f5f5"/>'
    for step in range(1, STEPS + 1):
        x = _x(left, step)
        yield f'<path d="M{x:.1f} {top:.1f}v{high:.1f}" stroke="#d0d0d0"/>'
        yield _text(x, top + high + 14.0, str(step), 'text-anchor="middle" fill="#555555" font-size="11"')


def _mark(score: VariantScore | None, presentation: Presentation, left: float, y: float) -> Iterator[str]:
    over = None if score is None else score.over_viewers
    if over is None:
        return
    ink = _INK[presentation]
    if over.low is not None and over.high is not None:
        low, high = _x(left, over.low), _x(left, over.high)
        yield f'<path d="M{low:.1f} {y:.1f}H{high:.1f}" stroke="{ink}" stroke-width="2"/>'
        ends = [x for x, value in ((low, over.low), (high, over.high)) if 1.0 <= value <= STEPS]
        for x in ends:
            yield f'<path d="M{x:.1f} {y - 3.5:.1f}v7" stroke="{ink}" stroke-width="2"/>'
    yield _shape(presentation, _x(left, over.mean), y)


def _shape(presentation: Presentation, x: float, y: float) -> str:
    ink = _INK[presentation]
    if presentation == "single":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4.5" fill="{ink}"/>'
    return (
        f'<rect x="{x - 4.0:.1f}" y="{y - 4.0:.1f}" width="8" height="8" fill="#ffffff" stroke="{ink}" '
        'stroke-width="2"/>'
    )


def _legend(presentations: list[Presentation], width: float, language: str) -> Iterator[str]:
    x = width - _EDGE - 90.0 * len(presentations)
    for presentation in presentations:
        yield _shape(presentation, x, _EDGE + 3.0)
        yield _text(x + 12.0, _EDGE + 8.0, text(Message(f"results.presentation_{presentation}"), language))
        x += 90.0


def _text(x: float, y: float, words: str, more: str = "") -> str:
    colour = "" if "fill=" in more else ' fill="#1a1a1a"'
    return f'<text x="{x:.1f}" y="{y:.1f}"{colour}{" " if more else ""}{more}>{escape(words)}</text>'
