"""Limits the length of a piece, so that every edit can be saved."""

from __future__ import annotations

from dataclasses import replace

from app.errors import UsageError
from app.project.model import Project
from app.score.limits import too_long
from app.score.model import Score


def with_score(project: Project, score: Score) -> Project:
    """Replace the score. Raises UsageError if it would be too long."""
    long = too_long(score)
    if long is not None:
        raise UsageError("piece.too_long", **long)
    return replace(project, score=score)
