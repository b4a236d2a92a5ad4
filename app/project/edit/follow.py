"""Adapts the tempo of the piece to a recording. Notes keep their ticks, so corrections stay valid."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Final

import msgspec
import numpy as np

from app.errors import UsageError
from app.project.edit.piece import set_audio, set_offset
from app.project.edit.tempo import set_beats
from app.project.model import Project
from app.project.recording import BeatPin, Doubt
from app.score.beat_following import SURE, Following, UnmatchedSpan

_LEAST_TIME: Final = 0.7
"""Least share of the usual duration of bars; a smaller one means that the recording omits some."""


def follow_recording(project: Project, following: Following, path: str | os.PathLike[str]) -> Project:
    """Set the tempo so that beats are at their times in a recording, which becomes the audio of the piece.

    Parameters
    ----------
    following : Following
        Alignment whose beats begin at tick 0.

    Raises
    ------
    UsageError
        The recording omits bars in the middle, which would leave them no time.
    """
    bar_of_tick = project.metre_map.bar_of_tick
    for span in following.missing:
        if _leaves_no_time(project, following, span):
            raise UsageError(
                "align.bars_missing", first=bar_of_tick(int(span.start)), last=bar_of_tick(max(int(span.end) - 1, 0))
            )
    pins = pins_for(project, path)
    project = set_beats(project, following.ticks, following.recording_s)
    project = set_audio(project, path)
    project = set_offset(project, -float(following.recording_s[0]), following.mean_confidence)
    if project.audio is None:
        raise UsageError("piece.no_recording")
    audio = msgspec.structs.replace(project.audio, pins=pins, doubts=_doubts(project, following))
    return replace(project, audio=audio)


def _leaves_no_time(project: Project, following: Following, span: UnmatchedSpan) -> bool:
    """Return whether the recording continues without a gap where it lacks bars, so that these would have no time."""
    # Beats before the first and after the last note are outside the bars to be left out.
    sounding = following.confidence >= SURE
    earlier = np.flatnonzero(sounding & (following.ticks < span.start))
    later = np.flatnonzero(sounding & (following.ticks >= span.end))
    if not len(earlier) or not len(later):
        return False
    seconds = project.score.tempo_map.seconds(following.ticks)
    before, after = earlier[-1], later[0]
    usual = np.median(np.diff(following.recording_s) / np.maximum(np.diff(seconds), 1e-6))
    there_s = following.recording_s[after] - following.recording_s[before]
    return bool(there_s < _LEAST_TIME * usual * (seconds[after] - seconds[before]))


def pins_for(project: Project, path: str | os.PathLike[str]) -> tuple[BeatPin, ...]:
    """Return the beats pinned to the recording at ``path``, which following again keeps; empty for another
    recording.
    """
    audio = project.audio
    same = audio is not None and audio.path == os.path.abspath(path)  # noqa: PTH100 - as `set_audio` has it
    return audio.pins if audio is not None and same else ()


def _doubts(project: Project, following: Following) -> tuple[Doubt, ...]:
    """Return the bars whose alignment must be checked by ear, and bars missing in the recording."""
    metre_map = project.metre_map
    last = int(following.ticks[-1])
    there = dict(following.bars(metre_map))
    low = {number: mean for number, mean in there.items() if mean < SURE}
    for span in following.missing:
        first_bar, last_bar = metre_map.bar_of_tick(int(span.start)), metre_map.bar_of_tick(max(int(span.end) - 1, 0))
        low.update({number: 0.0 for number in range(first_bar, last_bar + 1) if number not in there})
    result = []
    for number in sorted(low):
        start, end = max(metre_map.tick_of_bar(number), 0), metre_map.tick_of_bar(number + 1)
        if start <= last and end > start:
            result.append(Doubt(start, end, min(max(low[number], 0.0), 1.0)))
    return tuple(result)
