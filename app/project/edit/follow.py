"""The piece at the tempo of a recording. Notes keep their ticks, and with them everything that was set by hand.

Messages (`UsageError`): ``align.bars_missing``, ``tempo.outside``, those of `app.project.edit.piece`.
"""

from __future__ import annotations

import os

import numpy as np

from app.errors import UsageError
from app.project.edit.piece import set_audio, set_offset
from app.project.edit.tempo import set_beats
from app.project.model import Project
from app.score.following import SURE, Following


def follow_recording(project: Project, following: Following, path: str | os.PathLike[str]) -> Project:
    """Let the beats lie where they sound in a recording, which plays with the piece from now on.

    Parameters
    ----------
    following : Following
        Its beats begin at tick 0.

    Raises
    ------
    UsageError
        ``align.bars_missing`` (first, last) where the recording leaves out bars between others: they would have no
        time to sound in.
    """
    # Beats before the first note and after the last one are no bars that would have to wait for those left out.
    sounding = following.confidence >= SURE
    for span in following.missing:
        before = bool(np.any(sounding & (following.ticks < span.start)))
        after = bool(np.any(sounding & (following.ticks >= span.end)))
        if before and after:
            bar_of_tick = project.metre_map.bar_of_tick
            raise UsageError(
                "align.bars_missing", first=bar_of_tick(int(span.start)), last=bar_of_tick(max(int(span.end) - 1, 0))
            )
    project = set_beats(project, following.ticks, following.recording_s)
    project = set_audio(project, path)
    return set_offset(project, -float(following.recording_s[0]), following.mean_confidence)
