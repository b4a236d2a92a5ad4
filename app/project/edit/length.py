"""How long a piece may become: no edit makes one that no file could hold.

Messages (`UsageError`)
--------
tempo.too_many_bars : most
"""

from __future__ import annotations

from dataclasses import replace

from app.errors import UsageError
from app.project import limits
from app.project.model import Project
from app.score.model import Score


def with_score(project: Project, score: Score) -> Project:
    """The project with another score. Raises UsageError where it would have too many bars."""
    if score.bar_of_tick(score.sounding_end_tick) > limits.MOST_BARS:
        raise UsageError("tempo.too_many_bars", most=limits.MOST_BARS)
    return replace(project, score=score)
