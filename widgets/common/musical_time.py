"""Places in a score as a person writes them: bar, beat and ticks, counted from 1."""

from __future__ import annotations

import re
import unicodedata

from app.score.model import Metre, Score

_PLACE = re.compile(r"^\s*([-−]?\d+)(?:\s*[.|:]\s*(\d+)(?:\s*[.|:]\s*(\d+))?)?\s*$")


def metre_at(score: Score, tick: int) -> Metre:
    """The metre that holds at a tick."""
    return next((metre for metre in reversed(score.metres) if metre.tick <= tick), score.metres[0])


def beat_ticks(score: Score, tick: int) -> int:
    """Length of the metre's beat at a tick, at least one tick."""
    return max(4 * score.ticks_per_quarter // metre_at(score, tick).denominator, 1)


def place_text(score: Score, tick: int) -> str:
    """``"12.3"``, or ``"12.3.240"`` where the place is not on the beat."""
    bar = score.bar_of_tick(tick)
    beat, rest = divmod(tick - score.tick_of_bar(bar), beat_ticks(score, tick))
    text = f"{bar}.{beat + 1}".replace("-", "−")
    return f"{text}.{rest:03d}" if rest else text


def tick_of_place(score: Score, text: str) -> int | None:
    """The tick that such a text means; None where it means none. A bar alone is its first beat."""
    match = _PLACE.match(unicodedata.normalize("NFKC", text))
    if match is None:
        return None
    bar, beat, rest = (int(group.replace("−", "-")) if group else None for group in match.groups())
    assert bar is not None
    if abs(bar) > 1_000_000 or (beat or 0) > 10_000 or beat == 0:
        return None
    start = score.tick_of_bar(bar)
    return start + ((beat or 1) - 1) * beat_ticks(score, start) + (rest or 0)
